#include "cli/pages/pages.h"

#include "base/file.h"
#include "cli/pages/completion.h"
#include "cli/pages/man_page.h"

#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

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
  abbe_man_page_write(file.stream, table, w->version);
  w->result = abbe_file_writer_commit(&file, w->error);
}

static void write_own_page(work *w) {
  abbe_file_writer file = {0};
  if (w->result == ABBE_OK) w->result = open_page(w, "abbe.1", &file);
  if (w->result != ABBE_OK) return;
  abbe_man_page_begin(file.stream, w->version);
  for (size_t i = 0; i < w->count; i++)
    abbe_man_page_command(file.stream, w->command[i].name, w->command[i].summary);
  abbe_man_page_end(file.stream);
  w->result = abbe_file_writer_commit(&file, w->error);
}

static void write_ranks_page(work *w) {
  abbe_file_writer file = {0};
  if (w->result == ABBE_OK) w->result = open_page(w, "abbe-mpi.1", &file);
  if (w->result != ABBE_OK) return;
  abbe_man_page_ranks(file.stream, w->version);
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
  write_ranks_page(&w);
  write_completion(&w, false);
  write_completion(&w, true);
  return w.result;
}
