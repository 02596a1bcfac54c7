#include "cli/view/view_app.h"

#include "base/clock.h"
#include "base/file.h"
#include "base/number.h"
#include "cli/view/widgets/view_chart.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DIM 0x858b95
#define WARM 0xffb86b
#define MARK 0xffd75e
#define TILES_S 0.03 /* of each frame, for tiles that are not there yet */
#define CLICK 3.0    /* pixels that a click may move */
enum { LIGHTS = 64, MOST_PAIRS = 12 };

typedef abbe_view_inspection inspection;

static const abbe_inspect_picture *shown_of(const inspection *i) {
  return &i->pictures->picture[i->pictures->at];
}

/* ---- begin, end ---- */

abbe_result abbe_view_inspect_begin(abbe_view_session *app, abbe_error *error) {
  inspection *i = &app->inspection;
  i->stale = true;
  i->at = i->pictures->at;
  i->look = i->pictures->look;
  i->given[0] = i->look.view.from;
  i->given[1] = i->look.view.to;
  if (i->look.wavelength_nm == 0) i->look.wavelength_nm = 550;
  ABBE_TRY(abbe_display_list(app->ocio, &app->views, error));
  ABBE_TRY(abbe_view_session_begin_view(app, i->pictures->picture[i->at].encoded, error));
  ABBE_TRY(abbe_ui_make(error));
  if (i->listener != NULL) ABBE_TRY(abbe_view_listen_start(i->listener, app->judge.wake, error));
  return ABBE_OK;
}

void abbe_view_inspect_end(abbe_view_session *app) {
  inspection *i = &app->inspection;
  if (i->listener != NULL) abbe_view_listen_stop(i->listener);
  for (int k = 0; k < 2; k++) {
    abbe_inspect_probe_free(&i->probe[k]);
    abbe_illuminant_free(&i->made[k]);
  }
  free(i->pixels);
}

/* ---- state ---- */

static void probe(abbe_view_session *app) {
  inspection *i = &app->inspection;
  const abbe_inspect *s = i->pictures;
  const size_t at[2] = {s->at, s->other};
  for (int k = 0; k < 2; k++) {
    abbe_error error = {0};
    abbe_inspect_probe_free(&i->probe[k]);
    if (!i->picked || (k == 1 && (s->count < 2 || at[1] == at[0]))) continue;
    if (abbe_inspect_probe_make(s, at[k], i->window, &i->probe[k], &error) != ABBE_OK)
      snprintf(app->note, sizeof app->note, "%s", error.text);
  }
}

/* A light or a display is another at the same address: no tile is of it. */
static void forget(inspection *i) {
  for (size_t k = 0; k < i->pictures->count; k++) i->pictures->picture[k].look.display = NULL;
  i->stale = true;
}

/* Takes over what is wished; what cannot be shown is said, and what was shown stays. */
static void update(abbe_view_session *app) {
  inspection *i = &app->inspection;
  abbe_error error = {0};
  if (i->look.display != app->display) forget(i);
  if (!i->stale) return;
  i->look.display = app->display;
  app->note[0] = '\0';
  if (abbe_inspect_show(i->pictures, i->at, &i->look, &error) != ABBE_OK)
    snprintf(app->note, sizeof app->note, "%s", error.text);
  i->look = i->pictures->look;
  i->look.display = app->display;
  i->at = i->pictures->at;
  i->stale = i->whole = false;
  probe(app);
}

/* Picture `at`, beside the one that was shown. */
static void go_to(inspection *i, size_t at) {
  if (at == i->at) return;
  i->pictures->other = i->at;
  i->look.difference = false;
  const abbe_inspect_picture *from = &i->pictures->picture[i->at], *to = &i->pictures->picture[at];
  if (from->width != to->width || from->height != to->height) i->pictures->zoom = 0;
  i->at = at;
  i->stale = true;
}

/* Takes what other programs have sent, for a while. */
static void receive(abbe_view_session *app) {
  inspection *i = &app->inspection;
  abbe_inspect *s = i->pictures;
  const double until = abbe_clock_seconds() + TILES_S;
  char said[sizeof app->note] = "";
  unsigned char *bytes;
  size_t size;
  while (i->listener != NULL && abbe_clock_seconds() < until &&
         abbe_view_listen_take(i->listener, &bytes, &size)) {
    abbe_error error = {0};
    size_t focus = SIZE_MAX;
    if (i->at != s->at) update(app);
    const abbe_inspect_picture *p = shown_of(i);
    const size_t before[3] = {p->serial, p->width, p->height};
    const bool apart = s->look.difference;
    if (size == 0)
      snprintf(said, sizeof said, "%s", bytes != NULL ? (const char *)bytes : "no memory");
    else
      abbe_inspect_take_packet(s, bytes, size, &focus, &error);
    abbe_inspect_await(s, &error);
    if (error.code != ABBE_OK) snprintf(said, sizeof said, "%s", error.text);
    free(bytes);
    i->received++;
    i->stale = true;
    i->at = s->at;
    p = shown_of(i);
    if (p->serial != before[0]) i->look.entry = 0;
    if (apart && !s->look.difference) i->look.difference = false;
    if (p->width != before[1] || p->height != before[2]) {
      i->picked = false;
      s->zoom = 0;
    }
    if (focus < s->count) go_to(i, focus);
  }
  i->more = i->listener != NULL && abbe_clock_seconds() >= until;
  if (said[0] == '\0') return;
  update(app);
  snprintf(app->note, sizeof app->note, "%s", said);
}

/* What large pictures lack, for a while. */
static void read_on(abbe_view_session *app) {
  inspection *i = &app->inspection;
  abbe_error error = {0};
  bool whole;
  abbe_inspect_read_on(i->pictures, TILES_S, &whole, &error);
  i->stale = i->stale || (whole && i->reading);
  i->reading = !whole;
  update(app);
  if (error.code != ABBE_OK) snprintf(app->note, sizeof app->note, "%s", error.text);
}

void abbe_view_inspect_key(abbe_view_session *app, int key) {
  inspection *i = &app->inspection;
  abbe_inspect *s = i->pictures;
  i->stale = true;
  if (key == 'b' && s->count > 1) go_to(i, s->other);
  if (key == 'v') i->look.difference = !i->look.difference;
  if (key == '+' || key == '-') i->look.exposure += key == '+' ? 0.5 : -0.5;
  if (key == 'e') i->look.exposure = shown_of(i)->stops;
  if (key == 'c') i->look.false_colours = !i->look.false_colours;
  if (key == 'f') s->zoom = 0;
  if (key == '1') s->zoom = 1;
}

/* ---- by hand ---- */

static void mark(inspection *i, const size_t size[2], const double from[2], const double to[2]) {
  const abbe_inspect_picture *image = shown_of(i);
  const double most[2] = {(double)image->width - 1, (double)image->height - 1};
  for (int k = 0; k < 2; k++) {
    double at[2];
    for (int e = 0; e < 2; e++)
      at[e] = floor(i->pictures->centre[k] +
                    ((e == 0 ? from : to)[k] - 0.5 * (double)size[k]) / i->pictures->zoom);
    i->window[k] = (size_t)fmin(most[k], fmax(0, fmin(at[0], at[1])));
    i->window[k + 2] = (size_t)fmin(most[k], fmax(0, fmax(at[0], at[1])));
  }
  i->picked = true;
}

/* While the picture is moved: how long from one to the next. */
static void time_frame(abbe_view_session *app) {
  const double now = abbe_clock_seconds();
  if (app->inspection.held != 2) app->seen_s = -1;
  if (app->inspection.held != 2) return;
  if (app->seen_s > 0) app->frames_ms[app->frame_count++ % 32] = 1e3 * (now - app->seen_s);
  app->seen_s = now;
}

static void feed(abbe_view_session *app, const abbe_ui_input *in, const size_t size[2]) {
  inspection *i = &app->inspection;
  const abbe_ui_input *before = &app->input;
  const double *at = in->mouse;
  const bool inside = at[0] >= 0 && at[1] >= 0 && at[0] < (double)size[0] &&
                      at[1] < (double)size[1] && !abbe_ui_has_pointer();
  const bool left = in->button[0] && !before->button[0];
  const bool moves = (in->button[1] && !before->button[1]) || (in->button[2] && !before->button[2]);
  if (inside && i->held == 0 && (left || moves)) {
    size_t pixel[2];
    const bool marks = left && !in->shift;
    i->held = !marks ? 2 : abbe_inspect_pixel(i->pictures, size, at, pixel) ? 1 : 0;
    if (marks) i->picked = false;
    memcpy(i->pressed, at, sizeof i->pressed);
  }
  if (i->held == 2)
    for (int k = 0; k < 2; k++)
      i->pictures->centre[k] -= (at[k] - before->mouse[k]) / i->pictures->zoom;
  if (i->held == 1) {
    const bool far = hypot(at[0] - i->pressed[0], at[1] - i->pressed[1]) > CLICK;
    mark(i, size, i->pressed, far ? at : i->pressed);
  }
  if (i->held != 0 && !in->button[0] && !in->button[1] && !in->button[2]) {
    if (i->held == 1) probe(app);
    i->held = 0;
  }
  if (inside && in->wheel != 0) abbe_inspect_wheel(i->pictures, size, at, in->wheel);
}

/* ---- panel ---- */

static void draw_file(abbe_view_session *app) {
  inspection *i = &app->inspection;
  const abbe_inspect *s = i->pictures;
  const abbe_inspect_picture *p = shown_of(i);
  const abbe_image *image = &p->image;
  const char *names[ABBE_INSPECT_MOST_PICTURES];
  size_t at = s->at;
  for (size_t k = 0; k < s->count; k++) names[k] = abbe_file_name(s->picture[k].path);
  if (s->count == 1) abbe_ui_text(DIM, names[0]);
  if (s->count > 1 && abbe_ui_choose("picture", names, NULL, s->count, &at)) go_to(i, at);
  if (s->count > 1) abbe_view_panel_pair("beside (b, v)", "%s", names[s->other]);
  abbe_view_panel_pair("pixels", "%zu x %zu, %zu channels", p->width, p->height, image->channels);
  if (p->coarse > 0)
    abbe_view_panel_pair("in memory", "%zu x %zu; finer ones are read", image->width,
                         image->height);
  if (p->read > 0 && p->read < 1)
    abbe_view_panel_pair("read", "%.0f %% of its lines", 100 * p->read);
  if (image->part[0] != '\0') abbe_view_panel_pair("part", "%s", image->part);
  if (p->bands.count > 0)
    abbe_view_panel_pair("bands", "%zu, %.5g to %.5g nm", p->bands.count, p->bands.lambda_nm[0],
                         p->bands.lambda_nm[p->bands.count - 1]);
  const char *unit = abbe_image_attribute_text(image, "emissiveUnits");
  if (p->bands.count > 0)
    abbe_view_panel_pair("unit", "%s",
                         p->renamed                                  ? "not stated"
                         : p->bands.kind == ABBE_SPECTRAL_REFLECTIVE ? "of a perfect white"
                         : unit != NULL                              ? unit
                                                                     : "W.m^-2.sr^-1");
  if (p->space.text[0] != '\0')
    abbe_view_panel_pair("space", "%s%s", p->space.text, p->space.assumed ? ", assumed" : "");
  if (p->encoded) abbe_ui_text(DIM, "encoded for a screen; its light is shown");
  if (p->note[0] != '\0') abbe_ui_text(WARM, p->note);
  if (p->odd.infinite + p->odd.nan > 0)
    abbe_view_panel_pair("not finite", "%zu infinite, %zu NaN, from %zu, %zu", p->odd.infinite,
                         p->odd.nan, p->odd_at[0], p->odd_at[1]);
  if (app->note[0] != '\0') abbe_ui_text(WARM, app->note);
}

/* The entry of its name behind the first one; 0: there is no light. */
static size_t find_light(const char *const *names, size_t count, const abbe_illuminant *light) {
  size_t k = 1;
  while (light != NULL && k < count && strcmp(names[k], abbe_illuminant_name(light)) != 0) k++;
  return light != NULL ? k : 0;
}

/* Chooses a light by the list, where the one that was given is too; `none` stands for no choice. */
static void choose_light(abbe_view_session *app, const char *label, const char *none, int which,
                         const abbe_illuminant **light) {
  inspection *i = &app->inspection;
  const abbe_illuminant *given = i->given[which];
  const char *names[LIGHTS + 2] = {none};
  size_t count = 1;
  abbe_error error = {0};
  while (count <= LIGHTS && (names[count] = abbe_illuminant_listed(count - 1)) != NULL) count++;
  const size_t own = find_light(names, count, given);
  if (own == count) names[count++] = abbe_illuminant_name(given);
  size_t at = find_light(names, count, *light);
  if (!abbe_ui_choose(label, names, NULL, count, &at)) return;
  abbe_illuminant made = {0};
  if (at > 0 && at != own && abbe_illuminant_make(names[at], &made, &error) != ABBE_OK) {
    snprintf(app->note, sizeof app->note, "%s", error.text);
    return;
  }
  abbe_illuminant_free(&i->made[which]);
  i->made[which] = made;
  *light = at == 0 ? NULL : at == own ? given : &i->made[which];
  forget(i);
}

static void draw_spectral(abbe_view_session *app) {
  inspection *i = &app->inspection;
  const char *observers[ABBE_OBSERVER_COUNT];
  size_t observer = (size_t)i->look.view.observer;
  for (int k = 0; k < ABBE_OBSERVER_COUNT; k++) observers[k] = abbe_observer_text((abbe_observer)k);
  if (abbe_ui_choose("observer", observers, NULL, ABBE_OBSERVER_COUNT, &observer)) {
    i->look.view.observer = (abbe_observer)observer;
    i->stale = true;
  }
  const bool emissive = shown_of(i)->bands.kind == ABBE_SPECTRAL_EMISSIVE;
  if (emissive) choose_light(app, "lit by", "not known", 0, &i->look.view.from);
  if (!emissive || i->look.view.from != NULL)
    choose_light(app, "illuminant", emissive ? "the same" : "D65 (a reflectance)", 1,
                 &i->look.view.to);
}

static void draw_look(abbe_view_session *app) {
  inspection *i = &app->inspection;
  const abbe_inspect_picture *p = shown_of(i);
  const abbe_spectral_channels *b = &p->bands;
  static const char *const colours[] = {"grey", "false colours"};
  size_t entry = i->look.entry, falsely = i->look.false_colours;
  if (abbe_ui_choose("shown", p->name, NULL, p->count, &entry)) {
    i->look.entry = entry;
    i->stale = true;
  }
  const abbe_inspect_kind kind = p->entry[i->pictures->look.entry].kind;
  const bool band =
      kind == ABBE_INSPECT_BAND || kind == ABBE_INSPECT_DEGREE || kind == ABBE_INSPECT_ANGLE;
  if (band && b->count > 1 &&
      abbe_ui_slider("wavelength", &i->look.wavelength_nm, b->lambda_nm[0],
                     b->lambda_nm[b->count - 1], "%.4g nm", false, NULL))
    i->stale = true;
  if (band) abbe_view_panel_pair("the band", "%s", p->image.channel[p->mix.channel[0]]);
  if (!abbe_inspect_is_colour(kind) && abbe_ui_choose("as", colours, NULL, 2, &falsely)) {
    i->look.false_colours = falsely == 1;
    i->stale = true;
  }
  if (kind == ABBE_INSPECT_SPECTRUM) draw_spectral(app);
  if (abbe_ui_slider("exposure", &i->look.exposure, -16, 16, "%+.2f stops", false, NULL))
    i->stale = true;
  abbe_view_panel_display(app);
  if (i->pictures->count > 1) {
    if (abbe_ui_button(i->look.difference ? "no difference" : "difference"))
      abbe_view_inspect_key(app, 'v');
    abbe_ui_beside();
  }
  if (abbe_ui_button("expose")) abbe_view_inspect_key(app, 'e');
  abbe_ui_beside();
  if (abbe_ui_button("fit")) abbe_view_inspect_key(app, 'f');
}

static void draw_histogram(const abbe_inspect *s) {
  const abbe_inspect_picture *p = &s->picture[s->at];
  const bool colour = abbe_inspect_is_colour(p->mix.kind) && !s->look.difference;
  char least[64], most[64];
  abbe_number_format(least, sizeof least, colour ? "Y %.3g" : "%.3g",
                     colour ? 0.18 * exp2(-10) : p->scale.min);
  abbe_number_format(most, sizeof most, "%.3g", colour ? 0.18 * exp2(6) : p->scale.max);
  abbe_view_chart_histogram(p->bin, ABBE_INSPECT_BINS, least, most);
}

static void draw_channels(const abbe_inspect_picture *p, const abbe_inspect_probe *q) {
  size_t drawn = 0;
  double nm;
  for (size_t c = 0; c < q->channels && drawn < MOST_PAIRS; c++) {
    if (abbe_spectral_channel_parse(p->image.channel[c], &nm) != ABBE_SPECTRAL_NONE) continue;
    if (isfinite(q->error[c]))
      abbe_view_panel_pair(p->image.channel[c], "%.4g \u00b1 %.2g (%.2g)", q->mean[c], q->error[c],
                           q->deviation[c]);
    else
      abbe_view_panel_pair(p->image.channel[c], "%.4g", q->mean[c]);
    drawn++;
  }
}

static void draw_spectrum(const abbe_inspect_picture *p, const abbe_inspect_probe *q) {
  const size_t count = p->bands.count;
  double *value = calloc(3 * count + 1, sizeof *value);
  if (count == 0 || value == NULL) {
    free(value);
    return;
  }
  for (size_t k = 0; k < count; k++) {
    value[k] = q->mean[p->bands.channel[k]];
    value[count + k] = q->error[p->bands.channel[k]];
    value[2 * count + k] = q->deviation[p->bands.channel[k]];
  }
  abbe_view_chart_spectrum(&(abbe_view_chart_bands){.count = count,
                                                    .nm = p->bands.lambda_nm,
                                                    .value = value,
                                                    .error = value + count,
                                                    .deviation = value + 2 * count,
                                                    .unit = "\u00b1 1 standard error, deviation"});
  free(value);
}

/* "cd/m2" of "luminance, cd/m2". */
static const char *luminous_unit(const abbe_inspect_picture *p) {
  return strchr(abbe_spectral_quantity_text(p->bands.unit.quantity), ',') + 2;
}

static void draw_probe(const inspection *i) {
  const abbe_inspect_probe *q = &i->probe[0];
  const size_t *w = q->window;
  if (q->mean == NULL) return;
  if (q->pixels == 1)
    abbe_view_panel_pair("pixel", "%zu, %zu", w[0], w[1]);
  else
    abbe_view_panel_pair("region", "%zu, %zu to %zu, %zu: %zu pixels", w[0], w[1], w[2], w[3],
                         q->pixels);
  if (q->side > 1) abbe_view_panel_pair("of means of", "%zu x %zu pixels", q->side, q->side);
  if (q->odd > 0) abbe_view_panel_pair("left out", "%zu that are not finite", q->odd);
  if (q->coloured) {
    const char *unit = q->unit > 0 ? luminous_unit(shown_of(i)) : "";
    const double y = q->unit > 0 ? q->unit * q->xyz[1] : q->xyz[1];
    abbe_view_panel_pair("Y", "%.5g %s", y, unit);
    abbe_view_panel_pair("x, y", "%.5f, %.5f", q->xy[0], q->xy[1]);
    abbe_view_panel_pair("u', v'", "%.5f, %.5f", q->uv[0], q->uv[1]);
    if (isfinite(q->dominant_nm))
      abbe_view_panel_pair(q->dominant_nm > 0 ? "dominant" : "complementary",
                           "%.1f nm, purity %.0f %%", fabs(q->dominant_nm), 100 * q->purity);
  }
  draw_spectrum(shown_of(i), q);
  if (q->coloured) {
    const bool two = i->probe[1].coloured;
    const double xy[2][2] = {{q->xy[0], q->xy[1]}, {i->probe[1].xy[0], i->probe[1].xy[1]}};
    abbe_view_chart_colours(xy, two ? 2 : 1, q->cloud, q->cloud_count);
  }
  draw_channels(shown_of(i), q);
}

static void draw_panel(abbe_view_session *app) {
  inspection *i = &app->inspection;
  draw_file(app);
  abbe_ui_gap();
  if (abbe_ui_section("Shown", true)) draw_look(app);
  if (abbe_ui_section("Histogram", true)) draw_histogram(i->pictures);
  if (!i->picked)
    abbe_ui_text(DIM, "click: a pixel; drag: a region; right drag: moves; wheel: zooms");
  if (i->picked && abbe_ui_section(i->probe[0].pixels > 1 ? "Region" : "Pixel", true))
    draw_probe(i);
}

/* ---- frame ---- */

static void draw_mark(const inspection *i, const size_t size[2]) {
  const abbe_inspect *s = i->pictures;
  double e[4];
  if (!i->picked) return;
  for (int k = 0; k < 4; k++) {
    const double at = (double)i->window[k] + (k > 1 ? 1 : 0);
    const double least = k > 1 ? 1 : 0;
    e[k] = 0.5 * (double)size[k % 2] + (at - s->centre[k % 2]) * s->zoom + least;
  }
  abbe_ui_line(e[0], e[1], e[2], e[1], MARK, 1);
  abbe_ui_line(e[2], e[1], e[2], e[3], MARK, 1);
  abbe_ui_line(e[2], e[3], e[0], e[3], MARK, 1);
  abbe_ui_line(e[0], e[3], e[0], e[1], MARK, 1);
}

static void draw_picture(abbe_view_session *app, const size_t size[2]) {
  inspection *i = &app->inspection;
  abbe_error error = {0};
  if (i->size[0] != size[0] || i->size[1] != size[1]) {
    free(i->pixels);
    i->pixels = malloc(4 * size[0] * size[1]);
    memcpy(i->size, size, sizeof i->size);
  }
  if (i->pixels == NULL) return;
  if (!(i->pictures->zoom > 0)) abbe_inspect_fit(i->pictures, size[0], size[1]);
  if (abbe_inspect_draw(i->pictures, size[0], size[1], TILES_S, i->pixels, &i->whole, &error) !=
      ABBE_OK) {
    snprintf(app->note, sizeof app->note, "%s", error.text);
    i->whole = true;
  }
  abbe_view_screen_take(&app->screen, i->pixels, size[0], size[1], 1, size);
  abbe_view_screen_draw(&app->screen, size[0], size[1]);
  if (i->whole && app->first_s == 0) app->first_s = abbe_clock_process_seconds();
}

void abbe_view_inspect_frame(abbe_view_session *app, const abbe_ui_input *input) {
  inspection *i = &app->inspection;
  static const float background[4] = {0.086F, 0.094F, 0.11F, 1};
  const double panel = fmin(ABBE_VIEW_PANEL_WIDTH, input->width);
  const double width = floor(input->width - panel), height = floor(input->height);
  const bool room = width >= 16 && height >= 16;
  const size_t size[2] = {room ? (size_t)width : 0, room ? (size_t)height : 0};
  receive(app);
  if (room && i->pictures->zoom > 0) feed(app, input, size);
  read_on(app);
  app->input = *input;
  app->gl->ClearBufferfv(GL_COLOR, 0, background);
  if (room) draw_picture(app, size);
  i->whole = i->whole || !room;
  abbe_ui_begin(input);
  if (room) draw_mark(i, size);
  abbe_ui_panel_begin("Abbe", width, 0, panel, input->height);
  draw_panel(app);
  abbe_ui_panel_end();
  abbe_ui_end();
  time_frame(app);
}
