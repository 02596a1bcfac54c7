/* What needs no graphics, at the extremes and under the sanitizers: scenes, plans, weights, indices
 * and the reference tracer. test_extremes_cpu [--table] [GROUP…]. */
#include "tests/extremes/extreme.h"

#include "colorimetry/weights.h"
#include "spectral/optics.h"
#include "spectral/wavelengths.h"
#include "validation/trace/tracer/tracer.h"

#include <math.h>
#include <string.h>

typedef struct found {
  abbe_result result; /* of the first step that refuses */
  abbe_error error;
} found;

static void keep(found *f, abbe_result result, const abbe_error *error) {
  if (f->result != ABBE_OK || result == ABBE_OK) return;
  f->result = result;
  f->error = *error;
}

static void check_plan(const abbe_scene *scene, const abbe_render_desc *desc, found *f) {
  abbe_plan plan;
  abbe_error error = {0};
  keep(f, abbe_plan_make(scene, desc, &plan, &error), &error);
  abbe_plan_free(&plan);
}

/* Weights are non-negative and sum to the white. */
static void check_weights(const abbe_scene *scene, const abbe_render_desc *desc, found *f,
                          extreme_row *row) {
  abbe_wavelengths w = {0};
  abbe_weights weights = {0};
  abbe_error error = {0};
  abbe_result result =
      abbe_wavelengths_make(desc->wavelengths != 0 ? desc->wavelengths : 7,
                            desc->min_nm != 0 ? desc->min_nm : ABBE_WAVELENGTH_MIN_NM,
                            desc->max_nm != 0 ? desc->max_nm : ABBE_WAVELENGTH_MAX_NM, &w, &error);
  if (result == ABBE_OK)
    result =
        abbe_weights_make(&w, &scene->light[0].illuminant, ABBE_RGB_SPACE_XYZ, &weights, &error);
  keep(f, result, &error);
  if (result == ABBE_OK) {
    double sum = 0;
    for (size_t i = 0; i < weights.count; i++) {
      for (int c = 0; c < 3; c++)
        if (!(weights.weight[i][c] >= 0) || !isfinite(weights.weight[i][c]))
          extreme_row_break(row, "weight %zu is %g", i, weights.weight[i][c]);
      sum += weights.weight[i][1];
    }
    /* A thousand additions of doubles. */
    if (!(fabs(sum / weights.sum[1] - 1) < 1e-12))
      extreme_row_break(row, "weights sum to %.17g of the white", sum / weights.sum[1]);
  }
  abbe_weights_free(&weights);
  abbe_wavelengths_free(&w);
}

static void check_images(const abbe_tracer *tracer, extreme_row *row) {
  abbe_image image[2] = {{0}, {0}};
  abbe_tracer_picture(tracer, &image[0], NULL);
  abbe_tracer_map(tracer, &image[1], NULL);
  for (int k = 0; k < 2; k++) {
    size_t count = image[k].width * image[k].height * image[k].channels;
    for (size_t i = 0; i < count; i++)
      if (isnan(image[k].data[i])) extreme_row_break(row, "traced value %zu is no number", i);
    abbe_image_free(&image[k]);
  }
}

/* What reached refractors is somewhere: a photon is a whole, so the parts are sums of the same
 * numbers, in double precision. Hardly any may be lost. */
static void check_ledger(const abbe_tracer *tracer, extreme_row *row) {
  abbe_trace_statistics s;
  abbe_tracer_statistics(tracer, &s);
  const abbe_light_ledger *l = &s.ledger;
  double parts = l->deposited + l->absorbed + l->missed + l->trapped + l->lost;
  double open = l->reached > 0 ? fabs(l->reached - parts) / l->reached : fabs(parts);
  double lost = l->reached > 0 ? l->lost / l->reached : 0;
  extreme_row_add(row, "traced ledger %.1e, lost %.1e, cuts %llu", open, lost,
                  (unsigned long long)s.cuts);
  if (!(open < 1e-4)) extreme_row_break(row, "the traced ledger is open by %g", open);
  if (!(lost < 1e-3)) extreme_row_break(row, "the tracer lost %g of the light", lost);
}

static void trace(const abbe_scene *scene, const abbe_render_desc *d, extreme_row *row) {
  abbe_tracer *tracer = NULL;
  abbe_error error = {0};
  const abbe_trace_desc desc = {.width = 16,
                                .height = 16,
                                .map_width = 16,
                                .photons = 1024,
                                .threads = 2,
                                .min_nm = d->min_nm,
                                .max_nm = d->max_nm};
  abbe_result result = abbe_tracer_make(scene, &desc, &tracer, &error);
  for (int i = 0; i < 2 && result == ABBE_OK; i++) result = abbe_tracer_pass(tracer, NULL, &error);
  if (result != ABBE_OK) {
    extreme_row_add(row, "not traced: %s", error.text);
    if (result == ABBE_NO_MEMORY) extreme_row_break(row, "%s", error.text);
  } else {
    check_images(tracer, row);
    check_ledger(tracer, row);
  }
  abbe_tracer_free(tracer);
}

/* Making a tracer takes a third of a second. Cases that differ in the renderer's request alone are
 * the tracer's usual ball, and of three in one the brick stands for all. Lamps that touch glass,
 * which the renderer refuses, take the tracer half a minute to aim, and it tells what it loses of
 * them. */
static bool is_traced(const extreme *e) {
  static const char *const others[] = {", ball", ", ring"};
  const char *comma = strrchr(e->name, ',');
  for (int i = 0; i < 2; i++)
    if (comma != NULL && strcmp(comma, others[i]) == 0) return false;
  return e->refused == ABBE_OK && strcmp(e->group, "photons") != 0 &&
         strcmp(e->group, "images") != 0 &&
         !(strcmp(e->group, "wavelengths") == 0 && e->desc.min_nm == 0);
}

static void run(void *user, const extreme *e) {
  extreme_report *report = user;
  extreme_row row = {{0}, {0}};
  abbe_scene scene;
  found f = {ABBE_OK, {0}};
  abbe_error error = {0};
  abbe_render_desc desc = extreme_desc(e);
  keep(&f, extreme_load(&e->scene, &scene, &error), &error);
  if (f.result == ABBE_OK) {
    check_plan(&scene, &desc, &f);
    check_weights(&scene, &desc, &f, &row);
    if (is_traced(e)) trace(&scene, &desc, &row);
    abbe_scene_free(&scene);
  }
  /* What only a device can refuse is not refused here. */
  bool later = e->refused != ABBE_OK && f.result == ABBE_OK && e->by_device;
  if (f.result != e->refused && !later)
    extreme_row_break(&row, "%s instead of %s: %s", abbe_result_text(f.result),
                      abbe_result_text(e->refused), f.error.text);
  extreme_report_add(report, e->group, e->name, &row);
}

/* Optics in double precision over all ranges: in [0, 1], and light is neither lost nor made. */
static void check_optics(extreme_row *row) {
  static const double n[] = {1 - 1e-6, 1, 1 + 1e-7, 1.33, 1.5, 4, 80},
                      c[] = {0, 1e-300, 1e-9, 1e-3, 0.5, 1 - 1e-16, 1};
  for (size_t i = 0; i < 7; i++)
    for (size_t k = 0; k < 7; k++)
      for (int inside = 0; inside < 2; inside++) {
        double eta = inside ? n[i] : 1 / n[i], share = abbe_optics_fresnel(c[k], eta);
        bool total;
        double cosine = abbe_optics_cos_refracted(c[k], eta, &total);
        if (!(share >= 0 && share <= 1) || !(cosine >= 0 && cosine <= 1))
          extreme_row_break(row, "n %g, cosine %g: %g, %g", n[i], c[k], share, cosine);
        /* the same interface from the other side (Stokes) */
        if (!total && cosine > 1e-3 && c[k] > 1e-3 &&
            !(fabs(abbe_optics_fresnel(cosine, 1 / eta) - share) < 1e-6))
          extreme_row_break(row, "n %g, cosine %g: not the same from behind", n[i], c[k]);
      }
  if (abbe_optics_transmittance(INFINITY, 1) != 0 || abbe_optics_transmittance(INFINITY, 0) != 1 ||
      abbe_optics_transmittance(0, INFINITY) != 1)
    extreme_row_break(row, "infinite absorption");
}

int main(int count, char **argument) {
  extreme_report report = extreme_report_make(count, argument);
  extreme_for_each(&report, run, &report);
  if (extreme_report_wants(&report, "optics")) {
    extreme_row row = {{0}, {0}};
    check_optics(&row);
    extreme_report_add(&report, "optics", "n from 1 - 1e-6 to 80, grazing to normal", &row);
  }
  return extreme_report_end(&report);
}
