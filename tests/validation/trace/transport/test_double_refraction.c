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
}

/* ---- polarised light ---- */

#define KINDS                                                                                      \
  "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" SUN FLOOR                                  \
  "- {name: a, shape: sphere, radius: 0.02, material: n-sf11}\n"                                   \
  "- {name: b, shape: sphere, radius: 0.02, material: calcite, axis: [1, 0.4, 0.7]}\n"             \
  "- {name: c, shape: sphere, radius: 0.02, material: topaz, axes: {x: [1, 2, 0], z: [0, 0, "      \
  "1]}}\n"                                                                                         \
  "- {name: d, shape: sphere, radius: 0.02, material: n-bk7, coating: {layers: [[2.4, 90], "       \
  "[[0.42, 2.4], 8]]}}\n"                                                                          \
  "- {name: gold, shape: sphere, radius: 0.02, mirror: gold}\n"                                    \
  "- {name: grey, shape: sphere, radius: 0.02, mirror: 0.7}\n"

typedef struct kinds {
  abbe_scene scene;
  abbe_geometry g;
  abbe_media media;
  abbe_mirrors mirrors;
} kinds;

static void make_kinds(kinds *k) {
  const double lambda_nm[2] = {550, 551};
  *k = (kinds){0};
  OK(abbe_scene_parse(KINDS, strlen(KINDS), "scene", NULL, &k->scene, &error));
  OK(abbe_geometry_make(&k->scene, &k->g, &error));
  OK(abbe_media_make(&k->g, lambda_nm, 1, &k->media, &error));
  OK(abbe_mirrors_make(&k->g, lambda_nm, 1, &k->mirrors, &error));
}

static void free_kinds(kinds *k) {
  abbe_mirrors_free(&k->mirrors);
  abbe_media_free(&k->media);
  abbe_geometry_free(&k->g);
  abbe_scene_free(&k->scene);
}

static void state(uint64_t *random, float out[3]) {
  double v[3];
  direction(random, v);
  for (int k = 0; k < 3; k++) out[k] = (float)v[k];
}

/* Light of wholly polarised states that run one against the other: y is turned over. */
static float meets(const float a[3], const float b[3]) {
  return 0.5f * (1 + a[0] * b[0] - a[1] * b[1] + a[2] * b[2]);
}

/* A face between two of the media, and light of a random state that comes to it. */
static abbe_wave_face random_face(uint64_t *random, const abbe_media *m, float stokes[3]) {
  abbe_wave_face face = {.film = -1, .stokes = stokes};
  float n[3], along;
  do {
    face.from = (int)random_between(random, -1, 3.999);
    face.to = (int)random_between(random, -1, 3.999);
  } while (face.from == face.to);
  if (face.from == 3 || face.to == 3) face.film = 0;
  face.entering = face.to == 3;
  state(random, n);
  do {
    state(random, face.d);
    along = n[0] * face.d[0] + n[1] * face.d[1] + n[2] * face.d[2];
  } while (!(along < -0.01f));
  memcpy(face.n, n, sizeof n);
  state(random, stokes);
  if (abbe_media_is_crystal(m, face.from)) face.wave = random_between(random, 0, 2) < 1;
  return face;
}

/* The share of one state that a face turns into another is that of the way back: for glass,
 * crystals, films, total reflection. */
TEST(polarised_light_runs_back_as_it_came) {
  uint64_t random = 7;
  kinds k;
  make_kinds(&k);
  size_t compared = 0;
  for (int i = 0; i < 20000; i++) {
    float there[3], ends[3];
    const abbe_wave_face face = random_face(&random, &k.media, there);
    abbe_wave_ways ways, back;
    abbe_media_ways(&k.media, &face, 0, 0, &ways);
    float sum = 0;
    for (size_t w = 0; w < ways.count; w++) sum += ways.way[w].share;
    assert_near(sum, 1, 1e-6);
    const abbe_wave_way *way = &ways.way[(size_t)random_between(&random, 0, 3.99) % ways.count];
    const bool in_crystal = abbe_media_is_crystal(&k.media, way->reflected ? face.from : face.to);
    state(&random, ends);
    abbe_wave_face turned = face;
    turned.stokes = ends;
    turned.wave = way->wave;
    float along = 0;
    for (int c = 0; c < 3; c++) {
      turned.d[c] = -way->d[c];
      turned.n[c] = way->reflected ? face.n[c] : -face.n[c];
      along += turned.d[c] * turned.n[c];
    }
    if (!way->reflected) turned.from = face.to, turned.to = face.from;
    if (!way->reflected) turned.entering = !face.entering;
    if (!(along < -0.01f)) continue;
    abbe_media_ways(&k.media, &turned, 0, 0, &back);
    float share = 0;
    for (size_t w = 0; w < back.count; w++) {
      const abbe_wave_way *b = &back.way[w];
      if (b->reflected != way->reflected || b->wave != face.wave) continue;
      share = b->share * back.passes *
              (abbe_media_is_crystal(&k.media, face.from) ? 1 : meets(b->stokes, there));
    }
    assert_near(ways.passes * way->share * (in_crystal ? 1 : meets(way->stokes, ends)), share,
                3e-5);
    compared++;
  }
  assert_true(compared > 15000);
  free_kinds(&k);
}

/* The mean over two opposite states is what unpolarised light does. */
TEST(unpolarised_light_is_the_mean_of_opposite_states) {
  uint64_t random = 11;
  kinds k;
  make_kinds(&k);
  for (int i = 0; i < 5000; i++) {
    float stokes[3], none[3] = {0};
    abbe_wave_face face = random_face(&random, &k.media, stokes);
    if (abbe_media_is_crystal(&k.media, face.from)) continue;
    abbe_wave_ways ways[2], bare, plain;
    for (int sign = 0; sign < 2; sign++) {
      abbe_media_ways(&k.media, &face, 0, 0, &ways[sign]);
      for (int c = 0; c < 3; c++) stokes[c] = -stokes[c];
    }
    face.stokes = none;
    abbe_media_ways(&k.media, &face, 0, 0, &bare);
    face.stokes = NULL;
    if (face.film < 0 || abbe_media_is_crystal(&k.media, face.to)) {
      abbe_media_ways(&k.media, &face, 0, 0, &plain);
      assert_near(bare.passes * bare.reflected, plain.passes * plain.reflected, 2e-5);
    }
    assert_near((ways[0].passes * ways[0].reflected + ways[1].passes * ways[1].reflected) / 2,
                bare.passes * bare.reflected, 2e-6);
  }
  free_kinds(&k);
}

TEST(mirrors_turn_light_and_give_it_back) {
  uint64_t random = 3;
  kinds k;
  make_kinds(&k);
  for (int i = 0; i < 2000; i++) {
    const size_t mirror = (size_t)i % 2;
    float d[3], out[3], from[3], to[3], there[3], back[3], opposite[2][3];
    state(&random, d);
    state(&random, out);
    state(&random, from);
    state(&random, to);
    for (int c = 0; c < 3; c++) {
      there[c] = from[c];
      back[c] = to[c];
      opposite[0][c] = -out[c];
      opposite[1][c] = -d[c];
    }
    const float a = abbe_polarised_mirror(&k.mirrors, mirror, d, out, 0, 0, there);
    const float b = abbe_polarised_mirror(&k.mirrors, mirror, opposite[0], opposite[1], 0, 0, back);
    assert_near(a * meets(there, to), b * meets(back, from), 1e-5);
    if (mirror == 1) assert_near(a, 1, 1e-6);
  }
  float right[3] = {0, 0, 1};
  const float down[3] = {0, 0.6f, -0.8f}, up[3] = {0, -0.6f, 0.8f};
  abbe_polarised_mirror(&k.mirrors, 0, down, up, 0, 0, right);
  assert_near(right[2], -1, 1e-6);
  free_kinds(&k);
}

/* What a rough face shows of a light is the density with which it sends light there: by cosine to
 * the face, over both sides in air. */
static void check_looks(const abbe_media *m, int from, int to, double alpha, double cosine) {
  enum { BANDS = 10, PATHS = 20000 };
  const double sine = sqrt(1 - cosine * cosine), pi = 3.14159265358979;
  double sent[2 * BANDS] = {0}, shown[2 * BANDS] = {0}, square[2 * BANDS] = {0};
  abbe_rough_look look[2 * BANDS];
  uint64_t random = 9;
  const abbe_wave_face face = {.from = from,
                               .to = to,
                               .film = -1,
                               .entering = from < 0,
                               .n = {0, 0, 1},
                               .d = {(float)sine, 0, (float)-cosine},
                               .rough = (float)alpha};
  for (uint32_t i = 0; i < PATHS; i++) {
    for (int b = 0; b < 2 * BANDS; b++) {
      const double z = (b - BANDS + random_between(&random, 0, 1)) / BANDS, r = sqrt(1 - z * z),
                   angle = random_between(&random, 0, 2 * pi);
      look[b].to[0] = (float)(r * cos(angle));
      look[b].to[1] = (float)(r * sin(angle));
      look[b].to[2] = (float)z;
    }
    const uint32_t key[4] = {i, 1, 2, 3};
    abbe_wave_way way;
    abbe_media_roughen(m, &face, 3, 0.5f, key, look, 2 * BANDS, &way);
    const int at = (int)floorf(way.d[2] * BANDS) + BANDS;
    sent[at < 2 * BANDS ? at : 2 * BANDS - 1] += (double)way.share / PATHS;
    for (int b = 0; b < 2 * BANDS; b++) {
      const double value = (double)look[b].density * 2 * pi / BANDS;
      shown[b] += value / PATHS;
      square[b] += value * value / PATHS;
    }
  }
  for (int b = 0; b < 2 * BANDS; b++) {
    if ((b < BANDS ? to : from) >= 0) continue;
    const double error = sqrt((square[b] + sent[b]) / PATHS);
    assert_near(sent[b], shown[b], 4.5 * error + 1e-4);
  }
}

TEST(a_rough_face_shows_lights_as_it_sends_light) {
  static const double alpha[] = {0.15, 0.6}, cosine[] = {0.95, 0.5};
  const double lambda_nm[11] = {500, 510, 520, 530, 540, 550, 560, 570, 580, 590, 600};
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  MADE(abbe_geometry, g, abbe_geometry_make(&scene, &g, &error));
  MADE(abbe_media, m, abbe_media_make(&g, lambda_nm, 10, &m, &error));
  for (int i = 0; i < 8; i++)
    check_looks(&m, i < 4 ? -1 : 0, i < 4 ? 0 : -1, alpha[i & 1], cosine[i >> 1 & 1]);
}
