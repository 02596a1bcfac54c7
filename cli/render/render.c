#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"
#include "cli/options/own_context.h"
#include "cli/options/picture_options.h"
#include "cli/options/scene_input.h"
#include "cli/render/render_request.h"

#include "colorimetry/image/exr.h"
#include "gl/accuracy/frame_times.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_STATS = 0x200, OPTION_BACKEND, OPTION_FRAMES, OPTION_MOVE };

typedef abbe_render_request request;

static const abbe_option options[] = {
    {"output", 'o', "FILE", ABBE_ARGUMENT_WRITES,
     "the scene-linear picture, .exr; or that for a display, by its ending as --png", 0,
     ABBE_TAKE_OUTPUT(request, exr, png)},
    {"png", 0, "FILE.png", ABBE_ARGUMENT_WRITES,
     "the picture for a display, through OpenColorIO: .png, .webp, .jpg, .gif or .avif", 0,
     ABBE_TAKE_OUTPUT(request, png, png)},
    {"aovs", 0, NULL, 0, "direct and caustic light and distance in the EXR too", 0,
     ABBE_TAKE_FLAG(request, aovs)},
    {"bands", 0, "N", 0, "N bands of wavelengths in the EXR and the saved map too: N frames more",
     0, ABBE_TAKE_COUNT(request, bands, 1, ABBE_RENDER_MAX_BANDS)},
    {"stats", OPTION_STATS, "FILE|-", ABBE_ARGUMENT_WRITES | ABBE_ARGUMENT_STREAMS,
     "times, photons and the energy ledger as JSON; -: on standard output", 0, ABBE_TAKE_BY_KEY},
    {"json", 0, NULL, 0, "the same on standard output", 0, ABBE_TAKE_FLAG(request, json)},
    {"frames", OPTION_FRAMES, "N|A:B", 0,
     "warm up, then report the median of N frames (1); A:B: frames A to B - 1 over time, numbered, "
     "and FILE.png, .webp or .gif that moves",
     0, ABBE_TAKE_BY_KEY},
    ABBE_FRAME_SERIES_MOVE(OPTION_MOVE, 0),
    {"backend", OPTION_BACKEND, "NAME", 0, "cpu, gpu, or auto: a GPU where there is one (auto)", 0,
     ABBE_TAKE_BY_KEY},
    {"quiet", 'q', NULL, 0, "no progress, no summary", 0, ABBE_TAKE_FLAG(request, quiet)},
    ABBE_OPTIONS(request, &abbe_render_options_argp, render, "Speed and accuracy:", 1),
    ABBE_OPTIONS(request, &abbe_map_options_argp, map, "Spectral map:", 3),
    ABBE_OPTIONS(request, &abbe_preset_options_argp, preset, "By error or by time:", 2),
    ABBE_OPTIONS(request, &abbe_error_options_argp, errors, "How far off it is:", 4),
    ABBE_OPTIONS(request, &abbe_render_frames_argp, series, "From all around, and over time:", 5),
    ABBE_OPTIONS(request, &abbe_screen_options_argp, screen,
                 "How the picture for a display shows it:", 6),
    {0}};

static error_t parse(int key, char *text, struct argp_state *state) {
#define NAME_OF(code, name) name,
  static const char *const backends[] = {ABBE_CONTEXT_BACKENDS(NAME_OF)};
#undef NAME_OF
  request *q = state->input;
  const char *p = q->render.program;
  switch (key) {
  case OPTION_STATS:
    if (strcmp(text, "-") == 0)
      q->json = true;
    else
      q->stats = abbe_command_target(state->name, "--stats", text, ".json");
    return 0;
  case OPTION_FRAMES:
    if (strchr(text, ':') != NULL)
      abbe_frame_series_take(&q->series, text);
    else
      q->frames = abbe_command_count(p, "--frames", text, 1, 1000);
    return 0;
  case OPTION_MOVE:
    abbe_frame_series_take_move(&q->series, &q->render.changes, text);
    return 0;
  case OPTION_BACKEND:
    q->backend = (abbe_context_backend)abbe_command_choice(p, "--backend", text, backends,
                                                           ABBE_CONTEXT_BACKEND_COUNT);
    return 0;
  case ARGP_KEY_END:
    if (q->exr == NULL && q->png == NULL && q->stats == NULL && q->map.save == NULL && !q->json &&
        q->errors.png == NULL)
      q->png = abbe_scene_input_picture(p, q->render.scene);
    if (q->exr == NULL && q->png == NULL && q->stats == NULL && q->map.save == NULL && !q->json &&
        q->errors.png == NULL)
      argp_error(state, "where to? Give -o FILE.exr, --png FILE.png or both");
    q->screen.alpha = q->render.changes.alpha;
    abbe_screen_options_end(&q->screen, q->png, state);
    if (q->screen.alpha && (q->series.count > 0 || q->bands > 0))
      argp_error(state, "--alpha is of one picture: it goes without --turntable, --frames A:B and "
                        "--bands");
    if (q->screen.exposed && q->series.count > 0)
      argp_error(state, "--exposure auto is of one picture: give the stops that it takes for one");
    if (q->bands > 0 && q->map.save == NULL && q->exr == NULL)
      argp_error(state, "--bands are those of -o FILE.exr and --save-map FILE.exr: give one");
    if (q->series.count > 0 && (q->map.save != NULL || q->frames > 0 || q->errors.asked ||
                                q->bands > 0 || (q->exr == NULL && q->png == NULL)))
      argp_error(state,
                 "%s writes frames by -o FILE.exr and --png FILE.png, and goes "
                 "without --save-map, --frames N, --bands and --error-bars",
                 q->series.around ? "--turntable" : "--frames A:B");
    q->series.stated = q->screen.stated || q->png == NULL;
    abbe_frame_series_check(&q->series, q->png, state);
    if (q->series.merge && q->png == NULL)
      argp_error(state,
                 "--merge makes a picture that moves: give -o FILE.webp, FILE.gif or FILE.png");
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
  const bool printed = abbe_method_of(q->render.desc.profile)->printed;
  return abbe_screen_options_check(&q->screen, q->png,
                                   printed ? ABBE_RGB_SPACE_REC709 : q->render.desc.space, error);
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
  if (result == ABBE_OK && q->frames > 0 && !abbe_method_of(q->render.desc.profile)->own_passes)
    result = abbe_frame_times_baseline(renderer, q->frames, &out->baseline_ms, error);
  return result;
}

/* What the renderer reports while it prepares: the bar is first, for abbe_progress_update. */
typedef struct preparation {
  abbe_progress bar;
  request *request;
} preparation;

static void say_compiling(void *user) {
  request *q = ((preparation *)user)->request;
  q->picture.compiled = true;
  if (!q->quiet)
    fprintf(stderr, "compiling this scene's shaders: some seconds, once on this machine\n");
}

static void print_notes(const abbe_scene *scene, const abbe_plan *plan) {
  abbe_scene_input_note(scene);
  for (size_t i = 0; i < plan->note_count; i++) fprintf(stderr, "note: %s\n", plan->note[i]);
}

static void note_picture(const request *q) {
  if (q->picture_note != NULL) fprintf(stderr, "note: %s\n", q->picture_note);
  abbe_preset_options_note_picture(&q->picture);
  abbe_preset_options_note_overridden(q->overridden);
}

/* By the tracer, where it serves the request best. */
static abbe_result trace(request *q, const abbe_scene *scene, abbe_error *error) {
  const abbe_traced_picture_desc desc = abbe_render_describe_traced(q);
  ABBE_OWNED(abbe_image, image) = {0};
  if (!q->quiet) abbe_scene_input_note(scene);
  if (!q->quiet) note_picture(q);
  ABBE_TRY(abbe_scene_input_check_alpha(scene, error));
  ABBE_TRY(abbe_traced_picture_make(&q->picture, scene, &desc, &image, error));
  if (q->screen.alpha)
    ABBE_TRY(abbe_scene_input_add_alpha(scene, ABBE_SCENE_INPUT_ALPHA_SAMPLES, &image, error));
  if (q->exr != NULL) ABBE_TRY(abbe_exr_write(q->exr, &image, error));
  if (q->png != NULL) ABBE_TRY(abbe_render_write_png(q, &image, error));
  ABBE_TRY(abbe_render_check_in_time(q, scene, &image, error));
  ABBE_TRY(abbe_render_write_traced_stats(q, error));
  if (!q->quiet) abbe_preset_options_note_error(&q->picture);
  if (!q->quiet && !q->json)
    fprintf(stderr, "traced; %.0f ms from start to end\n", abbe_render_process_ms());
  return abbe_picture_choice_check(&q->picture, abbe_render_process_ms(), error);
}

/* The frame that the renderer holds, as files. */
static abbe_result write_picture(request *q, const abbe_scene *scene, const abbe_render_desc *desc,
                                 abbe_context *context, abbe_renderer *renderer,
                                 abbe_error_bars *bars, abbe_error *error) {
  abbe_image image = {0};
  abbe_scene sharp = *scene; /* as the frame is, and alpha of it */
  if (q->screen.alpha) sharp.camera.aperture = sharp.camera.focus = 0;
  abbe_progress bar;
  abbe_progress_begin(&bar, "lens", q->quiet || !(sharp.camera.aperture > 0));
  abbe_result result = abbe_renderer_read_blurred(renderer, &sharp, desc, q->aovs,
                                                  abbe_progress_update, &bar, &image, error);
  abbe_progress_end(&bar);
  if (result == ABBE_OK) result = abbe_render_check_frame(q, &sharp, renderer, &image, error);
  if (result == ABBE_OK && !q->picture.traced_instead)
    result = abbe_render_annotate(q, renderer, context, &image, error);
  if (result == ABBE_OK)
    result = abbe_error_options_work(&q->errors, context, scene, renderer, q->quiet, &image, bars,
                                     error);
  if (result == ABBE_OK && q->screen.alpha)
    result = abbe_scene_input_add_alpha(scene, abbe_renderer_plan(renderer)->desc.supersample,
                                        &image, error);
  if (result == ABBE_OK && q->exr != NULL && q->bands > 0)
    result = abbe_render_add_bands(q, scene, context, &image, error);
  if (result == ABBE_OK && q->exr != NULL) result = abbe_exr_write(q->exr, &image, error);
  if (result == ABBE_OK && q->map.save != NULL) result = abbe_render_save_map(q, renderer, error);
  if (result == ABBE_OK && q->png != NULL) result = abbe_render_write_png(q, &image, error);
  abbe_image_free(&image);
  return result;
}

static abbe_result render(request *q, const abbe_scene *scene, abbe_context *context,
                          abbe_error *error) {
  abbe_renderer *renderer = NULL;
  abbe_statistics statistics = {0};
  abbe_error_bars bars = {0};
  preparation preparing = {.request = q};
  abbe_render_desc desc = q->render.desc;
  if (q->map.like != NULL) {
    desc.map_layout = &q->map.layout;
    desc.map_layout_light = q->map.light_index;
    if (desc.map_size == 0) desc.map_size = q->map.side;
  }
  desc.progress = abbe_progress_update;
  desc.progress_user = &preparing;
  desc.compiling = say_compiling;
  desc.compiles_beside = true;
  abbe_progress_begin(&preparing.bar, "prepare", q->quiet);
  abbe_result result = abbe_renderer_make(context, scene, &desc, &renderer, error);
  const double prepared_s = abbe_progress_seconds(&preparing.bar);
  abbe_progress_end(&preparing.bar);
  q->picture.prepared_ms = 1e3 * prepared_s;
  if (result == ABBE_OK) {
    if (!q->quiet) print_notes(scene, abbe_renderer_plan(renderer));
    if (!q->quiet) abbe_preset_options_note(&q->choice);
    if (!q->quiet) note_picture(q);
    if (q->map.save != NULL && !abbe_renderer_plan(renderer)->caustics)
      result = abbe_error_set(error, ABBE_UNSUPPORTED,
                              "%s has no refractor, so there is no spectral map to save",
                              q->render.scene);
    else if (q->series.count > 0)
      result = abbe_render_frames_draw(q, scene, &desc, renderer, context, &statistics, error);
    else
      result = run_frames(q, renderer, &statistics, error);
  }
  if (result == ABBE_OK && q->series.count == 0)
    result = write_picture(q, scene, &desc, context, renderer, &bars, error);
  if (result == ABBE_OK && q->series.count == 0)
    result = abbe_render_check_frame_in_time(q, scene, renderer, error);
  if (result == ABBE_OK) result = abbe_render_write_stats(q, &statistics, &bars, context, error);
  if (result == ABBE_OK) abbe_render_summarise(q, &statistics, prepared_s);
  if (result == ABBE_OK && !q->quiet && !q->overridden) abbe_preset_options_note_error(&q->picture);
  if (result == ABBE_OK && !q->quiet && !q->json) abbe_error_options_summarise(&q->errors, &bars);
  /* The picture is there; but a bound that was requested and is not kept gives an exit
   * code.
   */
  if (result == ABBE_OK) result = abbe_preset_choice_check(&q->choice, statistics.frame_ms, error);
  if (result == ABBE_OK)
    result = abbe_picture_choice_check(&q->picture, abbe_render_process_ms(), error);
  abbe_error_bars_free(&bars);
  abbe_renderer_free(renderer);
  return result;
}

/* ---- what makes it ---- */

/* An option that the tracer does not know, or NULL. */
static const char *renderers_own(const request *q) {
  const abbe_render_desc *d = &q->render.desc;
  return q->aovs                                ? "--aovs"
         : q->bands > 0                         ? "--bands"
         : q->map.save != NULL                  ? "--save-map"
         : q->map.like != NULL                  ? "--map-like"
         : q->frames > 0                        ? "--frames"
         : q->errors.asked                      ? "--error-bars"
         : q->series.count > 0                  ? (q->series.around ? "--turntable" : "--frames")
         : d->wavelengths > 0                   ? "--wavelengths"
         : d->photons > 0                       ? "--photons"
         : d->map_size > 0                      ? "--map"
         : d->supersample > 0                   ? "--samples"
         : d->upsample > 0                      ? "--upsample"
         : d->adaptive > 0                      ? "--adaptive"
         : d->lens > 0                          ? "--lens"
         : d->receiver_samples > 0              ? "--receiver-samples"
         : d->environment_lights > 0            ? "--environment-lights"
         : d->light_points > 0                  ? "--light-points"
         : d->exits > 0                         ? "--exits"
         : d->energy_share > 0                  ? "--share"
         : d->fill != ABBE_FILL_AUTO            ? "--fill"
         : d->model != ABBE_MODEL_AUTO          ? "--model"
         : !abbe_method_of(d->profile)->presets ? "--profile"
                                                : NULL;
}

/* Leaves the choice without a point where a frame's settings are requested, or where the presets
 * know frames alone. */
static abbe_result choose_picture(request *q, const abbe_scene *scene, abbe_error *error) {
  const abbe_preset_options *o = &q->preset;
  const abbe_preset_request *p = &o->request;
  const char *own = renderers_own(q);
  abbe_picture_request r = {.name = p->name,
                            .file = p->file,
                            .max_error = p->max_error,
                            .budget_ms = p->budget_ms,
                            .timed = p->timed,
                            .width = q->render.desc.width,
                            .height = q->render.desc.height};
  if (p->name == NULL && !(p->max_error > 0) && !(p->budget_ms > 0)) return ABBE_OK;
  if (o->of_frame || !abbe_method_of(q->render.desc.profile)->presets) return ABBE_OK;
  if (o->tool > 0 && own != NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "--tool %s: %s is for the renderer alone; leave one of the two out",
                          abbe_picture_tool_name((abbe_picture_tool)o->tool), own);
  if (o->tool > 0) ABBE_TRY(abbe_scene_input_check_alpha(scene, error));
  q->may_trace = own == NULL && o->tool < 0;
  if (!q->may_trace) r.tool[own != NULL ? ABBE_PICTURE_RENDER : (abbe_picture_tool)o->tool] = true;
  abbe_result result = abbe_picture_choose(&r, scene, &q->picture, error);
  if (result == ABBE_UNSUPPORTED && !o->of_picture && o->tool <= 0) {
    q->picture_note =
        "the presets know no whole pictures of such a scene, so a frame's time counts";
    q->picture.point = NULL;
    return ABBE_OK;
  }
  if (result != ABBE_OK || q->picture.point->tool != ABBE_PICTURE_RENDER) return result;
  if (own != NULL)
    q->picture_note = "options of the renderer are given, so the tracer is not considered";
  const abbe_preset_point point = {.desc = abbe_picture_point_desc(q->picture.point)};
  q->overridden = !abbe_preset_apply(&point, scene, &q->render.desc);
  /* They show where the caustic is. */
  if (abbe_render_is_checked(q) || p->budget_ms > 0) q->render.desc.aovs = true;
  return result;
}

static abbe_result choose_and_draw(request *q, const abbe_scene *scene, abbe_error *error) {
  abbe_context *context = NULL;
  if (q->series.merge) return abbe_frame_series_merge(&q->series, q->png, error);
  q->preset.request.timed = q->stats != NULL || q->json;
  abbe_result result = choose_picture(q, scene, error);
  const bool chosen = q->picture.point != NULL;
  if (result == ABBE_OK && chosen && q->picture.point->tool != ABBE_PICTURE_RENDER)
    return trace(q, scene, error);
  if (result == ABBE_OK) result = abbe_own_context_make(q->backend, q->quiet, &context, error);
  if (result == ABBE_OK && !chosen)
    result =
        abbe_preset_choose(&q->preset.request, context, scene, &q->render.desc, &q->choice, error);
  if (result == ABBE_OK) result = render(q, scene, context, error);
  abbe_preset_choice_free(&q->choice);
  abbe_context_free(context);
  return result;
}

int abbe_command_render(int argc, char **argv) {
  const abbe_parser argp = {
      options, parse, NULL,
      "Renders a scene with its caustics to a scene-linear OpenEXR picture and to one for a "
      "display. 'abbe methods --help' shows the seldom options, and those of published methods, "
      "pinholes and caustic volumes.\v"
      "Examples:\n"
      "  abbe render scenes/gem.yaml -o gem.exr --png gem.png\n"
      "  abbe render scenes/prism.yaml --png prism.png --wavelengths 21 --photons 1024\n"
      "  abbe render scenes/sphere.yaml --profile thesis --png thesis.png --view Plain\n"
      "  abbe render scenes/gem.yaml --png ruby.png --material ruby --set lights.lamp.intensity=2\n"
      "  abbe render scenes/gem.yaml --stats gem.json --frames 9\n"
      "  abbe render scenes/gem.yaml --png gem.png --preset draft\n"
      "  abbe render scenes/gem.yaml --png gem.png --budget-ms 100 --json\n"
      "  abbe render scenes/gem.yaml -o gem.exr --error-bars --error-png gem-error.png\n"
      "  abbe render scenes/stone.yaml --turntable 72 --png stone.png --size 256x256\n"
      "  abbe render scenes/water/pool.yaml --frames 0:48 --fps 24 --png pool.png --size 256x256\n"
      "  abbe render scenes/prism.yaml -o bands.exr --bands 20\n"
      "  abbe render scenes/stone.yaml --turntable 72 --png stone.png --part 3/8\n"
      "  abbe render scenes/gem.yaml --save-map test.exr --map-like reference.exr\n"};
  request q = {.render.program = argv[0],
               .preset.program = argv[0],
               .preset.tool = -1,
               .errors.program = argv[0],
               .series.program = argv[0],
               .screen.program = argv[0]};
  abbe_render_options_begin();
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &q);
  abbe_error error = {0};
  abbe_scene scene = {0};
  /* The AOVs show where the caustic is, whose error is summed up. */
  q.render.desc.aovs = q.aovs || q.errors.asked;
  const char *const targets[] = {q.exr, q.png, q.map.save, q.stats, q.errors.png};
  abbe_result result = abbe_command_check_targets(targets, 5, &error);
  if (result == ABBE_OK) result = check_display(&q, &error);
  if (result == ABBE_OK)
    result = abbe_scene_input_load_with(argv[0], q.render.scene, q.render.materials,
                                        &q.render.changes, &scene, &error);
  bool loaded = result == ABBE_OK;
  if (loaded) result = abbe_render_options_load_volume(&q.render, &error);
  loaded = result == ABBE_OK;
  if (loaded && q.errors.asked) result = abbe_error_bars_check(q.render.desc.profile, NULL, &error);
  if (result == ABBE_OK)
    result = abbe_map_options_resolve(&q.map, &scene, q.render.desc.map_size == 0, &error);
  if (result == ABBE_OK && q.series.count > 0)
    result = abbe_frame_series_record(&q.series, &scene, &error);
  if (result == ABBE_OK) result = choose_and_draw(&q, &scene, &error);
  abbe_frame_series_free(&q.series);
  abbe_scene_free(&scene);
  abbe_caustic_volume_free(&q.render.volume);
  return abbe_render_options_end(&q.render, loaded, result, &error);
}
