package dev.subsurf

import java.nio.ByteBuffer
import java.nio.ByteOrder
import java.nio.FloatBuffer
import java.nio.IntBuffer

/** Shape that needs no file. */
public enum class Shape {
    /** Sphere. */
    SPHERE,

    /** Torus. */
    TORUS,

    /** Trefoil knot. */
    KNOT,

    /** Bowl. */
    BOWL,

    /** Hanging cloth. */
    DRAPERY,

    /** Sphere with a relief. */
    RELIEF,
}

/**
 * Triangle mesh to be drawn. Renderers make copies of it on their devices when they first draw it.
 *
 * Threads: any number at once.
 */
public class SubsurfMesh private constructor(
    internal val source: Source,
) {
    /** What a mesh is made of. */
    internal sealed class Source {
        class OfShape(val shape: Shape, val extentMm: Float) : Source()

        class OfBuffers(
            val vertices: Int,
            val triangles: Int,
            val positions: FloatBuffer,
            val normals: FloatBuffer?,
            val uvs: FloatBuffer?,
            val indices: IntBuffer,
        ) : Source()
    }

    /** Makers. */
    public companion object {
        private const val XYZ = 3
        private const val UV = 2
        private const val EXTENT_MM = 20f

        /** Shape whose longest side is so many mm. */
        @JvmStatic
        @JvmOverloads
        public fun of(shape: Shape, extentMm: Float = EXTENT_MM): SubsurfMesh =
            SubsurfMesh(Source.OfShape(shape, extentMm))

        /**
         * Mesh of direct buffers in the byte order of the machine ([ByteOrder.nativeOrder]), of which nothing is copied before it is drawn: they stay as they are.
         *
         * @param positions x, y and z of each vertex in mm.
         * @param indices Three vertices for each triangle, counter-clockwise.
         * @param normals x, y and z for each vertex; computed where there are none.
         * @param uvs u and v for each vertex; without them the material lies in its own size on the sides of a box.
         */
        @JvmStatic
        @JvmOverloads
        public fun of(
            positions: FloatBuffer,
            indices: IntBuffer,
            normals: FloatBuffer? = null,
            uvs: FloatBuffer? = null,
        ): SubsurfMesh {
            val vertices = positions.remaining() / XYZ
            fun expect(name: String, isDirect: Boolean, order: ByteOrder, found: Int, expected: Int) {
                require(isDirect) { "$name is not a direct buffer" }
                require(order == ByteOrder.nativeOrder()) { "$name is $order, expected is ${ByteOrder.nativeOrder()}" }
                require(found == expected) { "$name has $found numbers, expected are $expected" }
            }
            val triangles = indices.remaining() / XYZ
            expect("positions", positions.isDirect, positions.order(), positions.remaining(), vertices * XYZ)
            expect("indices", indices.isDirect, indices.order(), indices.remaining(), triangles * XYZ)
            normals?.let { expect("normals", it.isDirect, it.order(), it.remaining(), vertices * XYZ) }
            uvs?.let { expect("uvs", it.isDirect, it.order(), it.remaining(), vertices * UV) }
            val source =
                Source.OfBuffers(
                    vertices,
                    triangles,
                    positions.slice(),
                    normals?.slice(),
                    uvs?.slice(),
                    indices.slice(),
                )
            return SubsurfMesh(source)
        }

        /** Mesh of arrays, which are copied; otherwise as of buffers. */
        @JvmStatic
        @JvmOverloads
        public fun of(
            positions: FloatArray,
            indices: IntArray,
            normals: FloatArray? = null,
            uvs: FloatArray? = null,
        ): SubsurfMesh = of(direct(positions), direct(indices), normals?.let(::direct), uvs?.let(::direct))

        private fun bytes(numbers: Int) =
            ByteBuffer.allocateDirect(numbers * Int.SIZE_BYTES).order(ByteOrder.nativeOrder())

        private fun direct(values: FloatArray): FloatBuffer =
            bytes(values.size).asFloatBuffer().apply { put(values).rewind() }

        private fun direct(values: IntArray): IntBuffer =
            bytes(values.size).asIntBuffer().apply { put(values).rewind() }
    }
}
