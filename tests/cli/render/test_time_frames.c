/* `abbe render --frames A:B` and `abbe trace --frames A:B`: numbered frames over time, the PNG that
 * moves, parts, and going on. */
#include "tests/cli/run_program.h"

static const char pool[] = "cat > pool.yaml <<END\n"
                           "camera: {eye: [0, -0.5, 0.5], target: [0, 0, -0.05], fov: 20}\n"
                           "lights: [{name: sun, kind: directional, direction: [0.2, 0.1, -1], "
                           "irradiance: {keyframes: [[0, 1], [1, 3]]}}]\n"
                           "objects:\n"
                           "- {name: water, shape: water, size: [0.3, 0.3, 0.06], cells: 16, "
                           "material: water, waves: [{amplitude: 0.003, wavelength: 0.1}]}\n"
                           "- {name: bottom, shape: rectangle, width: 0.4, height: 0.4, "
                           "reflectance: 0.8, transform: [{translate: [0, 0, -0.05]}]}\n"
                           "END\n";

#define LOUD "\"$abbe\" render pool.yaml --size 16x16 --photons 16 --map 64 "
#define RENDER LOUD "-q "
#define TRACE "\"$abbe\" trace pool.yaml --size 8x8 --spp 2 --photons 512 -q "

GROUP(run_setup, run_teardown);

TEST(frames_and_what_moves) {
  run_must(pool);
  run_must(RENDER "--frames 2:5 --fps 4 --png t.png -o t.exr && ls t*");
  assert_string_equal(run_output, "t-0002.exr\nt-0002.png\nt-0003.exr\nt-0003.png\nt-0004.exr\n"
                                  "t-0004.png\nt.png\n");
  run_must("grep -c acTL t.png");
  /* frame 3 at 4 a second is the scene at 0.75 s, and others are not */
  run_must(RENDER "--at 0.75 -o one.exr && \"$abbe\" compare one.exr t-0003.exr --tolerance "
                  "relative_rmse=1e-5");
  run_must(RENDER "--set time=0.75 -o two.exr && cmp one.exr two.exr");
  assert_int_not_equal(run_line("cmp t-0002.png t-0003.png"), 0);
  /* a frame that is gone is drawn again, and the others are not */
  run_must("rm t-0003.* t.png && touch -d 2001-01-01 t-0002.png t-0004.png && cp t-0002.exr "
           "kept.exr && " RENDER
           "--frames 2:5 --fps 4 --png t.png -o t.exr --resume && find . -name 't*.png' -newermt "
           "2002-01-01 | sort && cmp kept.exr t-0002.exr");
  assert_string_equal(run_output, "./t-0003.png\n./t.png\n");
  run_must(LOUD "--frames 2:5 --fps 4 --png t.png -o t.exr --resume && cmp kept.exr t-0002.exr");
  assert_contains(run_errors, "no frame is left to draw");
  run_must("rm t* one.exr kept.exr");
}

/* Frames of another size, seed or scene are not kept, which is said; those of the same request are,
 * whatever part or number of threads has made them. */
TEST(what_made_a_frame_is_known) {
#define SEEDED "\"$abbe\" trace pool.yaml --spp 1 --photons 512 -q --frames 0:2 -o s.exr "
  run_must(pool);
  run_must(SEEDED "--size 8x8 --seed 1 && cp s-0001.exr one.exr");
  run_must(SEEDED "--size=8x8 --seed 1 --resume --threads 1 --part 1/2 && cmp one.exr s-0001.exr");
  assert_string_equal(run_errors, "");
  run_must(SEEDED "--size 8x8 --seed 2 --resume");
  assert_contains(run_errors, "note: s-0000.exr was made with 'seed 1', and not 'seed 2'");
  assert_contains(run_errors, "note: s-0001.exr was made with");
  assert_int_not_equal(run_line("cmp one.exr s-0001.exr"), 0);
  run_must(SEEDED "--size 8x8 --seed 1 --resume && cmp one.exr s-0001.exr");
  run_must("sed -i 's/0.8/0.4/' pool.yaml && " SEEDED "--size 8x8 --seed 1 --resume");
  assert_contains(run_errors, "note: s-0000.exr was made with 'scene of digest ");
#undef SEEDED
#define SIZED "\"$abbe\" render pool.yaml --photons 16 --map 64 -q --png z.png "
  run_must(SIZED "--frames 0:2 --size 16x16 && " SIZED "--frames 0:3 --size 16x16 --resume");
  assert_string_equal(run_errors, "");
  run_must(SIZED "--frames 0:3 --size 24x16 --resume");
  assert_contains(run_errors, "note: z-0000.png was made with 'size 16x16', and not 'size 24x16'");
  run_must(SIZED "--frames 0:3 --size 24x16 --resume && " SIZED "--frames 0:3 --merge");
  assert_string_equal(run_errors, "");
  run_must(SIZED "--frames 0:1 --size 24x16 --range 400:700");
  run_fails(SIZED "--frames 0:3 --merge", 2, "z-0001.png was made with");
#undef SIZED
  run_must("rm s-* one.exr z*");
}

/* What moves is halfway on the middle frame, and where it begins and ends on the others. */
TEST(what_is_moved) {
  run_must(RENDER "--frames 2:5 --fps 4 --move 'camera.eye=[0, -0.5, 0.5]:[0.25, -0.5, 0.5]' "
                  "--move camera.fov=20:30 -o m.exr");
  run_must(RENDER "--at 0.75 --set camera.eye=[0.125,-0.5,0.5] --set camera.fov=25 -o one.exr && "
                  "\"$abbe\" compare one.exr m-0003.exr --tolerance relative_rmse=1e-5");
  run_must(RENDER "--at 1 --set camera.eye=[0.25,-0.5,0.5] --set camera.fov=30 -o one.exr && "
                  "\"$abbe\" compare one.exr m-0004.exr --tolerance relative_rmse=1e-5");
  run_must(
      RENDER
      "--at 0.5 -o one.exr && \"$abbe\" compare one.exr m-0002.exr --tolerance relative_rmse=1e-5");
  run_must("rm m* one.exr");
}

TEST(parts_are_put_together) {
  run_must(RENDER "--frames 0:4 --fps 4 --png t.png && " RENDER
                  "--frames 0:4 --fps 4 --png u.png --part 1/2 && " RENDER
                  "--frames 0:4 --fps 4 --png u.png --part 0/2 && " RENDER
                  "--frames 0:4 --fps 4 --png u.png --merge && cmp t.png u.png");
  run_must("rm t* u*");
}

TEST(traced_frames) {
  run_must(TRACE "--frames 1:3 --fps 2 --png t.png -o t.exr && ls t*");
  assert_string_equal(run_output, "t-0001.exr\nt-0001.png\nt-0002.exr\nt-0002.png\nt.png\n");
  run_must(
      TRACE
      "--at 0.5 -o one.exr && \"$abbe\" compare one.exr t-0001.exr --tolerance relative_rmse=1e-5");
  run_must("rm t-0002.png && touch -d 2001-01-01 t-0001.png && " TRACE
           "--frames 1:3 --fps 2 --png t.png -o t.exr --resume && find . -name 't*.png' -newermt "
           "2002-01-01 | sort");
  assert_string_equal(run_output, "./t-0002.png\n./t.png\n");
  run_must("rm t* one.exr");
  run_clears("rm pool.yaml");
}

#define GEM "\"$abbe\" render \"$house\"/scenes/gem.yaml "
#define GEM_TRACE "\"$abbe\" trace \"$house\"/scenes/gem.yaml "

TEST(what_is_refused) {
  assert_true(run_refuses(GEM "--frames 4:4 --png t.png", 2, "are no frames"));
  assert_true(run_refuses(GEM "--frames 4: --png t.png", 2, "--frames"));
  assert_true(run_refuses(GEM "--frames 0:4 --json", 2, "--frames A:B writes frames"));
  assert_true(run_refuses(GEM "--frames 0:4 --png t.png --part 7/8", 2, "none of 4 frames"));
  assert_true(run_refuses(GEM "--resume --png t.png", 2, "goes with --turntable N or --frames"));
  assert_true(run_refuses(GEM "--at soon --png t.png", 2, "--at"));
  assert_true(run_refuses(GEM "--move camera.fov=20 --frames 0:4 --png t.png", 2, "moves nothing"));
  assert_true(run_refuses(GEM "--move camera.fov=20:wide --frames 0:4 --png t.png", 2, "KEY=A:B"));
  assert_true(run_refuses(GEM "--move camera.fov=20:30 --png t.png", 2, "goes with --frames A:B"));
  assert_true(
      run_refuses(GEM "--move camera.fog=20:30 --frames 0:4 --png t.png", 1, "no key 'fog'"));
  assert_true(run_refuses(GEM_TRACE "--move camera.fov=20:30 -o t.exr", 2, "goes with --frames"));
  assert_true(run_refuses(GEM_TRACE "--frames 0:4 --json", 2, "--frames writes frames"));
  assert_true(run_refuses(GEM_TRACE "--frames 0:4 -o t.exr --merge a b", 2, "goes without"));
  assert_true(run_refuses(GEM_TRACE "--fps 4 -o t.exr", 2, "--fps goes with --frames"));
  /* before any frame is drawn */
  assert_true(run_refuses(GEM "--frames 0:2 --fps 60 -o t.gif", 2, "to 50 frames a second"));
  assert_true(run_refuses(GEM_TRACE "--frames 0:2 --fps 60 -o t.gif", 2, "to 50 frames a second"));
  assert_true(run_refuses(GEM "--frames 0:2 --display 'Rec.2100 PQ' -o t.gif", 1, "PQ and HLG"));
  assert_true(run_refuses(GEM_TRACE "--frames 0:2 --display 'Rec.2100 HLG' -o t.gif", 1, "PQ and"));
}
