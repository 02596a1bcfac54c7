/* Memory barriers: what a shader has written is read, in whatever way, behind the barrier of that
 * way. llvmpipe needs few of them, so no picture shows on it that one is missing: here every call
 * is recorded, with what each program declares, which must not be more than is promised. A frame is
 * drawn three times, for buffers are used again. With --long also the programs that a GPU takes. */
#include "tests/gl/frame.h"

#include "tests/gl/device/recorded_gl.h"

static void draw_three(const char *file) {
  abbe_scene scene = {0};
  const char *path = printed(ABBE_SOURCE_DIR "/scenes/%s.yaml", file);
  forget();
  make_context();
  OK(abbe_scene_load(path, NULL, &scene, &error));
  abbe_renderer *renderer = make_renderer(&scene, &small_frame);
  for (int i = 0; i < 3; i++) draw_frame(renderer);
  OWNED(abbe_image, picture) = aovs_of(renderer);
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
  free_context();
  if (hazards > 0) print_error("%zu of %s%s\n", hazards, file, as_gpu ? ", as on a GPU" : "");
}

TEST(what_is_written_is_read_behind_its_barrier) {
  static const char *const scenes[] = {"gem",   "diamond-studio", "water/shafts", "metal-ring",
                                       "glass", "prism",          "rainbow",      "bunny"};
  const size_t count = all_cases() ? sizeof scenes / sizeof *scenes : 4;
  hazards = 0;
  for (as_gpu = false;; as_gpu = true) {
    for (size_t i = 0; i < count; i++) draw_three(scenes[i]);
    if (as_gpu || !all_cases()) break;
  }
  assert_int_equal(hazards, 0);
  for (size_t i = 0; i < SHADERS; i++) free(text[i]);
}
