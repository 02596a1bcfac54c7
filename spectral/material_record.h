/* material_record.h: one material from its record in a YAML table.
 *
 * docs/materials.md documents the keys. Complaints name file, line, key and value. It knows nothing
 * of the table around the record, and does not write: see spectral/material_write.h.
 */
#ifndef ABBE_SPECTRAL_MATERIAL_RECORD_H
#define ABBE_SPECTRAL_MATERIAL_RECORD_H

#include "spectral/error.h"
#include "spectral/material.h"
#include "spectral/yaml.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Reads the mapping `record` into *material, which must be zeroed; the caller frees it, also where
 * reading fails. ABBE_SCHEMA with a sentence where the record is wrong. */
abbe_result abbe_material_record_read(abbe_yaml *yaml, abbe_yaml_node record,
                                      abbe_material *material, abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
