/* plan_rows.h: plans as rows that a test writes down, by ids, and what two plans have otherwise. */
#ifndef ABBE_TESTS_GL_PLAN_PLAN_ROWS_H
#define ABBE_TESTS_GL_PLAN_PLAN_ROWS_H

#include "tests/gl/plan/planned.h"

typedef enum row_kind { ROW_END, ROW_COUNTS, ROW_RUNS, ROW_RESTS, ROW_GONE, ROW_NOTE } row_kind;

/* `part` of the reason, or of the note; `about`: name of the object or light, or "". */
typedef struct row {
  row_kind kind;
  abbe_plan_item item;
  const char *about, *part;
  size_t count[3];
} row;

/* Wavelengths, exits, and hits of a photon. */
#define COUNTS(wavelengths, exits, hits) FIELDS(ROW_COUNTS, 0, "", "", {wavelengths, exits, hits})
#define RUNS_OF(item, about, part) FIELDS(ROW_RUNS, ABBE_##item, about, part, {0})
#define RESTS_OF(item, about, part) FIELDS(ROW_RESTS, ABBE_##item, about, part, {0})
#define RUNS(item, part) RUNS_OF(item, "", part)
#define RESTS(item, part) RESTS_OF(item, "", part)
#define GONE(item, about) FIELDS(ROW_GONE, ABBE_##item, about, "", {0})
#define NOTE(part) FIELDS(ROW_NOTE, 0, "", part, {0})
#define END FIELDS(ROW_END, 0, "", "", {0})

#define GREY RESTS(CHOICE_RECEIVER_COLOURS, "no dispersed light falls on a receiver in colours")
#define COLOURED                                                                                   \
  RUNS(CHOICE_RECEIVER_COLOURS, "tables of what they reflect of bands, for light arrives "         \
                                "dispersed")

typedef struct line {
  row_kind kind;
  abbe_plan_item item;
  size_t count[3];
  char about[64], text[256];
} line;

enum { MAX_LINES = ABBE_PLAN_MAX_ENTRIES + 24 };

typedef struct lines {
  size_t count;
  line line[MAX_LINES];
} lines;

static inline line *put(lines *l, row_kind kind, abbe_plan_item item) {
  assert_true(l->count < MAX_LINES);
  line *added = &l->line[l->count++];
  *added = (line){.kind = kind, .item = item};
  return added;
}

#define DISK_LIGHT                                                                                 \
  "lights:\n- {name: lamp, kind: disk, position: [0.05, 0.03, 0.6], target: [0, 0, 0], radius: "   \
  "0.05, radiance: 100}\n"
#define LAMP_HAS_SIZE                                                                              \
  "a disk, 'lamp' first: 1 points stand for each, with as many shadows, soft ones of convex "      \
  "solids; where nothing hides it receivers have its light in closed form"

/* Of a scene with facets. */
#define IN_ROWS RUNS(PASS_SPECTRAL_MAP, "splats in rows: a refractor has facets")

/* The renderer gives an environment lights of its own, after the scene's. */
static inline const char *light_name(const abbe_scene *scene, size_t light) {
  return light < scene->light_count ? scene->light[light].name : "environment 1";
}

static inline void tell(const abbe_scene *scene, const abbe_plan *plan, lines *out) {
  out->count = 0;
  line *counts = put(out, ROW_COUNTS, 0);
  counts->count[0] = plan->desc.wavelengths;
  counts->count[1] = plan->desc.exits;
  counts->count[2] = plan->hit_slots;
  for (size_t i = 0; i < plan->entry_count; i++) {
    const abbe_plan_entry *e = &plan->entry[i];
    line *l = put(out, e->runs ? ROW_RUNS : ROW_RESTS, e->item);
    const char *about = e->item == ABBE_CHOICE_REFRACTOR_MODEL ? scene->object[e->index].name
                        : e->item == ABBE_CHOICE_LIGHT_MAP     ? light_name(scene, e->index)
                                                               : "";
    snprintf(l->about, sizeof l->about, "%s", about);
    snprintf(l->text, sizeof l->text, "%s", e->reason);
  }
  for (size_t i = 0; i < plan->note_count; i++)
    snprintf(put(out, ROW_NOTE, 0)->text, sizeof out->line[0].text, "%s", plan->note[i]);
}

static inline bool is_about_the_same(const line *a, const line *b) {
  return (a->kind == ROW_RUNS || a->kind == ROW_RESTS) &&
         (b->kind == ROW_RUNS || b->kind == ROW_RESTS) && a->item == b->item &&
         strcmp(a->about, b->about) == 0;
}

static inline bool is_the_same(const line *a, const line *b) {
  return a->kind == b->kind && a->item == b->item && strcmp(a->about, b->about) == 0 &&
         strcmp(a->text, b->text) == 0 && memcmp(a->count, b->count, sizeof a->count) == 0;
}

/* What the other plan has otherwise, in its order; then the entries that it has no more. */
static inline void differ(const lines *from, const lines *to, lines *out) {
  out->count = 0;
  for (size_t i = 0; i < to->count; i++) {
    bool same = false;
    for (size_t k = 0; k < from->count; k++)
      same = same || is_the_same(&to->line[i], &from->line[k]);
    if (!same) *put(out, 0, 0) = to->line[i];
  }
  for (size_t i = 0; i < from->count; i++) {
    const line *l = &from->line[i];
    bool there = l->kind != ROW_RUNS && l->kind != ROW_RESTS;
    for (size_t k = 0; k < to->count; k++) there = there || is_about_the_same(l, &to->line[k]);
    if (there) continue;
    strcpy(put(out, ROW_GONE, l->item)->about, l->about);
  }
}

static inline bool holds(const row *r, const line *l) {
  return r->kind == l->kind && r->item == l->item && strcmp(r->about, l->about) == 0 &&
         strstr(l->text, r->part) != NULL && memcmp(r->count, l->count, sizeof r->count) == 0;
}

static inline void check_rows(const char *scene, const row *rows, const lines *l) {
  static const char *const kinds[] = {"no more", "counts", "runs", "rests", "gone", "note"};
  size_t count = 0;
  while (rows[count].kind != ROW_END) count++;
  for (size_t i = 0; i < count || i < l->count; i++) {
    if (i < count && i < l->count && holds(&rows[i], &l->line[i])) continue;
    for (size_t k = 0; k < l->count; k++)
      print_message("  %s '%s%s': %s (%zu %zu %zu)\n", kinds[l->line[k].kind],
                    abbe_plan_item_text(l->line[k].item), l->line[k].about, l->line[k].text,
                    l->line[k].count[0], l->line[k].count[1], l->line[k].count[2]);
    fail_msg("%s: row %zu, expected: %s '%s%s': %s", scene, i + 1,
             kinds[rows[i < count ? i : count].kind],
             i < count ? abbe_plan_item_text(rows[i].item) : "", i < count ? rows[i].about : "",
             i < count ? rows[i].part : "");
  }
}

#endif
