#define _XOPEN_SOURCE 700 /* realpath */
#include "cli/view/view_keep.h"

#include "base/file.h"
#include "base/number.h"
#include "base/yaml/yaml_edit.h"
#include "base/yaml/yaml_edit_text.h"
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
#include <unistd.h>

/* Text that grows; without memory it stays NULL. */
typedef struct growing {
  char *text;
  size_t size;
  FILE *stream;
} growing;

void abbe_view_keep_quote(FILE *out, const char *text) {
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
    snprintf(out, size, "%s%.*s-view%s", session->elsewhere,
             dot != NULL ? (int)(dot - name) : (int)strlen(name), name, ending);
}

void abbe_view_keep_find_place(abbe_view_session *session) {
  const char *places[] = {getenv("HOME"), getenv("TMPDIR"), "/tmp"};
  char here[PATH_MAX];
  if (session->keep != NULL || (getcwd(here, sizeof here) != NULL && access(".", W_OK) == 0))
    return;
  for (size_t i = 0; i < sizeof places / sizeof *places && session->elsewhere[0] == '\0'; i++)
    if (places[i] != NULL && places[i][0] == '/' && access(places[i], W_OK) == 0 &&
        strlen(places[i]) + 2 < sizeof session->elsewhere)
      snprintf(session->elsewhere, sizeof session->elsewhere, "%s/", places[i]);
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
  abbe_view_keep_quote(out, name);
  abbe_view_keep_name(session, "-again.png", name, sizeof name);
  fputs(" --png ", out);
  abbe_view_keep_quote(out, name);
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    if (texts[i].text == NULL) continue;
    fputs(texts[i].option, out);
    abbe_view_keep_quote(out, texts[i].text);
  }
  if (session->state.exposure == 0 && !has_exposure(session)) return;
  abbe_number_format(stops, sizeof stops, " --exposure %.9g", session->state.exposure);
  fputs(stops, out);
}

/* How a stone's file is shown. */
static void write_studio(const abbe_studio *studio, FILE *out) {
#define LOOK_NAME(name) #name,
#define NAME(code, name) #name,
  static const char *const looks[] = {ABBE_STUDIO_LOOKS(LOOK_NAME)};
  static const char *const withs[] = {ABBE_STUDIO_WITHS(NAME)};
#undef LOOK_NAME
#undef NAME
  const struct {
    const char *option, *text;
  } texts[] = {
      {" --material ", studio->material},
      {" --look ", studio->look > 0 ? looks[studio->look] : NULL},
      {" --with ", studio->with > 0 ? withs[studio->with] : NULL},
      {" --setting ", studio->setting > 0 ? abbe_studio_setting_name(studio->setting) : NULL},
      {" --metal ", studio->metal}};
  char width[ABBE_NUMBER_TEXT_SIZE + 16];
  for (size_t i = 0; i < studio->more_count; i++) {
    fputc(' ', out);
    abbe_view_keep_quote(out, studio->more[i]);
  }
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    if (texts[i].text == NULL) continue;
    fputs(texts[i].option, out);
    abbe_view_keep_quote(out, texts[i].text);
  }
  if (!(studio->width_m > 0)) return;
  abbe_number_format(width, sizeof width, " --width %.9gmm", 1e3 * studio->width_m);
  fputs(width, out);
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
  abbe_view_keep_quote(out.stream, now->path);
  if (abbe_studio_is_stone(now->path) && now->studio != NULL) write_studio(now->studio, out.stream);
  if (session->materials != NULL) {
    fputs(" --materials ", out.stream);
    abbe_view_keep_quote(out.stream, session->materials);
  }
  if (session->volume_path != NULL) {
    fputs(" --volume ", out.stream);
    abbe_view_keep_quote(out.stream, session->volume_path);
  }
  for (size_t i = 0; i < now->set_count; i++) {
    fputs(" --set ", out.stream);
    abbe_view_keep_quote(out.stream, now->set[i]);
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

/* The file of the scene that a text names from its folder, or NULL. */
static const char *file_named(const abbe_view_session *session, const char *folder,
                              const char *text) {
  char path[PATH_MAX];
  if (text == NULL || text[0] == '/') return NULL;
  snprintf(path, sizeof path, "%s%s", strcmp(folder, ".") == 0 ? "" : folder, text);
  for (size_t i = 1; i < session->files.count; i++)
    if (strcmp(session->files.path[i], path) == 0) return session->files.path[i];
  return NULL;
}

/* The first value below a node that names a file from the folder. */
static const char *find_named(const abbe_view_session *session, const abbe_yaml_edit *edit,
                              const char *folder, abbe_yaml_node node, abbe_yaml_node *parent,
                              size_t *index) {
  const bool mapping = abbe_yaml_is_mapping(edit->yaml, node);
  const char *found = NULL;
  for (size_t i = 0; found == NULL && i < abbe_yaml_count(edit->yaml, node); i++) {
    const abbe_yaml_node value =
        mapping ? abbe_yaml_value(edit->yaml, node, i) : abbe_yaml_item(edit->yaml, node, i);
    if (mapping &&
        strcmp(abbe_yaml_text(edit->yaml, abbe_yaml_key(edit->yaml, node, i)), "name") == 0)
      continue;
    *parent = node;
    *index = i;
    found = abbe_yaml_is_scalar(edit->yaml, value)
                ? file_named(session, folder, abbe_yaml_text(edit->yaml, value))
                : find_named(session, edit, folder, value, parent, index);
  }
  return found;
}

/* In another folder than its own a scene names its files by their whole paths. */
static abbe_result name_files(const abbe_view_session *session, char **text, size_t *size,
                              abbe_error *error) {
  const char *path = abbe_view_history_now(&session->state.history)->path, *file;
  char here[PATH_MAX], whole[PATH_MAX];
  const char *folder = folder_of(path, here);
  abbe_yaml_edit edit;
  abbe_yaml_node parent;
  size_t index;
  abbe_result result = abbe_yaml_edit_make(*text, *size, path, &edit, error);
  while (result == ABBE_OK &&
         (file = find_named(session, &edit, folder, abbe_yaml_root(edit.yaml), &parent, &index))) {
    char *quoted = NULL;
    if (realpath(file, whole) == NULL)
      result = abbe_error_set(error, ABBE_IO, "%.300s is not there any more", file);
    if (result == ABBE_OK) result = abbe_yaml_quote_make(whole, &quoted, error);
    if (result == ABBE_OK) result = abbe_yaml_edit_replace(&edit, parent, index, quoted, error);
    free(quoted);
  }
  if (result == ABBE_OK) {
    free(*text);
    *text = edit.text;
    *size = edit.size;
    edit.text = NULL;
  }
  abbe_yaml_edit_free(&edit);
  return result;
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
  char here[PATH_MAX], there[PATH_MAX];
  const char *folder = folder_of(target, there);
  abbe_studio studio = now->studio != NULL ? *now->studio : (abbe_studio){0};
  studio.folder = strcmp(folder, ".") == 0 ? "" : folder;
  const abbe_scene_options options = {
      .set = set, .set_count = now->set_count + exposed, .studio = &studio};
  ABBE_FREED char *text = NULL;
  size_t size = 0;
  ABBE_TRY(abbe_scene_text(now->path, &options, &text, &size, error));
  if (!abbe_studio_is_stone(now->path) &&
      !abbe_view_keep_same_file(folder_of(now->path, here), folder))
    ABBE_TRY(name_files(session, &text, &size, error));
  return abbe_file_write(target, text, size, error);
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
  ABBE_TRY(abbe_view_keep_check(session, path, error));
  return abbe_screen_png_write(path, image, &desc, error);
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
  ABBE_TRY(abbe_view_keep_rests(session, error));
  ABBE_TRY(abbe_view_keep_check(session, exr, error));
  ABBE_TRY(abbe_view_keep_check(session, png, error));
  ABBE_TRY(abbe_view_keep_check(session, yaml, error));
  ABBE_TRY(abbe_exr_write(exr, image, error));
  ABBE_TRY(rendered ? abbe_view_keep_png(session, image, png, error)
                    : keep_shown(session, png, error));
  ABBE_TRY(keep_scene(session, yaml, error));
  print_command(session);
  snprintf(session->note, sizeof session->note, "kept %.300s, %.300s, %.300s%s", exr, png, yaml,
           session->elsewhere[0] != '\0'
               ? "; nothing can be written in the folder that abbe was started in"
               : "");
  return ABBE_OK;
}
