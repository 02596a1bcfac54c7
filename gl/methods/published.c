#include "gl/methods/published.h"

static bool is_shah(const abbe_published *p) {
  return p->shah.scene != NULL;
}

static bool is_wyman(const abbe_published *p) {
  return p->wyman.scene != NULL;
}

static bool is_wand(const abbe_published *p) {
  return p->wand.scene != NULL;
}

abbe_result abbe_published_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                                abbe_published *out, abbe_error *error) {
  if (abbe_method_of(scene->plan->desc.profile)->low_pass)
    return abbe_shah2007_make(scene, variant, &out->shah, error);
  if (abbe_method_of(scene->plan->desc.profile)->draws_photons)
    return abbe_wyman2006_make(scene, variant, &out->wyman, error);
  if (abbe_method_of(scene->plan->desc.profile)->surroundings)
    return abbe_wand2003_make(scene, variant, &out->wand, error);
  return abbe_thesis_make(scene, variant, &out->thesis, error);
}

void abbe_published_free(abbe_published *p) {
  abbe_thesis_free(&p->thesis);
  abbe_shah2007_free(&p->shah);
  abbe_wyman2006_free(&p->wyman);
  abbe_wand2003_free(&p->wand);
  *p = (abbe_published){0};
}

abbe_result abbe_published_run(abbe_published *p, bool lit, abbe_error *error) {
  if (is_wyman(p)) return abbe_wyman2006_run(&p->wyman, lit, error);
  if (is_wand(p)) return abbe_wand2003_run(&p->wand, error);
  return is_shah(p) ? abbe_shah2007_run(&p->shah, lit, error) : abbe_thesis_run(&p->thesis, error);
}

bool abbe_published_keeps_light(const abbe_render_desc *desc) {
  if (abbe_method_of(desc->profile)->draws_photons) return abbe_wyman2006_keeps_light(desc);
  return abbe_method_of(desc->profile)->low_pass;
}

void abbe_published_look(abbe_published *p) {
  if (is_wyman(p)) abbe_image_eye_look(&p->wyman.eye);
  if (is_shah(p)) abbe_image_eye_look(&p->shah.eye);
}

void abbe_published_take_frames(abbe_published *p, abbe_wyman_history *out) {
  *out = (abbe_wyman_history){0};
  if (is_wyman(p)) abbe_wyman2006_leave(&p->wyman, out);
}

void abbe_published_give_frames(abbe_published *p, abbe_wyman_history *frames) {
  if (is_wyman(p) && frames->sums[0] != 0) abbe_wyman2006_follow(&p->wyman, frames);
}

abbe_result abbe_published_read(const abbe_published *p, abbe_image *out, abbe_error *error) {
  if (is_wyman(p)) return abbe_wyman2006_read(&p->wyman, out, error);
  if (is_wand(p)) return abbe_wand2003_read(&p->wand, out, error);
  return is_shah(p) ? abbe_shah2007_read(&p->shah, out, error)
                    : abbe_thesis_read(&p->thesis, out, error);
}

abbe_result abbe_published_read_map(abbe_published *p, bool filled, abbe_image *out,
                                    abbe_error *error) {
  if (is_wyman(p)) return abbe_wyman2006_read_map(&p->wyman, out, error);
  return is_shah(p) ? abbe_shah2007_read_map(&p->shah, out, error)
                    : abbe_thesis_read_map(&p->thesis, filled, out, error);
}

const abbe_map_layout *abbe_published_layout(const abbe_published *p) {
  if (is_wyman(p)) return &p->wyman.layout;
  if (is_wand(p)) return &p->wand.layout;
  return is_shah(p) ? &p->shah.layout : &p->thesis.layout;
}

GLuint abbe_published_picture(const abbe_published *p) {
  if (is_wyman(p)) return p->wyman.eye.picture;
  if (is_wand(p)) return p->wand.picture;
  return is_shah(p) ? p->shah.eye.picture : p->thesis.picture;
}

size_t abbe_published_cells(const abbe_published *p) {
  const abbe_gpu_scene *scene = is_shah(p)    ? p->shah.scene
                                : is_wyman(p) ? p->wyman.scene
                                : is_wand(p)  ? p->wand.scene
                                              : p->thesis.scene;
  const size_t side = scene->plan->desc.photons;
  const size_t views = is_shah(p)    ? p->shah.light.object_faces
                       : is_wyman(p) ? p->wyman.light.object_faces
                                     : 1;
  return views * side * side;
}

double abbe_published_layers(const abbe_published *p) {
  if (!is_wyman(p)) return 0;
  return p->wyman.picture.scene != NULL ? p->wyman.picture.layers : p->wyman.map.layers;
}

size_t abbe_published_photons(const abbe_published *p) {
  if (is_wyman(p)) return p->wyman.photon_count;
  if (is_wand(p)) return 0;
  return is_shah(p) ? p->shah.photon_count : p->thesis.photon_count;
}
