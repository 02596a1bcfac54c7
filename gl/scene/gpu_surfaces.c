#include "colorimetry/rgb_space.h"

#include "colorimetry/reflectance/reflected_light.h"
#include "gl/device/float4.h"
#include "gl/plan/examine/examine.h"
#include "gl/scene/gpu_scene.h"

#include <stdlib.h>
#include <string.h>

/* What receivers in colours reflect of bands of each light, for the shaders: a row for each
 * receiver and light with the light's white x, y and where its tables begin, 0: it has none; then
 * the tables, one for each of a texture's channels. */

typedef struct work {
  const abbe_gpu_scene *scene;
  size_t lights, receivers, channels, used;
  float (*row)[4];
} work;

static const abbe_object *receiver(const work *w, size_t i) {
  return &w->scene->local->object[w->scene->plan->receiver_object[i]];
}

/* The first light of the same spectrum. */
static size_t like(const work *w, size_t light) {
  const abbe_light *all = w->scene->local->light;
  size_t i = 0;
  while (all[i].illuminant.kind != all[light].illuminant.kind ||
         all[i].illuminant.spectrum != all[light].illuminant.spectrum)
    i++;
  return i;
}

static abbe_result fill_tables(work *w, const abbe_reflected_light *light,
                               const abbe_object *object, abbe_error *error) {
  for (size_t j = 0; j < w->channels; j++) {
    float(*cell)[4] = w->row + w->used;
    const bool one = w->channels == 1;
    const double rgb[3] = {one || j == 0 ? object->reflectance[0] : 0,
                           one || j == 1 ? object->reflectance[1] : 0,
                           one || j == 2 ? object->reflectance[2] : 0};
    w->used += ABBE_BAND_REFLECTION_CELLS;
    if (object->spectrum != NULL && j > 0) continue; /* it has one channel alone */
    ABBE_TRY(abbe_band_reflection_fill(light, object->spectrum, rgb, cell, error));
  }
  return ABBE_OK;
}

static abbe_result fill_light(work *w, size_t l, abbe_error *error) {
  const abbe_render_desc *d = &w->scene->plan->desc;
  const size_t before = like(w, l);
  if (before < l) {
    for (size_t i = 0; i < w->receivers; i++)
      memcpy(w->row[i * w->lights + l], w->row[i * w->lights + before], sizeof *w->row);
    return ABBE_OK;
  }
  abbe_reflected_light *light;
  abbe_result result = abbe_reflected_light_make_by(
      d->observer, &w->scene->local->light[l].illuminant, d->min_nm, d->max_nm, &light, error);
  if (result != ABBE_OK) return result;
  double white[3];
  abbe_reflected_light_white(light, white);
  const double sum = white[0] + white[1] + white[2];
  for (size_t i = 0; i < w->receivers && result == ABBE_OK; i++) {
    if (!(sum > 0) || !abbe_receiver_model_is_coloured(receiver(w, i))) continue;
    float *row = w->row[i * w->lights + l];
    row[0] = (float)(white[0] / sum);
    row[1] = (float)(white[1] / sum);
    row[2] = (float)w->used;
    result = fill_tables(w, light, receiver(w, i), error);
  }
  abbe_reflected_light_free(light);
  return result;
}

/* gpu_surfaces.c: what receivers in colours reflect of bands of each light
 * (reflected_light.h), where the plan needs it. */
static abbe_result gpu_band_reflections_upload(abbe_gpu_scene *scene, abbe_error *error) {
  const abbe_plan *plan = scene->plan;
  if (!plan->receiver_colours) return ABBE_OK;
  work w = {.scene = scene,
            .lights = plan->light_view_count,
            .receivers = plan->receiver_count,
            .channels = plan->textured ? 3 : 1};
  size_t tables = 0;
  for (size_t i = 0; i < w.receivers; i++)
    tables += abbe_receiver_model_is_coloured(receiver(&w, i)) ? w.channels : 0;
  size_t spectra = 0;
  for (size_t l = 0; l < w.lights; l++) spectra += like(&w, l) == l;
  w.used = w.receivers * w.lights;
  w.row = calloc(w.used + tables * spectra * ABBE_BAND_REFLECTION_CELLS + 1, sizeof *w.row);
  if (w.row == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for reflections");
  abbe_result result = ABBE_OK;
  for (size_t l = 0; l < w.lights && result == ABBE_OK; l++) result = fill_light(&w, l, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(scene->gpu, (w.used + 1) * sizeof *w.row, w.row,
                                  &scene->band_reflections, error);
  free(w.row);
  return result;
}

/* A float copy of the shaders' struct (common.glsl). */
typedef struct gpu_surface {
  float texture_info[4];
} gpu_surface;

/* The published methods multiply colours in the working space. */
static bool reflects_spectra(const abbe_gpu_scene *scene) {
  return abbe_method_of(scene->plan->desc.profile)->reflects_spectra;
}

/* Working space: the picture's, or ACEScg where the picture is XYZ, so that a colour times a
 * reflectance means something. */
abbe_rgb_space abbe_gpu_scene_working_space(const abbe_gpu_scene *scene) {
  return scene->plan->desc.space == ABBE_RGB_SPACE_XYZ ? ABBE_RGB_SPACE_ACESCG
                                                       : scene->plan->desc.space;
}

void abbe_gpu_scene_to_working(const abbe_gpu_scene *scene, const double rgb[3], double out[3]) {
  double to_xyz[9], from_xyz[9];
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, to_xyz);
  abbe_rgb_space_from_xyz(abbe_gpu_scene_working_space(scene), from_xyz);
  abbe_rgb_space_apply(to_xyz, rgb, out);
  abbe_rgb_space_apply(from_xyz, out, out);
}

/* All textures in one array as large as the largest; smaller ones are resampled to it. */
static abbe_result upload_textures(abbe_gpu_scene *scene, gpu_surface *surface, abbe_error *error) {
  size_t width = 1, height = 1, layers = 0;
  for (size_t i = 0; i < scene->plan->receiver_count; i++) {
    const abbe_image *t = &scene->local->object[scene->plan->receiver_object[i]].texture;
    if (t->data == NULL) continue;
    layers++;
    if (t->width > width) width = t->width;
    if (t->height > height) height = t->height;
  }
  ABBE_TRY(abbe_gpu_make_texture(scene->gpu, GL_RGBA16F, width, height, layers > 0 ? layers : 1,
                                 true, &scene->surface_texture, error));
  if (layers == 0) return ABBE_OK;
  scene->gpu->gl->TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_REPEAT);
  scene->gpu->gl->TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_REPEAT);
  float *texel = malloc(width * height * 4 * sizeof *texel);
  if (texel == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a texture");
  int layer = 0;
  for (size_t i = 0; i < scene->plan->receiver_count; i++) {
    const abbe_image *t = &scene->local->object[scene->plan->receiver_object[i]].texture;
    if (t->data == NULL) continue;
    for (size_t y = 0; y < height; y++)
      for (size_t x = 0; x < width; x++) {
        const float *from =
            t->data +
            ((height - 1 - y) * t->height / height * t->width + x * t->width / width) * t->channels;
        double rgb[3] = {from[0], from[1], from[2]};
        if (!reflects_spectra(scene)) abbe_gpu_scene_to_working(scene, rgb, rgb);
        abbe_float4_store(rgb, 1, texel + 4 * (y * width + x));
      }
    scene->gpu->gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, layer, (GLsizei)width,
                                  (GLsizei)height, 1, GL_RGBA, GL_FLOAT, texel);
    surface[i].texture_info[0] = (float)layer++;
  }
  free(texel);
  return abbe_gl_check(scene->gpu->gl, "the upload of textures", error);
}

/* ---- what is reflected ---- */

size_t abbe_gpu_surfaces_reflections(const abbe_gpu_scene *scene) {
  const size_t slots = scene->plan->light_view_count + 2, channels = scene->plan->textured ? 3 : 1;
  return scene->plan->receiver_count * slots * channels * 3;
}

/* The matrix of a surface under a light, from XYZ: each channel by the object's own share of it. */
static void find_matrices(const abbe_object *object, const abbe_reflected_light *light,
                          const double rec709[3][9], double matrix[3][9]) {
  if (object->spectrum != NULL) {
    abbe_reflected_light_matrices(light, object->spectrum, matrix);
    return;
  }
  for (int j = 0; j < 3; j++)
    for (int i = 0; i < 9; i++) matrix[j][i] = object->reflectance[j] * rec709[j][i];
}

/* Into the working space, as columns; without textures all channels as one. */
static void store_matrices(const abbe_gpu_scene *scene, const double matrix[3][9],
                           float (*out)[4]) {
  const abbe_rgb_space space = abbe_gpu_scene_working_space(scene);
  const int channels = scene->plan->textured ? 3 : 1;
  double to_xyz[9], from_xyz[9];
  abbe_rgb_space_to_xyz(space, to_xyz);
  abbe_rgb_space_from_xyz(space, from_xyz);
  for (int j = 0; j < channels; j++) {
    double sum[9], own[9];
    for (int i = 0; i < 9; i++)
      sum[i] = channels == 3 ? matrix[j][i] : matrix[0][i] + matrix[1][i] + matrix[2][i];
    abbe_matrix3_multiply(sum, to_xyz, own);
    abbe_matrix3_multiply(from_xyz, own, sum);
    for (int column = 0; column < 3; column++)
      for (int row = 0; row < 3; row++) out[3 * j + column][row] = (float)sum[3 * row + column];
  }
}

/* Ambient light is white, (1, 1, 1) in every working space, and is reflected as the first light is,
 * whose colour becomes white by a factor each of X, Y and Z. */
static void whiten(const abbe_reflected_light *light, const abbe_object *object,
                   double matrix[3][9]) {
  double of[3][3], xyz[3];
  abbe_reflected_light_xyz(light, object->spectrum, of);
  abbe_reflected_light_white(light, xyz);
  for (int j = 0; j < 3; j++) {
    const double share = object->spectrum != NULL ? 1 : object->reflectance[j];
    for (int i = 0; i < 9; i++) matrix[j][i] = 0;
    for (int k = 0; k < 3; k++)
      matrix[j][4 * k] = xyz[k] > 0 ? share * of[j][k] / xyz[k] : share / 3;
  }
}

enum { OF_LIGHT, OF_AMBIENT };

static void fill_slot(const abbe_gpu_scene *scene, const abbe_reflected_light *light, size_t slot,
                      int of, float (*out)[4]) {
  const size_t slots = scene->plan->light_view_count + 2;
  const size_t stride = scene->plan->textured ? 9 : 3;
  double rec709[3][9], matrix[3][9];
  abbe_reflected_light_matrices(light, NULL, rec709);
  for (size_t i = 0; i < scene->plan->receiver_count; i++) {
    const abbe_object *object = &scene->local->object[scene->plan->receiver_object[i]];
    if (of == OF_AMBIENT)
      whiten(light, object, matrix);
    else
      find_matrices(object, light, (const double(*)[9])rec709, matrix);
    store_matrices(scene, (const double(*)[9])matrix, out + (i * slots + slot) * stride);
  }
}

/* A slot each of the lights, of ambient light and of the environment. */
static abbe_result fill_reflections(const abbe_gpu_scene *scene, float (*out)[4],
                                    abbe_error *error) {
  const abbe_render_desc *desc = &scene->plan->desc;
  const size_t lights = scene->plan->light_view_count;
  const abbe_illuminant *made = NULL;
  abbe_reflected_light *light = NULL;
  abbe_result result = ABBE_OK;
  for (size_t slot = 0; slot < lights + 2 && result == ABBE_OK; slot++) {
    const abbe_illuminant *wanted = slot < lights    ? &scene->local->light[slot].illuminant
                                    : slot == lights ? abbe_scene_illuminant(scene->local)
                                    : scene->local->environment != NULL
                                        ? &scene->local->environment->illuminant
                                        : made;
    if (made == NULL || wanted->kind != made->kind || wanted->spectrum != made->spectrum) {
      abbe_reflected_light_free(light);
      result = abbe_reflected_light_make_by(desc->observer, wanted, desc->min_nm, desc->max_nm,
                                            &light, error);
      made = wanted;
    }
    if (result == ABBE_OK)
      fill_slot(scene, light, slot, slot == lights ? OF_AMBIENT : OF_LIGHT, out);
  }
  abbe_reflected_light_free(light);
  return result;
}

static abbe_result upload_reflections(abbe_gpu_scene *scene, abbe_error *error) {
  const size_t room = abbe_gpu_spectra_room(abbe_gpu_surfaces_reflections(scene));
  float(*row)[4] = calloc(room, sizeof *row);
  if (row == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for reflections");
  abbe_result result = fill_reflections(scene, row, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(scene->gpu, room * sizeof *row, row, &scene->reflections, error);
  free(row);
  return result;
}

abbe_result abbe_gpu_surfaces_upload(abbe_gpu_scene *scene, abbe_error *error) {
  gpu_surface *surface = calloc(scene->plan->receiver_count + 1, sizeof *surface);
  if (surface == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for surfaces");
  for (size_t i = 0; i < scene->plan->receiver_count; i++) {
    const abbe_object *object = &scene->local->object[scene->plan->receiver_object[i]];
    surface[i].texture_info[0] = -1.0f;
    surface[i].texture_info[1] = (float)object->texture_repeat[0];
    surface[i].texture_info[2] = (float)object->texture_repeat[1];
  }
  abbe_result result = upload_textures(scene, surface, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(scene->gpu, scene->plan->receiver_count * sizeof *surface,
                                  surface, &scene->surfaces, error);
  free(surface);
  if (result == ABBE_OK) result = upload_reflections(scene, error);
  if (result == ABBE_OK) result = gpu_band_reflections_upload(scene, error);
  if (result != ABBE_OK) return result;
  return abbe_gpu_environment_make(scene->gpu, scene->local, abbe_gpu_scene_working_space(scene),
                                   &scene->plan->desc, &scene->environment, error);
}
