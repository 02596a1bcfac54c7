/* The pictures of lib_scene.h that OpenGL draws. */
#include "gl/plan/facts/render_settings.h"
#include "library/lib_handles.h"
#include "library/lib_settings.h"

#include <stdlib.h>

typedef struct request {
  abbe_render_desc desc;
  int backend;
} request;

#define NAME_OF(code, name) name,
static const char *const backends[] = {ABBE_CONTEXT_BACKENDS(NAME_OF)};

static abbe_lib_setting row_of(const abbe_render_setting *s, abbe_render_desc *desc) {
  static const abbe_lib_setting_kind kinds[] = {[ABBE_SETTING_COUNT] = ABBE_LIB_SETTING_COUNT,
                                                [ABBE_SETTING_NUMBER] = ABBE_LIB_SETTING_NUMBER,
                                                [ABBE_SETTING_FLAG] = ABBE_LIB_SETTING_FLAG,
                                                [ABBE_SETTING_CHOICE] = ABBE_LIB_SETTING_CHOICE};
  return (abbe_lib_setting){.key = s->key,
                            .kind = kinds[s->kind],
                            .value = abbe_render_setting_in(s, desc),
                            .least = s->least,
                            .most = s->most,
                            .names = s->names,
                            .names_count = s->name_count};
}

/* The table's settings, and the device. */
static abbe_result read_request(const char *const *settings, size_t count, request *q,
                                abbe_error *error) {
  abbe_lib_setting known[ABBE_LIB_SETTINGS_MOST] = {
      ABBE_LIB_CHOICE("backend", &q->backend, backends)};
  size_t known_count = 1;
  for (size_t i = 0; i < abbe_render_settings_count && known_count < ABBE_LIB_SETTINGS_MOST; i++)
    known[known_count++] = row_of(&abbe_render_settings[i], &q->desc);
  return abbe_library_settings_read("render", known, known_count, settings, count, error);
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
  const bool printed = abbe_method_of(q.desc.profile)->printed;
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
