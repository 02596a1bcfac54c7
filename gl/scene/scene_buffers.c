#include "gl/renderer_state.h"

#include "colorimetry/weights.h"
#include "spectral/wavelengths.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Float copies of the shaders' structs (common.glsl). */
typedef struct gpu_light {
  float near_view[24], map_view[24], position[4], direction[4], white[4], misc[4], cube[4];
} gpu_light;

typedef struct gpu_refractor {
  float sphere[4];
  int info[4];
} gpu_refractor;

typedef struct gpu_receiver {
  float corner[4], u[4], v[4], normal[4], du[4], dv[4];
} gpu_receiver;

typedef struct gpu_surface {
  float reflectance[4], texture_info[4];
} gpu_surface;

typedef struct gpu_band {
  float weight_n[4], attenuation[4];
} gpu_band;

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void store(const double v[3], double w, float out[4]) {
  for (int k = 0; k < 3; k++) out[k] = (float)v[k];
  out[3] = (float)w;
}

void abbe_renderer_point_to_vertices(const abbe_renderer *r) {
  static const struct {
    GLint size;
    size_t offset;
  } attribute[3] = {{3, 0}, {3, 12}, {2, 24}};
  for (GLuint k = 0; k < 3; k++) {
    r->gl->EnableVertexAttribArray(k);
    r->gl->VertexAttribPointer(k, attribute[k].size, GL_FLOAT, GL_FALSE, 32,
                               (const char *)NULL + attribute[k].offset);
  }
}

static abbe_result upload_mesh(abbe_renderer *r, const abbe_mesh *mesh, mesh_buffers *out,
                               abbe_error *error) {
  const abbe_gl *gl = r->gl;
  size_t size = mesh->vertex_count * 8 * sizeof(float);
  float *vertices = malloc(size > 0 ? size : 1);
  if (vertices == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a mesh");
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    float *v = vertices + 8 * i;
    for (int k = 0; k < 3; k++) {
      v[k] = (float)mesh->position[i][k];
      v[3 + k] = (float)mesh->normal[i][k];
    }
    v[6] = mesh->uv != NULL ? (float)mesh->uv[i][0] : 0.0f;
    v[7] = mesh->uv != NULL ? (float)mesh->uv[i][1] : 0.0f;
  }
  gl->GenVertexArrays(1, &out->array);
  gl->BindVertexArray(out->array);
  gl->GenBuffers(1, &out->vertices);
  gl->BindBuffer(GL_ARRAY_BUFFER, out->vertices);
  gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)size, vertices, GL_STATIC_DRAW);
  free(vertices);
  size_t index_size = mesh->face_count * sizeof *mesh->face;
  gl->GenBuffers(1, &out->indices);
  gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, out->indices);
  gl->BufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)index_size, mesh->face, GL_STATIC_DRAW);
  abbe_renderer_point_to_vertices(r);
  out->index_count = (GLsizei)(3 * mesh->face_count);
  r->device_bytes += size + index_size;
  return abbe_gl_check(gl, "the upload of a mesh", error);
}

static abbe_result upload_meshes(abbe_renderer *r, abbe_error *error) {
  r->mesh = calloc(r->scene->object_count + 1, sizeof *r->mesh);
  if (r->mesh == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for meshes");
  for (size_t i = 0; i < r->scene->object_count; i++) {
    abbe_result result = upload_mesh(r, &r->scene->object[i].mesh, &r->mesh[i], error);
    if (result != ABBE_OK) return result;
  }
  return ABBE_OK;
}

/* Refractors and the planes of the convex ones. */
static abbe_result upload_refractors(abbe_renderer *r, abbe_error *error) {
  const abbe_plan *plan = &r->plan;
  size_t planes = 0;
  for (size_t i = 0; i < plan->refractor_count; i++)
    if (plan->model[i] == ABBE_REFRACTOR_CONVEX)
      planes += r->scene->object[plan->refractor_object[i]].exact.count;
  gpu_refractor *refractor = calloc(plan->refractor_count + 1, sizeof *refractor);
  float(*plane)[4] = calloc(planes + 1, sizeof *plane);
  abbe_result result = ABBE_OK;
  if (refractor == NULL || plane == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for refractors");
  size_t next = 0;
  for (size_t i = 0; result == ABBE_OK && i < plan->refractor_count; i++) {
    const abbe_object *object = &r->scene->object[plan->refractor_object[i]];
    double centre[3], half = 0;
    for (int k = 0; k < 3; k++) {
      centre[k] = 0.5 * (object->min[k] + object->max[k]);
      half += pow(0.5 * (object->max[k] - object->min[k]), 2);
    }
    bool sphere = plan->model[i] == ABBE_REFRACTOR_SPHERE;
    store(sphere ? object->exact.centre : centre, sphere ? object->exact.radius : sqrt(half),
          refractor[i].sphere);
    refractor[i].info[0] = (int)plan->model[i];
    for (size_t k = 0; k <= i; k++) { /* the first of the same material */
      refractor[i].info[3] = (int)k;
      if (r->scene->object[plan->refractor_object[k]].material == object->material) break;
    }
    refractor[i].info[1] = (int)next;
    if (plan->model[i] == ABBE_REFRACTOR_BVH)
      refractor[i].info[1] = (int)r->refractor_root[i];
    if (plan->model[i] != ABBE_REFRACTOR_CONVEX) continue;
    refractor[i].info[2] = (int)object->exact.count;
    for (size_t k = 0; k < object->exact.count; k++)
      store(object->exact.plane[k], object->exact.plane[k][3], plane[next++]);
  }
  if (result == ABBE_OK)
    result = abbe_renderer_make_buffer(r, plan->refractor_count * sizeof *refractor, refractor,
                                       &r->buffer[BINDING_REFRACTORS], error);
  if (result == ABBE_OK)
    result = abbe_renderer_make_buffer(r, planes * sizeof *plane, plane, &r->buffer[BINDING_PLANES],
                                       error);
  free(refractor);
  free(plane);
  return result;
}

static void store_parallelogram(const double p[9], size_t surface, gpu_receiver *out) {
  const double *u = p + 3, *v = p + 6;
  double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  double area2 = dot(n, n), du[3], dv[3];
  /* Dual edges within the plane: du = (v x n) / |n|^2, dv = (n x u) / |n|^2. */
  for (int k = 0; k < 3; k++) {
    int a = (k + 1) % 3, b = (k + 2) % 3;
    du[k] = (v[a] * n[b] - v[b] * n[a]) / area2;
    dv[k] = (n[a] * u[b] - n[b] * u[a]) / area2;
  }
  for (int k = 0; k < 3; k++) n[k] /= sqrt(area2);
  store(p, (double)surface, out->corner);
  store(u, 0, out->u);
  store(v, 0, out->v);
  store(n, 0, out->normal);
  store(du, 0, out->du);
  store(dv, 0, out->dv);
}

static abbe_result upload_receivers(abbe_renderer *r, abbe_error *error) {
  size_t count = r->plan.parallelogram_count, next = 0;
  gpu_receiver *receiver = calloc(count + 1, sizeof *receiver);
  if (receiver == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for receivers");
  for (size_t i = 0; i < r->plan.receiver_count; i++) {
    if (r->plan.receiver_model[i] != ABBE_RECEIVER_EXACT) continue;
    const abbe_exact *exact = &r->scene->object[r->plan.receiver_object[i]].exact;
    for (size_t k = 0; k < exact->count && next < count; k++)
      store_parallelogram(exact->parallelogram[k], i, &receiver[next++]);
  }
  abbe_result result = abbe_renderer_make_buffer(r, count * sizeof *receiver, receiver,
                                                 &r->buffer[BINDING_RECEIVERS], error);
  free(receiver);
  return result;
}

/* Working space: the picture's, or ACEScg where the picture is XYZ, so that a colour times a
 * reflectance means something. */
static abbe_rgb_space working_space(const abbe_renderer *r) {
  return r->plan.desc.space == ABBE_RGB_SPACE_XYZ ? ABBE_RGB_SPACE_ACESCG : r->plan.desc.space;
}

void abbe_renderer_to_working(const abbe_renderer *r, const double rgb[3], double out[3]) {
  double to_xyz[9], from_xyz[9];
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, to_xyz);
  abbe_rgb_space_from_xyz(working_space(r), from_xyz);
  abbe_rgb_space_apply(to_xyz, rgb, out);
  abbe_rgb_space_apply(from_xyz, out, out);
}

/* All textures in one array as large as the largest; smaller ones are resampled to it. */
static abbe_result upload_textures(abbe_renderer *r, gpu_surface *surface, abbe_error *error) {
  size_t width = 1, height = 1, layers = 0;
  for (size_t i = 0; i < r->plan.receiver_count; i++) {
    const abbe_image *t = &r->scene->object[r->plan.receiver_object[i]].texture;
    if (t->data == NULL) continue;
    layers++;
    if (t->width > width) width = t->width;
    if (t->height > height) height = t->height;
  }
  abbe_result result = abbe_renderer_make_texture(
      r, GL_RGBA16F, width, height, layers > 0 ? layers : 1, true, &r->texture_surface, error);
  if (result != ABBE_OK || layers == 0) return result;
  r->gl->TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_REPEAT);
  r->gl->TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_REPEAT);
  float *texel = malloc(width * height * 4 * sizeof *texel);
  if (texel == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a texture");
  int layer = 0;
  for (size_t i = 0; i < r->plan.receiver_count; i++) {
    const abbe_image *t = &r->scene->object[r->plan.receiver_object[i]].texture;
    if (t->data == NULL) continue;
    for (size_t y = 0; y < height; y++)
      for (size_t x = 0; x < width; x++) {
        const float *from =
            t->data +
            ((height - 1 - y) * t->height / height * t->width + x * t->width / width) * t->channels;
        double rgb[3] = {from[0], from[1], from[2]};
        abbe_renderer_to_working(r, rgb, rgb);
        store(rgb, 1, texel + 4 * (y * width + x));
      }
    r->gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, layer, (GLsizei)width, (GLsizei)height, 1,
                         GL_RGBA, GL_FLOAT, texel);
    surface[i].texture_info[0] = (float)layer++;
  }
  free(texel);
  return abbe_gl_check(r->gl, "the upload of textures", error);
}

static abbe_result upload_surfaces(abbe_renderer *r, abbe_error *error) {
  gpu_surface *surface = calloc(r->plan.receiver_count + 1, sizeof *surface);
  if (surface == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for surfaces");
  for (size_t i = 0; i < r->plan.receiver_count; i++) {
    const abbe_object *object = &r->scene->object[r->plan.receiver_object[i]];
    double rgb[3];
    abbe_renderer_to_working(r, object->reflectance, rgb);
    store(rgb, 1, surface[i].reflectance);
    surface[i].texture_info[0] = -1.0f;
    surface[i].texture_info[1] = (float)object->texture_repeat[0];
    surface[i].texture_info[2] = (float)object->texture_repeat[1];
  }
  abbe_result result = upload_textures(r, surface, error);
  if (result == ABBE_OK)
    result = abbe_renderer_make_buffer(r, r->plan.receiver_count * sizeof *surface, surface,
                                       &r->buffer[BINDING_SURFACES], error);
  free(surface);
  return result;
}

static abbe_result upload_spectra(abbe_renderer *r, abbe_error *error) {
  size_t n = r->plan.desc.wavelengths;
  float(*spectrum)[4] = calloc(r->plan.refractor_count * n + 1, sizeof *spectrum);
  if (spectrum == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for spectra");
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < r->plan.refractor_count; i++) {
    const abbe_material *material = r->scene->object[r->plan.refractor_object[i]].material;
    for (size_t k = 0; k < n && result == ABBE_OK; k++) {
      double index = 1;
      result = abbe_material_n(material, r->lambda_nm[k], &index, error);
      spectrum[i * n + k][0] = (float)index;
      spectrum[i * n + k][1] = (float)abbe_material_attenuation(material, r->lambda_nm[k]);
    }
  }
  if (result == ABBE_OK)
    result = abbe_renderer_make_buffer(r, r->plan.refractor_count * n * sizeof *spectrum, spectrum,
                                       &r->buffer[BINDING_SPECTRA], error);
  free(spectrum);
  return result;
}

/* Y of the light's band below and above each node, into `part` and the next of every sample. */
static void weigh_halves(const abbe_renderer *r, const abbe_wavelengths *w, size_t light, int part,
                         float (*sample)[4]) {
  const abbe_illuminant *illuminant = &r->scene->light[light].illuminant;
  const size_t n = r->plan.desc.wavelengths;
  const double min = w->edge_nm[0], max = w->edge_nm[w->count];
  for (size_t k = 0; k < w->count; k++) {
    const size_t i = w->count == n ? k : abbe_renderer_coarse_node(n, w->count, k);
    double below[3], above[3];
    abbe_weights_band_xyz(illuminant, min, max, w->edge_nm[k], w->lambda_nm[k], below);
    abbe_weights_band_xyz(illuminant, min, max, w->lambda_nm[k], w->edge_nm[k + 1], above);
    sample[i][part] = (float)below[1];
    sample[i][part + 1] = (float)above[1];
  }
}

static abbe_result upload_sample_weights(abbe_renderer *r, const abbe_wavelengths *w,
                                         abbe_error *error) {
  size_t n = w->count;
  abbe_wavelengths coarse = {0};
  float(*sample)[4] = calloc(r->plan.light_view_count * n + 1, sizeof *sample);
  if (sample == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for weights");
  abbe_result result = abbe_renderer_coarse_wavelengths(r, w, &coarse, error);
  for (size_t light = 0; light < r->plan.light_view_count && result == ABBE_OK; light++) {
    weigh_halves(r, w, light, 0, sample + light * n);
    weigh_halves(r, &coarse, light, 2, sample + light * n);
  }
  if (result == ABBE_OK)
    result = abbe_renderer_make_buffer(r, r->plan.light_view_count * n * sizeof *sample, sample,
                                       &r->buffer[BINDING_SAMPLE_WEIGHTS], error);
  abbe_wavelengths_free(&coarse);
  free(sample);
  return result;
}

/* A pair of bands as one: weights add, index and attenuation are means by brightness. */
static void join_bands(const gpu_band *a, const gpu_band *b, gpu_band *out) {
  double wa = 1e-9, wb = 1e-9;
  for (int c = 0; c < 3; c++) {
    wa += fabs(a->weight_n[c]);
    wb += fabs(b->weight_n[c]);
    out->weight_n[c] = a->weight_n[c] + b->weight_n[c];
  }
  out->weight_n[3] = (float)((wa * a->weight_n[3] + wb * b->weight_n[3]) / (wa + wb));
  out->attenuation[0] = (float)((wa * a->attenuation[0] + wb * b->attenuation[0]) / (wa + wb));
}

static abbe_result fill_bands(const abbe_renderer *r, const abbe_weights *xyz, size_t refractor,
                              gpu_band *band, abbe_error *error) {
  const abbe_material *material = r->scene->object[r->plan.refractor_object[refractor]].material;
  size_t count = xyz->count;
  for (size_t i = 0; i < count; i++) {
    double n = 1, weight[3];
    abbe_result result = abbe_material_n(material, r->lambda_nm[i], &n, error);
    if (result != ABBE_OK) return result;
    for (int c = 0; c < 3; c++)
      weight[c] = xyz->sum[c] > 0 ? xyz->weight[i][c] / xyz->sum[c] : 1.0 / (double)count;
    store(weight, n, band[i].weight_n);
    band[i].attenuation[0] = (float)abbe_material_attenuation(material, r->lambda_nm[i]);
  }
  for (; count > 1; band += count, count = (count + 1) / 2)
    for (size_t i = 0; i < (count + 1) / 2; i++) {
      band[count + i] = band[2 * i];
      if (2 * i + 1 < count) join_bands(&band[2 * i], &band[2 * i + 1], &band[count + i]);
    }
  return ABBE_OK;
}

/* The eye's weights are the first light's in XYZ, where none is negative, by its white. */
static abbe_result upload_bands(abbe_renderer *r, const abbe_wavelengths *w, abbe_error *error) {
  size_t refractors = r->plan.refractor_count;
  gpu_band *band = calloc(refractors * r->band_count + 1, sizeof *band);
  abbe_weights xyz = {0};
  if (band == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for bands");
  abbe_result result =
      abbe_weights_make(w, &r->scene->light[0].illuminant, ABBE_RGB_SPACE_XYZ, &xyz, error);
  for (size_t i = 0; i < refractors && result == ABBE_OK; i++)
    result = fill_bands(r, &xyz, i, band + i * r->band_count, error);
  if (result == ABBE_OK)
    result = abbe_renderer_make_buffer(r, refractors * r->band_count * sizeof *band, band,
                                       &r->table_bands, error);
  abbe_weights_free(&xyz);
  free(band);
  return result;
}

static abbe_result upload_wavelengths(abbe_renderer *r, abbe_error *error) {
  abbe_wavelengths w = {0};
  size_t n = r->plan.desc.wavelengths;
  abbe_result result =
      abbe_wavelengths_make(n, r->plan.desc.min_nm, r->plan.desc.max_nm, &w, error);
  if (result != ABBE_OK) return result;
  r->lambda_nm = malloc(n * sizeof *r->lambda_nm);
  if (r->lambda_nm == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for wavelengths");
  else
    memcpy(r->lambda_nm, w.lambda_nm, n * sizeof *r->lambda_nm);
  r->nodes = abbe_plan_least_wavelengths(&r->plan);
  r->steps = 128;
  while (r->steps > 2 && r->steps * r->nodes > 1024) r->steps /= 2;
  if (result == ABBE_OK) result = upload_spectra(r, error);
  if (result == ABBE_OK) result = abbe_renderer_upload_intervals(r, &w, error);
  if (result == ABBE_OK) result = upload_sample_weights(r, &w, error);
  if (result == ABBE_OK) result = upload_bands(r, &w, error);
  abbe_wavelengths_free(&w);
  return result;
}

static void measure_scene(abbe_renderer *r) {
  double size = 0, radius = 0, min[3], max[3];
  abbe_scene_bounds(r->scene, true, true, r->scene_min, r->scene_max);
  bool any = abbe_scene_bounds(r->scene, true, false, min, max);
  for (int k = 0; k < 3; k++) {
    size += pow(r->scene_max[k] - r->scene_min[k], 2);
    r->refractor_centre[k] = any ? 0.5 * (min[k] + max[k]) : 0;
    radius += any ? pow(0.5 * (max[k] - min[k]), 2) : 0;
  }
  r->scene_size = sqrt(size);
  r->refractor_radius = sqrt(radius);
}

abbe_result abbe_renderer_upload_scene(abbe_renderer *r, abbe_error *error) {
  measure_scene(r);
  double matrix[9];
  abbe_rgb_space_from_xyz(working_space(r), matrix);
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++)
      r->rgb_from_xyz[3 * column + row] = (float)matrix[3 * row + column];
  abbe_rgb_space_to_xyz(working_space(r), matrix);
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++)
      r->xyz_from_rgb[3 * column + row] = (float)matrix[3 * row + column];
  abbe_result result = upload_meshes(r, error);
  if (result == ABBE_OK) result = upload_refractors(r, error);
  if (result == ABBE_OK) result = abbe_renderer_upload_shadows(r, error);
  if (result == ABBE_OK) result = upload_receivers(r, error);
  if (result == ABBE_OK) result = upload_surfaces(r, error);
  if (result == ABBE_OK) result = upload_wavelengths(r, error);
  if (result == ABBE_OK)
    result = abbe_renderer_make_buffer(r, r->plan.light_view_count * (WARP_STEPS + 1) * 16, NULL,
                                       &r->table_warps, error);
  if (result == ABBE_OK)
    result = abbe_renderer_make_buffer(r, r->plan.light_view_count * r->plan.desc.map_size * 8 * 4, NULL,
                                       &r->texel_sizes, error);
  if (result == ABBE_OK)
    result = abbe_renderer_make_buffer(r, r->plan.light_view_count * sizeof(gpu_light), NULL,
                                       &r->buffer[BINDING_LIGHTS], error);
  return result;
}

/* Wide sums have room for 2^36 full photons of 2^28 units; narrow ones share 2^31 units among all
 * the light that reaches refractors. Both count the largest of the white's X, Y and Z. */
double abbe_renderer_map_unit(const abbe_renderer *r, size_t light) {
  const light_state *state = &r->light[light];
  bool known = !r->wide && state->reached_flux > 0;
  double unit = known ? ldexp(state->reached_flux, -31) : ldexp(state->cell_flux, -28);
  return (double)(float)(unit * state->white_peak);
}

size_t abbe_renderer_map_words(const abbe_renderer *r) {
  return r->wide ? 6 : 3;
}

double abbe_renderer_texel_size(const abbe_renderer *r, size_t light, int axis, size_t texel) {
  return abbe_map_layout_texel_size(&r->light[light].map, axis, r->plan.desc.map_size, texel);
}

static double texel_size(const abbe_renderer *r, size_t light, int axis, size_t side, size_t i) {
  return abbe_map_layout_texel_size(&r->light[light].map, axis, side, i);
}

/* 1 / what a texel spreads its light over: by the weights of a bilinear filter, of the finer ones'
 * sizes. */
static double per_spread(const abbe_renderer *r, size_t light, int axis, size_t side, size_t i) {
  const size_t finer = 2 * side, before = i > 0 ? 2 * i - 1 : 0;
  const size_t after = 2 * i + 2 < finer ? 2 * i + 2 : 2 * i + 1;
  return 1 / (0.75 * texel_size(r, light, axis, side, i) +
              0.25 * (texel_size(r, light, axis, finer, before) +
                      texel_size(r, light, axis, finer, after)));
}

/* Of one axis of a light, as texel_sizes.glsl reads them: of one level after another. */
static void upload_texel_sizes(const abbe_renderer *r, size_t light, int axis) {
  const size_t whole = r->plan.desc.map_size;
  enum { CHUNK = 256 };
  float size[CHUNK], spread[CHUNK];
  for (size_t level = 0; level < r->map_levels; level++) {
    const size_t side = whole >> level,
                 first = 2 * (4 * light + (size_t)axis) * whole + 2 * (whole - side);
    for (size_t i = 0; i < side; i += CHUNK) {
      const size_t count = side - i < CHUNK ? side - i : CHUNK;
      for (size_t k = 0; k < count; k++) {
        size[k] = (float)texel_size(r, light, axis, side, i + k);
        spread[k] = level > 0 ? (float)per_spread(r, light, axis, side, i + k) : 0;
      }
      r->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, (GLintptr)((first + i) * sizeof *size),
                           (GLsizeiptr)(count * sizeof *size), size);
      r->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER,
                           (GLintptr)((first + 4 * whole + i) * sizeof *size),
                           (GLsizeiptr)(count * sizeof *size), spread);
    }
  }
}

static void upload_warps(abbe_renderer *r, size_t light) {
  float row[WARP_STEPS + 1][4] = {{0}};
  for (int k = 0; k <= WARP_STEPS; k++)
    for (int axis = 0; axis < 2; axis++) row[k][axis] = (float)r->light[light].map.knot[axis][k];
  r->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->table_warps);
  r->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, (GLintptr)(light * sizeof row), sizeof row, row);
  r->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->texel_sizes);
  for (int axis = 0; axis < 2; axis++) upload_texel_sizes(r, light, axis);
}

/* Called again whenever a light's view changes. */
void abbe_renderer_upload_lights(abbe_renderer *r) {
  for (size_t i = 0; i < r->plan.light_view_count; i++) {
    const abbe_light *light = &r->scene->light[i];
    light_state *state = &r->light[i];
    gpu_light g = {0};
    double white[3], rgb[3], matrix[9];
    abbe_weights_band_xyz(&light->illuminant, r->plan.desc.min_nm, r->plan.desc.max_nm,
                          r->plan.desc.min_nm, r->plan.desc.max_nm, white);
    abbe_rgb_space_from_xyz(working_space(r), matrix);
    abbe_rgb_space_apply(matrix, white, rgb);
    state->white_peak = fmax(white[0], fmax(white[1], white[2])) / white[1];
    double cell_area =
        abbe_view_area(&state->near_view) / ((double)state->cells[0] * (double)state->cells[1]);
    state->cell_flux = fmax(light->power * cell_area, DBL_MIN);
    abbe_view_pack(&state->near_view, g.near_view);
    abbe_view_pack(&state->map.view, g.map_view);
    store(light->position, (double)light->kind, g.position);
    store(light->direction, cos(light->cone_rad), g.direction);
    store(rgb, light->power, g.white);
    g.misc[0] = (float)cos(fmax(light->cone_rad - light->soft_rad, 0));
    g.misc[1] = (float)abbe_renderer_map_unit(r, i);
    g.misc[2] = (float)(1 / cell_area);
    g.misc[3] = r->plan.reaches[i] ? 1 : 0;
    g.cube[0] = (float)r->plan.light_view[i].faces;
    upload_warps(r, i);
    r->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->buffer[BINDING_LIGHTS]);
    r->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, (GLintptr)(i * sizeof g), sizeof g, &g);
  }
}

void abbe_renderer_free_scene(abbe_renderer *r) {
  for (size_t i = 0; r->mesh != NULL && i < r->scene->object_count; i++) {
    r->gl->DeleteVertexArrays(1, &r->mesh[i].array);
    r->gl->DeleteBuffers(1, &r->mesh[i].vertices);
    r->gl->DeleteBuffers(1, &r->mesh[i].indices);
    r->gl->DeleteVertexArrays(1, &r->mesh[i].layer_array);
    r->gl->DeleteBuffers(1, &r->mesh[i].layer_indices);
  }
  free(r->mesh);
  free(r->lambda_nm);
}
