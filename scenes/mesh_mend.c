/* Mending: a mesh as points and faces, on which the steps work until it is closed and outwards. */
#include "scenes/mesh.h"
#include "scenes/topology.h"
#include "scenes/vector.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Holes that bend are closed only where their rim is shorter than this share of the bounds'
 * diagonal, flat ones of any size where every point is this near the plane of the rim. */
#define SMALL_HOLE 0.15
#define FLAT_HOLE 0.01

typedef struct mending {
  size_t repeated, slivers, turned, holes, inverted;
} mending;

/* The mesh with one vertex a point, which later steps may change. */
static abbe_result welded(const abbe_topology *t, abbe_mesh *out, abbe_error *error) {
  abbe_result result = abbe_mesh_make(t->point_count, t->face_count, false, out, error);
  if (result != ABBE_OK) return result;
  memcpy(out->position, t->position, t->point_count * sizeof *out->position);
  memcpy(out->face, t->face, t->face_count * sizeof *out->face);
  return ABBE_OK;
}

static bool repeats(const uint32_t f[3]) {
  return f[0] == f[1] || f[1] == f[2] || f[2] == f[0];
}

static void drop_repeated(abbe_mesh *mesh, mending *done) {
  size_t kept = 0;
  for (size_t f = 0; f < mesh->face_count; f++) {
    if (repeats(mesh->face[f]))
      done->repeated++;
    else
      memmove(mesh->face[kept++], mesh->face[f], sizeof mesh->face[0]);
  }
  mesh->face_count = kept;
}

/* The corner opposite the longest side of a face without area; -1 for a sound face. */
static int sliver_tip(const abbe_mesh *mesh, const uint32_t f[3]) {
  double n[3], side[3], longest = 0.0;
  int tip = 0;
  abbe_vector_triangle(mesh->position[f[0]], mesh->position[f[1]], mesh->position[f[2]], n);
  for (int k = 0; k < 3; k++) {
    abbe_vector_subtract(mesh->position[f[(k + 1) % 3]], mesh->position[f[k]], side);
    const double squared = abbe_vector_dot(side, side);
    if (squared > longest) longest = squared, tip = (k + 2) % 3;
  }
  return abbe_vector_length(n) > 1e-9 * longest ? -1 : tip;
}

/* Turns the longest side of the sliver f, which its neighbour g shares, into the edge between
 * their far corners: the neighbour is split where the sliver's tip lies on it. */
static bool flip_sliver(abbe_mesh *mesh, const abbe_topology *t, uint32_t f, int tip) {
  const uint32_t e = t->face_edge[f][(tip + 1) % 3];
  if (e == ABBE_TOPOLOGY_NONE || t->edge[e].along != 1 || t->edge[e].against != 1) return false;
  const uint32_t g = t->edge[e].face[0] == f ? t->edge[e].face[1] : t->edge[e].face[0];
  const uint32_t a = mesh->face[f][(tip + 1) % 3], b = mesh->face[f][(tip + 2) % 3];
  const uint32_t c = mesh->face[f][tip];
  uint32_t d = ABBE_TOPOLOGY_NONE;
  for (int k = 0; k < 3; k++)
    if (mesh->face[g][k] != a && mesh->face[g][k] != b) d = mesh->face[g][k];
  if (d == ABBE_TOPOLOGY_NONE || d == c) return false;
  const uint32_t first[3] = {c, a, d}, second[3] = {c, d, b};
  memcpy(mesh->face[f], first, sizeof first);
  memcpy(mesh->face[g], second, sizeof second);
  return true;
}

static abbe_result flip_slivers(abbe_mesh *mesh, mending *done, abbe_error *error) {
  for (int pass = 0; pass < 8; pass++) {
    abbe_topology t;
    const abbe_result result = abbe_topology_make(mesh, &t, error);
    if (result != ABBE_OK) return result;
    bool *touched = calloc(mesh->face_count + 1, sizeof *touched);
    if (!touched) {
      abbe_topology_free(&t);
      return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to mend a mesh");
    }
    size_t flipped = 0;
    for (size_t f = 0; f < mesh->face_count; f++) {
      const int tip = touched[f] ? -1 : sliver_tip(mesh, mesh->face[f]);
      if (tip < 0) continue;
      const uint32_t e = t.face_edge[f][(tip + 1) % 3];
      const uint32_t *pair = e == ABBE_TOPOLOGY_NONE ? NULL : t.edge[e].face;
      if (!pair || pair[1] == ABBE_TOPOLOGY_NONE || touched[pair[0]] || touched[pair[1]]) continue;
      if (!flip_sliver(mesh, &t, (uint32_t)f, tip)) continue;
      touched[pair[0]] = touched[pair[1]] = true;
      flipped++;
    }
    free(touched);
    abbe_topology_free(&t);
    done->slivers += flipped;
    if (flipped == 0) break;
  }
  return ABBE_OK;
}

static void turn(abbe_mesh *mesh, size_t f) {
  const uint32_t second = mesh->face[f][1];
  mesh->face[f][1] = mesh->face[f][2];
  mesh->face[f][2] = second;
}

/* Whether face f runs along edge e from its lower point to its higher. */
static bool runs_along(const abbe_topology *t, uint32_t f, uint32_t e) {
  for (int k = 0; k < 3; k++)
    if (t->face_edge[f][k] == e) return t->face[f][k] == t->edge[e].a;
  return false;
}

/* Walks from face to face over edges with two faces and marks in side[] which agree with the
 * first (1) and which must turn (2); queue has room for every face. Returns how many it met. */
static size_t walk(const abbe_topology *t, uint32_t first, unsigned char *side, uint32_t *queue) {
  size_t head = 0, tail = 0;
  queue[tail++] = first;
  side[first] = 1;
  while (head < tail) {
    const uint32_t f = queue[head++];
    for (int k = 0; k < 3; k++) {
      const uint32_t e = t->face_edge[f][k];
      if (e == ABBE_TOPOLOGY_NONE || t->edge[e].along + t->edge[e].against != 2) continue;
      const uint32_t g = t->edge[e].face[0] == f ? t->edge[e].face[1] : t->edge[e].face[0];
      if (side[g]) continue;
      side[g] = runs_along(t, f, e) != runs_along(t, g, e) ? side[f] : (unsigned char)(3 - side[f]);
      queue[tail++] = g;
    }
  }
  return tail;
}

static abbe_result make_consistent(abbe_mesh *mesh, mending *done, abbe_error *error) {
  abbe_topology t;
  const abbe_result result = abbe_topology_make(mesh, &t, error);
  if (result != ABBE_OK) return result;
  unsigned char *side = calloc(mesh->face_count + 1, 1);
  uint32_t *queue = malloc((mesh->face_count + 1) * sizeof *queue);
  if (side && queue) {
    for (size_t f = 0; f < mesh->face_count; f++) {
      if (side[f]) continue;
      const size_t met = walk(&t, (uint32_t)f, side, queue);
      size_t against = 0;
      for (size_t i = 0; i < met; i++) against += side[queue[i]] == 2;
      const unsigned char minority = 2 * against > met ? 1 : 2;
      for (size_t i = 0; i < met; i++)
        if (side[queue[i]] == minority) turn(mesh, queue[i]), done->turned++;
    }
  }
  const bool ok = side && queue;
  free(side);
  free(queue);
  abbe_topology_free(&t);
  return ok ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory to mend a mesh");
}

/* next[p] is the point after p on the rim of a hole; ABBE_TOPOLOGY_NONE off every rim; points
 * where rims touch are marked with their own number, which no rim passes. */
static uint32_t *find_rims(const abbe_topology *t) {
  uint32_t *next = malloc((t->point_count + 1) * sizeof *next);
  if (!next) return NULL;
  memset(next, 0xff, (t->point_count + 1) * sizeof *next);
  for (size_t e = 0; e < t->edge_count; e++) {
    const abbe_edge *edge = &t->edge[e];
    if (edge->along + edge->against != 1) continue;
    const uint32_t from = edge->along ? edge->b : edge->a, to = edge->along ? edge->a : edge->b;
    next[from] = next[from] == ABBE_TOPOLOGY_NONE ? to : from;
  }
  return next;
}

/* Length of the rim through start, its points in rim[]; 0 where it does not return to start. */
static size_t follow(const uint32_t *next, uint32_t start, size_t most, uint32_t *rim) {
  size_t n = 0;
  uint32_t p = start;
  do {
    if (p == ABBE_TOPOLOGY_NONE || next[p] == p || n == most) return 0;
    rim[n++] = p;
    p = next[p];
  } while (p != start);
  return n >= 3 ? n : 0;
}

/* The rim's centre; false where a fan from there would not be safe. */
static bool fan_is_safe(const abbe_mesh *mesh, const uint32_t *rim, size_t n, double diagonal,
                        double centre[3]) {
  double normal[3] = {0}, length = 0.0, part[3], to[3];
  memset(centre, 0, 3 * sizeof *centre);
  for (size_t i = 0; i < n; i++)
    for (int k = 0; k < 3; k++) centre[k] += mesh->position[rim[i]][k] / (double)n;
  for (size_t i = 0; i < n; i++) {
    const double *a = mesh->position[rim[i]], *b = mesh->position[rim[(i + 1) % n]];
    abbe_vector_triangle(centre, a, b, part);
    abbe_vector_subtract(b, a, to);
    length += abbe_vector_length(to);
    for (int k = 0; k < 3; k++) normal[k] += part[k];
  }
  if (!abbe_vector_normalise(normal)) return false;
  const bool small = length <= SMALL_HOLE * diagonal;
  for (size_t i = 0; i < n; i++) {
    const double *a = mesh->position[rim[i]], *b = mesh->position[rim[(i + 1) % n]];
    abbe_vector_triangle(centre, a, b, part);
    abbe_vector_subtract(a, centre, to);
    if (!small && !(abbe_vector_dot(part, normal) > 0.0)) return false;
    if (!small && fabs(abbe_vector_dot(to, normal)) > FLAT_HOLE * length) return false;
  }
  return true;
}

/* Room for more vertices and faces; the mesh keeps its counts. */
static bool grow(abbe_mesh *mesh, size_t vertices, size_t faces) {
  if (vertices > ABBE_MESH_MAX_VERTICES || faces > ABBE_MESH_MAX_FACES) return false;
  void *position = realloc(mesh->position, vertices * sizeof *mesh->position);
  if (position) mesh->position = position;
  void *normal = realloc(mesh->normal, vertices * sizeof *mesh->normal);
  if (normal) mesh->normal = normal;
  void *face = realloc(mesh->face, faces * sizeof *mesh->face);
  if (face) mesh->face = face;
  return position && normal && face;
}

static abbe_result close_hole(abbe_mesh *mesh, const uint32_t *rim, size_t n,
                              const double centre[3], abbe_error *error) {
  const bool triangle = n == 3;
  const size_t vertices = mesh->vertex_count + !triangle;
  const size_t faces = mesh->face_count + (triangle ? 1 : n);
  if (!grow(mesh, vertices, faces))
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to close a hole of a mesh");
  if (triangle) {
    memcpy(mesh->face[mesh->face_count], rim, sizeof mesh->face[0]);
  } else {
    memcpy(mesh->position[mesh->vertex_count], centre, 3 * sizeof(double));
    for (size_t i = 0; i < n; i++) {
      const uint32_t f[3] = {(uint32_t)mesh->vertex_count, rim[i], rim[(i + 1) % n]};
      memcpy(mesh->face[mesh->face_count + i], f, sizeof f);
    }
  }
  mesh->vertex_count = vertices;
  mesh->face_count = faces;
  return ABBE_OK;
}

static abbe_result close_holes(abbe_mesh *mesh, mending *done, abbe_error *error) {
  abbe_mesh_report report;
  abbe_topology t;
  abbe_result result = abbe_mesh_check(mesh, &report, error);
  if (result != ABBE_OK || report.open_edges == 0) return result;
  double extent[3];
  abbe_vector_subtract(report.max, report.min, extent);
  result = abbe_topology_make(mesh, &t, error);
  if (result != ABBE_OK) return result;
  /* rims are in points; the mesh has one vertex a point, in another order perhaps */
  uint32_t *next = find_rims(&t), *rim = malloc((t.point_count + 1) * sizeof *rim);
  uint32_t *vertex = malloc((t.point_count + 1) * sizeof *vertex);
  if (!next || !rim || !vertex)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory to close the holes of a mesh");
  for (size_t v = 0; result == ABBE_OK && v < mesh->vertex_count; v++)
    vertex[t.point[v]] = (uint32_t)v;
  for (size_t p = 0; result == ABBE_OK && p < t.point_count; p++) {
    if (next[p] == ABBE_TOPOLOGY_NONE) continue;
    const size_t n = follow(next, (uint32_t)p, t.point_count, rim);
    for (size_t i = 0; i < n; i++) next[rim[i]] = ABBE_TOPOLOGY_NONE;
    for (size_t i = 0; i < n; i++) rim[i] = vertex[rim[i]];
    double centre[3];
    if (n == 0 || !fan_is_safe(mesh, rim, n, abbe_vector_length(extent), centre)) continue;
    result = close_hole(mesh, rim, n, centre, error);
    if (result == ABBE_OK) done->holes++;
  }
  free(next);
  free(rim);
  free(vertex);
  abbe_topology_free(&t);
  return result;
}

/* One shell as a mesh that borrows positions; its faces are malloc'd. */
static bool shell_faces(const abbe_mesh *mesh, const abbe_topology *t, size_t shell, bool others,
                        abbe_mesh *part) {
  *part = *mesh;
  part->face_count = 0;
  part->face = malloc((mesh->face_count + 1) * sizeof *part->face);
  if (!part->face) return false;
  for (size_t f = 0; f < mesh->face_count; f++)
    if ((t->shell[f] == shell) != others)
      memcpy(part->face[part->face_count++], mesh->face[f], sizeof part->face[0]);
  return true;
}

static double signed_volume(const abbe_mesh *mesh) {
  double volume = 0.0;
  for (size_t f = 0; f < mesh->face_count; f++) {
    const uint32_t *c = mesh->face[f];
    double n[3], from[3];
    abbe_vector_triangle(mesh->position[c[0]], mesh->position[c[1]], mesh->position[c[2]], n);
    abbe_vector_subtract(mesh->position[c[0]], mesh->position[mesh->face[0][0]], from);
    volume += abbe_vector_dot(from, n) / 6.0;
  }
  return volume;
}

/* Whether the shell must turn: its volume is to be positive at an even depth among the others
 * (a body) and negative at an odd one (a bubble). */
static abbe_result shell_is_inverted(const abbe_mesh *mesh, const abbe_topology *t, size_t shell,
                                     bool *inverted, abbe_error *error) {
  abbe_mesh self, rest;
  if (!shell_faces(mesh, t, shell, false, &self))
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to mend a mesh");
  if (!shell_faces(mesh, t, shell, true, &rest)) {
    free(self.face);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to mend a mesh");
  }
  const bool bubble =
      rest.face_count > 0 && abbe_mesh_contains(&rest, mesh->position[self.face[0][0]]);
  *inverted = (signed_volume(&self) < 0.0) != bubble;
  free(self.face);
  free(rest.face);
  return ABBE_OK;
}

static abbe_result turn_outwards(abbe_mesh *mesh, mending *done, abbe_error *error) {
  abbe_topology t;
  abbe_result result = abbe_topology_make(mesh, &t, error);
  if (result != ABBE_OK) return result;
  if (t.shell_count > 64) {
    /* too many parts to look at one by one: the sign of the whole decides */
    if (signed_volume(mesh) < 0.0) {
      for (size_t f = 0; f < mesh->face_count; f++) turn(mesh, f);
      done->inverted++;
    }
    abbe_topology_free(&t);
    return ABBE_OK;
  }
  bool inverted[64] = {false};
  for (size_t s = 0; result == ABBE_OK && s < t.shell_count; s++)
    result = shell_is_inverted(mesh, &t, s, &inverted[s], error);
  for (size_t f = 0; result == ABBE_OK && f < mesh->face_count; f++)
    if (inverted[t.shell[f]]) turn(mesh, f);
  for (size_t s = 0; s < t.shell_count; s++) done->inverted += inverted[s];
  abbe_topology_free(&t);
  return result;
}

static abbe_result run_steps(abbe_mesh *mesh, mending *done, abbe_error *error) {
  drop_repeated(mesh, done);
  if (mesh->face_count == 0)
    return abbe_error_set(error, ABBE_GEOMETRY, "the mesh has no face with an area");
  abbe_result result = make_consistent(mesh, done, error);
  if (result == ABBE_OK) result = flip_slivers(mesh, done, error);
  if (result == ABBE_OK) result = close_holes(mesh, done, error);
  if (result == ABBE_OK) result = turn_outwards(mesh, done, error);
  return result;
}

static abbe_result demand_sound(const abbe_mesh *mesh, abbe_error *error) {
  abbe_mesh_report r;
  const abbe_result result = abbe_mesh_check(mesh, &r, error);
  if (result != ABBE_OK) return result;
  if (r.open_edges || r.crowded_edges || r.flipped_edges || r.degenerate_faces)
    return abbe_error_set(error, ABBE_GEOMETRY,
                          "the mesh is not a closed, consistently oriented surface and cannot be "
                          "mended safely: %zu open edges, %zu edges with more than two faces, "
                          "%zu edges with faces turned against each other, %zu faces without area",
                          r.open_edges, r.crowded_edges, r.flipped_edges, r.degenerate_faces);
  double diagonal = 0.0;
  for (int k = 0; k < 3; k++) diagonal = hypot(diagonal, r.max[k] - r.min[k]);
  /* what rounding may make of nothing, and a thousandth of what points that are two may enclose */
  if (!(r.volume > 1e-12 * r.area * diagonal))
    return abbe_error_set(error, ABBE_GEOMETRY,
                          "the mesh encloses no volume (%g m3), so it has no inside to refract in",
                          r.volume);
  return ABBE_OK;
}

static void say(char *text, size_t size, size_t count, const char *one, const char *many) {
  if (count == 0) return;
  const size_t used = strlen(text);
  snprintf(text + used, size - used, "%s%zu %s", used ? ", " : "", count, count == 1 ? one : many);
}

static abbe_result describe(const mending *done, char **what, abbe_error *error) {
  char text[320] = "";
  say(text, sizeof text, done->repeated, "face with repeated corners dropped",
      "faces with repeated corners dropped");
  say(text, sizeof text, done->slivers, "face without area split away",
      "faces without area split away");
  say(text, sizeof text, done->turned, "face turned to agree with its neighbours",
      "faces turned to agree with their neighbours");
  say(text, sizeof text, done->holes, "hole closed", "holes closed");
  say(text, sizeof text, done->inverted, "inside-out part turned outwards",
      "inside-out parts turned outwards");
  if (!what || !text[0]) return ABBE_OK;
  *what = malloc(strlen(text) + 1);
  if (!*what) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a sentence");
  memcpy(*what, text, strlen(text) + 1);
  return ABBE_OK;
}

abbe_result abbe_mesh_mend(abbe_mesh *mesh, bool smooth, char **what, abbe_error *error) {
  if (what) *what = NULL;
  abbe_topology t;
  abbe_mesh work = {0};
  mending done = {0};
  abbe_result result = abbe_topology_make(mesh, &t, error);
  if (result != ABBE_OK) return result;
  result = welded(&t, &work, error);
  abbe_topology_free(&t);
  if (result == ABBE_OK) result = run_steps(&work, &done, error);
  if (result == ABBE_OK) result = demand_sound(&work, error);
  const bool changed = done.repeated + done.slivers + done.turned + done.holes + done.inverted > 0;
  if (result == ABBE_OK && changed) result = abbe_mesh_compute_normals(&work, smooth, error);
  if (result == ABBE_OK) result = describe(&done, what, error);
  if (result == ABBE_OK && changed) {
    abbe_mesh_free(mesh);
    *mesh = work;
  } else {
    abbe_mesh_free(&work);
  }
  return result;
}
