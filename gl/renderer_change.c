#include "gl/renderer_state.h"

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

/* The scene where floats serve it, with a light for each further face of a cube. */
static abbe_result make_local_scene(abbe_renderer *r, const abbe_scene *scene, abbe_error *error) {
  const size_t own = scene->light_count;
  size_t of[ABBE_SCENE_MAX_LIGHTS] = {0};
  abbe_local_scene_free(&r->local);
  ABBE_TRY(abbe_local_scene_make(scene, &r->local, error));
  if (!abbe_renderer_has_method(r)) ABBE_TRY(abbe_local_scene_scale_light(&r->local, error));
  for (size_t i = own; i < r->plan.light_view_count; i++) of[i - own] = r->plan.light_view[i].light;
  if (r->plan.cubes)
    ABBE_TRY(abbe_local_scene_repeat_lights(&r->local, of, r->plan.light_view_count - own, error));
  return ABBE_OK;
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

static void free_parts(abbe_renderer *r, unsigned parts) {
  if (parts & EYE) {
    abbe_renderer_free_stage(r, ABBE_STAGE_EYE);
    abbe_gpu_drop_textures(&r->gpu, 1, &r->baseline);
    r->seen = false;
  }
  if (parts & LIGHT) {
    abbe_method_free(&r->method);
    abbe_renderer_free_stage(r, ABBE_STAGE_LIGHT);
    r->lit = false;
  }
  abbe_gpu_scene_free(&r->scene, scene_parts(parts));
}

static abbe_result make_light(abbe_renderer *r, abbe_error *error) {
  abbe_shader_variant_make(&r->scene, &r->variant);
  r->variant.copies = r->gpu.software;
  if (abbe_renderer_has_method(r))
    return abbe_method_make(&r->scene, &r->variant, &r->method, error);
  /* no light is followed beyond a receiver */
  r->variant.textured = r->variant.receiver_colours = false;
  return abbe_renderer_make_stage(r, ABBE_STAGE_LIGHT, &r->variant, error);
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
  r->lighting = (abbe_lighting){&r->scene,  &r->views,      &r->layers, &r->atlas,  &r->map,
                                &r->camera, &r->transports, &r->shafts, &r->meshes, &r->glow};
  return abbe_renderer_make_stage(r, ABBE_STAGE_EYE, &variant, error);
}

/* Whatever fails here, the first renderer compiles itself. */
static void draw_ahead(const abbe_scene *scene, const abbe_render_desc *desc) {
  abbe_context *context = NULL;
  abbe_renderer *small = NULL;
  abbe_result result = abbe_context_make(ABBE_CONTEXT_CPU, &context, NULL);
  if (result == ABBE_OK) result = abbe_renderer_make(context, scene, desc, &small, NULL);
  if (result == ABBE_OK)
    abbe_renderer_frame(small, desc->progress, desc->progress_user, NULL, NULL);
  abbe_renderer_free(small);
  abbe_context_free(context);
}

void abbe_renderer_begin_ahead(abbe_renderer *r, const abbe_scene *scene) {
  abbe_renderer_thread_ahead(r, scene, draw_ahead);
}

/* asked: the scene as it came, without lights for its environment. */
static abbe_result make_parts(abbe_renderer *r, const abbe_scene *scene, const abbe_scene *asked,
                              unsigned parts, abbe_error *error) {
  ABBE_TRY(make_local_scene(r, scene, error));
  const size_t frames = r->plan.caustics && !abbe_renderer_has_method(r) ? r->plan.desc.history : 0;
  if ((parts & LIGHT) != 0) abbe_map_history_change(&r->history, frames, r->local.origin);
  abbe_gpu_scene_begin(&r->gpu, r->local.scene, r->local.unit, &r->plan, local_layout(r),
                       &r->scene);
  ABBE_TRY(abbe_gpu_scene_make(&r->scene, scene_parts(parts), error));
  if ((parts & LIGHT) != 0) ABBE_TRY(make_light(r, error));
  if (abbe_renderer_has_method(r) && (parts & (LIGHT | EYE)) == EYE) abbe_method_look(r->method);
  if (abbe_renderer_has_method(r)) return ABBE_OK;
  if ((parts & (LIGHT | POWERS)) == POWERS) abbe_photon_lights_upload(&r->views);
  if (r->plan.desc.compiles_beside && r->gpu.compiling == NULL) /* it has been told */
    abbe_renderer_begin_ahead(r, asked);
  return (parts & EYE) != 0 ? make_eye(r, error) : ABBE_OK;
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

static abbe_result change(abbe_renderer *r, const abbe_scene *scene, const abbe_render_desc *desc,
                          abbe_error *error) {
  abbe_renderer_inputs inputs;
  abbe_plan plan;
  abbe_scene surrounded;
  ABBE_TRY(plan_scene(r, scene, desc, &surrounded, &plan, error));
  abbe_environment_lights_drop(&r->surrounded);
  r->surrounded = surrounded;
  const abbe_scene *asked = scene;
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
  r->pages_stay = parts != ALL && r->inputs.pages == inputs.pages;
  r->glow_stays = parts != ALL && r->inputs.glow == inputs.glow;
  r->glow.lit = r->glow.lit && r->inputs.glow == inputs.glow; /* powers leave the camera's passes */
  free_parts(r, parts);
  r->pages_stay = r->glow_stays = false;
  if (parts == ALL && crowded) abbe_gpu_drop_programs(&r->gpu);
  take_plan(r, &plan);
  r->inputs = inputs;
  if (parts != 0) r->seen = false; /* all parts show, those of which nothing is made too */
  abbe_gpu_watch(&r->gpu, plan.desc.progress, plan.desc.progress_user);
  r->gpu.compiling = plan.desc.compiling;
  abbe_result result = abbe_renderer_end_watch(r, make_parts(r, scene, asked, parts, error), error);
  r->lacking = result == ABBE_OK ? 0 : parts; /* the others are as they were */
  if (r->lacking == 0) abbe_method_follow(r->method, &frames);
  abbe_gpu_drop_textures(&r->gpu, ABBE_METHOD_KEPT, frames.sums);
  abbe_refraction_kept_free(&r->gpu, &r->kept);
  free_parts(r, r->lacking);
  abbe_gpu_trim(&r->gpu);
  return result;
}

static void free_renderer(abbe_renderer *r) {
  abbe_renderer_end_ahead(r);
  free_parts(r, ALL);
  abbe_map_history_free(&r->history);
  abbe_gpu_free(&r->gpu);
  abbe_local_scene_free(&r->local);
  abbe_plan_free(&r->plan);
  abbe_environment_lights_drop(&r->surrounded);
  free(r);
}

static void tell_compiling(void *user) {
  const abbe_renderer_watched *w = user;
  if (w->compiling != NULL) w->compiling(w->user);
}

/* The scene and the request taken over, with whoever watches that. */
static abbe_result change_watched(abbe_renderer *r, const abbe_scene *scene,
                                  const abbe_render_desc *desc, abbe_error *error) {
  abbe_error lost = {0};
  abbe_render_desc request = desc != NULL ? *desc : (abbe_render_desc){0};
  abbe_renderer_watched w = {.context = r->context,
                             .progress = request.progress,
                             .user = request.progress_user,
                             .error = &lost,
                             .compiling = request.compiling};
  if (request.progress != NULL) request.progress = abbe_renderer_watch;
  if (request.compiling != NULL || request.compiles_beside) request.compiling = tell_compiling;
  abbe_renderer_end_ahead(r); /* of the scene before */
  request.progress_user = &w;
  const abbe_result result = change(r, scene, &request, error);
  r->plan.desc.progress = NULL;
  r->plan.desc.compiling = NULL;
  r->plan.desc.compiles_beside = false;
  return w.result == ABBE_OK ? result : abbe_error_set(error, w.result, "%s", lost.text);
}

static abbe_result make_renderer(abbe_context *context, const abbe_scene *scene,
                                 const abbe_render_desc *desc, abbe_renderer **out,
                                 abbe_error *error) {
  abbe_renderer *r = calloc(1, sizeof *r);
  if (r == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a renderer");
  r->context = context;
  r->lacking = (1u << ABBE_PART_COUNT) - 1;
  r->gpu.software = strstr(abbe_context_description(context), "llvmpipe") != NULL;
  abbe_result result = abbe_gpu_make(abbe_context_gl(context), &r->gpu, error);
  if (result == ABBE_OK) result = change_watched(r, scene, desc, error);
  if (result != ABBE_OK) {
    free_renderer(r);
    return result;
  }
  *out = r;
  return ABBE_OK;
}

abbe_result abbe_renderer_make(abbe_context *context, const abbe_scene *scene,
                               const abbe_render_desc *desc, abbe_renderer **out,
                               abbe_error *error) {
  *out = NULL;
  ABBE_TRY(abbe_renderer_enter(context, error));
  return abbe_renderer_leave(context, make_renderer(context, scene, desc, out, error));
}

abbe_result abbe_renderer_change(abbe_renderer *r, const abbe_scene *scene,
                                 const abbe_render_desc *desc, abbe_error *error) {
  ABBE_TRY(abbe_renderer_enter(r->context, error));
  return abbe_renderer_leave(r->context, change_watched(r, scene, desc, error));
}

void abbe_renderer_rest(abbe_renderer *r) {
  if (abbe_renderer_enter(r->context, NULL) != ABBE_OK) return;
  r->gpu.gl->Finish();
  abbe_caustics_rest(&r->caustics);
  abbe_buffer_memory_shrink(&r->gpu.memory);
  abbe_renderer_leave(r->context, ABBE_OK);
}

void abbe_renderer_redraw(abbe_renderer *r) {
  r->lit = r->seen = r->refraction.whole = false;
  abbe_transports_redraw(&r->transports);
}

static void delete_none(GLsizei count, const GLuint *names) {
  (void)count;
  (void)names;
}

static void delete_no_program(GLuint program) {
  (void)program;
}

/* In another context the names would be those of other things. */
static const abbe_gl no_gl = {.DeleteBuffers = delete_none,
                              .DeleteFramebuffers = delete_none,
                              .DeleteProgram = delete_no_program,
                              .DeleteTextures = delete_none,
                              .DeleteVertexArrays = delete_none};

void abbe_renderer_free(abbe_renderer *r) {
  if (r == NULL) return;
  abbe_context *context = r->context;
  const bool entered = abbe_renderer_enter(context, NULL) == ABBE_OK;
  if (!entered) r->gpu.gl = &no_gl;
  free_renderer(r);
  if (entered) abbe_renderer_leave(context, ABBE_OK);
}
