#include "validation/sweep/sweep_page.h"

#include "base/file.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/screen_png.h"
#include "gl/renderer.h"
#include "library/choice/sweep_setting.h"
#include "library/choice/sweep_trace.h"
#include "scenes/import/scene_file.h"
#include "validation/tradeoff/baseline_comparison.h"
#include "validation/tradeoff/error_decomposition.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PICTURES = ABBE_SWEEP_PAGE_PICTURES, PARAGRAPH = 2000 };

/* A picture of the page: a file's name, and what it shows. */
typedef struct shot {
  char file[ABBE_SWEEP_PATH], text[160];
  bool there;
} shot;

/* A best factor on the brightness, if there is one, is part of what was compared. */
static abbe_result write_png(abbe_image *image, double factor, const char *path,
                             abbe_error *error) {
  const abbe_screen_png_desc desc = {.name = path};
  for (size_t i = 0; factor != 1 && i < image->width * image->height * image->channels; i++)
    image->data[i] = (float)(factor * (double)image->data[i]);
  return abbe_screen_png_write(path, image, &desc, error);
}

static abbe_result render(abbe_context *context, const abbe_scene *scene,
                          const abbe_sweep_setting *setting, size_t width, size_t height,
                          abbe_image *out, abbe_error *error) {
  abbe_render_desc desc;
  abbe_renderer *renderer = NULL;
  abbe_result result = abbe_sweep_setting_desc(setting, &desc, error);
  desc.width = width;
  desc.height = height;
  if (result == ABBE_OK) result = abbe_renderer_make(context, scene, &desc, &renderer, error);
  if (result == ABBE_OK) result = abbe_renderer_frame(renderer, NULL, NULL, NULL, error);
  if (result == ABBE_OK) result = abbe_renderer_read(renderer, false, out, error);
  abbe_renderer_free(renderer);
  return result;
}

static abbe_result draw(abbe_context *context, const abbe_scene *scene, const abbe_sweep_table *t,
                        const abbe_sweep_row *row, const char *path, abbe_error *error) {
  abbe_image image = {0};
  abbe_sweep_row traced = {.setting = row->setting};
  abbe_sweep_trace_desc trace = {.frames = 1};
  sscanf(t->fact[ABBE_SWEEP_FACT_SIZE], "%5zux%5zu", &trace.width, &trace.height);
  const double scale = row->number[ABBE_SWEEP_SCALE];
  abbe_result result =
      abbe_sweep_setting_is_traced(&row->setting)
          ? abbe_sweep_trace_measure(scene, &trace, &traced, &image, error)
          : render(context, scene, &row->setting, trace.width, trace.height, &image, error);
  if (result == ABBE_OK) result = write_png(&image, isfinite(scale) ? scale : 1, path, error);
  abbe_image_free(&image);
  return result;
}

typedef struct page {
  const char *path; /* path of the page */
  FILE *out;
  abbe_context *context;
  abbe_sweep_number time, number;
  int turn; /* number of the table, among those of scenes of one name; from 1 */
} page;

static const char *const names[PICTURES] = {"reference", "cheapest", "middle",
                                            "accurate",  "thesis",   "thesis-cie"};

/* "PAGE-SCENE-what.png", beside the page; "PAGE-SCENE-2-what.png" for a second one of that name. */
static void name_shot(const page *p, const abbe_sweep_table *t, const char *what, shot *out) {
  const char *scene = abbe_file_name(t->fact[ABBE_SWEEP_FACT_SCENE]);
  const char *dot = strrchr(p->path, '.');
  int stem = dot != NULL && strchr(dot, '/') == NULL ? (int)(dot - p->path) : (int)strlen(p->path);
  char turn[16] = "";
  if (p->turn > 1) snprintf(turn, sizeof turn, "-%d", p->turn);
  snprintf(out->file, sizeof out->file, "%.*s-%.*s%s-%s.png", stem, p->path,
           (int)strcspn(scene, "."), scene, turn, what);
}

static void say_row(const page *p, const abbe_sweep_row *row, const char *what, shot *out) {
  char label[64], a[ABBE_SWEEP_SHORT], b[ABBE_SWEEP_SHORT];
  abbe_sweep_setting_label(&row->setting, label, sizeof label);
  snprintf(out->text, sizeof out->text, "%s: %s, %s ms, %s", what, label,
           abbe_sweep_number_short(row->number[p->time], a),
           abbe_sweep_number_short(row->number[p->number], b));
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
static const abbe_sweep_row *find_baseline(const page *p, const abbe_sweep_table *t, int which) {
  abbe_baseline_comparison c;
  if (abbe_baseline_comparison_make(t, abbe_baselines[which], p->time, p->number, &c, NULL) !=
      ABBE_OK)
    return NULL;
  return c.baseline;
}

/* The reference, three settings of the front, and the baselines that have settings of their own. */
static void take_shots(const page *p, const abbe_sweep_table *t, const size_t *order, size_t count,
                       shot *shots) {
  abbe_scene scene = {0};
  const abbe_sweep_row *rows[PICTURES] = {0};
  if (count > 0) {
    rows[1] = &t->row[order[0]];
    rows[2] = &t->row[order[count / 2]];
    rows[3] = &t->row[order[count - 1]];
  }
  for (int i = 0; 4 + i < PICTURES; i++) rows[4 + i] = find_baseline(p, t, i);
  show_reference(p, t, &shots[0]);
  bool loaded = abbe_scene_load(t->fact[ABBE_SWEEP_FACT_SCENE], NULL, &scene, NULL) == ABBE_OK;
  for (int i = 1; i < PICTURES; i++) {
    if (rows[i] == NULL || !loaded) continue;
    name_shot(p, t, names[i], &shots[i]);
    say_row(p, rows[i], names[i], &shots[i]);
    shots[i].there = draw(p->context, &scene, t, rows[i], shots[i].file, NULL) == ABBE_OK;
  }
  abbe_scene_free(&scene);
}

/* The page */

static void write_row(FILE *out, const char *first, const abbe_sweep_row *row) {
  char label[64], text[ABBE_SWEEP_SHORT], noise[ABBE_SWEEP_SHORT];
  abbe_sweep_setting_label(&row->setting, label, sizeof label);
  fprintf(out, "| %s%s |", first, label);
  for (int k = 0; k < ABBE_SWEEP_SHOWN; k++) {
    fprintf(out, " %s", abbe_sweep_number_short(row->number[abbe_sweep_shown[k]], text));
    bool noisy = abbe_sweep_shown[k] >= ABBE_SWEEP_MAP_RMSE &&
                 isfinite(row->number[abbe_sweep_shown[k] + 1]);
    if (noisy)
      fprintf(out, " (%s)", abbe_sweep_number_short(row->number[abbe_sweep_shown[k] + 1], noise));
    fprintf(out, " |");
  }
  fprintf(out, "\n");
}

static void write_pictures(FILE *out, const shot *shots) {
  for (int line = 0; line < 3; line++) {
    fprintf(out, "|");
    for (int i = 0; i < PICTURES; i++) {
      if (!shots[i].there) continue;
      if (line == 0) fprintf(out, " ![%s](%s) |", shots[i].text, abbe_file_name(shots[i].file));
      if (line == 1) fprintf(out, "---|");
      if (line == 2) fprintf(out, " %s |", shots[i].text);
    }
    fprintf(out, "\n");
  }
  fprintf(out, "\n");
  int missing = 0;
  for (int i = 0; i < PICTURES; i++) missing += !shots[i].there;
  if (missing > 0)
    fprintf(out, "%d pictures are missing: the scene, its reference or a setting is gone.\n\n",
            missing);
}

static abbe_result write_baseline(const page *p, const abbe_sweep_table *t, const char *profile,
                                  abbe_sweep_number time, abbe_error *error) {
  abbe_baseline_comparison c;
  char text[4][ABBE_SWEEP_SHORT];
  abbe_result result = abbe_baseline_comparison_make(t, profile, time, p->number, &c, error);
  if (result != ABBE_OK || c.front == 0) return result;
  fprintf(p->out, "| %s | %s | %s | %s | %s | %s | %zu of %zu |\n", abbe_baseline_text(profile),
          abbe_sweep_number_text(time), abbe_sweep_number_short(c.equal_error_speedup, text[0]),
          abbe_sweep_number_short(c.equal_time_error_ratio, text[1]),
          abbe_sweep_number_short(c.front_speedup, text[2]),
          abbe_sweep_number_short(c.front_ratio, text[3]), c.beaten, c.front);
  return ABBE_OK;
}

static abbe_result write_baselines(const page *p, const abbe_sweep_table *t, abbe_error *error) {
  abbe_result result = ABBE_OK;
  fprintf(p->out,
          "| the default profile against the | by | as fast at its error | of its error in its "
          "time | as fast, over its front | of the error, over its front | points of it "
          "beaten in both |\n|---|---|---|---|---|---|---|\n");
  for (int i = 0; i < ABBE_BASELINE_COUNT; i++)
    for (int k = 0; k < ABBE_SWEEP_TIMES && result == ABBE_OK; k++)
      result = write_baseline(p, t, abbe_baselines[i], abbe_sweep_times[k], error);
  fprintf(p->out, "\n");
  return result;
}

/* What each fill adds to the map and drops from it, and what the map then holds of what arrives. */
static void write_fills(const page *p, const abbe_sweep_table *t) {
  const abbe_sweep_row *rows[2 + 2 * ABBE_BASELINE_COUNT] = {0};
  size_t count = 0;
  for (size_t i = 0; i < t->count; i++) {
    /* Every setting that is there without its fill too, and its counterpart. */
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
    char label[64], text[ABBE_SWEEP_SHORT];
    abbe_sweep_setting_label(&rows[i]->setting, label, sizeof label);
    fprintf(p->out, "| %s%s%s |", label, i % 2 == 1 ? ", " : "",
            i % 2 == 1 ? rows[i]->setting.fill : "");
    for (size_t k = 0; k < sizeof cells / sizeof *cells; k++)
      fprintf(p->out, " %s |", abbe_sweep_number_short(rows[i]->number[cells[k]], text));
    fprintf(p->out, "\n");
  }
  fprintf(p->out, "\n");
}

static void write_decomposition(const page *p, const abbe_sweep_table *t) {
  abbe_error_decomposition d;
  char words[PARAGRAPH];
  abbe_error_decomposition_make(t, &d);
  abbe_error_decomposition_say(&d, words, sizeof words);
  if (words[0] != '\0') fprintf(p->out, "%s\n\n", words);
}

static abbe_result write_sweep(const page *p, const abbe_sweep_table *t, abbe_error *error) {
  shot *shots = calloc(PICTURES, sizeof *shots);
  size_t count, *order = abbe_sweep_table_front(t, p->time, &count);
  abbe_result result = ABBE_OK;
  if (shots == NULL || order == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the report");
  if (result == ABBE_OK) {
    fprintf(p->out, "## %s\n\n", abbe_file_name(t->fact[ABBE_SWEEP_FACT_SCENE]));
    take_shots(p, t, order, count, shots);
    write_pictures(p->out, shots);
    fprintf(p->out, "%s pixels, medians of %s frames. %s. %s. %s.\n\n",
            t->fact[ABBE_SWEEP_FACT_SIZE], t->fact[ABBE_SWEEP_FACT_FRAMES],
            t->fact[ABBE_SWEEP_FACT_MACHINE], t->fact[ABBE_SWEEP_FACT_DEVICE],
            t->fact[ABBE_SWEEP_FACT_DATE]);
    fprintf(p->out, "| of %zu settings, the Pareto front |", t->count);
    for (int k = 0; k < ABBE_SWEEP_SHOWN; k++)
      fprintf(p->out, " %s |", abbe_sweep_number_text(abbe_sweep_shown[k]));
    fprintf(p->out, "\n|---|");
    for (int k = 0; k < ABBE_SWEEP_SHOWN; k++) fprintf(p->out, "---|");
    fprintf(p->out, "\n");
    for (size_t i = 0; i < count; i++) write_row(p->out, "", &t->row[order[i]]);
    for (int i = 0; i < ABBE_BASELINE_COUNT; i++) {
      const abbe_sweep_row *baseline = find_baseline(p, t, i);
      if (baseline != NULL && !baseline->front) write_row(p->out, "baseline: ", baseline);
    }
    fprintf(p->out, "\n");
    result = write_baselines(p, t, error);
    write_fills(p, t);
    write_decomposition(p, t);
  }
  free(order);
  free(shots);
  return result;
}

/* Which table of its scene's name it is. */
static int turn_of(const abbe_sweep_table *tables, size_t index) {
  const char *scene = abbe_file_name(tables[index].fact[ABBE_SWEEP_FACT_SCENE]);
  int turn = 1;
  for (size_t i = 0; i < index; i++)
    turn += strcmp(abbe_file_name(tables[i].fact[ABBE_SWEEP_FACT_SCENE]), scene) == 0;
  return turn;
}

void abbe_sweep_page_picture(const char *path, const abbe_sweep_table *tables, size_t table,
                             size_t picture, char out[ABBE_SWEEP_PATH]) {
  shot own;
  const page p = {.path = path, .turn = turn_of(tables, table)};
  name_shot(&p, &tables[table], names[picture], &own);
  memcpy(out, own.file, ABBE_SWEEP_PATH);
}

abbe_result abbe_sweep_page_write(abbe_context *context, const char *path,
                                  const abbe_sweep_table *tables, size_t count,
                                  abbe_sweep_number time, abbe_sweep_number number,
                                  abbe_error *error) {
  abbe_file_writer writer = {0};
  page p = {.path = path, .context = context, .time = time, .number = number};
  if (strlen(path) > ABBE_SWEEP_PATH / 2)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the path '%.80s…' is too long", path);
  abbe_result result = abbe_file_writer_open(&writer, path, error);
  if (result == ABBE_OK) {
    p.out = writer.stream;
    fprintf(p.out,
            "# Time against error\n\nThe Pareto front of %s and %s; in brackets what "
            "the reference's own noise makes of an error.\n\n",
            abbe_sweep_number_text(time), abbe_sweep_number_text(number));
  }
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    p.turn = turn_of(tables, i);
    result = write_sweep(&p, &tables[i], error);
  }
  return abbe_file_writer_end(&writer, result, error);
}
