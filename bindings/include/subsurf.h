/* subsurf.h: .subsurf files for programs in C and C++.
 *
 * libsubsurf_decoder opens, describes and evaluates files, and draws nothing. libsubsurf has its functions too, and those of the
 * renderer: define SUBSURF_DECODER_ONLY before this header, and only those of libsubsurf_decoder are declared.
 *
 * Handles are opaque. Calls return a SubsurfStatus; after one that is not SUBSURF_STATUS_OK, subsurf_last_error says in one line what
 * was wrong, and nothing was written. Doc comments name statuses without their prefix. Pointers of arguments may have any
 * alignment and must not be null. Structs begin with struct_size, which the caller sets to its own sizeof, so that later
 * versions can append fields. Handles may be closed in any order: each keeps what it needs. No panic or exception leaves a function.
 *
 * Written by cbindgen from bindings/c/src and bindings/draw/src; scripts/lint compares it. */

#ifndef SUBSURF_H
#define SUBSURF_H

#include <stddef.h>
#include <stdint.h>

/**
 * Version of the functions and structs of this header: the major number in the upper 16 bits, the minor one in the lower.
 *
 * The major number grows when something that was there changes, the minor one when something is added.
 */
#define SUBSURF_ABI_VERSION 65536

/**
 * Length that stands for all bytes from an offset to the end of the file.
 */
#define SUBSURF_TO_END UINT64_MAX

/**
 * Outcome of a call. After all but `SUBSURF_STATUS_OK`, `subsurf_last_error` says what was wrong, and nothing was written to
 * what the caller pointed to. Later versions may add others.
 */
enum SubsurfStatus
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The call did what it is for.
   */
  SUBSURF_STATUS_OK = 0,
  /**
   * A pointer is null, a handle is none, a `struct_size` is too small, or a number is out of range: the program is wrong.
   */
  SUBSURF_STATUS_INVALID_ARGUMENT = 1,
  /**
   * The operating system did not open or map the file.
   */
  SUBSURF_STATUS_IO = 2,
  /**
   * The bytes are not a sound `.subsurf` file, or one of a later format.
   */
  SUBSURF_STATUS_INVALID_FILE = 3,
  /**
   * The function is for files of another family, or model.
   */
  SUBSURF_STATUS_WRONG_FAMILY = 4,
  /**
   * There is not enough memory.
   */
  SUBSURF_STATUS_OUT_OF_MEMORY = 5,
  /**
   * The file is a factored BTF: call `subsurf_btf_expand` first.
   */
  SUBSURF_STATUS_NOT_EXPANDED = 6,
  /**
   * The budget of a renderer, or what is left of it, is too small for the picture; nothing was allocated.
   */
  SUBSURF_STATUS_OVER_BUDGET = 7,
  /**
   * The device cannot hold something of that size, or draw it; the text says which.
   */
  SUBSURF_STATUS_UNSUPPORTED = 8,
  /**
   * There is no such device.
   */
  SUBSURF_STATUS_NO_DEVICE = 9,
  /**
   * The device or its driver failed: another backend may do better.
   */
  SUBSURF_STATUS_DEVICE_FAILED = 10,
  /**
   * The device is lost, as by a reset of its driver: close what was made on it, open it again, load again.
   */
  SUBSURF_STATUS_DEVICE_LOST = 11,
  /**
   * The mesh is broken or empty, or lacks what its material needs.
   */
  SUBSURF_STATUS_INVALID_MESH = 12,
  /**
   * The window shows no pictures any more: close its surface, and open one of the window that is there now.
   */
  SUBSURF_STATUS_SURFACE_LOST = 13,
  /**
   * The window takes no picture at present, as when it is covered: try again later.
   */
  SUBSURF_STATUS_SKIPPED = 14,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum SubsurfStatus SubsurfStatus;
#else
typedef int32_t SubsurfStatus;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What a file holds, which says what functions take it.
 */
enum SubsurfFamily
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Of a kind that this header does not know.
   */
  SUBSURF_FAMILY_OTHER = 0,
  /**
   * Diffuse BSSRDF of a patch: `subsurf_bssrdf_*`.
   */
  SUBSURF_FAMILY_BSSRDF = 1,
  /**
   * Bidirectional texture functions in nested codebooks: `subsurf_btf_*`.
   */
  SUBSURF_FAMILY_NESTED_BTF = 2,
  /**
   * Bidirectional texture functions as factors: `subsurf_btf_*`, after `subsurf_btf_expand`.
   */
  SUBSURF_FAMILY_FACTORED_BTF = 3,
  /**
   * Separable kernel of a homogeneous material.
   */
  SUBSURF_FAMILY_KERNEL = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum SubsurfFamily SubsurfFamily;
#else
typedef uint32_t SubsurfFamily;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Encoding of the mixtures of a patch.
 */
enum SubsurfCoding
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Single-precision ratios, and an index for each base material of a pixel.
   */
  SUBSURF_CODING_EXACT = 0,
  /**
   * Two base materials, the ratio in 8 bits: 24 bits per pixel.
   */
  SUBSURF_CODING_SMALL_RATIOS = 1,
  /**
   * Two base materials by a palette of pairs, the ratio in 5 bits: 16 bits per pixel.
   */
  SUBSURF_CODING_PALETTE = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum SubsurfCoding SubsurfCoding;
#else
typedef uint32_t SubsurfCoding;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What lies beyond the border of a patch.
 */
enum SubsurfAddressing
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The border pixel goes on: GL_CLAMP_TO_EDGE.
   */
  SUBSURF_ADDRESSING_CLAMP = 0,
  /**
   * The patch repeats: GL_REPEAT.
   */
  SUBSURF_ADDRESSING_REPEAT = 1,
  /**
   * The patch repeats, every other copy reflected: GL_MIRRORED_REPEAT.
   */
  SUBSURF_ADDRESSING_MIRROR = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum SubsurfAddressing SubsurfAddressing;
#else
typedef uint32_t SubsurfAddressing;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What the numbers of a plane are.
 */
enum SubsurfPlaneKind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Log-scale base scattering profiles: a row for each base material, a column for each node; natural log of mm^-2 in R, G, B,
   * linear Rec. 709, within -87 to 87.
   */
  SUBSURF_PLANE_KIND_BASE_PROFILES = 0,
  /**
   * Log-scale local scattering profiles: layer 3 h + c has node h of channel c for each pixel; natural log of mm^-2.
   */
  SUBSURF_PLANE_KIND_LOCAL_PROFILES = 1,
  /**
   * Mixture ratios t, 0 to 1. For K = 2, t of the first base material, 1 - t of the second; for K = 3 and 5, layer k has t_k.
   */
  SUBSURF_PLANE_KIND_MIXTURE_RATIOS = 2,
  /**
   * Base-material indices. For K = 2 both in R and G; for K = 1, 3 and 5, layer k has b_k.
   */
  SUBSURF_PLANE_KIND_BASE_INDICES = 3,
  /**
   * Palette of pairs: the two base materials in R and G, a column for each pair, at most 2,048.
   */
  SUBSURF_PLANE_KIND_PAIRS = 4,
  /**
   * Palette codes: the number of the pair in the lower 11 bits, 31 t of its first base material in the upper 5.
   */
  SUBSURF_PLANE_KIND_CODES = 5,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum SubsurfPlaneKind SubsurfPlaneKind;
#else
typedef uint32_t SubsurfPlaneKind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Format of the texels of a plane. Numbers are little-endian.
 */
enum SubsurfFormat
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * GL_R32F, VK_FORMAT_R32_SFLOAT.
   */
  SUBSURF_FORMAT_R32_FLOAT = 0,
  /**
   * GL_RGB32F, VK_FORMAT_R32G32B32_SFLOAT; three texels of GL_R32F each, where a device has no such textures.
   */
  SUBSURF_FORMAT_RGB32_FLOAT = 1,
  /**
   * GL_RGB16F, VK_FORMAT_R16G16B16_SFLOAT; three texels of GL_R16F each, where a device has no such textures.
   */
  SUBSURF_FORMAT_RGB16_FLOAT = 2,
  /**
   * GL_R8, VK_FORMAT_R8_UNORM.
   */
  SUBSURF_FORMAT_R8_UNORM = 3,
  /**
   * GL_R8UI, VK_FORMAT_R8_UINT.
   */
  SUBSURF_FORMAT_R8_UINT = 4,
  /**
   * GL_RG8UI, VK_FORMAT_R8G8_UINT.
   */
  SUBSURF_FORMAT_RG8_UINT = 5,
  /**
   * GL_R16UI, VK_FORMAT_R16_UINT.
   */
  SUBSURF_FORMAT_R16_UINT = 6,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum SubsurfFormat SubsurfFormat;
#else
typedef uint32_t SubsurfFormat;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Checked `.subsurf` file of any family.
 *
 * Ownership: `subsurf_file_open_*` give one, `subsurf_file_close` takes it back.
 * Threads: any number at once, but for `subsurf_btf_expand` and `subsurf_file_close`, which need the file for themselves.
 */
typedef struct SubsurfFile SubsurfFile;

/**
 * Description of a file of any family. Set `struct_size` to `sizeof(SubsurfFileInfo)` before it is filled.
 */
typedef struct {
  /**
   * Bytes of the caller's struct.
   */
  uint32_t struct_size;
  /**
   * What the file holds.
   */
  SubsurfFamily family;
  /**
   * Bytes of the file.
   */
  uint64_t file_bytes;
} SubsurfFileInfo;

/**
 * Description of a BSSRDF. Set `struct_size` to `sizeof(SubsurfBssrdfInfo)` before it is filled.
 */
typedef struct {
  /**
   * Bytes of the caller's struct.
   */
  uint32_t struct_size;
  /**
   * K, the number of base materials of a pixel: 1, 2, 3 or 5; 0 where each pixel has a profile of its own.
   */
  uint32_t bases_per_pixel;
  /**
   * Encoding of mixtures; `EXACT` but for K = 2.
   */
  SubsurfCoding coding;
  /**
   * What lies beyond the border.
   */
  SubsurfAddressing addressing;
  /**
   * Pixels in x, 1 to 65,535.
   */
  uint32_t width;
  /**
   * Pixels in y, 1 to 65,535.
   */
  uint32_t height;
  /**
   * R in pixels: Rd is 0 between pixels further apart in x or in y; at most 1,023.
   */
  uint32_t window_radius;
  /**
   * S, the nodes of a profile, 2 to 4,096; node h is at r = h * r_max_mm / (S - 1).
   */
  uint32_t samples;
  /**
   * M, the number of base materials, 1 to 65,536; 0 where each pixel has a profile of its own.
   */
  uint32_t base_materials;
  /**
   * Bits that a pixel takes, 16 to 200; 96 S where it has a profile of its own.
   */
  uint32_t bits_per_pixel;
  /**
   * Number of planes that `subsurf_bssrdf_plane` gives.
   */
  uint32_t planes;
  /**
   * Distance of neighbouring pixels in mm.
   */
  float pitch_mm;
  /**
   * Radius of the last node in mm; Rd is 0 beyond it.
   */
  float r_max_mm;
  /**
   * Refractive index of the material against air, 1 to 4.
   */
  float eta;
} SubsurfBssrdfInfo;

/**
 * Description of a BTF. Set `struct_size` to `sizeof(SubsurfBtfInfo)` before it is filled.
 */
typedef struct {
  /**
   * Bytes of the caller's struct.
   */
  uint32_t struct_size;
  /**
   * Number of materials, 1 to 255.
   */
  uint32_t materials;
  /**
   * Number of texels of all levels of all materials.
   */
  uint32_t texels;
  /**
   * Whether values are display values of sRGB, 0 to 1; else they are linear.
   */
  uint32_t is_display;
  /**
   * Nodes of alpha, 2 to 64, from -alpha_max to alpha_max.
   */
  uint32_t n_alpha;
  /**
   * Nodes of sin beta, 2 to 64, from -sin_beta_max to sin_beta_max.
   */
  uint32_t n_beta;
  /**
   * Nodes of the view's angle from the normal, 2 to 64, from 0 to theta_max.
   */
  uint32_t n_theta;
  /**
   * Nodes of the view's azimuth, 1 to 64, once around.
   */
  uint32_t n_phi;
  /**
   * Largest alpha in rad, to pi / 2.
   */
  float alpha_max;
  /**
   * Largest sin beta, to 1.
   */
  float sin_beta_max;
  /**
   * Largest angle of the view from the normal in rad, to pi / 2.
   */
  float theta_max;
  /**
   * Cosine of the angle between the normal and the lowest light that was measured; lower ones fade to black.
   */
  float cos_light_min;
  /**
   * Bytes that `subsurf_btf_expand` takes from the heap; 0 where it takes none.
   */
  uint64_t expansion_bytes;
} SubsurfBtfInfo;

/**
 * One material of a BTF. Set `struct_size` to `sizeof(SubsurfBtfMaterial)` before it is filled.
 */
typedef struct {
  /**
   * Bytes of the caller's struct.
   */
  uint32_t struct_size;
  /**
   * Texels in x of level 0, 1 to 65,535.
   */
  uint32_t width;
  /**
   * Texels in y of level 0, 1 to 65,535.
   */
  uint32_t height;
  /**
   * Mipmap levels, 1 to 16; each is half as large as the one before it, rounded down, and at least one texel.
   */
  uint32_t levels;
  /**
   * Name in UTF-8, zero-terminated; at most 24 bytes.
   */
  char name[32];
} SubsurfBtfMaterial;

/**
 * One plane of a BSSRDF, ready for glTexSubImage2D or 3D, or for a buffer that vkCmdCopyBufferToImage reads.
 *
 * Rows follow each other without gaps, and so do layers: set GL_UNPACK_ALIGNMENT to 1, bufferRowLength and bufferImageHeight
 * to 0. Set `struct_size` to `sizeof(SubsurfPlane)` before it is filled.
 */
typedef struct {
  /**
   * Bytes of the caller's struct.
   */
  uint32_t struct_size;
  /**
   * What the numbers are.
   */
  SubsurfPlaneKind kind;
  /**
   * Format of a texel.
   */
  SubsurfFormat format;
  /**
   * Texels in x.
   */
  uint32_t width;
  /**
   * Texels in y.
   */
  uint32_t height;
  /**
   * Layers of an array; 1 where it is a single picture.
   */
  uint32_t layers;
  /**
   * Bytes of a row.
   */
  uint32_t row_bytes;
  /**
   * Internal format for glTexStorage2D.
   */
  uint32_t gl_internal_format;
  /**
   * Format for glTexSubImage2D.
   */
  uint32_t gl_format;
  /**
   * Type for glTexSubImage2D.
   */
  uint32_t gl_type;
  /**
   * VkFormat.
   */
  uint32_t vk_format;
  /**
   * Bytes of a layer.
   */
  uint64_t layer_bytes;
  /**
   * Bytes of all layers.
   */
  uint64_t bytes;
  /**
   * First byte, of any alignment.
   */
  const void *data;
} SubsurfPlane;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Version of the library that is loaded, as `SUBSURF_ABI_VERSION`.
 *
 * It fits a program if its major number equals the header's, and it is not less than the header's.
 * Threads: any.
 */
uint32_t subsurf_abi_version(void);

/**
 * Text of the last call of this thread that failed: one line in UTF-8 that says what is wrong and what is expected; empty
 * before the first.
 *
 * Ownership: the library's; valid until the next call of this thread that fails, or the thread's end. Never null.
 * Threads: each has its own text.
 */
const char *subsurf_last_error(void);

/**
 * Opens a file whose bytes are in memory: checks all of it, copies none.
 *
 * `bytes`: `length` bytes of any alignment; what follows the file is ignored. `*file_out`: the handle; only written on success.
 * Errors: `INVALID_ARGUMENT` (null; more bytes than memory can have), `INVALID_FILE`, `OUT_OF_MEMORY` (a handle takes about 2 kB).
 * Ownership: the bytes stay the caller's, who keeps them as they are until the file is closed.
 * Threads: any.
 */
SubsurfStatus subsurf_file_open_memory(const void *bytes,
                                       size_t length,
                                       SubsurfFile **file_out);

/**
 * Opens a part of a file by its descriptor, such as an asset inside an APK: maps it, copies nothing.
 *
 * `offset`: first byte, of any alignment; `length`: bytes, or `SUBSURF_TO_END`. On Android both come from
 * `AAsset_openFileDescriptor64` or `AssetFileDescriptor`, for an asset that is stored without compression.
 * `*file_out`: the handle; only written on success.
 * Errors: `INVALID_ARGUMENT` (null), `IO` (not a regular file, fewer bytes than asked for), `INVALID_FILE`, `OUT_OF_MEMORY`.
 * Ownership: the descriptor stays the caller's, who may close it at once. Who shortens the file while it is open ends the
 * process: replace files, do not rewrite them.
 * Threads: any.
 */
SubsurfStatus subsurf_file_open_fd(int fd,
                                   uint64_t offset,
                                   uint64_t length,
                                   SubsurfFile **file_out);

/**
 * Opens a file by its path: maps it, copies nothing.
 *
 * `path`: zero-terminated; on Windows in UTF-8. `*file_out`: the handle; only written on success.
 * Errors: `INVALID_ARGUMENT` (null), `IO`, `INVALID_FILE`, `OUT_OF_MEMORY`; the text of `IO` and `INVALID_FILE` begins with the path.
 * Ownership: the path is not needed afterwards. Who shortens the file while it is open ends the process: replace files, do
 * not rewrite them.
 * Threads: any.
 */
SubsurfStatus subsurf_file_open_path(const char *path,
                                     SubsurfFile **file_out);

/**
 * All bytes of an open file, as they are stored.
 *
 * `*bytes_out`, `*length_out`: where they are and how many; what followed the file in memory is not part of it.
 * Errors: `INVALID_ARGUMENT`.
 * Ownership: the bytes are the file's, or the caller's who opened them; valid until the file is closed.
 * Threads: any.
 */
SubsurfStatus subsurf_file_bytes(const SubsurfFile *file, const void **bytes_out, size_t *length_out);

/**
 * Closes a file. Null is ignored, and so is what is no handle.
 *
 * Ownership: the handle is gone, and so are pointers to planes of it, but for bytes that are the caller's.
 * Threads: any, once no other uses the file.
 */
void subsurf_file_close(SubsurfFile *file);

/**
 * Family and size of a file.
 *
 * `info`: filled as far as its `struct_size` reaches.
 * Errors: `INVALID_ARGUMENT`.
 * Ownership: the struct is the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_file_info(const SubsurfFile *file, SubsurfFileInfo *info);

/**
 * Size, units and model of a BSSRDF.
 *
 * `info`: filled as far as its `struct_size` reaches.
 * Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`.
 * Ownership: the struct is the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_bssrdf_info(const SubsurfFile *file, SubsurfBssrdfInfo *info);

/**
 * Materials, directions and values of a BTF.
 *
 * `info`: filled as far as its `struct_size` reaches.
 * Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`.
 * Ownership: the struct is the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_btf_info(const SubsurfFile *file, SubsurfBtfInfo *info);

/**
 * Name and size of a material of a BTF.
 *
 * `number`: from 0, below `SubsurfBtfInfo::materials`. `material`: filled as far as its `struct_size` reaches.
 * Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`.
 * Ownership: the struct is the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_btf_material(const SubsurfFile *file, uint32_t number, SubsurfBtfMaterial *material);

/**
 * Plane of a BSSRDF: its bytes as they stand in the file, and the texture that they are.
 *
 * `number`: from 0, below `SubsurfBssrdfInfo::planes`. `plane`: filled as far as its `struct_size` reaches.
 * Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`.
 * Ownership: the struct is the caller's; what `data` points to is as the bytes of `subsurf_file_bytes`.
 * Threads: any.
 */
SubsurfStatus subsurf_bssrdf_plane(const SubsurfFile *file, uint32_t number, SubsurfPlane *plane);

/**
 * Diffuse reflectance Rd in mm^-2, linear Rec. 709, of light that enters at one pixel and leaves at another
 * (Yatagawa et al. 2020, eq. 1).
 *
 * `x_i`, `y_i`: column and row where light enters; `x_o`, `y_o`: where it leaves. Pixels may lie outside the patch: the addressing
 * mode says what is there. `rd`: three numbers, R, G, B: finite, not negative, 0 outside the window and beyond r_max_mm.
 * Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`.
 * Ownership: `rd` is the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_bssrdf_rd(const SubsurfFile *file,
                                int32_t x_i,
                                int32_t y_i,
                                int32_t x_o,
                                int32_t y_o,
                                float *rd);

/**
 * Diffuse albedo of a pixel, dimensionless, linear Rec. 709: the sum of Rd * pitch_mm^2 over its window, which takes (2 R + 1)^2
 * evaluations.
 *
 * `x`, `y`: column and row, which may lie outside the patch. `albedo`: three numbers, R, G, B, not negative.
 * Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`.
 * Ownership: `albedo` is the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_bssrdf_albedo(const SubsurfFile *file,
                                    int32_t x,
                                    int32_t y,
                                    float *albedo);

/**
 * Undoes the compression of a factored BTF, into memory of `SubsurfBtfInfo::expansion_bytes`, so that it can be evaluated. Takes some
 * 10 ms. What is expanded, or a nested BTF, stays as it is.
 *
 * Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`, `OUT_OF_MEMORY`. A hostile file may ask for gigabytes: look at `expansion_bytes` first.
 * Ownership: the memory is the file's.
 * Threads: the only one that uses the file.
 */
SubsurfStatus subsurf_btf_expand(SubsurfFile *file);

/**
 * Number of a texel, for the functions that take one.
 *
 * `material`: from 0, below `SubsurfBtfInfo::materials`; `level`: mipmap level, below `SubsurfBtfMaterial::levels`; `x`, `y`: column and row,
 * which repeat. `*texel_out`: below `SubsurfBtfInfo::texels`; texels of a level follow each other row by row.
 * Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`.
 * Ownership: `texel_out` is the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_btf_texel(const SubsurfFile *file,
                                uint32_t material,
                                uint32_t level,
                                int32_t x,
                                int32_t y,
                                uint32_t *texel_out);

/**
 * Value of a texel as images have it: pi times the radiance under light of unit irradiance on a plane that faces it, so that white
 * paper has the cosine of the light's angle. For display values (`SubsurfBtfInfo::is_display`) `subsurf_btf_linear` makes it linear.
 *
 * `light`, `view`: three numbers, unit vectors towards light and eye: x along the rows, y down the columns, z the normal.
 * `value`: three numbers, R, G, B, not negative; 0 under lights below the horizon.
 * Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`, `NOT_EXPANDED`.
 * Ownership: `value` is the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_btf_eval(const SubsurfFile *file,
                               uint32_t texel,
                               const float *light,
                               const float *view,
                               float *value);

/**
 * Linear Rec. 709 of a value that `subsurf_btf_eval` gave: `value` and `rgb` are three numbers each, and may be the same.
 *
 * Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY`.
 * Ownership: both are the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_btf_linear(const SubsurfFile *file,
                                 const float *value,
                                 float *rgb);

/**
 * Light to look for next, for two random numbers: nested BTFs draw lights in proportion to the luma of the texel
 * (Havran et al. 2010, section 5.2).
 *
 * `view`: three numbers, a unit vector towards the eye. `random`: two numbers, 0 to 1; the light moves on without jumps as they grow.
 * `light`: three numbers, a unit vector with z >= 0. `*pdf`: density there, per steradian, above 0.
 * Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY` (also of factored BTFs).
 * Ownership: `light` and `pdf` are the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_btf_sample(const SubsurfFile *file,
                                 uint32_t texel,
                                 const float *view,
                                 const float *random,
                                 float *light,
                                 float *pdf);

/**
 * Density with which `subsurf_btf_sample` draws a light, per steradian; 0 below the horizon.
 *
 * `light`, `view`: three numbers, unit vectors.
 * Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY` (also of factored BTFs).
 * Ownership: `pdf` is the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_btf_pdf(const SubsurfFile *file,
                              uint32_t texel,
                              const float *light,
                              const float *view,
                              float *pdf);

/**
 * Albedo of a texel towards the eye, linear Rec. 709: the radiance that it has under light of radiance 1 from all sides, by some
 * 900 evaluations.
 *
 * `view`: three numbers, a unit vector. `albedo`: three numbers, R, G, B, not negative.
 * Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY` (also of factored BTFs).
 * Ownership: `albedo` is the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_btf_albedo(const SubsurfFile *file,
                                 uint32_t texel,
                                 const float *view,
                                 float *albedo);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#ifndef SUBSURF_DECODER_ONLY

/**
 * Graphics API.
 */
enum SubsurfBackend
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The first that has a device: Vulkan before OpenGL ES; Direct3D 12 before both.
   */
  SUBSURF_BACKEND_AUTOMATIC = 0,
  /**
   * Vulkan.
   */
  SUBSURF_BACKEND_VULKAN = 1,
  /**
   * OpenGL ES 3.0 and newer.
   */
  SUBSURF_BACKEND_GL = 2,
  /**
   * Metal, of Apple's systems.
   */
  SUBSURF_BACKEND_METAL = 3,
  /**
   * Direct3D 12, of Windows.
   */
  SUBSURF_BACKEND_DX12 = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum SubsurfBackend SubsurfBackend;
#else
typedef uint32_t SubsurfBackend;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Technique by which a material is drawn.
 */
enum SubsurfTechnique
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The fastest that the file offers: separable blurs where it has a basis for them, else splats; BTFs and kernels as they are.
   */
  SUBSURF_TECHNIQUE_AUTOMATIC = 0,
  /**
   * Multiresolution splats, of BSSRDFs: closer to the reference in most scenes, and slower.
   */
  SUBSURF_TECHNIQUE_SPLAT = 1,
  /**
   * Separable blurs on the screen, of BSSRDFs whose file has a basis for them.
   */
  SUBSURF_TECHNIQUE_SEPARABLE = 2,
  /**
   * BTFs.
   */
  SUBSURF_TECHNIQUE_BTF = 3,
  /**
   * Separable kernels of homogeneous materials.
   */
  SUBSURF_TECHNIQUE_KERNEL = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum SubsurfTechnique SubsurfTechnique;
#else
typedef uint32_t SubsurfTechnique;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Window system whose windows are drawn to.
 */
enum SubsurfWindowSystem
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * None: pictures alone.
   */
  SUBSURF_WINDOW_SYSTEM_NONE = 0,
  /**
   * Android: windows are `ANativeWindow *`; there is no display.
   */
  SUBSURF_WINDOW_SYSTEM_ANDROID = 1,
  /**
   * X11 by Xlib: displays are `Display *`, windows are `Window`. Threads that draw need `XInitThreads`.
   */
  SUBSURF_WINDOW_SYSTEM_X11 = 2,
  /**
   * Wayland: displays are `wl_display *`, windows are `wl_surface *`.
   */
  SUBSURF_WINDOW_SYSTEM_WAYLAND = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum SubsurfWindowSystem SubsurfWindowSystem;
#else
typedef uint32_t SubsurfWindowSystem;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Shape that needs no file.
 */
enum SubsurfShape
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Sphere; u goes around, v from pole to pole.
   */
  SUBSURF_SHAPE_SPHERE = 0,
  /**
   * Ring.
   */
  SUBSURF_SHAPE_TORUS = 1,
  /**
   * Knot of a tube: thin and thick places close to each other.
   */
  SUBSURF_SHAPE_KNOT = 2,
  /**
   * Bowl with a wall to shine through.
   */
  SUBSURF_SHAPE_BOWL = 3,
  /**
   * Cloth over a ball, in folds.
   */
  SUBSURF_SHAPE_DRAPERY = 4,
  /**
   * Sphere with bumps and hollows.
   */
  SUBSURF_SHAPE_RELIEF = 5,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum SubsurfShape SubsurfShape;
#else
typedef uint32_t SubsurfShape;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Kind of a light.
 */
enum SubsurfLightKind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * From afar: `place` is the direction towards it, of any length but 0.
   */
  SUBSURF_LIGHT_KIND_DIRECTIONAL = 0,
  /**
   * From a point, all around: what it lights should be within 75 degrees of the direction to the middle of the objects.
   */
  SUBSURF_LIGHT_KIND_POINT = 1,
  /**
   * From a point into a cone around the line to `target_mm`, which fades over its outer tenth.
   */
  SUBSURF_LIGHT_KIND_SPOT = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum SubsurfLightKind SubsurfLightKind;
#else
typedef uint32_t SubsurfLightKind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Rule by which a material lies on a mesh.
 */
enum SubsurfMapping
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Texture coordinates: the unit square of them shows `copies` of the material in u and in v.
   */
  SUBSURF_MAPPING_UV = 0,
  /**
   * In its own size, from the side of a box that each normal faces most; not for BTFs, which have no size.
   */
  SUBSURF_MAPPING_BOX = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum SubsurfMapping SubsurfMapping;
#else
typedef uint32_t SubsurfMapping;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Light from all around, far away; on no device.
 *
 * Ownership: `subsurf_environment_*` give one, `subsurf_environment_close` takes it back.
 * Threads: any number at once, but for `subsurf_environment_close`, which needs the handle for itself.
 */
typedef struct SubsurfEnvironment SubsurfEnvironment;

/**
 * Device that draws, with its queue.
 *
 * Ownership: `subsurf_gpu_open` gives one, `subsurf_gpu_close` takes it back; what was made on it keeps what it needs.
 * Threads: any number at once, but for `subsurf_gpu_close`, which needs the handle for itself.
 */
typedef struct SubsurfGpu SubsurfGpu;

/**
 * Material on a device: what was uploaded of a file.
 *
 * Ownership: `subsurf_material_load` gives one, `subsurf_material_close` takes it back; it keeps its device, not its file.
 * Threads: any number at once, but for `subsurf_material_close`, which needs the handle for itself.
 */
typedef struct SubsurfMaterial SubsurfMaterial;

/**
 * Triangle mesh on a device.
 *
 * Ownership: `subsurf_mesh_*` give one, `subsurf_mesh_close` takes it back; it keeps its device.
 * Threads: any number at once, but for `subsurf_mesh_close`, which needs the handle for itself.
 */
typedef struct SubsurfMesh SubsurfMesh;

/**
 * Picture on a device, of 8 bits to red, green, blue and coverage.
 *
 * Ownership: `subsurf_picture_create` gives one, `subsurf_picture_close` takes it back; it keeps its device.
 * Threads: any, one at a time.
 */
typedef struct SubsurfPicture SubsurfPicture;

/**
 * Renderer: pipelines of techniques, and room for the frames of one size: depth, maps, what lights see.
 *
 * Pipelines are compiled, and room is made, by the first frame that needs them; another size, material, shadow or distance of the camera
 * takes other room. Pictures and windows that are drawn in turns have a renderer each.
 *
 * Ownership: `subsurf_renderer_create` gives one, `subsurf_renderer_close` takes it back; it keeps its device, and materials that it drew until
 * they are closed and another frame is drawn.
 * Threads: any, one at a time.
 */
typedef struct SubsurfRenderer SubsurfRenderer;

/**
 * Window to draw to. An app on Android closes it when it is paused or its surface is destroyed, before that call returns, and opens another
 * when it comes back; device, materials, meshes and renderers stay.
 *
 * Ownership: `subsurf_surface_open` gives one, `subsurf_surface_close` takes it back; it keeps its device.
 * Threads: any, one at a time.
 */
typedef struct SubsurfSurface SubsurfSurface;

/**
 * How a device is opened. Set `struct_size` to `sizeof(SubsurfGpuOptions)`; zeros are the usual choice.
 */
typedef struct {
  /**
   * Bytes of the caller's struct.
   */
  uint32_t struct_size;
  /**
   * A `SubsurfBackend`.
   */
  uint32_t backend;
  /**
   * A `SubsurfWindowSystem`: whose windows surfaces will be opened of.
   */
  uint32_t window_system;
  /**
   * Display of X11 or Wayland, which the caller keeps open until everything of the device is closed; null for others.
   */
  void *display;
} SubsurfGpuOptions;

/**
 * Description of a device. Set `struct_size` to `sizeof(SubsurfGpuInfo)` before it is filled.
 */
typedef struct {
  /**
   * Bytes of the caller's struct.
   */
  uint32_t struct_size;
  /**
   * Graphics API.
   */
  SubsurfBackend backend;
  /**
   * Whether the processor draws, without a graphics card.
   */
  uint32_t is_software;
  /**
   * Whether half floats can be drawn to: light is kept in them; without them, splats are not drawn.
   */
  uint32_t draws_half_floats;
  /**
   * Most texels to a side of a texture.
   */
  uint32_t most_texels;
  /**
   * Name of the device in UTF-8, zero-terminated, cut if it is longer.
   */
  char device[128];
  /**
   * Name and version of its driver, likewise.
   */
  char driver[256];
} SubsurfGpuInfo;

/**
 * Bytes on a device by their purpose: textures and buffers as they were asked for; what drivers add is not known. Set
 * `struct_size` to `sizeof(SubsurfGpuMemory)` before it is filled.
 */
typedef struct {
  /**
   * Bytes of the caller's struct.
   */
  uint32_t struct_size;
  /**
   * Tables and maps of materials.
   */
  uint64_t materials_bytes;
  /**
   * Vertices and triangles.
   */
  uint64_t meshes_bytes;
  /**
   * What lights see.
   */
  uint64_t light_views_bytes;
  /**
   * Maps and blocks of frames.
   */
  uint64_t frames_bytes;
  /**
   * Pictures, depth, and what is on its way to or from the device.
   */
  uint64_t others_bytes;
} SubsurfGpuMemory;

/**
 * How a material is loaded. Set `struct_size` to `sizeof(SubsurfMaterialOptions)`; zeros are the usual choice.
 */
typedef struct {
  /**
   * Bytes of the caller's struct.
   */
  uint32_t struct_size;
  /**
   * A `SubsurfTechnique`.
   */
  uint32_t technique;
} SubsurfMaterialOptions;

/**
 * What a load took. Set `struct_size` to `sizeof(SubsurfLoadReport)` before it is filled. Reading and checking of the file are done
 * when it is opened.
 */
typedef struct {
  /**
   * Bytes of the caller's struct.
   */
  uint32_t struct_size;
  /**
   * Bytes of the file.
   */
  uint64_t file_bytes;
  /**
   * Bytes of the material on the device.
   */
  uint64_t gpu_bytes;
  /**
   * Nanoseconds of the upload, until the device has everything.
   */
  uint64_t upload_ns;
  /**
   * Nanoseconds of pipelines that the load compiled: none but at the first load of a kind.
   */
  uint64_t pipelines_ns;
  /**
   * Nanoseconds of the processor for what is drawn at load: coefficients and albedo, from the planes of the file.
   */
  uint64_t recording_ns;
  /**
   * Nanoseconds of the same until the device has done it, with those of the processor.
   */
  uint64_t projection_ns;
} SubsurfLoadReport;

/**
 * Description of a material. Set `struct_size` to `sizeof(SubsurfMaterialInfo)` before it is filled.
 */
typedef struct {
  /**
   * Bytes of the caller's struct.
   */
  uint32_t struct_size;
  /**
   * Technique that draws it, never `AUTOMATIC`.
   */
  SubsurfTechnique technique;
  /**
   * Number of materials of a BTF; 1 for others.
   */
  uint32_t materials;
  /**
   * Bytes on the device.
   */
  uint64_t gpu_bytes;
} SubsurfMaterialInfo;

/**
 * Triangle mesh in memory. Set `struct_size` to `sizeof(SubsurfMeshData)`.
 */
typedef struct {
  /**
   * Bytes of the caller's struct.
   */
  uint32_t struct_size;
  /**
   * Number of vertices.
   */
  uint32_t vertices;
  /**
   * Number of triangles, 1 to 1,431,655,765.
   */
  uint32_t triangles;
  /**
   * Millimetres to a unit of positions; 0 stands for 1.
   */
  float mm_per_unit;
  /**
   * Three numbers for each vertex, x, y up, z.
   */
  const float *positions;
  /**
   * Three numbers for each vertex, of any length; null, or zeros for a vertex, for the means of the triangles around.
   */
  const float *normals;
  /**
   * Two numbers for each vertex, u and v upwards; null where materials lie by a box. BTFs need them.
   */
  const float *uvs;
  /**
   * Three numbers of vertices for each triangle, counter-clockwise as seen from outside.
   */
  const uint32_t *indices;
} SubsurfMeshData;

/**
 * Description of a mesh. Set `struct_size` to `sizeof(SubsurfMeshInfo)` before it is filled.
 */
typedef struct {
  /**
   * Bytes of the caller's struct.
   */
  uint32_t struct_size;
  /**
   * Number of vertices.
   */
  uint32_t vertices;
  /**
   * Number of triangles.
   */
  uint32_t triangles;
  /**
   * Whether it has texture coordinates.
   */
  uint32_t has_uvs;
  /**
   * Middle of the box around it, in mm.
   */
  float centre_mm[3];
  /**
   * Distance of the furthest vertex from there, in mm.
   */
  float radius_mm;
  /**
   * Bytes on the device.
   */
  uint64_t gpu_bytes;
} SubsurfMeshInfo;

/**
 * Source of light.
 */
typedef struct {
  /**
   * A `SubsurfLightKind`.
   */
  uint32_t kind;
  /**
   * Whether objects cast shadows of it, which takes 4 MiB on the device at the usual size.
   */
  uint32_t has_shadow;
  /**
   * Direction towards it, or its position in mm.
   */
  float place[3];
  /**
   * Point on the axis of a spot light, in mm.
   */
  float target_mm[3];
  /**
   * Angle from the axis of a spot light to the side of its cone in rad, to 75 degrees.
   */
  float half_angle_rad;
  /**
   * Irradiance on a plane that faces it, R, G, B of linear Rec. 709, 0 to 1e30: anywhere from afar, at `reference_mm` of the frame from
   * nearby, where it falls with the square of the distance.
   */
  float irradiance[3];
} SubsurfLight;

/**
 * Object: a mesh, what it is made of, and where it is. Objects of one material scatter light between each other.
 */
typedef struct {
  /**
   * Mesh.
   */
  const SubsurfMesh *mesh;
  /**
   * Material.
   */
  const SubsurfMaterial *material;
  /**
   * Number of the material of a BTF, from 0, below `SubsurfMaterialInfo::materials`; 0 for others.
   */
  uint32_t number;
  /**
   * A `SubsurfMapping`.
   */
  uint32_t mapping;
  /**
   * Copies of the material in u and in v, for texture coordinates.
   */
  float copies[2];
  /**
   * GGX roughness of the smooth coat over the material, 0 to 1.
   */
  float roughness;
  /**
   * From mm of the mesh to mm of the world, column by column: a rotation, a uniform scale, a translation. The material keeps its own size.
   */
  float world_from_mesh[16];
} SubsurfObject;

/**
 * Everything that a frame shows. Set `struct_size`, `light_bytes` and `object_bytes` to the sizes of the structs; y is up, lengths are in mm,
 * matrices are column by column.
 */
typedef struct {
  /**
   * Bytes of the caller's struct.
   */
  uint32_t struct_size;
  /**
   * `sizeof(SubsurfLight)`.
   */
  uint32_t light_bytes;
  /**
   * Number of lights, at most 8.
   */
  uint32_t light_count;
  /**
   * `sizeof(SubsurfObject)`.
   */
  uint32_t object_bytes;
  /**
   * Number of objects, at most `SubsurfRendererOptions::objects`.
   */
  uint32_t object_count;
  /**
   * Factor on radiance, before tone mapping (Khronos PBR Neutral).
   */
  float exposure;
  /**
   * Colour where no object is: R, G, B and coverage of display values, 0 to 1.
   */
  float background[4];
  /**
   * Point in mm at which lights from nearby have their irradiance.
   */
  float reference_mm[3];
  /**
   * From the world to the camera, which looks along -z, y up: rotation and translation.
   */
  float view_from_world[16];
  /**
   * Projection, in perspective or parallel: depth from 0 at the near plane to 1 at the far one. OpenGL's have -1 to 1: halve the third
   * row, and add half of the fourth.
   */
  float clip_from_view[16];
  /**
   * Lights, or null.
   */
  const SubsurfLight *lights;
  /**
   * Objects, or null.
   */
  const SubsurfObject *objects;
  /**
   * Light from all around; null for none.
   */
  const SubsurfEnvironment *environment;
} SubsurfFrame;

/**
 * How a renderer draws. Set `struct_size` to `sizeof(SubsurfRendererOptions)`; zeros are the usual choice.
 */
typedef struct {
  /**
   * Bytes of the caller's struct.
   */
  uint32_t struct_size;
  /**
   * Samples to a pixel, 1 or 4; 0 stands for 1.
   */
  uint32_t samples;
  /**
   * Texels to a side of what each light sees: a power of two, 128 or more; 0 stands for 512.
   */
  uint32_t light_texels;
  /**
   * Most objects of a frame, to 1,000,000; 0 stands for 16.
   */
  uint32_t objects;
  /**
   * Most bytes on the device, materials, meshes and pictures included; 0 for no limit. Frames become coarser until they fit.
   */
  uint64_t budget_bytes;
} SubsurfRendererOptions;

/**
 * What a frame took. Set `struct_size` to `sizeof(SubsurfFrameReport)` before it is filled.
 */
typedef struct {
  /**
   * Bytes of the caller's struct.
   */
  uint32_t struct_size;
  /**
   * Nanoseconds of pipelines that the frame compiled: none but at the first of a technique.
   */
  uint64_t pipelines_ns;
  /**
   * Nanoseconds of making room: none but at the first of a size, or of materials.
   */
  uint64_t prepare_ns;
  /**
   * Nanoseconds of the processor for the frame itself.
   */
  uint64_t recording_ns;
  /**
   * Nanoseconds from the beginning of the call until the device has done the frame.
   */
  uint64_t done_ns;
} SubsurfFrameReport;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Opens a device: the best of an API, discrete ones first, software last.
 *
 * `options`: null for the usual choice, pictures alone. `*gpu_out`: the handle; only written on success.
 * Errors: `INVALID_ARGUMENT`, `NO_DEVICE`, whose text says why; `OUT_OF_MEMORY`.
 * Ownership: the struct is not needed afterwards; a display is, as the struct says.
 * Threads: any. It takes about 10 ms, more with the first use of a driver.
 */
SubsurfStatus subsurf_gpu_open(const SubsurfGpuOptions *options, SubsurfGpu **gpu_out);

/**
 * What a device is.
 *
 * `info`: filled as far as its `struct_size` reaches.
 * Errors: `INVALID_ARGUMENT`.
 * Ownership: the struct is the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_gpu_info(const SubsurfGpu *gpu, SubsurfGpuInfo *info);

/**
 * Bytes on a device.
 *
 * `memory`: filled as far as its `struct_size` reaches.
 * Errors: `INVALID_ARGUMENT`.
 * Ownership: the struct is the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_gpu_memory(const SubsurfGpu *gpu, SubsurfGpuMemory *memory);

/**
 * Waits until a device has done everything that it was given.
 *
 * Errors: `INVALID_ARGUMENT`, `DEVICE_LOST`, `DEVICE_FAILED`.
 * Threads: any.
 */
SubsurfStatus subsurf_gpu_finish(const SubsurfGpu *gpu);

/**
 * Loses a device on purpose, as a reset of its driver would: everything on it fails with `DEVICE_LOST` from now on, and its memory is
 * free. For tests of how an app gets over it.
 *
 * Errors: `INVALID_ARGUMENT`.
 * Threads: any.
 */
SubsurfStatus subsurf_gpu_lose(const SubsurfGpu *gpu);

/**
 * Closes a device. Null is ignored, and so is what is no handle.
 *
 * Ownership: the handle is gone; the device goes with the last that was made on it.
 * Threads: any, once no other uses the handle.
 */
void subsurf_gpu_close(SubsurfGpu *gpu);

/**
 * Makes the same light from everywhere.
 *
 * `irradiance`: three numbers, R, G, B of linear Rec. 709, 0 to 1e30: what any surface gets. `*environment_out`: the handle; only
 * written on success.
 * Errors: `INVALID_ARGUMENT`, `OUT_OF_MEMORY`.
 * Ownership: the numbers are not needed afterwards.
 * Threads: any.
 */
SubsurfStatus subsurf_environment_uniform(const float *irradiance,
                                          SubsurfEnvironment **environment_out);

/**
 * Makes a photographer's studio without its key light: a large softbox overhead, a strip on the left, a dim floor.
 *
 * `*environment_out`: the handle; only written on success.
 * Errors: `INVALID_ARGUMENT`, `OUT_OF_MEMORY`.
 * Threads: any. It takes some milliseconds.
 */
SubsurfStatus subsurf_environment_studio(SubsurfEnvironment **environment_out);

/**
 * Makes light of a picture in equirectangular projection: a direction (x, y, z), y up, is seen at u = 1/2 + atan2(x, z) / 2 pi from
 * the left and v = acos(y) / pi from the top.
 *
 * `width`, `height`: pixels, 1 to 16,384 each. `radiance`: three numbers for each pixel, R, G, B of linear Rec. 709, 0 to 1e30, row by row
 * from the top. `*environment_out`: the handle; only written on success.
 * Errors: `INVALID_ARGUMENT`, `OUT_OF_MEMORY`.
 * Ownership: the picture is not needed afterwards.
 * Threads: any. It takes milliseconds to seconds, as the picture is large.
 */
SubsurfStatus subsurf_environment_picture(uint32_t width,
                                          uint32_t height,
                                          const float *radiance,
                                          SubsurfEnvironment **environment_out);

/**
 * Closes an environment. Null is ignored, and so is what is no handle.
 *
 * Ownership: the handle is gone.
 * Threads: any, once no other uses it.
 */
void subsurf_environment_close(SubsurfEnvironment *environment);

/**
 * Loads an open file onto a device: hands its bytes over where they are, without a copy, and draws from them what the technique needs.
 *
 * `options`: null for the usual choice. `report`: filled as far as its `struct_size` reaches; with one the load waits for the device after
 * every phase, with null for nothing. `*material_out`: the handle; only written on success.
 * Errors: `INVALID_ARGUMENT`, `WRONG_FAMILY` (factored BTFs are not drawn; a technique for other files), `UNSUPPORTED`, `DEVICE_LOST`,
 * `DEVICE_FAILED`, `OUT_OF_MEMORY`.
 * Ownership: the file stays the caller's, and may be closed at once; so are the structs.
 * Threads: any, also while another draws.
 */
SubsurfStatus subsurf_material_load(const SubsurfGpu *gpu,
                                    const SubsurfFile *file,
                                    const SubsurfMaterialOptions *options,
                                    SubsurfLoadReport *report,
                                    SubsurfMaterial **material_out);

/**
 * What a material is.
 *
 * `info`: filled as far as its `struct_size` reaches.
 * Errors: `INVALID_ARGUMENT`.
 * Ownership: the struct is the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_material_info(const SubsurfMaterial *material, SubsurfMaterialInfo *info);

/**
 * Closes a material. Null is ignored, and so is what is no handle.
 *
 * Ownership: the handle is gone; what is on the device goes with the next frame of the renderers that drew it.
 * Threads: any, once no other uses the handle.
 */
void subsurf_material_close(SubsurfMaterial *material);

/**
 * Uploads a mesh.
 *
 * `data`: the mesh. `*mesh_out`: the handle; only written on success.
 * Errors: `INVALID_ARGUMENT`, `INVALID_MESH` (no triangles, no area, an index outside, numbers that are not finite, more than 1 km),
 * `UNSUPPORTED` (more than a buffer of the device), `OUT_OF_MEMORY`, `DEVICE_LOST`, `DEVICE_FAILED`.
 * Ownership: the data is not needed afterwards.
 * Threads: any, also while another draws.
 */
SubsurfStatus subsurf_mesh_upload(const SubsurfGpu *gpu,
                                  const SubsurfMeshData *data,
                                  SubsurfMesh **mesh_out);

/**
 * Uploads a shape, around the origin, with texture coordinates.
 *
 * `shape`: a `SubsurfShape`. `extent_mm`: its longest side, 0.001 to 1,000,000 mm. `*mesh_out`: the handle; only written on success.
 * Errors: `INVALID_ARGUMENT`, `OUT_OF_MEMORY`, `DEVICE_LOST`, `DEVICE_FAILED`.
 * Ownership: none besides the handle.
 * Threads: any, also while another draws.
 */
SubsurfStatus subsurf_mesh_shape(const SubsurfGpu *gpu,
                                 uint32_t shape,
                                 float extent_mm,
                                 SubsurfMesh **mesh_out);

/**
 * What a mesh is.
 *
 * `info`: filled as far as its `struct_size` reaches.
 * Errors: `INVALID_ARGUMENT`.
 * Ownership: the struct is the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_mesh_info(const SubsurfMesh *mesh, SubsurfMeshInfo *info);

/**
 * Closes a mesh. Null is ignored, and so is what is no handle.
 *
 * Ownership: the handle is gone, and what is on the device once it is drawn.
 * Threads: any, once no other uses the handle.
 */
void subsurf_mesh_close(SubsurfMesh *mesh);

/**
 * Fills the two matrices of a frame with those of a camera that looks from one point at another, y up.
 *
 * `frame`: its `struct_size` is set; nothing else of it is read or changed. `eye_mm`, `target_mm`: three numbers each. `fov_y_rad`: angle from the
 * lower to the upper edge, 0.001 to 3.1. `aspect`: width by height, 0.001 to 1,000. `near_mm`, `far_mm`: distances of the planes, more than 0.
 * Errors: `INVALID_ARGUMENT`.
 * Ownership: all are the caller's.
 * Threads: any.
 */
SubsurfStatus subsurf_frame_look_at(SubsurfFrame *frame,
                                    const float *eye_mm,
                                    const float *target_mm,
                                    float fov_y_rad,
                                    float aspect,
                                    float near_mm,
                                    float far_mm);

/**
 * Makes a picture.
 *
 * `width`, `height`: pixels, 1 to `SubsurfGpuInfo::most_texels`. `*picture_out`: the handle; only written on success.
 * Errors: `INVALID_ARGUMENT`, `UNSUPPORTED`, `OUT_OF_MEMORY`, `DEVICE_LOST`, `DEVICE_FAILED`.
 * Ownership: none besides the handle.
 * Threads: any.
 */
SubsurfStatus subsurf_picture_create(const SubsurfGpu *gpu,
                                     uint32_t width,
                                     uint32_t height,
                                     SubsurfPicture **picture_out);

/**
 * Waits until a picture is drawn, and copies it: red, green, blue and coverage of display values, a byte each, rows from the top.
 *
 * `pixels`: room for `length` bytes, at least `row_bytes` for each row. `row_bytes`: from one row to the next, at least 4 for each pixel; 0 stands
 * for no gap.
 * Errors: `INVALID_ARGUMENT`, `OUT_OF_MEMORY`, `DEVICE_LOST`, `DEVICE_FAILED`.
 * Ownership: the bytes are the caller's.
 * Threads: any, one at a time for the picture.
 */
SubsurfStatus subsurf_picture_read(const SubsurfPicture *picture,
                                   void *pixels,
                                   size_t length,
                                   size_t row_bytes);

/**
 * Closes a picture. Null is ignored, and so is what is no handle.
 *
 * Ownership: the handle is gone, and what is on the device once it is drawn.
 * Threads: any, once no other uses the handle.
 */
void subsurf_picture_close(SubsurfPicture *picture);

/**
 * Opens the surface of a window, in the window system that the device was opened for.
 *
 * `window`: `ANativeWindow *` of Android, `Window` of X11, `wl_surface *` of Wayland. `width`, `height`: its pixels; 0 stands for 1.
 * `*surface_out`: the handle; only written on success.
 * Errors: `INVALID_ARGUMENT` (null; the device was opened for no window system), `UNSUPPORTED` (the device does not draw to the window, or not
 * in that size), `SURFACE_LOST` (there is no such window any more, or it takes no pictures of 8 bits), `DEVICE_LOST`, `DEVICE_FAILED`.
 * Ownership: the window stays the caller's, who keeps it until the surface is closed (on Android by `ANativeWindow_acquire`); a window
 * has one surface at a time.
 * Threads: any.
 */
SubsurfStatus subsurf_surface_open(const SubsurfGpu *gpu,
                                   size_t window,
                                   uint32_t width,
                                   uint32_t height,
                                   SubsurfSurface **surface_out);

/**
 * Follows a window to another size.
 *
 * `width`, `height`: its pixels; 0 stands for 1.
 * Errors: `INVALID_ARGUMENT`, `UNSUPPORTED`, `DEVICE_LOST`, `DEVICE_FAILED`.
 * Threads: any, one at a time for the surface.
 */
SubsurfStatus subsurf_surface_resize(SubsurfSurface *surface, uint32_t width, uint32_t height);

/**
 * Closes a surface, so that its window can go. Null is ignored, and so is what is no handle.
 *
 * Ownership: the handle is gone; the window is not needed any more.
 * Threads: any, once no other uses the handle.
 */
void subsurf_surface_close(SubsurfSurface *surface);

/**
 * Makes a renderer on a device: the passes that all techniques share.
 *
 * `options`: null for the usual choice. `*renderer_out`: the handle; only written on success.
 * Errors: `INVALID_ARGUMENT`, `UNSUPPORTED`, `OUT_OF_MEMORY`, `DEVICE_LOST`, `DEVICE_FAILED`.
 * Ownership: the struct is not needed afterwards.
 * Threads: any.
 */
SubsurfStatus subsurf_renderer_create(const SubsurfGpu *gpu,
                                      const SubsurfRendererOptions *options,
                                      SubsurfRenderer **renderer_out);

/**
 * Draws a frame into a picture.
 *
 * `frame`: what it shows. `report`: filled as far as its `struct_size` reaches, after waiting for the device; null to wait for nothing.
 * Errors: `INVALID_ARGUMENT`, `INVALID_MESH` (it lacks texture coordinates that its material needs), `OVER_BUDGET`, `UNSUPPORTED`, `DEVICE_LOST`,
 * `DEVICE_FAILED`.
 * Ownership: everything stays the caller's, and may be closed as soon as the call returns.
 * Threads: any, one at a time for the renderer and for the picture.
 */
SubsurfStatus subsurf_renderer_draw_picture(SubsurfRenderer *renderer,
                                            const SubsurfFrame *frame,
                                            const SubsurfPicture *picture,
                                            SubsurfFrameReport *report);

/**
 * Draws a frame into a window, and shows it: waits for the display where frames come faster.
 *
 * `frame`: what it shows. `report`: filled as far as its `struct_size` reaches, after waiting for the device; null to wait for nothing.
 * Errors: those of `subsurf_renderer_draw_picture`; `SKIPPED` where the window takes no picture at present; `SURFACE_LOST`.
 * Ownership: everything stays the caller's, and may be closed as soon as the call returns.
 * Threads: any, one at a time for the renderer and for the surface.
 */
SubsurfStatus subsurf_renderer_draw_surface(SubsurfRenderer *renderer,
                                            const SubsurfFrame *frame,
                                            SubsurfSurface *surface,
                                            SubsurfFrameReport *report);

/**
 * Gives up the room of a renderer, so that the device has it for others: the next frame makes it anew. For an app that goes into
 * the background or is told that memory is low.
 *
 * Errors: `INVALID_ARGUMENT`.
 * Threads: any, one at a time for the renderer.
 */
SubsurfStatus subsurf_renderer_trim(SubsurfRenderer *renderer);

/**
 * Closes a renderer. Null is ignored, and so is what is no handle.
 *
 * Ownership: the handle is gone, and what it has on the device once it is drawn.
 * Threads: any, once no other uses the handle.
 */
void subsurf_renderer_close(SubsurfRenderer *renderer);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SUBSURF_DECODER_ONLY */

#endif  /* SUBSURF_H */
