/* Caustics by projected surroundings [WandStrasser2003]: samples of all mirrors together, each for
 * the same area A/N, and to every pixel of a receiver (A/N) sum of L(r) cos cos / (d2 + eps), where
 * r is its view reflected at the sample, cosines below 0 are 0 and eps is the square of the
 * diameter of a sample's disk. L is one cube map of 256 x 256 texels a face for all samples, looked
 * up over the footprint of half the samples' spacing in up to 16 taps, or at a point. Nothing hides
 * anything and light is reflected once. Samples are added a few at a time by blending.
 *
 * Where the paper is silent: receivers are lit by all that is around, too, as if nothing hid it;
 * mirrors show it reflected once, and reflect as at normal incidence. Its pictures exaggerate
 * caustics "a bit"; here all is in W. */
#include "gl/methods/wand2003/wand2003.h"

#include "base/maths.h"

#include <stdlib.h>

enum { CUBE = 256, AT_ONCE = 32 /* samples of a pass */ };

static abbe_result make_programs(abbe_wand2003 *w, const abbe_shader_variant *variant,
                                 abbe_error *error) {
  const struct {
    const char *vertex, *fragment;
    GLuint *out;
  } all[] = {{"screen.vert", "surroundings.frag", &w->surroundings},
             {"surface.vert", "wand_receivers.frag", &w->receivers},
             {"surface.vert", "wand_pinholes.frag", &w->pinholes},
             {"surface.vert", "wand_mirrors.frag", &w->mirrors}};
  const bool wide = w->scene->plan->desc.footprint == ABBE_FOOTPRINT_ON;
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < sizeof all / sizeof *all && result == ABBE_OK; i++) {
    const abbe_program_stage stages[] = {{GL_VERTEX_SHADER, all[i].vertex},
                                         {GL_FRAGMENT_SHADER, all[i].fragment}};
    result = abbe_shader_variant_program(variant, w->scene->gpu, stages, 2,
                                         wide ? "#define FOOTPRINTS\n" : NULL, all[i].out, error);
  }
  return result;
}

abbe_result abbe_wand2003_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                               abbe_wand2003 *out, abbe_error *error) {
  const abbe_render_desc *d = &scene->plan->desc;
  out->scene = scene;
  abbe_camera_view_fit(scene->local, d, &out->camera);
  abbe_image_view_make(&out->camera.view, &out->view);
  abbe_result result = abbe_pinhole_samples_make(scene, true, &out->samples, error);
  if (result == ABBE_OK)
    result = abbe_pinhole_sky_make(scene, &scene->local->environment->map, CUBE, &out->sky, error);
  if (result == ABBE_OK) result = abbe_pinhole_samples_colours(scene, &out->colour, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_texture(scene->gpu, GL_RGBA32F, d->width, d->height, 0, false,
                                   &out->picture, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_texture(scene->gpu, GL_DEPTH_COMPONENT32F, d->width, d->height, 0, false,
                                   &out->depth, error);
  return result == ABBE_OK ? make_programs(out, variant, error) : result;
}

void abbe_wand2003_free(abbe_wand2003 *w) {
  if (w->scene == NULL) return;
  GLuint textures[] = {w->picture, w->depth};
  abbe_gpu_drop_textures(w->scene->gpu, sizeof textures / sizeof *textures, textures);
  abbe_pinhole_samples_free(w->scene->gpu, &w->samples);
  abbe_pinhole_sky_free(w->scene->gpu, &w->sky);
  free(w->colour);
  *w = (abbe_wand2003){0};
}

static void use(abbe_wand2003 *w, GLuint program) {
  const abbe_gl *gl = w->scene->gpu->gl;
  const double *eye = w->scene->local->camera.eye;
  gl->UseProgram(program);
  abbe_gpu_scene_set(w->scene, program);
  abbe_image_view_set_clip(w->scene, program, "view_projection", &w->view);
  abbe_image_view_set_view(w->scene, program, "eye_view", &w->view.view);
  gl->Uniform3f(gl->GetUniformLocation(program, "eye"), (float)eye[0], (float)eye[1],
                (float)eye[2]);
  gl->Uniform2f(gl->GetUniformLocation(program, "samples"), (float)w->scene->plan->desc.width,
                (float)w->scene->plan->desc.height);
  abbe_pinhole_samples_bind(w->scene, &w->samples, program);
  abbe_pinhole_sky_set(w->scene, &w->sky, ABBE_PINHOLE_SKY_UNIT, program);
}

static void draw_receivers(abbe_wand2003 *w, GLuint program) {
  const abbe_plan *plan = w->scene->plan;
  int layer = 0;
  for (size_t i = 0; i < plan->receiver_count; i++) {
    abbe_image_view_set_surface(w->scene, program, i, &layer);
    abbe_gpu_meshes_draw(w->scene, plan->receiver_object[i]);
  }
}

static void draw_mirrors(abbe_wand2003 *w) {
  const abbe_gl *gl = w->scene->gpu->gl;
  const abbe_plan *plan = w->scene->plan;
  use(w, w->mirrors);
  for (size_t i = 0; i < plan->refractor_count; i++) {
    const double *c = w->colour[i];
    gl->Uniform3f(gl->GetUniformLocation(w->mirrors, "mirror_colour"), (float)c[0], (float)c[1],
                  (float)c[2]);
    abbe_gpu_meshes_draw(w->scene, plan->refractor_object[i]);
  }
}

/* Over what is drawn, where it is seen. */
static abbe_result add_pinholes(abbe_wand2003 *w, abbe_error *error) {
  abbe_gpu *gpu = w->scene->gpu;
  const abbe_gl *gl = gpu->gl;
  const double disk = 4 / ABBE_PI * w->samples.area / (double)w->samples.count;
  abbe_result result = ABBE_OK;
  use(w, w->pinholes);
  abbe_gpu_set_float(gpu, w->pinholes, "softening", disk);
  gl->DepthFunc(GL_EQUAL);
  gl->Enable(GL_BLEND);
  gl->BlendFunc(GL_ONE, GL_ONE);
  for (size_t i = 0; i < w->samples.count && result == ABBE_OK && abbe_gpu_ask(gpu); i += AT_ONCE) {
    const size_t end = i + AT_ONCE < w->samples.count ? i + AT_ONCE : w->samples.count;
    abbe_gpu_set_int(gpu, w->pinholes, "first_pinhole", (int)i);
    abbe_gpu_set_int(gpu, w->pinholes, "end_pinhole", (int)end);
    draw_receivers(w, w->pinholes);
    if (gpu->progress != NULL) gl->Finish();
    result = abbe_gpu_tell(gpu, (double)end / (double)w->samples.count, error);
  }
  gl->Disable(GL_BLEND);
  gl->BlendFunc(GL_ONE, GL_ZERO);
  gl->DepthFunc(GL_LESS);
  return result;
}

static abbe_result draw(abbe_wand2003 *w, abbe_error *error) {
  static const int flat = -1;
  static const GLfloat nothing[4] = {0, 0, 0, 0}, far_away = 1;
  const abbe_gl *gl = w->scene->gpu->gl;
  const abbe_render_desc *d = &w->scene->plan->desc;
  abbe_gpu_start_lap(w->scene->gpu);
  abbe_result result = abbe_gpu_set_target(w->scene->gpu, &w->picture, &flat, 1, w->depth, d->width,
                                           d->height, error);
  if (result != ABBE_OK) return result;
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  gl->ClearBufferfv(GL_DEPTH, 0, &far_away);
  gl->Disable(GL_DEPTH_TEST);
  use(w, w->surroundings);
  abbe_gpu_draw_screen(w->scene->gpu);
  gl->Enable(GL_DEPTH_TEST);
  use(w, w->receivers);
  draw_receivers(w, w->receivers);
  abbe_gpu_book_lap(w->scene->gpu, ABBE_PASS_EYE_RECEIVERS);
  draw_mirrors(w);
  abbe_gpu_book_lap(w->scene->gpu, ABBE_PASS_EYE_REFRACTION);
  result = add_pinholes(w, error);
  abbe_gpu_book_lap(w->scene->gpu, ABBE_PASS_PINHOLES);
  gl->Disable(GL_DEPTH_TEST);
  return result;
}

abbe_result abbe_wand2003_run(abbe_wand2003 *w, abbe_error *error) {
  abbe_gpu_scene_bind(w->scene);
  abbe_result result = draw(w, error);
  return result == ABBE_OK ? abbe_gl_check(w->scene->gpu->gl, "the wand2003 profile", error)
                           : result;
}

abbe_result abbe_wand2003_read(const abbe_wand2003 *w, abbe_image *out, abbe_error *error) {
  return abbe_image_view_read(w->scene, w->picture, out, error);
}
