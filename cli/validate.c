#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"

#include "validation/lab/known/known_answers.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct request {
  const char *program, *chart;
  abbe_known_options options;
  bool json, quiet;
} request;

static const char *verdict(const abbe_known_answer *r) {
  if (r->passed) return "ok";
  return fabs(r->error) <= r->tolerance ? "TOO NOISY" : "FAILS";
}

static void print_row(const abbe_known_answer *r) {
  char spread[32] = "";
  if (r->standard_error > 0) snprintf(spread, sizeof spread, "%.2g", r->standard_error);
  printf("  %-62s %-9s %14.8g %14.8g %9s %10.2g %9.2g  %s\n", r->quantity, r->unit, r->exact,
         r->traced, spread, r->error, r->tolerance, verdict(r));
}

/* The reasons of a group, each once, under its rows. */
static void print_reasons(const abbe_known_answer *row, size_t count) {
  for (size_t i = 0; i < count; i++) {
    bool said = false;
    for (size_t k = 0; k < i && !said; k++) said = strcmp(row[k].reason, row[i].reason) == 0;
    if (!said) printf("  tolerance (%s): %s\n", row[i].unit, row[i].reason);
  }
  printf("\n");
}

static const char *description(const char *group) {
  for (size_t i = 0; abbe_known_answers_group(i) != NULL; i++)
    if (strcmp(abbe_known_answers_group(i), group) == 0) return abbe_known_answers_describe(i);
  return "";
}

static void print_text(const abbe_known_answers *a) {
  for (size_t from = 0, to; from < a->count; from = to) {
    const char *group = a->row[from].group;
    printf("%s: %s\n", group, description(group));
    printf("  %-62s %-9s %14s %14s %9s %10s %9s\n", "quantity", "unit", "exact", "traced",
           "std error", "error", "tolerance");
    for (to = from; to < a->count && a->row[to].group == group; to++) print_row(&a->row[to]);
    print_reasons(&a->row[from], to - from);
  }
  size_t failed = abbe_known_answers_failed(a);
  printf("%zu of %zu known answers are within tolerance\n", a->count - failed, a->count);
}

/* cJSON writes NaN as null. */
static bool add_row(cJSON *list, const abbe_known_answer *r) {
  cJSON *item = cJSON_CreateObject();
  if (!cJSON_AddItemToArray(list, item)) return false;
  return cJSON_AddStringToObject(item, "group", r->group) != NULL &&
         cJSON_AddStringToObject(item, "quantity", r->quantity) != NULL &&
         cJSON_AddStringToObject(item, "unit", r->unit) != NULL &&
         cJSON_AddNumberToObject(item, "exact", r->exact) != NULL &&
         cJSON_AddNumberToObject(item, "traced", r->traced) != NULL &&
         cJSON_AddNumberToObject(item, "standard_error", r->standard_error) != NULL &&
         cJSON_AddNumberToObject(item, "error", r->error) != NULL &&
         cJSON_AddNumberToObject(item, "tolerance", r->tolerance) != NULL &&
         cJSON_AddStringToObject(item, "reason", r->reason) != NULL &&
         cJSON_AddBoolToObject(item, "passed", r->passed) != NULL;
}

static abbe_result print_json(const abbe_known_answers *a, abbe_error *error) {
  cJSON *root = cJSON_CreateObject();
  size_t failed = abbe_known_answers_failed(a);
  bool made = cJSON_AddNumberToObject(root, "passed", (double)(a->count - failed)) != NULL &&
              cJSON_AddNumberToObject(root, "failed", (double)failed) != NULL;
  cJSON *list = cJSON_AddArrayToObject(root, "answers");
  for (size_t i = 0; made && i < a->count; i++) made = add_row(list, &a->row[i]);
  return abbe_command_print_json(root, made, error);
}

static abbe_result validate(request *r, abbe_error *error) {
  abbe_known_answers answers = {0};
  abbe_progress progress;
  abbe_progress_begin(&progress, r->program, r->quiet);
  r->options.progress = abbe_progress_update;
  r->options.user = &progress;
  abbe_result result = abbe_known_answers_make(&r->options, &answers, error);
  abbe_progress_end(&progress);
  size_t failed = abbe_known_answers_failed(&answers);
  if (result == ABBE_OK && r->json)
    result = print_json(&answers, error);
  else if (result == ABBE_OK)
    print_text(&answers);
  if (result == ABBE_OK && r->chart != NULL)
    result = abbe_known_chart_write(r->chart, &answers, error);
  if (result == ABBE_OK && failed > 0)
    result = abbe_error_set(error, ABBE_TOLERANCE, "%zu of %zu known answers are out of tolerance",
                            failed, answers.count);
  abbe_known_answers_free(&answers);
  return result;
}

enum { KEY_ONLY = 256, KEY_CHART, MAX_GROUPS = 32 };

static const abbe_option options[] = {
    {"only", KEY_ONLY, "GROUP", ABBE_ARGUMENT_ONCE, "one group of answers; see the list below", 0,
     ABBE_TAKE_BY_KEY},
    {"samples", 0, "N", 0, "paths of each traced light, instead of each group's own", 0,
     ABBE_TAKE_COUNT(request, options.samples, 1000, 1000000000000)},
    {"seed", 0, "N", 0, "other random numbers; without it, 0", 0,
     ABBE_TAKE_COUNT(request, options.seed, 0, UINT32_MAX)},
    {"threads", 0, "N", 0, "1 to 1024; without it, one a processor", 0,
     ABBE_TAKE_COUNT(request, options.threads, 1, 1024)},
    {"chart", KEY_CHART, "FILE", ABBE_ARGUMENT_WRITES, "draw the errors, as .png or .svg", 0,
     ABBE_TAKE_BY_KEY},
    {"quiet", 0, NULL, 0, "no progress bar", 0, ABBE_TAKE_FLAG(request, quiet)},
    {"json", 0, NULL, 0, "as JSON, numbers in full", 0, ABBE_TAKE_FLAG(request, json)},
    {0}};

static const char *choose_group(const request *r, const char *word) {
  const char *names[MAX_GROUPS];
  int count = 0;
  while (count < MAX_GROUPS && abbe_known_answers_group((size_t)count) != NULL) {
    names[count] = abbe_known_answers_group((size_t)count);
    count++;
  }
  return names[abbe_command_choice(r->program, "--only", word, names, count)];
}

/* Reported before the work and not after it. */
static bool is_picture(const char *path) {
  const char *dot = strrchr(path, '.');
  return dot != NULL && (strcmp(dot, ".png") == 0 || strcmp(dot, ".svg") == 0);
}

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
  switch (key) {
  case KEY_ONLY:
    r->options.only = choose_group(r, arg);
    return 0;
  case KEY_CHART:
    if (!is_picture(arg))
      argp_error(state, "--chart '%s' wants a name that ends with .png or .svg", arg);
    r->chart = arg;
    return 0;
  case ARGP_KEY_ARG:
    argp_error(state, "'%s' is one argument too many", arg);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

#define GROUP_LINE(name, what) "  " #name ": " what "\n"
static const abbe_parser parser = {
    .options = options,
    .parse = parse,
    .doc = "Holds the reference tracer against optics that is known in closed form or by "
           "quadrature, a row an answer: exact, traced, error, tolerance and its reason. Ends "
           "with 3 where a row is out of tolerance. All of it takes nine minutes of "
           "processor time.\v"
           "Groups:\n" ABBE_KNOWN_GROUPS(
               GROUP_LINE) "\n"
                           "Examples:\n"
                           "  abbe validate\n"
                           "  abbe validate --only rainbow\n"
                           "  abbe validate --only sphere --samples 100000000 --seed 7\n"
                           "  abbe validate --json > answers.json\n"
                           "  abbe validate --only convergence --chart convergence.png\n",
};
#undef GROUP_LINE

int abbe_command_validate(int argc, char **argv) {
  request r = {.program = argv[0]};
  abbe_arguments_parse(&parser, 0, argc, argv, &r);
  abbe_error error = {0};
  abbe_result result = validate(&r, &error);
  return abbe_command_end(r.program, result, &error);
}
