/* Maps of rays on parallelograms: a plate's beam stands where it should, keeps its flux and its
 * colour, and ends at what it meets first. */
#include "tests/scenes/scene_text.h"

#include "base/maths.h"
#include "colorimetry/weights.h"
#include "scenes/volume/exits/exit_pages.h"
#include "scenes/volume/half.h"

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
