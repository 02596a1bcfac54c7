/* environment_file.h: the surroundings of a scene file, key `environment` (docs/scene-files.md):
 * a picture, or sources that are computed, or both added up.
 */
#ifndef ABBE_SCENES_IMPORT_ENVIRONMENT_FILE_H
#define ABBE_SCENES_IMPORT_ENVIRONMENT_FILE_H

#include "base/yaml/yaml.h"
#include "scenes/environment/environment.h"

#define ABBE_ENVIRONMENT_MAX_SOURCES 256 /* of one list */

/* Reads the node into a zeroed *out and prepares it; relative paths start at folder. Errors say
 * file and line; what *out holds then is the caller's to free. */
abbe_result abbe_environment_read(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                                  abbe_environment *out, abbe_error *error);

#endif
