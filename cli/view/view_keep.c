#include "cli/view/view_keep.h"

#include "base/file.h"
#include "base/number.h"
#include "cli/view/picture/view_show.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/screen/screen_png.h"
#include "scenes/import/scene_file.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Text that grows; without memory it stays NULL. */
typedef struct growing {
  char *text;
  size_t size;
  FILE *stream;
} growing;

/* As a shell reads it back. */
static void quote(FILE *out, const char *text) {
  static const char plain[] =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./=+-:";
  if (text[0] != '\0' && strspn(text, plain) == strlen(text)) {
    fputs(text, out);
    return;
  }
  fputc('\'', out);
  for (; *text != '\0'; text++)
    if (*text == '\'')
      fputs("'\\''", out);
    else
      fputc(*text, out);
  fputc('\'', out);
}

abbe_result abbe_view_keep_rests(const abbe_view_session *session, abbe_error *error) {
  const abbe_view_refine *refine = &session->state.refine;
  if (refine->refused)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "what stands is the picture before the last change, which cannot be "
                          "drawn; go back first (control z)");
  if (session->pictures.rendered.data != NULL && refine->stage >= ABBE_VIEW_BALANCED)
    return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "a picture is kept once it has come to rest; wait a moment");
}

void abbe_view_keep_name(const abbe_view_session *session, const char *ending, char *out,
                         size_t size) {
  const char *name = abbe_file_name(abbe_view_history_now(&session->state.history)->path);
  const char *dot = strrchr(name, '.');
  if (session->keep != NULL)
    snprintf(out, size, "%.*s%s", ABBE_VIEW_KEEP_LONGEST, session->keep, ending);
  else
    snprintf(out, size, "%.*s-view%s", dot != NULL ? (int)(dot - name) : (int)strlen(name), name,
             ending);
}

static bool has_exposure(const abbe_view_session *session) {
  return abbe_image_attribute_text(&session->pictures.rendered, ABBE_SCREEN_EXPOSURE) != NULL;
}

/* Beside what is kept, and shown alike. */
static void write_outputs(const abbe_view_session *session, FILE *out) {
  char name[1100], stops[ABBE_NUMBER_TEXT_SIZE + 16];
  abbe_view_names names;
  const abbe_display_desc d = abbe_view_session_display(session, session->view, &names);
  const struct {
    const char *option, *text;
  } texts[] = {{" --ocio ", d.config},
               {" --display ", session->view > 0 ? d.display : NULL},
               {" --view ", session->view > 0 ? d.view : NULL}};
  abbe_view_keep_name(session, "-again.exr", name, sizeof name);
  fputs(" -o ", out);
  quote(out, name);
  abbe_view_keep_name(session, "-again.png", name, sizeof name);
  fputs(" --png ", out);
  quote(out, name);
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    if (texts[i].text == NULL) continue;
    fputs(texts[i].option, out);
    quote(out, texts[i].text);
  }
  if (session->state.exposure == 0 && !has_exposure(session)) return;
  abbe_number_format(stops, sizeof stops, " --exposure %.9g", session->state.exposure);
  fputs(stops, out);
}

char *abbe_view_keep_command(const abbe_view_session *session) {
  const abbe_view_document *now = abbe_view_history_now(&session->state.history);
  const abbe_render_desc *d = &session->last.asked;
  const struct {
    const char *option;
    size_t value;
  } settings[] = {{"wavelengths", d->wavelengths},
                  {"photons", d->photons},
                  {"map", d->map_size},
                  {"samples", d->supersample},
                  {"upsample", d->upsample},
                  {"adaptive", d->adaptive},
                  {"exits", d->exits}};
  growing out = {0};
  if (abbe_view_keep_rests(session, NULL) != ABBE_OK || d->width == 0 ||
      (out.stream = open_memstream(&out.text, &out.size)) == NULL)
    return NULL;
  fputs("abbe render ", out.stream);
  quote(out.stream, now->path);
  if (session->materials != NULL) {
    fputs(" --materials ", out.stream);
    quote(out.stream, session->materials);
  }
  if (session->volume_path != NULL) {
    fputs(" --volume ", out.stream);
    quote(out.stream, session->volume_path);
  }
  for (size_t i = 0; i < now->set_count; i++) {
    fputs(" --set ", out.stream);
    quote(out.stream, now->set[i]);
  }
  fprintf(out.stream, " --size %zux%zu", d->width, d->height);
  for (size_t i = 0; i < sizeof settings / sizeof *settings; i++)
    if (settings[i].value > 0)
      fprintf(out.stream, " --%s %zu", settings[i].option, settings[i].value);
  if (d->energy_share > 0) {
    char share[ABBE_NUMBER_TEXT_SIZE];
    abbe_number_format(share, sizeof share, " --share %.9g", d->energy_share);
    fputs(share, out.stream);
  }
  if (d->fill != ABBE_FILL_AUTO) fprintf(out.stream, " --fill %s", abbe_fill_name(d->fill));
  if (d->model != ABBE_MODEL_AUTO) fprintf(out.stream, " --model %s", abbe_model_name(d->model));
  if (session->stage == ABBE_VIEW_MEAN || session->stage == ABBE_VIEW_TRACED)
    if (session->pictures.error.data != NULL) fputs(" --mean", out.stream);
  write_outputs(session, out.stream);
  fclose(out.stream);
  return out.text;
}

/* out: capacity PATH_MAX */
static const char *folder_of(const char *path, char *out) {
  const char *slash = strrchr(path, '/');
  if (slash == NULL) return ".";
  snprintf(out, PATH_MAX, "%.*s", (int)(slash - path + 1), path);
  return out;
}

/* Whether the scene names files that it would not find from the other's folder. */
static bool names_files(const abbe_view_session *session, const char *target) {
  const char *path = abbe_view_history_now(&session->state.history)->path;
  char here[PATH_MAX], there[PATH_MAX];
  return session->files.count > 1 &&
         !abbe_view_keep_same_file(folder_of(path, here), folder_of(target, there));
}

static abbe_result keep_scene(const abbe_view_session *session, const char *target,
                              abbe_error *error) {
  const abbe_view_document *now = abbe_view_history_now(&session->state.history);
  const bool exposed = session->state.exposure != 0 || has_exposure(session);
  const char *set[ABBE_VIEW_MOST_CHANGES + 1];
  char stops[ABBE_NUMBER_TEXT_SIZE + 20];
  memcpy(set, now->set, now->set_count * sizeof *set);
  abbe_number_format(stops, sizeof stops, "camera.exposure=%.9g", session->state.exposure);
  set[now->set_count] = stops;
  const abbe_scene_options options = {
      .set = set, .set_count = now->set_count + exposed, .studio = now->studio};
  char *text = NULL;
  size_t size = 0;
  abbe_result result = abbe_scene_text(now->path, &options, &text, &size, error);
  if (result == ABBE_OK) result = abbe_file_write(target, text, size, error);
  free(text);
  return result;
}

/* Neither a scene that a step leads to nor what this one is made of is written over. */
abbe_result abbe_view_keep_check(const abbe_view_session *session, const char *target,
                                 abbe_error *error) {
  const abbe_view_history *history = &session->state.history;
  bool is_read = false;
  for (size_t i = 0; i < history->count && !is_read; i++)
    is_read = abbe_view_keep_same_file(history->entry[i].path, target);
  for (size_t i = 0; i < session->files.count && !is_read; i++)
    is_read = abbe_view_keep_same_file(session->files.path[i], target);
  if (!is_read) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%.300s is what the scene is read from and would be lost; nothing was "
                        "kept: start with another --keep NAME",
                        target);
}

bool abbe_view_keep_same_file(const char *a, const char *b) {
  struct stat of_a, of_b;
  if (strcmp(a, b) == 0) return true;
  return stat(a, &of_a) == 0 && stat(b, &of_b) == 0 && of_a.st_dev == of_b.st_dev &&
         of_a.st_ino == of_b.st_ino;
}

abbe_result abbe_view_keep_png(const abbe_view_session *session, const abbe_image *image,
                               const char *path, abbe_error *error) {
  abbe_view_names names;
  abbe_screen_png_desc desc = {.display =
                                   abbe_view_session_display(session, session->view, &names)};
  desc.display.exposure = session->state.exposure;
  desc.stated = true;
  const abbe_result result = abbe_view_keep_check(session, path, error);
  return result == ABBE_OK ? abbe_screen_png_write(path, image, &desc, error) : result;
}

/* What is looked at instead of the rendered picture. */
static abbe_result keep_shown(const abbe_view_session *session, const char *path,
                              abbe_error *error) {
  static const char *const names[] = {"R", "G", "B"};
  const abbe_image *rendered = &session->pictures.rendered;
  abbe_image screen = {0};
  unsigned char *pixels = NULL;
  abbe_result result =
      abbe_view_show(&session->pictures, session->state.shown, session->state.exposure,
                     session->display, NULL, &pixels, error);
  if (result == ABBE_OK)
    result = abbe_image_make(rendered->width, rendered->height, 3, names, &screen, error);
  for (size_t i = 0; result == ABBE_OK && i < screen.width * screen.height; i++)
    for (size_t c = 0; c < 3; c++) screen.data[3 * i + c] = (float)pixels[4 * i + c] / 255;
  if (result == ABBE_OK) result = abbe_png_write(path, &screen, 8, error);
  abbe_image_free(&screen);
  free(pixels);
  return result;
}

/* For whoever wants to repeat it: the panel's text cannot be copied. */
static void print_command(const abbe_view_session *session) {
  char *command = abbe_view_keep_command(session);
  if (command != NULL) printf("%s\n", command);
  fflush(stdout);
  free(command);
}

abbe_result abbe_view_keep(abbe_view_session *session, abbe_error *error) {
  const abbe_image *image = &session->pictures.rendered;
  const bool rendered =
      abbe_view_shown_of(&session->pictures, session->state.shown) == ABBE_VIEW_RENDERED_PICTURE;
  char exr[1024], png[1024], yaml[1024];
  abbe_view_keep_name(session, ".exr", exr, sizeof exr);
  abbe_view_keep_name(session, ".png", png, sizeof png);
  abbe_view_keep_name(session, ".yaml", yaml, sizeof yaml);
  const bool scene = !names_files(session, yaml);
  abbe_result result = abbe_view_keep_rests(session, error);
  if (result == ABBE_OK) result = abbe_view_keep_check(session, exr, error);
  if (result == ABBE_OK) result = abbe_view_keep_check(session, png, error);
  if (result == ABBE_OK) result = abbe_view_keep_check(session, yaml, error);
  if (result == ABBE_OK) result = abbe_exr_write(exr, image, error);
  if (result == ABBE_OK)
    result =
        rendered ? abbe_view_keep_png(session, image, png, error) : keep_shown(session, png, error);
  if (result == ABBE_OK && scene) result = keep_scene(session, yaml, error);
  if (result != ABBE_OK) return result;
  print_command(session);
  if (scene)
    snprintf(session->note, sizeof session->note, "kept %.300s, %.300s, %.300s", exr, png, yaml);
  else
    snprintf(
        session->note, sizeof session->note,
        "kept %.300s and %.300s; the scene names files beside it, so it can be kept in its own "
        "folder only: start with --keep there",
        exr, png);
  return ABBE_OK;
}
