/* scene_value.h: values that the entries of a scene file share: paths, places of errors, points,
 * illuminants, polarisers. */
#ifndef ABBE_SCENES_IMPORT_SCENE_VALUE_H
#define ABBE_SCENES_IMPORT_SCENE_VALUE_H

#include "base/error.h"
#include "base/yaml/yaml.h"
#include "colorimetry/illuminant.h"
#include "scenes/scene.h"

/* No coordinate or length of a scene, in metres, may be larger. */
#define ABBE_SCENE_FAR 1e6
/* No light may be brighter: W/sr, W/m2, W/(m2 sr). */
#define ABBE_SCENE_BRIGHTEST 1e9

/* Path relative to folder, or as it is where it is absolute; malloc'd, NULL without memory. */
char *abbe_scene_value_path(const char *folder, const char *path);

/* Puts "FILE:LINE: " before the sentence of an error that came from deeper down; returns code. */
abbe_result abbe_scene_value_locate(const abbe_yaml *yaml, abbe_yaml_node node, abbe_result code,
                                    abbe_error *error);

/* Three finite coordinates that must be there. */
abbe_result abbe_scene_value_point(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                   double out[3], abbe_error *error);

/* The list under a key of the mapping, of at most `most` entries; an absent one has none. */
abbe_result abbe_scene_value_list(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                  size_t most, abbe_yaml_node *list, size_t *count,
                                  abbe_error *error);

/* The scene's 'time', s; 0 without one. */
abbe_result abbe_scene_value_time(abbe_yaml *yaml, double *out, abbe_error *error);

/* What the key 'illuminant' of a light says; an absent one leaves D65 in a zeroed *out. *path: the
 * file that it is of, malloc'd, or left as it is. Errors of abbe_illuminant_make, with file and
 * line. */
abbe_result abbe_scene_value_illuminant(abbe_yaml *yaml, abbe_yaml_node mapping, const char *folder,
                                        abbe_illuminant *out, char **path, abbe_error *error);

/* The key 'polariser' of the camera or a light; an absent one leaves *out. */
abbe_result abbe_scene_value_polariser(abbe_yaml *yaml, abbe_yaml_node mapping, abbe_polariser *out,
                                       abbe_error *error);

#endif
