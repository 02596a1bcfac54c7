/* What the plan leaves out does not show: with everything switched on the picture is the same. */
#include "tests/gl/frame.h"

#include "gl/plan/plan.h"

#define ASIDE                                                                                      \
  "- {name: aside, kind: spot, position: [-0.3, 0.03, 0.6], target: [-0.5, 0, 0], cone: 10, "      \
  "intensity: 1}\n"
#define WIDE                                                                                       \
  "- {name: wide, kind: disk, position: [0.2, 0.1, 0.6], target: [0, 0, 0], radius: 0.01, "        \
  "radiance: 100}\n"
#define EYE_ASIDE "materials: glass.yaml\ncamera: {eye: [0, -1, 0.5], target: [-0.6, 0, 0.05]}\n"

static void draw(const abbe_scene *scene, const abbe_render_desc *desc, abbe_image *out) {
  HELD(abbe_renderer, renderer) = drawn_renderer(scene, desc);
  *out = picture_of(renderer);
}

/* Root of the mean square, relative to the first picture's mean. */
static double difference(const abbe_image *a, const abbe_image *b) {
  double squares = 0, sum = 0;
  size_t count = a->width * a->height * a->channels;
  for (size_t i = 0; i < count; i++) {
    squares += pow((double)a->data[i] - (double)b->data[i], 2);
    sum += (double)a->data[i];
  }
  return sqrt(squares * (double)count) / sum;
}

static double with_everything(const abbe_scene *scene, size_t exits) {
  abbe_render_desc desc = small_frame;
  FILLED(abbe_image, planned, draw(scene, &desc, &planned));
  desc.everything = true;
  desc.exits = exits;
  FILLED(abbe_image, all, draw(scene, &desc, &all));
  return difference(&planned, &all);
}

GROUP(make_context, free_context);

/* Only rounding is left: floats in another order, and the map's whole units. */
TEST(what_no_fact_asks_for_changes_nothing) {
  static const char *const texts[] = {
      CAMERA POINT_LIGHT ASIDE FLOOR BALL("flat"),
      CAMERA POINT_LIGHT ASIDE FLOOR BRICK("crown"),
      EYE_ASIDE POINT_LIGHT FLOOR BALL("crown"),
      CAMERA POINT_LIGHT FLOOR,
      CAMERA POINT_LIGHT ASIDE FLOOR BALL("smoke"),
      CAMERA POINT_LIGHT ASIDE FLOOR HILL BALL("flat"),
  };
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    if (!all_cases() && i % 2 == 0) continue;
    OWNED(abbe_scene, scene) = scene_of(texts[i]);
    double found = with_everything(&scene, 8);
    if (!(found < 1e-3)) fail_msg("scene %zu: %g", i, found);
  }
}

/* What receivers show to rays through stones is what the camera has seen, where it has: nearly as
 * all. */
TEST(what_the_camera_has_seen_serves_rays) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT ASIDE FLOOR BRICK(
      "crown") "environment: {uniform: 0.1, softboxes: [{elevation: 60, azimuth: 90, width: 60, "
               "height: 30, radiance: 2}]}\n");
  const double found = with_everything(&scene, 8);
  print_message("%g apart\n", found);
  assert_true(found < 5e-3);
}

TEST(every_switch_is_on) {
  const abbe_render_desc all = {.everything = true};
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA POINT_LIGHT ASIDE WIDE FLOOR BALL("flat") "environment: {uniform: 0.1}\n");
  MADE(abbe_plan, plan, abbe_plan_make(&scene, &all, &plan, &error));
  for (size_t i = 0; i < plan.entry_count; i++) {
    const abbe_plan_entry *entry = &plan.entry[i];
    const bool model = entry->item == ABBE_PASS_RECEIVER_DEPTH || /* other models, other pictures */
                       entry->item == ABBE_CHOICE_MULTI_REFRACTOR_PATHS;
    if (entry->runs == model) fail_msg("%s: %s", entry->name, entry->reason);
  }
  assert_true(plan.reaches[1] && plan.receiver_shadows && plan.absorbing && plan.textured);
  assert_true(plan.draw_back && plan.fills && plan.camera_sees_refractor);
  assert_int_equal(plan.desc.wavelengths, 7);
  assert_int_equal(plan.desc.exits, ABBE_RENDER_MAX_EXITS);
}

TEST(what_is_asked_for_stays) {
  const abbe_render_desc all = {
      .everything = true, .wavelengths = 3, .exits = 2, .fill = ABBE_FILL_NONE};
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT ASIDE FLOOR BALL("flat"));
  MADE(abbe_plan, plan, abbe_plan_make(&scene, &all, &plan, &error));
  assert_int_equal(plan.desc.wavelengths, 3);
  assert_int_equal(plan.desc.exits, 2);
  assert_false(plan.fills || abbe_plan_find(&plan, ABBE_PASS_GAP_FILL, 0)->runs);
}
