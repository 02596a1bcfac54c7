/* planned.h: plans of scenes that a test writes down, and what must not be planned. */
#ifndef ABBE_TESTS_GL_PLAN_PLANNED_H
#define ABBE_TESTS_GL_PLAN_PLANNED_H

#include "tests/scenes/scene_text.h"

#include "gl/plan/plan.h"

static inline void plan_scene(const abbe_scene *scene, const abbe_render_desc *desc,
                              abbe_plan *plan) {
  OK(abbe_plan_make(scene, desc, plan, &error));
}

static inline void plan_text(const char *text, const abbe_render_desc *desc, abbe_plan *plan) {
  OWNED(abbe_scene, scene) = scene_of(text);
  plan_scene(&scene, desc, plan);
}

static inline bool is_noted(const abbe_plan *plan, const char *part) {
  for (size_t i = 0; i < plan->note_count; i++)
    if (strstr(plan->note[i], part) != NULL) return true;
  return false;
}

/* The plan of the text is refused so, and the sentence has the part. */
static inline void refuse_plan(const char *text, const abbe_render_desc *desc, abbe_result expected,
                               const char *part) {
  abbe_plan plan;
  abbe_error error = {0};
  OWNED(abbe_scene, scene) = scene_of(text);
  assert_int_equal(abbe_plan_make(&scene, desc, &plan, &error), expected);
  assert_int_equal(error.code, expected);
  assert_contains(error.text, part);
}

#endif
