/* Materials of glTF files: what was exported is read again, the extension's own table of Abbe
 * numbers, and files that say what they may not say. */
#include "tests/scenes/export/export_text.h"

#include "scenes/import/mesh/gltf_material.h"
#include "spectral/materials/material_query.h"

#define FILE_NAME "/tmp/abbe-test-material.gltf"

static abbe_result load(const char *json, const char *part, abbe_material *out, char **name,
                        abbe_error *why) {
  OK(abbe_file_write(FILE_NAME, json, strlen(json), &error));
  const abbe_result result = abbe_gltf_material_load(FILE_NAME, part, out, name, why);
  unlink(FILE_NAME);
  return result;
}

#define GLASS(name, ior, more)                                                                     \
  "{\"name\":\"" name "\",\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0},"  \
  "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1},"                     \
  "\"KHR_materials_volume\":{\"thicknessFactor\":0.01" more "},"                                   \
  "\"KHR_materials_ior\":{\"ior\":" ior "}"
#define SOLID "\"KHR_materials_transmission\":{\"transmissionFactor\":1},\"KHR_materials_volume\":"
#define COLOUR(text) ",\"attenuationDistance\":1,\"attenuationColor\":" text
#define ONE(ior, more) "{\"materials\":[" GLASS("stone", ior, more) "}}]}"

GROUP(make_folder, drop_folder);

/* The extension's page: dispersion 2.04 for an Abbe number of 9.8 (rutile), 0.625 for 32, 0.36 for
 * 55, 0.33 for 59: rounded. */
TEST(abbe_numbers_of_the_extension) {
  static const double rows[][2] = {{2.04, 9.8}, {0.625, 32}, {0.36, 55}, {0.33, 59}};
  for (size_t i = 0; i < 4; i++) {
    char *name;
    abbe_material_numbers numbers;
    MADE(abbe_material, m,
         load(printed("{\"materials\":[%s,\"KHR_materials_dispersion\":{\"dispersion\":%g}}}]}",
                      GLASS("stone", "1.76", ""), rows[i][0]),
              NULL, &m, &name, &error));
    abbe_material_numbers_make(&m, &numbers);
    assert_near(numbers.n_d, 1.76, 1e-9);
    assert_near(numbers.v_d, 20 / rows[i][0], 1e-9);
    assert_near(numbers.v_d, rows[i][1], 0.03 * rows[i][1]);
    assert_null(name);
    assert_null(m.attenuation);
    assert_null(m.warning);
  }
}

TEST(defaults_and_what_is_left_out) {
  FREED char *name = NULL;
  double n;
  MADE(abbe_material, m,
       load("{\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.85,0.85,0.85,1]},"
            "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":0.9},\"KHR_"
            "materials_volume\":{\"thicknessFactor\":1,\"attenuationDistance\":0.02,"
            "\"attenuationColor\":[0.5,0.25,0]}}},{\"name\":\"cloth\"}]}",
            NULL, &m, &name, &error));
  OK(abbe_material_n(&m, 444, &n, &error));
  assert_near(n, 1.5, 0);
  assert_string_equal(m.name, "from-file");
  assert_string_equal(name, "");
  assert_contains(m.warning, "tint");
  assert_contains(m.warning, "roughness");
  assert_contains(m.warning, "not transmit");
  assert_near(abbe_material_attenuation(&m, 611.4), log(2) / 0.02, 1e-6);
  assert_near(abbe_material_attenuation(&m, 549.1), log(4) / 0.02, 1e-6);
  assert_near(abbe_material_attenuation(&m, 464.2), log(1e6) / 0.02, 1e-3);
}

TEST(bad_files_are_refused) {
  static const struct {
    const char *json, *part;
    abbe_result result;
    const char *says;
  } rows[] = {
      {"", NULL, ABBE_PARSE, "not well formed"},
      {"[]", NULL, ABBE_PARSE, "not well formed"},
      {"{}", NULL, ABBE_NOT_FOUND, "no material transmits"},
      {"{\"materials\":7}", NULL, ABBE_NOT_FOUND, "no material transmits"},
      {"{\"materials\":[7,null,\"x\"]}", NULL, ABBE_NOT_FOUND, "no material transmits"},
      {"{\"materials\":[{\"name\":\"cloth\"}]}", "cloth", ABBE_UNSUPPORTED, "transmits no light"},
      {ONE("1.5", ""), "other", ABBE_NOT_FOUND, "'stone'"},
      {"{\"materials\":[" GLASS("a", "1.5", "") "}}," GLASS("b", "1.6", "") "}}]}", NULL,
       ABBE_NOT_FOUND, "say which as 'part': 'a', 'b'"},
      {"{\"materials\":[" GLASS("a", "1.5", "") "}}," GLASS("a", "1.6", "") "}}]}", "a",
       ABBE_NOT_FOUND, "more than one"},
      {ONE("\"glass\"", ""), NULL, ABBE_SCHEMA, "'ior' is no number"},
      {ONE("-1", ""), NULL, ABBE_SCHEMA, "'ior' is -1"},
      {ONE("1e999", ""), NULL, ABBE_SCHEMA, "'ior'"},
      {ONE("0", ""), NULL, ABBE_UNSUPPORTED, "from 1 on"},
      {ONE("1.5", ",\"thicknessFactor\":\"thick\""), NULL, ABBE_OK, ""}, /* the first counts */
      {ONE("1.5", ",\"attenuationDistance\":0,\"attenuationColor\":[1,1,1]"), NULL, ABBE_SCHEMA,
       "'attenuationDistance' is 0"},
      {ONE("1.5", ",\"attenuationDistance\":1,\"attenuationColor\":[1,1]"), NULL, ABBE_SCHEMA,
       "three numbers"},
      {ONE("1.5", ",\"attenuationDistance\":1,\"attenuationColor\":[1,2,1]"), NULL, ABBE_SCHEMA,
       "three numbers"},
      {ONE("1.5", COLOUR("[\"red\",1,1]")), NULL, ABBE_SCHEMA, "three numbers"},
      {ONE("1.5", COLOUR("[1,-1,1]")), NULL, ABBE_SCHEMA, "three numbers"},
      {"{\"materials\":[{\"extensions\":{" SOLID "{\"thicknessFactor\":\"thick\"}}}]}", NULL,
       ABBE_SCHEMA, "'thicknessFactor' is no number"},
      {"{\"materials\":[{\"name\":\"stone\",\"extensions\":{\"KHR_materials_transmission\":"
       "{\"transmissionFactor\":0}}}]}",
       NULL, ABBE_NOT_FOUND, "no material transmits"},
      {"{\"materials\":[{\"name\":\"cloth\"}," GLASS("stone", "1.5", "") "}}]}", "cloth",
       ABBE_UNSUPPORTED, "those that do: 'stone'"},
      {"{\"materials\":[{\"name\":\"cloth\"}]}", "silk", ABBE_NOT_FOUND,
       "that transmit light: none"},
      {"{\"materials\":[{\"name\":\"film\",\"extensions\":{\"KHR_materials_transmission\":{"
       "\"transmissionFactor\":1}}}]}",
       NULL, ABBE_UNSUPPORTED, "thin wall"},
      {"{\"materials\":[" GLASS("x", "1.5",
                                "") ",\"KHR_materials_dispersion\":{\"dispersion\":-2}}}]}",
       NULL, ABBE_SCHEMA, "'dispersion' is -2"},
      /* so much that no index is left in the red */
      {"{\"materials\":[" GLASS("x", "2.4",
                                "") ",\"KHR_materials_dispersion\":{\"dispersion\":900}}}]}",
       NULL, ABBE_INVALID_ARGUMENT, "x"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    OWNED(abbe_material, m);
    FREED char *name = NULL;
    abbe_error error = {0};
    const abbe_result result = load(rows[i].json, rows[i].part, &m, &name, &error);
    if (result != rows[i].result || strstr(error.text, rows[i].says) == NULL)
      fail_msg("row %zu: %d: %s", i, (int)result, error.text);
  }
  abbe_material m;
  char *name;
  assert_int_equal(abbe_gltf_material_load("stone", NULL, &m, &name, NULL), ABBE_UNSUPPORTED);
  assert_int_equal(abbe_gltf_material_load("stone.obj", NULL, &m, &name, NULL), ABBE_UNSUPPORTED);
  assert_int_equal(abbe_gltf_material_load("/no/such.glb", NULL, &m, &name, NULL), ABBE_IO);
}

/* A colour takes light away over a distance, where it is not white; half rough is rough. */
TEST(colours_over_a_distance) {
  static const struct {
    const char *more;
    double red, green; /* per metre */
  } rows[] = {{",\"attenuationColor\":[0.5,0.5,0.5]", 0, 0},
              {COLOUR("[1,1,1]"), 0, 0},
              {COLOUR("[1,0.5,1]"), 0, 0.69314718},
              {COLOUR("[1,1,0.5]"), 0, 0},
              {COLOUR("[0.25,1,1]"), 1.38629436, 0}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char *name;
    const char *text =
        printed("{\"materials\":[{\"pbrMetallicRoughness\":{\"roughnessFactor\":0.5},"
                "\"extensions\":{" SOLID "{\"thicknessFactor\":1%s}}}]}",
                rows[i].more);
    MADE(abbe_material, m, load(text, NULL, &m, &name, &error));
    assert_near(abbe_material_attenuation(&m, 611.4), rows[i].red, 1e-6);
    assert_near(abbe_material_attenuation(&m, 549.1), rows[i].green, 1e-6);
    assert_true((m.attenuation != NULL) == (i > 1));
    assert_string_equal(m.warning, "glTF's; left out: roughness");
  }
}

/* Of many names those are listed that have room in a sentence. */
TEST(names_that_are_many) {
  static const char name[] = "a-name-of-a-stone-that-is-nearly-fifty-letters-long";
  char text[8192] = "{\"materials\":[";
  for (int i = 0; i < 12; i++)
    snprintf(text + strlen(text), sizeof text - strlen(text),
             "%s{\"name\":\"%s-%d\","
             "\"extensions\":{" SOLID "{}}}",
             i > 0 ? "," : "", name, i);
  strcat(text, "]}");
  abbe_material m;
  char *own;
  REFUSED(ABBE_NOT_FOUND, "'a-name-of-a-stone-that-is-nearly-fifty-letters-long-6'",
          load(text, NULL, &m, &own, &error));
  assert_null(strstr(last_error.text, "long-8"));
}

/* Binary files that end early, or say that they are longer. */
TEST(broken_binaries_are_refused) {
  static const char whole[] = "glTF\2\0\0\0\44\0\0\0\20\0\0\0JSON{\"materials\":[]}";
  static const char path[] = "/tmp/abbe-test-material.glb";
  for (size_t size = 0; size < sizeof whole; size++) {
    abbe_material m;
    char *name;
    OK(abbe_file_write(path, whole, size, &error));
    const abbe_result result = abbe_gltf_material_load(path, NULL, &m, &name, NULL);
    assert_true(result == (size < 36 ? ABBE_PARSE : ABBE_NOT_FOUND) || result == ABBE_IO ||
                result == ABBE_PARSE);
  }
  unlink(path);
}

/* A ball of glass on a floor, as glTF: the ball alone comes back, of the same index and colour. */
TEST(what_is_exported_is_read_again) {
  abbe_scene again;
  char text[1000];
  abbe_error why = {0};
  double a, b;
  abbe_scene scene = scene_of(CAMERA POINT_LIGHT FLOOR BALL("murk"));
  done(written(&scene, ABBE_SCENE_EXPORT_GLTF));
  const char *path = printed("%s/again.yaml", folder);
  snprintf(text, sizeof text, "%s",
           "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR
           "- {name: ball, mesh: it.glb, material: from-file}\n");
  OK(abbe_file_write(path, text, strlen(text), &error));
  OK(abbe_scene_load(path, NULL, &again, &error));
  const abbe_object *ball = &again.object[1];
  assert_string_equal(ball->material->name, "murk");
  for (int k = 0; k < 3; k++) {
    assert_near(ball->min[k], scene.object[1].min[k], 2e-3);
    assert_near(ball->max[k], scene.object[1].max[k], 2e-3);
  }
  for (int nm = 380; nm <= 780; nm += 20) {
    OK(abbe_material_n(ball->material, nm, &a, &error));
    OK(abbe_material_n(scene.object[1].material, nm, &b, &error));
    assert_near(a, b, 1e-9);
  }
  assert_near(abbe_material_attenuation(ball->material, 464.2),
              abbe_material_attenuation(scene.object[1].material, 464.2), 1e-6);
  abbe_scene_free(&again);
  abbe_scene_free(&scene);
  static const char *const wrong[] = {"shape: sphere, radius: 0.1, material: from-file",
                                      "mesh: it.glb, part: nothing, reflectance: 1",
                                      "mesh: it.glb, part: nothing, material: from-file"};
  static const char *const says[] = {"'mesh' of a .gltf or .glb", "called 'nothing'",
                                     "called 'nothing'"};
  for (size_t i = 0; i < 3; i++) {
    snprintf(text, sizeof text,
             "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR
             "- {name: ball, %s}\n",
             wrong[i]);
    OK(abbe_file_write(path, text, strlen(text), &error));
    assert_int_not_equal(abbe_scene_load(path, NULL, &again, &why), ABBE_OK);
    assert_contains(why.text, says[i]);
  }
  clear_folder();
}
