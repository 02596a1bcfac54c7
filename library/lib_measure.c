#define _GNU_SOURCE /* open_memstream */
#include "library/lib_measure.h"

#include "base/number.h"
#include "gl/accuracy/frame_times.h"
#include "gl/accuracy/preset.h"
#include "gl/plan/facts/render_desc.h"
#include "library/choice/trace_times.h"
#include "library/lib_handles.h"
#include "library/lib_settings.h"
#include "scenes/view/map_layout.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_REPEATS = 16, MOST_PASSES = 65536, PARTS = 4 };

/* ---- texts ---- */

typedef struct answer {
  char *text;
  size_t size;
  FILE *to;
} answer;

static abbe_result begin(answer *a, abbe_error *error) {
  *a = (answer){0};
  a->to = open_memstream(&a->text, &a->size);
  return a->to != NULL ? ABBE_OK
                       : abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for an answer");
}

/* Given where all went well, else freed. */
static abbe_result end(answer *a, abbe_result result, char **out, abbe_error *error) {
  const bool written = a->to == NULL || (fflush(a->to) == 0 && ferror(a->to) == 0);
  if (a->to != NULL && fclose(a->to) != 0) a->text = NULL;
  if (result == ABBE_OK && (!written || a->text == NULL))
    result = abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for an answer");
  if (result == ABBE_OK)
    *out = a->text;
  else
    free(a->text);
  return result;
}

void abbe_lib_text_free(char *text) {
  free(text);
}

static void put(FILE *to, const char *key, double value) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  if (isfinite(value)) fprintf(to, "%s=%s\n", key, abbe_number_text(value, text));
}

static void put_settings(FILE *to, const abbe_render_desc *desc, char after) {
  abbe_render_desc d = *desc;
  char text[ABBE_NUMBER_TEXT_SIZE];
  for (size_t i = 0; i < abbe_render_settings_count; i++) {
    const abbe_render_setting *s = &abbe_render_settings[i];
    const void *at = abbe_render_setting_in(s, &d);
    fprintf(to, "%s=", s->key);
    if (s->kind == ABBE_SETTING_COUNT) fprintf(to, "%zu", *(const size_t *)at);
    if (s->kind == ABBE_SETTING_NUMBER)
      fprintf(to, "%s", abbe_number_text(*(const double *)at, text));
    if (s->kind == ABBE_SETTING_FLAG) fprintf(to, "%d", *(const bool *)at);
    if (s->kind == ABBE_SETTING_CHOICE) fprintf(to, "%s", s->names[*(const int *)at]);
    fputc(after, to);
  }
}

/* ---- plans ---- */

/* Faces of the refractors; *general: one of them is a general mesh. */
static size_t count_faces(const abbe_scene *scene, bool *general) {
  size_t faces = 0;
  *general = false;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *object = &scene->object[i];
    if (abbe_object_kind_of(object) != ABBE_OBJECT_REFRACTOR) continue;
    faces += object->mesh.face_count;
    *general |= object->exact.kind == ABBE_EXACT_NONE;
  }
  return faces;
}

abbe_result abbe_lib_scene_plan(const abbe_lib_scene *s, const char *const *settings, size_t count,
                                char **out, abbe_error *error) {
  ABBE_REQUIRE(s && (settings || count == 0) && out, error);
  abbe_library_render_request q = {0};
  abbe_plan plan;
  answer a;
  *out = NULL;
  abbe_result result = abbe_library_render_request_read(settings, count, &q, error);
  if (result == ABBE_OK) result = abbe_plan_make(s->now, &q.desc, &plan, error);
  if (result != ABBE_OK) return result;
  result = begin(&a, error);
  if (result == ABBE_OK) {
    bool general;
    const size_t faces = count_faces(s->now, &general);
    fprintf(a.to, "class=%s\nhash=%016llx\nsize=%zux%zu\nmesh=%d\nmesh_faces=%zu\n",
            abbe_preset_class_name(abbe_preset_class_of(&plan)), abbe_scene_hash(s->now),
            s->now->camera.width, s->now->camera.height, general, faces);
    fprintf(a.to, "caustics=%d\nlight_views=%zu\n", plan.caustics, plan.light_view_count);
    if (s->context != NULL) fprintf(a.to, "device=%s\n", abbe_context_description(s->context));
    put_settings(a.to, &plan.desc, '\n');
  }
  abbe_plan_free(&plan);
  return end(&a, result, out, error);
}

abbe_result abbe_lib_scene_lay_map(abbe_lib_scene *s, const abbe_lib_picture *like,
                                   abbe_error *error) {
  ABBE_REQUIRE(s, error);
  abbe_map_layout layout = {0};
  size_t light = 0;
  if (like != NULL) {
    const char *name = abbe_image_attribute_text(&like->image, "abbe:map_light");
    ABBE_TRY(abbe_map_layout_read(&like->image, "the map", &layout, error));
    if (name != NULL) ABBE_TRY(abbe_scene_find_light(s->now, name, &light, error));
  }
  /* the renderer is not to look at a layout that is gone */
  abbe_library_scene_drop_renderer(s);
  s->laid = like != NULL;
  s->layout = layout;
  s->laid_light = light;
  return ABBE_OK;
}

/* ---- times ---- */

static abbe_result take_picture(abbe_lib_scene *s, abbe_lib_picture **picture, abbe_error *error) {
  abbe_image image = {0};
  ABBE_TRY(abbe_renderer_read(s->renderer, false, &image, error));
  return abbe_library_picture_adopt(&image, picture, error);
}

static abbe_result time_frames(abbe_lib_scene *s, const abbe_frame_times_desc *desc, FILE *to,
                               abbe_error *error) {
  abbe_frame_times times;
  ABBE_TRY(abbe_frame_times_measure(s->renderer, desc, &times, error));
  const abbe_statistics *m = &times.median;
  const abbe_ledger *e = &m->energy;
  put(to, "frame_ms", m->frame_ms);
  put(to, "fastest_ms", times.fastest_ms);
  put(to, "light_ms", abbe_statistics_stage_ms(m, ABBE_STAGE_LIGHT));
  put(to, "eye_ms", abbe_statistics_stage_ms(m, ABBE_STAGE_EYE));
  put(to, "photons", (double)m->photons);
  put(to, "refractor_share", m->refractor_share);
  put(to, "device_bytes", (double)m->device_bytes);
  if (m->polygon_layers > 0) put(to, "polygon_layers", m->polygon_layers);
  /* What is bridged while it is deposited is in the ledger, which sums the map itself. */
  const double parts =
      e->reflected + e->absorbed + e->trapped + e->missed + e->deposited - e->interpolated;
  if (e->deposited > 0) put(to, "invented", fmax(parts - e->reached, 0) / e->deposited);
  if (e->deposited > 0) put(to, "lost", fmax(e->reached - parts, 0) / e->deposited);
  return ABBE_OK;
}

abbe_result abbe_lib_scene_times(abbe_lib_scene *s, const char *const *settings, size_t count,
                                 abbe_lib_picture **picture, char **out, abbe_error *error) {
  ABBE_REQUIRE(s && (settings || count == 0) && out, error);
  abbe_frame_times_desc desc = {.progress = s->progress, .user = s->user};
  size_t baseline = 0, camera = 0;
  double ms = NAN;
  answer a;
  const abbe_lib_setting known[] = {ABBE_LIB_COUNT("frames", &desc.frames, 0, ABBE_FRAME_TIMES_MAX),
                                    ABBE_LIB_NUMBER("enough_ms", &desc.enough_ms, 0, 1e9),
                                    ABBE_LIB_COUNT("baseline", &baseline, 0, MOST_REPEATS),
                                    ABBE_LIB_COUNT("camera", &camera, 0, MOST_REPEATS)};
  *out = NULL;
  if (picture != NULL) *picture = NULL;
  if (s->renderer == NULL || s->held != s->now)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "no picture of the scene as it is has been rendered; times are of one");
  ABBE_TRY(abbe_library_settings_read("times", known, sizeof known / sizeof *known, settings, count,
                                      error));
  abbe_result result = begin(&a, error);
  if (result == ABBE_OK && desc.frames > 0) result = time_frames(s, &desc, a.to, error);
  if (result == ABBE_OK && picture != NULL) result = take_picture(s, picture, error);
  if (result == ABBE_OK && baseline > 0) {
    result = abbe_frame_times_baseline(s->renderer, baseline, &ms, error);
    if (result == ABBE_OK) put(a.to, "baseline_ms", ms);
  }
  if (result == ABBE_OK && camera > 0) {
    result = abbe_frame_times_camera(s->renderer, s->now, &s->desc, camera, &ms, error);
    if (result == ABBE_OK) put(a.to, "camera_ms", ms);
  }
  result = end(&a, result, out, error);
  if (result != ABBE_OK && picture != NULL) {
    abbe_lib_picture_free(*picture);
    *picture = NULL;
  }
  return result;
}

abbe_result abbe_lib_scene_trace_times(abbe_lib_scene *s, const char *const *settings, size_t count,
                                       abbe_lib_picture **picture, char **out, abbe_error *error) {
  ABBE_REQUIRE(s && (settings || count == 0) && out, error);
  abbe_trace_times_desc desc = {
      .passes = 2, .photons = 512, .frames = 1, .progress = s->progress, .user = s->user};
  abbe_trace_times times;
  abbe_image image = {0};
  answer a;
  const abbe_lib_setting known[] = {
      ABBE_LIB_COUNT("passes", &desc.passes, 1, MOST_PASSES),
      ABBE_LIB_COUNT("photons", &desc.photons, 1, ABBE_RENDER_MAX_PHOTONS),
      ABBE_LIB_FLAG("filter", &desc.filtered),
      ABBE_LIB_COUNT("width", &desc.width, 1, ABBE_RENDER_MAX_SIDE),
      ABBE_LIB_COUNT("height", &desc.height, 1, ABBE_RENDER_MAX_SIDE),
      ABBE_LIB_COUNT("frames", &desc.frames, 1, ABBE_FRAME_TIMES_MAX),
      ABBE_LIB_NUMBER("enough_ms", &desc.enough_ms, 0, 1e9)};
  *out = NULL;
  if (picture != NULL) *picture = NULL;
  abbe_result result = abbe_library_settings_read("trace", known, sizeof known / sizeof *known,
                                                  settings, count, error);
  if (result == ABBE_OK)
    result =
        abbe_trace_times_measure(s->now, &desc, &times, picture != NULL ? &image : NULL, error);
  if (result != ABBE_OK) return result;
  result = begin(&a, error);
  if (result == ABBE_OK) {
    put(a.to, "frame_ms", times.frame_ms);
    put(a.to, "fastest_ms", times.fastest_ms);
    put(a.to, "light_ms", times.light_ms);
    put(a.to, "eye_ms", times.eye_ms);
    put(a.to, "own_de", times.own_de);
  }
  result = end(&a, result, out, error);
  if (result == ABBE_OK && picture != NULL)
    result = abbe_library_picture_adopt(&image, picture, error);
  abbe_image_free(&image);
  return result;
}

/* ---- maps ---- */

abbe_result abbe_lib_picture_resample(const abbe_lib_picture *map, const abbe_lib_picture *like,
                                      abbe_lib_picture **out, abbe_error *error) {
  ABBE_REQUIRE(map && like && out, error);
  abbe_map_layout layout;
  abbe_image moved = {0};
  *out = NULL;
  size_t parts =
      map->image.width > 0 ? PARTS * (1 + (like->image.width - 1) / map->image.width) : 1;
  if (parts > ABBE_MAP_RESAMPLE_MAX_PARTS) parts = ABBE_MAP_RESAMPLE_MAX_PARTS;
  ABBE_TRY(abbe_map_layout_read(&like->image, "the other map", &layout, error));
  ABBE_TRY(abbe_map_resample(&map->image, "the map", &layout, like->image.width, like->image.height,
                             parts, &moved, error));
  return abbe_library_picture_adopt(&moved, out, error);
}

/* ---- presets ---- */

static const char *name_of(const abbe_preset_front *front, size_t point) {
  for (int i = 0; i < ABBE_PRESET_COUNT; i++)
    if (front->named[i] == point) return abbe_preset_name_text((abbe_preset_name)i);
  return "";
}

static void put_front(FILE *to, const abbe_presets *presets, const abbe_preset_front *front) {
  char text[3][ABBE_NUMBER_TEXT_SIZE];
  fprintf(to, "error=%s\nerror_text=%s\nscenes=%s\n", presets->error, presets->error_text,
          front->scenes);
  put(to, "margin", front->margin);
  put(to, "time_margin", front->time_margin);
  for (size_t i = 0; i < front->count; i++) {
    const abbe_preset_point *p = &front->point[i];
    fprintf(to, "point=%s ", name_of(front, i));
    put_settings(to, &p->desc, ' ');
    fprintf(to, "light_ms=%s eye_ms=%s error=%s\n", abbe_number_text(p->light_ms, text[0]),
            abbe_number_text(p->eye_ms, text[1]), abbe_number_text(p->error, text[2]));
  }
}

abbe_result abbe_lib_presets_read(const char *path, const char *of, char **out, abbe_error *error) {
  ABBE_REQUIRE(of && out, error);
  abbe_presets presets = {0};
  answer a;
  *out = NULL;
  ABBE_TRY(abbe_presets_load(path, &presets, error));
  abbe_result result = begin(&a, error);
  for (size_t i = 0; result == ABBE_OK && i < presets.count; i++)
    if (strcmp(abbe_preset_class_name(presets.front[i].of), of) == 0)
      put_front(a.to, &presets, &presets.front[i]);
  abbe_presets_free(&presets);
  return end(&a, result, out, error);
}
