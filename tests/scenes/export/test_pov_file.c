/* Scenes for POV-Ray: the index in two numbers against materials of known law, and what is written.
 */
#include "tests/scenes/scene_text.h"

#include "base/file.h"
#include "scenes/export/pov_file.h"
#include "spectral/formats/material_import.h"

/* A table of the very law that POV-Ray has: n = 1.7 * 1.05^((555 - nm) / 350). */
static const char *lawful(void) {
  static char text[8192];
  size_t used = (size_t)snprintf(text, sizeof text,
                                 "materials:\n- name: lawful\n  model: tabulated\n  interpolation: "
                                 "spline\n  source: made up\n  points: [");
  for (int nm = 380; nm <= 730; nm += 5)
    used += (size_t)snprintf(text + used, sizeof text - used, "%s[%d, %.12f]", nm > 380 ? ", " : "",
                             nm, 1.7 * pow(1.05, (555 - nm) / 350.0));
  snprintf(text + used, sizeof text - used, "]\n");
  return text;
}

static abbe_pov_glass glass_of(const abbe_material_table *table, const char *name) {
  const abbe_illuminant d65 = {0};
  const abbe_material *material = NULL;
  abbe_pov_glass glass;
  OK(abbe_material_table_find(table, name, &material, &error));
  OK(abbe_pov_file_glass(material, &d65, &glass, &error));
  return glass;
}

TEST(an_index_of_its_law_is_found_again) {
  char path[] = "/tmp/abbe-test-law-XXXXXX";
  int file = mkstemp(path);
  assert_true(file >= 0);
  close(file);
  const char *text = lawful();
  OK(abbe_file_write(path, text, strlen(text), &error));
  MADE(abbe_material_table, table, abbe_material_table_load(path, &table, &error));
  unlink(path);
  const abbe_pov_glass glass = glass_of(&table, "lawful");
  assert_near(glass.index.ior, 1.7, 1e-8);
  assert_near(glass.index.dispersion, 1.05, 1e-8);
  /* The spline is straight at its ends, the law is not: h^2 n'' / 8, 1e-7. */
  assert_true(glass.worst < 1e-7);
  assert_near(abbe_povray_index_at(&glass.index, 555), 1.7, 1e-8);
  assert_near(abbe_povray_index_at(&glass.index, 380), 1.7 * sqrt(1.05), 1e-7);
  assert_near(abbe_povray_index_at(&glass.index, 730), 1.7 / sqrt(1.05), 1e-7);
}

/* The fit leaves what it says, and less than both ends' own numbers would in the middle. */
TEST(real_glasses_are_met_as_said) {
  MADE(abbe_material_table, table, abbe_material_table_load("default", &table, &error));
  for (size_t i = 0; i < table.count; i++) {
    const abbe_material *m = &table.material[i];
    if (abbe_material_is_conductor(m)) continue;
    const abbe_pov_glass g = glass_of(&table, m->name);
    double worst = 0, at = 0, n = 0;
    for (int nm = 380; nm <= 730; nm++) {
      OK(abbe_material_n(m, nm, &n, &error));
      const double off = fabs(abbe_povray_index_at(&g.index, nm) - n);
      if (off > worst) at = nm;
      worst = fmax(worst, off);
    }
    assert_near(g.worst, worst, 1e-15);
    if (worst > 0) assert_near(g.worst_nm, at, 0);
    assert_true(g.rms <= g.worst);
    if (m->dispersion.model == ABBE_DISPERSION_CONSTANT) {
      assert_near(g.index.dispersion, 1, 0);
      assert_near(g.index.ior, n, 1e-12);
      continue;
    }
    assert_true(g.index.dispersion > 1);
    /* A line through log n at both ends lies above the index in between; the fit is nearer there.
     */
    double n_380 = 0, n_730 = 0, n_555 = 0;
    abbe_material_n(m, 380, &n_380, NULL);
    abbe_material_n(m, 730, &n_730, NULL);
    abbe_material_n(m, 555, &n_555, NULL);
    assert_true(fabs(g.index.ior - n_555) < fabs(sqrt(n_380 * n_730) - n_555));
  }
}

static char *written(const abbe_scene *scene, const abbe_pov_options *options) {
  char path[] = "/tmp/abbe-test-pov-XXXXXX", *text = NULL;
  size_t size = 0;
  int file = mkstemp(path);
  assert_true(file >= 0);
  close(file);
  OK(abbe_pov_file_write(path, scene, options, &error));
  OK(abbe_file_read(path, 1 << 28, &text, &size, &error));
  unlink(path);
  return text;
}

/* Outside comments: brackets in pairs, no number that is none. */
static void assert_well_formed(const char *text) {
  char open[64];
  size_t depth = 0;
  for (const char *at = text; *at != '\0'; at++) {
    if (at[0] == '/' && at[1] == '/') {
      at += strcspn(at, "\n");
      if (*at == '\0') break;
    }
    if (*at == '{' || *at == '(') {
      assert_true(depth < sizeof open);
      open[depth++] = *at == '{' ? '}' : ')';
    }
    if (*at == '}' || *at == ')') {
      assert_true(depth > 0);
      assert_int_equal(open[--depth], *at);
    }
  }
  assert_int_equal(depth, 0);
  assert_null(strstr(text, "nan"));
  assert_null(strstr(text, "inf>"));
  assert_null(strstr(text, "inf,"));
}

static double number_after(const char *text, const char *words) {
  const char *at = strstr(text, words);
  if (at == NULL) fail_msg("no '%s'", words);
  return strtod(at + strlen(words), NULL);
}

TEST(a_point_light_keeps_its_brightness) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  FREED char *text = written(&scene, NULL);
  assert_well_formed(text);
  const double scale = abbe_pov_file_scale(&scene);
  assert_near(scale, 10, 0); /* a floor of 2 m: 20 units */
  /* At 0.6 m a white floor has the radiance I / (pi r^2), by POV-Ray's law of fading. */
  const double fade = number_after(text, "fade_distance ");
  const double colour = number_after(text, "color rgb <");
  const double r = 0.6 * scale;
  assert_near(colour * 2 / (1 + pow(r / fade, 2)), 1 / (3.14159265358979 * 0.36), 5e-3);
  /* Rec.709's white is D65 to 5e-4; the rest of the tolerance is the fading's own, under 1e-6 */
  const char *green = strstr(strstr(text, "color rgb <"), ", ");
  assert_near(strtod(green + 2, NULL) / colour, 1, 1e-3);
  assert_non_null(strstr(text, "count Photons"));
  assert_non_null(strstr(text, "dispersion_samples Samples"));
  /* without caustics the glass still throws a shadow, by an object that only does that */
  assert_non_null(strstr(text, "#if (!Caustics) no_shadow #end"));
  assert_non_null(strstr(text, "no_image no_reflection"));
  assert_non_null(strstr(text, "#declare Surface = sphere {\n  <0, 0, 2>, 0.8"));
  assert_near(number_after(text, "Photons = "), 100000, 0);
}

TEST(every_kind_of_light_is_written) {
  OWNED(abbe_scene, scene) = scene_of(
      CAMERA "lights:\n"
             "- {name: sun, kind: directional, direction: [0, 0, -1], irradiance: 3}\n"
             "- {name: beam, kind: spot, position: [0, 0, 1], target: [0, 0, 0], intensity: 1, "
             "cone: 30, soft: 10, illuminant: A}\n"
             "- {name: panel, kind: disk, position: [0.3, 0, 1], direction: [0, 0, -1], radius: "
             "0.05, radiance: 100}\n" FLOOR BALL("smoke") BRICK("flat") RING("crown") HILL);
  const abbe_pov_options options = {.photons = 7, .samples = 3};
  FREED char *text = written(&scene, &options);
  assert_well_formed(text);
  assert_near(number_after(text, "Photons = "), 7, 0);
  assert_near(number_after(text, "Samples = "), 3, 0);
  assert_near(number_after(text, "color rgb <"), 3 / 3.14159265358979, 2e-3);
  assert_non_null(strstr(text, "parallel\n"));
  assert_near(number_after(text, "tightness 0 radius "), 20, 1e-9);
  assert_near(number_after(text, "tightness 0 radius 20 falloff "), 30, 1e-9);
  assert_non_null(strstr(text, "9, 9 circular"));
  /* 20 per m at 400 nm, 5 at 700: what is left after 0.1 m in the middle of red, green, blue */
  const double scale = abbe_pov_file_scale(&scene);
  const char *fade = strstr(text, "fade_power 1001 fade_distance ");
  assert_non_null(fade);
  const double length = strtod(fade + strlen("fade_power 1001 fade_distance "), NULL);
  const char *colour = strstr(fade, "rgb <") + 5;
  double rgb[3];
  for (int c = 0; c < 3; c++) {
    char *end;
    rgb[c] = strtod(colour, &end);
    colour = end + 2;
  }
  const double middle[3] = {655, 535, 435};
  for (int c = 0; c < 3; c++)
    assert_near((1 - rgb[c]) / length * scale, 20 - 15 * (middle[c] - 400) / 300, 0.5);
}

/* Names are comments that cannot end early; a path that cannot be spelt is refused. */
TEST(names_do_no_harm) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("flat"));
  free(scene.object[1].name);
  scene.object[1].name = strdup("x\n} light_source { <0,0,0> \r color 1 }");
  FREED char *text = written(&scene, NULL);
  assert_well_formed(text);
  assert_non_null(strstr(text, "// refractor 'x?} light_source { <0,0,0> ? color 1 }'\n"));
  scene.object[0].texture_path = strdup("wood\".png");
  REFUSED(ABBE_UNSUPPORTED, "plainer name",
          abbe_pov_file_write("/tmp/abbe-test-never.pov", &scene, NULL, &error));
  assert_int_not_equal(access("/tmp/abbe-test-never.pov", F_OK), 0);
}

TEST(what_cannot_be_is_refused) {
  abbe_pov_options options = {.samples = 1};
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA POINT_LIGHT FLOOR "- {name: ball, shape: sphere, radius: 0.1, transform: "
                                        "[{translate: [0, 0, 0.2]}], mirror: 0.9}\n");
  REFUSED(ABBE_UNSUPPORTED, "'ball' (line 7) is a mirror",
          abbe_pov_file_write("/tmp/abbe-test-never.pov", &scene, NULL, &error));
  abbe_scene_free(&scene);
  scene = scene_of(CAMERA POINT_LIGHT FLOOR BALL("narrow"));
  static const char never[] = "/tmp/abbe-test-never.pov";
  REFUSED(ABBE_INVALID_ARGUMENT, "2 to 100", abbe_pov_file_write(never, &scene, &options, &error));
  options.samples = 101;
  REFUSED(ABBE_INVALID_ARGUMENT, "samples of the spectrum, not",
          abbe_pov_file_write(never, &scene, &options, &error));
  options.samples = 2;
  options.photons = ABBE_POV_MAX_PHOTONS + 1;
  REFUSED(ABBE_INVALID_ARGUMENT, "photons are more than POV-Ray can hold",
          abbe_pov_file_write(never, &scene, &options, &error));
  /* known from 400 to 700 nm only */
  REFUSED(ABBE_OUT_OF_RANGE, "narrow", abbe_pov_file_write(never, &scene, NULL, &error));
  REFUSED(ABBE_IO, "cannot be written, for its folder is not",
          abbe_pov_file_write("/no/such/folder/x.pov", &scene, NULL, &error));
  abbe_scene_free(&scene);
  scene = scene_of(CAMERA FLOOR BALL("flat") "environment: {size: 64, uniform: 1}\n");
  REFUSED(ABBE_UNSUPPORTED, "'environment'", abbe_pov_file_write(never, &scene, NULL, &error));
  abbe_scene_free(&scene);
  scene = scene_of(
      CAMERA POINT_LIGHT FLOOR BALL("flat, clouds: [{radius: 0.02, medium: {scattering: 7}}]"));
  REFUSED(ABBE_UNSUPPORTED, "a cloud under 'clouds'",
          abbe_pov_file_write(never, &scene, NULL, &error));
  assert_int_not_equal(access(never, F_OK), 0);
}

TEST(shipped_scenes_are_written) {
  static const char *const names[] = {"sphere", "prism", "gem", "glass", "rainbow"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    OWNED(abbe_scene, scene) = shipped_scene(names[i]);
    FREED char *text = written(&scene, NULL);
    assert_well_formed(text);
  }
}
