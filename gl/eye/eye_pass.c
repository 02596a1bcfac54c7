#include "gl/device/program.h"
#include "gl/plan/lit_window.h"
#include "gl/renderer_state.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of a pixel, traced first; from FINE_FROM wavelengths on, where they are more. */
enum { COARSE_BANDS = 7, FINE_FROM = 9 };
/* Pixels at a time whose bands may ask for all their samples. */
enum { REFINE_ROOM = 1 << 20, LIST_HEADER = 16 };

/* One sample a pixel is the picture: refractors are written over receivers. */
static bool resolves(const abbe_renderer *r) {
  return r->plan.desc.supersample > 1;
}

static bool enlarges(const abbe_renderer *r) {
  return r->plan.desc.upsample > 1;
}

size_t abbe_renderer_samples(const abbe_renderer *r, int axis) {
  const abbe_render_desc *d = &r->plan.desc;
  const size_t pixels = axis == 0 ? d->width : d->height;
  return (pixels * d->supersample + d->upsample - 1) / d->upsample;
}

static bool refines(const abbe_renderer *r) {
  return r->plan.desc.wavelengths >= FINE_FROM && !r->plan.desc.everything;
}

void abbe_renderer_fit_eye(abbe_renderer *r) {
  const abbe_camera *camera = &r->scene->camera;
  double forward[3];
  for (int k = 0; k < 3; k++) forward[k] = camera->target[k] - camera->eye[k];
  abbe_view_look(camera->eye, forward, camera->up, false, &r->eye);
  for (size_t i = 0; i < r->scene->object_count; i++) {
    const abbe_object *o = &r->scene->object[i];
    double corner[8][3];
    for (int k = 0; k < 24; k++)
      corner[k / 3][k % 3] = (k / 3 >> k % 3) & 1 ? o->max[k % 3] : o->min[k % 3];
    abbe_view_fit(&r->eye, (const double(*)[3])corner, 8);
  }
  abbe_view_pad(&r->eye, 0.01);
  double y = tan(0.5 * camera->fov_y_rad);
  double x = y * (double)r->plan.desc.width / (double)r->plan.desc.height;
  /* Whole samples, the last of which may stand for pixels beyond the picture. */
  const double side = (double)r->plan.desc.upsample / (double)r->plan.desc.supersample;
  const double wide = side * 2 * x / (double)r->plan.desc.width;
  const double high = side * 2 * y / (double)r->plan.desc.height;
  const double left = wide * r->plan.desc.sample_shift[0] - x;
  const double bottom = high * r->plan.desc.sample_shift[1] - y;
  const double window[4] = {left, left + wide * (double)abbe_renderer_samples(r, 0), bottom,
                            bottom + high * (double)abbe_renderer_samples(r, 1)};
  memcpy(r->eye.window, window, sizeof window);
}

static abbe_result make_targets(abbe_renderer *r, abbe_error *error) {
  const size_t w = abbe_renderer_samples(r, 0), h = abbe_renderer_samples(r, 1);
  bool layers = r->plan.camera_sees_refractor;
  GLint most = 0;
  r->gl->GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  if (w > (size_t)most || h > (size_t)most)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%zu x %zu pixels with %zu samples a side are %zu x %zu; this OpenGL "
                          "draws at most %d a side: use fewer samples or a smaller picture",
                          r->plan.desc.width, r->plan.desc.height, r->plan.desc.supersample, w, h,
                          most);
  const struct {
    GLuint *texture;
    GLenum format;
    size_t layers;
    bool wanted;
  } targets[] = {
      {&r->eye_receivers, GL_RGBA32F, 1, true},
      {&r->eye_direct, GL_RGBA32F, 0, r->plan.desc.layers},
      {&r->eye_caustic, GL_RGBA32F, 0, r->plan.desc.layers},
      {&r->eye_refraction, GL_RGBA32F, 0, resolves(r)},
      {&r->eye_depth, GL_DEPTH_COMPONENT32F, 0, true},
      {&r->eye_layers, GL_RGBA32F, r->plan.draw_back ? 2 : 1, layers},
      {&r->eye_owner, GL_R16UI, 0, layers},
      {&r->eye_layers_depth, GL_DEPTH_COMPONENT32F, 0, layers},
  };
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < sizeof targets / sizeof *targets && result == ABBE_OK; i++)
    if (targets[i].wanted)
      result = abbe_renderer_make_texture(r, targets[i].format, w, h, targets[i].layers, false,
                                          targets[i].texture, error);
  if (result == ABBE_OK && layers)
    result = abbe_renderer_make_buffer(r, LIST_HEADER + 4 * w * h, NULL, &r->pixel_list, error);
  if (result == ABBE_OK && layers && refines(r)) {
    size_t room = w * h < REFINE_ROOM ? w * h : REFINE_ROOM;
    result = abbe_renderer_make_buffer(r, LIST_HEADER + 8 * room, NULL, &r->refine_list, error);
  }
  if (result == ABBE_OK && (resolves(r) || enlarges(r)))
    result = abbe_renderer_make_texture(r, GL_RGBA32F, r->plan.desc.width, r->plan.desc.height, 0,
                                        false, &r->eye_picture, error);
  return result;
}

/* A loop that the shader has unrolled, up to so many turns; more are no longer worth their code. */
enum { MOST_COPIES = 256, MOST_COPIED_LIGHTS = 4, MOST_COPIED_RECEIVERS = 32 };

static size_t write_each(char *text, size_t room, const char *name, size_t count, size_t most) {
  if (count == 0 || count > most) return 0;
  size_t used = (size_t)snprintf(text, room, "#define EACH_%s(DO)", name);
  for (size_t i = 0; i < count; i++)
    used += (size_t)snprintf(text + used, room - used, " DO(%zu)", i);
  return used + (size_t)snprintf(text + used, room - used, "\n");
}

/* Of refraction.comp: those of all shaders, with the eye's own exits; what a software rasteriser
 * copies (copies.glsl); and `more`. */
static char *refraction_defines(const abbe_renderer *r, const char *more) {
  const abbe_plan *p = &r->plan;
  const bool software = strstr(abbe_context_description(r->context), "llvmpipe") != NULL;
  const bool convex = p->convex && p->refractor_count == 1 && !p->multi_refractor_paths;
  const size_t planes = convex ? r->scene->object[p->refractor_object[0]].exact.count : 0;
  const size_t shadows = p->light_view_count * p->refractor_count == 1 ? r->shadow_planes : 0;
  const size_t room = sizeof r->defines + strlen(more) + 256 + 4 * (64 + 8 * MOST_COPIES);
  char *text = malloc(room);
  if (text == NULL) return NULL;
  size_t used = (size_t)snprintf(text, room, "%s#undef EXITS\n#define EXITS %zu\n%s", r->defines,
                                 p->eye_exits, more);
  if (!software) return text;
  used += write_each(text + used, room - used, "LIGHT", p->light_view_count, MOST_COPIED_LIGHTS);
  used += write_each(text + used, room - used, "RECEIVER", p->parallelogram_count,
                     MOST_COPIED_RECEIVERS);
  used += write_each(text + used, room - used, "PLANE", planes, MOST_COPIES);
  write_each(text + used, room - used, "SHADOW_PLANE", shadows, MOST_COPIES);
  return text;
}

static abbe_result make_program(abbe_renderer *r, const char *more, GLuint *program,
                                abbe_error *error) {
  char *defines = refraction_defines(r, more);
  if (defines == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a shader");
  abbe_result result = abbe_program_make_compute(r->gl, "refraction.comp", defines, program, error);
  free(defines);
  return result;
}

static abbe_result make_refraction(abbe_renderer *r, abbe_error *error) {
  char coarse[64];
  if (!refines(r)) return make_program(r, "", &r->refraction, error);
  snprintf(coarse, sizeof coarse, "#define REFINES\n#define COARSE_BANDS %d\n", COARSE_BANDS);
  abbe_result result = make_program(r, coarse, &r->refraction, error);
  return result != ABBE_OK ? result
                           : make_program(r, "#define REFINED\n", &r->refraction_fine, error);
}

/* Views that hold all that the light may reach, straight and through refractors; 0: no such are
 * known.
 */
static size_t views_of_light(const abbe_renderer *r, size_t light, abbe_view out[2]) {
  if (r->plan.cubes || r->pages || !abbe_lit_window_cone(&r->scene->light[light], &out[0]))
    return 0;
  out[1] = r->light[light].map.view;
  return r->plan.reaches[light] ? 2 : 1;
}

/* Around what the view holds of the object. */
static bool bound_object(const abbe_renderer *r, const abbe_view *view, const abbe_exact *exact,
                         int out[4]) {
  const size_t w = abbe_renderer_samples(r, 0), h = abbe_renderer_samples(r, 1);
  bool any = false;
  for (size_t i = 0; i < exact->count; i++) {
    int part[4];
    if (!abbe_lit_window(view, &r->eye, exact->parallelogram[i], w, h, part)) continue;
    for (int k = 0; k < 4; k++) {
      const bool further = k < 2 ? part[k] < out[k] : part[k] > out[k];
      if (!any || further) out[k] = part[k];
    }
    any = true;
  }
  return any;
}

/* Of the picture's samples, a half at least must be drawn without light for it to pay that the
 * others are drawn once more. */
static bool pays(const abbe_renderer *r) {
  double area = 0,
         samples = (double)abbe_renderer_samples(r, 0) * (double)abbe_renderer_samples(r, 1);
  for (size_t i = 0; i < r->lit_count; i++) {
    const int *rect = r->lit[i].rect;
    area += (double)(rect[2] - rect[0]) * (double)(rect[3] - rect[1]);
  }
  return area < 0.5 * samples;
}

/* Where the picture is mostly dark, receivers are drawn without any light, and what a light may
 * reach once more: a software rasteriser skips no part of a shader that nobody needs. */
static abbe_result make_unlit(abbe_renderer *r, abbe_error *error) {
  static const abbe_program_stage stages[] = {{GL_VERTEX_SHADER, "surface.vert"},
                                              {GL_FRAGMENT_SHADER, "receivers.frag"}};
  char defines[sizeof r->defines + 64];
  if (r->plan.desc.everything || r->plan.receivers != ABBE_RECEIVER_EXACT) return ABBE_OK;
  r->lit = calloc(2 * r->plan.light_view_count * r->plan.receiver_count + 1, sizeof *r->lit);
  if (r->lit == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for receivers");
  for (size_t light = 0; light < r->plan.light_view_count; light++) {
    abbe_view view[2];
    const size_t views = views_of_light(r, light, view);
    if (views == 0) return ABBE_OK;
    for (size_t k = 0; k < views * r->plan.receiver_count; k++) {
      lit_part *part = &r->lit[r->lit_count];
      part->receiver = k / views;
      const size_t object = r->plan.receiver_object[part->receiver];
      if (bound_object(r, &view[k % views], &r->scene->object[object].exact, part->rect))
        r->lit_count++;
    }
  }
  if (!pays(r)) return ABBE_OK;
  snprintf(defines, sizeof defines, "%s#define UNLIT\n", r->defines);
  return abbe_program_make(r->gl, stages, 2, defines, &r->unlit, error);
}

abbe_result abbe_renderer_make_eye(abbe_renderer *r, abbe_error *error) {
  static const abbe_program_stage lit[] = {{GL_VERTEX_SHADER, "surface.vert"},
                                           {GL_FRAGMENT_SHADER, "receivers.frag"}};
  abbe_renderer_fit_eye(r);
  abbe_result result = make_targets(r, error);
  if (result == ABBE_OK)
    result = abbe_program_make(r->gl, lit, 2, r->defines, &r->receivers, error);
  if (result == ABBE_OK) result = make_unlit(r, error);
  if (result == ABBE_OK && r->plan.camera_sees_refractor) result = make_refraction(r, error);
  if (result == ABBE_OK && r->plan.camera_sees_refractor)
    result =
        abbe_program_make_compute(r->gl, "refraction_list.comp", NULL, &r->refraction_list, error);
  if (result == ABBE_OK && (resolves(r) || enlarges(r)))
    result = abbe_program_make_compute(r->gl, enlarges(r) ? "eye_enlarge.comp" : "eye_resolve.comp",
                                       NULL, &r->eye_resolve, error);
  return result;
}

/* What receiver.glsl wants to know, in whichever program includes it. */
void abbe_renderer_set_lighting(abbe_renderer *r, GLuint program) {
  const abbe_gl *gl = r->gl;
  abbe_renderer_bind_texture(r, program, "spectral_map", 0, r->map);
  abbe_renderer_bind_texture(r, program, "surface_texture", 1, r->texture_surface);
  abbe_renderer_bind_texture(r, program, "light_layers", 2, r->light_layers);
  GLint matrix = gl->GetUniformLocation(program, "rgb_from_xyz");
  if (matrix >= 0) gl->UniformMatrix3fv(matrix, 1, GL_FALSE, r->rgb_from_xyz);
  matrix = gl->GetUniformLocation(program, "xyz_from_rgb");
  if (matrix >= 0) gl->UniformMatrix3fv(matrix, 1, GL_FALSE, r->xyz_from_rgb);
  /* Ambient light and background are white by definition, in every working space. */
  float ambient = (float)r->scene->ambient, background = (float)r->scene->background;
  gl->Uniform3f(gl->GetUniformLocation(program, "ambient"), ambient, ambient, ambient);
  gl->Uniform3f(gl->GetUniformLocation(program, "background"), background, background, background);
  gl->Uniform4f(gl->GetUniformLocation(program, "refractor_bounds"), (float)r->refractor_centre[0],
                (float)r->refractor_centre[1], (float)r->refractor_centre[2],
                (float)r->refractor_radius);
  abbe_renderer_set_float(r, program, "scene_size", r->scene_size);
}

static void set_eye(abbe_renderer *r, GLuint program) {
  double matrix[16];
  float clip[16], packed[24];
  abbe_view_matrix(&r->eye, matrix);
  for (int k = 0; k < 16; k++) clip[k] = (float)matrix[k];
  abbe_view_pack(&r->eye, packed);
  const abbe_gl *gl = r->gl;
  gl->UniformMatrix4fv(gl->GetUniformLocation(program, "view_projection"), 1, GL_FALSE, clip);
  gl->Uniform3f(gl->GetUniformLocation(program, "eye"), packed[0], packed[1], packed[2]);
  GLint view = gl->GetUniformLocation(program, "eye_view");
  if (view >= 0) gl->Uniform4fv(view, 6, packed);
  GLint origin = gl->GetUniformLocation(program, "view_origin");
  if (origin >= 0) gl->Uniform4f(origin, packed[0], packed[1], packed[2], packed[3]);
}

static void draw_receiver(abbe_renderer *r, GLuint program, size_t receiver) {
  abbe_renderer_set_int(r, program, "surface", (int)receiver);
  if (r->pages)
    abbe_renderer_set_int(r, program, "face_first", (int)r->charts.face_first[receiver]);
  abbe_renderer_draw(r, r->plan.receiver_object[receiver]);
}

static void use_for_receivers(abbe_renderer *r, GLuint program) {
  r->gl->UseProgram(program);
  abbe_renderer_set_lighting(r, program);
  set_eye(r, program);
}

/* Over what is drawn unlit. Of equal depths the first receiver has won there, and so it does here.
 */
static void draw_lit_parts(abbe_renderer *r) {
  const abbe_gl *gl = r->gl;
  use_for_receivers(r, r->receivers);
  gl->Enable(GL_SCISSOR_TEST);
  gl->DepthFunc(GL_EQUAL);
  for (size_t i = r->lit_count; i-- > 0;) {
    const int *rect = r->lit[i].rect;
    gl->Scissor(rect[0], rect[1], rect[2] - rect[0], rect[3] - rect[1]);
    draw_receiver(r, r->receivers, r->lit[i].receiver);
  }
  gl->DepthFunc(GL_LESS);
  gl->Disable(GL_SCISSOR_TEST);
}

static abbe_result draw_receivers(abbe_renderer *r, abbe_error *error) {
  const abbe_gl *gl = r->gl;
  const size_t w = abbe_renderer_samples(r, 0), h = abbe_renderer_samples(r, 1);
  GLuint target[3] = {r->eye_receivers, r->eye_direct, r->eye_caustic};
  static const int flat[3] = {0, -1, -1};
  static const GLfloat nothing[4] = {0, 0, 0, 0}, far = 1;
  abbe_renderer_begin_pass(r);
  abbe_result result = abbe_renderer_set_target(r, target, flat, r->plan.desc.layers ? 3 : 1,
                                                r->eye_depth, w, h, error);
  if (result != ABBE_OK) return result;
  GLfloat b = (GLfloat)r->scene->background, background[4] = {b, b, b, 0};
  gl->ClearBufferfv(GL_COLOR, 0, background);
  for (GLint k = 1; k < 3 && r->plan.desc.layers; k++) gl->ClearBufferfv(GL_COLOR, k, nothing);
  gl->ClearBufferfv(GL_DEPTH, 0, &far);
  gl->Enable(GL_DEPTH_TEST);
  const GLuint whole = r->unlit != 0 ? r->unlit : r->receivers;
  use_for_receivers(r, whole);
  for (size_t i = 0; i < r->plan.receiver_count; i++) draw_receiver(r, whole, i);
  if (r->unlit != 0) draw_lit_parts(r);
  abbe_renderer_end_pass(r, ABBE_PASS_EYE_RECEIVERS);
  return ABBE_OK;
}

/* Front with its owner, and, where a mesh ends at its back layer, the back. */
static abbe_result draw_layers(abbe_renderer *r, abbe_error *error) {
  const abbe_gl *gl = r->gl;
  const size_t w = abbe_renderer_samples(r, 0), h = abbe_renderer_samples(r, 1);
  static const GLfloat nothing[4] = {0, 0, 0, 0}, far = 1;
  static const GLuint nobody[4] = {0, 0, 0, 0};
  abbe_renderer_begin_pass(r);
  gl->UseProgram(r->layer);
  set_eye(r, r->layer);
  gl->Enable(GL_DEPTH_TEST);
  gl->Enable(GL_CULL_FACE);
  for (int back = 0; back <= (r->plan.draw_back ? 1 : 0); back++) {
    GLuint target[2] = {r->eye_layers, r->eye_owner};
    int layer[2] = {back, -1};
    abbe_result result =
        abbe_renderer_set_target(r, target, layer, back ? 1 : 2, r->eye_layers_depth, w, h, error);
    if (result != ABBE_OK) return result;
    gl->ClearBufferfv(GL_COLOR, 0, nothing);
    if (!back) gl->ClearBufferuiv(GL_COLOR, 1, nobody);
    gl->ClearBufferfv(GL_DEPTH, 0, &far);
    gl->CullFace(back ? GL_FRONT : GL_BACK);
    for (size_t i = 0; i < r->plan.refractor_count; i++) {
      gl->Uniform1ui(gl->GetUniformLocation(r->layer, "owner"), (GLuint)i + 1);
      abbe_renderer_draw_refractor(r, i);
    }
    abbe_renderer_end_pass(r, back ? ABBE_PASS_EYE_BACK : ABBE_PASS_EYE_FRONT);
  }
  gl->Disable(GL_CULL_FACE);
  return ABBE_OK;
}

static void list_pixels(abbe_renderer *r, size_t w, size_t h) {
  static const GLuint zero[4] = {0, 0, 0, 0};
  const abbe_gl *gl = r->gl;
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->pixel_list);
  gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof zero, zero);
  gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_LIST, r->pixel_list);
  gl->UseProgram(r->refraction_list);
  abbe_renderer_bind_texture(r, r->refraction_list, "eye_layers", 4, r->eye_layers);
  abbe_renderer_bind_texture(r, r->refraction_list, "eye_receivers", 5, r->eye_receivers);
  abbe_renderer_bind_texture_2d(r, r->refraction_list, "eye_owner", 6, r->eye_owner);
  abbe_renderer_dispatch_2d(r, w, h);
  gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

static void clear_refine_list(abbe_renderer *r) {
  static const GLuint zero[4] = {0, 0, 0, 0};
  r->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->refine_list);
  r->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof zero, zero);
  r->gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_PHOTONS_IN, r->refine_list);
}

/* In strips where somebody watches, so that a long frame shows its progress and can be stopped. */
static abbe_result refract_pixels(abbe_renderer *r, abbe_render_progress progress, void *user,
                                  abbe_error *error) {
  const abbe_gl *gl = r->gl;
  GLuint count = 0;
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->pixel_list);
  gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof count, &count);
  GLuint strips = progress != NULL ? 16 : 1;
  GLuint step = (count / strips / PHOTON_GROUP + 1) * PHOTON_GROUP;
  if (step > 65535u * (PHOTON_GROUP / r->ways))
    step = 65535u * (PHOTON_GROUP / r->ways); /* the most groups of a dispatch */
  if (refines(r) && step > REFINE_ROOM) step = REFINE_ROOM;
  for (GLuint first = 0; first < count; first += step) {
    GLuint size = count - first < step ? count - first : step;
    gl->UseProgram(r->refraction);
    gl->Uniform1ui(gl->GetUniformLocation(r->refraction, "pixel_first"), first);
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_LIST, r->pixel_list);
    if (refines(r)) clear_refine_list(r);
    gl->DispatchCompute((size * r->ways + PHOTON_GROUP - 1) / PHOTON_GROUP, 1, 1);
    if (refines(r)) {
      gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
      abbe_renderer_dispatch_list(r, r->refraction_fine, r->refine_list, REFINE_ROOM, r->ways);
    }
    if (progress == NULL) continue;
    gl->Finish();
    if (!progress(user, 0.5 + 0.5 * (double)(first + size) / (double)count))
      return abbe_error_set(error, ABBE_CANCELLED, "the render was cancelled");
  }
  gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                    GL_TEXTURE_UPDATE_BARRIER_BIT);
  return ABBE_OK;
}

static void set_refraction(abbe_renderer *r, GLuint program, size_t rows) {
  r->gl->UseProgram(program);
  abbe_renderer_set_lighting(r, program);
  abbe_renderer_bind_texture(r, program, "eye_layers", 4, r->eye_layers);
  abbe_renderer_bind_texture_2d(r, program, "eye_owner", 6, r->eye_owner);
  set_eye(r, program);
  abbe_renderer_set_float(r, program, "share_limit", r->plan.eye_share);
  double angle = (r->eye.window[3] - r->eye.window[2]) / (double)rows;
  abbe_renderer_set_float(r, program, "pixel_angle", angle);
}

static abbe_result draw_refraction(abbe_renderer *r, abbe_render_progress progress, void *user,
                                   abbe_error *error) {
  const abbe_gl *gl = r->gl;
  const size_t w = abbe_renderer_samples(r, 0), h = abbe_renderer_samples(r, 1);
  static const int flat = -1;
  static const GLfloat nothing[4] = {0, 0, 0, 0};
  abbe_renderer_begin_pass(r);
  abbe_result result = ABBE_OK;
  if (resolves(r)) {
    result = abbe_renderer_set_target(r, &r->eye_refraction, &flat, 1, 0, w, h, error);
    if (result != ABBE_OK) return result;
    gl->ClearBufferfv(GL_COLOR, 0, nothing);
  }
  if (!r->plan.camera_sees_refractor) return ABBE_OK;
  list_pixels(r, w, h);
  if (refines(r)) set_refraction(r, r->refraction_fine, h);
  set_refraction(r, r->refraction, h);
  gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_INTERVALS, r->table_bands);
  gl->BindImageTexture(0, resolves(r) ? r->eye_refraction : r->eye_receivers, 0, GL_FALSE, 0,
                       GL_READ_WRITE, GL_RGBA32F);
  result = refract_pixels(r, progress, user, error);
  abbe_renderer_end_pass(r, ABBE_PASS_EYE_REFRACTION);
  return result;
}

static void resolve_picture(abbe_renderer *r) {
  const abbe_gl *gl = r->gl;
  abbe_renderer_begin_pass(r);
  gl->UseProgram(r->eye_resolve);
  abbe_renderer_bind_texture(r, r->eye_resolve, "receivers", 0, r->eye_receivers);
  if (resolves(r)) {
    abbe_renderer_bind_texture_2d(r, r->eye_resolve, "refraction", 1, r->eye_refraction);
    abbe_renderer_set_int(r, r->eye_resolve, "samples", (int)r->plan.desc.supersample);
  } else {
    abbe_renderer_set_int(r, r->eye_resolve, "pixels", (int)r->plan.desc.upsample);
  }
  gl->BindImageTexture(0, r->eye_picture, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
  gl->Uniform2i(gl->GetUniformLocation(r->eye_resolve, "size"), (GLint)r->plan.desc.width,
                (GLint)r->plan.desc.height);
  abbe_renderer_dispatch_2d(r, r->plan.desc.width, r->plan.desc.height);
  gl->MemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
  abbe_renderer_end_pass(r, ABBE_PASS_EYE_PICTURE);
}

abbe_result abbe_renderer_eye(abbe_renderer *r, abbe_render_progress progress, void *user,
                              abbe_error *error) {
  abbe_result result = draw_receivers(r, error);
  if (result == ABBE_OK && r->eye_layers != 0) result = draw_layers(r, error);
  if (result == ABBE_OK) result = draw_refraction(r, progress, user, error);
  if (result == ABBE_OK && r->eye_picture != 0) resolve_picture(r);
  return result != ABBE_OK ? result : abbe_gl_check(r->gl, "the eye's passes", error);
}

abbe_result abbe_renderer_floor(abbe_renderer *r, double *ms, abbe_error *error) {
  ABBE_REQUIRE(r && ms, error);
  const abbe_gl *gl = r->gl;
  static const int first = 0;
  static const GLfloat nothing[4] = {0, 0, 0, 0}, far = 1;
  const size_t w = abbe_renderer_samples(r, 0), h = abbe_renderer_samples(r, 1);
  if (r->eye_receivers == 0)
    return abbe_error_set(error, ABBE_UNSUPPORTED, "the thesis profile has no floor of its own");
  abbe_result result = ABBE_OK;
  if (r->eye_floor == 0) /* the picture may be what lies in eye_receivers, and stays */
    result = abbe_renderer_make_texture(r, GL_RGBA32F, w, h, 1, false, &r->eye_floor, error);
  if (result != ABBE_OK) return result;
  gl->Finish();
  double start_ms = abbe_renderer_now_ms();
  gl->UseProgram(r->layer);
  set_eye(r, r->layer);
  gl->Enable(GL_DEPTH_TEST);
  result = abbe_renderer_set_target(r, &r->eye_floor, &first, 1, r->eye_depth, w, h, error);
  if (result != ABBE_OK) return result;
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  gl->ClearBufferfv(GL_DEPTH, 0, &far);
  for (size_t i = 0; i < r->scene->object_count; i++) abbe_renderer_draw(r, i);
  gl->Finish();
  *ms = abbe_renderer_now_ms() - start_ms;
  return abbe_gl_check(gl, "the drawing of surfaces", error);
}
