#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/map_options.h"
#include "cli/base/progress.h"
#include "cli/base/scene_input.h"
#include "cli/render/error_options.h"
#include "cli/render/preset_options.h"
#include "cli/render/render_options.h"

#include "base/file.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/screen_png.h"
#include "gl/accuracy/frame_times.h"
#include "scenes/import/scene_file.h"

#include <argp.h>
#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

enum {
  OPTION_PNG = 0x200,
  OPTION_BITS,
  OPTION_AOVS,
  OPTION_UNFILLED,
  OPTION_BANDS,
  OPTION_STATS,
  OPTION_GL,
  OPTION_FRAMES,
  OPTION_OCIO,
  OPTION_DISPLAY,
  OPTION_VIEW,
  OPTION_EXPOSURE,
  OPTION_JSON
};

typedef struct request {
  abbe_render_options render;
  abbe_map_options map;
  abbe_preset_options preset;
  abbe_preset_choice choice;
  abbe_error_options errors;
  const char *exr, *png, *stats;
  const char *of_png; /* an option that the PNG alone has */
  bool aovs, unfilled, quiet, json;
  int bits;
  size_t frames, bands;
  abbe_context_backend backend;
  abbe_display_desc display;
} request;

static const struct argp_option options[] = {
    {"output", 'o', "FILE.exr", ABBE_ARGUMENT_WRITES, "the scene-linear picture", 0},
    {"png", OPTION_PNG, "FILE.png", ABBE_ARGUMENT_WRITES,
     "the picture for a display, through OpenColorIO", 0},
    {"bits", OPTION_BITS, "8|16", 0, "of the PNG (8)", 0},
    {"aovs", OPTION_AOVS, NULL, 0, "direct and caustic light and distance in the EXR too", 0},
    {"bands", OPTION_BANDS, "N", 0, "N bands of wavelengths in the saved map too, in W/nm", 0},
    {"unfilled", OPTION_UNFILLED, NULL, 0, "the thesis's map before its fill", 0},
    {"stats", OPTION_STATS, "FILE", ABBE_ARGUMENT_WRITES,
     "times, photons and the energy ledger as JSON", 0},
    {"json", OPTION_JSON, NULL, 0, "the same on standard output", 0},
    {"frames", OPTION_FRAMES, "N", 0, "warm up, then report the median of N frames (1)", 0},
    {"gl", OPTION_GL, "NAME", 0, "osmesa (CPU) or egl (osmesa)", 0},
    {"quiet", 'q', NULL, 0, "no progress, no summary", 0},
    {"ocio", OPTION_OCIO, "FILE", ABBE_ARGUMENT_READS,
     "OpenColorIO configuration ($OCIO, else the shipped one)", 2},
    {"display", OPTION_DISPLAY, "NAME", 0, "of the configuration", 2},
    {"view", OPTION_VIEW, "NAME", 0, "of the display", 2},
    {"exposure", OPTION_EXPOSURE, "STOPS", 0, "for the PNG (0)", 2},
    {0}};

static error_t parse(int key, char *text, struct argp_state *state) {
  static const char *const backends[] = {"osmesa", "egl"}, *const bits[] = {"8", "16"};
  request *q = state->input;
  const char *p = q->render.program;
  switch (key) {
  case ARGP_KEY_INIT:
    state->child_inputs[0] = &q->render;
    state->child_inputs[1] = &q->map;
    state->child_inputs[2] = &q->preset;
    state->child_inputs[3] = &q->errors;
    return 0;
  case 'o':
    q->exr = abbe_command_target(state->name, "-o", text, ".exr");
    return 0;
  case OPTION_PNG:
    q->png = abbe_command_target(state->name, "--png", text, ".png");
    return 0;
  case OPTION_BITS:
    q->of_png = "--bits";
    q->bits = abbe_command_choice(p, "--bits", text, bits, 2) == 0 ? 8 : 16;
    return 0;
  case OPTION_AOVS:
    q->aovs = true;
    return 0;
  case OPTION_BANDS:
    q->bands = abbe_command_count(p, "--bands", text, 1, ABBE_RENDER_MAX_BANDS);
    return 0;
  case OPTION_UNFILLED:
    q->unfilled = true;
    return 0;
  case OPTION_STATS:
    q->stats = abbe_command_target(state->name, "--stats", text, ".json");
    return 0;
  case OPTION_JSON:
    q->json = true;
    return 0;
  case OPTION_FRAMES:
    q->frames = abbe_command_count(p, "--frames", text, 1, 1000);
    return 0;
  case OPTION_GL:
    q->backend = (abbe_context_backend)abbe_command_choice(p, "--gl", text, backends, 2);
    return 0;
  case 'q':
    q->quiet = true;
    return 0;
  case OPTION_OCIO:
    q->of_png = "--ocio";
    q->display.config = text;
    return 0;
  case OPTION_DISPLAY:
    q->of_png = "--display";
    q->display.display = text;
    return 0;
  case OPTION_VIEW:
    q->of_png = "--view";
    q->display.view = text;
    return 0;
  case OPTION_EXPOSURE:
    q->of_png = "--exposure";
    q->display.exposure = abbe_command_number(p, "--exposure", text, -30, 30);
    return 0;
  case ARGP_KEY_END:
    if (q->exr == NULL && q->png == NULL && q->stats == NULL && q->map.save == NULL && !q->json &&
        q->errors.png == NULL)
      argp_error(state, "where to? Give -o FILE.exr, --png FILE.png or both");
    if (q->of_png != NULL && q->png == NULL)
      argp_error(state, "%s is for the PNG: give --png FILE.png too", q->of_png);
    if (q->bands > 0 && q->map.save == NULL)
      argp_error(state, "--bands are those of a map: give --save-map FILE.exr too");
    if (q->errors.mean && q->aovs)
      argp_error(state, "--mean has no --aovs: they are of one picture, not of the mean");
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

/* A view that the configuration does not have is found out before the work, as a target is. */
static abbe_result check_display(const request *q, abbe_error *error) {
  if (q->png == NULL) return ABBE_OK;
  abbe_display *display = NULL;
  abbe_display_desc desc = q->display;
  bool thesis = q->render.desc.profile == ABBE_PROFILE_THESIS;
  desc.source_space =
      abbe_rgb_space_ocio_name(thesis ? ABBE_RGB_SPACE_REC709 : q->render.desc.space);
  abbe_result result = abbe_display_make(&desc, &display, error);
  abbe_display_free(display);
  return result;
}

static cJSON *describe(const request *q, const abbe_statistics *s, const abbe_error_bars *bars,
                       const abbe_context *context) {
  cJSON *root = cJSON_CreateObject();
  cJSON_AddNumberToObject(root, "frame_ms", s->frame_ms);
  if (s->baseline_ms > 0) cJSON_AddNumberToObject(root, "baseline_ms", s->baseline_ms);
  cJSON *passes = cJSON_AddArrayToObject(root, "passes");
  for (size_t i = 0; i < s->pass_count; i++) {
    cJSON *pass = cJSON_CreateObject();
    cJSON_AddStringToObject(pass, "name", abbe_plan_item_text(s->pass[i].pass));
    cJSON_AddNumberToObject(pass, "ms", s->pass[i].ms);
    cJSON_AddItemToArray(passes, pass);
  }
  cJSON_AddNumberToObject(root, "photons", (double)s->photons);
  cJSON_AddNumberToObject(root, "wavelengths", (double)s->wavelengths);
  cJSON_AddNumberToObject(root, "refractor_share", s->refractor_share);
  cJSON *energy = cJSON_AddObjectToObject(root, "energy");
  cJSON_AddNumberToObject(energy, "reached", s->energy.reached);
  cJSON_AddNumberToObject(energy, "reflected", s->energy.reflected);
  cJSON_AddNumberToObject(energy, "absorbed", s->energy.absorbed);
  cJSON_AddNumberToObject(energy, "trapped", s->energy.trapped);
  cJSON_AddNumberToObject(energy, "missed", s->energy.missed);
  cJSON_AddNumberToObject(energy, "deposited", s->energy.deposited);
  cJSON_AddNumberToObject(energy, "on_tiles", s->energy.on_tiles);
  cJSON_AddNumberToObject(energy, "interpolated", s->energy.interpolated);
  cJSON_AddNumberToObject(energy, "imbalance", abbe_ledger_imbalance(&s->energy));
  cJSON_AddNumberToObject(root, "device_bytes", (double)s->device_bytes);
  struct rusage usage;
  if (getrusage(RUSAGE_SELF, &usage) == 0)
    cJSON_AddNumberToObject(root, "peak_bytes", 1024.0 * (double)usage.ru_maxrss);
  cJSON_AddStringToObject(root, "device", abbe_context_description(context));
  abbe_error_options_describe(&q->errors, bars, root);
  double estimate = bars->caustic.pixels > 0 ? bars->caustic.ciede2000 : -1;
  abbe_preset_options_describe(&q->choice, s, estimate, root);
  return root;
}

static abbe_result write_stats(const request *q, const abbe_statistics *s,
                               const abbe_error_bars *bars, const abbe_context *context,
                               abbe_error *error) {
  if (q->stats == NULL && !q->json) return ABBE_OK;
  cJSON *root = describe(q, s, bars, context);
  char *text = abbe_command_json_text(root);
  cJSON_Delete(root);
  if (text == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the statistics");
  if (q->json) fputs(text, stdout);
  abbe_result result = ABBE_OK;
  if (q->stats != NULL) result = abbe_file_write(q->stats, text, strlen(text), error);
  free(text);
  return result;
}

/* One frame, or the median of several after a warm-up, and the baseline under them. */
static abbe_result run_frames(const request *q, abbe_renderer *renderer, abbe_statistics *out,
                              abbe_error *error) {
  abbe_progress progress;
  abbe_frame_times times;
  const abbe_frame_times_desc desc = {
      .frames = q->frames, .progress = abbe_progress_update, .user = &progress};
  abbe_progress_begin(&progress, "render", q->quiet);
  abbe_result result = ABBE_OK;
  if (q->frames == 0) {
    result = abbe_renderer_frame(renderer, abbe_progress_update, &progress, out, error);
  } else {
    result = abbe_frame_times_measure(renderer, &desc, &times, error);
    if (result == ABBE_OK) *out = times.median;
  }
  abbe_progress_end(&progress);
  if (result == ABBE_OK && q->frames > 0 && !abbe_profile_is_thesis(q->render.desc.profile))
    result = abbe_frame_times_baseline(renderer, q->frames, &out->baseline_ms, error);
  return result;
}

static abbe_result annotate(const request *q, const abbe_renderer *renderer,
                            const abbe_context *context, abbe_image *image, abbe_error *error) {
  const abbe_render_desc *d = &abbe_renderer_plan(renderer)->desc;
  char text[512];
  snprintf(text, sizeof text,
           "profile %s, %zu wavelengths %g:%g nm, photons %zu, map %zu, samples %zu, upsample %zu, "
           "fill %s, "
           "share %g, exits %zu",
           abbe_profile_name(d->profile), d->wavelengths, d->min_nm, d->max_nm, d->photons,
           d->map_size, d->supersample, d->upsample, abbe_fill_name(d->fill), d->energy_share,
           d->exits);
  abbe_result result = abbe_image_set_attribute(image, "abbe:settings", text, error);
  if (result == ABBE_OK)
    result = abbe_image_set_attribute(image, "abbe:scene", q->render.scene, error);
  if (result == ABBE_OK)
    result =
        abbe_image_set_attribute(image, "abbe:device", abbe_context_description(context), error);
  if (result == ABBE_OK)
    result = abbe_image_set_attribute(
        image, "abbe:unit",
        d->profile == ABBE_PROFILE_THESIS ? "display brightness" : "radiance, W/(m2 sr)", error);
  return result;
}

static abbe_result write_png(const request *q, const abbe_image *image, abbe_error *error) {
  const abbe_screen_png_desc desc = {.display = q->display, .bits = q->bits};
  return abbe_screen_png_write(q->png, image, &desc, error);
}

static abbe_result save_map(const request *q, abbe_renderer *renderer, abbe_error *error) {
  abbe_image map = {0};
  bool thesis = abbe_renderer_plan(renderer)->desc.profile == ABBE_PROFILE_THESIS;
  abbe_result result =
      q->bands > 0
          ? abbe_renderer_read_map_bands(renderer, q->map.light_index, q->bands, &map, error)
          : abbe_renderer_read_map(renderer, q->map.light_index, !q->unfilled, &map, error);
  if (result != ABBE_OK) return result;
  result = abbe_image_set_attribute(&map, "abbe:unit",
                                    thesis ? "display brightness" : "flux a texel, W", error);
  if (result == ABBE_OK)
    result = abbe_image_set_attribute(&map, "abbe:scene", q->render.scene, error);
  if (result == ABBE_OK) result = abbe_exr_write(q->map.save, &map, error);
  abbe_image_free(&map);
  return result;
}

static void summarise(const request *q, const abbe_statistics *s, double prepared_s) {
  if (q->quiet || q->json) return;
  fprintf(stderr, "a frame of %.0f ms, prepared in %.1f s, %zu photons x %zu wavelengths",
          s->frame_ms, prepared_s, s->photons, s->wavelengths);
  const abbe_ledger *e = &s->energy;
  if (e->reached > 0)
    fprintf(stderr,
            "; of the light that met refractors %.1f %% is in the map, %.1f %% reflected, %.1f %% "
            "absorbed, %.1f %% trapped, %.1f %% missed (balance %.1e)",
            100 * e->deposited / e->reached, 100 * e->reflected / e->reached,
            100 * e->absorbed / e->reached, 100 * e->trapped / e->reached,
            100 * e->missed / e->reached, abbe_ledger_imbalance(e));
  fprintf(stderr, "\n");
}

static void say_compiling(void *user) {
  (void)user;
  fprintf(stderr, "compiling this scene's shaders: some seconds, once on this machine\n");
}

static void print_notes(const abbe_scene *scene, const abbe_plan *plan) {
  abbe_scene_input_note(scene);
  for (size_t i = 0; i < plan->note_count; i++) fprintf(stderr, "note: %s\n", plan->note[i]);
}

static abbe_result render(const request *q, const abbe_scene *scene, abbe_context *context,
                          abbe_error *error) {
  abbe_renderer *renderer = NULL;
  abbe_statistics statistics;
  abbe_image image = {0};
  abbe_error_bars bars = {0};
  abbe_progress progress;
  abbe_render_desc desc = q->render.desc;
  if (q->map.like != NULL) {
    desc.map_layout = &q->map.layout;
    desc.map_layout_light = q->map.light_index;
    if (desc.map_size == 0) desc.map_size = q->map.side;
  }
  desc.progress = abbe_progress_update;
  desc.progress_user = &progress;
  desc.compiling = q->quiet ? NULL : say_compiling;
  abbe_progress_begin(&progress, "prepare", q->quiet);
  abbe_result result = abbe_renderer_make(context, scene, &desc, &renderer, error);
  const double prepared_s = abbe_progress_seconds(&progress);
  abbe_progress_end(&progress);
  if (result == ABBE_OK) {
    if (!q->quiet) print_notes(scene, abbe_renderer_plan(renderer));
    if (!q->quiet) abbe_preset_options_note(&q->choice);
    if (q->map.save != NULL && !abbe_renderer_plan(renderer)->caustics)
      result = abbe_error_set(error, ABBE_UNSUPPORTED,
                              "%s has no refractor, so there is no spectral map to save",
                              q->render.scene);
    else
      result = run_frames(q, renderer, &statistics, error);
  }
  if (result == ABBE_OK) result = abbe_renderer_read(renderer, q->aovs, &image, error);
  if (result == ABBE_OK) result = annotate(q, renderer, context, &image, error);
  if (result == ABBE_OK)
    result = abbe_error_options_work(&q->errors, context, scene, renderer, q->quiet, &image, &bars,
                                     error);
  if (result == ABBE_OK && q->exr != NULL) result = abbe_exr_write(q->exr, &image, error);
  if (result == ABBE_OK && q->map.save != NULL) result = save_map(q, renderer, error);
  if (result == ABBE_OK && q->png != NULL) result = write_png(q, &image, error);
  if (result == ABBE_OK) result = write_stats(q, &statistics, &bars, context, error);
  if (result == ABBE_OK) summarise(q, &statistics, prepared_s);
  if (result == ABBE_OK && !q->quiet && !q->json) abbe_error_options_summarise(&q->errors, &bars);
  /* The picture is there; but a bound that was asked for and is not kept is told by the exit code.
   */
  if (result == ABBE_OK) result = abbe_preset_choice_check(&q->choice, statistics.frame_ms, error);
  abbe_error_bars_free(&bars);
  abbe_image_free(&image);
  abbe_renderer_free(renderer);
  return result;
}

int abbe_command_render(int argc, char **argv) {
  static const struct argp_child children[] = {
      {&abbe_render_options_argp, 0, "Speed and accuracy:", 1},
      {&abbe_map_options_argp, 0, "Spectral map:", 3},
      {&abbe_preset_options_argp, 0, "By error or by time:", 2},
      {&abbe_error_options_argp, 0, "How far off it is:", 4},
      {0}};
  static const struct argp argp = {
      options,
      parse,
      NULL,
      "Renders a scene with its caustics to a scene-linear OpenEXR picture and to a PNG.\v"
      "Examples:\n"
      "  abbe render scenes/gem.yaml -o gem.exr --png gem.png\n"
      "  abbe render scenes/prism.yaml --png prism.png --wavelengths 21 --photons 1024\n"
      "  abbe render scenes/sphere.yaml --profile thesis --png thesis.png --view Plain\n"
      "  abbe render scenes/gem.yaml --stats gem.json --frames 9\n"
      "  abbe render scenes/gem.yaml --png gem.png --preset draft\n"
      "  abbe render scenes/gem.yaml --png gem.png --budget-ms 100 --json\n"
      "  abbe render scenes/gem.yaml -o gem.exr --error-bars --error-png gem-error.png\n"
      "  abbe render scenes/gem.yaml --save-map test.exr --map-like reference.exr\n",
      children,
      NULL,
      NULL};
  request q = {
      .render.program = argv[0], .preset.program = argv[0], .errors.program = argv[0], .bits = 8};
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &q);
  abbe_error error = {0};
  abbe_scene scene = {0};
  abbe_context *context = NULL;
  /* The AOVs tell where the caustic is, whose error is summed up. */
  q.render.desc.aovs = q.aovs || q.errors.asked;
  const char *const targets[] = {q.exr, q.png, q.map.save, q.stats, q.errors.png};
  abbe_result result = abbe_command_check_targets(targets, 5, &error);
  if (result == ABBE_OK) result = check_display(&q, &error);
  if (result == ABBE_OK)
    result = abbe_scene_input_load(argv[0], q.render.scene, q.render.materials, &scene, &error);
  bool loaded = result == ABBE_OK;
  if (loaded && q.errors.asked) result = abbe_error_bars_check(q.render.desc.profile, NULL, &error);
  if (result == ABBE_OK)
    result = abbe_map_options_resolve(&q.map, &scene, q.render.desc.map_size == 0, &error);
  if (result == ABBE_OK) result = abbe_context_make(q.backend, &context, &error);
  q.preset.request.timed = q.stats != NULL || q.json;
  if (result == ABBE_OK)
    result =
        abbe_preset_choose(&q.preset.request, context, &scene, &q.render.desc, &q.choice, &error);
  if (result == ABBE_OK) result = render(&q, &scene, context, &error);
  abbe_preset_choice_free(&q.choice);
  abbe_context_free(context);
  abbe_scene_free(&scene);
  return abbe_render_options_end(&q.render, loaded, result, &error);
}
