#include "cli/pages/pages.h"

#include "base/file.h"
#include "cli/base/command.h"

#include <ctype.h>
#include <limits.h>
#include <stdbool.h>
#include <string.h>

/* A manual page in roff, from a command's option table. */

/* ---- roff ---- */

/* What roff would obey, as what it shows. */
static void put(FILE *out, const char *text, size_t length) {
  for (size_t i = 0; i < length; i++) {
    const char c = text[i];
    if (i == 0 && (c == '.' || c == '\'')) fputs("\\&", out);
    if (c == '\\')
      fputs("\\e", out);
    else if (c == '-')
      fputs("\\-", out);
    else if (c == '~' || c == '^' || c == '`')
      fprintf(out, "\\(%s", c == '~' ? "ti" : c == '^' ? "ha" : "ga");
    else
      putc(c, out);
    /* A list may break behind its commas. */
    if (c == ',' && i + 1 < length && text[i + 1] != ' ') fputs("\\:", out);
  }
}

static void put_all(FILE *out, const char *text) {
  put(out, text, strlen(text));
}

static void put_upper(FILE *out, const char *text) {
  for (; *text != '\0'; text++)
    if (*text == '-' || *text == ' ')
      fputs("\\-", out);
    else
      putc(toupper((unsigned char)*text), out);
}

/* "abbe gem report" as the page's name, abbe-gem-report. */
static void put_name(FILE *out, const char *program) {
  for (; *program != '\0'; program++)
    if (*program == ' ' || *program == '-')
      fputs("\\-", out);
    else
      putc(*program, out);
}

static void begin(FILE *out, const char *program, const char *summary, const char *version) {
  fputs(".TH ", out);
  put_upper(out, program);
  fprintf(out, " 1 \"\" \"abbe %s\" \"Abbe\"\n.ad l\n.SH NAME\n", version);
  put_name(out, program);
  fputs(" \\- ", out);
  put_all(out, summary);
  putc('\n', out);
}

static void end(FILE *out, const char *see) {
  fputs(".SH EXIT STATUS\n0 done, 1 failed, 2 used wrongly, 3 out of tolerance.\n.SH SEE ALSO\n",
        out);
  fprintf(out, ".BR %s (1)\n", see);
}

/* ---- texts ---- */

/* One line of a text: those that are indented are shown as they are. */
static void put_line(FILE *out, const char *line, size_t length, bool *example) {
  const bool shown = length > 2 && strncmp(line, "  ", 2) == 0;
  const bool heading = length == strlen("Examples:") && strncmp(line, "Examples:", length) == 0;
  if (*example && !shown) fputs(".EE\n.RE\n", out);
  if (!*example && shown) fputs(".RS\n.EX\n", out);
  *example = shown;
  if (length == 0)
    fputs(".PP\n", out);
  else if (heading)
    fputs(".SH EXAMPLES\n", out);
  else {
    put(out, line, length);
    putc('\n', out);
  }
}

static bool is_blank(const char *text, size_t length) {
  for (size_t i = 0; i < length; i++)
    if (!isspace((unsigned char)text[i])) return false;
  return true;
}

static void put_text(FILE *out, const char *text, size_t length) {
  bool example = false, skip = true;
  for (size_t at = 0; at < length;) {
    const char *stop = memchr(text + at, '\n', length - at);
    const size_t count = stop != NULL ? (size_t)(stop - (text + at)) : length - at;
    /* no empty paragraphs at the ends or before a heading */
    const char *after = text + at + count + 1;
    const bool drop = count == 0 && (skip || at + 1 >= length || is_blank(after, length - at - 1) ||
                                     strncmp(after, "Examples:", strlen("Examples:")) == 0);
    if (!drop) put_line(out, text + at, count, &example);
    skip = count == 0 || strncmp(text + at, "Examples:", strlen("Examples:")) == 0;
    at += count + 1;
  }
  if (example) fputs(".EE\n.RE\n", out);
}

/* ---- options ---- */

static void put_argument(FILE *out, const struct argp_option *o, const char *between) {
  if (o->arg == NULL) return;
  const bool optional = o->flags & OPTION_ARG_OPTIONAL;
  fprintf(out, "%s%s\\fI", optional ? "[" : "", between);
  put_all(out, o->arg);
  fprintf(out, "\\fR%s", optional ? "]" : "");
}

static void put_option(FILE *out, const struct argp_option *o) {
  const bool is_short = o->key > ' ' && o->key < 0x7f;
  fputs(".TP\n", out);
  if (is_short) fprintf(out, "\\fB\\-%c\\fR", o->key);
  if (is_short && o->name == NULL) put_argument(out, o, " ");
  if (o->name != NULL) {
    fprintf(out, "%s\\fB\\-\\-", is_short ? ", " : "");
    put_all(out, o->name);
    fputs("\\fR", out);
    put_argument(out, o, "=");
  }
  putc('\n', out);
  if (o->doc != NULL) put_text(out, o->doc, strlen(o->doc));
}

static void put_options(FILE *out, const struct argp *argp) {
  for (const struct argp_option *o = argp->options; o && (o->name || o->key || o->doc); o++)
    if ((o->name != NULL || o->key != 0) && !(o->flags & (OPTION_HIDDEN | OPTION_DOC)))
      put_option(out, o);
  for (const struct argp_child *c = argp->children; c != NULL && c->argp != NULL; c++) {
    if (c->header != NULL && c->header[0] != '\0') {
      fputs(".SS ", out);
      put_all(out, c->header);
      putc('\n', out);
    }
    put_options(out, c->argp);
  }
}

static void put_synopsis(FILE *out, const char *program, const char *arguments) {
  const char *rest = arguments == NULL ? "" : arguments;
  fputs(".SH SYNOPSIS\n", out);
  for (bool first = true; first || *rest != '\0'; first = false) {
    const size_t length = strcspn(rest, "\n");
    fprintf(out, "%s.B %s\n[\\fIOPTION\\fR…] ", first ? "" : ".br\n", program);
    put(out, rest, length);
    putc('\n', out);
    rest += length + (rest[length] == '\n');
  }
}

static void put_verbs(FILE *out, const char *program, const abbe_verbs *verbs) {
  fprintf(out, ".SH SYNOPSIS\n.B %s\n\\fIVERB\\fR [\\fIOPTION\\fR…] [\\fINAME\\fR…]\n", program);
  fputs(".SH VERBS\n", out);
  for (size_t i = 0; i < verbs->count; i++) {
    fputs(".TP\n\\fB", out);
    put_name(out, program);
    fprintf(out, "\\-%s\\fR(1)\n", verbs->verb[i].name);
    put_all(out, verbs->verb[i].summary);
    putc('\n', out);
  }
  fputs(".SH EXAMPLES\n.RS\n.EX\n", out);
  for (size_t i = 0; i < verbs->examples; i++) {
    fprintf(out, "%s ", program);
    put_all(out, verbs->example[i]);
    putc('\n', out);
  }
  fputs(".EE\n.RE\n", out);
}

/* The page of a command or verb; of a command with verbs, the list of them. version: "0.1.0". */
static void man_page_write(FILE *out, const abbe_option_table *table, const char *version) {
  begin(out, table->program, table->summary, version);
  if (table->verbs != NULL) {
    put_verbs(out, table->program, table->verbs);
    end(out, "abbe");
    return;
  }
  const char *doc = table->argp->doc == NULL ? "" : table->argp->doc;
  const char *after = strchr(doc, '\v');
  put_synopsis(out, table->program, table->argp->args_doc);
  fputs(".SH DESCRIPTION\n", out);
  put_text(out, doc, after != NULL ? (size_t)(after - doc) : strlen(doc));
  fputs(".SH OPTIONS\n", out);
  put_options(out, table->argp);
  fputs(".TP\n\\fB\\-?\\fR, \\fB\\-\\-help\\fR\nthe options, with examples\n", out);
  fputs(".TP\n\\fB\\-\\-usage\\fR\nthe options in short\n", out);
  fputs(".TP\n\\fB\\-V\\fR, \\fB\\-\\-version\\fR\nwhich release this is\n", out);
  if (after != NULL && strncmp(after + 1, "Examples:", strlen("Examples:")) != 0)
    fputs(".SH NOTES\n", out);
  if (after != NULL) put_text(out, after + 1, strlen(after + 1));
  end(out, "abbe");
}

/* ---- the program's page ---- */

/* The program's own page, in parts: what comes before the commands, one of them, and the rest. */
static void man_page_begin(FILE *out, const char *version) {
  begin(out, "abbe", "spectral dispersion caustics", version);
  fputs(".SH SYNOPSIS\n.B abbe\n\\fICOMMAND\\fR [\\fIOPTION\\fR…] [\\fIFILE\\fR…]\n", out);
  fputs(".SH DESCRIPTION\nAbbe renders what light does in gems, prisms and glass, traces a "
        "reference with standard errors, compares the two, and keeps tables of materials and "
        "designs of gems.\n.SH COMMANDS\n",
        out);
}

static void man_page_command(FILE *out, const char *name, const char *summary) {
  fprintf(out, ".TP\n\\fBabbe\\-%s\\fR(1)\n", name);
  put_all(out, summary);
  putc('\n', out);
}

static void man_page_end(FILE *out) {
  fputs(".SH EXAMPLES\n", out);
  put_text(out, ABBE_FIRST_STEPS, strlen(ABBE_FIRST_STEPS));
#define SENTENCE(name, summary)                                                                    \
  "'abbe " #name "' " summary "; 'abbe " #name " --help' has its options.\n"
  static const char python[] = ABBE_PYTHON_COMMANDS(SENTENCE);
#undef SENTENCE
  fputs("Scenes that are not where they are said to be are taken from those that came with the "
        "program.\n"
        ".SH IN PYTHON\n",
        out);
  put_text(out, python, strlen(python));
  end(out, "abbe-render");
}

enum { MOST = 64 };

typedef struct work {
  const char *folder, *version;
  const abbe_pages_command *command;
  size_t count;
  abbe_result result;
  abbe_error *error;
} work;

static void visit_all(const work *w, abbe_option_table_take take, void *user) {
  for (size_t i = 0; i < w->count; i++) {
    char program[64];
    snprintf(program, sizeof program, "abbe %s", w->command[i].name);
    abbe_option_tables_visit(program, w->command[i].summary, w->command[i].run, take, user);
  }
}

static abbe_result open_page(const work *w, const char *name, abbe_file_writer *file) {
  char path[PATH_MAX];
  snprintf(path, sizeof path, "%s/%s", w->folder, name);
  return abbe_file_writer_open(file, path, w->error);
}

/* ---- manual pages ---- */

static void write_page(void *user, const abbe_option_table *table) {
  work *w = user;
  char name[80];
  abbe_file_writer file = {0};
  if (w->result != ABBE_OK) return;
  snprintf(name, sizeof name, "%s.1", table->program);
  for (char *c = name; *c != '\0'; c++)
    if (*c == ' ') *c = '-';
  w->result = open_page(w, name, &file);
  if (w->result != ABBE_OK) return;
  man_page_write(file.stream, table, w->version);
  w->result = abbe_file_writer_commit(&file, w->error);
}

static void write_own_page(work *w) {
  abbe_file_writer file = {0};
  if (w->result == ABBE_OK) w->result = open_page(w, "abbe.1", &file);
  if (w->result != ABBE_OK) return;
  man_page_begin(file.stream, w->version);
  for (size_t i = 0; i < w->count; i++)
    man_page_command(file.stream, w->command[i].name, w->command[i].summary);
  man_page_end(file.stream);
  w->result = abbe_file_writer_commit(&file, w->error);
}

/* ---- completion ---- */

static void bash_verbs(void *user, const abbe_option_table *table) {
  if (table->verbs != NULL) abbe_completion_bash_verbs(user, table);
}

static void bash_options(void *user, const abbe_option_table *table) {
  if (table->verbs == NULL) abbe_completion_bash_options(user, table);
}

static void zsh_verbs(void *user, const abbe_option_table *table) {
  if (table->verbs != NULL) abbe_completion_zsh_verbs(user, table);
}

static void zsh_options(void *user, const abbe_option_table *table) {
  if (table->verbs == NULL) abbe_completion_zsh_options(user, table);
}

static void write_completion(work *w, bool zsh) {
  abbe_completion_word word[MOST] = {0};
  abbe_file_writer file = {0};
  const size_t count = w->count < MOST ? w->count : MOST;
  for (size_t i = 0; i < count; i++)
    word[i] = (abbe_completion_word){w->command[i].name, w->command[i].summary};
  if (w->result == ABBE_OK) w->result = open_page(w, zsh ? "_abbe" : "abbe.bash", &file);
  if (w->result != ABBE_OK) return;
  FILE *out = file.stream;
  (zsh ? abbe_completion_zsh_begin : abbe_completion_bash_begin)(out, word, count);
  visit_all(w, zsh ? zsh_verbs : bash_verbs, out);
  (zsh ? abbe_completion_zsh_options_begin : abbe_completion_bash_options_begin)(out);
  visit_all(w, zsh ? zsh_options : bash_options, out);
  (zsh ? abbe_completion_zsh_end : abbe_completion_bash_end)(out);
  w->result = abbe_file_writer_commit(&file, w->error);
}

abbe_result abbe_pages_write(const char *folder, const char *version,
                             const abbe_pages_command *command, size_t count, abbe_error *error) {
  work w = {.folder = folder,
            .version = version,
            .command = command,
            .count = count,
            .result = ABBE_OK,
            .error = error};
  write_own_page(&w);
  visit_all(&w, write_page, &w);
  write_completion(&w, false);
  write_completion(&w, true);
  return w.result;
}
