#include "cli/base/frame_series.h"

#include "colorimetry/image/animated_png.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static double rate(const abbe_frame_series *s) {
  return s->per_second > 0 ? s->per_second : 25;
}

void abbe_frame_series_take(abbe_frame_series *s, const char *text) {
  char first[32];
  const size_t length = strcspn(text, ":");
  snprintf(first, sizeof first, "%.*s", (int)length, text);
  s->first = abbe_command_count(s->program, "--frames", first, 0, ABBE_FRAME_SERIES_MOST);
  const char *end = text[length] == ':' ? text + length + 1 : "";
  const size_t last = abbe_command_count(s->program, "--frames", end, 1, ABBE_FRAME_SERIES_MOST);
  if (last <= s->first) {
    fprintf(stderr,
            "%s: --frames '%s' are no frames: two numbers, the first frame and the one behind the "
            "last, such as 0:48\n",
            s->program, text);
    exit(ABBE_EXIT_USAGE);
  }
  s->count = last - s->first;
  s->around = false;
}

abbe_result abbe_frame_series_name(const char *path, size_t number, char **out, abbe_error *error) {
  *out = NULL;
  if (path == NULL) return ABBE_OK;
  const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
  const size_t length = strlen(path), room = length + 32;
  const size_t stem = dot != NULL && (slash == NULL || dot > slash) ? (size_t)(dot - path) : length;
  *out = malloc(room);
  if (*out == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a frame's name");
  snprintf(*out, room, "%.*s-%04zu%s", (int)stem, path, number, path + stem);
  return ABBE_OK;
}

/* What is there is whole: files are renamed when they are. */
static bool is_there(const char *path, size_t number) {
  char *name = NULL;
  const bool there = abbe_frame_series_name(path, number, &name, NULL) == ABBE_OK &&
                     (name == NULL || access(name, F_OK) == 0);
  free(name);
  return there;
}

bool abbe_frame_series_draws(const abbe_frame_series *s, size_t i, const char *exr,
                             const char *png) {
  if (!abbe_command_part_has(&s->part, i)) return false;
  return !s->resume || !is_there(exr, s->first + i) || !is_there(png, s->first + i);
}

double abbe_frame_series_time(const abbe_frame_series *s, double scene_time, size_t i) {
  return scene_time + (double)(s->first + i) / rate(s);
}

abbe_result abbe_frame_series_merge(const abbe_frame_series *s, const char *path,
                                    abbe_error *error) {
  char **png = calloc(s->count, sizeof *png);
  abbe_result result =
      png == NULL ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the names of frames")
                  : ABBE_OK;
  for (size_t i = 0; i < s->count && result == ABBE_OK; i++)
    result = abbe_frame_series_name(path, s->first + i, &png[i], error);
  if (result == ABBE_OK)
    result = abbe_animated_png_write(path, (const char *const *)png, s->count, rate(s), error);
  for (size_t i = 0; png != NULL && i < s->count; i++) free(png[i]);
  free(png);
  return result;
}
