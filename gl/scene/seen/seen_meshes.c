#include "gl/scene/seen/seen_meshes.h"

#include "base/maths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

abbe_result abbe_refractor_faces_make(const abbe_gpu_scene *scene, abbe_refractor_faces *out,
                                      abbe_error *error) {
  static const abbe_program_stage stages[] = {{GL_VERTEX_SHADER, "surface.vert"},
                                              {GL_FRAGMENT_SHADER, "layer.frag"}};
  out->scene = scene;
  return abbe_gpu_program(scene->gpu, stages, 2, NULL, &out->program, error);
}

void abbe_refractor_faces_use(const abbe_refractor_faces *faces, const abbe_view *view) {
  const abbe_gl *gl = faces->scene->gpu->gl;
  const GLuint program = faces->program;
  double matrix[16];
  float clip[16];
  abbe_view_reversed_matrix(view, matrix);
  for (int k = 0; k < 16; k++) clip[k] = (float)matrix[k];
  gl->UseProgram(program);
  gl->UniformMatrix4fv(gl->GetUniformLocation(program, "view_projection"), 1, GL_FALSE, clip);
  gl->Uniform4f(gl->GetUniformLocation(program, "view_origin"), (float)view->origin[0],
                (float)view->origin[1], (float)view->origin[2], view->orthographic ? 0.0f : 1.0f);
  gl->Uniform3f(gl->GetUniformLocation(program, "view_forward"), (float)view->forward[0],
                (float)view->forward[1], (float)view->forward[2]);
}

static bool seen_meshes_is_cut(const abbe_seen_meshes *seen, size_t object) {
  return seen->cut[object].array != 0;
}

abbe_result abbe_refractor_faces_draw(const abbe_refractor_faces *faces,
                                      const abbe_faces_target *target, bool clear_alone,
                                      abbe_error *error) {
  static const GLuint nobody[4] = {0, 0, 0, 0};
  const abbe_gpu_scene *scene = faces->scene;
  const abbe_gl *gl = scene->gpu->gl;
  const GLfloat nothing[4] = {0, 0, 0, target->distance};
  const GLuint colour[2] = {target->layers, target->owner};
  const int layer[2] = {target->layer, target->owner_layer};
  const bool owners = !target->back;
  ABBE_TRY(abbe_gpu_set_target(scene->gpu, colour, layer, owners ? 2 : 1, target->depth,
                               target->width, target->height, error));
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  if (owners) gl->ClearBufferuiv(GL_COLOR, 1, nobody);
  if (clear_alone) return ABBE_OK;
  abbe_gpu_begin_depths(scene->gpu, true);
  gl->CullFace(target->back ? GL_FRONT : GL_BACK);
  for (size_t i = 0; i < scene->plan->refractor_count; i++) {
    if (scene->plan->mirror[i] || target->both)
      gl->Disable(GL_CULL_FACE); /* a mirror has two sides */
    else
      gl->Enable(GL_CULL_FACE);
    abbe_gpu_set_uint(scene->gpu, faces->program, "owner", i + 1);
    const size_t object = scene->plan->refractor_object[i];
    if (target->meshes != NULL && seen_meshes_is_cut(target->meshes, object))
      abbe_seen_meshes_draw(target->meshes, object);
    else if (target->coarse)
      abbe_gpu_meshes_draw_coarse(scene, object);
    else
      abbe_gpu_meshes_draw(scene, object);
  }
  gl->Disable(GL_CULL_FACE);
  abbe_gpu_end_depths(scene->gpu);
  return ABBE_OK;
}

/* The least depth of a part times this is its greatest; how much wider than the window its outline
 * is. */
static const double growth = 16, margin = 0.1;

/* A triangle's corners, one more for each of the two depths and four sides that bound a part. */
enum { MOST_CORNERS = 9, PLACE = 0, NORMAL = 3, UV = 6, NUMBERS = 8 };

typedef struct corner {
  double at[NUMBERS], depth;
  int64_t vertex; /* vertex of the mesh, or -1 */
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
  size_t vertices, faces; /* the capacity */
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

/* Between two corners, from the one that comes first by depth, so that it is the same for all faces
 * that share the edge. */
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

static abbe_result cut_object(abbe_seen_meshes *seen, const abbe_view *view, size_t i,
                              abbe_error *error) {
  const abbe_object *object = &seen->scene->local->object[i];
  ABBE_OWNED(abbe_mesh, cut) = {0};
  if (!abbe_cut_mesh_needed(&object->mesh, object->min, object->max, view)) return ABBE_OK;
  ABBE_TRY(abbe_cut_mesh_make(&object->mesh, view, &cut, &seen->face_of[i], error));
  return abbe_gpu_mesh_upload(seen->scene, &cut, &seen->cut[i], error);
}

abbe_result abbe_seen_meshes_make(const abbe_gpu_scene *scene, const abbe_view *view,
                                  abbe_seen_meshes *out, abbe_error *error) {
  const size_t count = scene->local->object_count;
  *out = (abbe_seen_meshes){.scene = scene,
                            .cut = calloc(count + 1, sizeof *out->cut),
                            .face_of = calloc(count + 1, sizeof *out->face_of),
                            .count = count};
  if (out->cut == NULL || out->face_of == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for what the camera sees");
  for (size_t i = 0; i < count; i++) ABBE_TRY(cut_object(out, view, i, error));
  return ABBE_OK;
}

void abbe_seen_meshes_free(abbe_seen_meshes *seen) {
  if (seen->scene == NULL) return;
  for (size_t i = 0; i < seen->count && seen->cut != NULL && seen->face_of != NULL; i++) {
    abbe_gpu_mesh_free(seen->scene, &seen->cut[i]);
    free(seen->face_of[i]);
  }
  free(seen->cut);
  free(seen->face_of);
  *seen = (abbe_seen_meshes){0};
}

void abbe_seen_meshes_draw(const abbe_seen_meshes *seen, size_t object) {
  const abbe_gl *gl = seen->scene->gpu->gl;
  if (!seen_meshes_is_cut(seen, object)) {
    abbe_gpu_meshes_draw(seen->scene, object);
    return;
  }
  gl->BindVertexArray(seen->cut[object].array);
  gl->DrawElements(GL_TRIANGLES, seen->cut[object].index_count, GL_UNSIGNED_INT, NULL);
}

/* Faces that follow one another at a time: parts of one face do not. */
void abbe_seen_meshes_draw_numbered(const abbe_seen_meshes *seen, size_t object, GLint location,
                                    size_t face_first) {
  const abbe_gl *gl = seen->scene->gpu->gl;
  const uint32_t *face_of = seen->face_of[object];
  const size_t count = (size_t)seen->cut[object].index_count / 3;
  gl->Uniform1i(location, (GLint)face_first);
  if (!seen_meshes_is_cut(seen, object)) {
    abbe_gpu_meshes_draw(seen->scene, object);
    return;
  }
  gl->BindVertexArray(seen->cut[object].array);
  for (size_t i = 0, end = 0; i < count; i = end) {
    for (end = i + 1; end < count && face_of[end] == face_of[end - 1] + 1; end++) continue;
    gl->Uniform1i(location, (GLint)(face_first + face_of[i]));
    gl->DrawElements(GL_TRIANGLES, (GLsizei)(3 * (end - i)), GL_UNSIGNED_INT,
                     (const void *)(uintptr_t)(3 * i * sizeof(GLuint)));
  }
}
