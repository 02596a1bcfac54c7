#include "cli/options/frame_record.h"

#include "base/file.h"
#include "cli/base/arguments.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/png_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Options that change no pixel of a frame, or say where files go. */
static const char *const neutral[] = {
    "quiet", "json", "part", "resume", "merge", "threads", "checkpoint-every"};

/* FNV-1a. */
static uint64_t hash(uint64_t h, const void *data, size_t size) {
  const unsigned char *p = data;
  for (size_t i = 0; i < size; i++) h = (h ^ p[i]) * 1099511628211u;
  return h;
}

/* Of a file's bytes, or of its name where there is none of it. */
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

abbe_result abbe_frame_record_make(const abbe_scene *scene, const char *without, char **out,
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

char *abbe_frame_record_of(const char *common, size_t number) {
  const size_t size = strlen(common) + 32;
  char *text = malloc(size);
  if (text != NULL) snprintf(text, size, "frame %zu\n%s", number, common);
  return text;
}

char *abbe_frame_record_read(const char *path) {
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

bool abbe_frame_record_is_like(const char *theirs, const char *ours, char *text, size_t size) {
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
