/* derive.h: what `abbe derive` is asked for, and the scenes in which a key is moved, and a
 * stone's numbers.
 *
 * Internal to cli/derive/.
 */
#ifndef ABBE_CLI_DERIVE_DERIVE_H
#define ABBE_CLI_DERIVE_DERIVE_H

#include "cli/options/picture_options.h"
#include "cli/options/scene_input.h"
#include "validation/measure/derive/pixels.h"

enum { ABBE_DERIVE_MOST_KEYS = 16 };

typedef struct abbe_derive_request {
  const char *program, *path, *materials, *exr, *stone;
  bool json, quiet;
  const char *key[ABBE_DERIVE_MOST_KEYS];
  double value[ABBE_DERIVE_MOST_KEYS]; /* as the scene has it; of a material: 0 */
  abbe_scene_input_changes changes;
  abbe_map_options map;
  abbe_work_options work;
  size_t width, height; /* of the map */
  size_t columns, rows; /* of the picture */
  size_t samples, lines, points, interfaces, keys;
  abbe_rgb_space space;
} abbe_derive_request;

/* A key that is moved both ways: scenes of its own, or the base's with another material. */
typedef struct abbe_derive_moved {
  abbe_scene scene[2]; /* owned */
} abbe_derive_moved;

/* Key k of the request in those scenes; *moved outlives *out, and is freed by the caller also where
 * this fails. Errors of abbe_scene_input_load_with, and for a key that is no number. */
abbe_result abbe_derive_move(abbe_derive_request *request, size_t k, const abbe_scene *scene,
                             abbe_derive_moved *moved, abbe_pixels_key *out, abbe_error *error);

/* The measures of the stone --stone, and their derivatives by the keys, to stdout. */
abbe_result abbe_derive_stone(const abbe_derive_request *request, const abbe_scene *scene,
                              const abbe_pixels_key *key, abbe_error *error);

#endif
