#include "colorimetry/screen/lut.h"

#include "base/file.h"
#include "base/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { SHAPER = 65536, PROBES = 4096, GREYS = 1021 };

typedef struct shape {
  double a, span; /* the lowest stop, and log2(h + a) - log2 a */
} shape;

static double shaped(const shape *s, double light) {
  return (log2(light + s->a) - log2(s->a)) / s->span;
}

static double light_of(const shape *s, double y) {
  return s->a * (exp2(y * s->span) - 1);
}

bool abbe_lut_is_meant(const char *path) {
  const char *dot = path != NULL ? strrchr(path, '.') : NULL;
  return dot != NULL && (strcasecmp(dot, ".cube") == 0 || strcasecmp(dot, ".clf") == 0);
}

/* Red runs first. */
static abbe_result make_nodes(const abbe_lut_desc *desc, const shape *s, abbe_image *out,
                              abbe_error *error) {
  const size_t n = desc->nodes;
  ABBE_TRY(abbe_image_make(n, n * n, 3, (const char *const[]){"R", "G", "B"}, out, error));
  for (size_t i = 0; i < n * n * n; i++) {
    const size_t at[3] = {i % n, i / n % n, i / n / n};
    for (int c = 0; c < 3; c++)
      out->data[3 * i + (size_t)c] = (float)light_of(s, (double)at[c] / (double)(n - 1));
  }
  return abbe_display_apply(desc->display, out, error);
}

/* In full, whatever the locale says. */
static void put(FILE *out, double value, const char *after) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  fprintf(out, "%s%s", abbe_number_text(value, text), after);
}

/* The seven places of a table's entries. */
static double rounded(double value) {
  return abbe_number_tidy(round(value * 1e7) / 1e7);
}

static void put_colour(FILE *out, const float v[3]) {
  for (int c = 0; c < 3; c++) put(out, rounded((double)v[c]), c < 2 ? " " : "\n");
}

static void write_cube(const abbe_lut_desc *desc, const shape *s, const abbe_image *nodes,
                       FILE *out) {
  const double most = light_of(s, 1);
  char text[ABBE_NUMBER_TEXT_SIZE];
  fprintf(out, "# %s to %s\n# Input: scene-linear %s, 0 to ", desc->input, desc->output,
          desc->input);
  put(out, most, ", full range; the shaper is a logarithm,\n# ");
  put(out, desc->low, " to ");
  put(out, desc->high, " stops from 0.18. Output: ");
  fprintf(out, "%s, full range.\nLUT_1D_SIZE %d\nLUT_1D_INPUT_RANGE 0 ", desc->output, SHAPER);
  put(out, most, "\n");
  fprintf(out, "LUT_3D_SIZE %zu\nLUT_3D_INPUT_RANGE 0 1\n", desc->nodes);
  for (int i = 0; i < SHAPER; i++) {
    const char *y = abbe_number_text(rounded(shaped(s, most * i / (SHAPER - 1))), text);
    fprintf(out, "%s %s %s\n", y, y, y);
  }
  for (size_t i = 0; i < nodes->width * nodes->height; i++) put_colour(out, nodes->data + 3 * i);
}

static void write_text(const char *text, FILE *out) {
  for (; *text; text++) switch (*text) {
    case '&':
      fputs("&amp;", out);
      break;
    case '<':
      fputs("&lt;", out);
      break;
    case '"':
      fputs("&quot;", out);
      break;
    default:
      fputc(*text, out);
    }
}

static void write_clf(const abbe_lut_desc *desc, const shape *s, const abbe_image *nodes,
                      FILE *out) {
  const size_t n = desc->nodes;
  fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<ProcessList xmlns=\"urn:AMPAS:CLF:v3.0\" id=\"abbe-view\" compCLFversion=\"3.0\">\n"
        "  <InputDescriptor>scene-linear ",
        out);
  write_text(desc->input, out);
  fputs("</InputDescriptor>\n  <OutputDescriptor>", out);
  write_text(desc->output, out);
  char text[3][ABBE_NUMBER_TEXT_SIZE];
  fputs("</OutputDescriptor>\n"
        "  <Log inBitDepth=\"32f\" outBitDepth=\"32f\" style=\"linToLog\">\n    <Description>",
        out);
  put(out, desc->low, " to ");
  put(out, desc->high, " stops from 0.18</Description>\n");
  fprintf(out,
          "    <LogParams base=\"2\" logSideSlope=\"%s\" logSideOffset=\"%s\" "
          "linSideSlope=\"1\" linSideOffset=\"%s\"/>\n  </Log>\n"
          "  <LUT3D inBitDepth=\"32f\" outBitDepth=\"32f\" interpolation=\"tetrahedral\">\n"
          "    <Array dim=\"%zu %zu %zu 3\">\n",
          abbe_number_text(1 / s->span, text[0]), abbe_number_text(-log2(s->a) / s->span, text[1]),
          abbe_number_text(s->a, text[2]), n, n, n);
  /* Blue runs first here. */
  for (size_t i = 0; i < n * n * n; i++)
    put_colour(out, nodes->data + 3 * (i / n / n + i / n % n * n + i % n * n * n));
  fputs("    </Array>\n  </LUT3D>\n</ProcessList>\n", out);
}

/* The part of a whole by which the index, in digits of the base, is turned about the point. */
static double halton(size_t index, size_t base) {
  double sum = 0, share = 1;
  for (; index > 0; index /= base) sum += (share /= (double)base) * (double)(index % base);
  return sum;
}

static abbe_result measure(const abbe_lut_desc *desc, const shape *s, const char *path,
                           abbe_lut_error *off, abbe_error *error) {
  abbe_image shown = {0}, looked_up = {0};
  const char *const names[] = {"R", "G", "B"};
  abbe_result result = abbe_image_make(PROBES + GREYS, 1, 3, names, &shown, error);
  if (result == ABBE_OK) result = abbe_image_make(PROBES + GREYS, 1, 3, names, &looked_up, error);
  for (size_t i = 0; result == ABBE_OK && i < PROBES + GREYS; i++)
    for (size_t c = 0; c < 3; c++)
      shown.data[3 * i + c] = (float)light_of(s, i < PROBES ? halton(i + 1, (size_t[]){2, 3, 5}[c])
                                                            : (double)(i - PROBES) / (GREYS - 1));
  if (result == ABBE_OK) memcpy(looked_up.data, shown.data, 3 * (PROBES + GREYS) * sizeof(float));
  if (result == ABBE_OK) result = abbe_display_apply(desc->display, &shown, error);
  if (result == ABBE_OK) result = abbe_lut_apply(path, &looked_up, error);
  *off = (abbe_lut_error){0};
  for (size_t i = 0; result == ABBE_OK && i < PROBES + GREYS; i++) {
    double most = 0;
    for (size_t c = 0; c < 3; c++)
      most = fmax(most, fabs((double)shown.data[3 * i + c] - looked_up.data[3 * i + c]));
    if (i < PROBES) off->mean += most / PROBES;
    double *greatest = i < PROBES ? &off->most : &off->most_grey;
    *greatest = fmax(*greatest, most);
  }
  abbe_image_free(&looked_up);
  abbe_image_free(&shown);
  return result;
}

static abbe_result check(const abbe_lut_desc *desc, const char *path, abbe_error *error) {
  if (desc->nodes < ABBE_LUT_MIN_NODES || desc->nodes > ABBE_LUT_MAX_NODES)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a table of %zu nodes a side is outside %d to %d", desc->nodes,
                          ABBE_LUT_MIN_NODES, ABBE_LUT_MAX_NODES);
  if (!(desc->low >= -ABBE_LUT_MAX_STOPS && desc->low < desc->high &&
        desc->high <= ABBE_LUT_MAX_STOPS))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the stops %g to %g of a table do not rise within -%g to %g", desc->low,
                          desc->high, ABBE_LUT_MAX_STOPS, ABBE_LUT_MAX_STOPS);
  if (!abbe_lut_is_meant(path))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: a table is written to a name in .cube or .clf", path);
  return ABBE_OK;
}

abbe_result abbe_lut_write(const abbe_lut_desc *given, const char *path, abbe_lut_error *off,
                           abbe_error *error) {
  abbe_lut_desc desc = *given;
  if (desc.nodes == 0) desc.nodes = 33;
  if (desc.low == 0 && desc.high == 0) desc.low = -10, desc.high = 6.5;
  ABBE_TRY(check(&desc, path, error));
  shape s = {.a = 0.18 * exp2(desc.low)};
  s.span = log2(0.18 * exp2(desc.high) + s.a) - log2(s.a);
  abbe_image nodes = {0};
  abbe_file_writer writer = {0};
  abbe_result result = make_nodes(&desc, &s, &nodes, error);
  if (result == ABBE_OK) result = abbe_file_writer_open(&writer, path, error);
  if (result == ABBE_OK) {
    (strcasecmp(strrchr(path, '.'), ".cube") == 0 ? write_cube : write_clf)(&desc, &s, &nodes,
                                                                            writer.stream);
    result = abbe_file_writer_end(&writer, ABBE_OK, error);
  }
  abbe_image_free(&nodes);
  return result == ABBE_OK ? measure(&desc, &s, path, off, error) : result;
}
