#include "cli/materials/materials.h"

#include <stdio.h>

enum { FIRST_FEW = 12 };

void abbe_materials_print_report(const char *program, const abbe_report *report, bool all) {
  size_t shown[ABBE_NOTE_KIND_COUNT] = {0};
  for (size_t i = 0; i < report->count; i++) {
    const abbe_note *n = &report->note[i];
    if (++shown[n->kind] > FIRST_FEW && !all) continue;
    fprintf(stderr, "%s: %s: ", program, abbe_note_kind_word(n->kind));
    if (n->file[0] != '\0') fprintf(stderr, "%s: ", n->file);
    if (n->name[0] != '\0') fprintf(stderr, "%s: ", n->name);
    if (n->line > 0) fprintf(stderr, "line %zu: ", n->line);
    fprintf(stderr, "%s\n", n->text);
  }
  for (int k = 0; k < ABBE_NOTE_KIND_COUNT; k++) {
    size_t told = all || shown[k] < FIRST_FEW ? shown[k] : FIRST_FEW;
    if (report->kinds[k] > told)
      fprintf(stderr, "%s: %s: %zu more like these; --all shows them\n", program,
              abbe_note_kind_word((abbe_note_kind)k), report->kinds[k] - told);
  }
}

void abbe_materials_add_report(cJSON *to, const abbe_report *report) {
  for (int k = 0; k < ABBE_NOTE_KIND_COUNT; k++)
    cJSON_AddNumberToObject(to, abbe_note_kind_word((abbe_note_kind)k), (double)report->kinds[k]);
  cJSON *list = cJSON_AddArrayToObject(to, "notes");
  for (size_t i = 0; i < report->count; i++) {
    const abbe_note *n = &report->note[i];
    cJSON *item = cJSON_CreateObject();
    if (item == NULL || !cJSON_AddItemToArray(list, item)) continue;
    cJSON_AddStringToObject(item, "kind", abbe_note_kind_word(n->kind));
    if (n->file[0] != '\0') cJSON_AddStringToObject(item, "file", n->file);
    cJSON_AddNumberToObject(item, "line", (double)n->line);
    cJSON_AddStringToObject(item, "name", n->name);
    cJSON_AddStringToObject(item, "text", n->text);
  }
}
