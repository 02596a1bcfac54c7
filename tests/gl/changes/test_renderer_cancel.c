/* A renderer that is told to stop does so soon, and goes on as if it had not been. */
#include "tests/gl/changes/changed_frame.h"

#include "base/thread/watch.h"

GROUP(make_context, free_context);

/* Wherever a frame or a change is cancelled, the renderer goes on. */
TEST(a_cancelled_renderer_goes_on) {
  abbe_error why = {0};
  OWNED(abbe_scene, scene) = scene_of(GLASS_SCENE);
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &tiny);
  abbe_result result = ABBE_CANCELLED;
  int calls = 0;
  for (int most = 1; result == ABBE_CANCELLED && most < 10000; most += 1 + most / 4) {
    int left = most;
    abbe_renderer_redraw(renderer);
    result = abbe_renderer_frame(renderer, stop_at, &left, NULL, &why);
    calls = most - left;
  }
  assert_int_equal(result, ABBE_OK);
  assert_true(calls >= 3);
  assert_as_made_anew(renderer, &scene, &tiny, "cancelled frames");
  int left = 1;
  abbe_render_desc watched = tiny;
  watched.progress = stop_at;
  watched.progress_user = &left;
  scene.light[0].position[0] += 0.02;
  assert_int_equal(change(renderer, &scene, &watched), ABBE_CANCELLED);
  assert_false(abbe_renderer_is_lit(renderer));
  double ms;
  abbe_renderer_hits hits;
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_renderer_frame(renderer, NULL, NULL, NULL, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_renderer_baseline(renderer, &ms, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_renderer_read_hits(renderer, 0, 0, NULL, NULL, &hits, &error));
  OK(change(renderer, &scene, &tiny));
  assert_as_made_anew(renderer, &scene, &tiny, "a cancelled change");
}

/* Units of work, counted: what is dispatched, drawn and compiled. */
/* What the camera's passes alone ask for, cancelled, leaves the light as it is. */
TEST(a_cancelled_view_keeps_the_light) {
  int left = 1;
  OWNED(abbe_scene, scene) = scene_of(GLASS_SCENE);
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &tiny);
  abbe_render_desc other = tiny;
  other.aovs = true;
  other.progress = stop_at;
  other.progress_user = &left;
  assert_int_equal(change(renderer, &scene, &other), ABBE_CANCELLED);
  assert_true(abbe_renderer_is_lit(renderer));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_renderer_frame(renderer, NULL, NULL, NULL, &error));
  other.progress = NULL;
  OK(change(renderer, &scene, &other));
  const abbe_statistics s = draw_frame(renderer);
  assert_ran(&s, false, true);
  abbe_renderer_redraw(renderer);
  assert_as_made_anew(renderer, &scene, &other, "a cancelled view");
}

/* The thread's watch is heard by what comes before the first program: planning, and trees. */
static bool watch_at(void *user) {
  return stop_at(user, 0);
}

TEST(a_watch_ends_a_change) {
  abbe_result result = ABBE_CANCELLED;
  int calls = 0;
  OWNED(abbe_scene, scene) = scene_of(MESH_SCENE);
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &tiny);
  scene.light[0].position[0] += 0.02;
  for (int most = 1; result == ABBE_CANCELLED; most++) {
    int left = most;
    abbe_watch watch = {watch_at, &left, false};
    abbe_watch_set(&watch);
    result = change(renderer, &scene, &tiny);
    abbe_watch_set(NULL);
    assert_true(result == ABBE_OK || left == 0); /* and asked no more */
    calls = most - left;
  }
  assert_int_equal(result, ABBE_OK);
  assert_true(calls >= 3);
  assert_as_made_anew(renderer, &scene, &tiny, "a watched change");
}

static struct {
  abbe_gl real;
  int units, most, left; /* since somebody was asked last; the most; calls until they stop it */
  bool stopped;
} counted;

static void count_dispatch(GLuint x, GLuint y, GLuint z) {
  counted.units++;
  counted.real.DispatchCompute(x, y, z);
}
static void count_indirect(GLintptr at) {
  counted.units++;
  counted.real.DispatchComputeIndirect(at);
}
static void count_elements(GLenum mode, GLsizei count, GLenum type, const void *at) {
  counted.units++;
  counted.real.DrawElements(mode, count, type, at);
}
static void count_arrays(GLenum mode, GLint first, GLsizei count) {
  counted.units++;
  counted.real.DrawArrays(mode, first, count);
}
static void count_program(GLuint program) {
  counted.units++;
  counted.real.LinkProgram(program);
}

static bool stop_counted(void *user, double done) {
  (void)user;
  (void)done;
  assert_false(counted.stopped); /* nobody is asked again */
  if (counted.units > counted.most) counted.most = counted.units;
  counted.units = 0;
  counted.stopped = --counted.left <= 0;
  return !counted.stopped;
}

static void begin_count(void) {
  abbe_gl *gl = (abbe_gl *)abbe_context_gl(context);
  counted.real = *gl;
  gl->DispatchCompute = count_dispatch;
  gl->DispatchComputeIndirect = count_indirect;
  gl->DrawElements = count_elements;
  gl->DrawArrays = count_arrays;
  gl->LinkProgram = count_program;
}

static void end_count(void) {
  *(abbe_gl *)abbe_context_gl(context) = counted.real;
}

/* Whoever watches is asked after every few units of work, and after their no there is next to none:
 * of a change and the frame after it, from another light on, of another size. */
TEST(a_cancel_is_heard_soon) {
  enum { MOST_APART = 12, MOST_AFTER = 2 };
  abbe_error error = {0};
  OWNED(abbe_scene, scene) = scene_of(GLASS_SCENE);
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &tiny);
  abbe_render_desc watched = tiny;
  watched.progress = stop_counted;
  begin_count();
  for (int most = 1, done = 0; !done; most += 1 + most / 8) {
    counted.left = most;
    counted.units = counted.most = 0;
    counted.stopped = false;
    scene.light[0].position[0] += 0.001;
    watched.width = 16 + (size_t)(most % 16);
    abbe_result result = change(renderer, &scene, &watched);
    if (result == ABBE_OK) result = abbe_renderer_frame(renderer, stop_counted, NULL, NULL, &error);
    done = result == ABBE_OK;
    assert_true(done || result == ABBE_CANCELLED);
    if (!done && counted.units > MOST_AFTER) fail_msg("%d units after no %d", counted.units, most);
    if (counted.most > MOST_APART) fail_msg("%d units between two questions", counted.most);
  }
  end_count();
  watched.progress = NULL;
  assert_as_made_anew(renderer, &scene, &watched, "cancelled changes");
}
