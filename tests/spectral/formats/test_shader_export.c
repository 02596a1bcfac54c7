#include "tests/check.h"
#include "tests/spectral/shipped_table.h"

#include "spectral/formats/shader_export.h"

#include <cjson/cJSON.h>

static abbe_report report;

static char plain[] = "s", broken[] = "line\nbreak */", letter[] = "x";

static void unload(void) {
  abbe_report_free(&report);
  shipped_free();
}

static char *written(abbe_shader shader, const abbe_material *m, size_t count) {
  abbe_material_table some = {.count = count, .material = (abbe_material *)(uintptr_t)m};
  static char *text; /* outlives the stream that fills it */
  static size_t size;
  FILE *to = open_memstream(&text, &size);
  abbe_report_free(&report);
  OK(abbe_shader_write(shader, &some, to, &report, &error));
  fclose(to);
  return text;
}

GROUP(shipped_load, unload);

/* A material that follows POV-Ray's own law is found exactly; so is glTF's. */
TEST(the_laws_of_others_are_found_again) {
  double lambda_nm[351], n[351], ior = 0, dispersion = 0, error = 1;
  for (int i = 0; i <= 350; i++) {
    lambda_nm[i] = 380 + i;
    n[i] = 1.52 * pow(1.03, -(lambda_nm[i] - 555) / 350);
  }
  abbe_material m = {.min_nm = 380,
                     .max_nm = 730,
                     .name = (char[]){"p"},
                     .source = plain,
                     .dispersion = {.model = ABBE_DISPERSION_TABULATED}};
  assert_int_equal(
      abbe_spectrum_make(lambda_nm, n, 351, ABBE_INTERPOLATION_LINEAR, &m.dispersion.table, NULL),
      ABBE_OK);
  abbe_shader_povray_numbers(&m, &ior, &dispersion, &error);
  assert_near(ior, 1.52, 1e-12);
  assert_near(dispersion, 1.03, 1e-12);
  assert_near(error, 0, 1e-12);
  abbe_dispersion_free(&m.dispersion);
  m.dispersion =
      (abbe_dispersion){.model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {1.5046, 0.0042}};
  m.max_nm = 800;
  abbe_shader_gltf_numbers(&m, &ior, &dispersion, &error);
  assert_near(ior, 1.5046 + 0.0042 / 0.5875618 / 0.5875618, 1e-14);
  assert_near(dispersion, 20 / abbe_dispersion_describe(&m.dispersion).v_d, 1e-14);
  assert_near(error, 0, 1e-14);
}

/* N-BK7 has n_d 1.5168 and V_d 64.17: 20 / 64.17 = 0.3117. */
TEST(gltf_has_the_numbers_of_the_catalogue) {
  FREED char *text = written(ABBE_SHADER_GLTF, shipped.material, shipped.count);
  cJSON *root = cJSON_Parse(text);
  assert_non_null(root);
  cJSON *list = cJSON_GetObjectItem(root, "materials");
  assert_int_equal(cJSON_GetArraySize(list), shipped_glasses());
  cJSON *bk7 = cJSON_GetArrayItem(list, 1), *all = cJSON_GetObjectItem(bk7, "extensions");
  assert_string_equal(cJSON_GetObjectItem(bk7, "name")->valuestring, "n-bk7");
  cJSON *ior = cJSON_GetObjectItem(all, "KHR_materials_ior");
  cJSON *dispersion = cJSON_GetObjectItem(all, "KHR_materials_dispersion");
  assert_near(cJSON_GetObjectItem(ior, "ior")->valuedouble, 1.5168, 5e-6);
  assert_near(cJSON_GetObjectItem(dispersion, "dispersion")->valuedouble, 0.3117, 5e-5);
  /* F2 absorbs: the colour at the distance is exp(-a d) */
  for (int i = 0; i < cJSON_GetArraySize(list); i++) {
    cJSON *item = cJSON_GetArrayItem(list, i);
    if (strcmp(cJSON_GetObjectItem(item, "name")->valuestring, "f2") != 0) continue;
    cJSON *volume =
        cJSON_GetObjectItem(cJSON_GetObjectItem(item, "extensions"), "KHR_materials_volume");
    double d = cJSON_GetObjectItem(volume, "attenuationDistance")->valuedouble;
    double blue =
        cJSON_GetArrayItem(cJSON_GetObjectItem(volume, "attenuationColor"), 2)->valuedouble;
    assert_near(blue, exp(-d * abbe_material_attenuation(shipped_material("f2"), 464.2)), 1e-6);
    assert_near(blue, exp(-1), 1e-6);
  }
  cJSON_Delete(root);
}

/* Every sample that pbrt gets is the index there, from 360 to 830 nm without a gap: it takes 0
 * outside. */
TEST(pbrt_gets_the_index_every_five_nanometres) {
  const abbe_material *m = shipped_material("n-bk7");
  char *text = written(ABBE_SHADER_PBRT, m, 1);
  char *at = strstr(text, "\"spectrum eta\" [");
  assert_non_null(at);
  at += strlen("\"spectrum eta\" [");
  for (double l = 360; l <= 830; l += 5) {
    assert_near(strtod(at, &at), l, 0);
    assert_near(strtod(at, &at), abbe_dispersion_n(&m->dispersion, l), 1e-9);
  }
  assert_non_null(strchr(at, ']'));
  assert_null(strstr(text, "sigma_a"));
  assert_contains(report.note[0].text, "sampled every 5 nm");
  free(text);
  text = written(ABBE_SHADER_PBRT, shipped_material("f2"), 1);
  assert_contains(text, "MakeNamedMedium \"f2\"");
  assert_contains(text, "\"spectrum sigma_a\"");
  free(text);
}

TEST(held_indices_are_told) {
  abbe_material m = {
      .name = letter,
      .source = plain,
      .min_nm = 400,
      .max_nm = 700,
      .dispersion = {.model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {1.5, 0.004}}};
  free(written(ABBE_SHADER_PBRT, &m, 1));
  assert_int_equal(report.kinds[ABBE_NOTE_ASSUMED], 1);
  assert_contains(report.note[1].text, "reach from 400 to 700 nm; n is held at their ends out to "
                                       "360 and 830 nm");
  m.extrapolate = true;
  free(written(ABBE_SHADER_PBRT, &m, 1));
  assert_int_equal(report.kinds[ABBE_NOTE_ASSUMED], 0);
}

TEST(names_become_identifiers_once_each) {
  abbe_material m[4];
  char *const names[] = {(char[]){"n-bk7"}, (char[]){"n_bk7"}, (char[]){"n bk7"},
                         (char[]){"7 \xc3\xa4 \"x\""}};
  for (int i = 0; i < 4; i++)
    m[i] = (abbe_material){
        .name = names[i],
        .source = broken,
        .min_nm = 400,
        .max_nm = 700,
        .dispersion = {.model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {1.5, 0.004}}};
  char *text = written(ABBE_SHADER_POVRAY, m, 4);
  assert_contains(text, "#declare Abbe_n_bk7 =");
  assert_contains(text, "#declare Abbe_n_bk7_2 =");
  assert_contains(text, "#declare Abbe_n_bk7_3 =");
  assert_contains(text, "#declare Abbe_m_7_____x_ =");
  assert_contains(text, "source: line break */\n");
  free(text);
  text = written(ABBE_SHADER_MDL, m, 1);
  assert_contains(text, "mdl 1.6;");
  assert_contains(text, "export material n_bk7() = material(");
  free(text);
  text = written(ABBE_SHADER_GLTF, &m[3], 1);
  cJSON *root = cJSON_Parse(text);
  cJSON *first = cJSON_GetArrayItem(cJSON_GetObjectItem(root, "materials"), 0);
  assert_string_equal(cJSON_GetObjectItem(first, "name")->valuestring, names[3]);
  cJSON_Delete(root);
  free(text);
}

/* exp(-(1 - fade_color) d / fade_distance) is exp(-a d). */
TEST(povray_fades_as_the_material_absorbs) {
  const abbe_material *m = shipped_material("n-sf11");
  FREED char *text = written(ABBE_SHADER_POVRAY, m, 1);
  char *at = strstr(text, "fade_distance ");
  double distance = strtod(at + strlen("fade_distance "), NULL), colour[3];
  at = strchr(at, '<') + 1;
  for (int i = 0; i < 3; i++) colour[i] = strtod(at, &at), at++;
  const double primary_nm[3] = {611.4, 549.1, 464.2};
  for (int i = 0; i < 3; i++)
    assert_near((1 - colour[i]) / distance, abbe_material_attenuation(m, primary_nm[i]), 1e-9);
}

TEST(failures_are_told) {
  FILE *full = fopen("/dev/full", "w");
  REFUSED(ABBE_IO, "", abbe_shader_write(ABBE_SHADER_MDL, &shipped, full, NULL, &error));
  fclose(full);
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_shader_write(ABBE_SHADER_COUNT, &shipped, stdout, NULL, &error));
  abbe_material bad = {.name = (char[]){"bad"}};
  free(written(ABBE_SHADER_GLTF, &bad, 1));
  assert_int_equal(report.kinds[ABBE_NOTE_SKIPPED], 1);
}
