#include "gl/renderer.h"

#include "gl/caustics/map_bands.h"
#include "gl/renderer_parts.h"

#include <stdlib.h>
#include <string.h>

static bool is_thesis(const abbe_renderer *r) {
  return abbe_profile_is_thesis(r->plan.desc.profile);
}

abbe_result abbe_renderer_make(abbe_context *context, const abbe_scene *scene,
                               const abbe_render_desc *desc, abbe_renderer **out,
                               abbe_error *error) {
  ABBE_REQUIRE(context && scene && out, error);
  *out = NULL;
  abbe_renderer *r = calloc(1, sizeof *r);
  if (r == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a renderer");
  r->software = strstr(abbe_context_description(context), "llvmpipe") != NULL;
  abbe_result result = abbe_gpu_make(abbe_context_gl(context), &r->gpu, error);
  if (result == ABBE_OK) result = abbe_renderer_parts_change(r, scene, desc, error);
  if (result != ABBE_OK) {
    abbe_renderer_free(r);
    return result;
  }
  *out = r;
  return ABBE_OK;
}

void abbe_renderer_free(abbe_renderer *r) {
  if (r == NULL) return;
  abbe_renderer_parts_free(r);
  free(r);
}

abbe_result abbe_renderer_change(abbe_renderer *r, const abbe_scene *scene,
                                 const abbe_render_desc *desc, abbe_error *error) {
  ABBE_REQUIRE(r && scene, error);
  return abbe_renderer_parts_change(r, scene, desc, error);
}

void abbe_renderer_redraw(abbe_renderer *r) {
  r->lit = r->seen = false;
}

const abbe_plan *abbe_renderer_plan(const abbe_renderer *r) {
  return &r->plan;
}

abbe_result abbe_renderer_frame(abbe_renderer *r, abbe_render_progress progress, void *user,
                                abbe_statistics *statistics, abbe_error *error) {
  ABBE_REQUIRE(r, error);
  return abbe_renderer_parts_draw(r, progress, user, statistics, error);
}

abbe_result abbe_renderer_baseline(abbe_renderer *r, double *ms, abbe_error *error) {
  ABBE_REQUIRE(r && ms, error);
  return abbe_renderer_parts_baseline(r, ms, error);
}

static abbe_result check_drawn(const abbe_renderer *r, abbe_error *error) {
  if (r->seen) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "no frame has been drawn, so there is nothing to read; "
                        "abbe_renderer_frame comes first");
}

abbe_result abbe_renderer_read(abbe_renderer *r, bool layers, abbe_image *out, abbe_error *error) {
  ABBE_REQUIRE(r && out, error);
  *out = (abbe_image){0};
  abbe_result result = check_drawn(r, error);
  if (result != ABBE_OK) return result;
  result = is_thesis(r) ? abbe_thesis_read(&r->thesis, out, error)
                        : abbe_picture_read(&r->picture, layers, r->local.unit, out, error);
  if (result != ABBE_OK) return result;
  const abbe_rgb_space space =
      r->plan.desc.profile == ABBE_PROFILE_THESIS ? ABBE_RGB_SPACE_REC709 : r->plan.desc.space;
  abbe_rgb_space_chromaticities(space, out->xy);
  result = abbe_image_set_attribute(out, "abbe:space", abbe_rgb_space_name(space), error);
  if (result == ABBE_OK) result = abbe_gl_check(r->gpu.gl, "the reading of the picture", error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}

static abbe_result check_map(const abbe_renderer *r, size_t light, abbe_error *error) {
  if (light >= r->plan.light_view_count || !r->plan.reaches[light] ||
      r->plan.light_view[light].light != light)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the scene has no spectral map of light %zu", light);
  abbe_result result = check_drawn(r, error);
  if (result != ABBE_OK) return result;
  if (is_thesis(r) || !abbe_photon_lights_is_face(&r->views, light) ||
      abbe_photon_lights_map_is_given(&r->views, light))
    return ABBE_OK;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "the light '%s' has a cube of maps, each with its own layout; give one "
                        "layout for all, such as that of a traced map (--map-like)",
                        r->scene.local->light[light].name);
}

abbe_result abbe_renderer_read_map(abbe_renderer *r, size_t light, bool filled, abbe_image *out,
                                   abbe_error *error) {
  ABBE_REQUIRE(r && out, error);
  *out = (abbe_image){0};
  abbe_result result = check_map(r, light, error);
  if (result != ABBE_OK) return result;
  result = is_thesis(r) ? abbe_thesis_read_map(&r->thesis, filled, out, error)
                        : abbe_spectral_map_read(&r->map, light, r->local.unit, out, error);
  if (result != ABBE_OK) return result;
  result = abbe_gl_check(r->gpu.gl, "the reading of the map", error);
  abbe_map_layout layout;
  abbe_renderer_map_layout(r, light, &layout);
  if (result == ABBE_OK)
    result = abbe_map_layout_write(&layout, r->scene.local->light[light].name, out, error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}

abbe_result abbe_renderer_read_map_bands(abbe_renderer *r, size_t light, size_t bands,
                                         abbe_image *out, abbe_error *error) {
  ABBE_REQUIRE(r && out, error);
  *out = (abbe_image){0};
  if (bands < 1 || bands > ABBE_RENDER_MAX_BANDS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a map of %zu bands; it may have 1 to %d",
                          bands, ABBE_RENDER_MAX_BANDS);
  if (is_thesis(r))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the thesis's passes sum colours; bands go with the default profile");
  abbe_result result = check_map(r, light, error);
  if (result != ABBE_OK) return result;
  result = abbe_map_bands_read(&r->caustics, light, bands, r->local.unit, out, error);
  abbe_map_layout layout;
  abbe_renderer_map_layout(r, light, &layout);
  if (result == ABBE_OK)
    result = abbe_map_layout_write(&layout, r->scene.local->light[light].name, out, error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}

void abbe_renderer_map_layout(const abbe_renderer *r, size_t light, abbe_map_layout *out) {
  *out = is_thesis(r) ? r->thesis.layout : r->views.light[light].map;
  abbe_local_scene_to_world(&r->local, &out->view);
}

void abbe_renderer_photon_view(const abbe_renderer *r, size_t light, abbe_view *out) {
  *out = r->views.light[light].near_view;
  abbe_local_scene_to_world(&r->local, out);
}

abbe_result abbe_renderer_read_hits(abbe_renderer *r, size_t light, float **data, unsigned **cells,
                                    size_t *count, size_t *slots, size_t *samples,
                                    abbe_error *error) {
  ABBE_REQUIRE(r && data && count && slots && samples, error);
  *data = NULL;
  if (light >= r->plan.light_view_count || !r->plan.reaches[light] || is_thesis(r))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "no photons start from light %zu", light);
  *slots = r->plan.hit_slots;
  *samples = r->caustics.trace.hits.stride;
  return abbe_caustics_read_hits(&r->caustics, light, r->local.origin, data, cells, count, error);
}
