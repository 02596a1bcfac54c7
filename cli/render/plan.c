#include "cli/base/arguments.h"

#include "cli/base/command.h"
#include "cli/options/scene_input.h"
#include "cli/render/render_options.h"
#include "gl/methods/facts/method_facts.h"
#include "gl/plan/facts/render_desc.h"
#include "scenes/import/scene_file.h"

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct plan_options {
  abbe_render_options render;
  bool json;
} plan_options;

static void print_text(const abbe_plan *plan) {
  for (int runs = 1; runs >= 0; runs--) {
    printf("%s\n", runs ? "What runs, and the fact that asks for it:" : "\nWhat does not run:");
    for (size_t i = 0; i < plan->entry_count; i++)
      if (plan->entry[i].runs == (bool)runs)
        printf("  %-26s %s\n", plan->entry[i].name, plan->entry[i].reason);
  }
  if (plan->note_count > 0) printf("\nWhat to know:\n");
  for (size_t i = 0; i < plan->note_count; i++) printf("  %s\n", plan->note[i]);
}

static abbe_result print_json(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error) {
  cJSON *root = cJSON_CreateObject(), *entries = cJSON_AddArrayToObject(root, "plan");
  for (size_t i = 0; i < plan->entry_count; i++) {
    cJSON *entry = cJSON_CreateObject();
    cJSON_AddStringToObject(entry, "name", plan->entry[i].name);
    cJSON_AddBoolToObject(entry, "runs", plan->entry[i].runs);
    cJSON_AddStringToObject(entry, "reason", plan->entry[i].reason);
    cJSON_AddItemToArray(entries, entry);
  }
  cJSON *notes = cJSON_AddArrayToObject(root, "notes");
  for (size_t i = 0; i < plan->note_count; i++)
    cJSON_AddItemToArray(notes, cJSON_CreateString(plan->note[i]));
  abbe_scene_input_list_json(scene, root);
  cJSON_AddNumberToObject(root, "wavelengths", (double)plan->desc.wavelengths);
  cJSON_AddNumberToObject(root, "exits", (double)plan->desc.exits);
  return abbe_command_print_json(root, true, error);
}

int abbe_command_plan(int argc, char **argv) {
  static const abbe_option options[] = {
      {"json", 'j', NULL, 0, "as JSON", 0, ABBE_TAKE_FLAG(plan_options, json)},
      ABBE_OPTIONS(plan_options, &abbe_render_options_argp, render, "The request:", 1),
      {0}};

  static const abbe_parser argp = {
      options, NULL, NULL,
      "Says which passes and models a scene asks for, and which fact asks for each. Takes the "
      "options of abbe render, those of 'abbe methods --help' too. Needs no graphics.\v"
      "Examples:\n"
      "  abbe plan scenes/gem.yaml\n"
      "  abbe plan scenes/gem.yaml --profile thesis --json\n"};
  plan_options o = {.render.program = argv[0]};
  abbe_render_options_begin();
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &o);
  abbe_error error = {0};
  abbe_scene scene = {0};
  abbe_plan plan = {0};
  abbe_result result = abbe_scene_input_load_with(argv[0], o.render.scene, o.render.materials,
                                                  &o.render.changes, &scene, &error);
  if (result == ABBE_OK) result = abbe_render_options_load_volume(&o.render, &error);
  bool loaded = result == ABBE_OK;
  if (loaded) result = abbe_plan_make(&scene, &o.render.desc, &plan, &error);
  if (loaded) abbe_scene_input_note(&scene);
  if (result == ABBE_OK && o.json) result = print_json(&scene, &plan, &error);
  if (result == ABBE_OK && !o.json) {
    abbe_scene_input_list(&scene);
    print_text(&plan);
  }
  abbe_plan_free(&plan);
  abbe_scene_free(&scene);
  abbe_caustic_volume_free(&o.render.volume);
  return abbe_render_options_end(&o.render, loaded, result, &error);
}

/* abbe methods: what can be drawn in place of the renderer's own way, and the options that abbe
 * render shows here. */
static error_t methods_parse(int key, char *text, struct argp_state *state) {
  (void)text;
  const bool asks = key > 0 && key < ARGP_KEY_END; /* for one of the options below */
  if (key == ARGP_KEY_ARG || asks)
    argp_error(state, "this is a page to be read; draw by 'abbe render SCENE.yaml --profile NAME'");
  return 0;
}

int abbe_command_methods(int argc, char **argv) {
  const abbe_parser argp = {
      abbe_render_options_aside(), methods_parse, NULL,
      "Lists the published methods that 'abbe render --profile NAME' draws by, as they were "
      "printed and, with -cie, with CIE weights, Fresnel's law and watts. Below are the options of "
      "'abbe render' that only they, pinholes and caustic volumes take, and its seldom ones.\v"
      "Examples:\n"
      "  abbe methods\n"
      "  abbe render scenes/sphere.yaml --profile thesis --png thesis.png --view Plain\n"
      "  abbe render scenes/sphere.yaml --profile wyman2006-cie --fill quads --png quads.png\n"
      "  abbe render scenes/metals.yaml --transport pinhole --pinholes 512 --png metals.png\n"};
  abbe_arguments_parse(&argp, 0, argc, argv, NULL);
  for (int i = 0; i < ABBE_PROFILE_COUNT; i++)
    printf("%-14s %s\n", abbe_profile_name((abbe_profile)i), abbe_method_of((abbe_profile)i)->says);
  printf("\n'abbe methods --help' shows their options and the seldom ones of 'abbe render'; "
         "docs/methods.md compares their pictures.\n");
  return ABBE_EXIT_DONE;
}
