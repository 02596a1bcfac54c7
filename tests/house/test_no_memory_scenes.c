/* Every allocation failing in turn: pictures and their files, charts, weights, meshes, scenes,
 * plans. */
#include "tests/faults/operations.h"
#include "tests/fontconfig.h"

#include "colorimetry/illuminant.h"
#include "colorimetry/image/display_table.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/picture_file.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/image/rgb_encoding.h"
#include "colorimetry/plot/chart.h"
#include "colorimetry/plot/material_chart.h"
#include "colorimetry/weights.h"
#include "gl/accuracy/preset.h"
#include "gl/plan/plan.h"
#include "scenes/cuts/cut_file.h"
#include "scenes/cuts/cut_meets.h"
#include "scenes/cuts/cut_stretch.h"
#include "scenes/environment/environment_source.h"
#include "scenes/import/scene_file.h"
#include "scenes/mesh/mesh.h"
#include "scenes/shapes/shape.h"
#include "scenes/view/map_layout.h"
#include "spectral/formats/material_import.h"

#include "base/file.h"

#define FUZZ ABBE_SOURCE_DIR "/tests/fuzz/"

static const char *const rgb[] = {"R", "G", "B"};

/* ---- pictures ---- */

static abbe_result make_image(size_t side, abbe_image *out, abbe_error *error) {
  abbe_result result = abbe_image_make(side, side, 3, rgb, out, error);
  for (size_t i = 0; i < 3 * side * side && result == ABBE_OK; i++)
    out->data[i] = (float)(i % 7) * 0.125f;
  if (result == ABBE_OK) result = abbe_image_set_attribute(out, "note", "small", error);
  if (result == ABBE_OK) result = abbe_image_set_attribute(out, "note", "smaller", error);
  return result;
}

static void digest_image(const abbe_image *image) {
  digest(image->data, image->width * image->height * image->channels * sizeof *image->data);
  for (size_t i = 0; i < image->channels; i++) digest_text(image->channel[i]);
  for (size_t i = 0; i < image->attribute_count; i++) digest_text(image->attribute[i].text);
}

static abbe_result exr(abbe_error *error) {
  OWNED(abbe_image, image) = {0};
  abbe_image back = {0};
  const char *path = operation_path("picture.exr");
  abbe_result result = make_image(5, &image, error);
  if (result == ABBE_OK) result = abbe_image_set_attribute(&image, "R.wavelength", "6e-7", error);
  for (int half = 0; half < 2 && result == ABBE_OK; half++) {
    if (half) image.data[0] = 1e6f; /* so that it is scaled */
    result = (half ? abbe_exr_write_half : abbe_exr_write)(path, &image, error);
    if (result == ABBE_OK) result = abbe_exr_read(path, &back, error);
    if (result == ABBE_OK) digest_image(&back);
    abbe_image_free(&back);
  }
  return result;
}

static abbe_result png(abbe_error *error) {
  OWNED(abbe_image, image) = {0}, back = {0}, profile = {0};
  const char *path = operation_path("picture.png");
  abbe_result result = make_image(5, &image, error);
  if (result == ABBE_OK) abbe_rgb_encoding_display_p3(image.xy, image.curve);
  if (result == ABBE_OK) result = abbe_png_write(path, &image, 16, error);
  if (result == ABBE_OK) result = abbe_png_read(path, &back, error);
  if (result == ABBE_OK) digest_image(&back);
  if (result == ABBE_OK) result = abbe_png_read(FUZZ "corpus/png/profile.png", &profile, error);
  if (result == ABBE_OK) digest_image(&profile);
  return result;
}

static abbe_result chart(abbe_error *error) {
  static const double x[] = {1, 2, 3}, y[] = {1, 4, 9}, low[] = {0, 3, 8}, high[] = {2, 5, 10};
  static const float value[] = {0, 1, 2, 3};
  static const char *const text[] = {"a", "b", "c"};
  const abbe_chart_series series[] = {
      {.label = "s", .style = ABBE_CHART_JOINED_POINTS, .count = 3, .x = x, .y = y, .text = text},
      {.label = "t", .style = ABBE_CHART_BAND, .count = 3, .x = x, .low = low, .high = high}};
  const abbe_chart_field field = {.width = 2, .height = 2, .value = value, .label = "f"};
  const abbe_chart charts[] = {
      {.title = "t", .x = {.label = "x"}, .y = {.label = "y"}, .series_count = 2, .series = series},
      {.title = "f", .field = &field}};
  static const char *const names[] = {"chart.svg", "chart.png"};
  abbe_result result = ABBE_OK;
  for (int i = 0; i < 2 && result == ABBE_OK; i++)
    result = abbe_chart_write(operation_path(names[i]), charts, 2, 0, 0, error);
  return result;
}

static abbe_result material_charts(abbe_error *error) {
  OWNED(abbe_material_table, table) = {0};
  abbe_result result = abbe_material_table_load(FUZZ "parts/table.yaml", &table, error);
  if (result != ABBE_OK) return result;
  const abbe_material *two[] = {&table.material[0], &table.material[1]};
  const abbe_material_chart curves = {.count = 2, .material = two, .fits = true};
  result = abbe_material_chart_write(operation_path("curves.svg"), &curves, error);
  return result;
}

static abbe_result weights(abbe_error *error) {
  static const char *const names[] = {"D65", "A", FUZZ "parts/lines.txt"};
  OWNED(abbe_wavelengths, wavelengths) = {0};
  abbe_result result = abbe_wavelengths_make(7, 400, 700, &wavelengths, error);
  for (int i = 0; i < 3 && result == ABBE_OK; i++) {
    OWNED(abbe_illuminant, illuminant) = {0};
    OWNED(abbe_weights, made) = {0};
    result = abbe_illuminant_make(names[i], &illuminant, error);
    if (result == ABBE_OK)
      result = abbe_weights_make(&wavelengths, &illuminant, ABBE_RGB_SPACE_ACESCG, &made, error);
    if (result == ABBE_OK) digest(made.weight, made.count * sizeof *made.weight);
  }
  return result;
}

static abbe_result display(abbe_error *error) {
  abbe_display *made = NULL;
  FREED char *list = NULL;
  OWNED(abbe_image, image) = {0};
  const abbe_display_desc desc = {.exposure = 1};
  abbe_result result = abbe_display_make(&desc, &made, error);
  if (result == ABBE_OK) result = make_image(2, &image, error);
  if (result == ABBE_OK) result = abbe_display_apply(made, &image, error);
  if (result == ABBE_OK) digest_image(&image);
  if (result == ABBE_OK) result = abbe_display_list(NULL, &list, error);
  if (result == ABBE_OK) digest_text(list);
  abbe_display_free(made);
  return result;
}

/* A table of colours, for a picture that goes beyond it. */
static abbe_display *shown;

static abbe_result display_table(abbe_error *error) {
  abbe_display_table *table = NULL;
  OWNED(abbe_image, image) = {0};
  abbe_result result = abbe_display_table_make(shown, &table, error);
  if (result == ABBE_OK) result = make_image(2, &image, error);
  if (result == ABBE_OK) image.data[0] = -1;
  if (result == ABBE_OK) result = abbe_display_table_apply(table, &image, error);
  if (result == ABBE_OK) digest_image(&image);
  abbe_display_table_free(table);
  return result;
}

/* ENVI, Radiance, and of OpenEXR a header and sums. */
static abbe_result other_pictures(abbe_error *error) {
  static const char head[] =
      "ENVI\nsamples = 2\nlines = 2\nbands = 3\ninterleave = bip\n"
      "data type = 1\nband names = {a, b, c}\nwavelength = {500, 550, 600}\n";
  static const double weight[1][3] = {{1, 1, 1}}, one = 1;
  static const size_t first = 0;
  OWNED(abbe_image, cube) = {0}, light = {0}, header = {0}, sums = {0}, both = {0};
  abbe_exr_reader *reader = NULL;
  abbe_image_odd odd;
  abbe_result result = abbe_file_write(operation_path("cube.hdr"), head, sizeof head - 1, error);
  if (result == ABBE_OK)
    result = abbe_file_write(operation_path("cube.raw"), "abcdefghijkl", 12, error);
  if (result == ABBE_OK) result = abbe_picture_file_read(operation_path("cube.hdr"), &cube, error);
  if (result == ABBE_OK) digest_image(&cube);
  if (result == ABBE_OK)
    result = abbe_picture_file_read(FUZZ "corpus/picture/new_runs.hdr", &light, error);
  if (result == ABBE_OK) digest_image(&light);
  if (result == ABBE_OK)
    result = abbe_exr_open(FUZZ "corpus/exr/zip_half_lines.exr", &reader, error);
  if (result == ABBE_OK) result = abbe_exr_read_header(reader, &header, error);
  if (result == ABBE_OK)
    result = abbe_image_make(header.width, header.height, 3, rgb, &sums, error);
  if (result == ABBE_OK)
    result = abbe_exr_read_sums(reader, 1, &first, weight, &one, &sums, &odd, error);
  if (result == ABBE_OK) digest_image(&sums);
  if (result == ABBE_OK) result = abbe_image_make(2, 2, 3, rgb, &both, error);
  if (result == ABBE_OK) result = abbe_image_append(&both, &cube, error);
  if (result == ABBE_OK) digest_image(&both);
  abbe_exr_close(reader);
  return result;
}

/* ---- meshes ---- */

static void digest_mesh(const abbe_mesh *mesh) {
  digest(mesh->position, mesh->vertex_count * sizeof *mesh->position);
  digest(mesh->face, mesh->face_count * sizeof *mesh->face);
}

static abbe_result shapes(abbe_error *error) {
  static const double size[3] = {1, 2, 3}, profile[][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  abbe_mesh mesh[7] = {{0}};
  double(*rounded)[2] = NULL;
  size_t count = 0;
  abbe_result result = abbe_shape_sphere(1, 1, &mesh[0], error);
  if (result == ABBE_OK) result = abbe_shape_ring(1, 0.25, 8, 6, &mesh[1], error);
  if (result == ABBE_OK) result = abbe_shape_gem(6, 1, 0.5, 0.25, 0.5, &mesh[2], error);
  if (result == ABBE_OK) result = abbe_shape_prism(1, 1, 2, &mesh[3], error);
  if (result == ABBE_OK) result = abbe_shape_box(size, &mesh[4], error);
  if (result == ABBE_OK) result = abbe_shape_rectangle(1, 2, &mesh[5], error);
  if (result == ABBE_OK) result = abbe_shape_round_profile(profile, 4, 2, &rounded, &count, error);
  if (result == ABBE_OK)
    result = abbe_shape_lathe((const double(*)[2])rounded, count, 8, &mesh[6], error);
  for (int i = 0; i < 7; i++) {
    if (result == ABBE_OK) digest_mesh(&mesh[i]);
    abbe_mesh_free(&mesh[i]);
  }
  free(rounded);
  return result;
}

static abbe_result meshes(abbe_error *error) {
  static const char *const paths[] = {FUZZ "parts/tetra.obj", FUZZ "parts/open.ply"};
  abbe_result result = ABBE_OK;
  for (int i = 0; i < 2 && result == ABBE_OK; i++) {
    OWNED(abbe_mesh, mesh) = {0};
    FREED char *what = NULL;
    double plane[16][4];
    abbe_convex found = {0};
    result = abbe_mesh_load(paths[i], i == 0 ? ABBE_NORMALS_AUTO : ABBE_NORMALS_FLAT, &mesh, NULL,
                            error);
    if (result == ABBE_OK) result = abbe_mesh_fix(&mesh, ABBE_NORMALS_AUTO, NULL, &what, error);
    if (result == ABBE_OK) result = abbe_mesh_compute_normals(&mesh, (abbe_mesh_normals)i, error);
    if (result == ABBE_OK) result = abbe_convex_find(&mesh, 16, plane, NULL, &found, error);
    if (result == ABBE_OK && found.verdict == ABBE_CONVEX_SOLID)
      digest(plane, found.planes * sizeof *plane);
    double moved = 0;
    if (result == ABBE_OK && i == 0) result = abbe_convex_flatten(&mesh, 0.01, 16, &moved, error);
    if (result == ABBE_OK) digest_mesh(&mesh);
    if (result == ABBE_OK) result = abbe_mesh_subdivide(&mesh, 1, error);
    if (result == ABBE_OK) digest_mesh(&mesh);
    if (result == ABBE_OK) digest_text(what);
  }
  return result;
}

/* A box with slivers, a hole and turned faces, so that all steps of fixing have work. */
static abbe_result fix(abbe_error *error) {
  static const char *const names[] = {"box_open",   "box_turned", "sliver",  "two_shells",
                                      "degenerate", "crossing",   "touching"};
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < sizeof names / sizeof *names && result == ABBE_OK; i++) {
    static char path[512];
    FREED char *data = NULL, *what = NULL;
    size_t size = 0;
    OWNED(abbe_mesh, mesh) = {0};
    snprintf(path, sizeof path, FUZZ "corpus/mesh/%s", names[i]);
    result = abbe_file_read(path, 4096, &data, &size, error);
    if (result == ABBE_OK)
      result = abbe_mesh_make((size_t)data[1], (size_t)data[2], false, &mesh, error);
    for (size_t k = 0; result == ABBE_OK && k < 3 * mesh.vertex_count; k++)
      mesh.position[k / 3][k % 3] = (double)(signed char)data[4 + k];
    for (size_t k = 0; result == ABBE_OK && k < 3 * mesh.face_count; k++)
      mesh.face[k / 3][k % 3] = (uint32_t)(unsigned char)data[4 + 3 * mesh.vertex_count + k];
    if (result == ABBE_OK) result = abbe_mesh_fix(&mesh, ABBE_NORMALS_AUTO, NULL, &what, error);
    if (result == ABBE_OK) digest_mesh(&mesh);
    FREED abbe_mesh *part = NULL;
    size_t parts = 0;
    if (result == ABBE_OK) result = abbe_mesh_split(&mesh, &part, &parts, error);
    for (size_t k = 0; part != NULL && k < parts; k++) {
      digest_mesh(&part[k]);
      abbe_mesh_free(&part[k]);
    }
    if (result == ABBE_OK) digest_text(what);
  }
  return result;
}

/* ---- scenes ---- */

static abbe_result scene(const char *name, abbe_error *error) {
  static char path[512];
  FREED char *text = NULL;
  size_t size = 0;
  OWNED(abbe_scene, made) = {0};
  abbe_plan plan = {0};
  const abbe_render_desc desc = {.min_nm = 400, .max_nm = 700};
  snprintf(path, sizeof path, FUZZ "corpus/scene/%s.yaml", name);
  abbe_result result = abbe_file_read(path, 1 << 16, &text, &size, error);
  if (result == ABBE_OK)
    result = abbe_scene_parse(text, size, FUZZ "parts/f.yaml", NULL, &made, error);
  for (size_t i = 0; i < made.object_count && result == ABBE_OK; i++)
    digest_mesh(&made.object[i].mesh);
  if (result == ABBE_OK && made.environment != NULL) {
    digest(made.environment->mean, sizeof made.environment->mean);
  } else if (result == ABBE_OK && made.light[0].kind != ABBE_LIGHT_DISK) {
    result = abbe_plan_make(&made, &desc, &plan, error);
    for (size_t i = 0; i < plan.entry_count && result == ABBE_OK; i++)
      digest_text(plan.entry[i].reason);
    abbe_plan_free(&plan);
  }
  return result;
}

/* A Radiance picture of a cube. */
static abbe_result picture(abbe_error *error) {
  char text[1024] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 6 +X 8\n";
  const size_t head = strlen(text);
  const char *path = operation_path("cube.hdr");
  OWNED(abbe_environment, made) = {0};
  for (size_t i = 0; i < 48; i++) memcpy(text + head + 4 * i, "\x80\x40\x20\x80", 4);
  abbe_result result = abbe_file_write(path, text, head + 4 * 48, error);
  if (result == ABBE_OK)
    result = abbe_environment_picture_read(path, ABBE_LAYOUT_BY_ASPECT, &made.map, error);
  if (result == ABBE_OK) result = abbe_environment_prepare(&made, error);
  if (result == ABBE_OK) digest(made.mean, sizeof made.mean);
  return result;
}

#define SCENE(name)                                                                                \
  static abbe_result scene_##name(abbe_error *error) {                                             \
    return scene(#name, error);                                                                    \
  }
SCENE(shapes)
SCENE(gem)
SCENE(files)
SCENE(glass)
SCENE(surroundings)

static abbe_result presets(abbe_error *error) {
  OWNED(abbe_presets, made) = {0};
  const abbe_result result = abbe_presets_load(FUZZ "corpus/presets/small.yaml", &made, error);
  if (result == ABBE_OK) digest(made.front[0].named, sizeof made.front[0].named);
  return result;
}

static abbe_result maps(abbe_error *error) {
  static const double origin[3] = {0, 0, 1}, forward[3] = {0, 0, -1}, up[3] = {0, 1, 0};
  abbe_view view;
  abbe_map_layout layout, back;
  OWNED(abbe_image, image) = {0}, out = {0};
  abbe_view_look(origin, forward, up, false, &view);
  const double window[4] = {-1, 1, -1, 1};
  memcpy(view.window, window, sizeof window);
  view.near = 0.1;
  view.far = 10;
  abbe_map_layout_make(&view, &layout);
  abbe_result result = make_image(4, &image, error);
  if (result == ABBE_OK) result = abbe_map_layout_write(&layout, "lamp", &image, error);
  if (result == ABBE_OK) result = abbe_map_layout_read(&image, "it", &back, error);
  if (result == ABBE_OK) result = abbe_map_resample(&image, "it", &back, 3, 3, 2, &out, error);
  if (result == ABBE_OK) digest_image(&out);
  return result;
}

/* ---- stones ---- */

static abbe_result write_design(const abbe_cut *cut, const abbe_cut_polyhedron *p, int kind,
                                char **text, size_t *size, abbe_error *error) {
  FILE *to = open_memstream(text, size);
  if (to == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a test");
  const abbe_result result =
      kind == 0   ? abbe_cut_asc_write(cut, to, NULL, error)
      : kind == 1 ? abbe_cut_gem_write(cut, p, to, NULL, error)
      : kind == 2 ? abbe_cut_gcs_write(cut, p, to, NULL, error)
                  : abbe_cut_solid_write(cut, p, 1, NULL, ABBE_CUT_SOLID_GLB, to, error);
  fclose(to);
  if (result == ABBE_OK) digest(*text, *size);
  return result;
}

/* Out and in again as each kind of design, then as a solid. */
static abbe_result kinds_of(const abbe_cut *cut, const abbe_cut_polyhedron *p, abbe_error *error) {
  static abbe_result (*const parse[])(const char *data, size_t size, const char *name,
                                      abbe_cut *out, abbe_report *report, abbe_error *error) = {
      abbe_cut_asc_parse, abbe_cut_gem_parse, abbe_cut_gcs_parse};
  abbe_result result = ABBE_OK;
  for (int i = 0; i < 4 && result == ABBE_OK; i++) {
    FREED char *text = NULL;
    size_t size = 0;
    abbe_cut back = {0};
    result = write_design(cut, p, i, &text, &size, error);
    if (result == ABBE_OK && i < 3) result = parse[i](text, size, "it", &back, NULL, error);
    if (result == ABBE_OK) digest(&back.facet_count, sizeof back.facet_count);
    abbe_cut_free(&back);
  }
  return result;
}

static abbe_result stone(abbe_error *error) {
  static const char text[] = "g 96 0\nH box\na 90 1 96 n G 24 n H 48 72 G saw\nG and polish\n"
                             "a 0 1 n T\na -0 1\na -45 1.2 96 24 48 72\n";
  OWNED(abbe_cut, cut) = {0};
  OWNED(abbe_cut_polyhedron, p) = {0}, moved = {0};
  OWNED(abbe_cut_meets, meets) = {0};
  double change[32] = {0};
  abbe_result result = abbe_cut_asc_parse(text, sizeof text - 1, "it", &cut, NULL, error);
  if (result == ABBE_OK) result = abbe_cut_polyhedron_make(&cut, 0, &p, error);
  if (result == ABBE_OK) result = kinds_of(&cut, &p, error);
  if (result == ABBE_OK) result = abbe_cut_meets_make(&cut, &p, &meets, error);
  for (size_t s = 0; result == ABBE_OK && s < meets.scalars; s++) change[s] = 0.01 * meets.free[s];
  if (result == ABBE_OK) result = abbe_cut_meets_move(&cut, &p, change, &moved, error);
  if (result == ABBE_OK) result = abbe_cut_stretch_to(&cut, &p, 0, 43, error);
  if (result == ABBE_OK)
    result = abbe_cut_diagram_write(operation_path("sheet.pdf"), &cut, &p, NULL, 1.5, error);
  digest(&meets.freedoms, sizeof meets.freedoms);
  return result;
}

GROUP(operation_setup, operation_teardown);

TEST(pictures) {
  static const operation list[] = {
      {"EXR", exr, 0},
      {"PNG", png, 0},
      {"charts", chart, 0},
      {"curves", material_charts, 300},
      {"weights", weights, 0},
      {"display", display, 0},
      {"display's table", display_table, 0},
      {"other pictures", other_pictures, 0},
  };
  OK(abbe_display_make(&(abbe_display_desc){0}, &shown, &error));
  operation_check_all(list, sizeof list / sizeof *list);
  abbe_display_free(shown);
}

TEST(scenes) {
  static const operation list[] = {
      {"shapes", shapes, 0},
      {"meshes", meshes, 40},
      {"fix", fix, 0},
      {"stone", stone, 0},
      {"scene of shapes", scene_shapes, 300},
      {"scene of a gem", scene_gem, 100},
      {"scene of files", scene_files, 40},
      {"scene of a glass", scene_glass, 200},
      {"scene with surroundings", scene_surroundings, 100},
      {"picture of surroundings", picture, 0},
      {"presets", presets, 0},
      {"receiver maps", maps, 0},
  };
  operation_check_all(list, sizeof list / sizeof *list);
}
