#include "validation/lab/exit_fill.h"

#include "base/maths.h"
#include "validation/trace/transport/interface.h"
#include "validation/trace/transport/random.h"

#include <stdlib.h>
#include <string.h>

/* How far before its place a ray sets out, frame units: from outside of the object. */
static const float before = 4;
/* And how far off the place what it meets first may lie. */
static const float near_place = 1e-4f;

/* A ray in progress. */
typedef struct walk {
  const abbe_exit_space *space;
  uint32_t step;
  float o[3], d[3], carried;
  bool inside;
  uint32_t facets;
} walk;

static float dot(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* FNV's prime [FowlerNollVo]. */
static void note(walk *w, const abbe_hit *hit, bool reflects) {
  const uint32_t facet = w->space->facet != NULL ? w->space->facet[hit->face] : 0;
  w->facets = (w->facets ^ (2 * facet + reflects + 1)) * 16777619u;
}

/* The normals on the side that the ray comes from, interpolated and the face's own. */
static float face_normals(const walk *w, const abbe_hit *hit, float n[3], float ng[3]) {
  const bool entering = dot(w->d, hit->ng) < 0;
  const float side = entering ? 1 : -1;
  const float *outside = (dot(w->d, hit->n) < 0) == entering ? hit->n : hit->ng;
  for (int k = 0; k < 3; k++) {
    n[k] = side * outside[k];
    ng[k] = side * hit->ng[k];
  }
  return fminf(fmaxf(-dot(w->d, n), 0), 1);
}

static void go_on(walk *w, const abbe_hit *hit, const float out[3]) {
  memcpy(w->d, out, sizeof w->d);
  abbe_geometry_leave(hit, out, w->o);
}

static void meet_mirror(walk *w, const abbe_hit *hit) {
  float n[3], ng[3], out[3];
  const float cos_i = face_normals(w, hit, n, ng);
  w->carried *= abbe_mirrors_reflect(w->space->mirrors, hit->surface->index, cos_i, w->step, 0.5f);
  abbe_interface_reflect(w->d, n, cos_i, out);
  abbe_interface_keep_side(ng, 1, out);
  note(w, hit, true);
  go_on(w, hit, out);
}

static void meet_interface(walk *w, const abbe_hit *hit, float chance) {
  float n[3], ng[3], out[3], cos_t;
  const bool entering = dot(w->d, hit->ng) < 0;
  const float cos_i = face_normals(w, hit, n, ng);
  const float index = abbe_media_n(w->space->media, (int)hit->surface->index, w->step, 0.5f);
  const float eta = entering ? 1 / index : index;
  const bool reflects = chance < abbe_interface_reflectance(cos_i, eta, &cos_t);
  if (reflects)
    abbe_interface_reflect(w->d, n, cos_i, out);
  else
    abbe_interface_refract(w->d, n, eta, cos_i, cos_t, out);
  abbe_interface_keep_side(ng, reflects ? 1 : -1, out);
  w->inside = entering != reflects;
  note(w, hit, reflects);
  go_on(w, hit, out);
}

/* The decision's number: those that are given, and then others that only look like chance. */
static float chance_at(const abbe_exit_start *start, size_t met) {
  if (met < ABBE_EXIT_WALK_CHANCES) return start->chance[met];
  const float x = start->chance[ABBE_EXIT_WALK_CHANCES - 1] +
                  0.6180340f * (float)(met - ABBE_EXIT_WALK_CHANCES + 1);
  return x - floorf(x);
}

static bool meets_place(const abbe_exit_start *start, const abbe_hit *hit) {
  float square = 0;
  for (int k = 0; k < 3; k++)
    square += (hit->p[k] - start->place[k]) * (hit->p[k] - start->place[k]);
  return square < near_place * near_place;
}

void abbe_exit_walk(const abbe_exit_space *space, const abbe_exit_start *start,
                    abbe_exit_end *end) {
  walk w = {.space = space, .step = start->step, .carried = 1, .facets = 2166136261u};
  *end = (abbe_exit_end){0};
  memcpy(w.d, start->way, sizeof w.d);
  for (int k = 0; k < 3; k++) w.o[k] = start->place[k] - before * start->way[k];
  for (size_t met = 0; met <= ABBE_EXIT_WALK_MOST; met++) {
    abbe_hit hit;
    if (!abbe_geometry_hit(space->geometry, ABBE_GEOMETRY_SPECULAR, w.o, w.d, INFINITY, &hit)) {
      if (met == 0 || w.inside) return;
      memcpy(end->place, w.o, sizeof end->place);
      memcpy(end->way, w.d, sizeof end->way);
      end->carried = w.carried;
      end->facets = w.facets;
      return;
    }
    if (met == 0 && !meets_place(start, &hit)) return;
    if (w.inside) {
      float way[3];
      for (int k = 0; k < 3; k++) way[k] = hit.p[k] - w.o[k];
      const float attenuation =
          abbe_media_attenuation(space->media, (int)hit.surface->index, start->step, 0.5f);
      w.carried *= expf(-attenuation * sqrtf(dot(way, way)));
    }
    if (hit.surface->kind == ABBE_GEOMETRY_MIRRORS)
      meet_mirror(&w, &hit);
    else
      meet_interface(&w, &hit, chance_at(start, met));
  }
}

/* Numbers of a point that fill their space evenly together: two of its place, one of its
 * wavelength, three of its first decisions. */
enum { EVEN = 6, SALT = 0x65786974 };

/* 2^32 over the powers of the root of x^(EVEN + 1) = x + 1. */
static void make_ratios(const uint32_t seed, uint32_t ratio[EVEN], uint32_t shift[EVEN]) {
  double root = 1.1, power = 1;
  for (int i = 0; i < 64; i++) root = pow(1 + root, 1.0 / (EVEN + 1));
  for (uint32_t k = 0; k < EVEN; k++) {
    uint32_t bits[4];
    power /= root;
    ratio[k] = (uint32_t)(power * 0x1p32);
    abbe_random_bits(k, 2, seed, SALT, bits);
    shift[k] = seed == 0 ? 0x80000000u : bits[0];
  }
}

/* A surface to choose places of: triangles by their areas up to each, frame units. */
typedef struct sheet {
  const abbe_surface *surface;
  size_t faces;
  double *upto; /* [faces] */
  bool open;    /* light meets both sides */
} sheet;

static double corners_of(const abbe_surface *s, size_t face, double a[3], double u[3], double v[3],
                         double n[3]) {
  const uint32_t *f = s->face[face];
  for (int k = 0; k < 3; k++) {
    a[k] = (double)s->position[f[0]][k];
    u[k] = (double)s->position[f[1]][k] - a[k];
    v[k] = (double)s->position[f[2]][k] - a[k];
  }
  n[0] = u[1] * v[2] - u[2] * v[1];
  n[1] = u[2] * v[0] - u[0] * v[2];
  n[2] = u[0] * v[1] - u[1] * v[0];
  const double twice = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (int k = 0; k < 3 && twice > 0; k++) n[k] /= twice;
  return twice / 2;
}

static abbe_result make_sheet(const abbe_lone_object *lone, sheet *out, double *area,
                              abbe_error *error) {
  const abbe_surface *s = &lone->geometry.surface[0];
  *out = (sheet){.surface = s, .faces = s->sphere ? 1 : lone->object.mesh.face_count};
  out->upto = calloc(out->faces + 1, sizeof *out->upto);
  if (out->upto == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for faces");
  double sum = s->sphere ? 4 * ABBE_PI * (double)s->radius * (double)s->radius : 0, inside = 0;
  for (size_t i = 0; !s->sphere && i < out->faces; i++) {
    double a[3], u[3], v[3], n[3];
    const double each = corners_of(s, i, a, u, v, n);
    inside += each * (n[0] * a[0] + n[1] * a[1] + n[2] * a[2]) / 3;
    out->upto[i] = sum += each;
  }
  /* for a closed surface this is its volume */
  out->open =
      s->kind == ABBE_GEOMETRY_MIRRORS && !s->sphere && !(fabs(inside) > 1e-4 * pow(sum, 1.5));
  const double unit = lone->geometry.unit;
  *area = sum * unit * unit * (out->open ? 2 : 1);
  if (sum > 0) return ABBE_OK;
  free(out->upto);
  return abbe_error_set(error, ABBE_GEOMETRY, "the object '%s' has no surface", lone->body.name);
}

/* x in [0, 1): the face that holds it of all area, and where in the face it is. */
static size_t choose_face(const sheet *s, double *x) {
  const double at = *x * s->upto[s->faces - 1];
  size_t low = 0, high = s->faces - 1;
  while (low < high) {
    const size_t middle = (low + high) / 2;
    if (s->upto[middle] > at)
      high = middle;
    else
      low = middle + 1;
  }
  const double from = low > 0 ? s->upto[low - 1] : 0, width = s->upto[low] - from;
  *x = width > 0 ? fmin(fmax((at - from) / width, 0), 1) : 0;
  return low;
}

static void place_on_sphere(const abbe_surface *s, double x, double y, abbe_exit_point *p) {
  const double z = 1 - 2 * x, r = sqrt(fmax(1 - z * z, 0));
  const double n[3] = {r * cos(2 * ABBE_PI * y), r * sin(2 * ABBE_PI * y), z};
  for (int k = 0; k < 3; k++) {
    p->normal[k] = (float)n[k];
    p->place[k] = s->centre[k] + s->radius * (float)n[k];
  }
}

static void place_on_sheet(const sheet *s, size_t i, double x, double y, abbe_exit_point *p) {
  double a[3], u[3], v[3], n[3];
  if (s->surface->sphere) {
    place_on_sphere(s->surface, x, y, p);
    return;
  }
  corners_of(s->surface, choose_face(s, &x), a, u, v, n);
  if (x + y > 1) {
    x = 1 - x;
    y = 1 - y;
  }
  const double side = s->open && i % 2 != 0 ? -1 : 1;
  for (int k = 0; k < 3; k++) {
    p->place[k] = (float)(a[k] + x * u[k] + y * v[k]);
    p->normal[k] = (float)(side * n[k]);
  }
}

/* x in [0, 1): the bin that holds it of all chances. */
static uint32_t choose_bin(const double *chance, double x) {
  uint32_t bin = 0;
  while (bin + 1 < ABBE_LIGHT_EXITS_BINS && x >= chance[bin]) x -= chance[bin++];
  return bin;
}

static void decide(uint32_t i, uint32_t seed, const double even[EVEN], float *chance) {
  float random[8];
  abbe_random4(i, 0, seed, SALT, random);
  abbe_random4(i, 1, seed, SALT, random + 4);
  for (int k = 0; k < ABBE_EXIT_WALK_CHANCES; k++)
    chance[k] = k < EVEN - 3 ? fminf((float)even[3 + k], 0x1.fffffep-1f) : random[k];
}

/* Whether the symmetry leaves the point where it is. */
static bool is_kept(const abbe_lone_object *lone, const abbe_body_symmetry *symmetry,
                    const abbe_exit_point *p) {
  double world[3], there[3];
  abbe_geometry_to_world(&lone->geometry, p->place, world);
  for (int k = 0; k < 3; k++) world[k] -= lone->place.centre[k];
  return abbe_body_symmetry_bring(symmetry, world, there) == 0;
}

abbe_result abbe_exit_points_make(const abbe_lone_object *lone, const abbe_body_symmetry *symmetry,
                                  size_t count, double min_nm, double max_nm, uint32_t seed,
                                  abbe_exit_points *out, abbe_error *error) {
  sheet s;
  uint32_t ratio[EVEN], shift[EVEN];
  double chance[ABBE_LIGHT_EXITS_BINS];
  *out = (abbe_exit_points){0};
  ABBE_TRY(make_sheet(lone, &s, &out->area, error));
  make_ratios(seed, ratio, shift);
  abbe_light_exits_chances(min_nm, max_nm, chance);
  out->point = calloc(count + 1, sizeof *out->point);
  for (uint32_t i = 0; out->point != NULL && i < count; i++) {
    double even[EVEN];
    for (int k = 0; k < EVEN; k++) even[k] = (double)(i * ratio[k] + shift[k]) * 0x1p-32;
    abbe_exit_point *p = &out->point[out->count];
    place_on_sheet(&s, i, even[0], even[1], p);
    if (!is_kept(lone, symmetry, p) && (i + 1 < count || out->count > 0)) continue;
    out->count++;
    p->bin = choose_bin(chance, even[2]);
    decide(i, seed, even, p->chance);
  }
  free(s.upto);
  if (out->point != NULL) return ABBE_OK;
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu points", count);
}

void abbe_exit_points_free(abbe_exit_points *points) {
  if (points == NULL) return;
  free(points->point);
  *points = (abbe_exit_points){0};
}
