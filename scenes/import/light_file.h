/* light_file.h: the lights of a scene file, key `lights` (docs/scene-files.md).
 *
 * A part of scene_file.h. It reads what an entry says and whether it can be so; where lights stand
 * to all else is abbe_scene_check's business.
 */
#ifndef ABBE_SCENES_IMPORT_LIGHT_FILE_H
#define ABBE_SCENES_IMPORT_LIGHT_FILE_H

#include "base/yaml/yaml.h"
#include "scenes/scene.h"

/* The lights of the document whose root is given; relative paths start at folder. Errors say file
 * and line; what *out holds then is the caller's to free too (abbe_lights_free). */
abbe_result abbe_lights_read(abbe_yaml *yaml, abbe_yaml_node root, const char *folder,
                             abbe_light **out, size_t *count, abbe_error *error);

#endif
