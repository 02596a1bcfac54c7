/* object_reading.h: what is known of an object of a scene file while it is read.
 * Internal to scenes/. */
#ifndef ABBE_SCENES_IMPORT_OBJECT_READING_H
#define ABBE_SCENES_IMPORT_OBJECT_READING_H

#include "base/yaml/yaml.h"
#include "scenes/mesh/mesh.h"
#include "scenes/scene.h"

/* Stands for the name of a material: the one that the mesh's file has. */
#define ABBE_OBJECT_FROM_FILE "from-file"

#define ABBE_OBJECT_RADIANS (3.14159265358979323846 / 180.0)

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

typedef struct abbe_object_reading {
  abbe_yaml *yaml;
  abbe_yaml_node node;
  const char *folder;
  abbe_object_form form;
  double radius;             /* of a sphere */
  abbe_mesh_normals normals; /* of a mesh */
  double matrix[16];         /* to world */
} abbe_object_reading;

/* The surface under `shape` or `mesh`, in its own coordinates, and its form, radius and normals. */
abbe_result abbe_object_read_surface(abbe_object_reading *reading, abbe_object *object,
                                     abbe_error *error);

/* Water at the scene's time. */
abbe_result abbe_object_read_water(const abbe_object_reading *reading, abbe_mesh *out,
                                   abbe_error *error);

#endif
