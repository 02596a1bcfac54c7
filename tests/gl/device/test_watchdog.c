/* Work that nobody watches: a GPU's driver ends what takes seconds, so no dispatch has more than so
 * many groups, no draw that computes much more fragments, and what is cut gives what is whole.
 * llvmpipe stands in for a GPU. */
#include "tests/gl/frame.h"

#include "gl/device/gpu.h"
#include "gl/photons/photon_paths.h"

enum { MOST = 8, THREADS = MOST * ABBE_GPU_GROUP, TILE = 64 * 64 };

static bool as_gpu, cut, scissored, photons_by_device;
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

bool __real_abbe_photon_paths_serve(const abbe_trace_pass *pass, const abbe_shader_variant *v);
bool __wrap_abbe_photon_paths_serve(const abbe_trace_pass *pass, const abbe_shader_variant *v);
bool __wrap_abbe_photon_paths_serve(const abbe_trace_pass *pass, const abbe_shader_variant *v) {
  return !photons_by_device && __real_abbe_photon_paths_serve(pass, v);
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
      photons_by_device = true; /* so that all have the same hits */
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

typedef struct photons {
  abbe_renderer_hits hits;
  abbe_ledger ledger;
  abbe_image map;
} photons;

/* layout: of the map; given where it is not all zero. */
static void follow(const char *file, abbe_map_layout *layout, photons *out) {
  static const abbe_map_layout unknown;
  const bool given = memcmp(layout, &unknown, sizeof unknown) != 0;
  OWNED(abbe_scene, scene) = shipped_scene(file);
  look_aside(&scene);
  abbe_render_desc desc = frame;
  desc.map_layout = given ? layout : NULL;
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
  out->ledger = draw_frame(renderer).energy;
  out->map = map_of(renderer, 0);
  if (!given) abbe_renderer_map_layout(renderer, 0, layout);
  OK(abbe_renderer_read_hits(renderer, 0, 0, NULL, NULL, &out->hits, &error));
}

/* Hits of a photon in both, and those that lie apart or have another flux. */
static void compare_photon(const float *a, const float *b, const unsigned *paths_a,
                           const unsigned *paths_b, size_t count, size_t *all, size_t *odd) {
  for (size_t i = 0; i < count; i++, a += 4, b += 4) {
    double apart = 0;
    for (int k = 0; k < 3; k++) apart = fmax(apart, fabs((double)a[k] - (double)b[k]));
    *all += paths_b[i] != 0;
    *odd += paths_a[i] != paths_b[i] || apart > 1e-4 || /* m, or texels of a tile */
            fabs((double)a[3] - (double)b[3]) > 1e-3 * (double)b[3];
  }
}

/* Photons of clear meshes that the processor's own threads follow (photon_paths.h) land where
 * photon_trace.comp has them, but for those whose rounding many interfaces magnify. */
TEST(processor_and_device_follow_the_same_photons) {
  static const char *const files[] = {"glass", "ring"};
  as_gpu = cut = false;
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    abbe_map_layout layout = {0};
    photons of[2] = {{.map = {0}}, {.map = {0}}};
    for (int k = 0; k < 2; k++) {
      photons_by_device = k == 0;
      make_context();
      follow(files[i], &layout, &of[k]);
      free_context();
    }
    const abbe_renderer_hits *here = &of[1].hits, *there = &of[0].hits;
    const size_t each = here->slots * here->samples;
    size_t all = 0, odd = 0;
    assert_int_equal(here->count, there->count);
    assert_memory_equal(here->grid, there->grid, sizeof here->grid);
    for (size_t p = 0; p < here->count; p++) {
      size_t q = 0;
      while (q < there->count && there->cell[q] != here->cell[p]) q++;
      assert_true(q < there->count);
      compare_photon(here->at + 4 * each * p, there->at + 4 * each * q, here->path + each * p,
                     there->path + each * q, each, &all, &odd);
    }
    const double light = apart_by((abbe_image[2]){of[1].map, of[0].map});
    print_message("%s: %zu of %zu hits differ, apart by %g of the light\n", files[i], odd, all,
                  light);
    assert_true(all > here->count && odd * 200 < all);
    assert_near(light, 0, 1e-3);
    assert_near(of[1].ledger.reached / of[0].ledger.reached, 1, 1e-5);
    assert_near(of[1].ledger.missed / of[0].ledger.missed, 1, 1e-4);
    assert_near(of[1].ledger.trapped / of[0].ledger.trapped, 1, 1e-3);
    for (int k = 0; k < 2; k++) {
      abbe_renderer_hits_free(&of[k].hits);
      abbe_image_free(&of[k].map);
    }
  }
  photons_by_device = false;
}
