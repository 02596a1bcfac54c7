#include "base/number.h"
#include "base/text.h"
#include "cli/derive/derive.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef abbe_derive_request request;

/* materials.NAME.WHAT; false: it is no such key. */
static abbe_result read_material_key(const char *key, const abbe_scene *scene,
                                     char name[ABBE_MATERIAL_MAX_NAME + 1],
                                     abbe_specular_shift *shift, double *step, bool *is,
                                     abbe_error *error) {
  static const char head[] = "materials.";
  static const char *const whats[] = {"n", "B", "V", "absorption"};
  static const double steps[] = {1e-6, 1e-7, 1e-4, 1e-3};
  const char *last = strrchr(key, '.'), *names[ABBE_SCENE_MAX_OBJECTS];
  size_t count = 0;
  *is = strncmp(key, head, strlen(head)) == 0 && last > key + strlen(head);
  if (!*is) return ABBE_OK;
  snprintf(name, ABBE_MATERIAL_MAX_NAME + 1, "%.*s", (int)(last - key - (ptrdiff_t)strlen(head)),
           key + strlen(head));
  for (size_t i = 0; i < scene->object_count; i++)
    if (scene->object[i].material != NULL) names[count++] = scene->object[i].material->name;
  *shift = (abbe_specular_shift){0};
  for (size_t i = 0; i < count; i++)
    if (strcmp(names[i], name) == 0) shift->material = name;
  const char *near = shift->material ? NULL : abbe_nearest_word(name, names, count);
  if (shift->material == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "--by %.120s: no refractor is made of '%s'%s%s%s", key, name,
                          near ? "; did you mean '" : "", near ? near : "", near ? "'?" : "");
  double *const to[] = {&shift->n, &shift->b_um2, &shift->v, &shift->absorption};
  for (size_t i = 0; i < sizeof whats / sizeof *whats; i++)
    if (strcmp(last + 1, whats[i]) == 0) {
      *to[i] = *step = steps[i];
      return ABBE_OK;
    }
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "--by %.120s: of a material there are n, B (um2), V and absorption (1/m)",
                        key);
}

static abbe_specular_shift less(const abbe_specular_shift *more) {
  return (abbe_specular_shift){.material = more->material,
                               .n = -more->n,
                               .b_um2 = -more->b_um2,
                               .v = -more->v,
                               .absorption = -more->absorption};
}

static abbe_result load_moved(const request *q, const char *path, const char *key, double value,
                              abbe_scene *out, abbe_error *error) {
  char text[320];
  abbe_scene_input_changes changes = q->changes;
  abbe_error why = {0};
  abbe_number_format(text, sizeof text, "%.250s=%.17g", key, value);
  changes.set[changes.set_count++] = text;
  changes.save = NULL;
  const abbe_result result =
      abbe_scene_input_load_with(q->program, path, q->materials, &changes, out, &why);
  if (result == ABBE_OK) return result;
  return abbe_error_set(error, result, "--by %.120s: it cannot be moved by a little: %s", key,
                        why.text);
}

/* A number of the file, or the angle that a cut has where the file names none. */
static abbe_result read_value(const request *q, const abbe_scene *scene, const char *key,
                              double *value, abbe_error *error) {
  const abbe_result result =
      abbe_scene_input_number(scene, q->materials, &q->changes, key, value, error);
  for (size_t i = 0; i < scene->object_count && result != ABBE_OK; i++)
    for (int side = 0; side < 2; side++) {
      const abbe_object *o = &scene->object[i];
      char text[320];
      snprintf(text, sizeof text, "objects.%.200s.%s", o->name, side == 0 ? "crown" : "pavilion");
      if (strcmp(text, key) != 0 || !(o->cut_deg[side] > 0)) continue;
      *value = o->cut_deg[side];
      return ABBE_OK;
    }
  return result;
}

abbe_result abbe_derive_move(request *q, size_t k, const abbe_scene *scene,
                             abbe_derive_moved *moved, abbe_pixels_key *out, abbe_error *error) {
  static char names[ABBE_DERIVE_MOST_KEYS][ABBE_MATERIAL_MAX_NAME + 1];
  bool material;
  out->name = q->key[k];
  ABBE_TRY(
      read_material_key(q->key[k], scene, names[k], &out->shift[1], &out->step, &material, error));
  out->shift[0] = less(&out->shift[1]);
  if (!material) {
    ABBE_TRY(read_value(q, scene, q->key[k], &q->value[k], error));
    /* At a ball's outline reflectance is 1 less the root of the distance: so is what a step misses.
     */
    out->step = fmax(1e-7 * fabs(q->value[k]), 1e-9);
    if (q->value[k] != 0) out->step = fmin(out->step, 1e-3 * fabs(q->value[k]));
  }
  for (int s = 0; s < 2; s++) {
    out->moved[s] = material ? scene : &moved->scene[s];
    const double to = q->value[k] + (s == 0 ? -out->step : out->step);
    if (!material) ABBE_TRY(load_moved(q, scene->path, q->key[k], to, &moved->scene[s], error));
  }
  return ABBE_OK;
}
