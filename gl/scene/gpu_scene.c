#include "gl/scene/gpu_scene.h"

#include "base/maths.h"
#include "base/thread/watch.h"
#include "gl/device/bindings.h"
#include "gl/device/float4.h"
#include "gl/scene/spectra/camera_bands.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Float copies of the shaders' structs (common.glsl). */
typedef struct gpu_refractor {
  float sphere[4];
  int info[4];
} gpu_refractor;

typedef struct gpu_receiver {
  float anchor[4], u[4], v[4], normal[4], du[4], dv[4];
} gpu_receiver;

static bool along(const double a[3], const double b[3]) {
  return fabs(abbe_vector_dot(a, b)) > 1 - 1e-12;
}

bool abbe_gpu_scene_same_stuff(const abbe_object *a, const abbe_object *b) {
  if (a->material != b->material || a->material == NULL || !abbe_material_is_crystal(a->material))
    return a->material == b->material;
  return along(a->axis, b->axis) &&
         (!abbe_material_is_biaxial(a->material) || along(a->axis_x, b->axis_x));
}

/* Refractors and the planes of the convex ones. */
static abbe_result upload_refractors(abbe_gpu_scene *scene, abbe_error *error) {
  const abbe_plan *plan = scene->plan;
  size_t planes = 0;
  for (size_t i = 0; i < plan->refractor_count; i++)
    if (plan->model[i] == ABBE_REFRACTOR_CONVEX)
      planes += scene->local->object[plan->refractor_object[i]].exact.count;
  gpu_refractor *refractor = calloc(plan->refractor_count + 1, sizeof *refractor);
  float(*plane)[4] = calloc(planes + 1, sizeof *plane);
  abbe_result result = ABBE_OK;
  if (refractor == NULL || plane == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for refractors");
  size_t next = 0;
  for (size_t i = 0; result == ABBE_OK && i < plan->refractor_count; i++) {
    const abbe_object *object = &scene->local->object[plan->refractor_object[i]];
    double centre[3], half = 0;
    for (int k = 0; k < 3; k++) {
      centre[k] = 0.5 * (object->min[k] + object->max[k]);
      half += pow(0.5 * (object->max[k] - object->min[k]), 2);
    }
    bool sphere = plan->model[i] == ABBE_REFRACTOR_SPHERE;
    abbe_float4_store(sphere ? object->exact.centre : centre,
                      sphere ? object->exact.radius : sqrt(half), refractor[i].sphere);
    refractor[i].info[0] = (int)plan->model[i];
    for (size_t k = 0; k <= i; k++) { /* the first of the same */
      refractor[i].info[3] = (int)k;
      if (abbe_gpu_scene_same_stuff(&scene->local->object[plan->refractor_object[k]], object))
        break;
    }
    if (plan->mirror[i]) refractor[i].info[2] = -1;
    refractor[i].info[1] = (int)next;
    if (plan->model[i] == ABBE_REFRACTOR_BVH) refractor[i].info[1] = (int)scene->refractor_root[i];
    if (plan->model[i] != ABBE_REFRACTOR_CONVEX) continue;
    refractor[i].info[2] = (int)object->exact.count;
    for (size_t k = 0; k < object->exact.count; k++)
      abbe_float4_store(object->exact.plane[k], object->exact.plane[k][3], plane[next++]);
  }
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(scene->gpu, plan->refractor_count * sizeof *refractor, refractor,
                                  &scene->refractors, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(scene->gpu, planes * sizeof *plane, plane, &scene->planes, error);
  free(refractor);
  free(plane);
  return result;
}

/* A parallelogram is known from the place of it that is nearest to the refractors: floats know what
 * lies there best, however far it reaches. Of dual edges du, dv. */
static void find_anchor(const double p[9], const double du[3], const double dv[3],
                        const double near[3], double uv[2], double at[3]) {
  double from[3];
  abbe_vector_subtract(near, p, from);
  uv[0] = fmin(fmax(abbe_vector_dot(from, du), 0), 1);
  uv[1] = fmin(fmax(abbe_vector_dot(from, dv), 0), 1);
  for (int k = 0; k < 3; k++) at[k] = p[k] + uv[0] * p[3 + k] + uv[1] * p[6 + k];
}

static void store_parallelogram(const double p[9], size_t surface, const double near[3],
                                gpu_receiver *out) {
  const double *u = p + 3, *v = p + 6;
  double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  double area2 = abbe_vector_dot(n, n), du[3], dv[3], uv[2], anchor[3];
  /* Dual edges within the plane: du = (v x n) / |n|^2, dv = (n x u) / |n|^2. */
  for (int k = 0; k < 3; k++) {
    int a = (k + 1) % 3, b = (k + 2) % 3;
    du[k] = (v[a] * n[b] - v[b] * n[a]) / area2;
    dv[k] = (n[a] * u[b] - n[b] * u[a]) / area2;
  }
  for (int k = 0; k < 3; k++) n[k] /= sqrt(area2);
  find_anchor(p, du, dv, near, uv, anchor);
  abbe_float4_store(anchor, (double)surface, out->anchor);
  abbe_float4_store(u, 0, out->u);
  abbe_float4_store(v, 0, out->v);
  abbe_float4_store(n, abbe_vector_dot(n, p), out->normal);
  abbe_float4_store(du, uv[0], out->du);
  abbe_float4_store(dv, uv[1], out->dv);
}

static abbe_result upload_receivers(abbe_gpu_scene *scene, abbe_error *error) {
  size_t count = scene->plan->parallelogram_count, next = 0;
  ABBE_FREED gpu_receiver *receiver = calloc(count + 1, sizeof *receiver);
  if (receiver == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for receivers");
  for (size_t i = 0; i < scene->plan->receiver_count; i++) {
    if (scene->plan->receiver_model[i] != ABBE_RECEIVER_EXACT) continue;
    const abbe_exact *exact = &scene->local->object[scene->plan->receiver_object[i]].exact;
    for (size_t k = 0; k < exact->count && next < count; k++)
      store_parallelogram(exact->parallelogram[k], i, scene->refractor_centre, &receiver[next++]);
  }
  return abbe_gpu_make_buffer(scene->gpu, count * sizeof *receiver, receiver, &scene->receivers,
                              error);
}

static void measure_scene(abbe_gpu_scene *scene) {
  double size = 0, radius = 0, min[3], max[3];
  abbe_scene_bounds(scene->local, true, true, scene->min, scene->max);
  bool any = abbe_scene_bounds(scene->local, true, false, min, max);
  for (int k = 0; k < 3; k++) {
    size += pow(scene->max[k] - scene->min[k], 2);
    scene->refractor_centre[k] = any ? 0.5 * (min[k] + max[k]) : 0;
    radius += any ? pow(0.5 * (max[k] - min[k]), 2) : 0;
  }
  scene->size = sqrt(size);
  scene->refractor_radius = sqrt(radius);
}

static void store_matrix(const double matrix[9], float out[9]) {
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++)
      out[3 * column + row] = (float)matrix[3 * row + column];
}

void abbe_gpu_scene_begin(abbe_gpu *gpu, const abbe_scene *local, double unit,
                          const abbe_plan *plan, const abbe_map_layout *map_layout,
                          abbe_gpu_scene *out) {
  out->gpu = gpu;
  out->local = local;
  out->unit = unit;
  out->plan = plan;
  out->map_layout = map_layout;
  out->band_count = abbe_camera_bands_count(plan->desc.wavelengths, &out->band_levels);
  measure_scene(out);
  double matrix[9];
  abbe_rgb_space_from_xyz(abbe_gpu_scene_working_space(out), matrix);
  store_matrix(matrix, out->rgb_from_xyz);
  abbe_rgb_space_to_xyz(abbe_gpu_scene_working_space(out), matrix);
  store_matrix(matrix, out->xyz_from_rgb);
  abbe_gpu_haze_make(out);
}

static abbe_result make_geometry(abbe_gpu_scene *scene, abbe_error *error) {
  if (scene->plan->tiles || scene->plan->page_charts)
    ABBE_TRY(abbe_receiver_charts_make(scene->local, scene->plan, &scene->charts, error));
  ABBE_TRY(abbe_gpu_bvh_make(scene, error));
  ABBE_TRY(abbe_gpu_meshes_upload(scene, error));
  ABBE_TRY(upload_refractors(scene, error));
  return upload_receivers(scene, error);
}

abbe_result abbe_gpu_scene_make(abbe_gpu_scene *scene, unsigned parts, abbe_error *error) {
  if (parts & ABBE_SCENE_GEOMETRY) ABBE_TRY(make_geometry(scene, error));
  ABBE_TRY(abbe_watch_check(error));
  if ((parts & ABBE_SCENE_SHADOWS) != 0) ABBE_TRY(abbe_gpu_shadows_make(scene, error));
  if ((parts & ABBE_SCENE_SURFACES) != 0) ABBE_TRY(abbe_gpu_surfaces_upload(scene, error));
  ABBE_TRY(abbe_watch_check(error));
  if ((parts & ABBE_SCENE_SPECTRA) != 0)
    ABBE_TRY(abbe_spectral_tables_make(scene->local, scene->plan, &scene->tables, error));
  if ((parts & ABBE_SCENE_SPECTRA) != 0) ABBE_TRY(abbe_gpu_spectra_upload(scene, error));
  return ABBE_OK;
}

static void free_geometry(abbe_gpu_scene *scene) {
  abbe_gpu_meshes_free(scene);
  abbe_gpu_drop_buffers(scene->gpu, 1, &scene->refractors);
  abbe_gpu_drop_buffers(scene->gpu, 1, &scene->planes);
  abbe_gpu_drop_buffers(scene->gpu, 1, &scene->receivers);
  abbe_gpu_drop_buffers(scene->gpu, 3, scene->bvh);
  scene->gpu->gl->DeleteTextures(3, scene->bvh_texture);
  memset(scene->bvh_texture, 0, sizeof scene->bvh_texture);
  abbe_receiver_charts_free(&scene->charts);
  free(scene->refractor_root);
  free(scene->refractor_tree);
  scene->refractor_root = scene->refractor_tree = NULL;
  abbe_ray_trees_free(&scene->trees);
  scene->receiver_root = scene->bvh_depth = 0;
}

void abbe_gpu_scene_free(abbe_gpu_scene *scene, unsigned parts) {
  if (scene->gpu == NULL) return;
  if (parts & ABBE_SCENE_GEOMETRY) free_geometry(scene);
  if (parts & ABBE_SCENE_SHADOWS) abbe_gpu_shadows_free(scene);
  if (parts & ABBE_SCENE_SURFACES) {
    abbe_gpu_drop_buffers(scene->gpu, 1, &scene->surfaces);
    abbe_gpu_drop_buffers(scene->gpu, 1, &scene->reflections);
    abbe_gpu_drop_buffers(scene->gpu, 1, &scene->band_reflections);
    abbe_gpu_drop_textures(scene->gpu, 1, &scene->surface_texture);
    abbe_gpu_environment_free(scene->gpu, &scene->environment);
  }
  if (parts & ABBE_SCENE_SPECTRA) {
    abbe_gpu_drop_buffers(scene->gpu, 1, &scene->spectra);
    abbe_gpu_drop_buffers(scene->gpu, 1, &scene->bands);
    abbe_gpu_drop_buffers(scene->gpu, 1, &scene->band_texels);
    abbe_gpu_drop_textures(scene->gpu, 1, &scene->band_texels_texture);
    abbe_gpu_drop_buffers(scene->gpu, 1, &scene->film_texels);
    abbe_gpu_drop_textures(scene->gpu, 1, &scene->film_texels_texture);
    abbe_spectral_tables_free(&scene->tables);
  }
}

void abbe_gpu_scene_bind(const abbe_gpu_scene *scene) {
  const abbe_gl *gl = scene->gpu->gl;
  const struct {
    GLuint binding, buffer;
  } tables[] = {
      {BINDING_REFRACTORS, scene->refractors},  {BINDING_PLANES, scene->planes},
      {BINDING_RECEIVERS, scene->receivers},    {BINDING_SURFACES, scene->surfaces},
      {BINDING_SPECTRA, scene->spectra},        {BINDING_BANDS, scene->bands},
      {BINDING_SHADOW_PLANES, scene->shadows},  {BINDING_SOFT_LIGHT, scene->environment.soft_light},
      {BINDING_REFLECTIONS, scene->reflections}};
  for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
    if (tables[i].buffer == 0) continue;
    /* As blocks and as storage: the shaders choose by size. */
    gl->BindBufferBase(GL_UNIFORM_BUFFER, tables[i].binding, tables[i].buffer);
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, tables[i].binding, tables[i].buffer);
  }
  const struct {
    GLenum unit;
    GLuint texture;
  } texels[] = {{UNIT_BVH_NODES, scene->bvh_texture[0]},
                {UNIT_BVH_TRIANGLES, scene->bvh_texture[1]},
                {UNIT_BVH_CORNERS, scene->bvh_texture[2]},
                {UNIT_BAND_TEXELS, scene->band_texels_texture},
                {UNIT_FILMS, scene->film_texels_texture}};
  for (size_t i = 0; i < sizeof texels / sizeof *texels; i++) {
    if (texels[i].texture == 0) continue;
    gl->ActiveTexture(GL_TEXTURE0 + texels[i].unit);
    gl->BindTexture(GL_TEXTURE_BUFFER, texels[i].texture);
  }
}

/* Grooves and facets of mirrors (walk.glsl). */
static void set_rough(const abbe_gpu_scene *scene, GLuint program) {
  enum { MOST = 32 }; /* as light off mirrors is followed among so many */
  const abbe_gl *gl = scene->gpu->gl;
  const size_t count = scene->plan->refractor_count < MOST ? scene->plan->refractor_count : MOST;
  float facets[MOST][4] = {{0}}, axis[MOST][3], centre[MOST][3];
  for (size_t i = 0; i < count; i++) {
    const abbe_brushing *b = &scene->local->object[scene->plan->refractor_object[i]].brushing;
    facets[i][0] = (float)b->facets.x;
    facets[i][1] = (float)b->facets.y;
    facets[i][2] = b->around ? 1 : 0;
    for (int k = 0; k < 3; k++) {
      axis[i][k] = (float)b->axis[k];
      centre[i][k] = (float)b->centre[k];
    }
  }
  const GLsizei n = (GLsizei)count;
  gl->Uniform4fv(gl->GetUniformLocation(program, "rough_facets"), n, facets[0]);
  gl->Uniform3fv(gl->GetUniformLocation(program, "rough_axis"), n, axis[0]);
  gl->Uniform3fv(gl->GetUniformLocation(program, "rough_centre"), n, centre[0]);
}

void abbe_gpu_scene_set(const abbe_gpu_scene *scene, GLuint program) {
  const abbe_gl *gl = scene->gpu->gl;
  abbe_gpu_bind_array(scene->gpu, program, "surface_texture", 1, scene->surface_texture);
  if (scene->band_reflections != 0) /* in the unit of a volume, with which there are none */
    abbe_gpu_bind_texels(scene->gpu, program, "band_reflections", 3, GL_RGBA32F,
                         scene->band_reflections);
  GLint matrix = gl->GetUniformLocation(program, "rgb_from_xyz");
  if (matrix >= 0) gl->UniformMatrix3fv(matrix, 1, GL_FALSE, scene->rgb_from_xyz);
  matrix = gl->GetUniformLocation(program, "xyz_from_rgb");
  if (matrix >= 0) gl->UniformMatrix3fv(matrix, 1, GL_FALSE, scene->xyz_from_rgb);
  /* Ambient light and background are white by definition, in every working space. */
  const float ambient = (float)scene->local->ambient, background = (float)scene->local->background;
  gl->Uniform3f(gl->GetUniformLocation(program, "ambient"), ambient, ambient, ambient);
  gl->Uniform3f(gl->GetUniformLocation(program, "background"), background, background, background);
  gl->Uniform4f(gl->GetUniformLocation(program, "refractor_bounds"),
                (float)scene->refractor_centre[0], (float)scene->refractor_centre[1],
                (float)scene->refractor_centre[2], (float)scene->refractor_radius);
  abbe_gpu_set_float(scene->gpu, program, "scene_size", scene->size);
  if (scene->plan->rough) {
    set_rough(scene, program);
    abbe_gpu_set_float(scene->gpu, program, "light_unit", scene->unit);
    abbe_gpu_set_float(scene->gpu, program, "environment_scale", 1 / scene->unit);
  }
  abbe_gpu_haze_set(scene, program);
  abbe_gpu_area_lights_set(scene, program);
  abbe_gpu_environment_set(scene->gpu, scene->local, &scene->environment, scene->unit, program);
}
