/* Sixteen paths side by side inside a solid against one at a time, and their light's whereabouts.
 */
#include "tests/random.h"
#include "tests/scenes/scene_text.h"

#include "validation/trace/transport/geometry.h"
#include "validation/trace/transport/interface.h"
#include "validation/trace/transport/random.h"
#include "validation/trace/walks/inner_walk.h"

enum { PATHS = 500 };

#define STONE                                                                                      \
  CAMERA POINT_LIGHT FLOOR                                                                         \
      "- {name: stone, shape: brilliant, diameter: 0.1, transform: [{translate: [0, 0, 0.2]}], "   \
      "material: crown}\n"

typedef struct fixture {
  abbe_scene scene;
  abbe_geometry g;
  abbe_inner_rules rules;
  abbe_light_ledger ledger;
  uint64_t rays;
  abbe_inner_path path[PATHS];
} fixture;

static float dot(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Paths from the surface into the solid. */
static void make(const char *text, float eta, float attenuation, fixture *f) {
  memset(f, 0, sizeof *f);
  f->scene = scene_of(text);
  OK(abbe_geometry_make(&f->scene, &f->g, &error));
  f->rules = (abbe_inner_rules){.seed = 3, .pass = 2, .shift = {7, 1u << 20, 5, 11}};
  uint64_t random = 11;
  for (uint32_t i = 0; i < PATHS; i++) {
    const float middle[3] = {0};
    float away[3], n[3], p[3], d[3];
    for (int k = 0; k < 3; k++) away[k] = (float)random_between(&random, -1, 1);
    float length = sqrtf(dot(away, away));
    for (int k = 0; k < 3; k++) away[k] /= length;
    abbe_solid_leave(&f->g.solid[0], middle, away, p, n);
    for (int k = 0; k < 3; k++) d[k] = 0.6f * (float)random_between(&random, -1, 1) - n[k];
    length = sqrtf(dot(d, d));
    f->path[i] = (abbe_inner_path){.p = {p[0], p[1], p[2]},
                                   .d = {d[0] / length, d[1] / length, d[2] / length},
                                   .eta = eta,
                                   .attenuation = attenuation,
                                   .flux = 1,
                                   .full = 1,
                                   .y = 1,
                                   .carried = 1,
                                   .id = i,
                                   .steps = 1};
  }
}

static void run(fixture *f) {
  abbe_ray_record record = {0};
  abbe_inner_walk(&f->g.solid[0], &f->rules, f->path, PATHS, &f->ledger, &record, &f->rays);
}

static void fixture_free(fixture *f) {
  abbe_geometry_free(&f->g);
  abbe_scene_free(&f->scene);
}

/* One path at a time, with the interface's own laws. Returns the least difference between a number
 * and the reflectance that it was held against: rounding may decide otherwise where it is 0. */
static float follow_alone(const fixture *f, const abbe_inner_path *from, abbe_inner_path *out) {
  *out = *from;
  float closest = 1;
  while (out->steps < 64) {
    float p[3], n[3], bits[4], d[3], cos_t;
    abbe_solid_leave(&f->g.solid[0], out->p, out->d, p, n);
    abbe_random4(out->id, out->steps, f->rules.pass, f->rules.seed, bits);
    float chance = bits[0];
    if (out->steps < ABBE_EVEN_STEPS)
      chance =
          abbe_random_float(out->id * abbe_even_ratio[out->steps] + f->rules.shift[out->steps]);
    float cos_i = fminf(dot(out->d, n), 1), back[3] = {-n[0], -n[1], -n[2]};
    float share = abbe_interface_reflectance(cos_i, out->eta, &cos_t);
    closest = fminf(closest, fabsf(chance - share));
    out->steps++;
    memcpy(out->p, p, sizeof p);
    if (chance < share) {
      abbe_interface_reflect(out->d, back, cos_i, d);
      memcpy(out->d, d, sizeof d);
      continue;
    }
    abbe_interface_refract(out->d, back, out->eta, cos_i, cos_t, d);
    memcpy(out->d, d, sizeof d);
    return closest;
  }
  return 0;
}

TEST(every_lane_is_one_path) {
  static const char *const text[] = {STONE, CAMERA POINT_LIGHT FLOOR BALL("crown")};
  for (int i = 0; i < 2; i++) {
    static fixture f, alone;
    make(text[i], 1.6f, 0, &f);
    make(text[i], 1.6f, 0, &alone);
    run(&f);
    size_t same = 0, long_ones = 0;
    for (size_t k = 0; k < PATHS; k++) {
      abbe_inner_path one;
      if (follow_alone(&alone, &alone.path[k], &one) < 1e-4f || one.steps > 12) continue;
      const abbe_inner_path *p = &f.path[k];
      if (p->steps != one.steps) continue; /* an edge was met on the other side */
      float off = 0;
      for (int c = 0; c < 3; c++) off = fmaxf(off, fabsf(p->d[c] - one.d[c]));
      same += off < 1e-3f;
      long_ones += one.steps > 4;
      assert_int_equal(p->end, ABBE_INNER_LEFT);
    }
    assert_true(same > PATHS * 8 / 10);
    if (i == 0) assert_true(long_ones > PATHS / 20);
    fixture_free(&f);
    fixture_free(&alone);
  }
}

TEST(light_leaves_or_is_absorbed) {
  static fixture f;
  make(STONE, 2.4f, 0.3f, &f);
  run(&f);
  double left = 0, gone = 0;
  for (size_t k = 0; k < PATHS; k++) {
    if (f.path[k].end == ABBE_INNER_LEFT) left += (double)f.path[k].flux;
    if (f.path[k].end == ABBE_INNER_GONE) gone++;
  }
  assert_near((left + f.ledger.absorbed) / PATHS, 1, 1e-5);
  assert_true(f.ledger.absorbed > 0.1 * PATHS && left > 0.1 * PATHS);
  assert_true(gone > 0);
  assert_true(f.rays > 2 * PATHS);
  fixture_free(&f);
}

/* In a sphere the share of what is absorbed on a chord is known. */
TEST(a_chord_absorbs_by_its_length) {
  static fixture f;
  make(CAMERA POINT_LIGHT FLOOR BALL("crown"), 1, 0.7f, &f);
  const float radius = f.g.solid[0].radius;
  static fixture before;
  before = f;
  run(&f);
  for (size_t k = 0; k < PATHS; k++) {
    float from[3], chord = 0;
    for (int c = 0; c < 3; c++) from[c] = before.path[k].p[c] - f.g.solid[0].centre[c];
    chord = -2 * dot(from, before.path[k].d);
    assert_true(chord > 0 && chord <= 2.0001f * radius);
    assert_near((double)f.path[k].flux, exp(-0.7 * (double)chord), 1e-5);
    assert_int_equal(f.path[k].steps, 2);
  }
  fixture_free(&f);
}

TEST(the_order_has_no_part_in_it) {
  static fixture f, turned;
  make(STONE, 2.4f, 0.3f, &f);
  make(STONE, 2.4f, 0.3f, &turned);
  for (size_t k = 0; k < PATHS; k++) turned.path[k] = f.path[PATHS - 1 - k];
  run(&f);
  run(&turned);
  for (size_t k = 0; k < PATHS; k++) {
    const abbe_inner_path *a = &f.path[k], *b = &turned.path[PATHS - 1 - k];
    assert_int_equal(a->end, b->end);
    assert_int_equal(a->steps, b->steps);
    assert_memory_equal(&a->flux, &b->flux, sizeof a->flux);
    assert_memory_equal(a->p, b->p, sizeof a->p);
    assert_memory_equal(a->d, b->d, sizeof a->d);
  }
  fixture_free(&f);
  fixture_free(&turned);
}

/* Light at more than the critical angle goes round in a ball for ever. */
TEST(what_never_leaves_is_lost) {
  static fixture f;
  make(CAMERA POINT_LIGHT FLOOR BALL("crown"), 1.5f, 0, &f);
  const float *c = f.g.solid[0].centre, radius = f.g.solid[0].radius;
  for (size_t k = 0; k < PATHS; k++) {
    for (int i = 0; i < 3; i++) f.path[k].p[i] = c[i] + (i == 0 ? radius : 0);
    const float d[3] = {-0.6f, 0.8f, 0};
    memcpy(f.path[k].d, d, sizeof d);
  }
  run(&f);
  for (size_t k = 0; k < PATHS; k++) {
    assert_int_equal(f.path[k].end, ABBE_INNER_LOST);
    assert_int_equal(f.path[k].steps, ABBE_INNER_MAX_STEPS);
  }
  fixture_free(&f);
}

TEST(matched_physics_ends_where_the_renderer_does) {
  static fixture f;
  make(STONE, 2.4f, 0, &f);
  f.rules.physics = (abbe_physics){.matched = true, .orders = 3, .energy_share = 1e-3};
  run(&f);
  size_t trapped = 0;
  for (size_t k = 0; k < PATHS; k++) {
    const abbe_inner_path *p = &f.path[k];
    assert_true(p->inner == p->steps - 1);
    assert_true(p->inner <= 3);
    if (p->end == ABBE_INNER_TRAPPED) {
      trapped++;
      assert_true(p->inner == 3 || (double)p->carried < 1e-3);
    }
  }
  assert_true(trapped > PATHS / 10 && trapped < PATHS);
  fixture_free(&f);
}
