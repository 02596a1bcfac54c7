#include "scenes/studio/setting.h"

#include "base/maths.h"
#include "base/thread/watch.h"
#include "scenes/scene.h"
#include "scenes/shapes/shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  AROUND = 720, /* directions of the outline; a multiple of 8, so that corners of plates are met */
  ROD = 24,     /* corners of a rod's section */
  ROLL = 16,    /* steps of a prong over the girdle and the crown */
  TIP = 6
};
#define REACH 0.6       /* share of its thickness by which metal reaches over the crown */
#define MOST_WIDTHS 1e4 /* inner radius of a band, in widths of the stone */
#define LEAN 0.5        /* by which the foot is drawn in at the most */

/* The outline's outermost place in a direction, about the middle, and the heights of the girdle. */
typedef struct support {
  double angle, n[2], p[2], low, high;
} support;

typedef struct making {
  const abbe_object *stone;
  abbe_object
      under; /* those of its faces that a ball above can touch; its corners are the stone's */
  double middle[2], half[2], bottom, top; /* the stone's middle, half sizes and heights */
  double width, gap, thick;
  double unit;      /* m */
  size_t rim_count; /* number of its corners, each from the first direction to the last */
  support *rim;     /* [AROUND] */
  double (*row)[3]; /* [AROUND * ROD] */
  abbe_mesh *out;
  abbe_error *error;
  abbe_result result;
} making;

static support support_at(const making *m, double angle) {
  const abbe_mesh *mesh = &m->stone->mesh;
  support s = {.angle = angle,
               .n = {cos(angle) / m->half[0], sin(angle) / m->half[1]},
               .low = INFINITY,
               .high = -INFINITY};
  const double length = hypot(s.n[0], s.n[1]);
  double most = -INFINITY, from = INFINITY, to = -INFINITY;
  for (int k = 0; k < 2; k++) s.n[k] /= length;
  for (int pass = 0; pass < 2; pass++)
    for (size_t v = 0; v < mesh->vertex_count; v++) {
      const double *q = mesh->position[v];
      const double x = q[0] - m->middle[0], y = q[1] - m->middle[1];
      const double out = x * s.n[0] + y * s.n[1], along = y * s.n[0] - x * s.n[1];
      if (pass == 0) most = fmax(most, out);
      if (pass == 0 || out < most - 1e-6 * m->width) continue;
      from = fmin(from, along);
      to = fmax(to, along);
      s.low = fmin(s.low, q[2]);
      s.high = fmax(s.high, q[2]);
    }
  const double along = 0.5 * (from + to);
  s.p[0] = most * s.n[0] - along * s.n[1];
  s.p[1] = most * s.n[1] + along * s.n[0];
  return s;
}

static bool is_same(const support *a, const support *b) {
  return hypot(a->p[0] - b->p[0], a->p[1] - b->p[1]) < 1e-9 * hypot(a->p[0], a->p[1]);
}

static abbe_result find_rim(making *m) {
  m->rim = malloc(AROUND * sizeof *m->rim);
  m->row = malloc((size_t)AROUND * ROD * sizeof *m->row);
  m->under.mesh.face = malloc(m->stone->mesh.face_count * sizeof *m->under.mesh.face);
  m->under.mesh.position = m->stone->mesh.position;
  if (m->rim == NULL || m->row == NULL || m->under.mesh.face == NULL)
    return abbe_error_set(m->error, ABBE_NO_MEMORY, "no memory for a setting");
  support before = support_at(m, -2 * ABBE_PI / AROUND), now = support_at(m, 0);
  for (int i = 0; i < AROUND; i++) {
    if (i % 16 == 0 && abbe_watch_check(m->error) != ABBE_OK) return ABBE_CANCELLED;
    const support next = support_at(m, 2 * ABBE_PI * (i + 1) / AROUND);
    if (i % (AROUND / 8) == 0 || !is_same(&before, &now) || !is_same(&now, &next))
      m->rim[m->rim_count++] = now;
    before = now;
    now = next;
  }
  return ABBE_OK;
}

/* A place at that distance outside the outline, drawn towards the middle by a share. */
static void place(const making *m, const support *s, double out, double drawn, double z,
                  double at[3]) {
  for (int k = 0; k < 2; k++) at[k] = m->middle[k] + (1 - drawn) * (s->p[k] + out * s->n[k]);
  at[2] = z;
}

static bool goes_on(making *m) {
  if (m->result == ABBE_OK) m->result = abbe_watch_check(m->error);
  return m->result == ABBE_OK;
}

/* Leaves of `under` what is nearer than that to the vertical line. */
static void find_under(making *m, double x, double y, double radius) {
  const abbe_mesh *all = &m->stone->mesh;
  const double at[2] = {x, y};
  m->under.mesh.face_count = 0;
  for (size_t f = 0; f < all->face_count; f++) {
    const uint32_t *face = all->face[f];
    bool beside = false;
    for (int k = 0; k < 2; k++) {
      const double a = all->position[face[0]][k], b = all->position[face[1]][k],
                   c = all->position[face[2]][k];
      beside =
          beside || fmin(a, fmin(b, c)) > at[k] + radius || fmax(a, fmax(b, c)) < at[k] - radius;
    }
    if (!beside) memcpy(m->under.mesh.face[m->under.mesh.face_count++], face, sizeof *all->face);
  }
}

/* The lowest height at which a ball over the stone touches nothing of it, or `least`. */
static double height_of_ball(making *m, double x, double y, double radius, double least) {
  double z = m->top + 1.01 * radius;
  find_under(m, x, y, radius);
  for (int i = 0; i < 400 && z > least && goes_on(m); i++) {
    const double p[3] = {x, y, z};
    const double free = abbe_object_distance(&m->under, p) - radius;
    if (!(free > 1e-5 * radius)) break;
    z -= free;
  }
  return fmax(z, least);
}

/* ---- surfaces ---- */

static void add(making *m, abbe_mesh *part) {
  abbe_mesh both = {0};
  const size_t v = m->out->vertex_count, f = m->out->face_count;
  if (m->result == ABBE_OK)
    m->result =
        abbe_mesh_make(v + part->vertex_count, f + part->face_count, false, &both, m->error);
  if (m->result == ABBE_OK) {
    if (v > 0) memcpy(both.position, m->out->position, v * sizeof *both.position);
    if (f > 0) memcpy(both.face, m->out->face, f * sizeof *both.face);
    memcpy(both.position + v, part->position, part->vertex_count * sizeof *both.position);
    for (size_t i = 0; i < 3 * part->face_count; i++)
      both.face[f + i / 3][i % 3] = (uint32_t)v + part->face[i / 3][i % 3];
    abbe_mesh_free(m->out);
    *m->out = both;
  }
  abbe_mesh_free(part);
}

/* Rows of points around a section: a tube that is closed to a ring, or by a point at both ends. */
static void add_rows(making *m, size_t rows, size_t columns, bool ring) {
  abbe_mesh part = {0};
  double volume = 0;
  const double(*at)[3] = (const double(*)[3])m->row;
  if (m->result == ABBE_OK)
    m->result =
        abbe_mesh_make(rows * columns + (ring ? 0 : 2), 2 * rows * columns, false, &part, m->error);
  if (m->result != ABBE_OK) return;
  memcpy(part.position, at, rows * columns * sizeof *at);
  part.face_count = 0;
  for (size_t i = 0; i < (ring ? rows : rows - 1); i++)
    for (size_t k = 0; k < columns; k++) {
      const uint32_t a = (uint32_t)(i * columns + k),
                     b = (uint32_t)(i * columns + (k + 1) % columns);
      const uint32_t c = (uint32_t)((i + 1) % rows * columns + (k + 1) % columns);
      const uint32_t d = (uint32_t)((i + 1) % rows * columns + k);
      const uint32_t two[2][3] = {{a, b, c}, {a, c, d}};
      memcpy(part.face[part.face_count], two, sizeof two);
      part.face_count += 2;
    }
  for (size_t end = 0; end < 2 && !ring; end++) {
    const size_t first = end * (rows - 1) * columns, middle = rows * columns + end;
    for (size_t k = 0; k < columns; k++) {
      for (int c = 0; c < 3; c++) part.position[middle][c] += at[first + k][c] / (double)columns;
      const uint32_t a = (uint32_t)(first + k), b = (uint32_t)(first + (k + 1) % columns);
      const uint32_t cap[3] = {(uint32_t)middle, end ? a : b, end ? b : a};
      memcpy(part.face[part.face_count++], cap, sizeof cap);
    }
  }
  for (size_t f = 0; f < part.face_count; f++) {
    double n[3];
    const uint32_t *face = part.face[f];
    abbe_vector_cross(part.position[face[0]], part.position[face[1]], n);
    volume += abbe_vector_dot(n, part.position[face[2]]);
  }
  for (size_t f = 0; f < part.face_count && volume < 0; f++) {
    const uint32_t kept = part.face[f][1];
    part.face[f][1] = part.face[f][2];
    part.face[f][2] = kept;
  }
  add(m, &part);
}

/* A section in the plane of `out` (horizontal) and z around a place. */
static void put_round(const double at[3], const double out[2], double radius, double (*row)[3]) {
  for (int k = 0; k < ROD; k++) {
    const double a = 2 * ABBE_PI * k / ROD;
    for (int c = 0; c < 2; c++) row[k][c] = at[c] + radius * cos(a) * out[c];
    row[k][2] = at[2] + radius * sin(a);
  }
}

/* ---- prongs ---- */

/* How far feet at `foot` may be drawn in so that nothing around that line enters the stone. */
static double lean(making *m, double radius, double foot) {
  double least = 0, most = LEAN;
  for (int step = 0; step < 7; step++) {
    const double drawn = step == 0 ? LEAN : 0.5 * (least + most);
    bool clear = true;
    for (int a = 0; a < 16 && clear && goes_on(m); a++) {
      const support s = support_at(m, 2 * ABBE_PI * a / 16);
      for (int i = 1; i <= 12 && clear; i++) {
        double p[3];
        place(m, &s, radius, drawn * i / 12, s.low + (foot - s.low) * i / 12, p);
        clear =
            abbe_object_distance(m->stone, p) > radius && !abbe_mesh_contains(&m->stone->mesh, p);
      }
    }
    *(clear ? &least : &most) = drawn;
    if (step == 0 && clear) break;
  }
  return least;
}

/* A rod from its foot up to the girdle and, as a ball rolls over the stone, to its round tip. */
static void add_prong(making *m, double angle, double drawn, double foot) {
  const support s = support_at(m, angle);
  const double r = 0.5 * m->thick, away = r + m->gap, reach = REACH * m->thick;
  double path[ROLL + 3][3], along[3];
  size_t count = 0;
  place(m, &s, away, drawn, foot, path[count++]);
  place(m, &s, away, 0, s.low - m->gap, path[count++]);
  for (int i = 0; i <= ROLL; i++) {
    /* a quarter of a circle over the girdle's edge, and on */
    const double turn = 0.5 * ABBE_PI * i / 10;
    const double out = i <= 10 ? away * cos(turn) : -reach * (i - 10) / (ROLL - 10);
    double *p = path[count++];
    place(m, &s, out, 0, s.high, p);
    if (i > 0) p[2] = height_of_ball(m, p[0], p[1], away, s.high);
  }
  const double side[3] = {-s.n[1], s.n[0], 0};
  for (size_t i = 0; i < count + TIP; i++) {
    const bool tip = i >= count;
    const double bend = tip ? 0.5 * ABBE_PI * (double)(i - count + 1) / (TIP + 0.4) : 0;
    const double *at = path[tip ? count - 1 : i];
    double across[3];
    /* below the girdle's upper edge sections are level */
    if (i <= 2)
      along[0] = along[1] = 0, along[2] = 1;
    else if (!tip)
      abbe_vector_subtract(path[i + 1 < count ? i + 1 : i], path[i - 1], along);
    abbe_vector_normalise(along);
    abbe_vector_cross(along, side, across);
    abbe_vector_normalise(across);
    for (int k = 0; k < ROD; k++)
      for (int c = 0; c < 3; c++)
        m->row[i * ROD + (size_t)k][c] =
            at[c] + r * sin(bend) * along[c] +
            r * cos(bend) *
                (cos(2 * ABBE_PI * k / ROD) * across[c] + sin(2 * ABBE_PI * k / ROD) * side[c]);
  }
  add_rows(m, count + TIP, ROD, false);
}

static void add_rail(making *m, double drawn, double z) {
  for (size_t i = 0; i < m->rim_count; i++) {
    double at[3];
    place(m, &m->rim[i], 0.5 * m->thick + m->gap, drawn, z, at);
    put_round(at, m->rim[i].n, 0.35 * m->thick, m->row + i * ROD);
  }
  add_rows(m, m->rim_count, ROD, true);
}

static void add_prongs(making *m, size_t count) {
  const double foot = m->bottom - 0.4 * m->thick;
  const double drawn = lean(m, 0.5 * m->thick + m->gap, foot);
  for (size_t i = 0; i < count; i++)
    add_prong(m, 2 * ABBE_PI * ((double)i + 0.5) / (double)count, drawn, foot);
  const double low = support_at(m, 0).low;
  add_rail(m, drawn, foot + 0.35 * m->thick);
  add_rail(m, 0.5 * drawn, 0.5 * (foot + low));
}

/* ---- walls ---- */

/* The height of a lip's underside, over all of its edge. */
static double height_of_lip(making *m, double drawn) {
  enum { STEPS = 4 };
  double high = -INFINITY, from[3] = {0}, to[3];
  for (size_t i = 0; i <= m->rim_count; i++) {
    const support s = m->rim[i % m->rim_count];
    place(m, &s, m->gap, drawn, 0, to);
    for (int k = 1; k <= STEPS && i > 0; k++) {
      const double at[2] = {from[0] + (to[0] - from[0]) * k / STEPS,
                            from[1] + (to[1] - from[1]) * k / STEPS};
      high = fmax(high, height_of_ball(m, at[0], at[1], m->gap, s.high + m->gap));
    }
    memcpy(from, to, sizeof from);
  }
  return high;
}

static void add_bezel(making *m) {
  const double t = 0.6 * m->thick, foot = m->bottom - 0.4 * m->thick;
  const double lip = 0.8 * t / fmin(m->half[0], m->half[1]), under = height_of_lip(m, lip);
  for (size_t i = 0; i < m->rim_count; i++) {
    const support s = m->rim[i];
    double(*row)[3] = m->row + 6 * i;
    place(m, &s, m->gap, 0, foot, row[0]);
    place(m, &s, m->gap, 0, under, row[1]);
    place(m, &s, m->gap, lip, under, row[2]);
    place(m, &s, m->gap, lip, under + 0.3 * t, row[3]);
    place(m, &s, m->gap + t, 0, under, row[4]);
    place(m, &s, m->gap + t, 0, foot, row[5]);
  }
  add_rows(m, m->rim_count, 6, true);
}

static void add_box(making *m, double x0, double x1, double y0, double y1, double z0, double z1) {
  const double x = m->middle[0], y = m->middle[1];
  const double at[][3] = {{x + x0, y + y0, z0}, {x + x0, y + y1, z0}, {x + x0, y + y1, z1},
                          {x + x0, y + y0, z1}, {x + x1, y + y0, z0}, {x + x1, y + y1, z0},
                          {x + x1, y + y1, z1}, {x + x1, y + y0, z1}};
  memcpy(m->row, at, sizeof at);
  add_rows(m, 2, 4, false);
}

static void add_channel(making *m) {
  const double t = 0.6 * m->thick, foot = m->bottom - 0.4 * m->thick;
  const double lip = m->half[1] - 0.8 * t, inside = m->half[1] + m->gap, outside = inside + t;
  const double length = m->half[0] + m->thick;
  double under = support_at(m, 0.5 * ABBE_PI).high + m->gap;
  enum { STEPS = 128 };
  for (int i = 0; i <= STEPS; i++)
    for (int side = -1; side <= 1; side += 2)
      under = fmax(under, height_of_ball(m, m->middle[0] + m->half[0] * (2.0 * i / STEPS - 1),
                                         m->middle[1] + side * lip, m->gap, m->bottom));
  for (int side = -1; side <= 1; side += 2) {
    /* no two boxes share an edge */
    add_box(m, -length, length, side * inside, side * outside, foot, under + 0.2 * t);
    add_box(m, -length, length, side * lip, side * (inside + 0.5 * t), under, under + 0.4 * t);
    add_box(m, side * (m->half[0] + m->gap), side * (length - 0.1 * t), -inside - 0.5 * t,
            inside + 0.5 * t, foot, foot + t);
  }
}

static void add_pave(making *m, size_t count) {
  const double t = 0.5 * m->thick, bead = 0.35 * m->thick;
  double low = INFINITY, high = -INFINITY;
  for (size_t i = 0; i < m->rim_count; i++) {
    low = fmin(low, m->rim[i].low);
    high = fmax(high, m->rim[i].high);
  }
  for (size_t i = 0; i < m->rim_count; i++) {
    const support s = m->rim[i];
    const double of[2] = {cos(s.angle), sin(s.angle)};
    double(*row)[3] = m->row + 4 * i;
    for (int k = 0; k < 4; k++)
      place(m, &s, m->gap, 0, k == 0 || k == 3 ? low - 0.5 * m->thick : high, row[k]);
    for (int k = 2; k < 4; k++)
      for (int c = 0; c < 2; c++)
        row[k][c] = m->middle[c] + (m->half[c] + t) * fmax(-1, fmin(1, sqrt(2) * of[c]));
  }
  add_rows(m, m->rim_count, 4, true);
  for (size_t i = 0; i < count; i++) {
    const support s = support_at(m, 2 * ABBE_PI * ((double)i + 0.5) / (double)count);
    abbe_mesh ball = {0};
    double p[3];
    place(m, &s, 0.5 * (bead + m->gap), 0, high, p);
    p[2] = height_of_ball(m, p[0], p[1], bead + m->gap, high);
    if (m->result == ABBE_OK) m->result = abbe_shape_sphere(bead, 3, &ball, m->error);
    for (size_t v = 0; v < ball.vertex_count; v++)
      for (int c = 0; c < 3; c++) ball.position[v][c] += p[c];
    add(m, &ball);
  }
}

/* Around an axis along y, its outer side just below the stone. */
static void add_band(making *m, double radius) {
  const double t = m->thick, high = m->bottom - 0.2 * m->thick;
  enum { ROUND = 192 };
  for (int i = 0; i < ROUND; i++)
    for (int k = 0; k < ROD; k++) {
      const double a = 2 * ABBE_PI * i / ROUND, b = 2 * ABBE_PI * k / ROD;
      /* between an ellipse and a rectangle */
      const double flat = pow(pow(fabs(cos(b)), 4) + pow(fabs(sin(b)), 4), -0.25);
      const double r = radius + t + t * flat * cos(b);
      double *at = m->row[i * ROD + k];
      at[0] = m->middle[0] + r * cos(a);
      at[1] = m->middle[1] + 1.3 * t * flat * sin(b);
      at[2] = high - radius - 2 * t + r * sin(a);
    }
  add_rows(m, ROUND, ROD, true);
}

/* ---- all of it ---- */

static abbe_result measure(making *m, const abbe_mesh *stone) {
  double min[3] = {INFINITY, INFINITY, INFINITY}, max[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (size_t v = 0; v < stone->vertex_count; v++)
    for (int k = 0; k < 3; k++) {
      min[k] = fmin(min[k], stone->position[v][k]);
      max[k] = fmax(max[k], stone->position[v][k]);
    }
  for (int k = 0; k < 2; k++) {
    m->middle[k] = 0.5 * (min[k] + max[k]);
    m->half[k] = 0.5 * (max[k] - min[k]);
  }
  m->bottom = min[2];
  m->top = max[2];
  m->width = 2 * fmin(m->half[0], m->half[1]);
  m->gap = ABBE_SETTING_GAP * m->width;
  if (!(m->width > 0) || !(m->top > m->bottom))
    return abbe_error_set(m->error, ABBE_GEOMETRY, "a flat stone cannot be set");
  return ABBE_OK;
}

static abbe_result check(const making *m, const abbe_setting *s) {
  if (m->stone->mesh.face_count > ABBE_SETTING_FACES)
    return abbe_error_set(m->error, ABBE_UNSUPPORTED,
                          "a stone of %zu triangles cannot be set: up to %d; 'flatten' makes a "
                          "scanned one a stone of few facets",
                          m->stone->mesh.face_count, ABBE_SETTING_FACES);
  if (s->count > 0 && (s->count < ABBE_SETTING_LEAST || s->count > ABBE_SETTING_MOST))
    return abbe_error_set(m->error, ABBE_INVALID_ARGUMENT, "a setting has %d to %d prongs or beads",
                          ABBE_SETTING_LEAST, ABBE_SETTING_MOST);
  if (!(s->thick >= 0 && s->thick <= 0.5 * m->width * m->unit))
    return abbe_error_set(m->error, ABBE_INVALID_ARGUMENT,
                          "metal %g m thick is not possible: up to half of the stone's width, %g m",
                          s->thick, 0.5 * m->width * m->unit);
  if (!(s->radius >= 0 && s->radius <= MOST_WIDTHS * m->width * m->unit))
    return abbe_error_set(
        m->error, ABBE_INVALID_ARGUMENT,
        "a band of %g m inside is not possible: up to %g times the stone's width, %g m", s->radius,
        MOST_WIDTHS, MOST_WIDTHS * m->width * m->unit);
  return ABBE_OK;
}

double abbe_setting_pitch(const abbe_setting *setting, double length, double width) {
  const double thick = setting->thick > 0 ? setting->thick : ABBE_SETTING_THICK * width;
  return length + (setting->kind == ABBE_SETTING_CHANNEL ? 2 : 1) * thick;
}

abbe_result abbe_setting_make(const abbe_mesh *stone, const abbe_setting *setting, abbe_mesh *out,
                              abbe_error *error) {
  const abbe_object object = {.mesh = *stone};
  making m = {
      .stone = &object, .unit = setting->unit > 0 ? setting->unit : 1, .out = out, .error = error};
  memset(out, 0, sizeof *out);
  m.result = measure(&m, stone);
  if (m.result == ABBE_OK) m.result = check(&m, setting);
  if (m.result == ABBE_OK) m.result = find_rim(&m);
  const size_t count = setting->count > 0 ? setting->count : 4;
  m.thick = setting->thick > 0 ? setting->thick / m.unit : ABBE_SETTING_THICK * m.width;
  switch (m.result == ABBE_OK ? setting->kind : ABBE_SETTING_COUNT) {
  case ABBE_SETTING_BEZEL:
    add_bezel(&m);
    break;
  case ABBE_SETTING_CHANNEL:
    add_channel(&m);
    break;
  case ABBE_SETTING_BAND:
    add_band(&m, (setting->radius > 0 ? setting->radius : ABBE_SETTING_FINGER) / m.unit);
    break;
  case ABBE_SETTING_PAVE:
    add_pave(&m, count);
    break;
  case ABBE_SETTING_PRONGS:
    add_prongs(&m, count);
    break;
  default:
    break;
  }
  free(m.rim);
  free(m.row);
  free(m.under.mesh.face);
  if (m.result == ABBE_OK) m.result = abbe_mesh_compute_normals(out, ABBE_NORMALS_AUTO, error);
  if (m.result != ABBE_OK) abbe_mesh_free(out);
  return m.result;
}
