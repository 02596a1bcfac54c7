#include "gl/pinholes/pinhole_pages.h"

#include "scenes/geometry/vector.h"
#include "scenes/lights/environment_lights.h"

enum {
  UNIT = 5,
  LEAST_SIDE = 16,
  MAP_TEXELS = 8, /* of the spectral map, a side, for one of a page */
  LEAST_CUBE = 16,
  MOST_CUBE = 512,
  AT_ONCE = 8, /* samples of a pass: a thread has so many turns of loops (refraction_walk.glsl) */
  ROUGH_AT_ONCE = 1, /* where each has several ways */
  SKY_UNIT = 4 /* for the camera; that of front and back layers, which there are none of then */
};

/* As sharp as what is around. */
static size_t cube_side(const abbe_radiance_map *map) {
  size_t side = LEAST_CUBE;
  while (side < MOST_CUBE && 4 * side < map->width) side *= 2;
  return side;
}

static abbe_result make_sky(const abbe_gpu_scene *scene, abbe_pinhole_sky *out, abbe_error *error) {
  const abbe_environment *e = scene->local->environment;
  abbe_radiance_map left;
  abbe_result result =
      e == NULL ? abbe_radiance_map_make(4 * LEAST_CUBE, &left, error) /* dark */
                : abbe_environment_lights_leave(e, scene->local->environment_lights, &left, error);
  if (result != ABBE_OK) return result;
  result = abbe_pinhole_sky_make(scene, &left, cube_side(&left), out, error);
  abbe_radiance_map_free(&left);
  return result;
}

abbe_result abbe_pinhole_pages_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                                    abbe_pinhole_pages *out, abbe_error *error) {
  const abbe_render_desc *d = &scene->plan->desc;
  if (d->transport != ABBE_TRANSPORT_PINHOLE) return ABBE_OK;
  abbe_shader_variant follows = *variant;
  follows.exits = scene->plan->eye_exits;
  out->scene = scene;
  out->side = d->map_size / MAP_TEXELS > LEAST_SIDE ? d->map_size / MAP_TEXELS : LEAST_SIDE;
  out->count = 2 * scene->plan->parallelogram_count;
  abbe_result result = abbe_pinhole_samples_make(scene, false, &out->samples, error);
  if (result == ABBE_OK) result = make_sky(scene, &out->sky, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_texture(scene->gpu, GL_RGBA32F, out->side, out->side, out->count, true,
                                   &out->texture, error);
  if (result == ABBE_OK)
    result = abbe_shader_variant_compute(
        &follows, scene->gpu, "pinhole_pages.comp",
        d->footprint == ABBE_FOOTPRINT_ON ? "#define FOOTPRINTS\n" : NULL, &out->fill, error);
  return result;
}

void abbe_pinhole_pages_free(abbe_pinhole_pages *pages) {
  if (pages->scene == NULL) return;
  abbe_pinhole_samples_free(pages->scene->gpu, &pages->samples);
  abbe_pinhole_sky_free(pages->scene->gpu, &pages->sky);
  abbe_gpu_drop_textures(pages->scene->gpu, 1, &pages->texture);
  *pages = (abbe_pinhole_pages){0};
}

/* Whether some of the refractors' bounds is before that side of a parallelogram. */
static bool sees_refractors(const abbe_gpu_scene *scene, const double p[9], bool back) {
  double n[3], to[3];
  abbe_vector_cross(p + 3, p + 6, n);
  abbe_vector_normalise(n);
  abbe_vector_subtract(scene->refractor_centre, p, to);
  return (back ? -1 : 1) * abbe_vector_dot(n, to) > -scene->refractor_radius;
}

/* The pages' parallelograms, as the shaders count them. */
static abbe_result fill_page(abbe_pinhole_pages *pages, size_t page, abbe_error *error) {
  abbe_gpu *gpu = pages->scene->gpu;
  const size_t all = pages->samples.count;
  const size_t step = pages->scene->plan->rough ? ROUGH_AT_ONCE : AT_ONCE;
  abbe_result result = ABBE_OK;
  abbe_gpu_set_int(gpu, pages->fill, "page", (int)page);
  for (size_t i = 0; i < all && result == ABBE_OK; i += step) {
    abbe_gpu_set_int(gpu, pages->fill, "first_pinhole", (int)i);
    abbe_gpu_set_int(gpu, pages->fill, "end_pinhole", (int)(i + step < all ? i + step : all));
    abbe_gpu_dispatch_2d(gpu, pages->fill, pages->side, pages->side);
    gpu->gl->MemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    if (gpu->progress != NULL && !abbe_gpu_ask(gpu))
      result = abbe_error_set(error, ABBE_CANCELLED, "the render was cancelled");
  }
  return result;
}

static abbe_result clear(abbe_pinhole_pages *pages, abbe_error *error) {
  static const int all = -1;
  static const GLfloat nothing[4] = {0, 0, 0, 0};
  abbe_result result = abbe_gpu_set_target(pages->scene->gpu, &pages->texture, &all, 1, 0,
                                           pages->side, pages->side, error);
  if (result == ABBE_OK) pages->scene->gpu->gl->ClearBufferfv(GL_COLOR, 0, nothing);
  return result;
}

static void begin(abbe_pinhole_pages *pages) {
  const abbe_gpu_scene *scene = pages->scene;
  const abbe_gl *gl = scene->gpu->gl;
  abbe_gpu_scene_bind(scene);
  gl->UseProgram(pages->fill);
  abbe_gpu_scene_set(scene, pages->fill);
  abbe_pinhole_samples_bind(scene, &pages->samples, pages->fill);
  abbe_pinhole_sky_set(scene, &pages->sky, ABBE_PINHOLE_SKY_UNIT, pages->fill);
  abbe_gpu_set_float(scene->gpu, pages->fill, "share_limit", scene->plan->eye_share);
  abbe_gpu_set_float(scene->gpu, pages->fill, "seen_off", 1e-4 * scene->refractor_radius);
  abbe_gpu_set_int(scene->gpu, pages->fill, "pinhole_count", (int)pages->samples.count);
  gl->BindImageTexture(0, pages->texture, 0, GL_TRUE, 0, GL_READ_WRITE, GL_RGBA32F);
}

abbe_result abbe_pinhole_pages_run(abbe_pinhole_pages *pages, abbe_error *error) {
  if (pages->scene == NULL) return ABBE_OK;
  const abbe_plan *plan = pages->scene->plan;
  size_t page = 0;
  abbe_gpu_start_lap(pages->scene->gpu);
  abbe_result result = clear(pages, error);
  if (result != ABBE_OK) return result;
  begin(pages);
  for (size_t i = 0; i < plan->receiver_count; i++) {
    const abbe_exact *exact = &pages->scene->local->object[plan->receiver_object[i]].exact;
    for (size_t k = 0; k < 2 * exact->count && result == ABBE_OK; k++, page++)
      if (sees_refractors(pages->scene, exact->parallelogram[k / 2], k % 2 != 0))
        result = fill_page(pages, page, error);
  }
  pages->scene->gpu->gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  abbe_gpu_book_lap(pages->scene->gpu, ABBE_PASS_PINHOLES);
  return result;
}

void abbe_pinhole_pages_set(const abbe_pinhole_pages *pages, GLuint program) {
  if (pages->scene == NULL) return;
  abbe_gpu_bind_array(pages->scene->gpu, program, "pinhole_pages", UNIT, pages->texture);
  if (pages->scene->plan->rough) abbe_pinhole_sky_set(pages->scene, &pages->sky, SKY_UNIT, program);
}
