#include "spectral/formats/material_write.h"

#include "base/number.h"
#include "spectral/materials/absorption.h"
#include "spectral/wavelengths.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NAME = 120 };

static void put(FILE *to, double value, const char *before) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  fprintf(to, "%s%s", before, abbe_number_text(abbe_number_tidy(value), text));
}

static void put_text(FILE *to, const char *text) {
  for (; *text != '\0'; text++)
    if (strchr("&<\"", *text) != NULL)
      fputs(*text == '&' ? "&amp;" : *text == '<' ? "&lt;" : "&quot;", to);
    else
      fputc((unsigned char)*text < 0x20 ? ' ' : *text, to);
}

typedef char made_name[MOST_NAME];

/* MaterialX's names are of letters, digits and '_', each only once: a number is added to the
 * second. */
static void make_name(const char *text, made_name *made, size_t count) {
  char *out = made[count];
  size_t length = 0;
  for (; *text != '\0' && length < MOST_NAME - 24; text++)
    out[length++] = isalnum((unsigned char)*text) && (unsigned char)*text < 0x80 ? *text : '_';
  out[length] = '\0';
  for (size_t i = 0, again = 2; i < count; i++)
    if (strcmp(made[i], out) == 0) {
      snprintf(out + length, 24, "_%zu", again++);
      i = (size_t)-1; /* from the start */
    }
}

/* The distance where the darkest of the three shares is 1 / e, m, and the shares; 0: clear. */
static double volume_colour(const abbe_material *m, double colour[3]) {
  double most = 0;
  if (m->attenuation == NULL) return 0;
  abbe_absorption_colour(m->attenuation, 1, colour);
  for (int i = 0; i < 3; i++) most = fmax(most, -log(fmax(colour[i], 1e-300)));
  if (!(most > 0)) return 0;
  abbe_absorption_colour(m->attenuation, 1 / most, colour);
  return 1 / most;
}

/* The greatest distance from 380 to 780 nm, within the record's range, between n and Cauchy's two
 * terms. */
static double cauchy_error(const abbe_material *m, double n_d, double v_d) {
  const double F = ABBE_LINE_F_NM, C = ABBE_LINE_C_NM, d = ABBE_LINE_D_NM;
  const double b = (n_d - 1) / v_d / (1 / (F * F) - 1 / (C * C));
  double most = 0;
  for (double l = fmax(m->min_nm, 380); l <= fmin(m->max_nm, 780); l++) {
    const double n = n_d + b * (1 / (l * l) - 1 / (d * d));
    most = fmax(most, fabs(n - abbe_dispersion_n(&m->dispersion, l)));
  }
  return most;
}

static void write_shader(FILE *to, const abbe_material *m, const abbe_dispersion_numbers *d,
                         const char *name) {
  double colour[3];
  const double distance = volume_colour(m, colour);
  fprintf(to, "  <open_pbr_surface name=\"SR_%s\" type=\"surfaceshader\" doc=\"", name);
  put_text(to, m->source);
  fputs("\">\n    <input name=\"specular_roughness\" type=\"float\" value=\"0\"/>\n"
        "    <input name=\"transmission_weight\" type=\"float\" value=\"1\"/>\n"
        "    <input name=\"transmission_dispersion_scale\" type=\"float\" value=\"1\"/>\n",
        to);
  put(to, d->n_d, "    <input name=\"specular_ior\" type=\"float\" value=\"");
  put(to, d->v_d,
      "\"/>\n    <input name=\"transmission_dispersion_abbe_number\" type=\"float\" value=\"");
  if (distance > 0) {
    put(to, distance, "\"/>\n    <input name=\"transmission_depth\" type=\"float\" value=\"");
    for (int i = 0; i < 3; i++)
      put(to, colour[i],
          i == 0 ? "\"/>\n    <input name=\"transmission_color\" type=\"color3\" "
                   "colorspace=\"lin_rec709\" value=\""
                 : ", ");
  }
  fprintf(to,
          "\"/>\n  </open_pbr_surface>\n  <surfacematerial name=\"%s\" type=\"material\">\n"
          "    <input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"SR_%s\"/>\n"
          "  </surfacematerial>\n",
          name, name);
}

abbe_result abbe_mtlx_write(const abbe_material_table *table, FILE *to, abbe_report *report,
                            abbe_error *error) {
  made_name *made = calloc(table->count + 1, sizeof *made);
  size_t count = 0;
  if (made == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for names");
  fputs("<?xml version=\"1.0\"?>\n<!-- Written by Abbe. Lengths in metres. -->\n"
        "<materialx version=\"1.39\">\n",
        to);
  for (size_t i = 0; i < table->count; i++) {
    const abbe_material *m = &table->material[i];
    const abbe_dispersion_numbers d = abbe_dispersion_describe(&m->dispersion);
    const bool covered =
        m->extrapolate || (m->min_nm <= ABBE_LINE_F_NM && m->max_nm >= ABBE_LINE_C_NM);
    if (abbe_material_is_conductor(m) || !covered || !(d.n_d > 1 && d.v_d > 0 && isfinite(d.v_d))) {
      abbe_report_add(report, ABBE_NOTE_SKIPPED, m->line, m->name, "%s",
                      abbe_material_is_conductor(m) ? "it is a conductor"
                                                    : "it has no n_d and V_d in its range");
      continue;
    }
    if (abbe_material_is_crystal(m))
      abbe_report_add(report, ABBE_NOTE_LOST, m->line, m->name,
                      "it is written with its %s index and its first absorption alone",
                      abbe_material_is_biaxial(m) ? "middle" : "ordinary");
    abbe_report_add(
        report, ABBE_NOTE_LOST, m->line, m->name,
        "n is Cauchy's two terms through n_d %.6g and V_d %.4g; from 380 to 780 nm it is "
        "off by up to %.2g%s",
        d.n_d, d.v_d, cauchy_error(m, d.n_d, d.v_d),
        m->attenuation != NULL ? "; absorption is three numbers" : "");
    make_name(m->name, made, count);
    write_shader(to, m, &d, made[count++]);
  }
  free(made);
  fputs("</materialx>\n", to);
  if (fflush(to) == 0 && !ferror(to)) return ABBE_OK;
  return abbe_error_set(error, ABBE_IO, "the materials could not be written");
}
