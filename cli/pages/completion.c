#include "cli/pages/pages.h"

#include "cli/base/arguments.h"
#include "cli/base/command.h"

#include <stdbool.h>
#include <string.h>

/* What comes behind the program's name in "abbe gem report". */
static const char *words_of(const abbe_option_table *table) {
  return table->program + strlen("abbe ");
}

static bool is_shown(const struct argp_option *o) {
  return !(o->flags & (OPTION_HIDDEN | OPTION_DOC));
}

static bool is_short(const struct argp_option *o) {
  return o->key > ' ' && o->key < 0x7f;
}

static bool takes_file(const struct argp_option *o) {
  return (o->flags & (ABBE_ARGUMENT_READS | ABBE_ARGUMENT_WRITES | ABBE_ARGUMENT_REPEATS)) != 0 ||
         (o->arg != NULL && (strstr(o->arg, "FILE") || strstr(o->arg, "FOLDER")));
}

typedef void (*visit_option)(FILE *out, const struct argp_option *o);

static void each_option(FILE *out, const struct argp *argp, visit_option visit) {
  for (const struct argp_option *o = argp->options; o && (o->name || o->key || o->doc); o++)
    if ((o->name != NULL || o->key != 0) && is_shown(o)) visit(out, o);
  for (const struct argp_child *c = argp->children; c != NULL && c->argp != NULL; c++)
    each_option(out, c->argp, visit);
}

/* ---- bash ---- */

static void put_option(FILE *out, const struct argp_option *o) {
  if (o->name != NULL) fprintf(out, " --%s", o->name);
  if (is_short(o)) fprintf(out, " -%c", o->key);
}

static void put_file_option(FILE *out, const struct argp_option *o) {
  if (o->arg != NULL && !(o->flags & OPTION_ARG_OPTIONAL) && takes_file(o)) put_option(out, o);
}

static void put_value_option(FILE *out, const struct argp_option *o) {
  if (o->arg != NULL && !(o->flags & OPTION_ARG_OPTIONAL) && !takes_file(o)) put_option(out, o);
}

void abbe_completion_bash_begin(FILE *out, const abbe_completion_word *command, size_t count) {
  fputs("# bash completion of abbe, made from its option tables\n"
        "_abbe() {\n"
        "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]}\n"
        "  local first=1 command verbs= options= files= values=\n"
        "  COMPREPLY=()\n"
        "  # '=' is a word of its own\n"
        "  if [ \"$cur\" = = ]; then\n"
        "    cur=\n"
        "  elif [ \"$prev\" = = ]; then\n"
        "    prev=${COMP_WORDS[COMP_CWORD-2]}\n"
        "  fi\n"
        "  [ \"${COMP_WORDS[1]}\" = help ] && first=2\n"
        "  if [ \"$COMP_CWORD\" -le \"$first\" ]; then\n"
        "    COMPREPLY=($(compgen -W \"",
        out);
  for (size_t i = 0; i < count; i++) fprintf(out, "%s ", command[i].name);
  fputs("help --help --version\" -- \"$cur\"))\n"
        "    return\n"
        "  fi\n"
        "  command=${COMP_WORDS[first]}\n"
        "  case $command in\n",
        out);
}

void abbe_completion_bash_verbs(FILE *out, const abbe_option_table *table) {
  fprintf(out, "  %s) verbs='", words_of(table));
  for (size_t i = 0; i < table->verbs->count; i++)
    fprintf(out, "%s%s", i == 0 ? "" : " ", table->verbs->verb[i].name);
  fputs("' ;;\n", out);
}

void abbe_completion_bash_options_begin(FILE *out) {
  fputs("  esac\n"
        "  if [ -n \"$verbs\" ]; then\n"
        "    if [ \"$COMP_CWORD\" -eq $((first + 1)) ]; then\n"
        "      COMPREPLY=($(compgen -W \"$verbs --help\" -- \"$cur\"))\n"
        "      return\n"
        "    fi\n"
        "    command=\"$command ${COMP_WORDS[first+1]}\"\n"
        "  fi\n"
        "  [ \"$first\" -eq 1 ] || return 0\n"
        "  case $command in\n",
        out);
}

void abbe_completion_bash_options(FILE *out, const abbe_option_table *table) {
  fprintf(out, "  '%s')\n    options='--help --usage --version", words_of(table));
  each_option(out, table->argp, put_option);
  fputs("'\n    files='", out);
  each_option(out, table->argp, put_file_option);
  fputs(" '\n    values='", out);
  each_option(out, table->argp, put_value_option);
  fputs(" ' ;;\n", out);
}

void abbe_completion_bash_end(FILE *out) {
  fputs("  esac\n"
        "  if [[ $values == *\" $prev \"* ]]; then\n"
        "    return 0\n"
        "  elif [[ $files != *\" $prev \"* && $cur == -* ]]; then\n"
        "    COMPREPLY=($(compgen -W \"$options\" -- \"$cur\"))\n"
        "  else\n"
        "    compopt -o filenames 2>/dev/null\n"
        "    mapfile -t COMPREPLY < <(compgen -f -- \"$cur\")\n"
        "  fi\n"
        "}\n"
        "complete -F _abbe abbe\n",
        out);
}

/* ---- zsh ---- */

/* Inside of '…', where _arguments and _describe take some signs for their own. */
static void put_quoted(FILE *out, const char *text) {
  for (; *text != '\0' && *text != '\v'; text++) {
    if (*text == '\'')
      fputs("'\\''", out);
    else if (*text == '\n')
      putc(' ', out);
    else {
      if (strchr("\\[]:", *text) != NULL) putc('\\', out);
      putc(*text, out);
    }
  }
}

static void put_word(FILE *out, const char *name, const char *summary) {
  fprintf(out, "    '%s:", name);
  put_quoted(out, summary);
  fputs("'\n", out);
}

static void put_specification(FILE *out, const struct argp_option *o) {
  const bool both = o->name != NULL && is_short(o);
  const char *value = o->arg == NULL ? "" : "=";
  fputs(" \\\n      ", out);
  if (both)
    fprintf(out, "'(-%c --%s)'{-%c%s,--%s%s}'", o->key, o->name, o->key, o->arg ? "+" : "", o->name,
            value);
  else if (o->name != NULL)
    fprintf(out, "'%s--%s%s", o->flags & ABBE_ARGUMENT_REPEATS ? "*" : "", o->name, value);
  else
    fprintf(out, "'-%c%s", o->key, o->arg ? "+" : "");
  putc('[', out);
  put_quoted(out, o->doc == NULL ? "" : o->doc);
  putc(']', out);
  if (o->arg != NULL) {
    fputs(o->flags & OPTION_ARG_OPTIONAL ? "::" : ":", out);
    put_quoted(out, o->arg);
    fputs(takes_file(o) ? ":_files" : ": ", out);
  }
  putc('\'', out);
}

void abbe_completion_zsh_begin(FILE *out, const abbe_completion_word *command, size_t count) {
  fputs("#compdef abbe\n"
        "# zsh completion of abbe, made from its option tables\n"
        "_abbe() {\n"
        "  local -a commands verbs\n"
        "  commands=(\n",
        out);
  for (size_t i = 0; i < count; i++) put_word(out, command[i].name, command[i].summary);
  put_word(out, "help", "all commands, or one of them");
  fputs("  )\n"
        "  local asked=\n"
        "  if [[ $words[2] == help && CURRENT -gt 2 ]]; then\n"
        "    asked=1\n"
        "    shift words\n"
        "    (( CURRENT-- ))\n"
        "  fi\n"
        "  if (( CURRENT == 2 )); then\n"
        "    _describe command commands\n"
        "    return\n"
        "  fi\n"
        "  local command=$words[2]\n"
        "  case $command in\n",
        out);
}

void abbe_completion_zsh_verbs(FILE *out, const abbe_option_table *table) {
  fprintf(out, "  (%s) verbs=(\n", words_of(table));
  for (size_t i = 0; i < table->verbs->count; i++)
    put_word(out, table->verbs->verb[i].name, table->verbs->verb[i].summary);
  fputs("  ) ;;\n", out);
}

void abbe_completion_zsh_options_begin(FILE *out) {
  fputs("  esac\n"
        "  if (( $#verbs )); then\n"
        "    if (( CURRENT == 3 )); then\n"
        "      _describe verb verbs\n"
        "      return\n"
        "    fi\n"
        "    command=\"$command $words[3]\"\n"
        "    shift words\n"
        "    (( CURRENT-- ))\n"
        "  fi\n"
        "  [[ -n $asked ]] && return\n"
        "  shift words\n"
        "  (( CURRENT-- ))\n"
        "  case $command in\n",
        out);
}

void abbe_completion_zsh_options(FILE *out, const abbe_option_table *table) {
  fprintf(out, "  ('%s')\n    _arguments -s", words_of(table));
  each_option(out, table->argp, put_specification);
  fputs(" \\\n      '(- *)--help[the options, with examples]'"
        " \\\n      '(- *)--usage[the options in short]'"
        " \\\n      '(- *)--version[which release this is]'"
        " \\\n      '*:file:_files' ;;\n",
        out);
}

void abbe_completion_zsh_end(FILE *out) {
  fputs("  esac\n"
        "}\n"
        "_abbe \"$@\"\n",
        out);
}
