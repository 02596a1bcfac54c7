/* gem_report.h: what `abbe gem report` says of a judgement: as text, CSV, JSON, pages, pictures. */
#ifndef ABBE_CLI_GEM_GEM_REPORT_H
#define ABBE_CLI_GEM_GEM_REPORT_H

#include "cli/gem/gem_stone_input.h"
#include "validation/gem/gem_judgement.h"

typedef struct abbe_gem_report_facts {
  const abbe_gem_stone_input *input;
  const abbe_gem_judgement *judgement;
  double head_deg, seconds;
} abbe_gem_report_facts;

/* "91.73 %" and "0.02", for people. */
void abbe_gem_report_number(const abbe_gem_judgement_row *row, char value[32], char error[32]);

void abbe_gem_report_print(const abbe_gem_report_facts *facts);
/* Rows of measure, axis, tilt, wavelength, value, standard error; what does not apply is empty. */
void abbe_gem_report_print_csv(const abbe_gem_report_facts *facts);
abbe_result abbe_gem_report_print_json(const abbe_gem_report_facts *facts, abbe_error *error);

/* To path, .pdf. */
abbe_result abbe_gem_report_sheet(const char *path, const abbe_gem_report_facts *facts,
                                  abbe_error *error);
/* maps.exr and a PNG for each map, into a folder that is there. */
abbe_result abbe_gem_report_maps(const char *folder, const abbe_gem_judgement *judgement,
                                 abbe_error *error);

#endif
