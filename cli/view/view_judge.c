/* What designs return of light at the angles that their sliders have: coarsely at once, and better
 * at rest, on a thread of its own. */
#include "cli/view/view_app.h"

#include "base/maths.h"
#include "base/number.h"
#include "cli/view/view_keep.h"
#include "library/lib_gem_report.h"

#include <math.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { COARSE = ABBE_VIEW_FACE, FINE = 96, MOST_LINES = 16 };

static const char *const numbers[ABBE_VIEW_JUDGED_NUMBERS] = {"return", "gemray_iso",
                                                              "area_window"};

/* What a slider of that name is at; 0: there is none. */
static double value_of(const abbe_view_document *now, const abbe_view_object *object,
                       const char *name) {
  for (size_t i = 0; i < object->value_count; i++)
    if (strcmp(strrchr(object->value[i].key, '.') + 1, name) == 0)
      return abbe_view_outline_value(&object->value[i], now);
  return 0;
}

/* Not what was set in quotes, which is a name of no shipped material. */
static void material_of(const abbe_view_document *now, const abbe_view_object *object,
                        char out[ABBE_VIEW_NAME]) {
  char key[ABBE_VIEW_KEY + 16];
  snprintf(key, sizeof key, "%s.material", object->key);
  const char *set = abbe_view_document_value(now, key);
  snprintf(out, ABBE_VIEW_NAME, "%s",
           set != NULL && strchr("'\"", set[0]) == NULL ? set : object->material);
}

/* The request, a line each: path, material, settings. False for what is no design of a stone. */
static bool request_of(const abbe_view_session *session, const abbe_view_object *object,
                       char out[ABBE_VIEW_JUDGED_LONGEST]) {
  const abbe_view_document *now = abbe_view_history_now(&session->state.history);
  char material[ABBE_VIEW_NAME];
  if (object->design == NULL) return false;
  material_of(now, object, material);
  const double turn = ABBE_PI / 180, width = value_of(now, object, "width");
  const int n = abbe_number_format(
      out, ABBE_VIEW_JUDGED_LONGEST,
      "%s\n%s\ntable=%s\nwidth_m=%.6g\ncrown_rad=%.6g\npavilion_rad=%.6g", object->design, material,
      session->state.outline.table, width > 0 ? width : 0.0065,
      turn * value_of(now, object, "crown"), turn * value_of(now, object, "pavilion"));
  return n > 0 && n < ABBE_VIEW_JUDGED_LONGEST;
}

/* The next thing to be judged, and its place. */
static bool find_next(const abbe_view_session *session, abbe_view_judged *out, size_t *place) {
  const abbe_view_outline *o = &session->state.outline;
  *place = 0;
  for (size_t i = 0; i < o->object_count && *place < ABBE_VIEW_MOST_JUDGED; i++) {
    if (!request_of(session, &o->object[i], out->request)) continue;
    const abbe_view_judged *has = &session->judged[*place];
    const bool same = strcmp(has->request, out->request) == 0;
    out->side = same ? FINE : COARSE;
    snprintf(out->key, sizeof out->key, "%s", o->object[i].key);
    if (!same || (has->side < FINE && session->state.refine.stage >= ABBE_VIEW_BALANCED))
      return true;
    ++*place;
  }
  return false;
}

typedef struct asked {
  char text[ABBE_VIEW_JUDGED_LONGEST], *line[MOST_LINES];
  size_t count;
} asked;

static void split(const abbe_view_judged *judged, asked *out) {
  char *rest = out->text;
  out->count = 0;
  memcpy(out->text, judged->request, sizeof out->text);
  while (out->count < MOST_LINES - 6 &&
         (out->line[out->count] = strtok_r(rest, "\n", &rest)) != NULL)
    out->count++;
}

/* NULL: it cannot be judged. few: of five wavelengths. */
static abbe_lib_gem_report *report_of(const asked *a, size_t side, bool few, bool slopes) {
  static const char once[] = "tilt_rad=0", one[] = "threads=1", five[] = "wavelengths=5",
                    with[] = "slopes=1";
  const char *line[MOST_LINES];
  char size[32];
  size_t count = a->count;
  abbe_lib_gem_report *report = NULL;
  memcpy(line, a->line, count * sizeof *line);
  snprintf(size, sizeof size, "size=%zu", side);
  line[count++] = size;
  line[count++] = once;
  line[count++] = one;
  if (few) line[count++] = five;
  if (slopes) line[count++] = with;
  if (a->count < 2 || abbe_lib_gem_report_make(line[0], line[1], line + 2, count - 2, NULL, NULL,
                                               &report, NULL) != ABBE_OK)
    return NULL;
  return report;
}

/* A number of a report; NaN where it has none. */
static double number_of(const abbe_lib_gem_report *report, const char *name, double *error) {
  double value = NAN;
  for (size_t i = 0; abbe_lib_gem_report_name(report, i) != NULL; i++)
    if (strcmp(abbe_lib_gem_report_name(report, i), name) == 0)
      abbe_lib_gem_report_number(report, i, &value, error, NULL);
  return value;
}

/* Adds what returns from place to place, `by` times. */
static void add_map(const asked *a, float by, float *to) {
  abbe_lib_gem_report *report = report_of(a, COARSE, true, false);
  abbe_lib_picture *map = NULL;
  if (report != NULL && abbe_lib_gem_report_maps(report, &map, NULL) == ABBE_OK) {
    const size_t channels = abbe_lib_picture_channels(map);
    for (size_t c = 0; c < channels; c++)
      for (size_t i = 0; i < COARSE * COARSE; i++)
        if (strcmp(abbe_lib_picture_channel(map, c), "return") == 0)
          to[i] += by * abbe_lib_picture_pixels(map)[i * channels + c];
  }
  abbe_lib_picture_free(map);
  abbe_lib_gem_report_free(report);
}

/* The same design with a degree more on one side. */
static void change_side(const asked *a, int side, float *out) {
  asked more = *a;
  char line[64];
  const char *key = side == 0 ? "crown_rad=" : "pavilion_rad=", *end;
  for (size_t i = 0; i < a->count; i++) {
    double value;
    more.line[i] = more.text + (a->line[i] - a->text);
    if (strncmp(more.line[i], key, strlen(key)) != 0 ||
        !abbe_number_read(more.line[i] + strlen(key), &end, &value) || !(value > 0))
      continue;
    abbe_number_format(line, sizeof line, "%s%.9g", key, value + ABBE_DEGREE);
    more.line[i] = line;
    add_map(&more, 1, out);
    add_map(a, -1, out);
  }
}

/* A design that cannot be judged has no numbers. */
static void *judge(void *user) {
  static const char *const slopes[2][ABBE_VIEW_SLOPES] = {
      {"return_by_crown", "iso_by_crown", "fire_by_crown"},
      {"return_by_pavilion", "iso_by_pavilion", "fire_by_pavilion"}};
  abbe_view_judge *j = user;
  abbe_view_judged *out = &j->made;
  const bool fine = out->side == FINE;
  asked a;
  split(out, &a);
  abbe_lib_gem_report *report = report_of(&a, out->side, !fine, fine);
  /* A cut at whose angle facets come or go has no slopes, but numbers. */
  if (report == NULL && fine) report = report_of(&a, out->side, false, false);
  for (int i = 0; i < ABBE_VIEW_JUDGED_NUMBERS; i++)
    out->value[i] = number_of(report, numbers[i], &out->error[i]);
  memset(out->change, 0, sizeof out->change);
  for (int side = 0; side < 2; side++) {
    for (int i = 0; i < ABBE_VIEW_SLOPES; i++)
      out->slope[side][i] = number_of(report, slopes[side][i], &out->slope_error[side][i]);
    if (isfinite(out->slope[side][0])) change_side(&a, side, out->change[side]);
  }
  abbe_lib_gem_report_free(report);
  j->done = 1;
  if (j->wake != NULL) j->wake();
  return NULL;
}

void abbe_view_judge_end(abbe_view_session *session) {
  if (session->judge.begun) pthread_join(session->judge.thread, NULL);
  session->judge.begun = false;
}

void abbe_view_judge_frame(abbe_view_session *session) {
  abbe_view_judge *j = &session->judge;
  if (j->begun && j->done) {
    abbe_view_judge_end(session);
    session->judged[j->place] = j->made;
  }
  if (j->begun || !find_next(session, &j->made, &j->place)) return;
  j->done = 0;
  j->begun = pthread_create(&j->thread, NULL, judge, j) == 0;
}

bool abbe_view_judge_rests(const abbe_view_session *session) {
  abbe_view_judged next;
  size_t place;
  return !session->judge.begun && !find_next(session, &next, &place);
}

/* ---- the report ---- */

static const abbe_view_object *first_design(const abbe_view_session *session) {
  const abbe_view_outline *o = &session->state.outline;
  for (size_t i = 0; i < o->object_count; i++)
    if (o->object[i].design != NULL) return &o->object[i];
  return NULL;
}

static void write_option(FILE *out, const char *option, const char *text) {
  fprintf(out, " %s ", option);
  abbe_view_keep_quote(out, text);
}

static void write_number(FILE *out, const char *format, double value) {
  char text[64];
  abbe_number_format(text, sizeof text, format, value);
  if (value > 0) fputs(text, out);
}

/* The design as it is cut now, and its report, by the program's own commands; NULL: no memory. */
static char *report_command(const abbe_view_session *session, const char *cut, const char *pdf) {
  const abbe_view_object *object = first_design(session);
  const abbe_view_document *now = abbe_view_history_now(&session->state.history);
  const double crown = value_of(now, object, "crown"), pavilion = value_of(now, object, "pavilion");
  char png[1100], program[4096] = "abbe", material[ABBE_VIEW_NAME], *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (out == NULL) return NULL;
  const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
  if (length > 0) program[length] = '\0';
  abbe_view_keep_name(session, ".png", png, sizeof png);
  material_of(now, object, material);
  abbe_view_keep_quote(out, program);
  write_option(out, "gem retarget -q", object->design);
  write_number(out, " --crown %.9g", crown);
  write_number(out, " --pavilion %.9g", pavilion);
  write_option(out, "-o", cut);
  fputs(" >/dev/null && ", out);
  abbe_view_keep_quote(out, program);
  write_option(out, "gem report -q", cut);
  write_option(out, "--material", material);
  if (strcmp(session->state.outline.table, "default") != 0)
    write_option(out, "--table", session->state.outline.table);
  write_number(out, " --width %.9gmm", 1e3 * value_of(now, object, "width"));
  write_option(out, "--picture", png);
  write_option(out, "-o", pdf);
  fputs(" >/dev/null", out);
  fclose(out);
  return text;
}

abbe_result abbe_view_report_begin(abbe_view_session *session, abbe_error *error) {
  char pdf[1100], cut[1100];
  abbe_view_keep_name(session, "-report.pdf", pdf, sizeof pdf);
  abbe_view_keep_name(session, "-cut.asc", cut, sizeof cut);
  if (session->reports)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the report is being made; wait a moment");
  if (first_design(session) == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a report is of a stone that is cut by a design ('shape: cut')");
  ABBE_TRY(abbe_view_keep_check(session, cut, error));
  ABBE_TRY(abbe_view_keep_check(session, pdf, error));
  ABBE_TRY(abbe_view_keep(session, error)); /* the picture of its first page */
  abbe_result result = ABBE_OK;
  char *command = report_command(session, cut, pdf);
  char shell[] = "sh", option[] = "-c", *arguments[] = {shell, option, command, NULL};
  if (command == NULL ||
      posix_spawn(&session->reporter, "/bin/sh", NULL, NULL, arguments, environ) != 0)
    result = abbe_error_set(error, ABBE_IO, "no other program can be started for the report");
  free(command);
  if (result != ABBE_OK) return result;
  session->reports = true;
  snprintf(session->note, sizeof session->note, "%.900s is made, which takes a while", pdf);
  return ABBE_OK;
}

void abbe_view_report_frame(abbe_view_session *session) {
  char pdf[1100];
  int status = 0;
  if (!session->reports || waitpid(session->reporter, &status, WNOHANG) == 0) return;
  abbe_view_keep_name(session, "-report.pdf", pdf, sizeof pdf);
  session->reports = false;
  snprintf(session->note, sizeof session->note,
           status == 0 ? "kept %.900s" : "%.900s was not made; the terminal says why", pdf);
}

/* ---- what is known ---- */

bool abbe_view_judge_has_design(const abbe_view_session *session) {
  return first_design(session) != NULL;
}

const abbe_view_judged *abbe_view_judge_of(const abbe_view_session *session,
                                           const abbe_view_object *object) {
  for (size_t i = 0; i < ABBE_VIEW_MOST_JUDGED && object->design != NULL; i++)
    if (strcmp(session->judged[i].key, object->key) == 0 && session->judged[i].side > 0 &&
        isfinite(session->judged[i].value[0]))
      return &session->judged[i];
  return NULL;
}
