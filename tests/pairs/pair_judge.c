#include "tests/pairs/pair_judge.h"

#include "colorimetry/chromaticity.h"
#include "colorimetry/difference.h"

#include <math.h>
#include <string.h>

/* Right is what stays within these beside three standard errors: of the trace, and of a sample a
 * pixel where nothing more is drawn. */
static const double nm_bound = 2, colour_bound = 1, light_bound = 0.02, sigmas = 3;
/* What moves gives up paths of less than a tenth of their light. */
static const double moving_light_bound = 0.1;

static const double white_xy[2] = {0.3127, 0.3290};

/* The dominant wavelength, below 0 the complementary one of a purple; and the purity. */
static double dominant(const double xyz[3], double *purity) {
  double xy[2];
  abbe_dominant d;
  *purity = 0;
  if (!abbe_chromaticity_xy(xyz, xy)) return NAN;
  abbe_chromaticity_dominant(xy, white_xy, ABBE_OBSERVER_CIE_1931, &d);
  *purity = d.purity;
  return isnan(d.lambda_nm) ? -d.complementary_nm : d.lambda_nm;
}

/* CIEDE2000 of two colours at the luminance of middle grey. */
static double colour_apart(const double a[3], const double b[3]) {
  double white[3], lab[2][3];
  const double *const xyz[2] = {a, b};
  abbe_chromaticity_xyz(white_xy, white);
  for (size_t i = 0; i < 2; i++) {
    double grey[3];
    for (size_t c = 0; c < 3; c++) grey[c] = 0.18 * xyz[i][c] / xyz[i][1];
    abbe_difference_lab(grey, white, lab[i]);
  }
  return abbe_difference_ciede2000(lab[0], lab[1]);
}

/* A purple has no wavelength: it is as far from one as it can be. */
static double apart(bool saturated, const double a[3], const double b[3]) {
  double purity;
  if (!saturated) return colour_apart(a, b);
  const double first = dominant(a, &purity), second = dominant(b, &purity);
  return first * second > 0 ? fabs(second - first) : INFINITY;
}

/* What the trace's own errors make of that. */
static double noise(bool saturated, const double xyz[3], const double ratio_error[2]) {
  double squares = 0;
  for (size_t c = 0; c < 2; c++) {
    double shifted[3];
    memcpy(shifted, xyz, sizeof shifted);
    shifted[2 * c] += ratio_error[c] * xyz[1];
    squares += pow(apart(saturated, xyz, shifted), 2);
  }
  return sqrt(squares);
}

bool pair_verdict_hue(const pair_verdict *v) {
  return v->hue <= v->hue_bound;
}

bool pair_verdict_light(const pair_verdict *v) {
  return fabs(v->light - 1) <= v->light_bound;
}

void pair_judge(const cover_row *row, size_t region, const pair_light *traced,
                const pair_light *drawn, pair_verdict *out) {
  const double *is = drawn->xyz[region], *right = traced->xyz[region];
  const bool moving = row->level[PAIR_STAGE] == 0;
  double purity, ratio_error[2];
  out->nm[1] = dominant(is, &purity);
  out->nm[0] = dominant(right, &purity);
  out->saturated = purity >= PAIR_PURITY && out->nm[0] > 0;
  out->hue = apart(out->saturated, right, is);
  for (size_t c = 0; c < 2; c++)
    ratio_error[c] =
        hypot(traced->ratio_error[region][c], moving ? drawn->ratio_error[region][c] : 0);
  out->hue_bound = (out->saturated ? nm_bound : colour_bound) +
                   sigmas * noise(out->saturated, right, ratio_error);
  out->light = is[1] / right[1];
  out->light_bound = (moving ? moving_light_bound : light_bound) +
                     sigmas * hypot(traced->error[region], moving ? drawn->error[region] : 0);
}

static const char *const traces = ABBE_SOURCE_DIR "/tests/pairs/traces.csv";

void pair_judge_write(FILE *file, size_t stone, size_t company, const pair_light *traced) {
  for (size_t k = 0; k < PAIR_REGIONS; k++) {
    fprintf(file, "%s,%s,%s", pair_level_name(PAIR_STONE, stone),
            pair_level_name(PAIR_COMPANY, company), pair_region_name[k]);
    for (size_t c = 0; c < 3; c++) fprintf(file, ",%.6g", traced->xyz[k][c]);
    fprintf(file, ",%.2g,%.2g,%.2g\n", traced->error[k], traced->ratio_error[k][0],
            traced->ratio_error[k][1]);
  }
}

abbe_result pair_judge_read(size_t stone, size_t company, pair_light *out, abbe_error *error) {
  char line[256], name[96];
  size_t found = 0;
  FILE *file = fopen(traces, "r");
  if (file == NULL) return abbe_error_set(error, ABBE_IO, "%s cannot be read", traces);
  while (fgets(line, sizeof line, file) != NULL)
    for (size_t k = 0; k < PAIR_REGIONS; k++) {
      double *m = out->xyz[k], *r = out->ratio_error[k];
      snprintf(name, sizeof name, "%s,%s,%s,", pair_level_name(PAIR_STONE, stone),
               pair_level_name(PAIR_COMPANY, company), pair_region_name[k]);
      const size_t length = strlen(name);
      found += strncmp(line, name, length) == 0 &&
               sscanf(line + length, "%lf,%lf,%lf,%lf,%lf,%lf", &m[0], &m[1], &m[2], &out->error[k],
                      &r[0], &r[1]) == 6;
    }
  fclose(file);
  if (found == PAIR_REGIONS) return ABBE_OK;
  return abbe_error_set(error, ABBE_PARSE,
                        "%s has no trace of %s %s: make it by script/pairs --trace", traces,
                        pair_level_name(PAIR_STONE, stone), pair_level_name(PAIR_COMPANY, company));
}
