/* Caustics mapping [ShahKonttinenPattanaik2007]: receivers' places from the light, places and
 * normals of refractors and mirrors at the grid's resolution, a vertex for each of its pixels,
 * which is brought to a receiver by a few lookups and splatted, and a lookup of the map by
 * projection. Two interfaces by the distance between front and back along the view, one, or one
 * reflection. Places, shadow and map are those of one frustum, or of the six faces of a cube around
 * a point or spot light, which then sees its objects through one view or six.
 *
 * As printed: from 1 m on, flux (N . L) / V with V the pixels that an occlusion query counts,
 * exp(-K d) by the distance between front and back, an index each for red, green and blue. Where
 * the paper is silent: red, green and blue are 650, 550 and 450 nm; a splat's standard deviation is
 * half the distance of undisturbed vertices, and it ends at three; the light of an object that
 * fills a sixteenth of the view is white; totally reflected light starts no splat; ambient
 * brightness is 0.1; the camera's rays are the thesis's.
 *
 * In units (shah2007-cie) the same passes, grid and splats have the default profile's wavelengths,
 * indices, attenuation and XYZ weights, Fresnel's law, and the flux of a pixel's solid angle, which
 * counts projection once and needs no count of pixels; what a receiver hides from the light starts
 * no vertex, and estimators start from what the light sees behind the ray's origin. */
#include "gl/methods/shah2007/shah2007.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double white_share = 1.0 / 16;
/* Share of the Gaussian's integral within three standard deviations. */
static const double held = 0.98889100346175773;
static const double least_size = 3, most_size = 255; /* texels; drivers draw no larger points */
static const double tau = 6.283185307179586;

static bool is_printed(const abbe_gpu_scene *scene) {
  return abbe_method_of(scene->plan->desc.profile)->printed;
}

static bool around(const abbe_shah2007 *s) {
  return s->base.light.faces > 1;
}

static double splat_size(double apart) {
  return fmin(fmax(3.0 * apart, least_size), most_size);
}

static double window_side(const abbe_image_view *view) {
  return view->view.window[1] - view->view.window[0];
}

/* The distance of undisturbed vertices on the map, texels. */
static double vertices_apart(const abbe_shah2007 *s) {
  const abbe_render_desc *d = &s->base.scene->plan->desc;
  return (double)d->map_size / (double)d->photons * window_side(&s->base.light.object_face[0]) /
         window_side(&s->base.light.face[0]);
}

/* What a splat's peak is of a vertex of unit light. */
static double vertex_strength(const abbe_shah2007 *s) {
  const abbe_render_desc *d = &s->base.scene->plan->desc;
  const double apart = vertices_apart(s), sigma = splat_size(apart) / 6;
  const double texel = 1 / (tau * sigma * sigma * held);
  if (!is_printed(s->base.scene)) return texel * apart * apart;
  const double texels = (double)d->map_size * (double)d->map_size;
  return texel * white_share * texels / fmax((double)s->base.photon_count, 1);
}

static abbe_result make_programs(abbe_shah2007 *s, const abbe_shader_variant *variant,
                                 abbe_error *error) {
  const abbe_render_desc *d = &s->base.scene->plan->desc;
  float(*shares)[3] = NULL;
  char more[640], search[800];
  const char *cube = around(s) ? "#define PLACES_CUBE\n" : "";
  abbe_image_tables_define(d, more, sizeof more);
  snprintf(search, sizeof search,
           "%s#define ESTIMATOR %d\n#define ITERATIONS %zu\n#define OBJECT_FACES %zu\n%s%s", more,
           (int)d->estimator, d->iterations, s->base.light.object_faces, cube,
           is_printed(s->base.scene) ? "#define SEARCH_AS_PRINTED\n" : "");
  const abbe_image_program all[] = {{&s->splat, "shah_splat.vert",
                                     around(s) ? "shah_faces.geom" : NULL, "shah_splat.frag",
                                     search, false},
                                    {d->low_pass > 0 ? &s->low_pass : NULL, "screen.vert", NULL,
                                     "shah_low_pass.frag", cube, true}};
  ABBE_TRY(abbe_image_programs_make(variant, s->base.scene->gpu, all, 2, error));
  ABBE_TRY(abbe_image_tables_colours(s->base.scene, true, &shares, error));
  return abbe_image_eye_make(s->base.scene, &s->base.light, variant, more, shares, &s->base.eye,
                             error);
}

/* Texels that a face shares with its neighbours at each edge: what splats and the low pass lay
 * over it comes from there. */
static abbe_result look_around(const abbe_gpu_scene *scene, abbe_image_cube *out,
                               abbe_error *error) {
  const abbe_render_desc *d = &scene->plan->desc;
  const double apart = (double)d->map_size / (double)d->photons;
  const size_t border = (size_t)ceil(0.5 * splat_size(apart)) + 2 + 3 * d->low_pass;
  if (4 * border > d->map_size)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "faces of %zu texels a side would share more than half of them with "
                          "their neighbours, %zu at each edge, by splats of %.0f texels%s; ask for "
                          "a larger map or for more photons",
                          d->map_size, border, splat_size(apart),
                          d->low_pass > 0 ? " and the low pass" : "");
  abbe_image_cube_make(scene, d->map_size, border, false, out);
  return ABBE_OK;
}

static abbe_result look_from_light(const abbe_gpu_scene *scene, abbe_image_cube *out,
                                   abbe_error *error) {
  abbe_view view;
  if (scene->plan->desc.faces > 1) return look_around(scene, out, error);
  abbe_image_view_fit_light(scene, &view);
  abbe_image_cube_one(&view, out);
  return ABBE_OK;
}

static abbe_result make(abbe_method *m, const abbe_shader_variant *variant, abbe_error *error) {
  abbe_shah2007 *s = (abbe_shah2007 *)m;
  const abbe_gpu_scene *scene = m->scene;
  const abbe_render_desc *d = &scene->plan->desc;
  const size_t map[2] = {d->map_size, d->map_size}, grid[2] = {d->photons, d->photons};
  abbe_image_cube sight;
  ABBE_TRY(look_from_light(scene, &sight, error));
  const size_t layers = sight.faces > 1 ? sight.faces : 0;
  const abbe_image_texture all[] = {
      {&s->map, GL_RGBA32F, map[0], map[1], layers, true},
      {d->low_pass > 0 ? &s->smoothed : NULL, GL_RGBA32F, map[0], map[1], layers, true}};
  abbe_map_layout_make(&sight.face[0], &m->layout);
  ABBE_TRY(abbe_image_places_make(scene, &sight, map, grid, true, &m->light, error));
  ABBE_TRY(abbe_image_textures_make(scene->gpu, all, 2, error));
  ABBE_TRY(abbe_image_tables_colours(scene, false, &m->colour, error));
  return make_programs(s, variant, error);
}

static void free_own(abbe_method *m) {
  abbe_shah2007 *s = (abbe_shah2007 *)m;
  abbe_gpu_drop_textures(m->scene->gpu, 1, &s->map);
  abbe_gpu_drop_textures(m->scene->gpu, 1, &s->smoothed);
}

static void set_splats(abbe_shah2007 *s) {
  const abbe_gpu_scene *scene = s->base.scene;
  const abbe_gl *gl = scene->gpu->gl;
  const abbe_render_desc *d = &scene->plan->desc;
  const abbe_light *light = &scene->local->light[0];
  GLuint p = s->splat;
  abbe_gpu_scene_set(scene, p);
  abbe_image_places_set(&s->base.light, p);
  abbe_image_view_set_lamp(scene, p, light->direction);
  abbe_gpu_set_int(scene->gpu, p, "grid", (int)d->photons);
  abbe_gpu_set_float(scene->gpu, p, "map_side", (double)d->map_size);
  abbe_gpu_set_float(scene->gpu, p, "splat_size", splat_size(vertices_apart(s)));
  abbe_gpu_set_float(scene->gpu, p, "strength", vertex_strength(s));
  abbe_gpu_set_float(scene->gpu, p, "object_bias", 1e-3 * scene->refractor_radius);
  gl->Uniform3fv(gl->GetUniformLocation(p, "colour"), (GLsizei)d->wavelengths,
                 &s->base.colour[0][0]);
}

static abbe_result splat_vertices(abbe_shah2007 *s, abbe_error *error) {
  static const int flat = -1;
  static const GLfloat nothing[4] = {0, 0, 0, 0};
  const abbe_gpu_scene *scene = s->base.scene;
  const abbe_gl *gl = scene->gpu->gl;
  const abbe_render_desc *d = &scene->plan->desc;
  abbe_gpu_start_lap(scene->gpu);
  ABBE_TRY(abbe_gpu_set_target(scene->gpu, &s->map, &flat, 1, 0, d->map_size, d->map_size, error));
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  gl->Disable(GL_DEPTH_TEST);
  gl->Enable(GL_BLEND);
  gl->Enable(GL_PROGRAM_POINT_SIZE);
  gl->BlendFunc(GL_ONE, GL_ONE);
  gl->UseProgram(s->splat);
  set_splats(s);
  for (size_t i = 0; i < d->wavelengths * s->base.light.object_faces; i++) {
    abbe_gpu_set_int(scene->gpu, s->splat, "wavelength", (int)(i % d->wavelengths));
    abbe_gpu_set_int(scene->gpu, s->splat, "object_face", (int)(i / d->wavelengths));
    abbe_gpu_draw_things(scene->gpu, GL_POINTS, d->photons * d->photons, 1);
  }
  gl->Disable(GL_BLEND);
  abbe_gpu_book_lap(scene->gpu, ABBE_PASS_PHOTONS);
  return ABBE_OK;
}

/* Along one axis and then along the other, back into the map; face -1: its only one. */
static abbe_result smooth_face(abbe_shah2007 *s, int face, abbe_error *error) {
  abbe_gpu *gpu = s->base.scene->gpu;
  const abbe_render_desc *d = &s->base.scene->plan->desc;
  for (int axis = 0; axis < 2; axis++) {
    const GLuint from = axis == 0 ? s->map : s->smoothed, to = axis == 0 ? s->smoothed : s->map;
    gpu->gl->UseProgram(s->low_pass);
    abbe_gpu_set_int(gpu, s->low_pass, "face", face);
    if (face < 0)
      abbe_gpu_bind_texture(gpu, s->low_pass, "map", 0, from);
    else
      abbe_gpu_bind_array(gpu, s->low_pass, "map", 0, from);
    gpu->gl->Uniform2i(gpu->gl->GetUniformLocation(s->low_pass, "along"), axis == 0, axis == 1);
    abbe_gpu_set_float(gpu, s->low_pass, "sigma", (double)d->low_pass);
    ABBE_TRY(abbe_image_view_draw_screen(s->base.scene, to, face, d->map_size, d->map_size, error));
  }
  return ABBE_OK;
}

static abbe_result smooth_map(abbe_shah2007 *s, abbe_error *error) {
  for (size_t f = 0; f < s->base.light.faces && s->low_pass != 0; f++)
    ABBE_TRY(smooth_face(s, around(s) ? (int)f : -1, error));
  return ABBE_OK;
}

static abbe_result draw_map(abbe_shah2007 *s, abbe_error *error) {
  ABBE_TRY(abbe_method_see_from_light(&s->base, error));
  ABBE_TRY(splat_vertices(s, error));
  return smooth_map(s, error);
}

static abbe_result run(abbe_method *m, bool lit, abbe_error *error) {
  abbe_shah2007 *s = (abbe_shah2007 *)m;
  ABBE_TRY(lit ? ABBE_OK : draw_map(s, error));
  return abbe_image_eye_run(&m->eye, s->map, error);
}

static bool keeps_light(const abbe_render_desc *desc) {
  (void)desc;
  return true;
}

static abbe_result map(abbe_method *m, bool filled, GLuint *texture, abbe_error *error) {
  (void)filled;
  (void)error;
  *texture = ((abbe_shah2007 *)m)->map;
  return ABBE_OK;
}

const abbe_method_kind abbe_shah2007_kind = {sizeof(abbe_shah2007), make, free_own, run,
                                             keeps_light,           map};
