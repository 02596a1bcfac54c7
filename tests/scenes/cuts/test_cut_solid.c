/* Stones as solids for other programs: what is written reads back with its volume and place, in
 * metres or millimetres as the format has them; glTF's extensions by structure.
 */
#include "scenes/cuts/cut_file.h"

#include "base/file.h"
#include "scenes/mesh/mesh.h"
#include "spectral/formats/material_import.h"
#include "spectral/materials/material_table.h"
#include "tests/scenes/cuts/designs.h"

#include <cjson/cJSON.h>
#include <unistd.h>

static const char *const paths[] = {"cut_solid_test.stl", "cut_solid_test.obj",
                                    "cut_solid_test.glb"};

static abbe_cut_polyhedron stone_of(const abbe_cut *cut) {
  abbe_cut_polyhedron p;
  OK(abbe_cut_polyhedron_make(cut, 0, &p, &error));
  return p;
}

static void write_to(const char *path, const abbe_cut *cut, const abbe_cut_polyhedron *p,
                     double scale, const abbe_material *material) {
  abbe_error error = {0};
  FILE *to = fopen(path, "wb");
  assert_non_null(to);
  if (abbe_cut_solid_write(cut, p, scale, material, abbe_cut_solid_format_of(path), to, &error) !=
      ABBE_OK)
    fail_msg("%s", error.text);
  assert_int_equal(fclose(to), 0);
}

/* Volume and bounds are the stone's, in the unit of the format; the normals look outwards. */
static void check(const char *text, double scale, int format) {
  OWNED(abbe_cut, cut) = design_parse(text);
  OWNED(abbe_cut_polyhedron, p) = stone_of(&cut);
  abbe_mesh_report report;
  const double unit = format == 2 ? scale : 1e3 * scale, size = unit * (p.max[0] - p.min[0]);
  write_to(paths[format], &cut, &p, scale, NULL);
  MADE(abbe_mesh, mesh, abbe_mesh_load(paths[format], ABBE_NORMALS_FLAT, &mesh, NULL, &error));
  OK(abbe_mesh_check(&mesh, &report, &error));
  assert_near(report.volume, p.volume * pow(unit, 3), 1e-5 * p.volume * pow(unit, 3));
  assert_int_equal(report.open_edges + report.flipped_edges + report.crowded_edges, 0);
  assert_near(report.min[0], unit * p.min[0], 1e-6 * size);
  assert_near(report.max[0], unit * p.max[0], 1e-6 * size);
  for (int k = 1; k < 3; k++) assert_near(report.max[k], unit * p.max[k], 1e-6 * size);
  assert_int_equal(mesh.face_count, p.corner_count - 2 * p.face_count);
  assert_int_equal(unlink(paths[format]), 0);
}

TEST(what_is_written_reads_back) {
  for (int format = 0; format < ABBE_CUT_SOLID_COUNT; format++) {
    assert_int_equal(abbe_cut_solid_format_of(paths[format]), format);
    check(design_a, 0.004, format);
    check(design_d, 0.01, format); /* which looks different in a mirror */
  }
  assert_int_equal(abbe_cut_solid_format_of("stone.gltf"), ABBE_CUT_SOLID_COUNT);
  assert_int_equal(abbe_cut_solid_format_of("stl"), ABBE_CUT_SOLID_COUNT);
}

static double number(const cJSON *object, const char *key) {
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
  assert_non_null(item);
  return cJSON_GetNumberValue(item);
}

static const cJSON *under(const cJSON *object, const char *key) {
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
  if (item == NULL) fail_msg("there is no %s", key);
  return cJSON_IsArray(item) ? cJSON_GetArrayItem(item, 0) : item;
}

/* Words of OBJ are letters and digits; a stone of colour says it; one without an index at the lines
 * is refused. */
TEST(names_and_colours_are_written) {
  static const char stones[] =
      "materials:\n"
      "- {name: blue, model: constant, coefficients: [1.5], source: s,\n"
      "   absorption: {attenuation_per_m: [[380, 300], [500, 0], [780, 300]]}}\n"
      "- {name: narrow, model: cauchy, coefficients: [1.5, 0.006], range_nm: [400, 450], source: "
      "s}\n";
  OWNED(abbe_cut, cut) = design_parse("g 96 0\na 90 1 96 n Az-9{ 24 48 72\na 0 1\na -0 1\n");
  OWNED(abbe_cut_polyhedron, p) = stone_of(&cut);
  MADE(abbe_material_table, table,
       abbe_material_table_parse(stones, strlen(stones), "stones", &table, &error));
  FREED char *obj = NULL, *glb = NULL;
  size_t size;
  write_to(paths[1], &cut, &p, 1, NULL);
  OK(abbe_file_read(paths[1], 1 << 20, &obj, &size, &error));
  assert_contains(obj, "g facet_Az_9__1\n");
  write_to(paths[2], &cut, &p, 0.003, &table.material[0]);
  OK(abbe_file_read(paths[2], 1 << 20, &glb, &size, &error));
  cJSON *root = cJSON_Parse(glb + 20);
  const cJSON *e = under(under(root, "materials"), "extensions");
  const cJSON *colour =
      cJSON_GetObjectItemCaseSensitive(under(e, "KHR_materials_volume"), "attenuationColor");
  const double red = cJSON_GetArrayItem(colour, 0)->valuedouble,
               green = cJSON_GetArrayItem(colour, 1)->valuedouble;
  assert_true(green > red && red >= 0 && green <= 1);
  cJSON_Delete(root);
  REFUSED(
      ABBE_OUT_OF_RANGE, "no index at the lines d, F and C",
      abbe_cut_solid_write(&cut, &p, 1, &table.material[1], ABBE_CUT_SOLID_GLB, stderr, &error));
  assert_int_equal(unlink(paths[1]) + unlink(paths[2]), 0);
}

/* Diamond: n_d 2.4175, V_d 55.3 by the record; clear, so no colour. */
TEST(gltf_knows_the_stone) {
  OWNED(abbe_cut, cut) = design_parse(design_b);
  OWNED(abbe_cut_polyhedron, p) = stone_of(&cut);
  const abbe_material *diamond;
  FREED char *data = NULL;
  size_t size;
  MADE(abbe_material_table, table, abbe_material_table_load(NULL, &table, &error));
  OK(abbe_material_table_find(&table, "diamond", &diamond, &error));
  write_to(paths[2], &cut, &p, 0.003, diamond);
  OK(abbe_file_read(paths[2], 1 << 20, &data, &size, &error));
  assert_memory_equal(data, "glTF\2\0\0\0", 8);
  cJSON *root = cJSON_Parse(data + 20);
  assert_non_null(root);
  const cJSON *e = under(under(root, "materials"), "extensions");
  assert_near(number(under(e, "KHR_materials_ior"), "ior"), 2.4175, 1e-3);
  const double v_d = 20 / number(under(e, "KHR_materials_dispersion"), "dispersion");
  assert_true(v_d > 54 && v_d < 57);
  assert_near(number(under(e, "KHR_materials_transmission"), "transmissionFactor"), 1, 0);
  assert_near(number(under(e, "KHR_materials_volume"), "thicknessFactor"),
              0.003 * (p.max[0] - p.min[0]), 1e-8);
  const cJSON *accessor = under(root, "accessors");
  assert_int_equal(number(accessor, "count"), p.corner_count); /* no corner is shared */
  const uint32_t *bytes = (const uint32_t *)(const void *)data;
  assert_int_equal(bytes[2], size);
  cJSON_Delete(root);
  assert_int_equal(unlink(paths[2]), 0);
}
