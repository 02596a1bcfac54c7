#include "tests/check.h"

#include "tests/validation/trace/walks/light_walks.h"
#include "validation/trace/walks/light_walk.h"

/* What reached refractors went somewhere. Photons keep their flux but for absorption, whose
 * roulette is counted as absorbed, gained or lost: the ledger closes to rounding. */
TEST(the_books_close) {
  static const abbe_physics matched = {.matched = true, .orders = 3, .energy_share = 0.001};
  static const char *const scenes[] = {
      CAMERA POINT_LIGHT FLOOR BALL("flat"), CAMERA POINT_LIGHT FLOOR BALL("smoke"),
      CAMERA POINT_LIGHT FLOOR BRICK("smoke") BALL("crown"), CAMERA POINT_LIGHT FLOOR RING("crown"),
      CAMERA POINT_LIGHT FLOOR SHELL};
  for (size_t i = 0; i < 2 * (sizeof scenes / sizeof *scenes); i++) {
    static fixture f;
    make(scenes[i / 2], i % 2 ? &matched : NULL, &f);
    flood(&f, 8);
    const abbe_light_ledger *l = &f.ledger;
    assert_true(l->reached > 0.05 * (double)f.photons);
    double sum = l->deposited + l->absorbed + l->missed + l->trapped + l->lost;
    assert_near(sum / l->reached, 1, 1e-6);
    assert_true(i % 2 ? l->trapped > 0 : l->trapped == 0);
    assert_true(l->contact == 0);
    assert_true(l->lost <= 1e-4 * l->reached);
    fixture_free(&f);
  }
}

/* 4 % at each face and back and forth between them: 2 r / (1 + r) comes back. */
TEST(fresnels_share_at_normal_incidence) {
  static fixture f;
  make(CAMERA POINT_LIGHT FLOOR SLAB("flat"), NULL, &f);
  double r = 0.04, back = 2 * r / (1 + r);
  size_t landed = shoot(&f, (double[3]){0.02, 0.01, 0.6}, (double[3]){0, 0, -1}, 40);
  check_share((double)landed, (double)f.photons, 1 - back);
  check_share(f.ledger.missed, (double)f.photons, back);
  assert_near(f.ledger.reached, (double)f.photons, 0);
  fixture_free(&f);
}

/* A slab of 0.1 m that keeps exp(-a d) of the light at each crossing: T = (1-r)^2 k / (1 - r^2 k^2)
 * lands, r + T r k escapes. */
TEST(beer_and_lambert) {
  static fixture f;
  make(CAMERA POINT_LIGHT FLOOR SLAB("smoke"), NULL, &f);
  double landed = 0, r = 0.04, expected = 0;
  shoot(&f, (double[3]){0.02, 0.01, 0.6}, (double[3]){0, 0, -1}, 40);
  landed = f.ledger.deposited / (double)f.photons;
  for (uint32_t k = 0; k < STEPS; k++) {
    double nm = 500 + 100.0 * (k + 0.5) / STEPS, a = 20 - 15 * (nm - 400) / 300;
    double keep = exp(-a * 0.1);
    expected += pow(1 - r, 2) * keep / (1 - r * r * keep * keep) / STEPS;
  }
  /* what a photon lands with varies by no more than what it lands at all */
  assert_near(landed, expected, 4 * 0.3 / sqrt((double)f.photons));
  assert_true(f.ledger.absorbed > 0.5 * (double)f.photons);
  fixture_free(&f);
}

/* A roof of 90 degrees over a base: what enters the base from below meets both slanted faces at 45
 * degrees, beyond the critical angle of 41.8, and comes back down whole. */
TEST(total_reflection_lets_nothing_through) {
  static fixture f;
  make(CAMERA POINT_LIGHT FLOOR "- {name: roof, shape: prism, apex: 90, side: 0.2, length: 0.4, "
                                "transform: [{translate: [0, 0, 0.3]}], material: flat}\n",
       NULL, &f);
  size_t landed = shoot(&f, (double[3]){0.04, 0.01, 0.1}, (double[3]){0, 0, 1}, 4);
  assert_int_equal(landed, f.photons);
  assert_near(f.ledger.deposited, (double)f.photons, 1e-6);
  fixture_free(&f);
}

/* Along the axis through ball in ball: four interfaces, of which the inner two hardly reflect. */
TEST(nested_glass_reflects_by_the_two_indices) {
  static fixture f;
  make(CAMERA POINT_LIGHT FLOOR SHELL, NULL, &f);
  shoot(&f, (double[3]){0, 0, 0.6}, (double[3]){0, 0, -1}, 40);
  /* on the axis light goes to and fro between four mirrors; incoherent sum of the stack's
   * transmittance: 1/T = 1 + sum of r_i / (1 - r_i) */
  double mean = 0;
  for (uint32_t k = 0; k < STEPS; k++) {
    double um = (500 + 100.0 * (k + 0.5) / STEPS) / 1000, n = 1.5 + 0.006 / (um * um);
    double inner = pow((n - 1.5) / (n + 1.5), 2), outer = 0.04;
    mean += 1 / (1 + 2 * outer / (1 - outer) + 2 * inner / (1 - inner)) / STEPS;
  }
  check_share(f.ledger.deposited, (double)f.photons, mean);
  assert_true(f.ledger.lost == 0);
  fixture_free(&f);
}

/* A refractor of index 1 is not there: light goes straight on, by one path. */
TEST(glass_of_index_one_is_not_there) {
  static fixture f;
  make(CAMERA POINT_LIGHT FLOOR BALL("flat"), NULL, &f);
  for (size_t k = 0; k <= STEPS; k++) f.media.n[k] = 1;
  double from[3] = {0.05, 0.03, 0.6}, d[3] = {-0.08, -0.01, -0.4};
  size_t landed = shoot(&f, from, d, 1);
  assert_int_equal(landed, BATCH);
  double p[3], t = 0.6 / 0.4;
  for (size_t i = 0; i < landed; i++) {
    abbe_geometry_to_world(&f.geometry, f.hit[i].p, p);
    for (int k = 0; k < 3; k++) assert_near(p[k], from[k] + t * d[k], 1e-6);
    assert_true(f.hit[i].side > 0 && f.hit[i].surface == 0);
  }
  fixture_free(&f);
}

/* Light that meets no refractor is the eye's business. */
TEST(light_that_misses_is_not_counted) {
  static fixture f;
  make(CAMERA POINT_LIGHT FLOOR BALL("flat"), NULL, &f);
  assert_int_equal(shoot(&f, (double[3]){0.5, 0.3, 0.6}, (double[3]){0, 0, -1}, 1), 0);
  assert_int_equal(shoot(&f, (double[3]){0.5, 0.3, 0.6}, (double[3]){0, 0, 1}, 1), 0);
  static const abbe_light_ledger empty = {0};
  assert_memory_equal(&f.ledger, &empty, sizeof empty);
  /* photons of no flux, or of none that is a number, go nowhere */
  for (uint32_t i = 0; i < BATCH; i++) {
    f.photon[i] = photon_of(&f, (double[3]){0, 0, 0.6}, (double[3]){0, 0, -1}, i);
    f.photon[i].flux = i % 2 ? 0 : NAN;
  }
  assert_int_equal(
      abbe_light_walk_run(f.walk, &f.scene.light[0], 0, f.photon, BATCH, f.hit, &f.ledger), 0);
  assert_memory_equal(&f.ledger, &empty, sizeof empty);
  assert_int_equal(abbe_light_walk_run(f.walk, &f.scene.light[0], 0, f.photon, 0, f.hit, &f.ledger),
                   0);
  fixture_free(&f);
  /* another lamp in its way takes it, which nothing counts either */
  make(CAMERA POINT_LIGHT "- {name: panel, kind: rectangle, position: [0.5, 0.3, 0.4], direction: "
                          "[0, 0, 1], width: 0.2, "
                          "height: 0.2, radiance: 1}\n" FLOOR BALL("flat"),
       NULL, &f);
  for (int i = 0; i < 2; i++)
    assert_int_equal(shoot(&f, (double[3]){0.5, 0.3, 0.6 * i}, (double[3]){0, 0, 1 - 2 * i}, 1), 0);
  assert_memory_equal(&f.ledger, &empty, sizeof empty);
  fixture_free(&f);
}

/* Matched rules, on a slab at normal incidence: what the outside mirrors goes on (4 %), what is
 * reflected inside more often than `orders` walls allow is dropped. */
TEST(matched_rules_drop_what_they_say) {
  static fixture f;
  double r = 0.04;
  for (size_t orders = 1; orders <= 3; orders++) {
    const abbe_physics physics = {.matched = true, .orders = orders, .energy_share = 0};
    make(CAMERA POINT_LIGHT FLOOR SLAB("flat"), &physics, &f);
    shoot(&f, (double[3]){0.02, 0.01, 0.6}, (double[3]){0, 0, -1}, 20);
    /* walls met: 1 leaves below, 2 above, 3 below; reflections at the last wall are dropped */
    double below = (1 - r) * (1 - r) * (1 + (orders >= 3 ? r * r : 0));
    double above = orders >= 2 ? (1 - r) * r * (1 - r) : 0;
    check_share(f.ledger.deposited, (double)f.photons, below);
    check_share(f.ledger.missed, (double)f.photons, above + r);
    check_share(f.ledger.trapped, (double)f.photons, 1 - below - above - r);
    fixture_free(&f);
  }
  /* below a share of 1 % no order is left: (1 - r) r = 3.8 % goes on, (1 - r) r^2 does not */
  const abbe_physics faint = {.matched = true, .orders = 8, .energy_share = 0.01};
  make(CAMERA POINT_LIGHT FLOOR SLAB("flat"), &faint, &f);
  shoot(&f, (double[3]){0.02, 0.01, 0.6}, (double[3]){0, 0, -1}, 20);
  check_share(f.ledger.deposited, (double)f.photons, (1 - r) * (1 - r));
  check_share(f.ledger.missed, (double)f.photons, (1 - r) * r * (1 - r) + r);
  fixture_free(&f);
}

/* Matched: light that has left one refractor meets the next, by the same rules. */
TEST(matched_light_passes_two_refractors) {
  static const abbe_physics matched = {.matched = true, .orders = 3, .energy_share = 0};
  static fixture f;
  const char *two = CAMERA POINT_LIGHT FLOOR SLAB(
      "flat") "- {name: ball, shape: sphere, radius: 0.05, transform: [{translate: [0, 0, 0.15]}], "
              "material: flat}\n";
  double r = 0.04, from[3] = {0, 0, 0.6}, down[3] = {0, 0, -1};
  make(two, &matched, &f);
  shoot(&f, from, down, 20);
  /* straight through four faces, or to and fro once between the first two: what the third face
   * sends back is the third interface after the first at the next */
  check_share(f.ledger.deposited, (double)f.photons, pow(1 - r, 4) * (1 + r * r));
  fixture_free(&f);
  make(two, NULL, &f);
  shoot(&f, from, down, 20);
  /* four faces on one axis: 1/T = 1 + 4 r / (1 - r) */
  check_share(f.ledger.deposited, (double)f.photons, 1 / (1 + 4 * r / (1 - r)));
  fixture_free(&f);
}

/* What lands where other receivers hide it from the lamp is told from the rest, in either physics.
 */
TEST(light_that_the_lamp_does_not_see_is_hidden) {
  static const abbe_physics matched = {.matched = true, .orders = 4, .energy_share = 0};
  static fixture f;
  /* the ray bends at the brick's slanted way and gets around the lid's edge to the floor */
  const char *text = CAMERA
      "lights:\n- {name: lamp, kind: point, position: [-0.5, 0, 0.62], intensity: 1}\n" FLOOR SLAB(
          "flat") "- {name: lid, shape: rectangle, width: 0.4, height: 0.4, transform: "
                  "[{translate: [0.2005, 0, 0.1]}], reflectance: 0.5}\n";
  /* straight on the ray would meet z = 0.1 at x = 0.02, on the lid; the slab shifts it back by
   * more than that */
  double from[3] = {-0.5, 0, 0.62}, d[3] = {1, 0, -1};
  for (int i = 0; i < 2; i++) {
    make(text, i ? &matched : NULL, &f);
    size_t landed = shoot(&f, from, d, 4);
    if (!i) assert_true(landed > 3 * BATCH);
    /* the slab's side mirrors down to the floor before it: at 45 degrees rp = rs^2 */
    double t = asin(sqrt(0.5) / 1.5), q = acos(-1) / 4, rs = pow(sin(q - t) / sin(q + t), 2);
    double seen = (double)(landed - f.hidden);
    if (i) check_share(seen, (double)f.photons, (rs + rs * rs) / 2);
    assert_true(f.hidden > 0.8 * (double)f.photons);
    assert_near(f.ledger.hidden, (double)f.hidden, 1e-6 * (double)f.photons);
    fixture_free(&f);
    /* where no map is made nothing asks, and as much lands */
    make(text, i ? &matched : NULL, &f);
    abbe_light_walk_for_map(f.walk, false);
    assert_int_equal(shoot(&f, from, d, 4), landed);
    assert_int_equal(f.hidden, 0);
    assert_true(f.ledger.hidden == 0);
    fixture_free(&f);
  }
}

/* A floor or the walls of a room hide nothing from a lamp in it; and a card that hides a floor does
 * not hide what lands on the card. */
TEST(walls_hide_nothing) {
  static fixture f;
  const char *const more[] = {
      "",
      "- {name: wall, shape: rectangle, width: 2, height: 2, transform: [{rotate: {axis: [0, 1, "
      "0], angle: 90}}, {translate: [-1, 0, 1]}], reflectance: 0.5}\n",
      "- {name: card, shape: rectangle, width: 2, height: 2, transform: [{translate: [0, 0, "
      "0.1]}], reflectance: 0.5}\n- {name: under, shape: rectangle, width: 4, height: 4, "
      "transform: [{translate: [0, 0, -0.5]}], reflectance: 0.5}\n"};
  for (size_t i = 0; i < sizeof more / sizeof *more; i++) {
    make(printed("%s%s%s", CAMERA POINT_LIGHT FLOOR, more[i], BALL("flat")), NULL, &f);
    flood(&f, 4);
    assert_true(f.ledger.deposited > 0);
    assert_true(f.ledger.hidden == 0);
    fixture_free(&f);
  }
}

/* The books tell light that gets onto a receiver from inside of a refractor. */
TEST(contact_is_told) {
  static fixture f;
  make(CAMERA POINT_LIGHT FLOOR "- {name: brick, shape: box, size: [0.2, 0.2, 0.2], transform: "
                                "[{translate: [0, 0, 0.05]}], material: flat}\n",
       NULL, &f);
  shoot(&f, (double[3]){0, 0, 0.6}, (double[3]){0, 0, -1}, 4);
  check_share(f.ledger.contact, (double)f.photons, 0.96);
  assert_near(f.ledger.contact, f.ledger.deposited, 1e-6);
  fixture_free(&f);
}

/* Same counters, same landings, whatever else ran before; another pass or seed: others. */
TEST(a_walk_repeats_itself) {
  static fixture f, g;
  make(CAMERA POINT_LIGHT FLOOR RING("crown"), NULL, &f);
  make(CAMERA POINT_LIGHT FLOOR RING("crown"), NULL, &g);
  static abbe_photon_hit first[BATCH];
  uint64_t random = 4;
  for (uint32_t i = 0; i < BATCH; i++) {
    double d[3], to[3] = {0.08, 0, 0.2};
    for (int k = 0; k < 3; k++)
      d[k] = to[k] + random_between(&random, -0.02, 0.02) - f.scene.light[0].position[k];
    f.photon[i] = photon_of(&f, f.scene.light[0].position, d, i);
  }
  memcpy(g.photon, f.photon, sizeof f.photon);
  size_t a = abbe_light_walk_run(f.walk, &f.scene.light[0], 5, f.photon, BATCH, first, &f.ledger);
  flood(&g, 1);
  memcpy(g.photon, f.photon, sizeof f.photon);
  size_t b = abbe_light_walk_run(g.walk, &g.scene.light[0], 5, g.photon, BATCH, g.hit, &g.ledger);
  assert_true(a > 100);
  assert_int_equal(a, b);
  for (size_t i = 0; i < a; i++) {
    assert_memory_equal(first[i].p, g.hit[i].p, sizeof first[i].p);
    assert_true(first[i].flux == g.hit[i].flux && first[i].step == g.hit[i].step);
  }
  b = abbe_light_walk_run(g.walk, &g.scene.light[0], 6, g.photon, BATCH, g.hit, &g.ledger);
  assert_true(a != b || memcmp(first[0].p, g.hit[0].p, sizeof first[0].p) != 0 ||
              memcmp(first[a - 1].p, g.hit[a - 1].p, sizeof first[0].p) != 0);
  assert_true(abbe_light_walk_rays(f.walk) >= 2 * a);
  fixture_free(&f);
  fixture_free(&g);
}

/* Straight down through 0.4 m of smoke less than 2 % comes out: paths end by roulette below 5 %,
 * and their mean stays Beer-Lambert's, with the reflections that a slab adds up. */
TEST(dark_glass_keeps_its_mean) {
  OWNED(fixture, f) = {0};
  static const double from[3] = {0.01, 0.02, 0.9}, down[3] = {0, 0, -1};
  make(CAMERA POINT_LIGHT FLOOR "- {name: block, shape: box, size: [0.4, 0.4, 0.4], transform: "
                                "[{translate: [0, 0, 0.3]}], material: smoke}\n",
       NULL, &f);
  const double r = 0.04;
  double want = 0, variance = 0, landed = 0;
  for (int k = 0; k < STEPS; k++) {
    const double lambda_nm = 500 + 100 * (k + 0.5) / STEPS;
    const double left = exp(-0.4 * (20 - 15 * (lambda_nm - 400) / 300));
    const double passes = (1 - r) * (1 - r) * left / (1 - r * r * left * left);
    assert_true(left < 0.02);
    want += passes / STEPS;
    variance += passes * (0.05 - passes) / STEPS; /* what goes on has 0.05 */
  }
  const uint32_t batches = 512;
  for (uint32_t b = 0; b < batches; b++) {
    for (uint32_t i = 0; i < BATCH; i++) f.photon[i] = photon_of(&f, from, down, i);
    const size_t count =
        abbe_light_walk_run(f.walk, &f.scene.light[0], b, f.photon, BATCH, f.hit, &f.ledger);
    for (size_t i = 0; i < count; i++) landed += (double)f.hit[i].flux;
  }
  const double photons = (double)batches * BATCH, sigma = sqrt(variance / photons);
  print_message("%.6f of %.6f passes, known to %.6f\n", landed / photons, want, sigma);
  assert_true(sigma < 0.01 * want);
  assert_near(landed / photons, want, 4 * sigma);
  const abbe_light_ledger *l = &f.ledger;
  assert_near(l->absorbed / photons, 1 - r - want, 6 * sigma + 1e-3);
}

/* A normal of the slab's lower side that is bent by 60 degrees mirrors all light that comes
 * straight down, and to the wrong side of the face. It is pushed back until it runs just above the
 * face, leaves through the slab's end, level to a thousandth, and does not come down on the floor.
 */
TEST(what_a_bent_normal_mirrors_stays_inside) {
  OWNED(fixture, f) = {0};
  static const double from[3] = {0.01, 0.02, 0.9}, down[3] = {0, 0, -1};
  double lambda_nm[STEPS + 1];
  memset(&f, 0, sizeof f);
  f.scene = scene_of(CAMERA POINT_LIGHT FLOOR SLAB("flat"));
  abbe_mesh *mesh = &f.scene.object[1].mesh;
  size_t bent = 0;
  for (size_t i = 0; i < mesh->vertex_count; i++)
    if (mesh->normal[i][2] < -0.5) {
      /* not all alike: such are taken for the face's own */
      memcpy(mesh->normal[i], (double[]){sqrt(0.75), 1e-6 * (double)bent, -0.5},
             sizeof mesh->normal[i]);
      bent++;
    }
  assert_int_equal(bent, 4);
  f.scene.object[1].exact.kind = ABBE_EXACT_NONE;
  for (int k = 0; k <= STEPS; k++) lambda_nm[k] = 500 + 100.0 * k / STEPS;
  static const abbe_physics full = {0};
  OK(abbe_geometry_make(&f.scene, &f.geometry, &error));
  OK(abbe_media_make(&f.geometry, lambda_nm, STEPS, &f.media, &error));
  OK(abbe_light_walk_make(&f.geometry, &f.media, &f.mirrors, &full, 3, &f.walk, &error));
  assert_int_equal(shoot(&f, from, down, 4), 0);
  assert_true(f.ledger.lost == 0 && f.ledger.contact == 0);
  assert_near(f.ledger.missed / (double)f.photons, 1, 1e-6);
}

/* Photons that part at interfaces carry the same light as those that choose. */

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
