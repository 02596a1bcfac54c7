#include "library/lib_scene.h"

#include "base/maths.h"
#include "library/lib_handles.h"
#include "scenes/import/scene_file.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static abbe_result no_memory(abbe_error *error) {
  return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for the scene");
}

/* ---- the texts of values that are set ---- */

static void free_texts(char **text, size_t count) {
  for (size_t i = 0; text != NULL && i < count; i++) free(text[i]);
  free(text);
}

/* Those of the scene and `more` behind them, as copies; NULL for want of memory. */
static char **join_texts(const abbe_lib_scene *s, const char *const *more, size_t count) {
  const size_t all = s->set_count + count;
  char **out = calloc(all + 1, sizeof *out);
  for (size_t i = 0; out != NULL && i < all; i++) {
    out[i] = strdup(i < s->set_count ? s->set[i] : more[i - s->set_count]);
    if (out[i] != NULL) continue;
    free_texts(out, i);
    return NULL;
  }
  return out;
}

/* ---- reading ---- */

static void free_scene(abbe_scene *scene) {
  if (scene == NULL) return;
  abbe_scene_free(scene);
  free(scene);
}

static abbe_result read(const abbe_lib_scene *s, char *const *set, size_t count, abbe_scene **out,
                        abbe_error *error) {
  const abbe_scene_options options = {.materials = s->materials,
                                      .set = (const char *const *)set,
                                      .set_count = count,
                                      .stone = s->stone};
  abbe_scene *scene = calloc(1, sizeof *scene);
  if (scene == NULL) return no_memory(error);
  abbe_result result = abbe_scene_load(s->path, &options, scene, error);
  if (result != ABBE_OK) {
    free(scene);
    return result;
  }
  *out = scene;
  return ABBE_OK;
}

static bool copy_texts(abbe_lib_scene *s, const char *path, const char *materials,
                       const char *stone) {
  s->path = strdup(path);
  s->materials = materials == NULL ? NULL : strdup(materials);
  s->stone = stone == NULL ? NULL : strdup(stone);
  return s->path != NULL && (materials == NULL || s->materials != NULL) &&
         (stone == NULL || s->stone != NULL);
}

abbe_result abbe_lib_scene_open(const char *path, const char *materials, const char *stone,
                                const char *const *set, size_t count, abbe_lib_scene **out,
                                abbe_error *error) {
  ABBE_REQUIRE(path && (set || count == 0) && out, error);
  char place[2 * PATH_MAX];
  *out = NULL;
  for (size_t i = 0; i < count; i++) ABBE_REQUIRE(set[i], error);
  abbe_lib_scene *s = calloc(1, sizeof *s);
  if (s == NULL) return no_memory(error);
  abbe_result result = ABBE_OK;
  if (!copy_texts(s, abbe_library_shipped_find(path, place, sizeof place), materials, stone))
    result = no_memory(error);
  char **all = result == ABBE_OK ? join_texts(s, set, count) : NULL;
  if (result == ABBE_OK && all == NULL) result = no_memory(error);
  s->set = all;
  s->set_count = all == NULL ? 0 : count;
  if (result == ABBE_OK) result = read(s, s->set, s->set_count, &s->now, error);
  if (result == ABBE_OK)
    *out = s;
  else
    abbe_lib_scene_free(s);
  return result;
}

void abbe_library_scene_drop_renderer(abbe_lib_scene *s) {
  abbe_renderer_free(s->renderer);
  s->renderer = NULL;
  if (s->held != s->now) free_scene(s->held);
  s->held = NULL;
}

void abbe_lib_scene_free(abbe_lib_scene *s) {
  if (s == NULL) return;
  abbe_library_scene_drop_renderer(s);
  abbe_context_free(s->context);
  free_scene(s->now);
  free_texts(s->set, s->set_count);
  free(s->path);
  free(s->materials);
  free(s->stone);
  free(s);
}

void abbe_lib_scene_set_progress(abbe_lib_scene *scene, abbe_lib_progress progress, void *user) {
  if (scene == NULL) return;
  scene->progress = progress;
  scene->user = user;
}

/* ---- changes ---- */

static bool sets_camera(const char *const *set, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (strncmp(set[i], "camera", strlen("camera")) == 0) return true;
  return false;
}

abbe_result abbe_lib_scene_change(abbe_lib_scene *s, const char *const *set, size_t count,
                                  abbe_error *error) {
  ABBE_REQUIRE(s && (set || count == 0), error);
  for (size_t i = 0; i < count; i++) ABBE_REQUIRE(set[i], error);
  abbe_scene *next = NULL;
  char **all = join_texts(s, set, count);
  if (all == NULL) return no_memory(error);
  abbe_result result = read(s, all, s->set_count + count, &next, error);
  const bool looked = s->looked && !sets_camera(set, count);
  if (result == ABBE_OK && looked) {
    const abbe_camera *old = &s->now->camera;
    const abbe_camera own = next->camera;
    next->camera = *old;
    next->camera.width = own.width;
    next->camera.height = own.height;
    result = abbe_scene_check(next, error);
  }
  if (result != ABBE_OK) {
    free_scene(next);
    free_texts(all, s->set_count + count);
    return result;
  }
  if (s->held != s->now) free_scene(s->now); /* else the renderer has it until it is changed */
  free_texts(s->set, s->set_count);
  s->now = next;
  s->set = all;
  s->set_count += count;
  s->looked = looked;
  return ABBE_OK;
}

static abbe_result check_camera(const abbe_camera *c, abbe_error *error) {
  bool finite = isfinite(c->fov_y_rad);
  double to[3], across[3];
  for (int i = 0; i < 3; i++) {
    finite = finite && isfinite(c->eye[i]) && isfinite(c->target[i]) && isfinite(c->up[i]);
    to[i] = c->target[i] - c->eye[i];
  }
  for (int i = 0; i < 3; i++)
    across[i] = to[(i + 1) % 3] * c->up[(i + 2) % 3] - to[(i + 2) % 3] * c->up[(i + 1) % 3];
  if (!finite)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a camera's number is not finite");
  if (c->fov_y_rad <= 0 || c->fov_y_rad >= ABBE_PI)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a camera's vertical angle is above 0 and below 180 degrees");
  if (hypot(hypot(across[0], across[1]), across[2]) > 0) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "the camera has no view: its eye and target are one point, or up points "
                        "along the line between them");
}

static double far_of(const abbe_camera *c) {
  return hypot(hypot(c->target[0] - c->eye[0], c->target[1] - c->eye[1]), c->target[2] - c->eye[2]);
}

abbe_result abbe_lib_scene_look(abbe_lib_scene *s, const double eye[3], const double target[3],
                                const double up[3], double fov_y_rad, abbe_error *error) {
  ABBE_REQUIRE(s, error);
  abbe_camera *camera = &s->now->camera;
  const abbe_camera before = *camera;
  if (eye != NULL) memcpy(camera->eye, eye, sizeof camera->eye);
  if (target != NULL) memcpy(camera->target, target, sizeof camera->target);
  if (up != NULL) memcpy(camera->up, up, sizeof camera->up);
  if (fov_y_rad != 0) camera->fov_y_rad = fov_y_rad;
  if (fabs(before.focus - far_of(&before)) <= 1e-9 * before.focus) camera->focus = far_of(camera);
  abbe_result result = check_camera(camera, error);
  if (result == ABBE_OK) result = abbe_scene_check(s->now, error);
  if (result != ABBE_OK)
    *camera = before;
  else
    s->looked = true;
  return result;
}

abbe_result abbe_lib_scene_camera(const abbe_lib_scene *s, double eye[3], double target[3],
                                  double up[3], double *fov_y_rad, abbe_error *error) {
  ABBE_REQUIRE(s && eye && target && up && fov_y_rad, error);
  const abbe_camera *camera = &s->now->camera;
  memcpy(eye, camera->eye, sizeof camera->eye);
  memcpy(target, camera->target, sizeof camera->target);
  memcpy(up, camera->up, sizeof camera->up);
  *fov_y_rad = camera->fov_y_rad;
  return ABBE_OK;
}
