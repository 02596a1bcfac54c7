/* The pictures of lib_scene.h that OpenGL draws. */
#include "gl/plan/facts/render_desc.h"
#include "library/lib_handles.h"
#include "library/lib_measure.h"
#include "library/lib_settings.h"

#include <stdio.h>
#include <stdlib.h>

typedef abbe_library_render_request request;

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

abbe_result abbe_library_render_request_read(const char *const *settings, size_t count, request *q,
                                             abbe_error *error) {
  abbe_lib_setting known[ABBE_LIB_SETTINGS_MOST] = {
      ABBE_LIB_CHOICE("backend", &q->backend, backends), ABBE_LIB_FLAG("redraw", &q->redraw)};
  size_t known_count = 2;
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
  s->desc = q->desc;
  s->desc.progress = NULL;
  if (q->redraw) abbe_renderer_redraw(s->renderer);
  return ABBE_OK;
}

abbe_result abbe_lib_scene_render(abbe_lib_scene *s, const char *const *settings, size_t count,
                                  abbe_lib_picture **out, abbe_error *error) {
  ABBE_REQUIRE(s && (settings || count == 0) && out, error);
  request q = {0};
  abbe_image image = {0};
  *out = NULL;
  ABBE_TRY(abbe_library_render_request_read(settings, count, &q, error));
  if (s->laid && !abbe_method_of(q.desc.profile)->own_passes) {
    q.desc.map_layout = &s->layout;
    q.desc.map_layout_light = s->laid_light;
  }
  q.desc.progress = s->progress;
  q.desc.progress_user = s->user;
  abbe_result result = prepare(s, &q, error);
  if (result == ABBE_OK)
    result = abbe_renderer_frame(s->renderer, s->progress, s->user, NULL, error);
  if (result == ABBE_OK)
    result = abbe_renderer_read_blurred(s->renderer, s->now, &q.desc, q.desc.aovs, s->progress,
                                        s->user, &image, error);
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

static abbe_result make_place(abbe_lib_scene *s, abbe_lib_picture **out, abbe_error *error) {
  static const char *const names[] = {"X", "Y", "Z"};
  const abbe_plan *plan = abbe_renderer_plan(s->renderer);
  abbe_map_layout layout;
  abbe_image image = {0};
  if (!plan->caustics || plan->light_view_count == 0)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s has no refractor that a light reaches: there is no map to compare",
                          s->path);
  if (plan->light_view[0].face >= 0)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the light '%s' of %s has a cube of maps and no single layout to compare "
                          "them by; trace a reference map and render with --map-like",
                          s->now->light[0].name, s->path);
  abbe_renderer_map_layout(s->renderer, 0, &layout);
  abbe_result result = abbe_image_make(1, 1, 3, names, &image, error);
  if (result == ABBE_OK)
    result = abbe_map_layout_write(&layout, s->now->light[0].name, &image, error);
  if (result == ABBE_OK) return abbe_library_picture_adopt(&image, out, error);
  abbe_image_free(&image);
  return result;
}

abbe_result abbe_lib_scene_place_map(abbe_lib_scene *s, const char *backend, abbe_lib_picture **out,
                                     abbe_error *error) {
  ABBE_REQUIRE(s && out, error);
  char text[64];
  request q = {0};
  *out = NULL;
  snprintf(text, sizeof text, "backend=%s", backend != NULL ? backend : "auto");
  abbe_result result = abbe_library_render_request_read((const char *const[]){text}, 1, &q, error);
  q.desc.width = q.desc.height = 16;
  if (result == ABBE_OK) result = prepare(s, &q, error);
  if (result == ABBE_OK) result = make_place(s, out, error);
  abbe_library_scene_drop_renderer(s); /* it has drawn nothing */
  return result;
}
