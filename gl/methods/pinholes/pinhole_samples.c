#include "gl/methods/pinholes/pinhole_samples.h"

#include "base/maths.h"
#include "gl/device/float4.h"
#include "gl/scene/spectra/camera_bands.h"
#include "scenes/samples/surface_samples.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

abbe_result abbe_pinhole_sky_make(const abbe_gpu_scene *scene, const abbe_radiance_map *map,
                                  size_t side, abbe_pinhole_sky *out, abbe_error *error) {
  const abbe_render_desc *d = &scene->plan->desc;
  double matrix[9];
  abbe_radiance_cube cube;
  *out = (abbe_pinhole_sky){.side = side};
  const abbe_environment *around = scene->local->environment;
  abbe_result result = abbe_gpu_environment_colours(
      around != NULL ? &around->illuminant : abbe_scene_illuminant(scene->local),
      abbe_gpu_scene_working_space(scene), d, matrix, error);
  if (result == ABBE_OK) result = abbe_radiance_cube_make(map, side, &cube, error);
  if (result != ABBE_OK) return result;
  result = abbe_gpu_environment_cube(scene->gpu, &cube, matrix, &out->texture, error);
  abbe_radiance_cube_free(&cube);
  return result;
}

void abbe_pinhole_sky_free(abbe_gpu *gpu, abbe_pinhole_sky *sky) {
  abbe_gpu_drop_textures(gpu, 1, &sky->texture);
  *sky = (abbe_pinhole_sky){0};
}

void abbe_pinhole_sky_set(const abbe_gpu_scene *scene, const abbe_pinhole_sky *sky, int unit,
                          GLuint program) {
  abbe_gpu *gpu = scene->gpu;
  abbe_gpu_set_int(gpu, program, "pinhole_sky", unit);
  abbe_gpu_set_float(gpu, program, "sky_side", (double)sky->side);
  gpu->gl->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
  gpu->gl->BindTexture(GL_TEXTURE_2D, sky->texture);
}

enum { UNIT = 4, NODE_UNIT = 3, ROWS = ABBE_PINHOLE_ROWS, NODE_ROWS = ABBE_PINHOLE_NODE_ROWS };

typedef float row[4];

/* ---- what surfaces are like ---- */

abbe_result abbe_pinhole_samples_colours(const abbe_gpu_scene *scene, double (**out)[3],
                                         abbe_error *error) {
  const size_t count = scene->plan->refractor_count, set = scene->band_count;
  abbe_camera_band *band = calloc(count * ABBE_CAMERA_BAND_SETS * set + 1, sizeof *band);
  float(*texel)[4] = calloc(abbe_camera_bands_texels(scene->plan) + 1, sizeof *texel);
  double(*colour)[3] = calloc(count + 1, sizeof *colour), from_xyz[9], white[3];
  abbe_result result = band != NULL && texel != NULL && colour != NULL
                           ? ABBE_OK
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for bands");
  if (result == ABBE_OK)
    result = abbe_camera_bands_fill(scene->local, scene->plan, &scene->tables, band, texel, error);
  abbe_rgb_space_from_xyz(abbe_gpu_scene_working_space(scene), from_xyz);
  abbe_rgb_space_apply(from_xyz, scene->tables.camera.sum, white);
  for (size_t i = 0; result == ABBE_OK && i < count; i++) {
    double xyz[3] = {1, 1, 1};
    if (scene->plan->mirror[i])
      abbe_camera_bands_reflected(scene->plan, (const abbe_camera_band *)band,
                                  (const float(*)[4])texel, i, xyz);
    for (int k = 0; k < 3; k++) xyz[k] *= scene->tables.camera.sum[k];
    abbe_rgb_space_apply(from_xyz, xyz, colour[i]);
    for (int k = 0; k < 3; k++) colour[i][k] = scene->plan->mirror[i] ? colour[i][k] / white[k] : 1;
  }
  free(band);
  free(texel);
  if (result != ABBE_OK) free(colour);
  *out = result == ABBE_OK ? colour : NULL;
  return result;
}

/* Whether each of the plan's surfaces is seen from both sides: open mirrors are. Whether any is. */
static bool find_sheets(const abbe_gpu_scene *scene, bool *sheet) {
  const abbe_plan *plan = scene->plan;
  bool any = false;
  for (size_t i = 0; i < plan->refractor_count; i++) {
    const abbe_object *object = &scene->local->object[plan->refractor_object[i]];
    abbe_mesh_report report;
    sheet[i] = plan->mirror[i] && abbe_mesh_check(&object->mesh, &report, NULL) == ABBE_OK &&
               report.open_edges > 0;
    any = any || sheet[i];
  }
  return any;
}

/* From a ball's triangles onto the ball, which rays meet. */
static void move_to_sphere(const abbe_gpu_scene *scene, abbe_surface_point *p) {
  const size_t i = p->mesh;
  const abbe_exact *e = &scene->local->object[scene->plan->refractor_object[i]].exact;
  double from[3];
  if (scene->plan->model[i] != ABBE_REFRACTOR_SPHERE) return;
  abbe_vector_subtract(p->position, e->centre, from);
  if (!abbe_vector_normalise(from)) return;
  for (int k = 0; k < 3; k++) p->position[k] = e->centre[k] + e->radius * from[k];
  memcpy(p->normal, from, sizeof from);
}

/* ---- rows ---- */

static void store_sample(const abbe_surface_samples *s, const abbe_surface_curvature *c, size_t i,
                         double area, bool two_sides, const double colour[3], row *out) {
  const abbe_surface_point *p = &s->sample[i];
  const double half = 0.5 * s->spacing;
  abbe_float4_store(p->position, area, out[0]);
  abbe_float4_store(p->normal, two_sides ? -half : half, out[1]);
  abbe_float4_store(c->along[0], c->curvature[0], out[2]);
  abbe_float4_store(colour, c->curvature[1], out[3]);
}

/* Whole numbers stand as floats, which count so far. Of a sheet that is seen from both sides no
 * normal turns away; a cluster that holds some counts as if all were. */
static void store_node(const abbe_sample_node *node, bool two_sides, row *out) {
  abbe_float4_store(node->at.position, node->area, out[0]);
  abbe_float4_store(node->at.normal, node->radius, out[1]);
  out[2][0] = (float)(two_sides ? -1 : node->cone);
  out[2][1] = (float)node->next;
  out[2][2] = (float)node->sample;
  out[2][3] = node->cluster ? 1 : 0;
}

static abbe_result upload_nodes(const abbe_gpu_scene *scene, const abbe_surface_samples *s,
                                bool two_sides, abbe_pinhole_samples *out, abbe_error *error) {
  abbe_sample_tree tree = {0};
  abbe_result result = abbe_sample_tree_make(s, &tree, error);
  if (result != ABBE_OK) return result;
  row *rows = calloc(tree.count * NODE_ROWS + 1, sizeof *rows);
  if (rows == NULL) result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for pinholes");
  for (size_t i = 0; rows != NULL && i < tree.count; i++)
    store_node(&tree.node[i], two_sides, rows + NODE_ROWS * i);
  out->node_count = tree.count;
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(scene->gpu, tree.count * NODE_ROWS * sizeof *rows, rows,
                                  &out->nodes, error);
  free(rows);
  abbe_sample_tree_free(&tree);
  return result;
}

static abbe_result upload_samples(const abbe_gpu_scene *scene, bool published,
                                  const abbe_surface_samples *s, const bool *sheet,
                                  abbe_pinhole_samples *out, abbe_error *error) {
  row *rows = calloc(s->count * ROWS + 1, sizeof *rows);
  abbe_surface_curvature *curvature = calloc(s->count + 1, sizeof *curvature);
  double(*colour)[3] = NULL;
  abbe_result result = rows != NULL && curvature != NULL
                           ? abbe_surface_curvature_fit(s, curvature, error)
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for pinholes");
  if (result == ABBE_OK) result = abbe_pinhole_samples_colours(scene, &colour, error);
  for (size_t i = 0; result == ABBE_OK && i < s->count; i++)
    store_sample(s, &curvature[i], i, published ? s->area / (double)s->count : s->share[i],
                 sheet[s->sample[i].mesh], colour[s->sample[i].mesh], rows + ROWS * i);
  if (result == ABBE_OK)
    result =
        abbe_gpu_make_buffer(scene->gpu, s->count * ROWS * sizeof *rows, rows, &out->rows, error);
  free(rows);
  free(curvature);
  free(colour);
  return result;
}

static abbe_result upload(const abbe_gpu_scene *scene, bool published,
                          const abbe_surface_samples *s, abbe_pinhole_samples *out,
                          abbe_error *error) {
  ABBE_FREED bool *sheet = calloc(scene->plan->refractor_count + 1, sizeof *sheet);
  if (sheet == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for pinholes");
  const bool any = find_sheets(scene, sheet);
  ABBE_TRY(upload_samples(scene, published, s, sheet, out, error));
  if (!published) ABBE_TRY(upload_nodes(scene, s, any, out, error));
  return ABBE_OK;
}

uint64_t abbe_pinhole_samples_seed(const abbe_render_desc *d) {
  uint64_t seed = 0;
  for (int k = 0; k < 2 && d->history <= 1; k++)
    seed = seed * 0x9e3779b97f4a7c15u + (uint64_t)(int64_t)llrint(d->photon_shift[k] * 0x1p32);
  return seed;
}

abbe_result abbe_pinhole_samples_make(const abbe_gpu_scene *scene, bool published,
                                      abbe_pinhole_samples *out, abbe_error *error) {
  const abbe_plan *plan = scene->plan;
  const abbe_surface_sampling sampling = {.count = plan->desc.pinholes,
                                          .seed = abbe_pinhole_samples_seed(&plan->desc),
                                          .sided = !published,
                                          .even = !published};
  const abbe_mesh **mesh = calloc(plan->refractor_count + 1, sizeof *mesh);
  abbe_surface_samples s;
  *out = (abbe_pinhole_samples){0};
  if (mesh == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for pinholes");
  for (size_t i = 0; i < plan->refractor_count; i++)
    mesh[i] = &scene->local->object[plan->refractor_object[i]].mesh;
  abbe_result result = abbe_surface_samples_make(mesh, plan->refractor_count, &sampling, &s, error);
  free(mesh);
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < s.candidate_count; i++) move_to_sphere(scene, &s.candidate[i]);
  for (size_t i = 0; i < s.count; i++) move_to_sphere(scene, &s.sample[i]);
  out->count = s.count;
  out->area = s.area;
  out->spacing = s.spacing;
  result = upload(scene, published, &s, out, error);
  abbe_surface_samples_free(&s);
  return result;
}

void abbe_pinhole_samples_free(abbe_gpu *gpu, abbe_pinhole_samples *samples) {
  abbe_gpu_drop_buffers(gpu, 1, &samples->rows);
  abbe_gpu_drop_buffers(gpu, 1, &samples->nodes);
  *samples = (abbe_pinhole_samples){0};
}

void abbe_pinhole_samples_bind(const abbe_gpu_scene *scene, const abbe_pinhole_samples *samples,
                               GLuint program) {
  abbe_gpu_bind_texels(scene->gpu, program, "pinholes", UNIT, GL_RGBA32F, samples->rows);
  if (samples->nodes != 0)
    abbe_gpu_bind_texels(scene->gpu, program, "pinhole_nodes", NODE_UNIT, GL_RGBA32F,
                         samples->nodes);
}
