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
#include "gl/device/program.h"
#include "gl/renderer_state.h"

#include "colorimetry/weights.h"
#include "scenes/geometry/transform.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct thesis_state {
  GLuint layers, depth_only, splat, fill, receivers, refraction;
  GLuint light_normals, light_depths, light_receiver_depth, map, filled;
  GLuint eye_normals, eye_depths, eye_receiver_depth, eye_receivers;
  double light_look[16], light_clip[16], eye_look[16], eye_clip[16];
  float (*colour)[3];
  float *index, *attenuation_of; /* [wavelengths] */
  bool cie;
  float white[3]; /* XYZ, of all weights */
  double attenuation;
};

static const double colour_sum = 3.5;

/* Integral of the splat's Gaussian over its disk, in texels. */
static const double splat_sum = 2.6075;

/* XYZ weights, indices and attenuations of the default profile. */
static abbe_result make_cie_tables(abbe_renderer *r, abbe_error *error) {
  thesis_state *t = r->thesis;
  size_t n = r->plan.desc.wavelengths;
  const abbe_material *material = r->scene->object[r->plan.refractor_object[0]].material;
  abbe_wavelengths nodes = {0};
  abbe_weights xyz = {0};
  abbe_result result =
      abbe_wavelengths_make(n, r->plan.desc.min_nm, r->plan.desc.max_nm, &nodes, error);
  if (result == ABBE_OK)
    result =
        abbe_weights_make(&nodes, &r->scene->light[0].illuminant, ABBE_RGB_SPACE_XYZ, &xyz, error);
  for (size_t i = 0; i < n && result == ABBE_OK; i++) {
    double index = 1;
    result = abbe_material_n(material, nodes.lambda_nm[i], &index, error);
    t->index[i] = (float)index;
    t->attenuation_of[i] = (float)abbe_material_attenuation(material, nodes.lambda_nm[i]);
    for (int c = 0; c < 3; c++) {
      t->colour[i][c] = (float)xyz.weight[i][c];
      t->white[c] = (float)xyz.sum[c];
    }
  }
  abbe_weights_free(&xyz);
  abbe_wavelengths_free(&nodes);
  return result;
}

/* The seven colours, or as many as asked for along the same curve, with the same sum. */
static abbe_result make_tables(abbe_renderer *r, abbe_error *error) {
  thesis_state *t = r->thesis;
  size_t n = r->plan.desc.wavelengths;
  t->colour = calloc(n, sizeof *t->colour);
  t->index = calloc(n, sizeof *t->index);
  t->attenuation_of = calloc(n, sizeof *t->attenuation_of);
  if (t->colour == NULL || t->index == NULL || t->attenuation_of == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the thesis's colours");
  if (t->cie) return make_cie_tables(r, error);
  const abbe_material *material = r->scene->object[r->plan.refractor_object[0]].material;
  double sum[3] = {0, 0, 0};
  for (size_t i = 0; i < n; i++) {
    double at = n > 1 ? 6.0 * (double)i / (double)(n - 1) : 3.0, f = at - floor(at), index = 1;
    size_t k = (size_t)fmin(floor(at), 5);
    f = at - (double)k;
    for (int c = 0; c < 3; c++) {
      double a = abbe_weights_thesis_rgb[k][c], b = abbe_weights_thesis_rgb[k + 1][c];
      t->colour[i][c] = (float)(a + f * (b - a));
      sum[c] += t->colour[i][c];
    }
    abbe_result result = abbe_material_n(material, r->lambda_nm[i], &index, error);
    if (result != ABBE_OK) return result;
    t->index[i] = (float)index;
  }
  for (size_t i = 0; i < n && n != ABBE_WEIGHTS_THESIS_COUNT; i++)
    for (int c = 0; c < 3; c++) t->colour[i][c] *= (float)(colour_sum / sum[c]);
  t->attenuation = abbe_material_attenuation(material, 550.0);
  return ABBE_OK;
}

static void look_and_clip(const abbe_view *view, double look[16], double clip[16]) {
  double target[3];
  for (int k = 0; k < 3; k++) target[k] = view->origin[k] + view->forward[k];
  abbe_transform_look_at(view->origin, target, view->up, look);
  const double *w = view->window;
  abbe_transform_perspective(w[0], w[1], w[2], w[3], view->near, view->far, clip);
}

static abbe_result make_targets(abbe_renderer *r, abbe_error *error) {
  thesis_state *t = r->thesis;
  size_t map = r->plan.desc.map_size, w = r->plan.desc.width, h = r->plan.desc.height;
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
      {&r->eye_picture, GL_RGBA32F, w, h, 0, false},
  };
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < sizeof all / sizeof *all && result == ABBE_OK; i++)
    result = abbe_renderer_make_texture(r, all[i].format, all[i].width, all[i].height,
                                        all[i].layers, all[i].linear, all[i].texture, error);
  return result;
}

static abbe_result make_programs(abbe_renderer *r, abbe_error *error) {
  thesis_state *t = r->thesis;
  char defines[sizeof r->defines + 16];
  snprintf(defines, sizeof defines, "%s%s", r->defines, t->cie ? "#define CIE\n" : "");
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
  for (size_t i = 0; i < sizeof all / sizeof *all && result == ABBE_OK; i++)
    result = abbe_program_make(r->gl, all[i].stages, all[i].count, defines, all[i].out, error);
  return result;
}

abbe_result abbe_renderer_make_thesis(abbe_renderer *r, abbe_error *error) {
  r->thesis = calloc(1, sizeof *r->thesis);
  if (r->thesis == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the thesis profile");
  r->thesis->cie = r->plan.desc.profile == ABBE_PROFILE_THESIS_CIE;
  abbe_renderer_fit_eye(r);
  look_and_clip(&r->light[0].map.view, r->thesis->light_look, r->thesis->light_clip);
  look_and_clip(&r->eye, r->thesis->eye_look, r->thesis->eye_clip);
  abbe_result result = make_tables(r, error);
  if (result == ABBE_OK) result = make_targets(r, error);
  if (result == ABBE_OK) result = make_programs(r, error);
  return result;
}

static void set_matrix(abbe_renderer *r, GLuint program, const char *name, const double m[16]) {
  float f[16];
  for (int k = 0; k < 16; k++) f[k] = (float)m[k];
  r->gl->UniformMatrix4fv(r->gl->GetUniformLocation(program, name), 1, GL_FALSE, f);
}

static void set_planes(abbe_renderer *r, GLuint program, const abbe_view *view) {
  r->gl->Uniform3f(r->gl->GetUniformLocation(program, "planes"), (float)(view->near * view->far),
                   (float)(view->far - view->near), (float)view->far);
}

static void set_common(abbe_renderer *r, GLuint program, const abbe_view *view,
                       const double clip[16]) {
  const abbe_gl *gl = r->gl;
  thesis_state *t = r->thesis;
  const double *w = view->window;
  set_matrix(r, program, "projection", clip);
  gl->Uniform4f(gl->GetUniformLocation(program, "window"), (float)w[0], (float)w[1], (float)w[2],
                (float)w[3]);
  set_planes(r, program, view);
  GLsizei n = (GLsizei)r->plan.desc.wavelengths;
  gl->Uniform1fv(gl->GetUniformLocation(program, "index"), n, t->index);
  gl->Uniform1fv(gl->GetUniformLocation(program, "attenuation_of"), n, t->attenuation_of);
}

/* The lamp: white in Rec.709 at full strength, a cone; a point light's reaches everywhere. */
static void set_spot(abbe_renderer *r, GLuint program, const double direction[3]) {
  const abbe_light *light = &r->scene->light[0];
  double white[3], rgb[3], matrix[9];
  abbe_weights_band_xyz(&light->illuminant, ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM,
                        ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM, white);
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, matrix);
  abbe_rgb_space_apply(matrix, white, rgb);
  bool cone = light->kind == ABBE_LIGHT_SPOT;
  double outer = cone ? cos(light->cone_rad) : -2;
  double inner = cone ? cos(fmax(light->cone_rad - light->soft_rad, 0)) : -2;
  r->gl->Uniform4f(r->gl->GetUniformLocation(program, "spot"), (float)direction[0],
                   (float)direction[1], (float)direction[2], (float)outer);
  abbe_renderer_set_float(r, program, "spot_inner", inner);
  r->gl->Uniform3f(r->gl->GetUniformLocation(program, "spot_colour"), (float)rgb[0], (float)rgb[1],
                   (float)rgb[2]);
}

static abbe_result draw_layers(abbe_renderer *r, GLuint normals, GLuint depths, size_t width,
                               size_t height, const double look[16], const double clip[16],
                               abbe_error *error) {
  static const int all = -1;
  static const GLfloat nothing[4] = {0, 0, 0, 0}, far = 1;
  abbe_result result = abbe_renderer_set_target(r, &normals, &all, 1, depths, width, height, error);
  if (result != ABBE_OK) return result;
  r->gl->ClearBufferfv(GL_COLOR, 0, nothing);
  r->gl->ClearBufferfv(GL_DEPTH, 0, &far);
  r->gl->UseProgram(r->thesis->layers);
  set_matrix(r, r->thesis->layers, "view", look);
  set_matrix(r, r->thesis->layers, "projection", clip);
  for (size_t i = 0; i < r->plan.refractor_count; i++)
    abbe_renderer_draw(r, r->plan.refractor_object[i]);
  return ABBE_OK;
}

static abbe_result light_passes(abbe_renderer *r, abbe_error *error) {
  thesis_state *t = r->thesis;
  const abbe_gl *gl = r->gl;
  size_t map = r->plan.desc.map_size;
  static const GLfloat far = 1;
  double matrix[16];
  gl->Enable(GL_DEPTH_TEST);
  abbe_renderer_begin_pass(r);
  abbe_result result =
      abbe_renderer_set_target(r, NULL, NULL, 0, t->light_receiver_depth, map, map, error);
  if (result != ABBE_OK) return result;
  gl->ClearBufferfv(GL_DEPTH, 0, &far);
  gl->UseProgram(t->depth_only);
  abbe_transform_multiply(t->light_clip, t->light_look, matrix);
  set_matrix(r, t->depth_only, "view_projection", matrix);
  for (size_t i = 0; i < r->plan.receiver_count; i++)
    abbe_renderer_draw(r, r->plan.receiver_object[i]);
  abbe_renderer_end_pass(r, ABBE_PASS_RECEIVER_DEPTH);
  result = draw_layers(r, t->light_normals, t->light_depths, map, map, t->light_look, t->light_clip,
                       error);
  abbe_renderer_end_pass(r, ABBE_PASS_LIGHT_FRONT_AND_BACK);
  return result;
}

static abbe_result splat_photons(abbe_renderer *r, abbe_error *error) {
  thesis_state *t = r->thesis;
  const abbe_gl *gl = r->gl;
  size_t map = r->plan.desc.map_size;
  static const int flat = -1;
  static const GLfloat nothing[4] = {0, 0, 0, 0};
  abbe_renderer_begin_pass(r);
  abbe_result result = abbe_renderer_place_photons(r, 0, t->light_normals, 0, error);
  abbe_renderer_end_pass(r, ABBE_PASS_PHOTON_PLACEMENT);
  if (result == ABBE_OK)
    result = abbe_renderer_set_target(r, &t->map, &flat, 1, 0, map, map, error);
  if (result != ABBE_OK) return result;
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  gl->Disable(GL_DEPTH_TEST);
  gl->Enable(GL_BLEND);
  gl->Enable(GL_PROGRAM_POINT_SIZE);
  gl->BlendFunc(GL_ONE, GL_ONE);
  gl->UseProgram(t->splat);
  set_common(r, t->splat, &r->light[0].map.view, t->light_clip);
  double direction[3] = {0, 0, -1};
  abbe_transform_direction(t->light_look, r->scene->light[0].direction, direction);
  set_spot(r, t->splat, direction);
  abbe_renderer_bind_texture(r, t->splat, "normals", 0, t->light_normals);
  abbe_renderer_bind_texture(r, t->splat, "depths", 1, t->light_depths);
  abbe_renderer_bind_texture_2d(r, t->splat, "receiver_depth", 2, t->light_receiver_depth);
  double across = (double)map / (double)r->plan.desc.photons;
  abbe_renderer_set_int(r, t->splat, "grid", (int)r->plan.desc.photons);
  abbe_renderer_set_float(r, t->splat, "resolution", (double)map);
  abbe_renderer_set_float(r, t->splat, "modifier",
                          across * across / (t->cie ? splat_sum : colour_sum));
  gl->Uniform3fv(gl->GetUniformLocation(t->splat, "colour"), (GLsizei)r->plan.desc.wavelengths,
                 &t->colour[0][0]);
  gl->BindVertexArray(r->empty_array);
  gl->BindBuffer(GL_DRAW_INDIRECT_BUFFER, r->list[LEVELS - 1]);
  gl->DrawArraysIndirect(GL_POINTS, (const char *)NULL + 16);
  gl->Disable(GL_BLEND);
  abbe_renderer_end_pass(r, ABBE_PASS_PHOTONS);
  return ABBE_OK;
}

static abbe_result draw_screen(abbe_renderer *r, GLuint target, size_t width, size_t height,
                               abbe_error *error) {
  static const int flat = -1;
  abbe_result result = abbe_renderer_set_target(r, &target, &flat, 1, 0, width, height, error);
  if (result != ABBE_OK) return result;
  r->gl->Disable(GL_DEPTH_TEST);
  r->gl->BindVertexArray(r->empty_array);
  r->gl->DrawArrays(GL_TRIANGLES, 0, 3);
  return ABBE_OK;
}

static abbe_result fill_gaps(abbe_renderer *r, abbe_error *error) {
  thesis_state *t = r->thesis;
  size_t map = r->plan.desc.map_size;
  abbe_renderer_begin_pass(r);
  r->gl->UseProgram(t->fill);
  abbe_renderer_bind_texture_2d(r, t->fill, "spectral_map", 0, t->map);
  abbe_result result = draw_screen(r, t->filled, map, map, error);
  abbe_renderer_end_pass(r, ABBE_PASS_GAP_FILL);
  return result;
}

static void set_surface(abbe_renderer *r, size_t receiver, int *layer) {
  const abbe_object *o = &r->scene->object[r->plan.receiver_object[receiver]];
  GLuint p = r->thesis->receivers;
  bool textured = o->texture.data != NULL;
  double rgb[3] = {o->reflectance[0], o->reflectance[1], o->reflectance[2]};
  if (r->thesis->cie) abbe_renderer_to_working(r, rgb, rgb);
  r->gl->Uniform3f(r->gl->GetUniformLocation(p, "reflectance"), (float)rgb[0], (float)rgb[1],
                   (float)rgb[2]);
  r->gl->Uniform3f(r->gl->GetUniformLocation(p, "texture_info"), textured ? (float)*layer : -1.0f,
                   (float)o->texture_repeat[0], (float)o->texture_repeat[1]);
  *layer += textured;
}

/* What only the physical units ask for; programs without them have no such uniforms. */
static void set_units(abbe_renderer *r, GLuint program) {
  const abbe_gl *gl = r->gl;
  const double *forward = r->light[0].map.view.forward;
  const float *white = r->thesis->white, *m = r->rgb_from_xyz;
  if (!r->thesis->cie) return;
  gl->UniformMatrix3fv(gl->GetUniformLocation(program, "rgb_from_xyz"), 1, GL_FALSE, m);
  gl->UniformMatrix3fv(gl->GetUniformLocation(program, "xyz_from_rgb"), 1, GL_FALSE,
                       r->xyz_from_rgb);
  gl->Uniform3f(gl->GetUniformLocation(program, "forward"), (float)forward[0], (float)forward[1],
                (float)forward[2]);
  gl->Uniform3f(gl->GetUniformLocation(program, "white"), white[0], white[1], white[2]);
  abbe_renderer_set_float(r, program, "power", r->scene->light[0].power);
  abbe_renderer_set_float(r, program, "ambient", r->scene->ambient);
}

static abbe_result light_receivers(abbe_renderer *r, abbe_error *error) {
  thesis_state *t = r->thesis;
  const abbe_gl *gl = r->gl;
  static const int flat = -1;
  static const GLfloat far = 1;
  double matrix[16];
  abbe_renderer_begin_pass(r);
  abbe_result result =
      abbe_renderer_set_target(r, &t->eye_receivers, &flat, 1, t->eye_receiver_depth,
                               r->plan.desc.width, r->plan.desc.height, error);
  if (result != ABBE_OK) return result;
  const GLfloat sky = t->cie ? (float)r->scene->background : 0;
  const GLfloat background[4] = {sky, sky, sky, 0};
  gl->ClearBufferfv(GL_COLOR, 0, background);
  gl->ClearBufferfv(GL_DEPTH, 0, &far);
  gl->Enable(GL_DEPTH_TEST);
  gl->UseProgram(t->receivers);
  abbe_transform_multiply(t->eye_clip, t->eye_look, matrix);
  set_matrix(r, t->receivers, "view_projection", matrix);
  abbe_transform_multiply(t->light_clip, t->light_look, matrix);
  set_matrix(r, t->receivers, "light_matrix", matrix);
  set_spot(r, t->receivers, r->scene->light[0].direction);
  set_planes(r, t->receivers, &r->light[0].map.view);
  set_units(r, t->receivers);
  const double *lamp = r->scene->light[0].position, *eye = r->scene->camera.eye;
  gl->Uniform3f(gl->GetUniformLocation(t->receivers, "light_position"), (float)lamp[0],
                (float)lamp[1], (float)lamp[2]);
  gl->Uniform3f(gl->GetUniformLocation(t->receivers, "eye"), (float)eye[0], (float)eye[1],
                (float)eye[2]);
  bool fills = r->plan.desc.fill == ABBE_FILL_SMEAR;
  abbe_renderer_bind_texture_2d(r, t->receivers, "spectral_map", 0, fills ? t->filled : t->map);
  abbe_renderer_bind_texture_2d(r, t->receivers, "shadow_map", 1, t->light_receiver_depth);
  abbe_renderer_bind_texture(r, t->receivers, "surface_texture", 2, r->texture_surface);
  abbe_renderer_bind_texture(r, t->receivers, "refractor_depths", 3, t->light_depths);
  int layer = 0;
  for (size_t i = 0; i < r->plan.receiver_count; i++) {
    set_surface(r, i, &layer);
    abbe_renderer_draw(r, r->plan.receiver_object[i]);
  }
  abbe_renderer_end_pass(r, ABBE_PASS_EYE_RECEIVERS);
  return ABBE_OK;
}

static abbe_result refract_eye(abbe_renderer *r, abbe_error *error) {
  thesis_state *t = r->thesis;
  const abbe_gl *gl = r->gl;
  size_t width = r->plan.desc.width, height = r->plan.desc.height;
  GLsizei n = (GLsizei)r->plan.desc.wavelengths;
  gl->Enable(GL_DEPTH_TEST);
  abbe_renderer_begin_pass(r);
  abbe_result result =
      draw_layers(r, t->eye_normals, t->eye_depths, width, height, t->eye_look, t->eye_clip, error);
  abbe_renderer_end_pass(r, ABBE_PASS_EYE_FRONT_AND_BACK);
  if (result != ABBE_OK) return result;
  gl->UseProgram(t->refraction);
  set_common(r, t->refraction, &r->eye, t->eye_clip);
  double lamp[3], none[3] = {0, 0, -1};
  abbe_transform_point(t->eye_look, r->scene->light[0].position, lamp);
  set_spot(r, t->refraction, none);
  set_units(r, t->refraction);
  gl->Uniform3f(gl->GetUniformLocation(t->refraction, "light_position"), (float)lamp[0],
                (float)lamp[1], (float)lamp[2]);
  gl->Uniform2f(gl->GetUniformLocation(t->refraction, "picture_size"), (float)width, (float)height);
  abbe_renderer_set_float(r, t->refraction, "attenuation", t->attenuation);
  float(*colour)[3] = malloc((size_t)n * sizeof *colour);
  if (colour == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for colours");
  for (GLsizei i = 0; i < n; i++)
    for (int c = 0; c < 3; c++) colour[i][c] = t->colour[i][c] * (t->cie ? 1 / t->white[c] : 0.26f);
  gl->Uniform3fv(gl->GetUniformLocation(t->refraction, "colour"), n, &colour[0][0]);
  free(colour);
  abbe_renderer_bind_texture(r, t->refraction, "normals", 0, t->eye_normals);
  abbe_renderer_bind_texture(r, t->refraction, "depths", 1, t->eye_depths);
  abbe_renderer_bind_texture_2d(r, t->refraction, "receiver_depth", 2, t->eye_receiver_depth);
  abbe_renderer_bind_texture_2d(r, t->refraction, "receivers", 3, t->eye_receivers);
  result = draw_screen(r, r->eye_picture, width, height, error);
  abbe_renderer_end_pass(r, ABBE_PASS_EYE_REFRACTION);
  return result;
}

abbe_result abbe_renderer_thesis_frame(abbe_renderer *r, abbe_error *error) {
  abbe_result result = light_passes(r, error);
  if (result == ABBE_OK) result = splat_photons(r, error);
  if (result == ABBE_OK && r->plan.desc.fill == ABBE_FILL_SMEAR) result = fill_gaps(r, error);
  if (result == ABBE_OK) result = light_receivers(r, error);
  if (result == ABBE_OK) result = refract_eye(r, error);
  if (result != ABBE_OK) return result;
  if (r->statistics != NULL) {
    GLuint count = 0;
    r->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->list[LEVELS - 1]);
    r->gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof count, &count);
    r->light[0].photon_count = count;
  }
  return abbe_gl_check(r->gl, "the thesis profile", error);
}

GLuint abbe_renderer_thesis_map(const abbe_renderer *r, bool filled) {
  return filled && r->plan.desc.fill == ABBE_FILL_SMEAR ? r->thesis->filled : r->thesis->map;
}

void abbe_renderer_free_thesis(abbe_renderer *r) {
  thesis_state *t = r->thesis;
  if (t == NULL) return;
  const GLuint programs[] = {t->layers, t->depth_only, t->splat,
                             t->fill,   t->receivers,  t->refraction};
  for (size_t i = 0; i < sizeof programs / sizeof *programs; i++) r->gl->DeleteProgram(programs[i]);
  const GLuint textures[] = {
      t->light_normals, t->light_depths, t->light_receiver_depth, t->map,          t->filled,
      t->eye_normals,   t->eye_depths,   t->eye_receiver_depth,   t->eye_receivers};
  r->gl->DeleteTextures(sizeof textures / sizeof *textures, textures);
  free(t->colour);
  free(t->index);
  free(t->attenuation_of);
  free(t);
}
