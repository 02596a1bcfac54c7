#include "cli/render/turntable.h"

#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"

#include "colorimetry/image/animated_png.h"
#include "colorimetry/image/exr.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_TURNTABLE = 0x800, OPTION_FPS, OPTION_PART, OPTION_MERGE };

static const struct argp_option options[] = {
    {"turntable", OPTION_TURNTABLE, "N", 0,
     "N frames from all around, numbered: FILE-0001.exr, FILE-0001.png, and FILE.png that moves",
     5},
    {"part", OPTION_PART, "K/N", 0,
     "only every N-th frame from the K-th on, 0/8 to 7/8, and no PNG that moves", 5},
    {"merge", OPTION_MERGE, NULL, 0,
     "draw nothing: make FILE.png of the numbered frames that are there", 5},
    {"fps", OPTION_FPS, "F", 0, "frames a second of the PNG that moves (25)", 5},
    {0}};

static error_t parse(int key, char *text, struct argp_state *state) {
  abbe_turntable_options *o = state->input;
  switch (key) {
  case OPTION_TURNTABLE:
    o->frames = abbe_command_count(o->program, "--turntable", text, 2, ABBE_TURNTABLE_MAX_FRAMES);
    return 0;
  case OPTION_FPS:
    o->per_second = abbe_command_number(o->program, "--fps", text, 0.1, 1000);
    return 0;
  case OPTION_PART:
    abbe_command_read_part(o->program, text, &o->part);
    return 0;
  case OPTION_MERGE:
    o->merge = true;
    return 0;
  case ARGP_KEY_END:
    if ((o->part.parts > 0 || o->merge) && o->frames == 0)
      argp_error(state, "--%s goes with --turntable N", o->merge ? "merge" : "part");
    if (o->part.parts > 0 && o->part.part >= o->frames)
      argp_error(state, "--part %zu/%zu has none of %zu frames", o->part.part, o->part.parts,
                 o->frames);
    if (o->part.parts > 0 && o->merge)
      argp_error(state, "--part draws frames, and --merge draws nothing");
    if (o->per_second > 0 && o->frames == 0) argp_error(state, "--fps goes with --turntable N");
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

const struct argp abbe_turntable_argp = {options, parse, NULL, NULL, NULL, NULL, NULL};

/* v turned about the unit axis, the right-handed way. */
static void turn(const double v[3], const double axis[3], double rad, double out[3]) {
  const double c = cos(rad), s = sin(rad);
  const double along = v[0] * axis[0] + v[1] * axis[1] + v[2] * axis[2];
  for (int k = 0; k < 3; k++) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    out[k] = v[k] * c + (axis[i] * v[j] - axis[j] * v[i]) * s + axis[k] * along * (1 - c);
  }
}

static abbe_camera camera_at(const abbe_camera *first, double rad) {
  abbe_camera camera = *first;
  double axis[3], from[3], to[3], length = 0;
  for (int k = 0; k < 3; k++) length += first->up[k] * first->up[k];
  for (int k = 0; k < 3; k++) {
    axis[k] = first->up[k] / sqrt(length);
    from[k] = first->eye[k] - first->target[k];
  }
  turn(from, axis, rad, to);
  for (int k = 0; k < 3; k++) camera.eye[k] = first->target[k] + to[k];
  return camera;
}

/* "stone.png" is "stone-0001.png"; malloc'd, NULL without memory. */
static char *number(const char *path, size_t frame) {
  const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
  const size_t length = strlen(path), room = length + 32;
  const size_t stem = dot != NULL && (slash == NULL || dot > slash) ? (size_t)(dot - path) : length;
  char *out = malloc(room);
  if (out != NULL) snprintf(out, room, "%.*s-%04zu%s", (int)stem, path, frame, path + stem);
  return out;
}

static abbe_result no_memory(abbe_error *error) {
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the names of frames");
}

static abbe_result write_frame(const abbe_render_request *q, const abbe_image *image, size_t frame,
                               char **png, abbe_error *error) {
  char *exr = q->exr != NULL ? number(q->exr, frame) : NULL;
  abbe_render_request own = *q;
  *png = q->png != NULL ? number(q->png, frame) : NULL;
  own.png = *png;
  abbe_result result = (q->exr != NULL && exr == NULL) || (q->png != NULL && *png == NULL)
                           ? no_memory(error)
                           : ABBE_OK;
  if (result == ABBE_OK && exr != NULL) result = abbe_exr_write(exr, image, error);
  if (result == ABBE_OK && own.png != NULL) result = abbe_render_write_png(&own, image, error);
  free(exr);
  return result;
}

static abbe_result draw_frame(const abbe_render_request *q, const abbe_scene *scene,
                              const abbe_render_desc *desc, abbe_renderer *renderer,
                              const abbe_context *context, size_t i, char **png,
                              abbe_statistics *statistics, abbe_error *error) {
  const double full = 2 * 3.14159265358979323846;
  abbe_image image = {0};
  abbe_scene moved = *scene;
  moved.camera = camera_at(&scene->camera, full * (double)i / (double)q->turntable.frames);
  abbe_result result = abbe_renderer_change(renderer, &moved, desc, error);
  if (result == ABBE_OK) result = abbe_renderer_frame(renderer, NULL, NULL, statistics, error);
  if (result == ABBE_OK) result = abbe_renderer_read(renderer, q->aovs, &image, error);
  if (result == ABBE_OK) result = abbe_render_annotate(q, renderer, context, &image, error);
  if (result == ABBE_OK) result = write_frame(q, &image, i + 1, png, error);
  abbe_image_free(&image);
  return result;
}

static abbe_result write_moving(const abbe_render_request *q, char *const *png,
                                abbe_error *error) {
  const abbe_turntable_options *o = &q->turntable;
  const double per_second = o->per_second > 0 ? o->per_second : 25;
  return abbe_animated_png_write(q->png, (const char *const *)png, o->frames, per_second, error);
}

abbe_result abbe_turntable_merge(const abbe_render_request *q, abbe_error *error) {
  const size_t count = q->turntable.frames;
  char **png = calloc(count, sizeof *png);
  abbe_result result = png == NULL ? no_memory(error) : ABBE_OK;
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    png[i] = number(q->png, i + 1);
    if (png[i] == NULL) result = no_memory(error);
  }
  if (result == ABBE_OK) result = write_moving(q, png, error);
  for (size_t i = 0; png != NULL && i < count; i++) free(png[i]);
  free(png);
  return result;
}

abbe_result abbe_turntable_draw(const abbe_render_request *q, const abbe_scene *scene,
                                const abbe_render_desc *desc, abbe_renderer *renderer,
                                const abbe_context *context, abbe_statistics *statistics,
                                abbe_error *error) {
  const size_t count = q->turntable.frames;
  const abbe_command_part *part = &q->turntable.part;
  abbe_progress progress;
  abbe_render_desc own = *desc;
  char **png = calloc(count, sizeof *png);
  if (png == NULL) return no_memory(error);
  own.progress = NULL;
  own.compiling = NULL;
  abbe_progress_begin(&progress, "turntable", q->quiet);
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    if (!abbe_command_part_has(part, i)) continue;
    result = draw_frame(q, scene, &own, renderer, context, i, &png[i], statistics, error);
    if (!abbe_progress_update(&progress, (double)(i + 1) / (double)count) && result == ABBE_OK &&
        i + 1 < count)
      result =
          abbe_error_set(error, ABBE_CANCELLED, "stopped after %zu of %zu frames", i + 1, count);
  }
  abbe_progress_end(&progress);
  if (result == ABBE_OK && q->png != NULL && part->parts == 0)
    result = write_moving(q, png, error);
  /* the renderer is not to look at a scene that is gone */
  abbe_error ignored = {0};
  const abbe_result back = abbe_renderer_change(renderer, scene, &own, &ignored);
  if (result == ABBE_OK && back != ABBE_OK)
    result = abbe_error_set(error, back, "%s", ignored.text);
  for (size_t i = 0; i < count; i++) free(png[i]);
  free(png);
  return result;
}
