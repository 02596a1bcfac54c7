/* checked_record.h: records as text, and what is found about them beside the default table, which
 * the test loads (shipped_table.h). */
#ifndef ABBE_TESTS_SPECTRAL_EDITING_CHECKED_RECORD_H
#define ABBE_TESTS_SPECTRAL_EDITING_CHECKED_RECORD_H

#include "tests/check.h"
#include "tests/spectral/shipped_table.h"

#include "spectral/editing/check.h"

static inline abbe_findings checked_table(const abbe_material_table *table) {
  abbe_findings found = {0};
  OK(abbe_check_table(table, &shipped, &found, &error));
  return found;
}

/* The table of these records alone, read leniently and nothing left out. */
static inline abbe_material_table checked_parse(const char *records) {
  abbe_material_table table;
  OWNED(abbe_report, report) = {0};
  abbe_error error = {0};
  const char *text = printed("materials:\n%s", records);
  if (abbe_material_table_parse_lenient(text, strlen(text), "t.yaml", &table, &report, &error) !=
      ABBE_OK)
    fail_msg("%s", error.text);
  assert_int_equal(report.count, 0);
  return table;
}

#endif
