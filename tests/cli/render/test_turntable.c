/* `abbe render --turntable`: frames from all around and the PNG that moves. */
#include "tests/check.h"

#include "tests/cli/run_program.h"

#include <cjson/cJSON.h>

#define GEM "\"$abbe\" render \"$house\"/scenes/gem.yaml --size 16x16 --photons 16 --map 64 -q "

GROUP(run_setup, run_teardown);

TEST(frames_and_what_moves) {
  if (run_line(GEM "--turntable 4 --fps 10 --png t.png -o t.exr && ls t*") != 0)
    fail_msg("%s", run_errors);
  assert_string_equal(run_output, "t-0001.exr\nt-0001.png\nt-0002.exr\nt-0002.png\nt-0003.exr\n"
                                  "t-0003.png\nt-0004.exr\nt-0004.png\nt.png\n");
  run_must("grep -c acTL t.png");
  /* The first is the scene's own view, and the others are not. */
  run_must(GEM "-o one.exr && \"$abbe\" compare one.exr t-0001.exr --tolerance relative_rmse=1e-5");
  assert_int_not_equal(run_line("cmp t-0001.png t-0003.png"), 0);
  run_clears("rm t* one.exr");
}

/* Where light is alike all around, a stone that turns shows what a camera sees that goes around. A
 * fifth of a turn either way are two sights of six sides. */
TEST(the_stone_turns) {
  run_must("cat >s.yaml <<'END'\n"
           "camera: {eye: [0, -4cm, 3cm], target: [0, 0, -1mm], fov: 15}\n"
           "environment: {uniform: 1}\n"
           "objects:\n"
           "  - {name: stone, shape: gem, sides: 6, girdle: 5mm, table: 3mm, crown: 2mm, pavilion: "
           "4mm, material: ruby}\n"
           "END\n");
#define TURN "\"$abbe\" render s.yaml --size 24x24 -q --turntable 5 -o "
  run_must(TURN "c.exr && " TURN
                "s.exr --turn stone && for i in 1 2 3 4 5; do \"$abbe\" compare s-000$i.exr "
                "c-000$i.exr --tolerance relative_rmse=1e-3 || exit 1; done");
  assert_int_equal(
      run_line("\"$abbe\" compare s-0001.exr s-0002.exr --tolerance relative_rmse=1e-2"), 3);
  assert_int_equal(
      run_line("\"$abbe\" compare s-0002.exr c-0005.exr --tolerance relative_rmse=1e-2"), 3);
  run_must("rm s-0003.exr && " TURN "s.exr --turn stone --resume && test -s s-0003.exr");
  run_must("rm s* c*");
  assert_true(run_refuses(GEM "--turn stone --png t.png", 2, "--turn goes with --turntable N"));
  assert_true(run_refuses(GEM "--turn ring --turntable 4 --png t.png", 2, "one of camera, stone"));
  assert_int_equal(run_left(), 0);
}

/* Two processes that draw every other frame make what one makes. */
TEST(parts_are_put_together) {
  if (run_line(GEM "--turntable 5 --fps 10 --png t.png") != 0) fail_msg("%s", run_errors);
  if (run_line(GEM "--turntable 5 --png u.png --part 0/2 & " GEM
                   "--turntable 5 --png u.png --part 1/2; wait; ls u*") != 0)
    fail_msg("%s", run_errors);
  assert_string_equal(run_output, "u-0001.png\nu-0002.png\nu-0003.png\nu-0004.png\nu-0005.png\n");
  if (run_line(GEM "--turntable 5 --fps 10 --png u.png --merge && cmp t.png u.png") != 0)
    fail_msg("%s", run_errors);
  run_must("rm u-0003.png");
  run_fails(GEM "--turntable 5 --png u.png --merge", 1, "u-0003.png");
  run_must("rm t* u*");
  assert_true(run_refuses(GEM "--turntable 5 --merge -o u.exr", 2, "FILE.gif or FILE.png"));
  assert_true(run_refuses(GEM "--turntable 5 --png u.png --part 2/2", 2, "is no part"));
  assert_true(run_refuses(GEM "--turntable 5 --png u.png --part 6/9", 2, "none of 5 frames"));
  assert_true(run_refuses(GEM "--turntable 5 --png u.png --part 1/2 --merge", 2, "draws nothing"));
  assert_true(run_refuses(GEM "--png u.png --part 0/2", 2, "goes with --turntable"));
}

TEST(what_is_refused) {
  assert_true(run_refuses(GEM "--turntable 1 --png t.png", 2, "--turntable"));
  assert_true(run_refuses(GEM "--fps 5 --png t.png", 2, "--fps goes with --turntable"));
  assert_true(run_refuses(GEM "--turntable 4 --json", 2, "--turntable writes frames"));
  assert_true(run_refuses(GEM "--turntable 4 --png t.png --error-bars", 2, "goes without"));
  assert_true(run_refuses(GEM "--turntable 4 --png t.png --max-error 3 --tool trace", 2,
                          "--turntable is for the renderer alone"));
}

/* `--tilt`: of every command that reads a scene, and what is no tilt. */

#define STONE "\"$house\"/scenes/stone.yaml "

/* Extent of the stone along z, m, by the plan. */
static double height(const char *options) {
  const char *line = printed("\"$abbe\" plan " STONE "--json %s", options);
  if (run_line(line) != 0) fail_msg("%s", run_errors);
  cJSON *json = cJSON_Parse(run_output);
  const cJSON *stone = cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(json, "objects"), 0);
  double ends[2];
  for (int k = 0; k < 2; k++)
    ends[k] = cJSON_GetNumberValue(
        cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(stone, k ? "max" : "min"), 2));
  cJSON_Delete(json);
  return ends[1] - ends[0];
}

/* A round stone lying on its side is as high as it is wide, 8 mm at least, about any axis. */
TEST(a_stone_is_tilted) {
  const double level = height("");
  assert_int_in_range((int)(1e6 * level), 5000, 6500);
  assert_near(height("--tilt 0"), level, 0);
  assert_near(height("--tilt 180"), level, 1e-9);
  assert_true(height("--tilt 90") > 0.00799 && height("--tilt -90,45") > 0.00799);
  assert_true(height("--tilt 10") > level + 1e-4);
}

TEST(what_is_no_tilt) {
#define PLAN "\"$abbe\" plan "
  assert_true(run_refuses(PLAN STONE "--tilt steep", 2, "--tilt"));
  assert_true(run_refuses(PLAN STONE "--tilt 10,", 2, "--tilt"));
  assert_true(run_refuses(PLAN STONE "--tilt 10,x", 2, "--tilt"));
  assert_true(run_refuses(PLAN STONE "--tilt 400", 2, "--tilt"));
  assert_true(run_refuses(PLAN STONE "--tilt ''", 2, "--tilt"));
  assert_true(run_refuses(PLAN "\"$house\"/scenes/gem.yaml --tilt 1e99", 2, "--tilt"));
}
