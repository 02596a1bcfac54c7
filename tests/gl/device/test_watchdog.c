/* Work that nobody watches: a GPU's driver ends a dispatch that takes seconds, so none has more than
 * so many groups, and what is cut gives what is whole. llvmpipe stands in for a GPU. */
#include "tests/gl/frame.h"

#include "gl/device/gpu.h"

enum { MOST = 5 };

static bool as_gpu, cut;
static abbe_gl real;
static size_t dispatches, most_seen;

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
  abbe_scene scene = {0};
  abbe_error error = {0};
  char path[512];
  snprintf(path, sizeof path, ABBE_SOURCE_DIR "/scenes/%s.yaml", file);
  assert_ok(abbe_scene_load(path, NULL, &scene, &error), &error);
  abbe_renderer *renderer = make_renderer(&scene, &small_frame);
  dispatches = most_seen = 0;
  draw_frame(renderer);
  read_picture(renderer, false, picture);
  read_map(renderer, 0, map);
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
}

static void test_no_dispatch_is_long(void **state) {
  (void)state;
  abbe_image picture[2], map[2];
  size_t count_of[2];
  as_gpu = true;
  assert_int_equal(make_context(NULL), 0);
  for (int i = 0; i < 2; i++) {
    cut = i == 1;
    draw("gem", &picture[i], &map[i]);
    count_of[i] = dispatches;
    if (i == 0) assert_true(most_seen > 4 * MOST); /* there is something to cut */
  }
  assert_true(most_seen <= MOST);
  assert_true(count_of[1] > 2 * count_of[0]);
  assert_same_pixels(&map[0], &map[1]);
  assert_same_pixels(&picture[0], &picture[1]);
  for (int i = 0; i < 2; i++) {
    abbe_image_free(&picture[i]);
    abbe_image_free(&map[i]);
  }
  free_context(NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_no_dispatch_is_long)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
