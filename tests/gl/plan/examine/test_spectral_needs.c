/* Indices that are not known are refused, those that are extrapolated noted. */
#include "tests/gl/plan/planned.h"

#include "gl/plan/examine/examine.h"

TEST(an_index_that_is_not_known_is_refused_or_noted) {
  refuse_plan(CAMERA POINT_LIGHT FLOOR BALL("narrow"), NULL, ABBE_OUT_OF_RANGE, "narrow");
  FILLED(abbe_plan, plan, plan_text(CAMERA POINT_LIGHT FLOOR BALL("loose"), NULL, &plan));
  assert_true(is_noted(&plan, "loose: the index is extrapolated"));
  abbe_plan_free(&plan);
  /* of a diamond's wavelengths 760 to 780 nm are not known, in which there is nothing to see */
  plan_text("camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR BALL("diamond"),
            NULL, &plan);
  assert_false(is_noted(&plan, "extrapolated"));
  abbe_plan_free(&plan);
  const abbe_render_desc inside = {.min_nm = 420, .max_nm = 680};
  plan_text(CAMERA POINT_LIGHT FLOOR BALL("narrow"), &inside, &plan);
  assert_false(is_noted(&plan, "extrapolated"));
}

/* Its colours by ray, how far apart they are, and what is drawn. */
TEST(pleochroism_is_noted) {
  const char *head = "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR;
  FILLED(abbe_plan, plan, plan_text(printed("%s%s", head, BALL("tourmaline-green")), NULL, &plan));
  assert_true(is_noted(&plan, "tourmaline-green: pleochroic; 5 mm pass CIELAB 86 -49 46 of its "
                              "ordinary ray and 97 -12 14 of the extraordinary one, 50 apart"));
}

TEST(fluorescence_is_noted) {
  const char *head = "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR;
  FILLED(abbe_plan, plan,
         plan_text(printed("%s%s", head, BALL("diamond-fluorescent")), NULL, &plan));
  assert_true(is_noted(&plan,
                       "diamond-fluorescent: fluorescent; of photons that excite it 30 % come "
                       "back at 415.2 to 550 nm, 100 % of these within the range"));
  assert_true(plan.glowing && abbe_plan_runs(&plan, ABBE_PASS_EYE_GLOW, 0));
  assert_false(is_noted(&plan, "glow"));
  abbe_plan_free(&plan);
  const abbe_render_desc layers = {.model = ABBE_MODEL_LAYERS};
  plan_text(printed("%s%s", head, BALL("diamond-fluorescent")), &layers, &plan);
  assert_true(!plan.glowing && is_noted(&plan, "ball: drawn without its glow"));
}

TEST(an_aperture_is_noted) {
  const char *head = "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05], aperture: 2, focus: 1}\n";
  const abbe_render_desc thesis = {.profile = ABBE_PROFILE_THESIS};
  FILLED(abbe_plan, plan,
         plan_text(printed("%s%s", head, POINT_LIGHT FLOOR BALL("n-bk7")), NULL, &plan));
  assert_true(is_noted(&plan, "a mean of 16 pictures from its pupil"));
  abbe_plan_free(&plan);
  plan_text(printed("%s%s", head, POINT_LIGHT FLOOR BALL("n-bk7")), &thesis, &plan);
  assert_true(is_noted(&plan, "a mean of 1 pictures"));
}

/* What a film reflects, from both sides, beside the bare face. */
TEST(films_are_noted) {
  const char *head = "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR;
  FILLED(abbe_plan, plan,
         plan_text(printed("%s%s", head, BALL("n-bk7, coating: {layers: [[1.38, 99.638]]}")), NULL,
                   &plan));
  assert_true(is_noted(
      &plan, "ball: film: R at 0 degrees at 450/550/650 nm is 1.60/1.27/1.47 % from outside, "
             "1.60/1.27/1.47 % from inside"));
  assert_true(plan.filmed && !is_noted(&plan, "bare"));
  abbe_plan_free(&plan);
  plan_text(printed("%s%s", head, BALL("n-bk7, coating: {layers: [[1.38, 0.5]]}")), NULL, &plan);
  assert_true(is_noted(&plan, "a layer of its film is 0.5 nm"));
  abbe_plan_free(&plan); /* a cloud covers none of it */
  plan_text(printed("%s%s", head,
                    BALL("n-bk7, coating: {layers: [[1.38, 99.638]]}, clouds: "
                         "[{radius: 0.01, medium: {scattering: 3}}]")),
            NULL, &plan);
  assert_int_equal(plan.refractor_count, 2);
  assert_false(is_noted(&plan, "films are left out"));
}

TEST(all_that_is_to_say_is_noted) {
  char text[8192] = "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR;
  for (int i = 0; i < 30; i++)
    snprintf(text + strlen(text), sizeof text - strlen(text),
             "- {name: b%d, shape: box, size: [0.1, 0.1, 0.1], material: n-bk7, coating: {layers: "
             "[[1.38, %d]]}, transform: [{translate: [%g, 0.3, 0.2]}]}\n",
             i, 90 + i, 0.2 * i - 3);
  FILLED(abbe_plan, plan, plan_text(text, NULL, &plan));
  for (int i = 0; i < 30; i++) assert_true(is_noted(&plan, printed("b%d: film: R at", i)));
}

/* The plan says how a crystal is drawn, once a material. */
TEST(double_refraction_is_noted) {
  const char *head = "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR;
  FILLED(abbe_plan, plan,
         plan_text(printed("%s%s%s", head, BALL("calcite"), BRICK("calcite")), NULL, &plan));
  assert_true(plan.crystals && !plan.pleochroic);
  assert_true(
      is_noted(&plan, "calcite: double refraction by 0.1726 at 580 nm: both waves are drawn"));
  size_t count = 0;
  for (size_t i = 0; i < plan.note_count; i++)
    count += strstr(plan.note[i], "double refraction") != NULL ? 1 : 0;
  assert_int_equal(count, 1);
  abbe_plan_free(&plan);
  plan_text(printed("%s%s", head, BALL("diamond")), NULL, &plan);
  assert_false(is_noted(&plan, "double refraction") || plan.crystals);
  abbe_plan_free(&plan);
  plan_text(printed("%s%s", head, BALL("tanzanite")), NULL, &plan);
  assert_true(plan.crystals && plan.pleochroic && plan.tints == 3);
}

/* Known answers of panes of index 1.5 and of diamond; and polarisers. */
TEST(polarisation_that_matters_is_noted) {
  const char *pane = "- {name: pane, shape: box, size: [0.2, 0.2, 0.01], material: %s, "
                     "transform: [{translate: [0, 0, 0.1]}]}\n";
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("flat"));
  FILLED(abbe_plan, plan, plan_scene(&scene, NULL, &plan));
  assert_false(is_noted(&plan, "polarisation"));
  abbe_plan_free(&plan);
  char objects[200];
  snprintf(objects, sizeof objects, pane, "calcite");
  plan_text(printed("camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05], polariser: {kind: left}}\n"
                    "lights: [{name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1, "
                    "polariser: {angle: 30}}]\n" FLOOR "%s",
                    objects),
            NULL, &plan);
  assert_true(is_noted(&plan, "camera: its polariser is left out"));
  assert_true(is_noted(&plan, "sun: its polariser is left out"));
  assert_true(is_noted(&plan, "pane: a thin plate's colours and optical activity are left out"));
  abbe_plan_free(&plan);
  static const char *const rows[][2] = {{"1.5", "0.1638 of light at 60 degrees, and 0.1519 by"},
                                        {"2.417", "0.3488 of light at 60 degrees, and 0.3050 by"}};
  for (size_t i = 0; i < 2; i++) {
    const char *text =
        printed("materials:\n- {name: a, source: made up, model: constant, coefficients: [%s]}\n",
                rows[i][0]);
    MADE(abbe_material_table, table,
         abbe_material_table_parse(text, strlen(text), "table", &table, &error));
    snprintf(objects, sizeof objects, pane, "flat");
    OWNED(abbe_scene, glazed) = scene_of(printed(CAMERA POINT_LIGHT FLOOR "%s", objects));
    glazed.object[1].material = &table.material[0];
    plan_scene(&glazed, NULL, &plan);
    assert_true(is_noted(&plan, rows[i][1]));
    abbe_plan_free(&plan);
  }
}

/* Known answers for calcite, quartz, zircon and rutile; the middle one of three indices is of no
 * matter. */
TEST(double_images_are_noted) {
  static const struct {
    const char *indices, *note;
  } rows[] = {
#define TWO(o, e) "[" o "], extraordinary: {model: constant, coefficients: [" e "]}"
      {TWO("1.65834", "1.48613"),
       "walk-off 6.269 degrees, which moves an image by 1.099 mm per cm"},
      {TWO("1.5442", "1.5533"), "largest walk-off 0.337 degrees"},
      {TWO("1.925", "1.984"), "largest walk-off 1.729 degrees"},
      {TWO("2.616", "2.903"), "largest walk-off 5.954 degrees"},
      {TWO("1.6", "1.6"), "its indices are equal: it is no crystal"},
      {"[1.6], biaxial: {alpha: {model: constant, coefficients: [1.6]}, gamma: {model: constant, "
       "coefficients: [1.7]}}",
       "two of its three indices are equal: it is a uniaxial crystal"},
      {"[1.6], biaxial: {alpha: {model: constant, coefficients: [1.48613]}, gamma: {model: "
       "constant, coefficients: [1.65834]}}",
       "largest walk-off 6.269 degrees"}};
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("flat"));
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const char *text =
        printed("materials:\n- {name: a, source: made up, model: constant, coefficients: %s}\n",
                rows[i].indices);
    MADE(abbe_material_table, table,
         abbe_material_table_parse(text, strlen(text), "table", &table, &error));
    scene.object[1].material = &table.material[0];
    FILLED(abbe_plan, plan, plan_scene(&scene, NULL, &plan));
    assert_true(is_noted(&plan, rows[i].note));
  }
}
