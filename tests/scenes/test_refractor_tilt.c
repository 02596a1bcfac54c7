/* Stones that are tilted stand where a file with the same rotation puts them. */
#include "tests/scenes/scene_text.h"

#include "scenes/object_motion.h"

#define RAD (3.14159265358979323846 / 180)
#define START CAMERA POINT_LIGHT FLOOR
#define STONE_AT(name, steps)                                                                      \
  "- {name: " name ", shape: box, size: [0.1, 0.08, 0.06], material: crown, transform: [" steps    \
  "]}\n"
#define PANE                                                                                       \
  "- {name: pane, shape: box, size: [0.1, 0.1, 0.01], mirror: 0.5,\n"                              \
  "   transform: [{translate: [0.3, 0, 0.2]}]}\n"
/* About (0.2, 0.1, 0.3), the middle of both, by 25 degrees about the axis of azimuth 30. */
#define TURNED                                                                                     \
  ", {translate: [-0.2, -0.1, -0.3]}, {rotate: {axis: [0.8660254037844387, 0.5, 0], angle: 25}}, " \
  "{translate: [0.2, 0.1, 0.3]}"
#define ONE "{translate: [0.1, 0.1, 0.2]}"
#define OTHER "{translate: [0.3, 0.1, 0.4]}"

TEST(all_refractors_turn_about_their_middle) {
  OWNED(abbe_scene, tilted) = scene_of(START STONE_AT("a", ONE) PANE STONE_AT("b", OTHER));
  OWNED(abbe_scene, there) =
      scene_of(START STONE_AT("a", ONE TURNED) PANE STONE_AT("b", OTHER TURNED));
  OK(abbe_refractors_tilt(&tilted, 25 * RAD, 30 * RAD, &error));
  for (size_t i = 0; i < tilted.object_count; i++) {
    const abbe_object *a = &tilted.object[i], *b = &there.object[i];
    for (size_t v = 0; v < a->mesh.vertex_count; v++)
      for (int k = 0; k < 3; k++)
        assert_near(a->mesh.position[v][k], b->mesh.position[v][k], 1e-12);
    for (int k = 0; k < 3; k++) assert_near(a->max[k], b->max[k], 1e-12);
  }
}

/* As abbe gem report has it: what is left of the axis' arrow rises. */
TEST(a_tilt_lifts_what_is_left_of_its_axis) {
  OWNED(abbe_scene, scene) = scene_of(START STONE_AT("a", "{translate: [0, 0, 0.2]}"));
  abbe_object *o = &scene.object[1];
  size_t left = 0;
  for (size_t v = 0; v < o->mesh.vertex_count; v++)
    if (o->mesh.position[v][1] > 0.039) left = v;
  const double before = o->mesh.position[left][2];
  OK(abbe_refractors_tilt(&scene, 10 * RAD, 0, &error));
  assert_true(o->mesh.position[left][2] > before + 0.005);
}

static void refused(const char *text, double tilt, abbe_result why, const char *part) {
  OWNED(abbe_scene, scene) = scene_of(text);
  REFUSED(why, part, abbe_refractors_tilt(&scene, tilt, 0, &error));
}

TEST(what_cannot_be_tilted_is_refused) {
  refused(START PANE, 0.1, ABBE_INVALID_ARGUMENT, "no refractor");
  refused(START STONE_AT("a", ONE), NAN, ABBE_INVALID_ARGUMENT, "finite");
  /* a corner reaches the lamp */
  refused("materials: glass.yaml\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"
          "lights:\n- {name: lamp, kind: point, position: [0, 0, 0.3], intensity: 1}\n" FLOOR
          "- {name: a, shape: box, size: [0.1, 0.4, 0.1], material: crown,\n"
          "   transform: [{translate: [0, 0, 0.2]}]}\n",
          0.5 * 3.14159, ABBE_UNSUPPORTED, "lamp");
}
