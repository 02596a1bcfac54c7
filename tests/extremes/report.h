/* report.h: rows of the table of extremes, as they are printed and counted. */
#ifndef ABBE_TESTS_EXTREMES_REPORT_H
#define ABBE_TESTS_EXTREMES_REPORT_H

#include <stdbool.h>
#include <stddef.h>

/* What was found of one case: its worst figures and, where a law is broken, which one. */
typedef struct extreme_row {
  char figures[512];
  char broken[512]; /* empty: all laws are kept */
} extreme_row;

typedef struct extreme_report {
  bool table;    /* print every row as a line of a Markdown table, else only the broken ones */
  bool heavy;    /* run the heavy cases too */
  int count;     /* groups asked for; 0: all */
  char **groups; /* [count] */
  size_t rows, broken;
} extreme_report;

/* Reads [--table] [--heavy] [GROUP…]. */
extreme_report extreme_report_make(int count, char **argument);

bool extreme_report_wants(const extreme_report *report, const char *group);
/* Says in the row that a law is broken, and by how much; the first one counts. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void extreme_row_break(extreme_row *row, const char *format, ...);
/* Appends to the row's figures. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void extreme_row_add(extreme_row *row, const char *format, ...);
void extreme_report_add(extreme_report *report, const char *group, const char *name,
                        const extreme_row *row);

/* 0 where there was a row and none is broken. */
int extreme_report_end(const extreme_report *report);

#endif
