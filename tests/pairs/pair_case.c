#include "tests/pairs/pair_case.h"

#include "cli/view/work/view_worker.h"
#include "gl/renderer.h"
#include "scenes/import/scene_file.h"
#include "validation/lab/volume_fill.h"
#include "validation/trace/tracer/tracer.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const size_t pair_levels[COVER_FACTORS] = {PAIR_STONES, PAIR_COMPANIES, PAIR_TRANSPORTS,
                                           PAIR_STAGES};
static const char *const stones[] = {"diamond", "ruby", "emerald"};
static const char *const companies[] = {"alone", "ball", "mirror", "ring", "haze", "water"};
static const char *const transports[] = {"default", "layers", "pinhole", "volume"};
static const char *const stages[] = {"moving", "balanced", "accurate"};
enum { LAYERS = 1, PINHOLE, VOLUME };
enum { BALL = 1, MIRROR, RING, HAZE, WATER };

static const abbe_view_stage viewed[] = {ABBE_VIEW_MOVING, ABBE_VIEW_BALANCED, ABBE_VIEW_ACCURATE};

const char *const pair_region_name[PAIR_REGIONS] = {"stone", "caustic"};
/* Left, top, right, bottom: the first pixel and one past the last. In water light is bent less, and
 * falls nearer to the stone. */
static const size_t stone_region[4] = {14, 14, 38, 32}, caustic_region[4] = {12, 43, 34, 53},
                    water_region[4] = {12, 36, 36, 50};

const pair_refusal pair_refusals[] = {
    {MIRROR, LAYERS, "the model 'layers' follows no light off mirrors"},
    {RING, LAYERS, "the model 'layers' follows no light off mirrors"},
    {WATER, LAYERS, "the model 'layers' takes each refractor as if it stood in air alone"},
    {HAZE, PINHOLE, "take the transport 'photons'"},
    {HAZE, VOLUME, "take the transport 'photons'"},
    {BALL, VOLUME, "a volume holds the caustics of one object alone"},
    {MIRROR, VOLUME, "a volume holds the caustics of one object alone"},
    {RING, VOLUME, "a volume holds the caustics of one object alone"},
    {WATER, VOLUME, "a volume holds the caustics of one object alone"},
};
const size_t pair_refusal_count = sizeof pair_refusals / sizeof *pair_refusals;

const char *pair_level_name(size_t factor, size_t level) {
  return factor == PAIR_STONE       ? stones[level]
         : factor == PAIR_COMPANY   ? companies[level]
         : factor == PAIR_TRANSPORT ? transports[level]
                                    : stages[level];
}

bool pair_can(const cover_row *row) {
  for (size_t i = 0; i < pair_refusal_count; i++)
    if (pair_refusals[i].company == row->level[PAIR_COMPANY] &&
        pair_refusals[i].transport == row->level[PAIR_TRANSPORT])
      return false;
  return true;
}

abbe_result pair_scene(size_t stone, size_t company, abbe_scene *out, abbe_error *error) {
  char path[1024], material[64];
  const char *const set[] = {material};
  const abbe_scene_options options = {.set = set, .set_count = 1};
  snprintf(path, sizeof path, ABBE_SOURCE_DIR "/tests/pairs/%s.yaml", companies[company]);
  snprintf(material, sizeof material, "objects.stone.material=%s", stones[stone]);
  return abbe_scene_load(path, &options, out, error);
}

/* What a stone sends to the space around it, alone; the sun stands at one of the volume's nodes. A
 * coarse one is refused by the same scenes. */
static abbe_result fill(size_t stone, bool coarse, abbe_caustic_volume *out, abbe_error *error) {
  const abbe_volume_fill_desc desc = {.nodes = 12,
                                      .region = {.kind = ABBE_REGION_OCTAHEDRAL,
                                                 .shells = coarse ? 4 : 24,
                                                 .side = coarse ? 8 : 48},
                                      .photons = coarse ? 64 : 1 << 16,
                                      .passes = 1};
  abbe_volume_fill_statistics statistics;
  abbe_scene alone;
  abbe_result result = pair_scene(stone, 0, &alone, error);
  if (result != ABBE_OK) return result;
  result = abbe_volume_fill(&alone, &desc, out, &statistics, error);
  abbe_scene_free(&alone);
  return result;
}

/* So many times as many pixels, a side, by stage. What moves has a sample for 4 x 4 of them, the
 * most it ever has. What rests is held by the light of 16 or 4 pixels each, for a stone's facets
 * are no larger than one. */
static const size_t sides[] = {ABBE_VIEW_EYE_STEPS, 4, 2};

/* As the viewer asks for it. */
static abbe_result request(const abbe_scene *scene, const cover_row *row,
                           const abbe_caustic_volume *volume, abbe_render_desc *out,
                           abbe_error *error) {
  const abbe_view_document document = {0};
  const abbe_view_stage stage = viewed[row->level[PAIR_STAGE]];
  const bool moving = stage == ABBE_VIEW_MOVING;
  const abbe_view_job job = {
      .stage = stage, .light = stage, .eye_step = moving ? ABBE_VIEW_EYE_STEPS - 1 : 0};
  const size_t side = PAIR_SIDE * sides[row->level[PAIR_STAGE]];
  const abbe_preset_front none = {0}, *front = &none;
  abbe_presets presets;
  abbe_plan plan;
  abbe_result result = abbe_presets_load(NULL, &presets, error);
  if (result != ABBE_OK) return result;
  result = abbe_plan_make(scene, NULL, &plan, error);
  if (result == ABBE_OK) {
    if (abbe_presets_find(&presets, &plan, &front, NULL) != ABBE_OK) front = &none;
    *out = abbe_view_settings_of(front, scene, &job, &document, volume);
    out->width = out->height = side;
    out->space = ABBE_RGB_SPACE_XYZ;
    if (row->level[PAIR_TRANSPORT] == LAYERS) out->model = ABBE_MODEL_LAYERS;
    if (row->level[PAIR_TRANSPORT] == PINHOLE) out->transport = ABBE_TRANSPORT_PINHOLE;
    if (row->level[PAIR_TRANSPORT] == VOLUME) out->transport = ABBE_TRANSPORT_VOLUME;
    abbe_plan_free(&plan);
  }
  abbe_presets_free(&presets);
  return result;
}

/* Means of a picture's region, and the errors that they would have if its pixels were random
 * samples. */
static void measure_region(const abbe_image *image, const size_t region[4], double xyz[3],
                           double *error, double ratio_error[2]) {
  static const char *const names[] = {"X", "Y", "Z"};
  const size_t times = image->width / PAIR_SIDE;
  const size_t r[4] = {times * region[0], times * region[1], times * region[2], times * region[3]};
  const double pixels = (double)((r[2] - r[0]) * (r[3] - r[1]));
  size_t channel[3];
  double squares[3] = {0};
  for (size_t c = 0; c < 3; c++) channel[c] = abbe_image_find_channel(image, names[c]), xyz[c] = 0;
  for (size_t pass = 0; pass < 2; pass++)
    for (size_t y = r[1]; y < r[3]; y++)
      for (size_t x = r[0]; x < r[2]; x++) {
        const float *v = &image->data[(y * image->width + x) * image->channels];
        for (size_t c = 0; c < 3; c++) {
          const double is = (double)v[channel[c]], light = (double)v[channel[1]];
          if (pass == 0) xyz[c] += is / pixels;
          /* off the mean light, or off the light that the mean colour has */
          else
            squares[c] += pow(is - (c == 1 ? xyz[1] : light * xyz[c] / xyz[1]), 2);
        }
      }
  for (size_t c = 0; c < 3; c++) squares[c] = sqrt(squares[c] / (pixels * (pixels - 1))) / xyz[1];
  *error = squares[1];
  ratio_error[0] = squares[0];
  ratio_error[1] = squares[2];
}

static void measure(const abbe_image *image, size_t company, pair_light *out) {
  measure_region(image, stone_region, out->xyz[0], &out->error[0], out->ratio_error[0]);
  measure_region(image, company == WATER ? water_region : caustic_region, out->xyz[1],
                 &out->error[1], out->ratio_error[1]);
}

/* A row's scene, its volume if it takes one, and the request. */
typedef struct parts {
  abbe_scene scene;
  abbe_caustic_volume volume;
  abbe_render_desc desc;
} parts;

static void free_parts(parts *p) {
  abbe_scene_free(&p->scene);
  abbe_caustic_volume_free(&p->volume);
}

static abbe_result make_parts(const cover_row *row, bool coarse, parts *out, abbe_error *error) {
  const bool looks_up = row->level[PAIR_TRANSPORT] == VOLUME;
  *out = (parts){0};
  abbe_result result =
      pair_scene(row->level[PAIR_STONE], row->level[PAIR_COMPANY], &out->scene, error);
  if (result == ABBE_OK && looks_up)
    result = fill(row->level[PAIR_STONE], coarse, &out->volume, error);
  if (result == ABBE_OK)
    result = request(&out->scene, row, looks_up ? &out->volume : NULL, &out->desc, error);
  return result;
}

abbe_result pair_plan(const cover_row *row, abbe_plan *out, abbe_error *error) {
  parts p;
  *out = (abbe_plan){0};
  abbe_result result = make_parts(row, true, &p, error);
  if (result == ABBE_OK) result = abbe_plan_make(&p.scene, &p.desc, out, error);
  free_parts(&p);
  return result;
}

abbe_result pair_draw(abbe_context *context, const cover_row *row, pair_light *out,
                      abbe_error *error) {
  parts p;
  abbe_renderer *renderer = NULL;
  abbe_image image = {0};
  *out = (pair_light){0};
  abbe_result result = make_parts(row, false, &p, error);
  if (result == ABBE_OK) result = abbe_renderer_make(context, &p.scene, &p.desc, &renderer, error);
  if (result == ABBE_OK) result = abbe_renderer_frame(renderer, NULL, NULL, NULL, error);
  if (result == ABBE_OK) result = abbe_renderer_read(renderer, false, &image, error);
  if (result == ABBE_OK && (image.width % PAIR_SIDE != 0 || image.height != image.width))
    result = abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the picture has %zu x %zu samples",
                            image.width, image.height);
  if (result == ABBE_OK) measure(&image, row->level[PAIR_COMPANY], out);
  abbe_image_free(&image);
  abbe_renderer_free(renderer);
  free_parts(&p);
  return result;
}

enum { TRACES = 8, PASSES = 8 };

static abbe_result trace_once(const abbe_scene *scene, size_t company, uint32_t seed,
                              pair_light *out, abbe_error *error) {
  const abbe_trace_desc desc = {.no_map = true,
                                .width = PAIR_SIDE,
                                .height = PAIR_SIDE,
                                .space = ABBE_RGB_SPACE_XYZ,
                                /* below a stone in water is its caustic: hue of few photons */
                                .photons = company == WATER ? 1 << 18 : 1 << 16,
                                .seed = seed};
  abbe_tracer *tracer = NULL;
  abbe_image image = {0};
  abbe_result result = abbe_tracer_make(scene, &desc, &tracer, error);
  for (size_t i = 0; i < PASSES && result == ABBE_OK; i++)
    result = abbe_tracer_pass(tracer, NULL, error);
  if (result == ABBE_OK) result = abbe_tracer_picture(tracer, &image, error);
  if (result == ABBE_OK) measure(&image, company, out);
  abbe_image_free(&image);
  abbe_tracer_free(tracer);
  return result;
}

/* The mean of so many values and its standard error. */
static double mean_of(const double value[TRACES], double *error) {
  double sum = 0, squares = 0;
  for (size_t i = 0; i < TRACES; i++) sum += value[i];
  for (size_t i = 0; i < TRACES; i++) squares += pow(value[i] - sum / TRACES, 2);
  *error = sqrt(squares / (TRACES * (TRACES - 1)));
  return sum / TRACES;
}

abbe_result pair_trace(size_t stone, size_t company, pair_light *out, abbe_error *error) {
  pair_light each[TRACES];
  abbe_scene scene;
  abbe_result result = pair_scene(stone, company, &scene, error);
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < TRACES && result == ABBE_OK; i++)
    result = trace_once(&scene, company, (uint32_t)i + 1, &each[i], error);
  abbe_scene_free(&scene);
  if (result != ABBE_OK) return result;
  for (size_t k = 0; k < PAIR_REGIONS; k++) {
    double value[3][TRACES], ratio[2][TRACES], unused;
    for (size_t i = 0; i < TRACES; i++) {
      const double *xyz = each[i].xyz[k];
      for (size_t c = 0; c < 3; c++) value[c][i] = xyz[c];
      for (size_t c = 0; c < 2; c++) ratio[c][i] = xyz[2 * c] / xyz[1];
    }
    for (size_t c = 0; c < 3; c++) out->xyz[k][c] = mean_of(value[c], &unused);
    for (size_t c = 0; c < 2; c++) mean_of(ratio[c], &out->ratio_error[k][c]);
    mean_of(value[1], &out->error[k]);
    out->error[k] /= out->xyz[k][1];
  }
  return ABBE_OK;
}
