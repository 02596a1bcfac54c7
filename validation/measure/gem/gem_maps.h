/* gem_maps.h: the pictures that stones are judged by, from a view.
 *
 * Brightness in grey, ASET and Ideal-Scope in their colours, the light return in its own. As
 * pictures for a screen they are in sRGB, on white. Nothing is traced here.
 */
#ifndef ABBE_VALIDATION_MEASURE_GEM_GEM_MAPS_H
#define ABBE_VALIDATION_MEASURE_GEM_GEM_MAPS_H

#include "colorimetry/image/image.h"
#include "validation/measure/gem/gem_optimum.h"
#include "validation/measure/gem/gem_view.h"

/* X(code, name, text) */
#define ABBE_GEM_MAPS(X)                                                                           \
  X(COLOUR, "return", "light return, in colour")                                                   \
  X(ISO, "iso", "brightness")                                                                      \
  X(COS, "cos", "cosine brightness")                                                               \
  X(ASET, "aset", "ASET, leakage black")                                                           \
  X(IDEAL, "ideal-scope", "Ideal-Scope, leakage white")                                            \
  X(LEAKAGE, "leakage", "leakage: windows are bright")

typedef enum abbe_gem_map {
#define ABBE_GEM_MAP_ENUM(code, name, text) ABBE_GEM_MAP_##code,
  ABBE_GEM_MAPS(ABBE_GEM_MAP_ENUM)
#undef ABBE_GEM_MAP_ENUM
      ABBE_GEM_MAP_COUNT
} abbe_gem_map;

const char *abbe_gem_map_name(abbe_gem_map map);
const char *abbe_gem_map_text(abbe_gem_map map);

/* An image of channels R, G, B in [0, 1], encoded as sRGB. ABBE_NO_MEMORY; the caller frees. */
abbe_result abbe_gem_map_paint(const abbe_gem_view *view, abbe_gem_map map, abbe_image *out,
                               abbe_error *error);

/* All amounts of the pixels as channels of their names, X, Y and Z of the light return and cover,
 * the share of the pixel's rays that met the stone; means over those rays. ABBE_NO_MEMORY; the
 * caller frees. */
abbe_result abbe_gem_map_image(const abbe_gem_view *view, abbe_image *out, abbe_error *error);

/* The pairs of angles that one part of a search has judged, as a table that goes
 * together with those of the other parts. */

/* CSV: what was asked and what the design itself has, as comments; then a row for each pair that
 * was judged, with its place in value[], both angles in radians, value and standard error, all to
 * the last bit. ABBE_IO. */
abbe_result abbe_gem_grid_file_write(const char *path, const abbe_gem_optimum *optimum,
                                     abbe_error *error);

/* Takes the pairs of a table into a search that has begun; best becomes the best of all that are
 * known. ABBE_INVALID_ARGUMENT for a table of another search (other angles, another measure, or
 * another number for the design itself, which differs where the design, the stone or the view do),
 * and for a pair that is known already; ABBE_IO, ABBE_PARSE for what cannot be read, with the line.
 * On failure optimum may have some of the pairs. */
abbe_result abbe_gem_grid_file_read(const char *path, abbe_gem_optimum *optimum, abbe_error *error);

#endif
