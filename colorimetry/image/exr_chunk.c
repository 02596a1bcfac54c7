#include "base/maths.h"
#include "colorimetry/image/exr_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#ifdef ABBE_HAS_DEFLATE
#include <libdeflate.h>
#endif
#ifdef __SSE2__
#include <immintrin.h>
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
  uint32_t word;
  memcpy(&word, b, sizeof word);
  return __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? word : __builtin_bswap32(word);
}

static uint16_t short_of(const uint8_t *b) {
  uint16_t word;
  memcpy(&word, b, sizeof word);
  return __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? word : __builtin_bswap16(word);
}

#ifdef __SSE2__
/* Halves, eight at a time; returns how many. */
__attribute__((target("avx,f16c"))) static int64_t widen(const uint8_t *bytes, int64_t count,
                                                         float *out) {
  int64_t i = 0;
  for (; i + 8 <= count; i += 8)
    _mm256_storeu_ps(out + i, _mm256_cvtph_ps(_mm_loadu_si128((const __m128i *)(bytes + 2 * i))));
  return i;
}
#endif

/* A channel's neighbouring samples, as floats. */
SIDE_BY_SIDE
static void convert(const uint8_t *bytes, int type, double unit, int64_t count, float *out) {
  int64_t done = 0;
#ifdef __SSE2__
  /* all that have AVX2 have F16C, of which clang 14 cannot ask */
  if (type == EXR_PIXEL_HALF && __builtin_cpu_supports("avx2")) done = widen(bytes, count, out);
#endif
  if (type == EXR_PIXEL_HALF)
    for (int64_t i = done; i < count; i++) out[i] = half_of(short_of(bytes + 2 * i));
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

SIDE_BY_SIDE
static void add_weighted(const double weight[3], const float *value, int64_t count,
                         double sum[3][BLOCK]) {
  for (int k = 0; k < 3; k++)
    for (int64_t i = 0; i < count; i++) sum[k][i] += weight[k] * (double)value[i];
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
    add_weighted(weight, value, p->count, sum);
    const size_t place = to->sums->place[to->part->first + c], stride = to->image->channels;
    float *kept = to->image->data + (size_t)p->pixel * stride + place;
    for (int64_t i = 0; place > 0 && i < p->count; i++)
      kept[(size_t)i * stride] = (float)(to->sums->factor[to->part->first + c] * (double)value[i]);
  }
  for (int64_t i = 0; i < p->count; i++) {
    float *out = to->image->data + (size_t)(p->pixel + i) * to->image->channels;
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

#ifdef ABBE_HAS_DEFLATE

#ifdef __SSE2__
/* Sums of neighbouring differences less 128, on from the last one of `before`. */
static __m128i sum_up(const uint8_t *difference, __m128i *before) {
  __m128i x = _mm_xor_si128(_mm_loadu_si128((const __m128i *)difference), _mm_set1_epi8((char)128));
  x = _mm_add_epi8(x, _mm_slli_si128(x, 1));
  x = _mm_add_epi8(x, _mm_slli_si128(x, 2));
  x = _mm_add_epi8(x, _mm_slli_si128(x, 4));
  x = _mm_add_epi8(x, _mm_slli_si128(x, 8));
  const __m128i last = _mm_shufflehi_epi16(_mm_unpackhi_epi8(x, x), 0xff), sums = x;
  x = _mm_add_epi8(sums, *before);
  *before = _mm_add_epi8(*before, _mm_unpackhi_epi64(last, last));
  return x;
}
#endif

/* The bytes whose differences are a, of even places, and then b, of odd ones. */
static void rejoin(const uint8_t *a, size_t size, uint8_t *out) {
  const size_t half = (size + 1) / 2;
  const uint8_t *b = a + half;
  uint8_t even = 128, odd = 128;
  size_t i = 0;
  for (size_t k = 0; k < half; k++) odd = (uint8_t)(odd + a[k] - 128);
#ifdef __SSE2__
  __m128i from[2] = {_mm_set1_epi8((char)even), _mm_set1_epi8((char)odd)};
  for (; i + 16 <= size - half; i += 16) {
    const __m128i x = sum_up(a + i, &from[0]), y = sum_up(b + i, &from[1]);
    _mm_storeu_si128((__m128i *)(out + 2 * i), _mm_unpacklo_epi8(x, y));
    _mm_storeu_si128((__m128i *)(out + 2 * i + 16), _mm_unpackhi_epi8(x, y));
  }
  even = (uint8_t)_mm_cvtsi128_si32(from[0]);
  odd = (uint8_t)_mm_cvtsi128_si32(from[1]);
#endif
  for (; i < half; i++) {
    out[2 * i] = even = (uint8_t)(even + a[i] - 128);
    if (i < size - half) out[2 * i + 1] = odd = (uint8_t)(odd + b[i] - 128);
  }
}
#endif

/* What ZIP has packed, in half the time that zlib takes; false: the library shall try, or say why
 * it cannot. The bytes are differences, all even places before all odd ones. */
static bool inflate(exr_decode_pipeline_t *pipe, abbe_exr_source *from) {
#ifdef ABBE_HAS_DEFLATE
  const size_t size = pipe->chunk.unpacked_size;
  size_t made = 0;
  if (from->layout.compression != EXR_COMPRESSION_ZIP &&
      from->layout.compression != EXR_COMPRESSION_ZIPS)
    return false;
  if (from->inflater == NULL) from->inflater = libdeflate_alloc_decompressor();
  if (from->bytes < size) {
    free(from->differences);
    from->differences = malloc(size);
    from->bytes = from->differences != NULL ? size : 0;
  }
  if (from->inflater == NULL || from->differences == NULL || pipe->unpacked_buffer == NULL)
    return false;
  if (libdeflate_zlib_decompress(from->inflater, pipe->packed_buffer, pipe->chunk.packed_size,
                                 from->differences, size, &made) != LIBDEFLATE_SUCCESS ||
      made != size)
    return false;
  rejoin(from->differences, size, pipe->unpacked_buffer);
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
