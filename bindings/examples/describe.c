/* Tells what is in a .subsurf file, and what textures a BSSRDF is. */
#include "subsurf.h"
#include <stdio.h>

static int failed(void) {
    fprintf(stderr, "%s\n", subsurf_last_error());
    return 1;
}

int main(int argc, char **argv) {
    SubsurfFile *file = NULL;
    SubsurfFileInfo info = {.struct_size = sizeof info};
    SubsurfBssrdfInfo patch = {.struct_size = sizeof patch};
    SubsurfPlane plane = {.struct_size = sizeof plane};
    float rd[3];

    if (argc != 2 || subsurf_file_open_path(argv[1], &file) != SUBSURF_STATUS_OK) {
        return failed();
    }
    subsurf_file_info(file, &info);
    printf("%lu bytes, family %u\n", (unsigned long)info.file_bytes, (unsigned)info.family);
    if (info.family == SUBSURF_FAMILY_BSSRDF) {
        subsurf_bssrdf_info(file, &patch);
        printf("%u x %u pixels of %g mm, %u bits each\n", patch.width, patch.height, patch.pitch_mm, patch.bits_per_pixel);
        for (uint32_t number = 0; number < patch.planes; number++) {
            subsurf_bssrdf_plane(file, number, &plane);
            printf("plane %u: %u x %u x %u, GL format 0x%04X, Vulkan %u\n", (unsigned)plane.kind, plane.width,
                   plane.height, plane.layers, plane.gl_internal_format, plane.vk_format);
            /* glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, plane.width, plane.height, plane.gl_format, plane.gl_type, plane.data); */
        }
        subsurf_bssrdf_rd(file, 0, 0, 1, 0, rd);
        printf("Rd from pixel (0, 0) to (1, 0): %g %g %g per mm^2\n", rd[0], rd[1], rd[2]);
    }
    subsurf_file_close(file);
    return 0;
}
