/* Media that scatter, as the shaders know them (shaders/media/haze.glsl). */
#include "colorimetry/weights.h"
#include "gl/scene/gpu_scene.h"

enum { BANDS = ABBE_PLAN_HAZE_BANDS };

static void fill_white(const abbe_gpu_scene *scene, const abbe_illuminant *light,
                       float out[BANDS][3]) {
  const abbe_render_desc *desc = &scene->plan->desc;
  abbe_weights_range range;
  double matrix[9];
  abbe_weights_range_make_by(desc->observer, light, desc->min_nm, desc->max_nm, &range);
  abbe_rgb_space_from_xyz(abbe_gpu_scene_working_space(scene), matrix);
  for (int k = 0; k < BANDS; k++) {
    double xyz[3], rgb[3];
    abbe_weights_range_xyz(&range, abbe_plan_haze_edge(desc, k), abbe_plan_haze_edge(desc, k + 1),
                           xyz);
    abbe_rgb_space_apply(matrix, xyz, rgb);
    for (int c = 0; c < 3; c++) out[k][c] = (float)rgb[c];
  }
}

void abbe_gpu_haze_make(abbe_gpu_scene *scene) {
  const abbe_plan *plan = scene->plan;
  if (!plan->hazy) return;
  for (size_t i = 0; i < plan->light_view_count; i++)
    fill_white(scene, &scene->local->light[plan->light_view[i].light].illuminant,
               scene->haze_white + i * BANDS);
  fill_white(scene, abbe_scene_illuminant(scene->local),
             scene->haze_white + plan->light_view_count * BANDS);
}

void abbe_gpu_haze_set(const abbe_gpu_scene *scene, GLuint program) {
  const abbe_gl *gl = scene->gpu->gl;
  const abbe_plan *plan = scene->plan;
  const abbe_medium *air = scene->local->medium;
  if (!plan->hazy) return;
  float low[3] = {0}, high[3] = {0}, band[BANDS][4];
  for (int k = 0; k < 3 && air != NULL; k++) {
    low[k] = (float)air->min[k];
    high[k] = (float)air->max[k];
  }
  gl->Uniform3fv(gl->GetUniformLocation(program, "haze_low"), 1, low);
  gl->Uniform3fv(gl->GetUniformLocation(program, "haze_high"), 1, high);
  abbe_gpu_set_float(scene->gpu, program, "haze_air_g", plan->air_haze.g);
  abbe_gpu_set_float(scene->gpu, program, "haze_g", plan->eye_haze.g);
  for (int k = 0; k < BANDS; k++) {
    band[k][0] = (float)plan->air_haze.takes[k];
    band[k][1] = (float)plan->air_haze.scatters[k];
    band[k][2] = (float)plan->eye_haze.takes[k];
    band[k][3] = 0;
  }
  gl->Uniform4fv(gl->GetUniformLocation(program, "haze_bands"), BANDS, band[0]);
  gl->Uniform3fv(gl->GetUniformLocation(program, "haze_white"),
                 (GLsizei)((plan->light_view_count + 1) * BANDS), scene->haze_white[0]);
  abbe_gpu_set_int(scene->gpu, program, "eye_in_air", plan->eye_in_air);
}
