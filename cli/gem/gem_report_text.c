#include "cli/gem/gem.h"

#include "base/maths.h"
#include "cli/base/command.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>

void abbe_gem_report_number(const abbe_gem_judgement_row *row, char value[32], char error[32]) {
  const double unit = row->share ? 100 : 1;
  const char *form = row->share ? "%.2f %%" : "%.3f";
  snprintf(value, 32, form, unit * row->number.value);
  snprintf(error, 32, row->share ? "%.2f" : "%.3f", unit * row->number.error);
}

/* ---- for people ---- */

/* How it lies, and its colour in other ways. */
static void print_crystal(const abbe_gem_report_facts *f) {
  const abbe_gem_judgement *j = f->judgement;
  if (!j->is_crystal) return;
  double(*const frame)[3] = f->input->stone.media.frame[0];
  printf("both waves of a crystal of %s indices, z along %.3g %.3g %.3g",
         j->is_biaxial ? "three" : "two", frame[2][0], frame[2][1], frame[2][2]);
  if (j->is_biaxial) printf(", x along %.3g %.3g %.3g", frame[0][0], frame[0][1], frame[0][2]);
  printf("\ncolour of its light return, CIELAB:");
  for (int i = 0; i < ABBE_GEM_ORIENTATIONS; i++) {
    const double *lab = j->orientation[i].lab;
    printf("%s %.0f %.0f %.0f %s", i > 0 ? ";" : "", lab[0], lab[1], lab[2],
           abbe_gem_orientation_text(j, i));
  }
  printf("\n");
}

void abbe_gem_report_print(const abbe_gem_report_facts *f) {
  const abbe_gem_judgement *j = f->judgement;
  abbe_gem_judgement_row row[ABBE_GEM_JUDGEMENT_MOST_ROWS];
  const size_t count = abbe_gem_judgement_rows(j, row);
  printf("%s: %s, in %s, %g mm wide\n", f->input->in.path, abbe_gem_input_title(&f->input->in),
         f->input->in.material->name, 1000 * f->input->width_m);
  printf(
      "%.0f rays of the eye from above, each at %zu wavelength%s; head's half angle %g degrees\n",
      j->view.colour[0].weight, j->view.wavelengths, j->view.wavelengths == 1 ? "" : "s",
      f->head_deg);
  print_crystal(f);
  if (j->has_tilts)
    printf("tilted about %d axes up to %g degrees by %g\n", ABBE_GEM_AXES,
           j->tilts.tilt_rad[j->tilts.tilts - 1] * 180 / ABBE_PI,
           j->tilts.step_rad * 180 / ABBE_PI);
  printf("\n%-58s %10s %8s\n", "", "value", "error");
  for (size_t i = 0; i < count; i++) {
    char value[32], error[32];
    abbe_gem_report_number(&row[i], value, error);
    printf("%-58s %10s %8s\n", row[i].text, value, error);
  }
  if (!j->has_tilts) return;
  printf("\nbrightness by tilt, %%\n%-8s", "axis");
  const size_t stride = (j->tilts.tilts - 1) / 6 > 0 ? (j->tilts.tilts - 1) / 6 : 1;
  for (size_t t = 0; t < j->tilts.tilts; t += stride)
    printf(" %7.0f", j->tilts.tilt_rad[t] * 180 / ABBE_PI);
  printf("\n");
  for (size_t a = 0; a < ABBE_GEM_AXES; a++) {
    printf("%-8.0f", j->tilts.axis_rad[a] * 180 / ABBE_PI);
    for (size_t t = 0; t < j->tilts.tilts; t += stride)
      printf(" %7.2f", 100 * j->tilts.curve[ABBE_GEM_TILT_ISO][a * j->tilts.tilts + t].value);
    printf("\n");
  }
}

/* ---- for programs ---- */

static bool is_shown(const abbe_gem_tilts *t, int curve) {
  return curve != ABBE_GEM_TILT_FIRE || t->has_fire;
}

void abbe_gem_report_print_csv(const abbe_gem_report_facts *f) {
  const abbe_gem_judgement *j = f->judgement;
  abbe_gem_judgement_row row[ABBE_GEM_JUDGEMENT_MOST_ROWS];
  const size_t count = abbe_gem_judgement_rows(j, row);
  printf("measure,axis_deg,tilt_deg,wavelength_nm,value,standard_error\n");
  for (size_t i = 0; i < count; i++)
    printf("%s,,,,%.9g,%.3g\n", row[i].name, row[i].number.value, row[i].number.error);
  for (int c = 0; c < 3; c++)
    printf("return_%c,,,,%.9g,%.3g\n", "XYZ"[c], j -> xyz[c].value, j->xyz[c].error);
  for (size_t k = 0; k < j->view.wavelengths; k++)
    for (int a = 0; a < ABBE_GEM_AMOUNT_COUNT; a++) {
      const abbe_gem_number n = abbe_gem_view_at(&j->view, (abbe_gem_amount)a, k);
      printf("%s,,,%.6g,%.9g,%.3g\n", abbe_gem_amount_name((abbe_gem_amount)a),
             f->input->wavelengths.lambda_nm[k], n.value, n.error);
    }
  if (!j->has_tilts) return;
  for (int c = 0; c < ABBE_GEM_TILT_CURVE_COUNT; c++)
    for (size_t i = 0; is_shown(&j->tilts, c) && i < ABBE_GEM_AXES * j->tilts.tilts; i++)
      printf("%s,%.6g,%.6g,,%.9g,%.3g\n", abbe_gem_tilt_curve_name((abbe_gem_tilt_curve)c),
             j->tilts.axis_rad[i / j->tilts.tilts] * 180 / ABBE_PI,
             j->tilts.tilt_rad[i % j->tilts.tilts] * 180 / ABBE_PI, j->tilts.curve[c][i].value,
             j->tilts.curve[c][i].error);
}

static void add_number(cJSON *to, const char *name, abbe_gem_number n) {
  cJSON *pair = cJSON_AddObjectToObject(to, name);
  cJSON_AddNumberToObject(pair, "value", n.value);
  cJSON_AddNumberToObject(pair, "error", n.error);
}

static void add_wavelengths(cJSON *root, const abbe_gem_report_facts *f) {
  const abbe_gem_view *v = &f->judgement->view;
  cJSON *list = cJSON_AddArrayToObject(root, "wavelengths");
  for (size_t k = 0; k < v->wavelengths; k++) {
    cJSON *one = cJSON_CreateObject();
    cJSON_AddNumberToObject(one, "nm", f->input->wavelengths.lambda_nm[k]);
    for (int a = 0; a < ABBE_GEM_AMOUNT_COUNT; a++)
      add_number(one, abbe_gem_amount_name((abbe_gem_amount)a),
                 abbe_gem_view_at(v, (abbe_gem_amount)a, k));
    cJSON_AddItemToArray(list, one);
  }
}

static void add_crystal(cJSON *root, const abbe_gem_report_facts *f) {
  const abbe_gem_judgement *j = f->judgement;
  double(*const frame)[3] = f->input->stone.media.frame[0];
  cJSON *axes = cJSON_AddObjectToObject(root, "axes");
  cJSON_AddItemToObject(axes, "z", cJSON_CreateDoubleArray(frame[2], 3));
  if (j->is_biaxial) cJSON_AddItemToObject(axes, "x", cJSON_CreateDoubleArray(frame[0], 3));
  cJSON *list = cJSON_AddArrayToObject(root, "orientations");
  for (int i = 0; i < ABBE_GEM_ORIENTATIONS; i++) {
    cJSON *one = cJSON_CreateObject();
    cJSON_AddStringToObject(one, "lies", abbe_gem_orientation_text(j, i));
    add_number(one, "iso", j->orientation[i].value);
    cJSON_AddItemToObject(one, "lab", cJSON_CreateDoubleArray(j->orientation[i].lab, 3));
    cJSON_AddItemToArray(list, one);
  }
}

static void add_tilts(cJSON *root, const abbe_gem_tilts *t) {
  cJSON *list = cJSON_AddArrayToObject(root, "tilts");
  for (size_t i = 0; i < ABBE_GEM_AXES * t->tilts; i++) {
    cJSON *one = cJSON_CreateObject();
    cJSON_AddNumberToObject(one, "axis_deg", t->axis_rad[i / t->tilts] * 180 / ABBE_PI);
    cJSON_AddNumberToObject(one, "tilt_deg", t->tilt_rad[i % t->tilts] * 180 / ABBE_PI);
    for (int c = 0; c < ABBE_GEM_TILT_CURVE_COUNT; c++)
      if (is_shown(t, c))
        add_number(one, abbe_gem_tilt_curve_name((abbe_gem_tilt_curve)c), t->curve[c][i]);
    cJSON_AddItemToArray(list, one);
  }
}

abbe_result abbe_gem_report_print_json(const abbe_gem_report_facts *f, abbe_error *error) {
  const abbe_gem_judgement *j = f->judgement;
  abbe_gem_judgement_row row[ABBE_GEM_JUDGEMENT_MOST_ROWS];
  const size_t count = abbe_gem_judgement_rows(j, row);
  cJSON *root = cJSON_CreateObject();
  cJSON_AddStringToObject(root, "file", f->input->in.path);
  cJSON_AddStringToObject(root, "title", abbe_gem_input_title(&f->input->in));
  cJSON_AddStringToObject(root, "material", f->input->in.material->name);
  if (j->is_crystal) add_crystal(root, f);
  cJSON_AddNumberToObject(root, "width_mm", 1000 * f->input->width_m);
  cJSON_AddNumberToObject(root, "head_deg", f->head_deg);
  cJSON_AddNumberToObject(root, "rays", j->view.colour[0].weight);
  cJSON_AddNumberToObject(root, "seconds", f->seconds);
  cJSON *measures = cJSON_AddObjectToObject(root, "measures");
  for (size_t i = 0; i < count; i++) add_number(measures, row[i].name, row[i].number);
  static const char *const xyz[] = {"X", "Y", "Z"};
  cJSON *colour = cJSON_AddObjectToObject(root, "return_xyz");
  for (int c = 0; c < 3; c++) add_number(colour, xyz[c], j->xyz[c]);
  add_wavelengths(root, f);
  if (j->has_tilts) add_tilts(root, &j->tilts);
  return abbe_command_print_json(root, true, error);
}
