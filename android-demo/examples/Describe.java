import dev.subsurf.Bssrdf;
import dev.subsurf.Plane;
import dev.subsurf.SubsurfException;
import dev.subsurf.SubsurfFile;

/** Says what is in a file of a translucent material. */
final class Describe {
    private Describe() {}

    static String describe(String path) throws SubsurfException {
        try (SubsurfFile file = SubsurfFile.open(path)) {
            Bssrdf bssrdf = file.getBssrdf();
            StringBuilder text = new StringBuilder();
            text.append(bssrdf.getWidth()).append(" x ").append(bssrdf.getHeight()).append(" pixels of ");
            text.append(bssrdf.getPitchMm()).append(" mm, ").append(bssrdf.getBitsPerPixel()).append(" bits each\n");
            for (Plane plane : bssrdf.getPlanes()) {
                int bytes = plane.use(buffer -> buffer.remaining()); // glTexSubImage2D(.., buffer)
                text.append(plane.getKind()).append(": ").append(bytes).append(" bytes\n");
            }
            float[] albedo = bssrdf.albedo(0, 0);
            return text.append("green albedo of the first pixel: ").append(albedo[1]).append('\n').toString();
        }
    }
}
