/* The plan: each pass and model follows from a fact of the scene, and goes when the fact goes. */
#include "tests/scenes/scene_text.h"

#include "gl/plan/plan.h"

static void make(const abbe_scene *scene, const abbe_render_desc *desc, abbe_plan *plan) {
  abbe_error error = {0};
  abbe_result result = abbe_plan_make(scene, desc, plan, &error);
  if (result != ABBE_OK) print_error("%s\n", error.text);
  assert_int_equal(result, ABBE_OK);
}

static void make_text(const char *text, const abbe_render_desc *desc, abbe_plan *plan) {
  abbe_scene scene = {0};
  load_text(text, &scene);
  make(&scene, desc, plan);
  abbe_scene_free(&scene);
}

#define assert_runs(plan, item, expected) check_runs(plan, item, expected, __FILE__, __LINE__)
static void check_runs(const abbe_plan *plan, abbe_plan_item item, bool expected, const char *file,
                       int line) {
  const abbe_plan_entry *entry = abbe_plan_find(plan, item, 0);
  if (entry != NULL && entry->runs == expected) return;
  print_error("'%s' %s\n", abbe_plan_item_text(item),
              entry == NULL ? "is not in the plan" : entry->reason);
  _fail(file, line);
}

static bool noted(const abbe_plan *plan, const char *part) {
  for (size_t i = 0; i < plan->note_count; i++)
    if (strstr(plan->note[i], part) != NULL) return true;
  return false;
}

static void test_a_ball_over_a_floor(void **state) {
  (void)state;
  abbe_plan plan;
  make_text(CAMERA POINT_LIGHT FLOOR BALL("crown"), NULL, &plan);
  assert_int_equal(plan.refractor_count, 1);
  assert_int_equal(plan.refractor_object[0], 1);
  assert_int_equal(plan.receiver_object[0], 0);
  assert_int_equal(plan.model[0], ABBE_REFRACTOR_SPHERE);
  assert_int_equal(plan.receivers, ABBE_RECEIVER_EXACT);
  assert_int_equal(plan.desc.wavelengths, 7);
  assert_true(plan.spheres && !plan.convex && !plan.layers && !plan.absorbing && !plan.textured);
  assert_runs(&plan, ABBE_PASS_RECEIVER_DEPTH, false);
  assert_runs(&plan, ABBE_PASS_LIGHT_FRONT, true);
  assert_runs(&plan, ABBE_PASS_LIGHT_BACK, false);
  assert_runs(&plan, ABBE_PASS_PHOTONS, true);
  assert_runs(&plan, ABBE_PASS_GAP_FILL, true);
  assert_runs(&plan, ABBE_CHOICE_ABSORPTION, false);
  assert_runs(&plan, ABBE_PASS_EYE_BACK, false);
  assert_runs(&plan, ABBE_PASS_EYE_REFRACTION, true);
  assert_runs(&plan, ABBE_CHOICE_TEXTURES, false);
  assert_runs(&plan, ABBE_CHOICE_INNER_REFLECTIONS, true);
  assert_contains(abbe_plan_find(&plan, ABBE_CHOICE_REFRACTOR_MODEL, 1)->reason,
                  "the object is a sphere");
  abbe_plan_free(&plan);
}

static void test_without_refractors_no_light_is_split(void **state) {
  (void)state;
  abbe_plan plan;
  const abbe_render_desc many = {.wavelengths = 21};
  make_text(CAMERA POINT_LIGHT FLOOR, &many, &plan);
  assert_false(plan.caustics);
  assert_int_equal(plan.desc.wavelengths, 1);
  assert_runs(&plan, ABBE_PASS_LIGHT_FRONT, false);
  assert_runs(&plan, ABBE_PASS_LIGHT_BACK, false);
  assert_runs(&plan, ABBE_PASS_PHOTON_PLACEMENT, false);
  assert_runs(&plan, ABBE_PASS_PHOTONS, false);
  assert_runs(&plan, ABBE_PASS_SPECTRAL_MAP, false);
  assert_runs(&plan, ABBE_PASS_GAP_FILL, false);
  assert_runs(&plan, ABBE_PASS_EYE_REFRACTION, false);
  assert_runs(&plan, ABBE_PASS_EYE_RECEIVERS, true);
  assert_contains(abbe_plan_find(&plan, ABBE_CHOICE_WAVELENGTHS, 0)->reason, "nothing refracts");
  abbe_plan_free(&plan);
}

static void test_a_constant_index_needs_one_wavelength(void **state) {
  (void)state;
  abbe_plan plan;
  const abbe_render_desc asked = {.wavelengths = 21};
  make_text(CAMERA POINT_LIGHT FLOOR BALL("flat"), NULL, &plan);
  assert_false(plan.dispersive);
  assert_int_equal(plan.desc.wavelengths, 1);
  assert_runs(&plan, ABBE_PASS_GAP_FILL, false);
  assert_runs(&plan, ABBE_PASS_PHOTONS, true);
  abbe_plan_free(&plan);
  make_text(CAMERA POINT_LIGHT FLOOR BALL("flat"), &asked, &plan);
  assert_int_equal(plan.desc.wavelengths, 21);
  assert_contains(abbe_plan_find(&plan, ABBE_CHOICE_WAVELENGTHS, 0)->reason, "as asked");
  abbe_plan_free(&plan);
}

static void test_absorption_runs_where_something_absorbs(void **state) {
  (void)state;
  abbe_plan plan;
  make_text(CAMERA POINT_LIGHT FLOOR BALL("smoke"), NULL, &plan);
  assert_true(plan.absorbing);
  assert_runs(&plan, ABBE_CHOICE_ABSORPTION, true);
  abbe_plan_free(&plan);
}

/* Convex, and no sphere. */
#define EGG(material)                                                                              \
  "- {name: egg, shape: sphere, radius: 0.08, levels: 4, transform: [{scale: [1, 1, 1.4]}, "       \
  "{translate: [0, 0, 0.2]}], material: " material "}\n"

static void test_a_mesh_asks_for_its_back_layer(void **state) {
  (void)state;
  abbe_plan plan;
  make_text(CAMERA POINT_LIGHT FLOOR RING("crown"), NULL, &plan);
  assert_int_equal(plan.model[0], ABBE_REFRACTOR_HIERARCHY);
  assert_true(plan.walk && plan.hierarchy && !plan.layers);
  assert_runs(&plan, ABBE_CHOICE_REFRACTORS_IN_TURN, true);
  assert_runs(&plan, ABBE_PASS_LIGHT_BACK, false);
  assert_runs(&plan, ABBE_PASS_EYE_BACK, false);
  assert_contains(abbe_plan_find(&plan, ABBE_CHOICE_REFRACTORS_IN_TURN, 0)->reason, "not convex");
  abbe_plan_free(&plan);
  make_text(CAMERA POINT_LIGHT FLOOR EGG("crown"), NULL, &plan);
  assert_int_equal(plan.model[0], ABBE_REFRACTOR_LAYERS);
  assert_true(!plan.walk && !plan.hierarchy && plan.layers);
  assert_runs(&plan, ABBE_CHOICE_REFRACTORS_IN_TURN, false);
  assert_runs(&plan, ABBE_PASS_LIGHT_BACK, true);
  assert_runs(&plan, ABBE_PASS_EYE_BACK, true);
  assert_runs(&plan, ABBE_CHOICE_INNER_REFLECTIONS, true);
  abbe_plan_free(&plan);
  make_text(CAMERA POINT_LIGHT FLOOR BRICK("crown"), NULL, &plan);
  assert_int_equal(plan.model[0], ABBE_REFRACTOR_CONVEX);
  assert_runs(&plan, ABBE_PASS_LIGHT_BACK, false);
  assert_runs(&plan, ABBE_CHOICE_INNER_REFLECTIONS, true);
  abbe_plan_free(&plan);
  make_text(CAMERA POINT_LIGHT FLOOR RING("crown") BALL("flat") BRICK("flat"), NULL, &plan);
  assert_true(plan.spheres && plan.convex && plan.hierarchy && plan.walk && !plan.layers);
  assert_true(!noted(&plan, "meets another"));
  assert_contains(abbe_plan_find(&plan, ABBE_CHOICE_REFRACTORS_IN_TURN, 0)->reason,
                  "more than one");
  abbe_plan_free(&plan);
}

/* One refractor alone is not walked; a second, a hollow, or a receiver within it asks for that. */
static void test_what_light_may_meet_again_is_walked(void **state) {
  (void)state;
  static const struct {
    const char *text;
    bool walk;
  } rows[] = {
      {CAMERA POINT_LIGHT FLOOR BALL("crown"), false},
      {CAMERA POINT_LIGHT FLOOR BRICK("crown"), false},
      {CAMERA POINT_LIGHT FLOOR BALL("crown") BRICK("crown"), true},
      {CAMERA POINT_LIGHT FLOOR
       "- {name: low, shape: sphere, radius: 0.08, transform: [{translate: [0, 0, 0.05]}], "
       "material: crown}\n",
       true},
      {CAMERA POINT_LIGHT FLOOR
       "- {name: room, shape: box, size: [3, 3, 3], reflectance: 0.5}\n" BALL("crown"),
       false},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    abbe_plan plan;
    make_text(rows[i].text, NULL, &plan);
    if (plan.walk != rows[i].walk) print_error("scene %zu\n", i);
    assert_true(plan.walk == rows[i].walk);
    assert_runs(&plan, ABBE_CHOICE_REFRACTORS_IN_TURN, rows[i].walk);
    abbe_plan_free(&plan);
  }
}

/* What is asked for is taken where it can serve, and refused by name where it cannot. */
static void test_a_model_that_is_asked_for(void **state) {
  (void)state;
  static const struct {
    const char *text;
    abbe_model model;
    abbe_refractor_model expected;
    bool walk;
    const char *refusal; /* NULL: none */
  } rows[] = {
      {CAMERA POINT_LIGHT FLOOR BALL("crown"), ABBE_MODEL_SPHERE, ABBE_REFRACTOR_SPHERE, false,
       NULL},
      {CAMERA POINT_LIGHT FLOOR BALL("crown"), ABBE_MODEL_LAYERS, ABBE_REFRACTOR_LAYERS, false,
       NULL},
      {CAMERA POINT_LIGHT FLOOR BALL("crown"), ABBE_MODEL_HIERARCHY, ABBE_REFRACTOR_HIERARCHY, true,
       NULL},
      {CAMERA POINT_LIGHT FLOOR RING("crown"), ABBE_MODEL_LAYERS, ABBE_REFRACTOR_LAYERS, false,
       NULL},
      {CAMERA POINT_LIGHT FLOOR BALL("crown") RING("crown"), ABBE_MODEL_SPHERE,
       ABBE_REFRACTOR_SPHERE, false, "'sphere' cannot serve 'ring'"},
      {CAMERA POINT_LIGHT FLOOR BALL("crown"), ABBE_MODEL_CONVEX, ABBE_REFRACTOR_CONVEX, false,
       "'convex' cannot serve 'ball'"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    abbe_scene scene = {0};
    abbe_plan plan;
    abbe_error error = {0};
    load_text(rows[i].text, &scene);
    abbe_result result =
        abbe_plan_make(&scene, &(abbe_render_desc){.model = rows[i].model}, &plan, &error);
    assert_int_equal(result, rows[i].refusal != NULL ? ABBE_UNSUPPORTED : ABBE_OK);
    if (rows[i].refusal != NULL) {
      assert_contains(error.text, rows[i].refusal);
    } else {
      assert_int_equal(plan.model[0], rows[i].expected);
      assert_true(plan.walk == rows[i].walk);
      abbe_plan_free(&plan);
    }
    abbe_scene_free(&scene);
  }
}

static void test_a_curved_receiver_asks_for_a_hierarchy(void **state) {
  (void)state;
  abbe_plan plan;
  make_text(CAMERA POINT_LIGHT FLOOR HILL BALL("crown"), NULL, &plan);
  assert_int_equal(plan.receivers, ABBE_RECEIVER_HIERARCHY);
  assert_int_equal(plan.receiver_model[0], ABBE_RECEIVER_EXACT);
  assert_int_equal(plan.receiver_model[1], ABBE_RECEIVER_HIERARCHY);
  assert_int_equal(plan.parallelogram_count, 1);
  assert_runs(&plan, ABBE_PASS_RECEIVER_DEPTH, false);
  assert_contains(abbe_plan_find(&plan, ABBE_CHOICE_RECEIVER_MODEL, 0)->reason,
                  "'hill' is a general mesh");
  abbe_plan_free(&plan);
}

static void test_too_many_rectangles_are_traversed(void **state) {
  (void)state;
  abbe_scene scene = {0};
  abbe_plan plan;
  double many[97][9];
  load_text(CAMERA POINT_LIGHT FLOOR BALL("crown"), &scene);
  abbe_exact *exact = &scene.object[0].exact, floor = *exact;
  for (size_t i = 0; i < 97; i++) memcpy(many[i], floor.parallelogram[0], sizeof many[i]);
  exact->parallelogram = many;
  exact->count = 96;
  make(&scene, NULL, &plan);
  assert_int_equal(plan.receivers, ABBE_RECEIVER_EXACT);
  assert_int_equal(plan.parallelogram_count, 96);
  abbe_plan_free(&plan);
  exact->count = 97;
  make(&scene, NULL, &plan);
  assert_int_equal(plan.receivers, ABBE_RECEIVER_HIERARCHY);
  assert_int_equal(plan.parallelogram_count, 0);
  assert_contains(abbe_plan_find(&plan, ABBE_CHOICE_RECEIVER_MODEL, 0)->reason,
                  "with 'floor' there are more than 96 parallelograms");
  abbe_plan_free(&plan);
  *exact = floor;
  abbe_scene_free(&scene);
}

static void test_the_thesis_profile_knows_one_way(void **state) {
  (void)state;
  abbe_plan plan;
  const abbe_render_desc thesis = {.profile = ABBE_PROFILE_THESIS};
  make_text(CAMERA POINT_LIGHT FLOOR BALL("crown"), &thesis, &plan);
  assert_int_equal(plan.model[0], ABBE_REFRACTOR_LAYERS);
  assert_int_equal(plan.receivers, ABBE_RECEIVER_DEPTH);
  assert_int_equal(plan.desc.fill, ABBE_FILL_SMEAR);
  assert_int_equal(plan.desc.wavelengths, 7);
  assert_int_equal(plan.desc.orders, 1);
  assert_near(plan.desc.min_nm, 380, 0);
  assert_near(plan.desc.max_nm, 680, 0);
  abbe_plan_free(&plan);
}

/* Where the default profile has a cube, the thesis's has none; of a spot its view is the cone. */
static void test_the_thesis_profile_looks_through_one_view(void **state) {
  (void)state;
  static const struct {
    const char *kind;
    bool one_view;
  } rows[] = {{"point", false}, {"spot, direction: [1, 0, 0], cone: 30", true}};
  static const abbe_profile profiles[] = {ABBE_PROFILE_THESIS, ABBE_PROFILE_THESIS_CIE};
  for (size_t i = 0; i < 4; i++) {
    char text[1024];
    abbe_scene scene;
    abbe_plan plan;
    abbe_error error = {0};
    snprintf(text, sizeof text,
             CAMERA "lights:\n- {name: lamp, kind: %s, position: [0.1, 0, 0.2], intensity: "
                    "1}\n" FLOOR "%s" BALL("crown"),
             rows[i / 2].kind, BRICK("crown"));
    load_text(text, &scene);
    const abbe_render_desc desc = {.profile = profiles[i % 2]};
    const abbe_result result = abbe_plan_make(&scene, &desc, &plan, &error);
    assert_int_equal(result, rows[i / 2].one_view ? ABBE_OK : ABBE_UNSUPPORTED);
    if (!rows[i / 2].one_view) assert_contains(error.text, "looks through one view");
    abbe_plan_free(&plan);
    abbe_scene_free(&scene);
  }
}

static void test_the_fill_goes_when_it_is_not_wanted(void **state) {
  (void)state;
  abbe_plan plan;
  const abbe_render_desc none = {.fill = ABBE_FILL_NONE};
  make_text(CAMERA POINT_LIGHT FLOOR BALL("crown"), &none, &plan);
  assert_runs(&plan, ABBE_PASS_GAP_FILL, false);
  assert_runs(&plan, ABBE_PASS_SPECTRAL_MAP, true);
  abbe_plan_free(&plan);
}

static void refuse(const abbe_render_desc *desc, abbe_result expected, const char *part,
                   const char *text) {
  abbe_scene scene = {0};
  abbe_plan plan;
  abbe_error error = {0};
  load_text(text, &scene);
  abbe_result result = abbe_plan_make(&scene, desc, &plan, &error);
  if (result != expected) print_error("%s: '%s'\n", part, error.text);
  assert_int_equal(result, expected);
  assert_int_equal(error.code, expected);
  assert_contains(error.text, part);
  abbe_plan_free(&plan);
  abbe_scene_free(&scene);
}

static void test_an_index_that_is_not_known_is_refused_or_noted(void **state) {
  (void)state;
  abbe_plan plan;
  refuse(NULL, ABBE_OUT_OF_RANGE, "narrow", CAMERA POINT_LIGHT FLOOR BALL("narrow"));
  make_text(CAMERA POINT_LIGHT FLOOR BALL("loose"), NULL, &plan);
  assert_true(noted(&plan, "loose: the index is extrapolated"));
  abbe_plan_free(&plan);
  /* of a diamond's wavelengths 760 to 780 nm are not known, in which there is nothing to see */
  make_text("camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR BALL("diamond"),
            NULL, &plan);
  assert_false(noted(&plan, "extrapolated"));
  abbe_plan_free(&plan);
  const abbe_render_desc inside = {.min_nm = 420, .max_nm = 680};
  make_text(CAMERA POINT_LIGHT FLOOR BALL("narrow"), &inside, &plan);
  assert_false(noted(&plan, "extrapolated"));
  abbe_plan_free(&plan);
}

static void test_too_many_refractors_are_unsupported(void **state) {
  (void)state;
  abbe_scene scene = {0};
  abbe_plan plan;
  abbe_error error = {0};
  load_text(CAMERA POINT_LIGHT FLOOR BALL("crown"), &scene);
  abbe_object *object = scene.object, *many = calloc(256, sizeof *many);
  assert_non_null(many);
  for (size_t i = 0; i < 256; i++) many[i] = object[1];
  scene.object = many;
  scene.object_count = 255;
  make(&scene, NULL, &plan);
  assert_int_equal(plan.refractor_count, 255);
  assert_contains(abbe_plan_find(&plan, ABBE_CHOICE_MORE_REFRACTORS, 0)->reason,
                  "and 207 refractors more");
  assert_runs(&plan, ABBE_PASS_EYE_PICTURE, true);
  abbe_plan_free(&plan);
  scene.object_count = 256;
  assert_int_equal(abbe_plan_make(&scene, NULL, &plan, &error), ABBE_UNSUPPORTED);
  assert_contains(error.text, "255 refractors");
  scene.object = object;
  scene.object_count = 2;
  free(many);
  abbe_scene_free(&scene);
}

/* What a shipped scene is made of decides how it is drawn. */
static const struct {
  const char *name;
  abbe_refractor_model model;
  bool textured;
} shipped[] = {
    {"sphere", ABBE_REFRACTOR_SPHERE, false},   {"rainbow", ABBE_REFRACTOR_SPHERE, false},
    {"gem", ABBE_REFRACTOR_CONVEX, false},      {"prism", ABBE_REFRACTOR_CONVEX, true},
    {"diamond", ABBE_REFRACTOR_CONVEX, false},  {"ring", ABBE_REFRACTOR_HIERARCHY, false},
    {"bunny", ABBE_REFRACTOR_HIERARCHY, false}, {"glass", ABBE_REFRACTOR_HIERARCHY, true},
};

static void test_shipped_scenes(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof shipped / sizeof *shipped; i++) {
    abbe_scene scene = {0};
    abbe_plan plan;
    load_shipped(shipped[i].name, &scene);
    make(&scene, NULL, &plan);
    bool layers = shipped[i].model == ABBE_REFRACTOR_LAYERS;
    assert_int_equal(plan.refractor_count, 1);
    assert_int_equal(plan.model[0], shipped[i].model);
    assert_int_equal(plan.receivers, ABBE_RECEIVER_EXACT);
    assert_true(plan.caustics && plan.dispersive);
    assert_int_equal(plan.desc.wavelengths, 7);
    assert_runs(&plan, ABBE_PASS_LIGHT_BACK, layers);
    assert_runs(&plan, ABBE_CHOICE_INNER_REFLECTIONS, true);
    assert_runs(&plan, ABBE_CHOICE_TEXTURES, shipped[i].textured);
    for (size_t k = 0; k < plan.entry_count; k++) {
      assert_true(plan.entry[k].name[0] != '\0');
      assert_true(plan.entry[k].reason[0] != '\0');
    }
    abbe_plan_free(&plan);
    abbe_scene_free(&scene);
  }
}

static bool notes(const abbe_plan *plan, const char *part) {
  for (size_t i = 0; i < plan->note_count; i++)
    if (strstr(plan->note[i], part) != NULL) return true;
  return false;
}

#define WHITE_BALL                                                                                 \
  "- {name: white, shape: sphere, radius: 0.05, levels: 2, "                                       \
  "transform: [{translate: [-0.2, 0, 0.1]}], reflectance: 0.5}\n"
#define DROP(name, radius, z)                                                                      \
  "- {name: " name ", shape: sphere, radius: " radius ", levels: 2, "                              \
  "transform: [{translate: [0.09, 0.09, " z "]}], material: flat}\n"

static void test_refractors_that_overlap_are_noted(void **state) {
  (void)state;
  static const struct {
    const char *text, *part; /* NULL: none overlap */
  } rows[] = {
      {CAMERA POINT_LIGHT FLOOR BALL("flat") BRICK("flat"), NULL},
      /* the boxes around these two overlap at a corner, the balls do not */
      {CAMERA POINT_LIGHT FLOOR BALL("flat") DROP("drop", "0.04", "0.26"), NULL},
      {CAMERA POINT_LIGHT FLOOR BALL("flat") DROP("drop", "0.08", "0.26"),
       "'ball' and 'drop' over"},
      {CAMERA POINT_LIGHT FLOOR DROP("shell", "0.05", "0.2") DROP("bubble", "0.04", "0.2"),
       "'shell' and 'bubble' overlap"},
      {CAMERA POINT_LIGHT FLOOR DROP("a", "0.05", "0.2") DROP("b", "0.04", "0.2")
           DROP("c", "0.03", "0.2"),
       "'a' and 'b' (and 2 pairs more) overlap"},
      {CAMERA POINT_LIGHT FLOOR RING("flat") BALL("flat"), "'ring' and 'ball' overlap"},
  };
  /* walked light keeps the scene's rule; two layers know one refractor at a time */
  const abbe_render_desc apart = {.model = ABBE_MODEL_LAYERS};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    abbe_scene scene;
    abbe_plan plan;
    load_text(rows[i].text, &scene);
    assert_int_equal(abbe_plan_make(&scene, &apart, &plan, NULL), ABBE_OK);
    if (notes(&plan, "overlap") != (rows[i].part != NULL) ||
        (rows[i].part != NULL && !notes(&plan, rows[i].part)))
      fail_msg("scene %zu: %s", i,
               plan.note_count > 0 ? plan.note[plan.note_count - 1] : "no note");
    abbe_plan_free(&plan);
    abbe_scene_free(&scene);
  }
}

static void test_a_disk_is_refused_by_name(void **state) {
  (void)state;
  abbe_scene scene;
  abbe_plan plan;
  abbe_error error = {0};
  load_text(CAMERA "lights:\n- {name: panel, kind: disk, position: [0, 0, 0.6], target: [0, 0, 0], "
                   "radius: 0.1, radiance: 100}\n" FLOOR BALL("flat"),
            &scene);
  assert_int_equal(scene.light[0].kind, ABBE_LIGHT_DISK);
  assert_near(scene.light[0].radius, 0.1, 0);
  assert_near(scene.light[0].power, 100, 0);
  assert_near(scene.light[0].direction[2], -1, 0);
  assert_int_equal(abbe_plan_make(&scene, NULL, &plan, &error), ABBE_UNSUPPORTED);
  assert_contains(error.text, "'panel' is a disk");
  assert_contains(error.text, "trace the scene");
  assert_contains(error.text, "of 3.14159 W/sr"); /* 100 pi 0.1^2 */
  abbe_scene_free(&scene);
}

static void refuse_layout(const char *text, const abbe_render_desc *desc, const char *part) {
  abbe_scene scene;
  abbe_plan plan;
  abbe_error error = {0};
  load_text(text, &scene);
  assert_int_equal(abbe_plan_make(&scene, desc, &plan, &error), ABBE_INVALID_ARGUMENT);
  assert_contains(error.text, part);
  abbe_scene_free(&scene);
}

static void test_a_map_layout_belongs_to_its_light(void **state) {
  (void)state;
  static const char ball[] = CAMERA POINT_LIGHT FLOOR BALL("flat");
  static const double at[3] = {0.05, 0.03, 0.6}, down[3] = {0, 0, -1}, up[3] = {0, 1, 0};
  static const double point[1][3] = {{0, 0, 0}};
  abbe_view view;
  abbe_map_layout layout;
  abbe_view_look(at, down, up, false, &view);
  abbe_view_fit(&view, point, 1);
  abbe_view_pad(&view, 0.1);
  abbe_map_layout_make(&view, &layout);
  abbe_render_desc desc = {.map_layout = &layout};
  abbe_scene scene;
  abbe_plan plan;
  load_text(ball, &scene);
  assert_int_equal(abbe_plan_make(&scene, &desc, &plan, NULL), ABBE_OK);
  assert_contains(abbe_plan_find(&plan, ABBE_PASS_SPECTRAL_MAP, 0)->reason, "laid out as asked");
  abbe_plan_free(&plan);
  abbe_scene_free(&scene);
  refuse_layout(CAMERA POINT_LIGHT FLOOR, &desc, "no refractor");
  refuse_layout(CAMERA SUN FLOOR BALL("flat"), &desc, "another place than 'sun'");
  desc.map_layout_light = 1;
  refuse_layout(ball, &desc, "for light 2; the scene has 1");
  desc.map_layout_light = 0;
  desc.profile = ABBE_PROFILE_THESIS;
  refuse_layout(ball, &desc, "thesis");
  desc.profile = ABBE_PROFILE_DEFAULT;
  layout.knot[0][3] = NAN;
  refuse_layout(ball, &desc, "along x");
  layout.view.origin[0] += 1e-3;
  refuse_layout(ball, &desc, "another place than 'lamp'");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_a_ball_over_a_floor),
      cmocka_unit_test(test_without_refractors_no_light_is_split),
      cmocka_unit_test(test_a_constant_index_needs_one_wavelength),
      cmocka_unit_test(test_absorption_runs_where_something_absorbs),
      cmocka_unit_test(test_a_mesh_asks_for_its_back_layer),
      cmocka_unit_test(test_what_light_may_meet_again_is_walked),
      cmocka_unit_test(test_a_model_that_is_asked_for),
      cmocka_unit_test(test_a_curved_receiver_asks_for_a_hierarchy),
      cmocka_unit_test(test_too_many_rectangles_are_traversed),
      cmocka_unit_test(test_the_thesis_profile_knows_one_way),
      cmocka_unit_test(test_the_thesis_profile_looks_through_one_view),
      cmocka_unit_test(test_the_fill_goes_when_it_is_not_wanted),
      cmocka_unit_test(test_an_index_that_is_not_known_is_refused_or_noted),
      cmocka_unit_test(test_too_many_refractors_are_unsupported),
      cmocka_unit_test(test_refractors_that_overlap_are_noted),
      cmocka_unit_test(test_a_disk_is_refused_by_name),
      cmocka_unit_test(test_a_map_layout_belongs_to_its_light),
      cmocka_unit_test(test_shipped_scenes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
