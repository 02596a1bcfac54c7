#include "gl/renderer_parts.h"

#include "base/clock.h"
#include "scenes/lights/environment_lights.h"

#include <stdlib.h>
#include <string.h>

enum {
  GEOMETRY = 1 << ABBE_PART_GEOMETRY,
  SURFACES = 1 << ABBE_PART_SURFACES,
  SPECTRA = 1 << ABBE_PART_SPECTRA,
  SHADOWS = 1 << ABBE_PART_SHADOWS,
  LIGHT = 1 << ABBE_PART_LIGHT,
  EYE = 1 << ABBE_PART_EYE,
  POWERS = 1 << ABBE_PART_POWERS,
  ALL = (1 << ABBE_PART_COUNT) - 1
};

enum { COARSE_SHAFT_STEPS = 12 };

/* Whether a published method draws in place of the passes here. */
static bool has_method(const abbe_renderer *r) {
  return abbe_method_of(r->plan.desc.profile)->own_passes;
}

abbe_result abbe_renderer_parts_check(const abbe_renderer *r, abbe_error *error) {
  if (r->lacking == 0) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "the renderer's last change or frame failed, so there is nothing to draw; "
                        "abbe_renderer_change comes first");
}

/* The scene where floats serve it, with a light for each further face of a cube. */
static abbe_result make_local_scene(abbe_renderer *r, const abbe_scene *scene, abbe_error *error) {
  const size_t own = scene->light_count;
  size_t of[ABBE_SCENE_MAX_LIGHTS] = {0};
  abbe_local_scene_free(&r->local);
  abbe_result result = abbe_local_scene_make(scene, &r->local, error);
  if (result == ABBE_OK && !has_method(r)) result = abbe_local_scene_scale_light(&r->local, error);
  for (size_t i = own; i < r->plan.light_view_count; i++) of[i - own] = r->plan.light_view[i].light;
  if (result == ABBE_OK && r->plan.cubes)
    result = abbe_local_scene_repeat_lights(&r->local, of, r->plan.light_view_count - own, error);
  return result;
}

static void take_plan(abbe_renderer *r, const abbe_plan *plan) {
  abbe_plan_free(&r->plan);
  r->plan = *plan;
  if (plan->desc.map_layout == NULL) return;
  r->given = *plan->desc.map_layout; /* the caller's may go */
  r->plan.desc.map_layout = &r->given;
}

static const abbe_map_layout *local_layout(abbe_renderer *r) {
  if (r->plan.desc.map_layout == NULL) return NULL;
  r->local_given = r->given;
  abbe_local_scene_from_world(&r->local, &r->local_given.view);
  return &r->local_given;
}

static unsigned scene_parts(unsigned parts) {
  unsigned of_scene = 0;
  if (parts & GEOMETRY) of_scene |= ABBE_SCENE_GEOMETRY;
  if (parts & SURFACES) of_scene |= ABBE_SCENE_SURFACES;
  if (parts & SPECTRA) of_scene |= ABBE_SCENE_SPECTRA;
  if (parts & SHADOWS) of_scene |= ABBE_SCENE_SHADOWS;
  return of_scene;
}

static void free_eye(abbe_renderer *r) {
  abbe_haze_pass_free(&r->haze);
  abbe_picture_free(&r->picture);
  abbe_adaptive_pass_free(&r->adaptive);
  abbe_refraction_pass_free(&r->refraction);
  abbe_receivers_pass_free(&r->receivers);
  r->picture = (abbe_picture){0};
  r->adaptive = (abbe_adaptive_pass){0};
  r->refraction = (abbe_refraction_pass){0};
  r->receivers = (abbe_receivers_pass){0};
  abbe_seen_meshes_free(&r->meshes);
  abbe_gpu_drop_textures(&r->gpu, 1, &r->baseline);
  r->seen = false;
}

static void free_light(abbe_renderer *r, bool pages_stay) {
  abbe_method_free(&r->method);
  abbe_transports_free(&r->transports, pages_stay);
  abbe_shaft_grid_free(&r->shafts);
  abbe_caustics_free(&r->caustics);
  abbe_spectral_map_free(&r->map);
  abbe_receiver_atlas_free(&r->atlas);
  abbe_light_layers_free(&r->layers);
  abbe_photon_lights_free(&r->views);
  r->caustics = (abbe_caustics){0};
  r->map = (abbe_spectral_map){0};
  r->atlas = (abbe_receiver_atlas){0};
  r->layers = (abbe_light_layers){0};
  r->views = (abbe_photon_lights){0};
  r->lit = false;
}

static void free_parts(abbe_renderer *r, unsigned parts, bool pages_stay) {
  if (parts & EYE) free_eye(r);
  if (parts & LIGHT) free_light(r, pages_stay);
  abbe_gpu_scene_free(&r->scene, scene_parts(parts));
}

static abbe_result make_light(abbe_renderer *r, abbe_error *error) {
  abbe_shader_variant_make(&r->scene, &r->variant);
  r->variant.copies = r->gpu.software;
  if (has_method(r)) return abbe_method_make(&r->scene, &r->variant, &r->method, error);
  /* no light is followed beyond a receiver */
  r->variant.textured = r->variant.receiver_colours = false;
  abbe_result result = abbe_photon_lights_make(&r->scene, &r->views, error);
  r->variant.wide = r->views.wide;
  if (result == ABBE_OK) result = abbe_refractor_faces_make(&r->scene, &r->faces, error);
  if (result == ABBE_OK) result = abbe_light_layers_make(&r->views, &r->faces, &r->layers, error);
  r->atlas.views = &r->views;
  r->map.history = &r->history;
  if (result != ABBE_OK) return result;
  result = r->plan.caustics
               ? abbe_caustics_make(&r->views, &r->layers, &r->atlas, &r->map, &r->variant,
                                    &r->caustics, error)
               : abbe_spectral_map_make(&r->views, &r->atlas, &r->variant, &r->map, error);
  if (result == ABBE_OK && r->plan.shaft_count > 0)
    result = abbe_shaft_grid_make(&r->caustics, &r->variant, &r->shafts, error);
  if (result != ABBE_OK) return result;
  return abbe_transports_make(&r->scene, &r->variant, &r->transports, error);
}

static abbe_result make_eye(abbe_renderer *r, abbe_error *error) {
  abbe_shader_variant variant = r->variant;
  variant.aovs = r->plan.desc.aovs;
  variant.eye_bands = abbe_render_desc_eye_wavelengths(&r->plan.desc);
  const bool coarse = r->plan.desc.coarse != ABBE_COARSE_NONE;
  const size_t threads = r->plan.bvh ? 1 : 2; /* for few bands */
  if (coarse && variant.pixel_threads > threads) variant.pixel_threads = threads;
  if (coarse) variant.shaft_steps = COARSE_SHAFT_STEPS;
  variant.textured = r->plan.textured;
  variant.receiver_colours = r->plan.receiver_colours;
  abbe_camera_view_fit(r->scene.local, &r->plan.desc, &r->camera);
  r->lighting = (abbe_lighting){&r->scene,  &r->views,      &r->layers, &r->atlas, &r->map,
                                &r->camera, &r->transports, &r->shafts, &r->meshes};
  abbe_result result = abbe_seen_meshes_make(&r->scene, &r->camera.view, &r->meshes, error);
  if (result == ABBE_OK)
    result = abbe_receivers_pass_make(&r->lighting, &variant, &r->receivers, error);
  if (result == ABBE_OK)
    result = abbe_refraction_pass_make(&r->lighting, &r->faces, &r->receivers, &variant, &r->kept,
                                       &r->refraction, error);
  if (result == ABBE_OK)
    result = abbe_adaptive_pass_make(&r->receivers, &r->refraction, &variant, &r->adaptive, error);
  if (result == ABBE_OK)
    result = abbe_picture_make(&r->receivers, &r->refraction, &r->picture, error);
  if (result == ABBE_OK)
    result = abbe_haze_pass_make(&r->picture, &r->caustics, &variant, &r->haze, error);
  return result;
}

static abbe_result make_parts(abbe_renderer *r, const abbe_scene *scene, unsigned parts,
                              abbe_error *error) {
  abbe_result result = make_local_scene(r, scene, error);
  if (result != ABBE_OK) return result;
  const size_t frames = r->plan.caustics && !has_method(r) ? r->plan.desc.history : 0;
  if ((parts & LIGHT) != 0) abbe_map_history_change(&r->history, frames, r->local.origin);
  abbe_gpu_scene_begin(&r->gpu, r->local.scene, r->local.unit, &r->plan, local_layout(r),
                       &r->scene);
  result = abbe_gpu_scene_make(&r->scene, scene_parts(parts), error);
  if (result == ABBE_OK && (parts & LIGHT) != 0) result = make_light(r, error);
  if (result == ABBE_OK && has_method(r) && (parts & (LIGHT | EYE)) == EYE)
    abbe_method_look(r->method);
  if (result != ABBE_OK || has_method(r)) return result;
  if ((parts & (LIGHT | POWERS)) == POWERS) abbe_photon_lights_upload(&r->views);
  return (parts & EYE) != 0 ? make_eye(r, error) : ABBE_OK;
}

/* After a cancel nothing more was dispatched: whatever the passes say, there is no result. */
static abbe_result end_watch(abbe_renderer *r, abbe_result result, abbe_error *error) {
  const bool stopped = r->gpu.stopped;
  abbe_gpu_watch(&r->gpu, NULL, NULL);
  r->gpu.compiling = NULL;
  if (!stopped) return result;
  return abbe_error_set(error, ABBE_CANCELLED, "the render was cancelled");
}

/* The scene with lights for its environment, and its plan. */
static abbe_result plan_scene(const abbe_renderer *r, const abbe_scene *scene,
                              const abbe_render_desc *desc, abbe_scene *surrounded, abbe_plan *plan,
                              abbe_error *error) {
  *surrounded = (abbe_scene){0};
  abbe_result result = ABBE_OK;
  const bool other = abbe_plan_surrounds(scene);
  if (other) result = abbe_plan_surround(scene, desc, &r->surrounded, surrounded, error);
  if (result != ABBE_OK) return result;
  result = abbe_plan_make_after(&r->plan, other ? surrounded : scene, desc, plan, error);
  if (result != ABBE_OK) abbe_environment_lights_drop(surrounded);
  return result;
}

/* Whether the camera alone has moved, and the published method's light stays. */
static bool looks_alone(const abbe_renderer *r, const abbe_plan *plan, unsigned parts) {
  const abbe_render_desc *before = &r->plan.desc, *now = &plan->desc;
  return parts == EYE && r->lit && abbe_method_keeps_light(now) && before->width == now->width &&
         before->height == now->height;
}

abbe_result abbe_renderer_parts_change(abbe_renderer *r, const abbe_scene *scene,
                                       const abbe_render_desc *desc, abbe_error *error) {
  abbe_renderer_inputs inputs;
  abbe_plan plan;
  abbe_scene surrounded;
  abbe_result result = plan_scene(r, scene, desc, &surrounded, &plan, error);
  if (result != ABBE_OK) return result;
  abbe_environment_lights_drop(&r->surrounded);
  r->surrounded = surrounded;
  if (r->surrounded.light != NULL) scene = &r->surrounded;
  abbe_renderer_inputs_of(scene, &plan, &inputs);
  unsigned parts = r->lacking;
  if (parts != ALL) parts |= abbe_renderer_inputs_differ(&r->inputs, &inputs);
  if (abbe_method_of(plan.desc.profile)->own_passes && parts != 0 && !looks_alone(r, &plan, parts))
    parts = ALL; /* its tables hold all */
  const bool crowded = abbe_gpu_program_count(&r->gpu) > ABBE_GPU_MOST_PROGRAMS;
  if (crowded && (parts & LIGHT) != 0) parts = ALL;
  abbe_method_history frames = {0};
  if ((parts & (GEOMETRY | EYE)) == EYE && r->inputs.sights == inputs.sights)
    abbe_refraction_pass_leave(&r->refraction, &r->kept);
  if ((parts & LIGHT) != 0) abbe_method_leave(r->method, &frames);
  const bool pages_stay = parts != ALL && r->inputs.pages == inputs.pages;
  free_parts(r, parts, pages_stay);
  if (parts == ALL && crowded) abbe_gpu_drop_programs(&r->gpu);
  take_plan(r, &plan);
  r->inputs = inputs;
  if (parts != 0) r->seen = false; /* all parts show, those of which nothing is made too */
  abbe_gpu_watch(&r->gpu, plan.desc.progress, plan.desc.progress_user);
  r->gpu.compiling = plan.desc.compiling;
  result = end_watch(r, make_parts(r, scene, parts, error), error);
  r->lacking = result == ABBE_OK ? 0 : parts; /* the others are as they were */
  if (r->lacking == 0) abbe_method_follow(r->method, &frames);
  abbe_gpu_drop_textures(&r->gpu, ABBE_METHOD_KEPT, frames.sums);
  abbe_refraction_kept_free(&r->gpu, &r->kept);
  free_parts(r, r->lacking, false);
  abbe_gpu_trim(&r->gpu);
  return result;
}

void abbe_renderer_parts_free(abbe_renderer *r) {
  free_parts(r, ALL, false);
  abbe_map_history_free(&r->history);
  abbe_gpu_free(&r->gpu);
  abbe_local_scene_free(&r->local);
  abbe_plan_free(&r->plan);
  abbe_environment_lights_drop(&r->surrounded);
}

/* Whether the next pass is to be run. */
static bool goes_on(abbe_renderer *r, abbe_result result) {
  return result == ABBE_OK && abbe_gpu_ask(&r->gpu);
}

/* With the picture's beams, which are of the same photons. */
static abbe_result draw_shafts(abbe_renderer *r, abbe_error *error) {
  abbe_beam_use draws;
  if (r->plan.shaft_count == 0) return ABBE_OK;
  const bool shown = !r->seen && r->haze.caustics != NULL;
  abbe_result result = shown ? abbe_haze_pass_begin(&r->haze, &draws, error) : ABBE_OK;
  return result == ABBE_OK ? abbe_shaft_grid_run(&r->shafts, shown ? &draws : NULL, error) : result;
}

static abbe_result draw_light(abbe_renderer *r, abbe_error *error) {
  abbe_result result = abbe_light_layers_run(&r->layers, error);
  if (r->plan.caustics && goes_on(r, result))
    result = abbe_caustics_run(&r->caustics, &r->untimed_ms, error);
  if (goes_on(r, result)) result = draw_shafts(r, error);
  if (goes_on(r, result)) result = abbe_transports_run(&r->transports, error);
  return result;
}

static abbe_result draw_eye(abbe_renderer *r, abbe_error *error) {
  abbe_result result = abbe_receivers_pass_run(&r->receivers, error);
  if (goes_on(r, result)) result = abbe_refraction_pass_draw(&r->refraction, error);
  if (goes_on(r, result)) result = abbe_adaptive_pass_run(&r->adaptive, error);
  if (goes_on(r, result)) result = abbe_refraction_pass_run(&r->refraction, error);
  if (goes_on(r, result)) result = abbe_picture_run(&r->picture, error);
  if (goes_on(r, result)) result = abbe_haze_pass_run(&r->haze, error);
  return result;
}

/* The frame: the light's passes, then the camera's; those that were run and depend on nothing that
 * has changed since are left out. */
static abbe_result run_passes(abbe_renderer *r, abbe_error *error) {
  abbe_result result = ABBE_OK;
  if (has_method(r)) {
    if (!r->seen) result = abbe_method_run(r->method, r->lit, error);
    r->lit = result == ABBE_OK;
  } else {
    if (!r->lit) result = draw_light(r, error);
    r->lit = r->lit || (result == ABBE_OK && !r->gpu.stopped &&
                        (r->plan.desc.history_of_changes || abbe_map_history_settled(&r->history)));
    if (result == ABBE_OK && !r->seen && !r->gpu.stopped) result = draw_eye(r, error);
  }
  return result != ABBE_OK ? result : abbe_gl_check(r->gpu.gl, "the frame's passes", error);
}

static void summarise(const abbe_renderer *r, double start_ms, abbe_statistics *s) {
  s->frame_ms = 1e3 * abbe_clock_seconds() - start_ms - r->untimed_ms;
  s->wavelengths = r->plan.desc.wavelengths;
  s->device_bytes = abbe_gpu_bytes(&r->gpu) + r->scene.mesh_bytes;
  if (has_method(r)) {
    abbe_method_count(r->method, s);
  } else {
    const abbe_photon_light *first = &r->views.light[0];
    for (size_t i = 0; i < r->plan.light_view_count; i++)
      s->photons += r->views.light[i].photon_count;
    s->refractor_share =
        (double)first->photon_count / ((double)first->cells[0] * (double)first->cells[1]);
  }
  if (r->plan.caustics && !has_method(r)) abbe_caustics_energy(&r->caustics, &s->energy);
  double *part = &s->energy.reached;
  for (size_t i = 0; i < sizeof s->energy / sizeof *part; i++) part[i] *= r->local.unit;
  for (abbe_pass pass = 0; pass < ABBE_PASS_COUNT && (!has_method(r) || s->pass_count == 0); pass++)
    s->kept[pass] = abbe_plan_runs(&r->plan, pass, 0) && !abbe_statistics_ran(s, pass);
}

abbe_result abbe_renderer_parts_draw(abbe_renderer *r, abbe_render_progress progress, void *user,
                                     abbe_statistics *statistics, abbe_error *error) {
  if (statistics != NULL) memset(statistics, 0, sizeof *statistics);
  if (abbe_renderer_parts_check(r, error) != ABBE_OK) return ABBE_INVALID_ARGUMENT;
  if (statistics != NULL && r->plan.caustics && !has_method(r) &&
      !abbe_caustics_know_energy(&r->caustics))
    r->lit = false; /* no frame with statistics has followed this light */
  r->gpu.statistics = statistics;
  r->untimed_ms = 0;
  if (!r->lit || (has_method(r) && statistics != NULL)) r->seen = false; /* it counts as it draws */
  const double start_ms = 1e3 * abbe_clock_seconds();
  abbe_gpu_watch(&r->gpu, progress, user);
  abbe_result result = run_passes(r, error);
  r->gpu.gl->Finish();
  result = end_watch(r, result, error);
  r->seen = result == ABBE_OK;
  if (result != ABBE_OK && result != ABBE_CANCELLED) { /* lists without room, say */
    r->lacking = ALL;
    r->lit = false;
  }
  abbe_gpu_trim(&r->gpu); /* what was outgrown */
  if (statistics != NULL && result == ABBE_OK) summarise(r, start_ms, statistics);
  r->gpu.statistics = NULL;
  return result;
}

abbe_result abbe_renderer_parts_baseline(abbe_renderer *r, double *ms, abbe_error *error) {
  static const int first = 0;
  static const GLfloat nothing[4] = {0, 0, 0, 0};
  const size_t *samples = r->camera.receiver_samples;
  const abbe_gl *gl = r->gpu.gl;
  abbe_result result = abbe_renderer_parts_check(r, error);
  if (result != ABBE_OK) return result;
  if (has_method(r))
    return abbe_error_set(error, ABBE_UNSUPPORTED, "the %s profile has no baseline of its own",
                          abbe_profile_name(r->plan.desc.profile));
  if (r->baseline == 0) /* the picture may be what lies in the receivers' colour, and stays */
    result = abbe_gpu_make_texture(&r->gpu, GL_RGBA32F, samples[0], samples[1], 1, false,
                                   &r->baseline, error);
  if (result != ABBE_OK) return result;
  gl->Finish();
  const double start_ms = 1e3 * abbe_clock_seconds();
  abbe_refractor_faces_use(&r->faces, &r->camera.view);
  result = abbe_gpu_set_target(&r->gpu, &r->baseline, &first, 1, r->receivers.depth, samples[0],
                               samples[1], error);
  if (result != ABBE_OK) return result;
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  abbe_gpu_begin_depths(&r->gpu, true);
  for (size_t i = 0; i < r->scene.local->object_count; i++) abbe_seen_meshes_draw(&r->meshes, i);
  abbe_gpu_end_depths(&r->gpu);
  gl->Finish();
  *ms = 1e3 * abbe_clock_seconds() - start_ms;
  return abbe_gl_check(gl, "the drawing of surfaces", error);
}
