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

/* argp_parse under the rules. The flags are those of what is no option: 0, or
 * ABBE_ARGUMENT_READS where they name files. Ends the program with ABBE_EXIT_USAGE where something
 * is refused, with ABBE_EXIT_FAILED where memory lacks. argv[0] is the command's name. */
void abbe_arguments_parse(const struct argp *argp, unsigned flags, int argc, char **argv,
                          void *input);

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

/* Options whose value goes into one field of the request: a row each, in place of a case of the
 * parser, and {0} at the end. The types of the fields are checked where the row is written. */
typedef struct abbe_take {
  int kind, key;
  size_t at, to; /* of the fields in the request */
  double least, most;
  const char *ending;
} abbe_take;
enum {
  ABBE_TAKES_TEXT = 1,
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
#define ABBE_TAKE_TEXT(request, key, field)                                                        \
  { ABBE_TAKES_TEXT, key, ABBE_TAKE_AT(request, field, const char *), 0, 0, 0, NULL }
/* The same of what is no option, of which there may be one. */
#define ABBE_TAKE_ARGUMENT(request, field) ABBE_TAKE_TEXT(request, ARGP_KEY_ARG, field)
/* bool: true. */
#define ABBE_TAKE_FLAG(request, key, field)                                                        \
  { ABBE_TAKES_FLAG, key, ABBE_TAKE_AT(request, field, bool), 0, 0, 0, NULL }
/* double, and size_t: from least to most. */
#define ABBE_TAKE_NUMBER(request, key, field, least, most)                                         \
  { ABBE_TAKES_NUMBER, key, ABBE_TAKE_AT(request, field, double), 0, least, most, NULL }
#define ABBE_TAKE_COUNT(request, key, field, least, most)                                          \
  { ABBE_TAKES_COUNT, key, ABBE_TAKE_AT(request, field, size_t), 0, least, most, NULL }
/* double: a length with its unit, from least to most m. */
#define ABBE_TAKE_LENGTH(request, key, field, least, most)                                         \
  { ABBE_TAKES_LENGTH, key, ABBE_TAKE_AT(request, field, double), 0, least, most, NULL }
/* Two size_t, of a value such as 640x480, to most. */
#define ABBE_TAKE_SIZE(request, key, width, height, most)                                          \
  {                                                                                                \
    ABBE_TAKES_SIZE, key, ABBE_TAKE_AT(request, width, size_t),                                    \
        ABBE_TAKE_AT(request, height, size_t), 0, most, NULL                                       \
  }
/* The field is what the index-th child of the parser fills. */
#define ABBE_TAKE_CHILD(request, index, field)                                                     \
  { ABBE_TAKES_CHILD, ARGP_KEY_INIT, offsetof(request, field), 0, index, 0, NULL }
/* const char *: at the end of the line there must be one; else the sentence says what lacks. Other
 * conditions of the end may follow: its key is not taken. */
#define ABBE_TAKE_NEEDED(request, field, sentence)                                                 \
  { ABBE_TAKES_NEEDED, ARGP_KEY_END, ABBE_TAKE_AT(request, field, const char *), 0, 0, 0, sentence }
/* Two doubles, of a value such as 380:780. */
#define ABBE_TAKE_RANGE(request, key, from, to)                                                    \
  {                                                                                                \
    ABBE_TAKES_RANGE, key, ABBE_TAKE_AT(request, from, double), ABBE_TAKE_AT(request, to, double), \
        0, 0, NULL                                                                                 \
  }
/* const char *: a file to write, whose name ends so. */
#define ABBE_TAKE_TARGET(request, key, field, ending)                                              \
  { ABBE_TAKES_TARGET, key, ABBE_TAKE_AT(request, field, const char *), 0, 0, 0, ending }
/* const char *: the name of a picture, as abbe_command_output has it; of one for a display alone,
 * exr is png. */
#define ABBE_TAKE_OUTPUT(request, key, exr, png)                                                   \
  {                                                                                                \
    ABBE_TAKES_OUTPUT, key, ABBE_TAKE_AT(request, exr, const char *),                              \
        ABBE_TAKE_AT(request, png, const char *), 0, 0, NULL                                       \
  }
/* Puts the value of the option into its field of state->input; false where no row has the key. A
 * value that is wrong ends the program with ABBE_EXIT_USAGE. */
bool abbe_take_option(const abbe_take *takes, int key, char *text, struct argp_state *state);

#endif
