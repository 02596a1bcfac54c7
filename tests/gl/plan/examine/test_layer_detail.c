/* How finely layers are drawn: what asks for fewer faces, and within what distance. */
#include "tests/scenes/scene_text.h"

#include "gl/plan/examine/layer_detail.h"
#include "gl/plan/plan.h"
#include "scenes/shapes/shape.h"

#include <math.h>

static const double up[3] = {0, 1, 0}, forward[3] = {0, 0, -1};
static const size_t steps[2] = {20, 10};

static void close_to(double value, double expected) {
  if (!(fabs(value - expected) <= 1e-9 * fabs(expected))) fail_msg("%g, not %g", value, expected);
}

/* A cube of 2 m; its nearest corners are 4 m from the eye. */
static void a_step_is_as_wide_as_where_the_mesh_is_nearest(void **state) {
  (void)state;
  const double size[3] = {2, 2, 2}, eye[3] = {0, 0, 5}, within[3] = {0, 0, 0.5};
  const double window[4] = {-0.5, 0.5, -0.1, 0.3};
  abbe_mesh cube;
  abbe_view view;
  assert_int_equal(abbe_shape_box(size, &cube, NULL), ABBE_OK);
  abbe_view_look(eye, forward, up, false, &view);
  memcpy(view.window, window, sizeof window);
  close_to(abbe_layer_detail_step(&view, steps, &cube), 4 * 0.4 / 10);
  view.window[0] = 0.3;
  close_to(abbe_layer_detail_step(&view, steps, &cube), 4 * 0.2 / 20);
  abbe_view_look(within, forward, up, false, &view);
  memcpy(view.window, window, sizeof window);
  assert_true(abbe_layer_detail_step(&view, steps, &cube) == 0);
  abbe_view_look(eye, forward, up, true, &view);
  memcpy(view.window, window, sizeof window);
  close_to(abbe_layer_detail_step(&view, steps, &cube), 0.4 / 10);
  abbe_mesh_free(&cube);
}

static void the_finer_of_cells_and_samples_decides(void **state) {
  (void)state;
  const double cell = abbe_layer_detail_distance(1e-3, INFINITY);
  const double sample = abbe_layer_detail_distance(INFINITY, 1e-3);
  assert_true(cell > 0 && cell < 1e-4 && sample > 0 && sample < 2e-4);
  assert_true(abbe_layer_detail_distance(1e-3, 1e-3) == fmin(cell, sample));
  assert_true(abbe_layer_detail_distance(0, 1e-3) == 0);
  assert_false(isfinite(abbe_layer_detail_distance(INFINITY, INFINITY)));
  assert_true(abbe_layer_detail_saves(10, 20));
  assert_false(abbe_layer_detail_saves(11, 20));
}

static const abbe_object *finest(const abbe_scene *scene, const abbe_render_desc *desc, bool *runs,
                                 bool *told) {
  abbe_plan plan;
  abbe_error error = {0};
  if (abbe_plan_make(scene, desc, &plan, &error) != ABBE_OK) fail_msg("%s", error.text);
  const abbe_plan_entry *entry = abbe_plan_find(&plan, ABBE_CHOICE_FEWER_FACES, 0);
  const abbe_object *found = abbe_layer_detail_finest(scene, &plan);
  *told = entry != NULL;
  *runs = *told && entry->runs;
  abbe_plan_free(&plan);
  return found;
}

static void only_layers_of_many_faces_ask(void **state) {
  (void)state;
  abbe_scene rings;
  bool runs, told;
  load_text(CAMERA POINT_LIGHT FLOOR RING("crown") "- {name: coarse, shape: ring, major: 0.02, "
                                                   "minor: 0.01, around: 12, across: 8,\n"
                                                   "   material: crown}\n",
            &rings);
  const abbe_object *ring = &rings.object[1];
  assert_true(ring->mesh.face_count > ABBE_LAYER_DETAIL_FACES);
  assert_ptr_equal(finest(&rings, &(abbe_render_desc){.model = ABBE_MODEL_LAYERS}, &runs, &told),
                   ring);
  assert_true(runs);
  const abbe_render_desc other[] = {
      {0}, {.profile = ABBE_PROFILE_THESIS_CIE}, {.model = ABBE_MODEL_LAYERS, .everything = true}};
  for (size_t i = 0; i < sizeof other / sizeof *other; i++) {
    assert_null(finest(&rings, &other[i], &runs, &told));
    assert_false(runs);
    assert_int_equal(told, other[i].model == ABBE_MODEL_LAYERS);
  }
  rings.object[1].mesh.face_count = ABBE_LAYER_DETAIL_FACES;
  assert_null(finest(&rings, &(abbe_render_desc){.model = ABBE_MODEL_LAYERS}, &runs, &told));
  assert_true(told && !runs);
  abbe_scene_free(&rings);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_step_is_as_wide_as_where_the_mesh_is_nearest),
      cmocka_unit_test(the_finer_of_cells_and_samples_decides),
      cmocka_unit_test(only_layers_of_many_faces_ask),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
