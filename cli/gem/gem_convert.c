#include "cli/gem/gem.h"

#include "base/number.h"
#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/gem/gem_input.h"
#include "scenes/cuts/cut_file.h"
#include "scenes/cuts/cut_stretch.h"

#include <cjson/cJSON.h>
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct request {
  abbe_gem_input in;
  const char *output;
} request;

static const abbe_option options[] = {
    {"output", 'o', "FILE", ABBE_ARGUMENT_WRITES, "where to: .asc, .gem, .gcs, .stl, .obj or .glb",
     0, ABBE_TAKE_TEXT(request, output)},
    ABBE_OPTIONS(request, &abbe_gem_input_argp, in, NULL, 0),
    ABBE_NEEDED(request, output, "where to? Give -o FILE.asc, .gem, .gcs, .stl, .obj or .glb"),
    {0}};

static abbe_result print_json(const request *q, const abbe_report *report, abbe_error *error) {
  cJSON *root = cJSON_CreateObject();
  abbe_gem_input_describe(&q->in, root);
  cJSON_AddStringToObject(root, "output", q->output);
  cJSON *notes = cJSON_AddArrayToObject(root, "notes");
  for (size_t i = 0; i < report->count; i++)
    cJSON_AddItemToArray(notes, cJSON_CreateString(report->note[i].text));
  return abbe_command_print_json(root, true, error);
}

int abbe_gem_convert(int argc, char **argv) {
  static const abbe_parser argp = {
      options, NULL, "FILE",
      "Writes a design in another format, or its stone as a solid.\v"
      "STL and OBJ are in millimetres, z up, glTF in metres, y up; without --width a unit of the "
      "design is a metre. glTF takes index, dispersion and colour of --material.\n\n"
      "Examples:\n"
      "  abbe gem convert stone.gem -o stone.asc\n"
      "  abbe gem convert scenes/designs/brilliant-quartz.asc --width 8 -o stone.stl\n"
      "  abbe gem convert scenes/designs/brilliant-diamond.asc --width 6.5 --material diamond -o "
      "stone.glb"};
  request q = {.in.program = argv[0]};
  abbe_report report = {0};
  abbe_error error = {0};
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &q);
  abbe_result result = abbe_command_check_targets(&q.output, 1, &error);
  if (result == ABBE_OK) result = abbe_gem_input_load(&q.in, &error);
  if (result == ABBE_OK)
    result = abbe_gem_output_write(q.output, &q.in.cut, &q.in.stone, abbe_gem_input_scale(&q.in),
                                   q.in.material, &report, &error);
  for (size_t i = 0; i < report.count && !q.in.quiet; i++)
    fprintf(stderr, "note: %s: %s\n", q.output, report.note[i].text);
  if (result == ABBE_OK && q.in.json) result = print_json(&q, &report, &error);
  abbe_report_free(&report);
  abbe_gem_input_free(&q.in);
  return abbe_command_end(argv[0], result, &error);
}

typedef struct gem_diagram_request {
  abbe_gem_input in;
  const char *output;
} gem_diagram_request;

static const abbe_option gem_diagram_options[] = {
    {"output", 'o', "FILE", ABBE_ARGUMENT_WRITES, "the sheet: .pdf, .svg or .png", 0,
     ABBE_TAKE_TEXT(gem_diagram_request, output)},
    ABBE_OPTIONS(gem_diagram_request, &abbe_gem_input_argp, in, NULL, 0),
    ABBE_NEEDED(gem_diagram_request, output, "where to? Give -o FILE.pdf, .svg or .png"),
    {0}};

/* The stone's note, where one is wanted. */
static const char *note_of(const abbe_gem_input *in, char *text, size_t size) {
  const double density = abbe_gem_input_density(in), mm = 1e3 * in->width_m;
  int used = 0;
  if (in->material == NULL && in->width_m == 0) return NULL;
  if (in->material != NULL)
    used = abbe_number_format(text, size, "%s, index %.3f   ", in->material->name, in->n);
  if (in->width_m > 0)
    used += abbe_number_format(text + used, size - (size_t)used, "width %.2f mm   ", mm);
  if (in->width_m > 0 && density > 0)
    abbe_number_format(text + used, size - (size_t)used, "%.3f carats",
                       abbe_cut_measures_carats(&in->measures, in->width_m, density));
  return text;
}

int abbe_gem_diagram(int argc, char **argv) {
  static const abbe_parser argp = {
      gem_diagram_options, NULL, "FILE",
      "Draws a design on a sheet to cut from.\v"
      "Crown and pavilion with the wheel of indices, two profiles, proportions, and the tiers with "
      "their angles, indices and instructions.\n\n"
      "Examples:\n"
      "  abbe gem diagram scenes/designs/brilliant-quartz.asc -o quartz.pdf\n"
      "  abbe gem diagram stone.gem --material sapphire --width 8 -o stone.png"};
  gem_diagram_request q = {.in.program = argv[0]};
  char note[300];
  abbe_error error = {0};
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &q);
  abbe_result result = abbe_command_check_targets(&q.output, 1, &error);
  if (result == ABBE_OK) result = abbe_gem_input_load(&q.in, &error);
  if (result == ABBE_OK)
    result = abbe_cut_diagram_write(q.output, &q.in.cut, &q.in.stone,
                                    note_of(&q.in, note, sizeof note), q.in.n, &error);
  if (result == ABBE_OK && q.in.json) {
    cJSON *root = cJSON_CreateObject();
    abbe_gem_input_describe(&q.in, root);
    cJSON_AddStringToObject(root, "diagram", q.output);
    result = abbe_command_print_json(root, true, &error);
  }
  abbe_gem_input_free(&q.in);
  return abbe_command_end(argv[0], result, &error);
}

enum { OPTION_ROUGH = ABBE_GEM_KEY_OWN };

static double critical_deg(double n) {
  double low, high;
  abbe_cut_stretch_window(n, &low, &high);
  return low;
}

/* Those with main facets, by which a side is made steeper or flatter. */
static const abbe_cut_side sides[] = {ABBE_CUT_CROWN, ABBE_CUT_PAVILION};

static void print_main_angles(const abbe_gem_input *in) {
  const char *before = "  main       ";
  for (int i = 0; i < 2; i++) {
    const size_t tier = abbe_cut_stretch_main(&in->cut, &in->stone, sides[i]);
    if (tier == in->cut.tier_count) continue;
    const char *name = abbe_cut_facet_name(&in->cut, in->cut.tier[tier].first);
    printf("%s%s %.2f degrees%s%s", before, abbe_cut_side_name(sides[i]),
           fabs(in->cut.tier[tier].angle_deg), name[0] != '\0' ? ", facets " : "", name);
    before = "; ";
  }
  if (before[0] == ';') printf("\n");
}

/* The largest stone that a block of the rough's size holds. */
static void print_yield(const abbe_gem_input *in) {
  const abbe_cut_measures *m = &in->measures;
  const double *r = in->rough_m, unit = abbe_cut_measures_fit(m, r), mm = 1e3 * unit,
               density = abbe_gem_input_density(in);
  printf(
      "  rough      %.4g x %.4g x %.4g mm: a stone of %.2f x %.2f x %.2f mm at most, %.1f %% of it",
      1e3 * r[0], 1e3 * r[1], 1e3 * r[2], mm * m->length, mm * m->width, mm * m->height,
      100 * abbe_cut_measures_yield(m, r));
  if (density > 0)
    printf(", %.3f of %.3f carats", abbe_cut_measures_carats(m, unit * m->width, density),
           5e6 * density * r[0] * r[1] * r[2]);
  printf("\n");
}

static void print_stone(const abbe_gem_input *in) {
  const abbe_cut_measures *m = &in->measures;
  const double density = abbe_gem_input_density(in), w = m->width;
  printf("%s\n", abbe_gem_input_title(in));
  printf("  facets     %zu + %zu girdle: %zu crown, %zu pavilion; %zu corners, %zu edges\n",
         m->faces[ABBE_CUT_CROWN] + m->faces[ABBE_CUT_PAVILION], m->faces[ABBE_CUT_GIRDLE],
         m->faces[ABBE_CUT_CROWN], m->faces[ABBE_CUT_PAVILION], in->stone.vertex_count,
         in->stone.edge_count);
  printf("  gear       %d teeth", in->cut.gear);
  if (in->cut.folds > 0) printf(", %d-fold%s", in->cut.folds, in->cut.mirror ? ", mirrored" : "");
  printf("\n");
  if (in->cut.refractive_index > 0)
    printf("  cut for    an index of %.3f, critical angle %.2f degrees\n", in->cut.refractive_index,
           critical_deg(in->cut.refractive_index));
  if (in->material != NULL)
    printf("  material   %s: n_d %.4f, critical angle %.2f degrees\n", in->material->name, in->n,
           critical_deg(in->n));
  print_main_angles(in);
  printf("  ratios     L/W %.3f   T/W %.3f   C/W %.3f   P/W %.3f   H/W %.3f   Vol/W^3 %.3f\n",
         m->length / w, m->table / w, m->side[ABBE_CUT_CROWN] / w, m->side[ABBE_CUT_PAVILION] / w,
         m->height / w, m->volume / pow(w, 3));
  if (in->width_m > 0)
    printf("  size       %.2f x %.2f x %.2f mm\n", 1e3 * in->width_m * m->length / w,
           1e3 * in->width_m, 1e3 * in->width_m * m->height / w);
  if (density > 0 && in->width_m > 0)
    printf("  weight     %.3f carats, at %.3g g/cm3\n",
           abbe_cut_measures_carats(m, in->width_m, density), density);
  else if (in->width_m > 0)
    printf("  weight     not known without a density; --density gives it\n");
  if (in->rough_m[0] > 0) print_yield(in);
}

static void print_tiers(const abbe_gem_input *in) {
  const abbe_cut *cut = &in->cut;
  printf("\n  %-6s %8s %10s  indices\n", "facet", "angle", "distance");
  for (size_t t = 0; t < cut->tier_count; t++) {
    const abbe_cut_tier *tier = &cut->tier[t];
    if (tier->count == 0) continue;
    printf("  %-6s %8.2f %10.6f  ", abbe_cut_facet_name(cut, tier->first), tier->angle_deg,
           tier->distance);
    for (size_t i = 0; i < tier->count; i++)
      printf("%s%g%s", i > 0 ? " " : "", cut->facet[tier->first + i].index,
             in->stone.fate[tier->first + i] == ABBE_CUT_FACE ? "" : "*");
    if (tier->instruction != NULL) printf("  %s", tier->instruction);
    printf("%s\n", abbe_cut_stretch_is_flat(tier, in->n) ? "  (below the critical angle)" : "");
  }
  if (in->measures.dead + in->measures.doubled > 0) printf("  * no face\n");
}

static abbe_result gem_info_print_json(const abbe_gem_input *in, abbe_error *error) {
  static const char *const fates[] = {"face", "dead", "double"};
  const abbe_cut *cut = &in->cut;
  cJSON *root = cJSON_CreateObject();
  abbe_gem_input_describe(in, root);
  cJSON_AddNumberToObject(root, "volume", in->measures.volume);
  cJSON_AddNumberToObject(root, "cut_for_index", cut->refractive_index);
  if (cut->refractive_index > 1)
    cJSON_AddNumberToObject(root, "cut_for_critical_deg", critical_deg(cut->refractive_index));
  if (in->material != NULL) {
    cJSON_AddStringToObject(root, "material", in->material->name);
    cJSON_AddNumberToObject(root, "n_d", in->n);
    cJSON_AddNumberToObject(root, "critical_deg", critical_deg(in->n));
  }
  if (in->width_m > 0) {
    const double density = abbe_gem_input_density(in);
    cJSON_AddNumberToObject(root, "width_m", in->width_m);
    if (density > 0)
      cJSON_AddNumberToObject(root, "carats",
                              abbe_cut_measures_carats(&in->measures, in->width_m, density));
  }
  if (in->rough_m[0] > 0) {
    cJSON *rough = cJSON_AddObjectToObject(root, "rough");
    cJSON_AddItemToObject(rough, "size_m", cJSON_CreateDoubleArray(in->rough_m, 3));
    cJSON_AddNumberToObject(rough, "width_m",
                            abbe_cut_measures_fit(&in->measures, in->rough_m) * in->measures.width);
    cJSON_AddNumberToObject(rough, "yield", abbe_cut_measures_yield(&in->measures, in->rough_m));
  }
  cJSON *mains = cJSON_AddObjectToObject(root, "main_deg");
  for (int i = 0; i < 2; i++) {
    const double deg = abbe_cut_stretch_main_deg(cut, &in->stone, sides[i]);
    if (deg > 0) cJSON_AddNumberToObject(mains, abbe_cut_side_name(sides[i]), deg);
  }
  cJSON *tiers = cJSON_AddArrayToObject(root, "tiers");
  for (size_t t = 0; t < cut->tier_count; t++) {
    const abbe_cut_tier *tier = &cut->tier[t];
    cJSON *item = cJSON_CreateObject();
    if (item == NULL || !cJSON_AddItemToArray(tiers, item)) continue;
    cJSON_AddNumberToObject(item, "angle_deg", tier->angle_deg);
    cJSON_AddNumberToObject(item, "distance", tier->distance);
    cJSON_AddBoolToObject(item, "below_critical", abbe_cut_stretch_is_flat(tier, in->n));
    if (tier->instruction != NULL) cJSON_AddStringToObject(item, "instruction", tier->instruction);
    cJSON *facets = cJSON_AddArrayToObject(item, "facets");
    for (size_t i = tier->first; i < tier->first + tier->count; i++) {
      cJSON *facet = cJSON_CreateObject();
      if (facet == NULL || !cJSON_AddItemToArray(facets, facet)) continue;
      cJSON_AddNumberToObject(facet, "index", cut->facet[i].index);
      cJSON_AddStringToObject(facet, "name", abbe_cut_facet_name(cut, i));
      cJSON_AddStringToObject(facet, "fate", fates[in->stone.fate[i]]);
    }
  }
  return abbe_command_print_json(root, true, error);
}

static const abbe_option gem_info_options[] = {
    {"rough", OPTION_ROUGH, "AxBxC", 0,
     "size of a rough such as 12x9x7mm, for the largest stone that it holds and its yield", 0,
     ABBE_TAKE_BY_KEY},
    {.take = {.kind = ABBE_TAKES_CHILD, .child = &abbe_gem_input_argp}},
    {0}};

/* Each side in the unit that stands behind it or, there being none, behind the last one. */
static void read_rough(abbe_gem_input *in, const char *text) {
  const char *unit = text + strlen(text), *at = text;
  while (unit > text && isalpha((unsigned char)unit[-1]) && unit[-1] != 'x') unit--;
  for (int i = 0; i < 3; i++) {
    char side[64];
    const size_t length = strcspn(at, "x");
    const bool has_unit = i == 2 || (length > 0 && isalpha((unsigned char)at[length - 1]));
    snprintf(side, sizeof side, "%.*s%s", (int)(length < 40 ? length : 40), at,
             has_unit ? "" : unit);
    in->rough_m[i] = abbe_command_length(in->program, "--rough", side, 1e-6, 1e3);
    at += length;
    if (*at != (i < 2 ? 'x' : '\0')) {
      fprintf(stderr, "%s: --rough '%s' is not three sides such as 12x9x7mm\n", in->program, text);
      exit(ABBE_EXIT_USAGE);
    }
    at++;
  }
}

static error_t gem_info_parse(int key, char *text, struct argp_state *state) {
  abbe_gem_input *in = state->input;
  if (key != OPTION_ROUGH) return ARGP_ERR_UNKNOWN;
  read_rough(in, text);
  return 0;
}

int abbe_gem_info(int argc, char **argv) {
  static const abbe_parser argp = {
      gem_info_options, gem_info_parse, "FILE",
      "Says what a design holds: facets, proportions, weight, critical angle, tiers.\v"
      "Designs are GemCad's .asc and .gem files and Gem Cut Studio's .gcs.\n\n"
      "Examples:\n"
      "  abbe gem info scenes/designs/brilliant-quartz.asc\n"
      "  abbe gem info scenes/designs/brilliant-diamond.asc --material diamond --width 6.5\n"
      "  abbe gem info stone.gem --material sapphire --rough 12x9x7mm\n"
      "  abbe gem info stone.gem --weld 1e-4 --json"};
  abbe_gem_input in = {.program = argv[0]};
  abbe_error error = {0};
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &in);
  abbe_result result = abbe_gem_input_load(&in, &error);
  if (result == ABBE_OK && in.json) result = gem_info_print_json(&in, &error);
  if (result == ABBE_OK && !in.json) {
    print_stone(&in);
    print_tiers(&in);
  }
  abbe_gem_input_free(&in);
  return abbe_command_end(argv[0], result, &error);
}
