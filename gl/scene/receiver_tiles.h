/* receiver_tiles.h: maps on receivers, for light that the light's own map cannot hold: what falls
 * behind a point light, far off the map view's axis, or where a receiver hides the place.
 *
 * A chart is a parallelogram, or a part of a mesh within the parallelogram that bounds it
 * (scenes/mesh/mesh.h). A tile is a window of one side of a chart and a rectangle of texels
 * for it, in one layer beside the light's map. This chooses tiles from where light falls and lays
 * them out; it knows no GL. Internal to gl/.
 */
#ifndef ABBE_GL_SCENE_RECEIVER_TILES_H
#define ABBE_GL_SCENE_RECEIVER_TILES_H

#include <stdbool.h>
#include <stddef.h>

#define ABBE_RECEIVER_TILES 64 /* tiles of one light at the most */
#define ABBE_TILE_BINS 4096
#define ABBE_TILE_FLOATS 16 /* floats of the shaders' Tile */

/* What hits one side of a chart, corner + u U + v V, and where: flux by u and by v, 0 to 1. */
typedef struct abbe_tile_light {
  double flux;
  double bin[2][ABBE_TILE_BINS];
} abbe_tile_light;

typedef struct abbe_receiver_tile {
  size_t chart_side; /* 2 * chart: the side that U x V points to; + 1: the other */
  double window[4];  /* least and greatest u, then v */
  size_t rect[4];    /* texels: left, right, bottom, top; the ends excluded */
} abbe_receiver_tile;

typedef struct abbe_receiver_tiles {
  size_t count;
  abbe_receiver_tile tile[ABBE_RECEIVER_TILES];
  size_t rows; /* rows of the layer that are used */
} abbe_receiver_tiles;

/* u and v are clamped to 0 to 1; a flux that is not above zero is left out. */
void abbe_tile_light_add(abbe_tile_light *light, double u, double v, double flux);

/* Tiles in a layer of side x side texels for those of `count` charts' sides that take most light,
 * brightest first, until what has none is less than a thousandth of `total`, the flux of all that
 * lands. light: [count], NULL where there is none; parallelogram: of each chart, corner, U, V. A
 * rectangle's sides are multiples of `align`, which divides `side`; its texels are nearly squares
 * across the chart. All but 2e-4 of its light on each side lies in a tile's window. */
void abbe_receiver_tiles_lay_out(abbe_tile_light *const *light, const double (*parallelogram)[9],
                                 size_t count, double total, size_t side, size_t align,
                                 abbe_receiver_tiles *out);

/* Area of one of its texels on the parallelogram, m2. */
double abbe_receiver_tile_texel(const abbe_receiver_tile *tile, const double parallelogram[9]);
/* The place on the parallelogram of (x, y) in the layer's texels. */
void abbe_receiver_tile_place(const abbe_receiver_tile *tile, const double parallelogram[9],
                              double x, double y, double out[3]);
/* The shaders' Tile (receiver_atlas.glsl). */
void abbe_receiver_tile_pack(const abbe_receiver_tile *tile, const double parallelogram[9],
                             float out[ABBE_TILE_FLOATS]);

#endif
