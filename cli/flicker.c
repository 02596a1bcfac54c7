#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/options/frame_series.h"

#include "base/number.h"
#include "colorimetry/image/exr.h"
#include "validation/measure/frame_flicker.h"

#include <argp.h>
#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { OPTION_FRAMES = 0x100, OPTION_REFERENCE, OPTION_CAUSTIC, OPTION_JSON };

typedef struct request {
  const char *program, *path, *reference;
  abbe_frame_series series;
  bool caustic, json;
} request;

static const struct argp_option options[] = {
    {"frames", OPTION_FRAMES, "A:B", 0, "frames A to B - 1: TEST-0000.exr and so on", 0},
    {"reference", OPTION_REFERENCE, "REF.exr", ABBE_ARGUMENT_READS,
     "what they should be, frame by frame: REF-0000.exr and so on", 0},
    {"caustic", OPTION_CAUSTIC, NULL, 0, "of the layers caustic.R and so on alone", 0},
    {"json", OPTION_JSON, NULL, 0, "as JSON", 0},
    {0}};

static const abbe_take takes[] = {
    ABBE_TAKE_TEXT(request, OPTION_REFERENCE, reference),
    ABBE_TAKE_FLAG(request, OPTION_CAUSTIC, caustic),
    ABBE_TAKE_FLAG(request, OPTION_JSON, json),
    ABBE_TAKE_ARGUMENT(request, path),
    {0},
};

static error_t parse(int key, char *text, struct argp_state *state) {
  request *q = state->input;
  if (abbe_take_option(takes, key, text, state)) return 0;
  switch (key) {
  case OPTION_FRAMES:
    abbe_frame_series_take(&q->series, text);
    return 0;
  case ARGP_KEY_END:
    if (q->path == NULL || q->series.count == 0)
      argp_error(state, "which frames? Give TEST.exr and --frames A:B");
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

/* Which part of a file a frame is, is reported for the first. */
static abbe_result read_numbered(const request *q, const char *path, size_t i, abbe_image *out,
                                 abbe_error *error) {
  char *name = NULL;
  abbe_result result = abbe_frame_series_name(path, q->series.first + i, &name, error);
  if (result == ABBE_OK && name != NULL)
    result = (i == 0 ? abbe_command_read_picture : abbe_exr_read)(name, out, error);
  free(name);
  return result;
}

static abbe_result add_frame(const request *q, size_t i, abbe_frame_flicker *flicker,
                             abbe_frame_error *out, abbe_error *error) {
  abbe_image frame = {0}, reference = {0};
  abbe_result result = read_numbered(q, q->path, i, &frame, error);
  if (result == ABBE_OK) result = read_numbered(q, q->reference, i, &reference, error);
  if (result == ABBE_OK)
    result = abbe_frame_flicker_add(flicker, &frame, q->reference != NULL ? &reference : NULL, out,
                                    error);
  abbe_image_free(&frame);
  abbe_image_free(&reference);
  return result;
}

static void print_cell(double x) {
  char text[32];
  abbe_number_format(text, sizeof text, "%.4g", x);
  printf(" %10s", isnan(x) ? "-" : text);
}

static void print_row(const abbe_frame_error *row) {
  print_cell(row->error);
  print_cell(row->change);
  print_cell(row->ghost);
  printf("\n");
}

static void print_table(const request *q, const abbe_frame_flicker *f, const abbe_frame_error *row,
                        const abbe_frame_error *all, const abbe_frame_error *largest) {
  printf("%s, of the RMS of %s\nframe      error    flicker      ghost\n",
         f->caustic ? "caustic" : "picture", q->reference != NULL ? "the reference" : "the frame");
  for (size_t i = 0; i < f->count; i++) {
    printf("%5zu", q->series.first + i);
    print_row(&row[i]);
  }
  printf("  all");
  print_row(all);
  printf(" most");
  print_row(largest);
}

static void add_row(cJSON *item, const abbe_frame_error *row) {
  const double value[3] = {row->error, row->change, row->ghost};
  static const char *const name[3] = {"error", "flicker", "ghost"};
  for (int k = 0; k < 3; k++)
    cJSON_AddItemToObject(item, name[k],
                          isnan(value[k]) ? cJSON_CreateNull() : cJSON_CreateNumber(value[k]));
}

static abbe_result print_json(const request *q, const abbe_frame_flicker *f,
                              const abbe_frame_error *row, const abbe_frame_error *all,
                              const abbe_frame_error *largest, abbe_error *error) {
  cJSON *root = cJSON_CreateObject();
  cJSON_AddStringToObject(root, "of", f->caustic ? "caustic" : "picture");
  add_row(root, all);
  add_row(cJSON_AddObjectToObject(root, "largest"), largest);
  cJSON *list = cJSON_AddArrayToObject(root, "frames");
  for (size_t i = 0; i < f->count; i++) {
    cJSON *item = cJSON_CreateObject();
    cJSON_AddNumberToObject(item, "frame", (double)(q->series.first + i));
    add_row(item, &row[i]);
    cJSON_AddItemToArray(list, item);
  }
  const abbe_result result = abbe_command_print_json(root, error);
  cJSON_Delete(root);
  return result;
}

int abbe_command_flicker(int argc, char **argv) {
  static const struct argp argp = {
      options,
      parse,
      "TEST.exr",
      "Says how a series of frames errs over time: each frame's error, what of it changes from "
      "frame to frame, and light where there should be none.\v"
      "Examples:\n"
      "  abbe flicker pool.exr --frames 0:16\n"
      "  abbe flicker pool.exr --frames 0:16 --reference traced.exr --json\n"
      "  abbe flicker ring.exr --frames 0:8 --reference fine.exr --caustic\n",
      NULL,
      NULL,
      NULL};
  request q = {.program = argv[0], .series.program = argv[0]};
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &q);
  abbe_error error = {0};
  abbe_frame_flicker flicker = {.caustic = q.caustic};
  abbe_frame_error all, largest, *row = calloc(q.series.count, sizeof *row);
  abbe_result result =
      row != NULL ? ABBE_OK : abbe_error_set(&error, ABBE_NO_MEMORY, "no memory for frames");
  for (size_t i = 0; i < q.series.count && result == ABBE_OK; i++)
    result = add_frame(&q, i, &flicker, &row[i], &error);
  if (result == ABBE_OK) {
    abbe_frame_flicker_sum_up(row, q.series.count, &all);
    abbe_frame_flicker_largest(row, q.series.count, &largest);
    if (q.json)
      result = print_json(&q, &flicker, row, &all, &largest, &error);
    else
      print_table(&q, &flicker, row, &all, &largest);
  }
  abbe_frame_flicker_free(&flicker);
  free(row);
  return abbe_command_end(q.program, result, &error);
}
