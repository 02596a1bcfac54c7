#include "cli/base/arguments.h"

#include "base/text.h"
#include "cli/base/command.h"
#include "colorimetry/image/exr.h"
#include "spectral/materials/material_table.h"

#include <assert.h>
#include <libgen.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static _Noreturn void no_memory(const char *program) {
  fprintf(stderr, "%s: no memory to read the arguments\n", program);
  exit(ABBE_EXIT_FAILED);
}

static _Noreturn void wrong_use(const char *program) {
  fprintf(stderr, "Try '%s --help'.\n", program);
  exit(ABBE_EXIT_USAGE);
}

/* ---- files ---- */

typedef struct named_file {
  unsigned flags;
  const char *what;
  char *path;
} named_file;

static struct {
  named_file *file;
  size_t count, room;
} named;

/* What identifies a file: itself, or its folder and its name where there is none. */
typedef struct identity {
  bool known, exists;
  dev_t device;
  ino_t inode;
  char *name;
} identity;

static identity identify(const char *path, char *room) {
  struct stat s;
  if (stat(path, &s) == 0) return (identity){true, true, s.st_dev, s.st_ino, NULL};
  size_t length = strlen(path) + 1;
  memcpy(room, path, length);
  memcpy(room + length, path, length);
  if (stat(dirname(room), &s) != 0) return (identity){0};
  return (identity){true, false, s.st_dev, s.st_ino, basename(room + length)};
}

static bool is_same_file(const char *a, const char *b, const char *program) {
  char *room[2] = {malloc(2 * strlen(a) + 2), malloc(2 * strlen(b) + 2)};
  if (room[0] == NULL || room[1] == NULL) no_memory(program);
  identity x = identify(a, room[0]), y = identify(b, room[1]);
  bool same = x.known && y.known && x.exists == y.exists && x.device == y.device &&
              x.inode == y.inode && (x.exists || strcmp(x.name, y.name) == 0);
  free(room[0]);
  free(room[1]);
  return same;
}

static _Noreturn void refuse_overwriting(const char *program, const named_file *a,
                                         const named_file *b) {
  const named_file *out = a->flags & ABBE_ARGUMENT_WRITES ? a : b, *other = out == a ? b : a;
  if (other->flags & ABBE_ARGUMENT_WRITES)
    fprintf(stderr, "%s: %s '%s' and %s '%s' are one file; give each its own\n", program,
            other->what, other->path, out->what, out->path);
  else
    fprintf(stderr, "%s: %s '%s' would be written over %s '%s', which is read; name another file\n",
            program, out->what, out->path, other->what, other->path);
  wrong_use(program);
}

void abbe_arguments_add(const char *program, unsigned flags, const char *what, const char *path) {
  size_t size;
  if (path == NULL || path[0] == '\0') return;
  if (!(flags & ABBE_ARGUMENT_WRITES) && abbe_material_table_shipped(path, &size) != NULL) return;
  if (named.count == named.room) {
    size_t room = named.room == 0 ? 16 : 2 * named.room;
    named_file *file = realloc(named.file, room * sizeof *file);
    if (file == NULL) no_memory(program);
    named.file = file;
    named.room = room;
  }
  named_file *own = &named.file[named.count];
  const bool written = flags & ABBE_ARGUMENT_WRITES;
  *own =
      (named_file){flags, what, written ? strdup(path) : strndup(path, abbe_exr_file_length(path))};
  if (own->path == NULL) no_memory(program);
  for (size_t i = 0; i < named.count; i++)
    if ((written || (named.file[i].flags & ABBE_ARGUMENT_WRITES)) &&
        is_same_file(own->path, named.file[i].path, program))
      refuse_overwriting(program, &named.file[i], own);
  named.count++;
}

/* ---- options ---- */

/* Limit for the command and the parts that it is made of. */
enum { MAX_OPTIONS = 160 };
typedef struct option_list {
  const struct argp_option *option[MAX_OPTIONS];
  const char *value[MAX_OPTIONS]; /* as given so far */
  size_t count;
} option_list;

static void collect(const struct argp *argp, option_list *list) {
  for (const struct argp_option *o = argp->options; o != NULL && (o->name || o->key || o->doc); o++)
    if (o->name != NULL && list->count < MAX_OPTIONS) list->option[list->count++] = o;
  for (const struct argp_child *c = argp->children; c != NULL && c->argp != NULL; c++)
    collect(c->argp, list);
}

static bool takes_next(const struct argp_option *o) {
  return o->arg != NULL && !(o->flags & OPTION_ARG_OPTIONAL);
}

/* The option of that name, or the one that it abbreviates; NULL where argp is to say that it may be
 * several. A name that is none ends the program. */
static size_t find_long(const char *program, const option_list *list, const char *word) {
  const char *names[MAX_OPTIONS];
  size_t length = strcspn(word, "="), found = list->count, begins = 0;
  for (size_t i = 0; i < list->count; i++) {
    names[i] = list->option[i]->name;
    if (strncmp(names[i], word, length) != 0) continue;
    if (names[i][length] == '\0') return i;
    begins++;
    found = i;
  }
  if (begins > 1) return list->count;
  if (begins == 1 && names[found][length + 1] != '\0') return found;
  char own[128];
  snprintf(own, sizeof own, "%.*s", (int)length, word);
  const char *near = begins == 1 ? names[found] : abbe_nearest_word(own, names, list->count);
  fprintf(stderr, "%s: there is no option '--%s'", program, own);
  if (near != NULL) fprintf(stderr, "; did you mean '--%s'?", near);
  fprintf(stderr, "\n");
  wrong_use(program);
}

/* Where "-" is meant to be standard output, it is no file. */
static bool is_stream(const char *program, unsigned flags, const char *called, const char *value) {
  if (!(flags & ABBE_ARGUMENT_WRITES) || strcmp(value, "-") != 0) return false;
  if (flags & ABBE_ARGUMENT_STREAMS) return true;
  fprintf(stderr, "%s: %s goes into a file, not to standard output; ./- is a file of that name\n",
          program, called);
  wrong_use(program);
}

static struct {
  abbe_argument argument[ABBE_ARGUMENT_MOST];
  size_t count;
} given;

const abbe_argument *abbe_arguments_given(size_t index) {
  return index < given.count ? &given.argument[index] : NULL;
}

static void note_given(const struct argp_option *option, const char *value) {
  if (given.count < ABBE_ARGUMENT_MOST)
    given.argument[given.count++] =
        (abbe_argument){option->name, value != NULL ? value : "", (unsigned)option->flags};
}

static void take_value(const char *program, option_list *list, size_t i, const char *value) {
  note_given(list->option[i], value);
  static const unsigned once = ABBE_ARGUMENT_ONCE | ABBE_ARGUMENT_READS | ABBE_ARGUMENT_WRITES;
  static char called[MAX_OPTIONS][40];
  const unsigned flags = (unsigned)list->option[i]->flags;
  if (value == NULL || !(flags & once)) return;
  snprintf(called[i], sizeof called[i], "--%s", list->option[i]->name);
  if (list->value[i] != NULL && !(flags & ABBE_ARGUMENT_REPEATS)) {
    fprintf(stderr, "%s: %s is given twice, '%s' and '%s'; only one can be taken\n", program,
            called[i], list->value[i], value);
    wrong_use(program);
  }
  list->value[i] = value;
  if ((flags & (ABBE_ARGUMENT_READS | ABBE_ARGUMENT_WRITES)) &&
      !is_stream(program, flags, called[i], value))
    abbe_arguments_add(program, flags, called[i], value);
}

/* Letters behind one dash; true where the last one's value is the next word. */
static bool take_letters(const char *program, option_list *list, const char *letters,
                         const char *next) {
  for (; *letters != '\0'; letters++) {
    size_t i = 0;
    while (i < list->count && list->option[i]->key != *letters) i++;
    if (i < list->count && list->option[i]->arg == NULL) note_given(list->option[i], NULL);
    if (i == list->count || list->option[i]->arg == NULL) continue;
    bool own = letters[1] != '\0', optional = !takes_next(list->option[i]);
    take_value(program, list, i, own ? letters + 1 : optional ? NULL : next);
    return !own && !optional;
  }
  return false;
}

/* One word that begins with a dash; true where the next one is its value. */
static bool take_option(const char *program, option_list *list, const char *word,
                        const char *next) {
  if (word[1] != '-') return take_letters(program, list, word + 1, next);
  size_t i = find_long(program, list, word + 2);
  if (i == list->count) return false;
  const char *equals = strchr(word, '=');
  bool separate = equals == NULL && takes_next(list->option[i]);
  take_value(program, list, i, equals != NULL ? equals + 1 : separate ? next : NULL);
  return separate;
}

/* A shell puts the user's folder for the ~ that begins a word, and leaves "--out=~/a" as it is. */
static char *expand_home(const char *program, char *word) {
  static char *kept[MAX_OPTIONS]; /* to the program's end */
  static size_t count;
  const char *at = strstr(word, "=~/"), *home = getenv("HOME");
  if (at == NULL || home == NULL || count == MAX_OPTIONS) return word;
  const size_t size = strlen(word) + strlen(home) + 1;
  char *whole = malloc(size);
  if (whole == NULL) no_memory(program);
  snprintf(whole, size, "%.*s=%s%s", (int)(at - word), word, home, at + 2);
  return kept[count++] = whole;
}

/* ---- argp, made of rows ---- */

enum { MAX_PARSERS = 12, MAX_CHILDREN = 8, OWN_KEYS = 0x8000 };

/* A parser and the request that it fills, as argp has them: each parser's input is its own one. */
typedef struct bound {
  const abbe_parser *parser;
  char *request;
  struct argp argp;
  struct argp_option option[MAX_OPTIONS];
  struct argp_child child[MAX_CHILDREN];
  struct bound *inner[MAX_CHILDREN];
} bound;

static bool is_last(const abbe_option *o) {
  return o->name == NULL && o->doc == NULL && o->key == 0 && o->take.kind == 0;
}

static int key_of(const bound *b, const abbe_option *o) {
  return o->key != 0 || o->name == NULL ? o->key : OWN_KEYS + (int)(o - b->parser->options);
}

static void take_row(const abbe_option *o, char *request, char *text, struct argp_state *state) {
  const abbe_take *t = &o->take;
  char called[64];
  snprintf(called, sizeof called, o->key > 0 && o->key < 128 ? "-%c" : "--", o->key);
  if (called[1] == '-') snprintf(called, sizeof called, "--%s", o->name);
  const char **word = (const char **)(request + t->at);
  double *number = (double *)(request + t->at), *end = (double *)(request + t->to);
  switch (t->kind) {
  case ABBE_TAKES_FLAG:
    *(bool *)word = true;
    break;
  case ABBE_TAKES_NUMBER:
    *number = abbe_command_number(state->name, called, text, t->least, t->most);
    break;
  case ABBE_TAKES_COUNT:
    *(size_t *)word = abbe_command_count(state->name, called, text, (unsigned long)t->least,
                                         (unsigned long)t->most);
    break;
  case ABBE_TAKES_LENGTH:
    *number = abbe_command_length(state->name, called, text, t->least, t->most);
    break;
  case ABBE_TAKES_SIZE:
    abbe_command_size(state->name, called, text, (unsigned long)t->most, (size_t *)word,
                      (size_t *)(request + t->to));
    break;
  case ABBE_TAKES_RANGE:
    abbe_command_range(state->name, called, text, number, end);
    break;
  case ABBE_TAKES_TARGET:
    *word = abbe_command_target(state->name, called, text, t->text);
    break;
  case ABBE_TAKES_OUTPUT:
    abbe_command_output(state->name, called, text, t->at != t->to ? word : NULL,
                        (const char **)(request + t->to));
    break;
  default:
    if (t->kind == ABBE_TAKES_ARGUMENT && *word != NULL)
      argp_error(state, "'%s' is one argument too many", text);
    *word = text;
  }
}

static error_t parse_bound(int key, char *text, struct argp_state *state) {
  bound *b = state->input;
  for (size_t i = 0; key == ARGP_KEY_INIT && b->inner[i] != NULL; i++)
    state->child_inputs[i] = b->inner[i];
  for (const abbe_option *o = b->parser->options; !is_last(o); o++) {
    const abbe_take *t = &o->take;
    if (t->kind == ABBE_TAKES_NEEDED && key == ARGP_KEY_END &&
        *(const char **)(b->request + t->at) == NULL)
      argp_error(state, "%s", t->text);
    const bool own = o->name != NULL && key_of(b, o) == key;
    if (t->kind == 0 || !(own || (t->kind == ABBE_TAKES_ARGUMENT && key == ARGP_KEY_ARG))) continue;
    take_row(o, b->request, text, state);
    return 0;
  }
  if (b->parser->parse == NULL) return ARGP_ERR_UNKNOWN;
  state->input = b->request;
  const error_t result = b->parser->parse(key, text, state);
  state->input = b;
  return result;
}

static bound *bind_parser(const abbe_parser *parser, char *request) {
  static bound bounds[MAX_PARSERS];
  static size_t count;
  assert(count < MAX_PARSERS);
  bound *b = &bounds[count++];
  size_t options = 0, children = 0;
  *b = (bound){.parser = parser, .request = request};
  for (const abbe_option *o = parser->options; !is_last(o); o++) {
    if (o->take.kind == ABBE_TAKES_CHILD) {
      assert(children + 1 < MAX_CHILDREN);
      b->inner[children] = bind_parser(o->take.child, request + o->take.at);
      b->child[children] = (struct argp_child){&b->inner[children]->argp, 0, o->doc, o->group};
      children++;
    } else if (o->name != NULL || o->doc != NULL) {
      assert(options + 1 < MAX_OPTIONS);
      b->option[options++] =
          (struct argp_option){o->name, key_of(b, o), o->arg, o->flags, o->doc, o->group};
    }
  }
  b->argp =
      (struct argp){b->option, parse_bound, parser->args_doc, parser->doc, b->child, NULL, NULL};
  return b;
}

void abbe_arguments_parse(const abbe_parser *parser, unsigned flags, int argc, char **argv,
                          void *request) {
  static const struct argp_option own[] = {{"help", '?', NULL, 0, NULL, 0},
                                           {"usage", -1, NULL, 0, NULL, 0},
                                           {"version", 'V', NULL, 0, NULL, 0},
                                           {0}};
  static const struct argp always = {.options = own};
  option_list list = {.count = 0};
  bool only_arguments = false;
  bound *b = bind_parser(parser, request);
  collect(&b->argp, &list);
  collect(&always, &list);
  abbe_arguments_add(argv[0], ABBE_ARGUMENT_READS, "$OCIO", getenv("OCIO"));
  for (int i = 1; i < argc; i++) argv[i] = expand_home(argv[0], argv[i]);
  for (int i = 1; i < argc; i++) {
    const char *word = argv[i];
    if (!only_arguments && strcmp(word, "--") == 0)
      only_arguments = true;
    else if (only_arguments || word[0] != '-' || word[1] == '\0')
      abbe_arguments_add(argv[0], flags, "the argument", flags != 0 ? word : NULL);
    else
      i += take_option(argv[0], &list, word, argv[i + 1]);
  }
  if (argp_parse(&b->argp, argc, argv, 0, NULL, b) != 0) no_memory(argv[0]);
}

error_t abbe_arguments_one_file(int key, char *text, const char **path, struct argp_state *state) {
  if (key != ARGP_KEY_ARG && key != ARGP_KEY_END) return ARGP_ERR_UNKNOWN;
  if (key == ARGP_KEY_ARG && *path != NULL)
    argp_error(state, "'%s' is one argument too many", text);
  if (key == ARGP_KEY_ARG) *path = text;
  if (*path == NULL) argp_error(state, "which file?");
  return 0;
}
