#include "validation/trace/transport/environment_light.h"

#include "base/maths.h"
#include "colorimetry/upsampling.h"
#include "validation/trace/transport/lamp_place.h"

#include <stdlib.h>
#include <string.h>

static void set_lift(const abbe_upsampling *up, double lambda_nm, float out[3]) {
  for (int j = 0; j < 3; j++) {
    double rgb[3] = {0};
    rgb[j] = 1;
    out[j] = (float)abbe_upsampling_at(up, rgb, lambda_nm);
  }
}

/* Mean over the steps of each band, which hold equal shares of probability, by the power that they
 * carry. */
static void set_bands(const abbe_spectral_sampling *s, const abbe_bands *b,
                      abbe_environment_light *e) {
  const float *power = s->power + e->light * s->steps;
  double sum[ABBE_BANDS_MAX][4] = {{0}};
  for (size_t k = 0; k < s->steps; k++) {
    double *to = sum[b->of_step[k]];
    for (int j = 0; j < 3; j++) to[j] += (double)power[k] * (double)e->lift[k][j];
    to[3] += (double)power[k];
  }
  for (size_t i = 0; i < b->count; i++)
    for (int j = 0; j < 3; j++) e->band[i][j] = sum[i][3] > 0 ? (float)(sum[i][j] / sum[i][3]) : 0;
}

static void set_colour(const abbe_upsampling *up, abbe_rgb_space space, float out[9]) {
  double matrix[9];
  abbe_rgb_space_from_xyz(space, matrix);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      double sum = 0;
      for (int k = 0; k < 3; k++) sum += matrix[3 * i + k] * up->to_xyz[3 * k + j];
      out[3 * i + j] = (float)sum;
    }
}

/* The ball around the middle of an object's bounds. */
static void surround(const abbe_geometry *g, const abbe_object *o, float ball[4]) {
  double middle[3], square = 0;
  for (int k = 0; k < 3; k++) middle[k] = 0.5 * (o->min[k] + o->max[k]);
  for (size_t i = 0; i < o->mesh.vertex_count; i++) {
    double off = 0;
    for (int k = 0; k < 3; k++) off += pow(o->mesh.position[i][k] - middle[k], 2);
    square = fmax(square, off);
  }
  double radius = o->exact.kind == ABBE_EXACT_SPHERE ? o->exact.radius : sqrt(square);
  abbe_geometry_to_frame(g, middle, ball);
  ball[3] = (float)(radius / g->unit * 1.00001);
}

static void set_balls(const abbe_geometry *g, abbe_environment_light *e) {
  double min[3], max[3], far = 0;
  for (size_t i = 0; i < g->scene->object_count; i++) {
    if ((g->surface[i].kind & ABBE_GEOMETRY_SPECULAR) == 0) continue;
    float *ball = e->ball[e->ball_count++];
    surround(g, &g->scene->object[i], ball);
    e->area += 3.14159265358979 * pow((double)ball[3] * g->unit, 2);
  }
  abbe_scene_bounds(g->scene, true, true, min, max);
  abbe_scene_hold_lights(g->scene, min, max);
  for (int k = 0; k < 3; k++)
    far += pow(fmax(fabs(min[k] - g->origin[k]), fabs(max[k] - g->origin[k])) / g->unit, 2);
  e->far = (float)(1.01 * sqrt(far));
}

abbe_result abbe_environment_light_make(const abbe_geometry *g, const abbe_spectral_sampling *s,
                                        const abbe_bands *bands, abbe_rgb_space space,
                                        abbe_environment_light *out, abbe_error *error) {
  *out = (abbe_environment_light){0};
  const abbe_environment *environment = g->scene->environment;
  if (environment == NULL) return ABBE_OK;
  abbe_environment_light e = {.environment = environment, .light = g->scene->light_count};
  abbe_upsampling up;
  ABBE_TRY(abbe_upsampling_make_by(s->observer, &environment->illuminant, s->lambda_nm[0],
                                   s->lambda_nm[s->steps], &up, error));
  e.lift = calloc(s->steps, sizeof *e.lift);
  e.band = calloc(bands->count + 1, sizeof *e.band);
  e.ball = calloc(g->refractor_count + g->mirror_count + 1, sizeof *e.ball);
  *out = e;
  if (e.lift == NULL || e.band == NULL || e.ball == NULL) {
    abbe_environment_light_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the environment's spectra");
  }
  for (size_t k = 0; k < s->steps; k++)
    set_lift(&up, 0.5 * (s->lambda_nm[k] + s->lambda_nm[k + 1]), e.lift[k]);
  if (bands->count > 0) set_bands(s, bands, &e);
  set_colour(&up, space, e.to_colour);
  set_balls(g, &e);
  *out = e;
  return ABBE_OK;
}

void abbe_environment_light_free(abbe_environment_light *e) {
  if (e == NULL) return;
  free(e->lift);
  free(e->band);
  free(e->ball);
  *e = (abbe_environment_light){0};
}

static void radiance(const abbe_environment_light *e, const double direction[3], float rgb[3]) {
  double seen[3];
  abbe_environment_radiance(e->environment, direction, seen);
  for (int k = 0; k < 3; k++) rgb[k] = (float)seen[k];
}

static void unit_of(const float d[3], double out[3]) {
  double length = 0;
  for (int k = 0; k < 3; k++) length += (double)d[k] * (double)d[k];
  length = sqrt(length);
  for (int k = 0; k < 3; k++) out[k] = (double)d[k] / length;
}

void abbe_environment_light_seen(const abbe_environment_light *e, const float d[3], float rgb[3]) {
  double direction[3];
  unit_of(d, direction);
  radiance(e, direction, rgb);
}

float abbe_environment_light_pdf(const abbe_environment_light *e, const float d[3]) {
  double direction[3];
  unit_of(d, direction);
  return (float)abbe_environment_pdf(e->environment, direction);
}

void abbe_environment_light_sample(const abbe_environment_light *e, const double u[3], float d[3],
                                   float *pdf, float rgb[3]) {
  double direction[3], density, seen[3];
  abbe_environment_sample(e->environment, u, direction, &density, seen);
  for (int k = 0; k < 3; k++) rgb[k] = (float)seen[k];
  for (int k = 0; k < 3; k++) d[k] = (float)direction[k];
  *pdf = (float)density;
}

/* How many balls the line through p along d meets. */
static size_t balls_on(const abbe_environment_light *e, const float p[3], const float d[3]) {
  size_t count = 0;
  for (size_t i = 0; i < e->ball_count; i++) {
    float to[3], along = 0, square = 0;
    for (int k = 0; k < 3; k++) {
      to[k] = e->ball[i][k] - p[k];
      along += to[k] * d[k];
    }
    for (int k = 0; k < 3; k++) square += (to[k] - along * d[k]) * (to[k] - along * d[k]);
    count += square <= e->ball[i][3] * e->ball[i][3];
  }
  return count;
}

/* The ball of the share u of all disks' area. */
static size_t choose_ball(const abbe_environment_light *e, double u) {
  double sum = 0, below = 0;
  for (size_t i = 0; i < e->ball_count; i++) sum += pow((double)e->ball[i][3], 2);
  for (size_t i = 0; i + 1 < e->ball_count; i++) {
    below += pow((double)e->ball[i][3], 2);
    if (u * sum < below) return i;
  }
  return e->ball_count - 1;
}

void abbe_environment_light_ray(const abbe_environment_light *e, const double u[6], float o[3],
                                float d[3], float rgb[3]) {
  float towards[3], pdf, x[3], y[3], p[3];
  abbe_environment_light_sample(e, u, towards, &pdf, rgb);
  for (int k = 0; k < 3; k++) d[k] = -towards[k];
  const float *ball = e->ball[choose_ball(e, u[3])];
  const float r = ball[3] * sqrtf((float)u[4]), angle = 6.28318531f * (float)u[5];
  abbe_geometry_across(d, x, y);
  for (int k = 0; k < 3; k++) p[k] = ball[k] + r * (cosf(angle) * x[k] + sinf(angle) * y[k]);
  float along = 0;
  for (int k = 0; k < 3; k++) along += p[k] * d[k];
  for (int k = 0; k < 3; k++) o[k] = p[k] - (along + e->far) * d[k];
  size_t count = balls_on(e, p, d);
  const float flux = (float)e->area / (pdf * (float)(count > 0 ? count : 1));
  for (int k = 0; k < 3; k++) rgb[k] *= flux;
}

/* ---- how bright lights are ---- */

static void count_in(abbe_light_range *r, double radiance) {
  if (!(radiance > 0)) return;
  r->least = fmin(r->least, radiance);
  r->greatest = fmax(r->greatest, radiance);
}

static double radiance_of(const abbe_geometry *g, const abbe_light *light) {
  double square = 1, power = light->power;
  if (light->kind == ABBE_LIGHT_DISK) power *= 3.14159 * light->radius * light->radius;
  if (light->kind == ABBE_LIGHT_RECTANGLE) power *= abbe_light_area(light);
  if (light->kind != ABBE_LIGHT_DIRECTIONAL) {
    square = 0;
    for (int k = 0; k < 3; k++) square += pow(light->position[k] - g->origin[k], 2);
  }
  return power / fmax(square, 1e-6 * g->unit * g->unit);
}

void abbe_light_range_find(const abbe_geometry *geometry, abbe_light_range *out) {
  const abbe_scene *scene = geometry->scene;
  *out = (abbe_light_range){.least = INFINITY};
  count_in(out, scene->ambient);
  count_in(out, scene->background);
  if (scene->environment != NULL) count_in(out, scene->environment->luminance);
  for (size_t l = 0; l < scene->light_count; l++)
    count_in(out, radiance_of(geometry, &scene->light[l]));
  if (!(out->greatest > 0)) *out = (abbe_light_range){1, 1};
}
