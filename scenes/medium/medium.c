#include "scenes/medium/medium.h"

#include "base/maths.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_POINTS = 1024 };
static const double far_m = 1e6;

/* ---- coefficients ---- */

static abbe_result read_pair(abbe_yaml *yaml, abbe_yaml_node pair, const char *key, double *nm,
                             double *per_m, abbe_error *error) {
  if (!abbe_yaml_is_sequence(yaml, pair) || abbe_yaml_count(yaml, pair) != 2)
    return abbe_yaml_fail(yaml, pair, error,
                          "a point of '%s' is [nm, per metre], such as [450, 0.3]", key);
  ABBE_TRY(abbe_yaml_number(yaml, abbe_yaml_item(yaml, pair, 0), key, ABBE_SPECTRUM_LOW_NM,
                            ABBE_SPECTRUM_HIGH_NM, nm, error));
  return abbe_yaml_number(yaml, abbe_yaml_item(yaml, pair, 1), key, 0, ABBE_MEDIUM_MOST_PER_M,
                          per_m, error);
}

static abbe_result read_points(abbe_yaml *yaml, abbe_yaml_node list, const char *key,
                               abbe_spectrum **out, abbe_error *error) {
  double nm[MOST_POINTS], per_m[MOST_POINTS];
  const size_t count = abbe_yaml_count(yaml, list);
  if (count == 0 || count > MOST_POINTS)
    return abbe_yaml_fail(yaml, list, error,
                          "'%s' has %zu points; it wants 1 to %d of [nm, per metre]", key, count,
                          MOST_POINTS);
  for (size_t i = 0; i < count; i++) {
    const abbe_yaml_node pair = abbe_yaml_item(yaml, list, i);
    const abbe_result result = read_pair(yaml, pair, key, &nm[i], &per_m[i], error);
    if (result != ABBE_OK) return result;
    if (i > 0 && !(nm[i] > nm[i - 1]))
      return abbe_yaml_fail(yaml, pair, error, "'%s' has %g nm after %g nm; wavelengths must rise",
                            key, nm[i], nm[i - 1]);
  }
  return abbe_spectrum_make(nm, per_m, count, ABBE_INTERPOLATION_LINEAR, out, error);
}

/* A number, or points over wavelength. */
static abbe_result read_coefficient(abbe_yaml *yaml, abbe_yaml_node medium, const char *key,
                                    abbe_spectrum **out, abbe_error *error) {
  const double anywhere_nm = 555;
  const abbe_yaml_node node = abbe_yaml_get(yaml, medium, key);
  double per_m = 0;
  if (node.id == 0) return ABBE_OK;
  if (abbe_yaml_is_sequence(yaml, node)) return read_points(yaml, node, key, out, error);
  const abbe_result result =
      abbe_yaml_get_number(yaml, medium, key, 0, ABBE_MEDIUM_MOST_PER_M, &per_m, error);
  return result == ABBE_OK
             ? abbe_spectrum_make(&anywhere_nm, &per_m, 1, ABBE_INTERPOLATION_LINEAR, out, error)
             : result;
}

/* ---- the region ---- */

static abbe_result read_corner(abbe_yaml *yaml, abbe_yaml_node corner, double out[3],
                               abbe_error *error) {
  if (!abbe_yaml_is_sequence(yaml, corner) || abbe_yaml_count(yaml, corner) != 3)
    return abbe_yaml_fail(yaml, corner, error, "a corner of 'box' is a point [x, y, z]");
  for (size_t k = 0; k < 3; k++)
    ABBE_TRY(abbe_yaml_number(yaml, abbe_yaml_item(yaml, corner, k), "box", -far_m, far_m, &out[k],
                              error));
  return ABBE_OK;
}

static abbe_result read_box(abbe_yaml *yaml, abbe_yaml_node medium, abbe_medium *out,
                            abbe_error *error) {
  const abbe_yaml_node box = abbe_yaml_get(yaml, medium, "box");
  if (box.id == 0)
    return abbe_yaml_fail(yaml, medium, error,
                          "the air's 'medium' needs a 'box' that it fills, two corners such as "
                          "[[-1, -1, 0], [1, 1, 2]]; it would have no end else");
  if (!abbe_yaml_is_sequence(yaml, box) || abbe_yaml_count(yaml, box) != 2)
    return abbe_yaml_fail(yaml, box, error,
                          "'box' wants two corners, such as [[-1, -1, 0], [1, 1, 2]]");
  ABBE_TRY(read_corner(yaml, abbe_yaml_item(yaml, box, 0), out->min, error));
  ABBE_TRY(read_corner(yaml, abbe_yaml_item(yaml, box, 1), out->max, error));
  for (int k = 0; k < 3; k++)
    if (!(out->min[k] < out->max[k]))
      return abbe_yaml_fail(yaml, box, error,
                            "the 'box' reaches from %g to %g along %c; its first corner must be "
                            "the lower one in each coordinate",
                            out->min[k], out->max[k], "xyz"[k]);
  return ABBE_OK;
}

/* ---- the whole ---- */

static abbe_result refuse_inside(abbe_yaml *yaml, abbe_yaml_node medium, abbe_error *error) {
  const abbe_yaml_node absorption = abbe_yaml_get(yaml, medium, "absorption");
  const abbe_yaml_node box = abbe_yaml_get(yaml, medium, "box");
  if (absorption.id != 0)
    return abbe_yaml_fail(yaml, absorption, error,
                          "what an object absorbs is its material's: give the material an "
                          "'absorption', and its 'medium' what scatters alone");
  if (box.id != 0)
    return abbe_yaml_fail(yaml, box, error,
                          "the 'medium' of an object fills the object: leave out its 'box'");
  return ABBE_OK;
}

static abbe_result read_medium(abbe_yaml *yaml, abbe_yaml_node node, bool air, abbe_medium *out,
                               abbe_error *error) {
  if (!abbe_yaml_is_mapping(yaml, node))
    return abbe_yaml_fail(yaml, node, error,
                          "'medium' wants a mapping, such as {scattering: 0.3, g: 0.5%s}",
                          air ? ", box: [[-1, -1, 0], [1, 1, 2]]" : "");
  ABBE_TRY(read_coefficient(yaml, node, "scattering", &out->scattering, error));
  ABBE_TRY(abbe_yaml_get_number(yaml, node, "g", -1, 1, &out->g, error));
  if (fabs(out->g) >= 1)
    return abbe_yaml_fail(yaml, abbe_yaml_get(yaml, node, "g"), error,
                          "'g: %g' must lie between -1 and 1; at these nothing would be turned",
                          out->g);
  if (!air) ABBE_TRY(refuse_inside(yaml, node, error));
  if (air) ABBE_TRY(read_coefficient(yaml, node, "absorption", &out->absorption, error));
  if (air) ABBE_TRY(read_box(yaml, node, out, error));
  ABBE_TRY(abbe_yaml_check_keys(yaml, node, "a 'medium'", error));
  if (out->scattering == NULL && out->absorption == NULL)
    return abbe_yaml_fail(yaml, node, error,
                          "this 'medium' does nothing; give it a 'scattering' per metre%s",
                          air ? ", an 'absorption', or both" : "");
  return ABBE_OK;
}

abbe_result abbe_medium_file_read(abbe_yaml *yaml, abbe_yaml_node mapping, bool air,
                                  abbe_medium **out, abbe_error *error) {
  *out = NULL;
  const abbe_yaml_node node = abbe_yaml_get(yaml, mapping, "medium");
  if (node.id == 0) return ABBE_OK;
  abbe_medium *medium = calloc(1, sizeof *medium);
  if (medium == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a medium");
  const abbe_result result = read_medium(yaml, node, air, medium, error);
  if (result == ABBE_OK)
    *out = medium;
  else
    abbe_medium_free(medium);
  return result;
}

static abbe_result copy_spectrum(const abbe_spectrum *s, abbe_spectrum **out, abbe_error *error) {
  *out = NULL;
  if (s == NULL) return ABBE_OK;
  return abbe_spectrum_make(abbe_spectrum_lambda_nm(s), abbe_spectrum_value(s),
                            abbe_spectrum_count(s), abbe_spectrum_interpolation(s), out, error);
}

abbe_result abbe_medium_copy(const abbe_medium *m, abbe_medium **out, abbe_error *error) {
  *out = NULL;
  if (m == NULL) return ABBE_OK;
  abbe_medium *copy = malloc(sizeof *copy);
  if (copy == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a medium");
  *copy = *m;
  copy->absorption = NULL;
  abbe_result result = copy_spectrum(m->scattering, &copy->scattering, error);
  if (result == ABBE_OK) result = copy_spectrum(m->absorption, &copy->absorption, error);
  if (result == ABBE_OK)
    *out = copy;
  else
    abbe_medium_free(copy);
  return result;
}

void abbe_medium_free(abbe_medium *m) {
  if (m == NULL) return;
  abbe_spectrum_free(m->scattering);
  abbe_spectrum_free(m->absorption);
  free(m);
}

static double value_at(const abbe_spectrum *s, double lambda_nm) {
  return s != NULL ? abbe_spectrum_at(s, lambda_nm) : 0;
}

double abbe_medium_scattering(const abbe_medium *m, double lambda_nm) {
  return m != NULL ? value_at(m->scattering, lambda_nm) : 0;
}

double abbe_medium_absorption(const abbe_medium *m, double lambda_nm) {
  return m != NULL ? value_at(m->absorption, lambda_nm) : 0;
}

/* Linear between its points, so it varies where the range's ends or points within it differ. */
static bool varies(const abbe_spectrum *s, double low_nm, double high_nm) {
  if (s == NULL) return false;
  const double first = abbe_spectrum_at(s, low_nm);
  bool found = abbe_spectrum_at(s, high_nm) != first;
  for (size_t i = 0; i < abbe_spectrum_count(s); i++) {
    const double at = abbe_spectrum_lambda_nm(s)[i];
    found = found || (at > low_nm && at < high_nm && abbe_spectrum_value(s)[i] != first);
  }
  return found;
}

bool abbe_medium_is_coloured(const abbe_medium *m, double low_nm, double high_nm) {
  return m != NULL &&
         (varies(m->scattering, low_nm, high_nm) || varies(m->absorption, low_nm, high_nm));
}

double abbe_medium_phase(double g, double cosine) {
  const double square = 1 + g * g - 2 * g * cosine;
  return (1 - g * g) / (4 * ABBE_PI * square * sqrt(square));
}
