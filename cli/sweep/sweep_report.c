#include "cli/sweep/sweep_report.h"

#include "cli/base/arguments.h"
#include "cli/base/command.h"

#include "base/file.h"
#include "colorimetry/image/display_ocio.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/png_file.h"
#include "gl/accuracy/preset.h"
#include "gl/renderer.h"
#include "scenes/import/scene_file.h"
#include "validation/sweep/front.h"
#include "validation/sweep/sweep.h"
#include "validation/sweep/sweep_duel.h"
#include "validation/sweep/sweep_split.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_SIZE = 1024, SHOWN = 6, PARAGRAPH = 2000 };

/* The front in the order of time; indices are malloc'd. */
static size_t order_front(const abbe_sweep_table *table, size_t **out) {
  size_t count = 0;
  size_t *order = calloc(table->count + 1, sizeof *order);
  for (size_t i = 0; order != NULL && i < table->count; i++) {
    if (!table->row[i].front) continue;
    size_t at = count++;
    double ms = table->row[i].number[ABBE_SWEEP_FRAME_MS];
    for (; at > 0 && table->row[order[at - 1]].number[ABBE_SWEEP_FRAME_MS] > ms; at--)
      order[at] = order[at - 1];
    order[at] = i;
  }
  *out = order;
  return count;
}

/* What a table of the front shows beside the setting. */
static const abbe_sweep_number shown[] = {ABBE_SWEEP_FRAME_MS,     ABBE_SWEEP_CAUSTIC_DE,
                                          ABBE_SWEEP_CAUSTIC_RMSE, ABBE_SWEEP_MAP_RMSE,
                                          ABBE_SWEEP_MAP_ENERGY,   ABBE_SWEEP_PICTURE_DE};
enum { SHOWN_NUMBERS = sizeof shown / sizeof *shown };

static const char *number_text(double value, char out[24]) {
  snprintf(out, 24, isfinite(value) ? "%.3g" : "-", value);
  if (isfinite(value) && fabs(value) >= 1000) snprintf(out, 24, "%.0f", value);
  return out;
}

static void print_row(const abbe_sweep_row *row) {
  char label[64], text[24];
  abbe_sweep_setting_label(&row->setting, label, sizeof label);
  printf("%-34s", label);
  for (int k = 0; k < SHOWN_NUMBERS; k++) printf(" %12s", number_text(row->number[shown[k]], text));
  printf("\n");
}

static abbe_result print_duel(const abbe_sweep_table *table, const char *profile,
                              abbe_sweep_number number, abbe_error *error) {
  abbe_sweep_duel duel;
  char a[24], b[24];
  abbe_result result = abbe_sweep_duel_make(table, profile, number, &duel, error);
  if (result != ABBE_OK || duel.front == 0) return result;
  printf("\n%s", abbe_sweep_baseline_text(profile));
  if (duel.baseline != NULL) {
    printf(", at its own settings:\n");
    print_row(duel.baseline);
    printf("the default profile at its error: %s times as fast; in its time: %s of its error",
           number_text(duel.equal_error_speedup, a), number_text(duel.equal_time_error_ratio, b));
  }
  printf("\nagainst its own front of %zu settings: at least %s times as fast; at most %s of its "
         "error; %zu are beaten in both\n",
         duel.front, number_text(duel.front_speedup, a), number_text(duel.front_ratio, b),
         duel.beaten);
  return ABBE_OK;
}

abbe_result abbe_sweep_report_print(const abbe_sweep_table *table, abbe_sweep_number number,
                                    abbe_error *error) {
  size_t *order, count = order_front(table, &order);
  char text[24];
  if (order == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the front");
  printf("%s, %s: %zu settings, %zu on the front of time and %s\n\n%-34s",
         table->fact[ABBE_SWEEP_FACT_SCENE], table->fact[ABBE_SWEEP_FACT_SIZE], table->count, count,
         abbe_sweep_number_name(number), "");
  for (int k = 0; k < SHOWN_NUMBERS; k++) printf(" %12s", abbe_sweep_number_name(shown[k]));
  printf("\n");
  for (size_t i = 0; i < count; i++) print_row(&table->row[order[i]]);
  if (count > 0)
    printf("the reference's own noise: %s of %s\n",
           number_text(table->row[order[0]].number[number + 1], text),
           abbe_sweep_number_name(number));
  free(order);
  abbe_result result = ABBE_OK;
  for (int i = 0; i < ABBE_SWEEP_BASELINE_COUNT && result == ABBE_OK; i++)
    result = print_duel(table, abbe_sweep_baselines[i], number, error);
  abbe_sweep_split split;
  char words[PARAGRAPH];
  abbe_sweep_split_make(table, &split);
  abbe_sweep_split_say(&split, words, sizeof words);
  if (isfinite(split.rest)) printf("\n%s\n", words);
  return result;
}

/* Promises */

static const abbe_preset_front *find_front(const abbe_presets *presets, const char *of) {
  for (size_t i = 0; i < presets->count; i++)
    if (strcmp(abbe_preset_class_name(presets->front[i].of), of) == 0) return &presets->front[i];
  return NULL;
}

static const abbe_sweep_row *find_point(const abbe_sweep_table *table, const abbe_preset_point *p) {
  abbe_sweep_setting setting;
  abbe_sweep_setting_of(&p->desc, &setting);
  return abbe_sweep_table_find(table, &setting);
}

static const char *preset_of(const abbe_preset_front *front, size_t point) {
  for (int i = 0; i < ABBE_PRESET_COUNT; i++)
    if (front->named[i] == point) return abbe_preset_name_text((abbe_preset_name)i);
  return "";
}

static void print_promise(const abbe_preset_front *front, size_t i, const abbe_preset_speed *speed,
                          abbe_sweep_number number, const abbe_sweep_row *row) {
  const abbe_preset_point *p = &front->point[i];
  char label[64], e[24], ms[24];
  double promised_ms = abbe_preset_ms(p, speed);
  abbe_sweep_setting_label(&row->setting, label, sizeof label);
  printf("%-9s %-24s error %.3g promised, %s met", preset_of(front, i), label, p->error,
         number_text(row->number[number], e));
  printf("%s; %.0f ms promised, %s met\n", row->number[number] <= p->error ? "" : " (MORE)",
         promised_ms, number_text(row->number[ABBE_SWEEP_FRAME_MS], ms));
}

abbe_result abbe_sweep_report_print_promises(const abbe_sweep_table *table, const char *file,
                                             abbe_error *error) {
  abbe_presets presets;
  abbe_result result = abbe_presets_load(file, &presets, error);
  if (result != ABBE_OK) return result;
  const abbe_preset_front *front = find_front(&presets, table->fact[ABBE_SWEEP_FACT_CLASS]);
  const abbe_sweep_row *first = front != NULL ? find_point(table, &front->point[0]) : NULL;
  abbe_sweep_number number = abbe_sweep_number_find(presets.error);
  if (first != NULL && number != ABBE_SWEEP_NUMBER_COUNT) {
    const abbe_preset_point *p = &front->point[0];
    abbe_preset_speed speed = {first->number[ABBE_SWEEP_LIGHT_MS] / fmax(p->light_ms, 0.01),
                               first->number[ABBE_SWEEP_EYE_MS] / fmax(p->eye_ms, 0.01)};
    printf("\npresets, %s, made on %s; margin %.3g for the error, %.3g for the time:\n",
           presets.error_text, front->scenes, front->margin, front->time_margin);
    for (size_t i = 0; i < front->count; i++) {
      const abbe_sweep_row *row = find_point(table, &front->point[i]);
      if (row != NULL) print_promise(front, i, &speed, number, row);
    }
  }
  abbe_presets_free(&presets);
  return result;
}

/* JSON */

static void add_number(cJSON *object, const char *name, double value) {
  if (isfinite(value))
    cJSON_AddNumberToObject(object, name, value);
  else
    cJSON_AddNullToObject(object, name);
}

static cJSON *describe_row(const abbe_sweep_row *row) {
  const abbe_sweep_setting *s = &row->setting;
  cJSON *o = cJSON_CreateObject();
  cJSON_AddStringToObject(o, "profile", s->profile);
  cJSON_AddNumberToObject(o, "wavelengths", (double)s->wavelengths);
  cJSON_AddNumberToObject(o, "photons", (double)s->photons);
  cJSON_AddNumberToObject(o, "map", (double)s->map);
  cJSON_AddNumberToObject(o, "samples", (double)s->samples);
  cJSON_AddNumberToObject(o, "upsample", (double)s->upsample);
  cJSON_AddStringToObject(o, "fill", s->fill);
  cJSON_AddNumberToObject(o, "exits", (double)s->exits);
  cJSON_AddNumberToObject(o, "share", s->share);
  cJSON_AddStringToObject(o, "model", s->model);
  for (int i = 0; i < ABBE_SWEEP_NUMBER_COUNT; i++)
    add_number(o, abbe_sweep_number_name((abbe_sweep_number)i), row->number[i]);
  cJSON_AddBoolToObject(o, "front", row->front);
  return o;
}

/* "equal_error_speedup" against the thesis profile, "vs_fair_..." against its method in units. */
static abbe_result describe_duel(const abbe_sweep_table *table, const char *profile,
                                 abbe_sweep_number number, cJSON *root, abbe_error *error) {
  abbe_sweep_duel d;
  abbe_result result = abbe_sweep_duel_make(table, profile, number, &d, error);
  if (result != ABBE_OK) return result;
  const struct {
    const char *name;
    double value;
  } all[] = {{"equal_error_speedup", d.equal_error_speedup},
             {"equal_time_error_ratio", d.equal_time_error_ratio},
             {"front_speedup", d.front_speedup},
             {"front_ratio", d.front_ratio},
             {"front_points", (double)d.front},
             {"front_points_beaten", (double)d.beaten}};
  const char *before = strcmp(profile, abbe_sweep_baselines[0]) == 0 ? "" : "vs_fair_";
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    char name[64];
    snprintf(name, sizeof name, "%s%s", before, all[i].name);
    add_number(root, name, all[i].value);
  }
  return ABBE_OK;
}

static void describe_split(const abbe_sweep_table *table, cJSON *root) {
  abbe_sweep_split s;
  char words[PARAGRAPH];
  abbe_sweep_split_make(table, &s);
  if (s.row == NULL) return;
  abbe_sweep_split_say(&s, words, sizeof words);
  cJSON *o = cJSON_AddObjectToObject(root, "split");
  add_number(o, "total", s.total);
  add_number(o, "model", s.model);
  add_number(o, "sampling_and_reconstruction", s.rest);
  add_number(o, "with_fill", s.with_fill);
  add_number(o, "without_fill", s.without_fill);
  cJSON_AddStringToObject(o, "words", words);
}

abbe_result abbe_sweep_report_print_json(const abbe_sweep_table *table, abbe_sweep_number number,
                                         abbe_error *error) {
  cJSON *root = cJSON_CreateObject();
  abbe_result result = ABBE_OK;
  for (int i = 0; i < ABBE_SWEEP_FACT_COUNT; i++)
    cJSON_AddStringToObject(root, abbe_sweep_fact_name((abbe_sweep_fact)i), table->fact[i]);
  cJSON_AddStringToObject(root, "error", abbe_sweep_number_name(number));
  for (int i = 0; i < ABBE_SWEEP_BASELINE_COUNT && result == ABBE_OK; i++)
    result = describe_duel(table, abbe_sweep_baselines[i], number, root, error);
  describe_split(table, root);
  cJSON *rows = cJSON_AddArrayToObject(root, "rows");
  for (size_t i = 0; i < table->count; i++)
    cJSON_AddItemToArray(rows, describe_row(&table->row[i]));
  if (result == ABBE_OK) result = abbe_command_print_json(root, error);
  cJSON_Delete(root);
  return result;
}

/* Pictures */

static abbe_result write_png(const abbe_image *image, double scale, const char *path,
                             abbe_error *error) {
  static const char *const rgb[] = {"R", "G", "B"}, *const xyz[] = {"X", "Y", "Z"};
  const char *const *name = abbe_image_find_channel(image, "R") != (size_t)-1 ? rgb : xyz;
  const char *word = abbe_image_attribute_text(image, "abbe:space");
  abbe_display_desc desc = {0};
  abbe_display *display = NULL;
  abbe_image plain = {0};
  for (int i = 0; word != NULL && i < ABBE_RGB_SPACE_COUNT; i++)
    if (strcmp(word, abbe_rgb_space_name((abbe_rgb_space)i)) == 0)
      desc.source_space = abbe_rgb_space_ocio_name((abbe_rgb_space)i);
  abbe_result result = abbe_image_make(image->width, image->height, 3, name, &plain, error);
  for (size_t k = 0; k < 3 && result == ABBE_OK; k++) {
    size_t from = abbe_image_find_channel(image, name[k]);
    if (from == (size_t)-1) continue;
    for (size_t i = 0; i < image->width * image->height; i++)
      plain.data[3 * i + k] = (float)(scale * (double)image->data[i * image->channels + from]);
  }
  if (result == ABBE_OK) result = abbe_display_make(&desc, &display, error);
  if (result == ABBE_OK) result = abbe_display_apply(display, &plain, error);
  if (result == ABBE_OK) result = abbe_png_write(path, &plain, 8, error);
  abbe_display_free(display);
  abbe_image_free(&plain);
  return result;
}

/* A picture of the page: a file's name, and what it shows. */
typedef struct shot {
  char file[PATH_SIZE], text[160];
  bool there;
} shot;

static abbe_result draw(abbe_context *context, const abbe_scene *scene, const abbe_sweep_table *t,
                        const abbe_sweep_row *row, const char *path, abbe_error *error) {
  abbe_render_desc desc;
  abbe_renderer *renderer = NULL;
  abbe_image image = {0};
  abbe_result result = abbe_sweep_setting_desc(&row->setting, &desc, error);
  sscanf(t->fact[ABBE_SWEEP_FACT_SIZE], "%5zux%5zu", &desc.width, &desc.height);
  double scale = row->number[ABBE_SWEEP_SCALE];
  if (result == ABBE_OK) result = abbe_renderer_make(context, scene, &desc, &renderer, error);
  if (result == ABBE_OK) result = abbe_renderer_frame(renderer, NULL, NULL, NULL, error);
  if (result == ABBE_OK) result = abbe_renderer_read(renderer, false, &image, error);
  if (result == ABBE_OK) result = write_png(&image, isfinite(scale) ? scale : 1, path, error);
  abbe_image_free(&image);
  abbe_renderer_free(renderer);
  return result;
}

typedef struct page {
  const char *path; /* of the page */
  FILE *out;
  abbe_context *context;
  abbe_sweep_number number;
  int turn; /* of the table, among those of scenes of one name; from 1 */
} page;

static const char *base_of(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash == NULL ? path : slash + 1;
}

static const char *const names[SHOWN] = {"reference", "cheapest", "middle",
                                         "accurate",  "thesis",   "thesis-cie"};

/* "PAGE-SCENE-what.png", beside the page; "PAGE-SCENE-2-what.png" for a second one of that name. */
static void name_shot(const page *p, const abbe_sweep_table *t, const char *what, shot *out) {
  const char *scene = base_of(t->fact[ABBE_SWEEP_FACT_SCENE]);
  const char *dot = strrchr(p->path, '.');
  int stem = dot != NULL && strchr(dot, '/') == NULL ? (int)(dot - p->path) : (int)strlen(p->path);
  char turn[16] = "";
  if (p->turn > 1) snprintf(turn, sizeof turn, "-%d", p->turn);
  snprintf(out->file, sizeof out->file, "%.*s-%.*s%s-%s.png", stem, p->path,
           (int)strcspn(scene, "."), scene, turn, what);
}

static void say_row(const page *p, const abbe_sweep_row *row, const char *what, shot *out) {
  char label[64], a[24], b[24];
  abbe_sweep_setting_label(&row->setting, label, sizeof label);
  snprintf(out->text, sizeof out->text, "%s: %s, %s ms, %s", what, label,
           number_text(row->number[ABBE_SWEEP_FRAME_MS], a),
           number_text(row->number[p->number], b));
}

static void show_reference(const page *p, const abbe_sweep_table *t, shot *out) {
  abbe_image image = {0};
  name_shot(p, t, "reference", out);
  snprintf(out->text, sizeof out->text, "reference");
  out->there = abbe_exr_read(t->fact[ABBE_SWEEP_FACT_REFERENCE], &image, NULL) == ABBE_OK &&
               write_png(&image, 1, out->file, NULL) == ABBE_OK;
  abbe_image_free(&image);
}

/* The row of a baseline's own settings, or NULL. */
static const abbe_sweep_row *find_baseline(const abbe_sweep_table *t, int which,
                                           abbe_sweep_number number) {
  abbe_sweep_duel duel;
  if (abbe_sweep_duel_make(t, abbe_sweep_baselines[which], number, &duel, NULL) != ABBE_OK)
    return NULL;
  return duel.baseline;
}

/* The reference, three settings of the front, and the two baselines. */
static void take_shots(const page *p, const abbe_sweep_table *t, const size_t *order, size_t count,
                       shot *shots) {
  abbe_scene scene = {0};
  const abbe_sweep_row *rows[SHOWN] = {0};
  if (count > 0) {
    rows[1] = &t->row[order[0]];
    rows[2] = &t->row[order[count / 2]];
    rows[3] = &t->row[order[count - 1]];
  }
  for (int i = 0; i < ABBE_SWEEP_BASELINE_COUNT; i++) rows[4 + i] = find_baseline(t, i, p->number);
  show_reference(p, t, &shots[0]);
  bool loaded = abbe_scene_load(t->fact[ABBE_SWEEP_FACT_SCENE], NULL, &scene, NULL) == ABBE_OK;
  for (int i = 1; i < SHOWN; i++) {
    if (rows[i] == NULL || !loaded) continue;
    name_shot(p, t, names[i], &shots[i]);
    say_row(p, rows[i], names[i], &shots[i]);
    shots[i].there = draw(p->context, &scene, t, rows[i], shots[i].file, NULL) == ABBE_OK;
  }
  abbe_scene_free(&scene);
}

/* The page */

static void write_row(FILE *out, const char *first, const abbe_sweep_row *row) {
  char label[64], text[24], noise[24];
  abbe_sweep_setting_label(&row->setting, label, sizeof label);
  fprintf(out, "| %s%s |", first, label);
  for (int k = 0; k < SHOWN_NUMBERS; k++) {
    fprintf(out, " %s", number_text(row->number[shown[k]], text));
    bool noisy = shown[k] != ABBE_SWEEP_FRAME_MS && isfinite(row->number[shown[k] + 1]);
    if (noisy) fprintf(out, " (%s)", number_text(row->number[shown[k] + 1], noise));
    fprintf(out, " |");
  }
  fprintf(out, "\n");
}

static void write_pictures(FILE *out, const shot *shots) {
  for (int line = 0; line < 3; line++) {
    fprintf(out, "|");
    for (int i = 0; i < SHOWN; i++) {
      if (!shots[i].there) continue;
      if (line == 0) fprintf(out, " ![%s](%s) |", shots[i].text, base_of(shots[i].file));
      if (line == 1) fprintf(out, "---|");
      if (line == 2) fprintf(out, " %s |", shots[i].text);
    }
    fprintf(out, "\n");
  }
  fprintf(out, "\n");
  int missing = 0;
  for (int i = 0; i < SHOWN; i++) missing += !shots[i].there;
  if (missing > 0)
    fprintf(out, "%d pictures are missing: the scene, its reference or a setting is gone.\n\n",
            missing);
}

static abbe_result write_duel(const page *p, const abbe_sweep_table *t, const char *profile,
                              abbe_error *error) {
  abbe_sweep_duel duel;
  char text[4][24];
  abbe_result result = abbe_sweep_duel_make(t, profile, p->number, &duel, error);
  if (result != ABBE_OK || duel.front == 0) return result;
  fprintf(p->out, "| %s | %s | %s | %s | %s | %zu of %zu |\n", abbe_sweep_baseline_text(profile),
          number_text(duel.equal_error_speedup, text[0]),
          number_text(duel.equal_time_error_ratio, text[1]),
          number_text(duel.front_speedup, text[2]), number_text(duel.front_ratio, text[3]),
          duel.beaten, duel.front);
  return ABBE_OK;
}

static abbe_result write_duels(const page *p, const abbe_sweep_table *t, abbe_error *error) {
  abbe_result result = ABBE_OK;
  fprintf(p->out, "| the default profile against the | as fast at its error | of its error in its "
                  "time | as fast, over its front | of the error, over its front | points of it "
                  "beaten in both |\n|---|---|---|---|---|---|\n");
  for (int i = 0; i < ABBE_SWEEP_BASELINE_COUNT && result == ABBE_OK; i++)
    result = write_duel(p, t, abbe_sweep_baselines[i], error);
  fprintf(p->out, "\n");
  return result;
}

/* What each fill adds to the map and drops from it, and what the map then holds of what arrives. */
static void write_fills(const page *p, const abbe_sweep_table *t) {
  const abbe_sweep_row *rows[2 + 2 * ABBE_SWEEP_BASELINE_COUNT] = {0};
  size_t count = 0;
  for (size_t i = 0; i < t->count; i++) {
    /* Every setting that is there without its fill too, and its twin. */
    abbe_sweep_setting filled = t->row[i].setting;
    if (strcmp(filled.fill, "none") != 0 || count + 2 > sizeof rows / sizeof *rows) continue;
    bool plain = strcmp(filled.profile, "default") == 0;
    snprintf(filled.fill, sizeof filled.fill, "%s", plain ? "bridge" : "smear");
    const abbe_sweep_row *twin = abbe_sweep_table_find(t, &filled);
    if (twin == NULL) continue;
    rows[count++] = &t->row[i];
    rows[count++] = twin;
  }
  if (count == 0) return;
  fprintf(p->out, "| fill | added | dropped | map's energy | map, relative RMSE | caustic, "
                  "CIEDE2000 |\n|---|---|---|---|---|---|\n");
  for (size_t i = 0; i < count; i++) {
    static const abbe_sweep_number cells[] = {ABBE_SWEEP_FILL_INVENTED, ABBE_SWEEP_FILL_LOST,
                                              ABBE_SWEEP_MAP_ENERGY, ABBE_SWEEP_MAP_RMSE,
                                              ABBE_SWEEP_CAUSTIC_DE};
    char label[64], text[24];
    abbe_sweep_setting_label(&rows[i]->setting, label, sizeof label);
    fprintf(p->out, "| %s%s%s |", label, i % 2 == 1 ? ", " : "",
            i % 2 == 1 ? rows[i]->setting.fill : "");
    for (size_t k = 0; k < sizeof cells / sizeof *cells; k++)
      fprintf(p->out, " %s |", number_text(rows[i]->number[cells[k]], text));
    fprintf(p->out, "\n");
  }
  fprintf(p->out, "\n");
}

static void write_split(const page *p, const abbe_sweep_table *t) {
  abbe_sweep_split split;
  char words[PARAGRAPH];
  abbe_sweep_split_make(t, &split);
  abbe_sweep_split_say(&split, words, sizeof words);
  if (words[0] != '\0') fprintf(p->out, "%s\n\n", words);
}

static abbe_result write_sweep(const page *p, const abbe_sweep_table *t, abbe_error *error) {
  shot *shots = calloc(SHOWN, sizeof *shots);
  size_t *order, count = order_front(t, &order);
  abbe_result result = ABBE_OK;
  if (shots == NULL || order == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the report");
  if (result == ABBE_OK) {
    fprintf(p->out, "## %s\n\n", base_of(t->fact[ABBE_SWEEP_FACT_SCENE]));
    take_shots(p, t, order, count, shots);
    write_pictures(p->out, shots);
    fprintf(p->out, "%s pixels, medians of %s frames. %s. %s. %s.\n\n",
            t->fact[ABBE_SWEEP_FACT_SIZE], t->fact[ABBE_SWEEP_FACT_FRAMES],
            t->fact[ABBE_SWEEP_FACT_MACHINE], t->fact[ABBE_SWEEP_FACT_DEVICE],
            t->fact[ABBE_SWEEP_FACT_DATE]);
    fprintf(p->out, "| of %zu settings, the front |", t->count);
    for (int k = 0; k < SHOWN_NUMBERS; k++)
      fprintf(p->out, " %s |", abbe_sweep_number_text(shown[k]));
    fprintf(p->out, "\n|---|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < count; i++) write_row(p->out, "", &t->row[order[i]]);
    for (int i = 0; i < ABBE_SWEEP_BASELINE_COUNT; i++) {
      const abbe_sweep_row *baseline = find_baseline(t, i, p->number);
      if (baseline != NULL && !baseline->front) write_row(p->out, "baseline: ", baseline);
    }
    fprintf(p->out, "\n");
    result = write_duels(p, t, error);
    write_fills(p, t);
    write_split(p, t);
  }
  free(order);
  free(shots);
  return result;
}

/* Which table of its scene's name it is. */
static int turn_of(const abbe_sweep_table *tables, size_t index) {
  const char *scene = base_of(tables[index].fact[ABBE_SWEEP_FACT_SCENE]);
  int turn = 1;
  for (size_t i = 0; i < index; i++)
    turn += strcmp(base_of(tables[i].fact[ABBE_SWEEP_FACT_SCENE]), scene) == 0;
  return turn;
}

/* No picture beside the page may be a file that is read or written for something else. */
static void claim_pictures(page *p, const abbe_sweep_table *tables, size_t count) {
  shot own;
  for (size_t i = 0; i < count; i++) {
    p->turn = turn_of(tables, i);
    for (int k = 0; k < SHOWN; k++) {
      name_shot(p, &tables[i], names[k], &own);
      abbe_arguments_add("abbe sweep", ABBE_ARGUMENT_WRITES, "the report's picture", own.file);
    }
  }
}

abbe_result abbe_sweep_report_write(const char *path, const abbe_sweep_table *tables, size_t count,
                                    abbe_sweep_number number, abbe_context_backend backend,
                                    abbe_error *error) {
  abbe_file_writer writer = {0};
  page p = {.path = path, .number = number};
  if (strlen(path) > PATH_SIZE / 2)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the path '%.80s…' is too long", path);
  claim_pictures(&p, tables, count);
  abbe_result result = abbe_context_make(backend, &p.context, error);
  if (result == ABBE_OK) result = abbe_file_writer_open(&writer, path, error);
  if (result == ABBE_OK) {
    p.out = writer.stream;
    fprintf(p.out,
            "# Time against error\n\nThe front of the frame's time and %s; in brackets what "
            "the reference's own noise makes of an error.\n\n",
            abbe_sweep_number_text(number));
  }
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    p.turn = turn_of(tables, i);
    result = write_sweep(&p, &tables[i], error);
  }
  if (result == ABBE_OK)
    result = abbe_file_writer_commit(&writer, error);
  else
    abbe_file_writer_discard(&writer);
  abbe_context_free(p.context);
  return result;
}
