/* The frame. A renderer draws what light does, and then what the camera sees of it; whatever a
 * change has left as it was is not drawn again. A published method draws all of it in its own way
 * (gl/methods). */
#include "gl/renderer_state.h"

#include "base/clock.h"
#include "gl/device/api.h"

#include <string.h>

static abbe_result make_views(abbe_renderer *r, abbe_error *error) {
  ABBE_TRY(abbe_photon_lights_make(&r->scene, &r->views, error));
  r->variant.wide = r->views.wide;
  r->atlas.views = &r->views;
  r->map.history = &r->history;
  return ABBE_OK;
}

/* The map alone where no photons are followed: shaders read it. */
static abbe_result make_caustics(abbe_renderer *r, abbe_error *error) {
  if (r->plan.caustics && !r->plan.desc.camera_alone)
    return abbe_caustics_make(&r->views, &r->layers, &r->atlas, &r->map, &r->variant, &r->caustics,
                              error);
  if (r->plan.desc.camera_tiles)
    ABBE_TRY(abbe_receiver_atlas_make(&r->views, &r->variant, &r->atlas, error));
  return abbe_spectral_map_make(&r->views, &r->atlas, &r->variant, &r->map, error);
}

static abbe_result draw_caustics(abbe_renderer *r, abbe_error *error) {
  return r->plan.caustics ? abbe_caustics_run(&r->caustics, &r->untimed_ms, error) : ABBE_OK;
}

static void free_caustics(abbe_renderer *r) {
  abbe_caustics_free(&r->caustics);
  abbe_spectral_map_free(&r->map);
  r->caustics = (abbe_caustics){0};
  r->map = (abbe_spectral_map){0};
}

/* With the picture's beams, which are of the same photons. */
static abbe_result draw_shafts(abbe_renderer *r, abbe_error *error) {
  abbe_beam_use draws;
  if (r->plan.shaft_count == 0) return ABBE_OK;
  const bool shown = !r->seen && r->haze.caustics != NULL;
  ABBE_TRY(shown ? abbe_haze_pass_begin(&r->haze, &draws, error) : ABBE_OK);
  return abbe_shaft_grid_run(&r->shafts, shown ? &draws : NULL, error);
}

#define FREED(name, type) (abbe_##type##_free(&r->name), (void)memset(&r->name, 0, sizeof r->name))

/* The passes in the order of the frame, each of which may read what is above it: PASS(stage, name,
 * made, run, freed); a PART is not run. v is what shaders are compiled for. */
#define FRAME(PASS, PART)                                                                          \
  PART(LIGHT, views, make_views(r, error), FREED(views, photon_lights))                            \
  PART(LIGHT, faces, abbe_refractor_faces_make(&r->scene, &r->faces, error), (void)0)              \
  PASS(LIGHT, layers, abbe_light_layers_make(&r->views, &r->faces, &r->layers, error),             \
       abbe_light_layers_run(&r->layers, error), FREED(layers, light_layers))                      \
  PART(LIGHT, atlas, ABBE_OK, FREED(atlas, receiver_atlas))                                        \
  PASS(LIGHT, caustics, make_caustics(r, error), draw_caustics(r, error), free_caustics(r))        \
  PASS(LIGHT, shafts,                                                                              \
       r->plan.shaft_count > 0 ? abbe_shaft_grid_make(&r->caustics, v, &r->shafts, error)          \
                               : ABBE_OK,                                                          \
       draw_shafts(r, error), abbe_shaft_grid_free(&r->shafts))                                    \
  PASS(LIGHT, transports, abbe_transports_make(&r->scene, v, &r->transports, error),               \
       abbe_transports_run(&r->transports, error),                                                 \
       abbe_transports_free(&r->transports, r->pages_stay))                                        \
  PART(EYE, meshes, abbe_seen_meshes_make(&r->scene, &r->camera.view, &r->meshes, error),          \
       abbe_seen_meshes_free(&r->meshes))                                                          \
  PASS(EYE, glow, abbe_glow_pass_make(&r->lighting, v, &r->glow, error),                           \
       abbe_glow_pass_run(&r->glow, error), abbe_glow_pass_free(&r->glow, r->glow_stays))          \
  PASS(EYE, receivers, abbe_receivers_pass_make(&r->lighting, v, &r->receivers, error),            \
       abbe_receivers_pass_run(&r->receivers, error), FREED(receivers, receivers_pass))            \
  PASS(EYE, refraction,                                                                            \
       abbe_refraction_pass_make(&r->lighting, &r->faces, &r->receivers, v, &r->kept,              \
                                 &r->refraction, error),                                           \
       abbe_refraction_pass_draw(&r->refraction, error), FREED(refraction, refraction_pass))       \
  PASS(EYE, adaptive,                                                                              \
       abbe_adaptive_pass_make(&r->receivers, &r->refraction, v, &r->adaptive, error),             \
       abbe_adaptive_pass_run(&r->adaptive, error), FREED(adaptive, adaptive_pass))                \
  PASS(EYE, refracted, ABBE_OK, abbe_refraction_pass_run(&r->refraction, error), (void)0)          \
  PASS(EYE, picture, abbe_picture_make(&r->receivers, &r->refraction, &r->picture, error),         \
       abbe_picture_run(&r->picture, error), FREED(picture, picture))                              \
  PASS(EYE, haze, abbe_haze_pass_make(&r->picture, &r->caustics, v, &r->haze, error),              \
       abbe_haze_pass_run(&r->haze, error), abbe_haze_pass_free(&r->haze))

#define DEFINE_PART(stage, name, made, freed)                                                      \
  static abbe_result make_the_##name(abbe_renderer *r, const abbe_shader_variant *v,               \
                                     abbe_error *error) {                                          \
    (void)r, (void)v, (void)error;                                                                 \
    return made;                                                                                   \
  }                                                                                                \
  static void free_the_##name(abbe_renderer *r) {                                                  \
    (void)r;                                                                                       \
    freed;                                                                                         \
  }
#define DEFINE_PASS(stage, name, made, ran, freed)                                                 \
  DEFINE_PART(stage, name, made, freed)                                                            \
  static abbe_result run_the_##name(abbe_renderer *r, abbe_error *error) {                         \
    return ran;                                                                                    \
  }
FRAME(DEFINE_PASS, DEFINE_PART)

static const struct {
  abbe_pass_stage stage;
  abbe_result (*make)(abbe_renderer *r, const abbe_shader_variant *v, abbe_error *error);
  abbe_result (*run)(abbe_renderer *r, abbe_error *error); /* NULL: it has nothing to run */
  void (*free)(abbe_renderer *r);
} frame[] = {
#define PASS_ROW(stage, name, made, ran, freed)                                                    \
  {ABBE_STAGE_##stage, make_the_##name, run_the_##name, free_the_##name},
#define PART_ROW(stage, name, made, freed)                                                         \
  {ABBE_STAGE_##stage, make_the_##name, NULL, free_the_##name},
    FRAME(PASS_ROW, PART_ROW)};
enum { STEPS = sizeof frame / sizeof *frame };

abbe_result abbe_renderer_make_stage(abbe_renderer *r, abbe_pass_stage stage,
                                     const abbe_shader_variant *variant, abbe_error *error) {
  for (size_t i = 0; i < STEPS; i++)
    if (frame[i].stage == stage) ABBE_TRY(frame[i].make(r, variant, error));
  return ABBE_OK;
}

void abbe_renderer_free_stage(abbe_renderer *r, abbe_pass_stage stage) {
  for (size_t i = STEPS; i-- > 0;)
    if (frame[i].stage == stage) frame[i].free(r);
}

/* Until one fails, or whoever watches stops it. */
static abbe_result run_stage(abbe_renderer *r, abbe_pass_stage stage, abbe_error *error) {
  bool first = true;
  for (size_t i = 0; i < STEPS; i++) {
    if (frame[i].stage != stage || frame[i].run == NULL) continue;
    if (!first && !abbe_gpu_ask(&r->gpu)) break;
    ABBE_TRY(frame[i].run(r, error));
    first = false;
  }
  return ABBE_OK;
}

/* The frame: the light's passes, then the camera's; those that were run and depend on nothing that
 * has changed since are left out. */
static abbe_result run_passes(abbe_renderer *r, abbe_error *error) {
  abbe_result result = ABBE_OK;
  if (r->method != NULL) {
    if (!r->seen) result = abbe_method_run(r->method, r->lit, error);
    r->lit = result == ABBE_OK;
  } else {
    if (!r->lit && !r->plan.desc.camera_alone) {
      r->glow.lit = false;
      result = run_stage(r, ABBE_STAGE_LIGHT, error);
    }
    abbe_renderer_await_ahead(r);
    r->lit = r->lit || (result == ABBE_OK && !r->gpu.stopped &&
                        (r->plan.desc.history_of_changes || abbe_map_history_settled(&r->history)));
    if (result == ABBE_OK && !r->seen && !r->gpu.stopped) {
      abbe_gpu_forget_samplers(&r->gpu);
      result = run_stage(r, ABBE_STAGE_EYE, error);
    }
  }
  return result != ABBE_OK ? result : abbe_gl_check(r->gpu.gl, "the frame's passes", error);
}

static void summarise(const abbe_renderer *r, double start_ms, abbe_statistics *s) {
  s->frame_ms = 1e3 * abbe_clock_seconds() - start_ms - r->untimed_ms;
  s->wavelengths = r->plan.desc.wavelengths;
  s->device_bytes = abbe_gpu_bytes(&r->gpu) + r->scene.mesh_bytes;
  if (r->method != NULL) {
    abbe_method_count(r->method, s);
  } else {
    const abbe_photon_light *first = &r->views.light[0];
    for (size_t i = 0; i < r->plan.light_view_count; i++)
      s->photons += r->views.light[i].photon_count;
    s->refractor_share =
        (double)first->photon_count / ((double)first->cells[0] * (double)first->cells[1]);
  }
  if (r->plan.caustics && r->method == NULL) abbe_caustics_energy(&r->caustics, &s->energy);
  abbe_ledger_scale(&s->energy, r->local.unit);
  for (abbe_pass pass = 0; pass < ABBE_PASS_COUNT && (r->method == NULL || s->pass_count == 0);
       pass++)
    s->kept[pass] = abbe_plan_runs(&r->plan, pass, 0) && !abbe_statistics_ran(s, pass);
}

static abbe_result draw(abbe_renderer *r, abbe_render_progress progress, void *user,
                        abbe_statistics *statistics, abbe_error *error) {
  if (statistics != NULL) memset(statistics, 0, sizeof *statistics);
  if (abbe_renderer_check(r, error) != ABBE_OK) return ABBE_INVALID_ARGUMENT;
  if (statistics != NULL && r->plan.caustics && r->method == NULL &&
      !abbe_caustics_know_energy(&r->caustics))
    r->lit = false; /* no frame with statistics has followed this light */
  r->gpu.statistics = statistics;
  r->untimed_ms = 0;
  if (!r->lit || (r->method != NULL && statistics != NULL))
    r->seen = false; /* it counts as it draws */
  const double start_ms = 1e3 * abbe_clock_seconds();
  abbe_gpu_watch(&r->gpu, progress, user);
  abbe_result result = run_passes(r, error);
  r->gpu.gl->Finish();
  result = abbe_renderer_end_watch(r, result, error);
  r->seen = result == ABBE_OK;
  if (result != ABBE_OK &&
      result != ABBE_CANCELLED) { /* for instance lists beyond their capacity */
    r->lacking = (1u << ABBE_PART_COUNT) - 1;
    r->lit = false;
  }
  abbe_gpu_trim(&r->gpu); /* what was outgrown */
  if (statistics != NULL && result == ABBE_OK) summarise(r, start_ms, statistics);
  r->gpu.statistics = NULL;
  return result;
}

abbe_result abbe_renderer_frame(abbe_renderer *r, abbe_render_progress progress, void *user,
                                abbe_statistics *statistics, abbe_error *error) {
  abbe_error lost = {0};
  abbe_renderer_watched w = {
      .context = r->context, .progress = progress, .user = user, .error = &lost};
  ABBE_TRY(abbe_renderer_enter(r->context, error));
  abbe_result result =
      draw(r, progress != NULL ? abbe_renderer_watch : NULL, &w, statistics, error);
  if (w.result != ABBE_OK) return abbe_error_set(error, w.result, "%s", lost.text);
  return abbe_renderer_leave(r->context, result);
}
