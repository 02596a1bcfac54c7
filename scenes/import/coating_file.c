/* The keys 'coating' and, of what refracts, 'roughness' of an object: layers, a coating of a file,
 * or how rough it is, on the object or on some facets. */
#include "scenes/import/scene_reading.h"

#include "scenes/coating/coating.h"
#include "scenes/import/scene_value.h"
#include "spectral/microfacets.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define MOST_INDEX 20.0

/* --- layers --- */

/* An index, [n, k], or the name of a material. */
static abbe_result read_stuff(const abbe_object_reading *r, abbe_yaml_node node,
                              const abbe_material_table *table, abbe_coating_layer *out,
                              abbe_error *error) {
  const char *text = abbe_yaml_text(r->yaml, node);
  const bool pair = abbe_yaml_is_sequence(r->yaml, node) && abbe_yaml_count(r->yaml, node) == 2;
  const abbe_yaml_node n = pair ? abbe_yaml_item(r->yaml, node, 0) : node;
  if (text != NULL && strchr("0123456789.+-", text[0]) == NULL) {
    const abbe_result result = abbe_material_table_find(table, text, &out->material, error);
    return result == ABBE_OK ? ABBE_OK : abbe_scene_value_locate(r->yaml, node, result, error);
  }
  if (!pair && text == NULL)
    return abbe_yaml_fail(r->yaml, node, error,
                          "a layer is of a material, an index or [n, k], such as MgF2, 1.38 or "
                          "[0.42, 2.4]");
  ABBE_TRY(
      abbe_yaml_number(r->yaml, n, "the index of a layer", 0, MOST_INDEX, &out->index[0], error));
  if (!(out->index[0] > 0))
    return abbe_yaml_fail(r->yaml, n, error, "the index of a layer is above 0");
  if (pair)
    ABBE_TRY(abbe_yaml_number(r->yaml, abbe_yaml_item(r->yaml, node, 1), "k of a layer", 0,
                              MOST_INDEX, &out->index[1], error));
  return ABBE_OK;
}

/* [what, thickness]: nm, or quarters of the wavelength quarter_nm in it. */
static abbe_result read_layer(const abbe_object_reading *r, abbe_yaml_node node,
                              const abbe_material_table *table, double quarter_nm,
                              abbe_coating *out, abbe_error *error) {
  abbe_coating_layer layer = {0};
  if (!abbe_yaml_is_sequence(r->yaml, node) || abbe_yaml_count(r->yaml, node) != 2)
    return abbe_yaml_fail(r->yaml, node, error,
                          "a layer is [what, %s], such as [1.38, %s], from outside in",
                          quarter_nm > 0 ? "quarter waves" : "nm", quarter_nm > 0 ? "1" : "99.6");
  abbe_result result = read_stuff(r, abbe_yaml_item(r->yaml, node, 0), table, &layer, error);
  if (result == ABBE_OK)
    result = abbe_yaml_number(r->yaml, abbe_yaml_item(r->yaml, node, 1), "the thickness of a layer",
                              0, ABBE_FILM_MOST_NM, &layer.nm, error);
  if (result != ABBE_OK) return result;
  const double quarters = layer.nm;
  if (quarter_nm > 0) layer.nm = 0;
  result = abbe_coating_add(out, &layer, error);
  abbe_film_layer at[ABBE_FILM_MOST_LAYERS];
  if (result == ABBE_OK && quarter_nm > 0) result = abbe_coating_at(out, quarter_nm, at, error);
  if (result == ABBE_OK && quarter_nm > 0) {
    layer.nm = quarters * quarter_nm / (4 * at[out->count - 1].n);
    out->layer[out->count - 1].nm = layer.nm;
    if (!(layer.nm <= ABBE_FILM_MOST_NM))
      return abbe_yaml_fail(r->yaml, node, error, "a layer of %g nm is thicker than %d nm",
                            layer.nm, ABBE_FILM_MOST_NM);
  }
  return result == ABBE_OK ? ABBE_OK : abbe_scene_value_locate(r->yaml, node, result, error);
}

static abbe_result read_layers(const abbe_object_reading *r, abbe_yaml_node node,
                               const abbe_material_table *table, abbe_coating *out,
                               abbe_error *error) {
  double quarter_nm = 0;
  size_t count;
  abbe_yaml_node list;
  ABBE_TRY(
      abbe_scene_value_list(r->yaml, node, "layers", ABBE_FILM_MOST_LAYERS, &list, &count, error));
  if (count == 0)
    return abbe_yaml_fail(r->yaml, list, error, "'layers' is empty: leave the 'coating' out");
  if (abbe_yaml_get(r->yaml, node, "quarter").id != 0)
    ABBE_TRY(abbe_yaml_get_number(r->yaml, node, "quarter", 100, 10000, &quarter_nm, error));
  for (size_t i = 0; i < count; i++)
    ABBE_TRY(read_layer(r, abbe_yaml_item(r->yaml, list, i), table, quarter_nm, out, error));
  return ABBE_OK;
}

static abbe_result read_file(const abbe_object_reading *r, abbe_yaml_node node,
                             const abbe_material_table *table, abbe_coating *out,
                             abbe_error *error) {
  char *file = NULL, *name = NULL;
  double primary_nm = 0;
  abbe_result result = abbe_yaml_get_string(r->yaml, node, "file", &file, error);
  if (result == ABBE_OK && abbe_yaml_get(r->yaml, node, "name").id != 0)
    result = abbe_yaml_get_string(r->yaml, node, "name", &name, error);
  if (result == ABBE_OK && abbe_yaml_get(r->yaml, node, "primary").id != 0)
    result = abbe_yaml_get_number(r->yaml, node, "primary", 100, 10000, &primary_nm, error);
  if (result == ABBE_OK && (out->path = abbe_scene_value_path(r->folder, file)) == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
  if (result == ABBE_OK) {
    result = abbe_coating_file_read(out->path, name, primary_nm, table, out, error);
    if (result != ABBE_OK) abbe_scene_value_locate(r->yaml, node, result, error);
  }
  free(file);
  free(name);
  return result;
}

/* --- facets --- */

static abbe_result add_name(const abbe_object_reading *r, abbe_yaml_node node, size_t *used,
                            abbe_coating *out, abbe_error *error) {
  const char *text = abbe_yaml_text(r->yaml, node);
  if (text == NULL || text[0] == '\0')
    return abbe_yaml_fail(r->yaml, node, error, "'faces' wants names of facets, such as [table]");
  const size_t size = strlen(text) + 1;
  char *all = realloc(out->faces, *used + size + 1);
  if (all == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for names of facets");
  memcpy(all + *used, text, size);
  *used += size;
  all[*used] = '\0';
  out->faces = all;
  return ABBE_OK;
}

static abbe_result read_faces(const abbe_object_reading *r, abbe_yaml_node node, abbe_coating *out,
                              abbe_error *error) {
  const abbe_yaml_node faces = abbe_yaml_get(r->yaml, node, "faces");
  size_t used = 0;
  if (faces.id == 0) return ABBE_OK;
  if (r->form == ABBE_OBJECT_SPHERE)
    return abbe_yaml_fail(r->yaml, faces, error, "a sphere has no facets: leave 'faces' out");
  if (!abbe_yaml_is_sequence(r->yaml, faces)) return add_name(r, faces, &used, out, error);
  if (abbe_yaml_count(r->yaml, faces) == 0)
    return abbe_yaml_fail(r->yaml, faces, error, "'faces' is empty: leave it out, or name some");
  for (size_t i = 0; i < abbe_yaml_count(r->yaml, faces); i++)
    ABBE_TRY(add_name(r, abbe_yaml_item(r->yaml, faces, i), &used, out, error));
  return ABBE_OK;
}

static abbe_result read_one(const abbe_object_reading *r, abbe_yaml_node node,
                            const abbe_material_table *table, abbe_coatings *all,
                            abbe_error *error) {
  const bool file = abbe_yaml_get(r->yaml, node, "file").id != 0,
             layers = abbe_yaml_get(r->yaml, node, "layers").id != 0;
  if (!abbe_yaml_is_mapping(r->yaml, node) || file == layers)
    return abbe_yaml_fail(r->yaml, node, error,
                          "a 'coating' is {layers: [[1.38, 99.6]]}, from outside in, nm, or {file: "
                          "COATING.DAT, name: AR}");
  abbe_coating *out = &all->coating[all->count++];
  ABBE_TRY(file ? read_file(r, node, table, out, error) : read_layers(r, node, table, out, error));
  ABBE_TRY(read_faces(r, node, out, error));
  return abbe_yaml_check_keys(r->yaml, node, "a 'coating'", error);
}

/* A number, or {alpha: 0.3, faces: girdle}. */
static abbe_result read_alpha(const abbe_object_reading *r, abbe_yaml_node node,
                              const abbe_material_table *table, abbe_coatings *all,
                              abbe_error *error) {
  (void)table;
  abbe_yaml_node alpha = node;
  abbe_coating *out = &all->coating[all->count++];
  const bool some = abbe_yaml_is_mapping(r->yaml, node);
  if (some) ABBE_TRY(abbe_yaml_require(r->yaml, node, "alpha", &alpha, error));
  ABBE_TRY(
      abbe_yaml_number(r->yaml, alpha, "roughness", ABBE_MICROFACETS_LEAST, 1, &out->alpha, error));
  if (some) ABBE_TRY(read_faces(r, node, out, error));
  return some ? abbe_yaml_check_keys(r->yaml, node, "a 'roughness'", error) : ABBE_OK;
}

/* One entry under the key, or a list of them. */
static abbe_result
read_all(const abbe_object_reading *r, const char *key, const abbe_material_table *table,
         abbe_result (*read)(const abbe_object_reading *, abbe_yaml_node,
                             const abbe_material_table *, abbe_coatings *, abbe_error *),
         abbe_coatings **out, abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, r->node, key);
  if (node.id == 0) return ABBE_OK;
  const bool many = abbe_yaml_is_sequence(r->yaml, node);
  const size_t count = many ? abbe_yaml_count(r->yaml, node) : 1;
  if (count == 0 || count > ABBE_COATINGS_MOST)
    return abbe_yaml_fail(r->yaml, node, error, "'%s' has 1 to %d entries, not %zu", key,
                          ABBE_COATINGS_MOST, count);
  *out = calloc(1, sizeof **out);
  if (*out == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for coatings");
  abbe_result result = ABBE_OK;
  bool whole = false;
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    const abbe_yaml_node item = many ? abbe_yaml_item(r->yaml, node, i) : node;
    result = read(r, item, table, *out, error);
    if (result != ABBE_OK || (*out)->coating[i].faces != NULL) continue;
    if (whole)
      result =
          abbe_yaml_fail(r->yaml, item, error,
                         "'%s' has a second entry for all of the object: give it 'faces'", key);
    whole = true;
  }
  return result;
}

abbe_result abbe_object_read_coating(const abbe_object_reading *r, const abbe_material_table *table,
                                     abbe_object *out, abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, r->node, "coating");
  if (node.id != 0 && out->material == NULL)
    return abbe_yaml_fail(r->yaml, node, error,
                          "'coating' is on what refracts; this object has no 'material'");
  ABBE_TRY(read_all(r, "coating", table, read_one, &out->coatings, error));
  for (size_t i = 0; out->coatings != NULL && i < out->coatings->count; i++)
    if (out->coatings->coating[i].layer[0].table != NULL && abbe_material_is_crystal(out->material))
      return abbe_scene_value_locate(
          r->yaml, node,
          abbe_error_set(error, ABBE_UNSUPPORTED,
                         "a table of reflectances is for glass, and '%s' is a crystal: give its "
                         "film as layers",
                         out->material->name),
          error);
  return out->material != NULL ? read_all(r, "roughness", table, read_alpha, &out->roughness, error)
                               : ABBE_OK;
}

/* --- which face has which --- */

/* Names that any object's facets have, by their normals in its own coordinates, z up. */
static const char *side_of(const double n[3]) {
  static const double upright = 0.1 * ABBE_DEGREE;
  return n[2] > 1 - 1e-6             ? "table"
         : fabs(n[2]) < sin(upright) ? "girdle"
         : n[2] > 0                  ? "crown"
                                     : "pavilion";
}

static const char *facet_of(const abbe_object_reading *r, const double n[3]) {
  const abbe_named_facet *best = NULL;
  for (size_t i = 0; i < r->facet_count; i++)
    if (best == NULL || abbe_vector_dot(r->facet[i].n, n) > abbe_vector_dot(best->n, n))
      best = &r->facet[i];
  return best != NULL ? best->name : "";
}

/* The face's outward normal in the object's own coordinates. */
static void own_normal(const abbe_object_reading *r, const abbe_mesh *mesh, size_t face,
                       double out[3]) {
  const double *a = mesh->position[mesh->face[face][0]], *b = mesh->position[mesh->face[face][1]],
               *c = mesh->position[mesh->face[face][2]];
  double u[3], v[3], n[3];
  for (int k = 0; k < 3; k++) {
    u[k] = b[k] - a[k];
    v[k] = c[k] - a[k];
  }
  abbe_vector_cross(u, v, n);
  for (int k = 0; k < 3; k++) out[k] = abbe_vector_dot(r->matrix + 4 * k, n);
  abbe_vector_normalise(out);
}

static void list_names(const abbe_object_reading *r, char *out, size_t size) {
  size_t used = (size_t)snprintf(out, size, "table, crown, girdle, pavilion");
  for (size_t i = 0; i < r->facet_count && used < size; i++) {
    bool listed = r->facet[i].name[0] == '\0';
    for (size_t k = 0; k < i && !listed; k++)
      listed = strcasecmp(r->facet[k].name, r->facet[i].name) == 0;
    if (!listed) used += (size_t)snprintf(out + used, size - used, ", %s", r->facet[i].name);
  }
}

/* Puts the number on the faces of that name; returns how many there are. */
static size_t put(const abbe_object_reading *r, const abbe_object *object, abbe_coatings *c,
                  const char *name, uint8_t number) {
  size_t found = 0;
  for (size_t f = 0; f < object->mesh.face_count; f++) {
    double n[3];
    own_normal(r, &object->mesh, f, n);
    if (strcasecmp(name, side_of(n)) != 0 && strcasecmp(name, facet_of(r, n)) != 0) continue;
    c->face[f] = number;
    found++;
  }
  return found;
}

static abbe_result settle(const abbe_object_reading *r, const abbe_object *object, const char *key,
                          abbe_coatings *c, abbe_error *error) {
  char names[400];
  bool somewhere = false;
  for (size_t i = 0; c != NULL && i < c->count; i++)
    somewhere = somewhere || c->coating[i].faces != NULL;
  if (!somewhere) return ABBE_OK;
  c->face = calloc(object->mesh.face_count + 1, sizeof *c->face);
  if (c->face == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for coated faces");
  c->face_count = object->mesh.face_count;
  for (size_t i = 0; i < c->count; i++) {
    const uint8_t number = (uint8_t)(i + 1);
    const char *name = c->coating[i].faces;
    if (name == NULL) memset(c->face, number, object->mesh.face_count);
    for (; name != NULL && *name != '\0'; name += strlen(name) + 1) {
      if (put(r, object, c, name, number) > 0) continue;
      list_names(r, names, sizeof names);
      return abbe_yaml_fail(r->yaml, abbe_yaml_get(r->yaml, r->node, key), error,
                            "'%s' has no facet '%s'; facets are named %s", object->name, name,
                            names);
    }
  }
  return ABBE_OK;
}

abbe_result abbe_object_settle_coating(const abbe_object_reading *r, abbe_object *object,
                                       abbe_error *error) {
  ABBE_TRY(settle(r, object, "coating", object->coatings, error));
  return settle(r, object, "roughness", object->roughness, error);
}
