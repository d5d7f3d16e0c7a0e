import dev.subsurf.Scene
import dev.subsurf.SceneObject
import dev.subsurf.Shape
import dev.subsurf.SubsurfMaterial
import dev.subsurf.SubsurfMesh
import dev.subsurf.SubsurfRenderer
import dev.subsurf.load
import java.nio.ByteBuffer

/** Picture of a material on a sphere: RGBA, rows from the top. */
suspend fun thumbnail(path: String, size: Int): ByteBuffer =
    SubsurfMaterial.load(path).use { material ->
        SubsurfRenderer.open().use { renderer ->
            val sphere = SubsurfMesh.of(Shape.SPHERE)
            renderer.draw(Scene(listOf(SceneObject(sphere, material))), size, size)
        }
    }
