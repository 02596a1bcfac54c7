/* Indices that are not known are refused, those that are extrapolated noted. */
#include "tests/gl/plan/planned.h"

#include "gl/plan/examine/spectral_needs.h"

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

/* What a film reflects, from both sides, beside the bare face. */
TEST(films_are_noted) {
  const char *head = "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR;
  FILLED(abbe_plan, plan,
         plan_text(printed("%s%s", head, BALL("n-bk7, coating: {layers: [[1.38, 99.638]]}")), NULL,
                   &plan));
  assert_true(is_noted(
      &plan, "ball: film: R at 0 degrees at 450/550/650 nm is 1.60/1.27/1.47 % from outside, "
             "1.60/1.27/1.47 % from inside; it is drawn bare, with 4.33/4.24/4.19 %"));
  abbe_plan_free(&plan);
  plan_text(printed("%s%s", head, BALL("n-bk7, coating: {layers: [[1.38, 0.5]]}")), NULL, &plan);
  assert_true(is_noted(&plan, "a layer of its film is 0.5 nm"));
}

/* A crystal has one index here, and the plan says what is left out, once a material. */
TEST(double_refraction_is_noted) {
  const char *head = "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR;
  FILLED(abbe_plan, plan,
         plan_text(printed("%s%s%s", head, BALL("calcite"), BRICK("calcite")), NULL, &plan));
  assert_true(is_noted(&plan, "calcite: double refraction is left out; it has its ordinary index "
                              "alone, and the extraordinary one is 0.1726 lower at 580 nm"));
  size_t count = 0;
  for (size_t i = 0; i < plan.note_count; i++)
    count += strstr(plan.note[i], "double refraction") != NULL ? 1 : 0;
  assert_int_equal(count, 1);
  abbe_plan_free(&plan);
  plan_text(printed("%s%s", head, BALL("diamond")), NULL, &plan);
  assert_false(is_noted(&plan, "double refraction"));
}
