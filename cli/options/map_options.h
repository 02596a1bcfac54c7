/* map_options.h: the options of commands that make a receiver map: of which light, where to, laid
 * out how. Internal to cli/. */
#ifndef ABBE_CLI_OPTIONS_MAP_OPTIONS_H
#define ABBE_CLI_OPTIONS_MAP_OPTIONS_H

#include "scenes/scene.h"
#include "scenes/view/map_layout.h"

#include <argp.h>
#include <stdbool.h>

typedef struct abbe_map_options {
  const char *save;  /* file, or NULL */
  const char *light; /* name or number, or NULL */
  const char *like;  /* file whose layout is taken, or NULL */
  /* After abbe_map_options_resolve: */
  size_t light_index;
  abbe_map_layout layout; /* layout of like; else zeroed */
  size_t side;            /* side of like's map; else 0 */
} abbe_map_options;

/* An argp child: --save-map, --map-light, --map-like. Its input is an abbe_map_options. */
extern const struct argp abbe_map_options_argp;

/* Reads like and finds the light: --map-light's, else the one that like names, else the first.
 * With `sized` like's map must be square, for its side is taken. */
abbe_result abbe_map_options_resolve(abbe_map_options *options, const abbe_scene *scene, bool sized,
                                     abbe_error *error);

#endif
