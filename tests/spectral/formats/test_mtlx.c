/* MaterialX documents: what their numbers mean, and what is left out. */
#include "tests/check.h"
#include "tests/spectral/shipped_table.h"

#include "spectral/formats/material_import.h"
#include "spectral/formats/material_write.h"
#include "spectral/materials/absorption.h"
#include "spectral/wavelengths.h"

static abbe_material_table table;
static abbe_report report;

static void clean(void) {
  abbe_material_table_free(&table);
  abbe_report_free(&report);
  table = (abbe_material_table){0};
}

static abbe_result import(const char *text, abbe_error *error) {
  clean();
  return abbe_import_parse(text, strlen(text), "a.mtlx", NULL, &table, &report, error);
}

#define DOCUMENT(inside)                                                                           \
  "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\">\n" inside "</materialx>\n"
#define INPUT(name, value) "<input name=\"" name "\" type=\"float\" value=\"" value "\"/>\n"

static void unload(void) {
  clean();
  shipped_free();
}
GROUP(shipped_load, unload);

/* OpenPBR divides the Abbe number by its scale, standard_surface has it as it is, glTF 20 over it.
 */
TEST(each_model_means_its_own_dispersion) {
  const struct {
    const char *text;
    double n_d, v_d; /* 0: none */
  } rows[] = {
      {DOCUMENT("<open_pbr_surface name=\"SR_a\">" INPUT("transmission_weight", "1")
                    INPUT("specular_ior", "2.42") INPUT("transmission_dispersion_scale", "1")
                        INPUT("transmission_dispersion_abbe_number", "55.3") "</open_pbr_surface>"),
       2.42, 55.3},
      {DOCUMENT("<open_pbr_surface name=\"a\">" INPUT("transmission_weight", "0.5")
                    INPUT("transmission_dispersion_scale", "0.25") "</open_pbr_surface>"),
       1.5, 80},
      {DOCUMENT(
           "<open_pbr_surface name=\"a\">" INPUT("transmission_weight", "1") "</open_pbr_surface>"),
       1.5, 0},
      {DOCUMENT("<standard_surface name=\"a\">" INPUT("transmission", "1") INPUT(
           "specular_IOR", "1.7") INPUT("transmission_dispersion", "30") "</standard_surface>"),
       1.7, 30},
      {DOCUMENT("<gltf_pbr name=\"a\">" INPUT("transmission", "1") INPUT("ior", "1.6")
                    INPUT("dispersion", "0.5") "</gltf_pbr>"),
       1.6, 40}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    OK(import(rows[i].text, &error));
    assert_int_equal(table.count, 1);
    assert_string_equal(table.material[0].name, "a");
    const abbe_dispersion *d = &table.material[0].dispersion;
    assert_near(abbe_dispersion_n(d, ABBE_LINE_D_NM), rows[i].n_d, 1e-12);
    const double spread =
        abbe_dispersion_n(d, ABBE_LINE_F_NM) - abbe_dispersion_n(d, ABBE_LINE_C_NM);
    assert_near(spread, rows[i].v_d > 0 ? (rows[i].n_d - 1) / rows[i].v_d : 0, 1e-12);
  }
}

/* The share that is left after the depth, and the name that people gave. */
TEST(a_colour_at_a_depth_is_an_attenuation) {
  double colour[3];
  OK(import(DOCUMENT("<surfacematerial name=\"Wine\"><input name=\"surfaceshader\" nodename=\"s\"/>"
                     "</surfacematerial><gltf_pbr name=\"s\">" INPUT("transmission", "1")
                         INPUT("attenuation_color", "0.9, 0.2, 0.5")
                             INPUT("attenuation_distance", "0.02") "</gltf_pbr>"),
            &error));
  assert_string_equal(table.material[0].name, "Wine");
  abbe_absorption_colour(table.material[0].attenuation, 0.02, colour);
  assert_near(colour[0], 0.9, 1e-12);
  assert_near(colour[1], 0.2, 1e-12);
  assert_near(colour[2], 0.5, 1e-12);
}

TEST(what_is_written_is_read_again) {
  static const char *const names[] = {"gold", "diamond", "n-bk7", "emerald", "diamond-fluorescent"};
  abbe_material all[5], *some = all + 1;
  char *text = NULL;
  size_t size = 0;
  for (int i = 0; i < 5; i++) all[i] = *find_material(&shipped, names[i]);
  const abbe_material_table written = {.count = 5, .material = all};
  clean();
  FILE *to = open_memstream(&text, &size);
  OK(abbe_mtlx_write(&written, to, &report, &error));
  fclose(to);
  assert_non_null(strstr(report.note[0].text, "it is a conductor"));
  assert_non_null(strstr(report.note[report.count - 2].text, "without its fluorescence"));
  OK(import(text, &error));
  free(text);
  assert_int_equal(table.count, 4);
  assert_string_equal(table.material[1].name, "n_bk7");
  for (int i = 0; i < 4; i++) {
    const abbe_dispersion_numbers was = abbe_dispersion_describe(&some[i].dispersion),
                                  is = abbe_dispersion_describe(&table.material[i].dispersion);
    assert_near(is.n_d, was.n_d, 1e-6);
    assert_near(is.v_d, was.v_d, 1e-4);
    assert_int_equal(some[i].attenuation != NULL, table.material[i].attenuation != NULL);
    if (some[i].attenuation == NULL) continue;
    /* three shares at the distance where the darkest is 1 / e are what the file can say */
    double colour[3], darkest = 1, back[3];
    abbe_absorption_colour(some[i].attenuation, 1, colour);
    for (int k = 0; k < 3; k++) darkest = fmin(darkest, colour[k]);
    if (!(darkest < 1)) continue;
    abbe_absorption_colour(some[i].attenuation, -1 / log(fmax(darkest, 1e-300)), colour);
    abbe_absorption_colour(table.material[i].attenuation, -1 / log(fmax(darkest, 1e-300)), back);
    for (int k = 0; k < 3; k++) assert_near(back[k], colour[k], 1e-9);
  }
}

static char *written(const abbe_material *m) {
  const abbe_material_table one = {.count = 1, .material = (abbe_material *)(uintptr_t)m};
  char *text = NULL;
  size_t size = 0;
  clean();
  FILE *to = open_memstream(&text, &size);
  OK(abbe_mtlx_write(&one, to, &report, &error));
  fclose(to);
  return text;
}

/* Texts keep their letters, names lose what MaterialX does not take, and a record of nothing that
 * can be written is skipped with the reason. */
TEST(odd_records_are_written) {
  static const double nm[] = {400, 700}, clear[] = {0, 0};
  abbe_material m = *find_material(&shipped, "topaz");
  FREED char *biaxial = written(&m);
  assert_contains(biaxial, "name=\"SR_topaz\"");
  assert_contains(report.note[0].text, "with its middle index");
  m = *find_material(&shipped, "n-bk7");
  m.attenuation = NULL;
  m.source = (char[]){"A & B <c> \"d\"\te"};
  m.name =
      (char[]){"a name of more letters than MaterialX's have room, \xc3\xa9 and 1234567890 and "
               "1234567890 and more than all others together have, so that it is cut"};
  FREED char *text = written(&m);
  assert_contains(text, "doc=\"A &amp; B &lt;c> &quot;d&quot; e\"");
  assert_contains(text, "name=\"a_name_of_more_letters_than_MaterialX_s_have_room_____and_"
                        "1234567890_and_1234567890_and_more_tha\"");
  OK(abbe_spectrum_make(nm, clear, 2, ABBE_INTERPOLATION_LINEAR, &m.attenuation, &error));
  FREED char *same = written(&m); /* which attenuates nothing */
  assert_null(strstr(same, "transmission_depth"));
  abbe_spectrum_free(m.attenuation);
  m.attenuation = NULL;
  static const struct {
    double min_nm, max_nm, n;
  } none[] = {{500, 700, 1.5}, {400, 600, 1.5}, {400, 700, 0.9}, {400, 700, 1.5}};
  for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
    m.min_nm = none[i].min_nm;
    m.max_nm = none[i].max_nm;
    m.dispersion = (abbe_dispersion){.model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {none[i].n}};
    m.dispersion.c[1] = i == 3 ? -0.004 : 0.004;
    FREED char *nothing = written(&m);
    assert_null(strstr(nothing, "<open_pbr"));
    assert_int_equal(report.count, 1);
    assert_contains(report.note[0].text, "it has no n_d and V_d in its range");
  }
  OK(import(
      DOCUMENT("<gltf_pbr name=\"a\"><note/><input type=\"float\"/>" INPUT(
          "transmission",
          "1") "</gltf_pbr><surfacematerial name=\"w\"><input name=\"s\"/></surfacematerial>"),
      &error));
  assert_int_equal(table.count, 1);
  REFUSED(ABBE_PARSE, "'ior' is '1e999'",
          import(DOCUMENT("<gltf_pbr name=\"a\">" INPUT("ior", "1e999") "</gltf_pbr>"), &error));
  for (int buffered = 0; buffered < 2; buffered++) {
    const abbe_material_table one = {.count = 1, .material = &m};
    FILE *full = fopen("/dev/full", "w");
    if (!buffered) setvbuf(full, NULL, _IONBF, 0);
    REFUSED(ABBE_IO, "could not be written", abbe_mtlx_write(&one, full, &report, &error));
    fclose(full);
  }
}

/* Names that differ by what MaterialX does not take are two; a name that is taken or none is left.
 */
TEST(no_material_is_lost_by_its_name) {
  abbe_material some[2] = {*find_material(&shipped, "n-bk7"), *find_material(&shipped, "k5")};
  some[0].name = (char[]){"a-b"};
  some[1].name = (char[]){"a_b"};
  const abbe_material_table written = {.count = 2, .material = some};
  char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  OK(abbe_mtlx_write(&written, to, &report, &error));
  fclose(to);
  OK(import(text, &error));
  free(text);
  assert_int_equal(table.count, 2);
  assert_string_equal(table.material[1].name, "a_b_2");
  OK(import("<?xml version=\"1.0\"?><materialx version=\"1.39\"><gltf_pbr name=\"SR_a\">" INPUT(
                "transmission", "1") "</gltf_pbr><gltf_pbr name=\"M\">" INPUT("transmission", "1")
                INPUT("ior", "1.7") "</gltf_pbr><surfacematerial name=\"M\"><input name=\"s\" "
                                    "nodename=\"SR_a\"/></surfacematerial></materialx>",
            &error));
  assert_int_equal(table.count, 2);
  assert_string_equal(table.material[0].name, "a");
  assert_non_null(strstr(report.note[0].text, "another has that name"));
}

TEST(what_cannot_be_used_is_said) {
  const struct {
    const char *text, *note;
  } skipped[] = {{DOCUMENT("<open_pbr_surface name=\"s\"/>"), "no light goes through it"},
                 {DOCUMENT("<gltf_pbr name=\"s\">" INPUT(
                      "transmission",
                      "1") "<input name=\"ior\" type=\"float\" nodename=\"other\"/></gltf_pbr>"),
                  "come from another node"},
                 {DOCUMENT("<gltf_pbr name=\"s\">" INPUT("transmission", "1")
                               INPUT("ior", "0.5") "</gltf_pbr>"),
                  "is not an index of refraction"},
                 {DOCUMENT("<gltf_pbr name=\"s\">" INPUT("transmission", "1")
                               INPUT("attenuation_color", "1, 0.5, 1")
                                   INPUT("attenuation_distance", "1e-320") "</gltf_pbr>"),
                  "is not finite"},
                 {DOCUMENT("<gltf_pbr name=\"s\">" INPUT("transmission", "1")
                               INPUT("attenuation_color", "1, 0, 0") "</gltf_pbr>"),
                  "a tint of its surface"}};
  for (size_t i = 0; i < sizeof skipped / sizeof *skipped; i++) {
    OK(import(skipped[i].text, &error));
    assert_int_equal(table.count, i == 4);
    const abbe_note *last = &report.note[report.count - 1];
    assert_non_null(strstr(last->text, skipped[i].note));
  }
  char deep[2000] = "<?xml version=\"1.0\"?>";
  for (int i = 0; i < 65; i++) strcat(deep, "<materialx>");
  REFUSED(ABBE_PARSE, "more than 64 deep", import(deep, &error));
  REFUSED(ABBE_SCHEMA, "holds none of", import(DOCUMENT("<nodedef/>"), &error));
  static const char typed[] = "<!DOCTYPE materialx [<!ENTITY a \"1\">]><materialx/>";
  static const abbe_import_options options = {.format = ABBE_IMPORT_MTLX};
  clean();
  REFUSED(ABBE_PARSE, "a.mtlx:1: a MaterialX document has no <!DOCTYPE",
          abbe_import_parse(typed, strlen(typed), "a.mtlx", &options, &table, &report, &error));
  REFUSED(ABBE_PARSE, "a.mtlx:3: mismatched tag", import(DOCUMENT("<gltf_pbr></a>"), &error));
  REFUSED(ABBE_PARSE, "a.mtlx:3: 'ior' is 'high'; one number is right",
          import(DOCUMENT("<gltf_pbr>" INPUT("ior", "high") "</gltf_pbr>"), &error));
  REFUSED(ABBE_PARSE, "three numbers such as",
          import(DOCUMENT("<gltf_pbr>" INPUT("attenuation_color", "1, 2") "</gltf_pbr>"), &error));
}
