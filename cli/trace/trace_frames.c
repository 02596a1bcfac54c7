#include "cli/trace/trace_request.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_FRAMES = 0x900, OPTION_FPS, OPTION_PART };

static const struct argp_option options[] = {
    {"frames", OPTION_FRAMES, "A:B", 0,
     "frames A to B - 1 over time, numbered, and FILE.png, .webp or .gif that moves", 5},
    {"fps", OPTION_FPS, "F", 0, "frames a second, of time and of the picture that moves (25)", 5},
    {"part", OPTION_PART, "K/N", 0, "only every N-th frame from the K-th on, and none that moves",
     5},
    {0}};

static error_t parse(int key, char *text, struct argp_state *state) {
  abbe_frame_series *s = state->input;
  switch (key) {
  case OPTION_FRAMES:
    abbe_frame_series_take(s, text);
    return 0;
  case OPTION_FPS:
    s->per_second = abbe_command_number(s->program, "--fps", text, 0.1, 1000);
    return 0;
  case OPTION_PART:
    abbe_command_read_part(s->program, text, &s->part);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

const struct argp abbe_trace_frames_argp = {options, parse, NULL, NULL, NULL, NULL, NULL};

void abbe_trace_frames_check(const abbe_trace_request *q, struct argp_state *state) {
  const abbe_frame_series *s = &q->series;
  abbe_frame_series_check(s, q->png, state);
  if (s->count == 0 && (s->per_second > 0 || s->part.parts > 0))
    argp_error(state, "--%s goes with --frames A:B", s->per_second > 0 ? "fps" : "part");
  if (s->part.parts > 0 && q->ranks != NULL)
    argp_error(state, "--part is for one process: abbe trace");
  if (s->part.parts > 0 && s->part.part >= s->count)
    argp_error(state, "--part %zu/%zu has none of %zu frames", s->part.part, s->part.parts,
               s->count);
  if (s->count > 0 &&
      (q->map.save != NULL || q->stats != NULL || q->json || q->rates || q->checkpoint != NULL ||
       q->part_end > 0 || q->merge || (q->exr == NULL && q->png == NULL)))
    argp_error(state, "--frames writes frames by -o FILE.exr and --png FILE.png, and goes without "
                      "--save-map, --stats, --json, --rates, --checkpoint, --passes and --merge");
}

/* The checkpoint stands beside the frame's first file. */
static abbe_result name_files(abbe_trace_request *own, size_t number, char *name[2],
                              abbe_error *error) {
  abbe_result result = abbe_frame_series_name(own->exr, number, &name[0], error);
  if (result == ABBE_OK) result = abbe_frame_series_name(own->png, number, &name[1], error);
  if (result != ABBE_OK) return result;
  own->exr = name[0];
  own->png = name[1];
  const char *beside = own->exr != NULL ? own->exr : own->png;
  const size_t size = strlen(beside) + 32;
  own->checkpoint_path = malloc(size);
  if (own->checkpoint_path == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory");
  snprintf(own->checkpoint_path, size, "%s.checkpoint", beside);
  return ABBE_OK;
}

static abbe_result trace_frame(const abbe_trace_request *q, const abbe_scene *scene, size_t i,
                               abbe_trace_frame trace_one, abbe_error *error) {
  abbe_trace_request own = *q;
  abbe_scene moved = {0};
  char *name[2] = {NULL, NULL};
  own.checkpoint_path = NULL;
  own.frame = i;
  abbe_result result = name_files(&own, q->series.first + i, name, error);
  if (result == ABBE_OK)
    result =
        abbe_frame_series_scene(&q->series, scene, q->materials, &q->changes, i, &moved, error);
  if (result == ABBE_OK && !q->quiet) fprintf(stderr, "frame %zu of %zu\n", i + 1, q->series.count);
  if (result == ABBE_OK) result = trace_one(&own, &moved, error);
  abbe_scene_free(&moved);
  free(own.checkpoint_path);
  for (int k = 0; k < 2; k++) free(name[k]);
  return result;
}

abbe_result abbe_trace_frames(const abbe_trace_request *q, const abbe_scene *scene,
                              abbe_trace_frame trace_one, abbe_error *error) {
  const abbe_frame_series *s = &q->series;
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < s->count && result == ABBE_OK; i++)
    if (abbe_frame_series_draws(s, i, q->exr, q->png))
      result = trace_frame(q, scene, i, trace_one, error);
  if (result == ABBE_OK && q->png != NULL && s->part.parts == 0)
    result = abbe_frame_series_merge(s, q->png, error);
  return result;
}
