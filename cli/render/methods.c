/* abbe methods: what can be drawn in place of the renderer's own way, and the options that abbe
 * render shows here. */
#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/render/render_options.h"

#include "gl/methods/facts/method_facts.h"
#include "gl/plan/facts/render_desc.h"

#include <argp.h>
#include <stdbool.h>
#include <stdio.h>

static error_t parse(int key, char *text, struct argp_state *state) {
  (void)text;
  const bool asks = key > 0 && key < ARGP_KEY_END; /* for one of the options below */
  if (key == ARGP_KEY_ARG || asks)
    argp_error(state, "this is a page to be read; draw by 'abbe render SCENE.yaml --profile NAME'");
  return 0;
}

int abbe_command_methods(int argc, char **argv) {
  const struct argp argp = {
      abbe_render_options_aside(),
      parse,
      NULL,
      "Lists the published methods that 'abbe render --profile NAME' draws by, as they were "
      "printed and, with -cie, with CIE weights, Fresnel's law and watts. Below are the options of "
      "'abbe render' that only they, pinholes and caustic volumes take, and its seldom ones.\v"
      "Examples:\n"
      "  abbe methods\n"
      "  abbe render scenes/sphere.yaml --profile thesis --png thesis.png --view Plain\n"
      "  abbe render scenes/sphere.yaml --profile wyman2006-cie --fill quads --png quads.png\n"
      "  abbe render scenes/metals.yaml --transport pinhole --pinholes 512 --png metals.png\n",
      NULL,
      NULL,
      NULL};
  abbe_arguments_parse(&argp, 0, argc, argv, NULL);
  for (int i = 0; i < ABBE_PROFILE_COUNT; i++)
    printf("%-14s %s\n", abbe_profile_name((abbe_profile)i), abbe_method_of((abbe_profile)i)->says);
  printf("\n'abbe methods --help' shows their options and the seldom ones of 'abbe render'; "
         "docs/methods.md compares their pictures.\n");
  return ABBE_EXIT_DONE;
}
