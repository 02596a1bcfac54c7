#include "library/lib_gem_report.h"

#include "base/maths.h"
#include "colorimetry/weights.h"
#include "library/lib_handles.h"
#include "library/lib_settings.h"
#include "scenes/cuts/cut_file.h"
#include "scenes/cuts/cut_polyhedron.h"
#include "scenes/cuts/cut_stretch.h"
#include "spectral/formats/material_import.h"
#include "validation/measure/gem/gem_derive.h"
#include "validation/measure/gem/gem_judgement.h"
#include "validation/measure/gem/gem_maps.h"

#include <limits.h>
#include <stdlib.h>

struct abbe_lib_gem_report {
  abbe_gem_judgement judgement;
  size_t count;
  abbe_gem_judgement_row row[ABBE_GEM_JUDGEMENT_MOST_ROWS + 6]; /* slopes are the last */
};

typedef struct request {
  const char *table, *axis;
  double width_m, min_nm, max_nm, head_rad, tilt_rad, step_rad, weld, crown_rad, pavilion_rad;
  size_t wavelengths, size, repeats, threads, slopes;
} request;

static abbe_result read_request(const char *const *settings, size_t count, request *q,
                                abbe_error *error) {
  *q = (request){.width_m = 0.0065,
                 .min_nm = ABBE_WAVELENGTH_MIN_NM,
                 .max_nm = ABBE_WAVELENGTH_MAX_NM,
                 .head_rad = ABBE_GEM_HEAD_DEG * ABBE_PI / 180,
                 .tilt_rad = ABBE_PI / 6,
                 .step_rad = ABBE_PI / 90,
                 .wavelengths = 16,
                 .size = 96,
                 .repeats = 4};
  const abbe_lib_setting known[] = {
      ABBE_LIB_TEXT("table", &q->table),
      ABBE_LIB_TEXT("axis", &q->axis),
      ABBE_LIB_NUMBER("width_m", &q->width_m, 1e-6, 1e3),
      ABBE_LIB_NUMBER("min_nm", &q->min_nm, 1, 1e6),
      ABBE_LIB_NUMBER("max_nm", &q->max_nm, 1, 1e6),
      ABBE_LIB_NUMBER("head_rad", &q->head_rad, 0, 0.999 * ABBE_PI / 4),
      ABBE_LIB_NUMBER("tilt_rad", &q->tilt_rad, 0, ABBE_PI / 2),
      ABBE_LIB_NUMBER("step_rad", &q->step_rad, ABBE_PI / 1800, ABBE_PI / 2),
      ABBE_LIB_NUMBER("weld", &q->weld, 1e-12, ABBE_CUT_MOST_WELD),
      ABBE_LIB_NUMBER("crown_rad", &q->crown_rad, 0, ABBE_PI / 2),
      ABBE_LIB_NUMBER("pavilion_rad", &q->pavilion_rad, 0, ABBE_PI / 2),
      ABBE_LIB_COUNT("wavelengths", &q->wavelengths, 1, 256),
      ABBE_LIB_COUNT("size", &q->size, 8, ABBE_GEM_MOST_SIDE),
      ABBE_LIB_COUNT("repeats", &q->repeats, 3, ABBE_GEM_MOST_REPEATS),
      ABBE_LIB_COUNT("slopes", &q->slopes, 0, 1),
      ABBE_LIB_COUNT("threads", &q->threads, 1, 1024)};
  return abbe_library_settings_read("gem_report", known, sizeof known / sizeof *known, settings,
                                    count, error);
}

/* What is read and made on the way to a judgement. */
typedef struct work {
  abbe_cut cut;
  abbe_cut_polyhedron polyhedron;
  abbe_material_table table;
  const abbe_material *material;
  abbe_wavelengths wavelengths;
  abbe_weights weights;
  abbe_gem_stone stone;
} work;

static void free_work(work *w) {
  abbe_gem_stone_free(&w->stone);
  abbe_weights_free(&w->weights);
  abbe_wavelengths_free(&w->wavelengths);
  abbe_material_table_free(&w->table);
  abbe_cut_polyhedron_free(&w->polyhedron);
  abbe_cut_free(&w->cut);
}

/* The design at other angles. */
static abbe_result recut(const request *q, work *w, abbe_error *error) {
  const double degrees = 180 / ABBE_PI;
  if (!(q->crown_rad > 0) && !(q->pavilion_rad > 0)) return ABBE_OK;
  ABBE_TRY(abbe_cut_stretch_to(&w->cut, &w->polyhedron, degrees * q->crown_rad,
                               degrees * q->pavilion_rad, error));
  abbe_cut_polyhedron_free(&w->polyhedron);
  return abbe_cut_polyhedron_make(&w->cut, q->weld, &w->polyhedron, error);
}

static abbe_result prepare(const request *q, const char *path, const char *material, work *w,
                           abbe_error *error) {
  const abbe_illuminant d65 = {0};
  char place[2 * PATH_MAX];
  const char *found = abbe_library_shipped_find(path, place, sizeof place);
  ABBE_TRY(abbe_cut_file_read_stone(found, q->weld, &w->cut, &w->polyhedron, NULL, error));
  ABBE_TRY(recut(q, w, error));
  ABBE_TRY(abbe_material_table_load(q->table, &w->table, error));
  ABBE_TRY(abbe_material_table_find(&w->table, material, &w->material, error));
  ABBE_TRY(abbe_wavelengths_make(q->wavelengths, q->min_nm, q->max_nm, &w->wavelengths, error));
  ABBE_TRY(abbe_weights_make(&w->wavelengths, &d65, ABBE_RGB_SPACE_XYZ, &w->weights, error));
  ABBE_TRY(abbe_gem_stone_make(&w->cut, &w->polyhedron, w->material, &w->wavelengths, q->width_m,
                               &w->stone, error));
  abbe_gem_axes axes;
  if (q->axis != NULL) ABBE_TRY(abbe_gem_axes_read(q->axis, &axes, error));
  if (q->axis != NULL) ABBE_TRY(abbe_gem_stone_turn(&w->stone, &axes, error));
  return ABBE_OK;
}

static void free_key(abbe_gem_derive_key *key) {
  for (int s = 0; s < 2; s++) abbe_gem_derive_stone_free(&key->moved[s]);
}

/* A main angle a little less and more, the other side's as it is. False where it has none or cannot
 * move by itself. */
static bool move_side(const request *q, const work *w, int side, abbe_gem_derive_key *key) {
  const double degrees = abbe_cut_stretch_main_deg(&w->cut, &w->polyhedron,
                                                   side == 0 ? ABBE_CUT_CROWN : ABBE_CUT_PAVILION);
  key->name = side == 0 ? "crown" : "pavilion";
  key->step = 1e-4;
  for (int s = 0; s < 2; s++) {
    abbe_cut cut = {0};
    ABBE_OWNED(abbe_cut_polyhedron, p) = {0};
    const double to = degrees + (s == 0 ? -key->step : key->step);
    const bool moved = degrees > 0 && abbe_cut_copy(&w->cut, &cut, NULL) == ABBE_OK &&
                       abbe_cut_stretch_to(&cut, &w->polyhedron, side == 0 ? to : 0,
                                           side == 1 ? to : 0, NULL) == ABBE_OK &&
                       abbe_cut_polyhedron_make(&cut, q->weld, &p, NULL) == ABBE_OK &&
                       abbe_gem_derive_cut_make(&cut, &p, w->material, NULL, q->width_m,
                                                &w->wavelengths, &key->moved[s], NULL) == ABBE_OK;
    abbe_cut_copy_free(&cut);
    if (!moved) return false;
  }
  return true;
}

static abbe_result add_slopes(const request *q, const work *w, abbe_lib_gem_report *r,
                              abbe_error *error) {
  static const abbe_gem_derive_measure measures[] = {ABBE_GEM_DERIVE_RETURN, ABBE_GEM_DERIVE_ISO,
                                                     ABBE_GEM_DERIVE_FIRE};
  static const char *const rows[2][3][2] = {
      {{"return_by_crown", "light return by a degree of the crown's main angle"},
       {"iso_by_crown", "brightness by a degree of it"},
       {"fire_by_crown", "degrees of fire by a degree of it"}},
      {{"return_by_pavilion", "light return by a degree of the pavilion's main angle"},
       {"iso_by_pavilion", "brightness by a degree of it"},
       {"fire_by_pavilion", "degrees of fire by a degree of it"}}};
  abbe_gem_derive_stone base = {0};
  abbe_gem_derive_key key[2] = {{0}};
  size_t side[2], keys = 0;
  for (size_t i = 0; i < 2; i++)
    if (move_side(q, w, (int)i, &key[keys]))
      side[keys++] = i;
    else
      free_key(&key[keys]);
  abbe_result result = abbe_gem_derive_cut_make(&w->cut, &w->polyhedron, w->material, NULL,
                                                q->width_m, &w->wavelengths, &base, error);
  const abbe_gem_derive_desc desc = {.base = &base,
                                     .weights = &w->weights,
                                     .keys = keys,
                                     .key = key,
                                     .head_rad = q->head_rad,
                                     .lines = 256,
                                     .threads = q->threads};
  abbe_gem_number number[3 * 3];
  if (keys > 0 && result == ABBE_OK)
    result = abbe_gem_derive_make(&desc, measures, 3, number, NULL, error);
  for (size_t m = 0; m < 3 && result == ABBE_OK; m++)
    for (size_t k = 0; k < keys; k++)
      r->row[r->count++] = (abbe_gem_judgement_row){.name = rows[side[k]][m][0],
                                                    .text = rows[side[k]][m][1],
                                                    .number = number[m * (1 + keys) + 1 + k]};
  abbe_gem_derive_stone_free(&base);
  for (size_t k = 0; k < 2; k++) free_key(&key[k]);
  return result;
}

static abbe_gem_judgement_desc describe(const request *q, bool (*progress)(void *, double),
                                        void *user) {
  size_t steps = (size_t)(q->tilt_rad / q->step_rad + 0.5);
  if (steps < 1) steps = 1;
  return (abbe_gem_judgement_desc){
      .view = {.head_rad = q->head_rad,
               .side = q->size,
               .repeats = q->repeats,
               .threads = q->threads},
      .tilts = q->tilt_rad > 0,
      .rocked = {.most_rad = q->tilt_rad,
                 .steps = steps < ABBE_GEM_MOST_STEPS ? steps : ABBE_GEM_MOST_STEPS,
                 .progress = progress,
                 .user = user}};
}

abbe_result abbe_lib_gem_report_make(const char *path, const char *material,
                                     const char *const *settings, size_t count,
                                     bool (*progress)(void *user, double done), void *user,
                                     abbe_lib_gem_report **out, abbe_error *error) {
  ABBE_REQUIRE(path && material && (settings || count == 0) && out, error);
  request q;
  work w = {0};
  *out = NULL;
  ABBE_TRY(read_request(settings, count, &q, error));
  abbe_lib_gem_report *r = calloc(1, sizeof *r);
  if (r == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for a report");
  const abbe_gem_judgement_desc desc = describe(&q, progress, user);
  abbe_result result = prepare(&q, path, material, &w, error);
  if (result == ABBE_OK)
    result = abbe_gem_judgement_make(&w.stone, &w.weights, &desc, &r->judgement, error);
  if (result == ABBE_OK) r->count = abbe_gem_judgement_rows(&r->judgement, r->row);
  if (result == ABBE_OK && q.slopes > 0) result = add_slopes(&q, &w, r, error);
  free_work(&w);
  if (result != ABBE_OK) {
    abbe_lib_gem_report_free(r);
    return result;
  }
  *out = r;
  return ABBE_OK;
}

void abbe_lib_gem_report_free(abbe_lib_gem_report *r) {
  if (r == NULL) return;
  abbe_gem_judgement_free(&r->judgement);
  free(r);
}

const char *abbe_lib_gem_report_name(const abbe_lib_gem_report *r, size_t index) {
  return r != NULL && index < r->count ? r->row[index].name : NULL;
}

const char *abbe_lib_gem_report_text(const abbe_lib_gem_report *r, size_t index) {
  return r != NULL && index < r->count ? r->row[index].text : NULL;
}

abbe_result abbe_lib_gem_report_number(const abbe_lib_gem_report *r, size_t index, double *value,
                                       double *standard_error, abbe_error *error) {
  ABBE_REQUIRE(r && value && standard_error, error);
  if (index >= r->count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "there is no number %zu: the report has %zu, from 0 on", index, r->count);
  *value = r->row[index].number.value;
  *standard_error = r->row[index].number.error;
  return ABBE_OK;
}

abbe_result abbe_lib_gem_report_maps(const abbe_lib_gem_report *r, abbe_lib_picture **out,
                                     abbe_error *error) {
  ABBE_REQUIRE(r && out, error);
  abbe_image image = {0};
  *out = NULL;
  ABBE_TRY(abbe_gem_map_image(&r->judgement.view, &image, error));
  return abbe_library_picture_adopt(&image, out, error);
}
