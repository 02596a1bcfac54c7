/* gltf_material.h: a stone's material as a glTF file has it, by cJSON.
 *
 * KHR_materials_ior and KHR_materials_dispersion give Cauchy's two terms through n_d and V_d
 * [glTFDispersion], KHR_materials_volume the attenuation by a colour. What Abbe does not model of
 * it (a tint, roughness, textures) is in the record's warning. It reads no meshes.
 * Internal to scenes/.
 */
#ifndef ABBE_SCENES_IMPORT_MESH_GLTF_MATERIAL_H
#define ABBE_SCENES_IMPORT_MESH_GLTF_MATERIAL_H

#include "base/error.h"
#include "spectral/materials/material.h"

#define ABBE_GLTF_MOST_DISPERSION 1e3

/* The material called part, or, where part is NULL, the only one that transmits light, of a .gltf
 * or .glb file. *name gets its name, malloc'd, where the file has others besides, else NULL.
 * ABBE_UNSUPPORTED for a file of another kind, a material that does not transmit or is a thin wall
 * (no KHR_materials_volume, or a thickness of 0), and an ior of 0; ABBE_NOT_FOUND, with the names
 * that there are, where none or several transmit and for a name that none or several have;
 * ABBE_PARSE and ABBE_SCHEMA with the key and its value, ABBE_IO, ABBE_NO_MEMORY. */
abbe_result abbe_gltf_material_load(const char *path, const char *part, abbe_material *out,
                                    char **name, abbe_error *error);

#endif
