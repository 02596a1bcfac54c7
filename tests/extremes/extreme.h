/* extreme.h: scenes and settings at the ends of what can be asked for, as one table of cases.
 *
 * A case is a small scene in units of its own, scaled and moved as a whole, and a request. It says
 * whether it renders or with which error it is refused; what must hold of every case that renders
 * is in laws.h. Heavy cases run at full size only where that is asked for.
 */
#ifndef ABBE_TESTS_EXTREMES_EXTREME_H
#define ABBE_TESTS_EXTREMES_EXTREME_H

#include "gl/plan/plan.h"
#include "scenes/import/scene_file.h"
#include "tests/extremes/report.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct extreme_light {
  const char *kind;     /* point, spot, directional or disk; NULL: no light */
  double at[3], way[3]; /* position in units; direction */
  double power;         /* of a scene of one metre a unit; 0: 1 */
} extreme_light;

/* Zero: a ball of n = 1.5 over a grey floor, lit by a lamp above it, one metre a unit. */
typedef struct extreme_scene {
  double n, b;              /* Cauchy's A and B (um2) of the material "glass" */
  double attenuation_per_m; /* of it, over the whole range */
  const char *objects;      /* PLACE in their transforms stands for the scene's own steps */
  const char *mesh;         /* text of an OBJ file, "solid.obj" in the objects */
  extreme_light light[2];   /* the first NULL: a lamp at (0.05, 0.03, 0.6) */
  double eye[3], target[3]; /* equal: (0, -1, 0.5) and (0, 0, 0.05) */
  double size, at[3];       /* metres a unit (0: 1), and where the origin stands, m */
} extreme_scene;

typedef struct extreme {
  const char *group, *name;
  bool each; /* three in one: a ball, a brick and a ring, in place of the scene's objects */
  extreme_scene scene;
  abbe_render_desc desc; /* zero fields: 48 x 48 pixels, 48 photons, a map of 96 */
  abbe_result refused;   /* ABBE_OK: it renders */
  const char *reason;    /* part of the refusal's sentence */
  bool by_device;        /* refused only once there is a device */
  bool heavy;            /* takes more than a second or a gigabyte: on request only */
  bool dark;             /* no light may reach a receiver through the refractor */
} extreme;

extern const extreme extremes[];
extern const size_t extreme_count;

/* Calls back for every case of the table that is wanted, each of three in one by itself. */
typedef void (*extreme_call)(void *user, const extreme *e);
void extreme_for_each(const extreme_report *report, extreme_call call, void *user);

#define EXTREME_FLOOR                                                                              \
  "- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5, transform: [PLACE]}\n"
#define EXTREME_BALL                                                                               \
  "- {name: ball, shape: sphere, radius: 0.08, levels: 3, material: glass, transform: "            \
  "[{translate: [0, 0, 0.2]}, PLACE]}\n"
#define EXTREME_BRICK                                                                              \
  "- {name: brick, shape: box, size: [0.1, 0.08, 0.06], material: glass, transform: "              \
  "[{rotate: {axis: [1, 1, 0], angle: 30}}, {translate: [0, 0, 0.2]}, PLACE]}\n"
#define EXTREME_RING                                                                               \
  "- {name: ring, shape: ring, major: 0.08, minor: 0.03, around: 48, across: 24, material: "       \
  "glass, "                                                                                        \
  "transform: [{translate: [0, 0, 0.2]}, PLACE]}\n"
#define EXTREME_GEM(sides)                                                                         \
  "- {name: gem, shape: gem, sides: " sides ", girdle: 0.1, table: 0.05, crown: 0.04, "            \
  "pavilion: 0.08, material: glass, transform: [{translate: [0, 0, 0.2]}, PLACE]}\n"
#define EXTREME_SOLID                                                                              \
  "- {name: solid, mesh: solid.obj, smooth: false, material: glass, "                              \
  "transform: [{translate: [0, 0, 0.2]}, PLACE]}\n"

/* The request with its small defaults. */
abbe_render_desc extreme_desc(const extreme *e);

/* Writes the scene's files into a folder of their own, loads them and removes them again. */
abbe_result extreme_load(const extreme_scene *scene, abbe_scene *out, abbe_error *error);

#endif
