/* Photons off mirrors: laws of spheres and of planes that face each other. */
#include "tests/validation/trace/walks/light_walks.h"

/* A room that is a ball, so far off that a small mirror's rays land by their direction alone. */
#define ROOM "- {name: room, shape: sphere, radius: 50, levels: 1, reflectance: 0.5}\n"

static double balance(const fixture *f) {
  const abbe_light_ledger *l = &f->ledger;
  return l->deposited + l->absorbed + l->missed + l->trapped + l->lost;
}

/* A ball in a beam sends as much in all directions: of N photons over its disk, rho / (4 pi) a
 * steradian. */
TEST(a_mirror_ball_shines_evenly) {
  static fixture f;
  make(CAMERA POINT_LIGHT FLOOR ROOM "- {name: ball, shape: sphere, radius: 0.05, levels: 2, "
                                     "transform: [{translate: [0, 0, 3]}], mirror: 0.8}\n",
       NULL, &f);
  enum { BATCHES = 64, BINS = 10 };
  double up[BINS] = {0}, all = 0;
  uint64_t random = 3;
  size_t shot = 0;
  for (uint32_t b = 0; b < BATCHES; b++) {
    for (uint32_t i = 0; i < BATCH; i++) {
      double x, y;
      do {
        x = random_between(&random, -0.05, 0.05);
        y = random_between(&random, -0.05, 0.05);
      } while (x * x + y * y > 0.05 * 0.05);
      const double from[3] = {x, 1, 3 + y}, d[3] = {0, -1, 0};
      f.photon[i] = photon_of(&f, from, d, i);
    }
    size_t count =
        abbe_light_walk_run(f.walk, &f.scene.light[0], b, f.photon, BATCH, f.hit, &f.ledger);
    for (size_t i = 0; i < count; i++) {
      double p[3], length = 0;
      abbe_geometry_to_world(&f.geometry, f.hit[i].p, p);
      if (f.hit[i].surface == 0) continue; /* the floor takes a little */
      p[2] -= 3;
      for (int k = 0; k < 3; k++) length += p[k] * p[k];
      /* along the beam: equal zones of the sphere are equal steps of the cosine */
      int bin = (int)((p[1] / sqrt(length) + 1) / 2 * BINS);
      up[bin < BINS ? bin : BINS - 1] += (double)f.hit[i].flux;
      all += (double)f.hit[i].flux;
    }
    shot += BATCH;
  }
  for (int i = 0; i < BINS; i++) {
    const double share = up[i] / all;
    assert_near(share, 1.0 / BINS, 5 * sqrt(0.09 / (double)shot) + 2e-3);
  }
  assert_near(f.ledger.reached, (double)shot, 1e-3);
  assert_near(f.ledger.absorbed / f.ledger.reached, 0.2, 1e-4);
  assert_near(balance(&f) / f.ledger.reached, 1, 1e-5);
  fixture_free(&f);
}

/* Between two mirrors that face each other a ray loses the same share each time. */
TEST(two_mirrors_take_their_share_each_time) {
  static fixture f;
  make(CAMERA POINT_LIGHT FLOOR
       "- {name: left, shape: rectangle, width: 1, height: 1, transform: [{rotate: {axis: [0, 1, "
       "0], angle: 90}}, {translate: [-0.35, 0, 0.7]}], mirror: 0.9}\n"
       "- {name: right, shape: rectangle, width: 1, height: 1, transform: [{rotate: {axis: [0, 1, "
       "0], angle: -90}}, {translate: [-0.25, 0, 0.7]}], mirror: 0.9}\n",
       NULL, &f);
  /* down by 0.2 at every crossing of 0.1, from 1.1: meets the left at 1.0, then 0.8, 0.6, 0.4 */
  const double from[3] = {-0.3, 0, 1.1}, d[3] = {-0.05, 0, -0.1};
  const size_t landed = shoot(&f, from, d, 1);
  assert_int_equal(landed, BATCH);
  for (size_t i = 0; i < landed; i++) assert_near((double)f.hit[i].flux, pow(0.9, 5), 1e-5);
  assert_near(balance(&f) / f.ledger.reached, 1, 1e-5);
  fixture_free(&f);
}

/* A black mirror takes all, a whole one nothing. */
TEST(reflectance_has_its_ends) {
  static const char *const value[] = {"0", "1"};
  for (int i = 0; i < 2; i++) {
    static fixture f;
    make(printed(
             CAMERA POINT_LIGHT FLOOR
             "- {name: plate, shape: rectangle, width: 1, height: 1, transform: [{rotate: {axis: "
             "[1, 0, 0], angle: 135}}, {translate: [0, 0, 0.8]}], mirror: %s}\n",
             value[i]),
         NULL, &f);
    const double from[3] = {0, -0.5, 0.8}, d[3] = {0, 1, 0};
    const size_t landed = shoot(&f, from, d, 1);
    assert_int_equal(landed, i == 0 ? 0 : BATCH);
    assert_near(f.ledger.absorbed, i == 0 ? BATCH : 0, 1e-6);
    fixture_free(&f);
  }
}

/* Glass on a mirror of silver: what goes through comes back through. */
TEST(light_goes_through_glass_off_a_mirror_and_back) {
  static fixture f;
  make(CAMERA POINT_LIGHT FLOOR ROOM SLAB(
           "flat") "- {name: plate, shape: rectangle, width: 1, height: 1, transform: [{translate: "
                   "[0, 0, 0.1]}], mirror: 1}\n",
       NULL, &f);
  const double from[3] = {0, 0, 1}, d[3] = {0, 0.01, -1};
  const size_t landed = shoot(&f, from, d, 4);
  assert_int_equal(landed, 4 * BATCH);
  double p[3];
  for (size_t i = 0; i < BATCH; i++) {
    abbe_geometry_to_world(&f.geometry, f.hit[i].p, p);
    assert_true(p[2] > 40);
  }
  assert_near(balance(&f) / f.ledger.reached, 1, 1e-5);
  fixture_free(&f);
}
