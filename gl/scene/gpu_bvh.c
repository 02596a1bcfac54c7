#include "gl/scene/gpu_scene.h"
#include "gl/scene/spectra/camera_bands.h"

#include "base/maths.h"
#include "base/thread/watch.h"
#include "gl/device/bindings.h"
#include "gl/device/float4.h"
#include "scenes/mesh/bvh.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The grid is a little wider than the tree, and boxes than what they hold by MARGIN cells: more
 * than what a ray that starts at the tree loses by rounding. */
enum { ASKED = 4096 }; /* over so many triangles it is asked whether the tree is wanted */
enum { TREE_TEXELS = 2, NODE_TEXELS = 3, GRID_LOW = 200, GRID_CELLS = 65000, CONE_UNIT = 32767 };
static const double MARGIN = 0.0625;

/* A triangle's unit normal as floats know it, to an angle of `unsure`; below 0: it has none at all.
 */
typedef struct facing {
  double n[3], unsure;
} facing;

typedef struct packer {
  const abbe_bvh *h;
  facing *facing; /* facing of each triangle, in the tree's order */
  size_t first_texel, first_triangle, texels;
  double low[3], cell[3];
  uint32_t (*out)[4];
} packer;

size_t abbe_bvh_nodes_count(const abbe_bvh *h) {
  return TREE_TEXELS + NODE_TEXELS * ((h->node_count - 1) / 2);
}

static uint32_t bits_of(double x) {
  float f = (float)x;
  uint32_t bits;
  memcpy(&bits, &f, sizeof bits);
  return bits;
}

static void lay_grid(packer *p) {
  const abbe_bvh_node *root = p->h->node;
  double widest = 0;
  for (int k = 0; k < 3; k++) widest = fmax(widest, (double)root->max[k] - (double)root->min[k]);
  for (int k = 0; k < 3; k++) {
    /* a flat tree has its depth, too, and what lies in a point is not divided by nothing */
    double wide = fmax((double)root->max[k] - (double)root->min[k], 1e-3 * widest);
    wide = fmax(wide, 1e-6 * fmax(fabs((double)root->min[k]), 1e-20));
    p->cell[k] = (double)(float)(wide / GRID_CELLS);
    p->low[k] = (double)(float)((double)root->min[k] - GRID_LOW * p->cell[k]);
    p->out[0][k] = bits_of(p->low[k]);
    p->out[1][k] = bits_of(p->cell[k]);
  }
}

static void pack_box(const packer *p, const abbe_bvh_node *n, uint32_t out[4]) {
  for (int k = 0; k < 3; k++) {
    double low = floor(((double)n->min[k] - p->low[k]) / p->cell[k] - MARGIN);
    double high = ceil(((double)n->max[k] - p->low[k]) / p->cell[k] + MARGIN);
    out[k] = (uint32_t)fmax(low, 0) | (uint32_t)fmin(high, 65535) << 16;
  }
}

static facing facing_of(const double t[9]) {
  facing out = {.unsure = -1};
  double e1[3], e2[3], *n = out.n;
  abbe_vector_subtract(t + 3, t, e1);
  abbe_vector_subtract(t + 6, t, e2);
  abbe_vector_cross(e1, e2, n);
  double length = sqrt(abbe_vector_dot(n, n));
  double edges = sqrt(abbe_vector_dot(e1, e1) * abbe_vector_dot(e2, e2));
  if (!(length > 16 * (double)FLT_EPSILON * edges)) return out;
  for (int k = 0; k < 3; k++) n[k] /= length;
  out.unsure = asin(fmin(8 * (double)FLT_EPSILON * edges / length, 1));
  return out;
}

/* The cone of the normals of so many triangles; one that is wider than this leaves nothing out. */
static void pack_cone(const packer *p, size_t first, size_t count, uint32_t out[2]) {
  static const double too_wide = 1.5;
  double axis[3] = {0, 0, 0}, widest = 0;
  bool all = true;
  for (size_t i = first; i < first + count && all; i++) {
    all = p->facing[i].unsure >= 0;
    for (int k = 0; k < 3; k++) axis[k] += all ? p->facing[i].n[k] : 0;
  }
  double length = sqrt(abbe_vector_dot(axis, axis)), snorm[3] = {0, 0, 0}, sine = CONE_UNIT;
  if (all && length > 0) {
    for (int k = 0; k < 3; k++) snorm[k] = round(axis[k] / length * CONE_UNIT);
    length = sqrt(abbe_vector_dot(snorm, snorm));
    for (size_t i = first; i < first + count && widest < too_wide; i++) {
      double cosine = abbe_vector_dot(snorm, p->facing[i].n) / length;
      widest = fmax(widest, acos(fmin(fmax(cosine, -1), 1)) + p->facing[i].unsure);
    }
    /* one more for what the shader's dot product loses */
    if (widest < too_wide) sine = fmin(ceil(length * sin(widest)) + 1, CONE_UNIT);
  }
  if (sine >= CONE_UNIT) snorm[0] = snorm[1] = snorm[2] = 0;
  uint16_t word[4];
  for (int k = 0; k < 3; k++) word[k] = (uint16_t)(int16_t)snorm[k];
  word[3] = (uint16_t)sine;
  out[0] = word[0] | (uint32_t)word[1] << 16;
  out[1] = word[2] | (uint32_t)word[3] << 16;
}

static size_t count_below(const abbe_bvh *h, const abbe_bvh_node *n, size_t *first) {
  if (n->count > 0) {
    *first = (size_t)n->first;
    return (size_t)n->count;
  }
  size_t behind, count = count_below(h, h->node + n->first, first);
  return count + count_below(h, h->node + n->first + 1, &behind);
}

/* Returns what the node leads to. */
static int32_t pack(packer *p, const abbe_bvh_node *n) {
  if (n->count > 0)
    return ~(int32_t)(((size_t)n->first + p->first_triangle) << 3 | (size_t)n->count);
  size_t at = p->texels;
  p->texels += NODE_TEXELS;
  for (size_t k = 0; k < 2; k++) {
    const abbe_bvh_node *child = p->h->node + n->first + k;
    size_t first, count = count_below(p->h, child, &first);
    if (count >= ASKED && !abbe_watch_goes_on()) return 0;
    pack_box(p, child, p->out[at + k]);
    pack_cone(p, first, count, p->out[at + 2] + 2 * k);
    p->out[at + k][3] = (uint32_t)pack(p, child);
  }
  return (int32_t)(p->first_texel + at);
}

abbe_result abbe_bvh_nodes_pack(const abbe_bvh *h, const double (*triangle)[9], size_t first_texel,
                                size_t first_triangle, uint32_t (*out)[4], abbe_error *error) {
  assert(h->node_count > 0);
  packer p = {.h = h,
              .facing = malloc((h->triangle_count + 1) * sizeof *p.facing),
              .first_texel = first_texel,
              .first_triangle = first_triangle,
              .texels = TREE_TEXELS,
              .out = out};
  if (p.facing == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a hierarchy");
  for (size_t i = 0; i < h->triangle_count; i++) p.facing[i] = facing_of(triangle[h->triangle[i]]);
  lay_grid(&p);
  out[1][3] = 0;
  out[0][3] = (uint32_t)pack(&p, h->node);
  free(p.facing);
  return abbe_watch_check(error);
}

/* What the shaders read of one triangle (hierarchy.glsl). Whole numbers stand as bits. */
typedef struct gpu_triangle {
  float corner[4], edge[2][4];
} gpu_triangle;

typedef struct gpu_corners {
  float normal[3][4], v_part[4];
} gpu_corners;

typedef struct forest {
  uint32_t (*texel)[4]; /* gpu_scene.h */
  gpu_triangle *triangle;
  gpu_corners *corners;
  size_t texel_count, triangle_count;
} forest;

static bool make_room(forest *f, size_t texels, size_t triangles) {
  void *texel = realloc(f->texel, (f->texel_count + texels) * sizeof *f->texel);
  if (texel != NULL) f->texel = texel;
  void *triangle = realloc(f->triangle, (f->triangle_count + triangles) * sizeof *f->triangle);
  if (triangle != NULL) f->triangle = triangle;
  void *corners = realloc(f->corners, (f->triangle_count + triangles) * sizeof *f->corners);
  if (corners != NULL) f->corners = corners;
  return texel != NULL && triangle != NULL && corners != NULL;
}

/* One tree's triangles: meshes one after another, their faces and smooth parts numbered through. */
typedef struct grove {
  const abbe_mesh **mesh;
  uint32_t *surface, *face_first; /* for each mesh; face_first has one more */
  const int32_t **side;           /* sides of each mesh's faces (gpu_scene.h), or NULL */
  const abbe_coatings *films;     /* of the one mesh, or NULL; the first has number first_film */
  uint32_t first_film;
  size_t mesh_count;
  uint32_t *owner, *part; /* for each face: its mesh, and which part */
} grove;

static void store_bits(uint32_t bits, float *out) {
  memcpy(out, &bits, sizeof bits);
}

static void store_triangle(const grove *g, uint32_t face, gpu_triangle *t, gpu_corners *c) {
  const uint32_t m = g->owner[face];
  const abbe_mesh *mesh = g->mesh[m];
  const uint32_t *f = mesh->face[face - g->face_first[m]];
  const double *a = mesh->position[f[0]];
  abbe_float4_store(a, 0, t->corner);
  for (int e = 0; e < 2; e++) {
    double edge[3];
    for (int k = 0; k < 3; k++) edge[k] = mesh->position[f[e + 1]][k] - a[k];
    abbe_float4_store(edge, 0, t->edge[e]);
  }
  store_bits(g->part[face], &t->corner[3]);
  store_bits(g->surface[m], &t->edge[0][3]);
  const uint32_t film = g->films == NULL ? 0 : g->films->face == NULL ? 1 : g->films->face[face];
  if (film > 0) store_bits(g->first_film + film, &t->edge[1][3]); /* 0: bare */
  if (g->side[m] != NULL)
    store_bits((uint32_t)g->side[m][face - g->face_first[m]] / 2, &t->edge[1][3]);
  memset(c->v_part, 0, sizeof c->v_part);
  for (int k = 0; k < 3; k++) {
    abbe_float4_store(mesh->normal[f[k]], mesh->uv != NULL ? (float)mesh->uv[f[k]][0] : 0,
                      c->normal[k]);
    if (mesh->uv != NULL) c->v_part[k] = (float)mesh->uv[f[k]][1];
  }
}

/* The tree behind the others; its root's texel. */
static abbe_result plant(const grove *g, const double (*triangle)[9], const abbe_bvh *h, forest *f,
                         size_t *root, abbe_error *error) {
  const size_t texels = abbe_bvh_nodes_count(h);
  if (!make_room(f, texels, h->triangle_count))
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a hierarchy");
  *root = f->texel_count;
  ABBE_TRY(abbe_bvh_nodes_pack(h, triangle, f->texel_count, f->triangle_count,
                               f->texel + f->texel_count, error));
  for (size_t i = 0; i < h->triangle_count; i++)
    store_triangle(g, h->triangle[i], &f->triangle[f->triangle_count + i],
                   &f->corners[f->triangle_count + i]);
  f->texel_count += texels;
  f->triangle_count += h->triangle_count;
  return ABBE_OK;
}

/* Corners and parts of all meshes; false: no memory. */
static bool gather(grove *g, double (*triangle)[9]) {
  size_t parts = 0;
  for (size_t m = 0; m < g->mesh_count; m++) {
    const size_t first = g->face_first[m], count = g->mesh[m]->face_count;
    double(*corners)[9] = abbe_bvh_triangles(g->mesh[m]);
    const size_t own = abbe_bvh_parts(g->mesh[m], g->part + first);
    if (corners != NULL) memcpy(triangle + first, corners, count * sizeof *triangle);
    free(corners);
    if (corners == NULL || own == 0) return false;
    for (size_t i = 0; i < count; i++) {
      g->part[first + i] += (uint32_t)parts;
      g->owner[first + i] = (uint32_t)m;
    }
    parts += own;
  }
  return true;
}

static abbe_result grow(abbe_gpu_scene *scene, grove *g, forest *f, size_t *root,
                        abbe_error *error) {
  const size_t faces = g->face_first[g->mesh_count];
  abbe_bvh h = {0};
  double(*triangle)[9] = calloc(faces + 1, sizeof *triangle);
  g->part = calloc(faces + 1, sizeof *g->part);
  g->owner = calloc(faces + 1, sizeof *g->owner);
  abbe_result result =
      triangle == NULL || g->part == NULL || g->owner == NULL || !gather(g, triangle)
          ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a hierarchy")
          : abbe_bvh_make((const double(*)[9])triangle, faces, &h, error);
  if (result == ABBE_OK) result = abbe_watch_check(error);
  if (result == ABBE_OK) result = plant(g, (const double(*)[9])triangle, &h, f, root, error);
  if (h.depth > scene->bvh_depth) scene->bvh_depth = h.depth;
  abbe_bvh_free(&h);
  free(triangle);
  free(g->part);
  free(g->owner);
  return result;
}

/* Shaders have a leaf's first triangle and how many there are, below eight, in one number. */
enum { MOST_TRIANGLES = INT32_MAX / 8 };

static abbe_result add_mesh(grove *g, const forest *f, const abbe_mesh *mesh, size_t surface,
                            const int32_t *side, abbe_error *error) {
  const size_t first = g->face_first[g->mesh_count];
  if (f->triangle_count + first + mesh->face_count > MOST_TRIANGLES)
    return abbe_error_set(error, ABBE_UNSUPPORTED, "the scene has more than %d triangles",
                          MOST_TRIANGLES);
  g->mesh[g->mesh_count] = mesh;
  g->side[g->mesh_count] = side;
  g->surface[g->mesh_count++] = (uint32_t)surface;
  g->face_first[g->mesh_count] = (uint32_t)(first + mesh->face_count);
  return ABBE_OK;
}

/* A buffer that the shaders read as a texture of vec4. */
static abbe_result upload_texels(abbe_gpu_scene *scene, int which, GLenum format, size_t size,
                                 const void *data, abbe_error *error) {
  GLint most = 0;
  scene->gpu->gl->GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (size / 16 > (size_t)most)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the meshes that light is traced through take %zu texels in a buffer; "
                          "this OpenGL reads at most %d: use smaller meshes, or "
                          "the model 'layers' for those that refract",
                          size / 16, most);
  return abbe_gpu_make_texels(scene->gpu, format, size, data, UNIT_BVH_NODES + which,
                              &scene->bvh[which], &scene->bvh_texture[which], error);
}

static abbe_result upload(abbe_gpu_scene *scene, const forest *f, abbe_error *error) {
  ABBE_TRY(
      upload_texels(scene, 0, GL_RGBA32UI, f->texel_count * sizeof *f->texel, f->texel, error));
  ABBE_TRY(upload_texels(scene, 1, GL_RGBA32F, f->triangle_count * sizeof *f->triangle, f->triangle,
                         error));
  return upload_texels(scene, 2, GL_RGBA32F, f->triangle_count * sizeof *f->corners, f->corners,
                       error);
}

/* A tree for each mesh that refracts. */
static abbe_result grow_refractors(abbe_gpu_scene *scene, grove *g, forest *f, abbe_error *error) {
  for (size_t i = 0; i < scene->plan->refractor_count; i++) {
    if (scene->plan->model[i] != ABBE_REFRACTOR_BVH) continue;
    g->mesh_count = 0;
    g->films = abbe_film_tables_of(scene->local, scene->plan, i, &g->first_film);
    ABBE_TRY(add_mesh(g, f, &scene->local->object[scene->plan->refractor_object[i]].mesh, 0, NULL,
                      error));
    ABBE_TRY(grow(scene, g, f, &scene->refractor_root[i], error));
    if (scene->gpu->software)
      ABBE_TRY(abbe_ray_trees_add(&scene->trees, (const uint32_t(*)[4])f->texel,
                                  scene->refractor_root[i], &scene->refractor_tree[i], error));
  }
  return ABBE_OK;
}

/* One tree for all receivers that are traversed. */
static abbe_result grow_receivers(abbe_gpu_scene *scene, grove *g, forest *f, abbe_error *error) {
  if (scene->plan->receivers != ABBE_RECEIVER_BVH) return ABBE_OK;
  g->mesh_count = 0;
  g->films = NULL;
  for (size_t i = 0; i < scene->plan->receiver_count; i++) {
    const abbe_mesh *mesh = &scene->local->object[scene->plan->receiver_object[i]].mesh;
    const int32_t *side = scene->charts.face_side != NULL
                              ? scene->charts.face_side + scene->charts.face_first[i]
                              : NULL;
    if (scene->plan->receiver_model[i] == ABBE_RECEIVER_BVH)
      ABBE_TRY(add_mesh(g, f, mesh, i, side, error));
  }
  return grow(scene, g, f, &scene->receiver_root, error);
}

abbe_result abbe_gpu_bvh_make(abbe_gpu_scene *scene, abbe_error *error) {
  const size_t most = scene->local->object_count + 1;
  forest f = {0};
  if (!scene->plan->bvh && scene->plan->receivers != ABBE_RECEIVER_BVH) return ABBE_OK;
  scene->refractor_root = calloc(most, sizeof *scene->refractor_root);
  scene->refractor_tree = calloc(most, sizeof *scene->refractor_tree);
  grove g = {.mesh = calloc(most, sizeof *g.mesh),
             .surface = calloc(most, sizeof *g.surface),
             .side = calloc(most, sizeof *g.side),
             .face_first = calloc(most, sizeof *g.face_first)};
  abbe_result result = scene->refractor_root == NULL || scene->refractor_tree == NULL ||
                               g.mesh == NULL || g.surface == NULL || g.side == NULL ||
                               g.face_first == NULL
                           ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a hierarchy")
                           : grow_refractors(scene, &g, &f, error);
  if (result == ABBE_OK) result = grow_receivers(scene, &g, &f, error);
  if (result == ABBE_OK) result = upload(scene, &f, error);
  free(g.mesh);
  free(g.surface);
  free(g.side);
  free(g.face_first);
  free(f.texel);
  free(f.triangle);
  free(f.corners);
  return result;
}
