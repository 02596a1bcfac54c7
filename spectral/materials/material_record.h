/* material_record.h: one material from its record in a YAML table.
 *
 * docs/materials.md documents the keys. Complaints name file, line, key and value. It knows nothing
 * of the table around the record, and does not write: see spectral/formats/material_write.h.
 * Internal to spectral/materials/.
 */
#ifndef ABBE_SPECTRAL_MATERIALS_MATERIAL_RECORD_H
#define ABBE_SPECTRAL_MATERIALS_MATERIAL_RECORD_H

#include "base/error.h"
#include "base/yaml/yaml.h"
#include "spectral/materials/material.h"

/* Reads the mapping `record` into *material, which must be zeroed; the caller frees it, also where
 * reading fails. ABBE_SCHEMA with a sentence where the record is wrong. */
abbe_result abbe_material_record_read(abbe_yaml *yaml, abbe_yaml_node record,
                                      abbe_material *material, abbe_error *error);

/* The same for a record that is to be examined, not used: without a source it has none (NULL),
 * without range_nm it has none (0 to 0), and its formula may have no real index somewhere. */
abbe_result abbe_material_record_read_lenient(abbe_yaml *yaml, abbe_yaml_node record,
                                              abbe_material *material, abbe_error *error);

#endif
