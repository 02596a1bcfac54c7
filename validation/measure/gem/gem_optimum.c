#include "validation/measure/gem/gem_optimum.h"

#include "base/maths.h"
#include "scenes/cuts/cut_stretch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void abbe_gem_optimum_free(abbe_gem_optimum *optimum) {
  if (optimum == NULL) return;
  free(optimum->crown_rad);
  free(optimum->pavilion_rad);
  free(optimum->value);
  memset(optimum, 0, sizeof *optimum);
}

typedef struct work {
  const abbe_material *material;
  const abbe_wavelengths *wavelengths;
  const abbe_weights *weights;
  const abbe_gem_optimum_desc *desc;
} work;

static abbe_result make_stone(const work *w, const abbe_cut *cut, abbe_gem_stone *out,
                              abbe_error *error) {
  ABBE_OWNED(abbe_cut_polyhedron, p) = {0};
  ABBE_TRY(abbe_cut_polyhedron_make(cut, 0, &p, error));
  ABBE_TRY(abbe_gem_stone_make(cut, &p, w->material, w->wavelengths, w->desc->width_m, out, error));
  if (abbe_vector_length(w->desc->axes.z) > 0)
    ABBE_TRY(abbe_gem_stone_turn(out, &w->desc->axes, error));
  return ABBE_OK;
}

/* Frees the stone. */
static abbe_result judge(const work *w, abbe_gem_stone *stone, abbe_gem_number *out,
                         abbe_error *error) {
  abbe_gem_view view = {0};
  const abbe_result result = abbe_gem_view_make(stone, w->weights, &w->desc->view, &view, error);
  if (result == ABBE_OK) *out = abbe_gem_view_amount(&view, w->desc->measure);
  abbe_gem_view_free(&view);
  abbe_gem_stone_free(stone);
  return result;
}

static abbe_result check_pair(const abbe_gem_optimum *o, size_t i, abbe_error *error) {
  if (i < o->crowns * o->pavilions) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "pair %zu of %zu", i,
                        o->crowns * o->pavilions);
}

abbe_result abbe_gem_optimum_apply(const abbe_gem_optimum *o, abbe_cut *cut,
                                   const abbe_cut_polyhedron *polyhedron, size_t i,
                                   abbe_error *error) {
  ABBE_TRY(check_pair(o, i, error));
  return abbe_cut_stretch_apply(
      cut, polyhedron, tan(o->crown_rad[i % o->crowns]) / tan(o->design_crown_rad),
      tan(o->pavilion_rad[i / o->crowns]) / tan(o->design_pavilion_rad), error);
}

static abbe_result make_pair(const work *w, const abbe_cut *cut, const abbe_cut_polyhedron *p,
                             const abbe_gem_optimum *o, size_t i, abbe_gem_stone *out,
                             abbe_error *error) {
  abbe_cut own;
  ABBE_TRY(abbe_cut_copy(cut, &own, error));
  abbe_result result = abbe_gem_optimum_apply(o, &own, p, i, error);
  if (result == ABBE_OK) result = make_stone(w, &own, out, error);
  abbe_cut_copy_free(&own);
  return result;
}

abbe_result abbe_gem_optimum_stone(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                   const abbe_material *material,
                                   const abbe_wavelengths *wavelengths,
                                   const abbe_gem_optimum_desc *desc, const abbe_gem_optimum *o,
                                   abbe_gem_stone *out, abbe_error *error) {
  const work w = {material, wavelengths, NULL, desc};
  return make_pair(&w, cut, polyhedron, o, o->best, out, error);
}

static abbe_result check(const abbe_gem_optimum_desc *d, abbe_error *error) {
  const bool angles = d->crown_from_rad > 0 && d->crown_to_rad >= d->crown_from_rad &&
                      d->crown_to_rad < 0.5 * ABBE_PI && d->pavilion_from_rad > 0 &&
                      d->pavilion_to_rad >= d->pavilion_from_rad &&
                      d->pavilion_to_rad < 0.5 * ABBE_PI;
  if (angles && d->crowns >= 1 && d->pavilions >= 1 && d->crowns <= ABBE_GEM_MOST_ANGLES &&
      d->pavilions <= ABBE_GEM_MOST_ANGLES && (unsigned)d->measure < ABBE_GEM_AMOUNT_COUNT &&
      (d->parts == 0 || d->part < d->parts))
    return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "a grid of %zu x %zu angles, %g to %g and %g to %g rad; each is above 0 "
                        "and below %g, ascending, and there are 1 to %d",
                        d->crowns, d->pavilions, d->crown_from_rad, d->crown_to_rad,
                        d->pavilion_from_rad, d->pavilion_to_rad, 0.5 * ABBE_PI,
                        ABBE_GEM_MOST_ANGLES);
}

static double *spread(double from, double to, size_t count) {
  double *out = malloc(count * sizeof *out);
  for (size_t i = 0; i < count && out != NULL; i++)
    out[i] = count > 1 ? from + (to - from) * (double)i / ((double)count - 1) : 0.5 * (from + to);
  return out;
}

static abbe_result make_grid(const abbe_cut *cut, const abbe_cut_polyhedron *p,
                             const abbe_gem_optimum_desc *d, abbe_gem_optimum *out,
                             abbe_error *error) {
  const double crown_deg = abbe_cut_stretch_main_deg(cut, p, ABBE_CUT_CROWN);
  const double pavilion_deg = abbe_cut_stretch_main_deg(cut, p, ABBE_CUT_PAVILION);
  if (!(crown_deg > 0 && pavilion_deg > 0))
    return abbe_error_set(error, ABBE_GEOMETRY,
                          "the design has no slanted facets on its %s, whose angle could change",
                          crown_deg > 0 ? "pavilion" : "crown");
  out->design_crown_rad = crown_deg * ABBE_PI / 180;
  out->design_pavilion_rad = pavilion_deg * ABBE_PI / 180;
  out->crowns = d->crowns;
  out->pavilions = d->pavilions;
  out->crown_rad = spread(d->crown_from_rad, d->crown_to_rad, d->crowns);
  out->pavilion_rad = spread(d->pavilion_from_rad, d->pavilion_to_rad, d->pavilions);
  out->measure = d->measure;
  out->least = d->least;
  out->value = calloc(d->crowns * d->pavilions, sizeof *out->value);
  for (size_t i = 0; out->value != NULL && i < d->crowns * d->pavilions; i++)
    out->value[i] = (abbe_gem_number){NAN, NAN};
  if (out->crown_rad != NULL && out->pavilion_rad != NULL && out->value != NULL) return ABBE_OK;
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu x %zu angles", d->crowns,
                        d->pavilions);
}

void abbe_gem_optimum_know(abbe_gem_optimum *o, size_t i, abbe_gem_number value) {
  o->value[i] = value;
  const double gain = value.value - o->value[o->best].value;
  if (isnan(gain) ? !isnan(value.value) : gain == 0 ? i < o->best : o->least ? gain < 0 : gain > 0)
    o->best = i;
}

size_t abbe_gem_optimum_missing(const abbe_gem_optimum *o, size_t *first) {
  size_t missing = 0;
  for (size_t i = 0; i < o->crowns * o->pavilions; i++) {
    if (!isnan(o->value[i].value)) continue;
    if (missing++ == 0 && first != NULL) *first = i;
  }
  return missing;
}

abbe_result abbe_gem_optimum_begin(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                   const abbe_material *material,
                                   const abbe_wavelengths *wavelengths, const abbe_weights *weights,
                                   const abbe_gem_optimum_desc *desc, abbe_gem_optimum *out,
                                   abbe_error *error) {
  memset(out, 0, sizeof *out);
  const work w = {material, wavelengths, weights, desc};
  abbe_result result = check(desc, error);
  if (result == ABBE_OK) result = make_grid(cut, polyhedron, desc, out, error);
  abbe_gem_stone stone = {0};
  if (result == ABBE_OK) result = make_stone(&w, cut, &stone, error);
  if (result == ABBE_OK) result = judge(&w, &stone, &out->design, error);
  if (result != ABBE_OK) abbe_gem_optimum_free(out);
  return result;
}

/* Judges pair i of a search that has begun with the same. Errors as those of find, and
 * ABBE_INVALID_ARGUMENT for a pair that is not there. */
static abbe_result gem_optimum_judge(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                     const abbe_material *material,
                                     const abbe_wavelengths *wavelengths,
                                     const abbe_weights *weights, const abbe_gem_optimum_desc *desc,
                                     abbe_gem_optimum *optimum, size_t i, abbe_error *error) {
  const work w = {material, wavelengths, weights, desc};
  abbe_gem_number value;
  ABBE_TRY(check_pair(optimum, i, error));
  abbe_gem_stone stone = {0};
  ABBE_TRY(make_pair(&w, cut, polyhedron, optimum, i, &stone, error));
  ABBE_TRY(judge(&w, &stone, &value, error));
  abbe_gem_optimum_know(optimum, i, value);
  return ABBE_OK;
}

abbe_result abbe_gem_optimum_find(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                  const abbe_material *material,
                                  const abbe_wavelengths *wavelengths, const abbe_weights *weights,
                                  const abbe_gem_optimum_desc *desc, abbe_gem_optimum *out,
                                  abbe_error *error) {
  abbe_result result =
      abbe_gem_optimum_begin(cut, polyhedron, material, wavelengths, weights, desc, out, error);
  if (result != ABBE_OK) return result;
  const size_t all = out->crowns * out->pavilions, step = desc->parts > 0 ? desc->parts : 1;
  for (size_t i = desc->parts > 0 ? desc->part : 0; i < all && result == ABBE_OK; i += step) {
    result =
        gem_optimum_judge(cut, polyhedron, material, wavelengths, weights, desc, out, i, error);
    if (result == ABBE_OK && desc->progress != NULL &&
        !desc->progress(desc->user, fmin((double)(i + step) / (double)all, 1)))
      result = abbe_error_set(error, ABBE_CANCELLED, "the search was given up");
  }
  if (result != ABBE_OK) abbe_gem_optimum_free(out);
  return result;
}
