package dev.subsurf

/** Meshes, materials and surroundings that a renderer has on its device, made when a scene first shows them. */
internal class Resources(private val gpu: Handle) : AutoCloseable {
    private val meshes = HashMap<SubsurfMesh, GpuMesh>()
    private val materials = HashMap<MaterialKey, GpuMaterial>()
    private val environments = HashMap<Vector3?, Handle>()

    private data class MaterialKey(val material: SubsurfMaterial, val technique: Technique)

    /** Mesh on the device. */
    class GpuMesh(val handle: Handle, val bounds: Bounds)

    /** Material on the device, what its load took, and whether that was reported. */
    class GpuMaterial(val handle: Handle, val report: LongArray) {
        var isReported = false
    }

    fun mesh(mesh: SubsurfMesh): GpuMesh = meshes.getOrPut(mesh) { uploaded(mesh) }

    fun material(material: SubsurfMaterial, technique: Technique): GpuMaterial =
        materials.getOrPut(MaterialKey(material, technique)) {
            val report = LongArray(REPORT)
            val handle =
                handle("the material on the device", Native::materialClose) { out ->
                    material.file.handle.call { file ->
                        gpu.call { Native.materialLoad(it, file, technique.ordinal, report, out) }
                    }
                }
            GpuMaterial(handle, report)
        }

    fun environment(environment: Environment): Handle =
        environments.getOrPut(environment.irradiance) {
            handle("the surroundings", Native::environmentClose) { out ->
                val irradiance = environment.irradiance
                if (irradiance == null) {
                    Native.environmentStudio(out)
                } else {
                    Native.environmentUniform(irradiance.x, irradiance.y, irradiance.z, out)
                }
            }
        }

    /** Gives up a material. */
    fun drop(material: SubsurfMaterial, technique: Technique) {
        materials.remove(MaterialKey(material, technique))?.handle?.close()
    }

    /** Gives up what a scene does not show; everything where there is none. */
    fun keepOnly(scene: Scene?) {
        val shown = scene?.objects.orEmpty()
        meshes.closeUnless(shown.map { it.mesh }.toSet()) { it.handle }
        materials.closeUnless(shown.map { MaterialKey(it.material, it.technique) }.toSet()) { it.handle }
        environments.closeUnless(listOfNotNull(scene).map { it.environment.irradiance }.toSet()) { it }
    }

    override fun close() = keepOnly(null)

    private fun <K, V> HashMap<K, V>.closeUnless(kept: Set<K>, handle: (V) -> Handle) {
        entries.removeAll { (key, value) ->
            val isDropped = key !in kept
            if (isDropped) handle(value).close()
            isDropped
        }
    }

    private fun uploaded(mesh: SubsurfMesh): GpuMesh {
        val handle =
            handle("the mesh on the device", Native::meshClose) { out ->
                gpu.call { gpu ->
                    when (val source = mesh.source) {
                        is SubsurfMesh.Source.OfShape ->
                            Native.meshShape(gpu, source.shape.ordinal, source.extentMm, out)

                        is SubsurfMesh.Source.OfBuffers ->
                            with(source) {
                                Native.meshUpload(gpu, vertices, triangles, positions, normals, uvs, indices, out)
                            }
                    }
                }
            }
        val sphere = FloatArray(SPHERE)
        val status = handle.call { Native.meshInfo(it, IntArray(MESH), sphere, LongArray(1)) }
        if (status != Status.OK) handle.close()
        expectOk(status)
        val (x, y, z, radius) = sphere
        return GpuMesh(handle, Bounds(Vector3(x, y, z), radius))
    }

    companion object {
        private const val REPORT = 6
        private const val SPHERE = 4
        private const val MESH = 3

        /** Handle of what a function makes. */
        inline fun handle(name: String, noinline release: (Long) -> Unit, make: (LongArray) -> Int): Handle {
            val out = LongArray(1)
            expectOk(make(out))
            return Handle(name, out[0], null, release)
        }
    }
}
