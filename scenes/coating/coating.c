#include "scenes/coating/coating.h"

#include "base/file.h"
#include "base/maths.h"
#include "base/number.h"
#include "scenes/geometry/digest.h"
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
      free(coating->layer[k].table);
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
  *out = (abbe_film_layer){l->index[0], l->index[1], l->nm, l->table};
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

uint64_t abbe_coating_digest(uint64_t h, const abbe_coating *c, double lambda_nm) {
  const abbe_film_table *t = c->layer[0].table;
  abbe_film_layer layer[ABBE_FILM_MOST_LAYERS] = {{0}};
  if (t != NULL)
    return abbe_digest(h, t,
                       sizeof *t + (t->angles + t->wavelengths + 4 * t->angles * t->wavelengths) *
                                       sizeof *t->number);
  abbe_coating_at(c, lambda_nm, layer, NULL);
  return abbe_digest(h, layer, c->count * sizeof *layer);
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

enum { MOST_BYTES = 1 << 24, MOST_WORDS = 12, MOST_POINTS = 4096, MOST_ANGLES = 1024, WORD = 64 };

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

/* --- tables --- */

static abbe_result make_table(reading *r, double angles, double wavelengths, abbe_coating *out) {
  if (!(angles >= 1 && angles <= MOST_ANGLES && wavelengths >= 1 && wavelengths <= MOST_POINTS))
    return FAIL(r, ABBE_SCHEMA, "a table has 1 to %d angles of 1 to %d wavelengths, not %g of %g",
                MOST_ANGLES, MOST_POINTS, angles, wavelengths);
  const size_t a = (size_t)angles, w = (size_t)wavelengths;
  abbe_film_table *t = calloc(1, sizeof *t + (a + w + 4 * a * w) * sizeof *t->number);
  if (t == NULL) return FAIL(r, ABBE_NO_MEMORY, "no memory for a table of %zu angles", a);
  t->angles = a;
  t->wavelengths = w;
  out->layer[out->count++] = (abbe_coating_layer){.table = t, .index[0] = 1};
  return ABBE_OK;
}

static abbe_result put_angle(reading *r, abbe_film_table *t, size_t i, double degrees) {
  t->number[i] = 1 - cos(degrees * ABBE_DEGREE);
  if (degrees >= 0 && degrees <= 90 && (i == 0 || t->number[i] > t->number[i - 1])) return ABBE_OK;
  return FAIL(r, ABBE_SCHEMA, "the angle %g does not do: angles rise from 0 to 90 degrees",
              degrees);
}

static abbe_result put_wavelength(reading *r, abbe_film_table *t, size_t k, double nm) {
  double *at = t->number + t->angles + k;
  *at = nm;
  if (nm > 0 && (k == 0 || nm > at[-1])) return ABBE_OK;
  return FAIL(r, ABBE_SCHEMA, "%g nm does not do: wavelengths are above 0 and rise", nm);
}

/* What digits were rounded to more than all light is brought back to it. */
static abbe_result put_shares(reading *r, abbe_film_table *t, size_t i, size_t k, int p,
                              const double share[2]) {
  static const double rounded = 1.001;
  double *at = t->number + t->angles + t->wavelengths + 4 * (i * t->wavelengths + k) + 2 * p;
  const double sum = share[0] + share[1], all = fmax(sum, 1);
  for (int s = 0; s < 2; s++) at[s] = share[s] / all;
  if (share[0] >= 0 && share[1] >= 0 && sum <= rounded) return ABBE_OK;
  return FAIL(r, ABBE_SCHEMA,
              "at %g nm %g %% is reflected and %g %% transmitted; both are 0 or more, and together "
              "at most 100 %%, or the film would make light",
              t->number[t->angles + k], 100 * share[0], 100 * share[1]);
}

static abbe_result read_wave(reading *r, abbe_film_table *t, size_t i, size_t k) {
  double number[5];
  for (size_t n = 0; n < 5; n++)
    if (!number_at(r, n + 1, &number[n]))
      return FAIL(r, ABBE_PARSE, "WAVE has five numbers: um, Rs, Rp, Ts and Tp%s", "");
  const double nm = abbe_number_tidy(1000 * number[0]);
  if (i > 0 && fabs(nm - t->number[t->angles + k]) > 0)
    return FAIL(r, ABBE_SCHEMA, "%g um: all angles of a table have the same wavelengths",
                number[0]);
  ABBE_TRY(put_wavelength(r, t, k, nm));
  for (int p = 0; p < 2; p++)
    ABBE_TRY(put_shares(r, t, i, k, p, (const double[]){number[1 + p], number[3 + p]}));
  return ABBE_OK;
}

/* In a COATING.DAT: ANGL and degrees, then its lines of WAVE. Phases are passed over. */
static abbe_result read_table(reading *r, abbe_coating *out) {
  size_t angles = 0, waves = 0, i = 0, k = 0;
  reading ahead = *r;
  while (next_line(&ahead) && !begins_section(&ahead)) {
    if (begins(&ahead, "ANGL")) angles++;
    if (begins(&ahead, "WAVE") && angles == 1) waves++;
  }
  ABBE_TRY(make_table(r, (double)angles, (double)waves, out));
  abbe_film_table *t = out->layer[0].table;
  while (next_line(r) && !begins_section(r)) {
    double degrees;
    if (begins(r, "ANGL") && k == i * waves && number_at(r, 1, &degrees)) {
      ABBE_TRY(put_angle(r, t, i++, degrees));
    } else if (begins(r, "WAVE") && k < i * waves) {
      ABBE_TRY(read_wave(r, t, i - 1, k % waves));
      k++;
    } else {
      return FAIL(r, ABBE_PARSE,
                  "'%s' does not fit: a table is lines ANGL and degrees, each before as many lines "
                  "of WAVE",
                  r->word[0]);
    }
  }
  if (k == angles * waves) return ABBE_OK;
  return FAIL(r, ABBE_PARSE, "the table's last angle has %zu lines of WAVE, and its first %zu",
              waves - (angles * waves - k), waves);
}

static abbe_result next_number(reading *r, double *out) {
  for (; isspace((unsigned char)*r->at); r->at++) r->line += *r->at == '\n';
  const char *end = r->at;
  if (*r->at != '\0' && abbe_number_read(r->at, &end, out) && isfinite(*out) &&
      (*end == '\0' || isspace((unsigned char)*end))) {
    r->at = end;
    return ABBE_OK;
  }
  const size_t length = strcspn(r->at, " \t\r\n");
  return FAIL(r, ABBE_PARSE,
              "'%.*s' is no number; a table .coated is, from its third line: how "
              "many angles and wavelengths, the wavelengths, and for each angle R and T of p, then "
              "of s, in per cent",
              (int)(length < WORD ? length : WORD), r->at);
}

static bool is_coated(const char *text) {
  const char *title = strstr(text, "oated surface file");
  return title != NULL && title < text + strcspn(text, "\r\n");
}

/* A file of Speos: a title, a remark, then numbers alone. */
static abbe_result read_coated(reading *r, const char *text, abbe_coating *out) {
  double angles, wavelengths, number[2];
  if (!is_coated(text))
    return FAIL(r, ABBE_PARSE, "it begins '%.*s', and not 'OPTIS - Coated surface file'",
                (int)strcspn(text, "\r\n") < WORD ? (int)strcspn(text, "\r\n") : WORD, text);
  r->at = text;
  for (r->line = 1; r->line < 3 && *r->at != '\0'; r->at++) r->line += *r->at == '\n';
  ABBE_TRY(next_number(r, &angles));
  ABBE_TRY(next_number(r, &wavelengths));
  ABBE_TRY(make_table(r, angles, wavelengths, out));
  abbe_film_table *t = out->layer[0].table;
  for (size_t k = 0; k < t->wavelengths; k++) {
    ABBE_TRY(next_number(r, &number[0]));
    ABBE_TRY(put_wavelength(r, t, k, number[0]));
  }
  for (size_t i = 0; i < t->angles; i++) {
    ABBE_TRY(next_number(r, &number[0]));
    ABBE_TRY(put_angle(r, t, i, number[0]));
    for (size_t n = 0; n < 2 * t->wavelengths; n++) {
      for (int s = 0; s < 2; s++) {
        ABBE_TRY(next_number(r, &number[s]));
        number[s] /= 100;
      }
      const bool p_first = n < t->wavelengths;
      ABBE_TRY(
          put_shares(r, t, i, n % t->wavelengths, p_first ? ABBE_FILM_P : ABBE_FILM_S, number));
    }
  }
  if (r->at[strspn(r->at, " \t\r\n")] == '\0') return ABBE_OK;
  return FAIL(r, ABBE_PARSE, "it goes on behind its %zu angles of %zu wavelengths", t->angles,
              t->wavelengths);
}

/* --- files --- */

/* The names of the coatings that are read. */
static void list(reading *r, const char *text, char *out, size_t size) {
  size_t used = 0;
  out[0] = '\0';
  r->at = text;
  r->line = 0;
  while (next_line(r))
    if ((begins(r, "COAT") || begins(r, "TABLE")) && r->words > 1 && used + WORD + 3 < size)
      used += (size_t)snprintf(out + used, size - used, "%s%s", used > 0 ? ", " : "", r->word[1]);
}

static abbe_result read_coating(reading *r, const char *text, const char *name, double primary_nm,
                                const abbe_material_table *table, abbe_coating *out) {
  static const char *const others[] = {"IDEAL", "IDEAL2"};
  char names[400];
  for (int i = 0; i < 2; i++)
    if (find(r, text, others[i], name))
      return FAIL(r, ABBE_UNSUPPORTED,
                  "'%s' is of the kind %s, the same at all angles; COAT, which lists layers, and "
                  "TABLE are read",
                  name, others[i]);
  if (find(r, text, "TABLE", name)) return read_table(r, out);
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

abbe_result abbe_coating_file_read(const char *path, const char *name, double primary_nm,
                                   const abbe_material_table *table, abbe_coating *out,
                                   abbe_error *error) {
  ABBE_FREED char *text = NULL;
  size_t size = 0;
  const char *ending = strrchr(path, '.');
  reading r = {.path = path, .error = error, .line = 1};
  if (ending != NULL && strcasecmp(ending, ".zec") == 0)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%.300s is an encrypted coating, which only its maker's program reads: "
                          "ask the maker for its layers, as a COATING.DAT has them",
                          path);
  ABBE_TRY(abbe_file_read_text(path, MOST_BYTES, &text, &size, error));
  if ((ending != NULL && strcasecmp(ending, ".coated") == 0) || is_coated(text))
    return read_coated(&r, text, out);
  if (name == NULL)
    return abbe_error_set(error, ABBE_SCHEMA,
                          "which coating of %.300s? Say its name beside the file, such as 'name: "
                          "AR'",
                          path);
  return read_coating(&r, text, name, primary_nm, table, out);
}
