/* Photons in image space [WymanDavis2006]: a regular grid of pixels is seen from the light, each
 * brought to its first diffuse surface through two interfaces or off a mirror, and drawn into the
 * camera's image as a point or as polygons of neighbours, or gathered there or in the light's.
 *
 * As printed: a field of 90 degrees, 16-bit buffers, light as a ratio to the direct light's, by the
 * mean direction of photons in a pixel, neighbourhoods of fewer than three photons dropped, what
 * mirrors reflect laid on one plane. Where the paper is silent: the field looks along the spot's
 * axis or towards the objects; light-space images have 512 x 512 texels; the Gaussian's standard
 * deviation is 1.5 pixels; the index is that of 550 nm; receivers are looked up once behind the
 * ray; the frames of the filter weigh alike; the plane is that of the largest face of a receiver;
 * what is more than a hundredth of the distance before or behind the camera's surface is not drawn.
 *
 * Variants of polygons (abbe_render_desc.polygons) are those that the paper names beside its own.
 *
 * Six views, each of 90 degrees, see what is all around the light; photons then go to the camera's
 * image alone.
 *
 * In units (wyman2006-cie) the field is fitted, photons carry XYZ flux by wavelength with Fresnel's
 * law, and light is what they bring to an area, whatever their direction; sparse neighbourhoods
 * stay, and where frames are filtered their grids are shifted. */
#include "gl/methods/wyman2006/wyman2006.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct abbe_wyman2006 {
  abbe_method base;
  abbe_wyman_photons photons;
  abbe_wyman_target map, picture; /* the light's image; the camera's, where photons go there */
} abbe_wyman2006;

/* Four grids that fall into each other's gaps, in cells. */
static const double jitter[4][2] = {
    {-0.375, -0.125}, {0.125, -0.375}, {0.375, 0.125}, {-0.125, 0.375}};

/* Texels beyond a face's edge: places are interpolated there. */
enum { shared_border = 2 };

static bool is_printed(const abbe_gpu_scene *scene) {
  return abbe_method_of(scene->plan->desc.profile)->printed;
}

static bool draws_polygons(const abbe_render_desc *d) {
  return (d->fill == ABBE_FILL_QUADS || d->fill == ABBE_FILL_TRIANGLES) && d->photons > 1;
}

static bool in_camera(const abbe_gpu_scene *scene) {
  return !abbe_render_desc_in_light(&scene->plan->desc);
}

/* As printed through 90 degrees, be it one view or six. */
static void look_from_light(const abbe_gpu_scene *scene, abbe_image_cube *out) {
  const abbe_render_desc *d = &scene->plan->desc;
  if (d->faces > 1) {
    abbe_image_cube_make(scene, d->map_size, shared_border, is_printed(scene), out);
    /* polygons of one view and of the next meet where the outermost photons do, on the seam */
    const double apart = (double)d->photons / (double)(d->photons - 1);
    for (size_t f = 0; f < out->object_faces && out->object_faces > 1 && draws_polygons(d); f++)
      for (int k = 0; k < 4; k++) out->object_face[f].window[k] *= apart;
    return;
  }
  abbe_view view;
  abbe_image_view_fit_light(scene, &view);
  for (int k = 0; is_printed(scene) && k < 4; k++) view.window[k] = k % 2 == 0 ? -1 : 1;
  abbe_image_cube_one(&view, out);
}

static abbe_result make_eye(abbe_wyman2006 *w, const abbe_shader_variant *variant,
                            const char *definitions, abbe_error *error) {
  const abbe_fill fill = w->base.scene->plan->desc.fill;
  const abbe_direction direction = w->base.scene->plan->desc.direction;
  const bool whole =
      in_camera(w->base.scene) && (fill == ABBE_FILL_QUADS || fill == ABBE_FILL_TRIANGLES);
  float(*shares)[3] = NULL;
  char more[960];
  const int length = snprintf(more, sizeof more, "%s#define CAUSTIC_RATIOS\n%s%s%s%s", definitions,
                              in_camera(w->base.scene) ? "#define CAUSTICS_SEEN\n" : "",
                              whole ? "#define CAUSTICS_WHOLE\n" : "",
                              direction != ABBE_DIRECTION_DIRECT ? "#define DIRECTIONS\n" : "",
                              direction == ABBE_DIRECTION_MEAN && fill == ABBE_FILL_POINTS
                                  ? "#define NORMALISED_DIRECTIONS\n"
                                  : "");
  if (length < 0 || (size_t)length >= sizeof more)
    return abbe_error_set(error, ABBE_GL, "a shader's definitions are too long");
  ABBE_TRY(abbe_image_tables_colours(w->base.scene, true, &shares, error));
  return abbe_image_eye_make(w->base.scene, &w->base.light, variant, more, shares, &w->base.eye,
                             error);
}

/* Places between those that are seen: else photons of a texel land on a shell around the light, and
 * polygons bunch at the texels' middles. */
static void interpolate_receivers(const abbe_image_places *light) {
  const abbe_gl *gl = light->scene->gpu->gl;
  const GLenum kind = light->faces > 1 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
  gl->BindTexture(kind, light->receivers);
  gl->TexParameteri(kind, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl->TexParameteri(kind, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

static abbe_wyman_target *own_target(abbe_wyman2006 *w) {
  return in_camera(w->base.scene) ? &w->picture : &w->map;
}

static abbe_result make(abbe_method *m, const abbe_shader_variant *variant, abbe_error *error) {
  abbe_wyman2006 *w = (abbe_wyman2006 *)m;
  const abbe_gpu_scene *scene = m->scene;
  const abbe_render_desc *d = &scene->plan->desc;
  const size_t map[2] = {d->map_size, d->map_size}, grid[2] = {d->photons, d->photons};
  char definitions[768];
  abbe_image_cube sight;
  abbe_image_tables_define(d, definitions, sizeof definitions);
  look_from_light(scene, &sight);
  abbe_map_layout_make(&sight.face[0], &m->layout);
  ABBE_TRY(abbe_image_places_make(scene, &sight, map, grid, true, &m->light, error));
  interpolate_receivers(&m->light);
  ABBE_TRY(abbe_wyman_photons_make(scene, &m->light, variant, definitions, &w->photons, error));
  ABBE_TRY(abbe_image_tables_colours(scene, false, &m->colour, error));
  ABBE_TRY(make_eye(w, variant, definitions, error));
  if (sight.faces == 1)
    ABBE_TRY(abbe_wyman_target_make(&w->photons, &m->light, false, variant, &w->map, error));
  if (in_camera(scene))
    ABBE_TRY(
        abbe_wyman_target_make(&w->photons, &m->eye.places, true, variant, &w->picture, error));
  m->history = &own_target(w)->history;
  return ABBE_OK;
}

static void free_own(abbe_method *m) {
  abbe_wyman2006 *w = (abbe_wyman2006 *)m;
  abbe_wyman_target_free(&w->picture);
  abbe_wyman_target_free(&w->map);
  abbe_wyman_photons_free(&w->photons);
}

static void shift_grid(abbe_wyman2006 *w) {
  const abbe_render_desc *d = &w->base.scene->plan->desc;
  const double *by = jitter[own_target(w)->history.frame % 4];
  const bool moves = d->history > 1 && !is_printed(w->base.scene);
  for (int k = 0; k < 2; k++) w->base.light.shift[k] = d->photon_shift[k] + (moves ? by[k] : 0);
}

/* kept: their buffer is there. */
static abbe_result draw_photons(abbe_wyman2006 *w, abbe_wyman_target *target, bool kept,
                                abbe_error *error) {
  if (!kept) shift_grid(w);
  abbe_result result = kept ? ABBE_OK : abbe_method_see_from_light(&w->base, error);
  abbe_gpu_start_lap(w->base.scene->gpu);
  if (result == ABBE_OK && in_camera(w->base.scene))
    result = abbe_image_places_receivers(&w->base.eye.places, error);
  if (result == ABBE_OK) result = abbe_wyman_target_run(target, w->base.colour, true, kept, error);
  abbe_gpu_book_lap(w->base.scene->gpu, ABBE_PASS_PHOTONS);
  if (result == ABBE_OK) target->history.frame++;
  return result;
}

/* The light's image, or with one wavelength and view the buffer of photons that go to the camera's;
 * where it holds no frames before. */
static bool keeps_light(const abbe_render_desc *desc) {
  return desc->history <= 1 &&
         (abbe_render_desc_in_light(desc) || (desc->wavelengths == 1 && desc->faces <= 1));
}

static abbe_result run(abbe_method *m, bool lit, abbe_error *error) {
  abbe_wyman2006 *w = (abbe_wyman2006 *)m;
  abbe_wyman_target *target = own_target(w);
  const bool kept = lit && keeps_light(&m->scene->plan->desc);
  const bool map = kept && !in_camera(m->scene);
  abbe_result result = map ? ABBE_OK : draw_photons(w, target, kept, error);
  m->polygon_layers = target->layers;
  if (result != ABBE_OK) return result;
  m->scene->gpu->gl->UseProgram(m->eye.receivers);
  abbe_image_view_set_view(m->scene, m->eye.receivers, "camera_view", &m->eye.places.view.view);
  abbe_gpu_bind_texture(m->scene->gpu, m->eye.receivers, "caustic_directions", 3,
                        target->light_directions);
  return abbe_image_eye_run(&m->eye, target->light, error);
}

/* Drawn for it where photons go to the camera. */
static abbe_result map(abbe_method *m, bool filled, GLuint *texture, abbe_error *error) {
  abbe_wyman2006 *w = (abbe_wyman2006 *)m;
  abbe_result result = ABBE_OK;
  (void)filled;
  if (in_camera(m->scene)) {
    abbe_gpu_scene_bind(m->scene);
    result = abbe_wyman_target_run(&w->map, m->colour, false, false, error);
  }
  *texture = w->map.light;
  return result;
}

const abbe_method_kind abbe_wyman2006_kind = {
    sizeof(abbe_wyman2006), make, free_own, run, keeps_light, map};
