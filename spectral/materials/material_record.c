#include "spectral/materials/record_reading.h"

#include "spectral/materials/absorption.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- absorption ---- */

static abbe_result read_colour(abbe_record_reading *r, abbe_yaml_node where, abbe_spectrum **out) {
  double colour[3] = {1, 1, 1}, distance_m = 0;
  abbe_yaml_node node;
  ABBE_TRY(abbe_yaml_require(r->yaml, where, "distance_m", &node, r->error));
  ABBE_TRY(abbe_yaml_get_number(r->yaml, where, "distance_m", 1e-9, 1e9, &distance_m, r->error));
  ABBE_TRY(abbe_yaml_get_numbers(r->yaml, where, "colour", 3, 1e-6, 1, colour, r->error));
  return abbe_absorption_spectrum_of_colour(colour, distance_m, out, r->error);
}

static abbe_result read_attenuation(abbe_record_reading *r, abbe_yaml_node where,
                                    abbe_spectrum **out) {
  abbe_interpolation interpolation = ABBE_INTERPOLATION_LINEAR;
  ABBE_TRY(abbe_record_read_interpolation(r, where, &interpolation));
  return abbe_record_read_points(r, abbe_yaml_get(r->yaml, where, "attenuation_per_m"),
                                 "attenuation_per_m", 0, 1e15, interpolation, out);
}

/* Pairs into points, for what is converted. */
static abbe_result read_list(abbe_record_reading *r, abbe_yaml_node where, const char *key,
                             double max, abbe_points *points) {
  ABBE_OWNED(abbe_record_rows, pairs) = {.columns = 2};
  ABBE_TRY(abbe_record_rows_read(r, abbe_yaml_get(r->yaml, where, key), key, 0, max, &pairs));
  for (size_t i = 0; i < pairs.count; i++)
    ABBE_TRY(abbe_points_add(
        points, (abbe_point){.lambda_nm = pairs.column[0][i], .value = pairs.column[1][i]},
        r->error));
  return ABBE_OK;
}

static abbe_result read_k(abbe_record_reading *r, abbe_yaml_node where, abbe_spectrum **out) {
  ABBE_OWNED(abbe_points, points) = {0};
  ABBE_TRY(read_list(r, where, "k", 1e3, &points));
  return abbe_absorption_spectrum_of_k(&points, out, r->error);
}

static abbe_result read_transmittance(abbe_record_reading *r, abbe_yaml_node where,
                                      abbe_spectrum **out) {
  ABBE_OWNED(abbe_points, points) = {0};
  double thickness_m = 0;
  abbe_yaml_node node;
  ABBE_TRY(abbe_yaml_require(r->yaml, where, "thickness_m", &node, r->error));
  ABBE_TRY(abbe_yaml_get_number(r->yaml, where, "thickness_m", 1e-9, 1e9, &thickness_m, r->error));
  ABBE_TRY(read_list(r, where, "transmittance", 1, &points));
  return abbe_absorption_spectrum_of_transmittance(&points, thickness_m, out, r->error);
}

/* The three kinds of absorption, and the keys that go with each. */
static const struct {
  const char *key;
  abbe_result (*read)(abbe_record_reading *r, abbe_yaml_node where, abbe_spectrum **out);
} ways[] = {
    {"attenuation_per_m", read_attenuation},
    {"transmittance", read_transmittance},
    {"k", read_k},
    {"colour", read_colour},
};
#define WAYS                                                                                       \
  "'attenuation_per_m', 'k', 'transmittance' and 'thickness_m', or 'colour' and 'distance_m'"

/* In one of those ways. */
static abbe_result read_absorbed(abbe_record_reading *r, abbe_yaml_node where,
                                 abbe_spectrum **out) {
  size_t found = 0, which = 0;
  for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
    if (abbe_yaml_get(r->yaml, where, ways[i].key).id == 0) continue;
    found++;
    which = i;
  }
  if (found != 1) {
    /* a mistyped key is the likelier mistake, and explains more */
    static const char *const rest[] = {"distance_m", "thickness_m", "interpolation"};
    for (int i = 0; i < 3; i++) abbe_yaml_get(r->yaml, where, rest[i]);
    ABBE_TRY(abbe_yaml_check_keys(r->yaml, where, "'absorption'", r->error));
    return abbe_yaml_fail(r->yaml, where, r->error, "'absorption' wants one of " WAYS);
  }
  abbe_result result = ways[which].read(r, where, out);
  return result != ABBE_OK ? result
                           : abbe_yaml_check_keys(r->yaml, where, "'absorption'", r->error);
}

/* Along axes: each of the keys has one of those ways. */
static abbe_result read_axes(abbe_record_reading *r, abbe_yaml_node where, const char *const *key,
                             size_t count, abbe_spectrum ***out) {
  for (size_t i = 0; i < count; i++) {
    const abbe_yaml_node axis = abbe_yaml_get(r->yaml, where, key[i]);
    if (axis.id == 0)
      return abbe_yaml_fail(r->yaml, where, r->error, "'absorption' along axes wants '%s' too",
                            key[i]);
    if (!abbe_yaml_is_mapping(r->yaml, axis))
      return abbe_yaml_fail(r->yaml, axis, r->error, "'%s' wants " WAYS, key[i]);
    ABBE_TRY(read_absorbed(r, axis, out[i]));
  }
  return abbe_yaml_check_keys(r->yaml, where, "'absorption'", r->error);
}

/* Whether all of it is said twice. */
static bool is_same(const abbe_spectrum *a, const abbe_spectrum *b) {
  const size_t count = abbe_spectrum_count(a), size = count * sizeof(double);
  return count == abbe_spectrum_count(b) &&
         abbe_spectrum_interpolation(a) == abbe_spectrum_interpolation(b) &&
         memcmp(abbe_spectrum_lambda_nm(a), abbe_spectrum_lambda_nm(b), size) == 0 &&
         memcmp(abbe_spectrum_value(a), abbe_spectrum_value(b), size) == 0;
}

static abbe_result read_pleochroism(abbe_record_reading *r, abbe_yaml_node where, bool xyz) {
  static const char *const two[] = {"ordinary", "extraordinary"}, *const three[] = {"x", "y", "z"};
  abbe_material *m = r->material;
  abbe_spectrum **y = &m->attenuation_yz[0];
  abbe_error why;
  abbe_spectrum **of_two[] = {&m->attenuation, &m->attenuation_yz[1]},
                **of_three[] = {&m->attenuation, y, &m->attenuation_yz[1]};
  if (!xyz && abbe_material_is_biaxial(m))
    return abbe_yaml_fail(r->yaml, where, r->error,
                          "'absorption' of a biaxial crystal goes along 'x', 'y' and 'z'");
  ABBE_TRY(read_axes(r, where, xyz ? three : two, xyz ? 3 : 2, xyz ? of_three : of_two));
  if (*y != NULL && is_same(*y, m->attenuation)) {
    abbe_spectrum_free(*y);
    *y = NULL;
  }
  if (abbe_material_check_absorption(m, &why) != ABBE_OK)
    return abbe_yaml_fail(r->yaml, where, r->error, "%s", why.text);
  return ABBE_OK;
}

static abbe_result read_absorption(abbe_record_reading *r) {
  static const char *const axes[] = {"ordinary", "extraordinary", "x", "y", "z"};
  abbe_yaml_node where = abbe_yaml_get(r->yaml, r->record, "absorption");
  if (where.id == 0) return ABBE_OK;
  if (!abbe_yaml_is_mapping(r->yaml, where))
    return abbe_yaml_fail(r->yaml, where, r->error, "'absorption' wants " WAYS);
  for (int i = 0; i < 5; i++)
    if (abbe_yaml_get(r->yaml, where, axes[i]).id != 0) return read_pleochroism(r, where, i > 1);
  return read_absorbed(r, where, &r->material->attenuation);
}

/* ---- fluorescence ---- */

static abbe_result read_matrix(abbe_record_reading *r, abbe_yaml_node list) {
  abbe_fluorescence *f = &r->material->fluorescence;
  const size_t rows = abbe_yaml_count(r->yaml, list);
  if (rows == 0 || !abbe_yaml_is_mapping(r->yaml, abbe_yaml_item(r->yaml, list, 0)))
    return abbe_yaml_fail(r->yaml, list, r->error,
                          "'matrix' wants rows such as {nm: 400, emission: [[600, 0], [610, "
                          "0.05], [620, 0]]}: photons by nm by photon absorbed at 400 nm");
  for (size_t i = 0; i < rows; i++) {
    const abbe_yaml_node row = abbe_yaml_item(r->yaml, list, i);
    abbe_spectrum *emission = NULL;
    abbe_yaml_node node;
    double nm = 0;
    ABBE_TRY(abbe_yaml_require(r->yaml, row, "nm", &node, r->error));
    ABBE_TRY(abbe_yaml_get_number(r->yaml, row, "nm", ABBE_SPECTRUM_LOW_NM, ABBE_SPECTRUM_HIGH_NM,
                                  &nm, r->error));
    ABBE_TRY(abbe_yaml_require(r->yaml, row, "emission", &node, r->error));
    ABBE_TRY(abbe_record_read_points(r, node, "emission", 0, 1e15, ABBE_INTERPOLATION_LINEAR,
                                     &emission));
    ABBE_TRY(abbe_fluorescence_add_row(f, nm, emission, r->error));
    ABBE_TRY(abbe_yaml_check_keys(r->yaml, row, "a row of 'matrix'", r->error));
  }
  return abbe_fluorescence_sum_rows(f, r->error);
}

static abbe_result read_product(abbe_record_reading *r, abbe_yaml_node where,
                                abbe_yaml_node emission, abbe_yaml_node excitation) {
  abbe_fluorescence *f = &r->material->fluorescence;
  if (emission.id == 0)
    return abbe_yaml_fail(r->yaml, where, r->error,
                          "'fluorescence' wants an 'emission', or a 'matrix'");
  if (abbe_yaml_get(r->yaml, where, "yield").id == 0)
    return abbe_yaml_fail(r->yaml, where, r->error,
                          "'fluorescence' wants a 'yield', photons emitted by photon that excites, "
                          "0 to 1");
  ABBE_TRY(abbe_record_read_points(r, emission, "emission", 0, 1e15, ABBE_INTERPOLATION_LINEAR,
                                   &f->emission));
  if (excitation.id == 0) return ABBE_OK;
  return abbe_record_read_points(r, excitation, "excitation_per_m", 0, 1e15,
                                 ABBE_INTERPOLATION_LINEAR, &f->excitation);
}

static abbe_result read_fluorescence(abbe_record_reading *r) {
  const abbe_yaml_node where = abbe_yaml_get(r->yaml, r->record, "fluorescence");
  abbe_fluorescence *f = &r->material->fluorescence;
  abbe_error why;
  if (where.id == 0) return ABBE_OK;
  if (!abbe_yaml_is_mapping(r->yaml, where))
    return abbe_yaml_fail(r->yaml, where, r->error,
                          "'fluorescence' wants 'yield' and 'emission', and may have "
                          "'excitation_per_m'; or a 'matrix'");
  const abbe_yaml_node emission = abbe_yaml_get(r->yaml, where, "emission"),
                       excitation = abbe_yaml_get(r->yaml, where, "excitation_per_m"),
                       matrix = abbe_yaml_get(r->yaml, where, "matrix");
  ABBE_TRY(abbe_yaml_get_number(r->yaml, where, "yield", 0, 1, &f->yield, r->error));
  ABBE_TRY(abbe_yaml_check_keys(r->yaml, where, "'fluorescence'", r->error));
  if (matrix.id != 0 && (f->yield > 0 || emission.id != 0 || excitation.id != 0))
    return abbe_yaml_fail(r->yaml, where, r->error,
                          "a 'matrix' has all of the fluorescence: leave 'yield', 'emission' and "
                          "'excitation_per_m' out");
  ABBE_TRY(matrix.id != 0 ? read_matrix(r, matrix) : read_product(r, where, emission, excitation));
  if (abbe_material_check_fluorescence(r->material, &why) == ABBE_OK) return ABBE_OK;
  return abbe_yaml_fail(r->yaml, where, r->error, "%s", why.text);
}

/* ---- fits ---- */

static abbe_result read_fit(abbe_record_reading *r, abbe_yaml_node fits, const char *key,
                            size_t terms, abbe_material_fit *out) {
  abbe_yaml_node where = abbe_yaml_get(r->yaml, fits, key), node;
  if (where.id == 0) return ABBE_OK;
  abbe_material_fit fit = {
      .terms = terms, .min_nm = ABBE_WAVELENGTH_MIN_NM, .max_nm = ABBE_WAVELENGTH_MAX_NM};
  ABBE_TRY(abbe_yaml_require(r->yaml, where, "coefficients", &node, r->error));
  ABBE_TRY(
      abbe_yaml_get_numbers(r->yaml, where, "coefficients", terms, -1e12, 1e12, fit.c, r->error));
  ABBE_TRY(abbe_yaml_require(r->yaml, where, "max_error", &node, r->error));
  ABBE_TRY(abbe_yaml_get_number(r->yaml, where, "max_error", 0, 1e12, &fit.max_error, r->error));
  ABBE_TRY(abbe_record_read_range(r, where, "range_nm", &fit.min_nm, &fit.max_nm));
  ABBE_TRY(abbe_yaml_check_keys(r->yaml, where, key, r->error));
  *out = fit;
  return ABBE_OK;
}

static abbe_result read_fits(abbe_record_reading *r) {
  abbe_yaml_node fits = abbe_yaml_get(r->yaml, r->record, "fit");
  if (fits.id == 0) return ABBE_OK;
  ABBE_TRY(read_fit(r, fits, "cauchy2", 2, &r->material->fit[0]));
  ABBE_TRY(read_fit(r, fits, "cauchy3", 3, &r->material->fit[1]));
  return abbe_yaml_check_keys(r->yaml, fits, "'fit'", r->error);
}

/* ---- what the source prints besides ---- */

static abbe_result read_published(abbe_record_reading *r) {
  abbe_material *m = r->material;
  ABBE_TRY(abbe_yaml_get_number(r->yaml, r->record, "n_d", 1e-3, 1e3, &m->published_n_d, r->error));
  return abbe_yaml_get_number(r->yaml, r->record, "v_d", -1e6, 1e6, &m->published_v_d, r->error);
}

static abbe_result read_numbers(abbe_record_reading *r, abbe_yaml_node where, const char *key,
                                size_t count, double *out) {
  return abbe_yaml_get_numbers(r->yaml, where, key, count, -ABBE_MATERIAL_CATALOGUE_MOST,
                               ABBE_MATERIAL_CATALOGUE_MOST, out, r->error);
}

/* A key of the record; tables written before it was one have it in the catalogue. */
static abbe_result read_density(abbe_record_reading *r) {
  double *density_g_cm3 = &r->material->catalogue.density_g_cm3;
  const char *const key = "density_g_cm3";
  abbe_yaml_node catalogue = abbe_yaml_get(r->yaml, r->record, "catalogue");
  abbe_yaml_node twice = {0};
  if (catalogue.id != 0) twice = abbe_yaml_get(r->yaml, catalogue, key);
  if (twice.id != 0 && abbe_yaml_get(r->yaml, r->record, key).id != 0)
    return abbe_yaml_fail(r->yaml, twice, r->error,
                          "'%s' stands in the record and in its catalogue; leave it out here", key);
  return abbe_yaml_get_number(r->yaml, twice.id != 0 ? catalogue : r->record, key, 0,
                              ABBE_MATERIAL_DENSITY_MOST, density_g_cm3, r->error);
}

static abbe_result read_catalogue(abbe_record_reading *r) {
  abbe_material_catalogue *c = &r->material->catalogue;
  abbe_yaml_node where = abbe_yaml_get(r->yaml, r->record, "catalogue");
  if (where.id == 0) return ABBE_OK;
  ABBE_TRY(abbe_yaml_get_string(r->yaml, where, "code", &c->code, r->error));
  ABBE_TRY(abbe_yaml_get_string(r->yaml, where, "status", &c->status, r->error));
  ABBE_TRY(abbe_yaml_get_number(r->yaml, where, "melt_frequency", 0, ABBE_MATERIAL_MELT_MOST,
                                &c->melt_frequency, r->error));
  ABBE_TRY(read_numbers(r, where, "expansion_per_k", 2, c->expansion_per_k));
  ABBE_TRY(read_numbers(r, where, "expansion_range_k", 4, c->expansion_range_k));
  ABBE_TRY(abbe_yaml_get_number(r->yaml, where, "dpgf", -ABBE_MATERIAL_DPGF_MOST,
                                ABBE_MATERIAL_DPGF_MOST, &c->dpgf, r->error));
  ABBE_TRY(read_numbers(r, where, "thermal", 6, c->thermal));
  ABBE_TRY(read_numbers(r, where, "ratings", 6, c->ratings));
  if (abbe_yaml_get(r->yaml, where, "ratings").id != 0) c->rating_count = 6;
  return abbe_yaml_check_keys(r->yaml, where, "'catalogue'", r->error);
}

/* ---- records ---- */

static abbe_result check_name(abbe_record_reading *r) {
  abbe_error why;
  if (abbe_material_check_name(r->material->name, &why) == ABBE_OK) return ABBE_OK;
  return abbe_yaml_fail(r->yaml, abbe_yaml_get(r->yaml, r->record, "name"), r->error, "'name': %s",
                        why.text);
}

static abbe_result read_texts(abbe_record_reading *r) {
  abbe_material *m = r->material;
  abbe_yaml_node node;
  ABBE_TRY(abbe_yaml_require(r->yaml, r->record, "name", &node, r->error));
  ABBE_TRY(abbe_yaml_get_string(r->yaml, r->record, "name", &m->name, r->error));
  ABBE_TRY(check_name(r));
  ABBE_TRY(abbe_yaml_get_string(r->yaml, r->record, "description", &m->description, r->error));
  ABBE_TRY(abbe_record_require(r, "source", &node));
  ABBE_TRY(abbe_yaml_get_string(r->yaml, r->record, "source", &m->source, r->error));
  ABBE_TRY(abbe_yaml_get_string(r->yaml, r->record, "warning", &m->warning, r->error));
  return abbe_yaml_get_string(r->yaml, r->record, "comment", &m->comment, r->error);
}

/* Every key is asked for before the values are judged by what is missing, so that a mistyped key
 * is reported as such. */
static abbe_result check_record_keys(abbe_record_reading *r) {
  static const char *const keys[] = {
      "name",          "description", "model",      "coefficients",  "points",    "interpolation",
      "range_nm",      "extrapolate", "absorption", "temperature_c", "source",    "warning",
      "fit",           "n_d",         "v_d",        "comment",       "catalogue", "density_g_cm3",
      "extraordinary", "biaxial",     "n_absolute", "fluorescence"};
  for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
    abbe_yaml_get(r->yaml, r->record, keys[i]);
  return abbe_yaml_check_keys(r->yaml, r->record, "a material", r->error);
}

static abbe_result read_record(abbe_record_reading *r) {
  abbe_material *m = r->material;
  m->line = abbe_yaml_line(r->yaml, r->record);
  m->temperature_c = NAN;
  ABBE_TRY(check_record_keys(r));
  ABBE_TRY(read_texts(r));
  ABBE_TRY(abbe_record_read_dispersion(r));
  ABBE_TRY(abbe_yaml_get_bool(r->yaml, r->record, "extrapolate", &m->extrapolate, r->error));
  ABBE_TRY(abbe_yaml_get_number(r->yaml, r->record, "temperature_c", -273.15, 1e4,
                                &m->temperature_c, r->error));
  ABBE_TRY(abbe_yaml_get_bool(r->yaml, r->record, "n_absolute", &m->n_absolute, r->error));
  ABBE_TRY(read_absorption(r));
  ABBE_TRY(read_fluorescence(r));
  ABBE_TRY(read_published(r));
  ABBE_TRY(read_density(r));
  ABBE_TRY(read_catalogue(r));
  return read_fits(r);
}

abbe_result abbe_material_record_read(abbe_yaml *yaml, abbe_yaml_node record,
                                      abbe_material *material, abbe_error *error) {
  abbe_record_reading r = {yaml, record, material, error, false};
  return read_record(&r);
}

abbe_result abbe_material_record_read_lenient(abbe_yaml *yaml, abbe_yaml_node record,
                                              abbe_material *material, abbe_error *error) {
  abbe_record_reading r = {yaml, record, material, error, true};
  return read_record(&r);
}
