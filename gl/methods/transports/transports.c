#include "gl/methods/transports/transports.h"

abbe_result abbe_transports_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                                 abbe_transports *out, abbe_error *error) {
  ABBE_TRY(abbe_volume_light_make(scene, &out->volume, error));
  return abbe_pinhole_pages_make(scene, variant, &out->pinholes, error);
}

void abbe_transports_free(abbe_transports *t, bool pages_stay) {
  if (!pages_stay) abbe_pinhole_pages_free(&t->pinholes);
  abbe_volume_light_free(&t->volume);
}

abbe_result abbe_transports_run(abbe_transports *t, abbe_error *error) {
  return abbe_pinhole_pages_run(&t->pinholes, error);
}

void abbe_transports_set(const abbe_transports *t, GLuint program) {
  abbe_volume_light_set(&t->volume, program);
  abbe_pinhole_pages_set(&t->pinholes, program);
}

void abbe_transports_redraw(abbe_transports *t) {
  t->pinholes.filled = false;
}
