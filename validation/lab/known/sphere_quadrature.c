#include "validation/lab/known/known_light.h"

#include "base/maths.h"
#include "colorimetry/weights.h"
#include "spectral/optics.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <math.h>
#include <stdlib.h>

enum { OUTSIDE = -1, GRID = 1024, WORKSPACE = 256, MAX_CUTS = 64, MAX_BANDS = 4096 };

/* One way through the sphere: `order` reflections inside, or the one outside. The angle that runs
 * over it is that of refraction where the sphere is the thinner medium, else that of incidence:
 * so everything is smooth up to the ends. */
typedef struct branch {
  int order;
  bool by_refraction;
  double from, to;
} branch;

/* A part of a branch whose rays reach the plane, their place x monotone from x_from to x_to. */
typedef struct piece {
  branch way;
  double from, to, x_from, x_to;
} piece;

struct abbe_sphere_quadrature {
  abbe_sphere_setup setup;
  size_t piece_count, piece_room, fold_count, fold_room;
  piece *pieces;
  double *fold;
  gsl_integration_workspace *workspace;
};

/* A ray of a branch in its meridional plane. b and phi say all about it after the sphere: it leaves
 * at the signed distance b from the centre at which it came, in a direction phi from straight
 * down, as the sphere keeps a ray's moment about its centre. Primed: per angle. */
typedef struct ray {
  double cos_i, cos_t;
  double b, b_slope;
  double phi, phi_slope;
  double flux; /* W per radian of the running angle, before Fresnel and absorption */
} ray;

static ray ray_at(const abbe_sphere_setup *s, branch way, double angle) {
  const double n = s->index, R = s->radius;
  double sine = sin(angle), cosine = cos(angle), i, t, i_slope = 1, t_slope = 1, sin_i;
  ray r = {0};
  if (way.by_refraction) {
    sin_i = n * sine;
    r.cos_t = cosine;
    r.cos_i = sqrt((1 - sin_i) * (1 + sin_i));
    i = asin(sin_i);
    t = angle;
    i_slope = n * r.cos_t / r.cos_i;
  } else {
    double sin_t = fmin(sine / n, 1);
    sin_i = sine;
    r.cos_i = cosine;
    r.cos_t = sqrt((1 - sin_t) * (1 + sin_t));
    i = angle;
    t = n == 1 ? angle : asin(sin_t);
    t_slope = n == 1 ? 1 : r.cos_i / (n * r.cos_t);
  }
  double alpha = 0, alpha_slope = 0; /* angle of the incoming ray, from straight down */
  if (s->light_distance > 0) {
    double q = R / s->light_distance, cos_alpha = sqrt((1 - q * sin_i) * (1 + q * sin_i));
    alpha = asin(q * sin_i);
    alpha_slope = q * r.cos_i * i_slope / cos_alpha;
    r.flux = s->power * 2 * ABBE_PI * q * sin_i * alpha_slope;
  } else {
    r.flux = s->power * ABBE_PI * R * R * 2 * sin_i * r.cos_i * i_slope;
  }
  r.b = R * sin_i;
  r.b_slope = R * r.cos_i * i_slope;
  if (way.order == OUTSIDE) {
    r.phi = alpha + ABBE_PI - 2 * i;
    r.phi_slope = alpha_slope - 2 * i_slope;
  } else {
    r.phi = alpha - 2 * (i - t) - way.order * (ABBE_PI - 2 * t);
    r.phi_slope = alpha_slope - 2 * i_slope + 2 * (way.order + 1) * t_slope;
  }
  return r;
}

/* Share of the ray's light that is left when it leaves. */
static double share_of(const abbe_sphere_setup *s, branch way, const ray *r) {
  bool total = way.order == OUTSIDE && s->index < 1 && !way.by_refraction;
  double reflected = total ? 1 : abbe_optics_fresnel(r->cos_i, 1 / s->index);
  if (way.order == OUTSIDE) return reflected;
  double inside = 2 * s->radius * r->cos_t * (way.order + 1);
  return (1 - reflected) * (1 - reflected) * pow(reflected, way.order) *
         abbe_optics_transmittance(s->attenuation_per_m, inside);
}

/* The place is x = (b + h sin phi)
 * cos phi; cos^2 phi dx/dangle has the sign of its slope. */
static double landing(const abbe_sphere_setup *s, const ray *r) {
  return (r->b + s->plane_distance * sin(r->phi)) / cos(r->phi);
}

/* ---- functions of the angle whose zeros cut a branch ---- */

typedef double (*angle_function)(const abbe_sphere_setup *s, branch way, double angle, double x);

static double turning(const abbe_sphere_setup *s, branch way, double angle, double x) {
  (void)x;
  return ray_at(s, way, angle).phi_slope;
}

static double downward(const abbe_sphere_setup *s, branch way, double angle, double x) {
  (void)x;
  return cos(ray_at(s, way, angle).phi);
}

static double spreading(const abbe_sphere_setup *s, branch way, double angle, double x) {
  (void)x;
  ray r = ray_at(s, way, angle);
  return r.b_slope * cos(r.phi) + r.phi_slope * (r.b * sin(r.phi) + s->plane_distance);
}

/* Has the sign of the ray's place less x where the ray goes down; finite where the place is not. */
static double beyond(const abbe_sphere_setup *s, branch way, double angle, double x) {
  ray r = ray_at(s, way, angle);
  return r.b + s->plane_distance * sin(r.phi) - x * cos(r.phi);
}

/* Where f changes sign between a and b, to the last bit of the angle. */
static double bisect(const abbe_sphere_setup *s, branch way, angle_function f, double x, double a,
                     double b) {
  bool sign = f(s, way, a, x) > 0;
  for (int step = 0; step < 100; step++) {
    double middle = a + (b - a) / 2;
    if (middle == a || middle == b) break;
    if ((f(s, way, middle, x) > 0) == sign)
      a = middle;
    else
      b = middle;
  }
  return a + (b - a) / 2;
}

typedef struct cuts {
  size_t count;
  double at[MAX_CUTS];
} cuts;

/* The part's ends and, between them, the sign changes of f on a grid. The ends may be zeros of f:
 * the grid's signs are taken a little inside. */
static cuts cut(const abbe_sphere_setup *s, branch way, angle_function f, double from, double to) {
  cuts c = {.count = 1, .at = {from}};
  double step = (to - from) / GRID, inset = 1e-9 * (to - from), before = from + inset;
  bool sign = f(s, way, before, 0) > 0;
  for (int k = 1; k <= GRID && c.count + 1 < MAX_CUTS; k++) {
    double here = k < GRID ? from + k * step : to - inset;
    bool next = f(s, way, here, 0) > 0;
    if (next != sign) c.at[c.count++] = bisect(s, way, f, 0, before, here);
    sign = next;
    before = here;
  }
  c.at[c.count++] = to;
  return c;
}

/* ---- pieces ---- */

static bool grow(void **items, size_t *room, size_t count, size_t size) {
  if (count < *room) return true;
  size_t wanted = *room > 0 ? 2 * *room : 16;
  void *bigger = realloc(*items, wanted * size);
  if (bigger == NULL) return false;
  *items = bigger;
  *room = wanted;
  return true;
}

/* At an end where the rays run level, the place is infinite on the side they run to. */
static double end_landing(const abbe_sphere_setup *s, branch way, double angle) {
  ray r = ray_at(s, way, angle);
  if (fabs(cos(r.phi)) < 1e-12) return sin(r.phi) > 0 ? INFINITY : -INFINITY;
  return landing(s, &r);
}

static bool add_piece(abbe_sphere_quadrature *q, branch way, double from, double to) {
  if (!(to > from)) return true;
  if (!grow((void **)&q->pieces, &q->piece_room, q->piece_count, sizeof *q->pieces)) return false;
  piece p = {.way = way, .from = from, .to = to};
  p.x_from = end_landing(&q->setup, way, from);
  p.x_to = end_landing(&q->setup, way, to);
  q->pieces[q->piece_count++] = p;
  return true;
}

static bool add_fold(abbe_sphere_quadrature *q, branch way, double angle) {
  if (!grow((void **)&q->fold, &q->fold_room, q->fold_count, sizeof *q->fold)) return false;
  q->fold[q->fold_count++] = fabs(end_landing(&q->setup, way, angle));
  return true;
}

/* First where the turning has its extremes (so that between two cuts phi passes each level
 * direction once), then where the rays run level, then where the place turns back. */
static bool add_branch(abbe_sphere_quadrature *q, branch way) {
  const abbe_sphere_setup *s = &q->setup;
  cuts turns = cut(s, way, turning, way.from, way.to);
  for (size_t a = 0; a + 1 < turns.count; a++) {
    cuts levels = cut(s, way, downward, turns.at[a], turns.at[a + 1]);
    for (size_t b = 0; b + 1 < levels.count; b++) {
      double middle = (levels.at[b] + levels.at[b + 1]) / 2;
      if (downward(s, way, middle, 0) <= 0) continue;
      cuts folds = cut(s, way, spreading, levels.at[b], levels.at[b + 1]);
      for (size_t c = 0; c + 1 < folds.count; c++) {
        if (!add_piece(q, way, folds.at[c], folds.at[c + 1])) return false;
        if (c > 0 && !add_fold(q, way, folds.at[c])) return false;
      }
    }
  }
  return true;
}

static bool add_branches(abbe_sphere_quadrature *q) {
  const abbe_sphere_setup *s = &q->setup;
  bool thin = s->index < 1;
  for (size_t k = s->without_direct_order ? 1 : 0; k <= s->inner_orders; k++) {
    branch inside = {.order = (int)k, .by_refraction = thin, .from = 0, .to = ABBE_PI / 2};
    if (!add_branch(q, inside)) return false;
  }
  if (!s->outside) return true;
  branch outer = {.order = OUTSIDE, .by_refraction = thin, .from = 0, .to = ABBE_PI / 2};
  if (!add_branch(q, outer)) return false;
  branch total = {.order = OUTSIDE, .from = thin ? asin(s->index) : 0, .to = ABBE_PI / 2};
  return !thin || add_branch(q, total);
}

/* ---- making ---- */

static abbe_result check(const abbe_sphere_setup *s, abbe_error *error) {
  const struct {
    const char *name;
    double value;
    bool right;
    const char *wanted;
  } members[] = {
      {"radius", s->radius, s->radius > 0, "positive"},
      {"index", s->index, s->index >= 0.1 && s->index <= 10, "from 0.1 to 10"},
      {"light_distance", s->light_distance, s->light_distance == 0 || s->light_distance > s->radius,
       "0 or more than the radius"},
      {"plane_distance", s->plane_distance, s->plane_distance > s->radius, "more than the radius"},
      {"power", s->power, s->power >= 0, "0 or more"},
      {"attenuation_per_m", s->attenuation_per_m, s->attenuation_per_m >= 0, "0 or more"},
  };
  for (size_t i = 0; i < sizeof members / sizeof *members; i++)
    if (!members[i].right || !isfinite(members[i].value))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the sphere's %s is %g; it must be %s",
                            members[i].name, members[i].value, members[i].wanted);
  if (s->inner_orders > ABBE_SPHERE_MAX_ORDERS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%zu inner orders are more than %d",
                          s->inner_orders, ABBE_SPHERE_MAX_ORDERS);
  return ABBE_OK;
}

abbe_result abbe_sphere_quadrature_make(const abbe_sphere_setup *setup,
                                        abbe_sphere_quadrature **out, abbe_error *error) {
  *out = NULL;
  ABBE_TRY(check(setup, error));
  abbe_sphere_quadrature *q = calloc(1, sizeof *q);
  if (q != NULL) {
    q->setup = *setup;
    abbe_gsl_guard_enter();
    q->workspace = gsl_integration_workspace_alloc(WORKSPACE);
    abbe_gsl_guard_leave();
  }
  if (q == NULL || q->workspace == NULL || !add_branches(q)) {
    abbe_sphere_quadrature_free(q);
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for a sphere's quadrature");
  }
  *out = q;
  return ABBE_OK;
}

void abbe_sphere_quadrature_free(abbe_sphere_quadrature *quadrature) {
  if (quadrature == NULL) return;
  if (quadrature->workspace != NULL) gsl_integration_workspace_free(quadrature->workspace);
  free(quadrature->pieces);
  free(quadrature->fold);
  free(quadrature);
}

size_t abbe_sphere_quadrature_folds(const abbe_sphere_quadrature *quadrature,
                                    const double **radius_m) {
  *radius_m = quadrature->fold;
  return quadrature->fold_count;
}

/* ---- integrals ---- */

typedef struct integrand {
  const abbe_sphere_setup *setup;
  branch way;
} integrand;

static double flux_at(double angle, void *user) {
  const integrand *f = user;
  ray r = ray_at(f->setup, f->way, angle);
  return r.flux * share_of(f->setup, f->way, &r);
}

/* What falls on the sphere at all: the scale of the absolute error. */
static double incident(const abbe_sphere_setup *s) {
  if (s->light_distance <= 0) return s->power * ABBE_PI * s->radius * s->radius;
  double q = s->radius / s->light_distance;
  return s->power * 2 * ABBE_PI * q * q / (1 + sqrt((1 - q) * (1 + q)));
}

/* The angle of the piece at which its place is x, or the end beyond which x lies. */
static double angle_of(const abbe_sphere_setup *s, const piece *p, double x) {
  bool rising = p->x_to > p->x_from;
  double low = rising ? p->from : p->to, high = rising ? p->to : p->from;
  if (x <= fmin(p->x_from, p->x_to)) return low;
  if (x >= fmax(p->x_from, p->x_to)) return high;
  return bisect(s, p->way, beyond, x, fmin(low, high), fmax(low, high));
}

static abbe_result integrate(const abbe_sphere_quadrature *q, const piece *p, double radius_m,
                             double *flux_w, abbe_error *error) {
  integrand f = {.setup = &q->setup, .way = p->way};
  gsl_function function = {.function = flux_at, .params = &f};
  double a = angle_of(&q->setup, p, -radius_m), b = angle_of(&q->setup, p, radius_m);
  double value = 0, estimate = 0, scale = incident(&q->setup);
  if (a == b || scale <= 0) return ABBE_OK;
  int code = gsl_integration_qag(&function, fmin(a, b), fmax(a, b), 1e-11 * scale, 1e-11, WORKSPACE,
                                 GSL_INTEG_GAUSS31, q->workspace, &value, &estimate);
  /* Rounding is reported where the sum is as good as doubles allow. */
  if (code != GSL_SUCCESS && !(code == GSL_EROUND && estimate < 1e-10 * scale))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the light of order %d within %g m cannot be integrated: %s",
                          p->way.order, radius_m, gsl_strerror(code));
  *flux_w += value;
  return ABBE_OK;
}

/* Light that misses the sphere. */
static double flux_past(const abbe_sphere_setup *s, double radius_m) {
  if (s->light_distance <= 0)
    return s->power * ABBE_PI * fmax(0, (radius_m - s->radius) * (radius_m + s->radius));
  double q = s->radius / s->light_distance, edge = sqrt((1 - q) * (1 + q));
  double here = cos(atan2(radius_m, s->light_distance + s->plane_distance));
  return s->power * 2 * ABBE_PI * fmax(0, edge - here);
}

abbe_result abbe_sphere_quadrature_enclosed(const abbe_sphere_quadrature *quadrature,
                                            double radius_m, double *flux_w, abbe_error *error) {
  if (!(radius_m >= 0))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a circle of radius %g m is none; it must be 0 or more", radius_m);
  abbe_result result = ABBE_OK;
  *flux_w = quadrature->setup.past ? flux_past(&quadrature->setup, radius_m) : 0;
  abbe_gsl_guard_enter();
  for (size_t i = 0; i < quadrature->piece_count && result == ABBE_OK; i++)
    result = integrate(quadrature, &quadrature->pieces[i], radius_m, flux_w, error);
  abbe_gsl_guard_leave();
  return result;
}

static abbe_result add_band(const abbe_sphere_setup *setup, const double weight[3],
                            const double *radius_m, size_t count, double (*xyz)[3],
                            abbe_error *error) {
  abbe_sphere_quadrature *q = NULL;
  abbe_result result = abbe_sphere_quadrature_make(setup, &q, error);
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    double flux = 0;
    result = abbe_sphere_quadrature_enclosed(q, radius_m[i], &flux, error);
    for (int k = 0; k < 3; k++) xyz[i][k] += weight[k] * flux;
  }
  abbe_sphere_quadrature_free(q);
  return result;
}

abbe_result abbe_sphere_quadrature_xyz(const abbe_sphere_setup *setup,
                                       const abbe_material *material,
                                       const abbe_illuminant *illuminant, double min_nm,
                                       double max_nm, size_t bands, const double *radius_m,
                                       size_t count, double (*xyz)[3], abbe_error *error) {
  if (bands < 1 || bands > MAX_BANDS || !(min_nm > 0) || !(max_nm > min_nm) || !isfinite(max_nm))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu bands from %g to %g nm are no cut of a range; 1 to %d bands, "
                          "wavelengths ascending",
                          bands, min_nm, max_nm, MAX_BANDS);
  for (size_t i = 0; i < count; i++) xyz[i][0] = xyz[i][1] = xyz[i][2] = 0;
  double width = (max_nm - min_nm) / (double)bands;
  for (size_t i = 0; i < bands; i++) {
    double from = min_nm + width * (double)i, weight[3];
    abbe_sphere_setup one = *setup;
    abbe_weights_band_xyz(illuminant, min_nm, max_nm, from, from + width, weight);
    one.attenuation_per_m = abbe_material_attenuation(material, from + width / 2);
    ABBE_TRY(abbe_material_n(material, from + width / 2, &one.index, error));
    ABBE_TRY(add_band(&one, weight, radius_m, count, xyz, error));
  }
  return ABBE_OK;
}
