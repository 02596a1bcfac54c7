/* Splats on the map (photon_splat.comp, splat_sums.h): each lights the parallelogram that it stands
 * for, and side by side they make an even light, at every size, turn, shift and place against the
 * texels. The device and the processor's threads add the same.
 */
#include "gl/caustics/splat_sums.h"
#include "scenes/volume/half.h"
#include "tests/gl/glsl.h"

#include <inttypes.h>

enum { SIDE = 128, LEVELS = 6, WORDS = ABBE_SPLAT_WORDS, MOST = 4096, UNITS = 1 << 20 };
enum { TEXELS = SIDE * SIDE / 3 * 4 };

typedef struct splat {
  double at[2], across[2], narrow; /* texels; the side of a length square to `across` */
  double shift;                    /* along x, from one colour to the next */
  int level;
} splat;

/* Of a number that a half holds to 11 bits. */
static uint32_t half_of(double value) {
  int exponent;
  const double m = frexp(fabs(value), &exponent);
  if (value == 0) return 0;
  return (value < 0 ? 0x8000u : 0) | ((uint32_t)(exponent + 14) << 10) |
         ((uint32_t)lrint(ldexp(m, 11)) - 1024u);
}

static uint32_t halves(double a, double b) {
  return half_of(a) | half_of(b) << 16;
}

static void pack(const splat *s, uint32_t word[WORDS]) {
  memset(word, 0, WORDS * sizeof *word);
  word[0] = (uint32_t)(s->at[0] * 32768) << 5;
  word[1] = (uint32_t)(s->at[1] * 32768) << 5 | (uint32_t)s->level;
  word[2] = halves(s->across[0], s->across[1]);
  for (int c = 0; c < 3; c++) word[3 + c] = UNITS;
  word[9] = halves(s->shift, 0);
  word[11] = halves(s->narrow, 0);
}

static size_t texels_of(int level) {
  return (size_t)(SIDE >> level) * (SIDE >> level);
}

static uint32_t list[4 + MOST * WORDS], sums[12 * TEXELS], here[12 * TEXELS];
static abbe_receiver_tiles tiles = {
    .count = 2, .tile = {{.rect = {0, 64, 32, 96}}, {.rect = {64, 96, 0, 128}}}};

static float value_at(const uint32_t *word, int half) {
  return (float)abbe_half_value((uint16_t)(*word >> 16 * half));
}

/* What splat_list.glsl lists. */
static size_t listed(const void *from, size_t i, abbe_splat *to, int64_t entry[3]) {
  const uint32_t *word = (const uint32_t *)from + i * WORDS;
  *to = (abbe_splat){.narrow = value_at(word + 11, 0),
                     .to_next = value_at(word + 11, 1),
                     .level = word[1] & 7u,
                     .tile = (int32_t)((word[0] & 31u) << 2 | (word[1] >> 3 & 3u))};
  for (int k = 0; k < 2; k++) {
    to->centre[k] = (float)(word[k] >> 5) / 32768;
    to->across[k] = value_at(word + 2, k);
    to->shift[k] = value_at(word + 9, k);
    to->skew[k] = value_at(word + 10, k);
    for (int c = 0; c < 3; c++) to->off[c][k] = value_at(word + 6 + c, k);
  }
  memcpy(to->units, word + 3, sizeof to->units);
  entry[0]++;
  return 1;
}

/* To here what splat_sums.h makes of the list. */
static void run_here(size_t count, bool edges, bool wide, bool on_tiles) {
  const abbe_splat_sums s = FIELDS(.word = here, .side = SIDE,
                                   .texels = (SIDE * SIDE - (SIDE * SIDE >> 2 * LEVELS)) / 3 * 4,
                                   .wide = wide, .edges = edges, .tiles = on_tiles ? &tiles : NULL);
  memset(here, 0, sizeof here);
  const abbe_splat_source source =
      FIELDS(.list = listed, .from = list + 4, .count = count, .step = 1, .most = 1);
  int64_t entry[3] = {0, 0, 0};
  OK(abbe_splat_sums_add(&s, &source, entry, NULL, NULL, &error));
  assert_int_equal(entry[0], count);
}

/* To sums what the device does. */
static void run_there(size_t count, bool edges, bool wide, bool on_tiles) {
  const abbe_gl *gl = abbe_context_gl(context);
  GLuint program = 0;
  OK(abbe_program_make_compute(gl, "photon_splat.comp",
                               printed("#define LIGHTS 1\n%s%s", wide ? "#define WIDE\n" : "",
                                       on_tiles ? "#define TILES\n#define MOST_TILES 2\n" : ""),
                               &program, &error));
  float rows[2 * ABBE_TILE_FLOATS] = {0};
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 4; k++)
      rows[i * ABBE_TILE_FLOATS + 8 + k] = (float)tiles.tile[i].rect[k % 2 * 2 + k / 2];
  glsl_texels(gl, UNIT_TILE_ROWS, GL_RGBA32F, sizeof rows, rows);
  memset(sums, 0, sizeof sums);
  GLuint buffer[2] = {glsl_buffer(gl, BINDING_SPLATS, sizeof list, list),
                      glsl_buffer(gl, BINDING_MAP_SUMS, sizeof sums, sums)};
  gl->UseProgram(program);
  gl->Uniform1i(gl->GetUniformLocation(program, "map_size"), SIDE);
  gl->Uniform1ui(gl->GetUniformLocation(program, "most"), MOST);
  gl->Uniform1i(gl->GetUniformLocation(program, "has_edges"), edges ? 1 : 0);
  gl->Uniform1ui(gl->GetUniformLocation(program, "map_texels"),
                 (SIDE * SIDE - (SIDE * SIDE >> 2 * LEVELS)) / 3 * 4);
  gl->DispatchCompute((GLuint)((count + 255) / 256), 1, 1);
  gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof sums, sums);
  gl->DeleteBuffers(2, buffer);
  gl->DeleteProgram(program);
  OK(abbe_gl_check(gl, "the splats", &error));
}

static void run(const splat *splats, size_t count, bool edges) {
  memset(list, 0, sizeof list);
  list[0] = (uint32_t)count;
  for (size_t i = 0; i < count; i++) pack(&splats[i], list + 4 + i * WORDS);
  run_here(count, edges, false, false);
  memcpy(sums, here, sizeof sums);
}

/* The level whose texels are as wide as a footprint's narrower side asks for
 * (photon_footprint.glsl). */
static int level_of(double narrow) {
  const double fine = log2(fmax(narrow, 0.5)) + 1.25;
  return (int)fmin(fmax(floor(fine), 0), LEVELS - 1);
}

static splat make(double x, double y, double wide, double narrow, double turn) {
  return (splat){.at = {x, y},
                 .across = {wide * cos(turn), wide * sin(turn)},
                 .narrow = narrow,
                 .level = level_of(narrow)};
}

/* Of Y: all, its middle, and its variance along an axis and square to it, texels evenly lit. */
typedef struct spread {
  double all, at[2], along, beside;
} spread;

static spread measure(double turn) {
  const double axis[2][2] = {{cos(turn), sin(turn)}, {-sin(turn), cos(turn)}};
  double sum = 0, first[2] = {0, 0}, second[2] = {0, 0};
  const uint32_t *texel = sums;
  for (int level = 0; level < LEVELS; level++) {
    const int side = SIDE >> level;
    const double size = (double)(1 << level);
    for (int y = 0; y < side; y++)
      for (int x = 0; x < side; x++, texel += 3) {
        const double light = texel[1], p[2] = {size * (x + 0.5), size * (y + 0.5)};
        sum += light;
        for (int k = 0; k < 2; k++) {
          const double t = axis[k][0] * p[0] + axis[k][1] * p[1];
          first[k] += light * t;
          second[k] += light * (t * t + size * size / 12);
        }
      }
  }
  const double m[2] = {first[0] / sum, first[1] / sum};
  return (spread){sum,
                  {axis[0][0] * m[0] + axis[1][0] * m[1], axis[0][1] * m[0] + axis[1][1] * m[1]},
                  second[0] / sum - m[0] * m[0],
                  second[1] / sum - m[1] * m[1]};
}

GROUP(make_context, free_context);

/* A rectangle's variance along a side is a twelfth of its square. What the texels add is less than
 * that of a box as wide as the narrower side and half of it, whatever the rectangle's size and
 * turn: light stays where the photon's cell sends it. */
TEST(light_stays_in_its_area) {
  double worst = 0;
  for (int i = 0; i < 200; i++) {
    const double narrow = 2 * pow(8, fmod(0.618034 * i, 1)), ratio = 1 + 3 * fmod(0.7549 * i, 1);
    const double turn = 6.28 * fmod(0.5698 * i, 1);
    const splat s =
        make(60 + fmod(3.7 * i, 8), 60 + fmod(5.3 * i, 8), ratio * narrow, narrow, turn);
    run(&s, 1, true);
    const spread m = measure(turn);
    assert_near(m.all, UNITS, 0);
    const double added =
        fmax(m.along - pow(ratio * narrow, 2) / 12, m.beside - narrow * narrow / 12);
    worst = fmax(worst, added / (narrow * narrow));
    if (hypot(m.at[0] - s.at[0], m.at[1] - s.at[1]) > 0.3 * narrow)
      fail_msg("%g x %g turned by %g: %g, %g for %g, %g", ratio * narrow, narrow, turn, m.at[0],
               m.at[1], s.at[0], s.at[1]);
  }
  print_message("variance added: %g of the narrower side's square\n", worst);
  if (!(worst < 0.5)) fail_msg("variance added: %g of the narrower side's square", worst);
}

/* Squares side by side, turned against the texels. */
static void check_even(bool edges, double limit) {
  static splat splats[MOST];
  double worst = 0;
  for (int i = 0; i < 24; i++) {
    const double a = 2 * pow(4, i / 24.0), turn = 1.57 * fmod(0.618034 * i, 1);
    const double u[2] = {a * cos(turn), a * sin(turn)};
    size_t count = 0;
    for (int y = -64; y < 64; y++)
      for (int x = -64; x < 64; x++) {
        const double px = 64.3 + x * u[0] - y * u[1], py = 63.8 + x * u[1] + y * u[0];
        if (fmin(px, py) < 8 || fmax(px, py) > 120) continue;
        assert_true(count < MOST);
        splats[count++] = make(px, py, a, a, turn);
      }
    run(splats, count, edges);
    const uint32_t *texel = sums;
    for (int level = 0; level < LEVELS; texel += 3 * texels_of(level), level++) {
      const int side = SIDE >> level, from = 40 >> level, to = 88 >> level;
      const double right = UNITS / (a * a) * ldexp(1, 2 * level);
      for (int y = from; y < to; y++)
        for (int x = from; x < to; x++) {
          const double light = texel[3 * (y * side + x) + 1];
          if (light > 0) worst = fmax(worst, fabs(light / right - 1));
        }
    }
  }
  print_message("uneven by %g\n", worst);
  if (!(worst < limit)) fail_msg("uneven by %g", worst);
}

/* Where light has edges, parts lie by their bounds. */
TEST(side_by_side_they_are_even) {
  check_even(false, 1e-3);
  check_even(true, 0.1);
}

/* Splats with colours that lie apart, uneven halves, shares of two levels, on the map and on tiles,
 * also at their edges: device and processor differ by roundings of places alone. */
TEST(device_and_processor_add_the_same) {
  enum { COUNT = 1500 };
  for (int turn = 0; turn < 8; turn++) {
    const bool edges = turn & 1, wide = turn & 2, on_tiles = turn & 4;
    memset(list, 0, sizeof list);
    list[0] = COUNT;
    for (int i = 0; i < COUNT; i++) {
      uint32_t *word = list + 4 + i * WORDS;
      double u[16];
      for (int k = 0; k < 16; k++) u[k] = fmod((i + 1) * sqrt(2 + 3 * k), 1);
      const int level = (int)(5 * u[0]), tile = on_tiles ? (int)(3 * u[1]) : 0;
      const double size = ldexp(1, level);
      const size_t *rect =
          tile > 0 ? tiles.tile[tile - 1].rect : (const size_t[]){0, SIDE, 0, SIDE};
      for (int k = 0; k < 2; k++) {
        const double low = (double)rect[2 * k], high = (double)rect[2 * k + 1];
        word[k] = (uint32_t)((low + (high - low - 0.01) * u[2 + k]) * 32768) << 5;
      }
      word[0] |= (uint32_t)tile >> 2;
      word[1] |= (uint32_t)(tile & 3) << 3 | (uint32_t)level;
      word[2] = halves(size * (6 * u[4] - 3), i % 9 == 0 ? 0 : size * (6 * u[5] - 3));
      for (int c = 0; c < 3; c++) {
        word[3 + c] = i % 7 == c ? 0 : (uint32_t)((wide ? 256.0 : 1) * UNITS * u[6 + c]);
        word[6 + c] = halves(size * (0.4 * u[9 + c] - 0.2), size * (0.4 * u[10 + c] - 0.2));
      }
      word[9] = i % 3 == 0 ? 0 : halves(size * (4 * u[12] - 2), size * (4 * u[13] - 2));
      word[10] = i % 5 == 0 ? 0 : halves(size * (u[14] - 0.5), size * (u[15] - 0.5));
      word[11] = halves(size * (0.3 + 0.5 * u[11]), i % 2 == 0 || level == 0 ? 0 : u[8]);
    }
    run_there(COUNT, edges, wide, on_tiles);
    run_here(COUNT, edges, wide, on_tiles);
    double all = 0, apart = 0;
    int64_t more = 0;
    for (size_t i = 0; i < 6 * TEXELS; i++) {
      const uint64_t there = wide ? sums[2 * i] | (uint64_t)sums[2 * i + 1] << 32 : sums[i];
      const uint64_t ours = wide ? here[2 * i] | (uint64_t)here[2 * i + 1] << 32 : here[i];
      const int64_t differs = (int64_t)(there - ours);
      all += (double)there;
      apart += fabs((double)differs);
      more += differs;
      if (llabs(differs) > (wide ? 8 * 256 : 8))
        fail_msg("case %d, word %zu: %" PRIu64 " for %" PRIu64, turn, i, ours, there);
    }
    assert_true(all > COUNT * (double)UNITS && apart < 2e-6 * all && more == 0);
  }
}

/* A thin line's spectrum: splats that are shifted each to where the next begins. */
TEST(rows_leave_no_gaps) {
  static splat splats[MOST];
  double worst = 0;
  for (int i = 0; i < 24; i++) {
    const double shift = 0.5 * pow(4, i / 23.0);
    size_t count = 0;
    for (double x = 8; x < 120; x += shift) {
      splats[count] = make(x, 64.3, 0.125, 0.125, 0);
      splats[count++].shift = shift;
    }
    run(splats, count, true);
    for (int x = 40; x < 88; x++) {
      double light = 0;
      for (int y = 60; y < 70; y++) light += sums[3 * (y * SIDE + x) + 1];
      worst = fmax(worst, fabs(light / (UNITS / shift) - 1));
    }
  }
  print_message("uneven by %g\n", worst);
  if (!(worst < 0.12)) fail_msg("uneven by %g", worst);
}
