/* `abbe view`, led by scripts: the whole of it but the window. */
#include "tests/cli/run_program.h"

#define SCRIPTS "\"$house\"/tests/cli/view/scripts/"
#define VIEW "\"$abbe\" view \"$house\"/scenes/gem.yaml "

#ifdef ABBE_HAVE_VIEW

/* What a script says, and what it has kept, goes by the run's own folder. */
static void must(const char *line) {
  if (run_line(line) != 0) fail_msg("%s: %s", line, run_errors);
}

/* Opens the gem, turns it, makes it a diamond, drags the lamp, clicks the violet edge, keeps all.
 */
static void the_story(void **state) {
  (void)state;
  must(VIEW "--size 640x400 --keep story --script " SCRIPTS "story.txt > said");
  /* the scene that was kept differs in what was changed, and draws the same picture */
  must("diff \"$house\"/scenes/gem.yaml story.yaml | grep -c '^>' > lines; grep -qx 4 lines");
  must("grep -q 'material: diamond' story.yaml && grep -q '# A cut stone' story.yaml");
  must("sed -n 's/^command abbe/\"$abbe\"/p' said > again.sh");
  must("grep -q -e '--set objects.gem.material=diamond' again.sh");
  must("echo \"$(cat again.sh) --gl egl -q -o again.exr\" > again.sh && . ./again.sh");
  must("\"$abbe\" compare again.exr story.exr --tolerance relative_rmse=1e-6");
  must("rm said lines again.sh again.exr story.exr story.yaml *.png");
  assert_int_equal(run_left(), 0);
}

static void what_is_wrong_is_said_and_the_picture_stays(void **state) {
  (void)state;
  must("cp \"$house\"/scenes/sphere.yaml scene.yaml; cp scene.yaml good.yaml");
  must("sed 's/radius:/radios:/' good.yaml > broken.yaml");
  must("sed 's/^ambient:.*/ambient: 1.5/' good.yaml > bright.yaml");
  must("\"$abbe\" view scene.yaml --last balanced --size 500x200 --script " SCRIPTS "faults.txt");
  must("rm *.yaml");
  assert_int_equal(run_left(), 0);
}

static void scripts_that_do_not_hold(void **state) {
  (void)state;
  static const struct {
    const char *line, *sentence;
    int code;
  } cases[] = {{"wait balanced\nassert stage = mean", "stage is 'balanced', not = 'mean'", 3},
               {"\n\nwhistle", "a.txt:3: whistle: is no command", 1},
               {"assert nothing = 1", "there is no value 'nothing'", 1},
               {"click nowhere", "there is no 'nowhere' in sight", 1},
               {"assert stage like none", "'like' is none of", 1},
               {"size 0x5", "WxH", 1},
               {"key control+s", "", 0}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char line[512];
    snprintf(line, sizeof line, "printf '%s\\n' > a.txt", cases[i].line);
    must(line);
    const int code = run_line(VIEW "--last balanced --size 420x100 --script a.txt");
    if (code != cases[i].code) fail_msg("'%s' ends with %d: %s", line, code, run_errors);
    assert_contains(run_errors, cases[i].sentence);
  }
  must("rm a.txt");
  assert_int_equal(run_left(), 0);
}

static void without_a_display(void **state) {
  (void)state;
  assert_true(
      run_refuses("env -u DISPLAY -u WAYLAND_DISPLAY " VIEW, 1, "--script leads the viewer"));
}

#else

static void it_says_what_to_install(void **state) {
  (void)state;
  assert_true(run_refuses(VIEW, 1, "install libglfw3-dev and libimgui-dev"));
}

#endif

static void wrong_use(void **state) {
  (void)state;
  assert_true(run_refuses("\"$abbe\" view", 2, "which scene?"));
  assert_true(run_refuses(VIEW "--size 0x1", 2, "--size"));
  assert_true(run_refuses(VIEW "--last soon", 2, "--last"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
#ifdef ABBE_HAVE_VIEW
      cmocka_unit_test(the_story), cmocka_unit_test(what_is_wrong_is_said_and_the_picture_stays),
      cmocka_unit_test(scripts_that_do_not_hold), cmocka_unit_test(without_a_display),
#else
      cmocka_unit_test(it_says_what_to_install),
#endif
      cmocka_unit_test(wrong_use)};
  return cmocka_run_group_tests(tests, run_setup, run_teardown);
}
