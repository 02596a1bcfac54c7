/* The plan of each shipped scene, whole, and what one fact more or less in a scene changes of its
 * plan: each pass and model follows from a fact, and goes when the fact goes. */
#include "tests/gl/plan/plan_pairs.h"

static const row sphere_rows[] = {
    BALL_ROWS(RUNS(CHOICE_RECEIVER_MAPS,
                   "a receiver lies more than 76 degrees off the view of a light's map"),
              COLOURED) END};

/* What each has otherwise than scenes/sphere.yaml. */
static const struct {
  const char *name;
  row row[24];
} shipped[] = {
    {"rainbow",
     {RUNS_OF(CHOICE_REFRACTOR_MODEL, "drop", "exact sphere: the object is a sphere"), SHADOWED,
      GREY, GONE(CHOICE_REFRACTOR_MODEL, "ball"), END}},
    {"gem",
     {COUNTS(7, 20, 21),
      RUNS_OF(CHOICE_REFRACTOR_MODEL, "gem", "convex planes: the object is a convex faceted solid"),
      RUNS(CHOICE_INNER_REFLECTIONS, "followed until less than 0.005 of the light is left, 20 "
                                     "exits at most; 0.4 % of it is still inside then"),
      IN_ROWS, RUNS(CHOICE_ABSORPTION, "paths keep how much they pass of what tints"),
      GONE(CHOICE_REFRACTOR_MODEL, "ball"), END}},
    {"prism",
     {RUNS_OF(CHOICE_REFRACTOR_MODEL, "prism",
              "convex planes: the object is a convex faceted solid"),
      RUNS(CHOICE_RECEIVER_SHADOWS, "a receiver may stand between a light and another"),
      RUNS(CHOICE_INNER_REFLECTIONS, "followed until less than 0.01 of the light is left, 8 exits "
                                     "at most; 0.16 % of it is still inside then"),
      RUNS(CHOICE_RECEIVER_MAPS, "a receiver may hide from a light where its light lands"), IN_ROWS,
      RUNS(CHOICE_TEXTURES, "a receiver has one"), GONE(CHOICE_REFRACTOR_MODEL, "ball"), END}},
    {"diamond",
     {COUNTS(7, 24, 25),
      RUNS_OF(CHOICE_REFRACTOR_MODEL, "diamond",
              "convex planes: the object is a convex faceted solid"),
      RUNS(CHOICE_RECEIVER_SHADOWS, "a receiver may stand between a light and another"),
      RUNS(CHOICE_INNER_REFLECTIONS, "followed until less than 0.01 of the light is left, 24 exits "
                                     "at most; 2.9 % of it is still inside then"),
      RESTS_OF(CHOICE_LIGHT_MAP, "lamp of the left card", "its cone misses every refractor"),
      RESTS_OF(CHOICE_LIGHT_MAP, "lamp of the high card", "its cone misses every refractor"),
      RUNS(CHOICE_RECEIVER_MAPS, "a receiver may hide from a light where its light lands"), IN_ROWS,
      GREY, GONE(CHOICE_REFRACTOR_MODEL, "ball"), END}},
    {"ring",
     {COUNTS(7, 8, 16),
      RUNS_OF(CHOICE_REFRACTOR_MODEL, "ring",
              "triangle hierarchy: the object is a general mesh, and light may meet it more than "
              "twice"),
      RUNS(CHOICE_MULTI_REFRACTOR_PATHS, "the refractor is not convex"),
      RUNS(PASS_EYE_REFRACTION, "until less than 0.01 of its light is left, 256 exits at most"),
      GONE(CHOICE_REFRACTOR_MODEL, "ball"), END}},
    {"bunny",
     {COUNTS(7, 8, 16),
      RUNS_OF(CHOICE_REFRACTOR_MODEL, "bunny",
              "triangle hierarchy: the object is a general mesh, and light may meet it more than "
              "twice"),
      RUNS(CHOICE_MULTI_REFRACTOR_PATHS, "the refractor is not convex"),
      RUNS(PASS_EYE_REFRACTION, "until less than 0.01 of its light is left, 256 exits at most"),
      GONE(CHOICE_REFRACTOR_MODEL, "ball"), END}},
    {"glass",
     {COUNTS(7, 8, 16),
      RUNS_OF(CHOICE_REFRACTOR_MODEL, "glass",
              "triangle hierarchy: the object is a general mesh, and light may meet it more than "
              "twice"),
      RUNS(CHOICE_MULTI_REFRACTOR_PATHS, "the refractor is not convex"),
      RUNS(PASS_EYE_REFRACTION, "until less than 0.01 of its light is left, 256 exits at most"),
      RUNS(CHOICE_TEXTURES, "a receiver has one"), GONE(CHOICE_REFRACTOR_MODEL, "ball"), END}},
};

static void plan_of(const abbe_scene *scene, const abbe_render_desc *desc, lines *out) {
  FILLED(abbe_plan, plan, plan_scene(scene, desc, &plan));
  tell(scene, &plan, out);
}

static void load_and_plan(const char *text, const abbe_render_desc *desc, lines *out) {
  OWNED(abbe_scene, scene) = scene_of(text);
  plan_of(&scene, desc, out);
}

static void load_and_plan_shipped(const char *name, lines *out) {
  OWNED(abbe_scene, scene) = shipped_scene(name);
  plan_of(&scene, NULL, out);
}

TEST(shipped_scenes) {
  static lines sphere, other, difference;
  load_and_plan_shipped("sphere", &sphere);
  check_rows("sphere", sphere_rows, &sphere);
  for (size_t i = 0; i < sizeof shipped / sizeof *shipped; i++) {
    load_and_plan_shipped(shipped[i].name, &other);
    differ(&sphere, &other, &difference);
    check_rows(shipped[i].name, shipped[i].row, &difference);
  }
}

/* The plans of both scenes of each pair, made once. */
static lines from[PAIRS], to[PAIRS];

static void plan_pairs(void) {
  for (size_t i = 0; i < PAIRS; i++) {
    load_and_plan(pairs[i].from, NULL, &from[i]);
    load_and_plan(pairs[i].to, &pairs[i].desc, &to[i]);
  }
}

TEST(a_fact_changes_what_follows_from_it_alone) {
  static lines one, difference;
  load_and_plan(ball, NULL, &one);
  check_rows("ball", ball_rows, &one);
  for (size_t i = 0; i < PAIRS; i++) {
    differ(&from[i], &to[i], &difference);
    check_rows(pairs[i].fact, pairs[i].row, &difference);
  }
}

/* Whether the item runs in one of the plans and rests in the other. */
static bool flips(const lines *a, const lines *b, const line *item) {
  for (size_t i = 0; i < a->count; i++)
    for (size_t k = 0; k < b->count; k++)
      if (is_about_the_same(&a->line[i], item) && is_about_the_same(&b->line[k], item) &&
          a->line[i].kind != b->line[k].kind)
        return true;
  return false;
}

TEST(every_pass_goes_with_some_fact) {
  static lines all;
  load_and_plan(ball, NULL, &all);
  for (size_t i = 0; i < all.count; i++) {
    const line *l = &all.line[i];
    if (l->kind != ROW_RUNS && l->kind != ROW_RESTS) continue;
    /* what every picture of the default profile needs */
    const bool always = l->item == ABBE_CHOICE_RECEIVER_MODEL ||
                        l->item == ABBE_CHOICE_WAVELENGTHS || l->item == ABBE_PASS_EYE_RECEIVERS;
    bool goes = false;
    for (size_t k = 0; k < PAIRS && !goes; k++) goes = flips(&from[k], &to[k], l);
    if (goes == always)
      fail_msg("'%s' goes with %s", abbe_plan_item_text(l->item), goes ? "a fact" : "no fact");
  }
}

/* The lists are the scene's objects in their order, and the flags the models in use. */
TEST(lists_name_the_scenes_objects) {
  OWNED(abbe_plan, plan);
  plan_text(CAMERA POINT_LIGHT FLOOR BALL("crown") CARD BRICK("flat"), NULL, &plan);
  assert_int_equal(plan.refractor_count, 2);
  assert_true(plan.refractor_object[0] == 1 && plan.refractor_object[1] == 3);
  assert_true(plan.model[0] == ABBE_REFRACTOR_SPHERE && plan.model[1] == ABBE_REFRACTOR_CONVEX);
  assert_true(plan.spheres && plan.convex && !plan.layers && !plan.bvh &&
              plan.multi_refractor_paths);
  assert_int_equal(plan.receiver_count, 2);
  assert_true(plan.receiver_object[0] == 0 && plan.receiver_object[1] == 2);
  assert_int_equal(plan.receivers, ABBE_RECEIVER_EXACT);
  assert_true(plan.dispersive && plan.caustics && plan.camera_sees_refractor && plan.fills &&
              !plan.absorbing);
}

/* Light that ends at facets' edges is for what lays splats in rows; published passes lay none. */
TEST(facets_have_edges_for_own_passes) {
  const abbe_render_desc thesis = {.profile = ABBE_PROFILE_THESIS};
  for (int i = 0; i < 3; i++) {
    OWNED(abbe_plan, plan);
    plan_text(i == 1 ? CAMERA POINT_LIGHT FLOOR BALL("crown")
                     : CAMERA POINT_LIGHT FLOOR CUBE("crown"),
              i == 2 ? &thesis : NULL, &plan);
    assert_int_equal(plan.edges, i == 0);
  }
}

GROUP(plan_pairs, NULL);
