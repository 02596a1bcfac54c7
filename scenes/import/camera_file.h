/* camera_file.h: a scene's camera: as its file has it, or placed so that objects fill the picture.
 * Internal to scenes/. */
#ifndef ABBE_SCENES_IMPORT_CAMERA_FILE_H
#define ABBE_SCENES_IMPORT_CAMERA_FILE_H

#include "base/yaml/yaml.h"
#include "scenes/scene.h"

/* The values under 'camera'. With 'frame' its eye and target are not there yet. Errors with file,
 * line and key. */
abbe_result abbe_camera_read(abbe_yaml *yaml, abbe_yaml_node root, abbe_camera *out,
                             abbe_error *error);

/* What 'frame' leaves open, once the scene has its objects: the target is the middle of those
 * objects as they are seen, the eye as near as lets them fill the share 'fill' of the picture's
 * width or height, whichever comes first. Then the whole camera is held to what a camera must be.
 * ABBE_SCHEMA for an object that is not there, with the nearest name. */
abbe_result abbe_camera_frame(abbe_yaml *yaml, abbe_yaml_node root, abbe_scene *scene,
                              abbe_error *error);

#endif
