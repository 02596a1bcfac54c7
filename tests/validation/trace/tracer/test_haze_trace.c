/* Whole runs in haze: the ledger closes, zeros change nothing, threads change nothing, and light
 * that comes through glass that is none is scattered like light that comes straight. */
#include "tests/validation/trace_scene.h"

#define MIST(scattering)                                                                           \
  "medium: {scattering: " scattering ", absorption: 0, g: 0.2, box: [[-1, -1, 0.01], [1, 1, "      \
  "0.6]]}\n"

static void trace(const char *text, const abbe_trace_desc *desc, size_t passes, abbe_image *picture,
                  abbe_trace_statistics *statistics) {
  OWNED(abbe_scene, scene) = scene_of(text);
  HELD(abbe_tracer, tracer) = make_tracer(&scene, desc);
  run_passes(tracer, passes);
  if (picture != NULL) OK(abbe_tracer_picture(tracer, picture, &error));
  if (statistics != NULL) abbe_tracer_statistics(tracer, statistics);
}

TEST(the_ledger_closes) {
  static const char *const scenes[] = {
      CAMERA POINT_LIGHT MIST("2") FLOOR BALL("murk"),
      CAMERA SUN MIST("0.5") FLOOR
      "- {name: cloudy, shape: sphere, radius: 0.08, transform: [{translate: [0, 0, 0.2]}], "
      "material: smoke, medium: {scattering: [[400, 9], [700, 3]], g: 0.7}}\n",
      /* a receiver that stands in what scatters */
      CAMERA SUN FLOOR "- {name: pool, shape: box, size: [0.4, 0.4, 0.2], transform: [{translate: "
                       "[0, 0, 0.05]}], material: crown, medium: {scattering: 4}}\n"};
  for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
    abbe_trace_statistics s;
    const abbe_trace_desc desc = {.width = 8, .height = 8, .no_map = true, .photons = 1 << 14};
    trace(scenes[i], &desc, 2, NULL, &s);
    const abbe_light_ledger *l = &s.ledger;
    assert_true(l->scattered + l->turned > 0.05 * l->reached); /* once in the air, on and on inside */
    assert_near((l->deposited + l->absorbed + l->missed + l->trapped + l->lost + l->scattered) /
                    l->reached,
                1, 1e-4);
  }
}

/* exp(-depth) of the light that sets out reaches the floor through a plate of air's index. */
TEST(what_is_left_is_known) {
  abbe_trace_statistics s;
  const abbe_trace_desc desc = {.width = 4, .height = 4, .no_map = true, .photons = 1 << 14};
  trace("materials: glass.yaml\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"
        "lights:\n- {name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1}\n" MIST(
            "1.3") FLOOR "- {name: plate, shape: box, size: [0.2, 0.2, 0.1], transform: "
                         "[{translate: [0, 0, 0.75]}], material: air}\n",
        &desc, 1, NULL, &s);
  assert_near(s.ledger.reached, 0.04, 3e-4);
  assert_near(s.ledger.deposited / s.ledger.reached, exp(-1.3 * 0.59), 1e-3);
  assert_near(s.ledger.scattered / s.ledger.reached, 1 - exp(-1.3 * 0.59), 1e-3);
}

TEST(zeros_change_no_bit) {
  const abbe_trace_desc desc = {.width = 16, .height = 12, .no_map = true, .photons = 1 << 13};
  OWNED(abbe_image, zero);
  FILLED(abbe_image, clear, trace(CAMERA POINT_LIGHT FLOOR BALL("murk"), &desc, 2, &clear, NULL));
  trace(CAMERA POINT_LIGHT MIST("0") FLOOR
        "- {name: ball, shape: sphere, radius: 0.08, levels: 4, transform: [{translate: [0, 0, "
        "0.2]}], material: murk, medium: {scattering: 0, g: 0.5}}\n",
        &desc, 2, &zero, NULL);
  check_same_image(&clear, &zero);
}

TEST(threads_change_no_bit) {
  static const char text[] = CAMERA POINT_LIGHT MIST("[[400, 3], [700, 1]]") FLOOR BALL("crown");
  abbe_trace_desc desc = {
      .width = 16, .height = 12, .no_map = true, .photons = 1 << 15, .threads = 1};
  FILLED(abbe_image, one, trace(text, &desc, 2, &one, NULL));
  desc.threads = 3;
  FILLED(abbe_image, three, trace(text, &desc, 2, &three, NULL));
  check_same_image(&one, &three);
}

/* Mist under a plate of air's index, which hides the lamp: photons bring what came straight
 * before. With a second plate before the eye they are gathered, without it they find the eye. */
TEST(photons_bring_what_came_straight) {
#define VIEW                                                                                       \
  "materials: glass.yaml\ncamera: {eye: [0, -0.8, 0.3], target: [0, 0, 0.3], fov: 20}\n"           \
  "lights:\n- {name: lamp, kind: point, position: [0, 0, 1.2], intensity: 1}\n"                    \
  "medium: {scattering: 0.5, g: 0.3, box: [[-0.3, -0.3, 0.01], [0.3, 0.3, 0.6]]}\n"                \
  "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0}\n"
#define ROOF                                                                                       \
  "- {name: roof, shape: box, size: [0.8, 0.8, 0.02], transform: [{translate: [0, 0, 0.7]}], "     \
  "material: air}\n"
#define PANE                                                                                       \
  "- {name: pane, shape: box, size: [0.6, 0.02, 0.4], transform: [{translate: [0, -0.4, 0.3]}], "  \
  "material: air}\n"
  static const char *const scenes[] = {VIEW, VIEW ROOF, VIEW ROOF PANE};
  double sum[3];
  for (int i = 0; i < 3; i++) {
    const abbe_trace_desc desc = {.width = 8, .height = 8, .no_map = true, .photons = 1 << 16};
    FILLED(abbe_image, picture, trace(scenes[i], &desc, 4, &picture, NULL));
    sum[i] = channel_sum(&picture, "G");
  }
  assert_true(sum[0] > 0);
  assert_near(sum[1] / sum[0], 1, 0.02);
  assert_near(sum[2] / sum[0], 1, 0.02);
}
