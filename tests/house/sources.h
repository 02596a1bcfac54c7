/* sources.h: the files of the house, for the tests that keep its rules: where each lies, how long
 * it is, and what it includes. */
#ifndef ABBE_TESTS_HOUSE_SOURCES_H
#define ABBE_TESTS_HOUSE_SOURCES_H

#include <stdbool.h>
#include <stddef.h>

enum { SOURCES_MAX_PATH = 1024 };

typedef struct source_include {
  char *name; /* as it is written */
  int line;
} source_include;

typedef struct source_file {
  char *path;     /* from the root */
  bool is_source; /* C, C++ or a shader; of others neither lines nor includes are read */
  size_t lines, include_count;
  source_include *include; /* [include_count], of the house's own files */
} source_file;

typedef struct sources {
  size_t count;
  source_file *file; /* [count], in the order of their paths */
} sources;

/* Every file but what is hidden, built or drawn. Fails the test where something cannot be read. */
void sources_read(sources *out);
void sources_free(sources *all);

/* The room that a path lies in: "gl" of "gl/plan/plan.c"; "" for none. */
const char *sources_room(const char *path);
/* The folder of a path, into out[SOURCES_MAX_PATH]; "" for none. Returns out. */
const char *sources_folder(const char *path, char *out);
/* Of "plan.c" it is "c". */
const char *sources_ending(const char *path);
/* Whether word is one of the words, which blanks part. */
bool sources_has_word(const char *words, const char *word);
/* The name between the quotes of an include line, or between <> where it begins with a room. */
bool sources_included_name(const char *line, char *out, size_t size);

#endif
