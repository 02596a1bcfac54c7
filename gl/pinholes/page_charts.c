#include "gl/pinholes/page_charts.h"

#include "gl/device/bindings.h"
#include "gl/device/float4.h"
#include "gl/scene/receiver_tiles.h"
#include "scenes/geometry/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 2 };

typedef float row[4];

/* One axis of a chart's page, as pinhole_map.glsl has it. */
typedef struct axis {
  double middle, wide, low, high;
} axis;

typedef struct page {
  const double *parallelogram;
  size_t side;
  axis axes[2];
  row *place;   /* [side * side * ROWS] */
  double *off2; /* [side * side] m2, how far its texel is beside the chart */
} page;

static void make_axis(const abbe_gpu_scene *scene, const double p[9], int k, axis *out) {
  const double *edge = p + 3 + 3 * k, squared = abbe_vector_dot(edge, edge);
  double from[3];
  abbe_vector_subtract(scene->refractor_centre, p, from);
  out->middle = abbe_vector_dot(from, edge) / squared;
  out->wide = fmax(scene->refractor_radius / sqrt(squared), 1e-4);
  out->low = asinh(-out->middle / out->wide);
  out->high = asinh((1 - out->middle) / out->wide);
}

static double to_page(const axis *a, double x) {
  return (asinh((x - a->middle) / a->wide) - a->low) / (a->high - a->low);
}

static double from_page(const axis *a, double t) {
  return a->middle + a->wide * sinh(a->low + t * (a->high - a->low));
}

/* The triangle's place at u, v of the chart, or that nearest to it, nearly; m2 off. False: it is
 * seen edge on. */
static bool nearest(const double (*corner)[2], const double at[2], const double size[2],
                    double weight[3], double *off2) {
  const double ax = corner[1][0] - corner[0][0], ay = corner[1][1] - corner[0][1];
  const double bx = corner[2][0] - corner[0][0], by = corner[2][1] - corner[0][1];
  const double x = at[0] - corner[0][0], y = at[1] - corner[0][1], area = ax * by - ay * bx;
  if (area == 0) return false;
  weight[1] = fmax((x * by - y * bx) / area, 0);
  weight[2] = fmax((ax * y - ay * x) / area, 0);
  const double rest = 1 - (x * by - y * bx) / area - (ax * y - ay * x) / area;
  weight[0] = fmax(rest, 0);
  const double sum = weight[0] + weight[1] + weight[2];
  *off2 = 0;
  for (int k = 0; k < 3; k++) weight[k] /= sum;
  for (int k = 0; k < 2; k++) {
    const double there =
        weight[0] * corner[0][k] + weight[1] * corner[1][k] + weight[2] * corner[2][k];
    *off2 += pow((there - at[k]) * size[k], 2);
  }
  return true;
}

/* The place and normal, to the side that the face is seen on. */
static void store(const abbe_mesh *mesh, const uint32_t f[3], const double weight[3], row *out) {
  double place[3] = {0}, normal[3] = {0}, face[3];
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < 3; k++) {
      place[k] += weight[c] * mesh->position[f[c]][k];
      normal[k] += weight[c] * mesh->normal[f[c]][k];
    }
  abbe_vector_triangle(mesh->position[f[0]], mesh->position[f[1]], mesh->position[f[2]], face);
  if (!abbe_vector_normalise(normal)) memcpy(normal, face, sizeof normal);
  abbe_vector_normalise(normal);
  const double side = abbe_vector_dot(normal, face) < 0 ? -1 : 1;
  for (int k = 0; k < 3; k++) normal[k] *= side;
  abbe_float4_store(place, 1, out[0]);
  abbe_float4_store(normal, 0, out[1]);
}

/* The face's texels, and one more around it. */
static void lay_face(page *p, const abbe_mesh *mesh, const uint32_t f[3]) {
  double corner[3][2], size[2];
  long range[2][2];
  for (int k = 0; k < 2; k++) {
    const double *edge = p->parallelogram + 3 + 3 * k;
    double low = INFINITY, high = -INFINITY;
    size[k] = abbe_vector_length(edge);
    for (int c = 0; c < 3; c++) {
      double from[3];
      abbe_vector_subtract(mesh->position[f[c]], p->parallelogram, from);
      corner[c][k] = abbe_vector_dot(from, edge) / (size[k] * size[k]);
      const double t = (double)p->side * to_page(&p->axes[k], corner[c][k]);
      low = fmin(low, t);
      high = fmax(high, t);
    }
    range[k][0] = (long)fmax(floor(low - 0.5) - 1, 0);
    range[k][1] = (long)fmin(ceil(high - 0.5) + 1, (double)p->side - 1);
  }
  for (long y = range[1][0]; y <= range[1][1]; y++)
    for (long x = range[0][0]; x <= range[0][1]; x++) {
      const size_t texel = (size_t)y * p->side + (size_t)x;
      const double at[2] = {from_page(&p->axes[0], ((double)x + 0.5) / (double)p->side),
                            from_page(&p->axes[1], ((double)y + 0.5) / (double)p->side)};
      double weight[3], off2;
      if (!nearest((const double(*)[2])corner, at, size, weight, &off2)) return;
      if (off2 >= p->off2[texel]) continue;
      p->off2[texel] = off2;
      store(mesh, f, weight, p->place + ROWS * texel);
    }
}

static void lay_chart(const abbe_gpu_scene *scene, size_t chart, page *p) {
  const abbe_plan *plan = scene->plan;
  const abbe_receiver_charts *charts = &scene->charts;
  p->parallelogram = charts->parallelogram[chart];
  for (int k = 0; k < 2; k++) make_axis(scene, p->parallelogram, k, &p->axes[k]);
  for (size_t i = 0; i < p->side * p->side; i++) p->off2[i] = INFINITY;
  for (size_t i = 0; i < plan->receiver_count; i++) {
    if (plan->receiver_object[i] != charts->object[chart]) continue;
    const abbe_mesh *mesh = &scene->local->object[plan->receiver_object[i]].mesh;
    const int32_t *side = charts->face_side + charts->face_first[i];
    for (size_t k = 0; k < mesh->face_count; k++)
      if ((size_t)side[k] / 2 == chart) lay_face(p, mesh, mesh->face[k]);
  }
}

static abbe_result upload_places(const abbe_gpu_scene *scene, size_t side, abbe_page_charts *out,
                                 abbe_error *error) {
  const size_t first = scene->plan->parallelogram_count, texels = side * side;
  const size_t rows = (scene->charts.count - first) * texels * ROWS;
  row *place = calloc(rows + 1, sizeof *place);
  double *off2 = calloc(texels + 1, sizeof *off2);
  abbe_result result = place != NULL && off2 != NULL
                           ? ABBE_OK
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for pages");
  for (size_t i = first; result == ABBE_OK && i < scene->charts.count; i++) {
    page p = {.side = side, .place = place + (i - first) * texels * ROWS, .off2 = off2};
    lay_chart(scene, i, &p);
  }
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(scene->gpu, rows * sizeof *place, place, &out->places, error);
  free(place);
  free(off2);
  return result;
}

/* As the tables of maps on receivers have them (gl/light/receiver_atlas.c): a tile of one texel of
 * all of the chart. */
static abbe_result upload_charts(const abbe_gpu_scene *scene, abbe_page_charts *out,
                                 abbe_error *error) {
  static const abbe_receiver_tile whole = {.window = {0, 1, 0, 1}, .rect = {0, 1, 0, 1}};
  const abbe_receiver_charts *charts = &scene->charts;
  float(*packed)[8] = calloc(charts->count + 1, sizeof *packed);
  if (packed == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for charts");
  for (size_t i = 0; i < charts->count; i++) {
    float tile[ABBE_TILE_FLOATS];
    abbe_receiver_tile_pack(&whole, charts->parallelogram[i], tile);
    memcpy(packed[i], tile, sizeof packed[i]);
  }
  abbe_result result =
      abbe_gpu_make_texels(scene->gpu, GL_RGBA32F, charts->count * sizeof *packed, packed,
                           UNIT_CHART_ROWS, &out->rows, &out->rows_texture, error);
  free(packed);
  if (result != ABBE_OK) return result;
  return abbe_gpu_make_texels(scene->gpu, GL_R32I, charts->face_count * sizeof *charts->face_side,
                              charts->face_side, UNIT_SIDE_OF_FACE, &out->faces, &out->face_texture,
                              error);
}

static bool find_closed(const abbe_gpu_scene *scene, abbe_page_charts *out) {
  const abbe_receiver_charts *charts = &scene->charts;
  out->closed = calloc(charts->count + 1, sizeof *out->closed);
  for (size_t i = 0; out->closed != NULL && i < charts->count; i++) {
    abbe_mesh_report report;
    const bool known = i > 0 && charts->object[i] == charts->object[i - 1];
    out->closed[i] = known ? out->closed[i - 1]
                           : abbe_mesh_check(&scene->local->object[charts->object[i]].mesh, &report,
                                             NULL) == ABBE_OK &&
                                 report.open_edges == 0;
  }
  return out->closed != NULL;
}

abbe_result abbe_page_charts_make(const abbe_gpu_scene *scene, size_t side, abbe_page_charts *out,
                                  abbe_error *error) {
  *out = (abbe_page_charts){0};
  if (!find_closed(scene, out))
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for charts");
  abbe_result result = upload_places(scene, side, out, error);
  return result == ABBE_OK ? upload_charts(scene, out, error) : result;
}

void abbe_page_charts_free(abbe_gpu *gpu, abbe_page_charts *charts) {
  abbe_gpu_drop_buffers(gpu, 1, &charts->places);
  abbe_gpu_drop_buffers(gpu, 1, &charts->rows);
  abbe_gpu_drop_buffers(gpu, 1, &charts->faces);
  gpu->gl->DeleteTextures(1, &charts->rows_texture);
  gpu->gl->DeleteTextures(1, &charts->face_texture);
  free(charts->closed);
  *charts = (abbe_page_charts){0};
}

void abbe_page_charts_bind(abbe_gpu *gpu, const abbe_page_charts *charts) {
  gpu->gl->ActiveTexture(GL_TEXTURE0 + UNIT_CHART_ROWS);
  gpu->gl->BindTexture(GL_TEXTURE_BUFFER, charts->rows_texture);
  gpu->gl->ActiveTexture(GL_TEXTURE0 + UNIT_SIDE_OF_FACE);
  gpu->gl->BindTexture(GL_TEXTURE_BUFFER, charts->face_texture);
}
