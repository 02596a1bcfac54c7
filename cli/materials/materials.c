#include "cli/materials/materials.h"

static const abbe_verb verbs[] = {
#define ABBE_MATERIALS_ROW(name, summary) {#name, summary, abbe_materials_##name},
    ABBE_MATERIALS_VERBS(ABBE_MATERIALS_ROW)
#undef ABBE_MATERIALS_ROW
};

static const char *const examples[] = {"list",
                                       "show diamond --at 430.8 --at 686.7",
                                       "nearest --nd 1.728 --vd 28.4",
                                       "plot --map -o map.png",
                                       "import maker.agf -o glasses.yaml",
                                       "check --table glasses.yaml",
                                       "set sf10 coefficients.1=1.61625977 --table glasses.yaml "
                                       "--dry-run"};

int abbe_command_materials(int argc, char **argv) {
  const abbe_verbs all = {.verb = verbs,
                          .count = sizeof verbs / sizeof *verbs,
                          .example = examples,
                          .examples = sizeof examples / sizeof *examples,
                          .page = "docs/materials.md goes from\na catalogue to a picture."};
  return abbe_verbs_run(&all, argc, argv);
}
