#include "cli/gem/gem_input.h"

#include "base/file.h"
#include "base/number.h"
#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "scenes/cuts/cut_file.h"
#include "spectral/formats/material_import.h"
#include "spectral/spectrum.h"
#include "spectral/wavelengths.h"

#include <cjson/cJSON.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

void abbe_gem_stone_input_free(abbe_gem_stone_input *input) {
  abbe_gem_stone_free(&input->stone);
  abbe_material_free(&input->own);
  abbe_weights_free(&input->weights);
  abbe_wavelengths_free(&input->wavelengths);
  abbe_gem_input_free(&input->in);
}

static void note_range(const abbe_gem_stone_input *q) {
  const abbe_material *m = q->in.material;
  if (!abbe_material_extrapolates(m, q->from_nm) && !abbe_material_extrapolates(m, q->to_nm))
    return;
  fprintf(stderr, "note: the index of %s is known from %g to %g nm, and continued beyond\n",
          m->name, m->min_nm, m->max_nm);
}

/* The design's index, which does not say how it varies over wavelength. */
static abbe_result take_index(abbe_gem_stone_input *q, abbe_error *error) {
  abbe_material *own = &q->own;
  char name[64];
  if (!(q->in.n > 1))
    return abbe_error_set(error, ABBE_NOT_FOUND,
                          "of which stone? %s says no index; give --material NAME ('abbe materials "
                          "list' has them)",
                          q->in.path);
  abbe_number_format(name, sizeof name, "index %g", q->in.n);
  *own = (abbe_material){.name = strdup(name),
                         .dispersion = {.model = ABBE_DISPERSION_CONSTANT, .count = 1},
                         .min_nm = ABBE_SPECTRUM_LOW_NM,
                         .max_nm = ABBE_SPECTRUM_HIGH_NM};
  own->dispersion.c[0] = q->in.n;
  if (own->name == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a name");
  q->in.material = own;
  if (!q->in.quiet)
    fprintf(stderr,
            "note: no --material, so the design's index of %s, alike at all wavelengths: no fire\n",
            name + strlen("index "));
  return ABBE_OK;
}

static abbe_result turn(abbe_gem_stone_input *q, abbe_error *error) {
  if (!abbe_material_is_crystal(q->in.material))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "--axis '%s': %s has one index in all directions; leave the option out",
                          q->axis, q->in.material->name);
  ABBE_TRY(abbe_gem_axes_read(q->axis, &q->axes, error));
  return abbe_gem_stone_turn(&q->stone, &q->axes, error);
}

abbe_result abbe_gem_stone_input_load(abbe_gem_stone_input *q, abbe_error *error) {
  const abbe_illuminant d65 = {0};
  if (!(q->from_nm > 0)) q->from_nm = ABBE_WAVELENGTH_MIN_NM;
  if (!(q->to_nm > 0)) q->to_nm = ABBE_WAVELENGTH_MAX_NM;
  q->width_m = q->in.width_m > 0 ? q->in.width_m : ABBE_GEM_WIDTH_M;
  ABBE_TRY(abbe_gem_input_load(&q->in, error));
  if (q->in.material == NULL) ABBE_TRY(take_index(q, error));
  ABBE_TRY(abbe_wavelengths_make(q->count, q->from_nm, q->to_nm, &q->wavelengths, error));
  ABBE_TRY(abbe_weights_make(&q->wavelengths, &d65, ABBE_RGB_SPACE_XYZ, &q->weights, error));
  ABBE_TRY(abbe_gem_stone_make(&q->in.cut, &q->in.stone, q->in.material, &q->wavelengths,
                               q->width_m, &q->stone, error));
  if (q->axis != NULL) ABBE_TRY(turn(q, error));
  if (!q->in.quiet) note_range(q);
  return ABBE_OK;
}

static const abbe_option options[] = {
    {"material", 0, "NAME", 0, "of which the stone is; without it, the index that the design says",
     0, ABBE_TAKE_TEXT(abbe_gem_input, material_name)},
    {"table", 0, "FILE", ABBE_ARGUMENT_READS, "of materials: a file, default or thesis (default)",
     0, ABBE_TAKE_TEXT(abbe_gem_input, table_path)},
    {"width", 0, "LENGTH", 0,
     "of the stone, its smaller extent, such as 6.5mm or 0.2in; a bare number is of mm", 0,
     ABBE_TAKE_LENGTH(abbe_gem_input, width_m, 1e-6, 1e3)},
    {"density", 0, "G/CM3", 0, "where the material's record has none", 0,
     ABBE_TAKE_NUMBER(abbe_gem_input, density_g_cm3, 0.1, 50)},
    {"weld", 0, "SHARE", 0,
     "corners nearer than this share of half the width are one (1e-6); 1e-4 closes meets that were "
     "cut by eye",
     0, ABBE_TAKE_NUMBER(abbe_gem_input, weld, 1e-12, ABBE_CUT_MOST_WELD)},
    {"json", 0, NULL, 0, "as JSON, numbers in full", 0, ABBE_TAKE_FLAG(abbe_gem_input, json)},
    {"quiet", 'q', NULL, 0, "no notes", 0, ABBE_TAKE_FLAG(abbe_gem_input, quiet)},
    ABBE_NEEDED(abbe_gem_input, path,
                "which design? Give a file such as scenes/designs/brilliant-quartz.asc"),
    {0}};

static error_t parse(int key, char *text, struct argp_state *state) {
  abbe_gem_input *in = state->input;
  if (key != ARGP_KEY_ARG) return ARGP_ERR_UNKNOWN;
  if (in->path != NULL) argp_error(state, "one design at a time: '%s' and '%s'", in->path, text);
  in->path = text;
  return 0;
}

const abbe_parser abbe_gem_input_argp = {.options = options, .parse = parse};

static void print_notes(const abbe_gem_input *in) {
  for (size_t i = 0; i < in->report.count; i++) {
    const abbe_note *n = &in->report.note[i];
    fprintf(stderr, "note: %s", in->path);
    if (n->line > 0) fprintf(stderr, ":%zu", n->line);
    fprintf(stderr, ": %s\n", n->text);
  }
  if (in->measures.dead + in->measures.doubled == 0) return;
  fprintf(stderr, "note: %s:", in->path);
  if (in->measures.dead > 0) fprintf(stderr, " %zu facets cut nothing", in->measures.dead);
  if (in->measures.doubled > 0)
    fprintf(stderr, "%s %zu facets repeat another's plane", in->measures.dead > 0 ? "," : "",
            in->measures.doubled);
  fprintf(stderr, "; they are left out\n");
}

static abbe_result find_material(abbe_gem_input *in, abbe_error *error) {
  in->n = in->cut.refractive_index;
  if (in->material_name == NULL) return ABBE_OK;
  ABBE_TRY(abbe_material_table_load(in->table_path, &in->table, error));
  ABBE_TRY(abbe_material_table_find(&in->table, in->material_name, &in->material, error));
  if (abbe_material_is_conductor(in->material))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "'%s' is a metal; a stone is cut of something that light passes",
                          in->material_name);
  return abbe_material_n(in->material, ABBE_LINE_D_NM, &in->n, error);
}

abbe_result abbe_gem_input_load(abbe_gem_input *in, abbe_error *error) {
  char place[2 * PATH_MAX];
  const char *found = abbe_shipped_find(in->path, place, sizeof place);
  if (found != in->path && !in->quiet)
    fprintf(stderr, "note: %s is not here; %s is taken\n", in->path, found);
  abbe_arguments_add(in->program, ABBE_ARGUMENT_READS, "the design", found);
  abbe_result result =
      abbe_cut_file_read_stone(found, in->weld, &in->cut, &in->stone, &in->report, error);
  if (result == ABBE_OK) abbe_cut_measures_make(&in->cut, &in->stone, &in->measures);
  if (result == ABBE_OK) result = find_material(in, error);
  if (!in->quiet) print_notes(in);
  return result;
}

void abbe_gem_input_free(abbe_gem_input *in) {
  abbe_report_free(&in->report);
  abbe_cut_free(&in->cut);
  abbe_cut_polyhedron_free(&in->stone);
  abbe_material_table_free(&in->table);
}

double abbe_gem_input_density(const abbe_gem_input *in) {
  return in->density_g_cm3 > 0  ? in->density_g_cm3
         : in->material != NULL ? in->material->catalogue.density_g_cm3
                                : 0;
}

double abbe_gem_input_scale(const abbe_gem_input *in) {
  return in->width_m > 0 ? in->width_m / in->measures.width : 1;
}

const char *abbe_gem_input_title(const abbe_gem_input *in) {
  const char *own = in->cut.heading[0];
  return own != NULL && *own != '\0' ? own : abbe_file_name(in->path);
}

void abbe_gem_input_describe(const abbe_gem_input *in, cJSON *root) {
  const abbe_cut_measures *m = &in->measures;
  const double w = m->width;
  cJSON_AddStringToObject(root, "design", abbe_gem_input_title(in));
  cJSON_AddStringToObject(root, "file", in->path);
  cJSON *facets = cJSON_AddObjectToObject(root, "facets");
  for (int i = 0; i < ABBE_CUT_SIDE_COUNT; i++)
    cJSON_AddNumberToObject(facets, abbe_cut_side_name((abbe_cut_side)i), (double)m->faces[i]);
  cJSON_AddNumberToObject(facets, "dead", (double)m->dead);
  cJSON_AddNumberToObject(facets, "doubled", (double)m->doubled);
  cJSON_AddNumberToObject(root, "corners", (double)in->stone.vertex_count);
  cJSON_AddNumberToObject(root, "edges", (double)in->stone.edge_count);
  cJSON_AddNumberToObject(root, "gear", in->cut.gear);
  cJSON_AddNumberToObject(root, "folds", in->cut.folds);
  cJSON_AddBoolToObject(root, "mirror", in->cut.mirror);
  cJSON *ratios = cJSON_AddObjectToObject(root, "ratios");
  cJSON_AddNumberToObject(ratios, "L/W", m->length / w);
  cJSON_AddNumberToObject(ratios, "T/W", m->table / w);
  cJSON_AddNumberToObject(ratios, "C/W", m->side[ABBE_CUT_CROWN] / w);
  cJSON_AddNumberToObject(ratios, "P/W", m->side[ABBE_CUT_PAVILION] / w);
  cJSON_AddNumberToObject(ratios, "H/W", m->height / w);
  cJSON_AddNumberToObject(ratios, "Vol/W^3", m->volume / pow(w, 3));
  /* from the design's centre, which is a scene's origin */
  cJSON_AddNumberToObject(ratios, "top/W", in->stone.max[2] / w);
  cJSON_AddNumberToObject(ratios, "bottom/W", in->stone.min[2] / w);
}
