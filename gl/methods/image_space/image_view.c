#include "gl/methods/image_space/image_places.h"

#include "colorimetry/weights.h"
#include "gl/caustics/spectral_map.h"
#include "gl/eye/picture.h"
#include "gl/light/photon_lights.h"
#include "scenes/geometry/transform.h"
#include "scenes/view/estimator.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

size_t abbe_image_tables_define(const abbe_render_desc *d, char *out, size_t size) {
  size_t used = (size_t)snprintf(out, size, "#define WAVELENGTHS %zu\n#define INTERFACES %zu\n%s",
                                 d->wavelengths, d->interfaces,
                                 abbe_method_of(d->profile)->printed ? "#define AS_PRINTED\n" : "");
#define ABBE_DEFINE(code, name)                                                                    \
  used += (size_t)snprintf(out + used, size - used, "#define ESTIMATOR_" #code " %d\n",            \
                           (int)ABBE_ESTIMATOR_##code);
  ABBE_ESTIMATORS(ABBE_DEFINE)
#undef ABBE_DEFINE
  return used;
}

abbe_result abbe_image_tables_colours(const abbe_gpu_scene *scene, bool by_white, float (**out)[3],
                                      abbe_error *error) {
  const size_t n = scene->plan->desc.wavelengths;
  const bool printed = abbe_method_of(scene->plan->desc.profile)->printed;
  float(*colour)[3] = calloc(n, sizeof *colour);
  *out = colour;
  if (colour == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for colours");
  for (size_t i = 0; i < n; i++)
    for (size_t c = 0; c < 3; c++) {
      colour[i][c] = !printed ? (float)scene->tables.camera.weight[i][c]
                     : n == 1 ? 1.0f
                              : (float)(i + c == 2); /* blue, green, red */
      if (by_white && !printed) colour[i][c] /= (float)scene->tables.camera.sum[c];
    }
  return ABBE_OK;
}

void abbe_image_view_make(const abbe_view *view, abbe_image_view *out) {
  double target[3];
  out->view = *view;
  for (int k = 0; k < 3; k++) target[k] = view->origin[k] + view->forward[k];
  abbe_transform_look_at(view->origin, target, view->up, out->look);
  const double *w = view->window;
  if (view->orthographic)
    abbe_transform_orthographic(w[0], w[1], w[2], w[3], view->near, view->far, out->clip);
  else
    abbe_transform_perspective(w[0], w[1], w[2], w[3], view->near, view->far, out->clip);
}

static const double narrow_rad = 0.17; /* ten degrees */

static void fit_objects(const abbe_gpu_scene *scene, const size_t *object, size_t count,
                        abbe_view *view) {
  for (size_t i = 0; i < count; i++) {
    const abbe_mesh *mesh = &scene->local->object[object[i]].mesh;
    abbe_view_fit(view, (const double(*)[3])mesh->position, mesh->vertex_count);
  }
}

static bool in_units(const abbe_gpu_scene *scene) {
  return !abbe_method_of(scene->plan->desc.profile)->printed;
}

void abbe_image_view_fit_light(const abbe_gpu_scene *scene, abbe_view *view) {
  const abbe_light *light = &scene->local->light[0];
  const abbe_plan *plan = scene->plan;
  abbe_photon_light_look(scene, 0, view);
  fit_objects(scene, plan->refractor_object, plan->refractor_count, view);
  fit_objects(scene, plan->receiver_object, plan->receiver_count, view);
  const bool narrow = in_units(scene) && light->cone_rad < narrow_rad;
  if (light->kind == ABBE_LIGHT_SPOT && !narrow) {
    double look[3];
    memcpy(look, light->direction, sizeof look);
    double near = view->near, far = view->far;
    abbe_view_look(light->position, look, view->up, false, view);
    double tangent = fmin(tan(light->cone_rad), ABBE_VIEW_MAX_TANGENT);
    double window[4] = {-tangent, tangent, -tangent, tangent};
    memcpy(view->window, window, sizeof window);
    view->near = fmax(0.25 * near, 1e-3 * far);
    view->far = 1.5 * far;
  } else {
    abbe_view_pad(view, 0.01);
  }
  abbe_view_square(view);
}

void abbe_image_view_set_matrix(const abbe_gpu_scene *scene, GLuint program, const char *name,
                                const double m[16]) {
  const abbe_gl *gl = scene->gpu->gl;
  float f[16];
  for (int k = 0; k < 16; k++) f[k] = (float)m[k];
  gl->UniformMatrix4fv(gl->GetUniformLocation(program, name), 1, GL_FALSE, f);
}

void abbe_image_view_set_clip(const abbe_gpu_scene *scene, GLuint program, const char *name,
                              const abbe_image_view *view) {
  double matrix[16];
  abbe_transform_multiply(view->clip, view->look, matrix);
  abbe_image_view_set_matrix(scene, program, name, matrix);
}

void abbe_image_view_set_face(const abbe_gpu_scene *scene, GLuint program, const char *name,
                              size_t face, const abbe_view *view) {
  char row[64];
  snprintf(row, sizeof row, "%s[%zu]", name, 6 * face);
  abbe_image_view_set_view(scene, program, row, view);
}

void abbe_image_view_set_view(const abbe_gpu_scene *scene, GLuint program, const char *name,
                              const abbe_view *view) {
  const abbe_gl *gl = scene->gpu->gl;
  float packed[24];
  abbe_view_pack(view, packed);
  gl->Uniform4fv(gl->GetUniformLocation(program, name), 6, packed);
}

void abbe_image_view_set_lamp(const abbe_gpu_scene *scene, GLuint program,
                              const double direction[3]) {
  const abbe_gl *gl = scene->gpu->gl;
  const abbe_light *light = &scene->local->light[0];
  double white[3], rgb[3], matrix[9];
  abbe_weights_white(scene->plan->desc.observer, &light->illuminant, ABBE_WAVELENGTH_MIN_NM,
                     ABBE_WAVELENGTH_MAX_NM, white);
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, matrix);
  abbe_rgb_space_apply(matrix, white, rgb);
  bool cone = light->kind == ABBE_LIGHT_SPOT;
  double outer = cone ? cos(light->cone_rad) : -2;
  double inner = cone ? cos(fmax(light->cone_rad - light->soft_rad, 0)) : -2;
  gl->Uniform4f(gl->GetUniformLocation(program, "spot"), (float)direction[0], (float)direction[1],
                (float)direction[2], (float)outer);
  abbe_gpu_set_float(scene->gpu, program, "spot_inner", inner);
  gl->Uniform3f(gl->GetUniformLocation(program, "spot_colour"), (float)rgb[0], (float)rgb[1],
                (float)rgb[2]);
}

void abbe_image_view_set_surface(const abbe_gpu_scene *scene, GLuint program, size_t receiver,
                                 int *layer) {
  const abbe_gl *gl = scene->gpu->gl;
  const abbe_object *o = &scene->local->object[scene->plan->receiver_object[receiver]];
  bool textured = o->texture.data != NULL;
  double rgb[3] = {o->reflectance[0], o->reflectance[1], o->reflectance[2]};
  if (in_units(scene)) abbe_gpu_scene_to_working(scene, rgb, rgb);
  gl->Uniform3f(gl->GetUniformLocation(program, "reflectance"), (float)rgb[0], (float)rgb[1],
                (float)rgb[2]);
  gl->Uniform3f(gl->GetUniformLocation(program, "texture_info"), textured ? (float)*layer : -1.0f,
                (float)o->texture_repeat[0], (float)o->texture_repeat[1]);
  *layer += textured;
}

void abbe_image_view_set_units(const abbe_gpu_scene *scene, GLuint program,
                               const abbe_view *light) {
  const abbe_gl *gl = scene->gpu->gl;
  const double *forward = light->forward, *white = scene->tables.camera.sum;
  if (!in_units(scene)) return;
  gl->UniformMatrix3fv(gl->GetUniformLocation(program, "rgb_from_xyz"), 1, GL_FALSE,
                       scene->rgb_from_xyz);
  gl->UniformMatrix3fv(gl->GetUniformLocation(program, "xyz_from_rgb"), 1, GL_FALSE,
                       scene->xyz_from_rgb);
  gl->Uniform3f(gl->GetUniformLocation(program, "forward"), (float)forward[0], (float)forward[1],
                (float)forward[2]);
  gl->Uniform3f(gl->GetUniformLocation(program, "white"), (float)white[0], (float)white[1],
                (float)white[2]);
  abbe_gpu_set_float(scene->gpu, program, "power", scene->local->light[0].power);
  abbe_gpu_set_float(scene->gpu, program, "ambient", scene->local->ambient);
}

abbe_result abbe_image_view_draw_screen(const abbe_gpu_scene *scene, GLuint target, int layer,
                                        size_t width, size_t height, abbe_error *error) {
  const abbe_gl *gl = scene->gpu->gl;
  ABBE_TRY(abbe_gpu_set_target(scene->gpu, &target, &layer, 1, 0, width, height, error));
  gl->Disable(GL_DEPTH_TEST);
  abbe_gpu_draw_screen(scene->gpu);
  return ABBE_OK;
}

abbe_result abbe_image_view_read(const abbe_gpu_scene *scene, GLuint picture, abbe_image *out,
                                 abbe_error *error) {
  static const char *const rgb[] = {"R", "G", "B"}, *const xyz[] = {"X", "Y", "Z"};
  const abbe_gl *gl = scene->gpu->gl;
  const abbe_render_desc *desc = &scene->plan->desc;
  const bool as_xyz = in_units(scene) && desc->space == ABBE_RGB_SPACE_XYZ;
  ABBE_TRY(abbe_image_make(desc->width, desc->height, 3, as_xyz ? xyz : rgb, out, error));
  float *data = malloc(out->width * out->height * 4 * sizeof *data);
  if (data == NULL) {
    abbe_image_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to read the picture");
  }
  gl->BindTexture(GL_TEXTURE_2D, picture);
  gl->GetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, data);
  abbe_picture_copy_flipped(data, 0, out, 0, 3, 1);
  free(data);
  if (as_xyz) abbe_picture_to_xyz(out, 0);
  return ABBE_OK;
}

abbe_result abbe_image_view_read_map(const abbe_gpu_scene *scene, GLuint map,
                                     const abbe_map_layout *layout, abbe_image *out,
                                     abbe_error *error) {
  const abbe_gl *gl = scene->gpu->gl;
  const size_t side = scene->plan->desc.map_size;
  ABBE_FREED float *data = malloc(side * side * 4 * sizeof *data);
  if (data == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to read the map");
  gl->BindTexture(GL_TEXTURE_2D, map);
  gl->GetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, data);
  /* The passes sum the light of a light of unit power. */
  return in_units(scene)
             ? abbe_map_picture_flux(data, side, layout, scene->local->light[0].power, out, error)
             : abbe_map_picture_colour(data, side, out, error);
}

abbe_result abbe_image_textures_make(abbe_gpu *gpu, const abbe_image_texture *all, size_t count,
                                     abbe_error *error) {
  for (size_t i = 0; i < count; i++)
    if (all[i].texture != NULL)
      ABBE_TRY(abbe_gpu_make_texture(gpu, all[i].format, all[i].width, all[i].height, all[i].layers,
                                     all[i].linear, all[i].texture, error));
  return ABBE_OK;
}

abbe_result abbe_image_programs_make(const abbe_shader_variant *variant, abbe_gpu *gpu,
                                     const abbe_image_program *all, size_t count,
                                     abbe_error *error) {
  for (size_t i = 0; i < count; i++) {
    const abbe_image_program *p = &all[i];
    abbe_program_stage stages[3] = {{GL_VERTEX_SHADER, p->vertex}};
    size_t used = 1;
    if (p->program == NULL) continue;
    if (p->geometry != NULL) stages[used++] = (abbe_program_stage){GL_GEOMETRY_SHADER, p->geometry};
    stages[used++] = (abbe_program_stage){GL_FRAGMENT_SHADER, p->fragment};
    ABBE_TRY(
        p->plain
            ? abbe_gpu_program(gpu, stages, used, p->more != NULL ? p->more : "", p->program, error)
            : abbe_shader_variant_program(variant, gpu, stages, used, p->more, p->program, error));
  }
  return ABBE_OK;
}
