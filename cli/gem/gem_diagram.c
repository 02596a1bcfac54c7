#include "cli/gem/gem.h"
#include "cli/gem/gem_input.h"

#include "base/number.h"
#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "scenes/cuts/cut_diagram.h"

#include <cjson/cJSON.h>
#include <stdio.h>

typedef struct request {
  abbe_gem_input in;
  const char *output;
} request;

static const struct argp_option options[] = {
    {"output", 'o', "FILE", ABBE_ARGUMENT_WRITES, "the sheet: .pdf, .svg or .png", 0}, {0}};

static error_t parse(int key, char *text, struct argp_state *state) {
  request *q = state->input;
  switch (key) {
  case ARGP_KEY_INIT:
    state->child_inputs[0] = &q->in;
    return 0;
  case 'o':
    q->output = text;
    return 0;
  case ARGP_KEY_END:
    if (q->output == NULL) argp_error(state, "where to? Give -o FILE.pdf, .svg or .png");
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

/* The stone's note, where one is wanted. */
static const char *note_of(const abbe_gem_input *in, char *text, size_t size) {
  const double density = abbe_gem_input_density(in), mm = 1e3 * in->width_m;
  int used = 0;
  if (in->material == NULL && in->width_m == 0) return NULL;
  if (in->material != NULL)
    used = abbe_number_format(text, size, "%s, index %.3f   ", in->material->name, in->n);
  if (in->width_m > 0)
    used += abbe_number_format(text + used, size - (size_t)used, "width %.2f mm   ", mm);
  if (in->width_m > 0 && density > 0)
    abbe_number_format(text + used, size - (size_t)used, "%.3f carats",
                       abbe_cut_measures_carats(&in->measures, in->width_m, density));
  return text;
}

int abbe_gem_diagram(int argc, char **argv) {
  static const struct argp_child children[] = {{&abbe_gem_input_argp, 0, NULL, 0}, {0}};
  static const struct argp argp = {
      options,
      parse,
      "FILE",
      "Draws a design on a sheet to cut from.\v"
      "Crown and pavilion with the wheel of indices, two profiles, proportions, and the tiers with "
      "their angles, indices and instructions.\n\n"
      "Examples:\n"
      "  abbe gem diagram scenes/designs/brilliant-quartz.asc -o quartz.pdf\n"
      "  abbe gem diagram stone.gem --material sapphire --width 8 -o stone.png",
      children,
      NULL,
      NULL};
  request q = {.in.program = argv[0]};
  char note[300];
  abbe_error error = {0};
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &q);
  abbe_result result = abbe_command_check_targets(&q.output, 1, &error);
  if (result == ABBE_OK) result = abbe_gem_input_load(&q.in, &error);
  if (result == ABBE_OK)
    result = abbe_cut_diagram_write(q.output, &q.in.cut, &q.in.stone,
                                    note_of(&q.in, note, sizeof note), q.in.n, &error);
  if (result == ABBE_OK && q.in.json) {
    cJSON *root = cJSON_CreateObject();
    abbe_gem_input_describe(&q.in, root);
    cJSON_AddStringToObject(root, "diagram", q.output);
    result = abbe_command_print_json(root, &error);
    cJSON_Delete(root);
  }
  abbe_gem_input_free(&q.in);
  return abbe_command_end(argv[0], result, &error);
}
