#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/options/picture_options.h"
#include "cli/options/scene_input.h"
#include "gl/plan/facts/render_desc.h"

#ifdef ABBE_HAVE_VIEW
#include "cli/view/view_app.h"
#include "cli/view/view_keep.h"
#include "colorimetry/spectral_picture/pixel_probe.h"
#include "scenes/volume/caustic_volume.h"
#endif

#include <limits.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { OPTION_LAST = 0x100, OPTION_SERVE, OPTION_LISTEN, OPTION_SET };

enum { MOST_PICTURES = 16 };

typedef struct view_options {
  abbe_spectral_options spectral;
  const char *picture[MOST_PICTURES];
  size_t pictures;
  const char *program, *scene, *script, *keep, *materials, *ocio, *volume;
  size_t width, height, wavelengths, photons, map_size;
  int last, port, listen; /* ports below 0: nothing is served, or listened to */
  abbe_scene_input_changes changes;
} view_options;

static const abbe_option options[] = {
    {"size", 0, "WxH", 0, "of the window, pixels (900x560)", 1,
     ABBE_TAKE_SIZE(view_options, width, height, 8192)},
    {"keep", 0, "NAME", 0,
     "what kept files are called: NAME.exr, NAME.png, NAME.yaml (the scene's name and -view)", 1,
     ABBE_TAKE_TEXT(view_options, keep)},
    {"last", OPTION_LAST, "STAGE", 0,
     "where refining ends: moving, balanced, accurate, mean, traced (traced)", 1, ABBE_TAKE_BY_KEY},
    {"ocio", 0, "FILE", ABBE_ARGUMENT_READS,
     "an OpenColorIO configuration ($OCIO, else Abbe's own)", 1,
     ABBE_TAKE_TEXT(view_options, ocio)},
    {"materials", 0, "TABLE", ABBE_ARGUMENT_READS,
     "a table instead of the scene's: default, thesis or a file", 1,
     ABBE_TAKE_TEXT(view_options, materials)},
    {"set", OPTION_SET, "KEY=VALUE", 0,
     "another value in the scene to begin with, such as camera.fov=30; may be repeated", 1,
     ABBE_TAKE_BY_KEY},
    ABBE_OPTIONS(view_options, &abbe_studio_options, changes, NULL, 0),
    {"material", 0, "STONE", 0, "of which a stone's file is", 1,
     ABBE_TAKE_TEXT(view_options, changes.studio.material)},
    {"volume", 0, "FILE.exr", ABBE_ARGUMENT_READS,
     "look caustics up in what abbe volume has made, wherever lights and the object are dragged", 1,
     ABBE_TAKE_TEXT(view_options, volume)},
    {"wavelengths", 0, "N", 0, "at rest, for all stages (as each stage has them)", 1,
     ABBE_TAKE_COUNT(view_options, wavelengths, 1, ABBE_RENDER_MAX_WAVELENGTHS)},
    {"photons", 0, "N", 0, "a side, so too", 1,
     ABBE_TAKE_COUNT(view_options, photons, 1, ABBE_RENDER_MAX_PHOTONS)},
    {"map", 0, "N", 0, "texels a side, so too", 1,
     ABBE_TAKE_COUNT(view_options, map_size, 1, ABBE_RENDER_MAX_MAP)},
    {"script", 0, "FILE", ABBE_ARGUMENT_READS, "lead the viewer by a script, without a display", 2,
     ABBE_TAKE_TEXT(view_options, script)},
    {"serve", OPTION_SERVE, "PORT", 0,
     "without a display: a page for a browser on this machine, its address with a token on "
     "standard output; 0: any free port",
     2, ABBE_TAKE_BY_KEY},
    {"listen", OPTION_LISTEN, "PORT", OPTION_ARG_OPTIONAL,
     "show the pictures that programs on this machine send by tev's protocol (14158); 0: any free "
     "port; it is said on standard output",
     2, ABBE_TAKE_BY_KEY},
    ABBE_OPTIONS(view_options, &abbe_spectral_options_argp, spectral, "A picture by its bands:", 3),
    {0}};

/* By its ending: a picture to look at, whether it can be read or not. */
static bool is_picture(const char *path) {
  static const char *const endings[] = {".exr",  ".hdr",  ".pic", ".png",  ".avif", ".jpg",
                                        ".jpeg", ".webp", ".tif", ".tiff", ".gif",  ".jxl"};
  const char *dot = strrchr(path, '.');
  for (size_t i = 0; dot != NULL && i < sizeof endings / sizeof *endings; i++) {
    const size_t n = strlen(endings[i]);
    if (strncasecmp(dot, endings[i], n) == 0 && (dot[n] == '\0' || dot[n] == '#')) return true;
  }
  return false;
}

static void take_file(view_options *o, const char *path, struct argp_state *state) {
  if (!is_picture(path)) {
    abbe_scene_input_take_file(&o->changes, &o->scene, path, state);
    return;
  }
  if (o->pictures == MOST_PICTURES)
    argp_error(state, "at most %d pictures are looked at at once", MOST_PICTURES);
  o->picture[o->pictures++] = path;
  abbe_arguments_add(o->program, ABBE_ARGUMENT_READS, "the picture", path);
}

static bool looks_at_pictures(const view_options *o) {
  return o->pictures > 0 || o->listen >= 0;
}

/* What is for a scene alone, or for pictures alone. */
static void check_pictures(const view_options *o, struct argp_state *state) {
  const char *scene = o->scene               ? o->scene
                      : o->keep              ? "--keep"
                      : o->last > 0          ? "--last"
                      : o->materials         ? "--materials"
                      : o->volume            ? "--volume"
                      : o->changes.set_count ? "--set"
                      : o->wavelengths > 0   ? "--wavelengths"
                      : o->photons > 0       ? "--photons"
                      : o->map_size > 0      ? "--map"
                                             : NULL;
  if (looks_at_pictures(o) && scene != NULL)
    argp_error(state, "pictures are looked at without a scene: leave out %s", scene);
  if (!looks_at_pictures(o) && o->spectral.given)
    argp_error(state, "--observer, --lit-by and --illuminant are for pictures of bands");
}

static error_t parse(int key, char *text, struct argp_state *state) {
  static const char *const stages[] = {"moving", "balanced", "accurate", "mean", "traced"};
  view_options *o = state->input;
  switch (key) {
  case OPTION_SET:
    abbe_scene_input_set(&o->changes, text, o->program);
    return 0;
  case OPTION_SERVE:
    o->port = (int)abbe_command_count(o->program, "--serve", text, 0, 65535);
    return 0;
  case OPTION_LISTEN:
    o->listen = 14158;
    if (text != NULL) o->listen = (int)abbe_command_count(o->program, "--listen", text, 0, 65535);
    return 0;
  case OPTION_LAST:
    o->last = 1 + abbe_command_choice(o->program, "--last", text, stages, 5);
    return 0;
  case ARGP_KEY_ARG:
    take_file(o, text, state);
    return 0;
  case ARGP_KEY_END:
    check_pictures(o, state);
    if (o->scene == NULL && !looks_at_pictures(o))
      argp_error(
          state,
          "which scene? Give a file such as scenes/gem.yaml, a stone's such as round.asc, or "
          "pictures such as bands.exr");
    if (!looks_at_pictures(o) && o->changes.studio.material != NULL &&
        !abbe_studio_is_stone(o->scene))
      argp_error(state, "--material is for a stone's file; of a scene's object NAME it is --set "
                        "objects.NAME.material=STONE");
    if (o->script != NULL && o->port >= 0)
      argp_error(state, "--script or --serve, not both lead one viewer");
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

#ifdef ABBE_HAVE_VIEW
/* The document to begin with; its texts are the command line's. */
static abbe_result begin(const view_options *o, const char *path, const abbe_studio *studio,
                         abbe_view_document *out, abbe_error *error) {
  char *own = strdup(path);
  *out = (abbe_view_document){.path = own,
                              .studio = studio,
                              .wavelengths = o->wavelengths,
                              .photons = o->photons,
                              .map_size = o->map_size};
  if (own == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
  for (size_t i = 0; i < o->changes.set_count; i++) {
    const char *set = o->changes.set[i], *equals = strchr(set, '=');
    char key[256];
    if (equals == NULL || equals == set || (size_t)(equals - set) >= sizeof key)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "'%.80s' sets nothing; write KEY=VALUE, such as camera.fov=30", set);
    snprintf(key, sizeof key, "%.*s", (int)(equals - set), set);
    ABBE_TRY(abbe_view_document_set(out, key, equals + 1, error));
  }
  return ABBE_OK;
}

/* A name that is none, or what is kept would be the scene or what it is made of. */
static abbe_result check_keep(const char *keep, const abbe_scene *scene, abbe_error *error) {
  static const char *const endings[] = {"exr", "png", "yaml"};
  const size_t length = strlen(keep);
  if (length == 0 || keep[length - 1] == '/' || length > ABBE_VIEW_KEEP_LONGEST)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "--keep '%.60s' names no files; give a name such as out/gem, of at most "
                          "%d bytes",
                          keep, ABBE_VIEW_KEEP_LONGEST);
  for (size_t i = 0; i < abbe_scene_file_count(scene); i++)
    for (size_t k = 0; k < 3; k++) {
      char target[PATH_MAX];
      const char *file = abbe_scene_file(scene, i);
      snprintf(target, sizeof target, "%.4000s.%s", keep, endings[k]);
      if (file != NULL && abbe_view_keep_same_file(file, target))
        return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                              "--keep %.300s would write over %.300s, which the scene is read "
                              "from; choose another name",
                              keep, file);
    }
  return ABBE_OK;
}

/* Pictures of a large window go back to the system when it is small again, and do not stay as holes
 * of the heap. */
static void return_pictures(void) {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 22);
#endif
}

static abbe_result run(const view_options *o, const abbe_view_app_desc *desc, abbe_error *error) {
  if (o->script != NULL) return abbe_view_script_run(o->script, desc, o->width, o->height, error);
  if (o->port >= 0) return abbe_view_serve_run((unsigned)o->port, desc, o->width, o->height, error);
  return abbe_view_window_run(desc, o->width, o->height, error);
}

/* The colour of the first picture's bands, with the sentences of `pixel`. */
static abbe_result choose_spectrum(abbe_inspect *pictures, const view_options *o,
                                   abbe_error *error) {
  const abbe_inspect_picture *p = &pictures->picture[0];
  const abbe_image_window all = p->image.display_window, first = {all.x0, all.y0, all.x0, all.y0};
  abbe_pixel_probe probe;
  size_t at = 0;
  pictures->look.view = o->spectral.view;
  const abbe_result result =
      abbe_pixel_probe_make(&p->image, NULL, p->path, first, &o->spectral.view, &probe, error);
  abbe_pixel_probe_free(&probe);
  while (at < p->count && p->entry[at].kind != ABBE_INSPECT_SPECTRUM) at++;
  if (at < p->count) pictures->look.entry = at;
  return result;
}

static abbe_result listen_for(const view_options *o, abbe_view_app_desc *desc, abbe_error *error) {
  unsigned port = (unsigned)o->listen;
  ABBE_TRY(abbe_inspect_await(desc->pictures, error));
  ABBE_TRY(abbe_view_listen_begin(&port, &desc->listener, error));
  printf("listens at 127.0.0.1:%u\n", port);
  fflush(stdout);
  return ABBE_OK;
}

/* What is wrong with a file is reported before there is a window. */
static abbe_result view_pictures(view_options *o, abbe_error *error) {
  abbe_inspect *pictures = calloc(1, sizeof *pictures);
  abbe_result result = pictures != NULL ? abbe_spectral_options_load(&o->spectral, error)
                                        : abbe_error_set(error, ABBE_NO_MEMORY, "no memory");
  for (size_t i = 0; i < o->pictures && result == ABBE_OK; i++) {
    abbe_inspect_picture *p = &pictures->picture[i];
    result = abbe_inspect_open(pictures, o->picture[i], error);
    if (result != ABBE_OK) break;
    abbe_command_note_part(o->picture[i], p->image.part);
    abbe_command_note_odd(o->picture[i], &p->odd, "shown as the brightest light there is");
    if (p->space.assumed) abbe_command_note_space(o->picture[i]);
    if (p->note[0] != '\0') fprintf(stderr, "note: %s\n", p->note);
  }
  abbe_view_app_desc desc = {.pictures = pictures, .ocio = o->ocio};
  if (result == ABBE_OK && o->spectral.given) result = choose_spectrum(pictures, o, error);
  if (result == ABBE_OK && o->listen >= 0) result = listen_for(o, &desc, error);
  if (result == ABBE_OK) result = run(o, &desc, error);
  abbe_view_listen_end(desc.listener);
  if (pictures != NULL) abbe_inspect_free(pictures);
  free(pictures);
  abbe_spectral_options_free(&o->spectral);
  return result;
}

static abbe_result view(view_options *o, abbe_error *error) {
  if (looks_at_pictures(o)) return view_pictures(o, error);
  char shipped[2 * PATH_MAX];
  abbe_view_document document;
  abbe_scene scene = {0};
  const char *path = abbe_shipped_find(o->scene, shipped, sizeof shipped);
  abbe_studio studio = o->changes.studio;
  studio.more = o->changes.more;
  if (o->width >= ABBE_VIEW_PANEL_WIDTH + 16) { /* stones are framed for what the panel leaves */
    studio.columns = o->width - ABBE_VIEW_PANEL_WIDTH;
    studio.rows = o->height;
  }
  abbe_caustic_volume volume = {0};
  const abbe_view_app_desc desc = {.document = &document,
                                   .volume_path = o->volume,
                                   .volume = o->volume != NULL ? &volume : NULL,
                                   .materials = o->materials,
                                   .keep = o->keep,
                                   .ocio = o->ocio,
                                   .last = (abbe_view_stage)o->last};
  return_pictures();
  abbe_result result = begin(o, path, &studio, &document, error);
  /* what is wrong with the file is reported before there is a window */
  if (result == ABBE_OK)
    result =
        abbe_scene_input_load_with(o->program, o->scene, o->materials, &o->changes, &scene, error);
  if (result == ABBE_OK && o->keep != NULL) result = check_keep(o->keep, &scene, error);
  if (result == ABBE_OK && o->volume != NULL)
    result = abbe_volume_file_read(o->volume, &volume, error);
  abbe_scene_free(&scene);
  if (result == ABBE_OK) result = run(o, &desc, error);
  abbe_view_document_free(&document);
  abbe_caustic_volume_free(&volume);
  return result;
}
#else
static abbe_result view(view_options *o, abbe_error *error) {
  (void)o;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "this build has no window; install libglfw3-dev and libimgui-dev and build "
                        "again");
}
#endif

int abbe_command_view(int argc, char **argv) {
  static const abbe_parser argp = {
      options, parse, "SCENE.yaml\nSTONE.asc...\nPICTURE.exr...",
      "Shows a scene in a window: turn it, change it, and see the light follow. Or looks at "
      "pictures: their channels, bands and spectra.\v"
      "Left drag turns, middle drag or shift moves, the wheel goes nearer, right drag\n"
      "looks about, and w a s d q e fly meanwhile. Drag a ring to move a lamp or an\n"
      "object: shift upright, control tilts, g drops. Click for a pixel's spectrum.\n"
      "b: rendered or traced, v: their difference, + -: exposure, control z and y:\n"
      "back and forth, control s: keep, t: turntable, h: these keys.\n"
      "Pictures (.exr, .hdr, .pic, .png, .avif): click for a pixel, drag for a region,\n"
      "right drag moves, the wheel zooms, b: the other picture, v: their difference,\n"
      "c: false colours, + - e: exposure, f: all of it, 1: pixel by pixel.\n\n"
      "Examples:\n"
      "  abbe view scenes/gem.yaml\n"
      "  abbe view scenes/gem.yaml --set objects.gem.material=diamond --size 1200x800\n"
      "  abbe view scenes/gem.yaml --script tour.txt\n"
      "  abbe view docs/examples/ball.yaml --volume ball-volume.exr\n"
      "  abbe view scenes/gem.yaml --serve 8080\n"
      "  abbe view bands.exr --lit-by D65 --illuminant A\n"
      "  abbe view before.exr after.exr"};
  view_options o = {.program = argv[0],
                    .spectral.program = argv[0],
                    .width = 900,
                    .height = 560,
                    .port = -1,
                    .listen = -1};
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &o);
  abbe_error error = {0};
  const abbe_result result = view(&o, &error);
  const int code = abbe_command_end(argv[0], result, &error);
  return result == ABBE_TOLERANCE                             ? ABBE_EXIT_TOLERANCE
         : result == ABBE_INVALID_ARGUMENT && o.pictures == 0 ? ABBE_EXIT_USAGE
                                                              : code;
}
