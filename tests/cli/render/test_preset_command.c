/* Settings by name, by error and by time, as people ask for them: what is promised and what is met.
 */
#include "tests/cli/run_json.h"

#define GEM "\"$abbe\" render \"$house\"/scenes/gem.yaml --size 24x24 "
#define POINT(photons, light, error)                                                               \
  "  - {wavelengths: 3, photons: " photons                                                         \
  ", map: 64, samples: 1, fill: bridge, exits: 2, share: 0.1, light_ms: " light                    \
  ", eye_ms: 1, error: " error ", least: 0.5}\\n"
/* Times that no machine is as slow as: what matters is their ratio. */
#define PRESETS                                                                                    \
  "printf 'error: caustic_de\\nwhat: mean error\\nrun: a run\\nclasses:\\n- class: convex\\n"      \
  "  scenes: gem\\n  draft: 0\\n  balanced: 1\\n  accurate: 2\\n  front:\\n" POINT("16", "1", "8") \
      POINT("24", "10", "4") POINT("32", "1e7", "2") "' >p.yaml"

static const cJSON *item(const cJSON *json, const char *key) {
  return json_item(json_item(json, "promise"), key);
}

EACH(run_setup, run_teardown);

TEST(by_name) {
  run_must(PRESETS);
  HELD(cJSON, json) = run_json(GEM "--presets p.yaml --preset balanced --json -q", 0);
  assert_string_equal(cJSON_GetStringValue(item(json, "preset")), "balanced");
  assert_contains(cJSON_GetStringValue(item(json, "settings")), "24 photons, map 64");
  assert_near(cJSON_GetNumberValue(item(json, "error")), 4, 0);
  assert_true(cJSON_GetNumberValue(item(json, "ms")) > 0);
  assert_true(cJSON_GetNumberValue(item(json, "ms_met")) > 0);
  assert_true(cJSON_IsNull(item(json, "error_met")));
  assert_true(cJSON_IsTrue(item(json, "possible")));
  assert_near(cJSON_GetNumberValue(cJSON_GetObjectItemCaseSensitive(json, "wavelengths")), 3, 0);
  cJSON_Delete(json);
  /* Error bars tell it by an estimate, and say so. */
  json = run_json(GEM "--presets p.yaml --preset balanced --json -q --error-bars=2", 0);
  assert_true(cJSON_GetNumberValue(item(json, "error_met")) > 0);
  assert_contains(cJSON_GetStringValue(item(json, "error_met_is")), "estimate");
  cJSON_Delete(json);
  /* One's own option stays, and the promise is void. */
  json = run_json(GEM "--presets p.yaml --preset draft --wavelengths 5 --json", 0);
  assert_near(cJSON_GetNumberValue(cJSON_GetObjectItemCaseSensitive(json, "wavelengths")), 5, 0);
  assert_true(cJSON_IsTrue(item(json, "overridden")));
  assert_contains(run_errors, "what it promises is void");
  cJSON_Delete(json);
  /* The shipped ones, and none at all. */
  json = run_json(GEM "--preset draft --json -q", 0);
  assert_string_equal(cJSON_GetStringValue(item(json, "class")), "convex");
  rerun_json(&json, GEM "--photons 16 --map 64 --json -q", 0);
  assert_null(cJSON_GetObjectItemCaseSensitive(json, "promise"));
}

TEST(by_error_and_by_time) {
  run_must(PRESETS);
  HELD(cJSON, json) = run_json(GEM "--presets p.yaml --max-error 5 --json -q", 0);
  assert_near(cJSON_GetNumberValue(item(json, "error")), 4, 0);
  assert_true(cJSON_IsTrue(item(json, "possible")));
  rerun_json(&json, GEM "--presets p.yaml --max-error 1 --json --png a.png", 3);
  assert_near(cJSON_GetNumberValue(item(json, "error")), 2, 0);
  assert_true(cJSON_IsFalse(item(json, "possible")));
  assert_contains(run_errors, "no settings are known to keep 1; these are the most accurate");
  assert_contains(run_errors,
                  "no settings are known to keep an error of 1; the most accurate ones");
  run_must("test -s a.png && rm a.png");
  cJSON_Delete(json);
  /* The third would take ten million times the first's time. */
  json = run_json(GEM "--presets p.yaml --budget-ms 100000 --json -q", 0);
  assert_near(cJSON_GetNumberValue(item(json, "error")), 4, 0);
  assert_true(cJSON_IsTrue(item(json, "possible")));
  assert_true(cJSON_IsTrue(item(json, "budget_met")));
  rerun_json(&json, GEM "--presets p.yaml --budget-ms 0.001 --json -q --png a.png", 3);
  assert_true(cJSON_IsFalse(item(json, "possible")));
  assert_true(cJSON_IsFalse(item(json, "budget_met")));
  assert_contains(run_errors,
                  "the budget of 0.001 ms is not kept, for no faster settings are known");
  run_must("test -s a.png && rm a.png");
  run_fails(GEM "--presets p.yaml --budget-ms 0.001 --png a.png && rm a.png", 3,
            "these are the fastest");
}

TEST(what_is_refused) {
  static const struct {
    const char *line, *part;
    int code;
  } wrong[] = {
      {GEM "--json --preset drift", "did you mean 'draft'?", 2},
      {GEM "--json --preset draft --budget-ms 9", "one of them", 2},
      {GEM "--json --max-error 0", "--max-error '0' is not a number", 2},
      {GEM "--json --preset draft --profile thesis", "a published method has none", 2},
      {GEM "--json --preset draft --presets no.yaml", "no.yaml", 1},
      {GEM "--json --presets draft", "--presets 'draft' is a file for --preset,", 2},
  };
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    assert_true(run_refuses(wrong[i].line, wrong[i].code, wrong[i].part));
}

/* A file that knows whole pictures too: the tracer is far nearer to what it promises than anything
 * could be, and the renderer is taken where it alone can serve. */
#define PICTURES                                                                                   \
  "printf 'error: caustic_de\\nwhat: mean error\\nrun: a run\\nclasses:\\n- class: convex\\n"      \
  "  scenes: gem\\n  front:\\n" POINT(                                                             \
      "16", "1",                                                                                   \
      "8") "  pictures:\\n    base_ms: 1e-3\\n    base_error: 1\\n    render:\\n      front:\\n"   \
           "      - {photons: 16, wavelengths: 3, map: 64, samples: 1, upsample: 1, fill: "        \
           "bridge,\\n"                                                                            \
           "         exits: 8, share: 0.01, model: auto, ms: 1, error: 8, least: 0.5}\\n"          \
           "    trace:\\n      front:\\n"                                                          \
           "      - {photons: 64, passes: 4, ms: 2, error: 1e-6, least: 1e-6}\\n' >q.yaml"

/* With a time, passes tell the error where time is left, and else it is said to be expected. An age
 * is left here, or nothing. */
TEST(what_a_budget_tells) {
  run_must(PICTURES);
  run_must("sed 's/    trace:/    trace-filter:/' q.yaml >f.yaml");
  static const struct {
    const char *line, *met;
  } told[] = {
      {GEM "--presets q.yaml --budget-ms 1e6 --json --tool trace", "half of its passes"},
      {GEM "--presets f.yaml --budget-ms 1e6 --json --tool trace-filter", "by traced passes"},
      {GEM "--presets q.yaml --budget-ms 1e6 --json --tool render", "by traced passes"},
  };
  for (size_t i = 0; i < sizeof told / sizeof *told; i++) {
    HELD(cJSON, json) = run_json(told[i].line, 0);
    assert_true(cJSON_IsTrue(item(json, "checked")) && cJSON_IsTrue(item(json, "budget_met")));
    assert_contains(cJSON_GetStringValue(item(json, "error_met_is")), told[i].met);
    assert_contains(cJSON_GetStringValue(item(json, "error_is")), "told by");
    assert_true(cJSON_GetNumberValue(item(json, "passes")) >= 2);
    assert_true(cJSON_GetNumberValue(item(json, "error_at_most")) >=
                cJSON_GetNumberValue(item(json, "error_met")));
    assert_contains(run_errors, "in the caustic is expected, by what was measured on gem");
    assert_contains(run_errors, "note: the error is about");
  }
  HELD(cJSON, json) = run_json(GEM "--presets q.yaml --budget-ms 1 --json --tool render", 3);
  assert_true(cJSON_IsFalse(item(json, "checked")) && cJSON_IsNull(item(json, "error_met")));
  assert_contains(cJSON_GetStringValue(item(json, "error_is")),
                  "expected (not checked: the budget left no time for it)");
  assert_contains(run_errors, "note: the error is 8, expected (not checked");
  rerun_json(&json, GEM "--presets q.yaml --preset draft --json --tool render", 0);
  assert_contains(cJSON_GetStringValue(item(json, "error_is")), "no passes were traced for that");
  run_must("rm q.yaml f.yaml");
}

TEST(what_makes_the_picture) {
  run_must(PICTURES);
  HELD(cJSON, json) =
      run_json(GEM "--presets q.yaml --max-error 12 --tool trace --json -o a.exr", 0);
  assert_string_equal(cJSON_GetStringValue(item(json, "for")), "picture");
  assert_string_equal(cJSON_GetStringValue(item(json, "tool")), "trace");
  assert_contains(cJSON_GetStringValue(item(json, "settings")), "4 passes of 4096 photons");
  assert_true(cJSON_GetNumberValue(item(json, "error_met")) > 0);
  assert_contains(cJSON_GetStringValue(item(json, "error_met_is")), "half of its passes");
  assert_true(cJSON_GetNumberValue(item(json, "ms_met")) > 0);
  assert_contains(run_errors, "note: the tracer: 4 passes of 4096 photons");
  assert_near(cJSON_GetNumberValue(item(json, "passes")), 4, 0);
  assert_true(cJSON_IsTrue(item(json, "error_kept")));
  const double at_most = cJSON_GetNumberValue(item(json, "error_at_most"));
  assert_true(at_most > cJSON_GetNumberValue(item(json, "error_met")) && at_most <= 12);
  cJSON_Delete(json);
  /* Its own passes tell that the file promises too much: it goes on, or gives up and says so. */
  json = run_json(GEM "--presets q.yaml --max-error 6 --tool trace --json", 0);
  assert_true(cJSON_GetNumberValue(item(json, "passes")) > 4);
  assert_true(cJSON_GetNumberValue(item(json, "error_at_most")) <= 6);
  assert_contains(run_errors, "; 4 were too few for what is asked");
  rerun_json(&json, GEM "--presets q.yaml --max-error 0.5 --tool trace --json", 3);
  assert_true(cJSON_IsFalse(item(json, "error_kept")));
  assert_contains(run_errors, "half against half; expected were");
  assert_contains(run_errors, "that is more, for this scene's light is of another kind");
  assert_contains(run_errors, "an error of 0.5 is not known to be kept: 4 passes tell one of");
  cJSON_Delete(json);
  run_says("\"$abbe\" info a.exr && rm a.exr", "stderr.R");
  json = run_json(GEM "--presets q.yaml --max-error 30 --json --tool render -q", 0);
  assert_string_equal(cJSON_GetStringValue(item(json, "tool")), "render");
  assert_true(cJSON_IsFalse(item(json, "overridden")));
  assert_true(cJSON_IsTrue(item(json, "error_kept")));
  assert_true(cJSON_GetNumberValue(item(json, "passes")) >= 2);
  assert_contains(cJSON_GetStringValue(item(json, "error_met_is")), "by traced passes");
  cJSON_Delete(json);
  /* A file that promises too much of the renderer: its picture is found out, and the passes that do
   * so are taken instead, unless the renderer was asked for. */
  assert_int_equal(
      run_line(
          "sed 's/error: 8, least: 0.5/error: 0.1, least: 0.1/; s/ms: 2,/ms: 9,/' q.yaml >r.yaml"),
      0);
  json = run_json(GEM "--presets r.yaml --max-error 3 --json -o a.exr", 0);
  assert_string_equal(cJSON_GetStringValue(item(json, "tool")), "render");
  assert_true(cJSON_IsTrue(item(json, "traced_instead")));
  assert_true(cJSON_IsTrue(item(json, "error_kept")));
  assert_contains(run_errors, "of what they made; it is taken");
  cJSON_Delete(json);
  run_says("\"$abbe\" info a.exr && rm a.exr", "stderr.R");
  json = run_json(GEM "--presets r.yaml --max-error 3 --json --tool render", 3);
  assert_true(cJSON_IsFalse(item(json, "traced_instead")));
  assert_true(cJSON_IsFalse(item(json, "error_kept")));
  assert_contains(run_errors, "against which the picture is held; expected were 0.1");
  assert_contains(run_errors, "an error of 3 is not known to be kept");
  rerun_json(&json, GEM "--presets q.yaml --preset accurate --json --samples 1", 0);
  assert_string_equal(cJSON_GetStringValue(item(json, "tool")), "render");
  assert_contains(run_errors, "options of the renderer are given, so the tracer is not");
  rerun_json(&json, GEM "--presets q.yaml --budget-ms 1 --json -q", 3);
  assert_true(cJSON_IsFalse(item(json, "budget_met")));
  assert_contains(run_errors, "the budget of 1 ms is not kept, for nothing faster is known");
  rerun_json(&json, GEM "--presets q.yaml --max-error 9 --for frame --json -q", 0);
  assert_null(
      cJSON_GetObjectItemCaseSensitive(cJSON_GetObjectItemCaseSensitive(json, "promise"), "for"));
  run_must("rm q.yaml r.yaml");
  static const struct {
    const char *line, *part;
    int code;
  } wrong[] = {
      {GEM "--json --max-error 9 --tool trace --aovs", "--aovs is for the renderer alone", 2},
      {GEM "--json --max-error 9 --tool tracer", "did you mean 'trace'?", 2},
      {GEM "--json --tool trace", "--for and --tool go with --preset", 2},
      {GEM "--json --max-error 9 --tool trace --for frame", "makes no frames", 2},
  };
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    assert_true(run_refuses(wrong[i].line, wrong[i].code, wrong[i].part));
}

/* Presets of a small sweep of its own, and a sweep that holds the shipped ones to their word. */
TEST(presets_of_a_sweep) {
  int code = run_line(
      "\"$abbe\" sweep \"$house\"/scenes/gem.yaml -q --size 24x24 --frames 1 --spp 2 "
      "--traced-photons 20000 --texels 16 --map 64 --samples 1 --wavelengths 3 --photons 16,32 "
      "--profiles default -o s.csv && \"$abbe\" sweep s.csv --write-presets p.yaml && cat p.yaml");
  if (code != 0) fail_msg("%s", run_errors);
  assert_contains(
      run_output,
      "- class: convex\n  scenes: gem\n  margin: 1\n  time_margin: 1\n  margin_scenes: 0\n");
  HELD(cJSON, json) = run_json(GEM "--presets p.yaml --preset draft --json -q", 0);
  assert_contains(cJSON_GetStringValue(item(json, "run")), "24x24; medians of 1 frames");
  /* None of its settings is finer than the defaults. */
  run_fails(GEM "--presets p.yaml --preset accurate --json", 1,
            "there is no 'accurate' for scenes of the class convex in p.yaml");
  assert_true(run_line("rm s.csv s-reference*.exr p.yaml") == 0);
  assert_true(run_refuses("\"$abbe\" sweep a.yaml -o s.csv --write-presets p.yaml", 2,
                          "--write-presets reads tables"));
}
