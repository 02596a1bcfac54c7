/* scene_reading.h: the parts of a scene file (scene_file.h), each with a reader of its own:
 * objects, camera, lights, surroundings, reflectances; and values that are changed before any is
 * read.
 *
 * Internal to scenes/.
 */
#ifndef ABBE_SCENES_IMPORT_SCENE_READING_H
#define ABBE_SCENES_IMPORT_SCENE_READING_H

#include "base/error.h"
#include "base/maths.h"
#include "base/yaml/yaml.h"
#include "base/yaml/yaml_edit.h"
#include "scenes/environment/environment.h"
#include "scenes/environment/environment_source.h"
#include "scenes/mesh/mesh.h"
#include "scenes/scene.h"

#include <stdbool.h>
#include <stddef.h>

/* Stands for the name of a material: the one that the mesh's file has. */
#define ABBE_OBJECT_FROM_FILE "from-file"

typedef enum abbe_object_form {
  ABBE_OBJECT_SPHERE,
  ABBE_OBJECT_RING,
  ABBE_OBJECT_GEM,
  ABBE_OBJECT_BRILLIANT,
  ABBE_OBJECT_PRISM,
  ABBE_OBJECT_BOX,
  ABBE_OBJECT_RECTANGLE,
  ABBE_OBJECT_LATHE,
  ABBE_OBJECT_CUT,
  ABBE_OBJECT_WATER,
  ABBE_OBJECT_KNOT,
  ABBE_OBJECT_MESH
} abbe_object_form;

/* A facet of a cut, in the object's own coordinates. */
typedef struct abbe_named_facet {
  double n[3];
  char name[32];
} abbe_named_facet;

typedef struct abbe_object_reading {
  abbe_yaml *yaml;
  abbe_yaml_node node;
  const char *folder;
  abbe_object_form form;
  double radius;             /* a sphere's */
  abbe_mesh_normals normals; /* a mesh's */
  double matrix[16];         /* to world */
  abbe_named_facet *facet;   /* [facet_count] of a cut that is coated or rough; owned */
  size_t facet_count;
} abbe_object_reading;

/* `axis` or `axes` of a crystal, in the object's own coordinates; without them x and z as they are
 * named. */
abbe_result abbe_object_read_axes(const abbe_object_reading *reading, abbe_object *object,
                                  abbe_error *error);

/* `coating` and the `roughness` of what refracts, and once the object is placed which of its faces
 * have which. */
abbe_result abbe_object_read_coating(const abbe_object_reading *reading,
                                     const abbe_material_table *table, abbe_object *object,
                                     abbe_error *error);
abbe_result abbe_object_settle_coating(const abbe_object_reading *reading, abbe_object *object,
                                       abbe_error *error);

/* `clouds` of the object that is placed at out[0], as further objects behind it, *count in all and
 * fewer than `room`. */
abbe_result abbe_object_read_clouds(const abbe_object_reading *reading, abbe_object *out,
                                    size_t room, size_t *count, abbe_error *error);

/* The surface under `shape` or `mesh`, in its own coordinates, and its form, radius and normals. */
abbe_result abbe_object_read_surface(abbe_object_reading *reading, abbe_object *object,
                                     abbe_error *error);

#define ABBE_SETTINGS_MOST 4 /* settings of one stone */

/* A scene's camera: as its file has it, or placed so that objects fill the picture. */

/* The values under 'camera'. With 'frame' its place and target are not there yet. Errors with file,
 * line and key. */
abbe_result abbe_camera_read(abbe_yaml *yaml, abbe_yaml_node root, abbe_camera *out,
                             abbe_error *error);

/* What 'frame' leaves open, once the scene has its objects: the target is the middle of those
 * objects as they are seen, the camera as near as lets them fill the share 'fill' of the picture's
 * width or height, whichever comes first. Then the whole camera is checked. ABBE_SCHEMA for an
 * object that is not there, with the nearest name. */
abbe_result abbe_camera_frame(abbe_yaml *yaml, abbe_yaml_node root, abbe_scene *scene,
                              abbe_error *error);

/* The lights of a scene file, key `lights` (docs/scene-files.md).
 *
 * A part of scene_file.h. It reads what an entry says and whether it can be so; where lights stand
 * to all else is abbe_scene_check's business. */

/* The lights of the document whose root is given; relative paths start at folder. Errors say file
 * and line; what *out holds then is the caller's to free too (abbe_lights_free). */
abbe_result abbe_lights_read(abbe_yaml *yaml, abbe_yaml_node root, const char *folder,
                             abbe_light **out, size_t *count, abbe_error *error);

/* One object of a scene file: its shape or mesh, its transform, what it is made of.
 *
 * A part of scene_file.h with the keys of an entry under "objects"; docs/scene-files.md documents
 * them. It reads, tessellates, places, checks and fixes one object; the scene as a whole is
 * scene_file's business. */

/* Reads the mapping at node into out[0], and where shells of its mesh cross into further objects
 * behind it, *count in all and at most room (zeroed before; freed with the scene, also on failure).
 * folder is the scene file's, with its slash, or "". Materials are found in table. */
abbe_result abbe_object_read(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                             const abbe_material_table *table, abbe_object *out, size_t room,
                             size_t *count, abbe_error *error);

/* The surroundings of a scene file, key `environment` (docs/scene-files.md): a picture, or sources
 * that are computed, or both added up. */

#define ABBE_ENVIRONMENT_MAX_SOURCES 256 /* for one list */

/* Reads the node into a zeroed *out and prepares it; relative paths start at folder. Errors say
 * file and line; what *out holds then is the caller's to free. */
abbe_result abbe_environment_read(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                                  abbe_environment *out, abbe_error *error);

/* What the readers of surroundings share. */

/* A receiver's measured reflectance, as a scene file asks for it: {spectrum: FILE, column: NAME}
 * or {patch: NAME} of the ColorChecker.
 *
 * A part of scene_reading.h, which reads numbers. */

/* Fills the object's spectrum, its path and the colour under D65. Paths are relative to folder.
 * ABBE_SCHEMA and ABBE_NOT_FOUND with file, line and key; errors of the file. */
abbe_result abbe_reflectance_file_read(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                                       abbe_object *out, abbe_error *error);

/* An object's surface in the world: fixed, placed, split into solids, known exactly where it can
 * be.
 *
 * A part of scene_reading.h, which reads the keys. Here a refractor's mesh becomes a closed
 * surface, shells that cross become solids of their own, and the surface gets its size and
 * place. */

typedef struct abbe_object_surface {
  double matrix[16]; /* from its own coordinates to the world */
  double radius;     /* a sphere's, in its own coordinates; 0: it is none */
  bool rectangles;   /* its mesh is made of them, four vertices each */
  bool file;         /* its mesh is a file's */
  abbe_mesh_normals normals;
  double flatten; /* share of its size by which it is made a convex solid of planes, or 0 */
  double fit;     /* the longest side of its bounds, m, or 0: as it is */
  double width;   /* the smaller of their sides along x and y, m, or 0 */
  bool centred, stands;
  double centre[3]; /* where the middle of its bounds comes to stand, or of their lower side */
  const abbe_object *setting; /* [setting_count] what stands with it, in its own coordinates */
  size_t setting_count;
} abbe_object_surface;

/* Makes, from out->mesh in its own coordinates and out's material and name, all the rest. Shells
 * that cross become further objects behind out, *count in all, up to the capacity `room` (zeroed
 * before). ABBE_GEOMETRY for what cannot be a surface, of a refractor: in the mesh's own
 * coordinates; ABBE_UNSUPPORTED for more objects than the capacity. */
abbe_result abbe_object_place(const abbe_object_surface *surface, abbe_object *out, size_t room,
                              size_t *count, abbe_error *error);

/* Metres that one unit of the mesh's own coordinates is where it is placed: of all directions the
 * geometric mean. 0 where it has no size. */
double abbe_object_unit(const abbe_object_surface *surface, const abbe_mesh *mesh);

/* The metal around the stone, whose mesh is in its own coordinates still, and will be placed as
 * the surface says: *count objects in the same coordinates, for which a scene has room. Errors with
 * file, line and key. */
abbe_result abbe_setting_read(const abbe_object_reading *reading, const abbe_material_table *table,
                              const abbe_object *stone, const abbe_object_surface *surface,
                              size_t room, abbe_object out[ABBE_SETTINGS_MOST], size_t *count,
                              abbe_error *error);

/* Where the stone was placed (`before` is ABBE_OK), the metal around it moves the same way and
 * behind the *count objects at out; else it is freed. Returns what was before, or what fails. */
abbe_result abbe_setting_place(const abbe_object_surface *surface, abbe_result before,
                               abbe_object metal[ABBE_SETTINGS_MOST], abbe_object *out,
                               size_t *count, abbe_error *error);

/* Values of a scene file that are put in the place of others before it is read, so that what is
 * wrong with them is said as of any value of the file. It knows no key of the format but
 * 'objects', 'material', 'time' and 'keyframes'. */

/* "PATH=VALUE": PATH is keys with dots between them, and for an item of a list its number from 0 or
 * its 'name' (lights.lamp.intensity); VALUE is one line of YAML. The last key may be a new one.
 * "PATH=": what is there is taken out, as if it had never stood there. ABBE_INVALID_ARGUMENT for a
 * path that leads nowhere, with the nearest key or name. */
abbe_result abbe_scene_change_set(abbe_yaml_edit *edit, const char *assignment, abbe_error *error);

/* The number, or the length in m, at such a path. ABBE_INVALID_ARGUMENT for what is none, with one
 * that is near, and for a path that leads nowhere. */
abbe_result abbe_scene_change_number(const abbe_yaml_edit *edit, const char *path, double *value,
                                     abbe_error *error);

/* "STONE": what all refractors are made of, which must be one material; or "NAME=STONE": what is
 * made of the material NAME, or the object NAME. ABBE_INVALID_ARGUMENT where nothing is. */
abbe_result abbe_scene_change_material(abbe_yaml_edit *edit, const char *text, abbe_error *error);

/* Whether some value of the document is a mapping with 'keyframes'. */
bool abbe_scene_change_has_keyframes(const abbe_yaml *yaml);

/* Each {keyframes: [[TIME, VALUE], ...], repeat: SECONDS} becomes its value at the scene's 'time':
 * numbers or lists of as many numbers, straight lines between them, the first before and the last
 * behind; with 'repeat' the time counts from 0 to it again and again. ABBE_SCHEMA with file, line
 * and key for what is none. */
abbe_result abbe_scene_change_keyframes(abbe_yaml_edit *edit, abbe_error *error);

#endif
