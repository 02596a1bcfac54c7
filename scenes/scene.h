/* scene.h: what is there: camera, lights, surroundings, refractors and receivers, in world
 * coordinates.
 *
 * A scene is plain data, ready for the renderer, the tracer and the plan. Lengths in metres,
 * angles in radians, right-handed, z up by convention. Objects are refractors (a dielectric from
 * the material table, surrounded by air with n = 1), receivers (opaque, Lambertian, seen from both
 * sides) or mirrors (opaque, smooth or brushed, on both sides, whole or open).
 */
#ifndef ABBE_SCENES_SCENE_H
#define ABBE_SCENES_SCENE_H

#include "base/error.h"
#include "colorimetry/illuminant.h"
#include "colorimetry/image/image.h"
#include "scenes/coating/coating.h"
#include "scenes/environment/environment.h"
#include "scenes/environment/radiance_map.h"
#include "scenes/medium/medium.h"
#include "scenes/mesh/mesh.h"
#include "scenes/shapes/convex.h"
#include "scenes/shapes/shape.h"
#include "spectral/dispersion/dispersion.h"
#include "spectral/materials/material_table.h"
#include "spectral/spectrum.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_SCENE_MAX_LIGHTS 16
#define ABBE_SCENE_MAX_OBJECTS 1024
#define ABBE_SCENE_MAX_PLANES 256 /* planes of one convex refractor */

typedef enum abbe_polariser_kind {
  ABBE_POLARISER_NONE,
  ABBE_POLARISER_LINEAR,
  ABBE_POLARISER_RIGHT, /* circular: clockwise to one who looks into the light */
  ABBE_POLARISER_LEFT
} abbe_polariser_kind;

/* An ideal sheet, which passes half of unpolarised light. */
typedef struct abbe_polariser {
  abbe_polariser_kind kind;
  double angle_rad; /* linear: of what passes, from the horizontal, anticlockwise to one who looks
                       into the light of a light, or through the camera */
} abbe_polariser;

typedef struct abbe_camera {
  double eye[3], target[3], up[3];
  double fov_y_rad;     /* full vertical angle */
  size_t width, height; /* pixels of the scene's own picture, default 512 x 512 */
  bool inside;          /* the camera may be inside a refractor, as under water */
  double aperture;      /* m, the diameter of its pupil; 0: a pinhole, all is sharp */
  double focus;         /* m, how far along its view things are sharp; 0 of a pinhole */
  double exposure;      /* stops that a display adds, -60 to 60 */
  bool exposed;         /* not these: such as each picture's own light wants */
  abbe_polariser polariser;
} abbe_camera;

typedef enum abbe_light_kind {
  ABBE_LIGHT_POINT,       /* intensity, W/sr, all directions */
  ABBE_LIGHT_SPOT,        /* intensity, W/sr, inside a cone */
  ABBE_LIGHT_DIRECTIONAL, /* irradiance, W/m2, across the beam */
  ABBE_LIGHT_DISK,        /* radiance, W/(m2 sr), the same in all directions of its front side */
  ABBE_LIGHT_RECTANGLE    /* the same */
} abbe_light_kind;

typedef struct abbe_light {
  char *name;
  abbe_light_kind kind;
  double position[3];  /* point, spot; the centre of a disk or rectangle */
  double direction[3]; /* spot, directional: unit, the direction in which the light travels; disk,
                          rectangle: unit, the normal of the side that shines */
  double radius;       /* disk, m; rectangle: of the circle around it; directional: its tangent */
  double edge[2][3];   /* rectangle: half of its width and of its height, m */
  size_t points; /* disk, rectangle: of so many that stand for it (environment_lights.h), with power
                    in W/sr; 0 where it is whole, as in a scene as it is loaded */
  double centre[3]; /* centre of the light that the points stand for */
  double cone_rad;  /* spot: half angle beyond which there is no light */
  double soft_rad;  /* spot: full intensity inside cone - soft; smoothstep in the cosine between */
  double power;     /* W/sr, W/m2 or W/(m2 sr) over the rendered wavelength range, shared out over
                       wavelength by the illuminant */
  abbe_illuminant illuminant;
  char *illuminant_path;    /* the file that it is of, or NULL */
  abbe_polariser polariser; /* not of a point; `power` is without it */
} abbe_light;

typedef enum abbe_exact_kind {
  ABBE_EXACT_NONE, /* triangles only */
  ABBE_EXACT_SPHERE,
  ABBE_EXACT_CONVEX, /* intersection of half spaces */
  ABBE_EXACT_PARALLELOGRAMS
} abbe_exact_kind;

/* The exact surface behind the triangles, world space. */
typedef struct abbe_exact {
  abbe_exact_kind kind;
  double centre[3], radius;   /* SPHERE */
  size_t count;               /* planes or parallelograms */
  double (*plane)[4];         /* CONVEX: n . x <= d, unit n */
  double (*parallelogram)[9]; /* corner, edge u, edge v; normal = u x v */
  abbe_convex convex;         /* what was found, or why it is no convex solid */
} abbe_exact;

typedef enum abbe_object_kind {
  ABBE_OBJECT_RECEIVER,
  ABBE_OBJECT_REFRACTOR,
  ABBE_OBJECT_MIRROR
} abbe_object_kind;

typedef struct abbe_object {
  char *name;
  size_t line;    /* in the scene file */
  abbe_mesh mesh; /* world space */
  abbe_exact exact;
  double min[3], max[3]; /* bounds */
  double fitted;         /* what `fit` scaled it by about the origin, after `transform`; 1 */
  double centring[3];    /* by which `centre` moved it then, m; 0 */
  const abbe_material *material; /* refractor: of the scene's table or its own; else NULL */
  double axis[3];     /* a uniaxial crystal's optic axis in the world, or z of a biaxial one, unit;
                         of no meaning for other materials */
  double axis_x[3];   /* x of a biaxial crystal, unit and across z */
  double axes_turned; /* by how much x was turned to be so, radians */
  abbe_material *own_material; /* refractor: that of its mesh's file, owned, or NULL */
  abbe_medium *medium;         /* refractor: what scatters in it, owned, or NULL */
  bool cloud;                  /* refractor: a part of the one before it in which light is scattered
                                  otherwise, without a surface of its own */
  abbe_coatings *coatings;     /* refractor: films on it, owned, or NULL */
  abbe_coatings *roughness;    /* refractor: its rough facets, owned; NULL: all are polished */
  double reflectance[3];       /* receiver: linear Rec.709, 0 to 1, as reflected_light.h lifts it;
                                  of a spectrum: its colour under D65, kept within that */
  abbe_spectrum *spectrum;     /* receiver: its measured reflectance, owned; NULL: Rec.709's */
  char *spectrum_path;         /* the file that it is of, or NULL */
  char *texture_path;          /* receiver: NULL or the PNG that multiplies reflectance */
  abbe_image texture;          /* linear Rec.709, "R","G","B"; zeroed without a texture */
  double texture_repeat[2];
  bool mirror;
  bool holds; /* mirror: the metal around a refractor, which is tilted with it */
  const abbe_material *conductor; /* mirror: of its n and k, owned by the scene's table, or NULL: */
  double mirror_reflectance;      /* 0 to 1, at all angles and wavelengths */
  abbe_brushing brushing;         /* mirror: how rough it is */
  char *mesh_path;                /* NULL or the file that the mesh or the design is of */
  char *mesh_others;              /* and those that it names, as abbe_mesh_load has them */
  double cut_deg[2];              /* shape: cut: the design's own angles of the crown's and the
                                     pavilion's main facets; 0: there are none, or of a crown that
                                     follows the pavilion */
  char *fixes;                    /* what was fixed, and what is not whole still, or NULL */
} abbe_object;

typedef struct abbe_scene {
  char *path;
  char *description;
  double time; /* s: when waves and what has keyframes are as they are here */
  abbe_camera camera;
  size_t light_count; /* 0 only with an environment */
  abbe_light *light;
  size_t environment_lights;       /* so many at the end of light[] stand for the environment
                                      (environment_lights.h); 0 in a scene as it is loaded */
  abbe_irradiance_map *soft_light; /* what they leave of it, as irradiance without shadows, in its
                                      RGB; NULL in a scene as it is loaded */
  uint64_t surrounded_by;          /* a digest of what both were found from; 0: nothing was */
  abbe_environment *environment;   /* owned; NULL: dark surroundings */
  abbe_medium *medium;             /* the air's medium, owned, or NULL: it is clear */
  size_t object_count;
  abbe_object *object;
  abbe_material_table table;
  double ambient;    /* W/m2: uniform irradiance on every receiver, unshadowed by definition */
  double background; /* W/(m2 sr): radiance seen where nothing is hit */
  abbe_conditions conditions; /* of refractors and the air, as the file gives them */
  bool transparent; /* the camera sees nothing behind the objects: a picture to be laid over another
                       (view/coverage.h); what they refract and reflect stays */
} abbe_scene;

static inline abbe_object_kind abbe_object_kind_of(const abbe_object *object) {
  return object->mirror             ? ABBE_OBJECT_MIRROR
         : object->material != NULL ? ABBE_OBJECT_REFRACTOR
                                    : ABBE_OBJECT_RECEIVER;
}

/* "receiver", "refractor" or "mirror". */
static inline const char *abbe_object_kind_name(abbe_object_kind kind) {
  return kind == ABBE_OBJECT_MIRROR      ? "mirror"
         : kind == ABBE_OBJECT_REFRACTOR ? "refractor"
                                         : "receiver";
}

/* Whether light is scattered or absorbed in the air, or scattered in a refractor. */
bool abbe_scene_is_hazy(const abbe_scene *scene);

/* Whether there is a polariser on the camera or on a light. */
bool abbe_scene_is_polarised(const abbe_scene *scene);
/* A crystal that has another behind it as the camera or a light looks, to judge by balls around
 * them: what comes to it is polarised. NULL: there is none. */
const abbe_object *abbe_scene_crystal_in_line(const abbe_scene *scene);

/* Where a light's polariser has its angle 0 (across) and 90 degrees: unit, at right angles to the
 * direction; up is z, or y where it shines along z. */
void abbe_light_upright(const double direction[3], double across[3], double up[3]);

/* The first mirror, or NULL. */
const abbe_object *abbe_scene_mirror(const abbe_scene *scene);

/* A picture of the scene says its camera's exposure (screen_png.h), where that is not 0. */
abbe_result abbe_scene_mark_exposure(const abbe_scene *scene, abbe_image *image, abbe_error *error);

void abbe_scene_free(abbe_scene *scene);
/* A list of lights, and what they own. */
void abbe_lights_free(abbe_light *light, size_t count);

/* The illuminant of the first light, or of the environment where there is no light. */
const abbe_illuminant *abbe_scene_illuminant(const abbe_scene *scene);

/* The files that the scene was read from, each of index below the count: its own, the table of
 * materials, illuminants, surroundings, textures, meshes and what those name in turn; NULL where
 * there is none of that index. */
size_t abbe_scene_file_count(const abbe_scene *scene);
const char *abbe_scene_file(const abbe_scene *scene, size_t index);

/* A light or a camera nearer to a refractor's or mirror's surface than this share of half the
 * diagonal of all refractors' bounds (of all objects' where there is a mirror) is on it: single
 * precision does not resolve the side. */
#define ABBE_SCENE_LEAST_GAP 0x1p-20

/* Refuses what cannot be rendered, by name: neither light nor environment, no receiver without
 * surroundings, a light (a
 * disk: any part of it) inside a refractor or on its surface, the camera on one, inside one where
 * it does not say that it may be, or inside one that absorbs light or is a crystal, a light's
 * position or the camera on a mirror, no receiver and no mirror in the camera's view. Called by the
 * loader.
 */
abbe_result abbe_scene_check(const abbe_scene *scene, abbe_error *error);

/* Bounds of the objects chosen: refractors and mirrors, receivers, or both. False where there are
 * none. */
bool abbe_scene_bounds(const abbe_scene *scene, bool refractors, bool receivers, double min[3],
                       double max[3]);

/* Sets its bounds by its vertices, or its exact sphere. */
void abbe_object_bound(abbe_object *object);

/* Whether the point is inside the object, which is closed. */
bool abbe_object_contains(const abbe_object *object, const double point[3]);
/* The first refractor that the camera is inside of, or NULL. */
const abbe_object *abbe_scene_around_eye(const abbe_scene *scene);

/* From a point to the object's surface, m; to a sphere's exact one, negative inside it. */
double abbe_object_distance(const abbe_object *object, const double point[3]);
/* The same where it is below `most`, m, >= 0; else something from there on. It is found sooner. */
double abbe_object_distance_within(const abbe_object *object, const double point[3], double most);
/* Its least width, m, among those of its bounds, across its largest face and, of a convex solid,
 * across each face. */
double abbe_object_thickness(const abbe_object *object);

/* Index of the light of that name or, where none has it, of that number counted from 1.
 * ABBE_INVALID_ARGUMENT lists the names; also where several lights have it. */
abbe_result abbe_scene_find_light(const abbe_scene *scene, const char *text, size_t *index,
                                  abbe_error *error);

/* Whether it is a disk or a rectangle, whose area is in m2 (0 of the others); its flux is pi times
 * area times radiance. */
bool abbe_light_has_size(const abbe_light *light);
double abbe_light_area(const abbe_light *light);
/* Grows bounds until they hold every light that has a size. */
void abbe_scene_hold_lights(const abbe_scene *scene, double min[3], double max[3]);

/* Relative intensity of the light along the unit direction away from it, in [0, 1]; of a disk or a
 * rectangle, seen from afar: the cosine to its normal, 0 behind. */
double abbe_light_profile(const abbe_light *light, const double direction[3]);

#endif
