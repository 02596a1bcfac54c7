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

#include "gl/methods/image_space/image_view.h"

#include <stdio.h>
#include <stdlib.h>

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
  const abbe_fill fill = w->scene->plan->desc.fill;
  const abbe_direction direction = w->scene->plan->desc.direction;
  const bool whole =
      in_camera(w->scene) && (fill == ABBE_FILL_QUADS || fill == ABBE_FILL_TRIANGLES);
  float(*shares)[3] = NULL;
  char more[960];
  const int length = snprintf(more, sizeof more, "%s#define CAUSTIC_RATIOS\n%s%s%s%s", definitions,
                              in_camera(w->scene) ? "#define CAUSTICS_SEEN\n" : "",
                              whole ? "#define CAUSTICS_WHOLE\n" : "",
                              direction != ABBE_DIRECTION_DIRECT ? "#define DIRECTIONS\n" : "",
                              direction == ABBE_DIRECTION_MEAN && fill == ABBE_FILL_POINTS
                                  ? "#define NORMALISED_DIRECTIONS\n"
                                  : "");
  if (length < 0 || (size_t)length >= sizeof more)
    return abbe_error_set(error, ABBE_GL, "a shader's definitions are too long");
  abbe_result result = abbe_image_tables_colours(w->scene, true, &shares, error);
  if (result == ABBE_OK)
    result = abbe_image_eye_make(w->scene, &w->light, variant, more, shares, &w->eye, error);
  return result;
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

abbe_result abbe_wyman2006_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                                abbe_wyman2006 *out, abbe_error *error) {
  const abbe_render_desc *d = &scene->plan->desc;
  const size_t map[2] = {d->map_size, d->map_size}, grid[2] = {d->photons, d->photons};
  char definitions[768];
  abbe_image_cube sight;
  out->scene = scene;
  abbe_image_tables_define(d, definitions, sizeof definitions);
  look_from_light(scene, &sight);
  abbe_map_layout_make(&sight.face[0], &out->layout);
  abbe_result result = abbe_image_places_make(scene, &sight, map, grid, true, &out->light, error);
  if (result == ABBE_OK) interpolate_receivers(&out->light);
  if (result == ABBE_OK)
    result =
        abbe_wyman_photons_make(scene, &out->light, variant, definitions, &out->photons, error);
  if (result == ABBE_OK) result = abbe_image_tables_colours(scene, false, &out->colour, error);
  if (result == ABBE_OK) result = make_eye(out, variant, definitions, error);
  if (result == ABBE_OK && sight.faces == 1)
    result = abbe_wyman_target_make(&out->photons, &out->light, false, variant, &out->map, error);
  if (result == ABBE_OK && in_camera(scene))
    result = abbe_wyman_target_make(&out->photons, &out->eye.places, true, variant, &out->picture,
                                    error);
  return result;
}

void abbe_wyman2006_free(abbe_wyman2006 *w) {
  if (w->scene == NULL) return;
  abbe_wyman_target_free(&w->picture);
  abbe_wyman_target_free(&w->map);
  abbe_wyman_photons_free(&w->photons);
  abbe_image_eye_free(&w->eye);
  abbe_image_places_free(&w->light);
  free(w->colour);
  *w = (abbe_wyman2006){0};
}

static abbe_wyman_target *own_target(abbe_wyman2006 *w) {
  return in_camera(w->scene) ? &w->picture : &w->map;
}

void abbe_wyman2006_leave(abbe_wyman2006 *w, abbe_wyman_history *out) {
  abbe_wyman_history *own = &own_target(w)->history;
  *out = *own;
  *own = (abbe_wyman_history){0};
}

void abbe_wyman2006_follow(abbe_wyman2006 *w, abbe_wyman_history *before) {
  abbe_wyman_history *own = &own_target(w)->history, made = *own;
  for (int k = 0; k < 2; k++)
    if (before->size[k] != own->size[k]) return;
  for (size_t i = 0; i < ABBE_WYMAN_KEPT; i++)
    if ((before->sums[i] == 0) != (own->sums[i] == 0)) return;
  if (before->printed != own->printed) return;
  *own = *before;
  *before = made;
}

static void shift_grid(abbe_wyman2006 *w) {
  const abbe_render_desc *d = &w->scene->plan->desc;
  const double *by = jitter[own_target(w)->history.frame % 4];
  const bool moves = d->history > 1 && !is_printed(w->scene);
  for (int k = 0; k < 2; k++) w->light.shift[k] = d->photon_shift[k] + (moves ? by[k] : 0);
}

static abbe_result see_from_light(abbe_wyman2006 *w, abbe_error *error) {
  abbe_gpu *gpu = w->scene->gpu;
  abbe_gpu_start_lap(gpu);
  shift_grid(w);
  abbe_result result = abbe_image_places_receivers(&w->light, error);
  if (result == ABBE_OK) result = abbe_image_places_shadow(&w->light, error);
  abbe_gpu_book_lap(gpu, ABBE_PASS_RECEIVER_DEPTH);
  if (result == ABBE_OK) result = abbe_image_places_objects(&w->light, error);
  w->photon_count = abbe_image_places_count(&w->light);
  abbe_gpu_book_lap(gpu, ABBE_PASS_LIGHT_FRONT_AND_BACK);
  return result;
}

/* kept: their buffer is there. */
static abbe_result draw_photons(abbe_wyman2006 *w, abbe_wyman_target *target, bool kept,
                                abbe_error *error) {
  abbe_result result = kept ? ABBE_OK : see_from_light(w, error);
  abbe_gpu_start_lap(w->scene->gpu);
  if (result == ABBE_OK && in_camera(w->scene))
    result = abbe_image_places_receivers(&w->eye.places, error);
  if (result == ABBE_OK) result = abbe_wyman_target_run(target, w->colour, true, kept, error);
  abbe_gpu_book_lap(w->scene->gpu, ABBE_PASS_PHOTONS);
  if (result == ABBE_OK) target->history.frame++;
  return result;
}

bool abbe_wyman2006_keeps_light(const abbe_render_desc *desc) {
  return desc->history <= 1 &&
         (abbe_render_desc_in_light(desc) || (desc->wavelengths == 1 && desc->faces <= 1));
}

abbe_result abbe_wyman2006_run(abbe_wyman2006 *w, bool lit, abbe_error *error) {
  abbe_gpu *gpu = w->scene->gpu;
  abbe_wyman_target *target = own_target(w);
  const bool kept = lit && abbe_wyman2006_keeps_light(&w->scene->plan->desc);
  const bool map = kept && !in_camera(w->scene);
  abbe_gpu_scene_bind(w->scene);
  abbe_result result = map ? ABBE_OK : draw_photons(w, target, kept, error);
  if (result != ABBE_OK) return result;
  gpu->gl->UseProgram(w->eye.receivers);
  abbe_image_view_set_view(w->scene, w->eye.receivers, "camera_view", &w->eye.places.view.view);
  abbe_gpu_bind_texture(gpu, w->eye.receivers, "caustic_directions", 3, target->light_directions);
  result = abbe_image_eye_run(&w->eye, target->light, error);
  return result == ABBE_OK ? abbe_gl_check(gpu->gl, "the wyman2006 profile", error) : result;
}

abbe_result abbe_wyman2006_read(const abbe_wyman2006 *w, abbe_image *out, abbe_error *error) {
  return abbe_image_view_read(w->scene, w->eye.picture, out, error);
}

abbe_result abbe_wyman2006_read_map(abbe_wyman2006 *w, abbe_image *out, abbe_error *error) {
  abbe_result result = ABBE_OK;
  if (in_camera(w->scene)) {
    abbe_gpu_scene_bind(w->scene);
    result = abbe_wyman_target_run(&w->map, w->colour, false, false, error);
  }
  if (result != ABBE_OK) return result;
  return abbe_image_view_read_map(w->scene, w->map.light, &w->layout, out, error);
}
