/* verbs.h: a command that has verbs, such as `abbe materials show`: help on all of them, and the
 * one that is asked for. */
#ifndef ABBE_CLI_BASE_VERBS_H
#define ABBE_CLI_BASE_VERBS_H

#include <stddef.h>

typedef struct abbe_verb {
  const char *name, *summary;
  int (*run)(int argc, char **argv); /* argv[0] is "abbe COMMAND VERB" */
} abbe_verb;

typedef struct abbe_verbs {
  const abbe_verb *verb;
  size_t count;
  const char *const *example; /* of arguments behind the command's name */
  size_t examples;
  const char *page; /* of the documentation, as a sentence's end */
} abbe_verbs;

/* Runs the verb that argv[1] names, or prints help; the program's exit code. argv[0] is "abbe
 * COMMAND". A word that is no verb is refused with the nearest one. */
int abbe_verbs_run(const abbe_verbs *verbs, int argc, char **argv);

#endif
