#include "gl/methods/methods.h"

#include <stdio.h>
#include <stdlib.h>

/* Whose passes the profile's are; NULL: the renderer's. */
static const abbe_method_kind *kind_of(abbe_profile profile) {
  static const abbe_method_kind *const kinds[ABBE_PROFILE_COUNT] = {
      [ABBE_PROFILE_THESIS] = &abbe_thesis_kind,
      [ABBE_PROFILE_THESIS_CIE] = &abbe_thesis_kind,
      [ABBE_PROFILE_SHAH2007] = &abbe_shah2007_kind,
      [ABBE_PROFILE_SHAH2007_CIE] = &abbe_shah2007_kind,
      [ABBE_PROFILE_WYMAN2006] = &abbe_wyman2006_kind,
      [ABBE_PROFILE_WYMAN2006_CIE] = &abbe_wyman2006_kind,
      [ABBE_PROFILE_WAND2003] = &abbe_wand2003_kind};
  return kinds[profile];
}

abbe_result abbe_method_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                             abbe_method **out, abbe_error *error) {
  const abbe_method_kind *kind = kind_of(scene->plan->desc.profile);
  *out = NULL;
  if (kind == NULL) return ABBE_OK;
  abbe_method *method = calloc(1, kind->size);
  if (method == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a method");
  method->kind = kind;
  method->scene = scene;
  *out = method;
  return kind->make(method, variant, error);
}

void abbe_method_free(abbe_method **method) {
  abbe_method *m = *method;
  *method = NULL;
  if (m == NULL) return;
  m->kind->free(m);
  abbe_image_eye_free(&m->eye);
  abbe_image_places_free(&m->light);
  free(m->colour);
  free(m);
}

abbe_result abbe_method_run(abbe_method *m, bool lit, abbe_error *error) {
  char what[64];
  snprintf(what, sizeof what, "the %s profile", abbe_profile_name(m->scene->plan->desc.profile));
  abbe_gpu_scene_bind(m->scene);
  ABBE_TRY(m->kind->run(m, lit, error));
  return abbe_gl_check(m->scene->gpu->gl, what, error);
}

bool abbe_method_keeps_light(const abbe_render_desc *desc) {
  const abbe_method_kind *kind = kind_of(desc->profile);
  return kind != NULL && kind->keeps_light != NULL && kind->keeps_light(desc);
}

void abbe_method_look(abbe_method *m) {
  if (m->eye.scene != NULL) abbe_image_eye_look(&m->eye);
}

void abbe_method_leave(abbe_method *m, abbe_method_history *out) {
  *out = (abbe_method_history){0};
  if (m == NULL || m->history == NULL) return;
  *out = *m->history;
  *m->history = (abbe_method_history){0};
}

void abbe_method_follow(abbe_method *m, abbe_method_history *before) {
  if (m == NULL || m->history == NULL || before->sums[0] == 0) return;
  const abbe_method_history made = *m->history;
  bool alike = before->printed == made.printed;
  for (int k = 0; k < 2; k++) alike = alike && before->size[k] == made.size[k];
  for (size_t i = 0; i < ABBE_METHOD_KEPT; i++)
    alike = alike && (before->sums[i] == 0) == (made.sums[i] == 0);
  if (!alike) return;
  *m->history = *before;
  *before = made;
}

abbe_result abbe_method_read(const abbe_method *m, abbe_image *out, abbe_error *error) {
  const GLuint picture = m->eye.scene != NULL ? m->eye.picture : m->picture;
  return abbe_image_view_read(m->scene, picture, out, error);
}

abbe_result abbe_method_read_map(abbe_method *m, bool filled, abbe_image *out, abbe_error *error) {
  GLuint texture = 0;
  ABBE_TRY(m->kind->map(m, filled, &texture, error));
  return abbe_image_view_read_map(m->scene, texture, &m->layout, out, error);
}

void abbe_method_count(const abbe_method *m, abbe_statistics *s) {
  const size_t side = m->scene->plan->desc.photons;
  const size_t views = m->light.scene != NULL ? m->light.object_faces : 1;
  s->photons = m->photon_count;
  s->polygon_layers = m->polygon_layers;
  s->refractor_share = (double)m->photon_count / (double)(views * side * side);
}
