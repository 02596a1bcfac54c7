#include "cli/view/view_app.h"

#include "base/clock.h"
#include "base/file.h"
#include "base/number.h"
#include "cli/view/view_keep.h"
#include "colorimetry/image/png_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MOST_WORDS = 16, MOST_REMEMBERED = 32, LONGEST = 4096 };
#define PATIENCE_S 300.0 /* processor time, because the machine may be busy */
#define REST_S 1.0       /* in which nothing is left to do: files are looked at meanwhile */
#define SCRIPT_MOST_BYTES ((size_t)1 << 20)

typedef struct script {
  abbe_view_hidden hidden;
  uint64_t copied; /* the serial when a file was copied last */
  const char *path;
  size_t line;
  const char *word[MOST_WORDS];
  size_t words;
  struct {
    char name[LONGEST], value[LONGEST];
  } remembered[MOST_REMEMBERED];
  size_t remembered_count;
} script;

__attribute__((format(printf, 4, 5))) static abbe_result
fail(const script *s, abbe_result result, abbe_error *error, const char *format, ...) {
  char prefix[1024];
  va_list arguments;
  snprintf(prefix, sizeof prefix, "%.700s:%zu: %.60s: ", s->path, s->line,
           s->words > 0 ? s->word[0] : "");
  va_start(arguments, format);
  abbe_error_set_list(error, result, prefix, format, arguments);
  va_end(arguments);
  return result;
}

static void pump(script *s) {
  abbe_view_hidden_frame(&s->hidden);
}

/* The processor is others' meanwhile. */
static void sleep_a_little(void) {
  const struct timespec time = {.tv_nsec = 5000000};
  nanosleep(&time, NULL);
}

static abbe_result shoot(script *s, const char *path, abbe_error *error) {
  static const char *const names[] = {"R", "G", "B"};
  abbe_image image;
  pump(s);
  for (; !abbe_view_app_painted(&s->hidden.session); pump(s)) sleep_a_little();
  unsigned char *pixels = abbe_view_hidden_read(&s->hidden);
  abbe_result result =
      pixels != NULL ? abbe_image_make(s->hidden.width, s->hidden.height, 3, names, &image, error)
                     : abbe_error_set(error, ABBE_NO_MEMORY, "no memory");
  if (result == ABBE_OK) {
    for (size_t i = 0; i < 3 * image.width * image.height; i++)
      image.data[i] = (float)pixels[i] / 255;
    result = abbe_png_write(path, &image, 8, error);
    abbe_image_free(&image);
  }
  free(pixels);
  return result;
}

/* ---- where things are ---- */

static bool find_handle(const script *s, const char *name, double xy[2]) {
  const abbe_view_state *state = &s->hidden.session.state;
  abbe_view_handle handle;
  for (size_t i = 0; abbe_view_state_handle(state, i, &handle); i++) {
    const bool light = handle.kind == ABBE_VIEW_LIGHT_HANDLE;
    const char *own =
        light ? state->outline.light[handle.index].name : state->outline.object[handle.index].name;
    if (strcmp(own, name) != 0) continue;
    xy[0] = handle.xy[0];
    xy[1] = handle.xy[1];
    return true;
  }
  return false;
}

/* "FROM:TO", nm: where the rendered picture has most colour of a dominant wavelength in between;
 * with ":LEFT:TOP:RIGHT:BOTTOM" behind, in that part of it. */
static bool find_hue(const script *s, const char *text, double xy[2]) {
  double is[6] = {0, 0, 0, 0, INFINITY, INFINITY};
  for (int k = 0; k < 6; k++) {
    if (!abbe_number_read(text, &text, &is[k]) || (*text != ':' && *text != '\0')) return false;
    if (*text == '\0' && k == 1) break;
    if (*text == ':') text++;
  }
  return abbe_view_probe_find_hue(&s->hidden.session.pictures, is, is + 2, xy);
}

/* "X,Y", a handle, a hue or the label of a widget. */
static bool find(script *s, const char *text, double xy[2]) {
  double x, y, width, height;
  const char *end;
  if (abbe_number_read(text, &end, &xy[0]) && *end == ',' &&
      abbe_number_read(end + 1, &end, &xy[1]) && *end == '\0')
    return true;
  if (strncmp(text, "hue:", 4) == 0) return find_hue(s, text + 4, xy);
  if (strncmp(text, "handle:", 7) == 0) return find_handle(s, text + 7, xy);
  for (int i = 0; i < 4; i++) { /* it may have to scroll into view */
    if (abbe_ui_find(text, &x, &y, &width, &height) && y >= 0 &&
        y + height <= (double)s->hidden.height) {
      xy[0] = x + fmin(20, 0.5 * width);
      xy[1] = y + 0.5 * height;
      return true;
    }
    abbe_ui_seek(text);
    pump(s);
    pump(s);
  }
  return false;
}

static abbe_result aim(script *s, size_t word, double xy[2], abbe_error *error) {
  if (word >= s->words)
    return fail(s, ABBE_PARSE, error, "where? Give X,Y, a label, handle:NAME or hue:FROM:TO");
  if (!find(s, s->word[word], xy))
    return fail(s, ABBE_NOT_FOUND, error, "there is no '%.60s' in sight", s->word[word]);
  const double width = (double)s->hidden.width, height = (double)s->hidden.height;
  if (word != 1 || (xy[0] >= 0 && xy[0] < width && xy[1] >= 0 && xy[1] < height))
    return ABBE_OK; /* a drag may end outside, as a hand's does */
  return fail(s, ABBE_OUT_OF_RANGE, error, "'%.60s' lies outside of the window", s->word[word]);
}

/* ---- pointer ---- */

static void point(script *s, const double xy[2]) {
  s->hidden.input.mouse[0] = xy[0];
  s->hidden.input.mouse[1] = xy[1];
  pump(s);
}

static void set_button(script *s, int button, bool down) {
  s->hidden.input.button[button] = down;
  pump(s);
}

/* Button and keys beside it, by the words from `from` on; where seconds is not NULL also for how
 * long, at most a minute, else 0. */
static abbe_result read_held(script *s, size_t from, int *button, double *seconds,
                             abbe_error *error) {
  const char *end;
  *button = 0;
  for (size_t i = from; i < s->words; i++) {
    const char *word = s->word[i];
    const bool right = strcmp(word, "right") == 0, shift = strcmp(word, "shift") == 0;
    if (right || strcmp(word, "middle") == 0)
      *button = right ? 1 : 2;
    else if (shift || strcmp(word, "control") == 0)
      *(shift ? &s->hidden.input.shift : &s->hidden.input.control) = true;
    else if (seconds == NULL || strcmp(word, "for") != 0)
      return fail(s, ABBE_PARSE, error, "'%.60s' is none of right middle shift control%s", word,
                  seconds != NULL ? " for" : "");
    else if (++i == s->words || !abbe_number_read(s->word[i], &end, seconds) || *end != '\0' ||
             !(*seconds > 0))
      return fail(s, ABBE_PARSE, error, "for how many seconds?");
  }
  if (seconds != NULL) *seconds = fmin(*seconds, 60);
  return ABBE_OK;
}

static void press_at(script *s, const double xy[2], int button) {
  point(s, xy);
  pump(s);
  set_button(s, button, true);
  set_button(s, button, false);
}

static abbe_result do_click(script *s, abbe_error *error) {
  double xy[2];
  int button;
  abbe_result result = aim(s, 1, xy, error);
  if (result == ABBE_OK) result = read_held(s, 2, &button, NULL, error);
  if (result == ABBE_OK) press_at(s, xy, button);
  s->hidden.input.shift = s->hidden.input.control = false;
  pump(s);
  return result;
}

/* Without a pause: every frame has another place. */
static void glide(script *s, const double from[2], const double to[2], double seconds) {
  const double start = abbe_clock_seconds();
  for (double t = 0; t < 1;) {
    t = fmin(1, (abbe_clock_seconds() - start) / seconds);
    point(s, (const double[2]){from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])});
    abbe_view_hidden_sleep(&s->hidden, 0.005);
  }
}

/* As a hand does it: some places on the way, each for a moment, or evenly for so long. */
static abbe_result do_drag(script *s, abbe_error *error) {
  enum { PLACES = 12 };
  double from[2], to[2], seconds = 0;
  int button;
  ABBE_TRY(aim(s, 1, from, error));
  ABBE_TRY(aim(s, 2, to, error));
  ABBE_TRY(read_held(s, 3, &button, &seconds, error));
  point(s, from);
  pump(s);
  set_button(s, button, true);
  if (seconds > 0) glide(s, from, to, seconds);
  for (int i = 1; seconds <= 0 && i <= PLACES; i++) {
    const double t = (double)i / PLACES, until = abbe_clock_seconds() + 0.05;
    point(s, (const double[2]){from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])});
    for (pump(s); abbe_clock_seconds() < until; pump(s)) sleep_a_little();
  }
  set_button(s, button, false);
  s->hidden.input.shift = s->hidden.input.control = false;
  pump(s);
  return ABBE_OK;
}

static abbe_result do_choose(script *s, abbe_error *error) {
  double xy[2];
  ABBE_TRY(aim(s, 1, xy, error));
  press_at(s, xy, 0);
  pump(s);
  abbe_result result = aim(s, 2, xy, error);
  if (result == ABBE_OK) press_at(s, xy, 0);
  pump(s);
  return result;
}

/* To a share of the slider's way. */
static abbe_result do_slide(script *s, abbe_error *error) {
  double xy[2], x, y, width, height, share = 0;
  const char *end;
  ABBE_TRY(aim(s, 1, xy, error));
  if (s->words < 3 || !abbe_number_read(s->word[2], &end, &share) || share < 0 || share > 1)
    return fail(s, ABBE_PARSE, error, "how far? Give a share of its way, 0 to 1");
  if (!abbe_ui_find(s->word[1], &x, &y, &width, &height))
    return fail(s, ABBE_NOT_FOUND, error, "'%.60s' is out of sight", s->word[1]);
  xy[0] = x + 4 + share * (width - 8);
  press_at(s, xy, 0);
  return ABBE_OK;
}

static abbe_result do_wheel(script *s, abbe_error *error) {
  double xy[2], clicks = 0;
  const char *end;
  ABBE_TRY(aim(s, 1, xy, error));
  if (s->words < 3 || !abbe_number_read(s->word[2], &end, &clicks))
    return fail(s, ABBE_PARSE, error, "how many clicks?");
  point(s, xy);
  s->hidden.input.wheel = clicks;
  pump(s);
  return ABBE_OK;
}

static abbe_result do_key(script *s, abbe_error *error) {
  const char *name = s->words > 1 ? s->word[1] : "";
  const bool control = strncmp(name, "control+", 8) == 0;
  if (control) name += 8;
  if (strlen(name) != 1)
    return fail(s, ABBE_PARSE, error, "which? Give a letter, or control+LETTER");
  const int modifiers = control ? ABBE_VIEW_CONTROL : 0;
  abbe_view_app_key(&s->hidden.session, name[0], true, modifiers, abbe_clock_seconds());
  abbe_view_app_key(&s->hidden.session, name[0], false, modifiers, abbe_clock_seconds());
  pump(s);
  return ABBE_OK;
}

/* ---- waiting and asserting ---- */
static int stage_of(const char *name) {
  int stage = 0;
  while (stage < ABBE_VIEW_STAGE_COUNT &&
         strcmp(name, abbe_view_stage_name((abbe_view_stage)stage)) != 0)
    stage++;
  return stage;
}

static bool is_awaited(const char *what) {
  static const char *const others[] = {"rest",      "stopped", "refusal",  "changed",
                                       "turntable", "feed",    "spectrum", "sent"};
  bool is = stage_of(what) < ABBE_VIEW_STAGE_COUNT;
  for (size_t i = 0; i < sizeof others / sizeof *others; i++) is = is || !strcmp(what, others[i]);
  return is;
}

static bool has_come(script *s, const char *what) {
  const abbe_view_session *v = &s->hidden.session;
  if (!strcmp(what, "rest")) return abbe_view_app_rests(&s->hidden.session, abbe_clock_seconds());
  if (strcmp(what, "stopped") == 0) return abbe_view_app_stopped(v);
  if (strcmp(what, "refusal") == 0) return v->state.refusal[0] != '\0';
  if (strcmp(what, "changed") == 0) return v->state.refine.serial != s->copied;
  if (strcmp(what, "turntable") == 0) return v->turned && v->turn_frame == 0;
  if (strcmp(what, "sent") == 0)
    return v->inspection.received >= (s->words > 2 ? strtoul(s->word[2], NULL, 10) : 1);
  if (strcmp(what, "feed") == 0) return abbe_view_session_feed(v) != NULL;
  if (strcmp(what, "spectrum") == 0) return v->probe.bands > 0 || v->inspection.picked;
  const int stage = stage_of(what);
  return v->state.refine.stage != ABBE_VIEW_NONE && (int)v->stage >= stage &&
         (int)v->state.refine.stage >= stage && (stage != ABBE_VIEW_TRACED || v->passes > 0);
}

static abbe_result do_wait(script *s, abbe_error *error) {
  const char *what = s->words > 1 ? s->word[1] : "rest", *end;
  double seconds, start = abbe_clock_seconds();
  pump(s);
  if (abbe_number_read(what, &end, &seconds) && *end == '\0' && seconds >= 0) {
    for (double left = seconds; left > 0; left = start + seconds - abbe_clock_seconds()) {
      abbe_view_hidden_sleep(&s->hidden, left);
      pump(s);
    }
    return ABBE_OK;
  }
  if (!is_awaited(what))
    return fail(s, ABBE_PARSE, error, "'%.60s' is no stage, nor else what can come", what);
  if (stage_of(what) < ABBE_VIEW_STAGE_COUNT && s->hidden.session.state.width == 0)
    return fail(s, ABBE_OUT_OF_RANGE, error, "no room for a picture; --size makes the window wide");
  const clock_t begun = clock();
  for (double busy_s = start; !has_come(s, what); pump(s)) {
    const double now = abbe_clock_seconds();
    const bool listens = s->hidden.session.inspection.listener != NULL && now - start < PATIENCE_S;
    if (listens || !abbe_view_app_rests(&s->hidden.session, now)) busy_s = now;
    const bool late = (double)(clock() - begun) / CLOCKS_PER_SEC > PATIENCE_S;
    if (late || now - busy_s > REST_S)
      return fail(
          s, ABBE_TOLERANCE, error, "'%.60s' has not come%s; the stage is %s%s%.300s", what,
          late ? "" : ", and nothing is left to do", abbe_view_stage_name(s->hidden.session.stage),
          s->hidden.session.state.refusal[0] != '\0' ? ": " : "", s->hidden.session.state.refusal);
    abbe_view_hidden_sleep(&s->hidden, REST_S);
  }
  pump(s);
  return ABBE_OK;
}

static abbe_result value_of(script *s, const char *name, char out[LONGEST], abbe_error *error) {
  if (name[0] == '$') {
    for (size_t i = s->remembered_count; i-- > 0;)
      if (strcmp(s->remembered[i].name, name + 1) == 0) {
        memcpy(out, s->remembered[i].value, LONGEST);
        return ABBE_OK;
      }
    return fail(s, ABBE_NOT_FOUND, error, "'%.60s' was not remembered", name);
  }
  abbe_view_session *v = &s->hidden.session;
  const bool scene = v->inspection.pictures == NULL;
  if (scene ? abbe_view_session_value(v, name, out, LONGEST)
            : abbe_view_inspect_value(v, name, out, LONGEST))
    return ABBE_OK;
  char *command = scene && strcmp(name, "command") == 0 ? abbe_view_keep_command(v) : NULL;
  if (command != NULL) {
    snprintf(out, LONGEST, "%s", command);
    free(command);
    return ABBE_OK;
  }
  return fail(s, ABBE_NOT_FOUND, error, "there is no value '%.60s'", name);
}

static abbe_result do_remember(script *s, abbe_error *error) {
  char value[LONGEST];
  if (s->words < 3 || s->remembered_count == MOST_REMEMBERED)
    return fail(s, ABBE_PARSE, error, "a value, and a name for it");
  ABBE_TRY(value_of(s, s->word[1], value, error));
  memcpy(s->remembered[s->remembered_count].value, value, LONGEST);
  snprintf(s->remembered[s->remembered_count++].name, LONGEST, "%s", s->word[2]);
  return ABBE_OK;
}

static bool holds(const char *value, const char *relation, const char *other, bool *known) {
  double a = 0, b = 0;
  const char *end_a, *end_b;
  const bool numbers = abbe_number_read(value, &end_a, &a) && *end_a == '\0' &&
                       abbe_number_read(other, &end_b, &b) && *end_b == '\0';
  *known = true;
  if (strcmp(relation, "contains") == 0) return strstr(value, other) != NULL;
  if (strcmp(relation, "=") == 0) return numbers ? a == b : strcmp(value, other) == 0;
  if (strcmp(relation, "!=") == 0) return numbers ? a != b : strcmp(value, other) != 0;
  if (strcmp(relation, "<") == 0) return numbers && a < b;
  if (strcmp(relation, ">") == 0) return numbers && a > b;
  *known = false;
  return false;
}

static abbe_result do_assert(script *s, abbe_error *error) {
  char value[LONGEST], other[LONGEST];
  bool known;
  if (s->words < 4) return fail(s, ABBE_PARSE, error, "a value, one of = != < > contains, another");
  abbe_result result = value_of(s, s->word[1], value, error);
  snprintf(other, sizeof other, "%s", s->word[3]);
  if (result == ABBE_OK && s->word[3][0] == '$') result = value_of(s, s->word[3], other, error);
  if (result != ABBE_OK) return result;
  if (holds(value, s->word[2], other, &known)) return ABBE_OK;
  if (!known) return fail(s, ABBE_PARSE, error, "'%.20s' is none of = != < > contains", s->word[2]);
  return fail(s, ABBE_TOLERANCE, error, "%.60s is '%.120s', not %.20s '%.120s'", s->word[1], value,
              s->word[2], other);
}

static abbe_result do_say(script *s, abbe_error *error) {
  char value[LONGEST];
  for (size_t i = 1; i < s->words; i++) {
    ABBE_TRY(value_of(s, s->word[i], value, error));
    printf("%s %s\n", s->word[i], value);
  }
  fflush(stdout); /* somebody may wait for it */
  return ABBE_OK;
}

static abbe_result do_shot(script *s, abbe_error *error) {
  return s->words < 2 ? fail(s, ABBE_PARSE, error, "into which file?")
                      : shoot(s, s->word[1], error);
}

static abbe_result do_size(script *s, abbe_error *error) {
  unsigned width = 0, height = 0;
  if (s->words < 2 || sscanf(s->word[1], "%5ux%5u", &width, &height) != 2 || width < 1 ||
      height < 1 || width > 8192 || height > 8192)
    return fail(s, ABBE_PARSE, error, "WxH, 1 to 8192 each");
  abbe_view_hidden_resize(&s->hidden, width, height);
  pump(s);
  return ABBE_OK;
}

static abbe_result do_copy(script *s, abbe_error *error) {
  char *data = NULL;
  size_t size = 0;
  if (s->words < 3) return fail(s, ABBE_PARSE, error, "which file, and to where?");
  abbe_result result = abbe_file_read(s->word[1], SCRIPT_MOST_BYTES, &data, &size, error);
  s->copied = s->hidden.session.state.refine.serial;
  if (result == ABBE_OK) result = abbe_file_write(s->word[2], data, size, error);
  free(data);
  return result;
}

static const struct {
  const char *name;
  abbe_result (*run)(script *, abbe_error *);
} commands[] = {{"wait", do_wait},   {"click", do_click},       {"drag", do_drag},
                {"wheel", do_wheel}, {"key", do_key},           {"choose", do_choose},
                {"slide", do_slide}, {"remember", do_remember}, {"assert", do_assert},
                {"say", do_say},     {"shot", do_shot},         {"size", do_size},
                {"copy", do_copy}};

/* Words of a line, in place: by blanks, or between quotes. */
static void part(script *s, char *line) {
  s->words = 0;
  while (s->words < MOST_WORDS) {
    line += strspn(line, " \t\r");
    if (*line == '\0' || *line == '#') return;
    const bool quoted = *line == '"';
    if (quoted) line++;
    s->word[s->words++] = line;
    line += strcspn(line, quoted ? "\"" : " \t\r");
    if (*line == '\0') return;
    *line++ = '\0';
  }
}

static abbe_result run_line(script *s, char *line, abbe_error *error) {
  part(s, line);
  if (s->words == 0) return ABBE_OK;
  for (size_t i = 0; i < sizeof commands / sizeof *commands; i++)
    if (strcmp(s->word[0], commands[i].name) == 0) return commands[i].run(s, error);
  return fail(s, ABBE_PARSE, error, "is no command; docs/view.md lists them");
}

static abbe_result run_lines(script *s, char *text, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (char *line = text; line != NULL && result == ABBE_OK;) {
    char *end = strchr(line, '\n');
    if (end != NULL) *end++ = '\0';
    s->line++;
    result = run_line(s, line, error);
    line = end;
  }
  return result;
}

abbe_result abbe_view_script_run(const char *path, const abbe_view_app_desc *desc, size_t width,
                                 size_t height, abbe_error *error) {
  script *s = calloc(1, sizeof *s);
  char *text = NULL;
  size_t size = 0;
  if (s == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the viewer");
  s->path = path;
  abbe_result result = abbe_file_read_text(path, SCRIPT_MOST_BYTES, &text, &size, error);
  if (result == ABBE_OK) result = abbe_view_hidden_begin(&s->hidden, desc, width, height, error);
  if (result == ABBE_OK) {
    result = run_lines(s, text, error);
    abbe_view_hidden_end(&s->hidden);
  }
  free(text);
  free(s);
  return result;
}
