/* Which settings are taken by name, by error and by time, and whether a frame kept what they say.
 */
#include "tests/gl/frame.h"

#include "gl/accuracy/preset.h"

#include <unistd.h>

#define POINT(photons, light, error)                                                               \
  "  - {wavelengths: 3, photons: " photons                                                         \
  ", map: 64, samples: 1, fill: bridge, exits: 2, share: 0.1, light_ms: " light                    \
  ", eye_ms: 1, error: " error ", least: 0.5}\n"
/* Times that no machine is as slow as: what matters is their ratio. */
#define PRESETS                                                                                    \
  "error: caustic_de\nwhat: mean error\nrun: a run\nclasses:\n- class: spheres\n  scenes: ball\n"  \
  "  draft: 0\n  balanced: 1\n  front:\n" POINT("16", "1", "8") POINT("24", "10", "4")             \
      POINT("32", "1e7", "2")
#define SCENE CAMERA POINT_LIGHT FLOOR BALL("crown")

static char path[64];
static abbe_scene scene;

static abbe_result choose(abbe_preset_request request, abbe_render_desc *desc,
                          abbe_preset_choice *out, abbe_error *error) {
  request.file = path;
  return abbe_preset_choose(&request, context, &scene, desc, out, error);
}

static void begin(void) {
  snprintf(path, sizeof path, "/tmp/abbe_test_preset_choice_%ld.yaml", (long)getpid());
  OK(abbe_file_write(path, PRESETS, strlen(PRESETS), &error));
  scene = scene_of(SCENE);
  make_context();
}

static void finish(void) {
  free_context();
  abbe_scene_free(&scene);
  unlink(path);
}

GROUP(begin, finish);

TEST(names_and_errors) {
  abbe_render_desc desc = {.width = 16, .height = 16};
  MADE(abbe_preset_choice, c, choose((abbe_preset_request){.name = "balanced"}, &desc, &c, &error));
  assert_int_equal(desc.photons, 24);
  assert_true(c.kept && !c.overridden && !c.timed);
  OK(abbe_preset_choice_check(&c, 1e9, &error));
  abbe_preset_choice_free(&c);
  /* The cheapest that keeps the error; a field of one's own stays. */
  desc = (abbe_render_desc){.wavelengths = 5};
  OK(choose((abbe_preset_request){.max_error = 5}, &desc, &c, &error));
  assert_int_equal(desc.photons, 24);
  assert_int_equal(desc.wavelengths, 5);
  assert_true(c.kept && c.overridden);
  abbe_preset_choice_free(&c);
  /* None does: the most accurate, and the picture is out of tolerance. */
  desc = (abbe_render_desc){0};
  OK(choose((abbe_preset_request){.max_error = 1}, &desc, &c, &error));
  assert_int_equal(desc.photons, 32);
  assert_false(c.kept);
  REFUSED(ABBE_TOLERANCE, "", abbe_preset_choice_check(&c, 1, &error));
}

TEST(times) {
  abbe_render_desc desc = {.width = 16, .height = 16};
  MADE(abbe_preset_choice, c, choose((abbe_preset_request){.budget_ms = 1e-6}, &desc, &c, &error));
  assert_int_equal(desc.photons, 16);
  assert_true(c.timed && c.promised_ms > 0);
  assert_false(c.kept);
  REFUSED(ABBE_TOLERANCE, "the budget of 1e-06 ms is not kept, for no faster settings",
          abbe_preset_choice_check(&c, 1, &error));
  OK(abbe_preset_choice_check(&c, 1e-7, &error));
  /* Frames that differed are said to be of a busy machine; those that did not are not. */
  assert_true(c.unrest >= 0);
  c.unrest = 0.5;
  REFUSED(ABBE_TOLERANCE, "the machine is busy: repeats took 50 % longer than the fastest",
          abbe_preset_choice_check(&c, 1, &error));
  c.unrest = 0.05;
  REFUSED(ABBE_TOLERANCE, "", abbe_preset_choice_check(&c, 1, &error));
  assert_null(strstr(last_error.text, "busy"));
}

TEST(what_cannot_be_chosen) {
  abbe_render_desc desc = {0}, thesis = {.profile = ABBE_PROFILE_THESIS};
  MADE(abbe_preset_choice, c, choose((abbe_preset_request){0}, &desc, &c, &error));
  assert_null(c.point);
  assert_int_equal(desc.photons, 0);
  OK(abbe_preset_choice_check(&c, 1e9, &error));
  REFUSED(ABBE_NOT_FOUND, "there is no 'accurate' for scenes of the class spheres",
          choose((abbe_preset_request){.name = "accurate"}, &desc, &c, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          choose((abbe_preset_request){.name = "draft"}, &thesis, &c, &error));
}

TEST(settings_in_words) {
  char text[200];
  abbe_render_desc d =
      FIELDS(.wavelengths = 7, .photons = 256, .map_size = 1024, .supersample = 1, .upsample = 2,
             .fill = ABBE_FILL_BRIDGE, .exits = 8, .energy_share = 0.01);
  abbe_preset_describe(&d, text, sizeof text);
  assert_string_equal(text, "7 wavelengths, 256 photons, map 1024, 1 samples, fill bridge, 8 "
                            "exits, share 0.01, model auto, upsample 2");
  d.profile = ABBE_PROFILE_THESIS_CIE;
  abbe_preset_describe(&d, text, sizeof text);
  assert_contains(text, "thesis-cie: 7 wavelengths");
}
