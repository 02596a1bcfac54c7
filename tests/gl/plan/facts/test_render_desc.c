/* A request alone: its defaults, its names, and what is outside its limits. */
#include "tests/check.h"

#include "gl/plan/facts/render_desc.h"

static abbe_render_desc resolve(const abbe_render_desc *desc) {
  abbe_render_desc out;
  OK(abbe_render_desc_resolve(desc, 320, 200, &out, &error));
  return out;
}

TEST(what_is_left_open_gets_its_default) {
  abbe_render_desc d = resolve(NULL);
  assert_true(d.width == 320 && d.height == 200 && d.photons == 256 && d.map_size == 1024);
  assert_true(d.supersample == 2 && d.upsample == 1 && d.fill == ABBE_FILL_BRIDGE);
  assert_true(d.adaptive == 4);
  assert_true(d.wavelengths == 0 && d.exits == 0); /* the scene tells */
  assert_true(d.min_nm == 380 && d.max_nm == 780 && d.energy_share == 0.01);
  d = resolve(&(abbe_render_desc){.upsample = 3, .width = 7});
  assert_true(d.supersample == 1 && d.width == 7 && d.adaptive == 1);
  d = resolve(&(abbe_render_desc){.profile = ABBE_PROFILE_THESIS});
  assert_true(d.photons == 512 && d.supersample == 1 && d.fill == ABBE_FILL_SMEAR);
  assert_true(d.max_nm == 680 && d.adaptive == 1);
  d = resolve(&(abbe_render_desc){.profile = ABBE_PROFILE_SHAH2007});
  assert_true(d.photons == 128 && d.map_size == 768 && d.supersample == 1 && d.adaptive == 1);
  assert_true(d.min_nm == 450 && d.max_nm == 650 && d.fill == ABBE_FILL_NONE);
  assert_true(d.estimator == ABBE_ESTIMATOR_SHAH && d.iterations == 1 && d.interfaces == 2);
  d = resolve(&(abbe_render_desc){.profile = ABBE_PROFILE_SHAH2007_CIE});
  assert_true(d.min_nm == 380 && d.estimator == ABBE_ESTIMATOR_RATIO);
  d = resolve(&(abbe_render_desc){.profile = ABBE_PROFILE_WYMAN2006});
  assert_true(d.photons == 1024 && d.map_size == 512 && d.fill == ABBE_FILL_GATHER_LIGHT);
  assert_true(d.direction == ABBE_DIRECTION_MEAN && d.history == 1 && d.iterations == 1);
  d = resolve(&(abbe_render_desc){.profile = ABBE_PROFILE_WYMAN2006_CIE, .fill = ABBE_FILL_NONE});
  assert_true(d.direction == ABBE_DIRECTION_DIRECT && d.fill == ABBE_FILL_POINTS);
  d = resolve(&(abbe_render_desc){.profile = ABBE_PROFILE_WAND2003});
  assert_true(d.transport == ABBE_TRANSPORT_PINHOLE && d.pinholes == 256 && d.supersample == 1);
  assert_int_equal(d.clusters, 0);
  assert_true(d.footprint == ABBE_FOOTPRINT_ON);
  d = resolve(&(abbe_render_desc){0});
  assert_true(d.transport == ABBE_TRANSPORT_PHOTONS && d.pinholes == 0 && d.clusters == 0);
  d = resolve(&(abbe_render_desc){.transport = ABBE_TRANSPORT_PINHOLE});
  assert_true(d.pinholes == 256 && d.clusters == 50);
  d = resolve(&(abbe_render_desc){.profile = ABBE_PROFILE_THESIS_CIE});
  assert_true(d.photons == 512 && d.fill == ABBE_FILL_SMEAR && d.max_nm == 780);
}

TEST(names_are_the_options) {
  assert_string_equal(abbe_profile_name(ABBE_PROFILE_THESIS_CIE), "thesis-cie");
  assert_string_equal(abbe_fill_name(ABBE_FILL_SMEAR), "smear");
  assert_string_equal(abbe_transport_name(ABBE_TRANSPORT_PINHOLE), "pinhole");
  assert_string_equal(abbe_model_name(ABBE_MODEL_CONVEX), "convex");
  assert_string_equal(abbe_profile_name((abbe_profile)-1), "unknown");
  assert_string_equal(abbe_fill_name(ABBE_FILL_COUNT), "unknown");
  assert_string_equal(abbe_model_name(ABBE_MODEL_COUNT), "unknown");
  assert_true(abbe_method_of(ABBE_PROFILE_THESIS_CIE)->own_passes);
  assert_false(abbe_method_of(ABBE_PROFILE_DEFAULT)->own_passes);
}

TEST(limits_are_kept) {
  const struct {
    abbe_render_desc desc;
    const char *part;
  } rows[] = {
      {{.width = ABBE_RENDER_MAX_SIDE + 1}, "8193"},
      {{.height = ABBE_RENDER_MAX_SIDE + 1}, "height"},
      {{.photons = ABBE_RENDER_MAX_PHOTONS + 1}, "photon grid is 4097"},
      {{.map_size = ABBE_RENDER_MAX_MAP + 1}, "spectral map is 4097"},
      {{.supersample = 5}, "supersampling is 5"},
      {{.upsample = 5}, "upsampling is 5"},
      {{.adaptive = ABBE_RENDER_MAX_ADAPTIVE + 1}, "adaptive sampling is 9"},
      {{.profile = ABBE_PROFILE_SHAH2007, .wavelengths = 7}, "red, green and blue"},
      {{.profile = ABBE_PROFILE_SHAH2007, .interfaces = 3}, "interfaces is 3"},
      {{.profile = ABBE_PROFILE_SHAH2007, .fill = ABBE_FILL_SMEAR}, "'shah2007'"},
      {{.profile = ABBE_PROFILE_SHAH2007_CIE, .iterations = 65}, "iterations is 65"},
      {{.estimator = ABBE_ESTIMATOR_RATIO}, "not with 'default'"},
      {{.direction = ABBE_DIRECTION_OWN}, "not with 'default'"},
      {{.polygons = ABBE_POLYGONS_CORNERS}, "not with 'default'"},
      {{.profile = ABBE_PROFILE_WYMAN2006, .polygons = ABBE_POLYGONS_CULLED}, "'gather-light'"},
      {{.profile = ABBE_PROFILE_WYMAN2006, .fill = ABBE_FILL_QUADS, .polygons = 16}, "'quads'"},
      {{.profile = ABBE_PROFILE_WYMAN2006_CIE,
        .fill = ABBE_FILL_QUADS,
        .polygons = ABBE_POLYGONS_EVEN},
       "its solid angle"},
      {FIELDS(.profile = ABBE_PROFILE_WYMAN2006, .fill = ABBE_FILL_QUADS,
              .polygons = ABBE_POLYGONS_IN_LIGHT, .faces = 6),
       "one image of the light's"},
      {{.profile = ABBE_PROFILE_SHAH2007, .history = 4}, "not with 'shah2007'"},
      {{.profile = ABBE_PROFILE_THESIS, .history = 2}, "not with 'thesis'"},
      {{.history = 5}, "frames is 5"},
      {{.profile = ABBE_PROFILE_WYMAN2006, .history = 5}, "frames is 5"},
      {{.profile = ABBE_PROFILE_WYMAN2006, .history = 4, .fill = ABBE_FILL_QUADS}, "'quads'"},
      {{.profile = ABBE_PROFILE_WYMAN2006, .wavelengths = 3}, "one index for all"},
      {{.profile = ABBE_PROFILE_WYMAN2006, .fill = ABBE_FILL_SMEAR}, "'smear'"},
      {{.profile = ABBE_PROFILE_WYMAN2006_CIE, .direction = ABBE_DIRECTION_MEAN}, "in units"},
      {{.fill = ABBE_FILL_QUADS}, "'quads'"},
      {{.pinholes = 5}, "go with the transport 'pinhole'"},
      {{.footprint = ABBE_FOOTPRINT_OFF}, "not with 'photons'"},
      {{.clusters = 100}, "and clusters go with"},
      {{.profile = ABBE_PROFILE_WAND2003, .clusters = 100}, "clusters of pinholes"},
      {{.transport = ABBE_TRANSPORT_PINHOLE, .clusters = 1000001}, "clusters is 1000001"},
      {{.transport = ABBE_TRANSPORT_PINHOLE, .pinholes = 4097}, "pinholes is 4097"},
      {{.transport = ABBE_TRANSPORT_COUNT}, "'unknown'"},
      {{.transport = ABBE_TRANSPORT_PINHOLE, .footprint = ABBE_FOOTPRINT_COUNT}, "footprints"},
      {{.profile = ABBE_PROFILE_THESIS, .transport = ABBE_TRANSPORT_PINHOLE}, "with the profile"},
      {{.profile = ABBE_PROFILE_WAND2003, .transport = ABBE_TRANSPORT_PHOTONS}, "'wand2003'"},
      {{.profile = ABBE_PROFILE_THESIS, .interfaces = 1}, "not with 'thesis'"},
      {{.profile = ABBE_PROFILE_THESIS, .adaptive = 2}, "knows no adaptive samples"},
      {{.supersample = 2, .upsample = 2}, "a sample for 2 x 2 pixels and 2 samples"},
      {{.profile = ABBE_PROFILE_THESIS, .upsample = 2}, "cannot be upsampled"},
      {{.wavelengths = ABBE_RENDER_MAX_WAVELENGTHS + 1}, "wavelengths is 1001"},
      {{.profile = ABBE_PROFILE_THESIS, .wavelengths = 65}, "wavelengths is 65"},
      {{.exits = ABBE_RENDER_MAX_EXITS + 1}, "exits is 33"},
      {{.width = (size_t)-1}, "width"},
      {{.min_nm = 700, .max_nm = 400}, "700 to 400"},
      {{.min_nm = -1}, "-1 to 780"},
      {{.min_nm = NAN}, "nan"},
      {{.max_nm = INFINITY}, "inf"},
      {{.energy_share = -0.1}, "-0.1"},
      {{.energy_share = 1.5}, "1.5"},
      {{.energy_share = NAN}, "nan"},
      {{.photon_shift = {0, 0.6}}, "photons are shifted by 0.6"},
      {{.sample_shift = {NAN, 0}}, "samples are shifted by nan"},
      {{.lens_place = {0.8, 0.8}}, "a place on the lens is 0.8, 0.8"},
      {{.model = ABBE_MODEL_COUNT}, "model 'unknown'"},
      {{.profile = ABBE_PROFILE_THESIS, .model = ABBE_MODEL_SPHERE}, "model 'sphere'"},
      {{.fill = ABBE_FILL_SMEAR}, "'smear'"},
      {{.profile = ABBE_PROFILE_THESIS, .fill = ABBE_FILL_BRIDGE}, "'thesis'"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    abbe_render_desc out;
    REFUSED(ABBE_INVALID_ARGUMENT, "",
            abbe_render_desc_resolve(&rows[i].desc, 320, 200, &out, &error));
    assert_int_equal(last_error.code, ABBE_INVALID_ARGUMENT);
    assert_contains(last_error.text, rows[i].part);
  }
}

/* The table of settings: names that cannot be mixed up, and limits that a request is held to. */

TEST(keys_and_options_name_one_setting_each) {
  for (size_t i = 0; i < abbe_render_settings_count; i++) {
    const abbe_render_setting *a = &abbe_render_settings[i];
    assert_true(a->option == NULL || a->help != NULL);
    assert_true((a->kind == ABBE_SETTING_CHOICE) == (a->name_count > 0));
    for (size_t k = 0; k < i; k++) {
      const abbe_render_setting *b = &abbe_render_settings[k];
      assert_string_not_equal(a->key, b->key);
      assert_int_not_equal(a->offset, b->offset);
      if (a->option != NULL && b->option != NULL) assert_string_not_equal(a->option, b->option);
    }
  }
}

/* Each count alone, just beyond its most, in a request whose others are the defaults. */
TEST(a_request_is_held_to_every_limit) {
  size_t held = 0;
  for (size_t i = 0; i < abbe_render_settings_count; i++) {
    const abbe_render_setting *s = &abbe_render_settings[i];
    if (s->kind != ABBE_SETTING_COUNT || s->what == NULL) continue;
    abbe_render_desc desc = {0}, out;
    *(size_t *)abbe_render_setting_in(s, &desc) = (size_t)s->most + 1;
    REFUSED(ABBE_INVALID_ARGUMENT, s->what, abbe_render_desc_resolve(&desc, 8, 8, &out, &error));
    held++;
  }
  assert_int_equal(held, 19);
}
