#include "cli/base/option_tables.h"

#include "cli/base/verbs.h"

#include <setjmp.h>
#include <stdio.h>

/* Who visits, innermost; NULL: nobody. */
typedef struct visit {
  jmp_buf back;
  const char *program, *summary;
  abbe_option_table_take take;
  void *user;
} visit;

static visit *here;

void abbe_option_tables_visit(const char *program, const char *summary,
                              int (*run)(int argc, char **argv), abbe_option_table_take take,
                              void *user) {
  visit own = {.program = program, .summary = summary, .take = take, .user = user};
  visit *const outer = here;
  char name[64];
  snprintf(name, sizeof name, "%s", program);
  char *argv[] = {name, NULL};
  here = &own;
  if (setjmp(own.back) == 0) run(1, argv);
  here = outer;
}

void abbe_option_tables_offer(const struct argp *argp, unsigned flags) {
  visit *const v = here;
  if (v == NULL) return;
  const abbe_option_table table = {
      .program = v->program, .summary = v->summary, .argp = argp, .flags = flags};
  v->take(v->user, &table);
  longjmp(v->back, 1);
}

void abbe_option_tables_offer_verbs(const abbe_verbs *verbs) {
  visit *const v = here;
  if (v == NULL) return;
  const abbe_option_table table = {.program = v->program, .summary = v->summary, .verbs = verbs};
  v->take(v->user, &table);
  for (size_t i = 0; i < verbs->count; i++) {
    char program[64];
    snprintf(program, sizeof program, "%s %s", v->program, verbs->verb[i].name);
    abbe_option_tables_visit(program, verbs->verb[i].summary, verbs->verb[i].run, v->take, v->user);
  }
  longjmp(v->back, 1);
}
