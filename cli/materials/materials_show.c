#include "cli/materials/materials.h"

#include "colorimetry/illuminant.h"
#include "colorimetry/observer.h"
#include "colorimetry/rgb_space.h"
#include "spectral/dispersion/fit.h"
#include "spectral/editing/check.h"
#include "spectral/formats/material_import.h"
#include "spectral/materials/material_query.h"
#include "spectral/optics.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdio.h>

enum { MAX_AT = 4096 };

typedef struct request {
  const char *program, *name, *table;
  double at[MAX_AT];
  size_t at_count;
  abbe_conditions conditions;
  bool json, fit;
} request;

/* ---- metals ---- */

static const struct {
  const char *name;
  double nm;
} lines[] = {{"F", ABBE_LINE_F_NM}, {"d", ABBE_LINE_D_NM}, {"C", ABBE_LINE_C_NM}};

/* n, k and the share that is reflected head on; NaN where the record has none. */
static void nk_at(const abbe_material *m, double lambda_nm, double out[3]) {
  out[0] = out[1] = out[2] = NAN;
  if (abbe_material_nk(m, lambda_nm, &out[0], &out[1], NULL) == ABBE_OK)
    out[2] = abbe_optics_fresnel_conductor(1, out[0], out[1]);
}

/* Linear Rec.709 of D65 that the metal reflects head on, of which white is (1, 1, 1); false where
 * its data do not cover the visible. */
static bool colour_of(const abbe_material *m, double rgb[3]) {
  const abbe_illuminant d65 = {0};
  double xyz[3] = {0}, white = 0, matrix[9];
  for (double l = ABBE_WAVELENGTH_MIN_NM; l <= ABBE_WAVELENGTH_MAX_NM; l += 1) {
    double nk[3], bar[3], power = abbe_illuminant_power(&d65, l);
    nk_at(m, l, nk);
    if (isnan(nk[2])) return false;
    abbe_observer_xyz(l, bar);
    for (int i = 0; i < 3; i++) xyz[i] += nk[2] * power * bar[i];
    white += power * bar[1];
  }
  for (int i = 0; i < 3; i++) xyz[i] /= white;
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, matrix);
  abbe_rgb_space_apply(matrix, xyz, rgb);
  return true;
}

static void show_metal(const abbe_material *m) {
  double nk[3], rgb[3];
  char text[3][32];
  for (int i = 0; i < 3; i++) {
    nk_at(m, lines[i].nm, nk);
    printf("  %s %.1f nm    n %s   k %s   reflects %s head on\n", lines[i].name, lines[i].nm,
           abbe_materials_number(text[0], sizeof text[0], "%.4f", nk[0]),
           abbe_materials_number(text[1], sizeof text[1], "%.4f", nk[1]),
           abbe_materials_number(text[2], sizeof text[2], "%.2f %%", 100 * nk[2]));
  }
  if (colour_of(m, rgb))
    printf("  colour        %.3f, %.3f, %.3f of D65 is reflected head on, in linear Rec.709\n",
           rgb[0], rgb[1], rgb[2]);
}

/* ---- crystals ---- */

/* NaN where the record has none. */
static double extraordinary_at(const abbe_material *m, double lambda_nm) {
  double n = NAN;
  abbe_material_n_extraordinary(m, lambda_nm, &n, NULL);
  return n;
}

/* The extraordinary index less the ordinary one. */
static double birefringence_at(const abbe_material *m, double lambda_nm) {
  double n = NAN;
  abbe_material_n(m, lambda_nm, &n, NULL);
  return extraordinary_at(m, lambda_nm) - n;
}

/* ---- text ---- */

static void show_curve(const abbe_dispersion *d) {
  printf("  model         %s: %s\n", abbe_dispersion_model_name(d->model),
         abbe_dispersion_model_formula(d->model));
  if (d->table != NULL) printf("  points        %zu\n", abbe_spectrum_count(d->table));
  for (size_t i = 0; i < d->count; i++)
    printf("%s%.10g%s", i == 0 ? "  coefficients  " : "", d->c[i],
           i + 1 < d->count ? ", " : "   (L in um)\n");
}

static void show_extraordinary(const abbe_material *m) {
  char text[2][32];
  if (!abbe_material_is_uniaxial(m)) return;
  printf(
      "  extraordinary n_d %s   birefringence %s\n",
      abbe_materials_number(text[0], sizeof text[0], "%.6f", extraordinary_at(m, ABBE_LINE_D_NM)),
      abbe_materials_number(text[1], sizeof text[1], "%+.6f", birefringence_at(m, ABBE_LINE_D_NM)));
  show_curve(&m->extraordinary);
}

static void show_formula(const abbe_material *m) {
  show_curve(&m->dispersion);
  show_extraordinary(m);
  abbe_materials_show_biaxial(m);
  printf("  range         %g to %g nm%s\n", m->min_nm, m->max_nm,
         m->extrapolate ? ", extrapolated outside" : "");
  abbe_materials_print_conditions(m);
  if (m->catalogue.density_g_cm3 > 0)
    printf("  density       %g g/cm3\n", m->catalogue.density_g_cm3);
}

static void show_fits(const abbe_material *m) {
  for (int i = 0; i < 2; i++) {
    const abbe_material_fit *fit = &m->fit[i];
    abbe_index_difference off;
    if (fit->terms == 0) continue;
    printf("  Cauchy, %zu     ", fit->terms);
    for (size_t k = 0; k < fit->terms; k++)
      printf("%.9g%s", fit->c[k], k + 1 < fit->terms ? ", " : "");
    printf("   (%g to %g nm: ", fit->min_nm, fit->max_nm);
    if (abbe_material_fit_residual(m, fit, &off, NULL) == ABBE_OK)
      printf("rms error %.3g, largest %.3g at %g nm)\n", off.rms, off.max, off.max_nm);
    else
      printf("largest error %.3g)\n", fit->max_error);
  }
  bool none = m->fit[0].terms == 0 && m->fit[1].terms == 0;
  if (none && m->dispersion.model != ABBE_DISPERSION_CONSTANT)
    printf("  Cauchy        no fit recorded; --fit makes them, 'abbe materials fit' others\n");
}

static void show_numbers(const abbe_material *m) {
  char text[7][32];
  abbe_material_numbers n;
  abbe_material_published p;
  abbe_material_numbers_make(m, &n);
  abbe_material_published_make(m, &p);
  if (m->dispersion.shift.on) p = (abbe_material_published){0}; /* not of other conditions */
  printf("  n_d %s   V_d %s   B-G %s   n_F - n_C %s\n",
         abbe_materials_number(text[0], sizeof text[0], "%.6f", n.n_d),
         abbe_materials_number(text[1], sizeof text[1], "%.3f", n.v_d),
         abbe_materials_number(text[2], sizeof text[2], "%.6f", n.b_g),
         abbe_materials_number(text[3], sizeof text[3], "%.6f", n.n_F - n.n_C));
  printf("  n_e %s   P_gF %s   from the normal line %s\n",
         abbe_materials_number(text[4], sizeof text[4], "%.6f", n.n_e),
         abbe_materials_number(text[5], sizeof text[5], "%.4f", n.p_gF),
         abbe_materials_number(text[6], sizeof text[6], "%+.4f", n.dp_gF));
  if (p.n_d > 0 || p.v_d > 0) printf("  printed      ");
  if (p.n_d > 0) printf(" n_d %.8g (here %+.1g)", p.n_d, n.n_d - p.n_d);
  if (p.v_d > 0) printf(" V_d %.8g (here %+.1g)", p.v_d, n.v_d - p.v_d);
  if (p.n_d > 0 || p.v_d > 0) printf("\n");
}

static void show_findings(const abbe_findings *found) {
  for (size_t i = 0; i < found->count; i++) {
    const abbe_finding *f = &found->finding[i];
    printf("  %-13s %s: %s; %s\n", abbe_finding_weight_name(f->weight),
           abbe_finding_kind_meaning(f->kind), f->evidence, f->fix);
  }
}

static abbe_result show_text(const request *r, const abbe_material *m, const abbe_findings *found,
                             abbe_error *error) {
  printf("%s%s%s\n", m->name, m->description ? ": " : "", m->description ? m->description : "");
  const bool metal = abbe_material_is_conductor(m);
  if (metal)
    show_metal(m);
  else
    show_numbers(m);
  show_formula(m);
  if (!metal) abbe_materials_show_absorption(m);
  if (!metal && !m->dispersion.shift.on) show_fits(m);
  printf("  source        %s\n", m->source);
  if (m->comment != NULL) printf("  comment       %s\n", m->comment);
  if (m->warning != NULL) printf("  warning       %s\n", m->warning);
  show_findings(found);
  if (r->at_count > 0 && metal) printf("\n  %10s  %10s  %10s  %10s\n", "nm", "n", "k", "reflected");
  for (size_t i = 0; i < r->at_count && metal; i++) {
    double nk[3];
    nk_at(m, r->at[i], nk);
    printf("  %10.6g  %10.6f  %10.6f  %10.6f\n", r->at[i], nk[0], nk[1], nk[2]);
  }
  if (metal) return ABBE_OK;
  const bool two = abbe_material_is_uniaxial(m);
  if (r->at_count > 0)
    printf("\n  %10s  %12s%s%s\n", "nm", two ? "ordinary n" : "n", two ? " extraordinary" : "",
           abbe_materials_loss_columns(m));
  for (size_t i = 0; i < r->at_count; i++) {
    double n = 0;
    ABBE_TRY(abbe_material_n(m, r->at[i], &n, error));
    printf("  %10.6g  %12.9f", r->at[i], n);
    if (two) printf("  %12.9f", extraordinary_at(m, r->at[i]));
    abbe_materials_print_losses(m, r->at[i]);
    printf("%s\n", abbe_material_extrapolates(m, r->at[i]) ? "  extrapolated" : "");
  }
  return ABBE_OK;
}

/* The `fit` key of a record, made anew from its model, as it is pasted into a table. */
static abbe_result show_fit_yaml(const abbe_material *m, abbe_error *error) {
  const double low = ABBE_WAVELENGTH_MIN_NM, high = ABBE_WAVELENGTH_MAX_NM;
  double n = 0;
  ABBE_TRY(abbe_material_n(m, low, &n, error));
  ABBE_TRY(abbe_material_n(m, high, &n, error));
  abbe_dispersion fit[2];
  double max_error[2];
  for (int i = 0; i < 2; i++)
    ABBE_TRY(abbe_fit_dispersion(&m->dispersion, (size_t)i + 2, low, high, &fit[i], &max_error[i],
                                 error));
  printf("fit:\n");
  for (int i = 0; i < 2; i++) {
    printf("  cauchy%d: {coefficients: [", i + 2);
    for (size_t k = 0; k < fit[i].count; k++) printf("%s%.9g", k ? ", " : "", fit[i].c[k]);
    printf("], max_error: %.3g, range_nm: [%g, %g]}\n", max_error[i], low, high);
  }
  return ABBE_OK;
}

/* ---- JSON ---- */

/* Pairs, or [nm, n, k] where third is k. */
static void add_points(cJSON *to, const char *key, const abbe_spectrum *spectrum,
                       const abbe_spectrum *third) {
  cJSON *list = cJSON_AddArrayToObject(to, key);
  for (size_t i = 0; list != NULL && i < abbe_spectrum_count(spectrum); i++) {
    double row[3] = {abbe_spectrum_lambda_nm(spectrum)[i], abbe_spectrum_value(spectrum)[i],
                     third != NULL ? abbe_spectrum_value(third)[i] : 0};
    cJSON_AddItemToArray(list, cJSON_CreateDoubleArray(row, third != NULL ? 3 : 2));
  }
}

static void add_curve(cJSON *to, const abbe_dispersion *d) {
  cJSON_AddStringToObject(to, "model", abbe_dispersion_model_name(d->model));
  cJSON_AddStringToObject(to, "formula", abbe_dispersion_model_formula(d->model));
  if (d->table != NULL)
    add_points(to, "points", d->table, d->k);
  else
    cJSON_AddItemToObject(to, "coefficients", cJSON_CreateDoubleArray(d->c, (int)d->count));
}

static void add_extraordinary(cJSON *to, const abbe_material *m) {
  cJSON *item = cJSON_AddObjectToObject(to, "extraordinary");
  add_curve(item, &m->extraordinary);
  cJSON_AddNumberToObject(item, "n_d", extraordinary_at(m, ABBE_LINE_D_NM));
  cJSON_AddNumberToObject(item, "birefringence_d", birefringence_at(m, ABBE_LINE_D_NM));
}

static void add_record(cJSON *to, const abbe_material *m) {
  add_curve(to, &m->dispersion);
  if (abbe_material_is_uniaxial(m)) add_extraordinary(to, m);
  abbe_materials_add_biaxial(to, m);
  abbe_materials_add_pair(to, "range_nm", m->min_nm, m->max_nm);
  cJSON_AddBoolToObject(to, "extrapolate", m->extrapolate);
  cJSON_AddNumberToObject(to, "temperature_c", m->temperature_c);
  abbe_materials_add_conditions(to, m);
  abbe_materials_add_density(to, m);
  abbe_materials_add_absorption(to, m);
  abbe_materials_add_text(to, "source", m->source);
  abbe_materials_add_text(to, "warning", m->warning);
  cJSON *fits = cJSON_AddArrayToObject(to, "fits");
  for (int i = 0; i < 2 && !m->dispersion.shift.on; i++) {
    const abbe_material_fit *fit = &m->fit[i];
    cJSON *item = fit->terms > 0 ? cJSON_CreateObject() : NULL;
    if (item == NULL || !cJSON_AddItemToArray(fits, item)) continue;
    cJSON_AddNumberToObject(item, "terms", (double)fit->terms);
    cJSON_AddItemToObject(item, "coefficients", cJSON_CreateDoubleArray(fit->c, (int)fit->terms));
    cJSON_AddNumberToObject(item, "max_error", fit->max_error);
    abbe_index_difference off = {.rms = NAN, .max = NAN};
    abbe_material_fit_residual(m, fit, &off, NULL);
    cJSON_AddNumberToObject(item, "residual_rms", off.rms);
    cJSON_AddNumberToObject(item, "residual_max", off.max);
    abbe_materials_add_pair(item, "range_nm", fit->min_nm, fit->max_nm);
  }
}

static void add_published(cJSON *to, const abbe_material *m) {
  abbe_material_published p;
  abbe_material_published_make(m, &p);
  cJSON *item = cJSON_AddObjectToObject(to, "printed");
  cJSON_AddNumberToObject(item, "n_d", p.n_d);
  cJSON_AddNumberToObject(item, "v_d", p.v_d);
}

static void add_findings(cJSON *to, const abbe_findings *found) {
  cJSON *list = cJSON_AddArrayToObject(to, "findings");
  for (size_t i = 0; i < found->count; i++) {
    const abbe_finding *f = &found->finding[i];
    cJSON *item = cJSON_CreateObject();
    if (item == NULL || !cJSON_AddItemToArray(list, item)) continue;
    cJSON_AddStringToObject(item, "weight", abbe_finding_weight_name(f->weight));
    cJSON_AddStringToObject(item, "kind", abbe_finding_kind_name(f->kind));
    cJSON_AddStringToObject(item, "evidence", f->evidence);
    cJSON_AddStringToObject(item, "fix", f->fix);
  }
}

/* At the lines F, d and C, and where else it was asked. */
static void add_metal(cJSON *to, const request *r, const abbe_material *m) {
  double rgb[3];
  cJSON *list = cJSON_AddArrayToObject(to, "nk");
  for (size_t i = 0; i < 3 + r->at_count; i++) {
    double nk[3], nm = i < 3 ? lines[i].nm : r->at[i - 3];
    cJSON *item = cJSON_CreateObject();
    nk_at(m, nm, nk);
    cJSON_AddNumberToObject(item, "lambda_nm", nm);
    cJSON_AddNumberToObject(item, "n", nk[0]);
    cJSON_AddNumberToObject(item, "k", nk[1]);
    cJSON_AddNumberToObject(item, "reflectance", nk[2]);
    cJSON_AddItemToArray(list, item);
  }
  if (colour_of(m, rgb))
    cJSON_AddItemToObject(to, "colour_rec709", cJSON_CreateDoubleArray(rgb, 3));
  else
    cJSON_AddNullToObject(to, "colour_rec709");
}

static abbe_result show_json(const request *r, const abbe_material_table *table,
                             const abbe_material *m, const abbe_findings *found,
                             abbe_error *error) {
  cJSON *root = abbe_materials_json();
  cJSON_AddStringToObject(root, "name", m->name);
  abbe_materials_add_text(root, "description", m->description);
  cJSON_AddStringToObject(root, "table", table->path);
  const bool metal = abbe_material_is_conductor(m);
  cJSON *list = metal ? NULL : cJSON_AddArrayToObject(root, "n");
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < r->at_count && !metal && result == ABBE_OK; i++) {
    double n = 0, absolute = NAN;
    result = abbe_material_n(m, r->at[i], &n, error);
    abbe_material_n_absolute(m, r->at[i], &absolute, NULL);
    cJSON *item = cJSON_CreateObject();
    cJSON_AddNumberToObject(item, "lambda_nm", r->at[i]);
    cJSON_AddNumberToObject(item, "n", n);
    cJSON_AddNumberToObject(item, "n_absolute", absolute);
    if (abbe_material_is_uniaxial(m))
      cJSON_AddNumberToObject(item, "n_extraordinary", extraordinary_at(m, r->at[i]));
    abbe_materials_add_losses(item, m, r->at[i]);
    cJSON_AddBoolToObject(item, "extrapolated", abbe_material_extrapolates(m, r->at[i]));
    cJSON_AddItemToArray(list, item);
  }
  if (metal)
    add_metal(root, r, m);
  else
    abbe_materials_add_numbers(root, m);
  add_record(root, m);
  if (!metal) add_published(root, m);
  add_findings(root, found);
  if (result == ABBE_OK) return abbe_materials_print_json(root, error);
  cJSON_Delete(root);
  return result;
}

/* ---- arguments ---- */

enum { KEY_AT = ABBE_MATERIALS_KEY_OWN };

static const abbe_option options[] = {
    {"at", KEY_AT, "NM", 0, "also the index at this wavelength; may be repeated", 0,
     ABBE_TAKE_BY_KEY},
    {"temperature", 0, "C", 0, "the indices at this temperature of material and air, Celsius", 0,
     ABBE_TAKE_NUMBER(request, conditions.temperature_c, ABBE_CONDITIONS_LEAST_C,
                      ABBE_CONDITIONS_MOST_C)},
    {"pressure", 0, "ATM", 0, "and relative to air of this pressure; 0: relative to vacuum", 0,
     ABBE_TAKE_NUMBER(request, conditions.pressure_atm, 0, ABBE_CONDITIONS_MOST_ATM)},
    ABBE_MATERIALS_TABLE_OPTION(request, table),
    ABBE_MATERIALS_JSON_OPTION(request, json),
    {"fit", 0, NULL, 0, "the two Cauchy fits over 380:780 nm made anew, as YAML for the record", 0,
     ABBE_TAKE_FLAG(request, fit)},
    ABBE_ARGUMENT(request, name),
    {0}};

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
  switch (key) {
  case KEY_AT:
    if (r->at_count == MAX_AT) argp_error(state, "more than %d --at", MAX_AT);
    r->at[r->at_count++] = abbe_command_number(r->program, "--at", arg, 1, 1e6);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const abbe_parser parser = {
    .options = options,
    .parse = parse,
    .args_doc = "NAME",
    .doc = "Shows one material of a table.\v"
           "Examples:\n"
           "  abbe materials show diamond --at 430.8 --at 686.7\n"
           "  abbe materials show n-bk7 --at 587.5618 --json\n"
           "  abbe materials show my-glass --table glasses.yaml --fit\n"
           "  abbe materials show gold --at 550\n"
           "  abbe materials show n-bk7 --temperature -40 --pressure 0\n\n"
           "A wavelength outside a record's range is an error, unless the record says "
           "'extrapolate: true'; the answer then says so.",
};

/* What cannot go together is wrong use, reported before anything is read. */
static void check(const request *r) {
  if (r->name == NULL)
    abbe_materials_wrong_use(r->program,
                             "show what? Name a material; 'abbe materials list' has them");
  if (r->fit && (r->json || r->at_count > 0 || abbe_conditions_given(&r->conditions)))
    abbe_materials_wrong_use(r->program,
                             "--fit goes without --json, --at, --temperature and --pressure");
}

static abbe_result answer(const request *r, const abbe_material_table *table, abbe_error *error) {
  const abbe_material *m = NULL;
  ABBE_TRY(abbe_material_table_find(table, r->name, &m, error));
  /* asked first, so that a failure prints nothing else */
  for (size_t i = 0; i < r->at_count; i++) {
    double n, k;
    ABBE_TRY(abbe_material_is_conductor(m) ? abbe_material_nk(m, r->at[i], &n, &k, error)
                                           : abbe_material_n(m, r->at[i], &n, error));
  }
  abbe_material here = *m; /* owns nothing of its own */
  if (abbe_conditions_given(&r->conditions))
    ABBE_TRY(abbe_material_place(&here, &r->conditions, error));
  if (r->fit) return show_fit_yaml(m, error);
  ABBE_OWNED(abbe_material_table, known) = {0};
  ABBE_OWNED(abbe_findings, found) = {0};
  ABBE_TRY(abbe_material_table_load(NULL, &known, error));
  ABBE_TRY(abbe_check_material(m, &known, &found, error));
  m = &here;
  return r->json ? show_json(r, table, m, &found, error) : show_text(r, m, &found, error);
}

int abbe_materials_show(int argc, char **argv) {
  static request r;
  r = (request){.program = argv[0], .conditions = {NAN, NAN}};
  abbe_error error = {0};
  abbe_materials_parse(&parser, argc, argv, &r);
  check(&r);
  abbe_material_table table;
  abbe_result result = abbe_material_table_load_named(r.table, &r.name, 1, &table, &error);
  if (result == ABBE_OK) result = answer(&r, &table, &error);
  abbe_material_table_free(&table);
  return abbe_command_end(r.program, result, &error);
}
