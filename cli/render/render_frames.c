#include "cli/render/render_request.h"

#include "base/maths.h"
#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"
#include "cli/options/scene_input.h"
#include "scenes/object_motion.h"

#include "colorimetry/image/exr.h"

#include <math.h>
#include <stdlib.h>

enum {
  OPTION_TURNTABLE = 0x800,
  OPTION_TURN,
  OPTION_FPS,
  OPTION_PART,
  OPTION_MERGE,
  OPTION_RESUME
};
enum { MOST_AROUND = 9999 };

static const abbe_option options[] = {
    {"turntable", OPTION_TURNTABLE, "N", 0,
     "N frames from all around, numbered: FILE-0001.exr, FILE-0001.png, and FILE.png, .webp or "
     ".gif that moves",
     5, ABBE_TAKE_BY_KEY},
    {"turn", OPTION_TURN, "WHAT", 0,
     "of a turntable: camera, which goes around, or stone, which turns with its metal under lights "
     "and camera that stay (camera)",
     5, ABBE_TAKE_BY_KEY},
    {"part", OPTION_PART, "K/N", 0,
     "only every N-th frame from the K-th on, 0/8 to 7/8, and none that moves", 5,
     ABBE_TAKE_BY_KEY},
    {"resume", OPTION_RESUME, NULL, 0,
     "draw those frames alone whose files are not there, or are of another request", 5,
     ABBE_TAKE_BY_KEY},
    {"merge", OPTION_MERGE, NULL, 0,
     "draw nothing: make FILE.png, .webp or .gif of the numbered frames that are there", 5,
     ABBE_TAKE_BY_KEY},
    {"fps", OPTION_FPS, "F", 0, "frames a second, of time and of the picture that moves (25)", 5,
     ABBE_TAKE_BY_KEY},
    {0}};

/* What says nothing of one picture. */
static void check(const abbe_frame_series *o, struct argp_state *state) {
  const bool asked = o->part.parts > 0 || o->merge || o->resume || o->per_second > 0;
  if (asked && o->count == 0)
    argp_error(state, "--%s goes with --turntable N or --frames A:B",
               o->merge            ? "merge"
               : o->resume         ? "resume"
               : o->per_second > 0 ? "fps"
                                   : "part");
  if (o->piece && !o->around) argp_error(state, "--turn goes with --turntable N");
  if (o->part.parts > 0 && o->part.part >= o->count)
    argp_error(state, "--part %zu/%zu has none of %zu frames", o->part.part, o->part.parts,
               o->count);
  if (o->part.parts > 0 && o->merge)
    argp_error(state, "--part draws frames, and --merge draws nothing");
}

static const char *const turns[] = {"camera", "stone"};

static error_t parse(int key, char *text, struct argp_state *state) {
  abbe_frame_series *o = state->input;
  switch (key) {
  case OPTION_TURNTABLE:
    o->count = abbe_command_count(o->program, "--turntable", text, 2, MOST_AROUND);
    o->first = 1;
    o->around = true;
    return 0;
  case OPTION_TURN:
    o->piece = abbe_command_choice(o->program, "--turn", text, turns, 2) == 1;
    return 0;
  case OPTION_FPS:
    o->per_second = abbe_command_number(o->program, "--fps", text, 0.1, 1000);
    return 0;
  case OPTION_PART:
    abbe_command_read_part(o->program, text, &o->part);
    return 0;
  case OPTION_MERGE:
    o->merge = true;
    return 0;
  case OPTION_RESUME:
    o->resume = true;
    return 0;
  case ARGP_KEY_END:
    check(o, state);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

const abbe_parser abbe_render_frames_argp = {.options = options, .parse = parse};

/* v turned about the unit axis, the right-handed way. */
static void turn(const double v[3], const double axis[3], double rad, double out[3]) {
  const double c = cos(rad), s = sin(rad);
  const double along = v[0] * axis[0] + v[1] * axis[1] + v[2] * axis[2];
  for (int k = 0; k < 3; k++) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    out[k] = v[k] * c + (axis[i] * v[j] - axis[j] * v[i]) * s + axis[k] * along * (1 - c);
  }
}

static abbe_camera camera_at(const abbe_camera *first, double rad) {
  abbe_camera camera = *first;
  double axis[3], from[3], to[3], length = 0;
  for (int k = 0; k < 3; k++) length += first->up[k] * first->up[k];
  for (int k = 0; k < 3; k++) {
    axis[k] = first->up[k] / sqrt(length);
    from[k] = first->eye[k] - first->target[k];
  }
  turn(from, axis, rad, to);
  for (int k = 0; k < 3; k++) camera.eye[k] = first->target[k] + to[k];
  return camera;
}

static abbe_result write_frame(const abbe_render_request *q, const abbe_image *image, size_t number,
                               abbe_error *error) {
  ABBE_FREED char *exr = NULL, *png = NULL;
  abbe_render_request own = *q;
  ABBE_TRY(abbe_frame_series_name(q->exr, number, &exr, error));
  ABBE_TRY(abbe_frame_series_name(q->png, number, &png, error));
  own.png = png;
  if (exr != NULL) ABBE_TRY(abbe_exr_write(exr, image, error));
  if (png != NULL) ABBE_TRY(abbe_render_write_png(&own, image, error));
  return ABBE_OK;
}

/* The scene of a frame: the same with another camera, whose parts are the scene's, or all of it at
 * another time or with the piece turned. */
typedef struct frame_scene {
  abbe_scene scene;
  bool owned;
} frame_scene;

static abbe_result make_scene(const abbe_render_request *q, const abbe_scene *scene, size_t i,
                              frame_scene *out, abbe_error *error) {
  const abbe_frame_series *s = &q->series;
  const double rad = s->around ? 2 * ABBE_PI * (double)i / (double)s->count : 0;
  *out = (frame_scene){.owned = !s->around || s->piece};
  if (s->piece)
    ABBE_TRY(abbe_scene_input_at(scene, q->render.materials, &q->render.changes, scene->time,
                                 &out->scene, error));
  else if (out->owned)
    ABBE_TRY(abbe_frame_series_scene(s, scene, q->render.materials, &q->render.changes, i,
                                     &out->scene, error));
  else
    out->scene = *scene;
  if (!s->piece) {
    if (s->around) out->scene.camera = camera_at(&scene->camera, rad);
    return ABBE_OK;
  }
  /* it shows the sides that a camera shows that goes around the other way */
  return abbe_piece_turn(&out->scene, scene->camera.up, -rad, error);
}

static void free_scene(frame_scene *f) {
  if (f->owned) abbe_scene_free(&f->scene);
  *f = (frame_scene){0};
}

/* *shown: the scene that the renderer holds, which it must until it holds the next. */
static abbe_result draw_frame(const abbe_render_request *q, const abbe_scene *scene,
                              const abbe_render_desc *desc, abbe_renderer *renderer,
                              const abbe_context *context, size_t i, frame_scene shown[2],
                              abbe_statistics *statistics, abbe_error *error) {
  ABBE_OWNED(abbe_image, image) = {0};
  shown[1] = shown[0];
  shown[0] = (frame_scene){0};
  ABBE_TRY(make_scene(q, scene, i, &shown[0], error));
  ABBE_TRY(abbe_renderer_change(renderer, &shown[0].scene, desc, error));
  free_scene(&shown[1]);
  ABBE_TRY(abbe_renderer_frame(renderer, NULL, NULL, statistics, error));
  ABBE_TRY(abbe_renderer_read_blurred(renderer, &shown[0].scene, desc, q->aovs, NULL, NULL, &image,
                                      error));
  ABBE_TRY(abbe_render_annotate(q, renderer, context, &image, error));
  ABBE_TRY(abbe_frame_series_mark(&q->series, i, &image, error));
  return write_frame(q, &image, q->series.first + i, error);
}

abbe_result abbe_render_frames_draw(const abbe_render_request *q, const abbe_scene *scene,
                                    const abbe_render_desc *desc, abbe_renderer *renderer,
                                    const abbe_context *context, abbe_statistics *statistics,
                                    abbe_error *error) {
  const abbe_frame_series *s = &q->series;
  abbe_progress progress;
  abbe_render_desc own = *desc;
  frame_scene shown[2] = {{{0}, false}};
  own.progress = NULL;
  own.compiling = NULL;
  abbe_progress_begin(&progress, s->around ? "turntable" : "frames", q->quiet);
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < s->count && result == ABBE_OK; i++) {
    if (!abbe_frame_series_draws(s, i, q->exr, q->png)) continue;
    result = draw_frame(q, scene, &own, renderer, context, i, shown, statistics, error);
    if (!abbe_progress_update(&progress, (double)(i + 1) / (double)s->count) && result == ABBE_OK &&
        i + 1 < s->count)
      result = abbe_error_set(error, ABBE_CANCELLED,
                              "stopped after %zu of %zu frames; --resume goes on", i + 1, s->count);
  }
  abbe_progress_end(&progress);
  if (result == ABBE_OK && q->png != NULL && s->part.parts == 0)
    result = abbe_frame_series_merge(s, q->png, error);
  /* the renderer is not to look at a scene that is gone */
  abbe_error ignored = {0};
  const abbe_result back = abbe_renderer_change(renderer, scene, &own, &ignored);
  if (result == ABBE_OK && back != ABBE_OK)
    result = abbe_error_set(error, back, "%s", ignored.text);
  for (int k = 0; k < 2; k++) free_scene(&shown[k]);
  return result;
}
