/* Work that nobody watches: a GPU's driver ends what takes seconds, so no dispatch has more than so
 * many groups, no draw that computes much more fragments, and what is cut gives what is whole.
 * llvmpipe stands in for a GPU. */
#include "tests/gl/frame.h"

#include "gl/device/gpu.h"

enum { MOST = 8, THREADS = MOST * ABBE_GPU_GROUP, TILE = 64 * 64 };

static bool as_gpu, cut, scissored;
static abbe_gl real;
static size_t dispatches, most_seen;
static size_t viewport, scissor; /* texels */
/* Of draws over the target, of draws of surfaces in parts of it, and of draws without buffers. */
static size_t screen_seen, part_seen, things_seen;

static abbe_render_desc frame = {
    .width = 128, .height = 96, .supersample = 2, .photons = 64, .map_size = 128};

static void count(size_t groups) {
  dispatches++;
  if (groups > most_seen) most_seen = groups;
}

static void APIENTRY dispatch(GLuint x, GLuint y, GLuint z) {
  count((size_t)x * y * z);
  real.DispatchCompute(x, y, z);
}

static void APIENTRY dispatch_indirect(GLintptr at) {
  GLuint groups[3];
  real.MemoryBarrier(GL_ALL_BARRIER_BITS);
  real.GetBufferSubData(GL_DISPATCH_INDIRECT_BUFFER, at, sizeof groups, groups);
  count((size_t)groups[0] * groups[1] * groups[2]);
  real.DispatchComputeIndirect(at);
}

static void note(size_t *most, size_t seen) {
  if (seen > *most) *most = seen;
}

static void APIENTRY set_viewport(GLint x, GLint y, GLsizei width, GLsizei height) {
  viewport = (size_t)width * (size_t)height;
  real.Viewport(x, y, width, height);
}

static void APIENTRY set_scissor(GLint x, GLint y, GLsizei width, GLsizei height) {
  scissor = (size_t)width * (size_t)height;
  real.Scissor(x, y, width, height);
}

static void APIENTRY enable(GLenum what) {
  scissored = scissored || what == GL_SCISSOR_TEST;
  real.Enable(what);
}

static void APIENTRY disable(GLenum what) {
  scissored = scissored && what != GL_SCISSOR_TEST;
  real.Disable(what);
}

static void APIENTRY draw_arrays(GLenum mode, GLint first, GLsizei vertices) {
  if (vertices == 3)
    note(&screen_seen, scissored && scissor < viewport ? scissor : viewport);
  else
    note(&things_seen, (size_t)vertices);
  real.DrawArrays(mode, first, vertices);
}

static void APIENTRY draw_elements(GLenum mode, GLsizei count, GLenum type, const void *at) {
  if (scissored) note(&part_seen, scissor);
  real.DrawElements(mode, count, type, at);
}

static const GLubyte *APIENTRY get_string(GLenum name) {
  return name == GL_RENDERER && as_gpu ? (const GLubyte *)"as a GPU" : real.GetString(name);
}

abbe_result __real_abbe_gl_load(abbe_gl_lookup lookup, abbe_gl *out, abbe_error *error);
abbe_result __wrap_abbe_gl_load(abbe_gl_lookup lookup, abbe_gl *out, abbe_error *error);
abbe_result __wrap_abbe_gl_load(abbe_gl_lookup lookup, abbe_gl *out, abbe_error *error) {
  const abbe_result result = __real_abbe_gl_load(lookup, out, error);
  real = *out;
  out->DispatchCompute = dispatch;
  out->DispatchComputeIndirect = dispatch_indirect;
  out->GetString = get_string;
  out->Viewport = set_viewport;
  out->Scissor = set_scissor;
  out->Enable = enable;
  out->Disable = disable;
  out->DrawArrays = draw_arrays;
  out->DrawElements = draw_elements;
  return result;
}

abbe_result __real_abbe_gpu_make(const abbe_gl *gl, abbe_gpu *out, abbe_error *error);
abbe_result __wrap_abbe_gpu_make(const abbe_gl *gl, abbe_gpu *out, abbe_error *error);
abbe_result __wrap_abbe_gpu_make(const abbe_gl *gl, abbe_gpu *out, abbe_error *error) {
  const abbe_result result = __real_abbe_gpu_make(gl, out, error);
  assert_true(as_gpu ? out->most_groups < 1 << 16 : out->most_groups == SIZE_MAX);
  if (cut) out->most_groups = MOST;
  return result;
}

static void draw(const char *file, abbe_image *picture, abbe_image *map) {
  MADE(abbe_scene, scene,
       abbe_scene_load(printed(ABBE_SOURCE_DIR "/scenes/%s.yaml", file), NULL, &scene, &error));
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &frame);
  dispatches = most_seen = screen_seen = part_seen = things_seen = 0;
  draw_frame(renderer);
  *picture = picture_of(renderer);
  *map = map_of(renderer, 0);
}

/* Beams add up in the order in which threads have listed them, which is another each time. */
static void assert_same_sums(const abbe_image *a, const abbe_image *b) {
  assert_int_equal(a->width * a->height * a->channels, b->width * b->height * b->channels);
  double most = 0, apart = 0;
  for (size_t i = 0; i < a->width * a->height * a->channels; i++) {
    most = fmax(most, fabs((double)a->data[i]));
    apart = fmax(apart, fabs((double)a->data[i] - (double)b->data[i]));
  }
  assert_near(apart / most, 0, 1e-5);
}

/* things: something is drawn without buffers. */
static void cut_as_whole(const char *file, bool things) {
  abbe_image picture[2], map[2];
  size_t count_of[2];
  for (int i = 0; i < 2; i++) {
    cut = i == 1;
    draw(file, &picture[i], &map[i]);
    count_of[i] = dispatches;
    if (i == 1) continue;
    /* there is something to cut */
    assert_true(most_seen > 4 * MOST && screen_seen > 4 * THREADS && part_seen > 4 * TILE);
    assert_true(things_seen > 4 * THREADS || !things);
  }
  assert_true(most_seen <= MOST && screen_seen <= THREADS && part_seen <= TILE);
  assert_true(things_seen <= THREADS);
  assert_true(count_of[1] > 2 * count_of[0]);
  assert_same_pixels(&map[0], &map[1]);
  if (things)
    assert_same_sums(&picture[0], &picture[1]);
  else
    assert_same_pixels(&picture[0], &picture[1]);
  for (int i = 0; i < 2; i++) {
    abbe_image_free(&picture[i]);
    abbe_image_free(&map[i]);
  }
}

TEST(no_work_is_long) {
  as_gpu = true;
  make_context();
  cut_as_whole("gem", false);
  cut_as_whole("mist/prism", true);
  free_context();
}

static double apart_by(const abbe_image of[2]) {
  double all = 0, apart = 0;
  for (size_t k = 0; k < of[0].width * of[0].height * of[0].channels; k++) {
    all += fabs((double)of[1].data[k]);
    apart += fabs((double)of[0].data[k] - (double)of[1].data[k]);
  }
  assert_true(all > 0);
  return apart / all;
}

/* What the processor's own threads do for llvmpipe (path_splats.h, splat_sums.h, camera_paths.h), a
 * GPU's shaders do alike, but for rounding: as much light in the same texels, and pixels that show
 * the same, of which a few see other faces. */
TEST(processor_and_device_lay_and_see_the_same_light) {
  static const char *const files[] = {"gem", "glass", "ring"};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    abbe_image picture[2], map[2];
    for (int k = 0; k < 2; k++) {
      cut = false;
      as_gpu = k == 1;
      make_context();
      draw(files[i], &picture[k], &map[k]);
      free_context();
    }
    const double light = apart_by(map), seen = apart_by(picture);
    print_message("%s: apart by %g of the light, %g of the picture\n", files[i], light, seen);
    assert_near(light, 0, 3e-5);
    assert_near(seen, 0, 5e-4);
    for (int k = 0; k < 2; k++) {
      abbe_image_free(&picture[k]);
      abbe_image_free(&map[k]);
    }
  }
}
