#include "cli/options/frame_series.h"

#include "base/file.h"
#include "base/number.h"
#include "cli/base/arguments.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/screen/screen_file.h"
#include "scenes/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What made a frame, in lines of text that its files carry: so that a series that is resumed or
 * merged has no frames of another size, seed, scene or program among it. */

/* Options that change no pixel of a frame, or say where files go. */
static const char *const neutral[] = {
    "quiet", "json", "part", "resume", "merge", "threads", "checkpoint-every"};

/* FNV-1a. */
static uint64_t hash(uint64_t h, const void *data, size_t size) {
  const unsigned char *p = data;
  for (size_t i = 0; i < size; i++) h = (h ^ p[i]) * 1099511628211u;
  return h;
}

/* Hashes a file's bytes, or its name where there is no file. */
static uint64_t hash_file(uint64_t h, const char *path) {
  char block[1 << 14];
  FILE *file;
  if (path == NULL) return h;
  if (abbe_file_open(path, &file, NULL, NULL) != ABBE_OK) return hash(h, path, strlen(path));
  for (size_t size; (size = fread(block, 1, sizeof block, file)) > 0;) h = hash(h, block, size);
  fclose(file);
  return h;
}

static bool is_left_out(const abbe_argument *a, const char *without) {
  bool out =
      (a->flags & ABBE_ARGUMENT_WRITES) != 0 || (without != NULL && strcmp(a->name, without) == 0);
  for (size_t i = 0; i < sizeof neutral / sizeof *neutral; i++)
    out = out || strcmp(a->name, neutral[i]) == 0;
  return out;
}

/* By name; of one name in the order in which they were given. */
static int by_name(const void *a, const void *b) {
  const abbe_argument *const *x = a, *const *y = b;
  const int order = strcmp((*x)->name, (*y)->name);
  return order != 0 ? order : (*x > *y) - (*x < *y);
}

static void write_options(FILE *to, const char *without) {
  const abbe_argument *given[ABBE_ARGUMENT_MOST];
  size_t count = 0;
  for (const abbe_argument *a; (a = abbe_arguments_given(count)) != NULL;) given[count++] = a;
  qsort(given, count, sizeof *given, by_name);
  for (size_t i = 0; i < count; i++) {
    if (is_left_out(given[i], without)) continue;
    if ((given[i]->flags & ABBE_ARGUMENT_READS) != 0)
      fprintf(to, "%s of digest %016llx\n", given[i]->name,
              (unsigned long long)hash_file(0, given[i]->value));
    else
      fprintf(to, "%s%s%s\n", given[i]->name, given[i]->value[0] != '\0' ? " " : "",
              given[i]->value);
  }
}

/* What all frames of this run have in common: the program's version, its options but for those that
 * change no pixel and the one named `without` (NULL: none), and digests of all files that it reads.
 * *out is malloc'd. ABBE_NO_MEMORY. */
static abbe_result frame_record_make(const abbe_scene *scene, const char *without, char **out,
                                     abbe_error *error) {
  size_t size;
  uint64_t h = 14695981039346656037u;
  FILE *to = open_memstream(out, &size);
  if (to == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for frames' records");
  fprintf(to, "abbe %s\n", ABBE_VERSION);
  write_options(to, without);
  for (size_t i = 0; i < abbe_scene_file_count(scene); i++)
    h = hash_file(h, abbe_scene_file(scene, i));
  fprintf(to, "scene of digest %016llx\n", (unsigned long long)h);
  if (fclose(to) == 0) return ABBE_OK;
  free(*out);
  *out = NULL;
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for frames' records");
}

/* The record of frame `number`; malloc'd, or NULL without memory. */
static char *frame_record_of(const char *common, size_t number) {
  const size_t size = strlen(common) + 32;
  char *text = malloc(size);
  if (text != NULL) snprintf(text, size, "frame %zu\n%s", number, common);
  return text;
}

/* What the PNG or EXR file at path carries; malloc'd. NULL: none, or it cannot be read. */
static char *frame_record_read(const char *path) {
  char *text = NULL;
  abbe_image image;
  const size_t length = strlen(path);
  if (length < 4 || strcmp(path + length - 4, ".exr") != 0) {
    if (abbe_png_read_text(path, &text, NULL) != ABBE_OK) return NULL;
    return text;
  }
  if (abbe_exr_read(path, &image, NULL) != ABBE_OK) return NULL;
  const char *own = abbe_image_attribute_text(&image, ABBE_PNG_TEXT);
  if (own != NULL) text = strdup(own);
  abbe_image_free(&image);
  return text;
}

static const char *behind_line(const char *text) {
  const char *end = strchr(text, '\n');
  return end != NULL ? end + 1 : text + strlen(text);
}

/* Whether both are of one run, whatever their frames; else in text[size] how they differ: "'size
 * 64x64', and not 'size 96x64'". theirs may be NULL. */
static bool frame_record_is_like(const char *theirs, const char *ours, char *text, size_t size) {
  if (theirs == NULL) {
    snprintf(text, size, "what its file does not say");
    return false;
  }
  theirs = behind_line(theirs);
  ours = behind_line(ours);
  while (*theirs != '\0' || *ours != '\0') {
    const int n = (int)strcspn(theirs, "\n"), m = (int)strcspn(ours, "\n");
    if (n != m || strncmp(theirs, ours, (size_t)n) != 0) {
      snprintf(text, size, "'%.*s', and not '%.*s'", n < 200 ? n : 200, theirs, m < 200 ? m : 200,
               ours);
      return false;
    }
    theirs = behind_line(theirs);
    ours = behind_line(ours);
  }
  return true;
}

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

void abbe_frame_series_take_move(abbe_frame_series *s, abbe_scene_input_changes *changes,
                                 const char *text) {
  const char *equals = strchr(text, '='), *colon = equals != NULL ? strchr(equals, ':') : NULL;
  const bool numbers = colon != NULL && strchr("+-.[0123456789", equals[1]) != NULL &&
                       colon > equals + 1 && colon[1] != '\0' &&
                       strchr("+-.[0123456789", colon[1]) != NULL;
  if (!numbers || equals == text || colon - text >= ABBE_FRAME_SERIES_MOVE_TEXT ||
      strlen(colon) > ABBE_FRAME_SERIES_MOVE_TEXT) {
    fprintf(stderr,
            "%s: --move '%s' moves nothing; write KEY=A:B with numbers, such as "
            "lights.lamp.intensity=1:3 or lights.sun.direction=[0,0,-1]:[1,0,-1]\n",
            s->program, text);
    exit(ABBE_EXIT_USAGE);
  }
  if (s->moves == ABBE_FRAME_SERIES_MOVES) {
    fprintf(stderr, "%s: no more than %d --move; write keyframes into the scene\n", s->program,
            ABBE_FRAME_SERIES_MOVES);
    exit(ABBE_EXIT_USAGE);
  }
  char *first = s->move_first[s->moves];
  snprintf(first, ABBE_FRAME_SERIES_MOVE_TEXT, "%.*s", (int)(colon - text), text);
  s->move_last[s->moves++] = colon + 1;
  abbe_scene_input_set(changes, first, s->program);
}

void abbe_frame_series_check(const abbe_frame_series *s, const char *png,
                             struct argp_state *state) {
  const abbe_screen_file_needs needs = {.moves = true, .per_second = rate(s)};
  abbe_error error = {0};
  if (s->count > 0 && png != NULL && abbe_screen_file_check(png, &needs, &error) != ABBE_OK)
    argp_error(state, "%s", error.text);
  if (s->moves > 0 && (s->count == 0 || s->around))
    argp_error(state, "--move goes with --frames A:B");
}

/* The place of the change that a scene begins with, for that of all frames. */
static void put_change(abbe_scene_input_changes *changes, const char *first, const char *all) {
  for (size_t i = 0; i < changes->set_count; i++)
    if (strcmp(changes->set[i], first) == 0) changes->set[i] = all;
}

/* When frame i is, s, in a scene whose own time is scene_time. */
static double frame_series_time(const abbe_frame_series *s, double scene_time, size_t i) {
  return scene_time + (double)(s->first + i) / rate(s);
}

abbe_result abbe_frame_series_scene(const abbe_frame_series *s, const abbe_scene *scene,
                                    const char *materials, const abbe_scene_input_changes *changes,
                                    size_t i, abbe_scene *out, abbe_error *error) {
  char move[ABBE_FRAME_SERIES_MOVES][3 * ABBE_FRAME_SERIES_MOVE_TEXT];
  abbe_scene_input_changes own = *changes;
  for (size_t m = 0; m < s->moves && s->count > 1; m++) {
    const char *first = s->move_first[m];
    const int key = (int)strcspn(first, "=");
    abbe_number_format(move[m], sizeof move[m], "%.*s={keyframes: [[%.17g, %s], [%.17g, %s]]}", key,
                       first, frame_series_time(s, scene->time, 0), first + key + 1,
                       frame_series_time(s, scene->time, s->count - 1), s->move_last[m]);
    put_change(&own, first, move[m]);
  }
  return abbe_scene_input_at(scene, materials, &own, frame_series_time(s, scene->time, i), out,
                             error);
}

abbe_result abbe_frame_series_name(const char *path, size_t number, char **out, abbe_error *error) {
  *out = NULL;
  if (path == NULL) return ABBE_OK;
  const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
  const size_t length = strlen(path), room = length + 32;
  const size_t stem = dot != NULL && (slash == NULL || dot > slash) ? (size_t)(dot - path) : length;
  *out = malloc(room);
  if (*out == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a frame's name");
  snprintf(*out, room, "%.*s-%04zu%s", (int)stem, path, number,
           abbe_screen_kind_of(path) != NULL ? ".png" : path + stem);
  return ABBE_OK;
}

abbe_result abbe_frame_series_record(abbe_frame_series *s, const abbe_scene *scene,
                                     abbe_error *error) {
  /* which frames there are is no matter, unless what moves goes by it; nor is the pace of turning
   */
  if (scene->camera.exposed && !s->stated)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the scene's 'exposure: auto' is of one picture, and frames would "
                          "flicker: give the stops that it takes for one, as --exposure STOPS");
  const char *without = s->around ? "fps" : s->moves == 0 ? "frames" : NULL;
  return frame_record_make(scene, without, &s->made, error);
}

void abbe_frame_series_free(abbe_frame_series *s) {
  free(s->made);
  s->made = NULL;
}

abbe_result abbe_frame_series_mark(const abbe_frame_series *s, size_t i, abbe_image *image,
                                   abbe_error *error) {
  ABBE_FREED char *text = frame_record_of(s->made, s->first + i);
  if (text == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a frame's record");
  return abbe_image_set_attribute(image, ABBE_PNG_TEXT, text, error);
}

/* Whether the file was made by this request; else that is reported. */
static bool is_own(const abbe_frame_series *s, const char *name, size_t number) {
  char *theirs = frame_record_read(name), *ours = frame_record_of(s->made, number);
  char text[500];
  const bool own = ours != NULL && frame_record_is_like(theirs, ours, text, sizeof text);
  if (ours != NULL && !own)
    fprintf(stderr, "note: %s was made with %s: it is drawn anew\n", name, text);
  free(theirs);
  free(ours);
  return own;
}

/* What is there is whole: files are renamed when they are. */
static bool is_there(const abbe_frame_series *s, const char *path, size_t number) {
  char *name = NULL;
  const bool there = abbe_frame_series_name(path, number, &name, NULL) == ABBE_OK &&
                     (name == NULL || (access(name, F_OK) == 0 && is_own(s, name, number)));
  free(name);
  return there;
}

bool abbe_frame_series_draws(const abbe_frame_series *s, size_t i, const char *exr,
                             const char *png) {
  if (!abbe_command_part_has(&s->part, i)) return false;
  return !s->resume || !is_there(s, exr, s->first + i) || !is_there(s, png, s->first + i);
}

/* Frames that carry records carry those of one request. */
static abbe_result check_records(const char *const *path, size_t count, abbe_error *error) {
  char *first = count > 0 ? frame_record_read(path[0]) : NULL, text[500];
  abbe_result result = ABBE_OK;
  for (size_t i = 1; first != NULL && i < count && result == ABBE_OK; i++) {
    char *own = frame_record_read(path[i]);
    if (own != NULL && !frame_record_is_like(own, first, text, sizeof text))
      result =
          abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                         "%s was made with %s, as %s was: draw what differs anew, with --resume",
                         path[i], text, path[0]);
    free(own);
  }
  free(first);
  return result;
}

abbe_result abbe_frame_series_merge(const abbe_frame_series *s, const char *path,
                                    abbe_error *error) {
  char **png = calloc(s->count, sizeof *png);
  abbe_result result =
      png == NULL ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the names of frames")
                  : ABBE_OK;
  for (size_t i = 0; i < s->count && result == ABBE_OK; i++)
    result = abbe_frame_series_name(path, s->first + i, &png[i], error);
  if (result == ABBE_OK) result = check_records((const char *const *)png, s->count, error);
  if (result == ABBE_OK)
    result = abbe_screen_file_move(path, (const char *const *)png, s->count, rate(s), error);
  for (size_t i = 0; png != NULL && i < s->count; i++) free(png[i]);
  free(png);
  return result;
}
