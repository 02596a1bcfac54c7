/* The pictures of lib_scene.h that the reference tracer makes. */
#include "library/choice/trace_times.h"
#include "library/lib_handles.h"
#include "library/lib_settings.h"
#include "validation/trace/denoise.h"
#include "validation/trace/tracer/checkpoint.h"
#include "validation/trace/tracer/trace_run.h"

#include <stdint.h>
#include <unistd.h>

enum { DEFAULT_PASSES = 64, MOST_PASSES = 1000000, CHECKPOINT_S = 30 };

typedef struct request {
  abbe_trace_desc desc;
  abbe_trace_run_desc run;
  const char *light;
  size_t seed, map_size;
  int physics, polarisation, space, observer;
  bool filter;
  abbe_map_layout layout;
} request;

#define NAME_OF_3(code, name, ocio) name,
static const char *const spaces[] = {ABBE_RGB_SPACES(NAME_OF_3)};
static const char *const observers[] = {ABBE_OBSERVERS(NAME_OF_3)};
static const char *const physics[] = {"full", "matched"};
static const char *const polarisations[] = {"auto", "on", "off"};

static abbe_result read_request(const char *const *settings, size_t count, request *q,
                                abbe_error *error) {
  abbe_trace_desc *d = &q->desc;
  const abbe_lib_setting known[] = {
      ABBE_LIB_COUNT("passes", &q->run.passes, 1, MOST_PASSES),
      ABBE_LIB_NUMBER("seconds", &q->run.seconds, 0.001, 1e9),
      ABBE_LIB_NUMBER("error", &q->run.error, 1e-9, 1e9),
      ABBE_LIB_COUNT("width", &d->width, 1, ABBE_TRACER_MAX_SIDE),
      ABBE_LIB_COUNT("height", &d->height, 1, ABBE_TRACER_MAX_SIDE),
      ABBE_LIB_COUNT("photons", &d->photons, 1, ABBE_TRACER_MAX_PHOTONS),
      ABBE_LIB_COUNT("bands", &d->bands, 1, 256),
      ABBE_LIB_COUNT("seed", &q->seed, 0, UINT32_MAX),
      ABBE_LIB_COUNT("threads", &d->threads, 1, ABBE_TRACER_MAX_THREADS),
      ABBE_LIB_NUMBER("min_nm", &d->min_nm, 1, 1e6),
      ABBE_LIB_NUMBER("max_nm", &d->max_nm, 1, 1e6),
      ABBE_LIB_CHOICE("space", &q->space, spaces),
      ABBE_LIB_CHOICE("observer", &q->observer, observers),
      ABBE_LIB_CHOICE("physics", &q->physics, physics),
      ABBE_LIB_CHOICE("polarisation", &q->polarisation, polarisations),
      ABBE_LIB_FLAG("filter", &q->filter),
      ABBE_LIB_COUNT("map_size", &q->map_size, 1, ABBE_TRACER_MAX_SIDE),
      ABBE_LIB_TEXT("light", &q->light),
      ABBE_LIB_TEXT("checkpoint", &q->run.checkpoint)};
  abbe_result result = abbe_library_settings_read("trace", known, sizeof known / sizeof *known,
                                                  settings, count, error);
  if (q->run.passes == 0 && q->run.seconds == 0 && q->run.error == 0)
    q->run.passes = DEFAULT_PASSES;
  d->seed = (uint32_t)q->seed;
  d->space = (abbe_rgb_space)q->space;
  d->observer = (abbe_observer)q->observer;
  d->polarisation = (abbe_trace_polarisation)q->polarisation;
  d->guides = q->filter;
  d->map_width = d->map_height = q->map_size;
  q->run.checkpoint_s = CHECKPOINT_S;
  if (result == ABBE_OK && q->filter && q->run.passes == 1)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "trace: the filter needs two passes or more");
  return result;
}

static abbe_result complete(const abbe_lib_scene *s, const abbe_lib_picture *like, request *q,
                            abbe_error *error) {
  abbe_trace_desc *d = &q->desc;
  abbe_result result = ABBE_OK;
  if (q->light != NULL) result = abbe_scene_find_light(s->now, q->light, &d->map_light, error);
  if (result == ABBE_OK && like != NULL) {
    result = abbe_map_layout_read(&like->image, "the map", &q->layout, error);
    d->layout = &q->layout;
    if (q->map_size == 0) d->map_width = like->image.width;
    if (q->map_size == 0) d->map_height = like->image.height;
  }
  if (result == ABBE_OK && q->physics == 1)
    result = abbe_matched_physics(s->now, d->min_nm, d->max_nm, &d->physics, error);
  return result;
}

static abbe_result take_picture(const request *q, const abbe_tracer *tracer, abbe_lib_picture **out,
                                abbe_error *error) {
  abbe_image image = {0}, filtered = {0};
  abbe_result result = abbe_tracer_picture(tracer, &image, error);
  if (result == ABBE_OK && q->filter && abbe_tracer_passes(tracer) >= 2) {
    const abbe_denoise_desc desc = {.threads = q->desc.threads};
    result = abbe_denoise_picture(&image, &desc, &filtered, error);
    abbe_image_free(&image);
    image = filtered;
  }
  if (result == ABBE_OK)
    result =
        abbe_image_set_attribute(&image, "abbe:space", abbe_rgb_space_name(q->desc.space), error);
  if (result == ABBE_OK) return abbe_library_picture_adopt(&image, out, error);
  abbe_image_free(&image);
  return result;
}

static abbe_result take_map(const abbe_tracer *tracer, abbe_lib_picture **out, abbe_error *error) {
  abbe_image image = {0};
  ABBE_TRY(abbe_tracer_map(tracer, &image, error));
  return abbe_library_picture_adopt(&image, out, error);
}

/* From the checkpoint on, where there is one; what is stopped is kept in it. */
static abbe_result run(abbe_tracer *tracer, const abbe_trace_run_desc *desc, abbe_error *error) {
  abbe_result result = ABBE_OK;
  if (desc->checkpoint != NULL && access(desc->checkpoint, F_OK) == 0)
    result = abbe_checkpoint_load(tracer, desc->checkpoint, error);
  if (result == ABBE_OK) result = abbe_trace_run(tracer, desc, error);
  if (result == ABBE_CANCELLED && abbe_trace_keep(tracer, desc, error) != ABBE_OK) return ABBE_IO;
  return result;
}

abbe_result abbe_lib_scene_trace(abbe_lib_scene *s, const char *const *settings, size_t count,
                                 const abbe_lib_picture *like, abbe_lib_picture **picture,
                                 abbe_lib_picture **map, abbe_error *error) {
  ABBE_REQUIRE(s && (settings || count == 0) && (picture || map), error);
  request q = {.desc = {.no_picture = picture == NULL, .no_map = map == NULL}};
  abbe_tracer *tracer = NULL;
  if (picture != NULL) *picture = NULL;
  if (map != NULL) *map = NULL;
  abbe_result result = read_request(settings, count, &q, error);
  if (result == ABBE_OK) result = complete(s, like, &q, error);
  if (result != ABBE_OK) return result;
  q.run.progress = s->progress;
  q.run.user = s->user;
  result = abbe_tracer_make(s->now, &q.desc, &tracer, error);
  if (result == ABBE_OK) result = run(tracer, &q.run, error);
  if (result == ABBE_OK && picture != NULL) result = take_picture(&q, tracer, picture, error);
  if (result == ABBE_OK && map != NULL) result = take_map(tracer, map, error);
  if (result != ABBE_OK && picture != NULL) {
    abbe_lib_picture_free(*picture);
    *picture = NULL;
  }
  abbe_tracer_free(tracer);
  return result;
}
