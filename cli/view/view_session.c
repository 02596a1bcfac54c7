#include "cli/view/view_session.h"

#include "base/number.h"
#include "base/yaml/yaml.h"
#include "colorimetry/rgb_space.h"
#include "scenes/import/scene_file.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int by_name(const void *a, const void *b) {
  return strcmp(*(char *const *)a, *(char *const *)b);
}

/* By its objects, which tables of materials and sweeps' grids have not. What cannot be read is
 * listed too: who chooses it gets the reason. */
static bool is_scene(const char *path) {
  const abbe_scene_options as_it_is = {0};
  char *text = NULL;
  size_t size = 0;
  abbe_yaml *yaml = NULL;
  bool is = true;
  if (abbe_scene_text(path, &as_it_is, &text, &size, NULL) == ABBE_OK &&
      abbe_yaml_parse(text, size, path, &yaml, NULL) == ABBE_OK)
    is = abbe_yaml_get(yaml, abbe_yaml_root(yaml), "objects").id != 0;
  abbe_yaml_free(yaml);
  free(text);
  return is;
}

void abbe_view_session_list_scenes(abbe_view_session *session, const char *path) {
  char folder[3072];
  const char *slash = strrchr(path, '/');
  snprintf(folder, sizeof folder, "%.*s", slash != NULL ? (int)(slash - path + 1) : 2,
           slash != NULL ? path : "./");
  DIR *dir = opendir(folder);
  for (struct dirent *entry; dir != NULL && (entry = readdir(dir)) != NULL;) {
    char name[4096];
    const size_t length = strlen(entry->d_name);
    if (length < 6 || strcmp(entry->d_name + length - 5, ".yaml") != 0) continue;
    snprintf(name, sizeof name, "%s%s", slash != NULL ? folder : "", entry->d_name);
    if (!is_scene(name)) continue;
    if (session->scene_count < ABBE_VIEW_MOST_SCENES &&
        (session->scene[session->scene_count] = strdup(name)) != NULL)
      session->scene_count++;
  }
  if (dir != NULL) closedir(dir);
  qsort(session->scene, session->scene_count, sizeof *session->scene, by_name);
}

abbe_display_desc abbe_view_session_display(const abbe_view_session *session, size_t view,
                                            abbe_view_names *names) {
  const char *line = session->views;
  for (size_t i = 0; i < view && line != NULL; i++)
    if ((line = strchr(line, '\n')) != NULL) line++;
  const char *slash = line != NULL ? strstr(line, " / ") : NULL;
  if (slash == NULL) return (abbe_display_desc){.config = session->ocio};
  snprintf(names->display, sizeof names->display, "%.*s", (int)(slash - line), line);
  snprintf(names->view, sizeof names->view, "%.*s", (int)strcspn(slash + 3, "\n"), slash + 3);
  return (abbe_display_desc){
      .config = session->ocio, .display = names->display, .view = names->view};
}

abbe_result abbe_view_session_choose_view(abbe_view_session *session, size_t view,
                                          abbe_error *error) {
  abbe_view_names names;
  abbe_display *made = NULL;
  abbe_display_desc desc = abbe_view_session_display(session, view, &names);
  desc.source_space = abbe_rgb_space_ocio_name(ABBE_RGB_SPACE_ACESCG);
  ABBE_TRY(abbe_display_make(&desc, &made, error));
  abbe_view_painter_stop(session->painter);
  abbe_view_table_free(session->table);
  abbe_display_free(session->display);
  session->table = NULL;
  session->display = made;
  session->view = view;
  session->stale = true;
  return ABBE_OK;
}

/* What is encoded already looks as it does elsewhere by the view Plain. */
static size_t first_view(const char *views, bool encoded) {
  const char *plain = encoded && views != NULL ? strstr(views, " / Plain\n") : NULL;
  size_t view = 0;
  for (const char *c = views; plain != NULL && c < plain; c++) view += *c == '\n';
  return view;
}

abbe_result abbe_view_session_begin_view(abbe_view_session *app, bool encoded, abbe_error *error) {
  return abbe_view_session_choose_view(app, first_view(app->views, encoded), error);
}

double abbe_view_session_rate(const abbe_view_session *session) {
  const size_t count = session->frame_count < 32 ? session->frame_count : 32;
  double sum = 0;
  for (size_t i = 0; i < count; i++) sum += session->frames_ms[i];
  return sum > 0 ? 1e3 * (double)count / sum : 0;
}

/* FNV-1a of the bytes of the linear picture that stands. */
static unsigned long long view_session_hash(const abbe_view_session *session) {
  const abbe_image *image = &session->pictures.rendered;
  unsigned long long hash = 14695981039346656037ULL;
  /* a rendered picture's first three channels are its colour */
  for (size_t i = 0; image->data != NULL && i < image->width * image->height; i++) {
    unsigned char bytes[3 * sizeof(float)];
    memcpy(bytes, &image->data[i * image->channels], sizeof bytes);
    for (size_t k = 0; k < sizeof bytes; k++) hash = (hash ^ bytes[k]) * 1099511628211ULL;
  }
  return hash;
}

const abbe_view_feed *abbe_view_session_feed(const abbe_view_session *session) {
  const abbe_view_state *s = &session->state;
  const bool is_of_it = s->picked && session->fed_serial == s->refine.serial &&
                        session->fed_pixel[0] == s->pixel[0] &&
                        session->fed_pixel[1] == s->pixel[1];
  return is_of_it ? session->feed : NULL;
}

void abbe_view_session_compare(abbe_view_session *session) {
  const abbe_image *a = &session->pictures.rendered, *b = &session->pictures.traced;
  double mean = 0, off = 0, noise = 0, weight[3];
  size_t of_a[3], of_b[3], of_error[3];
  session->against = session->noise = 0;
  if (a->data == NULL || b->data == NULL || a->width != b->width || a->height != b->height) return;
  if (!abbe_view_channels(a, "", of_a) || !abbe_view_channels(b, "", of_b) ||
      !abbe_view_channels(b, "stderr", of_error))
    return;
  const size_t count = a->width * a->height;
  abbe_view_luminance_weights(weight); /* once: the window waits for this */
  for (size_t i = 0; i < count; i++) {
    const double y = abbe_view_luminance(weight, b, of_b, i);
    mean += y;
    off += pow(abbe_view_luminance(weight, a, of_a, i) - y, 2);
    noise += pow(abbe_view_luminance(weight, b, of_error, i), 2);
  }
  if (!(mean > 0)) return;
  session->against = sqrt(off / (double)count) / (mean / (double)count);
  session->noise = sqrt(noise / (double)count) / (mean / (double)count);
}

/* The largest of a spectrum, in standard errors. */
static double significance(const abbe_view_probe *probe) {
  double most = 0;
  for (size_t i = 0; i < probe->bands; i++)
    if (probe->stderr_of[i] > 0) most = fmax(most, probe->radiance[i] / probe->stderr_of[i]);
  return most;
}

static const char *drawn_name(const abbe_view_session *session) {
  static const char *const names[] = {
#define ABBE_VIEW_NAME_OF(code, name) name,
      ABBE_VIEW_SHOWN(ABBE_VIEW_NAME_OF)
#undef ABBE_VIEW_NAME_OF
  };
  return names[session->drawn];
}

static const char *turning_name(const abbe_view_session *session) {
  if (session->turn_frame > 0 && session->turn_serial == session->state.refine.serial) return "yes";
  return session->turned ? "done" : "no";
}

bool abbe_view_session_value(const abbe_view_session *session, const char *name, char *out,
                             size_t size) {
  const abbe_view_state *s = &session->state;
  const abbe_view_document *now = abbe_view_history_now(&s->history);
  const abbe_view_probe *probe = &session->probe;
  const abbe_view_feed *feed = abbe_view_session_feed(session);
  const struct {
    const char *name;
    double value;
  } numbers[] = {{"photons", (double)session->last.desc.photons},
                 {"wavelengths", (double)session->last.desc.wavelengths},
                 {"map", (double)session->last.desc.map_size},
                 {"passes", (double)session->passes},
                 {"promised", session->promised},
                 {"estimated", session->estimated},
                 {"against", session->against},
                 {"undo", (double)s->history.at},
                 {"first", session->first_s},
                 {"rate", abbe_view_session_rate(session)},
                 {"latency", session->latency_ms},
                 {"cancel", session->cancel_ms},
                 {"stop", session->stop_ms},
                 {"own", session->own_ms},
                 {"bands", (double)probe->bands},
                 {"dominant", probe->dominant_nm},
                 {"purity", probe->purity},
                 {"x", probe->xy[0]},
                 {"y", probe->xy[1]},
                 {"Y", probe->xyz[1]},
                 {"significance", significance(probe)},
                 {"photons_here", feed != NULL ? (double)feed->photons : 0},
                 {"through", feed != NULL && feed->sight.lands ? (double)feed->sight.count - 1 : 0},
                 {"facets", feed != NULL ? (double)feed->facet_count : 0},
                 {"light_return", session->judged[0].value[ABBE_VIEW_RETURN]},
                 {"iso", session->judged[0].value[ABBE_VIEW_ISO]},
                 {"window", session->judged[0].value[ABBE_VIEW_WINDOW]},
                 {"return_by_crown", session->judged[0].slope[0][0]},
                 {"return_by_pavilion", session->judged[0].slope[1][0]},
                 {"hinted", session->hinted != NULL ? 1 + session->hinted_side : 0},
                 {"exposure", s->exposure},
                 {"width", (double)s->width},
                 {"height", (double)s->height}};
  const struct {
    const char *name, *text;
  } texts[] = {{"scene", now->path},           {"stage", abbe_view_stage_name(session->stage)},
               {"refusal", s->refusal},        {"turning", turning_name(session)},
               {"drawn", drawn_name(session)}, {"note", session->note}};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
    if (strcmp(name, numbers[i].name) == 0)
      return abbe_number_format(out, size, "%.10g", numbers[i].value) > 0;
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
    if (strcmp(name, texts[i].name) == 0) return snprintf(out, size, "%s", texts[i].text) >= 0;
  if (strcmp(name, "hash") == 0)
    return snprintf(out, size, "%016llx", view_session_hash(session)) > 0;
  const char *set = abbe_view_document_value(now, name);
  return set != NULL && snprintf(out, size, "%s", set) >= 0;
}

bool abbe_view_inspect_value(const abbe_view_session *app, const char *name, char *out,
                             size_t size) {
  const abbe_view_inspection *i = &app->inspection;
  const abbe_inspect *s = i->pictures;
  const abbe_inspect_picture *p = &s->picture[s->at];
  const abbe_inspect_probe *q = &i->probe[0];
  const struct {
    const char *name;
    double value;
  } numbers[] = {{"first", app->first_s},
                 {"rate", abbe_view_session_rate(app)},
                 {"width", (double)p->width},
                 {"height", (double)p->height},
                 {"bands", (double)p->bands.count},
                 {"pictures", (double)s->count},
                 {"received", (double)i->received},
                 {"pixels", (double)q->pixels},
                 {"infinite", (double)p->odd.infinite},
                 {"nan", (double)p->odd.nan},
                 {"zoom", s->zoom},
                 {"exposure", s->look.exposure},
                 {"wavelength", s->look.wavelength_nm},
                 {"least", p->least_shown},
                 {"most", p->most_shown},
                 {"dominant", q->dominant_nm},
                 {"purity", q->purity},
                 {"x", q->xy[0]},
                 {"y", q->xy[1]},
                 {"Y", q->unit > 0 ? q->unit * q->xyz[1] : q->xyz[1]}};
  const struct {
    const char *name, *text;
  } texts[] = {{"picture", p->path}, {"shown", p->name[s->look.entry]}, {"note", app->note}};
  for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
    if (strcmp(name, numbers[k].name) == 0)
      return abbe_number_format(out, size, "%.10g", numbers[k].value) > 0;
  for (size_t k = 0; k < sizeof texts / sizeof *texts; k++)
    if (strcmp(name, texts[k].name) == 0) return snprintf(out, size, "%s", texts[k].text) >= 0;
  /* mean:CHANNEL, error:CHANNEL, deviation:CHANNEL of the pixel or region */
  const char *colon = strchr(name, ':');
  const size_t c = colon != NULL ? abbe_image_find_channel(&p->image, colon + 1) : (size_t)-1;
  if (c == (size_t)-1 || q->mean == NULL) return false;
  const double v = name[0] == 'm' ? q->mean[c] : name[0] == 'e' ? q->error[c] : q->deviation[c];
  return abbe_number_format(out, size, "%.10g", v) > 0;
}
