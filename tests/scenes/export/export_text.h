/* export_text.h: an exported scene as text, in a folder of the test's own, and numbers in it. */
#ifndef ABBE_TESTS_SCENES_EXPORT_EXPORT_TEXT_H
#define ABBE_TESTS_SCENES_EXPORT_EXPORT_TEXT_H

#include "tests/scenes/scene_text.h"

#include "scenes/export/scene_export.h"

#include <ctype.h>
#include <dirent.h>

static char folder[] = "/tmp/abbe-test-export-XXXXXX";

static inline void make_folder(void) {
  assert_non_null(mkdtemp(folder));
}

/* How many files were there. */
static inline int clear_folder(void) {
  int count = 0;
  DIR *dir = opendir(folder);
  for (struct dirent *e; (e = readdir(dir)) != NULL;) {
    if (e->d_name[0] == '.') continue;
    unlink(printed("%s/%s", folder, e->d_name));
    count++;
  }
  closedir(dir);
  return count;
}

static inline void drop_folder(void) {
  clear_folder();
  assert_false(rmdir(folder));
}

static abbe_scene_export_report report;

/* The text of what is written; the caller frees it, and the report. */
__attribute__((noinline)) static char *written(const abbe_scene *scene,
                                               abbe_scene_export_target target) {
  char *text = NULL;
  size_t size = 0;
  const char *path = printed("%s/it%s", folder, abbe_scene_export_ending(target));
  OK(abbe_scene_export_write(path, scene, target, &report, &error));
  OK(abbe_file_read(path, 1 << 28, &text, &size, &error));
  if (target == ABBE_SCENE_EXPORT_GLTF) {
    uint32_t length;
    assert_true(size > 20 && memcmp(text, "glTF\2\0\0\0", 8) == 0);
    memcpy(&length, text + 8, 4);
    assert_int_equal(length, size);
    memcpy(&length, text + 12, 4);
    memmove(text, text + 20, length);
    text[length] = '\0';
  }
  return text;
}

static inline void done(char *text) {
  free(text);
  abbe_scene_export_report_free(&report);
}

/* The next count numbers after the words, whatever stands between them. */
static inline void numbers_after(const char *text, const char *words, double *out, size_t count) {
  const char *at = strstr(text, words);
  if (at == NULL) fail_msg("no '%s'", words);
  at += strlen(words);
  for (size_t i = 0; i < count; i++) {
    while (*at != '\0' && !isdigit((unsigned char)*at) &&
           !(*at == '-' && isdigit((unsigned char)at[1])))
      at++;
    char *end;
    out[i] = strtod(at, &end);
    assert_true(end > at);
    at = end;
  }
}

#endif
