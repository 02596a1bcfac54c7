#include "spectral/formats/shader_export.h"

#include "base/number.h"
#include "spectral/dispersion/povray_index.h"
#include "spectral/materials/absorption.h"
#include "spectral/wavelengths.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { STEP_NM = 5, MAX_IDENTIFIER = 120 };

/* What pbrt-v4 samples; a spectrum of it is 0 outside its points. */
static const double PBRT_LOW_NM = 360, PBRT_HIGH_NM = 830;

/* ---- n where the record has it, and beyond ---- */

static double index_at(const abbe_material *m, double lambda_nm) {
  double held = fmin(fmax(lambda_nm, m->min_nm), m->max_nm);
  double n = m->extrapolate ? abbe_dispersion_n(&m->dispersion, lambda_nm) : NAN;
  return isnan(n) ? abbe_dispersion_n(&m->dispersion, held) : n;
}

/* The part of [low, high] that the record vouches for. */
static bool vouched(const abbe_material *m, double *low, double *high) {
  if (m->extrapolate) return true;
  *low = fmax(*low, m->min_nm);
  *high = fmin(*high, m->max_nm);
  return *low < *high;
}

void abbe_shader_povray_numbers(const abbe_material *material, double *ior, double *dispersion,
                                double *max_error) {
  enum { STEPS = 350 };
  double low = ABBE_POVRAY_VIOLET_NM, high = ABBE_POVRAY_RED_NM;
  double lambda_nm[STEPS + 1], n[STEPS + 1];
  if (!vouched(material, &low, &high)) low = ABBE_POVRAY_VIOLET_NM, high = ABBE_POVRAY_RED_NM;
  for (int i = 0; i <= STEPS; i++) {
    lambda_nm[i] = low + (high - low) * i / STEPS;
    n[i] = index_at(material, lambda_nm[i]);
  }
  abbe_povray_index index = abbe_povray_index_fit(lambda_nm, n, NULL, STEPS + 1);
  *ior = index.ior;
  *dispersion = index.dispersion;
  *max_error = 0;
  for (int i = 0; i <= STEPS; i++)
    *max_error = fmax(*max_error, fabs(abbe_povray_index_at(&index, lambda_nm[i]) - n[i]));
}

void abbe_shader_gltf_numbers(const abbe_material *material, double *ior, double *dispersion,
                              double *max_error) {
  double low = ABBE_WAVELENGTH_MIN_NM, high = ABBE_WAVELENGTH_MAX_NM;
  double spread = index_at(material, ABBE_LINE_F_NM) - index_at(material, ABBE_LINE_C_NM);
  *ior = index_at(material, ABBE_LINE_D_NM);
  double v_d = (*ior - 1) / spread;
  *dispersion = v_d > 0 && isfinite(v_d) ? 20 / v_d : 0;
  double F = ABBE_LINE_F_NM / 1000, C = ABBE_LINE_C_NM / 1000, d = ABBE_LINE_D_NM / 1000;
  double B = (*ior - 1) * *dispersion / 20 / (1 / (F * F) - 1 / (C * C));
  *max_error = 0;
  if (!vouched(material, &low, &high)) return;
  for (int i = 0; i <= 400; i++) {
    double L = (low + (high - low) * i / 400) / 1000;
    double n = *ior + B * (1 / (L * L) - 1 / (d * d));
    *max_error = fmax(*max_error, fabs(n - index_at(material, 1000 * L)));
  }
}

/* Largest difference between n and the straight lines between samples at low + k STEP_NM. */
static double sampling_error(const abbe_material *m, double low, double high) {
  double worst = 0;
  for (double l = low; l < high; l += STEP_NM)
    for (int i = 1; i < STEP_NM; i++) {
      double t = (double)i / STEP_NM;
      double line = (1 - t) * index_at(m, l) + t * index_at(m, l + STEP_NM);
      worst = fmax(worst, fabs(line - index_at(m, l + i)));
    }
  return worst;
}

/* ---- what all of them write ---- */

typedef struct writer {
  FILE *to;
  abbe_report *report;
  char (*used)[MAX_IDENTIFIER]; /* identifiers written so far */
  size_t count;
} writer;

static void put(FILE *to, double value, const char *before) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  fprintf(to, "%s%s", before, abbe_number_text(value, text));
}

/* Letters, digits and '_', beginning with a letter; a number after it where it stands already. */
static const char *identifier(writer *w, const char *name) {
  char *made = w->used[w->count];
  char stem[MAX_IDENTIFIER - 16];
  size_t used = 0;
  if (!isalpha((unsigned char)name[0])) used = (size_t)snprintf(stem, sizeof stem, "m_");
  for (const char *c = name; *c != '\0' && used + 1 < sizeof stem; c++)
    stem[used++] = isalnum((unsigned char)*c) && (unsigned char)*c < 0x80 ? *c : '_';
  stem[used] = '\0';
  snprintf(made, MAX_IDENTIFIER, "%s", stem);
  size_t again = 1;
  for (size_t i = 0; i < w->count; i++)
    if (strcmp(w->used[i], made) == 0) {
      snprintf(made, MAX_IDENTIFIER, "%s_%zu", stem, ++again);
      i = (size_t)-1; /* from the start */
    }
  w->count++;
  return made;
}

static void comment(FILE *to, const char *mark, const abbe_material *m) {
  fprintf(to, "%s ", mark);
  for (const char *c = m->name; *c != '\0'; c++) fputc(*c, to);
  fputs("; source: ", to);
  for (const char *c = m->source; *c != '\0'; c++) fputc((unsigned char)*c < 0x20 ? ' ' : *c, to);
  fputc('\n', to);
}

static void note_range(writer *w, const abbe_material *m, double low, double high) {
  bool outside = m->min_nm > low || m->max_nm < high;
  if (outside && !m->extrapolate)
    abbe_report_add(w->report, ABBE_NOTE_ASSUMED, m->line, m->name,
                    "its data reach from %g to %g nm; n is held at their ends out to %g and %g nm",
                    m->min_nm, m->max_nm, low, high);
}

static void note_sampling(writer *w, const abbe_material *m, double low, double high) {
  abbe_report_add(w->report, ABBE_NOTE_LOST, m->line, m->name,
                  "n is sampled every %d nm; between the samples it is off by up to %.2g", STEP_NM,
                  sampling_error(m, low, high));
}

static double attenuation_at(const abbe_material *m, double lambda_nm) {
  return abbe_material_attenuation(m, lambda_nm);
}

/* ---- pbrt ---- */

static void pbrt_spectrum(FILE *to, const char *key, const abbe_material *m,
                          double (*value)(const abbe_material *, double)) {
  fprintf(to, "    \"spectrum %s\" [", key);
  int column = 0;
  for (double l = PBRT_LOW_NM; l <= PBRT_HIGH_NM; l += STEP_NM) {
    put(to, l, column++ % 5 == 0 ? "\n      " : "  ");
    put(to, abbe_number_tidy(round(value(m, l) * 1e9) / 1e9), " ");
  }
  fputs(" ]\n", to);
}

static double conductor_n(const abbe_material *m, double lambda_nm) {
  double n = NAN, k = NAN;
  abbe_dispersion_nk(&m->dispersion, fmax(m->min_nm, fmin(lambda_nm, m->max_nm)), &n, &k);
  return n;
}

static double conductor_k(const abbe_material *m, double lambda_nm) {
  double n = NAN, k = NAN;
  abbe_dispersion_nk(&m->dispersion, fmax(m->min_nm, fmin(lambda_nm, m->max_nm)), &n, &k);
  return k;
}

static void write_pbrt_conductor(writer *w, const abbe_material *m) {
  comment(w->to, "#", m);
  fprintf(w->to, "MakeNamedMaterial \"%s\" \"string type\" \"conductor\"\n",
          identifier(w, m->name));
  pbrt_spectrum(w->to, "eta", m, conductor_n);
  pbrt_spectrum(w->to, "k", m, conductor_k);
  abbe_report_add(w->report, ABBE_NOTE_LOST, m->line, m->name,
                  "n and k are sampled every %d nm from %g to %g nm", STEP_NM, PBRT_LOW_NM,
                  PBRT_HIGH_NM);
  note_range(w, m, PBRT_LOW_NM, PBRT_HIGH_NM);
}

static void write_pbrt(writer *w, const abbe_material *m) {
  FILE *to = w->to;
  if (abbe_material_is_conductor(m)) {
    write_pbrt_conductor(w, m);
    return;
  }
  const char *name = identifier(w, m->name);
  comment(to, "#", m);
  fprintf(to, "MakeNamedMaterial \"%s\" \"string type\" \"dielectric\"\n", name);
  pbrt_spectrum(to, "eta", m, index_at);
  note_sampling(w, m, PBRT_LOW_NM, PBRT_HIGH_NM);
  note_range(w, m, PBRT_LOW_NM, PBRT_HIGH_NM);
  if (m->attenuation == NULL) return;
  fprintf(to, "# inside it, for a scene in metres: MediumInterface \"%s\" \"\"\n", name);
  fprintf(to, "MakeNamedMedium \"%s\" \"string type\" \"homogeneous\" \"float scale\" 1\n", name);
  pbrt_spectrum(to, "sigma_a", m, attenuation_at);
  fputs("    \"spectrum sigma_s\" [ 360 0 830 0 ]\n", to);
}

/* ---- POV-Ray ---- */

/* As abbe_absorption_colour; of a pleochroic crystal by the mean over its axes. */
static void colour_left(const abbe_material *m, double distance_m, double colour[3]) {
  double product[3] = {1, 1, 1};
  abbe_absorption_colour(m->attenuation, distance_m, colour);
  if (!abbe_material_is_pleochroic(m)) return;
  for (int axis = 0; axis < 3; axis++) {
    const abbe_spectrum *own = axis > 0 ? m->attenuation_yz[axis - 1] : NULL;
    abbe_absorption_colour(own != NULL ? own : m->attenuation, distance_m, colour);
    for (int i = 0; i < 3; i++) product[i] *= colour[i];
  }
  for (int i = 0; i < 3; i++) colour[i] = cbrt(product[i]);
}

static void povray_fading(FILE *to, const abbe_material *m) {
  double colour[3], most = 0;
  colour_left(m, 1, colour);
  for (int i = 0; i < 3; i++) {
    colour[i] = fabs(log(fmax(colour[i], 1e-300))); /* 1/m again, red first */
    most = fmax(most, colour[i]);
  }
  if (most == 0) return;
  /* what is left is exp(-(1 - fade_color) depth / fade_distance) */
  fputs("  fade_power 1001\n", to);
  put(to, 1 / most, "  fade_distance ");
  put(to, 1 - colour[0] / most, " // metres\n  fade_color rgb <");
  put(to, 1 - colour[1] / most, ", ");
  put(to, 1 - colour[2] / most, ", ");
  fputs(">\n", to);
}

static void write_povray(writer *w, const abbe_material *m) {
  double ior, dispersion, max_error;
  FILE *to = w->to;
  abbe_shader_povray_numbers(m, &ior, &dispersion, &max_error);
  comment(to, "//", m);
  fprintf(to, "#declare Abbe_%s = interior {\n", identifier(w, m->name));
  put(to, abbe_number_tidy(round(ior * 1e6) / 1e6), "  ior ");
  put(to, abbe_number_tidy(round(dispersion * 1e6) / 1e6), "\n  dispersion ");
  fputs("\n  dispersion_samples 31\n", to);
  if (m->attenuation != NULL) povray_fading(to, m);
  fputs("}\n", to);
  abbe_report_add(
      w->report, ABBE_NOTE_LOST, m->line, m->name,
      "n is an exponential of the wavelength, ior %.6g and dispersion %.6g; from 380 to "
      "730 nm it is off by up to %.2g%s",
      ior, dispersion, max_error, m->attenuation != NULL ? "; absorption is three numbers" : "");
  note_range(w, m, ABBE_POVRAY_VIOLET_NM, ABBE_POVRAY_RED_NM);
}

/* ---- MDL ---- */

static void mdl_spectrum(FILE *to, const abbe_material *m,
                         double (*value)(const abbe_material *, double)) {
  const double low = ABBE_WAVELENGTH_MIN_NM, high = ABBE_WAVELENGTH_MAX_NM;
  for (int part = 0; part < 2; part++) {
    int column = 0;
    fputs(part == 0 ? "color(\n      float[](" : ",\n      float[](", to);
    for (double l = low; l <= high; l += STEP_NM) {
      if (column > 0) fputs(column % 10 == 0 ? ",\n        " : ", ", to);
      column++;
      double number = part == 0 ? l : abbe_number_tidy(round(value(m, l) * 1e7) / 1e7);
      char text[ABBE_NUMBER_TEXT_SIZE];
      abbe_number_text(number, text);
      fprintf(to, "%s%s", text, strpbrk(text, ".e") == NULL ? ".0" : "");
    }
    fputc(')', to);
  }
  fputc(')', to);
}

static void write_mdl(writer *w, const abbe_material *m) {
  FILE *to = w->to;
  comment(to, "//", m);
  fprintf(to, "export material %s() = material(\n  ior: ", identifier(w, m->name));
  mdl_spectrum(to, m, index_at);
  fputs(",\n  surface: material_surface(scattering: df::specular_bsdf(\n"
        "    tint: color(1.0), mode: df::scatter_reflect_transmit))",
        to);
  if (m->attenuation != NULL) {
    fputs(",\n  volume: material_volume(absorption_coefficient: ", to); /* 1/m */
    mdl_spectrum(to, m, attenuation_at);
    fputc(')', to);
  }
  fputs(");\n", to);
  note_sampling(w, m, ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM);
  note_range(w, m, ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM);
}

/* ---- glTF ---- */

static void json_text(FILE *to, const char *text) {
  fputc('"', to);
  for (; *text != '\0'; text++) {
    if (*text == '"' || *text == '\\')
      fprintf(to, "\\%c", *text);
    else if ((unsigned char)*text < 0x20)
      fprintf(to, "\\u%04x", (unsigned)*text);
    else
      fputc(*text, to);
  }
  fputc('"', to);
}

/* At the distance where the darkest of the three shares is 1 / e. */
static void gltf_volume(FILE *to, const abbe_material *m) {
  double colour[3], most = 0;
  fputs("\"KHR_materials_volume\": { \"thicknessFactor\": 1", to);
  if (m->attenuation != NULL) {
    colour_left(m, 1, colour);
    for (int i = 0; i < 3; i++) most = fmax(most, -log(fmax(colour[i], 1e-300)));
  }
  if (most > 0) {
    colour_left(m, 1 / most, colour);
    put(to, 1 / most, ", \"attenuationDistance\": ");
    for (int i = 0; i < 3; i++)
      put(to, abbe_number_tidy(round(colour[i] * 1e6) / 1e6),
          i == 0 ? ", \"attenuationColor\": [" : ", ");
    fputc(']', to);
  }
  fputs(" }", to);
}

static void write_gltf(writer *w, const abbe_material *m) {
  double ior, dispersion, max_error;
  FILE *to = w->to;
  abbe_shader_gltf_numbers(m, &ior, &dispersion, &max_error);
  fputs(w->count++ > 0 ? ",\n    {\n      \"name\": " : "    {\n      \"name\": ", to);
  json_text(to, m->name);
  fputs(",\n      \"extras\": { \"source\": ", to);
  json_text(to, m->source);
  fputs(" },\n      \"pbrMetallicRoughness\": { \"metallicFactor\": 0, \"roughnessFactor\": 0 },\n"
        "      \"extensions\": {\n        \"KHR_materials_transmission\": "
        "{ \"transmissionFactor\": 1 },\n",
        to);
  put(to, abbe_number_tidy(round(ior * 1e6) / 1e6), "        \"KHR_materials_ior\": { \"ior\": ");
  put(to, abbe_number_tidy(round(dispersion * 1e6) / 1e6),
      " },\n        \"KHR_materials_dispersion\": { \"dispersion\": ");
  fputs(" },\n        ", to);
  gltf_volume(to, m);
  fputs("\n      }\n    }", to);
  abbe_report_add(
      w->report, ABBE_NOTE_LOST, m->line, m->name,
      "n is Cauchy's two terms through ior %.6g and dispersion %.6g; from 380 to 780 nm "
      "it is off by up to %.2g%s",
      ior, dispersion, max_error, m->attenuation != NULL ? "; absorption is three numbers" : "");
  note_range(w, m, ABBE_LINE_F_NM, ABBE_LINE_C_NM);
}

/* ---- whole files ---- */

static const struct {
  void (*write)(writer *w, const abbe_material *m);
  const char *head, *between, *tail;
} forms[] = {
    [ABBE_SHADER_PBRT] = {write_pbrt, "# pbrt-v4; written by Abbe. n is relative to air.\n\n", "\n",
                          ""},
    [ABBE_SHADER_POVRAY] = {write_povray,
                            "// POV-Ray 3.7 or later; written by Abbe. Lengths in metres.\n"
                            "#version 3.7;\n\n",
                            "\n", ""},
    [ABBE_SHADER_MDL] = {write_mdl,
                         "mdl 1.6;\n\n// Written by Abbe. n is relative to air.\n"
                         "import ::df::*;\n\n",
                         "\n", ""},
    [ABBE_SHADER_GLTF] = {write_gltf,
                          "{\n  \"asset\": { \"version\": \"2.0\", \"generator\": \"Abbe\" },\n"
                          "  \"extensionsUsed\": [\"KHR_materials_transmission\", "
                          "\"KHR_materials_ior\",\n    \"KHR_materials_dispersion\", "
                          "\"KHR_materials_volume\"],\n  \"materials\": [\n",
                          "", "\n  ]\n}\n"},
};

abbe_result abbe_shader_write(abbe_shader shader, const abbe_material_table *table, FILE *to,
                              abbe_report *report, abbe_error *error) {
  if ((int)shader < 0 || shader >= ABBE_SHADER_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no shader format %d",
                          (int)shader);
  writer w = {.to = to, .report = report};
  w.used = calloc(table->count + 1, sizeof *w.used);
  if (w.used == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu names", table->count);
  fputs(forms[shader].head, to);
  for (size_t i = 0; i < table->count; i++) {
    const abbe_material *m = &table->material[i];
    abbe_error why;
    if (abbe_material_check(m, &why) != ABBE_OK) {
      abbe_report_add(report, ABBE_NOTE_SKIPPED, m->line, NULL, "%s", why.text);
      continue;
    }
    if (abbe_material_is_conductor(m) && shader != ABBE_SHADER_PBRT) {
      abbe_report_add(report, ABBE_NOTE_SKIPPED, m->line, m->name,
                      "it is a conductor; of the shaders, only pbrt's are written of those");
      continue;
    }
    if (abbe_material_is_crystal(m))
      abbe_report_add(
          report, ABBE_NOTE_LOST, m->line, m->name, "it is written with its %s index alone%s",
          abbe_material_is_biaxial(m) ? "middle" : "ordinary",
          abbe_material_is_pleochroic(m) ? ", and with the mean of its absorption over its axes"
                                         : "");
    if (w.count > 0) fputs(forms[shader].between, to);
    forms[shader].write(&w, m);
  }
  fputs(forms[shader].tail, to);
  free(w.used);
  if (fflush(to) == 0 && !ferror(to)) return ABBE_OK;
  return abbe_error_set(error, ABBE_IO, "the materials could not be written");
}
