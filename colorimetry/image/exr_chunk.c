#include "colorimetry/image/exr_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#ifdef ABBE_HAS_DEFLATE
#include <libdeflate.h>
#endif

enum { BLOCK = 512 }; /* pixels of a line at a time, that they stay in the processor's cache */

static float float_of(uint32_t bits) {
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

/* IEEE 754's binary16: the exponent's bias is 112 less, and its greatest stands for infinity. */
static float half_of(uint32_t bits) {
  const float value = float_of((bits & 0x7fff) << 13) * 0x1p112f;
  const float finite = value >= 65536 ? float_of(0x7f800000 | (bits & 0x3ff) << 13) : value;
  return bits & 0x8000 ? -finite : finite;
}

static uint32_t word_of(const uint8_t *b) {
  return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

/* A channel's neighbouring samples, as floats. */
static void convert(const uint8_t *bytes, int type, double unit, int64_t count, float *out) {
  if (type == EXR_PIXEL_HALF)
    for (int64_t i = 0; i < count; i++)
      out[i] = half_of(bytes[2 * i] | (uint32_t)bytes[2 * i + 1] << 8);
  else if (type == EXR_PIXEL_FLOAT)
    for (int64_t i = 0; i < count; i++) out[i] = float_of(word_of(bytes + 4 * i));
  else
    for (int64_t i = 0; i < count; i++) out[i] = (float)word_of(bytes + 4 * i);
  for (int64_t i = 0; unit != 1 && i < count; i++) out[i] = (float)(unit * (double)out[i]);
}

/* Pixels of a line that the picture has: the first's sample in the chunk, and its place there. */
typedef struct piece {
  int64_t from, count, pixel;
} piece;

static void lay_down(const exr_decode_pipeline_t *pipe, const abbe_exr_place *to,
                     const uint8_t *line, const piece *p) {
  const abbe_image *image = to->image;
  float value[BLOCK];
  for (int c = 0; c < pipe->channel_count; c++) {
    const int bytes = pipe->channels[c].bytes_per_element;
    float *out = image->data + p->pixel * (int64_t)image->channels + to->part->first + c;
    convert(line + p->from * bytes, pipe->channels[c].data_type, to->part->unit, p->count, value);
    for (int64_t i = 0; i < p->count; i++) out[i * (int64_t)image->channels] = value[i];
    line += pipe->chunk.width * bytes;
  }
}

/* Whether a pixel of which some sum is not finite has an infinite sample, or else NaN. */
static void count_odd(const exr_decode_pipeline_t *pipe, const abbe_exr_place *to,
                      const uint8_t *line, int64_t x) {
  bool infinite = false;
  for (int c = 0; c < pipe->channel_count; c++) {
    const int bytes = pipe->channels[c].bytes_per_element;
    float value;
    convert(line + x * bytes, pipe->channels[c].data_type, to->part->unit, 1, &value);
    if (to->sums->weight[to->part->first + c] != NULL) infinite = infinite || isinf(value);
    line += pipe->chunk.width * bytes;
  }
#pragma omp atomic
  to->sums->odd.infinite += infinite;
#pragma omp atomic
  to->sums->odd.nan += !infinite;
}

static void add_up(const exr_decode_pipeline_t *pipe, const abbe_exr_place *to, const uint8_t *line,
                   const piece *p) {
  const uint8_t *first = line;
  float value[BLOCK];
  double sum[3][BLOCK] = {{0}};
  for (int c = 0; c < pipe->channel_count; c++) {
    const int bytes = pipe->channels[c].bytes_per_element;
    const double *weight = to->sums->weight[to->part->first + c];
    const uint8_t *samples = line + p->from * bytes;
    line += pipe->chunk.width * bytes;
    if (weight == NULL) continue;
    convert(samples, pipe->channels[c].data_type, to->part->unit, p->count, value);
    for (int k = 0; k < 3; k++)
      for (int64_t i = 0; i < p->count; i++) sum[k][i] += weight[k] * (double)value[i];
  }
  for (int64_t i = 0; i < p->count; i++) {
    float *out = to->image->data + (p->pixel + i) * 3;
    for (int k = 0; k < 3; k++) out[k] += (float)sum[k][i];
    if (!isfinite(sum[0][i] + sum[1][i] + sum[2][i])) count_odd(pipe, to, first, p->from + i);
  }
}

/* A chunk's lines, each channel after channel, into those pixels of the picture that they cover.
 * The library's own unpackers are not used: 3.1's for four halves that become neighbouring floats
 * lays them down in reverse. */
static exr_result_t unpack(exr_decode_pipeline_t *pipe) {
  const abbe_exr_place *to = pipe->decoding_user_data;
  const int64_t width = (int64_t)to->image->width, chunk_width = pipe->chunk.width;
  const int64_t past = to->x + chunk_width > width ? width - to->x : chunk_width;
  const uint8_t *line = pipe->unpacked_buffer;
  const size_t size = pipe->chunk.unpacked_size / (size_t)pipe->chunk.height;
  for (int64_t y = to->y; y < to->y + pipe->chunk.height; y++, line += size)
    for (int64_t x = to->x < 0 ? -to->x : 0; x < past; x += BLOCK) {
      const piece p = {x, past - x < BLOCK ? past - x : BLOCK, y * width + to->x + x};
      if (y < 0 || y >= (int64_t)to->image->height) break;
      if (to->sums != NULL)
        add_up(pipe, to, line, &p);
      else
        lay_down(pipe, to, line, &p);
    }
  return EXR_ERR_SUCCESS;
}

/* What ZIP has packed, in half the time that zlib takes; false: the library shall try, or say why
 * it cannot. The bytes are differences, all even places before all odd ones. */
static bool inflate(exr_decode_pipeline_t *pipe, abbe_exr_source *from) {
#ifdef ABBE_HAS_DEFLATE
  const size_t size = pipe->chunk.unpacked_size, half = (size + 1) / 2;
  size_t made = 0;
  uint8_t *out = pipe->unpacked_buffer, even = 0, odd = 0;
  if (from->layout.compression != EXR_COMPRESSION_ZIP &&
      from->layout.compression != EXR_COMPRESSION_ZIPS)
    return false;
  if (from->inflater == NULL) from->inflater = libdeflate_alloc_decompressor();
  if (from->bytes < size) {
    free(from->differences);
    from->differences = malloc(size);
    from->bytes = from->differences != NULL ? size : 0;
  }
  uint8_t *a = from->differences, *b = a + half;
  if (from->inflater == NULL || a == NULL || out == NULL || size < 2) return false;
  if (libdeflate_zlib_decompress(from->inflater, pipe->packed_buffer, pipe->chunk.packed_size, a,
                                 size, &made) != LIBDEFLATE_SUCCESS ||
      made != size)
    return false;
  a[0] = (uint8_t)(a[0] + 128);
  for (size_t i = 0; i < size - half;
       i++) { /* both sums at once, for each add waits for the last */
    a[i] = even = (uint8_t)(even + a[i] - 128);
    b[i] = odd = (uint8_t)(odd + b[i] - 128);
  }
  if (half > size - half) a[half - 1] = even = (uint8_t)(even + a[half - 1] - 128);
  for (size_t i = 0; i < size - half; i++) {
    out[2 * i] = a[i];
    out[2 * i + 1] = (uint8_t)(b[i] + even);
  }
  if (half > size - half) out[size - 1] = a[half - 1];
  return true;
#else
  (void)pipe;
  (void)from;
  return false;
#endif
}

/* What no codec made smaller is stored as it is; 3.1 forgets that for B44. */
static exr_result_t decompress(exr_decode_pipeline_t *pipe) {
  const abbe_exr_place *to = pipe->decoding_user_data;
  if (pipe->chunk.packed_size == pipe->chunk.unpacked_size) return EXR_ERR_SUCCESS;
  if (to->part->decompress == NULL) return EXR_ERR_CORRUPT_CHUNK;
  return inflate(pipe, to->part) ? EXR_ERR_SUCCESS : to->part->decompress(pipe);
}

static exr_result_t begin(exr_context_t context, abbe_exr_source *from,
                          const exr_chunk_info_t *chunk) {
  const int part = from->layout.part;
  exr_result_t rv = exr_decoding_initialize(context, part, chunk, &from->pipe);
  if (rv == 0) rv = exr_decoding_choose_default_routines(context, part, &from->pipe);
  from->decompress = from->pipe.decompress_fn;
  from->pipe.decompress_fn = decompress;
  from->pipe.unpack_and_convert_fn = unpack;
  return rv;
}

static bool is_whole(const exr_decode_pipeline_t *pipe) {
  uint64_t pixel = 0;
  for (int c = 0; c < pipe->channel_count; c++)
    pixel += (uint64_t)pipe->channels[c].bytes_per_element;
  return pixel * (uint64_t)pipe->chunk.width * (uint64_t)pipe->chunk.height ==
         pipe->chunk.unpacked_size;
}

exr_result_t abbe_exr_source_read(exr_context_t context, abbe_exr_source *from,
                                  const exr_chunk_info_t *chunk, int64_t width, int64_t height,
                                  const abbe_exr_place *at) {
  abbe_exr_place to = *at;
  if (chunk->width < 1 || chunk->height < 1 || chunk->width > width || chunk->height > height)
    return EXR_ERR_CORRUPT_CHUNK;
  exr_result_t rv = from->pipe.context == NULL
                        ? begin(context, from, chunk)
                        : exr_decoding_update(context, from->layout.part, chunk, &from->pipe);
  to.part = from;
  from->pipe.decoding_user_data = &to;
  if (rv == 0 && !is_whole(&from->pipe)) rv = EXR_ERR_CORRUPT_CHUNK;
  if (rv == 0) rv = exr_decoding_run(context, from->layout.part, &from->pipe);
  return abbe_exr_starved() ? EXR_ERR_OUT_OF_MEMORY : rv;
}

void abbe_exr_source_free(exr_context_t context, abbe_exr_source *source) {
  exr_decoding_destroy(context, &source->pipe);
#ifdef ABBE_HAS_DEFLATE
  libdeflate_free_decompressor(source->inflater);
#endif
  free(source->differences);
}
