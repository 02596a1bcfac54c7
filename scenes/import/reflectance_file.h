/* reflectance_file.h: a receiver's measured reflectance, as a scene file asks for it:
 * {spectrum: FILE, column: NAME} or {patch: NAME} of the ColorChecker.
 *
 * A part of object_file.h, which reads numbers.
 */
#ifndef ABBE_SCENES_IMPORT_REFLECTANCE_FILE_H
#define ABBE_SCENES_IMPORT_REFLECTANCE_FILE_H

#include "base/error.h"
#include "base/yaml/yaml.h"
#include "scenes/scene.h"

/* Fills the object's spectrum, its path and the colour under D65. Paths are relative to folder.
 * ABBE_SCHEMA and ABBE_NOT_FOUND with file, line and key; errors of the file. */
abbe_result abbe_reflectance_file_read(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                                       abbe_object *out, abbe_error *error);

#endif
