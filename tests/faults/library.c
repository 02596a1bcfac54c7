#include "tests/faults/library.h"

#include <errno.h>
#include <lcms2.h>
#include <openexr.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <unistd.h>
#ifdef ABBE_HAS_DEFLATE
#include <libdeflate.h>
#endif

static faults_library_kind kind;
static atomic_bool on;
static atomic_size_t seen;
static size_t wanted;
static int why;
static const char *what = "";
static FILE *broken; /* a stream that fails, to fread and ferror alike */

void faults_library_begin(faults_library_kind of, size_t n, int code) {
  kind = of;
  seen = 0;
  wanted = n;
  why = code;
  what = "";
  on = true;
}

size_t faults_library_end(void) {
  on = false;
  broken = NULL;
  return seen;
}

const char *faults_library_what(void) {
  return what;
}

static bool fails(faults_library_kind of, const char *name) {
  if (!on || kind != of || ++seen != wanted) return false;
  what = name;
  return true;
}

#define WRAP(kind, type, name, parameters, arguments, none)                                        \
  type __real_##name parameters;                                                                   \
  type __wrap_##name parameters;                                                                   \
  type __wrap_##name parameters {                                                                  \
    return fails(kind, #name) ? (none) : __real_##name arguments;                                  \
  }

#define EXR(name, parameters, arguments)                                                           \
  WRAP(FAULTS_OF_CALLS, exr_result_t, exr_##name, parameters, arguments, why)
#define ASK(name, type)                                                                            \
  EXR(get_##name, (exr_const_context_t file, int part, type *out), (file, part, out))
EXR(get_count, (exr_const_context_t file, int *out), (file, out))
ASK(storage, exr_storage_t)
ASK(compression, exr_compression_t)
ASK(data_window, exr_attr_box2i_t)
ASK(display_window, exr_attr_box2i_t)
ASK(channels, const exr_attr_chlist_t *)
ASK(scanlines_per_chunk, int32_t)
ASK(attribute_count, int32_t)
EXR(get_attribute_by_index,
    (exr_const_context_t file, int part, exr_attr_list_access_mode_t mode, int32_t i,
     const exr_attribute_t **out),
    (file, part, mode, i, out))
EXR(get_tile_descriptor,
    (exr_const_context_t file, int part, uint32_t *x, uint32_t *y, exr_tile_level_mode_t *level,
     exr_tile_round_mode_t *round),
    (file, part, x, y, level, round))
EXR(get_level_sizes, (exr_const_context_t file, int part, int x, int y, int32_t *w, int32_t *h),
    (file, part, x, y, w, h))
EXR(read_scanline_chunk_info, (exr_const_context_t file, int part, int y, exr_chunk_info_t *out),
    (file, part, y, out))
EXR(read_tile_chunk_info,
    (exr_const_context_t file, int part, int x, int y, int level_x, int level_y,
     exr_chunk_info_t *out),
    (file, part, x, y, level_x, level_y, out))
#define CHUNK(name, pipeline)                                                                      \
  EXR(name, (exr_const_context_t file, int part, const exr_chunk_info_t *chunk, pipeline *pipe),   \
      (file, part, chunk, pipe))
#define PIPE(name, pipeline)                                                                       \
  EXR(name, (exr_const_context_t file, int part, pipeline *pipe), (file, part, pipe))
CHUNK(decoding_initialize, exr_decode_pipeline_t)
CHUNK(decoding_update, exr_decode_pipeline_t)
PIPE(decoding_choose_default_routines, exr_decode_pipeline_t)
PIPE(decoding_run, exr_decode_pipeline_t)
CHUNK(encoding_initialize, exr_encode_pipeline_t)
CHUNK(encoding_update, exr_encode_pipeline_t)
PIPE(encoding_choose_default_routines, exr_encode_pipeline_t)
PIPE(encoding_run, exr_encode_pipeline_t)
EXR(start_write,
    (exr_context_t * file, const char *name, exr_default_write_mode_t mode,
     const exr_context_initializer_t *setup),
    (file, name, mode, setup))
EXR(set_longname_support, (exr_context_t file, int on_off), (file, on_off))
EXR(add_part, (exr_context_t file, const char *name, exr_storage_t type, int *out),
    (file, name, type, out))
EXR(initialize_required_attr_simple,
    (exr_context_t file, int part, int32_t width, int32_t height, exr_compression_t codec),
    (file, part, width, height, codec))
EXR(attr_set_string, (exr_context_t file, int part, const char *name, const char *text),
    (file, part, name, text))
EXR(attr_set_chromaticities,
    (exr_context_t file, int part, const char *name, const exr_attr_chromaticities_t *xy),
    (file, part, name, xy))
EXR(add_channel,
    (exr_context_t file, int part, const char *name, exr_pixel_type_t type,
     exr_perceptual_treatment_t as, int32_t x, int32_t y),
    (file, part, name, type, as, x, y))
EXR(write_header, (exr_context_t file), (file))
EXR(write_scanline_chunk_info, (exr_context_t file, int part, int y, exr_chunk_info_t *out),
    (file, part, y, out))

#define CMS(type, name, parameters, arguments, none)                                               \
  WRAP(FAULTS_OF_CALLS, type, cms##name, parameters, arguments, none)
CMS(cmsToneCurve *, BuildParametricToneCurve,
    (cmsContext context, cmsInt32Number form, const cmsFloat64Number *numbers),
    (context, form, numbers), NULL)
CMS(cmsHPROFILE, CreateRGBProfile,
    (const cmsCIExyY *white, const cmsCIExyYTRIPLE *primaries, cmsToneCurve *const curve[3]),
    (white, primaries, curve), NULL)
CMS(cmsMLU *, MLUalloc, (cmsContext context, cmsUInt32Number count), (context, count), NULL)
CMS(cmsBool, SaveProfileToMem, (cmsHPROFILE profile, void *to, cmsUInt32Number *size),
    (profile, to, size), FALSE)
CMS(cmsHPROFILE, OpenProfileFromMem, (const void *from, cmsUInt32Number size), (from, size), NULL)
CMS(cmsHPROFILE, Create_sRGBProfile, (void), (), NULL)
CMS(cmsHTRANSFORM, CreateTransform,
    (cmsHPROFILE from, cmsUInt32Number form, cmsHPROFILE to, cmsUInt32Number into,
     cmsUInt32Number intent, cmsUInt32Number flags),
    (from, form, to, into, intent, flags), NULL)

#ifdef ABBE_HAS_DEFLATE
WRAP(FAULTS_OF_PACKERS, struct libdeflate_compressor *, libdeflate_alloc_compressor, (int level),
     (level), NULL)
WRAP(FAULTS_OF_PACKERS, struct libdeflate_decompressor *, libdeflate_alloc_decompressor, (void), (),
     NULL)
#endif

#define READ(type, name, parameters, arguments)                                                    \
  WRAP(FAULTS_OF_READING, type, name, parameters, arguments, (errno = why, why != 0 ? -1 : 0))
READ(ssize_t, pread, (int fd, void *to, size_t size, off_t at), (fd, to, size, at))
READ(ssize_t, pwrite, (int fd, const void *from, size_t size, off_t at), (fd, from, size, at))
READ(int, fseek, (FILE * file, long at, int from), (file, at, from))
READ(int, fseeko, (FILE * file, off_t at, int from), (file, at, from))

size_t __real_fread(void *to, size_t size, size_t count, FILE *file);
size_t __wrap_fread(void *to, size_t size, size_t count, FILE *file);
size_t __wrap_fread(void *to, size_t size, size_t count, FILE *file) {
  if (!fails(FAULTS_OF_READING, "fread")) return __real_fread(to, size, count, file);
  errno = why;
  broken = why != 0 ? file : NULL;
  return 0;
}
int __real_ferror(FILE *file);
int __wrap_ferror(FILE *file);
int __wrap_ferror(FILE *file) {
  const int is_broken = broken == file;
  broken = NULL;
  return is_broken ? 1 : __real_ferror(file);
}
