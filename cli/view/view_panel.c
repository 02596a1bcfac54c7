#include "cli/view/view_app.h"

#include "base/file.h"
#include "base/number.h"
#include "base/yaml/yaml_edit_text.h"
#include "cli/view/view_keep.h"
#include "cli/view/widgets/view_chart.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_DISPLAYS = 512 }; /* and views of theirs, that are listed */

#define DIM 0x858b95
#define BRIGHT 0xe8eaee
#define WARM 0xffb86b
#define GREEN 0x9ccf9c

void abbe_view_panel_pair(const char *name, const char *format, ...) {
  char text[160];
  va_list arguments;
  va_start(arguments, format);
  abbe_number_format_list(text, sizeof text, format, arguments);
  va_end(arguments);
  abbe_ui_pair(name, text);
}

/* A slider over a value of the scene. */
static void slide(abbe_view_session *app, const abbe_view_value *v, const char *prefix,
                  bool logarithmic, double now_s) {
  char label[2 * ABBE_VIEW_NAME], format[48], text[ABBE_NUMBER_TEXT_SIZE];
  double shown = v->scale * abbe_view_outline_value(v, abbe_view_history_now(&app->state.history));
  bool began = false;
  snprintf(label, sizeof label, "%.70s%s%.70s", prefix, prefix[0] != '\0' ? " " : "", v->label);
  snprintf(format, sizeof format, "%%.4g %s", v->unit);
  if (!abbe_ui_slider(label, &shown, v->min * v->scale, v->max * v->scale, format, logarithmic,
                      &began))
    return;
  abbe_number_format(text, sizeof text, "%.5g", shown / v->scale);
  abbe_view_state_set(&app->state, v->key, text, !began, now_s);
}

/* The stage that is made behind what is shown; NONE: none. */
static abbe_view_stage coming(const abbe_view_refine *r) {
  const abbe_view_hand *beside = &r->hand[1 - r->shows];
  return beside->busy && beside->job.stage > ABBE_VIEW_MOVING && beside->job.serial == r->serial
             ? beside->job.stage
             : ABBE_VIEW_NONE;
}

/* What the picture was made with, in the plan's words, and what of it is less while something
 * moves. */
static void draw_made(const abbe_view_session *app) {
  const bool moving = app->stage == ABBE_VIEW_MOVING;
  const abbe_render_desc *d = moving ? &app->moving : &app->last.desc;
  const size_t followed = abbe_render_desc_eye_wavelengths(d);
  abbe_view_panel_pair("stage", "%s", abbe_view_stage_name(app->stage));
  if (d->photons > 0) abbe_view_panel_pair("photons a side", "%zu", d->photons);
  if (d->wavelengths > 0) abbe_view_panel_pair("wavelengths", "%zu", followed);
  if (moving && d->upsample > 1)
    abbe_view_panel_pair("pixels together", "%zu x %zu", d->upsample, d->upsample);
  if (moving) abbe_view_panel_pair("light of", "%s", abbe_view_stage_name(app->moved.light));
}

/* Two lines, also where the second is empty, for widgets below stay where they are. */
static void draw_head(abbe_view_session *app) {
  const abbe_view_state *s = &app->state;
  const abbe_view_stage next = coming(&s->refine);
  const char *word = abbe_view_stage_word(app->stage);
  char text[160];
  if (app->stage == ABBE_VIEW_MOVING && abbe_view_session_rate(app) > 0)
    abbe_number_format(text, sizeof text, "%s, %.0f pictures a second", word,
                       abbe_view_session_rate(app));
  else if (app->passes > 0)
    snprintf(text, sizeof text, "%s, %zu of %d passes", word, app->passes, ABBE_VIEW_TRACED_PASSES);
  else
    snprintf(text, sizeof text, "%s", word);
  abbe_ui_text(app->stage >= ABBE_VIEW_ACCURATE ? GREEN : DIM, text);
  snprintf(text, sizeof text, " ");
  if (next == ABBE_VIEW_TRACED && next != app->stage)
    snprintf(text, sizeof text, "is now checked by tracing");
  else if (next != ABBE_VIEW_NONE && next != app->stage)
    abbe_number_format(text, sizeof text, "%s: %.0f %%", abbe_view_stage_word(next),
                       100 * abbe_view_worker_done(app->desk[1 - s->refine.shows].worker));
  abbe_ui_text(DIM, text);
  if (s->refusal[0] != '\0') abbe_ui_text(WARM, s->refusal);
  if (app->note[0] != '\0') abbe_ui_text(DIM, app->note);
}

/* What it is made of: the outline's names and colours, stones parted from glasses. */
static void choose_material(abbe_view_session *app, const abbe_view_object *object, double now_s) {
  const abbe_view_outline *o = &app->state.outline;
  const char *names[ABBE_VIEW_MOST_STONES + 1];
  abbe_ui_colour colours[ABBE_VIEW_MOST_STONES + 1];
  char key[ABBE_VIEW_KEY + 16], label[ABBE_VIEW_NAME + 16], *value = NULL;
  const size_t total = object->mirror ? o->metal_count : o->stone_count;
  size_t count = 0, at = SIZE_MAX;
  snprintf(key, sizeof key, "%s.%s", object->key, object->mirror ? "mirror" : "material");
  const char *set = abbe_view_document_value(abbe_view_history_now(&app->state.history), key);
  for (size_t i = 0; i < total; i++) {
    const char *name = object->mirror ? o->metal[i] : o->stone[i];
    if (!object->mirror && i == o->glasses_from && i > 0) names[count++] = NULL;
    if (strcmp(name, object->material) == 0 && at == SIZE_MAX) at = count; /* in quotes, if set */
    if (set != NULL && strcmp(name, set) == 0) at = count;
    colours[count] = object->mirror ? o->metal_colour[i] : o->stone_colour[i];
    names[count++] = name;
  }
  snprintf(label, sizeof label, "%s, of", object->name);
  if (abbe_ui_choose(label, names, colours, count, &at) &&
      abbe_yaml_quote_make(names[at], &value, NULL) == ABBE_OK)
    abbe_view_state_set(&app->state, key, value, false, now_s);
  free(value);
}

/* While the pointer is over the slider that was drawn last: what a degree more will do. */
static void hint(abbe_view_session *app, const abbe_view_judged *judged, const abbe_view_value *v) {
  static const char *const names[2] = {"crown", "pavilion"};
  for (int side = 0; side < 2 && judged != NULL; side++) {
    const double *by = judged->slope[side];
    char text[256];
    if (strcmp(strrchr(v->key, '.') + 1, names[side]) != 0) continue;
    const double *error = judged->slope_error[side];
    if (isfinite(by[0]))
      abbe_number_format(
          text, sizeof text,
          "a degree more:\nlight return %+.1f \u00b1 %.1f points\nISO %+.1f \u00b1 %.1f "
          "points\nfire %+.2f \u00b1 %.2f degrees of light",
          100 * by[0], 100 * error[0], 100 * by[1], 100 * error[1], by[2], error[2]);
    else
      snprintf(text, sizeof text, "at rest it is said here what a degree more will do");
    if (!abbe_ui_tip(text) || !isfinite(by[0])) continue;
    app->hinted = judged;
    app->hinted_side = side;
  }
}

/* What it is made of, and its proportions. */
static void draw_object(abbe_view_session *app, const abbe_view_object *object, bool one_of_many,
                        double now_s) {
  static const char *const numbers[ABBE_VIEW_JUDGED_NUMBERS] = {"light return", "ISO", "window"};
  const abbe_view_judged *judged = abbe_view_judge_of(app, object);
  abbe_ui_scope_begin(object->key);
  choose_material(app, object, now_s);
  for (size_t k = 0; k < object->value_count; k++) {
    slide(app, &object->value[k], one_of_many ? object->name : "", false, now_s);
    hint(app, judged, &object->value[k]);
  }
  for (int k = 0; judged != NULL && k < ABBE_VIEW_JUDGED_NUMBERS; k++)
    abbe_view_panel_pair(numbers[k], "%.1f %% \u00b1 %.1f", 100 * judged->value[k],
                         100 * judged->error[k]);
  abbe_ui_scope_end();
}

static void draw_scene(abbe_view_session *app, double now_s) {
  abbe_view_state *s = &app->state;
  const abbe_view_outline *o = &s->outline;
  const char *names[ABBE_VIEW_MOST_SCENES];
  const char *path = abbe_view_history_now(&s->history)->path;
  size_t at = app->scene_count;
  for (size_t i = 0; i < app->scene_count; i++) {
    names[i] = abbe_file_name(app->scene[i]);
    if (strcmp(app->scene[i], path) == 0) at = i;
  }
  if (abbe_ui_choose("scene", names, NULL, app->scene_count, &at)) {
    abbe_view_state_open(s, app->scene[at], now_s);
    app->edition++; /* whoever has read it before does so again */
    return;
  }
  size_t count = 0;
  for (size_t i = 0; i < o->object_count; i++) count += o->object[i].bends;
  for (size_t i = 0; i < o->object_count; i++)
    if (o->object[i].bends) draw_object(app, &o->object[i], count > 1, now_s);
  for (size_t i = 0; i < o->light_count; i++) {
    abbe_ui_scope_begin(o->light[i].key);
    slide(app, &o->light[i].power, o->light[i].name, true, now_s);
    abbe_ui_scope_end();
  }
  if (o->surrounded) slide(app, &o->rotate, "", false, now_s);
  slide(app, &o->ambient, "", false, now_s);
}

void abbe_view_panel_display(abbe_view_session *app) {
  const char *names[MOST_DISPLAYS];
  char *views = app->views != NULL ? strdup(app->views) : NULL;
  size_t count = 0, view = app->view;
  for (char *line = views; line != NULL && *line != '\0' && count < MOST_DISPLAYS;) {
    char *end = strchr(line, '\n');
    if (end != NULL) *end = '\0';
    names[count++] = line;
    line = end != NULL ? end + 1 : NULL;
  }
  abbe_error error = {0};
  if (abbe_ui_choose("display", names, NULL, count, &view) &&
      abbe_view_session_choose_view(app, view, &error) != ABBE_OK)
    snprintf(app->note, sizeof app->note, "%s", error.text);
  free(views);
}

static void draw_view(abbe_view_session *app) {
  static const char *const shown[] = {
#define ABBE_VIEW_NAME_OF(code, name) name,
      ABBE_VIEW_SHOWN(ABBE_VIEW_NAME_OF)
#undef ABBE_VIEW_NAME_OF
  };
  abbe_view_state *s = &app->state;
  size_t at = s->shown;
  if (abbe_ui_choose("shown", shown, NULL, ABBE_VIEW_SHOWN_COUNT, &at))
    s->shown = (abbe_view_shown)at;
  if (app->drawn == ABBE_VIEW_DIFFERENCE_PICTURE)
    abbe_ui_text(DIM, "blue: darker than traced, red: brighter; full at 25 % of the mean");
  if (app->drawn == ABBE_VIEW_ERROR_PICTURE)
    abbe_ui_text(DIM, "one standard error, black 0.1 % of the mean, white 100 %");
  if (app->drawn == ABBE_VIEW_LUMINANCE_PICTURE)
    abbe_ui_text(DIM, "three decades up to 1 W/(m\u00b2 sr) after the exposure");
  if (app->drawn == ABBE_VIEW_MAP_PICTURE)
    abbe_ui_text(DIM, "flux of the first light's texels, lit ones at a mean Y of 0.2");
  if (app->drawn == ABBE_VIEW_DISTANCE_PICTURE)
    abbe_ui_text(DIM, "from the nearest to the farthest that is seen");
  if (app->drawn != s->shown) abbe_ui_text(DIM, "not there yet: the rendered picture stands");
  abbe_view_panel_display(app);
  abbe_ui_slider("exposure", &s->exposure, -8, 8, "%+.2f stops", false, NULL);
}

/* A setting that the stage has unless it is given. */
static bool slide_setting(const char *label, size_t *given, size_t planned, double min, double max,
                          bool *began) {
  double value = (double)(*given > 0 ? *given : planned);
  if (!(value > 0)) return false; /* nothing takes it */
  if (!abbe_ui_slider(label, &value, min, max, *given > 0 ? "%.0f" : "%.0f  (as planned)", true,
                      began))
    return false;
  *given = (size_t)(value + 0.5);
  return true;
}

static void draw_settings(abbe_view_session *app, double now_s) {
  const abbe_view_document *now = abbe_view_history_now(&app->state.history);
  const abbe_render_desc *d = &app->last.desc;
  size_t wavelengths = now->wavelengths, photons = now->photons, map = now->map_size;
  bool began[3] = {false};
  const bool a = slide_setting("wavelengths", &wavelengths, d->wavelengths, 1, 61, &began[0]);
  const bool b = slide_setting("photons a side", &photons, d->photons, 16, 1024, &began[1]);
  const bool c = slide_setting("map, texels a side", &map, d->map_size, 64, 2048, &began[2]);
  if (a || b || c)
    abbe_view_state_settings(&app->state, wavelengths, photons, map,
                             !(began[0] || began[1] || began[2]), now_s);
  if (now->wavelengths + now->photons + now->map_size > 0 && abbe_ui_button("as planned"))
    abbe_view_state_settings(&app->state, 0, 0, 0, false, now_s);
}

static void draw_error(const abbe_view_session *app) {
  if (app->promised > 0) abbe_view_panel_pair("promised", "%.2f \u0394E, caustic", app->promised);
  if (app->estimated > 0)
    abbe_view_panel_pair("estimated", "%.2f \u0394E, of the mean", app->estimated);
  if (app->against > 0)
    abbe_view_panel_pair("to traced", "%.1f %% rms (noise %.1f %%)", 100 * app->against,
                         100 * app->noise);
  if (!(app->promised > 0) && !(app->estimated > 0) && !(app->against > 0))
    abbe_ui_text(DIM, "known once the picture has come to rest");
}

static void draw_passes(const abbe_view_session *app) {
  const abbe_view_result *r = &app->last;
  draw_made(app);
  if (r->counted) abbe_view_panel_pair("frame", "%.0f ms", r->statistics.frame_ms);
  for (size_t i = 0; i < r->line_count; i++) {
    const abbe_view_line *line = &r->line[i];
    if (!line->runs) continue;
    if (line->ms >= 0)
      abbe_view_panel_pair(line->name, "%.1f ms", line->ms);
    else if (line->kept)
      abbe_view_panel_pair(line->name, "kept");
    else {
      abbe_ui_text(BRIGHT, line->name);
      abbe_ui_text(DIM, line->reason);
      continue;
    }
    abbe_ui_text(DIM, line->reason);
  }
}

static void draw_ledger(const abbe_view_session *app) {
  const abbe_ledger *e = &app->last.statistics.energy;
  const double whole = e->reached > 0 ? e->reached / 100 : 1;
  if (!(e->reached > 0)) {
    abbe_ui_text(DIM, "no light has reached a refractor");
    return;
  }
  abbe_view_panel_pair("reached refractors", "%.4g W", e->reached);
  abbe_view_panel_pair("laid on receivers", "%.2f %%", e->deposited / whole);
  abbe_view_panel_pair("reflected outside", "%.2f %%", e->reflected / whole);
  abbe_view_panel_pair("absorbed", "%.2f %%", e->absorbed / whole);
  abbe_view_panel_pair("trapped", "%.2f %%", e->trapped / whole);
  abbe_view_panel_pair("missed", "%.2f %%", e->missed / whole);
  abbe_view_panel_pair("imbalance", "%.1e", abbe_ledger_imbalance(e));
}

/* Through which facets its light has come in. */
static void draw_feed(const abbe_view_session *app) {
  const abbe_view_feed *feed = abbe_view_session_feed(app);
  const abbe_view_outline *o = &app->state.outline;
  if (feed == NULL) return;
  if (feed->on_refractor && !feed->sight.lands) {
    abbe_ui_text(DIM, "what is seen here through a refractor or in a mirror is no receiver");
    return;
  }
  if (feed->on_refractor)
    abbe_view_panel_pair("seen through", "%zu faces, at %.0f nm", feed->sight.count - 1,
                         feed->sight.nm);
  if (feed->ray_count == 0) {
    abbe_ui_text(DIM,
                 "none of the photons through refractors and off mirrors is found to land here");
    return;
  }
  abbe_view_panel_pair("fed by", "%zu photons, through", feed->photons);
  for (size_t i = 0; i < feed->facet_count; i++) {
    const abbe_view_facet *f = &feed->facet[i];
    const char *name = "a facet";
    for (size_t k = 0; k < o->object_count; k++)
      if (o->object[k].scene_index == f->object) name = o->object[k].name;
    char label[ABBE_VIEW_NAME + 16];
    snprintf(label, sizeof label, "%.70s, %zu", name, i + 1);
    abbe_view_panel_pair(label, "%.0f %%, n %.2f %.2f %.2f", 100 * f->share, f->normal[0],
                         f->normal[1], f->normal[2]);
  }
}

static void draw_pixel(const abbe_view_session *app) {
  const abbe_view_state *s = &app->state;
  const abbe_view_probe *p = &app->probe;
  abbe_view_panel_pair("pixel", "%zu, %zu", s->pixel[0], s->pixel[1]);
  if (!p->coloured) {
    abbe_ui_text(DIM, "no light is seen there");
    return;
  }
  abbe_view_panel_pair("Y", "%.4g, %s", p->xyz[1], p->traced ? "traced" : "rendered");
  abbe_view_panel_pair("x, y", "%.4f, %.4f", p->xy[0], p->xy[1]);
  abbe_view_panel_pair("u', v'", "%.4f, %.4f", p->uv[0], p->uv[1]);
  if (p->dominant_nm > 0)
    abbe_view_panel_pair("dominant", "%.1f nm, purity %.0f %%", p->dominant_nm, 100 * p->purity);
  if (p->dominant_nm < 0)
    abbe_view_panel_pair("complementary", "%.1f nm, purity %.0f %%", -p->dominant_nm,
                         100 * p->purity);
  draw_feed(app);
  abbe_ui_gap();
  if (p->bands > 0)
    abbe_view_chart_spectrum(
        &(abbe_view_chart_bands){.count = p->bands,
                                 .nm = p->nm,
                                 .value = p->radiance,
                                 .error = p->stderr_of,
                                 .unit = "W/(m\u00b2 sr nm), \u00b1 1 standard error"});
  else
    abbe_ui_text(DIM, s->refine.last == ABBE_VIEW_NONE || s->refine.last == ABBE_VIEW_TRACED
                          ? "the tracer is on its way to its spectrum"
                          : "no spectrum: nothing is traced (--last)");
  abbe_view_chart_colours(&p->xy, 1, NULL, 0);
}

void abbe_view_panel_draw(abbe_view_session *app, double now_s) {
  abbe_view_state *s = &app->state;
  abbe_error error = {0};
  app->hinted = NULL;
  draw_head(app);
  abbe_ui_gap();
  if (abbe_ui_button("undo")) abbe_view_state_undo(s, now_s);
  abbe_ui_beside();
  if (abbe_ui_button("redo")) abbe_view_state_redo(s, now_s);
  abbe_ui_beside();
  if (abbe_ui_button("keys")) app->keys = !app->keys;
  if (abbe_ui_button("keep") && abbe_view_keep(app, &error) != ABBE_OK)
    snprintf(app->note, sizeof app->note, "%s", error.text);
  abbe_ui_beside();
  if (abbe_ui_button("turntable") && abbe_view_turn_begin(app, &error) != ABBE_OK)
    snprintf(app->note, sizeof app->note, "%s", error.text);
  if (abbe_view_judge_has_design(app)) abbe_ui_beside();
  if (abbe_view_judge_has_design(app) && abbe_ui_button("report") &&
      abbe_view_report_begin(app, &error) != ABBE_OK)
    snprintf(app->note, sizeof app->note, "%s", error.text);
  abbe_ui_gap();
  if (s->picked && abbe_ui_section("Pixel", true)) draw_pixel(app);
  if (abbe_ui_section("Scene", true)) draw_scene(app, now_s);
  if (abbe_ui_section("Picture", true)) draw_view(app);
  if (abbe_ui_section("Error", true)) draw_error(app);
  if (!s->picked) abbe_ui_text(DIM, "click into the picture for a pixel's spectrum");
  if (abbe_ui_section("Settings", false)) draw_settings(app, now_s);
  if (abbe_ui_section("Light", false)) draw_ledger(app);
  if (abbe_ui_section("Plan and passes", false)) draw_passes(app);
  if (abbe_ui_section("Command", false)) {
    char *command = abbe_view_keep_command(app);
    abbe_ui_text(DIM, command != NULL ? command : "there is one once the picture has come to rest");
    free(command);
  }
}
