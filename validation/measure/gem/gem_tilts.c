#include "validation/measure/gem/gem_judgement.h"

#include "base/maths.h"
#include "colorimetry/difference.h"
#include "validation/measure/gem/gem_view.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { CURVES = ABBE_GEM_TILT_CURVE_COUNT, REPEATS = ABBE_GEM_MOST_REPEATS };

static const char *const names[] = {
#define ABBE_GEM_TILT_NAME(code, name) name,
    ABBE_GEM_TILT_CURVES(ABBE_GEM_TILT_NAME)
#undef ABBE_GEM_TILT_NAME
};

const char *abbe_gem_tilt_curve_name(abbe_gem_tilt_curve curve) {
  return (unsigned)curve < CURVES ? names[curve] : "unknown";
}

void abbe_gem_tilts_free(abbe_gem_tilts *tilts) {
  if (tilts == NULL) return;
  free(tilts->tilt_rad);
  for (int c = 0; c < CURVES; c++) free(tilts->curve[c]);
  memset(tilts, 0, sizeof *tilts);
}

/* ---- one place of the stone ---- */

typedef enum state { MISSED, DARK, LIT } state;

typedef struct frame {
  double met[REPEATS], sum[CURVES][REPEATS];
  unsigned char *state; /* [side][side][repeats] */
} frame;

typedef struct work {
  const abbe_gem_stone *stone;
  const abbe_weights *weights;
  size_t side, repeats;
  double head_rad;
} work;

/* Whether a colour is far enough from grey of its lightness. */
static bool is_fire(const double xyz[3], const double white[3]) {
  double lab[3];
  abbe_difference_lab(xyz, white, lab);
  const double grey[3] = {lab[0], 0, 0};
  return abbe_difference_ciede2000(lab, grey) > ABBE_GEM_FIRE_DIFFERENCE;
}

static state follow(const work *w, const abbe_gem_light *light, const abbe_gem_lamps *lamps,
                    const double p[3], const double n[3], const double d[3], uint32_t seed,
                    double sum[CURVES]) {
  static const abbe_gem_amount source[CURVES] = {
      [ABBE_GEM_TILT_ISO] = ABBE_GEM_ISO,
      [ABBE_GEM_TILT_COS] = ABBE_GEM_COS,
      [ABBE_GEM_TILT_RETURN] = ABBE_GEM_RETURN,
      [ABBE_GEM_TILT_DOWN] = ABBE_GEM_DOWN,
  };
  const double *white = w->weights->sum;
  abbe_gem_path path;
  double xyz[3] = {0};
  for (size_t k = 0; k < w->stone->wavelengths; k++) {
    float amount[ABBE_GEM_AMOUNT_COUNT];
    abbe_gem_path_follow(w->stone, k, p, n, d, seed, &path);
    abbe_gem_light_judge(light, &path, amount);
    const double lit = (double)abbe_gem_lamps_light(lamps, &path);
    const double *weight = w->weights->weight[k];
    for (int c = 0; c < 3; c++) xyz[c] += weight[c] * lit;
    for (int c = 0; c < ABBE_GEM_TILT_FIRE; c++)
      sum[c] += weight[1] / white[1] * (double)amount[source[c]];
  }
  sum[ABBE_GEM_TILT_FIRE] += is_fire(xyz, white);
  return xyz[1] >= ABBE_GEM_LIT * white[1] ? LIT : DARK;
}

static void trace(const work *w, double axis_rad, double tilt_rad, frame *f) {
  const abbe_gem_eye eye = abbe_gem_eye_make(axis_rad, tilt_rad);
  const abbe_gem_light light = abbe_gem_light_make(eye.to_eye, w->head_rad);
  for (size_t r = 0; r < w->repeats; r++) {
    const abbe_gem_lamps lamps = abbe_gem_lamps_make(&eye, r, w->head_rad);
    for (size_t i = 0; i < w->side * w->side; i++) {
      double u, v, o[3], d[3], p[3], n[3], sum[CURVES] = {0};
      const uint32_t seed = abbe_gem_eye_place(w->side, i % w->side, i / w->side, r, &u, &v);
      abbe_gem_eye_ray(&eye, w->side, i % w->side, i / w->side, u, v, o, d);
      if (!abbe_gem_path_enter(w->stone, o, d, p, n)) continue;
      f->met[r]++;
      f->state[i * w->repeats + r] = (unsigned char)follow(w, &light, &lamps, p, n, d, seed, sum);
      for (int c = 0; c < CURVES; c++) f->sum[c][r] += sum[c];
    }
  }
}

/* ---- all of them ---- */

/* A pixel that met the stone at both of two neighbouring tilts, and was lit at one alone. */
static void add_blinks(const work *w, const frame *a, const frame *b, double changed[REPEATS],
                       double both[REPEATS]) {
  for (size_t i = 0; i < w->side * w->side; i++)
    for (size_t r = 0; r < w->repeats; r++) {
      const unsigned char x = a->state[i * w->repeats + r], y = b->state[i * w->repeats + r];
      if (x == MISSED || y == MISSED) continue;
      both[r]++;
      changed[r] += x != y;
    }
}

/* Each frame counts alike, whatever the silhouette's area. The spread has products of different
 * repeats alone: what their own scatter adds is left out. */
static double mean_of(const frame *f, size_t frames, int c, size_t repeats, size_t without,
                      double *spread) {
  double mean = 0, square = 0;
  for (size_t i = 0; i < frames; i++) {
    double sum = 0, met = 0, values = 0, squares = 0, count = 0;
    for (size_t r = 0; r < repeats; r++) {
      if (r == without || !(f[i].met[r] > 0)) continue;
      const double value = f[i].sum[c][r] / f[i].met[r];
      sum += f[i].sum[c][r];
      met += f[i].met[r];
      values += value;
      squares += value * value;
      count++;
    }
    mean += met > 0 ? sum / met / (double)frames : 0;
    if (count > 1) square += (values * values - squares) / (count * (count - 1) * (double)frames);
  }
  *spread = sqrt(fmax(square - mean * mean, 0));
  return mean;
}

static void summarise(const work *w, const frame *f, abbe_gem_tilts *out) {
  const size_t frames = ABBE_GEM_AXES * out->tilts;
  for (int c = 0; c < CURVES; c++) {
    double without[REPEATS], spread[REPEATS], all, all_spread;
    for (size_t i = 0; i < frames; i++)
      out->curve[c][i] = abbe_gem_number_ratio(f[i].sum[c], f[i].met, w->repeats);
    for (size_t r = 0; r < w->repeats; r++)
      without[r] = mean_of(f, frames, c, w->repeats, r, &spread[r]);
    all = mean_of(f, frames, c, w->repeats, w->repeats, &all_spread);
    out->mean[c] = abbe_gem_number_jackknife(all, without, w->repeats);
    if (c == ABBE_GEM_TILT_ISO)
      out->spread = abbe_gem_number_jackknife(all_spread, spread, w->repeats);
  }
  double changed[REPEATS] = {0}, both[REPEATS] = {0};
  for (size_t i = 0; i + 1 < frames; i++)
    if ((i + 1) % out->tilts != 0) add_blinks(w, &f[i], &f[i + 1], changed, both);
  out->blinks = abbe_gem_number_ratio(changed, both, w->repeats);
}

static abbe_result run(const work *w, const abbe_gem_tilts_desc *desc, frame *f,
                       abbe_gem_tilts *out, abbe_error *error) {
  const int frames = (int)(ABBE_GEM_AXES * out->tilts);
  const size_t threads = desc->threads > 0 ? desc->threads : (size_t)omp_get_max_threads();
  int done = 0;
  bool stopped = false;
#pragma omp parallel for schedule(dynamic) num_threads((int)threads)
  for (int i = 0; i < frames; i++) {
    bool stop;
#pragma omp atomic read
    stop = stopped;
    if (stop) continue;
    trace(w, out->axis_rad[i / (int)out->tilts], out->tilt_rad[i % (int)out->tilts], &f[i]);
#pragma omp atomic
    done++;
    if (desc->progress == NULL || omp_get_thread_num() != 0) continue;
    int so_far;
#pragma omp atomic read
    so_far = done;
    if (!desc->progress(desc->user, (double)so_far / frames)) {
#pragma omp atomic write
      stopped = true;
    }
  }
  if (stopped) return abbe_error_set(error, ABBE_CANCELLED, "the stone's tilts were given up");
  for (int i = 0; i < frames; i++) {
    double met = 0;
    for (size_t r = 0; r < w->repeats; r++) met += f[i].met[r];
    if (met == 0)
      return abbe_error_set(error, ABBE_GEOMETRY,
                            "none of %zu x %zu x %zu rays of the eye met the stone: take more",
                            w->side, w->side, w->repeats);
  }
  summarise(w, f, out);
  return ABBE_OK;
}

static abbe_result allocate(const work *w, abbe_gem_tilts *out, frame **f, unsigned char **states,
                            abbe_error *error) {
  const size_t frames = ABBE_GEM_AXES * out->tilts, each = w->side * w->side * w->repeats;
  *f = calloc(frames, sizeof **f);
  *states = calloc(frames * each, 1);
  out->tilt_rad = calloc(out->tilts, sizeof *out->tilt_rad);
  bool made = *f != NULL && *states != NULL && out->tilt_rad != NULL;
  for (int c = 0; c < CURVES; c++) {
    out->curve[c] = calloc(frames, sizeof *out->curve[c]);
    made = made && out->curve[c] != NULL;
  }
  for (size_t i = 0; i < frames && made; i++) (*f)[i].state = *states + i * each;
  return made ? ABBE_OK
              : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a stone at %zu tilts", frames);
}

static abbe_result check(const abbe_gem_stone *stone, const abbe_weights *weights,
                         const abbe_gem_tilts_desc *d, abbe_error *error) {
  if (!(d->most_rad >= 0 && d->most_rad <= 0.5 * ABBE_PI) || d->steps > ABBE_GEM_MOST_STEPS ||
      d->side > ABBE_GEM_MOST_SIDE || d->repeats == 1 || d->repeats > REPEATS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "tilts of %g rad in %zu steps, %zu pixels a side and %zu repeats; there "
                          "are up to %g, 1 to %d, 1 to %d and 2 to %d",
                          d->most_rad, d->steps, d->side, d->repeats, 0.5 * ABBE_PI,
                          ABBE_GEM_MOST_STEPS, ABBE_GEM_MOST_SIDE, REPEATS);
  return abbe_gem_view_check(stone, weights, d->head_rad, error);
}

abbe_result abbe_gem_tilts_make(const abbe_gem_stone *stone, const abbe_weights *weights,
                                const abbe_gem_tilts_desc *desc, abbe_gem_tilts *out,
                                abbe_error *error) {
  memset(out, 0, sizeof *out);
  ABBE_TRY(check(stone, weights, desc, error));
  const work w = {.stone = stone,
                  .weights = weights,
                  .side = desc->side > 0 ? desc->side : 12,
                  .repeats = desc->repeats > 0 ? desc->repeats : 8,
                  .head_rad = desc->head_rad};
  const size_t steps = desc->steps > 0 ? desc->steps : 15;
  const double most = desc->most_rad > 0 ? desc->most_rad : ABBE_PI / 6;
  out->tilts = 2 * steps + 1;
  out->step_rad = most / (double)steps;
  out->has_fire = stone->wavelengths > 1;
  frame *f = NULL;
  unsigned char *states = NULL;
  abbe_result result = allocate(&w, out, &f, &states, error);
  if (result == ABBE_OK) {
    for (int a = 0; a < ABBE_GEM_AXES; a++) out->axis_rad[a] = a * ABBE_PI / ABBE_GEM_AXES;
    for (size_t t = 0; t < out->tilts; t++)
      out->tilt_rad[t] = ((double)t - (double)steps) * out->step_rad;
    result = run(&w, desc, f, out, error);
  }
  free(f);
  free(states);
  if (result != ABBE_OK) abbe_gem_tilts_free(out);
  return result;
}
