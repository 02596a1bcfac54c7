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
#include "gl/methods/thesis/thesis.h"

#include "colorimetry/weights.h"
#include "scenes/geometry/transform.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* XYZ weights and attenuations of the default profile. */
static void fill_cie(const abbe_spectral_tables *from, abbe_thesis_tables *t) {
  for (size_t i = 0; i < from->all.count; i++) {
    t->attenuation_of[i] = (float)from->attenuation[i];
    for (int c = 0; c < 3; c++) t->colour[i][c] = (float)from->camera.weight[i][c];
  }
  for (int c = 0; c < 3; c++) t->white[c] = (float)from->camera.sum[c];
}

/* The seven colours, or as many as asked for along the same curve, with the same sum. */
abbe_result abbe_thesis_tables_make(const abbe_gpu_scene *scene, bool cie, abbe_thesis_tables *t,
                                    abbe_error *error) {
  size_t n = scene->plan->desc.wavelengths;
  t->colour = calloc(n, sizeof *t->colour);
  t->index = calloc(n, sizeof *t->index);
  t->attenuation_of = calloc(n, sizeof *t->attenuation_of);
  if (t->colour == NULL || t->index == NULL || t->attenuation_of == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the thesis's colours");
  for (size_t i = 0; i < n; i++) t->index[i] = (float)scene->tables.index[i]; /* of the first */
  if (cie) {
    fill_cie(&scene->tables, t);
    return ABBE_OK;
  }
  double sum[3] = {0, 0, 0};
  for (size_t i = 0; i < n; i++) {
    double at = n > 1 ? 6.0 * (double)i / (double)(n - 1) : 3.0, f = at - floor(at);
    size_t k = (size_t)fmin(floor(at), 5);
    f = at - (double)k;
    for (int c = 0; c < 3; c++) {
      double a = abbe_weights_thesis_rgb[k][c], b = abbe_weights_thesis_rgb[k + 1][c];
      t->colour[i][c] = (float)(a + f * (b - a));
      sum[c] += t->colour[i][c];
    }
  }
  for (size_t i = 0; i < n && n != ABBE_WEIGHTS_THESIS_COUNT; i++)
    for (int c = 0; c < 3; c++) t->colour[i][c] *= (float)(ABBE_THESIS_COLOUR_SUM / sum[c]);
  t->attenuation = scene->tables.attenuation_550[0];
  return ABBE_OK;
}

void abbe_thesis_tables_free(abbe_thesis_tables *tables) {
  free(tables->colour);
  free(tables->index);
  free(tables->attenuation_of);
}

/* Integral of the splat's Gaussian over its disk, in texels. */
static const double splat_sum = 2.6075;

static abbe_result make_targets(abbe_thesis *t, abbe_error *error) {
  size_t map = t->scene->plan->desc.map_size, w = t->scene->plan->desc.width,
         h = t->scene->plan->desc.height;
  const struct {
    GLuint *texture;
    GLenum format;
    size_t width, height, layers;
    bool linear;
  } all[] = {
      {&t->light_normals, GL_RGBA32F, map, map, 2, true},
      {&t->light_depths, GL_DEPTH_COMPONENT32F, map, map, 2, false},
      {&t->light_receiver_depth, GL_DEPTH_COMPONENT32F, map, map, 0, false},
      {&t->map, GL_RGBA32F, map, map, 0, false},
      {&t->filled, GL_RGBA32F, map, map, 0, true},
      {&t->eye_normals, GL_RGBA32F, w, h, 2, true},
      {&t->eye_depths, GL_DEPTH_COMPONENT32F, w, h, 2, false},
      {&t->eye_receiver_depth, GL_DEPTH_COMPONENT32F, w, h, 0, false},
      {&t->eye_receivers, GL_RGBA32F, w, h, 0, false},
      {&t->picture, GL_RGBA32F, w, h, 0, false},
  };
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < sizeof all / sizeof *all && result == ABBE_OK; i++)
    result = abbe_gpu_make_texture(t->scene->gpu, all[i].format, all[i].width, all[i].height,
                                   all[i].layers, all[i].linear, all[i].texture, error);
  return result;
}

static abbe_result make_programs(abbe_thesis *t, const abbe_shader_variant *variant,
                                 abbe_error *error) {
  static const abbe_program_stage layers[] = {{GL_VERTEX_SHADER, "thesis_layers.vert"},
                                              {GL_GEOMETRY_SHADER, "thesis_layers.geom"},
                                              {GL_FRAGMENT_SHADER, "thesis_layers.frag"}};
  static const abbe_program_stage depth[] = {{GL_VERTEX_SHADER, "surface.vert"},
                                             {GL_FRAGMENT_SHADER, "depth.frag"}};
  static const abbe_program_stage splat[] = {{GL_VERTEX_SHADER, "thesis_splat.vert"},
                                             {GL_GEOMETRY_SHADER, "thesis_splat.geom"},
                                             {GL_FRAGMENT_SHADER, "thesis_splat.frag"}};
  static const abbe_program_stage fill[] = {{GL_VERTEX_SHADER, "screen.vert"},
                                            {GL_FRAGMENT_SHADER, "thesis_fill.frag"}};
  static const abbe_program_stage lit[] = {{GL_VERTEX_SHADER, "surface.vert"},
                                           {GL_FRAGMENT_SHADER, "thesis_receivers.frag"}};
  static const abbe_program_stage refracted[] = {{GL_VERTEX_SHADER, "screen.vert"},
                                                 {GL_FRAGMENT_SHADER, "thesis_refraction.frag"}};
  const struct {
    const abbe_program_stage *stages;
    size_t count;
    GLuint *out;
  } all[] = {{layers, 3, &t->layers}, {depth, 2, &t->depth_only}, {splat, 3, &t->splat},
             {fill, 2, &t->fill},     {lit, 2, &t->receivers},    {refracted, 2, &t->refraction}};
  abbe_result result = ABBE_OK;
  char more[64];
  snprintf(more, sizeof more, "#define WAVELENGTHS %zu\n%s", variant->wavelengths,
           t->cie ? "#define CIE\n" : "");
  for (size_t i = 0; i < sizeof all / sizeof *all && result == ABBE_OK; i++)
    result = abbe_shader_variant_program(variant, t->scene->gpu, all[i].stages, all[i].count, more,
                                         all[i].out, error);
  return result;
}

abbe_result abbe_thesis_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                             abbe_thesis *out, abbe_error *error) {
  abbe_thesis *t = out;
  t->scene = scene;
  t->cie = !abbe_method_of(scene->plan->desc.profile)->printed;
  abbe_view fitted;
  abbe_image_view_fit_light(scene, &fitted);
  abbe_map_layout_make(&fitted, &t->layout);
  abbe_camera_view_fit(scene->local, &scene->plan->desc, &t->camera);
  abbe_image_view_make(&t->layout.view, &t->light);
  abbe_image_view_make(&t->camera.view, &t->eye);
  abbe_result result =
      abbe_photon_cells_make(scene->gpu, scene->plan->desc.photons, &t->cells, error);
  if (result == ABBE_OK) result = abbe_thesis_tables_make(t->scene, t->cie, &t->tables, error);
  if (result == ABBE_OK) result = make_targets(t, error);
  if (result == ABBE_OK) result = make_programs(t, variant, error);
  return result;
}

static void set_planes(abbe_thesis *t, GLuint program, const abbe_view *view) {
  t->scene->gpu->gl->Uniform3f(t->scene->gpu->gl->GetUniformLocation(program, "planes"),
                               (float)(view->near * view->far), (float)(view->far - view->near),
                               (float)view->far);
}

static void set_common(abbe_thesis *t, GLuint program, const abbe_view *view,
                       const double clip[16]) {
  const abbe_gl *gl = t->scene->gpu->gl;
  const double *w = view->window;
  abbe_image_view_set_matrix(t->scene, program, "projection", clip);
  gl->Uniform4f(gl->GetUniformLocation(program, "window"), (float)w[0], (float)w[1], (float)w[2],
                (float)w[3]);
  set_planes(t, program, view);
  GLsizei n = (GLsizei)t->scene->plan->desc.wavelengths;
  gl->Uniform1fv(gl->GetUniformLocation(program, "index"), n, t->tables.index);
  gl->Uniform1fv(gl->GetUniformLocation(program, "attenuation_of"), n, t->tables.attenuation_of);
}

static abbe_result draw_layers(abbe_thesis *t, GLuint normals, GLuint depths, size_t width,
                               size_t height, const double look[16], const double clip[16],
                               abbe_error *error) {
  static const int all = -1;
  static const GLfloat nothing[4] = {0, 0, 0, 0}, far = 1;
  abbe_result result =
      abbe_gpu_set_target(t->scene->gpu, &normals, &all, 1, depths, width, height, error);
  if (result != ABBE_OK) return result;
  t->scene->gpu->gl->ClearBufferfv(GL_COLOR, 0, nothing);
  t->scene->gpu->gl->ClearBufferfv(GL_DEPTH, 0, &far);
  t->scene->gpu->gl->UseProgram(t->layers);
  abbe_image_view_set_matrix(t->scene, t->layers, "view", look);
  abbe_image_view_set_matrix(t->scene, t->layers, "projection", clip);
  for (size_t i = 0; i < t->scene->plan->refractor_count; i++)
    abbe_gpu_meshes_draw(t->scene, t->scene->plan->refractor_object[i]);
  return ABBE_OK;
}

static abbe_result light_passes(abbe_thesis *t, abbe_error *error) {
  const abbe_gl *gl = t->scene->gpu->gl;
  size_t map = t->scene->plan->desc.map_size;
  static const GLfloat far = 1;
  double matrix[16];
  gl->Enable(GL_DEPTH_TEST);
  abbe_gpu_start_lap(t->scene->gpu);
  abbe_result result =
      abbe_gpu_set_target(t->scene->gpu, NULL, NULL, 0, t->light_receiver_depth, map, map, error);
  if (result != ABBE_OK) return result;
  gl->ClearBufferfv(GL_DEPTH, 0, &far);
  gl->UseProgram(t->depth_only);
  abbe_transform_multiply(t->light.clip, t->light.look, matrix);
  abbe_image_view_set_matrix(t->scene, t->depth_only, "view_projection", matrix);
  for (size_t i = 0; i < t->scene->plan->receiver_count; i++)
    abbe_gpu_meshes_draw(t->scene, t->scene->plan->receiver_object[i]);
  abbe_gpu_book_lap(t->scene->gpu, ABBE_PASS_RECEIVER_DEPTH);
  result = draw_layers(t, t->light_normals, t->light_depths, map, map, t->light.look, t->light.clip,
                       error);
  abbe_gpu_book_lap(t->scene->gpu, ABBE_PASS_LIGHT_FRONT_AND_BACK);
  return result;
}

static abbe_result splat_photons(abbe_thesis *t, abbe_error *error) {
  const abbe_gl *gl = t->scene->gpu->gl;
  size_t map = t->scene->plan->desc.map_size;
  static const int flat = -1;
  static const GLfloat nothing[4] = {0, 0, 0, 0};
  const size_t grid[2] = {t->scene->plan->desc.photons, t->scene->plan->desc.photons};
  abbe_gpu_start_lap(t->scene->gpu);
  abbe_result result = abbe_photon_cells_run(&t->cells, grid, t->light_normals, 0, error);
  abbe_gpu_book_lap(t->scene->gpu, ABBE_PASS_PHOTON_PLACEMENT);
  if (result == ABBE_OK)
    result = abbe_gpu_set_target(t->scene->gpu, &t->map, &flat, 1, 0, map, map, error);
  if (result != ABBE_OK) return result;
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  gl->Disable(GL_DEPTH_TEST);
  gl->Enable(GL_BLEND);
  gl->Enable(GL_PROGRAM_POINT_SIZE);
  gl->BlendFunc(GL_ONE, GL_ONE);
  gl->UseProgram(t->splat);
  set_common(t, t->splat, &t->layout.view, t->light.clip);
  double direction[3] = {0, 0, -1};
  abbe_transform_direction(t->light.look, t->scene->local->light[0].direction, direction);
  abbe_image_view_set_lamp(t->scene, t->splat, direction);
  abbe_gpu_bind_array(t->scene->gpu, t->splat, "normals", 0, t->light_normals);
  abbe_gpu_bind_array(t->scene->gpu, t->splat, "depths", 1, t->light_depths);
  abbe_gpu_bind_texture(t->scene->gpu, t->splat, "receiver_depth", 2, t->light_receiver_depth);
  double across = (double)map / (double)t->scene->plan->desc.photons;
  abbe_gpu_set_int(t->scene->gpu, t->splat, "grid", (int)t->scene->plan->desc.photons);
  abbe_gpu_set_float(t->scene->gpu, t->splat, "resolution", (double)map);
  abbe_gpu_set_float(t->scene->gpu, t->splat, "modifier",
                     across * across / (t->cie ? splat_sum : ABBE_THESIS_COLOUR_SUM));
  gl->Uniform3fv(gl->GetUniformLocation(t->splat, "colour"),
                 (GLsizei)t->scene->plan->desc.wavelengths, &t->tables.colour[0][0]);
  gl->BindVertexArray(t->scene->gpu->empty_array);
  gl->BindBuffer(GL_DRAW_INDIRECT_BUFFER, t->cells.list[ABBE_CELL_LEVELS - 1]);
  gl->DrawArraysIndirect(GL_POINTS, (const char *)NULL + 16);
  gl->Disable(GL_BLEND);
  abbe_gpu_book_lap(t->scene->gpu, ABBE_PASS_PHOTONS);
  return ABBE_OK;
}

static abbe_result fill_gaps(abbe_thesis *t, abbe_error *error) {
  size_t map = t->scene->plan->desc.map_size;
  abbe_gpu_start_lap(t->scene->gpu);
  t->scene->gpu->gl->UseProgram(t->fill);
  abbe_gpu_bind_texture(t->scene->gpu, t->fill, "spectral_map", 0, t->map);
  abbe_result result = abbe_image_view_draw_screen(t->scene, t->filled, -1, map, map, error);
  abbe_gpu_book_lap(t->scene->gpu, ABBE_PASS_GAP_FILL);
  return result;
}

static abbe_result light_receivers(abbe_thesis *t, abbe_error *error) {
  const abbe_gl *gl = t->scene->gpu->gl;
  static const int flat = -1;
  static const GLfloat far = 1;
  double matrix[16];
  abbe_gpu_start_lap(t->scene->gpu);
  abbe_result result =
      abbe_gpu_set_target(t->scene->gpu, &t->eye_receivers, &flat, 1, t->eye_receiver_depth,
                          t->scene->plan->desc.width, t->scene->plan->desc.height, error);
  if (result != ABBE_OK) return result;
  const GLfloat sky = t->cie ? (float)t->scene->local->background : 0;
  const GLfloat background[4] = {sky, sky, sky, 0};
  gl->ClearBufferfv(GL_COLOR, 0, background);
  gl->ClearBufferfv(GL_DEPTH, 0, &far);
  gl->Enable(GL_DEPTH_TEST);
  gl->UseProgram(t->receivers);
  abbe_transform_multiply(t->eye.clip, t->eye.look, matrix);
  abbe_image_view_set_matrix(t->scene, t->receivers, "view_projection", matrix);
  abbe_transform_multiply(t->light.clip, t->light.look, matrix);
  abbe_image_view_set_matrix(t->scene, t->receivers, "light_matrix", matrix);
  abbe_image_view_set_lamp(t->scene, t->receivers, t->scene->local->light[0].direction);
  set_planes(t, t->receivers, &t->layout.view);
  abbe_image_view_set_units(t->scene, t->receivers, &t->light.view);
  const double *lamp = t->scene->local->light[0].position, *eye = t->scene->local->camera.eye;
  gl->Uniform3f(gl->GetUniformLocation(t->receivers, "light_position"), (float)lamp[0],
                (float)lamp[1], (float)lamp[2]);
  gl->Uniform3f(gl->GetUniformLocation(t->receivers, "eye"), (float)eye[0], (float)eye[1],
                (float)eye[2]);
  bool fills = t->scene->plan->desc.fill == ABBE_FILL_SMEAR;
  abbe_gpu_bind_texture(t->scene->gpu, t->receivers, "spectral_map", 0, fills ? t->filled : t->map);
  abbe_gpu_bind_texture(t->scene->gpu, t->receivers, "shadow_map", 1, t->light_receiver_depth);
  abbe_gpu_bind_array(t->scene->gpu, t->receivers, "surface_texture", 2, t->scene->surface_texture);
  abbe_gpu_bind_array(t->scene->gpu, t->receivers, "refractor_depths", 3, t->light_depths);
  int layer = 0;
  for (size_t i = 0; i < t->scene->plan->receiver_count; i++) {
    abbe_image_view_set_surface(t->scene, t->receivers, i, &layer);
    abbe_gpu_meshes_draw(t->scene, t->scene->plan->receiver_object[i]);
  }
  abbe_gpu_book_lap(t->scene->gpu, ABBE_PASS_EYE_RECEIVERS);
  return ABBE_OK;
}

static abbe_result refract_eye(abbe_thesis *t, abbe_error *error) {
  const abbe_gl *gl = t->scene->gpu->gl;
  size_t width = t->scene->plan->desc.width, height = t->scene->plan->desc.height;
  GLsizei n = (GLsizei)t->scene->plan->desc.wavelengths;
  gl->Enable(GL_DEPTH_TEST);
  abbe_gpu_start_lap(t->scene->gpu);
  abbe_result result =
      draw_layers(t, t->eye_normals, t->eye_depths, width, height, t->eye.look, t->eye.clip, error);
  abbe_gpu_book_lap(t->scene->gpu, ABBE_PASS_EYE_FRONT_AND_BACK);
  if (result != ABBE_OK) return result;
  gl->UseProgram(t->refraction);
  set_common(t, t->refraction, &t->camera.view, t->eye.clip);
  double lamp[3], none[3] = {0, 0, -1};
  abbe_transform_point(t->eye.look, t->scene->local->light[0].position, lamp);
  abbe_image_view_set_lamp(t->scene, t->refraction, none);
  abbe_image_view_set_units(t->scene, t->refraction, &t->light.view);
  gl->Uniform3f(gl->GetUniformLocation(t->refraction, "light_position"), (float)lamp[0],
                (float)lamp[1], (float)lamp[2]);
  gl->Uniform2f(gl->GetUniformLocation(t->refraction, "picture_size"), (float)width, (float)height);
  abbe_gpu_set_float(t->scene->gpu, t->refraction, "attenuation", t->tables.attenuation);
  float(*colour)[3] = malloc((size_t)n * sizeof *colour);
  if (colour == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for colours");
  for (GLsizei i = 0; i < n; i++)
    for (int c = 0; c < 3; c++)
      colour[i][c] = t->tables.colour[i][c] * (t->cie ? 1 / t->tables.white[c] : 0.26f);
  gl->Uniform3fv(gl->GetUniformLocation(t->refraction, "colour"), n, &colour[0][0]);
  free(colour);
  abbe_gpu_bind_array(t->scene->gpu, t->refraction, "normals", 0, t->eye_normals);
  abbe_gpu_bind_array(t->scene->gpu, t->refraction, "depths", 1, t->eye_depths);
  abbe_gpu_bind_texture(t->scene->gpu, t->refraction, "receiver_depth", 2, t->eye_receiver_depth);
  abbe_gpu_bind_texture(t->scene->gpu, t->refraction, "receivers", 3, t->eye_receivers);
  result = abbe_image_view_draw_screen(t->scene, t->picture, -1, width, height, error);
  abbe_gpu_book_lap(t->scene->gpu, ABBE_PASS_EYE_REFRACTION);
  return result;
}

abbe_result abbe_thesis_run(abbe_thesis *t, abbe_error *error) {
  abbe_result result = light_passes(t, error);
  if (result == ABBE_OK) result = splat_photons(t, error);
  if (result == ABBE_OK && t->scene->plan->desc.fill == ABBE_FILL_SMEAR)
    result = fill_gaps(t, error);
  if (result == ABBE_OK) result = light_receivers(t, error);
  if (result == ABBE_OK) result = refract_eye(t, error);
  if (result != ABBE_OK) return result;
  if (t->scene->gpu->statistics != NULL) {
    GLuint count = 0;
    t->scene->gpu->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, t->cells.list[ABBE_CELL_LEVELS - 1]);
    t->scene->gpu->gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof count, &count);
    t->photon_count = count;
  }
  return abbe_gl_check(t->scene->gpu->gl, "the thesis profile", error);
}

void abbe_thesis_free(abbe_thesis *t) {
  if (t->scene == NULL) return;
  abbe_photon_cells_free(&t->cells);
  GLuint textures[] = {
      t->light_normals, t->light_depths, t->light_receiver_depth, t->map,           t->filled,
      t->eye_normals,   t->eye_depths,   t->eye_receiver_depth,   t->eye_receivers, t->picture};
  abbe_gpu_drop_textures(t->scene->gpu, sizeof textures / sizeof *textures, textures);
  abbe_thesis_tables_free(&t->tables);
}

abbe_result abbe_thesis_read(const abbe_thesis *t, abbe_image *out, abbe_error *error) {
  return abbe_image_view_read(t->scene, t->picture, out, error);
}

abbe_result abbe_thesis_read_map(const abbe_thesis *t, bool filled, abbe_image *out,
                                 abbe_error *error) {
  const bool smeared = filled && t->scene->plan->desc.fill == ABBE_FILL_SMEAR;
  return abbe_image_view_read_map(t->scene, smeared ? t->filled : t->map, &t->layout, out, error);
}
