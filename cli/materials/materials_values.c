#include "cli/materials/materials.h"

#include "base/maths.h"
#include "cli/base/command.h"
#include "colorimetry/pleochroism.h"
#include "spectral/biaxial.h"
#include "spectral/materials/absorption.h"
#include "spectral/materials/material_query.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void abbe_materials_parse(const abbe_parser *parser, int argc, char **argv, void *request) {
  abbe_arguments_parse(parser, 0, argc, argv, request);
}

_Noreturn void abbe_materials_wrong_use(const char *program, const char *sentence) {
  fprintf(stderr, "%s: %s\nTry '%s --help'.\n", program, sentence, program);
  exit(ABBE_EXIT_USAGE);
}

enum { FIRST_FEW = 12 };

void abbe_materials_print_report(const char *program, const abbe_report *report, bool all) {
  size_t shown[ABBE_NOTE_KIND_COUNT] = {0};
  for (size_t i = 0; i < report->count; i++) {
    const abbe_note *n = &report->note[i];
    if (++shown[n->kind] > FIRST_FEW && !all) continue;
    fprintf(stderr, "%s: %s: ", program, abbe_note_kind_word(n->kind));
    if (n->file[0] != '\0') fprintf(stderr, "%s: ", n->file);
    if (n->name[0] != '\0') fprintf(stderr, "%s: ", n->name);
    if (n->line > 0) fprintf(stderr, "line %zu: ", n->line);
    fprintf(stderr, "%s\n", n->text);
  }
  for (int k = 0; k < ABBE_NOTE_KIND_COUNT; k++) {
    size_t told = all || shown[k] < FIRST_FEW ? shown[k] : FIRST_FEW;
    if (report->kinds[k] > told)
      fprintf(stderr, "%s: %s: %zu more like these; --all shows them\n", program,
              abbe_note_kind_word((abbe_note_kind)k), report->kinds[k] - told);
  }
}

void abbe_materials_add_report(cJSON *to, const abbe_report *report) {
  for (int k = 0; k < ABBE_NOTE_KIND_COUNT; k++)
    cJSON_AddNumberToObject(to, abbe_note_kind_word((abbe_note_kind)k), (double)report->kinds[k]);
  cJSON *list = cJSON_AddArrayToObject(to, "notes");
  for (size_t i = 0; i < report->count; i++) {
    const abbe_note *n = &report->note[i];
    cJSON *item = cJSON_CreateObject();
    if (item == NULL || !cJSON_AddItemToArray(list, item)) continue;
    cJSON_AddStringToObject(item, "kind", abbe_note_kind_word(n->kind));
    if (n->file[0] != '\0') cJSON_AddStringToObject(item, "file", n->file);
    cJSON_AddNumberToObject(item, "line", (double)n->line);
    cJSON_AddStringToObject(item, "name", n->name);
    cJSON_AddStringToObject(item, "text", n->text);
  }
}

abbe_dispersion_numbers abbe_materials_numbers(const abbe_material *m) {
  abbe_material_numbers n;
  abbe_material_numbers_make(m, &n);
  return (abbe_dispersion_numbers){
      .n_d = n.n_d, .n_F = n.n_F, .n_C = n.n_C, .v_d = n.v_d, .b_g = n.b_g};
}

const char *abbe_materials_number(char *text, size_t size, const char *format, double value) {
  if (isnan(value)) return "-";
  if (isinf(value)) return "infinite";
  snprintf(text, size, format, value);
  return text;
}

/* cJSON drops what it has no memory for, one value at a time; half an answer is none. */
static bool json_lost;

static void *json_allocate(size_t size) {
  void *memory = malloc(size);
  if (memory == NULL) json_lost = true;
  return memory;
}

cJSON *abbe_materials_json(void) {
  cJSON_InitHooks(&(cJSON_Hooks){.malloc_fn = json_allocate, .free_fn = free});
  json_lost = false;
  return cJSON_CreateObject();
}

abbe_result abbe_materials_print_json(cJSON *root, abbe_error *error) {
  return abbe_command_print_json(root, !json_lost, error);
}

void abbe_materials_add_text(cJSON *to, const char *key, const char *text) {
  if (text != NULL)
    cJSON_AddStringToObject(to, key, text);
  else
    cJSON_AddNullToObject(to, key);
}

/* cJSON writes NaN and infinity as null, and every other double so that it reads back the same. */
void abbe_materials_add_numbers(cJSON *to, const abbe_material *m) {
  abbe_material_numbers n;
  abbe_material_numbers_make(m, &n);
  cJSON_AddNumberToObject(to, "n_d", n.n_d);
  cJSON_AddNumberToObject(to, "v_d", n.v_d);
  cJSON_AddNumberToObject(to, "n_F", n.n_F);
  cJSON_AddNumberToObject(to, "n_C", n.n_C);
  cJSON_AddNumberToObject(to, "n_e", n.n_e);
  cJSON_AddNumberToObject(to, "n_g", n.n_g);
  cJSON_AddNumberToObject(to, "b_g", n.b_g);
  cJSON_AddNumberToObject(to, "p_gF", n.p_gF);
  cJSON_AddNumberToObject(to, "dp_gF", n.dp_gF);
}

void abbe_materials_add_density(cJSON *to, const abbe_material *m) {
  if (m->catalogue.density_g_cm3 > 0)
    cJSON_AddNumberToObject(to, "density_g_cm3", m->catalogue.density_g_cm3);
  else
    cJSON_AddNullToObject(to, "density_g_cm3");
}

void abbe_materials_add_pair(cJSON *to, const char *key, double a, double b) {
  cJSON_AddItemToObject(to, key, cJSON_CreateDoubleArray((double[]){a, b}, 2));
}

void abbe_materials_round(abbe_dispersion *dispersion) {
  char text[64];
  for (size_t i = 0; i < dispersion->count && dispersion->count <= 9; i++) {
    snprintf(text, sizeof text, "%.12g", dispersion->c[i]);
    dispersion->c[i] = strtod(text, NULL);
  }
}

/* The conditions of the index that is shown: where it was measured, or what was requested. */
static abbe_conditions conditions_of(const abbe_material *m) {
  const abbe_index_shift *s = &m->dispersion.shift;
  return s->on ? (abbe_conditions){s->to_c, s->pressure_atm}
               : (abbe_conditions){m->temperature_c, 1};
}

void abbe_materials_print_conditions(const abbe_material *material) {
  const abbe_material *m = material;
  const abbe_conditions at = conditions_of(m);
  double gain[2], n_d = NAN;
  char text[32];
  if (!isnan(m->temperature_c)) printf("  temperature   %g C\n", m->temperature_c);
  if (abbe_material_is_conductor(m)) return;
  if (m->n_absolute) printf("  index         relative to vacuum\n");
  if (m->dispersion.shift.on) {
    abbe_material_n_absolute(m, ABBE_LINE_D_NM, &n_d, NULL);
    printf("  shown         at %g C in air of %g atm; n_d %s relative to vacuum\n",
           at.temperature_c, at.pressure_atm,
           abbe_materials_number(text, sizeof text, "%.6f", n_d));
  }
  abbe_material_dn_dt(m, ABBE_LINE_E_NM, at.temperature_c, gain);
  if (isnan(gain[0]))
    printf("  dn/dT         not given\n");
  else
    printf("  dn/dT         %.1f relative to air, %.1f to vacuum, 1e-6/K at e and %g C\n",
           1e6 * gain[0], 1e6 * gain[1], at.temperature_c);
}

void abbe_materials_add_conditions(cJSON *to, const abbe_material *material) {
  const abbe_conditions at = conditions_of(material);
  double gain[2];
  cJSON_AddBoolToObject(to, "n_absolute", material->n_absolute);
  cJSON *item = cJSON_AddObjectToObject(to, "shown_at");
  cJSON_AddNumberToObject(item, "temperature_c", at.temperature_c);
  cJSON_AddNumberToObject(item, "pressure_atm", at.pressure_atm);
  abbe_material_dn_dt(material, ABBE_LINE_E_NM, at.temperature_c, gain);
  cJSON_AddNumberToObject(to, "dn_dt_e_relative_per_k", gain[0]);
  cJSON_AddNumberToObject(to, "dn_dt_e_absolute_per_k", gain[1]);
}

/* What a material absorbs, by direction where it is pleochroic, and the three indices of a biaxial
 * one, as text and as JSON. */
/* For a field along that axis. */
static void show_attenuation(const abbe_material *m, int axis) {
  const abbe_spectrum *own = axis > 0 ? m->attenuation_yz[axis - 1] : m->attenuation;
  if (own == NULL) own = m->attenuation;
  const double *l = abbe_spectrum_lambda_nm(own), *a = abbe_spectrum_value(own);
  size_t count = abbe_spectrum_count(own);
  for (size_t i = 0; i < count && i < 8; i++)
    printf(" %.4g at %g%s", a[i], l[i], i + 1 < count ? "," : "");
  printf(count > 8 ? " … (%zu points)\n" : "\n", count);
  printf("                through 10 mm:");
  for (int nm = 400; nm <= 700; nm += 100)
    printf(" %.4g at %d%s",
           abbe_absorption_transmittance(abbe_material_attenuation_along(m, axis, nm), 0.01), nm,
           nm < 700 ? "," : " nm\n");
}

static const double face_m[2] = {0.005, 0.01};

/* L*, C*ab and the hue angle in degrees. */
static void chroma_of(const double lab[3], double out[3]) {
  const double hue = atan2(lab[2], lab[1]) * 180 / acos(-1);
  out[0] = lab[0];
  out[1] = hypot(lab[1], lab[2]);
  out[2] = hue < 0 ? hue + 360 : hue;
}

/* Shows a face that is cut across each direction; one that holds the axis shows both waves. */
static void show_faces(const abbe_material *m) {
  static const struct {
    const char *name;
    int axis;  /* whose field or, */
    bool face; /* unpolarised, whose face it is */
  } uniaxial[] = {{"ordinary ray", 0, false},
                  {"extraordinary ray", 2, false},
                  {"face across the axis", 2, true},
                  {"face along the axis", 0, true}},
    biaxial[] = {{"field along x", 0, false}, {"field along y", 1, false},
                 {"field along z", 2, false}, {"face across x", 0, true},
                 {"face across y", 1, true},  {"face across z", 2, true}};
  const bool three = abbe_material_is_biaxial(m);
  abbe_pleochroism p[2];
  for (int i = 0; i < 2; i++) abbe_pleochroism_make(m, face_m[i], &p[i]);
  printf("  pleochroic    colours of D65: L*, chroma and hue through 5 mm, and through 10 mm\n");
  for (int r = 0; r < (three ? 6 : 4); r++) {
    const bool face = three ? biaxial[r].face : uniaxial[r].face;
    const int axis = three ? biaxial[r].axis : uniaxial[r].axis;
    printf("                %-21s", three ? biaxial[r].name : uniaxial[r].name);
    for (int i = 0; i < 2; i++) {
      double lch[3];
      chroma_of(face ? p[i].face_lab[axis] : p[i].field_lab[axis], lch);
      printf(" %5.1f %5.1f %5.1f%s", lch[0], lch[1], lch[2], i == 0 ? "   " : "\n");
    }
  }
  printf("                largest difference    %5.1f%s%5.1f (CIELAB)\n", p[0].largest,
         "               ", p[1].largest);
}

/* What excites it, where that has points of its own, and what it emits. */
static void show_fluorescence(const abbe_material *m) {
  const abbe_fluorescence *f = &m->fluorescence;
  if (!abbe_material_is_fluorescent(m)) return;
  const abbe_spectrum *const parts[] = {f->excitation, f->emission};
  double nm[2][2], most[2] = {0};
  for (int i = 0; i < 2; i++) {
    const size_t count = parts[i] != NULL ? abbe_spectrum_count(parts[i]) : 0;
    double best = -1;
    for (size_t k = 0; k < count; k++) {
      const double value = abbe_spectrum_value(parts[i])[k];
      if (value > best) most[i] = abbe_spectrum_lambda_nm(parts[i])[k];
      best = value > best ? value : best;
    }
    nm[i][0] = count > 0 ? abbe_spectrum_lambda_nm(parts[i])[0] : 0;
    nm[i][1] = count > 0 ? abbe_spectrum_lambda_nm(parts[i])[count - 1] : nm[0][0];
  }
  printf("  fluorescent   yield %.4g photons; emits %.4g to %.4g nm, most at %.4g nm\n", f->yield,
         nm[1][0], nm[1][1], most[1]);
  if (f->rows > 0)
    printf("                a matrix of %zu rows, excited by %.4g to %.4g nm\n", f->rows,
           f->row[0].nm, f->row[f->rows - 1].nm);
  else if (f->excitation != NULL)
    printf("                excited by %.4g to %.4g nm, most by %.4g nm\n", nm[0][0], nm[0][1],
           most[0]);
  else
    printf("                excited by all that it absorbs below %.4g nm\n", nm[1][0]);
}

void abbe_materials_show_absorption(const abbe_material *m) {
  show_fluorescence(m);
  if (m->attenuation == NULL) {
    printf("  absorption    none recorded%s\n",
           abbe_material_is_fluorescent(m) ? " but what excites it" : "");
    return;
  }
  if (!abbe_material_is_pleochroic(m)) {
    printf("  absorption    1/m, at nm:");
    show_attenuation(m, 0);
    return;
  }
  static const char *const waves[] = {"ordinary", "", "extraordinary"}, *const axes[] = {"along x",
                                                                                         "along y",
                                                                                         "along z"};
  const bool three = abbe_material_is_biaxial(m);
  for (int axis = 0; axis < 3; axis += three ? 1 : 2) {
    printf("  %-13s 1/m, at nm:", three ? axes[axis] : waves[axis]);
    show_attenuation(m, axis);
  }
  show_faces(m);
}

/* ---- at one wavelength ---- */

/* The axes whose losses differ: one, of a uniaxial crystal two, of a biaxial one three. */
static int loss_axes(const abbe_material *m, int axis[3]) {
  static const int three[3] = {0, 1, 2}, two[3] = {0, 2, 2};
  const bool biaxial = abbe_material_is_biaxial(m);
  memcpy(axis, biaxial ? three : two, sizeof three);
  if (m->attenuation == NULL) return m->fluorescence.excitation != NULL ? 1 : 0;
  return !abbe_material_is_pleochroic(m) ? 1 : biaxial ? 3 : 2;
}

const char *abbe_materials_loss_columns(const abbe_material *m) {
  static const char *const columns[] = {"", "         1/m", "  ordinary 1/m  extraordinary 1/m",
                                        "     1/m of x     1/m of y     1/m of z"};
  int axis[3];
  return columns[loss_axes(m, axis)];
}

void abbe_materials_print_losses(const abbe_material *m, double lambda_nm) {
  static const int widths[4][3] = {{0}, {12}, {14, 19}, {13, 13, 13}};
  int axis[3];
  const int count = loss_axes(m, axis);
  for (int i = 0; i < count; i++)
    printf("%*.4g", widths[count][i], abbe_material_attenuation_along(m, axis[i], lambda_nm));
}

void abbe_materials_add_losses(cJSON *to, const abbe_material *m, double lambda_nm) {
  static const char *const keys[3] = {"attenuation_per_m", "attenuation_y_per_m",
                                      "attenuation_z_per_m"};
  int axis[3];
  const int count = loss_axes(m, axis);
  cJSON_AddNumberToObject(to, keys[0], abbe_material_attenuation_along(m, 0, lambda_nm));
  for (int i = 1; i < count; i++)
    cJSON_AddNumberToObject(to, count == 2 ? "attenuation_extraordinary_per_m" : keys[i],
                            abbe_material_attenuation_along(m, axis[i], lambda_nm));
}

/* ---- JSON ---- */

static void add_points(cJSON *to, const char *key, const abbe_spectrum *spectrum) {
  cJSON *list = cJSON_AddArrayToObject(to, key);
  for (size_t i = 0; list != NULL && i < abbe_spectrum_count(spectrum); i++) {
    const double row[2] = {abbe_spectrum_lambda_nm(spectrum)[i], abbe_spectrum_value(spectrum)[i]};
    cJSON_AddItemToArray(list, cJSON_CreateDoubleArray(row, 2));
  }
}

/* `attenuation_per_m` is the ordinary wave's or that along x; the colours are CIELAB of D65. */
static void add_pleochroism(cJSON *to, const abbe_material *m) {
  cJSON *item = cJSON_AddObjectToObject(to, "pleochroism");
  const bool three = abbe_material_is_biaxial(m);
  const abbe_spectrum *y = m->attenuation_yz[0] != NULL ? m->attenuation_yz[0] : m->attenuation;
  if (three) add_points(item, "y_per_m", y);
  add_points(item, three ? "z_per_m" : "extraordinary_per_m", m->attenuation_yz[1]);
  cJSON *list = cJSON_AddArrayToObject(item, "colours");
  for (int i = 0; i < 2; i++) {
    abbe_pleochroism p;
    abbe_pleochroism_make(m, face_m[i], &p);
    cJSON *colours = cJSON_CreateObject();
    if (colours == NULL || !cJSON_AddItemToArray(list, colours)) return;
    cJSON_AddNumberToObject(colours, "thickness_m", face_m[i]);
    const struct {
      const char *key;
      const double *lab;
    } rows[] = {{"ordinary_lab", p.field_lab[0]},
                {"extraordinary_lab", p.field_lab[2]},
                {"across_the_axis_lab", p.face_lab[2]},
                {"along_the_axis_lab", p.face_lab[0]},
                {"x_lab", p.field_lab[0]},
                {"y_lab", p.field_lab[1]},
                {"z_lab", p.field_lab[2]},
                {"across_x_lab", p.face_lab[0]},
                {"across_y_lab", p.face_lab[1]},
                {"across_z_lab", p.face_lab[2]}};
    for (int k = three ? 4 : 0; k < (three ? 10 : 4); k++)
      cJSON_AddItemToObject(colours, rows[k].key, cJSON_CreateDoubleArray(rows[k].lab, 3));
    cJSON_AddNumberToObject(colours, "largest_difference", p.largest);
  }
}

void abbe_materials_add_absorption(cJSON *to, const abbe_material *m) {
  if (m->attenuation != NULL)
    add_points(to, "attenuation_per_m", m->attenuation);
  else
    cJSON_AddNullToObject(to, "attenuation_per_m");
  if (abbe_material_is_pleochroic(m)) add_pleochroism(to, m);
  if (!abbe_material_is_fluorescent(m)) return;
  const abbe_fluorescence *f = &m->fluorescence;
  cJSON *item = cJSON_AddObjectToObject(to, "fluorescence");
  cJSON_AddNumberToObject(item, "yield", f->yield);
  cJSON *rows = f->rows > 0 ? cJSON_AddArrayToObject(item, "matrix") : NULL;
  for (size_t i = 0; i < f->rows; i++) {
    cJSON *row = cJSON_CreateObject();
    cJSON_AddNumberToObject(row, "nm", f->row[i].nm);
    add_points(row, "emission", f->row[i].emission);
    cJSON_AddItemToArray(rows, row);
  }
  add_points(item, "emission", f->emission);
  if (f->excitation != NULL) add_points(item, "excitation_per_m", f->excitation);
}

/* ---- three indices ---- */

/* At d; twice the half angle of the optic axes, in degrees. NaN where the record has none. */
static double three_indices(const abbe_material *m, double n[3]) {
  for (int axis = 0; axis < 3; axis++)
    if (abbe_material_n_along(m, axis, ABBE_LINE_D_NM, &n[axis], NULL) != ABBE_OK) n[axis] = NAN;
  return 2 * abbe_biaxial_half_angle(n) * 180 / ABBE_PI;
}

void abbe_materials_show_biaxial(const abbe_material *m) {
  double n[3];
  if (!abbe_material_is_biaxial(m)) return;
  const double twice = three_indices(m, n);
  printf("  biaxial       n_d %.6f, %.6f, %.6f   2V about z %.2f degrees, %s\n", n[0], n[1], n[2],
         twice, twice < 90 ? "positive" : "negative");
}

void abbe_materials_add_biaxial(cJSON *to, const abbe_material *m) {
  double n[3];
  if (!abbe_material_is_biaxial(m)) return;
  cJSON *item = cJSON_AddObjectToObject(to, "biaxial");
  const double twice = three_indices(m, n);
  cJSON_AddItemToObject(item, "n_d", cJSON_CreateDoubleArray(n, 3));
  cJSON_AddNumberToObject(item, "two_v_deg", twice);
}
