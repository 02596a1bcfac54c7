/* Which tool makes a picture: what is promised of a scene and machine, what is chosen by an error,
 * by a time and by name, and files that are broken. */
#include "tests/validation/trace_scene.h"

#include "base/file.h"
#include "library/choice/picture_choice.h"
#include "library/choice/trace_times.h"

#include <unistd.h>

#define SCENE CAMERA POINT_LIGHT FLOOR BEADS("crown")
#define RENDER(photons, ms, error)                                                                 \
  "      - {photons: " photons                                                                     \
  ", wavelengths: 3, map: 64, samples: 1, upsample: 1, fill: bridge, exits: 2, share: 0.01,\n"     \
  "         model: auto, ms: " ms ", error: " error ", least: 0.5}\n"
#define TRACE(photons, passes, ms, error)                                                          \
  "      - {photons: " photons ", passes: " passes ", ms: " ms ", error: " error ", least: 0.5}\n"
#define HEAD "error: a\nwhat: b\nrun: c\nclasses:\n- class: spheres\n  scenes: beads\n"
#define PICTURES "  pictures:\n    base_ms: 1e-3\n    base_error: 1\n    margin_scenes: 2\n"
/* A yardstick of a microsecond: here everything takes far longer than in that run. */
#define WHOLE                                                                                      \
  HEAD PICTURES "    render:\n      margin: 2\n      time_margin: 1.5\n      front:\n" RENDER(     \
      "16", "1", "8")                                                                              \
      RENDER("32", "4", "3") "    trace:\n      front:\n" TRACE("64", "2", "2", "1e6")             \
          TRACE("256", "8", "1e9", "1e-9")

static char path[64];
static abbe_scene scene;

static void write_file(const char *text) {
  OK(abbe_file_write(path, text, strlen(text), &error));
}

static void choose(abbe_picture_request request, abbe_picture_choice *out) {
  request.file = path;
  request.width = request.height = 16;
  OK(abbe_picture_choose(&request, &scene, out, &error));
}

static void begin(void) {
  snprintf(path, sizeof path, "/tmp/abbe_test_picture_choice_%ld.yaml", (long)getpid());
  scene = scene_of(SCENE);
}

static void finish(void) {
  abbe_scene_free(&scene);
  unlink(path);
}

GROUP(begin, finish);

TEST(the_file) {
  abbe_picture_front f;
  write_file(WHOLE);
  OK(abbe_picture_front_load(path, ABBE_PRESET_CLASS_SPHERES, &f, &error));
  assert_int_equal(f.count, 4);
  assert_string_equal(f.scenes, "beads");
  assert_int_equal(f.point[1].tool, ABBE_PICTURE_RENDER);
  assert_int_equal(f.point[1].photons, 32);
  assert_near(f.point[1].worst, 3, 0);
  assert_near(f.point[1].error, 6, 0);
  assert_near(f.point[1].ms, 6, 0);
  assert_int_equal(f.point[3].tool, ABBE_PICTURE_TRACE);
  assert_int_equal(f.point[3].passes, 8);
  assert_near(f.point[3].error, 1e-9, 0);
  REFUSED(ABBE_UNSUPPORTED, "class meshes",
          abbe_picture_front_load(path, ABBE_PRESET_CLASS_MESHES, &f, &error));
}

/* Without the tracer and without a time nothing is measured: promises are the file's. */
TEST(the_renderer_alone) {
  abbe_picture_choice c;
  write_file(WHOLE);
  abbe_picture_request q = {.max_error = 16, .tool = {[ABBE_PICTURE_RENDER] = true}};
  choose(q, &c);
  assert_int_equal(c.point->photons, 16);
  assert_true(c.kept && !c.timed);
  assert_near(c.promised_error, 16, 0);
  assert_near(c.spent_ms, 0, 0);
  q.max_error = 15.9;
  choose(q, &c);
  assert_int_equal(c.point->photons, 32);
  OK(abbe_picture_choice_check(&c, 1e9, &error));
  q.max_error = 5.9;
  choose(q, &c);
  assert_int_equal(c.point->photons, 32);
  assert_false(c.kept);
  REFUSED(ABBE_TOLERANCE, "an error of 5.9; the nearest was taken, of which 6 is promised",
          abbe_picture_choice_check(&c, 1, &error));
  q.max_error = 0;
  q.name = "draft";
  choose(q, &c);
  assert_int_equal(c.point->photons, 16);
  q.name = "accurate";
  choose(q, &c);
  assert_int_equal(c.point->photons, 32);
}

/* The tracer's errors are the yardstick's own, as often as the file says; times likewise. */
TEST(promises_are_told_by_the_yardstick) {
  abbe_picture_choice c;
  abbe_trace_times times;
  write_file(WHOLE);
  choose((abbe_picture_request){.max_error = 1e-6}, &c);
  assert_int_equal(c.point->tool, ABBE_PICTURE_TRACE);
  assert_int_equal(c.point->passes, 8);
  assert_true(c.kept && c.timed && c.spent_ms > 0);
  const abbe_trace_times_desc desc =
      FIELDS(.passes = ABBE_PICTURE_YARDSTICK_PASSES, .photons = ABBE_PICTURE_YARDSTICK_PHOTONS,
             .width = 16, .height = 16, .frames = 1);
  OK(abbe_trace_times_measure(&scene, &desc, &times, NULL, &error));
  assert_true(times.own_de > 0);
  assert_near(c.promised_error, 1e-9 * times.own_de, 1e-20);
  assert_true(c.promised_ms > 1e9);
}

/* A traced picture's own passes decide, whatever was promised. */
TEST(what_passes_tell) {
  abbe_picture_choice c;
  write_file(WHOLE);
  choose((abbe_picture_request){.max_error = 1e-6}, &c);
  assert_false(abbe_picture_choice_tells(&c));
  OK(abbe_picture_choice_check(&c, 1, &error));
  c.passes = 8;
  c.met = (abbe_pass_error){2e-6, 3e-6};
  assert_true(abbe_picture_choice_tells(&c));
  REFUSED(ABBE_TOLERANCE, "8 passes tell one of 2e-06, and at most 3e-06",
          abbe_picture_choice_check(&c, 1, &error));
  c.met.bound = 1e-6;
  c.kept = false;
  OK(abbe_picture_choice_check(&c, 1, &error));
  c.met.bound = NAN;
  c.kept = true;
  assert_false(abbe_picture_choice_tells(&c));
  REFUSED(ABBE_TOLERANCE, "", abbe_picture_choice_check(&c, 1, &error));
}

static void assert_says(const abbe_picture_choice *c, const char *right) {
  char text[300];
  abbe_picture_choice_say_error(c, text, sizeof text);
  assert_string_equal(text, right);
}

/* What was measured elsewhere is expected; what passes of this picture say is told. */
TEST(told_or_expected) {
  abbe_picture_choice c;
  write_file(WHOLE);
  choose((abbe_picture_request){.budget_ms = 1e9}, &c);
  c.promised_error = 2;
  assert_says(&c, "2, expected (not checked: no passes were traced for that)");
  c.timed_out = c.others = true;
  assert_says(&c, "2, expected (not checked: the budget left no time for it)");
  c.passes = 4;
  c.met = (abbe_pass_error){NAN, NAN};
  assert_says(
      &c,
      "2, expected (not checked: so few passes as the budget left time for are too noisy to tell)");
  c.met = (abbe_pass_error){1.5, 1.75};
  assert_says(&c, "about 1.5 (at most 1.75), told by 4 passes, against which the picture is held; "
                  "expected were 2");
  c.others = false;
  assert_says(&c, "about 1.5 (at most 1.75), told by 4 passes, half against half; expected were 2");
  /* An error that is too large is told and is no failure where a time was asked for. */
  c.met = (abbe_pass_error){17, 27};
  OK(abbe_picture_choice_check(&c, 1, &error));
}

/* Of many photons a pass takes as many times as long, of few no less than the yardstick's. */
TEST(what_passes_take) {
  const size_t its = ABBE_PICTURE_YARDSTICK_PHOTONS * ABBE_PICTURE_YARDSTICK_PHOTONS;
  abbe_picture_choice c = {.once_ms = 50};
  assert_near(abbe_picture_choice_pass_s(&c, 4 * its), 0.2, 1e-12);
  assert_near(abbe_picture_choice_pass_s(&c, 1), 0.05, 1e-12);
  c.once_ms = 0;
  assert_true(isnan(abbe_picture_choice_pass_s(&c, its)));
}

TEST(by_time) {
  abbe_picture_choice c;
  write_file(WHOLE);
  /* Of what no machine does in that time the fastest. */
  choose((abbe_picture_request){.budget_ms = 1e-3}, &c);
  assert_int_equal(c.point->photons, 16);
  assert_false(c.kept);
  REFUSED(ABBE_TOLERANCE, "the budget of 0.001 ms is not kept, for nothing faster is known",
          abbe_picture_choice_check(&c, 1, &error));
  OK(abbe_picture_choice_check(&c, 1e-4, &error));
  /* An age is time for all but what takes 1e12 times the yardstick. */
  choose((abbe_picture_request){.budget_ms = 1e9}, &c);
  assert_int_equal(c.point->photons, 32);
  assert_true(c.kept && c.promised_ms <= 1e9);
}

/* What repeats of the yardstick tell of the machine is said where a budget is not kept. */
TEST(a_busy_machine) {
  abbe_picture_choice c;
  write_file(WHOLE);
  choose((abbe_picture_request){.max_error = 1e-6}, &c);
  assert_true(isnan(c.unrest)); /* no time is asked for: it is not repeated */
  choose((abbe_picture_request){.budget_ms = 1e-3}, &c);
  assert_true(isnan(c.unrest)); /* nor where it would take much of the budget */
  choose((abbe_picture_request){.budget_ms = 1e9}, &c);
  assert_true(c.unrest >= 0);
  c.request.budget_ms = 1000;
  c.promised_ms = 900;
  c.unrest = 0.4;
  REFUSED(ABBE_TOLERANCE, "the machine is busy: repeats took 40 % longer than the fastest",
          abbe_picture_choice_check(&c, 1100, &error));
  OK(abbe_picture_choice_check(&c, 1000, &error));
  c.unrest = 0.1;
  REFUSED(ABBE_TOLERANCE, "", abbe_picture_choice_check(&c, 1100, &error));
  assert_null(strstr(last_error.text, "busy"));
  c.unrest = NAN;
  REFUSED(ABBE_TOLERANCE, "the machine may be busy", abbe_picture_choice_check(&c, 1400, &error));
}

TEST(words) {
  char text[300];
  const abbe_picture_point point = {.tool = ABBE_PICTURE_TRACE_FILTER, .photons = 256, .passes = 4};
  abbe_picture_describe(&point, text, sizeof text);
  assert_string_equal(text, "the tracer: 4 passes of 65536 photons, filtered");
  write_file(WHOLE);
  abbe_picture_choice c;
  choose((abbe_picture_request){.max_error = 16, .tool = {true}}, &c);
  abbe_picture_describe(c.point, text, sizeof text);
  assert_contains(text, "the renderer: 3 wavelengths, 16 photons");
}

TEST(what_is_refused) {
  static const struct {
    const char *text, *part;
  } broken[] = {
      {HEAD PICTURES, "'pictures' has no tool"},
      {HEAD "  pictures:\n    base_error: 1\n", "'base_ms' is a number above 0"},
      {HEAD PICTURES "    trace:\n      front: []\n", "a list of 1 to 48 points"},
      {HEAD PICTURES "    trace:\n      front:\n" TRACE("64", "0", "1", "1"), "passes"},
      {HEAD PICTURES "    trace:\n      front:\n" TRACE("64", "1", "0", "1"), "'ms' is a number"},
      {HEAD PICTURES "    trace:\n      front:\n" TRACE("64", "1", "1", "nan"), "error"},
      {HEAD PICTURES "    trace:\n      front:\n" TRACE("64", "1", "2", "1")
           TRACE("64", "2", "1", "0.5"),
       "rising time and falling error"},
      {HEAD PICTURES "    trace:\n      margin: 0.5\n      front:\n" TRACE("64", "1", "2", "1"),
       "margin"},
      {HEAD PICTURES "    tracer:\n      front:\n" TRACE("64", "1", "2", "1"), "no tool"},
      {HEAD PICTURES "    render:\n      front:\n" TRACE("64", "1", "2", "1"), "wavelengths"},
  };
  abbe_picture_front f;
  abbe_picture_choice c;
  abbe_error why = {0};
  for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
    write_file(broken[i].text);
    why = (abbe_error){0};
    if (abbe_picture_front_load(path, ABBE_PRESET_CLASS_SPHERES, &f, &why) != ABBE_SCHEMA)
      fail_msg("%zu is not refused so: %s", i, why.text);
    assert_contains(why.text, broken[i].part);
    assert_contains(why.text, path);
  }
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_picture_choose(&(abbe_picture_request){0}, &scene, &c, &error));
  write_file(HEAD PICTURES "    trace:\n      front:\n" TRACE("64", "1", "2", "1"));
  const abbe_picture_request q = {.file = path, .max_error = 1, .tool = {true}};
  REFUSED(ABBE_NOT_FOUND, "", abbe_picture_choose(&q, &scene, &c, &error));
}
