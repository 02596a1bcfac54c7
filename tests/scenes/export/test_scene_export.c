/* Scenes for other programs: what was written is read back by each program's own rules.
 * Tables give the index whose error is stated, lights have their power, and nothing stays of a file
 * that could not be finished. */
#include "tests/scenes/export/export_text.h"

#include "colorimetry/reflectance/reflected_light.h"

#include <cjson/cJSON.h>
#include <sys/stat.h>

/* ---- the index ---- */

/* From each file's own numbers, as each program would have it. */
static double pbrt_n(const double *table, double nm) {
  size_t i = 0;
  while (table[2 * i + 2] < nm) i++;
  const double *a = table + 2 * i;
  return a[1] + (nm - a[0]) / (a[2] - a[0]) * (a[3] - a[1]);
}

GROUP(make_folder, drop_folder);

TEST(the_index_in_the_file_has_the_stated_error) {
  static const char *const words[] = {"\"spectrum eta\" [", "\"ior\":", "= glass('m0_sf10', "};
  static const size_t counts[] = {190, 1, 3};
  OWNED(abbe_scene, scene) = shipped_scene("prism");
  for (int target = 0; target < ABBE_SCENE_EXPORT_COUNT; target++) {
    char *text = written(&scene, (abbe_scene_export_target)target);
    double v[190], b = 0, worst = 0, sum = 0;
    numbers_after(text, words[target], v, counts[target]);
    if (target == ABBE_SCENE_EXPORT_GLTF) numbers_after(text, "\"dispersion\":", &b, 1);
    assert_int_equal(report.glass_count, 1);
    for (int nm = 380; nm <= 780; nm++) {
      double n = 0, got = v[0];
      OK(abbe_material_n(report.glass[0].material, nm, &n, &error));
      if (target == ABBE_SCENE_EXPORT_PBRT) got = pbrt_n(v, nm);
      /* the law that the extension prints, whose numbers are rounded */
      if (target == ABBE_SCENE_EXPORT_GLTF)
        got += (got - 1) * b / 20 * (523655.0 / ((double)nm * nm) - 1.5168);
      if (target == ABBE_SCENE_EXPORT_BLENDER) got = v[nm > 580 ? 0 : nm > 506 ? 1 : 2];
      worst = fmax(worst, fabs(got - n));
      sum += (got - n) * (got - n);
    }
    const abbe_export_index *index = &report.glass[0].index;
    assert_near(worst, index->worst, 1e-6);
    assert_near(sqrt(sum / 401), index->rms, 1e-6);
    assert_true(index->worst > 0);
    done(text);
  }
}

/* ---- lights ---- */

#define LIGHTS                                                                                     \
  "lights:\n"                                                                                      \
  "- {name: lamp, kind: point, position: [0.1, 0.2, 0.9], intensity: 2}\n"                         \
  "- {name: sun, kind: directional, direction: [0, 0.6, -0.8], irradiance: 3}\n"                   \
  "- {name: beam, kind: spot, position: [0, 0, 1], target: [0, 0, 0], intensity: 5, cone: 30, "    \
  "soft: 10, illuminant: E}\n"                                                                     \
  "- {name: panel, kind: disk, position: [0.3, 0, 1], direction: [0, 0, -1], radius: 0.05, "       \
  "radiance: 100}\n"                                                                               \
  "- {name: window, kind: rectangle, position: [-0.3, 0, 1], direction: [0, 0, -1], width: 0.2, "  \
  "height: 0.1, radiance: 40}\n"

TEST(lights_keep_their_power) {
  const double sphere = 4 * 3.14159265358979323846;
  double v[16];
  OWNED(abbe_scene, scene) = scene_of(CAMERA LIGHTS FLOOR BALL("murk") BRICK("flat"));
  char *text = written(&scene, ABBE_SCENE_EXPORT_PBRT);
  const char *at = strstr(text, "\"point\"");
  numbers_after(at, "\"float scale\"", v, 1);
  assert_near(v[0], 2, 0);
  numbers_after(text, "\"distant\" \"point3 from\"", v, 3);
  assert_near(v[1], -0.6, 1e-9);
  assert_near(v[2], 0.8, 1e-9);
  numbers_after(text, "coneangle\"", v, 1);
  assert_near(v[0], 30, 1e-6);
  numbers_after(text, "conedeltaangle\"", v, 1);
  assert_near(v[0], 10, 1e-6);
  assert_non_null(strstr(text, "Shape \"disk\" \"float radius\" 0.05"));
  assert_non_null(strstr(text, "MediumInterface \"m0_murk\" \"\""));
  done(text);
  text = written(&scene, ABBE_SCENE_EXPORT_BLENDER);
  assert_non_null(strstr(text, "use_denoising = False")); /* nor what else makes light less */
  assert_non_null(strstr(text, "sample_clamp_indirect = 0"));
  numbers_after(text, "'l0_lamp', ", v, 13);
  assert_near(v[12], 2 * sphere, 1e-6);
  numbers_after(text, "'l1_sun', ", v, 13);
  assert_near(v[12], 3, 1e-9);
  assert_near(v[7], -0.6, 1e-9); /* lamps shine along -z, the third column */
  done(text);
}

/* The format's validator refuses components of colours beyond 1: the largest is 1. */
TEST(colours_in_gltf) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA LIGHTS FLOOR BALL("murk") BRICK("flat"));
  char *text = written(&scene, ABBE_SCENE_EXPORT_GLTF);
  const char *const keys[] = {"color", "emissiveFactor"};
  int count[2] = {0};
  for (int k = 0; k < 2; k++)
    for (const char *at = strstr(text, keys[k]); at != NULL; at = strstr(at + 1, keys[k])) {
      double rgb[3];
      numbers_after(at, ":", rgb, 3);
      assert_near(fmax(fmax(rgb[0], rgb[1]), rgb[2]), 1, 0);
      assert_true(fmin(fmin(rgb[0], rgb[1]), rgb[2]) >= 0);
      count[k]++;
    }
  assert_int_equal(count[0], 3);
  assert_int_equal(count[1], 2);
  done(text);
}

/* An equal-energy lamp in glTF: 683 lm/W times the mean of V over 380 to 780 nm, 0.2672 (the
 * integral of V is 106.86 nm). */
TEST(photometric_units) {
  double v[1];
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA "lights:\n- {name: lamp, kind: point, position: [0, 0, 0.9], intensity: 2, "
                      "illuminant: E}\n" FLOOR BALL("flat"));
  char *text = written(&scene, ABBE_SCENE_EXPORT_GLTF);
  double rgb[3];
  numbers_after(text, "\"color\":", rgb, 3);
  numbers_after(text, "\"intensity\":", v, 1);
  const double luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
  assert_near(luminance * v[0], 2 * 683.0 * 106.86 / 400, 0.5);
  done(text);
}

/* ---- the rest ---- */

static bool noted(abbe_note_kind kind, const char *name, const char *part) {
  for (size_t i = 0; i < report.notes.count; i++) {
    const abbe_note *n = &report.notes.note[i];
    if (n->kind == kind && strcmp(n->name, name) == 0 && strstr(n->text, part) != NULL) return true;
  }
  return false;
}

TEST(losses_are_said) {
  abbe_scene scene = scene_of(CAMERA "ambient: 0.1\n" LIGHTS FLOOR BALL("murk"));
  char *text = written(&scene, ABBE_SCENE_EXPORT_BLENDER);
  assert_true(noted(ABBE_NOTE_LOST, "ambient", "0.1"));
  assert_non_null(strstr(text, "# lost: ambient: "));
  done(text);
  text = written(&scene, ABBE_SCENE_EXPORT_GLTF);
  assert_true(noted(ABBE_NOTE_LOST, "panel", "glows"));
  assert_true(noted(ABBE_NOTE_LOST, "caustics", ""));
  assert_true(noted(ABBE_NOTE_CHANGED, "ball", "triangles"));
  assert_true(noted(ABBE_NOTE_CHANGED, "murk", "three numbers"));
  assert_non_null(strstr(text, "\"lost: caustics: "));
  done(text);
  text = written(&scene, ABBE_SCENE_EXPORT_PBRT);
  assert_true(!noted(ABBE_NOTE_CHANGED, "ball", "triangles"));
  assert_non_null(strstr(text, "Shape \"sphere\" \"float radius\" 0.08"));
  done(text);
  abbe_scene_free(&scene);
  scene = scene_of(CAMERA POINT_LIGHT FLOOR BALL("narrow"));
  text = written(&scene, ABBE_SCENE_EXPORT_PBRT);
  assert_true(noted(ABBE_NOTE_ASSUMED, "narrow", "400 to 700 nm"));
  done(text);
  abbe_scene_free(&scene);
  clear_folder();
}

/* ---- reflectances ---- */

/* The pairs of a spectrum, as many as its brackets hold. */
static size_t read_pairs(const char *text, double (*out)[2]) {
  const char *at = strstr(text, "\"spectrum reflectance\" [");
  assert_non_null(at);
  at = strchr(at, '[') + 1;
  size_t i = 0;
  for (char *end; *at != ']'; i++) {
    out[i / 2][i % 2] = strtod(at, &end);
    assert_true(end > at && i < 1200);
    at = end + strspn(end, ", \n");
  }
  return i / 2;
}

static double between(double (*pair)[2], size_t count, double nm) {
  size_t i = 0;
  while (i + 2 < count && pair[i + 1][0] < nm) i++;
  return pair[i][1] +
         (nm - pair[i][0]) / (pair[i + 1][0] - pair[i][0]) * (pair[i + 1][1] - pair[i][1]);
}

/* Where spectra are taken: read back, the floor reflects at each wavelength what it does here,
 * whether that was measured or lifted from three numbers. */
TEST(reflectances_are_read_back) {
  static const char *const floors[] = {"{patch: orange}", "[0.7, 0.3, 0.1]"};
  for (int i = 0; i < 2; i++) {
    char source[2000];
    double pair[600][2];
    snprintf(
        source, sizeof source,
        CAMERA POINT_LIGHT
        "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: %s}\n" BALL(
            "crown"),
        floors[i]);
    OWNED(abbe_scene, scene) = scene_of(source);
    char *text = written(&scene, ABBE_SCENE_EXPORT_PBRT);
    const size_t count = read_pairs(text, pair);
    assert_true(count > 80 && pair[0][0] == 360 && pair[count - 1][0] == 830);
    for (double nm = 360; nm <= 830; nm += 1.25) {
      double channel[3], own = 0;
      abbe_reflectance_channels(scene.object[0].spectrum, nm, channel);
      for (int c = 0; c < 3; c++)
        own += i == 0 ? channel[c] : channel[c] * scene.object[0].reflectance[c];
      assert_near(between(pair, count, nm), own, 1e-8);
    }
    assert_false(noted(ABBE_NOTE_LOST, "floor", "") || noted(ABBE_NOTE_CHANGED, "floor", ""));
    done(text);
    text = written(&scene, ABBE_SCENE_EXPORT_BLENDER);
    assert_int_equal(noted(ABBE_NOTE_LOST, "floor", "measured reflectance"), i == 0);
    done(text);
  }
  clear_folder();
}

TEST(an_aperture_is_lost) {
  for (int target = 0; target < ABBE_SCENE_EXPORT_COUNT; target++)
    for (int lens = 0; lens < 2; lens++) {
      OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("flat"));
      if (lens) scene.camera.aperture = 0.01, scene.camera.focus = 0.25;
      char *text = written(&scene, (abbe_scene_export_target)target);
      assert_int_equal(noted(ABBE_NOTE_LOST, "camera", "0.25 m"), lens);
      done(text);
    }
  clear_folder();
}

/* They have no surface; what stands after them is there. */
TEST(clouds_are_left_out) {
  for (int target = 0; target < ABBE_SCENE_EXPORT_COUNT; target++) {
    OWNED(abbe_scene, scene) =
        scene_of(CAMERA POINT_LIGHT FLOOR BALL("flat, clouds: [{radius: 0.02}]") BRICK("flat"));
    char *text = written(&scene, (abbe_scene_export_target)target);
    assert_true(noted(ABBE_NOTE_LOST, "ball (cloud 1)", "left out"));
    assert_null(strstr(text, "ball__cloud_1_"));
    assert_non_null(strstr(text, "o3_brick"));
    done(text);
  }
  clear_folder();
}

/* Names become identifiers; what would end a comment does not. */
TEST(names_do_no_harm) {
  abbe_scene scene = scene_of(CAMERA POINT_LIGHT FLOOR BALL("flat"));
  free(scene.object[1].name);
  scene.object[1].name = strdup("x\"--><b>'\n]\nimport os #");
  free(scene.path);
  scene.path = strdup("a--><b>\nimport os");
  for (int target = 0; target < ABBE_SCENE_EXPORT_COUNT; target++) {
    char *text = written(&scene, (abbe_scene_export_target)target);
    if (target != ABBE_SCENE_EXPORT_GLTF) assert_null(strstr(text, "--><b>"));
    assert_null(strstr(text, "\nimport os\n"));
    if (target != ABBE_SCENE_EXPORT_GLTF)
      assert_non_null(strstr(text, "o1_x_____b_____import_os__"));
    done(text);
  }
  abbe_scene_free(&scene);
  clear_folder();
}

TEST(nothing_half_written_stays) {
  char path[200], blocked[220];
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA POINT_LIGHT "environment: {size: 64, uniform: 1}\n" FLOOR BALL("crown"));
  /* a folder stands where the companion is to be written */
  snprintf(path, sizeof path, "%s/it.py", folder);
  snprintf(blocked, sizeof blocked, "%s/it-environment.exr", folder);
  assert_int_equal(mkdir(blocked, 0777), 0);
  REFUSED(ABBE_IO, "",
          abbe_scene_export_write(path, &scene, ABBE_SCENE_EXPORT_BLENDER, &report, &error));
  abbe_scene_export_report_free(&report);
  assert_int_equal(rmdir(blocked), 0);
  assert_int_equal(clear_folder(), 0);
  REFUSED(ABBE_INVALID_ARGUMENT, ".pbrt",
          abbe_scene_export_write(path, &scene, ABBE_SCENE_EXPORT_PBRT, &report, &error));
  snprintf(path, sizeof path, "%s/a b.py", folder);
  REFUSED(ABBE_UNSUPPORTED, "",
          abbe_scene_export_write(path, &scene, ABBE_SCENE_EXPORT_BLENDER, &report, &error));
  abbe_scene_export_report_free(&report);
  /* nor is a file of the scene's own written over */
  snprintf(path, sizeof path, "%s/it.py", folder);
  OK(abbe_file_write(blocked, "mine", 4, &error));
  scene.object[0].mesh_path = strdup(blocked);
  REFUSED(ABBE_INVALID_ARGUMENT, "would be written over the scene's file",
          abbe_scene_export_write(path, &scene, ABBE_SCENE_EXPORT_BLENDER, &report, &error));
  abbe_scene_export_report_free(&report);
  assert_int_equal(clear_folder(), 1);
}

/* pbrt's own rules of tokens: strings, brackets, directives and numbers, brackets in pairs. */
static void check_pbrt(const char *text) {
  bool inside = false;
  for (const char *at = text; *at != '\0';) {
    if (*at == '#') {
      at += strcspn(at, "\n");
    } else if (*at == '"') {
      at = strchr(at + 1, '"') + 1;
    } else if (*at == '[' || *at == ']') {
      assert_true(inside == (*at == ']'));
      inside = *at++ == '[';
    } else if (isspace((unsigned char)*at)) {
      at++;
    } else if (isalpha((unsigned char)*at)) {
      at += strcspn(at, " \n");
      assert_false(inside);
    } else {
      char *end;
      assert_true(isfinite(strtod(at, &end)));
      assert_true(end > at);
      at = end;
    }
  }
  assert_false(inside);
}

/* Runs it where the program is found; 0 without it. */
static int checked_by(const char *program, const char *line) {
  return system(
      printed("command -v %s > /dev/null 2>&1 || exit 0; cd %s && %s", program, folder, line));
}

TEST(shipped_scenes_are_well_formed) {
  static const char *const names[] = {"gem", "metals", "prism", "glass", "diamond-studio"};
  for (size_t i = 0; i < (SANITIZED ? 2 : sizeof names / sizeof *names); i++) {
    abbe_scene scene = shipped_scene(names[i]);
    for (int target = 0; target < ABBE_SCENE_EXPORT_COUNT; target++) {
      char *text = written(&scene, (abbe_scene_export_target)target);
      if (target == ABBE_SCENE_EXPORT_PBRT) check_pbrt(text);
      if (target == ABBE_SCENE_EXPORT_GLTF) {
        cJSON *root = cJSON_Parse(text);
        assert_non_null(root);
        assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(root, "meshes")),
                         scene.object_count);
        cJSON_Delete(root);
      }
      assert_null(strstr(text, "nan"));
      done(text);
    }
    assert_int_equal(
        checked_by("python3", "python3 -c \"compile(open('it.py').read(), 'it.py', 'exec')\""), 0);
    abbe_scene_free(&scene);
    clear_folder();
  }
}
