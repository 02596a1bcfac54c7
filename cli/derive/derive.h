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
  size_t region[4];     /* of it: column, row, width and height; 0: all of it */
  const char *target;
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

/* A region of the picture beside the same of a picture that is wanted. */
typedef struct abbe_derive_target {
  const abbe_pixels *pixels;
  double to_xyz[9], white[3], lab[3]; /* lab: of the target's mean */
} abbe_derive_target;

/* --region X,Y,W,H. Another text ends the program with ABBE_EXIT_USAGE. */
void abbe_derive_take_region(abbe_derive_request *request, const char *text, const char *program);
/* ABBE_INVALID_ARGUMENT for a region outside of a picture of that size, and a target of another
 * size, without colour or without light there; errors of abbe_field_load. */
abbe_result abbe_derive_read_target(const abbe_derive_request *request, size_t width, size_t height,
                                    abbe_derive_target *out, abbe_error *error);
/* CIEDE2000 of the region's mean from the target's (row 0), or its derivative, and its standard
 * error (jackknife over the parts). */
double abbe_derive_difference(const abbe_derive_target *target, size_t row, double *error);

/* The measures of the stone --stone, and their derivatives by the keys, to stdout. */
abbe_result abbe_derive_stone(const abbe_derive_request *request, const abbe_scene *scene,
                              const abbe_pixels_key *key, abbe_error *error);

#endif
