/* Charts of receivers: parallelograms first, every face on the side of the chart that it lies on.
 */
#include "tests/scenes/scene_text.h"

#include "base/maths.h"
#include "gl/scene/gpu_scene.h"

#define CRATE                                                                                      \
  "- {name: crate, shape: box, size: [0.1, 0.2, 0.3], transform: [{rotate: {axis: [1, 2, 3], "     \
  "angle: 40}}, {translate: [0.3, 0, 0.3]}], reflectance: 0.5}\n"
#define CEILING                                                                                    \
  "- {name: ceiling, shape: rectangle, width: 2, height: 2, reflectance: 0.5, transform: "         \
  "[{rotate: {axis: [1, 0, 0], angle: 180}}, {translate: [0, 0, 1.2]}]}\n"

static void make_charts(const char *text, abbe_scene *scene, abbe_plan *plan,
                        abbe_receiver_charts *out) {
  abbe_error error = {0};
  *scene = scene_of(text);
  abbe_result result = abbe_plan_make(scene, NULL, plan, &error);
  if (result == ABBE_OK) result = abbe_receiver_charts_make(scene, plan, out, &error);
  if (result != ABBE_OK) print_error("%s\n", error.text);
  assert_int_equal(result, ABBE_OK);
}

TEST(faces_know_their_sides) {
  OWNED(abbe_scene, scene) = {0};
  OWNED(abbe_plan, plan) = {0};
  OWNED(abbe_receiver_charts, charts) = {0};
  make_charts(CAMERA POINT_LIGHT FLOOR HILL CRATE BALL("crown") CEILING, &scene, &plan, &charts);
  assert_int_equal(plan.receiver_count, 4);
  assert_int_equal(plan.parallelogram_count, 8);
  assert_int_equal(charts.count, 8 + 6);
  assert_int_equal(charts.face_first[4], charts.face_count);
  for (size_t i = 0; i < plan.receiver_count; i++) {
    const abbe_mesh *mesh = &scene.object[plan.receiver_object[i]].mesh;
    const bool exact = plan.receiver_model[i] == ABBE_RECEIVER_EXACT;
    for (size_t f = 0; f < mesh->face_count; f++) {
      const size_t side = (size_t)charts.face_side[charts.face_first[i] + f];
      const double *p = charts.parallelogram[side / 2];
      const double *corner[3];
      double n[3], across[3];
      assert_true(side / 2 < charts.count && exact == (side / 2 < 8));
      assert_int_equal(charts.object[side / 2], plan.receiver_object[i]);
      for (int k = 0; k < 3; k++) corner[k] = mesh->position[mesh->face[f][k]];
      abbe_vector_triangle(corner[0], corner[1], corner[2], n);
      abbe_vector_cross(p + 3, p + 6, across);
      assert_true(abbe_vector_normalise(n) && abbe_vector_normalise(across));
      const double along = abbe_vector_dot(n, across) * (side % 2 == 0 ? 1 : -1);
      assert_true(along > (exact ? 1 - 1e-9 : 0.5));
      for (int k = 0; k < 3 && exact; k++) {
        double from[3];
        abbe_vector_subtract(corner[k], p, from);
        assert_true(fabs(abbe_vector_dot(from, across)) < 1e-9);
      }
    }
  }
}
