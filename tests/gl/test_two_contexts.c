/* Renderers on contexts of their own in one process: each draws what it draws alone, whoever drew
 * before it, and outlives the others. */
#include "gl/device/context_backend.h"
#include "gl/renderer_state.h"
#include "tests/gl/frame.h"
#include "tests/random.h"

#include <EGL/egl.h>

/* Scenes, and what is drawn of each alone. */
enum { SCENES = 2, STEPS = 24 };
static const char *const texts[SCENES] = {CAMERA POINT_LIGHT FLOOR BALL("flat"),
                                          CAMERA SUN FLOOR BRICK("crown")};
static const abbe_render_desc tiny = {
    .width = 16, .height = 16, .photons = 16, .map_size = 16, .wavelengths = 3};
static abbe_scene scenes[SCENES];

typedef struct taken {
  abbe_image picture, map;
} taken;

static taken alone[SCENES];

static abbe_context *make(void) {
  abbe_context *made = NULL;
  OK(abbe_context_make(ABBE_CONTEXT_CPU, &made, &error));
  return made;
}

static abbe_renderer *make_on(abbe_context *on, int scene) {
  context = on;
  return make_renderer(&scenes[scene], &tiny);
}

static void take(abbe_renderer *renderer, taken *out) {
  out->picture = picture_of(renderer);
  out->map = map_of(renderer, 0);
}

static void taken_free(taken *t) {
  abbe_image_free(&t->picture);
  abbe_image_free(&t->map);
}

static void take_alone(int scene, taken *out) {
  HELD(abbe_context, own) = make();
  HELD(abbe_renderer, renderer) = make_on(own, scene);
  draw_frame(renderer);
  take(renderer, out);
  assert_true(image_max(&out->picture, 1) > 0 && image_max(&out->map, 1) > 0);
}

static void draw_alone(void) {
  for (int i = 0; i < SCENES; i++) {
    scenes[i] = scene_of(texts[i]);
    take_alone(i, &alone[i]);
  }
}

static void free_alone(void) {
  for (int i = 0; i < SCENES; i++) {
    abbe_scene_free(&scenes[i]);
    taken_free(&alone[i]);
  }
}

static void assert_draws(abbe_renderer *renderer, const taken *expected, bool anew) {
  if (anew) draw_frame(renderer);
  FILLED(taken, now, take(renderer, &now));
  assert_same_pixels(&now.picture, &expected->picture);
  assert_same_pixels(&now.map, &expected->map);
}

GROUP(draw_alone, free_alone);

/* Frames and reads in any order, on one display, which closes with neither; then the second is
 * freed, whose context was made last, and the first is whole. */
TEST(two_do_not_meet) {
  abbe_context *on[2];
  abbe_renderer *renderer[2];
  uint64_t seed = 1;
  for (int i = 0; i < 2; i++) on[i] = make();
  for (int i = 0; i < 2; i++) renderer[i] = make_on(on[i], i);
  for (int i = 0; i < 2; i++) draw_frame(renderer[i]);
  for (int k = 0; k < STEPS; k++) {
    const uint64_t bits = random_bits(&seed);
    assert_draws(renderer[bits & 1], &alone[bits & 1], (bits & 2) != 0);
  }
  abbe_renderer_free(renderer[1]);
  assert_draws(renderer[0], &alone[0], false);
  abbe_context_free(on[1]);
  assert_draws(renderer[0], &alone[0], true);
  abbe_renderer_free(renderer[0]);
  abbe_context_free(on[0]);
}

TEST(two_renderers_on_one_context) {
  abbe_renderer *renderer[2];
  HELD(abbe_context, both) = make();
  for (int i = 0; i < 2; i++) renderer[i] = make_on(both, i);
  for (int k = 0; k < 4; k++) assert_draws(renderer[k & 1], &alone[k & 1], true);
  for (int i = 0; i < 2; i++) assert_draws(renderer[i], &alone[i], false);
  abbe_renderer_free(renderer[0]);
  assert_draws(renderer[1], &alone[1], true);
  abbe_renderer_free(renderer[1]);
}

/* A context that is the caller's. */
typedef struct host {
  abbe_context_native native;
  bool gone;
  size_t calls;
} host;

static abbe_context_native *native;

static abbe_gl_function look_up(const char *name) {
  return native->lookup(name);
}

static bool make_host_current(void *user) {
  host *h = user;
  h->calls++;
  native = &h->native;
  return !h->gone && native->make_current(native);
}

static void make_host(host *h) {
  *h = (host){0};
  OK(abbe_context_egl(true, 0, &h->native, &error));
  assert_true(make_host_current(h));
}

static abbe_context *adopt(host *h, bool told) {
  const abbe_context_host how = {look_up, told ? make_host_current : NULL, told ? h : NULL};
  abbe_context *adopted = NULL;
  OK(abbe_context_adopt(&how, &adopted, &error));
  return adopted;
}

/* The host's context is current, and takes its calls. */
static void assert_host_draws(void) {
  const PFNGLCLEARCOLORPROC clear_color = (PFNGLCLEARCOLORPROC)look_up("glClearColor");
  const PFNGLGETFLOATVPROC get = (PFNGLGETFLOATVPROC)look_up("glGetFloatv");
  const PFNGLGETERRORPROC get_error = (PFNGLGETERRORPROC)look_up("glGetError");
  GLfloat colour[4] = {0};
  assert_ptr_equal(eglGetCurrentContext(), native->handle[1]);
  clear_color(1, 0, 0.5f, 1);
  get(GL_COLOR_CLEAR_VALUE, colour);
  assert_true(colour[0] == 1 && colour[1] == 0 && colour[2] == 0.5f);
  assert_int_equal(get_error(), GL_NO_ERROR);
}

TEST(an_adopted_one_draws_the_same) {
  host h;
  make_host(&h);
  abbe_context *adopted = adopt(&h, false);
  assert_contains(abbe_context_description(adopted), "adopted: ");
  assert_contains(abbe_context_description(adopted), "OpenGL 4.");
  abbe_renderer *renderer = make_on(adopted, 0);
  assert_draws(renderer, &alone[0], true);
  abbe_renderer_free(renderer);
  abbe_context_free(adopted);
  assert_host_draws();
  h.native.destroy(&h.native);
}

/* Told how, Abbe makes it current itself, between others; one that is gone is said to be, and what
 * was drawn on others stays. */
TEST(an_adopted_one_beside_an_own) {
  host h;
  make_host(&h);
  abbe_context *own = make();
  abbe_renderer *other = make_on(own, 0);
  abbe_context *adopted = adopt(&h, true);
  abbe_renderer *renderer = make_on(adopted, 1);
  for (int k = 0; k < 2; k++) {
    assert_draws(other, &alone[0], true);
    assert_draws(renderer, &alone[1], true);
  }
  abbe_image image = {0};
  h.gone = true;
  REFUSED(ABBE_GL, "cannot be made current", abbe_renderer_read(renderer, false, &image, &error));
  assert_null(image.data);
  assert_draws(other, &alone[0], true);
  abbe_renderer_free(renderer); /* of what is current it deletes nothing */
  assert_draws(other, &alone[0], false);
  abbe_context_free(adopted);
  assert_draws(other, &alone[0], true);
  abbe_renderer_free(other);
  abbe_context_free(own);
  h.gone = false;
  assert_true(make_host_current(&h));
  assert_host_draws();
  h.native.destroy(&h.native);
}

/* Draws with another renderer in the midst of a frame, and leaves that one's context current. */
typedef struct meanwhile {
  abbe_renderer *other;
  const taken *expected;
  size_t calls;
} meanwhile;

static bool draw_meanwhile(void *user, double done) {
  meanwhile *m = user;
  assert_true(done >= 0 && done <= 1);
  if (m->calls++ % 8 == 0) assert_draws(m->other, m->expected, true);
  return true;
}

TEST(progress_may_draw_elsewhere) {
  abbe_context *on[2];
  abbe_renderer *renderer[2];
  for (int i = 0; i < 2; i++) on[i] = make();
  for (int i = 0; i < 2; i++) renderer[i] = make_on(on[i], i);
  meanwhile m = {renderer[1], &alone[1], 0};
  OK(abbe_renderer_frame(renderer[0], draw_meanwhile, &m, NULL, &error));
  assert_true(m.calls > 0);
  assert_draws(renderer[0], &alone[0], false);
  for (int i = 0; i < 2; i++) {
    abbe_renderer_free(renderer[i]);
    abbe_context_free(on[i]);
  }
}

static bool is_begun_by(const char *text, const char *const *names) {
  while (*names != NULL && strncmp(text, *names, strlen(*names)) != 0) names++;
  return *names != NULL;
}

static bool has_program(const abbe_gpu_store *store, const char *text) {
  for (size_t i = 0; i < store->count; i++)
    if (store->item[i].key.kind == ABBE_STORED_PROGRAM &&
        strcmp(store->item[i].key.text, text) == 0)
      return true;
  return false;
}

/* A renderer that draws with the camera alone, and smaller, has all of another's programs but those
 * of its light. */
TEST(what_is_compiled_ahead_is_what_the_camera_needs) {
  static const char *const of_light[] = {"photon_", "light_fit", "map_", NULL};
  abbe_render_desc whole = tiny, small = tiny;
  whole.width = 8 * small.width;
  whole.height = 8 * small.height;
  small.camera_alone = true;
  abbe_context *on = context = make();
  for (int i = 0; i < SCENES; i++) {
    abbe_renderer *renderer = make_renderer(&scenes[i], &whole);
    small.camera_tiles = renderer->atlas.used;
    abbe_renderer *ahead = make_renderer(&scenes[i], &small);
    const abbe_gpu_store *has = &ahead->gpu.store, *needs = &renderer->gpu.store;
    size_t found = 0;
    draw_frame(renderer);
    OK(abbe_renderer_frame(ahead, NULL, NULL, NULL, &error));
    for (size_t k = 0; k < needs->count; k++) {
      const char *text = needs->item[k].key.text;
      if (needs->item[k].key.kind != ABBE_STORED_PROGRAM || is_begun_by(text, of_light)) continue;
      if (!has_program(has, text)) fail_msg("it lacks %.60s", text);
      found++;
    }
    assert_true(found > 5);
    abbe_renderer_free(renderer);
    abbe_renderer_free(ahead);
  }
  abbe_context_free(on);
}

/* Beside one that compiles ahead for it, the light and the picture are the same; and it may end at
 * any time. */
TEST(one_compiles_ahead_of_another) {
  HELD(abbe_context, on) = make();
  for (int i = 0; i < SCENES; i++) {
    HELD(abbe_renderer, renderer) = make_on(on, i);
    abbe_renderer_begin_ahead(renderer, &scenes[i]);
    assert_non_null(renderer->ahead);
    assert_draws(renderer, &alone[i], true);
    assert_null(renderer->ahead);
    abbe_renderer_begin_ahead(renderer, &scenes[i]);
  }
}
