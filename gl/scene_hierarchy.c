#include "gl/renderer_state.h"
#include "scenes/hierarchy.h"

#include <stdlib.h>
#include <string.h>

/* What the shaders read of one triangle (hierarchy.glsl). */
typedef struct gpu_triangle {
  float corner[4], edge[2][4];
} gpu_triangle;

typedef struct gpu_corners {
  float normal[3][4], v_part[4];
} gpu_corners;

typedef struct forest {
  abbe_hierarchy_node *node;
  gpu_triangle *triangle;
  gpu_corners *corners;
  size_t node_count, triangle_count;
} forest;

static void store(const double v[3], float w, float out[4]) {
  for (int k = 0; k < 3; k++) out[k] = (float)v[k];
  out[3] = w;
}

static bool make_room(forest *f, size_t nodes, size_t triangles) {
  void *node = realloc(f->node, (f->node_count + nodes) * sizeof *f->node);
  if (node != NULL) f->node = node;
  void *triangle = realloc(f->triangle, (f->triangle_count + triangles) * sizeof *f->triangle);
  if (triangle != NULL) f->triangle = triangle;
  void *corners = realloc(f->corners, (f->triangle_count + triangles) * sizeof *f->corners);
  if (corners != NULL) f->corners = corners;
  return node != NULL && triangle != NULL && corners != NULL;
}

static void store_triangle(const abbe_mesh *mesh, uint32_t face, uint32_t part, gpu_triangle *t,
                           gpu_corners *c) {
  const uint32_t *f = mesh->face[face];
  const double *a = mesh->position[f[0]];
  float bits;
  memcpy(&bits, &part, sizeof bits);
  store(a, bits, t->corner);
  for (int e = 0; e < 2; e++) {
    double edge[3];
    for (int k = 0; k < 3; k++) edge[k] = mesh->position[f[e + 1]][k] - a[k];
    store(edge, 0, t->edge[e]);
  }
  memset(c->v_part, 0, sizeof c->v_part);
  for (int k = 0; k < 3; k++) {
    store(mesh->normal[f[k]], mesh->uv != NULL ? (float)mesh->uv[f[k]][0] : 0, c->normal[k]);
    if (mesh->uv != NULL) c->v_part[k] = (float)mesh->uv[f[k]][1];
  }
}

/* One mesh's tree behind the others; its root's index. */
static abbe_result plant(const abbe_mesh *mesh, const abbe_hierarchy *h, const uint32_t *part,
                         forest *f, size_t *root, abbe_error *error) {
  if (!make_room(f, h->node_count + 1, h->triangle_count))
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a hierarchy");
  *root = f->node_count;
  for (size_t i = 0; i < h->node_count; i++) {
    abbe_hierarchy_node *n = &f->node[f->node_count + i];
    *n = h->node[i];
    n->first += (int32_t)(n->count > 0 ? f->triangle_count : f->node_count);
  }
  for (size_t i = 0; i < h->triangle_count; i++)
    store_triangle(mesh, h->triangle[i], part[h->triangle[i]], &f->triangle[f->triangle_count + i],
                   &f->corners[f->triangle_count + i]);
  f->node_count += h->node_count;
  f->triangle_count += h->triangle_count;
  return ABBE_OK;
}

static abbe_result add_mesh(abbe_renderer *r, const abbe_mesh *mesh, forest *f, size_t *root,
                            abbe_error *error) {
  abbe_hierarchy h = {0};
  double(*triangle)[9] = abbe_hierarchy_triangles(mesh);
  uint32_t *part = calloc(mesh->face_count + 1, sizeof *part);
  abbe_result result =
      triangle == NULL || part == NULL || abbe_hierarchy_parts(mesh, part) == 0
          ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a hierarchy")
          : abbe_hierarchy_make((const double(*)[9])triangle, mesh->face_count, &h, error);
  if (result == ABBE_OK) result = plant(mesh, &h, part, f, root, error);
  if (h.depth > r->hierarchy_depth) r->hierarchy_depth = h.depth;
  abbe_hierarchy_free(&h);
  free(triangle);
  free(part);
  return result;
}

/* A buffer that the shaders read as a texture of vec4. */
static abbe_result upload_texels(abbe_renderer *r, int which, size_t size, const void *data,
                                 abbe_error *error) {
  const abbe_gl *gl = r->gl;
  GLint most = 0;
  gl->GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (size / 16 > (size_t)most)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the meshes that light is traced through take %zu texels in a buffer; "
                          "this OpenGL reads at most %d: use smaller meshes or the model 'layers'",
                          size / 16, most);
  abbe_result result = abbe_renderer_make_buffer(r, size, data, &r->hierarchy[which], error);
  if (result != ABBE_OK) return result;
  gl->GenTextures(1, &r->hierarchy_texture[which]);
  gl->BindTexture(GL_TEXTURE_BUFFER, r->hierarchy_texture[which]);
  gl->TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, r->hierarchy[which]);
  return abbe_gl_check(gl, "the upload of a hierarchy", error);
}

static abbe_result upload(abbe_renderer *r, const forest *f, abbe_error *error) {
  abbe_result result = upload_texels(r, 0, f->node_count * sizeof *f->node, f->node, error);
  if (result == ABBE_OK)
    result = upload_texels(r, 1, f->triangle_count * sizeof *f->triangle, f->triangle, error);
  if (result == ABBE_OK)
    result = upload_texels(r, 2, f->triangle_count * sizeof *f->corners, f->corners, error);
  return result;
}

abbe_result abbe_renderer_make_hierarchy(abbe_renderer *r, abbe_error *error) {
  abbe_result result = ABBE_OK;
  forest f = {0};
  if (!r->plan.hierarchy) return ABBE_OK;
  r->refractor_root = calloc(r->plan.refractor_count + 1, sizeof *r->refractor_root);
  if (r->refractor_root == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a hierarchy");
  for (size_t i = 0; i < r->plan.refractor_count && result == ABBE_OK; i++) {
    const abbe_object *object = &r->scene->object[r->plan.refractor_object[i]];
    if (r->plan.model[i] == ABBE_REFRACTOR_HIERARCHY)
      result = add_mesh(r, &object->mesh, &f, &r->refractor_root[i], error);
  }
  if (result == ABBE_OK) result = upload(r, &f, error);
  free(f.node);
  free(f.triangle);
  free(f.corners);
  return result;
}
