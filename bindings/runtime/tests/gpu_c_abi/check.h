/* What the programs of these tests share; in the common part of C11 and C++17. */
#include "../../../c/tests/abi/expect.h"

#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Pixels of the pictures. */
enum { WIDTH = 96, HEIGHT = 72 };

/* Everything that a picture takes. */
typedef struct Stage {
    SubsurfGpu *gpu;
    SubsurfFile *file;
    SubsurfMaterial *material;
    SubsurfMesh *mesh;
    SubsurfEnvironment *environment;
    SubsurfRenderer *renderer;
    SubsurfPicture *picture;
    SubsurfLight light;
    SubsurfObject object;
    SubsurfFrame frame;
} Stage;

static inline SubsurfGpu *open_gpu(uint32_t backend, uint32_t window_system, void *display) {
    SubsurfGpuOptions options;
    SubsurfGpu *gpu = NULL;
    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options;
    options.backend = backend;
    options.window_system = window_system;
    options.display = display;
    OK(subsurf_gpu_open(&options, &gpu));
    return gpu;
}

static inline void identity(float *matrix) {
    for (int k = 0; k < 16; k++) {
        matrix[k] = k % 5 == 0 ? 1.0f : 0.0f;
    }
}

/* One light from the side, with its shadow, and a sky. */
static inline void set_scene(Stage *stage, uint32_t mapping) {
    static const float PLACE[3] = {0.9f, 1.1f, 0.35f}, IRRADIANCE[3] = {3.0f, 2.9f, 2.7f}, SKY[3] = {0.35f, 0.4f, 0.5f};
    static const float EYE[3] = {40.0f, 24.0f, 64.0f}, ORIGIN[3] = {0.0f, 0.0f, 0.0f};
    static const float BACKGROUND[4] = {0.2f, 0.4f, 0.6f, 1.0f};
    memset(&stage->light, 0, sizeof stage->light);
    memset(&stage->object, 0, sizeof stage->object);
    memset(&stage->frame, 0, sizeof stage->frame);
    stage->light.kind = SUBSURF_LIGHT_KIND_DIRECTIONAL;
    stage->light.has_shadow = 1;
    memcpy(stage->light.place, PLACE, sizeof PLACE);
    memcpy(stage->light.irradiance, IRRADIANCE, sizeof IRRADIANCE);
    stage->object.mesh = stage->mesh;
    stage->object.material = stage->material;
    stage->object.mapping = mapping;
    stage->object.copies[0] = 2.0f;
    stage->object.copies[1] = 1.0f;
    stage->object.roughness = 0.25f;
    identity(stage->object.world_from_mesh);
    if (stage->environment == NULL) {
        OK(subsurf_environment_uniform(SKY, &stage->environment));
    }
    stage->frame.struct_size = sizeof stage->frame;
    stage->frame.exposure = 1.0f;
    memcpy(stage->frame.background, BACKGROUND, sizeof BACKGROUND);
    stage->frame.light_bytes = sizeof stage->light;
    stage->frame.light_count = 1;
    stage->frame.lights = &stage->light;
    stage->frame.object_bytes = sizeof stage->object;
    stage->frame.object_count = 1;
    stage->frame.objects = &stage->object;
    stage->frame.environment = stage->environment;
    OK(subsurf_frame_look_at(&stage->frame, EYE, ORIGIN, 0.5f, (float)WIDTH / (float)HEIGHT, 1.0f, 200.0f));
}

/* Loads a file and a sphere. */
static inline void load(Stage *stage, const char *path, uint32_t technique) {
    SubsurfMaterialOptions options;
    options.struct_size = sizeof options;
    options.technique = technique;
    OK(subsurf_file_open_path(path, &stage->file));
    OK(subsurf_material_load(stage->gpu, stage->file, &options, NULL, &stage->material));
    OK(subsurf_mesh_shape(stage->gpu, SUBSURF_SHAPE_SPHERE, 40.0f, &stage->mesh));
    set_scene(stage, SUBSURF_MAPPING_UV);
}

/* Fills a stage, whose frame points into it. */
static inline void open_stage(Stage *stage, const char *path, uint32_t backend, uint32_t technique) {
    memset(stage, 0, sizeof *stage);
    stage->gpu = open_gpu(backend, SUBSURF_WINDOW_SYSTEM_NONE, NULL);
    load(stage, path, technique);
    OK(subsurf_renderer_create(stage->gpu, NULL, &stage->renderer));
    OK(subsurf_picture_create(stage->gpu, WIDTH, HEIGHT, &stage->picture));
}

static inline void unload(Stage *stage) {
    subsurf_file_close(stage->file);
    subsurf_material_close(stage->material);
    subsurf_mesh_close(stage->mesh);
    stage->file = NULL;
    stage->material = NULL;
    stage->mesh = NULL;
}

/* Device first: everything else keeps what it needs. */
static inline void close_stage(Stage *stage) {
    subsurf_gpu_close(stage->gpu);
    unload(stage);
    subsurf_environment_close(stage->environment);
    subsurf_renderer_close(stage->renderer);
    subsurf_picture_close(stage->picture);
}

static inline uint64_t bytes_on(const SubsurfGpu *gpu) {
    SubsurfGpuMemory memory;
    memory.struct_size = sizeof memory;
    OK(subsurf_gpu_memory(gpu, &memory));
    return memory.materials_bytes + memory.meshes_bytes + memory.light_views_bytes + memory.frames_bytes + memory.others_bytes;
}

/* Bytes of the heap that are in use: those of all threads where MALLOC_ARENA_MAX is 1. Drivers keep pages for themselves. */
static inline uint64_t heap_bytes(void) {
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
    return mallinfo2().uordblks;
#else
    return 0;
#endif
}

static inline long open_files(void) {
    FILE *stream = fopen("/dev/null", "r");
    long next = stream == NULL ? 0 : (long)fileno(stream);
    if (stream != NULL) {
        fclose(stream);
    }
    return next;
}
