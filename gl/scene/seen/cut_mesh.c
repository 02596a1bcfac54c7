#include "gl/scene/seen/cut_mesh.h"

#include "scenes/geometry/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The least depth of a part times this is its greatest; how much wider than the window its outline is. */
static const double growth = 16, margin = 0.1;

/* A triangle's corners, one more for each of the two depths and four sides that bound a part. */
enum { MOST_CORNERS = 9, PLACE = 0, NORMAL = 3, UV = 6, NUMBERS = 8 };

typedef struct corner {
  double at[NUMBERS], depth;
  int64_t vertex; /* of the mesh, or -1 */
} corner;

typedef struct polygon {
  corner at[MOST_CORNERS];
  size_t count;
} polygon;

typedef struct cutter {
  const abbe_mesh *mesh;
  const abbe_view *view;
  abbe_mesh *out;
  uint32_t *face_of;
  size_t vertices, faces; /* there is room for */
} cutter;

static double depth_of(const abbe_view *view, const double p[3]) {
  double from[3];
  abbe_vector_subtract(p, view->origin, from);
  return abbe_vector_dot(from, view->forward);
}

/* Least and greatest depth of a face. */
static void depths_of(const cutter *c, size_t face, double range[2]) {
  range[0] = INFINITY;
  range[1] = -INFINITY;
  for (int k = 0; k < 3; k++) {
    const double z = depth_of(c->view, c->mesh->position[c->mesh->face[face][k]]);
    range[0] = fmin(range[0], z);
    range[1] = fmax(range[1], z);
  }
}

static bool grows(const abbe_view *view, const double range[2]) {
  return range[1] > growth * fmax(range[0], view->near);
}

/* In which step of depths, each growing so much from near on; -1: before them. */
static int step_of(const abbe_view *view, double depth) {
  return depth < view->near ? -1 : (int)floor(log(depth / view->near) / log(growth));
}

bool abbe_cut_mesh_needed(const abbe_mesh *mesh, const double min[3], const double max[3],
                          const abbe_view *view) {
  const cutter c = {.mesh = mesh, .view = view};
  double range[2] = {INFINITY, -INFINITY};
  for (int i = 0; i < 8; i++) {
    double p[3];
    for (int k = 0; k < 3; k++) p[k] = i >> k & 1 ? max[k] : min[k];
    const double z = depth_of(view, p);
    range[0] = fmin(range[0], z);
    range[1] = fmax(range[1], z);
  }
  if (view->orthographic || !grows(view, range)) return false;
  for (size_t i = 0; i < mesh->face_count; i++) {
    depths_of(&c, i, range);
    if (grows(view, range)) return true;
  }
  return false;
}

/* Between two corners, from the one that comes first by depth, so that it is the same for all faces that
 * share the edge. */
static corner between(const corner *a, const corner *b, double before, double behind) {
  corner out = {.vertex = -1};
  const bool turned = b->depth < a->depth;
  const corner *first = turned ? b : a, *last = turned ? a : b;
  const double from = turned ? behind : before, t = from / (from - (turned ? before : behind));
  for (int k = 0; k < NUMBERS; k++) out.at[k] = first->at[k] + t * (last->at[k] - first->at[k]);
  out.depth = first->depth + t * (last->depth - first->depth);
  return out;
}

/* How far a corner is inside a bound: of depth, or of a side of the window. */
typedef struct bound {
  const double *axis; /* NULL: of depth */
  double limit, sign;
} bound;

static double inside(const cutter *c, const bound *b, const corner *x) {
  double from[3];
  if (b->axis == NULL) return b->sign * (x->depth - b->limit);
  abbe_vector_subtract(x->at, c->view->origin, from);
  return b->sign * (abbe_vector_dot(from, b->axis) - b->limit * x->depth);
}

/* By Sutherland and Hodgman. */
static void clip(const cutter *c, const bound *b, polygon *p) {
  polygon kept = {.count = 0};
  for (size_t i = 0; i < p->count; i++) {
    const corner *from = &p->at[i], *to = &p->at[(i + 1) % p->count];
    const double before = inside(c, b, from), after = inside(c, b, to);
    if (before >= 0 && kept.count < MOST_CORNERS) kept.at[kept.count++] = *from;
    if ((before >= 0) == (after >= 0) || kept.count == MOST_CORNERS) continue;
    kept.at[kept.count] = between(from, to, before, after);
    if (b->axis == NULL) kept.at[kept.count].depth = b->limit;
    kept.count++;
  }
  *p = kept;
}

static void clip_to_window(const cutter *c, polygon *p) {
  const double *w = c->view->window;
  for (int k = 0; k < 4; k++) {
    const double wider = margin * (w[k | 1] - w[k & 2]), sign = k % 2 ? -1 : 1;
    const bound side = {k < 2 ? c->view->right : c->view->up, w[k] - sign * wider, sign};
    clip(c, &side, p);
  }
}

static corner corner_of(const cutter *c, uint32_t vertex) {
  corner out = {.vertex = vertex};
  memcpy(out.at + PLACE, c->mesh->position[vertex], sizeof *c->mesh->position);
  memcpy(out.at + NORMAL, c->mesh->normal[vertex], sizeof *c->mesh->normal);
  if (c->mesh->uv != NULL) memcpy(out.at + UV, c->mesh->uv[vertex], sizeof *c->mesh->uv);
  out.depth = depth_of(c->view, out.at);
  return out;
}

static bool grow(void **array, size_t count, size_t size) {
  void *more = realloc(*array, count * size);
  if (more != NULL) *array = more;
  return more != NULL;
}

static bool make_room(cutter *c, size_t vertices, size_t faces) {
  abbe_mesh *m = c->out;
  if (m->vertex_count + vertices > c->vertices) {
    const size_t room = 2 * (m->vertex_count + vertices);
    if (!grow((void **)&m->position, room, sizeof *m->position) ||
        !grow((void **)&m->normal, room, sizeof *m->normal) ||
        (c->mesh->uv != NULL && !grow((void **)&m->uv, room, sizeof *m->uv)))
      return false;
    c->vertices = room;
  }
  if (m->face_count + faces > c->faces) {
    const size_t room = 2 * (m->face_count + faces);
    if (!grow((void **)&m->face, room, sizeof *m->face) ||
        !grow((void **)&c->face_of, room, sizeof *c->face_of))
      return false;
    c->faces = room;
  }
  return true;
}

static uint32_t keep_corner(cutter *c, const corner *x) {
  abbe_mesh *m = c->out;
  if (x->vertex >= 0) return (uint32_t)x->vertex;
  memcpy(m->position[m->vertex_count], x->at + PLACE, sizeof *m->position);
  memcpy(m->normal[m->vertex_count], x->at + NORMAL, sizeof *m->normal);
  if (m->uv != NULL) memcpy(m->uv[m->vertex_count], x->at + UV, sizeof *m->uv);
  return (uint32_t)m->vertex_count++;
}

static bool keep_part(cutter *c, size_t face, const polygon *p) {
  uint32_t vertex[MOST_CORNERS];
  if (p->count < 3) return true;
  if (!make_room(c, p->count, p->count)) return false;
  for (size_t i = 0; i < p->count; i++) vertex[i] = keep_corner(c, &p->at[i]);
  for (size_t i = 1; i + 1 < p->count; i++) {
    const uint32_t corners[3] = {vertex[0], vertex[i], vertex[i + 1]};
    memcpy(c->out->face[c->out->face_count], corners, sizeof corners);
    c->face_of[c->out->face_count++] = (uint32_t)face;
  }
  return true;
}

/* Parts of the face that the view shows, step by step; of nothing before near. */
static bool cut_face(cutter *c, size_t face, int first, int last) {
  for (int step = first < 0 ? 0 : first; step <= last; step++) {
    const double low = c->view->near * pow(growth, step);
    const bound from = {NULL, low, 1}, to = {NULL, growth * low, -1};
    polygon p = {.count = 3};
    for (int k = 0; k < 3; k++) p.at[k] = corner_of(c, c->mesh->face[face][k]);
    if (step > first) clip(c, &from, &p);
    if (step < last) clip(c, &to, &p);
    clip_to_window(c, &p);
    if (!keep_part(c, face, &p)) return false;
  }
  return true;
}

static bool copy_vertices(cutter *c) {
  const abbe_mesh *m = c->mesh;
  if (!make_room(c, m->vertex_count, m->face_count)) return false;
  memcpy(c->out->position, m->position, m->vertex_count * sizeof *m->position);
  memcpy(c->out->normal, m->normal, m->vertex_count * sizeof *m->normal);
  if (m->uv != NULL) memcpy(c->out->uv, m->uv, m->vertex_count * sizeof *m->uv);
  c->out->vertex_count = m->vertex_count;
  return true;
}

/* Faces in one step as they are, or the others in parts. */
static bool keep_faces(cutter *c, bool parts) {
  for (size_t i = 0; i < c->mesh->face_count; i++) {
    double range[2];
    depths_of(c, i, range);
    const int first = step_of(c->view, range[0]), last = step_of(c->view, range[1]);
    if (parts != (first < last)) continue;
    if (parts ? !cut_face(c, i, first, last) : !make_room(c, 0, 1)) return false;
    if (parts) continue;
    memcpy(c->out->face[c->out->face_count], c->mesh->face[i], sizeof *c->mesh->face);
    c->face_of[c->out->face_count++] = (uint32_t)i;
  }
  return true;
}

abbe_result abbe_cut_mesh_make(const abbe_mesh *mesh, const abbe_view *view, abbe_mesh *out,
                               uint32_t **face_of, abbe_error *error) {
  cutter c = {.mesh = mesh, .view = view, .out = out};
  memset(out, 0, sizeof *out);
  *face_of = NULL;
  if (copy_vertices(&c) && keep_faces(&c, false) && keep_faces(&c, true)) {
    *face_of = c.face_of;
    return ABBE_OK;
  }
  abbe_mesh_free(out);
  free(c.face_of);
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for what the camera sees of a mesh");
}
