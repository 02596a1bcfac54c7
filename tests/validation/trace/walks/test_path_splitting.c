/* Photons that part at interfaces carry the same light as those that choose. */
#include "tests/validation/trace/walks/light_walks.h"

#include "validation/trace/walks/path_splitting.h"

/* A photon that goes both ways brings as much to the floor as many that choose, and the books close
 * as before. */
TEST(parted_light_is_the_same_light) {
  static const char *const scenes[] = {CAMERA POINT_LIGHT FLOOR BALL("flat"),
                                       CAMERA POINT_LIGHT FLOOR BALL("smoke"),
                                       CAMERA POINT_LIGHT FLOOR SHELL};
  for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
    double landed[1 << ABBE_PHOTON_SPLITS], reached = 0;
    for (unsigned parts = 0; parts < 1u << ABBE_PHOTON_SPLITS; parts++) {
      static fixture f;
      make(scenes[i], NULL, &f);
      abbe_light_walk_split(f.walk, parts);
      flood(&f, 64);
      const abbe_light_ledger *l = &f.ledger;
      double sum = l->deposited + l->absorbed + l->missed + l->trapped + l->lost;
      assert_near(sum / l->reached, 1, 1e-6);
      if (parts == 0) reached = l->reached;
      assert_true(l->reached == reached);
      landed[parts] = l->deposited;
      fixture_free(&f);
    }
    /* the share that lands is that of some 20000 photons: four standard deviations, of two means */
    for (unsigned parts = 1; parts < 1u << ABBE_PHOTON_SPLITS; parts++)
      assert_near(landed[parts] / reached, landed[0] / reached, 4 * sqrt(2 * 0.25 / reached));
  }
}

/* On a slab nothing is left to chance at the two interfaces where photons part. */
TEST(parting_gives_fresnels_share_exactly) {
  static const double down[3] = {0, 0, -1}, above[3] = {0.1, 0.05, 0.9};
  static fixture f;
  make(CAMERA POINT_LIGHT FLOOR SLAB("flat"), NULL, &f);
  abbe_light_walk_split(f.walk, 3);
  size_t count = shoot(&f, above, down, 1);
  const double r = 0.04;
  size_t straight = 0;
  for (size_t i = 0; i < count; i++) {
    double flux = (double)f.hit[i].flux;
    straight += fabs(flux - (1 - r) * (1 - r)) < 1e-5;
    assert_true(fabs(flux - (1 - r) * (1 - r)) < 1e-5 || flux < r * (1 + 1e-5));
  }
  assert_int_equal(straight, BATCH);
  fixture_free(&f);
}

TEST(parts_are_where_the_rare_way_lands) {
  const struct {
    float common[2], rare[2];
    size_t rare_of_100;
    unsigned parts;
  } cases[] = {
      {{0.96f, 0.96f}, {0.04f, 1}, 0, 0},       {{0.96f, 0.96f}, {0.96f, 0.04f}, 10, 0},
      {{0.96f, 0.96f}, {0.96f, 0.04f}, 100, 2}, {{0.96f, 0.96f}, {0.04f, 1}, 90, 1},
      {{0.04f, 1}, {0.96f, 0.04f}, 50, 3},      {{1, 1}, {1, 1}, 50, 0},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    abbe_photon_hit hit[100];
    memset(hit, 0, sizeof hit);
    for (size_t k = 0; k < 100; k++) {
      hit[k].flux = 2;
      memcpy(hit[k].chance, k < cases[i].rare_of_100 ? cases[i].rare : cases[i].common,
             sizeof hit[k].chance);
    }
    assert_int_equal(abbe_path_splitting_best(hit, 100), cases[i].parts);
  }
  assert_int_equal(abbe_path_splitting_best(NULL, 0), 0);
}
