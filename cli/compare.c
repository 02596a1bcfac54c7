#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/compare_report.h"

#include "base/nearest.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/png_file.h"
#include "validation/compare/difference_picture.h"

#include <argp.h>
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
  KEY_MASK = 256,
  KEY_MASK_SHARE,
  KEY_WHITE,
  KEY_SCALE,
  KEY_TOLERANCE,
  KEY_DIFFERENCE,
  KEY_RANGE,
  KEY_SEED,
  KEY_JSON
};

typedef struct request {
  const char *program, *path[2], *mask, *difference;
  double mask_share, range;
  bool json;
  abbe_compare_options options;
  size_t tolerance_count;
  abbe_compare_tolerance tolerance[ABBE_COMPARE_MAX_TOLERANCES];
} request;

/* All that is loaded or made on the way. */
typedef struct work {
  abbe_field field[2];
  size_t size[2][2]; /* width and height as read */
  abbe_mask mask;
  abbe_comparison comparison;
} work;

/* The work itself */

static bool ends_with_png(const char *path) {
  size_t n = strlen(path);
  return n > 4 && path[n - 4] == '.' && tolower((unsigned char)path[n - 3]) == 'p' &&
         tolower((unsigned char)path[n - 2]) == 'n' && tolower((unsigned char)path[n - 1]) == 'g';
}

static abbe_result load_mask(const request *q, const abbe_field *reference, abbe_mask *mask,
                             abbe_error *error) {
  abbe_image image = {0};
  abbe_error why = {0};
  const bool png = ends_with_png(q->mask);
  abbe_result result =
      png ? abbe_png_read(q->mask, &image, error) : abbe_exr_read(q->mask, &image, error);
  if (result != ABBE_OK) return result;
  if (image.width != reference->width || image.height != reference->height)
    result =
        abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                       "%s: the mask has %zu x %zu pixels; what is compared has %zu x %zu", q->mask,
                       image.width, image.height, reference->width, reference->height);
  else if (!png) /* a PNG says of no place where it lies */
    result = abbe_image_check_place(&image, q->mask, &reference->header, q->path[0], error);
  if (result == ABBE_OK && abbe_mask_make_drawn(&image, mask, &why) != ABBE_OK)
    result = abbe_error_set(error, why.code, "%s: %.400s", q->mask, why.text);
  abbe_image_free(&image);
  return result;
}

static abbe_result find_mask(const request *q, const abbe_field *reference, abbe_mask *mask,
                             abbe_error *error) {
  if (q->mask == NULL) return ABBE_OK;
  if (strcmp(q->mask, "caustic") == 0)
    return abbe_mask_make_caustic(reference, q->path[0], q->mask_share, mask, error);
  return load_mask(q, reference, mask, error);
}

/* What a tolerance bounds must be known: a bound that is not looked at would be kept for ever. */
static abbe_result check_tolerances(const request *q, const abbe_comparison *c, abbe_error *error) {
  for (size_t i = 0; i < q->tolerance_count; i++) {
    const abbe_compare_tolerance *t = &q->tolerance[i];
    const abbe_compare_region *region = t->mask ? &c->mask : &c->whole;
    if (!isnan(region->metric[t->metric].value) || region->invalid_test > 0) continue;
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "--tolerance %s: it is not known for %s and %s (bands and standard "
                          "errors must be there, and light in the region)",
                          abbe_compare_metric_name(t->metric), q->path[0], q->path[1]);
  }
  return ABBE_OK;
}

static const char *base_of(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash == NULL ? path : slash + 1;
}

static abbe_result draw(const request *q, work *w, abbe_error *error) {
  if (q->difference == NULL) return ABBE_OK;
  double range = q->range, scale = w->comparison.scale;
  char title[160];
  snprintf(title, sizeof title, "%.70s less %.70s", base_of(q->path[1]), base_of(q->path[0]));
  abbe_result result = ABBE_OK;
  if (range == 0)
    result = abbe_difference_picture_range(&w->field[0], &w->field[1], scale, &range, error);
  if (range == 0) range = w->comparison.unit; /* nothing differs */
  if (result == ABBE_OK)
    result = abbe_difference_picture_write(q->difference, &w->field[0], &w->field[1], scale, range,
                                           title, error);
  return result;
}

/* The first tolerance that is not kept, and how many more. */
static abbe_result judge(const request *q, const abbe_compare_report *r, abbe_error *error) {
  const abbe_compare_tolerance *first = NULL;
  size_t failed = 0;
  for (size_t i = 0; i < q->tolerance_count; i++) {
    if (abbe_compare_report_keeps(r, &q->tolerance[i])) continue;
    if (failed++ == 0) first = &q->tolerance[i];
  }
  if (failed == 0) return ABBE_OK;
  const abbe_compare_region *region = first->mask ? &r->comparison->mask : &r->comparison->whole;
  char more[64] = "", bad[64] = "";
  if (failed > 1) snprintf(more, sizeof more, "; %zu more are out of tolerance", failed - 1);
  if (region->invalid_test > 0)
    snprintf(bad, sizeof bad, " and %zu pixels are not finite", region->invalid_test);
  return abbe_error_set(
      error, ABBE_TOLERANCE, "%s: %s of the %s is %.4g%s, out of the tolerance of %g%s", q->path[1],
      abbe_compare_metric_name(first->metric), first->mask ? "mask" : "whole field",
      region->metric[first->metric].value, bad, first->tolerance, more);
}

static abbe_result report(const request *q, const work *w, abbe_error *error) {
  bool found = q->mask != NULL && strcmp(q->mask, "caustic") == 0;
  abbe_compare_report r = {.path = {q->path[0], q->path[1]},
                           .field = {&w->field[0], &w->field[1]},
                           .size = {{w->size[0][0], w->size[0][1]}, {w->size[1][0], w->size[1][1]}},
                           .mask_name = q->mask,
                           .mask_share = found ? q->mask_share : 0,
                           .mask = &w->mask,
                           .comparison = &w->comparison,
                           .tolerance_count = q->tolerance_count,
                           .tolerance = q->tolerance};
  abbe_compare_report_add_notes(&r);
  abbe_result result = ABBE_OK;
  if (q->json)
    result = abbe_compare_report_print_json(&r, error);
  else
    abbe_compare_report_print(&r);
  return result == ABBE_OK ? judge(q, &r, error) : result;
}

static abbe_result compare(const request *q, work *w, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (int side = 0; side < 2 && result == ABBE_OK; side++) {
    result = abbe_field_load(q->path[side], &w->field[side], error);
    w->size[side][0] = w->field[side].width;
    w->size[side][1] = w->field[side].height;
  }
  if (result == ABBE_OK)
    result = abbe_field_align(&w->field[0], q->path[0], &w->field[1], q->path[1], error);
  if (result == ABBE_OK) result = find_mask(q, &w->field[0], &w->mask, error);
  abbe_compare_options options = q->options;
  if (q->mask != NULL) options.mask = &w->mask;
  abbe_error why = {0};
  if (result == ABBE_OK &&
      abbe_compare(&w->field[0], &w->field[1], &options, &w->comparison, &why) != ABBE_OK)
    result = abbe_error_set(error, why.code, "%s and %s: %.600s", q->path[0], q->path[1], why.text);
  if (result == ABBE_OK) result = check_tolerances(q, &w->comparison, error);
  if (result == ABBE_OK) result = draw(q, w, error);
  return result == ABBE_OK ? report(q, w, error) : result;
}

/* The command line */

static const struct argp_option options[] = {
    {"mask", KEY_MASK, "caustic|FILE", ABBE_ARGUMENT_READS,
     "look at a region too: where REF's caustic is, or a picture's first channel is above 0.5", 0},
    {"mask-share", KEY_MASK_SHARE, "X", 0, "of the caustic's light that its mask holds (0.95)", 0},
    {"tolerance", KEY_TOLERANCE, "[mask.]METRIC=X", 0,
     "end with 3 where the metric is above X; of an energy ratio, its distance from 1; repeatable",
     0},
    {"difference", KEY_DIFFERENCE, "FILE", ABBE_ARGUMENT_WRITES,
     "where TEST is brighter or darker, in colours: a .png or .svg", 0},
    {"range", KEY_RANGE, "X", 0, "of the difference picture, -X to X (99 % of what there is)", 0},
    {"scale", KEY_SCALE, "best", 0, "multiply TEST by its best single factor first", 0},
    {"white", KEY_WHITE, "Y|X,Y,Z", 0,
     "of CIEDE2000: D65 at Y, or XYZ (D65 at what the brightest 1 % reach)", 0},
    {"seed", KEY_SEED, "N", 0, "of the noise that REF's errors are drawn as, for colour (0)", 0},
    {"json", KEY_JSON, NULL, 0, "as JSON, numbers in full", 0},
    {0}};

static void wrong_tolerance(const char *text, struct argp_state *state) {
  const char *names[ABBE_COMPARE_METRIC_COUNT];
  char list[600] = "";
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
  if (q->tolerance_count == ABBE_COMPARE_MAX_TOLERANCES)
    argp_error(state, "--tolerance may be given %d times", ABBE_COMPARE_MAX_TOLERANCES);
  q->tolerance[q->tolerance_count++] = t;
}

static void set_white(request *q, const char *text, struct argp_state *state) {
  static const double d65[3] = {0.3127 / 0.3290, 1, (1 - 0.3127 - 0.3290) / 0.3290};
  double v[3];
  char rest;
  int n = sscanf(text, "%lf,%lf,%lf%c", &v[0], &v[1], &v[2], &rest);
  bool one = n == 1 && strchr(text, ',') == NULL && isfinite(v[0]);
  for (int c = 0; one && c < 3; c++) q->options.white[c] = v[0] * d65[c];
  for (int c = 0; n == 3 && c < 3; c++) q->options.white[c] = v[c];
  bool good = one || n == 3;
  for (int c = 0; good && c < 3; c++)
    good = q->options.white[c] > 0 && isfinite(q->options.white[c]);
  if (!good)
    argp_error(state, "--white '%s' is not a Y above 0 such as 1, nor an XYZ such as 0.95,1,1.09",
               text);
}

static void finish(request *q, struct argp_state *state) {
  if (q->path[1] == NULL) argp_error(state, "which two files? Give REF and TEST");
  if (q->range > 0 && q->difference == NULL)
    argp_error(state, "--range is that of the picture of --difference, which is not asked for");
  for (size_t i = 0; i < q->tolerance_count; i++)
    if (q->tolerance[i].mask && q->mask == NULL)
      argp_error(state, "--tolerance mask.%s needs a --mask",
                 abbe_compare_metric_name(q->tolerance[i].metric));
}

static error_t parse(int key, char *arg, struct argp_state *state) {
  static const char *const scales[] = {"best"};
  request *q = state->input;
  switch (key) {
  case KEY_MASK:
    q->mask = arg;
    return 0;
  case KEY_MASK_SHARE:
    q->mask_share = abbe_command_number(q->program, "--mask-share", arg, 0.001, 1);
    return 0;
  case KEY_WHITE:
    set_white(q, arg, state);
    return 0;
  case KEY_SCALE:
    q->options.best_scale = abbe_command_choice(q->program, "--scale", arg, scales, 1) == 0;
    return 0;
  case KEY_TOLERANCE:
    add_tolerance(q, arg, state);
    return 0;
  case KEY_DIFFERENCE:
    q->difference = arg;
    return 0;
  case KEY_RANGE:
    q->range = abbe_command_number(q->program, "--range", arg, 1e-30, 1e30);
    return 0;
  case KEY_SEED:
    q->options.seed = abbe_command_count(q->program, "--seed", arg, 0, 4294967295u);
    return 0;
  case KEY_JSON:
    q->json = true;
    return 0;
  case ARGP_KEY_ARG:
    if (q->path[1] != NULL) argp_error(state, "'%s' is one argument too many", arg);
    q->path[q->path[0] != NULL] = arg;
    return 0;
  case ARGP_KEY_END:
    finish(q, state);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const struct argp parser = {
    .options = options,
    .parser = parse,
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
  request q = {.program = argv[0], .mask_share = ABBE_MASK_CAUSTIC_SHARE};
  abbe_arguments_parse(&parser, ABBE_ARGUMENT_READS, argc, argv, &q);
  abbe_error error = {0};
  work w = {0};
  abbe_result result = compare(&q, &w, &error);
  abbe_comparison_free(&w.comparison);
  abbe_mask_free(&w.mask);
  abbe_field_free(&w.field[0]);
  abbe_field_free(&w.field[1]);
  return abbe_command_end(q.program, result, &error);
}
