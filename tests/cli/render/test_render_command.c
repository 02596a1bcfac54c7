/* `abbe render` and `abbe plan` as people and programs meet them: files, JSON, Ctrl-C. */
#include "tests/cli/run_json.h"

#include "colorimetry/image/exr.h"

#include <fcntl.h>
#include <signal.h>

#define SMALL " --size 32x24 --photons 32 --map 64"
#define GEM "\"$abbe\" render \"$house\"/scenes/gem.yaml" SMALL

static void assert_statistics(const char *text) {
  HELD(cJSON, json) = cJSON_Parse(text);
  assert_non_null(json);
  assert_true(json_number(json, "frame_ms") > 0);
  assert_near(json_number(json, "wavelengths"), 7, 0);
  double photons = json_number(json, "photons");
  assert_true(photons > 0 && photons <= 32 * 32);
  const cJSON *passes = cJSON_GetObjectItemCaseSensitive(json, "passes"), *pass;
  assert_true(cJSON_GetArraySize(passes) >= 4);
  cJSON_ArrayForEach(pass, passes) {
    assert_true(cJSON_IsString(cJSON_GetObjectItemCaseSensitive(pass, "name")));
    assert_true(json_number(pass, "ms") >= 0);
  }
  const cJSON *energy = cJSON_GetObjectItemCaseSensitive(json, "energy");
  static const char *const parts[] = {"reflected", "absorbed", "trapped", "missed", "deposited"};
  double sum = 0, reached = json_number(energy, "reached");
  for (size_t i = 0; i < 5; i++) sum += json_number(energy, parts[i]);
  sum -= json_number(energy, "interpolated");
  assert_true(reached > 0);
  /* The balance that is promised, from the numbers as they are told. */
  assert_near(sum / reached, 1, 1e-4);
  assert_true(json_number(energy, "imbalance") < 1e-4);
}

GROUP(run_setup, run_teardown);

TEST(statistics_as_json) {
  run_must(GEM " --stats stats.json && cat stats.json && rm stats.json");
  assert_statistics(run_output);
  run_must(GEM " --stats -"); /* as --json */
  assert_statistics(run_output);
  run_must(GEM " --json --frames 3");
  assert_statistics(run_output);
  assert_int_equal(run_left(), 0);
}

TEST(the_plan_as_json) {
  HELD(cJSON, json) = run_json("\"$abbe\" plan \"$house\"/scenes/gem.yaml --json", 0);
  const cJSON *plan = cJSON_GetObjectItemCaseSensitive(json, "plan"), *entry;
  assert_true(cJSON_GetArraySize(plan) > 10);
  cJSON_ArrayForEach(entry, plan) {
    assert_true(cJSON_IsString(cJSON_GetObjectItemCaseSensitive(entry, "name")));
    assert_true(cJSON_IsBool(cJSON_GetObjectItemCaseSensitive(entry, "runs")));
    assert_true(cJSON_IsString(cJSON_GetObjectItemCaseSensitive(entry, "reason")));
  }
  assert_near(json_number(json, "wavelengths"), 7, 0);
  const cJSON *objects = cJSON_GetObjectItemCaseSensitive(json, "objects"), *gem = NULL, *one;
  cJSON_ArrayForEach(one, objects) {
    if (strcmp(cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(one, "name")), "gem") == 0)
      gem = one;
  }
  assert_non_null(gem);
  const cJSON *max = cJSON_GetObjectItemCaseSensitive(gem, "max");
  assert_int_equal(cJSON_GetArraySize(max), 3);
  assert_true(cJSON_GetNumberValue(cJSON_GetArrayItem(max, 0)) > 0.01);
  assert_string_equal(cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(gem, "material")),
                      "n-sf11");
  run_says("\"$abbe\" plan \"$house\"/scenes/gem.yaml",
           "What runs, and the fact that asks for it:");
  assert_contains(run_output, "What is there, with its size and the middle of its bounds, m:");
  assert_contains(run_output, "What does not run:");
}

TEST(pictures_are_written) {
  run_must(GEM " -o a.exr --png a.png --save-map map.exr --bits 16");
  assert_string_equal(run_output, "");
  MADE(abbe_image, image, abbe_exr_read(printed("%s/a.exr", run_folder), &image, &error));
  assert_int_equal(image.width, 32);
  assert_int_equal(image.height, 24);
  assert_string_equal(abbe_image_attribute_text(&image, "abbe:space"), "acescg");
  assert_contains(abbe_image_attribute_text(&image, "abbe:settings"), "7 wavelengths 380:780 nm");
  assert_contains(abbe_image_attribute_text(&image, "abbe:scene"), "gem.yaml");
  abbe_image_free(&image);
  OK(abbe_exr_read(printed("%s/map.exr", run_folder), &image, &error));
  assert_int_equal(image.width, 64);
  assert_true(abbe_image_find_channel(&image, "Y") != (size_t)-1);
  /* The same request gives the same bytes. */
  run_must(GEM " -q -o b.exr --png b.png --bits 16 && cmp a.png b.png && cmp a.exr b.exr && rm "
               "a.exr a.png b.exr b.png map.exr");
  assert_string_equal(run_errors, "");
  assert_int_equal(run_left(), 0);
}

TEST(a_map_like_another) {
  run_must(GEM " -q --save-map a.exr && \"$abbe\" render \"$house\"/scenes/gem.yaml --size 32x24 "
               "--photons 32 -q --map-like a.exr --save-map b.exr && cmp a.exr b.exr");
  /* Finer, in the same window; and the light by its name or number. */
  run_says(
      GEM
      "0 -q --map-like a.exr --map-light 1 --save-map b.exr && \"$abbe\" info b.exr && rm b.exr",
      "640 x 640 pixels");
  assert_contains(run_output, "abbe:map_light: lamp");
  run_fails(GEM " --map-like a.exr --map-light moon --save-map b.exr", 2,
            "no light is called 'moon'; its lights are 1 'lamp'");
  run_fails("\"$abbe\" render \"$house\"/scenes/sphere.yaml" SMALL
            " --map-like a.exr --save-map b.exr",
            2, "for a light in another place than 'lamp'");
  run_fails("\"$abbe\" render \"$house\"/scenes/sphere.yaml" SMALL
            " --profile thesis --map-like a.exr --save-map b.exr",
            2, "thesis");
  run_fails("rm a.exr; " GEM " -q -o a.exr && " GEM " --map-like a.exr --save-map b.exr", 1,
            "a.exr: there is no attribute abbe:map_view");
  run_fails("rm a.exr; " GEM " --map-like a.exr --save-map b.exr", 1, "a.exr");
  assert_int_equal(run_left(), 0);
}

TEST(error_bars) {
  HELD(cJSON, json) =
      run_json(GEM " -o a.exr --error-bars=2 --error-png e.png --json && test -s e.png", 0);
  const cJSON *bars = cJSON_GetObjectItemCaseSensitive(json, "error_bars");
  const cJSON *caustic = cJSON_GetObjectItemCaseSensitive(bars, "caustic");
  assert_near(json_number(bars, "variants"), 2, 0);
  assert_near(json_number(bars, "frames"), 3, 0);
  assert_true(json_number(bars, "ms") > 0);
  assert_true(json_number(caustic, "relative_rmse") > 0);
  assert_true(json_number(caustic, "ciede2000_mean") > 0);
  MADE(abbe_image, image, abbe_exr_read(run_path("a.exr"), &image, &error));
  assert_int_equal(image.channels, 6);
  assert_true(abbe_image_find_channel(&image, "stderr.G") != (size_t)-1);
  assert_contains(abbe_image_attribute_text(&image, "abbe:stderr"), "what is not modelled");
  /* The errors leave the picture alone; the mean is another. */
  run_must(GEM " -q --png b.png && " GEM " -q --png c.png --error-bars=2 && cmp b.png c.png");
  run_must(GEM " -q --png c.png --error-bars=2 --mean && ! cmp -s b.png c.png");
  run_must("rm a.exr e.png b.png c.png");
  static const struct {
    const char *line, *says;
  } refused[] = {
      {GEM " -o a.exr --mean", "--mean goes with --error-bars"},
      {GEM " --error-png e.png", "--error-png goes with --error-bars"},
      {GEM " -o a.exr --error-bars=1", "--error-bars"},
      {GEM " -o a.exr --error-bars --mean --aovs", "--mean has no --aovs"},
      {GEM " -o a.exr --error-bars --profile thesis", "'thesis' has no error bars"},
  };
  for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
    run_fails(refused[i].line, 2, refused[i].says);
  assert_int_equal(run_left(), 0);
}

TEST(every_command_has_help) {
  static const char *const commands[] = {"render",  "plan", "weights", "materials",
                                         "display", "info", "compare"};
  run_must("\"$abbe\" help");
  for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
    run_says("\"$abbe\" help", commands[i]);
    run_says(printed("\"$abbe\" help %s", commands[i]), "Examples:");
    run_says(printed("\"$abbe\" %s --help", commands[i]), "Examples:");
  }
  run_says("\"$abbe\" --version", "abbe ");
}

/* A render whose picture takes many seconds, its stderr on fd. */
static pid_t start_long_render(int fd) {
  pid_t child = fork();
  assert_true(child >= 0);
  if (child > 0) return child;
  if (chdir(run_folder) != 0 || dup2(fd, STDERR_FILENO) < 0) _exit(99);
  execl(ABBE_PROGRAM, "abbe", "render", ABBE_SOURCE_DIR "/scenes/diamond.yaml", "--photons", "64",
        "--wavelengths", "100", "--size", "2048x2048", "--preset", "accurate", "-o", "picture.exr",
        "--png", "picture.png", (char *)NULL);
  _exit(99);
}

/* The note on the preset is printed when the frame is about to begin. */
TEST(ctrl_c_stops_cleanly) {
  int pipes[2], status = 0;
  assert_int_equal(pipe(pipes), 0);
  pid_t child = start_long_render(pipes[1]);
  close(pipes[1]);
  size_t used = 0;
  ssize_t got = read(pipes[0], run_errors, sizeof run_errors - 1);
  assert_true(got > 0);
  used = (size_t)got;
  assert_int_equal(kill(child, SIGINT), 0);
  while ((got = read(pipes[0], run_errors + used, sizeof run_errors - 1 - used)) > 0)
    used += (size_t)got;
  run_errors[used] = '\0';
  close(pipes[0]);
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_true(WIFEXITED(status));
  assert_int_equal(WEXITSTATUS(status), 1);
  assert_contains(run_errors, "cancelled");
  assert_int_equal(run_left(), 0);
}
