/* Which model follows light through a refractor, which serve when asked for, and what is noted. */
#include "tests/gl/plan/planned.h"

#include "gl/plan/examine/examine.h"
#include "scenes/shapes/shape.h"

/* What is asked for is taken where it can serve, and refused by name where it cannot. */
TEST(a_model_that_is_asked_for) {
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
      {CAMERA POINT_LIGHT FLOOR BRICK("crown"), ABBE_MODEL_LAYERS, ABBE_REFRACTOR_CONVEX, false,
       NULL},
      {CAMERA POINT_LIGHT FLOOR BALL("crown"), ABBE_MODEL_BVH, ABBE_REFRACTOR_BVH, true, NULL},
      {CAMERA POINT_LIGHT FLOOR RING("crown"), ABBE_MODEL_LAYERS, ABBE_REFRACTOR_LAYERS, false,
       NULL},
      {CAMERA POINT_LIGHT FLOOR BALL("crown") RING("crown"), ABBE_MODEL_SPHERE,
       ABBE_REFRACTOR_SPHERE, false, "'sphere' cannot serve 'ring'"},
      {CAMERA POINT_LIGHT FLOOR BALL("crown"), ABBE_MODEL_CONVEX, ABBE_REFRACTOR_CONVEX, false,
       "'convex' cannot serve 'ball'"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    abbe_plan plan;
    abbe_error error = {0};
    OWNED(abbe_scene, scene) = scene_of(rows[i].text);
    abbe_result result =
        abbe_plan_make(&scene, &(abbe_render_desc){.model = rows[i].model}, &plan, &error);
    assert_int_equal(result, rows[i].refusal != NULL ? ABBE_UNSUPPORTED : ABBE_OK);
    if (rows[i].refusal != NULL) {
      assert_contains(error.text, rows[i].refusal);
    } else {
      assert_int_equal(plan.model[0], rows[i].expected);
      assert_true(plan.multi_refractor_paths == rows[i].walk);
      abbe_plan_free(&plan);
    }
  }
}

TEST(too_many_refractors_are_unsupported) {
  abbe_plan plan;
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  abbe_object *object = scene.object;
  FREED abbe_object *many = calloc(256, sizeof *many);
  assert_non_null(many);
  for (size_t i = 0; i < 256; i++) many[i] = object[1];
  scene.object = many;
  scene.object_count = 255;
  plan_scene(&scene, NULL, &plan);
  assert_int_equal(plan.refractor_count, 255);
  assert_contains(abbe_plan_find(&plan, ABBE_CHOICE_MORE_REFRACTORS, 0)->reason,
                  "and 207 refractors more");
  assert_true(abbe_plan_find(&plan, ABBE_PASS_EYE_PICTURE, 0)->runs);
  abbe_plan_free(&plan);
  scene.object_count = 256;
  REFUSED(ABBE_UNSUPPORTED, "255 refractors", abbe_plan_make(&scene, NULL, &plan, &error));
  scene.object = object;
  scene.object_count = 2;
}

#define DROP(name, radius, z)                                                                      \
  "- {name: " name ", shape: sphere, radius: " radius ", levels: 2, "                              \
  "transform: [{translate: [0.09, 0.09, " z "]}], material: flat}\n"

TEST(refractors_that_overlap_are_noted) {
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
  const abbe_render_desc apart = {.profile = ABBE_PROFILE_THESIS};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    OWNED(abbe_scene, scene) = scene_of(rows[i].text);
    MADE(abbe_plan, plan, abbe_plan_make(&scene, &apart, &plan, &error));
    if (is_noted(&plan, "overlap") != (rows[i].part != NULL) ||
        (rows[i].part != NULL && !is_noted(&plan, rows[i].part)))
      fail_msg("scene %zu: %s", i,
               plan.note_count > 0 ? plan.note[plan.note_count - 1] : "no note");
  }
}

/* Layers show few of a diamond's reflections, and enough of what lets light out soon. */
TEST(light_that_layers_do_not_show_is_noted) {
  static const abbe_render_desc layers = {.model = ABBE_MODEL_LAYERS};
  static const struct {
    const char *text;
    const abbe_render_desc *asked;
    bool noted;
  } rows[] = {{CAMERA POINT_LIGHT FLOOR RING("dense"), &layers, true},
              {CAMERA POINT_LIGHT FLOOR RING("dense"), NULL, false},
              {CAMERA POINT_LIGHT FLOOR RING("crown"), &layers, false},
              {CAMERA POINT_LIGHT FLOOR BRICK("dense"), &layers, false}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    OWNED(abbe_scene, scene) = scene_of(rows[i].text);
    MADE(abbe_plan, plan, abbe_plan_make(&scene, rows[i].asked, &plan, &error));
    assert_int_equal(is_noted(&plan, "'ring' keeps light for many inner reflections"),
                     rows[i].noted);
  }
}

/* Of names no facets of one plane differ, but faces within rounding of it may. */
TEST(faces_of_one_plane_may_have_films_of_their_own) {
  OWNED(abbe_scene, scene) = scene_of(
      CAMERA POINT_LIGHT FLOOR BRICK("crown, coating: {layers: [[2.4, 120]], faces: girdle}"));
  const abbe_render_desc layers = {.model = ABBE_MODEL_LAYERS};
  for (int differ = 0; differ < 2; differ++) {
    MADE(abbe_plan, auto_plan, abbe_plan_make(&scene, NULL, &auto_plan, &error));
    MADE(abbe_plan, plan, abbe_plan_make(&scene, &layers, &plan, &error));
    assert_int_equal(auto_plan.model[0], differ ? ABBE_REFRACTOR_BVH : ABBE_REFRACTOR_CONVEX);
    assert_int_equal(plan.model[0], ABBE_REFRACTOR_CONVEX);
    assert_false(is_noted(&auto_plan, "it is drawn bare"));
    assert_int_equal(is_noted(&plan, "it is drawn bare"), differ);
    abbe_coatings *c = scene.object[1].coatings;
    for (size_t f = 0; f < c->face_count && !differ; f++)
      if (c->face[f] != 0) {
        c->face[f] = 0;
        break;
      }
  }
}

TEST(convex_meshes_are_known) {
  MADE(abbe_mesh, mesh, abbe_shape_sphere(2, 3, &mesh, &error));
  assert_true(abbe_mesh_is_convex(&mesh));
  /* one corner drawn in by a tenth */
  for (int k = 0; k < 3; k++) mesh.position[0][k] *= 0.9;
  assert_false(abbe_mesh_is_convex(&mesh));
  abbe_mesh_free(&mesh);
  OK(abbe_shape_ring(0.08, 0.02, 32, 16, &mesh, &error));
  assert_false(abbe_mesh_is_convex(&mesh));
}
