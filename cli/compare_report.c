#include "cli/compare_report.h"

#include "cli/base/command.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>

/* Text */

static void print_file(const abbe_file_comparison *r, int side) {
  const abbe_field *f = &r->field[side];
  const char *physics = abbe_file_comparison_attribute(r, side, "abbe:physics");
  printf("%-10s %s: %s, %zu x %zu", side == 0 ? "reference" : "test", r->path[side],
         abbe_field_kind_name(f->kind), f->width, f->height);
  if (f->colour.channels > 0) printf(", %s", f->space);
  if (f->bands.channels > 0) printf(", %zu bands", f->bands.channels);
  if (physics != NULL) printf(", physics %s", physics);
  printf(", %s",
         abbe_file_comparison_has_errors(r, side) ? "standard errors" : "no standard errors");
  if (f->passes > 0) printf(" of %zu passes", f->passes);
  printf("\n");
}

static void print_number(double x, int width) {
  if (isnan(x))
    printf(" %*s", width, "-");
  else
    printf(" %*.4g", width, x);
}

static void print_metrics(const abbe_file_comparison *r) {
  int regions = r->comparison.masked ? 2 : 1;
  printf("\n%-26s %23s", "", "whole field");
  if (regions == 2) printf("   %23s", r->mask_name);
  printf("\n%-26s", "");
  for (int k = 0; k < regions; k++) printf("%s %11s %11s", k > 0 ? "  " : "", "value", "noise");
  printf("\n");
  for (int m = 0; m < ABBE_COMPARE_METRIC_COUNT; m++) {
    if (isnan(r->comparison.whole.metric[m].value) &&
        (regions == 1 || isnan(r->comparison.mask.metric[m].value)))
      continue;
    printf("%-26s", abbe_compare_metric_text((abbe_compare_metric)m));
    for (int k = 0; k < regions; k++) {
      const abbe_compare_value *v = &abbe_file_comparison_region(r, k)->metric[m];
      if (k > 0) printf("  ");
      print_number(v->value, 11);
      print_number(v->noise, 11);
    }
    printf("\n");
  }
}

static void print_channels(const abbe_file_comparison *r) {
  bool mask = r->comparison.masked;
  const abbe_compare_region *region = abbe_file_comparison_region(r, mask);
  printf("\n%-26s %11s %11s %11s %11s %11s\n", mask ? r->mask_name : "whole field", "mean of ref",
         "energy", "rel. RMSE", "noise", "net");
  for (size_t c = 0; c < region->channels; c++) {
    const abbe_compare_channel *h = &region->channel[c];
    printf("%-26s", h->name);
    print_number(h->mean_reference, 11);
    print_number(h->energy_ratio.value, 11);
    print_number(h->relative_rmse.value, 11);
    print_number(h->relative_rmse.noise, 11);
    print_number(h->relative_rmse.net, 11);
    printf("\n");
  }
}

void abbe_compare_report_print(const abbe_file_comparison *r, const abbe_compare_notes *notes) {
  print_file(r, 0);
  print_file(r, 1);
  if (r->mask_name != NULL) {
    printf("%-10s %s: %zu of %zu pixels", "mask", r->mask_name, r->mask.inside, r->mask.count);
    if (r->mask_share > 0) printf(", the brightest that hold %g %% of it", 100 * r->mask_share);
    printf("\n");
  }
  print_metrics(r);
  print_channels(r);
  printf("\n");
  for (size_t i = 0; i < notes->count; i++) printf("%s\n", notes->note[i]);
}

/* JSON: numbers that are not known are null, which is how cJSON writes NaN. */

static bool add_text(cJSON *object, const char *key, const char *text) {
  return text == NULL ? cJSON_AddNullToObject(object, key) != NULL
                      : cJSON_AddStringToObject(object, key, text) != NULL;
}

static bool add_file(cJSON *root, const abbe_file_comparison *r, int side) {
  const abbe_field *f = &r->field[side];
  cJSON *o = cJSON_AddObjectToObject(root, side == 0 ? "reference" : "test");
  return add_text(o, "file", r->path[side]) && add_text(o, "kind", abbe_field_kind_name(f->kind)) &&
         cJSON_AddNumberToObject(o, "width", (double)f->width) != NULL &&
         cJSON_AddNumberToObject(o, "height", (double)f->height) != NULL &&
         cJSON_AddNumberToObject(o, "file_width", (double)r->size[side][0]) != NULL &&
         cJSON_AddNumberToObject(o, "file_height", (double)r->size[side][1]) != NULL &&
         add_text(o, "space", f->colour.channels > 0 ? f->space : NULL) &&
         cJSON_AddNumberToObject(o, "bands", (double)f->bands.channels) != NULL &&
         cJSON_AddBoolToObject(o, "standard_errors", abbe_file_comparison_has_errors(r, side)) !=
             NULL &&
         cJSON_AddNumberToObject(o, "passes", (double)f->passes) != NULL &&
         add_text(o, "physics", abbe_file_comparison_attribute(r, side, "abbe:physics")) &&
         add_text(o, "scene", abbe_file_comparison_attribute(r, side, "abbe:scene"));
}

static bool add_value(cJSON *object, const char *key, const abbe_compare_value *v,
                      const char *verdict) {
  cJSON *o = cJSON_AddObjectToObject(object, key);
  return cJSON_AddNumberToObject(o, "value", v->value) != NULL &&
         cJSON_AddNumberToObject(o, "noise", v->noise) != NULL &&
         cJSON_AddNumberToObject(o, "limit", v->limit) != NULL &&
         cJSON_AddNumberToObject(o, "both_noise", v->both_noise) != NULL &&
         cJSON_AddNumberToObject(o, "both_limit", v->both_limit) != NULL &&
         cJSON_AddNumberToObject(o, "net", v->net) != NULL &&
         (verdict == NULL || add_text(o, "verdict", verdict));
}

static bool add_channel(cJSON *list, const abbe_compare_channel *h) {
  cJSON *o = cJSON_CreateObject();
  return cJSON_AddItemToArray(list, o) && add_text(o, "name", h->name) &&
         cJSON_AddNumberToObject(o, "lambda_nm", h->lambda_nm > 0 ? h->lambda_nm : NAN) != NULL &&
         cJSON_AddNumberToObject(o, "mean_reference", h->mean_reference) != NULL &&
         cJSON_AddNumberToObject(o, "mean_test", h->mean_test) != NULL &&
         add_value(o, "relative_rmse", &h->relative_rmse, NULL) &&
         add_value(o, "squared_relative", &h->squared_relative, NULL) &&
         add_value(o, "energy_ratio", &h->energy_ratio, NULL);
}

static bool add_z(cJSON *object, const abbe_compare_region *region) {
  cJSON *o = cJSON_AddObjectToObject(object, "z");
  const abbe_ztest *z = &region->z;
  return cJSON_AddNumberToObject(o, "samples", (double)z->count) != NULL &&
         cJSON_AddNumberToObject(o, "greatest", z->count > 0 ? z->max : NAN) != NULL &&
         cJSON_AddNumberToObject(o, "critical", region->z_critical) != NULL &&
         cJSON_AddNumberToObject(o, "untested", (double)z->untested) != NULL &&
         cJSON_AddNumberToObject(o, "untested_differ", (double)z->untested_differ) != NULL;
}

static bool add_region(cJSON *root, const char *key, const abbe_compare_region *region) {
  static const char *const verdicts[] = {NULL, "below the reference's noise",
                                         "below the noise of both", "above noise"};
  cJSON *o = cJSON_AddObjectToObject(root, key);
  bool made =
      cJSON_AddNumberToObject(o, "pixels", (double)region->pixels) != NULL &&
      cJSON_AddNumberToObject(o, "invalid_reference", (double)region->invalid_reference) != NULL &&
      cJSON_AddNumberToObject(o, "invalid_test", (double)region->invalid_test) != NULL &&
      cJSON_AddNumberToObject(o, "uv_share", region->uv_share) != NULL && add_z(o, region);
  cJSON *metrics = cJSON_AddObjectToObject(o, "metrics");
  for (int m = 0; made && m < ABBE_COMPARE_METRIC_COUNT; m++) {
    const abbe_compare_value *v = &region->metric[m];
    if (isnan(v->value)) continue;
    made = add_value(metrics, abbe_compare_metric_name((abbe_compare_metric)m), v,
                     verdicts[abbe_compare_judge((abbe_compare_metric)m, v)]);
  }
  cJSON *channels = cJSON_AddArrayToObject(o, "channels");
  for (size_t c = 0; made && c < region->channels; c++)
    made = add_channel(channels, &region->channel[c]);
  return made;
}

static bool add_mask(cJSON *root, const abbe_file_comparison *r) {
  if (r->mask_name == NULL) return cJSON_AddNullToObject(root, "mask") != NULL;
  cJSON *o = cJSON_AddObjectToObject(root, "mask");
  return add_text(o, "name", r->mask_name) &&
         cJSON_AddNumberToObject(o, "pixels", (double)r->mask.inside) != NULL &&
         cJSON_AddNumberToObject(o, "share", r->mask_share > 0 ? r->mask_share : NAN) != NULL;
}

static bool add_tolerances(cJSON *root, const abbe_file_comparison *r,
                           const abbe_compare_tolerance *tolerance, size_t count) {
  cJSON *list = cJSON_AddArrayToObject(root, "tolerances");
  bool all = true, made = list != NULL;
  for (size_t i = 0; made && i < count; i++) {
    const abbe_compare_tolerance *t = &tolerance[i];
    bool kept = abbe_file_comparison_keeps(r, t);
    cJSON *o = cJSON_CreateObject();
    all = all && kept;
    made = cJSON_AddItemToArray(list, o) && add_text(o, "region", t->mask ? "mask" : "whole") &&
           add_text(o, "metric", abbe_compare_metric_name(t->metric)) &&
           cJSON_AddNumberToObject(o, "tolerance", t->tolerance) != NULL &&
           cJSON_AddBoolToObject(o, "kept", kept) != NULL;
  }
  return made && cJSON_AddBoolToObject(root, "within_tolerance", all) != NULL;
}

abbe_result abbe_compare_report_print_json(const abbe_file_comparison *r,
                                           const abbe_compare_notes *notes,
                                           const abbe_compare_tolerance *tolerance, size_t count,
                                           abbe_error *error) {
  const abbe_comparison *c = &r->comparison;
  cJSON *root = cJSON_CreateObject();
  bool made = add_file(root, r, 0) && add_file(root, r, 1) && add_mask(root, r) &&
              cJSON_AddNumberToObject(root, "scale", c->scale) != NULL &&
              cJSON_AddNumberToObject(root, "unit", c->unit) != NULL &&
              cJSON_AddItemToObject(root, "white", cJSON_CreateDoubleArray(c->white, 3)) &&
              cJSON_AddNumberToObject(root, "freedom", c->freedom) != NULL;
  cJSON *regions = cJSON_AddObjectToObject(root, "regions");
  made = made && add_region(regions, "whole", &c->whole);
  if (made && c->masked) made = add_region(regions, "mask", &c->mask);
  made = made && add_tolerances(root, r, tolerance, count);
  cJSON *list = cJSON_AddArrayToObject(root, "notes");
  for (size_t i = 0; made && i < notes->count; i++)
    made = cJSON_AddItemToArray(list, cJSON_CreateString(notes->note[i]));
  abbe_result result = abbe_command_print_json(made ? root : NULL, error);
  cJSON_Delete(root);
  return result;
}
