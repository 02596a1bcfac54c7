/* The pictures of lib_scene.h that OpenGL draws. */
#include "library/lib_handles.h"
#include "library/lib_settings.h"

#include <stdlib.h>

typedef struct request {
  abbe_render_desc desc;
  int profile, fill, model, transport, strategy, footprint, space, observer, backend;
} request;

#define NAME_OF_2(code, name) name,
#define NAME_OF_3(code, name, ocio) name,
static const char *const profiles[] = {ABBE_PROFILES(NAME_OF_2)};
static const char *const fills[] = {ABBE_FILLS(NAME_OF_2)};
static const char *const models[] = {ABBE_MODELS(NAME_OF_2)};
static const char *const transports[] = {ABBE_TRANSPORTS(NAME_OF_2)};
static const char *const strategies[] = {ABBE_SAMPLE_STRATEGIES(NAME_OF_2)};
static const char *const footprints[] = {ABBE_FOOTPRINTS(NAME_OF_2)};
static const char *const spaces[] = {ABBE_RGB_SPACES(NAME_OF_3)};
static const char *const observers[] = {ABBE_OBSERVERS(NAME_OF_3)};
static const char *const backends[] = {ABBE_CONTEXT_BACKENDS(NAME_OF_2)};

static abbe_result read_request(const char *const *settings, size_t count, request *q,
                                abbe_error *error) {
  abbe_render_desc *d = &q->desc;
  const abbe_lib_setting known[] = {
      ABBE_LIB_COUNT("width", &d->width, 1, ABBE_RENDER_MAX_SIDE),
      ABBE_LIB_COUNT("height", &d->height, 1, ABBE_RENDER_MAX_SIDE),
      ABBE_LIB_COUNT("wavelengths", &d->wavelengths, 1, ABBE_RENDER_MAX_WAVELENGTHS),
      ABBE_LIB_NUMBER("min_nm", &d->min_nm, 1, 1e6),
      ABBE_LIB_NUMBER("max_nm", &d->max_nm, 1, 1e6),
      ABBE_LIB_COUNT("photons", &d->photons, 1, ABBE_RENDER_MAX_PHOTONS),
      ABBE_LIB_COUNT("map_size", &d->map_size, 1, ABBE_RENDER_MAX_MAP),
      ABBE_LIB_COUNT("supersample", &d->supersample, 1, 4),
      ABBE_LIB_COUNT("upsample", &d->upsample, 1, 4),
      ABBE_LIB_COUNT("adaptive", &d->adaptive, 1, ABBE_RENDER_MAX_ADAPTIVE),
      ABBE_LIB_COUNT("receiver_samples", &d->receiver_samples, 1, 4),
      ABBE_LIB_COUNT("environment_lights", &d->environment_lights, 1,
                     ABBE_RENDER_MAX_ENVIRONMENT_LIGHTS),
      ABBE_LIB_COUNT("light_points", &d->light_points, 1, ABBE_RENDER_MAX_LIGHT_POINTS),
      ABBE_LIB_COUNT("exits", &d->exits, 1, ABBE_RENDER_MAX_EXITS),
      ABBE_LIB_NUMBER("energy_share", &d->energy_share, 0, 1),
      ABBE_LIB_CHOICE("profile", &q->profile, profiles),
      ABBE_LIB_CHOICE("fill", &q->fill, fills),
      ABBE_LIB_CHOICE("model", &q->model, models),
      ABBE_LIB_CHOICE("transport", &q->transport, transports),
      ABBE_LIB_COUNT("pinholes", &d->pinholes, 1, ABBE_SURFACE_MAX_SAMPLES),
      ABBE_LIB_COUNT("clusters", &d->clusters, 1, ABBE_RENDER_MAX_CLUSTERS),
      ABBE_LIB_CHOICE("strategy", &q->strategy, strategies),
      ABBE_LIB_CHOICE("footprint", &q->footprint, footprints),
      ABBE_LIB_CHOICE("space", &q->space, spaces),
      ABBE_LIB_CHOICE("observer", &q->observer, observers),
      ABBE_LIB_CHOICE("backend", &q->backend, backends),
      ABBE_LIB_FLAG("aovs", &d->aovs)};
  abbe_result result = abbe_library_settings_read("render", known, sizeof known / sizeof *known,
                                                  settings, count, error);
  d->profile = (abbe_profile)q->profile;
  d->fill = (abbe_fill)q->fill;
  d->model = (abbe_model)q->model;
  d->transport = (abbe_transport)q->transport;
  d->strategy = (abbe_sample_strategy)q->strategy;
  d->footprint = (abbe_footprint)q->footprint;
  d->space = (abbe_rgb_space)q->space;
  d->observer = (abbe_observer)q->observer;
  return result;
}

/* The renderer takes over the scene as it is now; what it held before is freed. */
static abbe_result prepare(abbe_lib_scene *s, const request *q, abbe_error *error) {
  abbe_result result = ABBE_OK;
  if (s->context == NULL)
    result = abbe_context_make((abbe_context_backend)q->backend, &s->context, error);
  if (result != ABBE_OK) return result;
  result = s->renderer == NULL
               ? abbe_renderer_make(s->context, s->now, &q->desc, &s->renderer, error)
               : abbe_renderer_change(s->renderer, s->now, &q->desc, error);
  if (result != ABBE_OK) {
    abbe_library_scene_drop_renderer(s);
    return result;
  }
  if (s->held != s->now && s->held != NULL) {
    abbe_scene_free(s->held);
    free(s->held);
  }
  s->held = s->now;
  return ABBE_OK;
}

abbe_result abbe_lib_scene_render(abbe_lib_scene *s, const char *const *settings, size_t count,
                                  abbe_lib_picture **out, abbe_error *error) {
  ABBE_REQUIRE(s && (settings || count == 0) && out, error);
  request q = {0};
  abbe_image image = {0};
  *out = NULL;
  abbe_result result = read_request(settings, count, &q, error);
  if (result != ABBE_OK) return result;
  q.desc.progress = s->progress;
  q.desc.progress_user = s->user;
  result = prepare(s, &q, error);
  if (result == ABBE_OK)
    result = abbe_renderer_frame(s->renderer, s->progress, s->user, NULL, error);
  if (result == ABBE_OK) result = abbe_renderer_read(s->renderer, q.desc.aovs, &image, error);
  if (result == ABBE_OK) result = abbe_image_set_attribute(&image, "abbe:scene", s->path, error);
  const bool printed = abbe_profile_is_printed(q.desc.profile);
  if (result == ABBE_OK)
    result = abbe_image_set_attribute(
        &image, "abbe:unit", printed ? "display brightness" : "radiance, W/(m2 sr)", error);
  if (result == ABBE_OK) return abbe_library_picture_adopt(&image, out, error);
  abbe_image_free(&image);
  return result;
}

abbe_result abbe_lib_scene_map(abbe_lib_scene *s, const char *light, size_t bands,
                               abbe_lib_picture **out, abbe_error *error) {
  ABBE_REQUIRE(s && out, error);
  abbe_image image = {0};
  size_t index = 0;
  *out = NULL;
  if (s->renderer == NULL || s->held != s->now)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "no picture of the scene as it is has been rendered; a map is of one");
  abbe_result result = ABBE_OK;
  if (light != NULL) result = abbe_scene_find_light(s->now, light, &index, error);
  if (result == ABBE_OK)
    result = bands > 0 ? abbe_renderer_read_map_bands(s->renderer, index, bands, &image, error)
                       : abbe_renderer_read_map(s->renderer, index, true, &image, error);
  if (result != ABBE_OK) return result;
  result = abbe_image_set_attribute(&image, "abbe:unit", "flux a texel, W", error);
  if (result == ABBE_OK) return abbe_library_picture_adopt(&image, out, error);
  abbe_image_free(&image);
  return result;
}
