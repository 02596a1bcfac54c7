#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/scene_input.h"

#include "scenes/export/pov_file.h"
#include "scenes/import/scene_file.h"

#include <argp.h>
#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

enum { OPTION_PHOTONS = 0x100, OPTION_SAMPLES, OPTION_MATERIALS, OPTION_JSON };

typedef struct request {
  const char *program, *scene, *output, *materials;
  abbe_scene_input_changes changes;
  abbe_pov_options pov;
  bool json, quiet;
} request;

static const struct argp_option options[] = {
    {"output", 'o', "FILE.pov", ABBE_ARGUMENT_WRITES, "where to", 0},
    {"photons", OPTION_PHOTONS, "N", 0, "that POV-Ray shoots at refractors (100000)", 0},
    {"samples", OPTION_SAMPLES, "N", 0, "of POV-Ray's spectrum, 2 to 100 (31)", 0},
    {"materials", OPTION_MATERIALS, "TABLE", ABBE_ARGUMENT_READS,
     "a table instead of the scene's: default, thesis or a file", 0},
    ABBE_SCENE_INPUT_OPTIONS(0),
    {"json", OPTION_JSON, NULL, 0, "what became of each material, on standard output", 0},
    {"quiet", 'q', NULL, 0, "no summary", 0},
    {0}};

static error_t parse(int key, char *text, struct argp_state *state) {
  request *q = state->input;
  switch (key) {
  case 'o':
    q->output = abbe_command_target(state->name, "-o", text, ".pov");
    return 0;
  case OPTION_PHOTONS:
    q->pov.photons = abbe_command_count(q->program, "--photons", text, 1, ABBE_POV_MAX_PHOTONS);
    return 0;
  case OPTION_SAMPLES:
    q->pov.samples = abbe_command_count(q->program, "--samples", text, 2, ABBE_POV_MAX_SAMPLES);
    return 0;
  case OPTION_MATERIALS:
    q->materials = text;
    return 0;
  case OPTION_JSON:
    q->json = true;
    return 0;
  case 'q':
    q->quiet = true;
    return 0;
  case ARGP_KEY_ARG:
    if (q->scene != NULL) argp_error(state, "one scene at a time: '%s' and '%s'", q->scene, text);
    q->scene = text;
    return 0;
  case ARGP_KEY_END:
    if (q->scene == NULL) argp_error(state, "which scene? Give a file such as scenes/gem.yaml");
    if (q->output == NULL) argp_error(state, "where to? Give -o FILE.pov");
    return 0;
  default:
    return abbe_scene_input_take(&q->changes, key, text, q->program);
  }
}

/* Whether an object before this one is of its material. */
static bool said(const abbe_scene *scene, size_t object) {
  for (size_t i = 0; i < object; i++)
    if (scene->object[i].material == scene->object[object].material) return true;
  return false;
}

static abbe_result report(const request *q, const abbe_scene *scene, abbe_error *error) {
  cJSON *root = q->json ? cJSON_CreateObject() : NULL;
  cJSON *glasses = q->json ? cJSON_AddArrayToObject(root, "materials") : NULL;
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < scene->object_count && result == ABBE_OK; i++) {
    const abbe_material *m = scene->object[i].material;
    abbe_pov_glass g;
    if (abbe_object_kind_of(&scene->object[i]) != ABBE_OBJECT_REFRACTOR || said(scene, i)) continue;
    result = abbe_pov_file_glass(m, abbe_scene_illuminant(scene), &g, error);
    if (result != ABBE_OK) break;
    if (!q->json) {
      fprintf(stderr, "%s: ior %.6f, dispersion %.6f; n off by %.2g at %g nm, %.2g in the mean\n",
              m->name, g.index.ior, g.index.dispersion, g.worst, g.worst_nm, g.rms);
      if (abbe_material_is_uniaxial(m))
        fprintf(stderr, "%s: its double refraction is left out\n", m->name);
      continue;
    }
    cJSON *glass = cJSON_CreateObject();
    cJSON_AddStringToObject(glass, "name", m->name);
    cJSON_AddNumberToObject(glass, "ior", g.index.ior);
    cJSON_AddNumberToObject(glass, "dispersion", g.index.dispersion);
    cJSON_AddNumberToObject(glass, "worst", g.worst);
    cJSON_AddNumberToObject(glass, "worst_nm", g.worst_nm);
    cJSON_AddNumberToObject(glass, "rms", g.rms);
    cJSON_AddItemToArray(glasses, glass);
  }
  if (q->json && result == ABBE_OK) {
    cJSON_AddNumberToObject(root, "units_per_metre", abbe_pov_file_scale(scene));
    result = abbe_command_print_json(root, error);
  }
  cJSON_Delete(root);
  return result;
}

int abbe_command_export(int argc, char **argv) {
  static const struct argp argp = {
      options,
      parse,
      "SCENE.yaml",
      "Writes a scene for POV-Ray 3.7, with photons and dispersion, as an outside witness.\v"
      "Examples:\n"
      "  abbe export scenes/prism.yaml -o prism.pov\n"
      "  povray +Iprism.pov +Oprism.exr +FE +W512 +H512 -D\n"
      "  abbe display prism.exr -o prism.png\n"
      "  abbe export scenes/gem.yaml -o gem.pov --photons 1000000 --samples 100\n",
      NULL,
      NULL,
      NULL};
  request q = {.program = argv[0]};
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &q);
  abbe_error error = {0};
  abbe_scene scene = {0};
  abbe_result result =
      abbe_scene_input_load_with(argv[0], q.scene, q.materials, &q.changes, &scene, &error);
  if (result == ABBE_OK) result = abbe_pov_file_write(q.output, &scene, &q.pov, &error);
  if (result == ABBE_OK && (q.json || !q.quiet)) result = report(&q, &scene, &error);
  abbe_scene_free(&scene);
  return abbe_command_end(q.program, result, &error);
}
