#include "cli/gem/gem.h"
#include "cli/gem/gem_input.h"

#include "cli/base/arguments.h"
#include "cli/base/command.h"

#include <cjson/cJSON.h>
#include <stdio.h>

typedef struct request {
  abbe_gem_input in;
  const char *output;
} request;

static const struct argp_option options[] = {
    {"output", 'o', "FILE", ABBE_ARGUMENT_WRITES, "where to: .asc, .gem, .gcs, .stl, .obj or .glb", 0},
    {0}};

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
    if (q->output == NULL)
      argp_error(state, "where to? Give -o FILE.asc, .gem, .gcs, .stl, .obj or .glb");
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static abbe_result print_json(const request *q, const abbe_report *report, abbe_error *error) {
  cJSON *root = cJSON_CreateObject();
  abbe_gem_input_describe(&q->in, root);
  cJSON_AddStringToObject(root, "output", q->output);
  cJSON *notes = cJSON_AddArrayToObject(root, "notes");
  for (size_t i = 0; i < report->count; i++)
    cJSON_AddItemToArray(notes, cJSON_CreateString(report->note[i].text));
  abbe_result result = abbe_command_print_json(root, error);
  cJSON_Delete(root);
  return result;
}

int abbe_gem_convert(int argc, char **argv) {
  static const struct argp_child children[] = {{&abbe_gem_input_argp, 0, NULL, 0}, {0}};
  static const struct argp argp = {
      options,
      parse,
      "FILE",
      "Writes a design in another format, or its stone as a solid.\v"
      "STL and OBJ are in millimetres, z up, glTF in metres, y up; without --width a unit of the "
      "design is a metre. glTF takes index, dispersion and colour of --material.\n\n"
      "Examples:\n"
      "  abbe gem convert stone.gem -o stone.asc\n"
      "  abbe gem convert scenes/designs/brilliant-quartz.asc --width 8 -o stone.stl\n"
      "  abbe gem convert scenes/designs/brilliant-diamond.asc --width 6.5 --material diamond -o "
      "stone.glb",
      children,
      NULL,
      NULL};
  request q = {.in.program = argv[0]};
  abbe_report report = {0};
  abbe_error error = {0};
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &q);
  abbe_result result = abbe_command_check_targets(&q.output, 1, &error);
  if (result == ABBE_OK) result = abbe_gem_input_load(&q.in, &error);
  if (result == ABBE_OK)
    result = abbe_gem_output_write(q.output, &q.in.cut, &q.in.stone, abbe_gem_input_scale(&q.in),
                                   q.in.material, &report, &error);
  for (size_t i = 0; i < report.count && !q.in.quiet; i++)
    fprintf(stderr, "note: %s: %s\n", q.output, report.note[i].text);
  if (result == ABBE_OK && q.in.json) result = print_json(&q, &report, &error);
  abbe_report_free(&report);
  abbe_gem_input_free(&q.in);
  return abbe_command_end(argv[0], result, &error);
}
