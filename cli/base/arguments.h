/* arguments.h: a command line, held to three rules before argp reads it.
 *
 * An option that is not there, or that lacks the last letter of one, is refused with the name that
 * was meant. A file that is named twice for one option is refused, for one would be ignored. And no
 * output may be an input or another output: not the same file by device and inode, nor, where there
 * is none yet, the same name in the same folder; FILE#PART that is read is FILE. "-" is the name of
 * no output. Internal to cli/.
 */
#ifndef ABBE_CLI_BASE_ARGUMENTS_H
#define ABBE_CLI_BASE_ARGUMENTS_H

#include <argp.h>
#include <stdbool.h>
#include <stddef.h>

/* Flags of an argp_option beside argp's own, which end at 0x10. A table that is edited in place is
 * read. */
enum {
  ABBE_ARGUMENT_ONCE = 0x100,    /* a second one would be ignored */
  ABBE_ARGUMENT_READS = 0x200,   /* names a file that is read, once */
  ABBE_ARGUMENT_WRITES = 0x400,  /* names a file that is written, once */
  ABBE_ARGUMENT_REPEATS = 0x800, /* names a file each time */
  ABBE_ARGUMENT_STREAMS = 0x1000 /* "-" is standard output, where it is written */
};

/* Where an option's value goes: into a field of the request, whose type is checked where the row is
 * written. */
struct abbe_parser;
typedef struct abbe_take {
  int kind;
  size_t at, to; /* of the fields in the request */
  double least, most;
  const char *text;
  const struct abbe_parser *child;
} abbe_take;
enum {
  ABBE_TAKES_TEXT = 1,
  ABBE_TAKES_ARGUMENT,
  ABBE_TAKES_FLAG,
  ABBE_TAKES_NUMBER,
  ABBE_TAKES_COUNT,
  ABBE_TAKES_RANGE,
  ABBE_TAKES_TARGET,
  ABBE_TAKES_OUTPUT,
  ABBE_TAKES_LENGTH,
  ABBE_TAKES_SIZE,
  ABBE_TAKES_CHILD,
  ABBE_TAKES_NEEDED
};

#define ABBE_TAKE_AT(request, field, type)                                                         \
  (offsetof(request, field) + 0 * sizeof(char[_Generic(((request *)0)->field, type : 1)]))
/* const char *: the value as it stands. */
#define ABBE_TAKE_TEXT(request, field)                                                             \
  { .kind = ABBE_TAKES_TEXT, .at = ABBE_TAKE_AT(request, field, const char *) }
/* bool: true. */
#define ABBE_TAKE_FLAG(request, field)                                                             \
  { .kind = ABBE_TAKES_FLAG, .at = ABBE_TAKE_AT(request, field, bool) }
/* double, and size_t: from least to most. */
#define ABBE_TAKE_NUMBER(request, field, least_, most_)                                            \
  {                                                                                                \
    .kind = ABBE_TAKES_NUMBER, .at = ABBE_TAKE_AT(request, field, double), .least = least_,        \
    .most = most_                                                                                  \
  }
#define ABBE_TAKE_COUNT(request, field, least_, most_)                                             \
  {                                                                                                \
    .kind = ABBE_TAKES_COUNT, .at = ABBE_TAKE_AT(request, field, size_t), .least = least_,         \
    .most = most_                                                                                  \
  }
/* double: a length with its unit, from least to most m. */
#define ABBE_TAKE_LENGTH(request, field, least_, most_)                                            \
  {                                                                                                \
    .kind = ABBE_TAKES_LENGTH, .at = ABBE_TAKE_AT(request, field, double), .least = least_,        \
    .most = most_                                                                                  \
  }
/* Two size_t, of a value such as 640x480, to most. */
#define ABBE_TAKE_SIZE(request, width, height, most_)                                              \
  {                                                                                                \
    .kind = ABBE_TAKES_SIZE, .at = ABBE_TAKE_AT(request, width, size_t),                           \
    .to = ABBE_TAKE_AT(request, height, size_t), .most = most_                                     \
  }
/* Two doubles, of a value such as 380:780. */
#define ABBE_TAKE_RANGE(request, from, to_)                                                        \
  {                                                                                                \
    .kind = ABBE_TAKES_RANGE, .at = ABBE_TAKE_AT(request, from, double),                           \
    .to = ABBE_TAKE_AT(request, to_, double)                                                       \
  }
/* const char *: a file to write, whose name ends so. */
#define ABBE_TAKE_TARGET(request, field, ending)                                                   \
  { .kind = ABBE_TAKES_TARGET, .at = ABBE_TAKE_AT(request, field, const char *), .text = ending }
/* const char *: the name of a picture, as abbe_command_output has it; of one for a display alone,
 * exr is png. */
#define ABBE_TAKE_OUTPUT(request, exr, png)                                                        \
  {                                                                                                \
    .kind = ABBE_TAKES_OUTPUT, .at = ABBE_TAKE_AT(request, exr, const char *),                     \
    .to = ABBE_TAKE_AT(request, png, const char *)                                                 \
  }

/* One row an option, as argp has it and with what it is for; a row without a name is what its take
 * says. Rows end with {0}. */
typedef struct abbe_option {
  const char *name;
  int key; /* a letter, or what the parser's own function knows the option by; else 0 */
  const char *arg;
  int flags;
  const char *doc;
  int group;
  abbe_take take;
} abbe_option;

/* For an option that the parser's own function takes by its key. */
#define ABBE_TAKE_BY_KEY                                                                           \
  { 0 }
/* Rows of no option. const char *: the one argument that there may be. */
#define ABBE_ARGUMENT(request, field)                                                              \
  {                                                                                                \
    .take = {.kind = ABBE_TAKES_ARGUMENT, .at = ABBE_TAKE_AT(request, field, const char *) }       \
  }
/* const char *: at the end of the line there must be one; else the sentence says what lacks. */
#define ABBE_NEEDED(request, field, sentence)                                                      \
  {                                                                                                \
    .take = {                                                                                      \
      .kind = ABBE_TAKES_NEEDED,                                                                   \
      .at = ABBE_TAKE_AT(request, field, const char *),                                            \
      .text = sentence                                                                             \
    }                                                                                              \
  }
/* The field is the request of another parser, whose options these are too: in their own groups, or
 * all in one, with a heading. */
#define ABBE_OPTIONS(request, parser, field, heading, group_)                                      \
  {                                                                                                \
    .doc = heading, .group = group_, .take = {                                                     \
      .kind = ABBE_TAKES_CHILD,                                                                    \
      .at = offsetof(request, field),                                                              \
      .child = parser                                                                              \
    }                                                                                              \
  }

/* A command's options, or some that several commands have. */
typedef struct abbe_parser {
  const abbe_option *options;
  /* For keys that no row takes, with the request as state->input; or NULL. */
  error_t (*parse)(int key, char *text, struct argp_state *state);
  const char *args_doc, *doc;
} abbe_parser;

/* argp_parse under the rules. The flags are those of what is no option: 0, or
 * ABBE_ARGUMENT_READS where they name files. Ends the program with ABBE_EXIT_USAGE where something
 * is refused, with ABBE_EXIT_FAILED where memory lacks. argv[0] is the command's name. */
void abbe_arguments_parse(const abbe_parser *parser, unsigned flags, int argc, char **argv,
                          void *request);

/* Holds a file to the third rule that no option names: `what` says what it is. Ends the program
 * likewise. A path that is NULL or empty is none. */
void abbe_arguments_add(const char *program, unsigned flags, const char *what, const char *path);

/* An option as it was given: its whole name and value, "" for none. */
enum { ABBE_ARGUMENT_MOST = 320 };
typedef struct abbe_argument {
  const char *name, *value;
  unsigned flags;
} abbe_argument;
/* In the order in which they were given, at most ABBE_ARGUMENT_MOST; NULL behind the last. */
const abbe_argument *abbe_arguments_given(size_t index);

/* For the parser of a command about one file, what is no option: takes ARGP_KEY_ARG, and
 * ARGP_KEY_END, at which there must be one; ARGP_ERR_UNKNOWN for other keys. */
error_t abbe_arguments_one_file(int key, char *text, const char **path, struct argp_state *state);

#endif
