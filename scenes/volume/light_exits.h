/* light_exits.h: the rays that leave an object: for points of its surface where light first meets
 * it, each with a wavelength of its own, and for the directions of light nodes, where the light
 * goes out again and which way; and for light from any other direction the rays between them.
 *
 * A ray on its way through an object depends on the point and the direction where it came in and on
 * nothing else, so that one table serves lights at any distance and cones that meet a part of the
 * object. Rays of three nodes that met the same facets become one; others go on alone, each moved
 * by how it changes with the light, so that what stands beside its place does so by the square of
 * the distance between nodes. Of an object that turns and reflections bring onto itself it takes
 * the points of the part that these make the whole of. Places are from the object's centre in m, as
 * it stood when the table was made. It holds numbers; validation/lab/exit_fill.h finds them out.
 */
#ifndef ABBE_SCENES_VOLUME_LIGHT_EXITS_H
#define ABBE_SCENES_VOLUME_LIGHT_EXITS_H

#include "scenes/scene.h"
#include "scenes/volume/sphere_mesh.h"

#include <stdbool.h>

/* The turns and reflections that bring an object onto itself, found by testing, and the part of
 * all directions that is enough: light from any other is brought there by one of them.
 *
 * It reads an object and holds maps; what depends on the direction of light it does not know. */

#define ABBE_BODY_SYMMETRY_MOST 512        /* maps */
#define ABBE_BODY_SYMMETRY_MOST_MARKS 8192 /* faces of a solid of planes, vertices of another */

typedef struct abbe_body_symmetry {
  size_t count;     /* 0 of one that was not made; else the first is the unit map */
  double (*map)[9]; /* [count] orthogonal, row-major, around the object's centre */
} abbe_body_symmetry;

/* Finds the symmetry of the planes of a convex solid, or of the vertices and normals of another
 * mesh, within 1e-5 of its radius around `centre`. An object of more planes or vertices, of more
 * maps, or of a crystal, whose axis they would turn, has the unit map alone; so has a ball.
 * ABBE_NO_MEMORY. */
abbe_result abbe_body_symmetry_find(const abbe_object *object, const double centre[3],
                                    double radius, abbe_body_symmetry *out, abbe_error *error);
/* Makes a symmetry of given maps, copied. ABBE_INVALID_ARGUMENT where one is not orthogonal, within
 * 1e-6, where the first is not the unit map, and for more than ABBE_BODY_SYMMETRY_MOST;
 * ABBE_NO_MEMORY. */
abbe_result abbe_body_symmetry_make(size_t count, const double (*map)[9], abbe_body_symmetry *out,
                                    abbe_error *error);
void abbe_body_symmetry_free(abbe_body_symmetry *symmetry);

/* Which map brings a direction to where it is enough to know it, and there. The same place for all
 * directions that the maps bring onto each other. */
size_t abbe_body_symmetry_bring(const abbe_body_symmetry *symmetry, const double direction[3],
                                double out[3]);

#define ABBE_LIGHT_EXITS_MOST 131072 /* points */
#define ABBE_LIGHT_EXITS_BINS 256    /* bins of wavelengths, alike in width */

/* Halves of a point: place in the object's radii, unit normal of its face, bin of wavelengths; the
 * rest is 0. */
enum { ABBE_EXIT_POINT = 0, ABBE_EXIT_NORMAL = 3, ABBE_EXIT_BIN = 6 };
/* Halves of an exit: place in radii and unit direction, how both change with the light along the
 * two axes of the node (abbe_light_exits_axes), the share of the light that gets there, 0 where
 * none does, which facets the ray met: a whole number for each sequence, 0 where it is not known;
 * and how place and direction change with the object's index. */
enum {
  ABBE_EXIT_PLACE = 0,
  ABBE_EXIT_WAY = 3,
  ABBE_EXIT_PLACE_BY = 6,
  ABBE_EXIT_WAY_BY = 12,
  ABBE_EXIT_CARRIED = 18,
  ABBE_EXIT_FACETS = 19,
  ABBE_EXIT_PLACE_BY_INDEX = 20,
  ABBE_EXIT_WAY_BY_INDEX = 23,
  ABBE_EXIT_HALVES = 26
};
#define ABBE_EXIT_MOST_FACETS 2047 /* sequences: whole numbers that halves hold */

typedef uint16_t abbe_exit_halves[ABBE_EXIT_HALVES];

typedef struct abbe_light_exits {
  size_t points;       /* 0: there is no table */
  double radius, area; /* radius of the object, m; area of its surface, m2, in equal parts for the
                          points and what the maps make of them */
  abbe_body_symmetry symmetry;
  size_t cells;            /* cells of the region around it: */
  uint16_t *space;         /* [cells] halves: share of each that the object leaves free */
  abbe_exit_halves *point; /* [points] */
  size_t count;
  abbe_exit_halves
      *exit;    /* [count] by nodes, then by points, of those that face the node's light */
  uint32_t *at; /* [nodes][points] index of an exit and 1; 0: the point faces away */
} abbe_light_exits;

/* A table whose exits and space are 0. point[points] are its points, copied, and so is the symmetry
 * (NULL: none). ABBE_INVALID_ARGUMENT
 * for a number of points beyond 1 to ABBE_LIGHT_EXITS_MOST, sizes that are not above 0, and more
 * than ABBE_LIGHT_EXITS_MOST_EXITS exits, ABBE_NO_MEMORY. */
#define ABBE_LIGHT_EXITS_MOST_EXITS ((size_t)1 << 26)
abbe_result abbe_light_exits_make(const abbe_light_nodes *nodes, size_t points,
                                  const abbe_exit_halves *point, const abbe_body_symmetry *symmetry,
                                  double radius, double area, size_t cells, abbe_light_exits *out,
                                  abbe_error *error);
void abbe_light_exits_free(abbe_light_exits *exits);
size_t abbe_light_exits_bytes(const abbe_light_exits *exits); /* in memory, without the indices */

/* The probability of each bin of wavelengths for a point: by what the eye sees of equal energy, and
 * a part of it evenly, so that no wavelength starves; they sum to 1. */
void abbe_light_exits_chances(double min_nm, double max_nm, double chance[ABBE_LIGHT_EXITS_BINS]);

/* Two unit vectors across a node's direction; with it right-handed. */
void abbe_light_exits_axes(const double node[3], double x[3], double y[3]);

/* A light's direction between its nodes: their weights, and how far from each node the sum of the
 * nodes by them is along the node's axes. */
typedef struct abbe_exit_aim {
  abbe_node_blend blend;
  double far[3][2];
} abbe_exit_aim;
void abbe_light_exits_aim(const abbe_light_nodes *nodes, const double to_light[3],
                          abbe_exit_aim *out);

/* Whether a point's face may be turned to a light in that direction. */
bool abbe_light_exits_faces(const abbe_light_exits *exits, size_t point, const double to_light[3]);

typedef struct abbe_exit_ray {
  double place[3], way[3];       /* m from the object's centre; unit */
  double place_by[3], way_by[3]; /* their change with the object's index */
  double share;                  /* share of the light that came in at the point */
  double weight;                 /* probability of the path: share is so much of what takes it */
  unsigned facets;
} abbe_exit_ray;

/* A point's place, normal and bin. */
void abbe_light_exits_point(const abbe_light_exits *exits, size_t point, double place[3],
                            double normal[3], size_t *bin);

/* The rays of light that comes in at a point: at most three, of shares that sum to at most 1.
 * plane[planes] (n, d: n . x <= d): of a convex object, whose rays leave it on its surface; a ray
 * that does not is left out while there is another. Returns how many. */
size_t abbe_light_exits_at(const abbe_light_exits *exits, const abbe_exit_aim *aim, size_t point,
                           const double (*plane)[4], size_t planes, abbe_exit_ray ray[3]);

#endif
