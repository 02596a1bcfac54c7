/* The best angles by derivatives, of crown and pavilion or of every tier. */
#include "cli/gem/gem.h"

#include "base/maths.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"
#include "scenes/cuts/cut_stretch.h"
#include "validation/measure/gem/gem_ascent.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>

static const char *tier_name(const abbe_cut *cut, size_t tier) {
  return cut->tier[tier].count > 0 ? abbe_cut_facet_name(cut, cut->tier[tier].first) : "";
}

/* Whether a tier has an angle that could change. */
static bool leans(const abbe_cut *cut, size_t tier) {
  const double angle = fabs(cut->tier[tier].angle_deg);
  return cut->tier[tier].count > 0 && angle > ABBE_CUT_GIRDLE_DEG &&
         angle < 90 - ABBE_CUT_GIRDLE_DEG;
}

static void print_row(const char *name, const abbe_cut *cut, const abbe_cut_polyhedron *p,
                      abbe_gem_number n) {
  printf("%-8s %8.3f %9.3f %7.2f %% %8.2f\n", name,
         abbe_cut_stretch_main_deg(cut, p, ABBE_CUT_CROWN),
         abbe_cut_stretch_main_deg(cut, p, ABBE_CUT_PAVILION), 100 * n.value, 100 * n.error);
}

static void print(const abbe_gem_stone_input *s, const char *measure, const abbe_gem_ascent *a) {
  const abbe_gem_input *in = &s->in;
  printf("%s in %s: %s, by derivatives of %zu stones\n\n", in->path, in->material->name, measure,
         a->evaluations);
  printf("%-8s %8s %9s %9s %8s\n", "", "crown", "pavilion", "value", "error");
  print_row("design", &in->cut, &in->stone, a->design);
  print_row("best", &a->cut, &a->polyhedron, a->value);
  printf("\n%-8s %8s %9s %15s %8s\n", "tier", "design", "best", "points/degree", "error");
  for (size_t t = 0; t < in->cut.tier_count; t++)
    if (leans(&in->cut, t))
      printf("%-8s %8.3f %9.3f %15.2f %8.2f\n", tier_name(&in->cut, t), in->cut.tier[t].angle_deg,
             a->cut.tier[t].angle_deg, 100 * ABBE_DEGREE * a->slope[2 * t].value,
             100 * ABBE_DEGREE * a->slope[2 * t].error);
}

static void add_number(cJSON *root, const char *name, abbe_gem_number n) {
  cJSON *one = cJSON_AddObjectToObject(root, name);
  cJSON_AddNumberToObject(one, "value", n.value);
  cJSON_AddNumberToObject(one, "error", n.error);
}

static abbe_result print_json(const abbe_gem_stone_input *s, const char *measure,
                              const abbe_gem_ascent *a, abbe_error *error) {
  const abbe_gem_input *in = &s->in;
  cJSON *root = cJSON_CreateObject();
  cJSON_AddStringToObject(root, "file", in->path);
  cJSON_AddStringToObject(root, "material", in->material->name);
  cJSON_AddStringToObject(root, "measure", measure);
  cJSON_AddNumberToObject(root, "evaluations", (double)a->evaluations);
  add_number(root, "design", a->design);
  add_number(root, "best", a->value);
  cJSON *tiers = cJSON_AddArrayToObject(root, "tiers");
  for (size_t t = 0; t < in->cut.tier_count; t++) {
    cJSON *tier = cJSON_CreateObject();
    cJSON_AddStringToObject(tier, "name", tier_name(&in->cut, t));
    cJSON_AddNumberToObject(tier, "design_deg", in->cut.tier[t].angle_deg);
    cJSON_AddNumberToObject(tier, "best_deg", a->cut.tier[t].angle_deg);
    add_number(tier, "by_angle_rad", a->slope[2 * t]);
    add_number(tier, "by_distance", a->slope[2 * t + 1]);
    cJSON_AddItemToArray(tiers, tier);
  }
  return abbe_command_print_json(root, true, error);
}

abbe_result abbe_gem_optimise_ascend(abbe_gem_stone_input *s, const char *measure,
                                     const abbe_gem_optimum_desc *search, bool tiers,
                                     const char *out, abbe_error *error) {
  abbe_progress progress;
  abbe_gem_ascent ascent;
  abbe_gem_ascent_desc desc = {.search = *search, .tiers = tiers};
  abbe_progress_begin(&progress, "searching", s->in.quiet);
  desc.search.progress = abbe_progress_update;
  desc.search.user = &progress;
  abbe_result result = abbe_gem_ascent_make(&s->in.cut, &s->in.stone, s->in.material,
                                            &s->wavelengths, &s->weights, &desc, &ascent, error);
  abbe_progress_end(&progress);
  if (result != ABBE_OK) return result;
  if (out != NULL)
    result =
        abbe_gem_output_write(out, &ascent.cut, &ascent.polyhedron, 1, NULL, &s->in.report, error);
  if (result == ABBE_OK && s->in.json) result = print_json(s, measure, &ascent, error);
  if (result == ABBE_OK && !s->in.json) print(s, measure, &ascent);
  abbe_gem_ascent_free(&ascent);
  return result;
}
