/* scene_change.h: values of a scene file that are put in the place of others before it is read, so
 * that what is wrong with them is said as of any value of the file. It knows no key of the format
 * but 'objects' and 'material'. Internal to scenes/. */
#ifndef ABBE_SCENES_IMPORT_SCENE_CHANGE_H
#define ABBE_SCENES_IMPORT_SCENE_CHANGE_H

#include "base/yaml/yaml_edit.h"

#ifdef __cplusplus
extern "C" {
#endif

/* "PATH=VALUE": PATH is keys with dots between them, and for an item of a list its number from 0 or
 * its 'name' (lights.lamp.intensity); VALUE is one line of YAML. The last key may be a new one.
 * ABBE_INVALID_ARGUMENT for a path that leads nowhere, with the nearest key or name. */
abbe_result abbe_scene_change_set(abbe_yaml_edit *edit, const char *assignment, abbe_error *error);

/* "STONE": what all refractors are made of, which must be one material; or "NAME=STONE": what is
 * made of the material NAME, or the object NAME. ABBE_INVALID_ARGUMENT where nothing is. */
abbe_result abbe_scene_change_material(abbe_yaml_edit *edit, const char *text, abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
