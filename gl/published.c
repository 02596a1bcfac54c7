#include "gl/published.h"

static bool is_shah(const abbe_published *p) {
  return p->shah.scene != NULL;
}

abbe_result abbe_published_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                                abbe_published *out, abbe_error *error) {
  if (abbe_profile_is_shah2007(scene->plan->desc.profile))
    return abbe_shah2007_make(scene, variant, &out->shah, error);
  return abbe_thesis_make(scene, variant, &out->thesis, error);
}

void abbe_published_free(abbe_published *p) {
  abbe_thesis_free(&p->thesis);
  abbe_shah2007_free(&p->shah);
  *p = (abbe_published){0};
}

abbe_result abbe_published_run(abbe_published *p, abbe_error *error) {
  return is_shah(p) ? abbe_shah2007_run(&p->shah, error) : abbe_thesis_run(&p->thesis, error);
}

abbe_result abbe_published_read(const abbe_published *p, abbe_image *out, abbe_error *error) {
  return is_shah(p) ? abbe_shah2007_read(&p->shah, out, error)
                    : abbe_thesis_read(&p->thesis, out, error);
}

abbe_result abbe_published_read_map(const abbe_published *p, bool filled, abbe_image *out,
                                    abbe_error *error) {
  return is_shah(p) ? abbe_shah2007_read_map(&p->shah, out, error)
                    : abbe_thesis_read_map(&p->thesis, filled, out, error);
}

const abbe_map_layout *abbe_published_layout(const abbe_published *p) {
  return is_shah(p) ? &p->shah.layout : &p->thesis.layout;
}

GLuint abbe_published_picture(const abbe_published *p) {
  return is_shah(p) ? p->shah.eye.picture : p->thesis.picture;
}

size_t abbe_published_photons(const abbe_published *p) {
  return is_shah(p) ? p->shah.photon_count : p->thesis.photon_count;
}
