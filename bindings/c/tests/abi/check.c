/* Calls every function of subsurf.h: values, misuse, hostile bytes, and many files one after the other. */
#define _POSIX_C_SOURCE 200809L
#include "expect.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const float LIGHT[3] = {0.48f, -0.6f, 0.64f}, VIEW[3] = {0.36f, 0.48f, 0.8f}, RANDOM[2] = {0.3f, 0.7f};

static unsigned char *read_file(const char *path, size_t *length) {
    FILE *stream = fopen(path, "rb");
    unsigned char *bytes;
    EXPECT(stream != NULL && fseek(stream, 0, SEEK_END) == 0);
    *length = (size_t)ftell(stream);
    rewind(stream);
    bytes = malloc(*length);
    EXPECT(bytes != NULL && fread(bytes, 1, *length, stream) == *length);
    fclose(stream);
    return bytes;
}

static SubsurfFile *open_path(const char *path) {
    SubsurfFile *file = NULL;
    OK(subsurf_file_open_path(path, &file));
    return file;
}

static void show(const char *name, const float *numbers, int count) {
    printf("%s", name);
    for (int k = 0; k < count; k++) {
        uint32_t bits;
        memcpy(&bits, &numbers[k], sizeof bits);
        printf(" %08x", (unsigned)bits);
    }
    printf("\n");
}

static void show_bssrdf(const SubsurfFile *file) {
    SubsurfBssrdfInfo info = {.struct_size = sizeof info};
    float rgb[3];
    OK(subsurf_bssrdf_info(file, &info));
    printf("patch %u %u %u %u %u %u %u %u %u\n", (unsigned)info.bases_per_pixel, (unsigned)info.coding,
           (unsigned)info.addressing, info.width, info.height, info.window_radius, info.samples, info.base_materials,
           info.bits_per_pixel);
    show("lengths", &info.pitch_mm, 3);
    for (uint32_t number = 0; number < info.planes; number++) {
        SubsurfPlane plane = {.struct_size = sizeof plane};
        uint32_t sum = 0;
        OK(subsurf_bssrdf_plane(file, number, &plane));
        EXPECT(plane.bytes == plane.layer_bytes * plane.layers && plane.layer_bytes == (uint64_t)plane.row_bytes * plane.height);
        for (uint64_t k = 0; k < plane.bytes; k++) {
            sum = 31 * sum + ((const unsigned char *)plane.data)[k];
        }
        printf("plane %u %u %ux%ux%u %08x\n", (unsigned)plane.kind, plane.row_bytes, plane.width, plane.height, plane.layers,
               (unsigned)sum);
    }
    for (int32_t x = -1; x <= 2; x++) {
        OK(subsurf_bssrdf_rd(file, x, 0, 1, 1, rgb));
        show("rd", rgb, 3);
        OK(subsurf_bssrdf_albedo(file, x, 1, rgb));
        show("albedo", rgb, 3);
    }
}

static void show_btf(SubsurfFile *file, int is_nested) {
    SubsurfBtfInfo info = {.struct_size = sizeof info};
    float rgb[3], light[3], pdf;
    OK(subsurf_btf_expand(file));
    OK(subsurf_btf_expand(file));
    OK(subsurf_btf_info(file, &info));
    printf("btf %u %u %u %u %u %u %u %lu\n", info.materials, info.texels, info.is_display, info.n_alpha, info.n_beta,
           info.n_theta, info.n_phi, (unsigned long)info.expansion_bytes);
    for (uint32_t number = 0; number < info.materials; number++) {
        SubsurfBtfMaterial material = {.struct_size = sizeof material};
        OK(subsurf_btf_material(file, number, &material));
        printf("material %s %u %u %u\n", material.name, material.width, material.height, material.levels);
    }
    for (int32_t x = -1; x <= 2; x++) {
        uint32_t texel;
        OK(subsurf_btf_texel(file, 0, 0, x, 1, &texel));
        OK(subsurf_btf_eval(file, texel, LIGHT, VIEW, rgb));
        show("value", rgb, 3);
        OK(subsurf_btf_linear(file, rgb, rgb));
        show("linear", rgb, 3);
        if (is_nested) {
            OK(subsurf_btf_sample(file, texel, VIEW, RANDOM, light, &pdf));
            show("light", light, 3);
            show("density", &pdf, 1);
            OK(subsurf_btf_pdf(file, texel, LIGHT, VIEW, &pdf));
            show("pdf", &pdf, 1);
            OK(subsurf_btf_albedo(file, texel, VIEW, rgb));
            show("albedo", rgb, 3);
        }
    }
}

/* Everything that a file can be asked. */
static void show_all(SubsurfFile *file) {
    SubsurfFileInfo info = {.struct_size = sizeof info};
    const void *bytes;
    size_t length;
    OK(subsurf_file_info(file, &info));
    OK(subsurf_file_bytes(file, &bytes, &length));
    EXPECT(length == info.file_bytes && memcmp(bytes, "\x89SSF", 4) == 0);
    printf("file %u %lu\n", (unsigned)info.family, (unsigned long)info.file_bytes);
    if (info.family == SUBSURF_FAMILY_BSSRDF) {
        show_bssrdf(file);
    } else {
        show_btf(file, info.family == SUBSURF_FAMILY_NESTED_BTF);
    }
}

/* Null, wrong families, handles that are none, structs of other versions. */
static void misuse(const char *bssrdf_path, const char *nested_path, const char *factored_path) {
    SubsurfFile *bssrdf = open_path(bssrdf_path), *nested = open_path(nested_path), *factored = open_path(factored_path);
    SubsurfFile *none = NULL;
    SubsurfFileInfo info = {.struct_size = sizeof info};
    SubsurfBssrdfInfo patch = {.struct_size = sizeof patch};
    SubsurfBtfInfo btf = {.struct_size = sizeof btf};
    SubsurfPlane plane = {.struct_size = sizeof plane};
    struct {
        SubsurfFileInfo info;
        uint32_t later[4];
    } newer = {{.struct_size = sizeof newer}, {7, 7, 7, 7}};
    uint64_t words[64] = {0};
    uint32_t texel;
    float rgb[3], pdf;

    EXPECT(subsurf_abi_version() == SUBSURF_ABI_VERSION);
    FAILS(INVALID_ARGUMENT, "file_out is null", subsurf_file_open_path(bssrdf_path, NULL));
    FAILS(INVALID_ARGUMENT, "path is null", subsurf_file_open_path(NULL, &none));
    FAILS(INVALID_ARGUMENT, "bytes is null", subsurf_file_open_memory(NULL, 3, &none));
    FAILS(IO, "/nowhere/x.subsurf: open: ", subsurf_file_open_path("/nowhere/x.subsurf", &none));
    FAILS(IO, "regular", subsurf_file_open_path("/", &none));
    FAILS(IO, "fstat", subsurf_file_open_fd(-1, 0, SUBSURF_TO_END, &none));
    FAILS(INVALID_FILE, "not a .subsurf file", subsurf_file_open_memory("text", 4, &none));
    EXPECT(none == NULL);

    FAILS(INVALID_ARGUMENT, "file is null", subsurf_file_info(NULL, &info));
    FAILS(INVALID_ARGUMENT, "info is null", subsurf_file_info(bssrdf, NULL));
    FAILS(INVALID_ARGUMENT, "is not a SubsurfFile", subsurf_file_info((const SubsurfFile *)words, &info));
    FAILS(INVALID_ARGUMENT, "is not a SubsurfFile", subsurf_file_info((const SubsurfFile *)((char *)words + 1), &info));
    info.struct_size = 4;
    FAILS(INVALID_ARGUMENT, "sizeof(SubsurfFileInfo)", subsurf_file_info(bssrdf, &info));
    OK(subsurf_file_info(bssrdf, &newer.info));
    EXPECT(newer.info.struct_size == sizeof newer && newer.info.family == SUBSURF_FAMILY_BSSRDF && newer.later[0] == 7);

    FAILS(WRONG_FAMILY, "nested BTF, expected is a BSSRDF", subsurf_bssrdf_info(nested, &patch));
    FAILS(WRONG_FAMILY, "BSSRDF, expected is a BTF", subsurf_btf_info(bssrdf, &btf));
    FAILS(WRONG_FAMILY, "BSSRDF", subsurf_btf_eval(bssrdf, 0, LIGHT, VIEW, rgb));
    FAILS(WRONG_FAMILY, "BSSRDF", subsurf_btf_expand(bssrdf));
    FAILS(WRONG_FAMILY, "factored", subsurf_bssrdf_rd(factored, 0, 0, 0, 0, rgb));
    FAILS(WRONG_FAMILY, "factored BTF, expected is a nested", subsurf_btf_pdf(factored, 0, LIGHT, VIEW, &pdf));
    FAILS(NOT_EXPANDED, "subsurf_btf_expand", subsurf_btf_eval(factored, 0, LIGHT, VIEW, rgb));
    OK(subsurf_bssrdf_info(bssrdf, &patch));
    FAILS(INVALID_ARGUMENT, "number is", subsurf_bssrdf_plane(bssrdf, patch.planes, &plane));
    OK(subsurf_btf_info(nested, &btf));
    FAILS(INVALID_ARGUMENT, "texel is", subsurf_btf_eval(nested, btf.texels, LIGHT, VIEW, rgb));
    FAILS(INVALID_ARGUMENT, "no level 0 of a material 1000", subsurf_btf_texel(nested, 1000, 0, 0, 0, &texel));
    FAILS(INVALID_ARGUMENT, "no level 300", subsurf_btf_texel(nested, 0, 300, 0, 0, &texel));
    FAILS(INVALID_ARGUMENT, "length is", subsurf_file_open_memory(words, SIZE_MAX, &none));
    FAILS(INVALID_ARGUMENT, "light is null", subsurf_btf_eval(nested, 0, NULL, VIEW, rgb));
    FAILS(INVALID_ARGUMENT, "value is null", subsurf_btf_eval(nested, 0, LIGHT, VIEW, NULL));
    FAILS(INVALID_ARGUMENT, "rd is null", subsurf_bssrdf_rd(bssrdf, 0, 0, 0, 0, NULL));

    subsurf_file_close(NULL);
    subsurf_file_close((SubsurfFile *)words);
    subsurf_file_close(bssrdf);
    subsurf_file_close(nested);
    subsurf_file_close(factored);
}

/* Cut at every length, in memory of exactly that length, and with every byte changed. */
static void hostile(const char *path) {
    size_t length;
    unsigned char *whole = read_file(path, &length);
    for (size_t cut = 0; cut < length; cut++) {
        unsigned char *bytes = malloc(cut > 0 ? cut : 1);
        SubsurfFile *file = NULL;
        memcpy(bytes, whole, cut);
        EXPECT(subsurf_file_open_memory(bytes, cut, &file) == SUBSURF_STATUS_INVALID_FILE && file == NULL);
        EXPECT(subsurf_last_error()[0] != 0 && strchr(subsurf_last_error(), '\n') == NULL);
        free(bytes);
    }
    for (size_t at = 0; at < length; at++) {
        SubsurfFile *file = NULL;
        whole[at] ^= 0x81;
        if (subsurf_file_open_memory(whole, length, &file) == SUBSURF_STATUS_OK) {
            show_all(file);
        }
        subsurf_file_close(file);
        whole[at] ^= 0x81;
    }
    free(whole);
}

static long lines_of(const char *path) {
    FILE *stream = fopen(path, "r");
    long lines = 0;
    for (int c; stream != NULL && (c = fgetc(stream)) != EOF;) {
        lines += c == '\n';
    }
    if (stream != NULL) {
        fclose(stream);
    }
    return lines;
}

static long resident_pages(void) {
    FILE *stream = fopen("/proc/self/statm", "r");
    long pages = 0;
    if (stream != NULL) {
        EXPECT(fscanf(stream, "%*d %ld", &pages) == 1);
        fclose(stream);
    }
    return pages;
}

/* Opens, evaluates and closes a file in all ways; as an asset it stands between other bytes. */
static void cycle(const char *path, const char *asset_path) {
    size_t length;
    unsigned char *bytes = read_file(path, &length);
    int fd = open(asset_path, O_RDONLY);
    SubsurfFile *files[3];
    const void *first;
    size_t first_length;
    OK(subsurf_file_open_memory(bytes, length, &files[0]));
    OK(subsurf_file_open_path(path, &files[1]));
    OK(subsurf_file_open_fd(fd, 5001, length, &files[2]));
    close(fd);
    /* What is in memory is read where it is. */
    OK(subsurf_file_bytes(files[0], &first, &first_length));
    EXPECT(first == bytes && first_length == length);
    for (int k = 0; k < 3; k++) {
        show_all(files[k]);
        subsurf_file_close(files[k]);
    }
    FAILS(INVALID_FILE, "file is cut", subsurf_file_open_memory(bytes, 5, &files[0]));
    free(bytes);
}

static void cycles(int count, long most_pages, const char *path, const char *asset_path) {
    long maps = 0, pages = 0;
    int next_fd = open(path, O_RDONLY);
    close(next_fd);
    for (int k = 0; k < count; k++) {
        if (k == count / 10) {
            maps = lines_of("/proc/self/maps");
            pages = resident_pages();
        }
        cycle(path, asset_path);
    }
    EXPECT(lines_of("/proc/self/maps") <= maps);
    EXPECT(resident_pages() <= pages + most_pages);
    EXPECT(open(path, O_RDONLY) == next_fd);
}

int main(int argc, char **argv) {
    EXPECT(argc >= 3);
    if (strcmp(argv[1], "values") == 0) {
        SubsurfFile *file = open_path(argv[2]);
        show_all(file);
        subsurf_file_close(file);
    } else if (strcmp(argv[1], "misuse") == 0) {
        misuse(argv[2], argv[3], argv[4]);
    } else if (strcmp(argv[1], "hostile") == 0) {
        hostile(argv[2]);
    } else {
        cycles(atoi(argv[2]), atol(argv[3]), argv[4], argv[5]);
    }
    return 0;
}
