/* What is known of a stone by its file. */
#include "scenes/studio/studio.h"

#include "base/number.h"
#include "scenes/cuts/cut_file.h"
#include "scenes/cuts/cut_stretch.h"
#include "scenes/import/mesh/gltf_material.h"
#include "scenes/mesh/mesh.h"
#include "spectral/formats/material_import.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Jewellers' programs write millimetres into files that say no unit; glTF's is the metre. */
static const struct kind {
  const char *ending;
  bool design, gltf;
  double unit_m; /* unit of meshes */
} kinds[] = {{".asc", true, false, 0},     {".gem", true, false, 0},
             {".gcs", true, false, 0},     {".stl", false, false, 1e-3},
             {".obj", false, false, 1e-3}, {".ply", false, false, 1e-3},
             {".gltf", false, true, 1},    {".glb", false, true, 1}};

#define UNKNOWN "diamond" /* where a file says nothing of its stone */
#define NEAR 0.015        /* difference of an index */
/* Beyond these a mesh is in another unit. */
#define LEAST_M 0.0005
#define MOST_M 0.5

static const struct kind *kind_of(const char *path) {
  const char *dot = strrchr(path, '.');
  for (size_t i = 0; dot != NULL && i < sizeof kinds / sizeof *kinds; i++)
    if (strcasecmp(dot, kinds[i].ending) == 0) return &kinds[i];
  return NULL;
}

bool abbe_studio_is_stone(const char *path) {
  return path != NULL && kind_of(path) != NULL;
}

/* Stones of the shipped table that designs are made for; of colours the usual one of its kind. */
static const char *const clear[] = {"quartz", "topaz",          "spinel",  "sapphire",   "yag",
                                    "zircon", "cubic-zirconia", "diamond", "moissanite", NULL};
static const char *const tinted[] = {"emerald",   "tourmaline-green", "peridot",   "tanzanite",
                                     "tsavorite", "spessartine",      "demantoid", NULL};

/* The nearest of those names in the table; *off: how far its index is. */
static const abbe_material *nearest_of(const abbe_material_table *table, const char *const *names,
                                       double n, double *off) {
  const abbe_material *best = NULL, *m;
  double own;
  *off = INFINITY;
  for (; *names != NULL; names++)
    if (abbe_material_table_find(table, *names, &m, NULL) == ABBE_OK &&
        abbe_material_n(m, ABBE_LINE_D_NM, &own, NULL) == ABBE_OK && fabs(own - n) < *off) {
      *off = fabs(own - n);
      best = m;
    }
  return best;
}

const abbe_material *abbe_studio_nearest(const abbe_material_table *table, double n) {
  double off[2];
  const abbe_material *best = nearest_of(table, clear, n, &off[0]);
  const abbe_material *other = nearest_of(table, tinted, n, &off[1]);
  return off[0] > NEAR && off[1] <= NEAR ? other : best;
}

/* What a design's index is nearest to. */
static abbe_result choose(double n, const abbe_studio *studio, abbe_studio_stone *out,
                          abbe_error *error) {
  abbe_material_table table = {0};
  abbe_result result = abbe_material_table_load(studio->table, &table, error);
  const abbe_material *near = result == ABBE_OK && n > 1 ? abbe_studio_nearest(&table, n) : NULL;
  snprintf(out->material, sizeof out->material, "%s", near != NULL ? near->name : UNKNOWN);
  if (near != NULL)
    abbe_number_format(out->note, sizeof out->note, "its design is for an index of %g", n);
  else
    snprintf(out->note, sizeof out->note, "its file names no stone");
  abbe_material_table_free(&table);
  return result;
}

static abbe_result read_design(const char *path, const abbe_studio *studio, abbe_studio_stone *out,
                               abbe_error *error) {
  ABBE_OWNED(abbe_cut, cut) = {0};
  ABBE_OWNED(abbe_cut_polyhedron, stone) = {0};
  abbe_cut_measures m;
  ABBE_TRY(abbe_cut_file_read_stone(path, ABBE_CUT_WELD, &cut, &stone, NULL, error));
  abbe_cut_measures_make(&cut, &stone, &m);
  out->width = studio->width_m > 0 ? studio->width_m : ABBE_STUDIO_WIDTH_M;
  for (int k = 0; k < 3; k++) out->size[k] = (stone.max[k] - stone.min[k]) * out->width / m.width;
  out->girdle =
      (0.5 * (m.girdle_low + m.girdle_high) - stone.min[2]) / (stone.max[2] - stone.min[2]);
  if (studio->material == NULL) ABBE_TRY(choose(cut.refractive_index, studio, out, error));
  return ABBE_OK;
}

/* A glTF's own stone, where it has one. */
static void choose_own(const struct kind *kind, abbe_studio_stone *out) {
  abbe_material own = {0};
  char *name = NULL;
  const bool has = kind->gltf && abbe_gltf_material_load(out->path, NULL, &own, &name, NULL) == 0;
  snprintf(out->material, sizeof out->material, "%s", has ? "from-file" : UNKNOWN);
  snprintf(out->note, sizeof out->note, "its file %s",
           has ? "has a glass of its own" : "names no stone");
  if (has) abbe_material_free(&own);
  free(name);
}

static abbe_result read_mesh(const struct kind *kind, const abbe_studio *studio,
                             abbe_studio_stone *out, abbe_error *error) {
  abbe_mesh mesh = {0};
  double min[3] = {INFINITY, INFINITY, INFINITY}, max[3] = {-INFINITY, -INFINITY, -INFINITY};
  ABBE_TRY(abbe_mesh_load(out->path, ABBE_NORMALS_AUTO, &mesh, NULL, error));
  for (size_t v = 0; v < mesh.vertex_count; v++)
    for (int k = 0; k < 3; k++) {
      min[k] = fmin(min[k], mesh.position[v][k]);
      max[k] = fmax(max[k], mesh.position[v][k]);
    }
  abbe_mesh_free(&mesh);
  const double own = fmin(max[0] - min[0], max[1] - min[1]);
  if (!(own > 0) || !(max[2] > min[2]))
    return abbe_error_set(error, ABBE_GEOMETRY, "%s: it is flat; a stone has a volume", out->path);
  out->girdle = 0.6;
  out->width = studio->width_m > 0 ? studio->width_m : own * kind->unit_m;
  const bool odd = out->width < LEAST_M || out->width > MOST_M;
  if (studio->material == NULL) choose_own(kind, out);
  if (odd && !(studio->width_m > 0)) {
    const size_t used = strlen(out->note);
    abbe_number_format(out->note + used, sizeof out->note - used,
                       "%sit would be %g m wide, so its unit is another: --width says which",
                       used > 0 ? "; " : "", out->width);
    out->width = ABBE_STUDIO_WIDTH_M;
  }
  for (int k = 0; k < 3; k++) out->size[k] = (max[k] - min[k]) * out->width / own;
  return ABBE_OK;
}

abbe_result abbe_studio_stone_read(const char *path, const abbe_studio *studio,
                                   abbe_studio_stone *out, abbe_error *error) {
  const struct kind *kind = kind_of(path);
  *out = (abbe_studio_stone){.path = path, .design = kind != NULL && kind->design};
  if (kind == NULL)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: a stone's file ends with .asc, .gem, .gcs, .stl, .obj, .ply, .gltf "
                          "or .glb",
                          path);
  snprintf(out->material, sizeof out->material, "%s", studio->material ? studio->material : "");
  return kind->design ? read_design(path, studio, out, error) : read_mesh(kind, studio, out, error);
}
