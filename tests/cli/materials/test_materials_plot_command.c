/* `abbe materials plot` as people meet it. */
#include "tests/cli/run_program.h"

#include "colorimetry/image/png_file.h"

#define PLOT "\"$abbe\" materials plot "

static void check_picture(const char *name, size_t width, size_t height) {
  MADE(abbe_image, image, abbe_png_read(run_path(name), &image, &error));
  assert_int_equal(image.width, width);
  assert_int_equal(image.height, height);
  unlink(run_path(name));
}

GROUP(run_setup, run_teardown);

TEST(pictures_are_made) {
  run_must(PLOT "n-bk7 f2 -o a.png");
  check_picture("a.png", 960, 600);
  run_must(PLOT "rutile --fits --size 400x300 --range 300:900 -o a.png");
  check_picture("a.png", 400, 300);
  run_must("printf '486.1 1.5224\\n656.3 1.5143\\n' > p.csv && " PLOT
           "n-bk7 --points p.csv -o a.png && rm p.csv");
  check_picture("a.png", 960, 600);
  run_must(PLOT "--map --table thesis --table default bk7 n-bk7 -o a.png");
  assert_string_equal(
      run_errors, "abbe materials plot: left out 1 without n_d and a finite V_d in their range\n");
  check_picture("a.png", 960, 600);
  run_must(PLOT "n-bk7 -o a.svg && head -c 5 a.svg && rm a.svg");
  assert_string_equal(run_output, "<?xml");
  assert_int_equal(run_left(), 0);
}

TEST(wrong_use_gets_a_sentence) {
  const struct {
    const char *line, *part;
    int code;
  } cases[] = {
      {PLOT "-o a.png", "plot what?", 2},
      {PLOT "n-bk7", "where to?", 2},
      {PLOT "n-bk7 -o a.jpg", ".png or .svg", 1},
      {PLOT "n-bk8 -o a.png", "did you mean 'n-bk7'?", 1},
      {PLOT "n-bk7 -o a.png --range 780:380", "not a range", 2},
      {PLOT "n-bk7 -o a.png --range 5000:6000", "no index from 5000 to 6000 nm", 1},
      {PLOT "n-bk7 -o a.png --size 5", "960x600", 2},
      {PLOT "n-bk7 -o a.png --size -1x-1", "960x600", 2},
      {PLOT "n-bk7 -o a.png --size 9x9", "64 to", 1},
      {PLOT "n-bk7 -o a.png --table no.yaml", "no.yaml", 1},
      {PLOT "n-bk7 -o a.png --points no.csv", "no.csv", 1},
      {PLOT "n-bk7 -o no/a.png", "no/a.png", 1},
      {PLOT "--map --fits -o a.png", "--map goes without", 2},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
    assert_true(run_refuses(cases[i].line, cases[i].code, cases[i].part));
  run_says(PLOT "--help", "  abbe materials plot n-bk7 f2 sf11 -o glasses.png");
}
