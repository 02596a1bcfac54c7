#include "validation/tradeoff/error_decomposition.h"

#include "base/number.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* One part is the most of it where it is this many times the other. */
static const double outweighs = 1.5;

/* More samples still help where they take at least this share off. */
static const double helps = 0.05;

static bool is_default(const abbe_sweep_row *row) {
  return strcmp(row->setting.profile, "default") == 0;
}

static bool has_fill(const abbe_sweep_row *row) {
  return strcmp(row->setting.fill, "none") != 0;
}

static const abbe_sweep_row *most_accurate(const abbe_sweep_table *table) {
  const abbe_sweep_row *best = NULL;
  for (size_t i = 0; i < table->count; i++) {
    const abbe_sweep_row *row = &table->row[i];
    double e = row->number[ABBE_SWEEP_CAUSTIC_DE];
    if (is_default(row) && isfinite(e) && (best == NULL || e < best->number[ABBE_SWEEP_CAUSTIC_DE]))
      best = row;
  }
  return best;
}

/* A pair that differs in the fill alone; of several the one with most samples. */
static void find_fill(const abbe_sweep_table *table, abbe_error_decomposition *out) {
  size_t most = 0;
  for (size_t i = 0; i < table->count; i++) {
    const abbe_sweep_row *bare = &table->row[i];
    size_t samples = bare->setting.photons * bare->setting.wavelengths;
    if (!is_default(bare) || has_fill(bare) || samples <= most) continue;
    abbe_sweep_setting filled = bare->setting;
    snprintf(filled.fill, sizeof filled.fill, "bridge");
    const abbe_sweep_row *other = abbe_sweep_table_find(table, &filled);
    if (other == NULL) continue;
    most = samples;
    out->without_fill = bare->number[ABBE_SWEEP_MATCHED_DE];
    out->with_fill = other->number[ABBE_SWEEP_MATCHED_DE];
  }
}

/* The rest of the row that has fewer of one kind of sample and is else the same; of several the one
 * with most of those. */
static double with_fewer(const abbe_sweep_table *table, const abbe_sweep_setting *s, bool photons) {
  double rest = NAN;
  size_t most = 0;
  for (size_t i = 0; i < table->count; i++) {
    abbe_sweep_setting other = table->row[i].setting;
    size_t count = photons ? other.photons : other.wavelengths;
    if (2 * count > (photons ? s->photons : s->wavelengths)) continue;
    other.photons = photons ? s->photons : other.photons;
    other.wavelengths = photons ? other.wavelengths : s->wavelengths;
    if (!abbe_sweep_setting_same(&other, s) || count <= most) continue;
    most = count;
    rest = table->row[i].number[ABBE_SWEEP_MATCHED_DE];
  }
  return rest;
}

void abbe_error_decomposition_make(const abbe_sweep_table *table, abbe_error_decomposition *out) {
  abbe_sweep_model model = {NAN, NAN, NAN, NAN, NAN};
  *out = (abbe_error_decomposition){
      .row = most_accurate(table), .with_fill = NAN, .without_fill = NAN};
  if (out->row == NULL) return;
  const double *number = out->row->number;
  abbe_sweep_model_read(table, &model);
  out->total = number[ABBE_SWEEP_CAUSTIC_DE];
  out->total_noise = number[ABBE_SWEEP_CAUSTIC_DE_NOISE];
  out->model = model.de;
  out->model_noise = model.de_noise;
  out->rest = number[ABBE_SWEEP_MATCHED_DE];
  out->rest_noise = number[ABBE_SWEEP_MATCHED_DE_NOISE];
  out->energy = number[ABBE_SWEEP_MAP_ENERGY];
  out->model_energy = model.energy;
  out->fill_invented = number[ABBE_SWEEP_FILL_INVENTED];
  out->fill_lost = number[ABBE_SWEEP_FILL_LOST];
  find_fill(table, out);
  out->fewer_photons = with_fewer(table, &out->row->setting, true);
  out->fewer_wavelengths = with_fewer(table, &out->row->setting, false);
}

/* Words */

typedef struct text {
  char *out;
  size_t size, used;
} text;

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
say(text *t, const char *format, ...) {
  va_list args;
  if (t->used + 1 >= t->size) return;
  va_start(args, format);
  int length = abbe_number_format_list(t->out + t->used, t->size - t->used, format, args);
  va_end(args);
  if (length > 0) t->used += (size_t)length;
}

/* An error with its reference's noise taken off, which is independent of it. */
static double above_noise(double error, double noise) {
  return isfinite(noise) ? sqrt(fmax(error * error - noise * noise, 0)) : error;
}

static void say_parts(const abbe_error_decomposition *s, text *t) {
  double model = above_noise(s->model, s->model_noise), rest = above_noise(s->rest, s->rest_noise);
  say(t,
      " Matched physics, which leaves out what the model does, is itself %.3g (%.2g) away from "
      "full; the setting is %.3g (%.2g) away from matched physics.",
      s->model, s->model_noise, s->rest, s->rest_noise);
  if (model < 0.1 * s->total && rest < 0.1 * s->total)
    say(t, " Both are noise: a longer reference would tell more.");
  else if (model > outweighs * rest)
    say(t, " So most of it is the model's.");
  else if (rest > outweighs * model)
    say(t, " So most of it is sampling and reconstruction.");
  else
    say(t, " So the model has about as much of it as sampling and reconstruction.");
}

/* Whether the last step up in samples still paid. */
static void say_step(const abbe_error_decomposition *s, double before, const char *what, text *t) {
  if (!isfinite(before) || !isfinite(s->rest)) return;
  bool pays = s->rest < (1 - helps) * before;
  say(t, " With fewer %s it was %.3g: more of them %s.", what, before,
      pays ? "would help on" : "would not help");
}

void abbe_error_decomposition_say(const abbe_error_decomposition *s, char *out, size_t size) {
  text t = {out, size, 0};
  char label[64];
  if (size > 0) out[0] = '\0';
  if (s->row == NULL) return;
  abbe_sweep_setting_label(&s->row->setting, label, sizeof label);
  say(&t, "What is left: %s has %.3g (%.2g of it noise).", label, s->total, s->total_noise);
  if (isfinite(s->model) && isfinite(s->rest)) say_parts(s, &t);
  if (isfinite(s->model_energy) && isfinite(s->energy))
    say(&t, " The model keeps %.1f %% of the map's light, and the setting has %.1f %%.",
        100 * s->model_energy, 100 * s->energy);
  say_step(s, s->fewer_photons, "photons", &t);
  say_step(s, s->fewer_wavelengths, "wavelengths", &t);
  if (isfinite(s->with_fill) && isfinite(s->without_fill))
    say(&t, " Reconstruction: the bridge between wavelengths turns %.3g into %.3g.",
        s->without_fill, s->with_fill);
  if (isfinite(s->fill_invented) && isfinite(s->fill_lost))
    say(&t, " The fill adds %.1g and drops %.1g of the map's light.", s->fill_invented,
        s->fill_lost);
}
