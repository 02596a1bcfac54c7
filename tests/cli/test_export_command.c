/* `abbe export` as people and programs meet it: the file, what is said of materials, refusals. */
#include "tests/cli/run_json.h"

GROUP(run_setup, run_teardown);

TEST(a_scene_is_exported) {
  run_must("\"$abbe\" export \"$house\"/scenes/prism.yaml -o p.pov && grep -c 'mesh2 {' p.pov");
  assert_string_equal(run_output, "7\n"); /* the prism, four jaws, floor and wall */
  assert_contains(run_errors, "sf10: ior 1.73");
  run_must("\"$abbe\" export \"$house\"/scenes/prism.yaml -o q.pov -q && cmp p.pov q.pov && rm "
           "p.pov q.pov");
  assert_string_equal(run_errors, "");
  assert_int_equal(run_left(), 0);
}

TEST(what_povray_does_not_get_is_said) {
  run_must("\"$abbe\" export \"$house\"/scenes/sphere.yaml -o s.pov --set 'camera.polariser={}' "
           "--set 'objects.ball.clouds=[{radius: 0.01}]' && ! grep cloud s.pov && rm s.pov");
  assert_contains(run_errors, "camera: its polariser is left out");
  assert_contains(run_errors, "ball (cloud 1): it is left out");
}

TEST(materials_as_json) {
  HELD(cJSON, json) = run_json(
      "\"$abbe\" export \"$house\"/scenes/sphere.yaml -o s.pov --json --photons 5000 --samples 15 "
      "&& grep -q 'Photons = 5000' s.pov && grep -q 'Samples = 15' s.pov && rm s.pov",
      0);
  const cJSON *list = cJSON_GetObjectItemCaseSensitive(json, "materials");
  assert_int_equal(cJSON_GetArraySize(list), 1);
  const cJSON *glass = cJSON_GetArrayItem(list, 0);
  assert_string_equal(cJSON_GetObjectItemCaseSensitive(glass, "name")->valuestring, "fused-silica");
  /* n is 1.4599 at 555 nm and 1.4725 at 380, 1.4546 at 730 [Malitson1965]; the fit is between */
  assert_near(cJSON_GetObjectItemCaseSensitive(glass, "ior")->valuedouble, 1.4599, 5e-4);
  const double dispersion = cJSON_GetObjectItemCaseSensitive(glass, "dispersion")->valuedouble;
  assert_true(dispersion > 1.008 && dispersion < 1.4725 / 1.4546 + 0.001);
  assert_near(cJSON_GetObjectItemCaseSensitive(json, "units_per_metre")->valuedouble, 100, 0);
  assert_int_equal(run_left(), 0);
}

/* The format by the file's ending or by --to; the same report for people and for programs. */
TEST(other_programs) {
  static const struct {
    const char *to, *file, *says;
  } rows[] = {{"", "p.pbrt", "sf10: n as 'table'"},
              {"--to gltf", "p.glb", "sf10: n as 'abbe'"},
              {"--to blender", "p.py", "n as 'three'"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    run_must(printed("\"$abbe\" export \"$house\"/scenes/prism.yaml %s -o %s", rows[i].to,
                     rows[i].file));
    assert_string_equal(run_output, "");
    assert_contains(run_errors, rows[i].says);
    run_line(printed("\"$abbe\" export \"$house\"/scenes/prism.yaml %s -o %s --json && rm p.* p-*",
                     rows[i].to, rows[i].file));
    HELD(cJSON, json) = cJSON_Parse(run_output);
    assert_non_null(json);
    const cJSON *glass = cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(json, "materials"), 0);
    assert_string_equal(cJSON_GetObjectItemCaseSensitive(glass, "name")->valuestring, "sf10");
    const double worst = cJSON_GetObjectItemCaseSensitive(glass, "worst")->valuedouble;
    assert_true(worst > 0 && worst >= cJSON_GetObjectItemCaseSensitive(glass, "rms")->valuedouble);
    run_must("rm -f p.* p-*");
  }
  assert_int_equal(run_left(), 0);
}

TEST(wrong_use_ends_with_2) {
  static const struct {
    const char *line;
    int code;
    const char *part;
  } rows[] = {
      {"\"$abbe\" export", 2, "which scene?"},
      {"\"$abbe\" export \"$house\"/scenes/gem.yaml", 2, "-o FILE.pbrt"},
      {"\"$abbe\" export \"$house\"/scenes/gem.yaml -o x.pov --samples 1", 2, "--samples"},
      {"\"$abbe\" export \"$house\"/scenes/gem.yaml -o x.pov --photons 0", 2, "--photons"},
      {"\"$abbe\" export \"$house\"/scenes/gem.yaml -o x.obj", 2, ".obj"},
      {"\"$abbe\" export \"$house\"/scenes/gem.yaml -o x.pbrt --to maya", 2, "not 'maya'"},
      {"\"$abbe\" export \"$house\"/scenes/gem.yaml -o x.pbrt --samples 9", 2, "POV-Ray's"},
      {"\"$abbe\" export \"$house\"/scenes/gem.yaml -o no/x.py", 1, "no/x.py"},
      {"\"$abbe\" export \"$house\"/tests/bad/scene_no_light.yaml -o x.pov", 1, "has no light"},
      {"\"$abbe\" export \"$house\"/scenes/gem.yaml -o missing/x.pov", 1, "missing/x.pov"},
      {"\"$abbe\" export missing.yaml -o x.pov", 1, "missing.yaml"},
      {"\"$abbe\" export \"$house\"/scenes/gem.yaml -o x.pov --set camera.fob=3", 1, "fob"},
  };
  int wrong = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    wrong += !run_refuses(rows[i].line, rows[i].code, rows[i].part);
  assert_int_equal(wrong, 0);
}
