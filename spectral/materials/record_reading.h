/* record_reading.h: what the parts of a record are read with. Internal to spectral/materials/. */
#ifndef ABBE_SPECTRAL_MATERIALS_RECORD_READING_H
#define ABBE_SPECTRAL_MATERIALS_RECORD_READING_H

#include "base/error.h"
#include "base/yaml/yaml.h"
#include "spectral/materials/material.h"

#include <stdbool.h>
#include <stddef.h>

/* A record being read: where complaints go, and what fills. */
typedef struct abbe_record_reading {
  abbe_yaml *yaml;
  abbe_yaml_node record;
  abbe_material *material;
  abbe_error *error;
  bool lenient; /* for a record that is to be examined */
} abbe_record_reading;

/* A key that only the lenient reading goes without: *node is none then. */
abbe_result abbe_record_require(abbe_record_reading *r, const char *key, abbe_yaml_node *node);

/* Rows of a list: wavelengths, and one or two values of each. */
typedef struct abbe_record_rows {
  size_t columns, count;
  double *column[3];
} abbe_record_rows;

/* [[nm, value], …] or, with three columns, [[nm, n, k], …], values in [min, max]; the rows are
 * freed by the caller, also after a failure. */
abbe_result abbe_record_rows_read(abbe_record_reading *r, abbe_yaml_node list, const char *key,
                                  double min, double max, abbe_record_rows *out);
void abbe_record_rows_free(abbe_record_rows *list);

/* A list of pairs as a spectrum. */
abbe_result abbe_record_read_points(abbe_record_reading *r, abbe_yaml_node list, const char *key,
                                    double min, double max, abbe_interpolation interpolation,
                                    abbe_spectrum **out);

/* [from, to] under the key of `where`; as it is where there is none. */
abbe_result abbe_record_read_range(abbe_record_reading *r, abbe_yaml_node where, const char *key,
                                   double *min_nm, double *max_nm);
abbe_result abbe_record_read_interpolation(abbe_record_reading *r, abbe_yaml_node where,
                                           abbe_interpolation *interpolation);

/* Model, numbers and range of the material, and its extraordinary index. */
abbe_result abbe_record_read_dispersion(abbe_record_reading *r);

/* One material from its record in a YAML table.
 *
 * docs/materials.md documents the keys. Complaints name file, line, key and value. It knows
 * nothing of the table around the record, and does not write: see
 * spectral/formats/material_write.h. */

/* Reads the mapping `record` into *material, which must be zeroed; the caller frees it, also where
 * reading fails. ABBE_SCHEMA with a sentence where the record is wrong. */
abbe_result abbe_material_record_read(abbe_yaml *yaml, abbe_yaml_node record,
                                      abbe_material *material, abbe_error *error);

/* The same for a record that is to be examined, not used: without a source it has none (NULL),
 * without range_nm it has none (0 to 0), and its formula may have no real index somewhere. */
abbe_result abbe_material_record_read_lenient(abbe_yaml *yaml, abbe_yaml_node record,
                                              abbe_material *material, abbe_error *error);

#endif
