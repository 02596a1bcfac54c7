#include "tests/scenes/scene_text.h"

#include "spectral/optics.h"
#include "tests/random.h"
#include "validation/trace/transport/double_refraction.h"

static const abbe_uniaxial air = {1, 1, {0, 0, 1}};

static void direction(uint64_t *random, double out[3]) {
  double square;
  do {
    for (int k = 0; k < 3; k++) out[k] = random_between(random, -1, 1);
    square = out[0] * out[0] + out[1] * out[1] + out[2] * out[2];
  } while (!(square > 0.01 && square < 1));
  for (int k = 0; k < 3; k++) out[k] /= sqrt(square);
}

/* Shares add up, ways leave to their sides, and there are as many as media have waves. */
TEST(ways_hold_all_of_the_light) {
  uint64_t random = 5;
  size_t most = 0;
  for (int i = 0; i < 20000; i++) {
    abbe_uniaxial media[2];
    double v[3];
    float n[3], d[3], along = 0;
    for (int m = 0; m < 2; m++) {
      media[m].n_o = random_between(&random, 1, 2.5);
      media[m].n_e = i % 3 == m ? media[m].n_o : random_between(&random, 1, 2.5);
      direction(&random, media[m].axis);
    }
    direction(&random, v);
    for (int k = 0; k < 3; k++) n[k] = (float)v[k];
    do {
      direction(&random, v);
      for (int k = 0; k < 3; k++) d[k] = (float)v[k];
      along = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
    } while (!(along < -1e-3f));
    abbe_wave_ways ways;
    abbe_wave_ways_find(&media[0], &media[1], n, d, (uint8_t)(i & 1), &ways);
    float sum = 0, reflected = 0;
    for (size_t w = 0; w < ways.count; w++) {
      const abbe_wave_way *way = &ways.way[w];
      const float side = n[0] * way->d[0] + n[1] * way->d[1] + n[2] * way->d[2];
      assert_true(way->reflected == (side > 0) && way->share > 0);
      sum += way->share;
      if (way->reflected) reflected += way->share;
    }
    assert_near(sum, 1, 1e-6);
    assert_near(reflected, ways.reflected, 1e-6);
    assert_true(ways.count <= (i % 3 == 0 ? 3u : i % 3 == 1 ? 3u : 4u));
    most = ways.count > most ? ways.count : most;
  }
  assert_int_equal(most, 4);
}

TEST(glass_is_as_it_was) {
  const abbe_uniaxial glass = {1.5, 1.5, {0, 1, 0}};
  const float n[3] = {0, 0, 1};
  for (float s = 0.05f; s < 1; s += 0.05f) {
    const float c = sqrtf(1 - s * s), d[3] = {s, 0, -c};
    abbe_wave_ways ways;
    abbe_wave_ways_find(&air, &glass, n, d, 0, &ways);
    assert_int_equal(ways.count, 2);
    assert_near(ways.reflected, abbe_optics_fresnel((double)c, 1 / 1.5), 1e-6);
    assert_near(ways.way[1].d[0], s / 1.5f, 1e-6);
    abbe_wave_ways_find(&glass, &air, n, d, 1, &ways);
    assert_int_equal(ways.count, s > 1 / 1.5f ? 1 : 2);
    if (ways.count == 1) assert_true(ways.reflected == 1);
  }
}

/* As often as their shares say; reflection by the first number alone. */
TEST(ways_are_chosen_by_their_shares) {
  const abbe_wave_ways ways = FIELDS(.count = 4,
                                     .way = {{.share = 0.1f, .reflected = true},
                                             {.share = 0.2f, .wave = 1, .reflected = true},
                                             {.share = 0.3f},
                                             {.share = 0.4f, .wave = 1}},
                                     .reflected = 0.3f);
  double count[4] = {0};
  enum { STEPS = 200 };
  for (int i = 0; i < STEPS; i++)
    for (int k = 0; k < STEPS; k++) {
      const float a = ((float)i + 0.5f) / STEPS, b = ((float)k + 0.5f) / STEPS;
      const abbe_wave_way *way = abbe_wave_ways_choose(&ways, a, b);
      assert_true(way->reflected == (a < 0.3f));
      count[way - ways.way] += 1.0 / STEPS / STEPS;
    }
  for (int i = 0; i < 4; i++) assert_near(count[i], ways.way[i].share, 6e-3);
  /* the numbers of a split path: one side or, where it has none, the other */
  assert_true(abbe_wave_ways_choose(&ways, -1, 0.5f)->reflected);
  assert_false(abbe_wave_ways_choose(&ways, 2, 0.5f)->reflected);
  const abbe_wave_ways total = {
      .count = 1, .way = {{.share = 1, .reflected = true}}, .reflected = 1};
  assert_true(abbe_wave_ways_choose(&total, 2, 0.999f) == &total.way[0]);
  const abbe_wave_ways none = {.count = 1, .way = {{.share = 1}}};
  assert_true(abbe_wave_ways_choose(&none, -1, 0) == &none.way[0]);
}

#define STONE(name, axis, x)                                                                       \
  "- {name: " name ", shape: sphere, radius: 0.02, material: calcite, axis: " axis                 \
  ", transform: [{rotate: {axis: [0, 1, 0], angle: 90}}, {translate: [" x ", 0, 0.2]}]}\n"
#define SCENE                                                                                      \
  "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" SUN FLOOR STONE("a", "[0, 0, 2]", "0")     \
      STONE("b", "[0, 0, -1]", "0.1") STONE("c", "[0, 1, 0]", "0.2")

/* Axes are turned with the object; two of one material are one medium if their axes are. */
TEST(media_know_their_axes) {
  const double lambda_nm[2] = {587.5618, 600};
  MADE(abbe_scene, scene, abbe_scene_parse(SCENE, strlen(SCENE), "scene", NULL, &scene, &error));
  MADE(abbe_geometry, g, abbe_geometry_make(&scene, &g, &error));
  MADE(abbe_media, m, abbe_media_make(&g, lambda_nm, 1, &m, &error));
  abbe_uniaxial u;
  abbe_media_crystal(&m, 0, 0, 0, &u);
  assert_near(u.n_o, 1.658461, 1e-6);
  assert_near(u.n_e, 1.486185, 1e-6);
  assert_near(u.axis[0], 1, 1e-12);
  abbe_media_crystal(&m, 2, 0, 0, &u);
  assert_near(u.axis[1], 1, 1e-12);
  abbe_media_crystal(&m, -1, 0, 0, &u);
  assert_true(u.n_o == 1 && u.n_e == 1);
  assert_true(abbe_media_same(&m, 0, 1)); /* the two ends of an axis are alike */
  assert_false(abbe_media_same(&m, 0, 2));
  assert_true(abbe_media_is_crystal(&m, 2) && !abbe_media_is_crystal(&m, -1));
  abbe_media_forget_axes(&m);
  assert_false(abbe_media_is_crystal(&m, 2));
  abbe_media_crystal(&m, 0, 0, 0, &u);
  assert_true(u.n_e == u.n_o);
}
