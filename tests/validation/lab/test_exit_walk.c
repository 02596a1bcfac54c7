/* One ray through an object: a plate lets it on as it came, a number decides, facets tell paths
 * apart, what stands before a place hides it, and glass that absorbs takes its share. */
#include "tests/validation/trace_scene.h"

#include "validation/lab/exit_fill.h"

#define PLATE(material)                                                                            \
  CAMERA SUN FLOOR "- {name: plate, shape: box, size: [0.2, 0.2, 0.02], material: " material       \
                   ", transform: [{translate: [0.1, 0, 0.5]}]}\n"

typedef struct bench {
  abbe_scene scene;
  abbe_lone_object lone;
  abbe_media media;
  abbe_mirrors mirrors;
  uint32_t facet[64];
  abbe_exit_space space;
} bench;

static void make_bench(const char *text, bench *b) {
  static const double lambda_nm[2] = {500, 600};
  *b = (bench){0};
  b->scene = scene_of(text);
  OK(abbe_lone_object_make(&b->scene, 1, 0, &b->lone, &error));
  OK(abbe_media_make(&b->lone.geometry, lambda_nm, 1, &b->media, &error));
  OK(abbe_mirrors_make(&b->lone.geometry, lambda_nm, 1, &b->mirrors, &error));
  for (uint32_t i = 0; i < 64; i++) b->facet[i] = i / 2; /* a box's faces, by twos */
  b->space = (abbe_exit_space){
      .geometry = &b->lone.geometry, .media = &b->media, .mirrors = &b->mirrors, .facet = b->facet};
}

static void bench_free(bench *b) {
  abbe_media_free(&b->media);
  abbe_mirrors_free(&b->mirrors);
  abbe_lone_object_free(&b->lone);
  abbe_scene_free(&b->scene);
}

/* From above on a place of the world, aslant; all decisions alike. */
static void walk(const bench *b, const double place[3], float chance, abbe_exit_end *end) {
  float chances[ABBE_EXIT_WALK_CHANCES];
  abbe_exit_start start = {.way = {0.6f, 0, -0.8f}, .chance = chances};
  for (int k = 0; k < ABBE_EXIT_WALK_CHANCES; k++) chances[k] = chance;
  abbe_geometry_to_frame(&b->lone.geometry, place, start.place);
  abbe_exit_walk(&b->space, &start, end);
}

TEST(a_plate) {
  static const double top[3] = {0.1, 0, 0.51}, beside[3] = {0.11, 0.01, 0.51},
                      under[3] = {0.1, 0, 0.49}, near_end[3] = {0.195, 0, 0.51};
  abbe_exit_end end, other, side;
  double out[3];
  FILLED(bench, b, make_bench(PLATE("flat"), &b));
  walk(&b, top, 0.9f, &end);
  assert_near((double)end.carried, 1, 0);
  assert_near((double)end.way[0], 0.6, 1e-6);
  assert_near((double)end.way[2], -0.8, 1e-6);
  abbe_geometry_to_world(&b.lone.geometry, end.place, out);
  /* sin of 0.4 inside: the beam moves to the side by the thickness times its tangent */
  assert_near(out[0], 0.1 + 0.02 * 0.4 / sqrt(1 - 0.16), 1e-6);
  assert_near(out[2], 0.49, 1e-5);
  walk(&b, beside, 0.9f, &other);
  assert_int_equal(end.facets, other.facets);
  walk(&b, top, 0, &other); /* reflected at once */
  assert_near((double)other.way[2], 0.8, 1e-6);
  assert_true(other.facets != end.facets);
  walk(&b, near_end, 0.9f, &side); /* out through the end face, or back from it */
  assert_true(side.facets != end.facets);
  walk(&b, under, 0.9f, &other); /* the plate itself is before it */
  assert_near((double)other.carried, 0, 0);
}

TEST(what_is_lost_on_the_way) {
  static const double top[3] = {0.1, 0, 0.51};
  abbe_exit_end end;
  FILLED(bench, b, make_bench(PLATE("grey"), &b));
  walk(&b, top, 0.9f, &end);
  assert_near((double)end.carried, exp(-10 * 0.02 / sqrt(1 - 0.16)), 1e-5);
  bench_free(&b);
  make_bench(CAMERA SUN FLOOR "- {name: plate, shape: box, size: [0.2, 0.2, 0.02], mirror: 0.7, "
                              "transform: [{translate: [0.1, 0, 0.5]}]}\n",
             &b);
  walk(&b, top, 0.9f, &end);
  assert_near((double)end.carried, 0.7, 1e-6);
  assert_near((double)end.way[2], 0.8, 1e-6);
}
