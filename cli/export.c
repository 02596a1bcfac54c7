#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/options/scene_input.h"

#include "scenes/export/pov_file.h"
#include "scenes/export/scene_export.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#define NAME(code, name, ending, form, program) name ", "
#define ENDING(code, name, ending, form, program) ending ", "

typedef struct request {
  const char *program, *scene, *output, *materials, *to;
  abbe_scene_input_changes changes;
  abbe_scene_export_target target; /* ABBE_SCENE_EXPORT_COUNT: POV-Ray */
  abbe_pov_options pov;
  bool json, quiet;
} request;

static const abbe_option options[] = {
    {"output", 'o', "FILE", ABBE_ARGUMENT_WRITES, "where to: " ABBE_SCENE_EXPORTS(ENDING) "or .pov",
     1, ABBE_TAKE_TEXT(request, output)},
    {"to", 0, "FORMAT", 0,
     ABBE_SCENE_EXPORTS(NAME) "or povray; by the file's ending where it is not said", 0,
     ABBE_TAKE_TEXT(request, to)},
    {"photons", 0, "N", 0, "that POV-Ray shoots at refractors (100000)", 0,
     ABBE_TAKE_COUNT(request, pov.photons, 1, ABBE_POV_MAX_PHOTONS)},
    {"samples", 0, "N", 0, "of POV-Ray's spectrum, 2 to 100 (31)", 0,
     ABBE_TAKE_COUNT(request, pov.samples, 2, ABBE_POV_MAX_SAMPLES)},
    {"materials", 0, "TABLE", ABBE_ARGUMENT_READS,
     "a table instead of the scene's: default, thesis or a file", 0,
     ABBE_TAKE_TEXT(request, materials)},
    ABBE_OPTIONS(request, &abbe_scene_input_options, changes, NULL, 0),
    ABBE_OPTIONS(request, &abbe_studio_options, changes, NULL, 0),
    {"json", 0, NULL, 0, "what became of each material, on standard output", 0,
     ABBE_TAKE_FLAG(request, json)},
    {"quiet", 'q', NULL, 0, "no summary", 1, ABBE_TAKE_FLAG(request, quiet)},
    ABBE_NEEDED(request, scene, "which scene? Give a file such as scenes/gem.yaml"),
    ABBE_NEEDED(request, output, "where to? Give -o FILE.pbrt, for one"),
    {0}};

/* By --to, else by the ending; the ending has to be the format's. */
static void choose_target(request *q, struct argp_state *state) {
  static const char povray[] = "povray";
  const char *dot = strrchr(q->output, '.'), *ending = ".pov";
  int i = 0;
  if (q->to != NULL) {
    i = abbe_scene_export_of_name(q->to);
    if (i == ABBE_SCENE_EXPORT_COUNT && strcmp(q->to, povray) != 0)
      argp_error(state, "--to takes " ABBE_SCENE_EXPORTS(NAME) "or %s, not '%s'", povray, q->to);
  } else {
    while (i < ABBE_SCENE_EXPORT_COUNT && dot != NULL &&
           strcasecmp(dot, abbe_scene_export_ending((abbe_scene_export_target)i)) != 0)
      i++;
    if (dot == NULL || (i == ABBE_SCENE_EXPORT_COUNT && strcasecmp(dot, ending) != 0))
      argp_error(state, "'%s' ends in none of " ABBE_SCENE_EXPORTS(ENDING) "or %s; say --to too",
                 q->output, ending);
  }
  q->target = (abbe_scene_export_target)i;
  if (i < ABBE_SCENE_EXPORT_COUNT) ending = abbe_scene_export_ending(q->target);
  q->output = abbe_command_target(state->name, "-o", q->output, ending);
  const bool pov = q->pov.photons != 0 || q->pov.samples != 0;
  if (i < ABBE_SCENE_EXPORT_COUNT && pov)
    argp_error(state, "--photons and --samples are POV-Ray's; leave them out");
}

static error_t parse(int key, char *text, struct argp_state *state) {
  request *q = state->input;
  switch (key) {
  case ARGP_KEY_ARG:
    abbe_scene_input_take_file(&q->changes, &q->scene, text, state);
    return 0;
  case ARGP_KEY_END:
    choose_target(q, state);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

/* What the file lacks of camera, lights and objects. */
static void report_left_out(const abbe_scene *scene) {
  if (scene->camera.aperture > 0) fprintf(stderr, "camera: its aperture is left out\n");
  if (scene->camera.polariser.kind != ABBE_POLARISER_NONE)
    fprintf(stderr, "camera: its polariser is left out\n");
  for (size_t i = 0; i < scene->light_count; i++)
    if (scene->light[i].polariser.kind != ABBE_POLARISER_NONE)
      fprintf(stderr, "%s: its polariser is left out\n", scene->light[i].name);
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    if (o->coatings != NULL) fprintf(stderr, "%s: its coating is left out\n", o->name);
    if (o->roughness != NULL) fprintf(stderr, "%s: its roughness is left out\n", o->name);
    if (o->cloud) fprintf(stderr, "%s: it is left out\n", o->name);
  }
}

/* Whether an object before this one is of its material. */
static bool said(const abbe_scene *scene, size_t object) {
  for (size_t i = 0; i < object; i++)
    if (scene->object[i].material == scene->object[object].material) return true;
  return false;
}

static abbe_result report_pov(const request *q, const abbe_scene *scene, abbe_error *error) {
  cJSON *root = q->json ? cJSON_CreateObject() : NULL;
  cJSON *glasses = q->json ? cJSON_AddArrayToObject(root, "materials") : NULL;
  abbe_result result = ABBE_OK;
  if (!q->json) report_left_out(scene);
  for (size_t i = 0; i < scene->object_count && result == ABBE_OK; i++) {
    const abbe_material *m = scene->object[i].material;
    abbe_pov_glass g;
    if (abbe_object_kind_of(&scene->object[i]) != ABBE_OBJECT_REFRACTOR || said(scene, i)) continue;
    result = abbe_pov_file_glass(m, abbe_scene_illuminant(scene), &g, error);
    if (result != ABBE_OK) break;
    if (!q->json) {
      fprintf(stderr, "%s: ior %.6f, dispersion %.6f; n off by %.2g at %g nm, %.2g in the mean\n",
              m->name, g.index.ior, g.index.dispersion, g.worst, g.worst_nm, g.rms);
      if (abbe_material_is_crystal(m))
        fprintf(stderr, "%s: its double refraction is left out\n", m->name);
      if (abbe_material_is_fluorescent(m))
        fprintf(stderr, "%s: its fluorescence is left out\n", m->name);
      if (abbe_material_is_pleochroic(m))
        fprintf(stderr, "%s: its absorption is the mean over its axes\n", m->name);
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
    return abbe_command_print_json(root, true, error);
  }
  cJSON_Delete(root);
  return result;
}

static void add_glass_json(cJSON *list, const abbe_scene_export_glass *g) {
  cJSON *glass = cJSON_CreateObject();
  cJSON_AddItemToArray(list, glass);
  cJSON_AddStringToObject(glass, "name", g->material->name);
  cJSON_AddStringToObject(glass, "form", abbe_export_form_name(g->index.form));
  if (g->index.form != ABBE_EXPORT_FORM_TABLE) {
    const int count = g->index.form == ABBE_EXPORT_FORM_THREE ? 3 : 2;
    cJSON_AddItemToObject(glass, "values", cJSON_CreateDoubleArray(g->index.value, count));
  }
  cJSON_AddNumberToObject(glass, "worst", g->index.worst);
  cJSON_AddNumberToObject(glass, "worst_nm", g->index.worst_nm);
  cJSON_AddNumberToObject(glass, "rms", g->index.rms);
}

static abbe_result report_json(const request *q, const abbe_scene_export_report *r,
                               abbe_error *error) {
  cJSON *root = cJSON_CreateObject();
  cJSON_AddStringToObject(root, "format", abbe_scene_export_name(q->target));
  cJSON_AddStringToObject(root, "output", q->output);
  cJSON *glasses = cJSON_AddArrayToObject(root, "materials");
  for (size_t i = 0; i < r->glass_count; i++) add_glass_json(glasses, &r->glass[i]);
  cJSON *notes = cJSON_AddArrayToObject(root, "notes");
  for (size_t i = 0; i < r->notes.count; i++) {
    cJSON *note = cJSON_CreateObject();
    cJSON_AddItemToArray(notes, note);
    cJSON_AddStringToObject(note, "kind", abbe_note_kind_word(r->notes.note[i].kind));
    cJSON_AddStringToObject(note, "of", r->notes.note[i].name);
    cJSON_AddStringToObject(note, "text", r->notes.note[i].text);
  }
  return abbe_command_print_json(root, true, error);
}

static void report_text(const abbe_scene_export_report *r) {
  for (size_t i = 0; i < r->glass_count; i++) {
    const abbe_scene_export_glass *g = &r->glass[i];
    fprintf(stderr, "%s: n as '%s' is off by up to %.2g (at %g nm), RMS %.2g\n", g->material->name,
            abbe_export_form_name(g->index.form), g->index.worst, g->index.worst_nm, g->index.rms);
  }
  for (size_t i = 0; i < r->notes.count; i++)
    fprintf(stderr, "%s: %s: %s\n", abbe_note_kind_word(r->notes.note[i].kind),
            r->notes.note[i].name, r->notes.note[i].text);
}

static abbe_result write_scene(const request *q, const abbe_scene *scene, abbe_error *error) {
  if (q->target == ABBE_SCENE_EXPORT_COUNT) {
    const abbe_result result = abbe_pov_file_write(q->output, scene, &q->pov, error);
    return result == ABBE_OK && (q->json || !q->quiet) ? report_pov(q, scene, error) : result;
  }
  ABBE_OWNED(abbe_scene_export_report, report) = {0};
  ABBE_TRY(abbe_scene_export_write(q->output, scene, q->target, &report, error));
  if (q->json) ABBE_TRY(report_json(q, &report, error));
  if (!q->json && !q->quiet) report_text(&report);
  return ABBE_OK;
}

int abbe_command_export(int argc, char **argv) {
  static const abbe_parser argp = {
      options, parse, "SCENE.yaml",
      "Writes a scene for another program, and says what that cannot hold of it.\v"
      "pbrt takes n as a table, glTF n_d and an Abbe number, Blender one index for red, green and "
      "blue each, POV-Ray two numbers. Pictures are written beside the file, as STEM-NAME.\n\n"
      "Examples:\n"
      "  abbe export scenes/gem.yaml -o gem.pbrt\n"
      "  abbe export scenes/gem.yaml -o gem.glb --json\n"
      "  abbe export scenes/gem.yaml --to blender -o gem.py\n"
      "  abbe export scenes/prism.yaml -o prism.pov --photons 1000000 --samples 100\n"};
  request q = {.program = argv[0]};
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &q);
  abbe_error error = {0};
  abbe_scene scene = {0};
  abbe_result result =
      abbe_scene_input_load_with(argv[0], q.scene, q.materials, &q.changes, &scene, &error);
  if (result == ABBE_OK) result = write_scene(&q, &scene, &error);
  abbe_scene_free(&scene);
  return abbe_command_end(q.program, result, &error);
}
