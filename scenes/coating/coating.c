#include "scenes/coating/coating.h"

#include "base/file.h"
#include "base/number.h"
#include "spectral/materials/absorption.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

void abbe_coatings_free(abbe_coatings *c) {
  if (c == NULL) return;
  for (size_t i = 0; i < c->count; i++) {
    abbe_coating *coating = &c->coating[i];
    for (size_t k = 0; k < coating->count; k++) {
      abbe_spectrum_free(coating->layer[k].n);
      abbe_spectrum_free(coating->layer[k].k);
    }
    free(coating->path);
    free(coating->faces);
  }
  free(c->face);
  free(c);
}

const abbe_coating *abbe_coatings_on(const abbe_coatings *c, size_t face) {
  if (c == NULL) return NULL;
  const size_t number = c->face == NULL ? 1 : c->face[face];
  return number == 0 ? NULL : &c->coating[number - 1];
}

static abbe_result layer_at(const abbe_coating_layer *l, double lambda_nm, abbe_film_layer *out,
                            abbe_error *error) {
  *out = (abbe_film_layer){l->index[0], l->index[1], l->nm};
  if (l->n != NULL) {
    out->n = abbe_spectrum_at(l->n, lambda_nm);
    out->k = abbe_spectrum_at(l->k, lambda_nm);
  }
  if (l->material == NULL) return ABBE_OK;
  if (abbe_material_is_conductor(l->material))
    return abbe_material_nk(l->material, lambda_nm, &out->n, &out->k, error);
  out->k = abbe_absorption_k(abbe_material_attenuation(l->material, lambda_nm), lambda_nm);
  return abbe_material_n(l->material, lambda_nm, &out->n, error);
}

abbe_result abbe_coating_at(const abbe_coating *coating, double lambda_nm,
                            abbe_film_layer layer[ABBE_FILM_MOST_LAYERS], abbe_error *error) {
  for (size_t i = 0; i < coating->count; i++) {
    ABBE_TRY(layer_at(&coating->layer[i], lambda_nm, &layer[i], error));
  }
  return ABBE_OK;
}

abbe_result abbe_coating_straight(const abbe_coating *coating, double n, bool inside,
                                  double lambda_nm, double *reflected, double *transmitted,
                                  abbe_error *error) {
  abbe_film_layer layer[ABBE_FILM_MOST_LAYERS];
  abbe_film_light light;
  ABBE_TRY(abbe_coating_at(coating, lambda_nm, layer, error));
  const double to[2] = {inside ? 1 : n, 0};
  abbe_film_light_at(layer, coating->count, inside, inside ? n : 1, to, 1, lambda_nm, &light);
  abbe_film_unpolarised(&light, reflected, transmitted);
  return ABBE_OK;
}

abbe_result abbe_coating_add(abbe_coating *coating, const abbe_coating_layer *layer,
                             abbe_error *error) {
  const abbe_material *m = layer->material;
  if (coating->count == ABBE_FILM_MOST_LAYERS)
    return abbe_error_set(error, ABBE_UNSUPPORTED, "a coating has at most %d layers",
                          ABBE_FILM_MOST_LAYERS);
  if (m != NULL && abbe_material_is_crystal(m))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the material '%s' is a crystal, and layers have one index in all "
                          "directions: give the layer's index as a number",
                          m->name);
  if (!(layer->nm >= 0 && layer->nm <= ABBE_FILM_MOST_NM))
    return abbe_error_set(error, ABBE_SCHEMA,
                          "a layer is %g nm thick; it is to be from 0 to %d nm: light that crosses "
                          "more does not interfere",
                          layer->nm, ABBE_FILM_MOST_NM);
  coating->layer[coating->count++] = *layer;
  return ABBE_OK;
}

enum { MOST_BYTES = 1 << 24, MOST_WORDS = 12, MOST_POINTS = 4096, WORD = 64 };

static const double most_index = 1000;

/* A line of the file, cut into words; what comes behind ! is a remark. */
typedef struct reading {
  const char *path, *at;
  size_t line, words;
  char word[MOST_WORDS][WORD];
  abbe_error *error;
} reading;

#define FAIL(r, code, format, ...)                                                                 \
  abbe_error_set((r)->error, code, "%.300s:%zu: " format, (r)->path, (r)->line, __VA_ARGS__)

/* The next line that holds words; false at the end. */
static bool next_line(reading *r) {
  while (*r->at != '\0') {
    const size_t length = strcspn(r->at, "\r\n"), used = strcspn(r->at, "\r\n!");
    const char *at = r->at, *end = r->at + used;
    r->line++;
    r->words = 0;
    while (at < end) {
      while (at < end && isspace((unsigned char)*at)) at++;
      size_t size = 0;
      while (at + size < end && !isspace((unsigned char)at[size])) size++;
      if (size > 0 && r->words < MOST_WORDS)
        snprintf(r->word[r->words++], WORD, "%.*s", (int)(size < WORD ? size : WORD - 1), at);
      at += size;
    }
    r->at += length;
    if (*r->at == '\r' && r->at[1] == '\n') r->at++;
    if (*r->at != '\0') r->at++;
    if (r->words > 0) return true;
  }
  return false;
}

static bool begins(const reading *r, const char *key) {
  return strcasecmp(r->word[0], key) == 0;
}

static bool begins_section(const reading *r) {
  static const char *const keys[] = {"MATE", "COAT", "TAPR", "TABLE", "IDEAL", "IDEAL2"};
  for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
    if (begins(r, keys[i])) return true;
  return false;
}

static bool number_at(const reading *r, size_t word, double *out) {
  const char *end;
  return word < r->words && abbe_number_read(r->word[word], &end, out) && *end == '\0' &&
         isfinite(*out);
}

/* The section of that key and name from the file's beginning; false where there is none. */
static bool find(reading *r, const char *text, const char *key, const char *name) {
  r->at = text;
  r->line = 0;
  while (next_line(r))
    if (begins(r, key) && r->words > 1 && strcasecmp(r->word[1], name) == 0) return true;
  return false;
}

/* Points um, n, k of a material, of which k is below 0 where it absorbs: Abbe's sign is the other.
 */
static abbe_result read_points(reading *r, abbe_coating_layer *out) {
  static _Thread_local double nm[MOST_POINTS], n[MOST_POINTS], k[MOST_POINTS];
  size_t count = 0;
  char name[WORD];
  snprintf(name, sizeof name, "%s", r->word[1]);
  while (next_line(r) && !begins_section(r)) {
    double um = 0;
    if (count == MOST_POINTS)
      return FAIL(r, ABBE_UNSUPPORTED, "'%s' has more than %d points", name, MOST_POINTS);
    k[count] = 0;
    if (!number_at(r, 0, &um) || !number_at(r, 1, &n[count]) ||
        (r->words > 2 && !number_at(r, 2, &k[count])))
      return FAIL(r, ABBE_PARSE, "a point of '%s' is three numbers: um, n and k", name);
    if (k[count] > 0)
      return FAIL(r, ABBE_SCHEMA,
                  "'%s' has k = %g, which would make light: this format has k below 0 for what "
                  "absorbs",
                  name, k[count]);
    if (!(um > 0 && n[count] > 0 && n[count] <= most_index && k[count] >= -most_index))
      return FAIL(r, ABBE_SCHEMA,
                  "'%s' has n = %g and k = %g at %g um; wavelength and n are above 0, n and -k at "
                  "most %g",
                  name, n[count], k[count], um, most_index);
    nm[count] = abbe_number_tidy(1000 * um);
    if (count > 0 && !(nm[count] > nm[count - 1]))
      return FAIL(r, ABBE_SCHEMA, "'%s' has %g um after %g um; wavelengths must rise", name, um,
                  nm[count - 1] / 1000);
    k[count] = -k[count];
    count++;
  }
  if (count == 0) return FAIL(r, ABBE_PARSE, "the material '%s' has no points", name);
  ABBE_TRY(abbe_spectrum_make(nm, n, count, ABBE_INTERPOLATION_LINEAR, &out->n, r->error));
  return abbe_spectrum_make(nm, k, count, ABBE_INTERPOLATION_LINEAR, &out->k, r->error);
}

/* A layer's thickness: um, or waves of primary_nm in it. */
static abbe_result take_thickness(const reading *r, double thickness, bool absolute,
                                  double primary_nm, abbe_coating *coating) {
  abbe_coating_layer *layer = &coating->layer[coating->count - 1];
  abbe_film_layer at[ABBE_FILM_MOST_LAYERS];
  layer->nm = 1000 * thickness;
  if (!absolute) {
    if (!(primary_nm > 0))
      return FAIL(r, ABBE_SCHEMA,
                  "the layer of '%s' is %g waves thick: say of which wavelength, in nm, such as "
                  "'primary: 550' beside the file",
                  r->word[0], thickness);
    ABBE_TRY(abbe_coating_at(coating, primary_nm, at, r->error));
    layer->nm = thickness * primary_nm / at[coating->count - 1].n;
  }
  if (layer->nm >= 0 && layer->nm <= ABBE_FILM_MOST_NM) return ABBE_OK;
  return FAIL(r, ABBE_SCHEMA, "the layer of '%s' is %g nm thick; it is to be from 0 to %d nm",
              r->word[0], layer->nm, ABBE_FILM_MOST_NM);
}

static abbe_result read_layer(reading *r, const char *text, double primary_nm,
                              const abbe_material_table *table, abbe_coating *out) {
  double thickness = 0, absolute = 0, loop = 0;
  if (!number_at(r, 1, &thickness) || (r->words > 2 && !number_at(r, 2, &absolute)) ||
      (r->words > 3 && !number_at(r, 3, &loop)))
    return FAIL(r, ABBE_PARSE,
                "a layer is a material, a thickness and 1 (um) or 0 (waves); '%s' is none",
                r->word[0]);
  if (loop < 0 || loop > 0)
    return FAIL(r, ABBE_UNSUPPORTED,
                "the layer of '%s' begins or ends a loop: write its layers out", r->word[0]);
  if (r->words > 4)
    return FAIL(r, ABBE_UNSUPPORTED, "the layer of '%s' has the taper '%s': films are even here",
                r->word[0], r->word[4]);
  reading at = *r;
  abbe_coating_layer layer = {0};
  abbe_result result = ABBE_OK;
  if (find(&at, text, "MATE", r->word[0]))
    result = read_points(&at, &layer);
  else if (abbe_material_table_find(table, r->word[0], &layer.material, NULL) != ABBE_OK)
    result = FAIL(r, ABBE_NOT_FOUND,
                  "neither the file nor the table of materials has the material '%s'", r->word[0]);
  const size_t count = out->count;
  if (result == ABBE_OK) result = abbe_coating_add(out, &layer, r->error);
  if (out->count == count) {
    abbe_spectrum_free(layer.n);
    abbe_spectrum_free(layer.k);
    return result;
  }
  return take_thickness(r, thickness, absolute > 0, primary_nm, out);
}

/* The names of the coatings of layers. */
static void list(reading *r, const char *text, char *out, size_t size) {
  size_t used = 0;
  out[0] = '\0';
  r->at = text;
  r->line = 0;
  while (next_line(r))
    if (begins(r, "COAT") && r->words > 1 && used + WORD + 3 < size)
      used += (size_t)snprintf(out + used, size - used, "%s%s", used > 0 ? ", " : "", r->word[1]);
}

static abbe_result read_coating(reading *r, const char *text, const char *name, double primary_nm,
                                const abbe_material_table *table, abbe_coating *out) {
  static const char *const others[] = {"TABLE", "IDEAL", "IDEAL2"};
  char names[400];
  for (int i = 0; i < 3; i++)
    if (find(r, text, others[i], name))
      return FAIL(r, ABBE_UNSUPPORTED,
                  "'%s' is of the kind %s, which says nothing of the other side of its film; only "
                  "COAT is read, which lists layers",
                  name, others[i]);
  if (!find(r, text, "COAT", name)) {
    list(r, text, names, sizeof names);
    return abbe_error_set(r->error, ABBE_NOT_FOUND, "%.300s has no coating '%s'; it has %s",
                          r->path, name, names[0] != '\0' ? names : "none");
  }
  while (next_line(r) && !begins_section(r)) {
    ABBE_TRY(read_layer(r, text, primary_nm, table, out));
  }
  if (out->count > 0) return ABBE_OK;
  return FAIL(r, ABBE_SCHEMA, "the coating '%s' has no layers", name);
}

abbe_result abbe_coating_dat_read(const char *path, const char *name, double primary_nm,
                                  const abbe_material_table *table, abbe_coating *out,
                                  abbe_error *error) {
  ABBE_FREED char *text = NULL;
  size_t size = 0;
  const char *ending = strrchr(path, '.');
  if (ending != NULL && strcasecmp(ending, ".zec") == 0)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%.300s is an encrypted coating, which only its maker's program reads: "
                          "ask the maker for its layers, as a COATING.DAT has them",
                          path);
  if (ending != NULL && strcasecmp(ending, ".coated") == 0)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%.300s is a table of reflectances for one side, without layers; a "
                          "COATING.DAT with the layers themselves can be read",
                          path);
  ABBE_TRY(abbe_file_read_text(path, MOST_BYTES, &text, &size, error));
  reading r = {.path = path, .error = error};
  return read_coating(&r, text, name, primary_nm, table, out);
}
