#include "gl/methods/pinholes/pinhole_pages.h"

#include "base/maths.h"
#include "gl/device/bindings.h"
#include "gl/device/float4.h"
#include "gl/scene/receiver_tiles.h"
#include "scenes/lights/environment_lights.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 2 };

typedef float row[4];

/* One axis of a chart's chart_page, as pinhole_map.glsl has it. */
typedef struct axis {
  double middle, wide, low, high;
} axis;

typedef struct chart_page {
  const double *parallelogram;
  size_t side;
  axis axes[2];
  row *place;   /* [side * side * ROWS] */
  double *off2; /* [side * side] m2, how far its texel is beside the chart */
} chart_page;

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
static void lay_face(chart_page *p, const abbe_mesh *mesh, const uint32_t f[3]) {
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

static void lay_chart(const abbe_gpu_scene *scene, size_t chart, chart_page *p) {
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
    chart_page p = {.side = side, .place = place + (i - first) * texels * ROWS, .off2 = off2};
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

/* Makes tiles of side x side texels, laid out as in pinhole_map.glsl; a texel beside its chart has
 * the nearest place of it. ABBE_GL, ABBE_NO_MEMORY. */
static abbe_result page_charts_make(const abbe_gpu_scene *scene, size_t side, abbe_page_charts *out,
                                    abbe_error *error) {
  *out = (abbe_page_charts){0};
  if (!find_closed(scene, out))
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for charts");
  ABBE_TRY(upload_places(scene, side, out, error));
  return upload_charts(scene, out, error);
}

static void page_charts_free(abbe_gpu *gpu, abbe_page_charts *charts) {
  abbe_gpu_drop_buffers(gpu, 1, &charts->places);
  abbe_gpu_drop_buffers(gpu, 1, &charts->rows);
  abbe_gpu_drop_buffers(gpu, 1, &charts->faces);
  gpu->gl->DeleteTextures(1, &charts->rows_texture);
  gpu->gl->DeleteTextures(1, &charts->face_texture);
  free(charts->closed);
  *charts = (abbe_page_charts){0};
}

/* The charts and their faces, where shaders expect them. */
static void page_charts_bind(abbe_gpu *gpu, const abbe_page_charts *charts) {
  gpu->gl->ActiveTexture(GL_TEXTURE0 + UNIT_CHART_ROWS);
  gpu->gl->BindTexture(GL_TEXTURE_BUFFER, charts->rows_texture);
  gpu->gl->ActiveTexture(GL_TEXTURE0 + UNIT_SIDE_OF_FACE);
  gpu->gl->BindTexture(GL_TEXTURE_BUFFER, charts->face_texture);
}

enum {
  UNIT = 5,
  PLACES_UNIT = 2,
  LEAST_SIDE = 16,
  MAP_TEXELS = 4,        /* texels of the spectral map, a side, for one of a tile; */
  SOFT_TEXELS = 16,      /* where refractors alone blur what they show */
  MOST_TEXELS = 1 << 22, /* texels of all tiles: many have fewer each */
  MOST_PAGES = 2048,     /* layers of an array, as OpenGL promises them */
  LEAST_CUBE = 16,
  MOST_CUBE = 512,
  GROUP = 32,  /* threads of a group, so that few texels are shared out as well */
  STRIDE = 4,  /* every fourth of the texels is taken first */
  SKY_UNIT = 4 /* for the camera; that of front and back layers, which there are none of then */
};

/* As sharp as what is around. */
static size_t cube_side(const abbe_radiance_map *map) {
  size_t side = LEAST_CUBE;
  while (side < MOST_CUBE && 4 * side < map->width) side *= 2;
  return side;
}

static abbe_result make_sky(const abbe_gpu_scene *scene, abbe_pinhole_sky *out, abbe_error *error) {
  const abbe_environment *e = scene->local->environment;
  abbe_radiance_map left;
  ABBE_TRY(e == NULL
               ? abbe_radiance_map_make(4 * LEAST_CUBE, &left, error) /* dark */
               : abbe_environment_lights_leave(e, scene->local->environment_lights, &left, error));
  abbe_result result = abbe_pinhole_sky_make(scene, &left, cube_side(&left), out, error);
  abbe_radiance_map_free(&left);
  return result;
}

/* Texels a side; of many tiles as many as memory allows. */
static size_t side_of(const abbe_plan *plan, size_t pages) {
  size_t side = plan->desc.map_size / (plan->mirror_count > 0 ? MAP_TEXELS : SOFT_TEXELS);
  while (side > LEAST_SIDE && side * side * pages > MOST_TEXELS) side /= 2;
  return side > LEAST_SIDE ? side : LEAST_SIDE;
}

static abbe_result check_count(const abbe_gpu_scene *scene, size_t pages, abbe_error *error) {
  if (pages <= MOST_PAGES) return ABBE_OK;
  return abbe_error_set(
      error, ABBE_UNSUPPORTED,
      "the receivers fall into %zu flat parts, and the transport 'pinhole' lights "
      "at most %d: use smoother meshes, or take the transport 'photons'",
      scene->charts.count, MOST_PAGES / 2);
}

static abbe_result make_programs(abbe_pinhole_pages *pages, const abbe_shader_variant *variant,
                                 abbe_error *error) {
  const abbe_plan *plan = pages->scene->plan;
  abbe_shader_variant follows = *variant;
  follows.exits = plan->eye_exits;
  follows.walk = true; /* also where the camera's rays need no such loop */
  char places[64] = "";
  if (plan->page_charts)
    snprintf(places, sizeof places, "#define PINHOLE_CHARTS\n#define RECEIVERS %zu\n",
             plan->parallelogram_count);
  ABBE_TRY(
      abbe_gpu_compute(pages->scene->gpu, "pinhole_select.comp", places, &pages->select, error));
  return abbe_shader_variant_compute(
      &follows, pages->scene->gpu, "pinhole_pages.comp",
      plan->desc.footprint == ABBE_FOOTPRINT_ON ? "#define FOOTPRINTS\n" : NULL, &pages->fill,
      error);
}

abbe_result abbe_pinhole_pages_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                                    abbe_pinhole_pages *out, abbe_error *error) {
  const abbe_render_desc *d = &scene->plan->desc;
  if (d->transport != ABBE_TRANSPORT_PINHOLE || out->scene != NULL) return ABBE_OK;
  out->scene = scene;
  out->count =
      2 * (scene->plan->page_charts ? scene->charts.count : scene->plan->parallelogram_count);
  out->side = side_of(scene->plan, out->count);
  ABBE_TRY(check_count(scene, out->count, error));
  ABBE_TRY(abbe_pinhole_samples_make(scene, false, &out->samples, error));
  if (scene->plan->page_charts) ABBE_TRY(page_charts_make(scene, out->side, &out->charts, error));
  ABBE_TRY(make_sky(scene, &out->sky, error));
  ABBE_TRY(abbe_gpu_make_texture(scene->gpu, GL_RGBA32F, out->side, out->side, out->count, true,
                                 &out->texture, error));
  for (int k = 0; k < 2; k++)
    ABBE_TRY(abbe_gpu_make_buffer(scene->gpu, ABBE_GPU_LIST_HEADER + 4 * out->side * out->side,
                                  NULL, &out->texels[k], error));
  out->order = malloc(out->side * out->side * sizeof *out->order);
  if (out->order == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for pages");
  return make_programs(out, variant, error);
}

void abbe_pinhole_pages_free(abbe_pinhole_pages *pages) {
  if (pages->scene == NULL) return;
  abbe_pinhole_samples_free(pages->scene->gpu, &pages->samples);
  abbe_pinhole_sky_free(pages->scene->gpu, &pages->sky);
  page_charts_free(pages->scene->gpu, &pages->charts);
  abbe_gpu_drop_buffers(pages->scene->gpu, 2, pages->texels);
  abbe_gpu_drop_textures(pages->scene->gpu, 1, &pages->texture);
  free(pages->order);
  *pages = (abbe_pinhole_pages){0};
}

/* Whether some of the refractors' bounds is before that side of a parallelogram. */
static bool sees_refractors(const abbe_gpu_scene *scene, const double p[9], bool back) {
  double n[3], to[3];
  abbe_vector_cross(p + 3, p + 6, n);
  abbe_vector_normalise(n);
  abbe_vector_subtract(scene->refractor_centre, p, to);
  return (back ? -1 : 1) * abbe_vector_dot(n, to) > -scene->refractor_radius;
}

/* Lists those of a tile's texels, `stride` apart, that do not follow from others, in texels[0]. */
static void select_texels(abbe_pinhole_pages *pages, size_t page, size_t stride,
                          const int first[2]) {
  abbe_gpu *gpu = pages->scene->gpu;
  const size_t across = (pages->side + stride - 1) / stride;
  gpu->gl->UseProgram(pages->select);
  abbe_gpu_set_int(gpu, pages->select, "page", (int)page);
  abbe_gpu_set_int(gpu, pages->select, "stride", (int)stride);
  gpu->gl->Uniform2i(gpu->gl->GetUniformLocation(pages->select, "first"), first[0], first[1]);
  abbe_gpu_clear_list(gpu, pages->texels[0]);
  abbe_gpu_bind_storage(gpu, BINDING_UNFINISHED, pages->texels[0]);
  abbe_gpu_dispatch_2d(gpu, pages->select, across, across);
}

static int by_place(const void *a, const void *b) {
  const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
  return (x > y) - (x < y);
}

/* Threads list texels as they come. In order those that go together lie together, and are always
 * the same: the last bit of what a rasteriser's lane samples hangs on its company. */
static void sort_texels(abbe_pinhole_pages *pages, GLuint list, size_t count) {
  const abbe_gl *gl = pages->scene->gpu->gl;
  const GLsizeiptr bytes = (GLsizeiptr)(count * sizeof *pages->order);
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, list);
  gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, ABBE_GPU_LIST_HEADER, bytes, pages->order);
  qsort(pages->order, count, sizeof *pages->order, by_place);
  gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, ABBE_GPU_LIST_HEADER, bytes, pages->order);
}

/* Fills a part of a tile's texels, until each has taken all that it needs. */
static abbe_result fill_texels(abbe_pinhole_pages *pages, size_t page, size_t stride,
                               const int first[2], abbe_error *error) {
  abbe_gpu *gpu = pages->scene->gpu;
  select_texels(pages, page, stride, first);
  gpu->gl->UseProgram(pages->fill);
  abbe_gpu_set_int(gpu, pages->fill, "page", (int)page);
  for (int now = 0;; now = 1 - now) {
    gpu->gl->MemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                           GL_BUFFER_UPDATE_BARRIER_BIT);
    const size_t count = abbe_gpu_read_count(gpu, pages->texels[now]);
    if (gpu->progress != NULL && !abbe_gpu_ask(gpu))
      return abbe_error_set(error, ABBE_CANCELLED, "the render was cancelled");
    if (count == 0) return ABBE_OK;
    sort_texels(pages, pages->texels[now], count);
    abbe_gpu_clear_list(gpu, pages->texels[1 - now]);
    abbe_gpu_bind_storage(gpu, BINDING_PAGE_TEXELS, pages->texels[now]);
    abbe_gpu_bind_storage(gpu, BINDING_UNFINISHED, pages->texels[1 - now]);
    abbe_gpu_dispatch(gpu, pages->fill, (count + GROUP - 1) / GROUP);
  }
}

/* Fills a tile's texels: first some far apart, then those between, columns, rows and crossings. */
static abbe_result fill_page(abbe_pinhole_pages *pages, size_t page, abbe_error *error) {
  static const int none[2] = {0, 0};
  abbe_result result = fill_texels(pages, page, STRIDE, none, error);
  for (int stride = STRIDE; stride > 1; stride /= 2)
    for (int k = 1; k < 4 && result == ABBE_OK; k++) {
      const int first[2] = {k & 1 ? stride / 2 : 0, k & 2 ? stride / 2 : 0};
      result = fill_texels(pages, page, (size_t)stride, first, error);
    }
  return result;
}

/* The tiles' charts, as the shaders count them: parallelograms before parts of meshes. What
 * encloses a space is not seen from inside. */
static abbe_result fill_pages(abbe_pinhole_pages *pages, abbe_error *error) {
  const abbe_gpu_scene *scene = pages->scene;
  const abbe_plan *plan = scene->plan;
  size_t page = 0;
  for (size_t i = 0; i < plan->receiver_count; i++) {
    if (plan->receiver_model[i] != ABBE_RECEIVER_EXACT) continue;
    const abbe_exact *exact = &scene->local->object[plan->receiver_object[i]].exact;
    for (size_t k = 0; k < 2 * exact->count; k++, page++)
      if (sees_refractors(scene, exact->parallelogram[k / 2], k % 2 != 0))
        ABBE_TRY(fill_page(pages, page, error));
  }
  for (; page < pages->count; page++)
    if (page % 2 == 0 || !pages->charts.closed[page / 2]) ABBE_TRY(fill_page(pages, page, error));
  return ABBE_OK;
}

static abbe_result clear(abbe_pinhole_pages *pages, abbe_error *error) {
  static const int all = -1;
  static const GLfloat nothing[4] = {0, 0, 0, 0};
  ABBE_TRY(abbe_gpu_set_target(pages->scene->gpu, &pages->texture, &all, 1, 0, pages->side,
                               pages->side, error));
  pages->scene->gpu->gl->ClearBufferfv(GL_COLOR, 0, nothing);
  return ABBE_OK;
}

/* What both programs read, into that which is in use. */
static void set_both(const abbe_pinhole_pages *pages, GLuint program) {
  const abbe_gpu_scene *scene = pages->scene;
  abbe_pinhole_sky_set(scene, &pages->sky, ABBE_PINHOLE_SKY_UNIT, program);
  if (scene->plan->page_charts)
    abbe_gpu_bind_texels(scene->gpu, program, "page_places", PLACES_UNIT, GL_RGBA32F,
                         pages->charts.places);
}

static void begin(abbe_pinhole_pages *pages) {
  const abbe_gpu_scene *scene = pages->scene;
  abbe_gpu *gpu = scene->gpu;
  const size_t clusters = scene->plan->desc.clusters;
  const double share = clusters == ABBE_RENDER_MAX_CLUSTERS ? 0 : 1 / (double)clusters;
  abbe_gpu_scene_bind(scene);
  gpu->gl->UseProgram(pages->select);
  set_both(pages, pages->select);
  abbe_gpu_set_float(gpu, pages->select, "smooth_share", share);
  gpu->gl->UseProgram(pages->fill);
  abbe_gpu_scene_set(scene, pages->fill);
  set_both(pages, pages->fill);
  abbe_pinhole_samples_bind(scene, &pages->samples, pages->fill);
  abbe_gpu_set_float(gpu, pages->fill, "share_limit", scene->plan->eye_share);
  abbe_gpu_set_float(gpu, pages->fill, "seen_off", 1e-4 * scene->refractor_radius);
  abbe_gpu_set_int(gpu, pages->fill, "node_count", (int)pages->samples.node_count);
  abbe_gpu_set_float(gpu, pages->fill, "cluster_share", share);
  gpu->gl->BindImageTexture(0, pages->texture, 0, GL_TRUE, 0, GL_READ_WRITE, GL_RGBA32F);
}

abbe_result abbe_pinhole_pages_run(abbe_pinhole_pages *pages, abbe_error *error) {
  if (pages->scene == NULL || pages->filled) return ABBE_OK;
  abbe_gpu_start_lap(pages->scene->gpu);
  ABBE_TRY(clear(pages, error));
  begin(pages);
  abbe_result result = fill_pages(pages, error);
  pages->filled = result == ABBE_OK && !pages->scene->gpu->stopped;
  pages->scene->gpu->gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  abbe_gpu_book_lap(pages->scene->gpu, ABBE_PASS_PINHOLES);
  return result;
}

void abbe_pinhole_pages_set(const abbe_pinhole_pages *pages, GLuint program) {
  if (pages->scene == NULL) return;
  abbe_gpu_bind_array(pages->scene->gpu, program, "pinhole_pages", UNIT, pages->texture);
  if (pages->scene->plan->page_charts) page_charts_bind(pages->scene->gpu, &pages->charts);
  if (pages->scene->plan->rough) abbe_pinhole_sky_set(pages->scene, &pages->sky, SKY_UNIT, program);
}
