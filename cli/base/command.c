#include "cli/base/command.h"

#include "base/file.h"
#include "base/number.h"
#include "base/text.h"
#include "cli/base/arguments.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/picture_file.h"
#include "colorimetry/screen/screen_file.h"

#include <cjson/cJSON.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

const char *abbe_shipped_find(const char *path, char *text, size_t size) {
  static const char *const shares[] = {ABBE_SHARE_BESIDE, ABBE_SHARE};
  char own[PATH_MAX];
  if (path[0] == '/' || access(path, F_OK) == 0) return path;
  ssize_t length = readlink("/proc/self/exe", own, sizeof own - 1);
  own[length > 0 ? length : 0] = '\0';
  char *slash = strrchr(own, '/');
  if (slash != NULL) slash[1] = '\0';
  for (int i = slash == NULL; i < 2; i++) {
    int n = snprintf(text, size, "%s%s/%s", i == 0 ? own : "", shares[i], path);
    if (n > 0 && (size_t)n < size && access(text, F_OK) == 0) return text;
  }
  return path;
}

/* Prints "PROGRAM: sentence" to stderr (its general text where the sentence is empty); returns
 * the exit code that goes with the result. */
static int command_fail(const char *program, const abbe_error *error) {
  const char *text = error->text[0] ? error->text : abbe_result_text(error->code);
  fprintf(stderr, "%s: %s\n", program, text);
  return error->code == ABBE_TOLERANCE ? ABBE_EXIT_TOLERANCE : ABBE_EXIT_FAILED;
}

static _Noreturn void wrong_use(const char *program) {
  fprintf(stderr, "Try '%s --help'.\n", program);
  exit(ABBE_EXIT_USAGE);
}

double abbe_command_number(const char *program, const char *option, const char *text, double min,
                           double max) {
  char *end = NULL;
  double value = strtod(text, &end);
  if (end == text || *end != '\0' || !isfinite(value) || value < min || value > max) {
    fprintf(stderr, "%s: %s '%s' is not a number from %g to %g\n", program, option, text, min, max);
    wrong_use(program);
  }
  return value;
}

double abbe_command_length(const char *program, const char *option, const char *text, double min_m,
                           double max_m) {
  const char *end;
  double value = 0;
  bool read = abbe_number_read(text, &end, &value);
  if (read && *end == '\0')
    value /= 1e3;
  else
    read = abbe_number_read_length(text, &end, &value) && *end == '\0';
  if (!read || !(value >= min_m && value <= max_m)) {
    fprintf(
        stderr,
        "%s: %s '%s' is not a length from %gmm to %gm: write it with its unit, such as 6.5mm or "
        "0.2in (" ABBE_LENGTH_UNITS "); a bare number is of mm\n",
        program, option, text, 1e3 * min_m, max_m);
    wrong_use(program);
  }
  return value;
}

unsigned long abbe_command_count(const char *program, const char *option, const char *text,
                                 unsigned long min, unsigned long max) {
  char *end = NULL;
  errno = 0;
  unsigned long value = strtoul(text, &end, 10);
  if (end == text || *end != '\0' || text[0] == '-' || errno != 0 || value < min || value > max) {
    fprintf(stderr, "%s: %s '%s' is not a whole number from %lu to %lu\n", program, option, text,
            min, max);
    wrong_use(program);
  }
  return value;
}

void abbe_command_range(const char *program, const char *option, const char *text, double *from,
                        double *to) {
  char *middle = NULL, *end = NULL;
  *from = strtod(text, &middle);
  *to = *middle == ':' ? strtod(middle + 1, &end) : 0;
  if (middle == text || end == NULL || end == middle + 1 || *end != '\0' || !isfinite(*from) ||
      !isfinite(*to) || *from >= *to || *from <= 0) {
    fprintf(stderr,
            "%s: %s '%s' is not a range: two numbers above 0, the smaller first, such as %s\n",
            program, option, text, *from > 0 && *from < 100 ? "1.5:1.6" : "380:780");
    wrong_use(program);
  }
}

int abbe_command_choice(const char *program, const char *option, const char *text,
                        const char *const *names, int count) {
  for (int i = 0; i < count; i++)
    if (strcasecmp(text, names[i]) == 0) return i;
  const char *near = abbe_nearest_word(text, names, (size_t)count);
  fprintf(stderr, "%s: %s '%s' is not known; ", program, option, text);
  if (near != NULL) fprintf(stderr, "did you mean '%s'? ", near);
  fprintf(stderr, near != NULL ? "It is one of" : "it is one of");
  for (int i = 0; i < count; i++) fprintf(stderr, "%s %s", i > 0 ? "," : "", names[i]);
  fprintf(stderr, "\n");
  wrong_use(program);
}

void abbe_command_note_space(const char *name) {
  fprintf(stderr, "note: %s does not say its colour space; linear Rec.709 is taken\n", name);
}

void abbe_command_note_odd(const char *name, const struct abbe_image_odd *odd, const char *how) {
  if (odd->infinite > 0)
    fprintf(stderr, "note: %s: %zu pixels are infinite, %s\n", name, odd->infinite, how);
  if (odd->nan > 0)
    fprintf(stderr, "note: %s: %zu pixels are not a number (NaN)\n", name, odd->nan);
}

void abbe_command_note_part(const char *name, const char *part) {
  if (part[0] == '\0') return;
  fprintf(stderr, "note: %s: its part %s is read; FILE#NAME or FILE#NUMBER is another\n", name,
          part);
}

abbe_result abbe_command_read_picture(const char *path, struct abbe_image *out, abbe_error *error) {
  ABBE_TRY(abbe_picture_file_read(path, out, error));
  abbe_command_note_part(path, out->part);
  return ABBE_OK;
}

abbe_result abbe_command_open_picture(const char *path, struct abbe_exr_reader **file,
                                      struct abbe_image *out, abbe_error *error) {
  abbe_picture_file_kind kind;
  ABBE_TRY(abbe_picture_file_find_kind(path, &kind, error));
  if (kind == ABBE_PICTURE_FILE_RADIANCE || kind == ABBE_PICTURE_FILE_ENVI)
    return abbe_command_read_picture(path, out, error);
  ABBE_TRY(abbe_exr_open(path, file, error));
  ABBE_TRY(abbe_exr_read_header(*file, out, error));
  abbe_command_note_part(path, out->part);
  return ABBE_OK;
}

/* json as text that ends with a newline, always valid UTF-8; NULL for want of memory or where json
 * is NULL. cJSON copies the bytes of strings as they are, but for those below U+0020. */
static char *json_text(const struct cJSON *json) {
  char *raw = json == NULL ? NULL : abbe_json_text(json, true);
  const size_t length = raw == NULL ? 0 : strlen(raw), size = 3 * length + 2;
  char *text = raw == NULL ? NULL : malloc(size);
  if (text != NULL) strcpy(text + abbe_utf8_printable(raw, length, true, text, size), "\n");
  cJSON_free(raw);
  return text;
}

abbe_result abbe_command_write_json(struct cJSON *json, bool made, bool print, const char *path,
                                    abbe_error *error) {
  ABBE_FREED char *text = json_text(made ? json : NULL);
  cJSON_Delete(json);
  if (text == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for the JSON");
  if (print) fputs(text, stdout);
  return path == NULL ? ABBE_OK : abbe_file_write(path, text, strlen(text), error);
}

abbe_result abbe_command_print_json(struct cJSON *json, bool made, abbe_error *error) {
  return abbe_command_write_json(json, made, true, NULL, error);
}

static bool output_told;

/* A reader that has gone, as `head` goes, is no failure to report: all else is done and written, so
 * the program ends as it would by the signal that it holds back. */
static void leave_broken_pipe(void) {
  struct pollfd out = {.fd = STDOUT_FILENO, .events = POLLOUT};
  if (poll(&out, 1, 0) != 1 || !(out.revents & POLLERR)) return;
  signal(SIGPIPE, SIG_DFL);
  raise(SIGPIPE);
}

/* Why not everything reached stdout; NULL where it did. An earlier write leaves no reason behind.
 */
static const char *output_trouble(void) {
  int number = fflush(stdout) != 0 ? errno : 0;
  if (number == 0 && !ferror(stdout)) return NULL;
  leave_broken_pipe();
  return number != 0 ? strerror(number) : "an earlier write failed";
}

bool abbe_command_output_failed(void) {
  const char *why = output_told ? NULL : output_trouble();
  if (why != NULL) fprintf(stderr, "abbe: it could not be written to the output: %s\n", why);
  return why != NULL;
}

int abbe_command_end(const char *program, abbe_result result, abbe_error *error) {
  const char *why = result == ABBE_OK ? output_trouble() : NULL;
  if (why != NULL) {
    output_told = true;
    result =
        abbe_error_set(error, ABBE_IO, "the results could not be written to the output: %s", why);
  }
  return result == ABBE_OK ? ABBE_EXIT_DONE : command_fail(program, error);
}

const char *abbe_command_target(const char *program, const char *option, const char *text,
                                const char *ending) {
  static const char *const known[] = {".exr",  ".png",  ".jpg", ".jpeg", ".svg", ".tif",
                                      ".tiff", ".bmp",  ".gif", ".avif", ".hdr", ".pfm",
                                      ".webp", ".json", ".csv", ".yaml", ".pov"};
  static const char *const films[] = {".mp4", ".webm", ".mov", ".mkv", ".avi"};
  const char *dot = strrchr(text, '.');
  if (dot == NULL || strcasecmp(dot, ending) == 0) return text;
  for (size_t i = 0; i < sizeof films / sizeof *films; i++) {
    if (strcasecmp(dot, films[i]) != 0) continue;
    fprintf(stderr,
            "%s: %s '%s' is a film, which ffmpeg makes of numbered frames; a .webp or .gif "
            "moves by itself\n",
            program, option, text);
    exit(ABBE_EXIT_USAGE);
  }
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    if (strcasecmp(dot, known[i]) != 0) continue;
    bool looks = strcmp(ending, ".exr") == 0 && strcmp(option, "-o") == 0;
    fprintf(stderr,
            "%s: %s writes a %s file, and '%s' ends like another kind; name it '%.*s%s'%s\n",
            program, option, ending, text, (int)(dot - text), text, ending,
            looks ? ", or take --png for a picture to look at" : "");
    exit(ABBE_EXIT_USAGE);
  }
  return text;
}

void abbe_command_output(const char *program, const char *option, const char *text,
                         const char **exr, const char **png) {
  const abbe_screen_file_needs none = {0};
  abbe_error error = {0};
  if (abbe_screen_kind_of(text) == NULL && exr != NULL) {
    *exr = abbe_command_target(program, option, text, ".exr");
    return;
  }
  if (*png != NULL)
    fprintf(stderr, "%s: '%s' and '%s' are two pictures for a display; name one\n", program, *png,
            text);
  else if (abbe_screen_file_check(text, &none, &error) != ABBE_OK)
    fprintf(stderr, "%s: %s\n", program, error.text);
  else
    *png = abbe_screen_kind_of(text) != NULL ? text
                                             : abbe_command_target(program, option, text, ".png");
  if (*png != text) exit(ABBE_EXIT_USAGE);
}

void abbe_command_size(const char *program, const char *option, const char *text, size_t most,
                       size_t *width, size_t *height) {
  unsigned w = 0, h = 0;
  char rest;
  if (sscanf(text, "%6ux%6u%c", &w, &h, &rest) != 2 || w < 1 || h < 1 || w > most || h > most) {
    fprintf(stderr, "%s: %s '%s' is not a size such as 512x512 (at most %zux%zu)\n", program,
            option, text, most, most);
    exit(ABBE_EXIT_USAGE);
  }
  *width = w;
  *height = h;
}

void abbe_command_read_part(const char *program, const char *text, abbe_command_part *out) {
  unsigned part = 0, parts = 0;
  char rest;
  if (sscanf(text, "%7u/%7u%c", &part, &parts, &rest) != 2 || part >= parts ||
      parts > ABBE_COMMAND_MOST_PARTS) {
    fprintf(stderr,
            "%s: --part '%s' is no part: 0/8 is the first of eight, 7/8 the last (at most %d)\n",
            program, text, ABBE_COMMAND_MOST_PARTS);
    exit(ABBE_EXIT_USAGE);
  }
  *out = (abbe_command_part){part, parts};
}

bool abbe_command_part_has(const abbe_command_part *p, size_t piece) {
  return p->parts == 0 || piece % p->parts == p->part;
}

abbe_result abbe_command_check_targets(const char *const *paths, size_t count, abbe_error *error) {
  for (size_t i = 0; i < count; i++) {
    if (paths[i] == NULL) continue;
    abbe_file_writer writer = {0};
    abbe_result result = abbe_file_writer_open(&writer, paths[i], error);
    abbe_file_writer_discard(&writer);
    if (result != ABBE_OK) return result;
  }
  return ABBE_OK;
}

enum { MOST = 64 };

static void help(const abbe_verbs *v, FILE *out, const char *program) {
  fprintf(out, "usage: %s VERB [OPTION…] [NAME…]\n\n", program);
  for (size_t i = 0; i < v->count; i++)
    fprintf(out, "  %-9s %s\n", v->verb[i].name, v->verb[i].summary);
  fprintf(out, "\nExamples:\n");
  for (size_t i = 0; i < v->examples; i++) fprintf(out, "  %s %s\n", program, v->example[i]);
  fprintf(out, "\n'%s VERB --help' shows a verb's options, with examples; %s\n", program, v->page);
}

static bool is_help(const char *word) {
  return strcmp(word, "--help") == 0 || strcmp(word, "-?") == 0 || strcmp(word, "-h") == 0 ||
         strcmp(word, "help") == 0;
}

static int run(const abbe_verb *verb, bool for_help, int argc, char **argv) {
  static char name[64];
  snprintf(name, sizeof name, "%s %s", argv[0], verb->name);
  char *help_argv[] = {name, (char[]){"--help"}, NULL};
  if (for_help) return verb->run(2, help_argv);
  argv[1] = name;
  return verb->run(argc - 1, argv + 1);
}

int abbe_verbs_run(const abbe_verbs *v, int argc, char **argv) {
  const char *program = argv[0], *names[MOST];
  if (argc < 2) {
    fprintf(stderr, "%s: a verb is wanted\n", program);
    help(v, stderr, program);
    return ABBE_EXIT_USAGE;
  }
  if (is_help(argv[1]) && argc == 2) {
    help(v, stdout, program);
    return ABBE_EXIT_DONE;
  }
  const char *word = is_help(argv[1]) ? argv[2] : argv[1];
  const size_t count = v->count < MOST ? v->count : MOST;
  for (size_t i = 0; i < count; i++) {
    names[i] = v->verb[i].name;
    if (strcmp(word, names[i]) == 0) return run(&v->verb[i], word != argv[1], argc, argv);
  }
  const char *near = abbe_nearest_word(word, names, count);
  fprintf(stderr, "%s: there is no verb '%s'", program, word);
  if (near != NULL) fprintf(stderr, "; did you mean '%s'?", near);
  fprintf(stderr, "\nTry '%s --help'.\n", program);
  return ABBE_EXIT_USAGE;
}
