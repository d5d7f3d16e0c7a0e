/* Draws by the functions of subsurf.h: pictures, mistakes, a lost device, many one after the other. */
#define _POSIX_C_SOURCE 200809L
#include "check.h"

#include <math.h>

/* Writes the picture of a file, and checks what is told of it. */
static void picture(const char *path, uint32_t backend, uint32_t technique, const char *out) {
    static unsigned char pixels[HEIGHT][WIDTH][4], gapped[HEIGHT][WIDTH + 3][4];
    Stage stage;
    SubsurfGpuInfo gpu;
    SubsurfMaterialInfo material;
    SubsurfMeshInfo mesh;
    SubsurfFrameReport first, second;
    gpu.struct_size = sizeof gpu;
    material.struct_size = sizeof material;
    mesh.struct_size = sizeof mesh;
    first.struct_size = second.struct_size = sizeof first;
    open_stage(&stage, path, backend, technique);
    OK(subsurf_gpu_info(stage.gpu, &gpu));
    EXPECT((uint32_t)gpu.backend == backend && gpu.device[0] != 0 && gpu.driver[0] != 0 && gpu.most_texels >= 2048);
    OK(subsurf_material_info(stage.material, &material));
    EXPECT(material.technique != SUBSURF_TECHNIQUE_AUTOMATIC && material.gpu_bytes > 0);
    EXPECT(technique == SUBSURF_TECHNIQUE_AUTOMATIC || (uint32_t)material.technique == technique);
    OK(subsurf_mesh_info(stage.mesh, &mesh));
    EXPECT(mesh.triangles > 1000 && mesh.has_uvs == 1 && fabsf(mesh.radius_mm - 20.0f) < 0.01f && mesh.gpu_bytes > 0);

    OK(subsurf_renderer_draw_picture(stage.renderer, &stage.frame, stage.picture, &first));
    EXPECT(first.pipelines_ns > 0 && first.prepare_ns > 0 && first.done_ns >= first.pipelines_ns + first.prepare_ns);
    OK(subsurf_renderer_draw_picture(stage.renderer, &stage.frame, stage.picture, &second));
    EXPECT(second.prepare_ns == 0 && second.recording_ns > 0 && second.done_ns >= second.recording_ns);
    OK(subsurf_picture_read(stage.picture, pixels, sizeof pixels, 0));
    OK(subsurf_picture_read(stage.picture, gapped, sizeof gapped, sizeof gapped[0]));
    for (int y = 0; y < HEIGHT; y++) {
        EXPECT(memcmp(pixels[y], gapped[y], sizeof pixels[y]) == 0);
        EXPECT(gapped[y][WIDTH][0] == 0);
    }
    FILE *stream = fopen(out, "wb");
    EXPECT(stream != NULL && fwrite(pixels, sizeof pixels, 1, stream) == 1);
    fclose(stream);

    /* Room that is given up is made again, and the picture stays the same. */
    uint64_t before = bytes_on(stage.gpu);
    OK(subsurf_renderer_trim(stage.renderer));
    OK(subsurf_gpu_finish(stage.gpu));
    EXPECT(bytes_on(stage.gpu) < before);
    memset(gapped, 0, sizeof gapped);
    OK(subsurf_renderer_draw_picture(stage.renderer, &stage.frame, stage.picture, NULL));
    OK(subsurf_picture_read(stage.picture, gapped, sizeof pixels, 0));
    EXPECT(memcmp(gapped, pixels, sizeof pixels) == 0);
    EXPECT(bytes_on(stage.gpu) == before);
    close_stage(&stage);
}

/* A triangle by hand, against arrays of every wrong kind. */
static void meshes(const Stage *stage) {
    float positions[9] = {0, 0, 0, 10, 0, 0, 0, 10, 0}, uvs[6] = {0, 0, 1, 0, 0, 1};
    uint32_t indices[3] = {0, 1, 2};
    SubsurfMesh *mesh = NULL;
    SubsurfMeshInfo info;
    SubsurfMeshData data;
    memset(&data, 0, sizeof data);
    info.struct_size = sizeof info;
    data.struct_size = sizeof data;
    data.vertices = 3;
    data.triangles = 1;
    data.positions = positions;
    data.uvs = uvs;
    data.indices = indices;
    OK(subsurf_mesh_upload(stage->gpu, &data, &mesh));
    OK(subsurf_mesh_info(mesh, &info));
    EXPECT(info.vertices == 3 && info.triangles == 1 && info.centre_mm[0] == 5.0f && info.has_uvs == 1);
    subsurf_mesh_close(mesh);
    mesh = NULL;
    FAILS(INVALID_ARGUMENT, "data is null", subsurf_mesh_upload(stage->gpu, NULL, &mesh));
    FAILS(INVALID_ARGUMENT, "mesh_out is null", subsurf_mesh_upload(stage->gpu, &data, NULL));
    indices[1] = 3;
    FAILS(INVALID_MESH, "vertex 3, but there are 3", subsurf_mesh_upload(stage->gpu, &data, &mesh));
    indices[1] = 0;
    FAILS(INVALID_MESH, "no area", subsurf_mesh_upload(stage->gpu, &data, &mesh));
    indices[1] = 1;
    positions[4] = NAN;
    FAILS(INVALID_MESH, "vertex 1 is at", subsurf_mesh_upload(stage->gpu, &data, &mesh));
    positions[4] = 0.0f;
    positions[4] = 0.0f;
    data.mm_per_unit = 1e9f;
    FAILS(INVALID_MESH, "from its origin", subsurf_mesh_upload(stage->gpu, &data, &mesh));
    data.mm_per_unit = -1.0f;
    FAILS(INVALID_MESH, "scale of -1", subsurf_mesh_upload(stage->gpu, &data, &mesh));
    data.mm_per_unit = 0.0f;
    data.triangles = 0;
    FAILS(INVALID_MESH, "no triangles", subsurf_mesh_upload(stage->gpu, &data, &mesh));
    data.triangles = 0xFFFFFFFFu;
    FAILS(INVALID_ARGUMENT, "triangles, expected are 1431655765", subsurf_mesh_upload(stage->gpu, &data, &mesh));
    data.triangles = 1;
    data.positions = NULL;
    FAILS(INVALID_ARGUMENT, "positions is null", subsurf_mesh_upload(stage->gpu, &data, &mesh));
    data.struct_size = 8;
    FAILS(INVALID_ARGUMENT, "sizeof(SubsurfMeshData)", subsurf_mesh_upload(stage->gpu, &data, &mesh));
    FAILS(INVALID_ARGUMENT, "shape is 6, expected is less than 6", subsurf_mesh_shape(stage->gpu, 6, 1.0f, &mesh));
    FAILS(INVALID_ARGUMENT, "extent_mm is", subsurf_mesh_shape(stage->gpu, 0, NAN, &mesh));
    EXPECT(mesh == NULL);
}

/* Frames that cannot be drawn; after each, one that can. */
static void frames(Stage *stage) {
    SubsurfFrame frame = stage->frame;
    SubsurfLight lights[9];
    SubsurfObject object = stage->object;
#define REFUSED(words) FAILS(INVALID_ARGUMENT, words, subsurf_renderer_draw_picture(stage->renderer, &frame, stage->picture, NULL))
#define RESET frame = stage->frame, object = stage->object, frame.objects = &object
    for (int k = 0; k < 9; k++) {
        lights[k] = stage->light;
    }
    FAILS(INVALID_ARGUMENT, "frame is null", subsurf_renderer_draw_picture(stage->renderer, NULL, stage->picture, NULL));
    FAILS(INVALID_ARGUMENT, "picture is null", subsurf_renderer_draw_picture(stage->renderer, &frame, NULL, NULL));
    FAILS(INVALID_ARGUMENT, "renderer is null", subsurf_renderer_draw_picture(NULL, &frame, stage->picture, NULL));
    frame.struct_size = 16;
    REFUSED("sizeof(SubsurfFrame)");
    RESET;
    frame.light_bytes = 8;
    REFUSED("sizeof(SubsurfLight)");
    RESET;
    frame.lights = NULL;
    REFUSED("lights is null");
    RESET;
    frame.lights = lights;
    frame.light_count = 9;
    REFUSED("9 lights, expected are 8 at most");
    RESET;
    frame.object_count = 17;
    REFUSED("17 objects, expected are 16 at most");
    RESET;
    frame.view_from_world[3] = INFINITY;
    REFUSED("view_from_world has inf");
    RESET;
    memset(frame.clip_from_view, 0, sizeof frame.clip_from_view);
    REFUSED("clip_from_view has the determinant 0");
    RESET;
    object.mesh = NULL;
    REFUSED("mesh is null");
    RESET;
    object.material = (const SubsurfMaterial *)(const void *)stage->mesh;
    REFUSED("material is not a SubsurfMaterial");
    RESET;
    object.number = 7;
    REFUSED("number is 7");
    RESET;
    object.mapping = 2;
    REFUSED("mapping is 2, expected is less than 2");
    RESET;
    object.roughness = 2.0f;
    REFUSED("roughness is 2, expected is 0 to 1");
    RESET;
    object.world_from_mesh[0] = 2.0f;
    REFUSED("no rotation with a uniform scale");
    RESET;
    lights[0].kind = 3;
    frame.lights = lights;
    REFUSED("kind is 3");
    lights[0].kind = SUBSURF_LIGHT_KIND_SPOT;
    REFUSED("half_angle_rad is 0");
    lights[0].kind = SUBSURF_LIGHT_KIND_POINT;
    lights[0].irradiance[1] = -1.0f;
    REFUSED("irradiance is -1");
    RESET;
    OK(subsurf_renderer_draw_picture(stage->renderer, &frame, stage->picture, NULL));
    /* Numbers at the ends of what is allowed are drawn somehow. */
    static const float ENDS[] = {0.0f, -0.0f, 1e-38f, 1e-20f, 1e20f, 3e38f, -3e38f};
    for (int k = 0; k < (int)(sizeof ENDS / sizeof ENDS[0]); k++) {
        for (int at = 0; at < 8; at++) {
            RESET;
            lights[0] = stage->light;
            frame.lights = lights;
            if (at < 4) {
                frame.view_from_world[at * 5] = ENDS[k];
            } else if (at == 4) {
                frame.view_from_world[14] = ENDS[k];
            } else if (at == 5) {
                frame.clip_from_view[0] = ENDS[k];
            } else if (at == 6) {
                object.world_from_mesh[13] = ENDS[k];
            } else {
                lights[0].kind = SUBSURF_LIGHT_KIND_POINT;
                lights[0].place[1] = ENDS[k];
            }
            SubsurfStatus status = subsurf_renderer_draw_picture(stage->renderer, &frame, stage->picture, NULL);
            EXPECT(status == SUBSURF_STATUS_OK || status == SUBSURF_STATUS_INVALID_ARGUMENT);
        }
    }
    /* No object at all: the background. */
    unsigned char pixels[HEIGHT][WIDTH][4];
    RESET;
    frame.object_count = 0;
    frame.objects = NULL;
    frame.light_count = 0;
    frame.environment = NULL;
    OK(subsurf_renderer_draw_picture(stage->renderer, &frame, stage->picture, NULL));
    OK(subsurf_picture_read(stage->picture, pixels, sizeof pixels, 0));
    EXPECT(pixels[HEIGHT / 2][WIDTH / 2][0] == 51 && pixels[HEIGHT / 2][WIDTH / 2][2] == 153);
}

static void misuse(const char *path, uint32_t backend, const char *btf_path) {
    Stage stage, other;
    SubsurfGpu *gpu = NULL;
    SubsurfGpuOptions options;
    SubsurfMaterialOptions technique;
    SubsurfRendererOptions asked;
    SubsurfRenderer *renderer = NULL;
    SubsurfMaterial *material = NULL;
    SubsurfPicture *small = NULL;
    SubsurfSurface *surface = NULL;
    SubsurfEnvironment *environment = NULL;
    SubsurfGpuInfo info;
    SubsurfFile *btf = NULL;
    float sky[3] = {1.0f, NAN, 1.0f};
    unsigned char pixels[16];
    memset(&options, 0, sizeof options);
    memset(&asked, 0, sizeof asked);
    options.struct_size = sizeof options;
    technique.struct_size = sizeof technique;
    asked.struct_size = sizeof asked;
    info.struct_size = 4;

    open_stage(&stage, path, backend, SUBSURF_TECHNIQUE_AUTOMATIC);
    open_stage(&other, path, backend, SUBSURF_TECHNIQUE_AUTOMATIC);
    FAILS(INVALID_ARGUMENT, "gpu_out is null", subsurf_gpu_open(NULL, NULL));
    options.backend = 5;
    FAILS(INVALID_ARGUMENT, "backend is 5, expected is less than 5", subsurf_gpu_open(&options, &gpu));
    options.backend = SUBSURF_BACKEND_METAL;
    FAILS(NO_DEVICE, "no Metal device", subsurf_gpu_open(&options, &gpu));
    options.backend = backend;
    options.window_system = SUBSURF_WINDOW_SYSTEM_X11;
    FAILS(INVALID_ARGUMENT, "display is null", subsurf_gpu_open(&options, &gpu));
    options.struct_size = 3;
    FAILS(INVALID_ARGUMENT, "sizeof(SubsurfGpuOptions)", subsurf_gpu_open(&options, &gpu));
    EXPECT(gpu == NULL);
    FAILS(INVALID_ARGUMENT, "gpu is null", subsurf_gpu_finish(NULL));
    FAILS(INVALID_ARGUMENT, "gpu is not a SubsurfGpu", subsurf_gpu_finish((const SubsurfGpu *)(const void *)stage.mesh));
    FAILS(INVALID_ARGUMENT, "sizeof(SubsurfGpuInfo)", subsurf_gpu_info(stage.gpu, &info));
    FAILS(INVALID_ARGUMENT, "opened for no windows", subsurf_surface_open(stage.gpu, 1, 1, 1, &surface));
    FAILS(INVALID_ARGUMENT, "surface is null", subsurf_surface_resize(NULL, 1, 1));

    FAILS(INVALID_ARGUMENT, "file is null", subsurf_material_load(stage.gpu, NULL, NULL, NULL, &material));
    technique.technique = SUBSURF_TECHNIQUE_BTF;
    FAILS(WRONG_FAMILY, "BSSRDF, expected is a nested BTF", subsurf_material_load(stage.gpu, stage.file, &technique, NULL, &material));
    OK(subsurf_file_open_path(btf_path, &btf));
    technique.technique = SUBSURF_TECHNIQUE_SPLAT;
    FAILS(WRONG_FAMILY, "nested BTF, expected is a BSSRDF", subsurf_material_load(stage.gpu, btf, &technique, NULL, &material));
    EXPECT(material == NULL);
    OK(subsurf_material_load(stage.gpu, btf, NULL, NULL, &material));
    subsurf_file_close(btf);

    meshes(&stage);
    frames(&stage);
    /* A BTF lies by texture coordinates. */
    stage.object.material = material;
    stage.object.mapping = SUBSURF_MAPPING_BOX;
    FAILS(INVALID_ARGUMENT, "not by a box", subsurf_renderer_draw_picture(stage.renderer, &stage.frame, stage.picture, NULL));
    stage.object.material = other.material;
    FAILS(INVALID_ARGUMENT, "another SubsurfGpu", subsurf_renderer_draw_picture(stage.renderer, &stage.frame, stage.picture, NULL));
    stage.object.material = stage.material;
    FAILS(INVALID_ARGUMENT, "another SubsurfGpu", subsurf_renderer_draw_picture(stage.renderer, &stage.frame, other.picture, NULL));

    asked.samples = 3;
    FAILS(INVALID_ARGUMENT, "samples is 3", subsurf_renderer_create(stage.gpu, &asked, &renderer));
    asked.samples = 4;
    asked.light_texels = 100;
    FAILS(INVALID_ARGUMENT, "power of two", subsurf_renderer_create(stage.gpu, &asked, &renderer));
    asked.light_texels = 128;
    asked.objects = 2000000;
    FAILS(INVALID_ARGUMENT, "objects is 2000000", subsurf_renderer_create(stage.gpu, &asked, &renderer));
    asked.objects = 1;
    asked.budget_bytes = 1000;
    OK(subsurf_renderer_create(stage.gpu, &asked, &renderer));
    FAILS(OVER_BUDGET, "more than the budget of 1000", subsurf_renderer_draw_picture(renderer, &stage.frame, stage.picture, NULL));
    subsurf_renderer_close(renderer);

    FAILS(INVALID_ARGUMENT, "0 x 4 pixels", subsurf_picture_create(stage.gpu, 0, 4, &small));
    FAILS(UNSUPPORTED, "texture sides up to", subsurf_picture_create(stage.gpu, 0x7FFFFFFF, 4, &small));
    OK(subsurf_picture_create(stage.gpu, 2, 2, &small));
    FAILS(INVALID_ARGUMENT, "length is 15, expected are 16", subsurf_picture_read(small, pixels, 15, 0));
    FAILS(INVALID_ARGUMENT, "row_bytes is 7", subsurf_picture_read(small, pixels, 16, 7));
    FAILS(INVALID_ARGUMENT, "pixels is null", subsurf_picture_read(small, NULL, 16, 0));
    OK(subsurf_picture_read(small, pixels, 16, 8));
    FAILS(INVALID_ARGUMENT, "irradiance is NaN", subsurf_environment_uniform(sky, &environment));
    FAILS(INVALID_ARGUMENT, "pixel (0, 0)", subsurf_environment_picture(1, 1, sky, &environment));
    FAILS(INVALID_ARGUMENT, "0 x 1 pixels", subsurf_environment_picture(0, 1, sky, &environment));
    OK(subsurf_environment_studio(&environment));
    stage.object.mapping = SUBSURF_MAPPING_UV;
    stage.frame.environment = environment;
    OK(subsurf_renderer_draw_picture(stage.renderer, &stage.frame, small, NULL));

    /* Null and what is another handle are not closed. */
    subsurf_environment_close(environment);
    subsurf_picture_close(small);
    subsurf_material_close(material);
    subsurf_gpu_close(NULL);
    subsurf_surface_close(NULL);
    subsurf_renderer_close((SubsurfRenderer *)(void *)stage.picture);
    subsurf_gpu_close((SubsurfGpu *)(void *)stage.picture);
    OK(subsurf_picture_read(stage.picture, malloc(WIDTH * HEIGHT * 4), WIDTH * HEIGHT * 4, 0));
    close_stage(&stage);
    close_stage(&other);
}

/* After the loss of a device every call says so, and another device draws the same. */
static void lost(const char *path, uint32_t backend) {
    static unsigned char before[WIDTH * HEIGHT * 4], after[WIDTH * HEIGHT * 4];
    Stage stage;
    SubsurfMesh *mesh = NULL;
    SubsurfMaterial *material = NULL;
    SubsurfLoadReport load_report;
    SubsurfFrameReport frame_report;
    load_report.struct_size = frame_report.struct_size = 4;
    open_stage(&stage, path, backend, SUBSURF_TECHNIQUE_AUTOMATIC);
    OK(subsurf_renderer_draw_picture(stage.renderer, &stage.frame, stage.picture, NULL));
    OK(subsurf_picture_read(stage.picture, before, sizeof before, 0));
    OK(subsurf_gpu_lose(stage.gpu));
    /* Reports that cannot be filled are refused before the device is asked. */
    FAILS(INVALID_ARGUMENT, "sizeof(SubsurfLoadReport)", subsurf_material_load(stage.gpu, stage.file, NULL, &load_report, &material));
    FAILS(INVALID_ARGUMENT, "sizeof(SubsurfFrameReport)", subsurf_renderer_draw_picture(stage.renderer, &stage.frame, stage.picture, &frame_report));
    FAILS(DEVICE_LOST, "lost", subsurf_renderer_draw_picture(stage.renderer, &stage.frame, stage.picture, NULL));
    FAILS(DEVICE_LOST, "lost", subsurf_gpu_finish(stage.gpu));
    EXPECT(subsurf_picture_read(stage.picture, after, sizeof after, 0) == SUBSURF_STATUS_DEVICE_LOST);
    EXPECT(subsurf_material_load(stage.gpu, stage.file, NULL, NULL, &material) == SUBSURF_STATUS_DEVICE_LOST);
    EXPECT(subsurf_mesh_shape(stage.gpu, SUBSURF_SHAPE_TORUS, 1.0f, &mesh) == SUBSURF_STATUS_DEVICE_LOST);
    EXPECT(mesh == NULL && material == NULL);
    close_stage(&stage);
    open_stage(&stage, path, backend, SUBSURF_TECHNIQUE_AUTOMATIC);
    OK(subsurf_renderer_draw_picture(stage.renderer, &stage.frame, stage.picture, NULL));
    OK(subsurf_picture_read(stage.picture, after, sizeof after, 0));
    EXPECT(memcmp(before, after, sizeof before) == 0);
    close_stage(&stage);
}

/* Materials and meshes that come and go on one device, and devices that come and go. */
static void cycles(const char *path, uint32_t backend, int devices, int loads, uint64_t most_heap_bytes) {
    static unsigned char pixels[WIDTH * HEIGHT * 4];
    uint64_t heap = 0;
    long files = 0;
    for (int device = 0; device < devices; device++) {
        Stage stage;
        uint64_t bytes = 0;
        open_stage(&stage, path, backend, SUBSURF_TECHNIQUE_AUTOMATIC);
        for (int k = 0; k < loads; k++) {
            unload(&stage);
            load(&stage, path, SUBSURF_TECHNIQUE_AUTOMATIC);
            OK(subsurf_renderer_draw_picture(stage.renderer, &stage.frame, stage.picture, NULL));
            OK(subsurf_picture_read(stage.picture, pixels, sizeof pixels, 0));
            if (k == 0) {
                bytes = bytes_on(stage.gpu);
            }
        }
        EXPECT(bytes_on(stage.gpu) == bytes);
        close_stage(&stage);
        if (device == 1) {
            heap = heap_bytes();
            files = open_files();
        }
    }
    printf("%lu bytes of heap, then %lu\n", (unsigned long)heap, (unsigned long)heap_bytes());
    EXPECT(heap_bytes() <= heap + most_heap_bytes && open_files() == files);
}

int main(int argc, char **argv) {
    EXPECT(argc >= 4);
    uint32_t backend = strcmp(argv[3], "gl") == 0 ? SUBSURF_BACKEND_GL : SUBSURF_BACKEND_VULKAN;
    if (strcmp(argv[1], "picture") == 0) {
        picture(argv[2], backend, (uint32_t)atoi(argv[4]), argv[5]);
    } else if (strcmp(argv[1], "misuse") == 0) {
        misuse(argv[2], backend, argv[4]);
    } else if (strcmp(argv[1], "lost") == 0) {
        lost(argv[2], backend);
    } else {
        cycles(argv[2], backend, atoi(argv[4]), atoi(argv[5]), (uint64_t)atol(argv[6]));
    }
    return 0;
}
