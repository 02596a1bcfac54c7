#include "gl/renderer.h"

#include "gl/caustics/map_bands.h"
#include "gl/plan/examine/layer_detail.h"
#include "gl/renderer_state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_thesis(const abbe_renderer *r) {
  return abbe_profile_is_thesis(r->plan.desc.profile);
}

/* The scene where floats serve it, with a light for each further face of a cube. */
static abbe_result make_local_scene(abbe_renderer *r, const abbe_scene *scene, abbe_error *error) {
  const size_t own = scene->light_count;
  size_t of[ABBE_SCENE_MAX_LIGHTS] = {0};
  abbe_result result = abbe_local_scene_make(scene, &r->local, error);
  if (result == ABBE_OK && !is_thesis(r)) result = abbe_local_scene_scale_light(&r->local, error);
  for (size_t i = own; i < r->plan.light_view_count; i++) of[i - own] = r->plan.light_view[i].light;
  if (result == ABBE_OK && r->plan.cubes)
    result = abbe_local_scene_repeat_lights(&r->local, of, r->plan.light_view_count - own, error);
  if (result != ABBE_OK || !r->local.moved || r->plan.desc.map_layout == NULL) return result;
  r->given = *r->plan.desc.map_layout;
  abbe_local_scene_from_world(&r->local, &r->given.view);
  r->plan.desc.map_layout = &r->given;
  return ABBE_OK;
}

/* Refractors' faces as coarse as their layers can tell. */
static abbe_result simplify_layers(abbe_renderer *r, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < r->plan.refractor_count && result == ABBE_OK; i++) {
    const size_t object = r->plan.refractor_object[i];
    const abbe_mesh *mesh = &r->scene.local->object[object].mesh;
    double cell = INFINITY, sample = INFINITY;
    if (!abbe_layer_detail_asks(r->scene.local, &r->plan, i)) continue;
    for (size_t k = 0; k < r->plan.light_view_count; k++)
      if (r->plan.reaches[k])
        cell = fmin(cell, abbe_layer_detail_step(&r->views.light[k].near_view,
                                                 r->views.light[k].cells, mesh));
    if (r->plan.camera_sees_refractor)
      sample = abbe_layer_detail_step(&r->camera.view, r->camera.samples, mesh);
    result = abbe_gpu_meshes_simplify(&r->scene, object, abbe_layer_detail_distance(cell, sample),
                                      error);
  }
  return result;
}

static abbe_result make_light(abbe_renderer *r, abbe_error *error) {
  abbe_result result = simplify_layers(r, error);
  if (result == ABBE_OK) result = abbe_refractor_faces_make(&r->scene, &r->faces, error);
  if (result == ABBE_OK) result = abbe_light_layers_make(&r->views, &r->faces, &r->layers, error);
  r->atlas.views = &r->views;
  if (result != ABBE_OK) return result;
  if (r->plan.caustics)
    return abbe_caustics_make(&r->views, &r->layers, &r->atlas, &r->map, &r->variant, &r->caustics,
                              error);
  return abbe_spectral_map_make(&r->views, &r->atlas, &r->variant, &r->map, error);
}

static abbe_result make_eye(abbe_renderer *r, abbe_error *error) {
  r->lighting = (abbe_lighting){&r->scene, &r->views, &r->layers, &r->atlas, &r->map, &r->camera};
  abbe_result result = abbe_receivers_pass_make(&r->lighting, &r->variant, &r->receivers, error);
  if (result == ABBE_OK)
    result = abbe_refraction_pass_make(&r->lighting, &r->faces, &r->receivers, &r->variant,
                                       &r->refraction, error);
  if (result == ABBE_OK)
    result = abbe_picture_make(&r->receivers, &r->refraction, &r->picture, error);
  return result;
}

static abbe_result make_passes(abbe_renderer *r, bool software, abbe_error *error) {
  abbe_result result = abbe_gpu_scene_upload(&r->scene, error);
  abbe_shader_variant_make(&r->scene, &r->variant);
  r->variant.copies = software;
  if (result == ABBE_OK && is_thesis(r))
    return abbe_thesis_make(&r->scene, &r->variant, &r->thesis, error);
  abbe_camera_view_fit(r->scene.local, &r->plan.desc, &r->camera);
  if (result == ABBE_OK) result = abbe_photon_lights_make(&r->scene, &r->views, error);
  r->variant.wide = r->views.wide;
  if (result == ABBE_OK) result = make_light(r, error);
  return result == ABBE_OK ? make_eye(r, error) : result;
}

abbe_result abbe_renderer_make(abbe_context *context, const abbe_scene *scene,
                               const abbe_render_desc *desc, abbe_renderer **out,
                               abbe_error *error) {
  ABBE_REQUIRE(context && scene && out, error);
  *out = NULL;
  abbe_renderer *r = calloc(1, sizeof *r);
  if (r == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a renderer");
  const bool software = strstr(abbe_context_description(context), "llvmpipe") != NULL;
  abbe_result result = abbe_plan_make(scene, desc, &r->plan, error);
  if (result == ABBE_OK) result = abbe_gpu_make(abbe_context_gl(context), &r->gpu, error);
  if (result == ABBE_OK) result = make_local_scene(r, scene, error);
  if (result == ABBE_OK)
    result = abbe_gpu_scene_make(&r->gpu, r->local.scene, &r->plan, &r->scene, error);
  if (result == ABBE_OK) result = make_passes(r, software, error);
  if (result != ABBE_OK) {
    abbe_renderer_free(r);
    return result;
  }
  *out = r;
  return ABBE_OK;
}

void abbe_renderer_free(abbe_renderer *r) {
  if (r == NULL) return;
  abbe_thesis_free(&r->thesis);
  abbe_picture_free(&r->picture);
  abbe_refraction_pass_free(&r->refraction);
  abbe_receivers_pass_free(&r->receivers);
  abbe_caustics_free(&r->caustics);
  abbe_spectral_map_free(&r->map);
  abbe_receiver_atlas_free(&r->atlas);
  abbe_light_layers_free(&r->layers);
  abbe_refractor_faces_free(&r->faces);
  abbe_photon_lights_free(&r->views);
  abbe_gpu_scene_free(&r->scene);
  if (r->gpu.gl != NULL) r->gpu.gl->DeleteTextures(1, &r->baseline);
  abbe_gpu_free(&r->gpu);
  abbe_local_scene_free(&r->local);
  abbe_plan_free(&r->plan);
  free(r);
}

const abbe_plan *abbe_renderer_plan(const abbe_renderer *r) {
  return &r->plan;
}

static abbe_result run_passes(abbe_renderer *r, abbe_render_progress progress, void *user,
                              abbe_error *error) {
  if (is_thesis(r)) return abbe_thesis_run(&r->thesis, error);
  abbe_result result = abbe_light_layers_run(&r->layers, error);
  if (result == ABBE_OK && r->plan.caustics)
    result = abbe_caustics_run(&r->caustics, progress, user, &r->untimed_ms, error);
  if (result == ABBE_OK) result = abbe_receivers_pass_run(&r->receivers, error);
  if (result == ABBE_OK) result = abbe_refraction_pass_run(&r->refraction, progress, user, error);
  if (result == ABBE_OK) abbe_picture_run(&r->picture);
  return result != ABBE_OK ? result : abbe_gl_check(r->gpu.gl, "the frame's passes", error);
}

static void summarise(const abbe_renderer *r, double start_ms, abbe_statistics *s) {
  s->frame_ms = abbe_gpu_now_ms() - start_ms - r->untimed_ms;
  s->wavelengths = r->plan.desc.wavelengths;
  s->device_bytes = r->gpu.bytes;
  double cells = (double)r->plan.desc.photons * (double)r->plan.desc.photons;
  size_t first = r->thesis.photon_count;
  if (!is_thesis(r)) {
    s->layer_faces = abbe_gpu_meshes_layer_faces(&r->scene);
    for (size_t i = 0; i < r->plan.light_view_count; i++)
      s->photons += r->views.light[i].photon_count;
    cells = (double)r->views.light[0].cells[0] * (double)r->views.light[0].cells[1];
    first = r->views.light[0].photon_count;
  } else {
    s->photons = first;
  }
  s->refractor_share = (double)first / cells;
  double *part = &s->energy.reached;
  for (size_t i = 0; i < sizeof s->energy / sizeof *part; i++) part[i] *= r->local.unit;
}

abbe_result abbe_renderer_frame(abbe_renderer *r, abbe_render_progress progress, void *user,
                                abbe_statistics *statistics, abbe_error *error) {
  ABBE_REQUIRE(r, error);
  if (statistics != NULL) memset(statistics, 0, sizeof *statistics);
  r->gpu.statistics = statistics;
  r->untimed_ms = 0;
  r->drawn = false;
  const double start_ms = abbe_gpu_now_ms();
  const abbe_result result = run_passes(r, progress, user, error);
  r->gpu.gl->Finish();
  if (statistics != NULL && result == ABBE_OK) summarise(r, start_ms, statistics);
  r->gpu.statistics = NULL;
  r->drawn = result == ABBE_OK;
  return result;
}

abbe_result abbe_renderer_baseline(abbe_renderer *r, double *ms, abbe_error *error) {
  ABBE_REQUIRE(r && ms, error);
  static const int first = 0;
  static const GLfloat nothing[4] = {0, 0, 0, 0}, far = 1;
  const size_t *samples = r->camera.samples;
  const abbe_gl *gl = r->gpu.gl;
  abbe_result result = ABBE_OK;
  if (is_thesis(r))
    return abbe_error_set(error, ABBE_UNSUPPORTED, "the thesis profile has no baseline of its own");
  if (r->baseline == 0) /* the picture may be what lies in the receivers' colour, and stays */
    result = abbe_gpu_make_texture(&r->gpu, GL_RGBA32F, samples[0], samples[1], 1, false,
                                   &r->baseline, error);
  if (result != ABBE_OK) return result;
  gl->Finish();
  const double start_ms = abbe_gpu_now_ms();
  abbe_refractor_faces_use(&r->faces, &r->camera.view);
  gl->Enable(GL_DEPTH_TEST);
  result = abbe_gpu_set_target(&r->gpu, &r->baseline, &first, 1, r->receivers.depth, samples[0],
                               samples[1], error);
  if (result != ABBE_OK) return result;
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  gl->ClearBufferfv(GL_DEPTH, 0, &far);
  for (size_t i = 0; i < r->scene.local->object_count; i++) abbe_gpu_meshes_draw(&r->scene, i);
  gl->Finish();
  *ms = abbe_gpu_now_ms() - start_ms;
  return abbe_gl_check(gl, "the drawing of surfaces", error);
}

static abbe_result check_drawn(const abbe_renderer *r, abbe_error *error) {
  if (r->drawn) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "no frame has been drawn, so there is nothing to read; "
                        "abbe_renderer_frame comes first");
}

abbe_result abbe_renderer_read(abbe_renderer *r, bool layers, abbe_image *out, abbe_error *error) {
  ABBE_REQUIRE(r && out, error);
  *out = (abbe_image){0};
  abbe_result result = check_drawn(r, error);
  if (result != ABBE_OK) return result;
  result = is_thesis(r) ? abbe_thesis_read(&r->thesis, out, error)
                        : abbe_picture_read(&r->picture, layers, r->local.unit, out, error);
  if (result != ABBE_OK) return result;
  const abbe_rgb_space space =
      r->plan.desc.profile == ABBE_PROFILE_THESIS ? ABBE_RGB_SPACE_REC709 : r->plan.desc.space;
  abbe_rgb_space_chromaticities(space, out->xy);
  result = abbe_image_set_attribute(out, "abbe:space", abbe_rgb_space_name(space), error);
  if (result == ABBE_OK) result = abbe_gl_check(r->gpu.gl, "the reading of the picture", error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}

static abbe_result check_map(const abbe_renderer *r, size_t light, abbe_error *error) {
  if (light >= r->plan.light_view_count || !r->plan.reaches[light] ||
      r->plan.light_view[light].light != light)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the scene has no spectral map of light %zu", light);
  abbe_result result = check_drawn(r, error);
  if (result != ABBE_OK) return result;
  if (is_thesis(r) || !abbe_photon_lights_is_face(&r->views, light) ||
      abbe_photon_lights_map_is_given(&r->views, light))
    return ABBE_OK;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "the light '%s' has a cube of maps, each with its own layout; give one "
                        "layout for all, such as that of a traced map (--map-like)",
                        r->scene.local->light[light].name);
}

abbe_result abbe_renderer_read_map(abbe_renderer *r, size_t light, bool filled, abbe_image *out,
                                   abbe_error *error) {
  ABBE_REQUIRE(r && out, error);
  *out = (abbe_image){0};
  abbe_result result = check_map(r, light, error);
  if (result != ABBE_OK) return result;
  result = is_thesis(r) ? abbe_thesis_read_map(&r->thesis, filled, out, error)
                        : abbe_spectral_map_read(&r->map, light, r->local.unit, out, error);
  if (result != ABBE_OK) return result;
  result = abbe_gl_check(r->gpu.gl, "the reading of the map", error);
  abbe_map_layout layout;
  abbe_renderer_map_layout(r, light, &layout);
  if (result == ABBE_OK)
    result = abbe_map_layout_write(&layout, r->scene.local->light[light].name, out, error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}

abbe_result abbe_renderer_read_map_bands(abbe_renderer *r, size_t light, size_t bands,
                                         abbe_image *out, abbe_error *error) {
  ABBE_REQUIRE(r && out, error);
  *out = (abbe_image){0};
  if (bands < 1 || bands > ABBE_RENDER_MAX_BANDS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a map of %zu bands; it may have 1 to %d",
                          bands, ABBE_RENDER_MAX_BANDS);
  if (is_thesis(r))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the thesis's passes sum colours; bands go with the default profile");
  abbe_result result = check_map(r, light, error);
  if (result != ABBE_OK) return result;
  result = abbe_map_bands_read(&r->caustics, light, bands, r->local.unit, out, error);
  abbe_map_layout layout;
  abbe_renderer_map_layout(r, light, &layout);
  if (result == ABBE_OK)
    result = abbe_map_layout_write(&layout, r->scene.local->light[light].name, out, error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}

void abbe_renderer_map_layout(const abbe_renderer *r, size_t light, abbe_map_layout *out) {
  *out = is_thesis(r) ? r->thesis.layout : r->views.light[light].map;
  abbe_local_scene_to_world(&r->local, &out->view);
}

void abbe_renderer_photon_view(const abbe_renderer *r, size_t light, abbe_view *out) {
  *out = r->views.light[light].near_view;
  abbe_local_scene_to_world(&r->local, out);
}

abbe_result abbe_renderer_read_hits(abbe_renderer *r, size_t light, float **data, unsigned **cells,
                                    size_t *count, size_t *slots, size_t *samples,
                                    abbe_error *error) {
  ABBE_REQUIRE(r && data && count && slots && samples, error);
  *data = NULL;
  if (light >= r->plan.light_view_count || !r->plan.reaches[light] || is_thesis(r))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "no photons start from light %zu", light);
  *slots = r->plan.hit_slots;
  *samples = r->caustics.trace.hits.stride;
  return abbe_caustics_read_hits(&r->caustics, light, r->local.origin, data, cells, count, error);
}
