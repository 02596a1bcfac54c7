/* environment_reading.h: what the readers of surroundings share. Internal to scenes/import. */
#ifndef ABBE_SCENES_IMPORT_ENVIRONMENT_READING_H
#define ABBE_SCENES_IMPORT_ENVIRONMENT_READING_H

#include "base/yaml/yaml.h"
#include "scenes/environment/environment_source.h"

/* Adds the sources that the node's keys name (uniform, sky, sun, softboxes, spots, dome) to the
 * map; *count says how many there were. */
abbe_result abbe_environment_read_sources(abbe_yaml *yaml, abbe_yaml_node node,
                                          abbe_radiance_map *map, size_t *count, abbe_error *error);

#endif
