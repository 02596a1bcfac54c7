/* The library in a program that sets its user's locale: what it reads, computes, writes and says is
 * the same to the byte where numbers are written with a comma. */
#include "tests/decimal_comma.h"
#include "tests/fontconfig.h"
#include "tests/scenes/scene_text.h"

#include "base/number.h"
#include "colorimetry/image/display_ocio.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/plot/chart.h"
#include "gl/accuracy/preset.h"
#include "gl/plan/plan.h"
#include "scenes/export/pov_file.h"
#include "scenes/view/map_layout.h"
#include "spectral/editing/check.h"
#include "spectral/formats/material_import.h"
#include "spectral/formats/material_write.h"
#include "validation/lab/known/known_answers.h"
#include "validation/measure/field.h"
#include "validation/trace/tracer/tracer.h"

/* ---- what is noted of a run ---- */

/* Bits, not digits: the test itself must not go by the locale. */
static void note(FILE *to, const char *what, const void *data, size_t size) {
  fprintf(to, "%s:", what);
  for (size_t i = 0; i < size; i++) fprintf(to, " %02x", ((const unsigned char *)data)[i]);
  fputc('\n', to);
}

static void in_folder(const char *name, char path[300]) {
  snprintf(path, 300, "%s/%s", comma_folder, name);
}

static void make_file(const char *name, const char *text) {
  char path[300];
  in_folder(name, path);
  OK(abbe_file_write(path, text, strlen(text), &error));
}

static void note_file(FILE *to, const char *name) {
  char path[300];
  FREED char *data = NULL;
  size_t size = 0;
  in_folder(name, path);
  OK(abbe_file_read(path, 1 << 26, &data, &size, &error));
  for (size_t i = 0; i < size; i++)
    if (data[i] == '\0') data[i] = '@'; /* the notes are text */
  /* cairo counts the surfaces of a process */
  for (char *at = data; (at = strstr(at, "surface")) != NULL;)
    for (at += 7; *at >= '0' && *at <= '9'; at++) *at = '#';
  fprintf(to, "%s:\n", name);
  fwrite(data, 1, size, to);
  fputc('\n', to);
}

static void note_image(FILE *to, const char *what, const abbe_image *image) {
  note(to, what, image->data, image->width * image->height * image->channels * sizeof(float));
  for (size_t i = 0; i < image->attribute_count; i++)
    fprintf(to, "%s %s\n", image->attribute[i].name, image->attribute[i].text);
  for (size_t i = 0; i < image->channels; i++) fprintf(to, "%s\n", image->channel[i]);
}

/* ---- what the rooms do with numbers ---- */

static void with_materials(FILE *to) {
  static const char *const sets[] = {"default", "thesis"};
  for (int t = 0; t < 2; t++) {
    MADE(abbe_material_table, table, abbe_material_table_load(sets[t], &table, &error));
    MADE(abbe_material_table, known, abbe_material_table_load("default", &known, &error));
    OK(abbe_material_table_write(&table, to, &error));
    MADE(abbe_report, report, abbe_agf_write(&table, to, &report, &error));
    const abbe_csv_sampling sampling = {450, 525, 12.5};
    OK(abbe_csv_write(&table.material[1], &sampling, to, &report, &error));
    OK(abbe_rii_write(&table.material[1], to, &report, &error));
    for (size_t i = 0; i < report.count; i++) fprintf(to, "%s\n", report.note[i].text);
    MADE(abbe_findings, findings, abbe_check_table(&table, &known, &findings, &error));
    for (size_t i = 0; i < findings.count; i++)
      fprintf(to, "%s %s %s\n", findings.finding[i].evidence,
              findings.finding[i].fix ? findings.finding[i].fix : "",
              findings.finding[i].value ? findings.finding[i].value : "");
  }
}

static void with_imports(FILE *to) {
  static const char *const files[][2] = {
      {"points.csv", "wl,n,k\n0.5,1.52,1e-7\n0.6,1.515,2.5e-7\n0.7,1.51,1.25e-7\n"},
      {"glass.agf", "CC made up\nNM GLASS 2 0 1.5168 64.17 0 1\n"
                    "CD 1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653\n"
                    "TD 1.86e-6 1.31e-8 -1.37e-11 4.34e-7 6.27e-10 0.17 20\nLD 0.31 2.5\n"
                    "IT 0.4 0.997 10\nIT 0.5 0.9985 10\n"},
      {"page.yml",
       "REFERENCES: made up\nDATA:\n  - type: formula 1\n    wavelength_range: 0.3 2.5\n"
       "    coefficients: 0 1.03961212 0.0775 0.231792344 0.1415 1.01046945 10.176\n"}};
  for (int i = 0; i < 3; i++) {
    char path[300];
    OWNED(abbe_report, report) = {0};
    in_folder(files[i][0], path);
    make_file(files[i][0], files[i][1]);
    MADE(abbe_material_table, table,
         abbe_import_load(path, &(abbe_import_options){0}, &table, &report, &error));
    OK(abbe_material_table_write(&table, to, &error));
    for (size_t k = 0; k < report.count; k++) fprintf(to, "%s\n", report.note[k].text);
  }
}

static void with_illuminants(FILE *to) {
  static const char *const files[][2] = {{"comma.csv", "400,100\n500,200\n600,300\n700,50\n"},
                                         {"point.csv", "400.5 0.25\n500.5 0.5\n700.5 7.5e-1\n"}};
  for (int i = 0; i < 2; i++) {
    char path[300];
    in_folder(files[i][0], path);
    make_file(files[i][0], files[i][1]);
    MADE(abbe_illuminant, light, abbe_illuminant_make(path, &light, &error));
    const double power[2] = {abbe_illuminant_power(&light, 500.5),
                             abbe_illuminant_power(&light, 450)};
    note(to, files[i][0], power, sizeof power);
    assert_near(power[0], i == 0 ? 200.5 : 0.5, 1e-12);
  }
}

static void with_pictures(FILE *to) {
  static const char *const names[] = {"R", "G", "B"};
  abbe_view view =
      FIELDS(.forward = {0, 0, -1}, .right = {1, 0, 0}, .up = {0, 1, 0}, .origin = {0.1, -0.2, 0.3},
             .window = {-0.5, 0.5, -0.25, 0.75}, .near = 0.125, .far = 2.5);
  abbe_map_layout layout;
  char path[300], band[40];
  in_folder("half.exr", path);
  abbe_image_band_name(550.25, band, sizeof band);
  fprintf(to, "%s\n", band);
  assert_string_equal(band, "S0.550,250000nm"); /* [Fichet2021] */
  MADE(abbe_image, image, abbe_image_make(2, 2, 3, names, &image, &error));
  for (int i = 0; i < 12; i++) image.data[i] = 1e-5f * (float)(i + 1);
  abbe_map_layout_make(&view, &layout);
  OK(abbe_map_layout_write(&layout, "lamp", &image, &error));
  OK(abbe_image_set_attribute(&image, "abbe:passes", "16", &error));
  OK(abbe_exr_write_half(path, &image, &error));
  note_file(to, "half.exr");
  MADE(abbe_image, back, abbe_exr_read(path, &back, &error));
  note_image(to, "back", &back);
  OK(abbe_map_layout_read(&back, path, &layout, &error));
  note(to, "layout", &layout, sizeof layout);
  MADE(abbe_field, field, abbe_field_make(&back, path, &field, &error));
  fprintf(to, "%zu passes\n", field.passes);
  abbe_display *display = NULL;
  OK(abbe_display_make(&(abbe_display_desc){.exposure = 12.5}, &display, &error));
  OK(abbe_display_apply(display, &image, &error));
  note_image(to, "displayed", &image);
  note(to, "xy", image.xy, sizeof image.xy);
  abbe_display_free(display);
}

static void with_charts(FILE *to) {
  const double x[] = {0.125, 0.5, 1.25}, y[] = {1e-3, 0.1, 7.5};
  abbe_chart_series series = {.label = "a", .style = ABBE_CHART_POINTS, .count = 3, .x = x, .y = y};
  abbe_chart charts[2] = {{.series_count = 1, .series = &series},
                          {.y = {.log = true}, .series_count = 1, .series = &series}};
  char path[300];
  in_folder("chart.svg", path);
  OK(abbe_chart_write(path, charts, 2, 400, 300, &error));
  note_file(to, "chart.svg");
}

static void with_meshes(FILE *to) {
  static const char *const files[][2] = {
      {"a.obj", "v 0 0 0\nv 0.125 0 0\nv 0 0.25 0\nv 0 0 3.75e-1\nvt 0.5 0.25\n"
                "f 1/1 3/1 2/1\nf 1/1 2/1 4/1\nf 1/1 4/1 3/1\nf 2/1 3/1 4/1\n"},
      {"a.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                "property float z\nelement face 4\nproperty list uchar int vertex_indices\n"
                "end_header\n0 0 0\n0.125 0 0\n0 0.25 0\n0 0 0.375\n"
                "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"},
      {"a.stl", "solid x\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0.25 0\n"
                "vertex 0.125 0 0\nendloop\nendfacet\nfacet normal 0 0 0\nouter loop\n"
                "vertex 0 0 0\nvertex 0.125 0 0\nvertex 0 0 0.375\nendloop\nendfacet\n"
                "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 0.375\nvertex 0 0.25 0\n"
                "endloop\nendfacet\nfacet normal 0 0 0\nouter loop\nvertex 0.125 0 0\n"
                "vertex 0 0.25 0\nvertex 0 0 0.375\nendloop\nendfacet\nendsolid x\n"},
      {"a.gltf",
       "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"data:application/"
       "octet-stream;base64,AAAAAAAAAAAAAAAAAAAAPgAAAAAAAAAAAAAAAAAAgD4AAAAAAAAAAAAAAAAAAMA+"
       "AAACAAEAAAABAAMAAAADAAIAAQACAAMA\",\"byteLength\":72}],\"bufferViews\":[{\"buffer\":0,"
       "\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":24}],\"accessors\":[{"
       "\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[0,0,0],"
       "\"max\":[0.125,0.25,0.375]},{\"bufferView\":1,\"componentType\":5123,\"count\":12,\"type\":"
       "\"SCALAR\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}"
       "],\"nodes\":[{\"mesh\":0,\"scale\":[1.5,1.5,1.5]}],\"scenes\":[{\"nodes\":[0]}],\"scene\":"
       "0}"}};
  for (int i = 0; i < 4; i++) {
    char path[300];
    in_folder(files[i][0], path);
    make_file(files[i][0], files[i][1]);
    MADE(abbe_mesh, mesh, abbe_mesh_load(path, ABBE_NORMALS_FLAT, &mesh, NULL, &error));
    double most = 0;
    for (size_t v = 0; v < mesh.vertex_count; v++) most = fmax(most, mesh.position[v][2]);
    assert_near(most, 0.375, 1e-6); /* of glTF, y is up: 0.25, scaled */
    note(to, files[i][0], mesh.position, mesh.vertex_count * sizeof *mesh.position);
  }
}

static void with_scenes(FILE *to) {
  char path[300];
  OWNED(abbe_scene, scene) = shipped_scene("gem");
  note(to, "eye", scene.camera.eye, sizeof scene.camera.eye);
  MADE(abbe_plan, plan, abbe_plan_make(&scene, NULL, &plan, &error));
  for (size_t i = 0; i < plan.entry_count; i++)
    fprintf(to, "%s: %s\n", plan.entry[i].name, plan.entry[i].reason);
  for (size_t i = 0; i < plan.note_count; i++) fprintf(to, "%s\n", plan.note[i]);
  in_folder("gem.pov", path);
  OK(abbe_pov_file_write(path, &scene, NULL, &error));
  note_file(to, "gem.pov");
  const abbe_trace_desc desc = FIELDS(.width = 6, .height = 4, .photons = 64, .threads = 1,
                                      .map_width = 4, .map_height = 4, .seed = 1);
  abbe_tracer *tracer;
  OK(abbe_tracer_make(&scene, &desc, &tracer, &error));
  for (int i = 0; i < 2; i++) OK(abbe_tracer_pass(tracer, NULL, &error));
  MADE(abbe_image, picture, abbe_tracer_picture(tracer, &picture, &error));
  abbe_tracer_free(tracer);
  note_image(to, "traced", &picture);
}

static void with_answers(FILE *to) {
  static const char *const groups[] = {"prism", "slab", "nest", "fresnel"};
  for (int i = 0; i < 4; i++) {
    const abbe_known_options options = {.only = groups[i], .threads = 1};
    MADE(abbe_known_answers, answers, abbe_known_answers_make(&options, &answers, &error));
    assert_int_equal(abbe_known_answers_failed(&answers), 0);
    for (size_t k = 0; k < answers.count; k++) {
      fprintf(to, "%s\n", answers.row[k].quantity);
      note(to, "traced", &answers.row[k].traced, sizeof(double));
    }
  }
}

static void with_presets(FILE *to) {
  MADE(abbe_presets, presets, abbe_presets_load(NULL, &presets, &error));
  const abbe_preset_front *front = &presets.front[0];
  note(to, "margin", &front->margin, sizeof front->margin);
  for (size_t i = 0; i < front->count; i++) {
    const double number[] = {front->point[i].light_ms, front->point[i].error,
                             front->point[i].desc.energy_share};
    note(to, "preset", number, sizeof number);
  }
}

static void with_messages(FILE *to) {
  abbe_error said = {0};
  abbe_error_set(&said, ABBE_IO, "%g of %.3f", 1.5, 2.25);
  fprintf(to, "%s\n", said.text);
  assert_string_equal(said.text, "1.5 of 2.250");
  FILLED(abbe_report, report, abbe_report_add(&report, ABBE_NOTE_LOST, 1, NULL, "%g", 0.125));
  fprintf(to, "%s\n", report.note[0].text);
  char text[ABBE_NUMBER_TEXT_SIZE];
  fprintf(to, "%s\n", abbe_number_text(0.1, text));
  abbe_number_write(to, "%g %.17g\n", 0.5, 1.0 / 3);
  abbe_scene scene;
  static const char wrong[] = "camera: {eye: [0, -1.5, 0.5], target: [0, 0, 0.05], fov: 200.5}\n";
  assert_int_equal(abbe_scene_parse(wrong, sizeof wrong - 1, "s.yaml", NULL, &scene, &said),
                   ABBE_SCHEMA);
  fprintf(to, "%s\n", said.text);
}

/* ---- */

static char *run(const char *locale, void (*work)(FILE *to)) {
  char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  assert_non_null(to);
  assert_non_null(setlocale(LC_ALL, locale));
  work(to);
  const bool kept = strcmp(setlocale(LC_ALL, NULL), locale) == 0;
  char number[16];
  snprintf(number, sizeof number, "%.1f", 1.5); /* the thread's is as it was, too */
  setlocale(LC_ALL, "C");
  assert_int_equal(fclose(to), 0);
  assert_true(kept && number[1] == (strcmp(locale, "C") == 0 ? '.' : ','));
  return text;
}

static void same(void (*work)(FILE *to)) {
  FREED char *plain = run("C", work), *comma = run(COMMA, work);
  size_t at = 0;
  while (plain[at] != '\0' && plain[at] == comma[at]) at++;
  if (plain[at] != comma[at]) {
    const size_t from = at < 60 ? 0 : at - 60;
    print_error("'%.100s'\nbecomes '%.100s'\n", plain + from, comma + from);
  }
  assert_true(at > 10 && plain[at] == comma[at]);
}

GROUP(comma_setup, comma_teardown);

#define SAME(what)                                                                                 \
  TEST(what##_are_the_same) {                                                                      \
    same(with_##what);                                                                             \
  }
SAME(materials)
SAME(imports)
SAME(illuminants)
SAME(pictures)
SAME(charts)
SAME(meshes)
SAME(scenes)
SAME(answers)
SAME(presets)
SAME(messages)
