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
#include "gl/methods/image_space/method.h"

#include "base/maths.h"
#include "gl/methods/pinholes/pinhole_samples.h"
#include "gl/scene/local_scene.h"

#include <stdlib.h>

enum { CUBE = 256, AT_ONCE = 32 /* samples of a pass */ };

typedef struct abbe_wand2003 {
  abbe_method base;
  abbe_pinhole_samples samples;
  abbe_pinhole_sky sky;
  double (*colour)[3]; /* colour of each mirror */
  abbe_camera_view camera;
  abbe_image_view view;
  GLuint surroundings, receivers, pinholes, mirrors; /* programs */
  GLuint depth;
} abbe_wand2003;

static abbe_result make(abbe_method *m, const abbe_shader_variant *variant, abbe_error *error) {
  abbe_wand2003 *w = (abbe_wand2003 *)m;
  const abbe_gpu_scene *scene = m->scene;
  const abbe_render_desc *d = &scene->plan->desc;
  const char *more = d->footprint == ABBE_FOOTPRINT_ON ? "#define FOOTPRINTS\n" : NULL;
  const abbe_image_texture textures[] = {
      {&m->picture, GL_RGBA32F, d->width, d->height, 0, false},
      {&w->depth, GL_DEPTH_COMPONENT32F, d->width, d->height, 0, false}};
  const abbe_image_program programs[] = {
      {&w->surroundings, "screen.vert", NULL, "surroundings.frag", more, false},
      {&w->receivers, "surface.vert", NULL, "wand_receivers.frag", more, false},
      {&w->pinholes, "surface.vert", NULL, "wand_pinholes.frag", more, false},
      {&w->mirrors, "surface.vert", NULL, "wand_mirrors.frag", more, false}};
  abbe_camera_view_fit(scene->local, d, &w->camera);
  abbe_image_view_make(&w->camera.view, &w->view);
  ABBE_TRY(abbe_pinhole_samples_make(scene, true, &w->samples, error));
  ABBE_TRY(abbe_pinhole_sky_make(scene, &scene->local->environment->map, CUBE, &w->sky, error));
  ABBE_TRY(abbe_pinhole_samples_colours(scene, &w->colour, error));
  ABBE_TRY(abbe_image_textures_make(scene->gpu, textures, 2, error));
  return abbe_image_programs_make(variant, scene->gpu, programs, 4, error);
}

static void free_own(abbe_method *m) {
  abbe_wand2003 *w = (abbe_wand2003 *)m;
  GLuint textures[] = {m->picture, w->depth};
  abbe_gpu_drop_textures(m->scene->gpu, sizeof textures / sizeof *textures, textures);
  abbe_pinhole_samples_free(m->scene->gpu, &w->samples);
  abbe_pinhole_sky_free(m->scene->gpu, &w->sky);
  free(w->colour);
}

static void use(abbe_wand2003 *w, GLuint program) {
  const abbe_gl *gl = w->base.scene->gpu->gl;
  const double *eye = w->base.scene->local->camera.eye;
  gl->UseProgram(program);
  abbe_gpu_scene_set(w->base.scene, program);
  abbe_image_view_set_clip(w->base.scene, program, "view_projection", &w->view);
  abbe_image_view_set_view(w->base.scene, program, "eye_view", &w->view.view);
  gl->Uniform3f(gl->GetUniformLocation(program, "eye"), (float)eye[0], (float)eye[1],
                (float)eye[2]);
  gl->Uniform2f(gl->GetUniformLocation(program, "samples"), (float)w->base.scene->plan->desc.width,
                (float)w->base.scene->plan->desc.height);
  abbe_pinhole_samples_bind(w->base.scene, &w->samples, program);
  abbe_pinhole_sky_set(w->base.scene, &w->sky, ABBE_PINHOLE_SKY_UNIT, program);
}

static void draw_receivers(abbe_wand2003 *w, GLuint program) {
  const abbe_plan *plan = w->base.scene->plan;
  int layer = 0;
  for (size_t i = 0; i < plan->receiver_count; i++) {
    abbe_image_view_set_surface(w->base.scene, program, i, &layer);
    abbe_gpu_meshes_draw(w->base.scene, plan->receiver_object[i]);
  }
}

static void draw_mirrors(abbe_wand2003 *w) {
  const abbe_gl *gl = w->base.scene->gpu->gl;
  const abbe_plan *plan = w->base.scene->plan;
  use(w, w->mirrors);
  for (size_t i = 0; i < plan->refractor_count; i++) {
    const double *c = w->colour[i];
    gl->Uniform3f(gl->GetUniformLocation(w->mirrors, "mirror_colour"), (float)c[0], (float)c[1],
                  (float)c[2]);
    abbe_gpu_meshes_draw(w->base.scene, plan->refractor_object[i]);
  }
}

/* Over what is drawn, where it is seen. */
static abbe_result add_pinholes(abbe_wand2003 *w, abbe_error *error) {
  abbe_gpu *gpu = w->base.scene->gpu;
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

static abbe_result run(abbe_method *m, bool lit, abbe_error *error) {
  abbe_wand2003 *w = (abbe_wand2003 *)m;
  (void)lit;
  static const int flat = -1;
  static const GLfloat nothing[4] = {0, 0, 0, 0}, far_away = 1;
  const abbe_gl *gl = w->base.scene->gpu->gl;
  const abbe_render_desc *d = &w->base.scene->plan->desc;
  abbe_gpu_start_lap(w->base.scene->gpu);
  ABBE_TRY(abbe_gpu_set_target(w->base.scene->gpu, &w->base.picture, &flat, 1, w->depth, d->width,
                               d->height, error));
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  gl->ClearBufferfv(GL_DEPTH, 0, &far_away);
  gl->Disable(GL_DEPTH_TEST);
  use(w, w->surroundings);
  abbe_gpu_draw_screen(w->base.scene->gpu);
  gl->Enable(GL_DEPTH_TEST);
  use(w, w->receivers);
  draw_receivers(w, w->receivers);
  abbe_gpu_book_lap(w->base.scene->gpu, ABBE_PASS_EYE_RECEIVERS);
  draw_mirrors(w);
  abbe_gpu_book_lap(w->base.scene->gpu, ABBE_PASS_EYE_REFRACTION);
  abbe_result result = add_pinholes(w, error);
  abbe_gpu_book_lap(w->base.scene->gpu, ABBE_PASS_PINHOLES);
  gl->Disable(GL_DEPTH_TEST);
  return result;
}

const abbe_method_kind abbe_wand2003_kind = {
    sizeof(abbe_wand2003), make, free_own, run, NULL, NULL};
