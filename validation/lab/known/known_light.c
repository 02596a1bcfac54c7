#include "validation/lab/known/known_light.h"

#include "base/number.h"
#include "scenes/import/scene_file.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

abbe_result abbe_known_add(abbe_known_run *run, abbe_known_answer row, abbe_error *error) {
  abbe_known_answers *out = run->out;
  if (out->count == out->room) {
    size_t room = out->room > 0 ? 2 * out->room : 64;
    abbe_known_answer *bigger = realloc(out->row, room * sizeof *bigger);
    if (bigger == NULL)
      return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for %zu known answers",
                            room);
    out->row = bigger;
    out->room = room;
  }
  row.group = run->group;
  row.error = row.traced - row.exact;
  row.passed = fabs(row.error) <= row.tolerance && /* false for NaN */
               (row.useful <= 0 || row.tolerance <= row.useful);
  out->row[out->count++] = row;
  return ABBE_OK;
}

abbe_result abbe_known_progress(const abbe_known_run *run, double done, abbe_error *error) {
  const abbe_known_options *o = run->options;
  double whole = run->from + (run->to - run->from) * fmin(fmax(done, 0), 1);
  if (o->progress == NULL || o->progress(o->user, whole)) return ABBE_OK;
  return abbe_error_set(error, ABBE_CANCELLED, "the known answers were stopped before their end");
}

enum { TEXT_SIZE = 4096 };

static const char stage_head[] =
    "camera: {eye: [0, -1e4, -1e4], target: [0, 0, -1e5]}\n"
    "lights: [{name: lamp, kind: directional, direction: [0, 0, -1], irradiance: 1}]\n"
    "objects:\n";
static const char stage_floor[] =
    "- {name: far below, shape: rectangle, width: 1e5, height: 1e5, reflectance: 0.5,\n"
    "   transform: [{translate: [0, 0, -1e5]}]}\n";

static abbe_result parse(const char *head, const char *middle, va_list arguments, const char *tail,
                         abbe_scene *out, abbe_error *error) {
  char filled[TEXT_SIZE], text[TEXT_SIZE + sizeof stage_head + sizeof stage_floor];
  *out = (abbe_scene){0};
  int length = abbe_number_format_list(filled, sizeof filled, middle, arguments);
  if (length < 0 || length >= TEXT_SIZE)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a known answer's scene is too long");
  snprintf(text, sizeof text, "%s%s%s", head, filled, tail);
  return abbe_scene_parse(text, strlen(text), "known answer", NULL, out, error);
}

abbe_result abbe_known_scene(abbe_scene *out, abbe_error *error, const char *text, ...) {
  va_list arguments;
  va_start(arguments, text);
  abbe_result result = parse("", text, arguments, "", out, error);
  va_end(arguments);
  return result;
}

abbe_result abbe_known_stage_make(abbe_known_stage *stage, abbe_error *error, const char *objects,
                                  ...) {
  *stage = (abbe_known_stage){0};
  va_list arguments;
  va_start(arguments, objects);
  abbe_result result = parse(stage_head, objects, arguments, stage_floor, &stage->scene, error);
  va_end(arguments);
  if (result == ABBE_OK) result = abbe_geometry_make(&stage->scene, &stage->geometry, error);
  if (result != ABBE_OK) abbe_known_stage_free(stage);
  return result;
}

void abbe_known_stage_free(abbe_known_stage *stage) {
  if (stage == NULL) return;
  abbe_geometry_free(&stage->geometry);
  abbe_scene_free(&stage->scene);
}

abbe_result abbe_known_stage_n(const abbe_known_stage *stage, double lambda_nm, double *n,
                               abbe_error *error) {
  return abbe_material_n(stage->scene.object[0].material, lambda_nm, n, error);
}

abbe_result abbe_known_follow(abbe_known_stage *stage, const double from[3],
                              const double direction[3], double lambda_nm, const char *choices,
                              abbe_error *error) {
  double d[3] = {direction[0], direction[1], direction[2]};
  stage->count = 0;
  if (!abbe_vector_normalise(d))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a ray without a direction");
  return abbe_route_follow(&stage->geometry, from, d, lambda_nm, choices, stage->vertex,
                           ABBE_KNOWN_ROOM, &stage->count, error);
}

double abbe_known_angle(const double a[3], const double b[3]) {
  double across[3];
  abbe_vector_cross(a, b, across);
  return atan2(abbe_vector_length(across), abbe_vector_dot(a, b));
}

/* Golden section: its ratio keeps one of the two inner points at each step. */
double abbe_known_least(abbe_known_function f, void *user, double low, double high) {
  const double ratio = (sqrt(5) - 1) / 2;
  double a = high - ratio * (high - low), b = low + ratio * (high - low);
  double at_a = f(a, user), at_b = f(b, user);
  for (int step = 0; step < 60; step++) {
    if (isnan(at_a) || isnan(at_b)) return NAN;
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - ratio * (high - low);
      at_a = f(a, user);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + ratio * (high - low);
      at_b = f(b, user);
    }
  }
  return fmin(at_a, at_b);
}

enum { PASSES = 64, MIN_PHOTONS = 256 };

size_t abbe_known_passes(const abbe_known_run *run, uint64_t samples, abbe_trace_desc *desc) {
  uint64_t wanted = run->options->samples > 0 ? run->options->samples : samples;
  uint64_t passes = PASSES, photons = wanted / PASSES;
  if (photons > ABBE_TRACER_MAX_PHOTONS) {
    photons = ABBE_TRACER_MAX_PHOTONS;
    passes = wanted / photons;
  }
  desc->photons = photons > MIN_PHOTONS ? (size_t)photons : MIN_PHOTONS;
  desc->seed = (uint32_t)run->options->seed;
  desc->threads = run->options->threads;
  return (size_t)passes;
}

void abbe_known_narrow(double lambda_nm, abbe_trace_desc *desc) {
  desc->min_nm = lambda_nm - 0.05;
  desc->max_nm = lambda_nm + 0.05;
}

/* The rings' sums of the mean so far. */
static abbe_result sum_so_far(const abbe_tracer *tracer, const abbe_rings *rings, double (*sum)[3],
                              abbe_error *error) {
  static const char *const names[3] = {"X", "Y", "Z"};
  double one[ABBE_RINGS_MAX];
  ABBE_OWNED(abbe_image, map) = {0};
  ABBE_TRY(abbe_tracer_map(tracer, &map, error));
  for (int k = 0; k < 3; k++) {
    size_t channel = abbe_image_find_channel(&map, names[k]);
    if (channel == (size_t)-1 || map.width != rings->width || map.height != rings->height)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "the receiver map has no channel %s of %zu x %zu texels", names[k],
                            rings->width, rings->height);
    abbe_rings_sum(rings, map.data + channel, map.channels, false, one);
    for (size_t i = 0; i < rings->count; i++) sum[i][k] = one[i];
  }
  return ABBE_OK;
}

/* The last pass alone is k times the mean of k passes less k - 1 times that of k - 1. */
static abbe_result one_pass(abbe_tracer *tracer, const abbe_rings *rings, double k,
                            double (*mean)[3], double (*sum)[3], abbe_error *error) {
  double before[ABBE_RINGS_MAX][3];
  memcpy(before, mean, rings->count * sizeof *mean);
  ABBE_TRY(abbe_tracer_pass(tracer, NULL, error));
  ABBE_TRY(sum_so_far(tracer, rings, mean, error));
  for (size_t i = 0; i < rings->count; i++)
    for (int c = 0; c < 3; c++) sum[i][c] = k * mean[i][c] - (k - 1) * before[i][c];
  return ABBE_OK;
}

abbe_result abbe_known_measure(const abbe_known_run *run, double from, double to,
                               const abbe_scene *scene, const abbe_trace_desc *desc, size_t passes,
                               const abbe_rings *rings, double (*sum)[3], abbe_error *error) {
  abbe_trace_desc d = *desc;
  d.no_picture = true;
  d.map_width = rings->width;
  d.map_height = rings->height;
  d.layout = &rings->layout;
  double mean[ABBE_RINGS_MAX][3] = {{0}};
  ABBE_HELD(abbe_tracer, tracer) = NULL;
  ABBE_TRY(abbe_tracer_make(scene, &d, &tracer, error));
  for (size_t p = 0; p < passes; p++) {
    ABBE_TRY(one_pass(tracer, rings, (double)p + 1, mean, sum + p * rings->count, error));
    double done = from + (to - from) * (double)(p + 1) / (double)passes;
    ABBE_TRY(abbe_known_progress(run, done, error));
  }
  return ABBE_OK;
}

void abbe_known_mean(double (*sum)[3], size_t passes, size_t rings, size_t first, size_t end,
                     int channel, double *mean, double *standard_error) {
  double n = (double)passes, total = 0, square = 0;
  for (int round = 0; round < 2; round++)
    for (size_t p = 0; p < passes; p++) {
      double x = 0;
      for (size_t i = first; i < end; i++) x += sum[p * rings + i][channel];
      if (round == 0)
        total += x / n;
      else
        square += (x - total) * (x - total);
    }
  *mean = total;
  *standard_error = passes > 1 ? sqrt(square / (n - 1) / n) : INFINITY;
}

double abbe_known_sigmas(size_t passes) {
  double tail = gsl_cdf_ugaussian_Q(ABBE_KNOWN_SIGMAS);
  return passes > 1 ? gsl_cdf_tdist_Qinv(tail, (double)passes - 1) : INFINITY;
}

/* The value of all passes so far. */
static abbe_result value_so_far(const abbe_tracer *tracer, const abbe_known_setting *s,
                                double *value, abbe_error *error) {
  abbe_trace_statistics statistics;
  abbe_tracer_statistics(tracer, &statistics);
  const abbe_light_ledger *l = &statistics.ledger;
  *value = l->reached;
  if (s->channel == NULL) return ABBE_OK;
  const struct {
    const char *channel;
    double value;
  } ledger[] = {{"turned", l->turned / l->reached},
                {"yield", l->quanta[1] / l->quanta[0]},
                {"deposited", l->deposited / l->reached},
                {"closed", (l->deposited + l->absorbed + l->missed + l->lost + l->excited) /
                               (l->reached + l->glowing)}};
  for (size_t i = 0; i < sizeof ledger / sizeof *ledger; i++) {
    if (strcmp(s->channel, ledger[i].channel) != 0) continue;
    *value = ledger[i].value;
    return ABBE_OK;
  }
  abbe_image picture = {0};
  abbe_result result = abbe_tracer_picture(tracer, &picture, error);
  if (result != ABBE_OK) return result;
  const size_t at = abbe_image_find_channel(&picture, s->channel);
  const size_t pixels = picture.width * picture.height;
  if (at >= picture.channels)
    result =
        abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the picture has no channel %s", s->channel);
  *value = 0;
  for (size_t i = 0; result == ABBE_OK && i < pixels; i++) {
    const double x = (2 * (double)(i % picture.width) + 1) / (double)picture.width - 1;
    const double y = 1 - (2 * (double)(i / picture.width) + 1) / (double)picture.height;
    const double weight = s->weight != NULL ? s->weight(x, y) : 1;
    *value += weight * (double)picture.data[i * picture.channels + at] / (double)pixels;
  }
  abbe_image_free(&picture);
  return result;
}

static abbe_result add_mean(abbe_known_run *run, const abbe_known_setting *s, double (*sum)[3],
                            size_t passes, abbe_error *error) {
  abbe_known_answer row = {
      .unit = s->unit, .exact = s->exact, .useful = s->useful, .reason = s->reason};
  abbe_known_mean(sum, passes, 1, 0, 1, 1, &row.traced, &row.standard_error);
  row.tolerance = abbe_known_sigmas(passes) * row.standard_error + s->slack;
  snprintf(row.quantity, sizeof row.quantity, "%s", s->what);
  return abbe_known_add(run, row, error);
}

abbe_result abbe_known_add_setting(abbe_known_run *run, const abbe_known_setting *setting,
                                   const abbe_scene *scene, double from, double to,
                                   abbe_error *error) {
  abbe_tracer *tracer = NULL;
  abbe_trace_desc desc = {
      .no_map = true, .space = ABBE_RGB_SPACE_XYZ, .width = setting->side, .height = setting->side};
  desc.physics.once = setting->once;
  desc.min_nm = setting->min_nm;
  desc.max_nm = setting->max_nm;
  if (setting->lambda_nm > 0) abbe_known_narrow(setting->lambda_nm, &desc);
  if (setting->polarised) desc.polarisation = ABBE_TRACE_POLARISATION_ON;
  const size_t passes = abbe_known_passes(run, setting->samples, &desc);
  double(*sum)[3] = calloc(passes, sizeof *sum), before = 0, mean = 0;
  abbe_result result = sum != NULL ? abbe_tracer_make(scene, &desc, &tracer, error)
                                   : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for passes");
  for (size_t p = 0; p < passes && result == ABBE_OK; p++) {
    result = abbe_tracer_pass(tracer, NULL, error);
    if (result == ABBE_OK) result = value_so_far(tracer, setting, &mean, error);
    sum[p][1] = ((double)p + 1) * mean - (double)p * before;
    before = mean;
    const double done = from + (to - from) * (double)(p + 1) / (double)passes;
    if (result == ABBE_OK) result = abbe_known_progress(run, done, error);
  }
  if (result == ABBE_OK) result = add_mean(run, setting, sum, passes, error);
  abbe_tracer_free(tracer);
  free(sum);
  return result;
}
