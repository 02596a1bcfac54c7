/* Fixing: a mesh as points and faces, on which the steps work until it is closed and outwards. */
#include "base/maths.h"
#include "base/number.h"
#include "scenes/mesh/mesh.h"
#include "scenes/mesh/mesh_parts.h"
#include "scenes/mesh/shells.h"
#include "scenes/mesh/topology.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct fixing {
  size_t joined, repeated, doubles, slivers, turned, holes, inverted, crossings, solids;
  double volume;      /* that is enclosed */
  double widest;      /* hole, in the mesh's own unit */
  double apart;       /* a joined corner, at the most, from the middle, likewise */
  double crossing[3]; /* where the surface crosses itself first */
} fixing;

/* The mesh with one vertex a point, which later steps may change. */
static abbe_result welded(const abbe_topology *t, abbe_mesh *out, abbe_error *error) {
  ABBE_TRY(abbe_mesh_make(t->point_count, t->face_count, false, out, error));
  memcpy(out->position, t->position, t->point_count * sizeof *out->position);
  memcpy(out->face, t->face, t->face_count * sizeof *out->face);
  return ABBE_OK;
}

static bool repeats(const uint32_t f[3]) {
  return f[0] == f[1] || f[1] == f[2] || f[2] == f[0];
}

static void drop_repeated(abbe_mesh *mesh, fixing *done) {
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
  const double *corner[3] = {mesh->position[f[0]], mesh->position[f[1]], mesh->position[f[2]]};
  int tip;
  return abbe_mesh_is_sliver(corner, &tip) ? tip : -1;
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

static abbe_result flip_slivers(abbe_mesh *mesh, fixing *done, abbe_error *error) {
  for (int pass = 0; pass < 8; pass++) {
    abbe_topology t;
    ABBE_TRY(abbe_topology_make(mesh, &t, error));
    bool *touched = calloc(mesh->face_count + 1, sizeof *touched);
    if (!touched) {
      abbe_topology_free(&t);
      return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to fix a mesh");
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

/* Goes from face to face over edges with two faces and notes in side[] which agree with the first
 * (1) and which must turn (2); queue has capacity for every face. Returns how many it met. */
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

static abbe_result make_consistent(abbe_mesh *mesh, fixing *done, abbe_error *error) {
  abbe_topology t;
  ABBE_TRY(abbe_topology_make(mesh, &t, error));
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
  return ok ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory to fix a mesh");
}

static bool is_sound(const abbe_mesh_report *r) {
  return !(r->open_edges || r->crowded_edges || r->flipped_edges || r->degenerate_faces);
}

/* Turns shells so that bodies look outwards and hollows into themselves. What is not closed has no
 * inside, and is left to be refused. */
static abbe_result turn_outwards(abbe_mesh *mesh, const abbe_topology *t, fixing *done,
                                 size_t *turned, abbe_error *error) {
  abbe_shells shells;
  const abbe_result result = abbe_shells_find(mesh, t, &shells, error);
  *turned = 0;
  done->volume = 0;
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < shells.count; i++) {
    const double volume = fabs(shells.shell[i].volume);
    done->volume += shells.shell[i].depth % 2 != 0 ? -volume : volume;
    shells.shell[i].solid = (shells.shell[i].volume < 0) != (shells.shell[i].depth % 2 != 0);
    *turned += shells.shell[i].solid;
  }
  done->inverted += *turned;
  for (size_t f = 0; f < mesh->face_count; f++)
    if (shells.shell[t->shell[f]].solid) turn(mesh, f);
  done->solids = shells.solid_count;
  done->crossings = shells.self_count;
  memcpy(done->crossing, shells.self_place, sizeof done->crossing);
  abbe_shells_free(&shells);
  return ABBE_OK;
}

static abbe_result run_steps(abbe_mesh *mesh, fixing *done, abbe_error *error) {
  drop_repeated(mesh, done);
  if (mesh->face_count == 0)
    return abbe_error_set(error, ABBE_GEOMETRY, "the mesh has no face with an area");
  ABBE_TRY(abbe_mesh_drop_doubles(mesh, &done->doubles, error));
  ABBE_TRY(make_consistent(mesh, done, error));
  ABBE_TRY(flip_slivers(mesh, done, error));
  return abbe_mesh_close_holes(mesh, &done->holes, &done->widest, error);
}

static abbe_result refuse(const abbe_mesh_report *r, abbe_error *error) {
  char faults[640];
  abbe_mesh_report_faults(r, faults, sizeof faults);
  return abbe_error_set(
      error, ABBE_GEOMETRY, "the mesh is not a closed, consistently oriented surface: %s%s%s",
      faults, r->open_edges ? "; fill its holes in a modeller, such as Blender or MeshLab" : "",
      r->crowded_edges ? "; sheets that hang on a body are taken off where the mesh was made" : "");
}

/* After the steps, or at once where none is needed. */
static abbe_result finish(abbe_mesh *mesh, const abbe_topology *t, fixing *done,
                          abbe_error *error) {
  abbe_mesh_report r;
  abbe_result result = abbe_mesh_check_known(mesh, t, &r, error);
  if (result == ABBE_OK && !is_sound(&r)) result = refuse(&r, error);
  size_t turned = 0;
  if (result == ABBE_OK) result = turn_outwards(mesh, t, done, &turned, error);
  /* bodies that touch along edges are separated by place and by the side that they face */
  for (int i = 0; i < 3 && result == ABBE_OK && turned > 0 && r.touching_edges > 0; i++) {
    abbe_topology again;
    result = abbe_topology_make(mesh, &again, error);
    if (result == ABBE_OK) result = turn_outwards(mesh, &again, done, &turned, error);
    abbe_topology_free(&again);
  }
  double diagonal = 0.0;
  for (int k = 0; k < 3; k++) diagonal = hypot(diagonal, r.max[k] - r.min[k]);
  /* what rounding may make of nothing, and a thousandth of what points that are two may enclose */
  if (result == ABBE_OK && !(done->volume > 1e-12 * r.area * diagonal))
    return abbe_error_set(error, ABBE_GEOMETRY,
                          "the mesh encloses no volume (%g), so it has no inside to refract in",
                          done->volume);
  return result;
}

static void say(char *text, size_t size, size_t count, const char *one, const char *many) {
  if (count == 0) return;
  const size_t used = strlen(text);
  snprintf(text + used, size - used, "%s%zu %s", used ? ", " : "", count, count == 1 ? one : many);
}

static abbe_result describe(const fixing *done, char **what, abbe_error *error) {
  char text[640] = "", one[80], many[80], corners[96];
  abbe_number_format(corners, sizeof corners,
                     "corners joined that lay up to %.3g from their middle, in the mesh's own unit",
                     done->apart);
  abbe_number_format(one, sizeof one, "hole closed, %.3g across in the mesh's own unit",
                     done->widest);
  abbe_number_format(many, sizeof many,
                     "holes closed, the widest %.3g across in the mesh's own unit", done->widest);
  say(text, sizeof text, done->joined, corners, corners);
  say(text, sizeof text, done->repeated, "face with repeated corners dropped",
      "faces with repeated corners dropped");
  say(text, sizeof text, done->doubles, "face that was there twice dropped",
      "faces that were there twice dropped");
  say(text, sizeof text, done->slivers, "face without area split away",
      "faces without area split away");
  say(text, sizeof text, done->turned, "face turned to agree with its neighbours",
      "faces turned to agree with their neighbours");
  say(text, sizeof text, done->holes, one, many);
  say(text, sizeof text, done->inverted, "inside-out part turned outwards",
      "inside-out parts turned outwards");
  if (done->crossings > 0) {
    const size_t used = strlen(text);
    abbe_number_format(
        text + used, sizeof text - used,
        "%sthe surface crosses itself, in %zu pairs of faces, at (%.4g, %.4g, %.4g) for one: "
        "light may go wrong there",
        used ? "; " : "", done->crossings, done->crossing[0], done->crossing[1], done->crossing[2]);
  }
  if (!what || !text[0]) return ABBE_OK;
  *what = malloc(strlen(text) + 1);
  if (!*what) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a sentence");
  memcpy(*what, text, strlen(text) + 1);
  return ABBE_OK;
}

/* ---- normals ---- */

typedef struct triple {
  uint32_t point[3], face; /* points in ascending order */
} triple;

static triple triple_of(const uint32_t face[3], uint32_t number) {
  triple out = {.face = number};
  const uint32_t a = face[0] < face[1] ? face[0] : face[1],
                 b = face[0] < face[1] ? face[1] : face[0];
  out.point[0] = a < face[2] ? a : face[2];
  out.point[2] = b > face[2] ? b : face[2];
  out.point[1] = face[0] ^ face[1] ^ face[2] ^ out.point[0] ^ out.point[2];
  return out;
}

static int by_points(const void *a, const void *b) {
  return memcmp(((const triple *)a)->point, ((const triple *)b)->point,
                sizeof((const triple *)a)->point);
}

/* The normals that the file gave to faces of the same three points; t is the topology of `from`,
 * whose points are the first vertices of `to`. */
static abbe_result carry_normals(const abbe_mesh *from, const abbe_topology *t, const abbe_mesh *to,
                                 double (*corner)[3], abbe_error *error) {
  triple *known = malloc((from->face_count + 1) * sizeof *known);
  if (!known) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the normals of a mesh");
  for (size_t f = 0; f < from->face_count; f++) known[f] = triple_of(t->face[f], (uint32_t)f);
  qsort(known, from->face_count, sizeof *known, by_points);
  for (size_t f = 0; f < to->face_count; f++) {
    const uint32_t *face = to->face[f];
    const triple wanted = triple_of(face, 0);
    const triple *found = bsearch(&wanted, known, from->face_count, sizeof *known, by_points);
    double n[3];
    if (!found) continue;
    abbe_vector_triangle(to->position[face[0]], to->position[face[1]], to->position[face[2]], n);
    for (int k = 0; k < 3; k++)
      for (int i = 0; i < 3; i++)
        if (t->face[found->face][i] == face[k])
          abbe_mesh_fair_normal(from->normal[from->face[found->face][i]], n,
                                corner[3 * f + (size_t)k]);
  }
  free(known);
  return ABBE_OK;
}

/* Normals of the fixed mesh, by angles, and by the file's normals where a face is the file's. */
static abbe_result fixed_normals(const abbe_mesh *from, const abbe_topology *t, abbe_mesh *mesh,
                                 abbe_error *error) {
  abbe_topology own;
  ABBE_TRY(abbe_topology_make(mesh, &own, error));
  double(*corner)[3] = malloc((3 * mesh->face_count + 1) * sizeof *corner);
  abbe_result result =
      corner ? abbe_mesh_crease_normals(mesh, &own, corner, error)
             : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the normals of a mesh");
  if (result == ABBE_OK && from->given_normals)
    result = carry_normals(from, t, mesh, corner, error);
  mesh->given_normals = from->given_normals;
  if (result == ABBE_OK)
    result = abbe_mesh_take_normals(mesh, own.point, (const double(*)[3])corner, error);
  free(corner);
  abbe_topology_free(&own);
  return result;
}

/* The steps over a mesh of one vertex a point, which it leaves in *work. */
static abbe_result fix(const abbe_topology *t, fixing *done, abbe_mesh *work, abbe_error *error) {
  ABBE_OWNED(abbe_topology, own) = {0};
  ABBE_TRY(welded(t, work, error));
  ABBE_TRY(run_steps(work, done, error));
  ABBE_TRY(abbe_topology_make(work, &own, error));
  return finish(work, &own, done, error);
}

/* The mesh, or with its corners joined where that closes it, and the topology of that. */
static abbe_result join(const abbe_mesh *mesh, abbe_mesh *joined, abbe_topology *t, fixing *done,
                        abbe_error *error) {
  abbe_topology own;
  ABBE_TRY(abbe_mesh_join_corners(mesh, t, joined, &own, &done->joined, &done->apart, error));
  if (done->joined == 0) return ABBE_OK;
  abbe_topology_free(t);
  *t = own;
  return ABBE_OK;
}

abbe_result abbe_mesh_fix(abbe_mesh *mesh, abbe_mesh_normals normals, size_t *solids, char **what,
                          abbe_error *error) {
  if (what) *what = NULL;
  abbe_topology t;
  abbe_mesh_report report;
  abbe_mesh work = {0}, joined = {0};
  fixing done = {0};
  ABBE_TRY(abbe_topology_make(mesh, &t, error));
  abbe_result result = abbe_mesh_check_known(mesh, &t, &report, error);
  if (result == ABBE_OK && report.open_edges > 0) {
    result = join(mesh, &joined, &t, &done, error);
    if (result == ABBE_OK && done.joined > 0)
      result = abbe_mesh_check_known(&joined, &t, &report, error);
  }
  const abbe_mesh *from = done.joined > 0 ? &joined : mesh;
  /* what is sound, and nowhere there twice, has faces turned at the most */
  if (result == ABBE_OK && is_sound(&report) && report.touching_edges == 0) {
    result = welded(&t, &work, error);
    if (result == ABBE_OK) result = finish(&work, &t, &done, error);
  } else if (result == ABBE_OK) {
    result = fix(&t, &done, &work, error);
  }
  const bool changed = done.joined + done.repeated + done.doubles + done.slivers + done.turned +
                           done.holes + done.inverted >
                       0;
  if (result == ABBE_OK && changed && normals != ABBE_NORMALS_AUTO)
    result = abbe_mesh_drop_unused(&work, error);
  if (result == ABBE_OK && changed)
    result = normals == ABBE_NORMALS_AUTO ? fixed_normals(from, &t, &work, error)
                                          : abbe_mesh_compute_normals(&work, normals, error);
  if (result == ABBE_OK) result = describe(&done, what, error);
  abbe_topology_free(&t);
  abbe_mesh_free(&joined);
  if (result == ABBE_OK && solids) *solids = done.solids;
  if (result == ABBE_OK && changed) {
    abbe_mesh_free(mesh);
    *mesh = work;
  } else {
    abbe_mesh_free(&work);
  }
  return result;
}
