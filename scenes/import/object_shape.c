/* The surface of an object: one of the shapes, or the mesh of a file. */
#include "scenes/cuts/cut_file.h"

#include "scenes/cuts/cut_polyhedron.h"
#include "scenes/cuts/cut_stretch.h"
#include "scenes/import/mesh/gltf_material.h"
#include "scenes/import/scene_reading.h"
#include "scenes/import/scene_value.h"
#include "scenes/shapes/shape.h"
#include "scenes/shapes/water.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Water at the scene's time, as an object of a scene file describes it. */

static abbe_result need_water_length(abbe_yaml *yaml, abbe_yaml_node node, const char *key,
                                     double *out, abbe_error *error) {
  abbe_yaml_node ignored;
  ABBE_TRY(abbe_yaml_require(yaml, node, key, &ignored, error));
  return abbe_yaml_get_length(yaml, node, key, -ABBE_SCENE_FAR, ABBE_SCENE_FAR, out, error);
}

/* The list under key, of at most `most` mappings, with capacity for them in *room, zeroed. */
static abbe_result list_of(const abbe_object_reading *r, const char *key, size_t most, size_t size,
                           void **room, size_t *count, abbe_yaml_node *list, abbe_error *error) {
  *list = abbe_yaml_get(r->yaml, r->node, key);
  *count = abbe_yaml_count(r->yaml, *list);
  *room = NULL;
  if (list->id == 0) return ABBE_OK;
  if (!abbe_yaml_is_sequence(r->yaml, *list) || *count > most)
    return abbe_yaml_fail(r->yaml, *list, error, "'%s' wants a list of up to %zu", key, most);
  for (size_t i = 0; i < *count; i++)
    if (!abbe_yaml_is_mapping(r->yaml, abbe_yaml_item(r->yaml, *list, i)))
      return abbe_yaml_fail(r->yaml, abbe_yaml_item(r->yaml, *list, i), error,
                            "an entry of '%s' must be a mapping (key: value)", key);
  *room = calloc(*count + 1, size);
  return *room != NULL ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for '%s'", key);
}

static abbe_result read_wave(abbe_yaml *yaml, abbe_yaml_node node, abbe_water_wave *out,
                             abbe_error *error) {
  double direction = 0, phase = 0;
  ABBE_TRY(need_water_length(yaml, node, "amplitude", &out->amplitude, error));
  ABBE_TRY(need_water_length(yaml, node, "wavelength", &out->wavelength, error));
  ABBE_TRY(abbe_yaml_get_number(yaml, node, "direction", -3600, 3600, &direction, error));
  ABBE_TRY(abbe_yaml_get_number(yaml, node, "phase", -3600, 3600, &phase, error));
  out->direction_rad = direction * ABBE_DEGREE;
  out->phase_rad = phase * ABBE_DEGREE;
  return abbe_yaml_check_keys(yaml, node, "a wave", error);
}

static abbe_result read_drop(abbe_yaml *yaml, abbe_yaml_node node, abbe_water_drop *out,
                             abbe_error *error) {
  abbe_yaml_node ignored;
  ABBE_TRY(abbe_yaml_require(yaml, node, "at", &ignored, error));
  ABBE_TRY(
      abbe_yaml_get_lengths(yaml, node, "at", 2, -ABBE_SCENE_FAR, ABBE_SCENE_FAR, out->at, error));
  ABBE_TRY(
      abbe_yaml_get_number(yaml, node, "time", -ABBE_SCENE_FAR, ABBE_SCENE_FAR, &out->time, error));
  ABBE_TRY(need_water_length(yaml, node, "depth", &out->depth, error));
  ABBE_TRY(need_water_length(yaml, node, "radius", &out->radius, error));
  return abbe_yaml_check_keys(yaml, node, "a drop", error);
}

static abbe_result read_rain(const abbe_object_reading *r, abbe_water_rain *out,
                             abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, r->node, "rain");
  size_t seed = 0;
  if (node.id == 0) return ABBE_OK;
  if (!abbe_yaml_is_mapping(r->yaml, node))
    return abbe_yaml_fail(r->yaml, node, error, "'rain' must be a mapping (key: value)");
  abbe_yaml_node ignored;
  ABBE_TRY(abbe_yaml_require(r->yaml, node, "every", &ignored, error));
  ABBE_TRY(abbe_yaml_get_number(r->yaml, node, "every", -ABBE_SCENE_FAR, ABBE_SCENE_FAR,
                                &out->every, error));
  if (!(out->every > 0))
    return abbe_yaml_fail(r->yaml, abbe_yaml_get(r->yaml, node, "every"), error,
                          "'every' is the time between two drops, in seconds, above 0");
  ABBE_TRY(need_water_length(r->yaml, node, "depth", &out->depth, error));
  ABBE_TRY(need_water_length(r->yaml, node, "radius", &out->radius, error));
  ABBE_TRY(abbe_yaml_get_count(r->yaml, node, "seed", 0, UINT32_MAX, &seed, error));
  out->seed = (uint32_t)seed;
  return abbe_yaml_check_keys(r->yaml, node, "'rain'", error);
}

/* One number for both sides, or two. */
static abbe_result read_cells(const abbe_object_reading *r, size_t cells[2], abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, r->node, "cells");
  double number[2] = {0, 0};
  ABBE_TRY(abbe_yaml_is_sequence(r->yaml, node)
               ? abbe_yaml_get_numbers(r->yaml, r->node, "cells", 2, 1, ABBE_WATER_MOST_CELLS,
                                       number, error)
               : abbe_yaml_get_number(r->yaml, r->node, "cells", 1, ABBE_WATER_MOST_CELLS, number,
                                      error));
  if (node.id == 0) return ABBE_OK;
  if (!abbe_yaml_is_sequence(r->yaml, node)) number[1] = number[0];
  for (int k = 0; k < 2; k++) {
    cells[k] = (size_t)number[k];
    if ((double)cells[k] != number[k])
      return abbe_yaml_fail(r->yaml, node, error, "'cells' wants whole numbers");
  }
  return ABBE_OK;
}

/* Water at the scene's time. */
static abbe_result object_read_water(const abbe_object_reading *r, abbe_mesh *out,
                                     abbe_error *error) {
  abbe_water water = {0};
  abbe_yaml_node list;
  ABBE_FREED void *waves = NULL, *drops = NULL;
  ABBE_TRY(abbe_scene_value_point(r->yaml, r->node, "size", water.size, error));
  ABBE_TRY(abbe_scene_value_time(r->yaml, &water.time, error));
  ABBE_TRY(read_cells(r, water.cells, error));
  ABBE_TRY(list_of(r, "waves", ABBE_WATER_MOST_WAVES, sizeof *water.wave, &waves, &water.wave_count,
                   &list, error));
  for (size_t i = 0; i < water.wave_count; i++)
    ABBE_TRY(
        read_wave(r->yaml, abbe_yaml_item(r->yaml, list, i), (abbe_water_wave *)waves + i, error));
  ABBE_TRY(list_of(r, "drops", 4096, sizeof *water.drop, &drops, &water.drop_count, &list, error));
  for (size_t i = 0; i < water.drop_count; i++)
    ABBE_TRY(
        read_drop(r->yaml, abbe_yaml_item(r->yaml, list, i), (abbe_water_drop *)drops + i, error));
  ABBE_TRY(read_rain(r, &water.rain, error));
  water.wave = waves;
  water.drop = drops;
  return abbe_water_make(&water, out, error);
}

static const char *const shape_names[] = {"sphere",    "ring",  "gem", "brilliant", "prism", "box",
                                          "rectangle", "lathe", "cut", "water",     "knot",  NULL};

/* A length that must be there; the shape itself says that it must be above zero. */
static abbe_result need_length(const abbe_object_reading *r, const char *key, double *out,
                               abbe_error *error) {
  abbe_yaml_node ignored;
  ABBE_TRY(abbe_yaml_require(r->yaml, r->node, key, &ignored, error));
  return abbe_yaml_get_length(r->yaml, r->node, key, -ABBE_SCENE_FAR, ABBE_SCENE_FAR, out, error);
}

static abbe_result read_count(const abbe_object_reading *r, const char *key, size_t min, size_t max,
                              size_t *out, abbe_error *error) {
  return abbe_yaml_get_count(r->yaml, r->node, key, min, max, out, error);
}

/* --- shapes --- */

static abbe_result read_sphere(abbe_object_reading *r, abbe_mesh *out, abbe_error *error) {
  size_t levels = 4;
  ABBE_TRY(need_length(r, "radius", &r->radius, error));
  ABBE_TRY(read_count(r, "levels", 0, 9, &levels, error));
  return abbe_shape_sphere(r->radius, levels, out, error);
}

static abbe_result read_ring(const abbe_object_reading *r, abbe_mesh *out, abbe_error *error) {
  double major = 0.0, minor = 0.0;
  size_t around = 256, across = 128;
  ABBE_TRY(need_length(r, "major", &major, error));
  ABBE_TRY(need_length(r, "minor", &minor, error));
  ABBE_TRY(read_count(r, "around", 3, 4096, &around, error));
  ABBE_TRY(read_count(r, "across", 3, 4096, &across, error));
  return abbe_shape_ring(major, minor, around, across, out, error);
}

static abbe_result read_knot(const abbe_object_reading *r, abbe_mesh *out, abbe_error *error) {
  abbe_knot knot = {.spine = 0.5};
  const struct {
    const char *key;
    size_t most, *count;
  } counts[] = {{"turns", ABBE_KNOT_MAX_WINDINGS, &knot.turns},
                {"coils", ABBE_KNOT_MAX_WINDINGS, &knot.coils},
                {"spines", ABBE_KNOT_MAX_SPINES, &knot.spines},
                {"along", ABBE_KNOT_MAX_SEGMENTS, &knot.along},
                {"across", ABBE_KNOT_MAX_SEGMENTS, &knot.across}};
  ABBE_TRY(need_length(r, "major", &knot.major, error));
  ABBE_TRY(need_length(r, "minor", &knot.minor, error));
  ABBE_TRY(need_length(r, "radius", &knot.radius, error));
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
    ABBE_TRY(read_count(r, counts[i].key, 1, counts[i].most, counts[i].count, error));
  ABBE_TRY(abbe_yaml_get_number(r->yaml, r->node, "spine", 0, 2, &knot.spine, error));
  return abbe_knot_make(&knot, out, error);
}

static abbe_result read_gem(const abbe_object_reading *r, abbe_mesh *out, abbe_error *error) {
  static const char *const keys[] = {"girdle", "table", "crown", "pavilion"};
  double length[4] = {0};
  size_t sides = 6;
  ABBE_TRY(read_count(r, "sides", 3, 1024, &sides, error));
  for (int i = 0; i < 4; i++) ABBE_TRY(need_length(r, keys[i], &length[i], error));
  return abbe_shape_gem(sides, length[0], length[1], length[2], length[3], out, error);
}

/* Angles in degrees, the rest in shares of the diameter or of the distance; 0 stays the default. */
static abbe_result read_brilliant(const abbe_object_reading *r, abbe_mesh *out, abbe_error *error) {
  abbe_brilliant cut = {0};
  double crown = 34.5, pavilion = 40.75;
  const struct {
    const char *key;
    double *value;
  } keys[] = {{"table", &cut.table},   {"star", &cut.star}, {"lower", &cut.lower},
              {"girdle", &cut.girdle}, {"crown", &crown},   {"pavilion", &pavilion}};
  ABBE_TRY(need_length(r, "diameter", &cut.diameter, error));
  for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
    ABBE_TRY(abbe_yaml_get_number(r->yaml, r->node, keys[i].key, 1e-6, 90, keys[i].value, error));
  cut.crown_rad = crown * ABBE_DEGREE;
  cut.pavilion_rad = pavilion * ABBE_DEGREE;
  return abbe_brilliant_make(&cut, out, error);
}

static abbe_result read_prism(const abbe_object_reading *r, abbe_mesh *out, abbe_error *error) {
  double apex = 60.0, side = 0.0, length = 0.0;
  ABBE_TRY(abbe_yaml_get_number(r->yaml, r->node, "apex", -360, 360, &apex, error));
  ABBE_TRY(need_length(r, "side", &side, error));
  ABBE_TRY(need_length(r, "length", &length, error));
  return abbe_shape_prism(apex * ABBE_DEGREE, side, length, out, error);
}

static abbe_result read_box(const abbe_object_reading *r, abbe_mesh *out, abbe_error *error) {
  double size[3] = {0};
  ABBE_TRY(abbe_scene_value_point(r->yaml, r->node, "size", size, error));
  return abbe_shape_box(size, out, error);
}

static abbe_result read_rectangle(const abbe_object_reading *r, abbe_mesh *out, abbe_error *error) {
  double width = 0.0, height = 0.0;
  ABBE_TRY(need_length(r, "width", &width, error));
  ABBE_TRY(need_length(r, "height", &height, error));
  return abbe_shape_rectangle(width, height, out, error);
}

/* The list of [r, z] pairs under "profile". */
static abbe_result read_profile(const abbe_object_reading *r, double (**out)[2], size_t *count,
                                abbe_error *error) {
  abbe_yaml_node list;
  abbe_result result = abbe_yaml_require(r->yaml, r->node, "profile", &list, error);
  if (result != ABBE_OK) return result;
  *count = abbe_yaml_count(r->yaml, list);
  if (!abbe_yaml_is_sequence(r->yaml, list) || *count < 2 || *count > ABBE_SHAPE_MAX_PROFILE)
    return abbe_yaml_fail(r->yaml, list, error, "'profile' wants a list of 2 to %u points [r, z]",
                          ABBE_SHAPE_MAX_PROFILE);
  double(*profile)[2] = malloc(*count * sizeof *profile);
  if (!profile) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a lathe profile");
  for (size_t i = 0; i < *count && result == ABBE_OK; i++) {
    const abbe_yaml_node point = abbe_yaml_item(r->yaml, list, i);
    if (!abbe_yaml_is_sequence(r->yaml, point) || abbe_yaml_count(r->yaml, point) != 2)
      result = abbe_yaml_fail(r->yaml, point, error, "a point of 'profile' is two numbers [r, z]");
    for (size_t k = 0; k < 2 && result == ABBE_OK; k++)
      result = abbe_yaml_length(r->yaml, abbe_yaml_item(r->yaml, point, k), "profile",
                                -ABBE_SCENE_FAR, ABBE_SCENE_FAR, &profile[i][k], error);
  }
  if (result == ABBE_OK)
    *out = profile;
  else
    free(profile);
  return result;
}

static abbe_result read_lathe(const abbe_object_reading *r, abbe_mesh *out, abbe_error *error) {
  size_t around = 96, round = 0, count = 0, rounded_count = 0;
  double(*profile)[2] = NULL, (*rounded)[2] = NULL;
  abbe_result result = read_count(r, "around", 3, 4096, &around, error);
  if (result == ABBE_OK) result = read_count(r, "round", 0, 8, &round, error);
  if (result == ABBE_OK) result = read_profile(r, &profile, &count, error);
  if (result == ABBE_OK && abbe_yaml_get(r->yaml, r->node, "material").id != 0 &&
      (profile[0][0] != 0 || profile[count - 1][0] != 0))
    result = abbe_yaml_fail(r->yaml, abbe_yaml_get(r->yaml, r->node, "profile"), error,
                            "the 'profile' of a refractor begins and ends on the axis, r = 0, so "
                            "that it encloses a volume; this one is open");
  if (result == ABBE_OK)
    result = abbe_shape_round_profile((const double(*)[2])profile, count, round, &rounded,
                                      &rounded_count, error);
  if (result == ABBE_OK)
    result = abbe_shape_lathe((const double(*)[2])rounded, rounded_count, around, out, error);
  free(profile);
  free(rounded);
  return result;
}

typedef struct cut_reading {
  double width, weld;
  double to_deg[2]; /* angles of the main facets on crown and pavilion; 0: as the design has them */
} cut_reading;

/* The stone at other angles. */
static abbe_result stretch(const cut_reading *q, abbe_cut *cut, abbe_cut_polyhedron *stone,
                           abbe_error *error) {
  ABBE_OWNED(abbe_cut_polyhedron, own) = *stone;
  *stone = (abbe_cut_polyhedron){0};
  ABBE_TRY(abbe_cut_stretch_to(cut, &own, q->to_deg[0], q->to_deg[1], error));
  return abbe_cut_polyhedron_make(cut, q->weld, stone, error);
}

/* Names of its facets, for what is said of some of them. */
static abbe_result name_facets(abbe_object_reading *r, const abbe_cut *cut, abbe_error *error) {
  if (abbe_yaml_get(r->yaml, r->node, "coating").id == 0 &&
      abbe_yaml_get(r->yaml, r->node, "roughness").id == 0)
    return ABBE_OK;
  r->facet = calloc(cut->facet_count + 1, sizeof *r->facet);
  if (r->facet == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for facets");
  for (size_t i = 0; i < cut->facet_count; i++) {
    memcpy(r->facet[i].n, cut->facet[i].n, sizeof r->facet[i].n);
    snprintf(r->facet[i].name, sizeof r->facet[i].name, "%s", abbe_cut_facet_name(cut, i));
  }
  r->facet_count = cut->facet_count;
  return ABBE_OK;
}

/* The planes of a design as wide as it is to be: the smaller extent of its outline. */
static abbe_result make_cut(abbe_object_reading *r, const cut_reading *q, abbe_object *object,
                            abbe_error *error) {
  ABBE_OWNED(abbe_cut, cut) = {0};
  ABBE_OWNED(abbe_cut_polyhedron, stone) = {0};
  ABBE_TRY(abbe_cut_file_read_stone(object->mesh_path, q->weld, &cut, &stone, NULL, error));
  if (!abbe_cut_stretch_bound(&cut, &stone)) /* else the pavilion's moves both */
    object->cut_deg[0] = abbe_cut_stretch_main_deg(&cut, &stone, ABBE_CUT_CROWN);
  object->cut_deg[1] = abbe_cut_stretch_main_deg(&cut, &stone, ABBE_CUT_PAVILION);
  if (q->to_deg[0] > 0 || q->to_deg[1] > 0) ABBE_TRY(stretch(q, &cut, &stone, error));
  const double own = fmin(stone.max[0] - stone.min[0], stone.max[1] - stone.min[1]);
  ABBE_TRY(abbe_cut_polyhedron_mesh(&cut, &stone, q->width / own, &object->mesh, error));
  return name_facets(r, &cut, error);
}

/* The angle of a side's main facets. */
static abbe_result read_cut_angle(const abbe_object_reading *r, const char *key, double *out,
                                  abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, r->node, key);
  if (node.id == 0) return ABBE_OK;
  ABBE_TRY(abbe_yaml_number(r->yaml, node, key, -360, 360, out, error));
  if (*out > 0 && *out < 90) return ABBE_OK;
  return abbe_yaml_fail(r->yaml, node, error,
                        "'%s' is the angle of that side's main facets, between 0 and 90 degrees",
                        key);
}

static abbe_result read_cut(abbe_object_reading *r, abbe_object *object, abbe_error *error) {
  cut_reading q = {.weld = ABBE_CUT_WELD};
  ABBE_FREED char *name = NULL;
  abbe_yaml_node ignored;
  ABBE_TRY(abbe_yaml_require(r->yaml, r->node, "file", &ignored, error));
  ABBE_TRY(abbe_yaml_get_string(r->yaml, r->node, "file", &name, error));
  ABBE_TRY(need_length(r, "width", &q.width, error));
  if (!(q.width > 0))
    return abbe_yaml_fail(r->yaml, abbe_yaml_get(r->yaml, r->node, "width"), error,
                          "'width' is the stone's, in metres, above 0");
  ABBE_TRY(
      abbe_yaml_get_number(r->yaml, r->node, "weld", 1e-12, ABBE_CUT_MOST_WELD, &q.weld, error));
  ABBE_TRY(read_cut_angle(r, "crown", &q.to_deg[0], error));
  ABBE_TRY(read_cut_angle(r, "pavilion", &q.to_deg[1], error));
  if ((object->mesh_path = abbe_scene_value_path(r->folder, name)) == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
  return make_cut(r, &q, object, error);
}

/* Reads 'material: from-file'; *part becomes the name of the material whose triangles are meant. */
static abbe_result read_own_material(const abbe_object_reading *r, abbe_object *out, char **part,
                                     abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, r->node, "material");
  const char *text = abbe_yaml_text(r->yaml, node);
  char *name = NULL;
  if (text == NULL || strcmp(text, ABBE_OBJECT_FROM_FILE) != 0) return ABBE_OK;
  out->own_material = calloc(1, sizeof *out->own_material);
  if (out->own_material == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a material");
  ABBE_TRY(abbe_gltf_material_load(out->mesh_path, *part, out->own_material, &name, error));
  free(*part);
  *part = name;
  return ABBE_OK;
}

static abbe_result read_mesh(abbe_object_reading *r, abbe_object *out, abbe_error *error) {
  const bool says = abbe_yaml_get(r->yaml, r->node, "smooth").id != 0;
  ABBE_FREED char *name = NULL, *part = NULL;
  size_t levels = 0;
  bool smooth = true;
  ABBE_TRY(abbe_yaml_get_string(r->yaml, r->node, "mesh", &name, error));
  ABBE_TRY(abbe_yaml_get_string(r->yaml, r->node, "part", &part, error));
  ABBE_TRY(abbe_yaml_get_bool(r->yaml, r->node, "smooth", &smooth, error));
  ABBE_TRY(read_count(r, "subdivide", 0, 8, &levels, error));
  if (levels > 0 && !smooth)
    return abbe_yaml_fail(r->yaml, r->node, error,
                          "'subdivide' makes a smooth surface; leave it out or leave out "
                          "'smooth: false'");
  if (says || levels > 0) r->normals = smooth ? ABBE_NORMALS_SMOOTH : ABBE_NORMALS_FLAT;
  out->mesh_path = abbe_scene_value_path(r->folder, name);
  if (!out->mesh_path) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
  ABBE_TRY(read_own_material(r, out, &part, error));
  ABBE_TRY(
      abbe_mesh_load_part(out->mesh_path, part, r->normals, &out->mesh, &out->mesh_others, error));
  if (levels > 0) ABBE_TRY(abbe_mesh_subdivide(&out->mesh, levels, error));
  return ABBE_OK;
}

abbe_result abbe_object_read_surface(abbe_object_reading *r, abbe_object *object,
                                     abbe_error *error) {
  abbe_mesh *out = &object->mesh;
  const abbe_yaml_node shape = abbe_yaml_get(r->yaml, r->node, "shape");
  const abbe_yaml_node mesh = abbe_yaml_get(r->yaml, r->node, "mesh");
  if (shape.id == 0 && mesh.id == 0) {
    abbe_result mistyped = abbe_yaml_refuse_near(r->yaml, r->node, "shape", error);
    if (mistyped == ABBE_OK) mistyped = abbe_yaml_refuse_near(r->yaml, r->node, "mesh", error);
    if (mistyped != ABBE_OK) return mistyped;
  }
  if ((shape.id != 0) == (mesh.id != 0))
    return abbe_yaml_fail(r->yaml, r->node, error,
                          "an object has either a 'shape' or a 'mesh' file; this one has %s",
                          shape.id ? "both" : "neither");
  int form = ABBE_OBJECT_MESH;
  abbe_result result = abbe_yaml_get_choice(r->yaml, r->node, "shape", shape_names, &form, error);
  if (result != ABBE_OK) return result;
  r->form = (abbe_object_form)form;
  switch (r->form) {
  case ABBE_OBJECT_SPHERE:
    result = read_sphere(r, out, error);
    break;
  case ABBE_OBJECT_RING:
    result = read_ring(r, out, error);
    break;
  case ABBE_OBJECT_GEM:
    result = read_gem(r, out, error);
    break;
  case ABBE_OBJECT_BRILLIANT:
    result = read_brilliant(r, out, error);
    break;
  case ABBE_OBJECT_PRISM:
    result = read_prism(r, out, error);
    break;
  case ABBE_OBJECT_BOX:
    result = read_box(r, out, error);
    break;
  case ABBE_OBJECT_RECTANGLE:
    result = read_rectangle(r, out, error);
    break;
  case ABBE_OBJECT_LATHE:
    result = read_lathe(r, out, error);
    break;
  case ABBE_OBJECT_CUT:
    result = read_cut(r, object, error);
    break;
  case ABBE_OBJECT_WATER:
    result = object_read_water(r, out, error);
    break;
  case ABBE_OBJECT_KNOT:
    result = read_knot(r, out, error);
    break;
  case ABBE_OBJECT_MESH:
    result = read_mesh(r, object, error);
    break;
  }
  /* schema errors carry their line already; the geometry's own sentences do not */
  if (result != ABBE_OK && result != ABBE_SCHEMA)
    return abbe_scene_value_locate(r->yaml, shape.id ? shape : mesh, result, error);
  return result;
}
