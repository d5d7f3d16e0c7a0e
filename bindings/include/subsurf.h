/* subsurf.h: .subsurf files for programs in C and C++.
 *
 * libsubsurf_decoder has these functions: it opens, describes and evaluates files, and draws nothing.
 *
 * Handles are opaque. Calls return a SubsurfStatus; after one that is not SUBSURF_STATUS_OK, subsurf_last_error says in one line what
 * was wrong, and nothing was written. Doc comments name statuses without their prefix. Pointers of arguments may have any
 * alignment and must not be null. Structs begin with struct_size, which the caller sets to its own sizeof, so that later
 * versions can append fields. No panic or exception leaves a function.
 *
 * Written by cbindgen from bindings/c/src; scripts/lint compares it. */

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

#endif  /* SUBSURF_H */
