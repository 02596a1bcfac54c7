/* object_file.h: one object of a scene file: its shape or mesh, its transform, what it is made of.
 *
 * A part of scene_file.h with the keys of an entry under "objects"; docs/scene-files.md documents
 * them. It reads, tessellates, places, checks and fixes one object; the scene as a whole is
 * scene_file's business.
 */
#ifndef ABBE_SCENES_IMPORT_OBJECT_FILE_H
#define ABBE_SCENES_IMPORT_OBJECT_FILE_H

#include "base/error.h"
#include "base/yaml/yaml.h"
#include "scenes/scene.h"

/* Reads the mapping at node into out[0], and where shells of its mesh cross into further objects
 * behind it, *count in all and at most room (zeroed before; freed with the scene, also on failure).
 * folder is the scene file's, with its slash, or "". Materials are found in table. */
abbe_result abbe_object_read(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                             const abbe_material_table *table, abbe_object *out, size_t room,
                             size_t *count, abbe_error *error);

#endif
