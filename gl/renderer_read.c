#include "gl/renderer_state.h"

#include "base/clock.h"
#include "base/maths.h"
#include "gl/caustics/caustics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static abbe_result check_drawn(const abbe_renderer *r, abbe_error *error) {
  if (r->seen) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "no frame has been drawn, so there is nothing to read; "
                        "abbe_renderer_frame comes first");
}

static abbe_rgb_space space_of(const abbe_renderer *r) {
  return abbe_method_of(r->plan.desc.profile)->printed ? ABBE_RGB_SPACE_REC709 : r->plan.desc.space;
}

/* Whose colours they are; printed methods have their own. */
static abbe_result set_observer(const abbe_renderer *r, abbe_image *out, abbe_error *error) {
  const abbe_render_desc *d = &r->plan.desc;
  if (abbe_method_of(d->profile)->printed) return ABBE_OK;
  return abbe_image_set_attribute(out, "abbe:observer", abbe_observer_text(d->observer), error);
}

static abbe_result read_picture(abbe_renderer *r, bool aovs, abbe_image *out, abbe_error *error) {
  ABBE_TRY(check_drawn(r, error));
  ABBE_TRY(r->method != NULL ? abbe_method_read(r->method, out, error)
                             : abbe_picture_read(&r->picture, aovs, r->local.unit, out, error));
  const abbe_rgb_space space = space_of(r);
  abbe_rgb_space_chromaticities(space, out->xy);
  abbe_result result =
      abbe_image_set_attribute(out, "abbe:space", abbe_rgb_space_name(space), error);
  if (result == ABBE_OK) result = set_observer(r, out, error);
  if (result == ABBE_OK) result = abbe_scene_mark_exposure(r->scene.local, out, error);
  if (result == ABBE_OK) result = abbe_gl_check(r->gpu.gl, "the reading of the picture", error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}

static abbe_result check_map(const abbe_renderer *r, size_t light, abbe_error *error) {
  if (light >= r->plan.light_view_count || !r->plan.reaches[light] ||
      r->plan.light_view[light].light != light)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the scene has no spectral map of light %zu", light);
  if (r->plan.volume)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "caustics are looked up in a volume, so there is no spectral map");
  ABBE_TRY(check_drawn(r, error));
  if (r->method != NULL && r->plan.desc.faces > 1)
    return abbe_error_set(
        error, ABBE_UNSUPPORTED,
        "the light '%s' has a cube of maps, each with its own layout; ask for one "
        "view (--faces 1), or for the picture",
        r->scene.local->light[light].name);
  if (r->method != NULL || !abbe_photon_lights_is_face(&r->views, light) ||
      abbe_photon_lights_map_is_given(&r->views, light))
    return ABBE_OK;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "the light '%s' has a cube of maps, each with its own layout; give one "
                        "layout for all, such as that of a traced map (--map-like)",
                        r->scene.local->light[light].name);
}

/* A map that was read gets its layout and its light's name; of one that was not nothing is left. */
static abbe_result describe_map(const abbe_renderer *r, size_t light, abbe_result result,
                                abbe_image *out, abbe_error *error) {
  abbe_map_layout layout;
  abbe_renderer_map_layout(r, light, &layout);
  if (result == ABBE_OK)
    result = abbe_map_layout_write(&layout, r->scene.local->light[light].name, out, error);
  if (result == ABBE_OK) result = set_observer(r, out, error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}

static abbe_result read_map(abbe_renderer *r, size_t light, bool filled, abbe_image *out,
                            abbe_error *error) {
  ABBE_TRY(check_map(r, light, error));
  ABBE_TRY(r->method != NULL ? abbe_method_read_map(r->method, filled, out, error)
                             : abbe_spectral_map_read(&r->map, light, r->local.unit, out, error));
  abbe_result result = abbe_gl_check(r->gpu.gl, "the reading of the map", error);
  return describe_map(r, light, result, out, error);
}

static abbe_result read_map_bands(abbe_renderer *r, size_t light, size_t bands, abbe_image *out,
                                  abbe_error *error) {
  if (bands < 1 || bands > ABBE_RENDER_MAX_BANDS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a map of %zu bands; it may have 1 to %d",
                          bands, ABBE_RENDER_MAX_BANDS);
  if (r->method != NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the %s profile's passes sum colours; bands go with the default profile",
                          abbe_profile_name(r->plan.desc.profile));
  if (r->plan.desc.history > 1)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "bands are of one frame, not of a history of %zu", r->plan.desc.history);
  ABBE_TRY(check_map(r, light, error));
  abbe_result result = abbe_map_bands_read(&r->caustics, light, bands, r->local.unit, out, error);
  if (result != ABBE_OK) r->lit = r->seen = false; /* the map may hold bands */
  return describe_map(r, light, result, out, error);
}

void abbe_renderer_map_layout(const abbe_renderer *r, size_t light, abbe_map_layout *out) {
  *out = r->method != NULL ? r->method->layout : r->views.light[light].map;
  abbe_local_scene_to_world(&r->local, &out->view);
}

static abbe_result read_hits(abbe_renderer *r, size_t light, size_t first, abbe_renderer_hits *out,
                             abbe_error *error) {
  const abbe_result made = abbe_renderer_check(r, error);
  if (made != ABBE_OK) return made;
  if (light >= r->plan.light_view_count || !r->plan.reaches[light] || r->method != NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "no photons start from light %zu", light);
  if (first >= r->plan.desc.wavelengths)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "wavelength %zu of %zu is asked for", first,
                          r->plan.desc.wavelengths);
  const abbe_photon_light *from = &r->views.light[light];
  out->slots = r->plan.hit_slots;
  out->samples = r->caustics.trace.hits.stride;
  out->view = from->near_view;
  abbe_local_scene_to_world(&r->local, &out->view);
  for (int k = 0; k < 2; k++) out->grid[k] = from->cells[k];
  return abbe_caustics_read_hits(&r->caustics, light, first, r->local.origin, &out->at, &out->path,
                                 &out->cell, &out->count, error);
}

static abbe_result draw_baseline(abbe_renderer *r, double *ms, abbe_error *error) {
  static const int first = 0;
  static const GLfloat nothing[4] = {0, 0, 0, 0};
  const size_t *samples = r->camera.receiver_samples;
  const abbe_gl *gl = r->gpu.gl;
  ABBE_TRY(abbe_renderer_check(r, error));
  if (r->method != NULL)
    return abbe_error_set(error, ABBE_UNSUPPORTED, "the %s profile has no baseline of its own",
                          abbe_profile_name(r->plan.desc.profile));
  if (r->baseline == 0) /* the picture may be what lies in the receivers' colour, and stays */
    ABBE_TRY(abbe_gpu_make_texture(&r->gpu, GL_RGBA32F, samples[0], samples[1], 1, false,
                                   &r->baseline, error));
  gl->Finish();
  const double start_ms = 1e3 * abbe_clock_seconds();
  abbe_refractor_faces_use(&r->faces, &r->camera.view);
  ABBE_TRY(abbe_gpu_set_target(&r->gpu, &r->baseline, &first, 1, r->receivers.depth, samples[0],
                               samples[1], error));
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  abbe_gpu_begin_depths(&r->gpu, true);
  for (size_t i = 0; i < r->scene.local->object_count; i++) abbe_seen_meshes_draw(&r->meshes, i);
  abbe_gpu_end_depths(&r->gpu);
  gl->Finish();
  *ms = 1e3 * abbe_clock_seconds() - start_ms;
  return abbe_gl_check(gl, "the drawing of surfaces", error);
}

abbe_result abbe_renderer_baseline(abbe_renderer *r, double *ms, abbe_error *error) {
  ABBE_TRY(abbe_renderer_enter(r->context, error));
  return abbe_renderer_leave(r->context, draw_baseline(r, ms, error));
}

abbe_result abbe_renderer_read(abbe_renderer *r, bool aovs, abbe_image *out, abbe_error *error) {
  *out = (abbe_image){0};
  ABBE_TRY(abbe_renderer_enter(r->context, error));
  return abbe_renderer_leave(r->context, read_picture(r, aovs, out, error));
}

/* Evenly spread over the disk: a spiral by the golden angle [Vogel1979]. */
static void place_on_lens(size_t i, size_t count, double out[2]) {
  const double far = sqrt(((double)i + 0.5) / (double)count);
  const double turn = ABBE_PI * (3 - sqrt(5)) * (double)i;
  out[0] = far * cos(turn);
  out[1] = far * sin(turn);
}

/* One of the pictures of the mean: of one sample a pixel, which lies elsewhere in each, as no place
 * is the same. */
static abbe_render_desc take_place(size_t i, size_t count, bool jitters,
                                   const abbe_render_desc *all) {
  abbe_render_desc own = *all;
  place_on_lens(i, count, own.lens_place);
  own.aovs = false;
  if (!jitters) return own;
  own.supersample = own.receiver_samples = own.adaptive = 1;
  own.lens_turn = count % 4 == 0 ? i + 1 : 0;
  own.sample_shift[0] = fmod(0.7548776662 * ((double)i + 0.5), 1) - 0.5; /* [Roberts2018] */
  own.sample_shift[1] = fmod(0.5698402910 * ((double)i + 0.5), 1) - 0.5;
  return own;
}

/* Adds a share of the picture's first three channels, its colours. */
static void add_colours(const abbe_image *image, double share, abbe_image *sum) {
  for (size_t i = 0; i < sum->width * sum->height; i++)
    for (size_t c = 0; c < 3; c++)
      sum->data[i * sum->channels + c] +=
          (float)(share * (double)image->data[i * image->channels + c]);
}

abbe_result abbe_renderer_read_blurred(abbe_renderer *r, const abbe_scene *scene,
                                       const abbe_render_desc *desc, bool aovs,
                                       abbe_render_progress progress, void *user, abbe_image *out,
                                       abbe_error *error) {
  const size_t count = r->plan.desc.lens;
  const bool jitters = r->plan.desc.supersample > 1 && r->plan.desc.upsample == 1;
  ABBE_TRY(abbe_renderer_read(r, aovs, out, error));
  if (!(scene->camera.aperture > 0) || count < 2 || r->method != NULL) return ABBE_OK;
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < out->width * out->height; i++)
    memset(out->data + i * out->channels, 0, 3 * sizeof *out->data);
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    abbe_image image = {0};
    const abbe_render_desc own = take_place(i, count, jitters, desc);
    result = abbe_renderer_change(r, scene, &own, error);
    if (result == ABBE_OK) result = abbe_renderer_frame(r, NULL, NULL, NULL, error);
    if (result == ABBE_OK) result = abbe_renderer_read(r, false, &image, error);
    if (result == ABBE_OK) add_colours(&image, 1 / (double)count, out);
    abbe_image_free(&image);
    if (result == ABBE_OK && progress != NULL && !progress(user, (double)(i + 1) / (double)count))
      result = abbe_error_set(error, ABBE_CANCELLED, "stopped after %zu of %zu places on the lens",
                              i + 1, count);
  }
  if (result == ABBE_OK) result = abbe_renderer_change(r, scene, desc, error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}

abbe_result abbe_renderer_read_map(abbe_renderer *r, size_t light, bool filled, abbe_image *out,
                                   abbe_error *error) {
  *out = (abbe_image){0};
  ABBE_TRY(abbe_renderer_enter(r->context, error));
  return abbe_renderer_leave(r->context, read_map(r, light, filled, out, error));
}

abbe_result abbe_renderer_read_map_bands(abbe_renderer *r, size_t light, size_t bands,
                                         abbe_image *out, abbe_error *error) {
  *out = (abbe_image){0};
  ABBE_TRY(abbe_renderer_enter(r->context, error));
  return abbe_renderer_leave(r->context, read_map_bands(r, light, bands, out, error));
}

abbe_result abbe_renderer_read_hits(abbe_renderer *r, size_t light, size_t first,
                                    abbe_render_progress progress, void *user,
                                    abbe_renderer_hits *out, abbe_error *error) {
  *out = (abbe_renderer_hits){0};
  abbe_error lost = {0};
  abbe_renderer_watched w = {
      .context = r->context, .progress = progress, .user = user, .error = &lost};
  ABBE_TRY(abbe_renderer_enter(r->context, error));
  abbe_gpu_watch(&r->gpu, progress != NULL ? abbe_renderer_watch : NULL, &w);
  abbe_result result = read_hits(r, light, first, out, error);
  if (result == ABBE_OK) result = abbe_gpu_tell(&r->gpu, 1, error);
  abbe_gpu_watch(&r->gpu, NULL, NULL);
  if (w.result != ABBE_OK) result = abbe_error_set(error, w.result, "%s", lost.text);
  if (w.result == ABBE_OK) result = abbe_renderer_leave(r->context, result);
  if (result != ABBE_OK) abbe_renderer_hits_free(out);
  return result;
}

void abbe_renderer_hits_free(abbe_renderer_hits *hits) {
  if (hits == NULL) return;
  free(hits->at);
  free(hits->path);
  free(hits->cell);
  *hits = (abbe_renderer_hits){0};
}
