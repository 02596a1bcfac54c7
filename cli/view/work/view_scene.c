#include "cli/view/work/view_scene.h"

#include "base/number.h"
#include "cli/view/state/view_camera.h"
#include "scenes/import/scene_file.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

void abbe_view_scene_news_free(abbe_view_scene_news *news) {
  abbe_view_outline_free(&news->outline);
  for (size_t i = 0; i < news->file_count; i++) free(news->file[i]);
  free(news->file);
  *news = (abbe_view_scene_news){0};
}

void abbe_view_scene_drop(abbe_scene *scene) {
  abbe_scene_free(scene);
  free(scene);
}

void abbe_view_scene_free(abbe_view_scene *scene) {
  abbe_view_scene_drop(scene->now);
  abbe_view_document_free(&scene->document);
  *scene = (abbe_view_scene){0};
}

static bool is_place(const char *set) {
  return strncmp(set, "camera.eye=", 11) == 0 || strncmp(set, "camera.target=", 14) == 0;
}

static void read_place(const abbe_view_document *document, const char *key, double out[3]) {
  const char *text = abbe_view_document_value(document, key);
  double v[3];
  for (int k = 0; k < 3; k++) {
    if (text == NULL || (*text != '[' && *text != ',')) return;
    if (!abbe_number_read(text + 1, &text, &v[k])) return;
  }
  memcpy(out, v, sizeof v);
}

static void place_camera(abbe_view_scene *s, const abbe_view_document *document, double turn_rad) {
  s->now->camera = s->own;
  read_place(document, "camera.eye", s->now->camera.eye);
  read_place(document, "camera.target", s->now->camera.target);
  if (turn_rad != 0) abbe_view_camera_orbit(&s->now->camera, turn_rad, 0);
}

/* The document's changes but for the camera's place; `set` has capacity for all. */
static abbe_scene_options options_of(const abbe_view_scene *s, const abbe_view_document *d,
                                     const char *set[ABBE_VIEW_MOST_CHANGES]) {
  abbe_scene_options options = {.materials = s->materials, .set = set, .studio = d->studio};
  for (size_t i = 0; i < d->set_count; i++)
    if (!is_place(d->set[i])) set[options.set_count++] = d->set[i];
  return options;
}

/* With the camera as the file has it. */
static abbe_result tell(abbe_view_scene *s, abbe_view_scene_news *out, abbe_error *error) {
  const abbe_view_document *d = &s->document;
  const abbe_scene_options all = {
      .set = (const char *const *)d->set, .set_count = d->set_count, .studio = d->studio};
  char *text = NULL;
  size_t size = 0;
  s->now->camera = s->own;
  abbe_result result = abbe_scene_text(d->path, &all, &text, &size, error);
  if (result == ABBE_OK) result = abbe_view_outline_make(s->now, text, size, &out->outline, error);
  free(text);
  out->outlined = result == ABBE_OK;
  const size_t files = abbe_scene_file_count(s->now);
  out->file = calloc(files + 1, sizeof *out->file);
  for (size_t i = 0; out->file != NULL && i < files; i++) {
    const char *file = abbe_scene_file(s->now, i);
    if (file != NULL && (out->file[out->file_count] = strdup(file)) != NULL) out->file_count++;
  }
  return result;
}

/* What was read is of that document; takes it. */
static abbe_result adopt(abbe_view_scene *s, abbe_view_document *document,
                         abbe_view_scene_news *out, abbe_error *error) {
  abbe_view_document_free(&s->document);
  s->document = *document;
  return tell(s, out, error);
}

/* A camera that the file frames stays where it is while the objects in it are changed. */
static void keep_place(const abbe_camera *own, abbe_camera *now) {
  memcpy(now->eye, own->eye, sizeof now->eye);
  memcpy(now->target, own->target, sizeof now->target);
}

static abbe_result load(abbe_view_scene *s, const abbe_view_document *d, bool reload,
                        abbe_view_scene_news *out, abbe_error *error) {
  const bool same = !reload && s->document.path != NULL && strcmp(s->document.path, d->path) == 0;
  const char *set[ABBE_VIEW_MOST_CHANGES];
  const abbe_scene_options options = options_of(s, d, set);
  abbe_view_document kept;
  abbe_scene *scene = calloc(1, sizeof *scene);
  if (scene == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the scene");
  abbe_result result = abbe_scene_load(d->path, &options, scene, error);
  if (result == ABBE_OK) result = abbe_view_document_copy(d, &kept, error);
  if (result != ABBE_OK) {
    abbe_view_scene_drop(scene);
    return result;
  }
  if (same) keep_place(&s->own, &scene->camera);
  s->now = scene;
  s->own = scene->camera;
  return adopt(s, &kept, out, error);
}

static abbe_result relight(abbe_view_scene *s, const abbe_view_document *d,
                           abbe_view_scene_news *out, abbe_error *error) {
  const char *set[ABBE_VIEW_MOST_CHANGES];
  const abbe_scene_options options = options_of(s, d, set);
  abbe_view_document kept;
  ABBE_TRY(abbe_view_document_copy(d, &kept, error));
  abbe_result result = abbe_scene_load_lights(d->path, &options, s->now, error);
  if (result != ABBE_OK) {
    abbe_view_document_free(&kept);
    return result;
  }
  s->relit = true;
  return adopt(s, &kept, out, error);
}

abbe_result abbe_view_scene_take(abbe_view_scene *s, const abbe_view_document *document,
                                 bool reload, double turn_rad, abbe_view_scene_news *out,
                                 abbe_error *error) {
  const abbe_view_difference difference = s->now == NULL || reload
                                              ? ABBE_VIEW_CHANGED
                                              : abbe_view_document_compare(&s->document, document);
  if (difference == ABBE_VIEW_CHANGED) {
    const abbe_result result = load(s, document, reload, out, error);
    if (result != ABBE_OK) return result;
  }
  place_camera(s, document, turn_rad);
  const abbe_result result = difference == ABBE_VIEW_LIGHTS ? relight(s, document, out, error)
                                                            : abbe_scene_check(s->now, error);
  place_camera(s, document, turn_rad); /* which relight has put back */
  if (result != ABBE_OK) return result;
  s->document.wavelengths = document->wavelengths;
  s->document.photons = document->photons;
  s->document.map_size = document->map_size;
  return ABBE_OK;
}

void abbe_view_files_free(abbe_view_files *files) {
  for (size_t i = 0; i < files->count; i++) free(files->path[i]);
  free(files->path);
  free(files->changed);
  *files = (abbe_view_files){0};
}

static long long changed_at(const char *path) {
  struct stat status;
  if (stat(path, &status) != 0) return -1;
  return (long long)status.st_mtim.tv_sec * 1000000000 + status.st_mtim.tv_nsec;
}

void abbe_view_files_take(abbe_view_files *files, abbe_view_scene_news *news) {
  long long *changed = news->file != NULL ? calloc(news->file_count + 1, sizeof *changed) : NULL;
  if (changed == NULL) return;
  for (size_t i = 0; i < news->file_count; i++) {
    changed[i] = changed_at(news->file[i]);
    for (size_t k = 0; k < files->count; k++)
      if (strcmp(files->path[k], news->file[i]) == 0) changed[i] = files->changed[k];
  }
  abbe_view_files_free(files);
  *files = (abbe_view_files){news->file_count, news->file, changed};
  news->file = NULL;
  news->file_count = 0;
}

bool abbe_view_files_changed(abbe_view_files *files) {
  bool others = false;
  for (size_t i = 0; i < files->count; i++) {
    const long long at = changed_at(files->path[i]);
    if (at == files->changed[i] || at < 0) continue;
    files->changed[i] = at;
    others = true;
  }
  return others;
}
