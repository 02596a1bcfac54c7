/* Maps of rays on parallelograms: a plate's beam stands where it should, keeps its flux and its
 * colour, and ends at what it meets first. */
#include "tests/check.h"

#include "base/maths.h"
#include "colorimetry/weights.h"
#include "scenes/volume/exits/exit_pages.h"
#include "scenes/volume/half.h"
#include "tests/scenes/scene_text.h"
#include "tests/scenes/volume/volume_lookup.h"

#define PLATE                                                                                      \
  CAMERA SUN FLOOR                                                                                 \
      "- {name: plate, shape: box, size: [0.2, 0.2, 0.02], material: flat, transform: "            \
      "[{translate: [0.1, 0, 0.5]}]}\n"

typedef struct bench {
  abbe_scene scene;
  abbe_volume_place place;
  abbe_caustic_volume volume;
} bench;

/* Points on the plate's upper side, which let light straight through to the lower. */
static void make_bench(size_t across, bench *b) {
  *b = (bench){0};
  b->scene = scene_of(PLATE);
  abbe_caustic_volume *v = &b->volume;
  *v = (abbe_caustic_volume){.kind = ABBE_VOLUME_EXITS, .min_nm = 380, .max_nm = 780};
  const abbe_region_desc region = {.side = 2, .outer = 1};
  OK(abbe_volume_body_make(&b->scene.object[1], &v->body, &error));
  OK(abbe_volume_body_find(&v->body, &b->scene.object[1], &b->place, &error));
  OK(abbe_volume_region_make(&region, &v->region, &error));
  OK(abbe_light_nodes_make(42, (const double[3]){0, 0, 1}, &v->nodes, &error));
  FREED abbe_exit_halves *point = calloc(across * across, sizeof *point);
  assert_non_null(point);
  const double r = v->body.radius;
  for (size_t i = 0; i < across * across; i++) {
    const double x = 0.2 * (((double)(i % across) + 0.5) / (double)across - 0.5),
                 y = 0.2 * (((double)(i / across) + 0.5) / (double)across - 0.5);
    point[i][ABBE_EXIT_POINT] = abbe_half_of(x / r);
    point[i][ABBE_EXIT_POINT + 1] = abbe_half_of(y / r);
    point[i][ABBE_EXIT_POINT + 2] = abbe_half_of(0.01 / r);
    point[i][ABBE_EXIT_NORMAL + 2] = abbe_half_of(1);
    point[i][ABBE_EXIT_BIN] = abbe_half_of((double)(i * 37 % ABBE_LIGHT_EXITS_BINS));
  }
  OK(abbe_light_exits_make(&v->nodes, across * across, (const abbe_exit_halves *)point, NULL, r,
                           0.04, v->region.cells, &v->exits, &error));
  for (size_t n = 0; n < v->nodes.count; n++)
    for (size_t i = 0; i < across * across; i++) {
      const uint32_t at = v->exits.at[n * v->exits.points + i];
      if (at == 0) continue;
      uint16_t *half = v->exits.exit[at - 1];
      memcpy(half + ABBE_EXIT_PLACE, point[i], 3 * sizeof *half);
      half[ABBE_EXIT_PLACE + 2] = abbe_half_of(-0.01 / r);
      for (int k = 0; k < 3; k++) half[ABBE_EXIT_WAY + k] = abbe_half_of(-v->nodes.direction[n][k]);
      half[ABBE_EXIT_CARRIED] = abbe_half_of(0.5);
      half[ABBE_EXIT_FACETS] = abbe_half_of(1);
      double axis[2][3];
      abbe_light_exits_axes(v->nodes.direction[n], axis[0], axis[1]);
      for (int a = 0; a < 2; a++)
        for (int k = 0; k < 3; k++) half[ABBE_EXIT_WAY_BY + 3 * a + k] = abbe_half_of(-axis[a][k]);
    }
}

static void bench_free(bench *b) {
  abbe_caustic_volume_free(&b->volume);
  abbe_scene_free(&b->scene);
}

static void make_pages(const bench *b, const double (*sheets)[9], size_t count,
                       const abbe_light *light, abbe_exit_pages *out) {
  const abbe_exit_light_desc desc = FIELDS(.light = light, .object = &b->scene.object[1],
                                           .place = &b->place, .min_nm = 380, .max_nm = 780);
  OK(abbe_exit_pages_make(&b->volume, &desc, sheets, count, 64, out, &error));
}

static const double floor_below[9] = {-1, -1, 0, 2, 0, 0, 0, 2, 0};

/* Half of the sun's light in the plate's shadow, and none beside it; all of it sums up, in the
 * sun's colour: of clear glass, of a mirror of one reflectance, and of a metal whose rays have
 * their own wavelengths. */
static void check_beam(bool mirror, bool metal) {
  OWNED(abbe_exit_pages, pages) = {0};
  FILLED(bench, b, make_bench(120, &b));
  static const abbe_material any = {0};
  b.scene.object[1].mirror = mirror;
  b.scene.object[1].conductor = metal ? &any : NULL;
  abbe_light *sun = &b.scene.light[0];
  const double *d = sun->direction;
  make_pages(&b, (const double(*)[9]) & floor_below, 1, sun, &pages);
  assert_near(pages.flux, 0.5 * 0.04 * -d[2], 1e-4);
  assert_near(pages.window[1][2], 0, 0);                              /* nothing comes from below */
  const double x = 0.1 - d[0] / d[2] * 0.49, y = -d[1] / d[2] * 0.49; /* the beam's middle */
  for (int i = -4; i <= 4; i++) {
    double xyz[3], off[3], white[3];
    abbe_weights_white(ABBE_OBSERVER_CIE_1931, &sun->illuminant, 380, 780, white);
    abbe_exit_pages_at(&pages, 0, (x + 0.02 * i + 1) / 2, (y + 1) / 2, xyz);
    abbe_exit_pages_at(&pages, 0, (x + 1) / 2, (y + 0.15 + 1) / 2, off);
    for (int k = 0; k < 3; k++) {
      assert_near(xyz[k], 0.5 * -d[2] * white[k], 0.01); /* every ray is of all wavelengths */
      assert_near(off[k], 0, 1e-6);
    }
  }
  b.scene.object[1].conductor = NULL;
}

TEST(a_beam_on_a_floor) {
  check_beam(false, false);
  check_beam(true, false);
  check_beam(true, true);
}

/* A roof over half of the floor takes what is above it, on its upper side. */
TEST(the_first_sheet_takes_it) {
  OWNED(abbe_exit_pages, pages) = {0};
  FILLED(bench, b, make_bench(40, &b));
  const double *d = b.scene.light[0].direction;
  const double middle = 0.1 - d[0] / d[2] * 0.29; /* of the beam at the roof's height */
  double sheets[2][9] = {{0}, {middle, -1, 0.2, 0, 2, 0, 2, 0, 0}};
  memcpy(sheets[0], floor_below, sizeof floor_below);
  make_pages(&b, (const double(*)[9])sheets, 2, &b.scene.light[0], &pages);
  double sum[4] = {0};
  for (size_t page = 0; page < 4; page++)
    for (size_t i = 0; i < 2 * 64 * 64; i++) {
      const float *w = pages.window[page];
      const double texel = 4.0 / (64 * 64) / (i < 64 * 64 ? 1 : (double)(w[2] * w[3]));
      if (w[2] > 0) sum[page] += texel * (double)pages.value[page * 2 * 64 * 64 + i][1];
    }
  /* U x V of the roof points down */
  assert_near(sum[0] + sum[3], pages.flux, 1e-6);
  assert_near(sum[3] / pages.flux, 0.5, 0.02);
  assert_near(sum[1] + sum[2], 0, 0);
}

/* A lid over half of the plate hides the sun from that half. */
TEST(what_hides_the_light) {
  OWNED(abbe_exit_pages, pages) = {0};
  FILLED(bench, b, make_bench(40, &b));
  const double *d = b.scene.light[0].direction;
  const double middle = 0.1 + d[0] / d[2] * 0.2; /* over the plate's, on the way to the sun */
  double sheets[2][9] = {{0}, {middle, -1, 0.71, 0, 2, 0, 2, 0, 0}};
  memcpy(sheets[0], floor_below, sizeof floor_below);
  make_pages(&b, (const double(*)[9])sheets, 2, &b.scene.light[0], &pages);
  assert_near(pages.flux, 0.25 * 0.04 * -d[2], 2e-4);
}

TEST(requests) {
  abbe_exit_pages pages;
  FILLED(bench, b, make_bench(4, &b));
  const abbe_exit_light_desc desc = {
      .light = &b.scene.light[0], .object = &b.scene.object[1], .place = &b.place};
  assert_int_equal(abbe_exit_pages_make(&b.volume, &desc, (const double(*)[9]) & floor_below, 1, 0,
                                        &pages, NULL),
                   ABBE_INVALID_ARGUMENT);
  abbe_light_exits_free(&b.volume.exits);
  assert_int_equal(abbe_exit_pages_make(&b.volume, &desc, (const double(*)[9]) & floor_below, 1, 8,
                                        &pages, NULL),
                   ABBE_INVALID_ARGUMENT);
}

/* Parallelograms that rays meet: known places, the first of two, parts by the index, sides, and
 * what hides the light, of an object that stands turned. */

/* A quarter turn about y: the object's x is down, its z the world's x. */
static const abbe_volume_place place = {.centre = {1, 2, 3}, .turn = {0, 0, 1, 0, 1, 0, -1, 0, 0}};
/* The floor at z = 0, U x V up, and a shelf at z = 1 over x > 1, U x V down. */
static const double floor_and_shelf[2][9] = {{-4, -4, 0, 10, 0, 0, 0, 10, 0},
                                             {1, -4, 1, 0, 10, 0, 5, 0, 0}};

static void make_sheets(abbe_exit_sheet sheet[2]) {
  for (int i = 0; i < 2; i++) abbe_exit_sheet_make(floor_and_shelf[i], &place, &sheet[i]);
  assert_near(sheet[0].area, 100, 1e-12);
  assert_near(sheet[1].area, 50, 1e-12);
}

/* Straight down from the object's middle, and by the index 0.5 m to the side for a step of 1. */
static const abbe_exit_ray down = {.way = {1, 0, 0}, .place_by = {0, 0, -0.5}, .share = 1};

static void meet(size_t first, size_t sheets, const float *step, size_t parts,
                 abbe_exit_landing *at) {
  abbe_exit_sheet sheet[2];
  abbe_exit_track track[2];
  make_sheets(sheet);
  abbe_exit_sheets_track(sheet + first, sheets, &down, track);
  abbe_exit_sheets_meet(track, sheets, step, parts, at);
}

TEST(parts) {
  const float step[ABBE_EXIT_MOST_PARTS] = {0, 1, 2, -1, 20};
  abbe_exit_landing at;
  meet(0, 1, step, 5, &at);
  for (int i = 0; i < 4; i++) {
    assert_int_equal(at.page[i], 0);
    assert_near((double)at.far[i], 3, 1e-6);
    assert_near((double)at.u[i], (1 - 0.5 * (double)step[i] + 4) / 10, 1e-6);
    assert_near((double)at.v[i], 0.6, 1e-6);
  }
  assert_int_equal(at.page[4], -1); /* beside the floor */
}

TEST(the_first) {
  const float step[ABBE_EXIT_MOST_PARTS] = {0.1f, -1};
  abbe_exit_landing at;
  meet(0, 2, step, 2, &at);
  assert_int_equal(at.page[0], 0); /* beside the shelf */
  assert_int_equal(at.page[1], 3); /* on it, which is met along its normal */
  assert_near((double)at.far[1], 2, 1e-6);
  assert_near((double)at.u[1], 0.6, 1e-6);
  assert_near((double)at.v[1], 0.1, 1e-6);
  meet(1, 1, step, 1, &at);
  assert_int_equal(at.page[0], -1);
}

TEST(hiding) {
  static const double up[3] = {-1, 0, 0}, below[3] = {2.5, 0, 0.5}, on[3] = {2, 0, 0.5};
  abbe_exit_sheet sheet[2];
  make_sheets(sheet);
  assert_true(abbe_exit_sheets_hide(sheet, 2, below, up, INFINITY));
  assert_false(abbe_exit_sheets_hide(sheet, 2, below, up, 0.4));
  assert_false(abbe_exit_sheets_hide(sheet, 1, below, up, INFINITY)); /* the floor is behind it */
  assert_false(abbe_exit_sheets_hide(sheet, 2, on, up, INFINITY));    /* what stands on the shelf */
}

/* Maps that light is laid on: its sum and its middle stay, tents are as wide as asked for, and even
 * light stays even up to the ends. */

enum { SIDE = 48 };

static float map[SIDE * SIDE][4], smooth[SIDE * SIDE][4];

/* Of a channel: its sum, the mean of x and of y, and their variances. */
static void find_moments(const float (*of)[4], int channel, double moment[5]) {
  memset(moment, 0, 5 * sizeof *moment);
  for (int i = 0; i < SIDE * SIDE; i++) {
    const double v = (double)of[i][channel], x = i % SIDE + 0.5, y = i / SIDE + 0.5;
    moment[0] += v;
    moment[1] += v * x;
    moment[2] += v * y;
    moment[3] += v * x * x;
    moment[4] += v * y * y;
  }
  for (int k = 1; k < 5; k++) moment[k] /= moment[0];
  for (int k = 3; k < 5; k++) moment[k] -= moment[k - 2] * moment[k - 2];
}

TEST(tents) {
  static const float value[4] = {1, 2, 3, 0}, wide[2] = {7.5f, 3.25f};
  double moment[5];
  memset(map, 0, sizeof map);
  abbe_exit_map_add(map, SIDE, 20.3f, 24.9f, value);
  for (int channel = 0; channel < 3; channel++) {
    find_moments((const float(*)[4])map, channel, moment);
    assert_near(moment[0], channel + 1, 1e-6);
    assert_near(moment[1], 20.3, 1e-5);
    assert_near(moment[2], 24.9, 1e-5);
    abbe_exit_map_smooth((const float(*)[4])map, SIDE, wide, smooth);
    find_moments((const float(*)[4])smooth, channel, moment);
    assert_near(moment[0], channel + 1, 1e-5);
    assert_near(moment[1], 20.3, 1e-4);
    assert_near(moment[2], 24.9, 1e-4);
    for (int a = 0; a < 2; a++) /* a place among texels has a share of 1/4 at the most */
      assert_near(moment[3 + a], (double)(wide[a] * wide[a]) / 6, 0.13);
  }
}

/* At the ends nothing is lost, and an even map is even. */
TEST(ends) {
  static const float value[4] = {1, 0, 0, 0}, wide[2] = {9, 200};
  static const float spot[][2] = {{0, 0}, {SIDE, 0}, {0.2f, SIDE}, {SIDE, SIDE}, {-1, 3}};
  double moment[5];
  for (size_t i = 0; i < sizeof spot / sizeof *spot; i++) {
    memset(map, 0, sizeof map);
    abbe_exit_map_add(map, SIDE, spot[i][0], spot[i][1], value);
    abbe_exit_map_smooth((const float(*)[4])map, SIDE, wide, smooth);
    find_moments((const float(*)[4])smooth, 0, moment);
    assert_near(moment[0], 1, 1e-5);
  }
  for (int i = 0; i < SIDE * SIDE; i++) map[i][1] = 0.5f;
  abbe_exit_map_smooth((const float(*)[4])map, SIDE, wide, smooth);
  for (int i = 0; i < SIDE * SIDE; i++) assert_near((double)smooth[i][1], 0.5, 1e-6);
}

/* Narrow tents are what a place is already; a map of one texel has it all. */
TEST(narrow) {
  static const float value[4] = {1, 2, 3, 4}, wide[2] = {1, 0.5f}, wider[2] = {5, 5};
  float one[1][4] = {{0}}, out[1][4];
  memset(map, 0, sizeof map);
  abbe_exit_map_add(map, SIDE, 10.6f, 11.2f, value);
  abbe_exit_map_smooth((const float(*)[4])map, SIDE, wide, smooth);
  assert_memory_equal(map, smooth, sizeof map);
  abbe_exit_map_add(one, 1, 0.7f, 0.1f, value);
  abbe_exit_map_smooth((const float(*)[4])one, 1, wider, out);
  for (int k = 0; k < 4; k++) assert_near((double)out[0][k], (double)value[k], 1e-6);
}
