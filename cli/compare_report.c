#include "cli/compare_report.h"

#include "cli/base/command.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const char *attribute(const abbe_compare_report *r, int side, const char *key) {
  return abbe_image_attribute_text(&r->field[side]->header, key);
}

static const abbe_compare_region *region_of(const abbe_compare_report *r, bool mask) {
  return mask ? &r->comparison->mask : &r->comparison->whole;
}

static bool has_errors(const abbe_field *f) {
  return f->colour.error != NULL || f->bands.error != NULL;
}

/* Notes */

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
note(abbe_compare_report *r, const char *format, ...) {
  if (r->note_count == ABBE_COMPARE_MAX_NOTES) return;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(r->note[r->note_count++], sizeof r->note[0], format, arguments);
  va_end(arguments);
}

static void note_files(abbe_compare_report *r) {
  static const char *const keys[] = {"abbe:scene", "abbe:unit"};
  for (int side = 0; side < 2; side++)
    if (r->field[side]->space_assumed)
      note(r,
           "%.150s does not say its colour space; Rec.709 primaries are assumed, as OpenEXR does",
           r->path[side]);
  for (int k = 0; k < 2; k++) {
    const char *a = attribute(r, 0, keys[k]), *b = attribute(r, 1, keys[k]);
    if (a != NULL && b != NULL && strcmp(a, b) != 0)
      note(r, "the files differ in %s: '%.100s' and '%.100s'", keys[k], a, b);
  }
  for (int side = 0; side < 2; side++) {
    const abbe_field *f = r->field[side];
    if (r->size[side][0] != f->width || r->size[side][1] != f->height)
      note(r, "%.150s was summed down from %zu x %zu texels", r->path[side], r->size[side][0],
           r->size[side][1]);
  }
}

static void note_units(abbe_compare_report *r) {
  const abbe_comparison *c = r->comparison;
  bool colour = r->field[0]->colour.channels > 0;
  if (c->scale != 1)
    note(r,
         "the test was multiplied by %.6g, the factor of least squares; its own energy ratio is "
         "the table's divided by it",
         c->scale);
  note(r, "0.01 in (a-b)^2/(b+0.01)^2 is a hundredth of the reference's mean %s, %.4g",
       colour ? "Y" : "over bands", c->unit);
  if (colour && c->white_found)
    note(r,
         "the white of CIEDE2000 is D65 at Y = %.4g, which the brightest 1 %% of the "
         "reference's lit pixels reach",
         c->white[1]);
  else if (colour)
    note(r, "the white of CIEDE2000 is XYZ = %.4g, %.4g, %.4g, as given", c->white[0], c->white[1],
         c->white[2]);
}

static void note_errors(abbe_compare_report *r) {
  const abbe_comparison *c = r->comparison;
  const abbe_ztest *z = &c->whole.z;
  if (!has_errors(r->field[0]))
    note(r, "the reference has no standard errors, so nothing tells its noise from a difference");
  else if (!r->field[0]->is_xyz && r->field[0]->colour.error != NULL)
    note(r, "noise of X, Y, Z is told from R, G, B at the most, for errors that go together");
  if (c->freedom > 0)
    note(r, "the Z-test takes the standard errors to rest on %.0f estimates (Student's t)",
         c->freedom + 1);
  if (z->untested > 0 && z->count > 0)
    note(r,
         "%zu of %zu samples have no standard error, so they are not in the Z-test; %zu of them "
         "differ",
         z->untested, z->untested + z->count, z->untested_differ);
  const char *seed[2] = {attribute(r, 0, "abbe:seed"), attribute(r, 1, "abbe:seed")};
  if (seed[0] != NULL && seed[1] != NULL && strcmp(seed[0], seed[1]) == 0 &&
      has_errors(r->field[0]) && has_errors(r->field[1]))
    note(r,
         "both were traced with the seed %.20s: noise that they share does not show in their "
         "difference, and less of it is there than is told",
         seed[0]);
  if (c->whole.invalid_reference > 0 || c->whole.invalid_test > 0)
    note(r, "left out: %zu pixels that are not finite in the reference, %zu in the test",
         c->whole.invalid_reference, c->whole.invalid_test);
}

/* Which metrics of light and colour noise explains, in one sentence a region. */
static void note_noise(abbe_compare_report *r, bool mask) {
  static const char *const of[] = {"the reference's own noise", "the noise of both"};
  for (int who = 0; who < 2; who++) {
    char list[300] = "";
    size_t used = 0;
    for (int m = 0; m < ABBE_COMPARE_Z_OVER_2; m++) {
      const abbe_compare_value *v = &region_of(r, mask)->metric[m];
      abbe_compare_verdict verdict = abbe_compare_judge((abbe_compare_metric)m, v);
      if (verdict != (who == 0 ? ABBE_COMPARE_BELOW_REFERENCE : ABBE_COMPARE_BELOW_BOTH)) continue;
      int n = snprintf(list + used, sizeof list - used, "%s%s", used > 0 ? ", " : "",
                       abbe_compare_metric_text((abbe_compare_metric)m));
      used += n > 0 && used + (size_t)n < sizeof list ? (size_t)n : 0;
    }
    if (used > 0)
      note(r, "%s: the difference is below %s in %s", mask ? r->mask_name : "whole field", of[who],
           list);
  }
}

static void note_z(abbe_compare_report *r, bool mask) {
  const abbe_compare_region *region = region_of(r, mask);
  if (region->z.count == 0) return;
  bool within = region->z.max <= region->z_critical;
  note(r,
       "%s: the greatest |z| of %zu is %.3g; up to %.3g noise explains it (%g %% chance of one "
       "above): the two %s",
       mask ? r->mask_name : "whole field", region->z.count, region->z.max, region->z_critical,
       100 * ABBE_ZTEST_LEVEL, within ? "agree within their errors" : "differ by more than noise");
}

void abbe_compare_report_add_notes(abbe_compare_report *report) {
  note_files(report);
  note_units(report);
  note_errors(report);
  for (int mask = 0; mask <= (report->comparison->masked ? 1 : 0); mask++) {
    note_noise(report, mask);
    note_z(report, mask);
  }
}

bool abbe_compare_report_keeps(const abbe_compare_report *report, const abbe_compare_tolerance *t) {
  const abbe_compare_region *region = region_of(report, t->mask);
  return region->invalid_test == 0 &&
         abbe_compare_deviation(t->metric, region->metric[t->metric].value) <= t->tolerance;
}

/* Text */

static void print_file(const abbe_compare_report *r, int side) {
  const abbe_field *f = r->field[side];
  const char *physics = attribute(r, side, "abbe:physics");
  printf("%-10s %s: %s, %zu x %zu", side == 0 ? "reference" : "test", r->path[side],
         abbe_field_kind_name(f->kind), f->width, f->height);
  if (f->colour.channels > 0) printf(", %s", f->space);
  if (f->bands.channels > 0) printf(", %zu bands", f->bands.channels);
  if (physics != NULL) printf(", physics %s", physics);
  printf(", %s", has_errors(f) ? "standard errors" : "no standard errors");
  if (f->passes > 0) printf(" of %zu passes", f->passes);
  printf("\n");
}

static void print_number(double x, int width) {
  if (isnan(x))
    printf(" %*s", width, "-");
  else
    printf(" %*.4g", width, x);
}

static void print_metrics(const abbe_compare_report *r) {
  int regions = r->comparison->masked ? 2 : 1;
  printf("\n%-26s %23s", "", "whole field");
  if (regions == 2) printf("   %23s", r->mask_name);
  printf("\n%-26s", "");
  for (int k = 0; k < regions; k++) printf("%s %11s %11s", k > 0 ? "  " : "", "value", "noise");
  printf("\n");
  for (int m = 0; m < ABBE_COMPARE_METRIC_COUNT; m++) {
    if (isnan(r->comparison->whole.metric[m].value) &&
        (regions == 1 || isnan(r->comparison->mask.metric[m].value)))
      continue;
    printf("%-26s", abbe_compare_metric_text((abbe_compare_metric)m));
    for (int k = 0; k < regions; k++) {
      const abbe_compare_value *v = &region_of(r, k)->metric[m];
      if (k > 0) printf("  ");
      print_number(v->value, 11);
      print_number(v->noise, 11);
    }
    printf("\n");
  }
}

static void print_channels(const abbe_compare_report *r) {
  bool mask = r->comparison->masked;
  const abbe_compare_region *region = region_of(r, mask);
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

void abbe_compare_report_print(const abbe_compare_report *r) {
  print_file(r, 0);
  print_file(r, 1);
  if (r->mask_name != NULL) {
    printf("%-10s %s: %zu of %zu pixels", "mask", r->mask_name, r->mask->inside, r->mask->count);
    if (r->mask_share > 0) printf(", the brightest that hold %g %% of it", 100 * r->mask_share);
    printf("\n");
  }
  print_metrics(r);
  print_channels(r);
  printf("\n");
  for (size_t i = 0; i < r->note_count; i++) printf("%s\n", r->note[i]);
}

/* JSON: numbers that are not known are null, which is how cJSON writes NaN. */

static bool add_text(cJSON *object, const char *key, const char *text) {
  return text == NULL ? cJSON_AddNullToObject(object, key) != NULL
                      : cJSON_AddStringToObject(object, key, text) != NULL;
}

static bool add_file(cJSON *root, const abbe_compare_report *r, int side) {
  const abbe_field *f = r->field[side];
  cJSON *o = cJSON_AddObjectToObject(root, side == 0 ? "reference" : "test");
  return add_text(o, "file", r->path[side]) && add_text(o, "kind", abbe_field_kind_name(f->kind)) &&
         cJSON_AddNumberToObject(o, "width", (double)f->width) != NULL &&
         cJSON_AddNumberToObject(o, "height", (double)f->height) != NULL &&
         cJSON_AddNumberToObject(o, "file_width", (double)r->size[side][0]) != NULL &&
         cJSON_AddNumberToObject(o, "file_height", (double)r->size[side][1]) != NULL &&
         add_text(o, "space", f->colour.channels > 0 ? f->space : NULL) &&
         cJSON_AddNumberToObject(o, "bands", (double)f->bands.channels) != NULL &&
         cJSON_AddBoolToObject(o, "standard_errors", has_errors(f)) != NULL &&
         cJSON_AddNumberToObject(o, "passes", (double)f->passes) != NULL &&
         add_text(o, "physics", attribute(r, side, "abbe:physics")) &&
         add_text(o, "scene", attribute(r, side, "abbe:scene"));
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

static bool add_mask(cJSON *root, const abbe_compare_report *r) {
  if (r->mask_name == NULL) return cJSON_AddNullToObject(root, "mask") != NULL;
  cJSON *o = cJSON_AddObjectToObject(root, "mask");
  return add_text(o, "name", r->mask_name) &&
         cJSON_AddNumberToObject(o, "pixels", (double)r->mask->inside) != NULL &&
         cJSON_AddNumberToObject(o, "share", r->mask_share > 0 ? r->mask_share : NAN) != NULL;
}

static bool add_tolerances(cJSON *root, const abbe_compare_report *r) {
  cJSON *list = cJSON_AddArrayToObject(root, "tolerances");
  bool all = true, made = list != NULL;
  for (size_t i = 0; made && i < r->tolerance_count; i++) {
    const abbe_compare_tolerance *t = &r->tolerance[i];
    bool kept = abbe_compare_report_keeps(r, t);
    cJSON *o = cJSON_CreateObject();
    all = all && kept;
    made = cJSON_AddItemToArray(list, o) && add_text(o, "region", t->mask ? "mask" : "whole") &&
           add_text(o, "metric", abbe_compare_metric_name(t->metric)) &&
           cJSON_AddNumberToObject(o, "tolerance", t->tolerance) != NULL &&
           cJSON_AddBoolToObject(o, "kept", kept) != NULL;
  }
  return made && cJSON_AddBoolToObject(root, "within_tolerance", all) != NULL;
}

abbe_result abbe_compare_report_print_json(const abbe_compare_report *r, abbe_error *error) {
  const abbe_comparison *c = r->comparison;
  cJSON *root = cJSON_CreateObject();
  bool made = add_file(root, r, 0) && add_file(root, r, 1) && add_mask(root, r) &&
              cJSON_AddNumberToObject(root, "scale", c->scale) != NULL &&
              cJSON_AddNumberToObject(root, "unit", c->unit) != NULL &&
              cJSON_AddItemToObject(root, "white", cJSON_CreateDoubleArray(c->white, 3)) &&
              cJSON_AddNumberToObject(root, "freedom", c->freedom) != NULL;
  cJSON *regions = cJSON_AddObjectToObject(root, "regions");
  made = made && add_region(regions, "whole", &c->whole);
  if (made && c->masked) made = add_region(regions, "mask", &c->mask);
  made = made && add_tolerances(root, r);
  cJSON *notes = cJSON_AddArrayToObject(root, "notes");
  for (size_t i = 0; made && i < r->note_count; i++)
    made = cJSON_AddItemToArray(notes, cJSON_CreateString(r->note[i]));
  abbe_result result = abbe_command_print_json(made ? root : NULL, error);
  cJSON_Delete(root);
  return result;
}
