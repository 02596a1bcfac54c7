/* medium_file.h: the `medium` of a scene file: of the air, and of what refracts.
 * Internal to scenes/. */
#ifndef ABBE_SCENES_MEDIUM_MEDIUM_FILE_H
#define ABBE_SCENES_MEDIUM_MEDIUM_FILE_H

#include "base/yaml/yaml.h"
#include "scenes/medium/medium.h"

/* A coefficient, 1/m, may be this large. */
#define ABBE_MEDIUM_MOST_PER_M 1e6

/* The value under the key 'medium' of the scene (air: with absorption and a box) or of an object
 * that refracts; NULL without the key. ABBE_SCHEMA with file and line, ABBE_NO_MEMORY; *out is then
 * NULL. */
abbe_result abbe_medium_file_read(abbe_yaml *yaml, abbe_yaml_node mapping, bool air,
                                  abbe_medium **out, abbe_error *error);

#endif
