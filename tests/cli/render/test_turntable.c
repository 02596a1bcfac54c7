/* `abbe render --turntable`: frames from all around and the PNG that moves. */
#include "tests/cli/run_program.h"

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
  run_must("rm t* one.exr");
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
  assert_int_equal(run_line(GEM "--turntable 5 --png u.png --merge"), 1);
  assert_contains(run_errors, "u-0003.png");
  run_must("rm t* u*");
  assert_true(run_refuses(GEM "--turntable 5 --merge -o u.exr", 2, "--png FILE.png"));
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
