/* Draws a .subsurf file on a sphere, and writes the picture as picture.ppm. */
#include "subsurf.h"
#include <stdio.h>

enum { WIDTH = 320, HEIGHT = 240 };
#define CHECK(call) if ((call) != SUBSURF_STATUS_OK) return fprintf(stderr, "%s\n", subsurf_last_error()), 1

int main(int argc, char **argv) {
    static unsigned char pixels[WIDTH * HEIGHT][4];
    const float sky[3] = {0.35f, 0.4f, 0.5f}, eye[3] = {40, 24, 64}, middle[3] = {0, 0, 0};
    SubsurfFile *file = NULL;
    SubsurfGpu *gpu = NULL;
    SubsurfMaterial *material = NULL;
    SubsurfMesh *mesh = NULL;
    SubsurfEnvironment *environment = NULL;
    SubsurfRenderer *renderer = NULL;
    SubsurfPicture *picture = NULL;
    CHECK(subsurf_file_open_path(argc > 1 ? argv[1] : "", &file));
    CHECK(subsurf_gpu_open(NULL, &gpu));
    CHECK(subsurf_material_load(gpu, file, NULL, NULL, &material));
    CHECK(subsurf_mesh_shape(gpu, SUBSURF_SHAPE_SPHERE, 40, &mesh));
    CHECK(subsurf_environment_uniform(sky, &environment));
    CHECK(subsurf_renderer_create(gpu, NULL, &renderer));
    CHECK(subsurf_picture_create(gpu, WIDTH, HEIGHT, &picture));
    SubsurfLight light = {.has_shadow = 1, .place = {0.9f, 1.1f, 0.35f}, .irradiance = {3, 3, 3}};
    SubsurfObject object = {mesh, material, .copies = {2, 1}, .roughness = 0.25f, .world_from_mesh = {[0] = 1, [5] = 1, [10] = 1, [15] = 1}};
    SubsurfFrame frame = {.struct_size = sizeof frame, .exposure = 1, .environment = environment,
                          .light_bytes = sizeof light, .light_count = 1, .lights = &light,
                          .object_bytes = sizeof object, .object_count = 1, .objects = &object};
    CHECK(subsurf_frame_look_at(&frame, eye, middle, 0.6f, (float)WIDTH / HEIGHT, 1, 200));
    CHECK(subsurf_renderer_draw_picture(renderer, &frame, picture, NULL));
    CHECK(subsurf_picture_read(picture, pixels, sizeof pixels, 0));
    FILE *out = fopen("picture.ppm", "wb");
    fprintf(out, "P6 %d %d 255\n", WIDTH, HEIGHT);
    for (int k = 0; k < WIDTH * HEIGHT; k++) fwrite(pixels[k], 3, 1, out);
    fclose(out);
    subsurf_gpu_close(gpu); /* and so on, in any order */
    return 0;
}
