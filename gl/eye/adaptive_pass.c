#include "gl/eye/adaptive_pass.h"

#include "gl/device/bindings.h"

#include <math.h>
#include <stdio.h>

enum { LIST_ROWS = 4 }; /* rows of a thread of adaptive_list.comp */

/* A bend below these is left alone: of the light around the sample, and of what a white receiver
 * shows of the lights, so that noise in the dark takes no samples. */
static const double bend_share = 0.2, least_white = 0.01;

static const abbe_gpu_scene *scene_of(const abbe_adaptive_pass *pass) {
  return pass->receivers->lighting->scene;
}

abbe_result abbe_adaptive_pass_make(const abbe_receivers_pass *receivers,
                                    const abbe_refraction_pass *refraction,
                                    const abbe_shader_variant *variant, abbe_adaptive_pass *out,
                                    abbe_error *error) {
  *out = (abbe_adaptive_pass){.receivers = receivers, .refraction = refraction};
  const abbe_plan *plan = scene_of(out)->plan;
  const size_t *samples = receivers->lighting->camera->receiver_room;
  abbe_gpu *gpu = scene_of(out)->gpu;
  if (!abbe_plan_runs(plan, ABBE_PASS_EYE_ADAPTIVE, 0)) return ABBE_OK;
  ABBE_TRY(abbe_gpu_make_buffer(gpu, ABBE_GPU_LIST_HEADER + 4 * samples[0] * samples[1], NULL,
                                &out->samples, error));
  const bool fewer = plan->desc.receiver_samples < plan->desc.supersample;
  char side[48];
  snprintf(side, sizeof side, "#define PIXEL_SIDE %zu\n",
           !plan->camera_sees_refractor ? 0
           : fewer                      ? plan->desc.supersample
                                        : 1);
  ABBE_TRY(abbe_gpu_compute(gpu, "adaptive_list.comp", side, &out->list, error));
  return abbe_shader_variant_compute(variant, gpu, "adaptive.comp", NULL, &out->resample, error);
}

void abbe_adaptive_pass_free(abbe_adaptive_pass *pass) {
  if (pass->receivers == NULL) return;
  abbe_gpu_drop_buffers(scene_of(pass)->gpu, 1, &pass->samples);
}

/* The radiance of a white receiver in the lights' full light, where refractors stand, or the
 * scene's middle. */
static double white_radiance(const abbe_gpu_scene *scene) {
  double sum = 0;
  for (size_t i = 0; i < scene->local->light_count; i++) {
    const abbe_light *light = &scene->local->light[i];
    double square = 0;
    for (int k = 0; k < 3; k++) {
      const double middle = scene->refractor_radius > 0 ? scene->refractor_centre[k]
                                                        : 0.5 * (scene->min[k] + scene->max[k]);
      square += (light->position[k] - middle) * (light->position[k] - middle);
    }
    sum += light->kind == ABBE_LIGHT_DIRECTIONAL ? light->power : light->power / square;
  }
  return sum / acos(-1);
}

static void list_samples(abbe_adaptive_pass *pass) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const size_t *samples = pass->receivers->lighting->camera->receiver_samples;
  abbe_gpu_clear_list(gpu, pass->samples);
  abbe_gpu_bind_storage(gpu, BINDING_ADAPTIVE_SAMPLES, pass->samples);
  gpu->gl->UseProgram(pass->list);
  gpu->gl->Uniform2f(gpu->gl->GetUniformLocation(pass->list, "receiver_samples"),
                     (GLfloat)samples[0], (GLfloat)samples[1]);
  abbe_gpu_bind_array(gpu, pass->list, "eye_receivers", 4, pass->receivers->colour);
  if (pass->refraction->layers != 0) {
    abbe_gpu_bind_array(gpu, pass->list, "eye_layers", 5, pass->refraction->layers);
    abbe_gpu_bind_texture(gpu, pass->list, "eye_owner", 6, pass->refraction->owner);
  }
  abbe_gpu_set_float(gpu, pass->list, "bend_share", bend_share);
  abbe_gpu_set_float(gpu, pass->list, "least_bend", least_white * white_radiance(scene_of(pass)));
  abbe_gpu_dispatch_2d(gpu, pass->list, samples[0], (samples[1] + LIST_ROWS - 1) / LIST_ROWS);
  gpu->gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT |
                         GL_BUFFER_UPDATE_BARRIER_BIT);
}

static void resample(abbe_adaptive_pass *pass) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const abbe_gl *gl = gpu->gl;
  const abbe_receivers_pass *receivers = pass->receivers;
  const size_t *samples = receivers->lighting->camera->receiver_samples;
  const GLuint picture[3] = {receivers->colour, receivers->direct, receivers->caustic};
  abbe_lighting_use(receivers->lighting, pass->resample);
  abbe_gpu_set_int(gpu, pass->resample, "side", (int)scene_of(pass)->plan->desc.adaptive);
  for (GLuint k = 0; k < (scene_of(pass)->plan->desc.aovs ? 3u : 1u); k++)
    gl->BindImageTexture(k, picture[k], 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32F);
  abbe_gpu_dispatch_list(gpu, pass->resample, pass->samples, 0, samples[0] * samples[1], 1);
  gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                    GL_TEXTURE_UPDATE_BARRIER_BIT);
}

abbe_result abbe_adaptive_pass_run(abbe_adaptive_pass *pass, abbe_error *error) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  if (pass->resample == 0) return ABBE_OK;
  abbe_gpu_start_lap(gpu);
  list_samples(pass);
  resample(pass);
  abbe_gpu_book_lap(gpu, ABBE_PASS_EYE_ADAPTIVE);
  return abbe_gpu_tell(gpu, 0.5, error);
}
