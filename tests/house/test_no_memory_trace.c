/* Every allocation failing in turn: the tracer and its checkpoints, caustic volumes, comparisons,
 * outlines. */
#include "tests/faults/operations.h"
#include "tests/fontconfig.h"

#include "base/file.h"
#include "scenes/export/pov_file.h"
#include "scenes/import/scene_file.h"
#include "validation/lab/known/known_answers.h"
#include "validation/lab/known/known_light.h"
#include "validation/lab/volume_fill.h"
#include "validation/measure/compare.h"
#include "validation/measure/file_comparison.h"
#include "validation/trace/denoise.h"
#include "validation/trace/tracer/checkpoint.h"

#define FUZZ ABBE_SOURCE_DIR "/tests/fuzz/"

static const char scene_text[] =
    "materials: table.yaml\n"
    "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05], size: [3, 2]}\n"
    "lights:\n- {name: lamp, kind: point, position: [0.05, 0.03, 0.6], intensity: 1}\n"
    "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, texture: dot.png}\n"
    "- {name: ball, shape: sphere, radius: 0.05, levels: 1, transform: [{translate: [0.2, 0, "
    "0.2]}],\n   material: smoke}\n"
    "- {name: brick, shape: box, size: [0.1, 0.08, 0.06], transform: [{translate: [0, 0, 0.2]}],\n"
    "   material: crown}\n";

static abbe_result parse_scene(abbe_scene *scene, abbe_error *error) {
  return abbe_scene_parse(scene_text, sizeof scene_text - 1, FUZZ "parts/f.yaml", NULL, scene,
                          error);
}

static const abbe_trace_desc tiny = FIELDS(.width = 3, .height = 2, .map_width = 4, .map_height = 4,
                                           .photons = 64, .bands = 2, .guides = true, .threads = 1);

static void digest_image(const abbe_image *image) {
  digest(image->data, image->width * image->height * image->channels * sizeof *image->data);
  for (size_t i = 0; i < image->channels; i++) digest_text(image->channel[i]);
  for (size_t i = 0; i < image->attribute_count; i++) digest_text(image->attribute[i].text);
}

/* Made once: what is under test begins after it. */
static abbe_scene shared;

static abbe_result trace(abbe_error *error) {
  abbe_tracer *tracer = NULL;
  OWNED(abbe_image, picture) = {0}, map = {0}, filtered = {0};
  abbe_result result = abbe_tracer_make(&shared, &tiny, &tracer, error);
  for (int i = 0; i < 2 && result == ABBE_OK; i++) result = abbe_tracer_pass(tracer, NULL, error);
  if (result == ABBE_OK) result = abbe_tracer_picture(tracer, &picture, error);
  if (result == ABBE_OK) result = abbe_tracer_map(tracer, &map, error);
  if (result == ABBE_OK)
    result = abbe_denoise_picture(&picture, &(abbe_denoise_desc){.threads = 1}, &filtered, error);
  if (result == ABBE_OK) digest_image(&picture);
  if (result == ABBE_OK) digest_image(&map);
  if (result == ABBE_OK) digest_image(&filtered);
  abbe_tracer_free(tracer);
  return result;
}

static abbe_tracer *traced;

static abbe_result checkpoint(abbe_error *error) {
  const char *path = operation_path("trace.checkpoint");
  abbe_result result = abbe_checkpoint_save(traced, path, error);
  if (result == ABBE_OK) result = abbe_checkpoint_load(traced, path, error);
  return result;
}

/* Of what was saved before anything failed, for a merge that fails leaves no pass. */
static abbe_result merge(abbe_error *error) {
  const char *path = operation_path("part.checkpoint");
  return abbe_checkpoint_merge(traced, &path, 1, NULL, error);
}

/* ---- caustic volumes ---- */

static void digest_volume(const abbe_caustic_volume *v) {
  const abbe_light_exits *e = &v->exits;
  if (v->kind == ABBE_VOLUME_EXITS) {
    digest(&e->points, sizeof e->points);
    digest(e->exit, e->count * sizeof *e->exit);
  } else {
    digest(v->value,
           v->nodes.count * v->region.cells * abbe_caustic_volume_channels(v) * sizeof *v->value);
  }
}

/* Filled with a checkpoint after each node, written, and read again. */
static abbe_result volume_of(const abbe_volume_fill_desc *desc, abbe_error *error) {
  const char *path = operation_path("volume.exr");
  OWNED(abbe_caustic_volume, volume) = {0};
  OWNED(abbe_caustic_volume, back) = {0};
  abbe_volume_fill_statistics done;
  abbe_volume_fill_desc own = *desc;
  own.checkpoint = operation_path("volume.checkpoint");
  abbe_result result = abbe_volume_fill(&shared, &own, &volume, &done, error);
  if (result == ABBE_OK) result = abbe_volume_file_write(path, &volume, error);
  if (result == ABBE_OK) result = abbe_volume_file_read(path, &back, error);
  if (result == ABBE_OK) digest_volume(&volume);
  if (result == ABBE_OK) digest_volume(&back);
  return result;
}

static abbe_result volume_values(abbe_error *error) {
  return volume_of(&(abbe_volume_fill_desc){.object = 2,
                                            .kind = ABBE_VOLUME_PRINTED,
                                            .nodes = 12,
                                            .region = {.kind = ABBE_REGION_GRID, .side = 2},
                                            .photons = 64,
                                            .passes = 2,
                                            .threads = 1},
                   error);
}

static abbe_result volume_exits(abbe_error *error) {
  return volume_of(&(abbe_volume_fill_desc){.object = 2,
                                            .nodes = 12,
                                            .exits = 8,
                                            .region = {.kind = ABBE_REGION_GRID, .side = 2},
                                            .threads = 1},
                   error);
}

/* ---- comparisons ---- */

static abbe_result make_picture(int which, abbe_image *out, abbe_error *error) {
  static const char *const names[] = {"R",        "G",         "B",         "stderr.R", "stderr.G",
                                      "stderr.B", "caustic.R", "caustic.G", "caustic.B"};
  abbe_result result = abbe_image_make(8, 8, 9, names, out, error);
  for (size_t i = 0; i < 8 * 8 * 9 && result == ABBE_OK; i++)
    out->data[i] = (float)((i * 7 + (size_t)which) % 11 + 1) * 0.125f;
  return result == ABBE_OK ? abbe_image_set_attribute(out, "abbe:space", "acescg", error) : result;
}

static abbe_result compare(abbe_error *error) {
  abbe_image image[2] = {{0}, {0}};
  abbe_field field[2] = {{0}, {0}};
  OWNED(abbe_mask, mask) = {0};
  OWNED(abbe_comparison, comparison) = {0};
  abbe_result result = ABBE_OK;
  for (int i = 0; i < 2 && result == ABBE_OK; i++) {
    result = make_picture(i, &image[i], error);
    if (result == ABBE_OK) result = abbe_field_make(&image[i], "it", &field[i], error);
  }
  if (result == ABBE_OK) result = abbe_field_align(&field[0], "a", &field[1], "b", error);
  if (result == ABBE_OK) result = abbe_mask_make_caustic(&field[0], "a", 0.9, &mask, error);
  const abbe_compare_options options = {.mask = &mask};
  if (result == ABBE_OK) result = abbe_compare(&field[0], &field[1], &options, &comparison, error);
  for (int m = 0; m < ABBE_COMPARE_METRIC_COUNT && result == ABBE_OK; m++)
    digest(&comparison.mask.metric[m].value, sizeof(double));
  if (result == ABBE_OK)
    result = abbe_difference_picture_write(operation_path("difference.png"), &field[0], &field[1],
                                           1, 1, "it", error);
  for (int i = 0; i < 2; i++) {
    abbe_field_free(&field[i]);
    abbe_image_free(&image[i]);
  }
  return result;
}

static abbe_result pov(abbe_error *error) {
  const char *path = operation_path("scene.pov");
  FREED char *text = NULL;
  size_t size = 0;
  abbe_scene plain = shared; /* a scene for POV-Ray has no textures */
  abbe_object objects[3];
  memcpy(objects, shared.object, sizeof objects);
  memset(&objects[0].texture, 0, sizeof objects[0].texture);
  plain.object = objects;
  abbe_result result = abbe_pov_file_write(path, &plain, NULL, error);
  if (result == ABBE_OK) result = abbe_file_read(path, 1 << 20, &text, &size, error);
  if (result == ABBE_OK) digest(text, size);
  return result;
}

static abbe_result known(abbe_error *error) {
  const abbe_known_options options = {.only = "slab", .threads = 1};
  OWNED(abbe_known_answers, answers) = {0};
  abbe_result result = abbe_known_answers_make(&options, &answers, error);
  if (result == ABBE_OK) digest(&answers.count, sizeof answers.count);
  if (result == ABBE_OK)
    result = abbe_known_chart_write(operation_path("known.svg"), &answers, error);
  return result;
}

static void setup(void) {
  abbe_error error = {0};
  operation_setup();
  if (parse_scene(&shared, &error) == ABBE_OK &&
      abbe_tracer_make(&shared, &tiny, &traced, &error) == ABBE_OK &&
      abbe_tracer_pass(traced, NULL, &error) == ABBE_OK &&
      abbe_checkpoint_save(traced, operation_path("part.checkpoint"), &error) == ABBE_OK)
    return;
  fprintf(stderr, "%s\n", error.text);
  fail();
}

static void teardown(void) {
  abbe_tracer_free(traced);
  abbe_scene_free(&shared);
  operation_teardown();
}

GROUP(setup, teardown);

TEST(traces) {
  static const operation list[] = {
      {"trace", trace, 20}, {"checkpoint", checkpoint, 0}, {"merge", merge, 0}};
  operation_check_all(list, sizeof list / sizeof *list);
}

TEST(caustic_volumes) {
  static const operation list[] = {{"volume", volume_values, 60},
                                   {"volume of rays", volume_exits, 12}};
  operation_check_all(list, sizeof list / sizeof *list);
}

TEST(comparisons) {
  static const operation list[] = {
      {"compare", compare, 0}, {"POV-Ray scene", pov, 0}, {"known answers", known, 6}};
  operation_check_all(list, sizeof list / sizeof *list);
}
