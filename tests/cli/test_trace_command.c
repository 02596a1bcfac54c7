/* `abbe trace` as people and programs meet it: files, sentences, exit codes, stops and kills. */
#include "tests/cli/run_json.h"

#include "colorimetry/image/exr.h"

#include <signal.h>

#define TRACE "\"$abbe\" trace "
/* A picture in a tenth of a second. */
#define SMALL " --size 16x12 --photons 4000 --map 16 --threads 1 -q "
#define BALL "\"$house/scenes/sphere.yaml\" "

/* In the background until it has a checkpoint, whatever time that takes; $p is its number. */
#define AFTER_A_PASS " & p=$!; while [ ! -e a.exr.checkpoint ] && kill -0 $p; do sleep 0.02; done; "

static void read_image(const char *name, abbe_image *image) {
  OK(abbe_exr_read(run_path(name), image, &error));
}

static bool there(const char *name) {
  return access(run_path(name), F_OK) == 0;
}

static void check_run(const char *line, int code) {
  int got = run_line(line);
  if (got != code) fail_msg("%s ends with %d: %s", line, got, run_errors);
}

static bool same_pixels(const char *a, const char *b) {
  FILLED(abbe_image, x, read_image(a, &x));
  FILLED(abbe_image, y, read_image(b, &y));
  return x.width == y.width && x.height == y.height && x.channels == y.channels &&
         memcmp(x.data, y.data, x.width * x.height * x.channels * sizeof *x.data) == 0;
}

EACH(run_setup, run_teardown);

TEST(outputs) {
  check_run(TRACE BALL SMALL "--spp 2 -o a.exr --png a.png --save-map m.exr --stats s.json", 0);
  assert_string_equal(run_output, "");
  assert_string_equal(run_errors, "");
  assert_true(there("a.png") && !there("a.exr.checkpoint"));
  FILLED(abbe_image, image, read_image("a.exr", &image));
  assert_int_equal(image.width, 16);
  assert_int_equal(image.height, 12);
  static const char *const names[] = {"R",        "G",         "B",         "stderr.R", "stderr.G",
                                      "stderr.B", "caustic.R", "caustic.G", "caustic.B"};
  assert_int_equal(image.channels, 9);
  for (int i = 0; i < 9; i++) assert_true(abbe_image_find_channel(&image, names[i]) < 9);
  assert_string_equal(abbe_image_attribute_text(&image, "abbe:kind"), "picture");
  assert_string_equal(abbe_image_attribute_text(&image, "abbe:passes"), "2");
  abbe_image_free(&image);
  read_image("m.exr", &image);
  assert_int_equal(image.width, 16);
  assert_true(abbe_image_find_channel(&image, "stderr.Y") < image.channels);
  assert_non_null(abbe_image_attribute_text(&image, "abbe:map_view"));
}

TEST(numbers) {
  HELD(cJSON, json) = run_json(TRACE BALL SMALL "--spp 3 --json", 0);
  assert_near(json_number(json, "passes"), 3, 0);
  assert_near(json_number(json, "photons"), 3 * 4000, 0);
  assert_true(json_number(json, "relative_error") > 0);
  const cJSON *energy = cJSON_GetObjectItemCaseSensitive(json, "energy");
  double sum = json_number(energy, "deposited") + json_number(energy, "absorbed") +
               json_number(energy, "missed") + json_number(energy, "trapped") +
               json_number(energy, "lost");
  assert_near(sum / json_number(energy, "reached"), 1, 1e-4);
  assert_true(run_left() == 0);
}

/* Bands by the names of the spectral layout, which OpenEXR's own tool reads, where it is there. */
TEST(bands) {
  check_run(TRACE BALL SMALL "--spp 2 --bands 4 -o a.exr --save-map m.exr", 0);
  abbe_image image;
  for (int i = 0; i < 2; i++) {
    read_image(i ? "m.exr" : "a.exr", &image);
    assert_true(abbe_image_find_channel(&image, "S0.430,000000nm") < image.channels);
    assert_true(abbe_image_find_channel(&image, "stderr.S0.730,000000nm") < image.channels);
    assert_non_null(abbe_image_attribute_text(&image, "emissiveUnits"));
    abbe_image_free(&image);
  }
  if (run_line("command -v exrinfo") != 0) return;
  run_line("exrinfo -v a.exr"); /* its status is random in OpenEXR 3.1.5 */
  assert_contains(run_output, "S0.430,000000nm");
  assert_contains(run_output, "emissiveUnits");
}

/* Same seed, same bytes of pixels, however many threads; the seed is told apart. */
TEST(seeds_and_threads) {
  check_run(TRACE BALL SMALL "--spp 2 -o one.exr", 0);
  check_run(TRACE BALL SMALL "--spp 2 -o two.exr --threads 2", 0);
  check_run(TRACE BALL SMALL "--spp 2 -o other.exr --seed 1", 0);
  assert_true(same_pixels("one.exr", "two.exr"));
  assert_false(same_pixels("one.exr", "other.exr"));
}

TEST(resume) {
  check_run(TRACE BALL SMALL "--spp 5 -o whole.exr --save-map whole-map.exr", 0);
  check_run(TRACE BALL SMALL "--spp 2 -o a.exr --save-map a-map.exr --checkpoint run.c", 0);
  assert_true(there("run.c"));
  check_run(TRACE BALL SMALL "--spp 5 -o a.exr --save-map a-map.exr --checkpoint run.c --resume",
            0);
  assert_true(same_pixels("whole.exr", "a.exr"));
  assert_true(same_pixels("whole-map.exr", "a-map.exr"));
  /* there is nothing to take up: a resumed run starts anew */
  check_run(TRACE BALL SMALL "--spp 2 -o b.exr --resume", 0);
  /* more is done than is asked for: no image of 3 passes comes of that */
  check_run(TRACE BALL SMALL "--spp 3 -o c.exr --save-map c-map.exr --checkpoint run.c --resume",
            1);
  assert_contains(run_errors, "5 passes");
  assert_false(there("c.exr"));
  /* another seed, another scene: refused, and nothing is lost */
  check_run(TRACE BALL SMALL
            "--spp 5 -o a.exr --save-map a-map.exr --checkpoint run.c --resume --seed 2",
            1);
  assert_contains(run_errors, "seed 2");
  check_run(TRACE "\"$house/scenes/gem.yaml\"" SMALL
                  "--spp 5 -o a.exr --save-map a-map.exr --checkpoint run.c --resume",
            1);
  assert_contains(run_errors, "another scene");
  assert_true(there("run.c") && same_pixels("whole.exr", "a.exr"));
}

/* Ctrl-C: what is done is saved, the exit code says that it is not all, and --resume goes on. */
TEST(interrupt) {
  check_run(TRACE BALL SMALL
            "--spp 1000000 -o a.exr --save-map m.exr --checkpoint-every 0" AFTER_A_PASS
            "kill -INT $p; wait $p",
            1);
  assert_contains(run_errors, "stopped after");
  assert_contains(run_errors, "--resume");
  assert_true(there("a.exr") && there("m.exr") && there("a.exr.checkpoint"));
  FILLED(abbe_image, image, read_image("a.exr", &image));
  long passes = strtol(abbe_image_attribute_text(&image, "abbe:passes"), NULL, 10);
  assert_true(passes >= 1);
  check_run(printed(TRACE BALL SMALL
                    "--spp %ld -o a.exr --save-map m.exr --resume && " TRACE BALL SMALL
                    "--spp %ld -o whole.exr --save-map whole-map.exr",
                    passes + 1, passes + 1),
            0);
  assert_true(same_pixels("whole.exr", "a.exr"));
  assert_true(same_pixels("whole-map.exr", "m.exr"));
  assert_false(there("a.exr.checkpoint"));
}

/* A kill loses at most what came after the last checkpoint, which is whole. */
TEST(kill) {
  check_run(TRACE BALL SMALL "--spp 1000000 -o a.exr --checkpoint-every 0.01" AFTER_A_PASS
                             "kill -KILL $p; wait $p; true",
            0);
  assert_true(there("a.exr.checkpoint") && !there("a.exr"));
  check_run(TRACE BALL SMALL "--spp 1000000 --time 0.01 -o a.exr --resume", 0);
  FILLED(abbe_image, image, read_image("a.exr", &image));
  assert_true(strtol(abbe_image_attribute_text(&image, "abbe:passes"), NULL, 10) >= 2);
}

TEST(stops) {
  HELD(cJSON, json) = run_json(TRACE BALL SMALL "--until-error 0.9 -o a.exr --json", 0);
  assert_true(json_number(json, "relative_error") <= 0.9 && json_number(json, "passes") >= 4);
  rerun_json(&json, TRACE BALL SMALL "--time 0.2 -o a.exr --json", 0);
  assert_true(json_number(json, "passes") >= 2);
}

TEST(used_wrongly) {
  static const struct {
    const char *line, *part;
  } lines[] = {{TRACE BALL "-o a.exr --spp 0", "--spp"},
               {TRACE BALL "-o a.exr --spp 1000000000000", "--spp"},
               {TRACE BALL "-o a.exr --spp -3", "--spp"},
               {TRACE BALL "-o a.exr --spp many", "many"},
               {TRACE BALL "-o a.exr --size 0x5", "0x5"},
               {TRACE BALL "-o a.exr --size 99999x5", "99999x5"},
               {TRACE BALL "-o a.exr --threads 0", "--threads"},
               {TRACE BALL "-o a.exr --photons 0", "--photons"},
               {TRACE BALL "-o a.exr --bands 257", "--bands"},
               {TRACE BALL "-o a.exr --physics real", "real"},
               {TRACE BALL "-o a.exr --space srgb", "srgb"},
               {TRACE BALL "-o a.exr --time nan", "nan"},
               {TRACE BALL "-o a.exr --until-error 0", "--until-error"},
               {TRACE BALL "-o a.exr --range 780:380", "780:380"},
               {TRACE BALL, "where to"},
               {TRACE "-o a.exr", "which scene"},
               {TRACE BALL BALL "-o a.exr", "one scene"}};
  bool right = true;
  for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
    right = run_refuses(lines[i].line, 2, lines[i].part) && right;
  assert_true(right);
}

/* Scenes that cannot be traced; each is made by sed from one that can. */
TEST(bad_scenes) {
#define SCENE(edit)                                                                                \
  "sed " edit " \"$house/scenes/sphere.yaml\" > s.yaml; " TRACE "s.yaml" SMALL                     \
  "--spp 1 -o a.exr; code=$?; rm s.yaml; exit $code"
  static const struct {
    const char *line;
    const char *part;
  } lines[] = {
      {SCENE("'/^lights:/,/^objects:/{/^objects:/!d}'"), "lights"},
      {SCENE("'s/^  eye: .*/  eye: [0.02, -0.01, 0.07]/'"), "inside"},
      {SCENE("'s/material: fused-silica/reflectance: 1.5/'"), "1.5"},
      {"printf 'no scene' > s.yaml; " TRACE "s.yaml -o a.exr; code=$?; rm s.yaml; exit $code",
       "s.yaml"},
      {TRACE "missing.yaml -o a.exr", "missing.yaml"},
      {TRACE BALL "-o nowhere/a.exr" SMALL, "nowhere"},
      {TRACE BALL "-o a.exr --save-map nowhere/m.exr" SMALL, "nowhere"},
      {TRACE BALL "-o a.exr --checkpoint nowhere/c" SMALL, "nowhere"},
      {TRACE BALL "-o a.exr --range 900:1000" SMALL, "eye"},
      {TRACE BALL "--save-map m.exr --map-light sun" SMALL, "sun"},
      {TRACE BALL "--save-map m.exr --map-like missing.exr" SMALL, "missing.exr"},
  };
  bool right = true;
  for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
    right = run_refuses(lines[i].line, 1, lines[i].part) && right;
  assert_true(right);
}

/* Two maps of one scene: the second like the first, and with `options`. */
static void save_two_maps(const char *options, abbe_image *a, abbe_image *b) {
  const char *line =
      printed("%s %s", TRACE BALL SMALL "--spp 1 --save-map b.exr --map-like a.exr", options);
  check_run(TRACE BALL SMALL "--spp 1 --save-map a.exr", 0);
  check_run(line, 0);
  read_image("a.exr", a);
  read_image("b.exr", b);
}

TEST(map_like) {
  OWNED(abbe_image, b);
  FILLED(abbe_image, a, save_two_maps("--seed 4", &a, &b));
  assert_string_equal(abbe_image_attribute_text(&a, "abbe:map_view"),
                      abbe_image_attribute_text(&b, "abbe:map_view"));
  assert_int_equal(a.width, b.width);
}

/* A map need not be square: it holds the same light. */
TEST(map_sides) {
  OWNED(abbe_image, a) = {0}, b = {0};
  save_two_maps("--map 4x16", &a, &b);
  assert_int_equal(b.width, 4);
  assert_int_equal(b.height, 16);
  double lights[2] = {0, 0};
  for (size_t i = 0; i < 256; i++) lights[0] += (double)a.data[i * a.channels + 1];
  for (size_t i = 0; i < 64; i++) lights[1] += (double)b.data[i * b.channels + 1];
  assert_true(lights[0] > 0 && fabs(lights[1] / lights[0] - 1) < 1e-5);
  check_run(TRACE BALL SMALL "--spp 1 --save-map c.exr --map 4x", 2);
}

/* Threads have the stack that the shell allows; a quarter of a megabyte does, also for two. */
TEST(a_small_stack) {
  check_run("ulimit -s 256 && " TRACE BALL SMALL "--spp 1 -o a.exr --save-map m.exr --rates", 0);
  check_run("ulimit -s 256 && " TRACE "\"$house/scenes/bunny.yaml\" " SMALL
            "--threads 2 --spp 1 -o b.exr",
            0);
}

/* Processes that know nothing of each other, one of them killed and started again. */
TEST(parts) {
  const char *const whole = TRACE BALL SMALL "--spp 7 -o whole.exr --save-map whole-map.exr";
  check_run(whole, 0);
#define PART(range, file)                                                                          \
  TRACE BALL SMALL "-o a.exr --save-map m.exr --passes " range " --checkpoint " file
  check_run(PART("0:2", "p0.ck") " & " PART("5:7", "p2.ck") " & wait", 0);
  assert_true(!there("a.exr") && !there("m.exr"));
  /* killed once it has a pass on the disk, and taken up again */
  check_run(PART("2:5", "p1.ck") " --checkpoint-every 0 & p=$!; while [ ! -e p1.ck ] && kill -0 "
                                 "$p; do sleep 0.02; done; kill -9 $p; wait $p; true",
            0);
  check_run(PART("2:5", "p1.ck") " --resume", 0);
  check_run(TRACE BALL SMALL "-o a.exr --save-map m.exr --merge p2.ck p0.ck p1.ck", 0);
  assert_true(same_pixels("whole.exr", "a.exr") && same_pixels("whole-map.exr", "m.exr"));
  check_run("cmp whole.exr a.exr && cmp whole-map.exr m.exr", 0);
  /* some put together are a part again */
  check_run(TRACE BALL SMALL "-o b.exr --save-map n.exr --merge p0.ck p1.ck --checkpoint p01.ck",
            0);
  check_run(TRACE BALL SMALL "-o b.exr --save-map n.exr --merge p01.ck p2.ck", 0);
  check_run("cmp whole.exr b.exr", 0);
#undef PART
}

static void refuse_parts(const char *arguments, int code, const char *part) {
  check_run(printed(TRACE BALL SMALL "%s", arguments), code);
  assert_contains(run_errors, part);
}

TEST(wrong_parts) {
  check_run(TRACE BALL SMALL "--passes 0:1 --checkpoint q0.ck", 0);
  check_run(TRACE BALL SMALL "--passes 3:4 --checkpoint q3.ck", 0);
  refuse_parts("-o c.exr --merge q0.ck q3.ck", 1, "passes 1 to 2 are missing");
  refuse_parts("-o c.exr --merge q3.ck", 1, "passes 0 to 2 are missing");
  refuse_parts("-o c.exr --merge q0.ck q0.ck", 1, "both hold pass 0");
  refuse_parts("-o c.exr --seed 4 --merge q0.ck", 1, "seed 0");
  refuse_parts("-o c.exr --merge q0.ck nothing.ck", 1, "nothing.ck");
  refuse_parts("-o c.exr --merge", 2, "which parts");
  refuse_parts("-o c.exr q0.ck", 2, "one scene at a time");
  refuse_parts("-o c.exr --passes 0:1", 2, "--checkpoint FILE");
  refuse_parts("--passes 3:3 --checkpoint q.ck", 2, "are no passes");
  refuse_parts("--passes 3 --checkpoint q.ck", 2, "are no passes");
  refuse_parts("--passes 0:1 --passes 3 --checkpoint q.ck", 2, "are no passes");
  refuse_parts("--passes 2:4 --spp 3 --checkpoint q.ck", 2, "--spp");
  refuse_parts("--passes 0:1 --checkpoint q.ck --incomplete", 2, "--merge");
  refuse_parts("--merge q0.ck --checkpoint q.ck --incomplete", 2, "is no part");
  /* the last part is missing */
  check_run(TRACE BALL SMALL "--spp 3 --passes 0:1 --checkpoint r0.ck", 0);
  check_run(TRACE BALL SMALL "--spp 3 --passes 1:2 --checkpoint r1.ck", 0);
  refuse_parts("-o c.exr --merge r0.ck r1.ck", 1,
               "pass 2 is missing: there are to be 3, as r0.ck says; trace them, or take what is "
               "there with --incomplete");
  refuse_parts("-o c.exr --spp 2 --merge q0.ck", 1, "pass 1 is missing: there are to be 2, as is");
  check_run(TRACE BALL SMALL "-o c.exr --merge r0.ck r1.ck --incomplete", 0);
  assert_contains(run_errors, "note: pass 2 is missing");
  check_run("rm c.exr", 0);
  refuse_parts("--passes 0:1 --merge q0.ck --checkpoint q.ck", 2, "--merge");
  refuse_parts("--passes 0:1 --checkpoint q3.ck --resume", 1, "from 3 on, not all from 0");
  assert_true(!there("c.exr") && !there("q.ck"));
}
