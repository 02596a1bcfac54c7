#include "gl/renderer_state.h"

#include "gl/methods/transports/transports.h"
#include "gl/scene/gpu_scene.h"
#include "gl/scene/spectra/camera_bands.h"
#include "scenes/geometry/digest.h"

#include <stdlib.h>
#include <string.h>

#define MIX(h, value) ((h) = abbe_digest((h), &(value), sizeof(value)))

static uint64_t mix_spectrum(uint64_t h, const abbe_spectrum *s) {
  const bool there = s != NULL;
  MIX(h, there);
  if (!there) return h;
  const size_t count = abbe_spectrum_count(s);
  const abbe_interpolation interpolation = abbe_spectrum_interpolation(s);
  MIX(h, interpolation);
  h = abbe_digest_array(h, abbe_spectrum_lambda_nm(s), count, sizeof(double));
  return abbe_digest_array(h, abbe_spectrum_value(s), count, sizeof(double));
}

static uint64_t mix_material(uint64_t h, const abbe_material *m) {
  MIX(h, m->dispersion.model);
  MIX(h, m->dispersion.count);
  h = abbe_digest(h, m->dispersion.c, sizeof m->dispersion.c);
  h = mix_spectrum(h, m->dispersion.table);
  const abbe_index_shift *s = &m->dispersion.shift;
  const double shift[] = {s->on ? 1 : 0, s->from_c, s->to_c, s->pressure_atm, s->from_atm};
  h = abbe_digest(h, shift, sizeof shift);
  h = abbe_digest(h, s->thermal, sizeof s->thermal);
  MIX(h, m->min_nm);
  MIX(h, m->max_nm);
  MIX(h, m->extrapolate);
  for (int i = 0; i < 2; i++) h = mix_spectrum(h, m->attenuation_yz[i]);
  MIX(h, m->fluorescence.yield);
  h = mix_spectrum(h, m->fluorescence.excitation);
  h = mix_spectrum(h, m->fluorescence.emission);
  for (size_t i = 0; i < m->fluorescence.rows; i++) {
    MIX(h, m->fluorescence.row[i].nm);
    h = mix_spectrum(h, m->fluorescence.row[i].emission);
  }
  return mix_spectrum(h, m->attenuation);
}

static uint64_t mix_medium(uint64_t h, const abbe_medium *m) {
  const bool there = m != NULL;
  MIX(h, there);
  if (!there) return h;
  h = mix_spectrum(h, m->scattering);
  h = mix_spectrum(h, m->absorption);
  MIX(h, m->g);
  MIX(h, m->min);
  MIX(h, m->max);
  return h;
}

/* Films by their layers over the plan's wavelengths. */
static uint64_t mix_coatings(uint64_t h, const abbe_coatings *c, const abbe_plan *plan) {
  enum { AT = 16 };
  const size_t count = c != NULL ? c->count : 0;
  MIX(h, count);
  for (size_t i = 0; i < count; i++)
    for (int k = 0; k < AT; k++)
      h = abbe_coating_digest(h, &c->coating[i],
                              plan->desc.min_nm +
                                  (plan->desc.max_nm - plan->desc.min_nm) * k / (AT - 1));
  return h;
}

/* Which face has which film. */
static uint64_t mix_coated(uint64_t h, const abbe_coatings *c) {
  const bool apart = c != NULL && c->face != NULL, there = c != NULL;
  MIX(h, there);
  return apart ? abbe_digest_array(h, c->face, c->face_count, sizeof *c->face) : h;
}

static uint64_t mix_shape(uint64_t h, const abbe_object *o) {
  const abbe_mesh *m = &o->mesh;
  const abbe_exact *e = &o->exact;
  h = abbe_digest_array(h, m->position, m->vertex_count, sizeof *m->position);
  h = abbe_digest_array(h, m->normal, m->vertex_count, sizeof *m->normal);
  h = abbe_digest_array(h, m->uv, m->vertex_count, sizeof *m->uv);
  h = abbe_digest_array(h, m->face, m->face_count, sizeof *m->face);
  MIX(h, e->kind);
  MIX(h, e->centre);
  MIX(h, e->radius);
  h = abbe_digest_array(h, e->plane, e->count, sizeof *e->plane);
  h = abbe_digest_array(h, e->parallelogram, e->count, sizeof *e->parallelogram);
  MIX(h, o->min);
  MIX(h, o->max);
  return mix_coated(h, o->coatings);
}

/* Surfaces, of which kind, which are of the same stuff, and the models that the plan chose. */
static uint64_t of_geometry(const abbe_scene *scene, const abbe_plan *plan) {
  uint64_t h = 1;
  for (size_t i = 0; i < scene->object_count; i++) {
    size_t first = 0;
    while (!abbe_gpu_scene_same_stuff(&scene->object[first], &scene->object[i])) first++;
    const abbe_object_kind kind = abbe_object_kind_of(&scene->object[i]);
    h = mix_shape(h, &scene->object[i]);
    MIX(h, first);
    MIX(h, kind);
  }
  h = abbe_digest_array(h, plan->model, plan->refractor_count, sizeof *plan->model);
  h = abbe_digest_array(h, plan->receiver_model, plan->receiver_count,
                        sizeof *plan->receiver_model);
  MIX(h, plan->desc.profile);
  MIX(h, plan->receivers);
  MIX(h, plan->bvh);
  MIX(h, plan->tiles);
  MIX(h, plan->page_charts);
  return h;
}

static uint64_t mix_environment(uint64_t h, const abbe_environment *e, const abbe_plan *plan) {
  const bool there = e != NULL;
  MIX(h, there);
  if (!there) return h;
  MIX(h, plan->desc.observer);
  MIX(h, plan->desc.min_nm);
  MIX(h, plan->desc.max_nm);
  MIX(h, e->to_map);
  MIX(h, e->map_digest);
  MIX(h, e->illuminant.kind);
  return mix_spectrum(h, e->illuminant.spectrum);
}

static uint64_t mix_illuminants(uint64_t h, const abbe_scene *scene, const abbe_plan *plan) {
  for (size_t i = 0; i < plan->light_view_count; i++) {
    const abbe_illuminant *illuminant = &scene->light[plan->light_view[i].light].illuminant;
    MIX(h, illuminant->kind);
    h = mix_spectrum(h, illuminant->spectrum);
  }
  return h;
}

static uint64_t of_surfaces(const abbe_scene *scene, const abbe_plan *plan) {
  uint64_t h = 4;
  MIX(h, plan->desc.space);
  MIX(h, plan->desc.observer);
  MIX(h, plan->desc.profile);
  MIX(h, plan->desc.min_nm);
  MIX(h, plan->desc.max_nm);
  MIX(h, plan->light_view_count);
  MIX(h, plan->textured);
  MIX(h, plan->receiver_colours);
  h = mix_illuminants(h, scene, plan);
  h = mix_environment(h, scene->environment, plan);
  h = abbe_digest_array(h, scene->soft_light, scene->soft_light != NULL, sizeof *scene->soft_light);
  for (size_t i = 0; i < plan->receiver_count; i++) {
    const abbe_object *o = &scene->object[plan->receiver_object[i]];
    const size_t texels = o->texture.width * o->texture.height * o->texture.channels;
    MIX(h, o->reflectance);
    h = mix_spectrum(h, o->spectrum);
    MIX(h, o->texture_repeat);
    MIX(h, o->texture.width);
    MIX(h, o->texture.height);
    h = abbe_digest_array(h, o->texture.data, texels, sizeof *o->texture.data);
  }
  return h;
}

static uint64_t of_spectra(const abbe_scene *scene, const abbe_plan *plan) {
  const abbe_render_desc *d = &plan->desc;
  uint64_t h = 2;
  for (size_t i = 0; i < plan->refractor_count; i++) {
    const abbe_object *o = &scene->object[plan->refractor_object[i]];
    const abbe_material *material = o->mirror ? o->conductor : o->material;
    MIX(h, o->mirror);
    MIX(h, o->mirror_reflectance);
    MIX(h, o->axis);
    MIX(h, o->axis_x);
    MIX(h, o->brushing.facets);
    MIX(h, o->brushing.around);
    MIX(h, o->brushing.axis);
    MIX(h, o->brushing.centre);
    if (material != NULL) h = mix_material(h, material);
    h = mix_medium(h, o->medium);
    h = mix_coatings(h, o->coatings, plan);
    if (o->coatings != NULL) h = mix_shape(h, o); /* films are looked up by plane */
    MIX(h, o->min);                               /* how long paths through it are */
    MIX(h, o->max);
  }
  h = mix_illuminants(h, scene, plan);
  MIX(h, d->profile);
  MIX(h, d->observer);
  MIX(h, d->wavelengths);
  MIX(h, plan->lines);
  MIX(h, d->min_nm);
  MIX(h, d->max_nm);
  MIX(h, plan->caustics);
  MIX(h, plan->tints);
  MIX(h, plan->band_parts);
  const bool interleaved = abbe_camera_bands_interleave(plan);
  MIX(h, interleaved);
  MIX(h, plan->fills);
  MIX(h, plan->dispersive);
  MIX(h, plan->absorbing);
  MIX(h, plan->tinting);
  MIX(h, plan->colouring);
  MIX(h, plan->filmed);
  MIX(h, plan->crystals);
  MIX(h, plan->biaxial);
  MIX(h, plan->pleochroic);
  MIX(h, plan->glowing);
  return h;
}

/* Where light comes from. */
static uint64_t mix_places(uint64_t h, const abbe_scene *scene, const abbe_plan *plan) {
  MIX(h, plan->desc.everything);
  for (size_t i = 0; i < plan->light_view_count; i++) {
    const abbe_light *light = &scene->light[plan->light_view[i].light];
    MIX(h, light->kind);
    MIX(h, light->position);
    if (light->kind == ABBE_LIGHT_DIRECTIONAL) {
      MIX(h, light->direction);
      MIX(h, light->radius);
    }
    MIX(h, plan->light_view[i].light);
    MIX(h, plan->reaches[i]);
  }
  MIX(h, plan->light_view_count);
  return h;
}

/* Where it goes to from there, by unit power. */
static uint64_t mix_beams(uint64_t h, const abbe_scene *scene, const abbe_plan *plan) {
  for (size_t i = 0; i < plan->light_view_count; i++) {
    const abbe_light_view *view = &plan->light_view[i];
    const abbe_light *light = &scene->light[view->light];
    MIX(h, light->direction);
    MIX(h, light->radius);
    MIX(h, light->edge);
    MIX(h, light->cone_rad);
    MIX(h, light->soft_rad);
    MIX(h, view->face);
    MIX(h, view->faces);
  }
  return h;
}

static uint64_t mix_layout(uint64_t h, const abbe_map_layout *layout, size_t light) {
  const bool there = layout != NULL;
  MIX(h, there);
  if (!there) return h;
  MIX(h, light);
  MIX(h, layout->view.orthographic);
  MIX(h, layout->view.origin);
  MIX(h, layout->view.right);
  MIX(h, layout->view.up);
  MIX(h, layout->view.forward);
  MIX(h, layout->view.window);
  MIX(h, layout->view.near);
  MIX(h, layout->view.far);
  MIX(h, layout->knot);
  return h;
}

/* What the plan and the request set for light's paths from lights to maps. */
static uint64_t mix_light_plan(uint64_t h, const abbe_plan *plan) {
  const abbe_render_desc *d = &plan->desc;
  MIX(h, d->photons);
  MIX(h, d->map_size);
  MIX(h, d->fill);
  MIX(h, d->model);
  MIX(h, d->energy_share);
  MIX(h, d->exits);
  MIX(h, d->photon_shift);
  MIX(h, d->estimator);
  MIX(h, d->iterations);
  MIX(h, d->interfaces);
  MIX(h, d->direction);
  MIX(h, d->polygons);
  MIX(h, d->low_pass);
  MIX(h, d->faces);
  MIX(h, d->history);
  MIX(h, d->volume);
  MIX(h, d->lookup);
  MIX(h, d->transport);
  MIX(h, d->pinholes);
  MIX(h, d->clusters);
  MIX(h, d->footprint);
  h = mix_layout(h, d->map_layout, d->map_layout_light);
  const bool coarse = plan->fewer_triangles == ABBE_COARSE_ALL;
  MIX(h, coarse);
  const bool facts[] = {plan->spheres,
                        plan->convex,
                        plan->layers,
                        plan->multi_refractor_paths,
                        plan->cubes,
                        plan->forward_transmission,
                        plan->outside_map_view,
                        plan->draw_back,
                        plan->receiver_shadows};
  MIX(h, facts);
  MIX(h, plan->hit_slots);
  MIX(h, plan->haze_beyond);
  MIX(h, plan->shaft_count);
  return h;
}

static uint64_t mix_eye(uint64_t h, const abbe_scene *scene, const abbe_plan *plan) {
  const abbe_render_desc *d = &plan->desc;
  MIX(h, scene->camera.eye);
  MIX(h, scene->camera.target);
  MIX(h, scene->camera.up);
  MIX(h, scene->camera.fov_y_rad);
  MIX(h, scene->camera.aperture);
  MIX(h, scene->camera.focus);
  MIX(h, d->width);
  MIX(h, d->height);
  MIX(h, d->supersample);
  MIX(h, d->upsample);
  const bool coarse[2] = {d->coarse != ABBE_COARSE_NONE, plan->fewer_triangles != ABBE_COARSE_NONE};
  MIX(h, coarse);
  MIX(h, d->adaptive);
  MIX(h, d->receiver_samples);
  MIX(h, d->sample_shift);
  MIX(h, d->lens_place);
  MIX(h, d->lens_turn);
  MIX(h, d->aovs);
  MIX(h, plan->textured);
  MIX(h, plan->receiver_colours);
  MIX(h, plan->camera_sees_refractor);
  MIX(h, plan->eye_exits);
  MIX(h, plan->eye_share);
  return h;
}

static uint64_t mix_powers(uint64_t h, const abbe_scene *scene, const abbe_plan *plan) {
  for (size_t i = 0; i < scene->light_count; i++) MIX(h, scene->light[i].power);
  MIX(h, scene->ambient); /* the unit of power goes by the greatest of all */
  MIX(h, scene->background);
  MIX(h, scene->transparent);
  MIX(h, plan->desc.space);
  MIX(h, plan->desc.observer); /* whose white a light has */
  return h;
}

/* Lights with a size are seen. */
static uint64_t of_sights(const abbe_scene *scene, const abbe_plan *plan, const uint64_t *part) {
  uint64_t h = 5;
  MIX(h, part[ABBE_PART_GEOMETRY]);
  MIX(h, part[ABBE_PART_SURFACES]);
  MIX(h, part[ABBE_PART_SPECTRA]);
  MIX(h, part[ABBE_PART_POWERS]);
  MIX(h, plan->volume);
  if (plan->sized_lights) MIX(h, part[ABBE_PART_LIGHT]);
  return mix_eye(h, scene, plan);
}

/* Programs know how many lights there are. */
static uint64_t of_pages(const abbe_scene *scene, const abbe_plan *plan, const uint64_t *part) {
  const abbe_render_desc *d = &plan->desc;
  uint64_t h = 6;
  MIX(h, part[ABBE_PART_GEOMETRY]);
  MIX(h, part[ABBE_PART_SURFACES]);
  MIX(h, part[ABBE_PART_SPECTRA]);
  MIX(h, scene->environment_lights);
  MIX(h, scene->light_count);
  MIX(h, plan->light_view_count);
  MIX(h, plan->eye_exits);
  MIX(h, plan->eye_share);
  MIX(h, d->transport);
  MIX(h, d->map_size);
  const uint64_t seed = abbe_pinhole_samples_seed(d);
  MIX(h, seed);
  MIX(h, d->pinholes);
  MIX(h, d->clusters);
  MIX(h, d->footprint);
  if (plan->rough) MIX(h, part[ABBE_PART_LIGHT]);
  return h;
}

static uint64_t of_glow(const abbe_plan *plan, const uint64_t *part) {
  uint64_t h = 7;
  for (unsigned i = 0; i < ABBE_PART_COUNT; i++)
    if (i != ABBE_PART_EYE) MIX(h, part[i]);
  MIX(h, plan->textured);
  MIX(h, plan->receiver_colours);
  MIX(h, plan->eye_exits);
  MIX(h, plan->eye_share);
  return h;
}

/* The colour of a matrix's glow goes by the lights. */
static uint64_t mix_glow_rows(uint64_t h, const abbe_scene *scene, const abbe_plan *plan) {
  for (size_t r = 0; r < plan->refractor_count; r++) {
    const abbe_object *o = &scene->object[plan->refractor_object[r]];
    const size_t rows = o->material != NULL ? o->material->fluorescence.rows : 0; /* mirrors */
    double *weight = rows > 0 ? calloc(rows, sizeof *weight) : NULL;
    if (weight == NULL) continue;
    abbe_glow_rows_weigh(scene, plan, o, weight);
    h = abbe_digest_array(h, weight, rows, sizeof *weight);
    free(weight);
  }
  return h;
}

void abbe_renderer_inputs_of(const abbe_scene *scene, const abbe_plan *plan,
                             abbe_renderer_inputs *out) {
  uint64_t *part = out->part, light;
  part[ABBE_PART_GEOMETRY] = of_geometry(scene, plan);
  part[ABBE_PART_SURFACES] = of_surfaces(scene, plan);
  part[ABBE_PART_SPECTRA] =
      mix_glow_rows(mix_medium(of_spectra(scene, plan), scene->medium), scene, plan);
  part[ABBE_PART_SHADOWS] = mix_places(part[ABBE_PART_GEOMETRY], scene, plan);
  light = mix_light_plan(mix_beams(part[ABBE_PART_SHADOWS], scene, plan), plan);
  MIX(light, part[ABBE_PART_SPECTRA]);
  if (plan->desc.transport == ABBE_TRANSPORT_PINHOLE) MIX(light, part[ABBE_PART_SURFACES]);
  /* samples show lights, too, and beams are in their colours */
  if (plan->rough || plan->hazy) light = mix_powers(light, scene, plan);
  part[ABBE_PART_LIGHT] = light;
  part[ABBE_PART_EYE] = mix_eye(light, scene, plan);
  part[ABBE_PART_POWERS] = mix_powers(3, scene, plan);
  out->sights = of_sights(scene, plan, part);
  out->pages = of_pages(scene, plan, part);
  out->glow = of_glow(plan, part);
}

unsigned abbe_renderer_inputs_differ(const abbe_renderer_inputs *a, const abbe_renderer_inputs *b) {
  unsigned parts = 0;
  for (unsigned i = 0; i < ABBE_PART_COUNT; i++)
    if (a->part[i] != b->part[i]) parts |= 1u << i;
  return parts;
}
