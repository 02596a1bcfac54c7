/* scene_change.h: values of a scene file that are put in the place of others before it is read, so
 * that what is wrong with them is said as of any value of the file. It knows no key of the format
 * but 'objects', 'material', 'time' and 'keyframes'. Internal to scenes/. */
#ifndef ABBE_SCENES_IMPORT_SCENE_CHANGE_H
#define ABBE_SCENES_IMPORT_SCENE_CHANGE_H

#include "base/yaml/yaml_edit.h"

/* "PATH=VALUE": PATH is keys with dots between them, and for an item of a list its number from 0 or
 * its 'name' (lights.lamp.intensity); VALUE is one line of YAML. The last key may be a new one.
 * "PATH=": what is there is taken out, as if it had never stood there. ABBE_INVALID_ARGUMENT for a path that leads nowhere, with the nearest key or name. */
abbe_result abbe_scene_change_set(abbe_yaml_edit *edit, const char *assignment, abbe_error *error);

/* "STONE": what all refractors are made of, which must be one material; or "NAME=STONE": what is
 * made of the material NAME, or the object NAME. ABBE_INVALID_ARGUMENT where nothing is. */
abbe_result abbe_scene_change_material(abbe_yaml_edit *edit, const char *text, abbe_error *error);

/* Whether some value of the document is a mapping with 'keyframes'. */
bool abbe_scene_change_has_keyframes(const abbe_yaml *yaml);

/* Each {keyframes: [[TIME, VALUE], ...], repeat: SECONDS} becomes its value at the scene's 'time':
 * numbers or lists of as many numbers, straight lines between them, the first before and the last
 * behind; with 'repeat' the time counts from 0 to it again and again. ABBE_SCHEMA with file, line
 * and key for what is none. */
abbe_result abbe_scene_change_keyframes(abbe_yaml_edit *edit, abbe_error *error);

#endif
