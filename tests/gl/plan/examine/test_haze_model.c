/* What the plan makes of media that scatter, and what it says that it leaves out. */
#include "tests/check.h"

#include "gl/plan/examine/examine.h"
#include "tests/gl/plan/planned.h"
#include "tests/scenes/scene_text.h"

#define MIST(scattering)                                                                           \
  "medium: {scattering: " scattering ", absorption: 0.5, g: 0.4, box: [[-1, -1, 0], [1, 1, 1]]}\n"

TEST(mist_is_a_fact) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT MIST("2") FLOOR BALL("flat"));
  MADE(abbe_plan, plan, abbe_plan_make(&scene, NULL, &plan, &error));
  assert_true(plan.hazy && plan.eye_in_air);
  assert_near(plan.air_haze.scattering, 2, 1e-9);
  assert_near(plan.air_haze.absorption, 0.5, 1e-9);
  assert_near(plan.eye_haze.g, 0.4, 0);
  for (int k = 0; k < ABBE_PLAN_HAZE_BANDS; k++) {
    assert_near(plan.air_haze.scatters[k], 2, 1e-9);
    assert_near(plan.air_haze.takes[k], 2.5, 1e-9);
  }
  assert_true(abbe_plan_find(&plan, ABBE_PASS_EYE_HAZE, 0)->runs);
  assert_true(is_noted(&plan, "scatters light once"));
  assert_false(is_noted(&plan, "taken for white"));
  abbe_plan_free(&plan);
  abbe_scene_free(&scene);
  scene = scene_of(CAMERA POINT_LIGHT FLOOR BALL("flat"));
  OK(abbe_plan_make(&scene, NULL, &plan, &error));
  assert_false(plan.hazy);
  assert_null(abbe_plan_find(&plan, ABBE_PASS_EYE_HAZE, 0));
}

/* Between what it is at the ends, nearer to where X, Y and Z have their middle. */
TEST(a_coloured_medium_is_its_mean) {
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA POINT_LIGHT MIST("[[380, 0], [780, 4]]") FLOOR BALL("flat"));
  MADE(abbe_plan, plan, abbe_plan_make(&scene, NULL, &plan, &error));
  assert_near(plan.air_haze.scattering, 4 * (524 - 380) / 400.0, 0.1);
  assert_true(is_noted(&plan, "taken for white"));
}

/* An object's medium takes of light like an absorbing material. */
TEST(murky_glass_attenuates) {
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA POINT_LIGHT FLOOR
               "- {name: ball, shape: sphere, radius: 0.08, transform: [{translate: [0, 0, 0.2]}], "
               "material: flat, medium: {scattering: 3}}\n");
  MADE(abbe_plan, plan, abbe_plan_make(&scene, NULL, &plan, &error));
  assert_true(plan.hazy && plan.absorbing && !plan.tinting);
  assert_near(plan.eye_haze.scattering, 0, 0);
}

/* Clouds are followed, and those that nothing tells apart from what is around them are not. */
TEST(clouds_count_where_they_scatter) {
  static const struct {
    const char *cloud;
    size_t count;
    const char *why;
  } rows[] = {{"{radius: 0.02, medium: {scattering: 3}}", 2, "clouds in the refractor"},
              {"{radius: 0.02}", 1, "light that leaves the refractor cannot meet it again"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    FILLED(abbe_plan, plan,
           plan_text(printed(CAMERA POINT_LIGHT FLOOR BALL("flat, clouds: [%s]"), rows[i].cloud),
                     NULL, &plan));
    assert_int_equal(plan.refractor_count, rows[i].count);
    assert_contains(abbe_plan_find(&plan, ABBE_CHOICE_MULTI_REFRACTOR_PATHS, 0)->reason,
                    rows[i].why);
  }
  char text[4096] = CAMERA POINT_LIGHT FLOOR
      "- {name: ball, shape: sphere, radius: 0.08, material: flat, transform: [{translate: [0, 0, "
      "0.2]}], clouds: [";
  for (int i = 0; i < 32; i++) strcat(text, "{radius: 0.01, medium: {scattering: 3}}, ");
  strcat(text, "]}\n");
  refuse_plan(text, NULL, ABBE_UNSUPPORTED, "through clouds among at most 32");
}

/* Of white light red goes first; what is in the water is seen through its surface. */
TEST(blue_water) {
  OWNED(abbe_scene, scene) = shipped_scene("water/shafts");
  MADE(abbe_plan, plan, abbe_plan_make(&scene, NULL, &plan, &error));
  const abbe_plan_haze *h = &plan.eye_haze;
  assert_true(!plan.eye_in_air && h->absorption > 0.05 && h->absorption < 0.2);
  assert_true(h->takes[8] > 1.5 * h->takes[2] && h->scatters[2] > h->scatters[8]);
  assert_true(plan.shaft_count == 1 && plan.shaft[0].refractor == 0 && !plan.haze_beyond);
  assert_near(plan.shaft[0].g, 0.75, 0);
  assert_true(plan.shaft[0].scattering > h->scatters[3]);
  assert_true(abbe_plan_find(&plan, ABBE_PASS_SHAFTS, 0)->runs);
  assert_true(is_noted(&plan, "taken for white"));
}

TEST(published_methods_refuse_it) {
  abbe_render_desc desc = {.profile = ABBE_PROFILE_THESIS};
  refuse_plan(CAMERA POINT_LIGHT MIST("2") FLOOR BALL("flat"), &desc, ABBE_UNSUPPORTED,
              "of which the thesis profile knows nothing");
  desc.profile = ABBE_PROFILE_SHAH2007;
  refuse_plan(CAMERA POINT_LIGHT MIST("2") FLOOR BALL("flat"), &desc, ABBE_UNSUPPORTED,
              "take the default profile");
}

/* Receivers are hit exactly as long as there is room; others are traversed. */

TEST(a_curved_receiver_asks_for_a_hierarchy) {
  FILLED(abbe_plan, plan, plan_text(CAMERA POINT_LIGHT FLOOR HILL BALL("crown"), NULL, &plan));
  assert_int_equal(plan.receivers, ABBE_RECEIVER_BVH);
  assert_int_equal(plan.receiver_model[0], ABBE_RECEIVER_EXACT);
  assert_int_equal(plan.receiver_model[1], ABBE_RECEIVER_BVH);
  assert_int_equal(plan.parallelogram_count, 1);
  assert_false(abbe_plan_find(&plan, ABBE_PASS_RECEIVER_DEPTH, 0)->runs);
  assert_contains(abbe_plan_find(&plan, ABBE_CHOICE_RECEIVER_MODEL, 0)->reason,
                  "'hill' is a general mesh");
}

TEST(too_many_rectangles_are_traversed) {
  double many[97][9];
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  abbe_exact *exact = &scene.object[0].exact, floor = *exact;
  for (size_t i = 0; i < 97; i++) memcpy(many[i], floor.parallelogram[0], sizeof many[i]);
  exact->parallelogram = many;
  exact->count = 96;
  FILLED(abbe_plan, plan, plan_scene(&scene, NULL, &plan));
  assert_int_equal(plan.receivers, ABBE_RECEIVER_EXACT);
  assert_int_equal(plan.parallelogram_count, 96);
  abbe_plan_free(&plan);
  exact->count = 97;
  plan_scene(&scene, NULL, &plan);
  assert_int_equal(plan.receivers, ABBE_RECEIVER_BVH);
  assert_int_equal(plan.parallelogram_count, 0);
  assert_contains(abbe_plan_find(&plan, ABBE_CHOICE_RECEIVER_MODEL, 0)->reason,
                  "with 'floor' there are more than 96 parallelograms");
  *exact = floor;
}

/* What a mirror asks of the plan. */

#define SILVERED "materials: default\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"
#define MIRROR_BALL(what)                                                                          \
  "- {name: ball, shape: sphere, radius: 0.08, levels: 4, transform: [{translate: [0, 0, 0.2]}], " \
  "mirror: " what "}\n"
#define MIRROR_PANE(what)                                                                          \
  "- {name: pane, shape: rectangle, width: 0.3, height: 0.3, transform: [{rotate: {axis: [0, 1, "  \
  "0], angle: 90}}, {translate: [-0.3, 0, 0.2]}], mirror: " what "}\n"

static void check(const abbe_plan *plan, abbe_plan_item item, size_t index, const char *part) {
  const abbe_plan_entry *entry = abbe_plan_find(plan, item, index);
  assert_non_null(entry);
  assert_true(entry->runs);
  assert_contains(entry->reason, part);
}

TEST(a_grey_ball_asks_for_one_wavelength) {
  FILLED(abbe_plan, plan, plan_text(SILVERED POINT_LIGHT FLOOR MIRROR_BALL("0.9"), NULL, &plan));
  assert_int_equal(plan.refractor_count, 1);
  assert_int_equal(plan.mirror_count, 1);
  assert_true(plan.mirror[0] && plan.multi_refractor_paths && plan.caustics);
  assert_false(plan.colouring || plan.dispersive || plan.absorbing || plan.bvh);
  assert_int_equal(plan.model[0], ABBE_REFRACTOR_SPHERE);
  assert_int_equal(plan.desc.wavelengths, 1);
  check(&plan, ABBE_CHOICE_REFRACTOR_MODEL, 1, "exact sphere: the object is a mirror");
  check(&plan, ABBE_CHOICE_MIRROR, 1, "reflects 0.9 of the light");
  check(&plan, ABBE_CHOICE_MULTI_REFRACTOR_PATHS, 0, "what a mirror sends on");
  check(&plan, ABBE_CHOICE_WAVELENGTHS, 0, "mirrors reflect all wavelengths alike");
}

TEST(a_metal_asks_for_all) {
  FILLED(abbe_plan, plan, plan_text(SILVERED POINT_LIGHT FLOOR MIRROR_BALL("gold"), NULL, &plan));
  assert_true(plan.colouring);
  assert_false(plan.fills || plan.dispersive);
  assert_int_equal(plan.desc.wavelengths, ABBE_PLAN_WAVELENGTHS);
  check(&plan, ABBE_CHOICE_MIRROR, 1, "by wavelength");
  check(&plan, ABBE_CHOICE_WAVELENGTHS, 0, "a mirror's reflectance varies");
  assert_int_equal(abbe_plan_least_wavelengths(&plan), ABBE_PLAN_WAVELENGTHS);
}

/* A path's parts of a band hold what a metal takes between coarse wavelengths. */
TEST(glass_beside_a_metal_asks_for_no_more_wavelengths) {
  OWNED(abbe_plan, plan);
  plan_text(SILVERED POINT_LIGHT FLOOR MIRROR_PANE("gold") BALL("n-bk7"), NULL, &plan);
  assert_true(plan.fills && plan.bvh && plan.mirror[0] && !plan.mirror[1]);
  assert_int_equal(plan.model[0], ABBE_REFRACTOR_BVH);
  assert_int_equal(abbe_plan_least_wavelengths(&plan), 4);
  abbe_plan_free(&plan);
  plan_text(SILVERED POINT_LIGHT FLOOR MIRROR_PANE("0.9") BALL("n-bk7"), NULL, &plan);
  assert_int_equal(abbe_plan_least_wavelengths(&plan), 4);
}

/* A ball is known by its triangles to whom is inside: they have two sides. */
TEST(a_ball_around_the_lamp_is_a_mesh) {
  OWNED(abbe_plan, plan);
  plan_text(SILVERED POINT_LIGHT FLOOR "- {name: ball, shape: sphere, radius: 0.1, transform: "
                                       "[{translate: [0.05, 0.03, 0.6]}], mirror: 0.9}\n",
            NULL, &plan);
  assert_int_equal(plan.model[0], ABBE_REFRACTOR_BVH);
}

TEST(a_metal_is_known_over_the_range) {
  const abbe_render_desc desc = {.min_nm = 380, .max_nm = 1e5};
  refuse_plan(SILVERED POINT_LIGHT FLOOR MIRROR_BALL("gold"), &desc, ABBE_OUT_OF_RANGE, "gold");
}

/* Extremes of index and attenuation over a range, and an index that is not known in it. */

TEST(extremes_are_those_of_the_range) {
  abbe_material_range range;
  double first, last;
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA POINT_LIGHT FLOOR BALL("murk")); /* n falls; 20 per m at 400, 0 at 500 */
  const abbe_material *murk = scene.object[1].material;
  OK(abbe_material_range_make(murk, 400, 700, &range, &error));
  OK(abbe_material_n(murk, 400, &first, &error));
  OK(abbe_material_n(murk, 700, &last, &error));
  assert_true(range.most_n == first && range.least_n == last && last < first);
  assert_near(range.most_per_m, 20, 1e-12);
  assert_near(range.least_per_m, 0, 0);
  OK(abbe_material_n(murk, 550, &first, &error));
  assert_near(range.middle_n, first, 0);
  assert_near(range.middle_per_m, 0, 0);
  OK(abbe_material_range_make(murk, 500, 700, &range, &error));
  assert_near(range.most_per_m, 0, 0);
}

TEST(an_unknown_index_is_an_error) {
  abbe_material_range range;
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("narrow"));
  const abbe_material *narrow = scene.object[1].material;
  OK(abbe_material_range_make(narrow, 400, 700, &range, &error));
  REFUSED(ABBE_OUT_OF_RANGE, "narrow", abbe_material_range_make(narrow, 400, 701, &range, &error));
}
