/* Settings of tables as the renderer's requests, and in words. */
#include "tests/check.h"

#include "library/choice/sweep_setting.h"

static const abbe_render_desc fine = {.wavelengths = 21,
                                      .photons = 512,
                                      .map_size = 1024,
                                      .supersample = 2,
                                      .upsample = 1,
                                      .fill = ABBE_FILL_BRIDGE,
                                      .energy_share = 0.01,
                                      .exits = 8};

TEST(there_and_back) {
  abbe_sweep_setting setting;
  abbe_render_desc desc;
  abbe_sweep_setting_of(&fine, &setting);
  OK(abbe_sweep_setting_desc(&setting, &desc, &error));
  assert_memory_equal(&desc, &fine, sizeof desc);
  assert_true(abbe_sweep_setting_is_fine(&setting));
  setting.photons = 64;
  assert_false(abbe_sweep_setting_is_fine(&setting));
  char text[200];
  setting.history = 4;
  abbe_sweep_setting_describe(&setting, text, sizeof text);
  assert_contains(text, ", of 4 frames");
  OK(abbe_sweep_setting_desc(&setting, &desc, &error));
  assert_int_equal(desc.history, 4);
  /* What is without effect in a thesis profile makes one setting of all. */
  desc.profile = ABBE_PROFILE_THESIS;
  desc.energy_share = 0.5;
  abbe_sweep_setting_of(&desc, &setting);
  assert_int_equal(setting.samples, 1);
  assert_near(setting.share, 0.01, 0);
}

/* Names are those of the bits that they sum, and lead back. */
static const abbe_render_desc quads = {.profile = ABBE_PROFILE_WYMAN2006,
                                       .wavelengths = 7,
                                       .photons = 64,
                                       .map_size = 64,
                                       .supersample = 1,
                                       .upsample = 1,
                                       .fill = ABBE_FILL_QUADS,
                                       .energy_share = 0.01};

TEST(kinds_of_polygons) {
#define NAME(code, name, bit) {name, bit},
  static const struct {
    const char *name;
    unsigned bit;
  } kinds[] = {ABBE_POLYGONS(NAME)};
  for (unsigned bits = 0; bits <= ABBE_POLYGONS_ALL; bits++) {
    char words[64] = "", text[200];
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
      if ((bits & kinds[i].bit) == 0) continue;
      if (*words != '\0') strcat(words, "+");
      strcat(words, kinds[i].name);
    }
    assert_string_equal(abbe_sweep_polygons[bits], bits > 0 ? words : "plain");
    abbe_sweep_setting setting;
    abbe_render_desc back, desc = quads;
    desc.polygons = bits;
    abbe_sweep_setting_of(&desc, &setting);
    assert_string_equal(setting.polygons, words);
    OK(abbe_sweep_setting_desc(&setting, &back, &error));
    assert_memory_equal(&back, &desc, sizeof back);
    abbe_sweep_setting_describe(&setting, text, sizeof text);
    if (bits > 0) assert_contains(text, words);
    snprintf(setting.polygons, sizeof setting.polygons, "round");
    assert_int_equal(abbe_sweep_setting_desc(&setting, &back, NULL), ABBE_NOT_FOUND);
  }
}

TEST(directions) {
  for (int k = 0; k < ABBE_DIRECTION_COUNT; k++) {
    abbe_sweep_setting setting;
    char text[200];
    abbe_render_desc back, desc = quads;
    desc.direction = (abbe_direction)k;
    const bool other = k == ABBE_DIRECTION_OWN || k == ABBE_DIRECTION_DIRECT;
    abbe_sweep_setting_of(&desc, &setting);
    assert_string_equal(setting.direction, other ? abbe_sweep_directions[k] : "");
    OK(abbe_sweep_setting_desc(&setting, &back, &error));
    assert_int_equal(back.direction, other ? k : ABBE_DIRECTION_AUTO);
    abbe_sweep_setting_describe(&setting, text, sizeof text);
    if (other) assert_contains(text, abbe_sweep_directions[k]);
  }
  abbe_sweep_setting setting;
  abbe_render_desc back;
  abbe_sweep_setting_of(&(abbe_render_desc){.profile = ABBE_PROFILE_WYMAN2006}, &setting);
  snprintf(setting.direction, sizeof setting.direction, "sideways");
  assert_int_equal(abbe_sweep_setting_desc(&setting, &back, NULL), ABBE_NOT_FOUND);
}

TEST(pinholes_are_contestants) {
  abbe_sweep_setting setting;
  abbe_render_desc desc = fine;
  char text[200];
  desc.transport = ABBE_TRANSPORT_PINHOLE;
  desc.pinholes = 256;
  abbe_sweep_setting_of(&desc, &setting);
  assert_string_equal(setting.profile, "pinhole-256");
  assert_false(abbe_sweep_setting_is_fine(&setting)); /* presets have none */
  abbe_sweep_setting_describe(&setting, text, sizeof text);
  assert_contains(text, "pinhole-256");
  abbe_render_desc back;
  OK(abbe_sweep_setting_desc(&setting, &back, &error));
  assert_memory_equal(&back, &desc, sizeof back);
  static const char *const wrong[] = {"pinhole-", "pinhole-x", "pinhole-99999", "pinhole-0"};
  for (int i = 0; i < 4; i++) {
    snprintf(setting.profile, sizeof setting.profile, "%s", wrong[i]);
    assert_int_equal(abbe_sweep_setting_desc(&setting, &back, NULL), ABBE_NOT_FOUND);
  }
}

TEST(unknown_names) {
  static const abbe_sweep_setting wrong = {
      .profile = "default", .fill = "glue", .model = "auto", .wavelengths = 3, .share = 0.01};
  abbe_render_desc desc;
  char text[200];
  REFUSED(ABBE_NOT_FOUND, "'glue'", abbe_sweep_setting_desc(&wrong, &desc, &error));
  assert_false(abbe_sweep_setting_is_fine(&wrong));
  abbe_sweep_setting_describe(&wrong, text, sizeof text);
  assert_contains(text, "w3 p0");
}
