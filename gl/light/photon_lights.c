#include "gl/light/photon_lights.h"

#include "base/maths.h"
#include "colorimetry/weights.h"
#include "gl/device/bindings.h"
#include "gl/device/float4.h"
#include "gl/plan/examine/examine.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Up to so many photons (cells times wavelengths) 32-bit sums round to well below 1e-4 of the light
 * without ever overflowing. */
enum { MAX_NARROW_PHOTONS = 1 << 20, MAX_MAP_LEVELS = 6 };

/* Float copy of the shaders' struct (common.glsl). */
typedef struct gpu_light {
  float near_view[24], map_view[24], position[4], direction[4], white[4], misc[4], cube[4];
} gpu_light;

bool abbe_photon_lights_is_face(const abbe_photon_lights *views, size_t light) {
  return views->scene->plan->light_view[light].face >= 0;
}

void abbe_photon_light_look(const abbe_gpu_scene *scene, size_t index, abbe_view *view) {
  static const double up[3] = {0, 1, 0};
  const abbe_light *light = &scene->local->light[index];
  if (scene->plan->light_view[index].face >= 0) {
    abbe_light_cube_look(light->position, scene->plan->light_view[index].face, view);
    return;
  }
  double origin[3], forward[3], back = scene->size;
  /* From farther off, floats would round places across a parallel view to its size. */
  if (scene->plan->refractor_count > 0 && !abbe_method_of(scene->plan->desc.profile)->own_passes)
    back = fmin(back, 64 * scene->refractor_radius);
  for (int k = 0; k < 3; k++) {
    double centre = scene->plan->refractor_count > 0 ? scene->refractor_centre[k]
                                                     : 0.5 * (scene->min[k] + scene->max[k]);
    bool directional = light->kind == ABBE_LIGHT_DIRECTIONAL;
    origin[k] = directional ? centre - light->direction[k] * back : light->position[k];
    forward[k] = directional ? light->direction[k] : centre - light->position[k];
  }
  double length2 = 0;
  for (int k = 0; k < 3; k++) length2 += forward[k] * forward[k];
  if (length2 == 0) forward[2] = -1; /* the light stands in the middle of it all */
  abbe_view_look(origin, forward, up, light->kind == ABBE_LIGHT_DIRECTIONAL, view);
}

static void fit_objects(const abbe_photon_lights *views, const size_t *object, size_t count,
                        abbe_view *view) {
  for (size_t i = 0; i < count; i++) {
    const abbe_mesh *mesh = &views->scene->local->object[object[i]].mesh;
    abbe_view_fit(view, (const double(*)[3])mesh->position, mesh->vertex_count);
  }
}

bool abbe_photon_lights_map_is_given(const abbe_photon_lights *views, size_t light) {
  return views->scene->map_layout != NULL &&
         views->scene->plan->desc.map_layout_light == views->scene->plan->light_view[light].light;
}

/* All of it but the range, which must hold this scene's receivers. */
void abbe_photon_lights_take_layout(const abbe_photon_lights *views, const abbe_map_layout *given,
                                    abbe_map_layout *out) {
  *out = *given;
  out->view.near = INFINITY;
  out->view.far = -INFINITY;
  fit_objects(views, views->scene->plan->receiver_object, views->scene->plan->receiver_count,
              &out->view);
  abbe_view_pad(&out->view, 0.01);
  memcpy(out->view.window, given->view.window, sizeof out->view.window);
}

void abbe_photon_lights_whole_map(const abbe_photon_lights *views, size_t light,
                                  abbe_map_layout *out) {
  abbe_view view;
  abbe_photon_light_look(views->scene, light, &view);
  fit_objects(views, views->scene->plan->receiver_object, views->scene->plan->receiver_count,
              &view);
  if (abbe_photon_lights_is_face(views,
                                 light)) /* receivers lie all around it, as the refractors do */
    for (int k = 0; k < 4; k++)
      view.window[k] = k % 2 != 0 ? ABBE_VIEW_MAX_TANGENT : -ABBE_VIEW_MAX_TANGENT;
  abbe_view_pad(&view, 0.01);
  abbe_map_layout_make(&view, out);
}

/* Around what the face shows of the refractors. The shaders' profile of the light keeps photons in
 * the face; the window ends there too, unless layers are read beyond it. */
static void fit_face(const abbe_photon_lights *views, size_t light, abbe_view *view) {
  const abbe_plan *plan = views->scene->plan;
  const abbe_light *from = &views->scene->local->light[light];
  double near = INFINITY, far = 0;
  for (size_t i = 0; i < plan->refractor_count; i++) {
    const abbe_object *object = &views->scene->local->object[plan->refractor_object[i]];
    const abbe_mesh *mesh = &object->mesh;
    if ((abbe_light_cube_reached(from, object) >> plan->light_view[light].face & 1) == 0) continue;
    abbe_light_cube_fit(view, object);
    if (plan->model[i] == ABBE_REFRACTOR_LAYERS)
      abbe_view_fit(view, (const double(*)[3])mesh->position, mesh->vertex_count);
    near = fmin(near, 0.5 * abbe_object_distance(object, from->position));
    for (size_t k = 0; k < mesh->vertex_count; k++) {
      double to[3];
      abbe_vector_subtract(mesh->position[k], from->position, to);
      far = fmax(far, 1.01 * abbe_vector_length(to));
    }
  }
  for (int k = 0; k < 4; k++) /* a seam's rounding may leave it empty */
    if (!isfinite(view->window[k])) view->window[k] = 0;
  abbe_view_pad(view, 0.01);
  for (int k = 0; k < 4 && !plan->layers && !plan->bvh; k++)
    view->window[k] = fmin(fmax(view->window[k], -1), 1);
  view->far = far > 0 ? far : 1;
  view->near = fmax(fmin(near, 0.5 * view->far), 1e-4 * view->far);
}

size_t abbe_photon_lights_photons(const abbe_gpu_scene *scene, size_t light) {
  const size_t all = scene->plan->desc.photons, points = scene->local->light[light].points;
  const size_t side = (size_t)ceil((double)all / sqrt((double)(points > 0 ? points : 1)));
  return side > 0 ? side : 1;
}

/* A parallel view starts close to what it shows: farther off, places across it are rounded to parts
 * of a photon's cell. */
static void come_close(abbe_view *view) {
  const double depth = view->far - view->near, way = view->near - 0.5 * depth;
  for (int k = 0; k < 3; k++) view->origin[k] += way * view->forward[k];
  view->near -= way;
  view->far -= way;
}

/* Tight around the refractors for the photons; around all receivers for the map, which is fitted
 * to the photons' hits later where the request does not give it. */
static void fit_views(abbe_photon_lights *views) {
  for (size_t i = 0; i < views->scene->plan->light_view_count; i++) {
    abbe_photon_light *state = &views->light[i];
    state->cells[0] = state->cells[1] = abbe_photon_lights_photons(views->scene, i);
    abbe_photon_light_look(views->scene, i, &state->near_view);
    if (views->scene->plan->refractor_count > 0)
      fit_objects(views, views->scene->plan->refractor_object, views->scene->plan->refractor_count,
                  &state->near_view);
    else
      fit_objects(views, views->scene->plan->receiver_object, views->scene->plan->receiver_count,
                  &state->near_view);
    abbe_view_pad(&state->near_view, 0.01);
    if (state->near_view.orthographic) come_close(&state->near_view);
    if (abbe_photon_lights_is_face(views, i)) {
      abbe_photon_light_look(views->scene, i, &state->near_view);
      fit_face(views, i, &state->near_view);
    }
    abbe_photon_lights_whole_map(views, i, &state->map);
    if (abbe_photon_lights_map_is_given(views, i))
      abbe_photon_lights_take_layout(views, views->scene->map_layout, &state->map);
  }
}

void abbe_photon_lights_shift_cells(abbe_photon_lights *views, size_t light,
                                    const double shift[2]) {
  abbe_photon_light *state = &views->light[light];
  memcpy(state->near_view.window, state->unshifted, sizeof state->unshifted);
  if (fmax(fabs(shift[0]), fabs(shift[1])) == 0) return;
  for (int axis = 0; axis < 2; axis++) {
    double *low = &state->near_view.window[2 * axis], *high = low + 1;
    double cell = (*high - *low) / (double)state->cells[axis];
    *low += (shift[axis] - 0.5) * cell;
    *high += (shift[axis] + 0.5) * cell;
  }
}

void abbe_photon_lights_set_grid(const abbe_photon_lights *views, GLuint program, size_t light) {
  const size_t *cells = views->light[light].cells;
  views->scene->gpu->gl->Uniform2i(views->scene->gpu->gl->GetUniformLocation(program, "grid"),
                                   (GLint)cells[0], (GLint)cells[1]);
}

/* Wide sums hold 2^36 full photons of 2^28 units; narrow ones share 2^31 units among all
 * photons that there are. Both count the largest of the white's X, Y and Z. */
double abbe_photon_lights_map_unit(const abbe_photon_lights *views, size_t light) {
  const abbe_photon_light *state = &views->light[light];
  bool known = !views->wide && state->photon_count > 0;
  double unit = known ? ldexp((double)state->photon_count * state->cell_flux, -31)
                      : ldexp(state->cell_flux, -28);
  return (double)(float)(unit * state->white_peak);
}

size_t abbe_photon_lights_map_words(const abbe_photon_lights *views) {
  return views->wide ? 6 : 3;
}

static double texel_size(const abbe_photon_lights *views, size_t light, int axis, size_t side,
                         size_t i) {
  return abbe_map_layout_texel_size(&views->light[light].map, axis, side, i);
}

/* 1 / what a texel spreads its light over: by the weights of a bilinear filter, of the finer ones'
 * sizes. */
static double per_spread(const abbe_photon_lights *views, size_t light, int axis, size_t side,
                         size_t i) {
  const size_t finer = 2 * side, before = i > 0 ? 2 * i - 1 : 0;
  const size_t after = 2 * i + 2 < finer ? 2 * i + 2 : 2 * i + 1;
  return 1 / (0.75 * texel_size(views, light, axis, side, i) +
              0.25 * (texel_size(views, light, axis, finer, before) +
                      texel_size(views, light, axis, finer, after)));
}

/* Uploads sizes along one axis of a light, as texel_sizes.glsl reads them: one level after
 * another. */
static void upload_texel_sizes(const abbe_photon_lights *views, size_t light, int axis) {
  const size_t whole = views->scene->plan->desc.map_size;
  enum { CHUNK = 256 };
  float size[CHUNK], spread[CHUNK];
  for (size_t level = 0; level < views->map_levels; level++) {
    const size_t side = whole >> level,
                 first = 2 * (4 * light + (size_t)axis) * whole + 2 * (whole - side);
    for (size_t i = 0; i < side; i += CHUNK) {
      const size_t count = side - i < CHUNK ? side - i : CHUNK;
      for (size_t k = 0; k < count; k++) {
        size[k] = (float)texel_size(views, light, axis, side, i + k);
        spread[k] = level > 0 ? (float)per_spread(views, light, axis, side, i + k) : 0;
      }
      views->scene->gpu->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER,
                                           (GLintptr)((first + i) * sizeof *size),
                                           (GLsizeiptr)(count * sizeof *size), size);
      views->scene->gpu->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER,
                                           (GLintptr)((first + 4 * whole + i) * sizeof *size),
                                           (GLsizeiptr)(count * sizeof *size), spread);
    }
  }
}

static void upload_warps(abbe_photon_lights *views, size_t light) {
  float row[ABBE_WARP_STEPS][4];
  for (int k = 0; k < ABBE_WARP_STEPS; k++)
    for (int i = 0; i < 4; i++) row[k][i] = (float)views->light[light].map.knot[i % 2][k + i / 2];
  views->scene->gpu->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, views->warps);
  views->scene->gpu->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, (GLintptr)(light * sizeof row),
                                       sizeof row, row);
  views->scene->gpu->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, views->texel_sizes);
  for (int axis = 0; axis < 2; axis++) upload_texel_sizes(views, light, axis);
}

/* Called again whenever a light's view changes. */
void abbe_photon_lights_upload(abbe_photon_lights *views) {
  for (size_t i = 0; i < views->scene->plan->light_view_count; i++) {
    const abbe_light *light = &views->scene->local->light[i];
    abbe_photon_light *state = &views->light[i];
    gpu_light g = {0};
    double white[3], rgb[3], matrix[9];
    abbe_weights_white(views->scene->plan->desc.observer, &light->illuminant,
                       views->scene->plan->desc.min_nm, views->scene->plan->desc.max_nm, white);
    abbe_rgb_space_from_xyz(abbe_gpu_scene_working_space(views->scene), matrix);
    abbe_rgb_space_apply(matrix, white, rgb);
    state->white_peak = fmax(white[0], fmax(white[1], white[2])) / white[1];
    double cell_area =
        abbe_view_area(&state->near_view) / ((double)state->cells[0] * (double)state->cells[1]);
    state->cell_flux = fmax(cell_area, DBL_MIN);
    abbe_view_pack(&state->near_view, g.near_view);
    abbe_view_pack(&state->map.view, g.map_view);
    abbe_float4_store(light->position, (double)light->kind, g.position);
    abbe_float4_store(light->direction, cos(light->cone_rad), g.direction);
    abbe_float4_store(rgb, light->power, g.white);
    g.misc[0] = (float)cos(fmax(light->cone_rad - light->soft_rad, 0));
    g.misc[1] = (float)abbe_photon_lights_map_unit(views, i);
    g.misc[2] = (float)(1 / cell_area);
    g.misc[3] = views->scene->plan->reaches[i] ? 1 : 0;
    g.cube[0] = (float)views->scene->plan->light_view[i].faces;
    g.cube[1] = (float)abbe_gpu_area_lights_of(views->scene, i);
    g.cube[2] = (float)abbe_gpu_shadows_radius(light);
    upload_warps(views, i);
    views->scene->gpu->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, views->lights);
    views->scene->gpu->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, (GLintptr)(i * sizeof g),
                                         sizeof g, &g);
  }
}

/* Levels halve the side as long as it is even, so that coarse texels cover whole fine ones. */
static void size_map(abbe_photon_lights *views, size_t side) {
  views->map_levels = 1;
  views->map_texels = side * side;
  while (views->map_levels < MAX_MAP_LEVELS && side % 2 == 0 && side > 2) {
    side /= 2;
    views->map_levels++;
    views->map_texels += side * side;
  }
}

abbe_result abbe_photon_lights_make(const abbe_gpu_scene *scene, abbe_photon_lights *out,
                                    abbe_error *error) {
  const abbe_render_desc *desc = &scene->plan->desc;
  const size_t lights = scene->plan->light_view_count;
  out->scene = scene;
  out->wide = desc->photons * desc->photons * desc->wavelengths > MAX_NARROW_PHOTONS;
  size_map(out, scene->plan->caustics ? desc->map_size : 1);
  fit_views(out);
  ABBE_TRY(abbe_gpu_make_texels(scene->gpu, GL_RGBA32F, lights * ABBE_WARP_STEPS * 16, NULL,
                                UNIT_WARPS, &out->warps, &out->warp_texels, error));
  ABBE_TRY(abbe_gpu_make_buffer(scene->gpu, lights * desc->map_size * 8 * 4, NULL,
                                &out->texel_sizes, error));
  ABBE_TRY(abbe_gpu_make_buffer(scene->gpu, lights * sizeof(gpu_light), NULL, &out->lights, error));
  abbe_photon_lights_upload(out);
  return ABBE_OK;
}

void abbe_photon_lights_free(abbe_photon_lights *views) {
  if (views->scene == NULL) return;
  GLuint buffers[] = {views->lights, views->warps, views->texel_sizes};
  abbe_gpu_drop_buffers(views->scene->gpu, sizeof buffers / sizeof *buffers, buffers);
  views->scene->gpu->gl->DeleteTextures(1, &views->warp_texels);
}

void abbe_photon_lights_bind(const abbe_photon_lights *views) {
  const abbe_gl *gl = views->scene->gpu->gl;
  gl->BindBufferBase(GL_UNIFORM_BUFFER, BINDING_LIGHTS, views->lights);
  gl->ActiveTexture(GL_TEXTURE0 + UNIT_WARPS);
  gl->BindTexture(GL_TEXTURE_BUFFER, views->warp_texels);
}
