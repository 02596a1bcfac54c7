/* Settings held against references: errors that are known beforehand. */
#include "tests/gl/frame.h"

#include "library/choice/sweep_setting.h"
#include "validation/sweep/sweep_grid.h"
#include "validation/sweep/sweep_measure.h"
#include "validation/tracer/reference.h"

#define SCENE CAMERA POINT_LIGHT FLOOR BALL("crown")
#define SPOT                                                                                       \
  "lights:\n- {name: lamp, kind: spot, position: [0.05, 0.03, 0.6], direction: [0, 0, -1], "       \
  "intensity: 1, cone: 40}\n"

/* A setting of the default profile, small. */
static abbe_sweep_setting small_setting(const abbe_scene *scene, abbe_profile profile) {
  abbe_sweep_setting *list, setting;
  size_t count, refused;
  const abbe_sweep_grid grid = {.profiles = {1, {(size_t)profile}},
                                .photons = {1, {64}},
                                .map = {1, {128}},
                                .samples = {1, {1}}};
  OK(abbe_sweep_grid_expand(scene, &grid, 1, &list, &count, &refused, NULL, &error));
  assert_int_equal(count, 1);
  setting = list[0];
  free(list);
  return setting;
}

/* The renderer's own picture and map as the reference: no error at all, and a known factor. */
static void own_reference(const abbe_scene *scene, const abbe_sweep_setting *setting,
                          abbe_image *picture, abbe_image *map) {
  abbe_render_desc desc;
  OK(abbe_sweep_setting_desc(setting, &desc, &error));
  desc.width = desc.height = 32;
  desc.aovs = true;
  abbe_renderer *renderer = make_renderer(scene, &desc);
  draw_frame(renderer);
  read_picture(renderer, true, picture);
  read_map(renderer, 0, map);
  abbe_renderer_free(renderer);
}

static abbe_sweep_row measure(const abbe_sweep *sweep, const abbe_sweep_setting *setting) {
  abbe_sweep_row row;
  OK(abbe_sweep_measure(sweep, setting, NULL, NULL, &row, NULL, &error));
  return row;
}

GROUP(make_context, free_context);

TEST(the_same_picture_has_no_error) {
  OWNED(abbe_scene, scene) = {0};
  OWNED(abbe_image, picture);
  OWNED(abbe_image, map);
  load_text(SCENE, &scene);
  abbe_sweep_setting setting = small_setting(&scene, ABBE_PROFILE_DEFAULT);
  own_reference(&scene, &setting, &picture, &map);
  abbe_sweep sweep = {
      .context = context, .scene = &scene, .frames = 3, .picture = &picture, .map = &map};
  abbe_sweep_row row = measure(&sweep, &setting);
  static const abbe_sweep_number none[] = {ABBE_SWEEP_MAP_RMSE,   ABBE_SWEEP_MAP_UV,
                                           ABBE_SWEEP_CAUSTIC_DE, ABBE_SWEEP_CAUSTIC_RMSE,
                                           ABBE_SWEEP_PICTURE_DE, ABBE_SWEEP_PICTURE_RMSE};
  for (size_t i = 0; i < 6; i++) assert_near(row.number[none[i]], 0, 1e-6);
  assert_near(row.number[ABBE_SWEEP_MAP_ENERGY], 1, 1e-6);
  assert_near(row.number[ABBE_SWEEP_SCALE], 1, 0);
  assert_true(row.number[ABBE_SWEEP_FRAME_MS] >= row.number[ABBE_SWEEP_FASTEST_MS]);
  assert_true(row.number[ABBE_SWEEP_FASTEST_MS] > 0);
  assert_true(row.number[ABBE_SWEEP_CAMERA_MS] > 0);
  double parts = row.number[ABBE_SWEEP_LIGHT_MS] + row.number[ABBE_SWEEP_EYE_MS];
  assert_true(row.number[ABBE_SWEEP_LIGHT_MS] > 0 && row.number[ABBE_SWEEP_EYE_MS] > 0);
  assert_true(parts <= row.number[ABBE_SWEEP_FRAME_MS] * 1.01);
  /* A reference of twice the light: the default profile is told so, and not scaled. */
  for (size_t i = 0; i < 128 * 128 * 3; i++) map.data[i] *= 2;
  for (size_t i = 0; i < 32 * 32 * picture.channels; i++) picture.data[i] *= 2;
  row = measure(&sweep, &setting);
  assert_near(row.number[ABBE_SWEEP_MAP_ENERGY], 0.5, 1e-6);
  assert_near(row.number[ABBE_SWEEP_SCALE], 1, 0);
  assert_true(row.number[ABBE_SWEEP_PICTURE_RMSE] > 0.4);
  /* Without a picture and without a map only the other is compared. */
  sweep.picture = NULL;
  row = measure(&sweep, &setting);
  assert_true(isnan(row.number[ABBE_SWEEP_PICTURE_DE]));
  assert_near(row.number[ABBE_SWEEP_MAP_ENERGY], 0.5, 1e-6);
  sweep.map = NULL;
  assert_true(isnan(measure(&sweep, &setting).number[ABBE_SWEEP_MAP_RMSE]));
}

/* The thesis profile against itself, but in another brightness: the best factor finds it back. */
TEST(the_thesis_gets_its_best_brightness) {
  OWNED(abbe_scene, scene) = {0};
  OWNED(abbe_image, picture);
  OWNED(abbe_image, map);
  load_text(CAMERA SPOT FLOOR BALL("crown"), &scene);
  abbe_sweep_setting setting = small_setting(&scene, ABBE_PROFILE_THESIS);
  own_reference(&scene, &setting, &picture, &map);
  for (size_t i = 0; i < 128 * 128 * 3; i++) map.data[i] *= 0.125f;
  for (size_t i = 0; i < 32 * 32 * 3; i++) picture.data[i] *= 4;
  const abbe_sweep sweep = {
      .context = context, .scene = &scene, .frames = 1, .picture = &picture, .map = &map};
  abbe_sweep_row row = measure(&sweep, &setting);
  assert_near(row.number[ABBE_SWEEP_SCALE], 4, 1e-5);
  assert_near(row.number[ABBE_SWEEP_MAP_SCALE], 0.125, 1e-6);
  assert_near(row.number[ABBE_SWEEP_PICTURE_RMSE], 0, 1e-5);
  assert_near(row.number[ABBE_SWEEP_MAP_RMSE], 0, 1e-5);
  assert_near(row.number[ABBE_SWEEP_MAP_ENERGY], 1, 1e-5);
  /* Light only where it has none: no factor helps but 0, and then all of it is missing. */
  for (size_t i = 0; i < 128 * 128; i++) {
    bool dark = map.data[3 * i] == 0 && map.data[3 * i + 1] == 0 && map.data[3 * i + 2] == 0;
    for (size_t c = 0; c < 3; c++) map.data[3 * i + c] = dark ? 1 : 0;
  }
  row = measure(&sweep, &setting);
  assert_near(row.number[ABBE_SWEEP_MAP_SCALE], 0, 0);
  assert_near(row.number[ABBE_SWEEP_MAP_ENERGY], 0, 0);
  assert_true(row.number[ABBE_SWEEP_MAP_RMSE] >= 1);
}

/* The same method in physical units is judged in them, and its fill's light is counted. */
TEST(the_method_in_units_gets_no_factor) {
  OWNED(abbe_scene, scene) = {0};
  OWNED(abbe_image, picture);
  OWNED(abbe_image, map);
  load_text(CAMERA SPOT FLOOR BALL("crown"), &scene);
  abbe_sweep_setting setting = small_setting(&scene, ABBE_PROFILE_THESIS_CIE);
  own_reference(&scene, &setting, &picture, &map);
  abbe_sweep sweep = {
      .context = context, .scene = &scene, .frames = 1, .picture = &picture, .map = &map};
  abbe_sweep_row row = measure(&sweep, &setting);
  assert_near(row.number[ABBE_SWEEP_PICTURE_RMSE], 0, 1e-6);
  assert_near(row.number[ABBE_SWEEP_MAP_ENERGY], 1, 1e-6);
  assert_true(isnan(row.number[ABBE_SWEEP_BASELINE_MS]));
  double added = row.number[ABBE_SWEEP_FILL_INVENTED] - row.number[ABBE_SWEEP_FILL_LOST];
  assert_true(row.number[ABBE_SWEEP_FILL_INVENTED] > 0 && row.number[ABBE_SWEEP_FILL_LOST] > 0);
  /* Without the fill: nothing is added, and the map has that much less. */
  snprintf(setting.fill, sizeof setting.fill, "none");
  row = measure(&sweep, &setting);
  assert_near(row.number[ABBE_SWEEP_FILL_INVENTED], 0, 0);
  assert_near(row.number[ABBE_SWEEP_FILL_LOST], 0, 0);
  assert_near(row.number[ABBE_SWEEP_MAP_ENERGY] * (1 + added), 1, 1e-4);
  /* Against twice the light it stays what it is. */
  for (size_t i = 0; i < 32 * 32 * 3; i++) picture.data[i] *= 2;
  row = measure(&sweep, &setting);
  assert_near(row.number[ABBE_SWEEP_SCALE], 1, 0);
  assert_true(row.number[ABBE_SWEEP_PICTURE_RMSE] > 0.4);
  /* The default profile's bridge adds nothing: its ledger closes. */
  setting = small_setting(&scene, ABBE_PROFILE_DEFAULT);
  sweep.picture = sweep.map = NULL;
  row = measure(&sweep, &setting);
  assert_near(row.number[ABBE_SWEEP_FILL_INVENTED], 0, 1e-4);
  assert_near(row.number[ABBE_SWEEP_FILL_LOST], 0, 1e-4);
}

/* Of a still scene the fourth frame is the mean of four grids, and stays; held against itself it
 * has no error, and the frames before have. */
TEST(frames_come_together) {
  OWNED(abbe_scene, scene) = {0};
  OWNED(abbe_image, picture);
  abbe_render_desc desc;
  load_text(CAMERA SPOT FLOOR BALL("flat"), &scene);
  abbe_sweep_setting setting = small_setting(&scene, ABBE_PROFILE_DEFAULT);
  setting.history = 4;
  OK(abbe_sweep_setting_desc(&setting, &desc, &error));
  desc.width = desc.height = 32;
  desc.aovs = true;
  abbe_renderer *renderer = make_renderer(&scene, &desc);
  for (int k = 0; k < 4; k++) {
    abbe_renderer_redraw(renderer);
    draw_frame(renderer);
  }
  read_picture(renderer, true, &picture);
  abbe_renderer_free(renderer);
  const abbe_sweep sweep = {.context = context, .scene = &scene, .frames = 4, .picture = &picture};
  const abbe_sweep_row row = measure(&sweep, &setting);
  const double *n = row.number;
  print_message("%.3g, %.3g, %.3g, %.3g\n", n[ABBE_SWEEP_AFTER_1], n[ABBE_SWEEP_AFTER_2],
                n[ABBE_SWEEP_AFTER_4], n[ABBE_SWEEP_AFTER_8]);
  assert_true(n[ABBE_SWEEP_AFTER_1] > 0.02 && n[ABBE_SWEEP_AFTER_2] < n[ABBE_SWEEP_AFTER_1]);
  assert_true(n[ABBE_SWEEP_AFTER_2] > 0.2 * n[ABBE_SWEEP_AFTER_1]);
  assert_near(n[ABBE_SWEEP_AFTER_4], 0, 1e-4);
  assert_near(n[ABBE_SWEEP_AFTER_8], 0, 1e-3);
  assert_near(n[ABBE_SWEEP_CAUSTIC_DE], 0, 1e-3);
}

static bool never(void *user, double done) {
  (void)user;
  (void)done;
  return false;
}

/* Against a traced reference: the numbers are there with their noise, maps of other sizes too. */
TEST(against_a_traced_reference) {
  OWNED(abbe_scene, scene) = {0};
  abbe_image picture, map, drawn;
  abbe_map_layout layout;
  load_text(SCENE, &scene);
  OK(abbe_sweep_fit_layout(context, &scene, 0, &layout, &error));
  /* What the renderer models and no more, so that what is left is sampling. */
  const abbe_reference_desc desc = {.trace = {.physics = {true, 8, 0.01},
                                              .width = 32,
                                              .height = 32,
                                              .map_width = 64,
                                              .map_height = 64,
                                              .layout = &layout,
                                              .photons = 1 << 16,
                                              .threads = 2},
                                    .passes = 4};
  OK(abbe_reference_trace(&scene, &desc, &picture, &map, &error));
  /* The same against itself: the model leaves out nothing. */
  const abbe_sweep sweep = {.context = context,
                            .scene = &scene,
                            .frames = 1,
                            .picture = &picture,
                            .map = &map,
                            .matched_picture = &picture,
                            .matched_map = &map};
  abbe_sweep_model model;
  OK(abbe_sweep_model_measure(&sweep, &model, &error));
  assert_near(model.de, 0, 1e-6);
  assert_near(model.energy, 1, 1e-9);
  assert_true(model.map_noise > 0);
  abbe_sweep_setting setting = small_setting(&scene, ABBE_PROFILE_DEFAULT);
  static const size_t sides[] = {128, 96, 32}; /* summed down, resampled, and coarser */
  for (size_t i = 0; i < 3; i++) {
    setting.map = sides[i];
    abbe_sweep_row row = measure(&sweep, &setting);
    for (int k = ABBE_SWEEP_MAP_RMSE; k < ABBE_SWEEP_MATCHED_DE; k++)
      if (k != ABBE_SWEEP_MAP_BANDS && k != ABBE_SWEEP_MAP_BANDS_NOISE)
        assert_true(isfinite(row.number[k]));
    assert_near(row.number[ABBE_SWEEP_MATCHED_DE], row.number[ABBE_SWEEP_CAUSTIC_DE], 1e-9);
    assert_near(row.number[ABBE_SWEEP_MATCHED_MAP], row.number[ABBE_SWEEP_MAP_RMSE], 1e-9);
    assert_true(row.number[ABBE_SWEEP_MAP_RMSE_NOISE] > 0);
    assert_near(row.number[ABBE_SWEEP_MAP_ENERGY], 1, 0.02);
    assert_true(row.number[ABBE_SWEEP_CAUSTIC_DE] < 10);
  }
  abbe_sweep_row row;
  REFUSED(ABBE_CANCELLED, "",
          abbe_sweep_measure(&sweep, &setting, never, NULL, &row, &drawn, &error));
  assert_null(drawn.data);
  OK(abbe_sweep_measure(&sweep, &setting, NULL, NULL, &row, &drawn, &error));
  assert_int_equal(drawn.width, 32);
  abbe_image_free(&drawn);
  abbe_image_free(&picture);
  abbe_image_free(&map);
}

TEST(a_scene_without_refractors_has_no_map) {
  OWNED(abbe_scene, scene) = {0};
  abbe_map_layout layout;
  load_text(CAMERA POINT_LIGHT FLOOR, &scene);
  REFUSED(ABBE_UNSUPPORTED, "no refractor",
          abbe_sweep_fit_layout(context, &scene, 0, &layout, &error));
}
