#include "cli/base/arguments.h"

#include "base/text.h"
#include "cli/base/command.h"
#include "validation/measure/file_comparison.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A comparison for people and as JSON, on stdout. */

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

static void compare_report_print(const abbe_file_comparison *r, const abbe_compare_notes *notes) {
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

static abbe_result compare_report_print_json(const abbe_file_comparison *r,
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
  return abbe_command_print_json(root, made, error);
}

enum { KEY_WHITE = 256, KEY_SCALE, KEY_TOLERANCE, KEY_SEED };

enum { MAX_TOLERANCES = 64 };

typedef struct request {
  const char *program, *difference;
  double range;
  bool json;
  abbe_file_comparison_desc desc;
  size_t tolerance_count;
  abbe_compare_tolerance tolerance[MAX_TOLERANCES];
} request;

static abbe_result report(const request *q, const abbe_file_comparison *c, abbe_error *error) {
  abbe_compare_notes notes;
  abbe_compare_notes_make(c, &notes);
  if (q->json) return compare_report_print_json(c, &notes, q->tolerance, q->tolerance_count, error);
  compare_report_print(c, &notes);
  return ABBE_OK;
}

static abbe_result compare(const request *q, abbe_error *error) {
  abbe_file_comparison c;
  ABBE_TRY(abbe_file_comparison_make(&q->desc, &c, error));
  for (int side = 0; side < 2; side++)
    abbe_command_note_part(c.path[side], c.field[side].header.part);
  abbe_command_note_part(c.mask_name, c.mask_part);
  abbe_result result = abbe_file_comparison_check(&c, q->tolerance, q->tolerance_count, error);
  if (result == ABBE_OK && q->difference != NULL)
    result = abbe_file_comparison_draw(&c, q->difference, q->range, error);
  if (result == ABBE_OK) result = report(q, &c, error);
  if (result == ABBE_OK)
    result = abbe_file_comparison_judge(&c, q->tolerance, q->tolerance_count, error);
  abbe_file_comparison_free(&c);
  return result;
}

/* The command line */

static const abbe_option options[] = {
    {"mask", 0, "caustic|FILE", ABBE_ARGUMENT_READS,
     "look at a region too: where REF's caustic is, or a picture's first channel is above 0.5", 0,
     ABBE_TAKE_TEXT(request, desc.mask)},
    {"mask-share", 0, "X", 0, "of the caustic's light that its mask holds (0.95)", 0,
     ABBE_TAKE_NUMBER(request, desc.mask_share, 0.001, 1)},
    {"tolerance", KEY_TOLERANCE, "[mask.]METRIC=X", 0,
     "end with 3 where the metric is above X; of an energy ratio or SSIM, its distance from 1; "
     "repeatable",
     0, ABBE_TAKE_BY_KEY},
    {"difference", 0, "FILE", ABBE_ARGUMENT_WRITES,
     "where TEST is brighter or darker, in colours: a .png or .svg", 0,
     ABBE_TAKE_TEXT(request, difference)},
    {"range", 0, "X", 0, "of the difference picture, -X to X (99 % of what there is)", 0,
     ABBE_TAKE_NUMBER(request, range, 1e-30, 1e30)},
    {"scale", KEY_SCALE, "best", 0, "multiply TEST by its best single factor first", 0,
     ABBE_TAKE_BY_KEY},
    {"white", KEY_WHITE, "Y|X,Y,Z", 0,
     "of colour, SSIM and FLIP: D65 at Y, or XYZ (D65 at what the brightest 1 % reach)", 0,
     ABBE_TAKE_BY_KEY},
    {"seed", KEY_SEED, "N", 0, "of the noise that REF's errors are drawn as, for colour (0)", 0,
     ABBE_TAKE_BY_KEY},
    {"json", 0, NULL, 0, "as JSON, numbers in full", 0, ABBE_TAKE_FLAG(request, json)},
    {0}};

static void wrong_tolerance(const char *text, struct argp_state *state) {
  const char *names[ABBE_COMPARE_METRIC_COUNT];
  char list[800] = "";
  size_t used = 0;
  for (int m = 0; m < ABBE_COMPARE_METRIC_COUNT; m++) {
    names[m] = abbe_compare_metric_name((abbe_compare_metric)m);
    used += (size_t)snprintf(list + used, sizeof list - used, " %s", names[m]);
  }
  char word[64];
  snprintf(word, sizeof word, "%.*s", (int)strcspn(text, "="), text);
  const char *near = abbe_nearest_word(word, names, ABBE_COMPARE_METRIC_COUNT);
  argp_error(state, "--tolerance '%s' is not METRIC=X%s%s%s; METRIC is one of%s", text,
             near != NULL ? "; did you mean '" : "", near != NULL ? near : "",
             near != NULL ? "'?" : "", list);
}

static void add_tolerance(request *q, const char *text, struct argp_state *state) {
  const char *name = text, *equals = strchr(text, '=');
  abbe_compare_tolerance t = {.mask = strncmp(text, "mask.", 5) == 0};
  if (t.mask) name += 5;
  if (strncmp(text, "whole.", 6) == 0) name += 6;
  char word[64] = "";
  if (equals != NULL && (size_t)(equals - name) < sizeof word)
    snprintf(word, sizeof word, "%.*s", (int)(equals - name), name);
  t.metric = abbe_compare_metric_find(word);
  if (t.metric == ABBE_COMPARE_METRIC_COUNT) wrong_tolerance(name, state);
  t.tolerance = abbe_command_number(q->program, "--tolerance", equals + 1, 0, 1e30);
  if (q->tolerance_count == MAX_TOLERANCES)
    argp_error(state, "--tolerance may be given %d times", MAX_TOLERANCES);
  q->tolerance[q->tolerance_count++] = t;
}

static void set_white(request *q, const char *text, struct argp_state *state) {
  static const double d65[3] = {0.3127 / 0.3290, 1, (1 - 0.3127 - 0.3290) / 0.3290};
  double v[3];
  char rest;
  int n = sscanf(text, "%lf,%lf,%lf%c", &v[0], &v[1], &v[2], &rest);
  bool one = n == 1 && strchr(text, ',') == NULL && isfinite(v[0]);
  for (int c = 0; one && c < 3; c++) q->desc.options.white[c] = v[0] * d65[c];
  for (int c = 0; n == 3 && c < 3; c++) q->desc.options.white[c] = v[c];
  bool good = one || n == 3;
  for (int c = 0; good && c < 3; c++)
    good = q->desc.options.white[c] > 0 && isfinite(q->desc.options.white[c]);
  if (!good)
    argp_error(state, "--white '%s' is not a Y above 0 such as 1, nor an XYZ such as 0.95,1,1.09",
               text);
}

static void finish(request *q, struct argp_state *state) {
  if (q->desc.path[1] == NULL) argp_error(state, "which two files? Give REF and TEST");
  if (q->range > 0 && q->difference == NULL)
    argp_error(state, "--range is that of the picture of --difference, which is not asked for");
  for (size_t i = 0; i < q->tolerance_count; i++)
    if (q->tolerance[i].mask && q->desc.mask == NULL)
      argp_error(state, "--tolerance mask.%s needs a --mask",
                 abbe_compare_metric_name(q->tolerance[i].metric));
}

static error_t parse(int key, char *arg, struct argp_state *state) {
  static const char *const scales[] = {"best"};
  request *q = state->input;
  switch (key) {
  case KEY_WHITE:
    set_white(q, arg, state);
    return 0;
  case KEY_SCALE:
    q->desc.options.best_scale = abbe_command_choice(q->program, "--scale", arg, scales, 1) == 0;
    return 0;
  case KEY_TOLERANCE:
    add_tolerance(q, arg, state);
    return 0;
  case KEY_SEED:
    q->desc.options.seed = abbe_command_count(q->program, "--seed", arg, 0, 4294967295u);
    return 0;
  case ARGP_KEY_ARG:
    if (q->desc.path[1] != NULL) argp_error(state, "'%s' is one argument too many", arg);
    q->desc.path[q->desc.path[0] != NULL] = arg;
    return 0;
  case ARGP_KEY_END:
    finish(q, state);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const abbe_parser parser = {
    .options = options,
    .parse = parse,
    .args_doc = "REF.exr TEST.exr",
    .doc =
        "Says how far a picture or a receiver map is from a reference: in light, in colour, band "
        "by "
        "band, and whether the standard errors of the files explain it. Beside each value stands "
        "what the reference's own noise alone would make of it.\v"
        "Pictures must have one size and lie in one place (display window); of two maps of one "
        "layout the finer is summed down to the coarser. A difference below the reference's noise "
        "is said to be so.\n\n"
        "Examples:\n"
        "  abbe compare reference.exr gem.exr\n"
        "  abbe compare map-ref.exr map.exr --mask caustic --difference map.png\n"
        "  abbe compare ref.exr gem.exr --tolerance mask.relative_rmse=0.1 --mask caustic\n"
        "  abbe compare ref.exr thesis.exr --scale best --json\n",
};

int abbe_command_compare(int argc, char **argv) {
  request q = {.program = argv[0],
               .desc = {.mask_share = ABBE_MASK_CAUSTIC_SHARE, .options.structure = true}};
  abbe_arguments_parse(&parser, ABBE_ARGUMENT_READS, argc, argv, &q);
  abbe_error error = {0};
  abbe_result result = compare(&q, &error);
  return abbe_command_end(q.program, result, &error);
}
