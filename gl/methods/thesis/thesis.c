/* The thesis profile [Blanchette2012]: geometry shader and Gaussian point splats, fixed iteration,
 * smearing fill, and its brightness factors. Where the thesis is silent: 1024 x 1024 light buffers,
 * photon levels 128, 256, 512; the splat modifier is (map / photons)^2 / 3.5, which makes
 * undisturbed light white; the shadow's bias, 0.005, is a share of the light's range; scene ambient
 * 0.1; colours for other counts than seven are its seven, interpolated and scaled to the same sum.
 *
 * With CIE weights (thesis-cie) the same passes, splats, levels, steps and fill have the default
 * profile's wavelengths, indices, attenuation and colours in XYZ, Fresnel's law at both interfaces,
 * and flux in place of brightness factors: a splat is divided by the integral of its Gaussian, the
 * fill takes means, irradiance follows from flux as it does in receiver.glsl. Its map holds flux
 * over window area for a lamp of unit power, so that undisturbed light on the axis is white and the
 * fill's thresholds mean what they do in the thesis. */
#include "gl/methods/image_space/method.h"

#include "colorimetry/weights.h"
#include "gl/light/photon_start.h"
#include "gl/scene/local_scene.h"
#include "scenes/geometry/transform.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* What the thesis's seven colours sum to. */
#define COLOUR_SUM 3.5

/* Indices, attenuations and colours of the thesis's wavelengths, as printed or by the CIE's
 * observer. */
typedef struct tables {
  float *index, *attenuation_of; /* [wavelengths]; 1/m */
  float white[3];                /* XYZ, of all weights; by the CIE alone */
  double attenuation;            /* at 550 nm, 1/m; as printed alone */
} tables;

typedef struct abbe_thesis {
  abbe_method base;
  abbe_camera_view camera;
  abbe_photon_cells cells;
  GLuint layers, depth_only, splat, fill, receivers, refraction; /* programs */
  GLuint light_normals, light_depths, light_receiver_depth, map, filled;
  GLuint eye_normals, eye_depths, eye_receiver_depth, eye_receivers;
  abbe_image_view light, eye;
  tables tables;
  bool cie;
} abbe_thesis;

/* XYZ weights and attenuations of the default profile. */
static void fill_cie(const abbe_spectral_tables *from, abbe_thesis *t) {
  for (size_t i = 0; i < from->all.count; i++) {
    t->tables.attenuation_of[i] = (float)from->attenuation[i];
    for (int c = 0; c < 3; c++) t->base.colour[i][c] = (float)from->camera.weight[i][c];
  }
  for (int c = 0; c < 3; c++) t->tables.white[c] = (float)from->camera.sum[c];
}

/* The printed seven colours, or as many as asked for along the same curve, with the same sum. */
static void fill_printed(size_t n, float (*colour)[3]) {
  double sum[3] = {0, 0, 0};
  for (size_t i = 0; i < n; i++) {
    double at = n > 1 ? 6.0 * (double)i / (double)(n - 1) : 3.0, f = at - floor(at);
    size_t k = (size_t)fmin(floor(at), 5);
    f = at - (double)k;
    for (int c = 0; c < 3; c++) {
      double a = abbe_weights_thesis_rgb[k][c], b = abbe_weights_thesis_rgb[k + 1][c];
      colour[i][c] = (float)(a + f * (b - a));
      sum[c] += colour[i][c];
    }
  }
  for (size_t i = 0; i < n && n != ABBE_WEIGHTS_THESIS_COUNT; i++)
    for (int c = 0; c < 3; c++) colour[i][c] *= (float)(COLOUR_SUM / sum[c]);
}

static abbe_result make_tables(abbe_thesis *t, abbe_error *error) {
  const abbe_gpu_scene *scene = t->base.scene;
  const size_t n = scene->plan->desc.wavelengths;
  t->base.colour = calloc(n, sizeof *t->base.colour);
  t->tables.index = calloc(n, sizeof *t->tables.index);
  t->tables.attenuation_of = calloc(n, sizeof *t->tables.attenuation_of);
  if (t->base.colour == NULL || t->tables.index == NULL || t->tables.attenuation_of == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the thesis's colours");
  for (size_t i = 0; i < n; i++)
    t->tables.index[i] = (float)scene->tables.index[i]; /* index of the first */
  if (t->cie)
    fill_cie(&scene->tables, t);
  else
    fill_printed(n, t->base.colour);
  if (!t->cie) t->tables.attenuation = scene->tables.attenuation_550[0];
  return ABBE_OK;
}

/* Integral of the splat's Gaussian over its disk, in texels. */
static const double splat_sum = 2.6075;

static abbe_result make_targets(abbe_thesis *t, abbe_error *error) {
  const abbe_render_desc *d = &t->base.scene->plan->desc;
  const size_t map = d->map_size, w = d->width, h = d->height;
  const abbe_image_texture all[] = {
      {&t->light_normals, GL_RGBA32F, map, map, 2, true},
      {&t->light_depths, GL_DEPTH_COMPONENT32F, map, map, 2, false},
      {&t->light_receiver_depth, GL_DEPTH_COMPONENT32F, map, map, 0, false},
      {&t->map, GL_RGBA32F, map, map, 0, false},
      {&t->filled, GL_RGBA32F, map, map, 0, true},
      {&t->eye_normals, GL_RGBA32F, w, h, 2, true},
      {&t->eye_depths, GL_DEPTH_COMPONENT32F, w, h, 2, false},
      {&t->eye_receiver_depth, GL_DEPTH_COMPONENT32F, w, h, 0, false},
      {&t->eye_receivers, GL_RGBA32F, w, h, 0, false},
      {&t->base.picture, GL_RGBA32F, w, h, 0, false},
  };
  return abbe_image_textures_make(t->base.scene->gpu, all, sizeof all / sizeof *all, error);
}

static abbe_result make_programs(abbe_thesis *t, const abbe_shader_variant *variant,
                                 abbe_error *error) {
  char more[64];
  snprintf(more, sizeof more, "#define WAVELENGTHS %zu\n%s", variant->wavelengths,
           t->cie ? "#define CIE\n" : "");
  const abbe_image_program all[] = {
      {&t->layers, "thesis_layers.vert", "thesis_layers.geom", "thesis_layers.frag", more, false},
      {&t->depth_only, "surface.vert", NULL, "depth.frag", more, false},
      {&t->splat, "thesis_splat.vert", "thesis_splat.geom", "thesis_splat.frag", more, false},
      {&t->fill, "screen.vert", NULL, "thesis_fill.frag", more, false},
      {&t->receivers, "surface.vert", NULL, "thesis_receivers.frag", more, false},
      {&t->refraction, "screen.vert", NULL, "thesis_refraction.frag", more, false}};
  return abbe_image_programs_make(variant, t->base.scene->gpu, all, sizeof all / sizeof *all,
                                  error);
}

static abbe_result make(abbe_method *m, const abbe_shader_variant *variant, abbe_error *error) {
  abbe_thesis *t = (abbe_thesis *)m;
  const abbe_gpu_scene *scene = m->scene;
  t->cie = !abbe_method_of(scene->plan->desc.profile)->printed;
  abbe_view fitted;
  abbe_image_view_fit_light(scene, &fitted);
  abbe_map_layout_make(&fitted, &t->base.layout);
  abbe_camera_view_fit(scene->local, &scene->plan->desc, &t->camera);
  abbe_image_view_make(&t->base.layout.view, &t->light);
  abbe_image_view_make(&t->camera.view, &t->eye);
  ABBE_TRY(abbe_photon_cells_make(scene->gpu, scene->plan->desc.photons, &t->cells, error));
  ABBE_TRY(make_tables(t, error));
  ABBE_TRY(make_targets(t, error));
  return make_programs(t, variant, error);
}

static void set_planes(abbe_thesis *t, GLuint program, const abbe_view *view) {
  t->base.scene->gpu->gl->Uniform3f(t->base.scene->gpu->gl->GetUniformLocation(program, "planes"),
                                    (float)(view->near * view->far),
                                    (float)(view->far - view->near), (float)view->far);
}

static void set_common(abbe_thesis *t, GLuint program, const abbe_view *view,
                       const double clip[16]) {
  const abbe_gl *gl = t->base.scene->gpu->gl;
  const double *w = view->window;
  abbe_image_view_set_matrix(t->base.scene, program, "projection", clip);
  gl->Uniform4f(gl->GetUniformLocation(program, "window"), (float)w[0], (float)w[1], (float)w[2],
                (float)w[3]);
  set_planes(t, program, view);
  GLsizei n = (GLsizei)t->base.scene->plan->desc.wavelengths;
  gl->Uniform1fv(gl->GetUniformLocation(program, "index"), n, t->tables.index);
  gl->Uniform1fv(gl->GetUniformLocation(program, "attenuation_of"), n, t->tables.attenuation_of);
}

static abbe_result draw_layers(abbe_thesis *t, GLuint normals, GLuint depths, size_t width,
                               size_t height, const double look[16], const double clip[16],
                               abbe_error *error) {
  static const int all = -1;
  static const GLfloat nothing[4] = {0, 0, 0, 0}, far = 1;
  ABBE_TRY(
      abbe_gpu_set_target(t->base.scene->gpu, &normals, &all, 1, depths, width, height, error));
  t->base.scene->gpu->gl->ClearBufferfv(GL_COLOR, 0, nothing);
  t->base.scene->gpu->gl->ClearBufferfv(GL_DEPTH, 0, &far);
  t->base.scene->gpu->gl->UseProgram(t->layers);
  abbe_image_view_set_matrix(t->base.scene, t->layers, "view", look);
  abbe_image_view_set_matrix(t->base.scene, t->layers, "projection", clip);
  for (size_t i = 0; i < t->base.scene->plan->refractor_count; i++)
    abbe_gpu_meshes_draw(t->base.scene, t->base.scene->plan->refractor_object[i]);
  return ABBE_OK;
}

static abbe_result light_passes(abbe_thesis *t, abbe_error *error) {
  const abbe_gl *gl = t->base.scene->gpu->gl;
  size_t map = t->base.scene->plan->desc.map_size;
  static const GLfloat far = 1;
  double matrix[16];
  gl->Enable(GL_DEPTH_TEST);
  abbe_gpu_start_lap(t->base.scene->gpu);
  ABBE_TRY(abbe_gpu_set_target(t->base.scene->gpu, NULL, NULL, 0, t->light_receiver_depth, map, map,
                               error));
  gl->ClearBufferfv(GL_DEPTH, 0, &far);
  gl->UseProgram(t->depth_only);
  abbe_transform_multiply(t->light.clip, t->light.look, matrix);
  abbe_image_view_set_matrix(t->base.scene, t->depth_only, "view_projection", matrix);
  for (size_t i = 0; i < t->base.scene->plan->receiver_count; i++)
    abbe_gpu_meshes_draw(t->base.scene, t->base.scene->plan->receiver_object[i]);
  abbe_gpu_book_lap(t->base.scene->gpu, ABBE_PASS_RECEIVER_DEPTH);
  abbe_result result = draw_layers(t, t->light_normals, t->light_depths, map, map, t->light.look,
                                   t->light.clip, error);
  abbe_gpu_book_lap(t->base.scene->gpu, ABBE_PASS_LIGHT_FRONT_AND_BACK);
  return result;
}

static abbe_result splat_photons(abbe_thesis *t, abbe_error *error) {
  const abbe_gl *gl = t->base.scene->gpu->gl;
  size_t map = t->base.scene->plan->desc.map_size;
  static const int flat = -1;
  static const GLfloat nothing[4] = {0, 0, 0, 0};
  const size_t grid[2] = {t->base.scene->plan->desc.photons, t->base.scene->plan->desc.photons};
  abbe_gpu_start_lap(t->base.scene->gpu);
  abbe_result result = abbe_photon_cells_run(&t->cells, grid, t->light_normals, 0, error);
  abbe_gpu_book_lap(t->base.scene->gpu, ABBE_PASS_PHOTON_PLACEMENT);
  if (result == ABBE_OK)
    result = abbe_gpu_set_target(t->base.scene->gpu, &t->map, &flat, 1, 0, map, map, error);
  if (result != ABBE_OK) return result;
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  gl->Disable(GL_DEPTH_TEST);
  gl->Enable(GL_BLEND);
  gl->Enable(GL_PROGRAM_POINT_SIZE);
  gl->BlendFunc(GL_ONE, GL_ONE);
  gl->UseProgram(t->splat);
  set_common(t, t->splat, &t->base.layout.view, t->light.clip);
  double direction[3] = {0, 0, -1};
  abbe_transform_direction(t->light.look, t->base.scene->local->light[0].direction, direction);
  abbe_image_view_set_lamp(t->base.scene, t->splat, direction);
  abbe_gpu_bind_array(t->base.scene->gpu, t->splat, "normals", 0, t->light_normals);
  abbe_gpu_bind_array(t->base.scene->gpu, t->splat, "depths", 1, t->light_depths);
  abbe_gpu_bind_texture(t->base.scene->gpu, t->splat, "receiver_depth", 2, t->light_receiver_depth);
  double across = (double)map / (double)t->base.scene->plan->desc.photons;
  abbe_gpu_set_int(t->base.scene->gpu, t->splat, "grid", (int)t->base.scene->plan->desc.photons);
  abbe_gpu_set_float(t->base.scene->gpu, t->splat, "resolution", (double)map);
  abbe_gpu_set_float(t->base.scene->gpu, t->splat, "modifier",
                     across * across / (t->cie ? splat_sum : COLOUR_SUM));
  gl->Uniform3fv(gl->GetUniformLocation(t->splat, "colour"),
                 (GLsizei)t->base.scene->plan->desc.wavelengths, &t->base.colour[0][0]);
  gl->BindVertexArray(t->base.scene->gpu->empty_array);
  gl->BindBuffer(GL_DRAW_INDIRECT_BUFFER, t->cells.list[ABBE_CELL_LEVELS - 1]);
  gl->DrawArraysIndirect(GL_POINTS, (const void *)(uintptr_t)16);
  gl->Disable(GL_BLEND);
  abbe_gpu_book_lap(t->base.scene->gpu, ABBE_PASS_PHOTONS);
  return ABBE_OK;
}

static abbe_result fill_gaps(abbe_thesis *t, abbe_error *error) {
  size_t map = t->base.scene->plan->desc.map_size;
  abbe_gpu_start_lap(t->base.scene->gpu);
  t->base.scene->gpu->gl->UseProgram(t->fill);
  abbe_gpu_bind_texture(t->base.scene->gpu, t->fill, "spectral_map", 0, t->map);
  abbe_result result = abbe_image_view_draw_screen(t->base.scene, t->filled, -1, map, map, error);
  abbe_gpu_book_lap(t->base.scene->gpu, ABBE_PASS_GAP_FILL);
  return result;
}

static abbe_result light_receivers(abbe_thesis *t, abbe_error *error) {
  const abbe_gl *gl = t->base.scene->gpu->gl;
  static const int flat = -1;
  static const GLfloat far = 1;
  double matrix[16];
  abbe_gpu_start_lap(t->base.scene->gpu);
  ABBE_TRY(abbe_gpu_set_target(t->base.scene->gpu, &t->eye_receivers, &flat, 1,
                               t->eye_receiver_depth, t->base.scene->plan->desc.width,
                               t->base.scene->plan->desc.height, error));
  const GLfloat sky = t->cie ? (float)t->base.scene->local->background : 0;
  const GLfloat background[4] = {sky, sky, sky, 0};
  gl->ClearBufferfv(GL_COLOR, 0, background);
  gl->ClearBufferfv(GL_DEPTH, 0, &far);
  gl->Enable(GL_DEPTH_TEST);
  gl->UseProgram(t->receivers);
  abbe_transform_multiply(t->eye.clip, t->eye.look, matrix);
  abbe_image_view_set_matrix(t->base.scene, t->receivers, "view_projection", matrix);
  abbe_transform_multiply(t->light.clip, t->light.look, matrix);
  abbe_image_view_set_matrix(t->base.scene, t->receivers, "light_matrix", matrix);
  abbe_image_view_set_lamp(t->base.scene, t->receivers, t->base.scene->local->light[0].direction);
  set_planes(t, t->receivers, &t->base.layout.view);
  abbe_image_view_set_units(t->base.scene, t->receivers, &t->light.view);
  const double *lamp = t->base.scene->local->light[0].position,
               *eye = t->base.scene->local->camera.eye;
  gl->Uniform3f(gl->GetUniformLocation(t->receivers, "light_position"), (float)lamp[0],
                (float)lamp[1], (float)lamp[2]);
  gl->Uniform3f(gl->GetUniformLocation(t->receivers, "eye"), (float)eye[0], (float)eye[1],
                (float)eye[2]);
  bool fills = t->base.scene->plan->desc.fill == ABBE_FILL_SMEAR;
  abbe_gpu_bind_texture(t->base.scene->gpu, t->receivers, "spectral_map", 0,
                        fills ? t->filled : t->map);
  abbe_gpu_bind_texture(t->base.scene->gpu, t->receivers, "shadow_map", 1, t->light_receiver_depth);
  abbe_gpu_bind_array(t->base.scene->gpu, t->receivers, "surface_texture", 2,
                      t->base.scene->surface_texture);
  abbe_gpu_bind_array(t->base.scene->gpu, t->receivers, "refractor_depths", 3, t->light_depths);
  int layer = 0;
  for (size_t i = 0; i < t->base.scene->plan->receiver_count; i++) {
    abbe_image_view_set_surface(t->base.scene, t->receivers, i, &layer);
    abbe_gpu_meshes_draw(t->base.scene, t->base.scene->plan->receiver_object[i]);
  }
  abbe_gpu_book_lap(t->base.scene->gpu, ABBE_PASS_EYE_RECEIVERS);
  return ABBE_OK;
}

static abbe_result refract_eye(abbe_thesis *t, abbe_error *error) {
  const abbe_gl *gl = t->base.scene->gpu->gl;
  size_t width = t->base.scene->plan->desc.width, height = t->base.scene->plan->desc.height;
  GLsizei n = (GLsizei)t->base.scene->plan->desc.wavelengths;
  gl->Enable(GL_DEPTH_TEST);
  abbe_gpu_start_lap(t->base.scene->gpu);
  abbe_result result =
      draw_layers(t, t->eye_normals, t->eye_depths, width, height, t->eye.look, t->eye.clip, error);
  abbe_gpu_book_lap(t->base.scene->gpu, ABBE_PASS_EYE_FRONT_AND_BACK);
  if (result != ABBE_OK) return result;
  gl->UseProgram(t->refraction);
  set_common(t, t->refraction, &t->camera.view, t->eye.clip);
  double lamp[3], none[3] = {0, 0, -1};
  abbe_transform_point(t->eye.look, t->base.scene->local->light[0].position, lamp);
  abbe_image_view_set_lamp(t->base.scene, t->refraction, none);
  abbe_image_view_set_units(t->base.scene, t->refraction, &t->light.view);
  gl->Uniform3f(gl->GetUniformLocation(t->refraction, "light_position"), (float)lamp[0],
                (float)lamp[1], (float)lamp[2]);
  gl->Uniform2f(gl->GetUniformLocation(t->refraction, "picture_size"), (float)width, (float)height);
  abbe_gpu_set_float(t->base.scene->gpu, t->refraction, "attenuation", t->tables.attenuation);
  float(*colour)[3] = malloc((size_t)n * sizeof *colour);
  if (colour == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for colours");
  for (GLsizei i = 0; i < n; i++)
    for (int c = 0; c < 3; c++)
      colour[i][c] = t->base.colour[i][c] * (t->cie ? 1 / t->tables.white[c] : 0.26f);
  gl->Uniform3fv(gl->GetUniformLocation(t->refraction, "colour"), n, &colour[0][0]);
  free(colour);
  abbe_gpu_bind_array(t->base.scene->gpu, t->refraction, "normals", 0, t->eye_normals);
  abbe_gpu_bind_array(t->base.scene->gpu, t->refraction, "depths", 1, t->eye_depths);
  abbe_gpu_bind_texture(t->base.scene->gpu, t->refraction, "receiver_depth", 2,
                        t->eye_receiver_depth);
  abbe_gpu_bind_texture(t->base.scene->gpu, t->refraction, "receivers", 3, t->eye_receivers);
  result = abbe_image_view_draw_screen(t->base.scene, t->base.picture, -1, width, height, error);
  abbe_gpu_book_lap(t->base.scene->gpu, ABBE_PASS_EYE_REFRACTION);
  return result;
}

static bool smears(const abbe_thesis *t) {
  return t->base.scene->plan->desc.fill == ABBE_FILL_SMEAR;
}

static abbe_result run(abbe_method *m, bool lit, abbe_error *error) {
  abbe_thesis *t = (abbe_thesis *)m;
  abbe_gpu *gpu = m->scene->gpu;
  (void)lit;
  ABBE_TRY(light_passes(t, error));
  ABBE_TRY(splat_photons(t, error));
  if (smears(t)) ABBE_TRY(fill_gaps(t, error));
  ABBE_TRY(light_receivers(t, error));
  ABBE_TRY(refract_eye(t, error));
  if (gpu->statistics == NULL) return ABBE_OK;
  GLuint count = 0;
  gpu->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, t->cells.list[ABBE_CELL_LEVELS - 1]);
  gpu->gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof count, &count);
  m->photon_count = count;
  return ABBE_OK;
}

static void free_own(abbe_method *m) {
  abbe_thesis *t = (abbe_thesis *)m;
  GLuint textures[] = {
      t->light_normals, t->light_depths, t->light_receiver_depth, t->map,           t->filled,
      t->eye_normals,   t->eye_depths,   t->eye_receiver_depth,   t->eye_receivers, m->picture};
  abbe_photon_cells_free(&t->cells);
  abbe_gpu_drop_textures(m->scene->gpu, sizeof textures / sizeof *textures, textures);
  free(t->tables.index);
  free(t->tables.attenuation_of);
}

static abbe_result map(abbe_method *m, bool filled, GLuint *texture, abbe_error *error) {
  const abbe_thesis *t = (const abbe_thesis *)m;
  (void)error;
  *texture = filled && smears(t) ? t->filled : t->map;
  return ABBE_OK;
}

const abbe_method_kind abbe_thesis_kind = {sizeof(abbe_thesis), make, free_own, run, NULL, map};
