#include "cli/gem/gem.h"

#include "cli/base/command.h"

static const abbe_verb verbs[] = {
#define ABBE_GEM_ROW(name, summary) {#name, summary, abbe_gem_##name},
    ABBE_GEM_VERBS(ABBE_GEM_ROW)
#undef ABBE_GEM_ROW
};

static const char *const examples[] = {
    "info scenes/designs/brilliant-quartz.asc",
    "diagram scenes/designs/step-square.asc -o step.pdf",
    "retarget scenes/designs/brilliant-quartz.asc --material sapphire -o sapphire.asc",
    "report scenes/designs/brilliant-diamond.asc --material diamond -o report.pdf",
    "optimise scenes/designs/brilliant-quartz.asc --material quartz -o best.asc --plot best.png",
    "convert scenes/designs/brilliant-quartz.asc --width 8 --material diamond -o stone.glb"};

int abbe_command_gem(int argc, char **argv) {
  const abbe_verbs all = {.verb = verbs,
                          .count = sizeof verbs / sizeof *verbs,
                          .example = examples,
                          .examples = sizeof examples / sizeof *examples,
                          .page = "docs/gems.md goes from a\ndesign to a picture and its numbers."};
  return abbe_verbs_run(&all, argc, argv);
}
