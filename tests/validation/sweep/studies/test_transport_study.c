/* Ways for light side by side: slopes and fronts by hand, and what is measured of a ball's. */
#include "tests/gl/frame.h"

#include "validation/sweep/studies/transport_study.h"

#include <unistd.h>

GROUP(make_context, free_context);

TEST(what_pays_and_fronts) {
  static abbe_transport_study s;
  /* moved_ms, caustic_de, bytes, precompute_s; the second is better than the third in all */
  static const double rows[4][4] = {
      {500, 0.7, NAN, NAN}, {100, 1, 1e6, 4.1}, {120, 2, 2e6, 1}, {600, 3, 5e5, 10}};
  static const double frame_ms[4] = {400, 50, 60, 40}, without_ms = 40;
  s.count = 4;
  for (size_t i = 0; i < 4; i++) {
    for (int k = 0; k < ABBE_TRANSPORT_NUMBER_COUNT; k++) s.row[i].number[k] = NAN;
    s.row[i].number[ABBE_TRANSPORT_MOVED_MS_NUMBER] = rows[i][0];
    s.row[i].number[ABBE_TRANSPORT_CAUSTIC_DE_NUMBER] = rows[i][1];
    s.row[i].number[ABBE_TRANSPORT_BYTES_MEMORY_NUMBER] = rows[i][2];
    s.row[i].number[ABBE_TRANSPORT_PRECOMPUTE_S_NUMBER] = rows[i][3];
    s.row[i].number[ABBE_TRANSPORT_FRAME_MS_NUMBER] = frame_ms[i];
    s.row[i].number[ABBE_TRANSPORT_NONE_MS_NUMBER] = without_ms;
  }
  abbe_transport_study_judge(&s);
  assert_near(s.row[0].number[ABBE_TRANSPORT_OVER_NONE_NUMBER], 9, 1e-12);
  assert_near(s.row[1].number[ABBE_TRANSPORT_OVER_NONE_NUMBER], 0.25, 1e-12);
  static const bool on_time[] = {true, true, false, false}, on_bytes[] = {false, true, false, true};
  for (size_t i = 0; i < 4; i++) {
    assert_int_equal(s.row[i].on_time, on_time[i]);
    assert_int_equal(s.row[i].on_bytes, on_bytes[i]);
  }
  assert_near(s.row[1].number[ABBE_TRANSPORT_PAYS_AFTER_NUMBER], 11, 0); /* of 400 ms each */
  assert_near(s.row[2].number[ABBE_TRANSPORT_PAYS_AFTER_NUMBER], 3, 0);
  assert_true(isnan(s.row[3].number[ABBE_TRANSPORT_PAYS_AFTER_NUMBER])); /* slower: never */
  assert_true(isnan(s.row[0].number[ABBE_TRANSPORT_PAYS_AFTER_NUMBER]));
}

TEST(slopes) {
  static abbe_transport_study s;
  s.count = 4;
  for (size_t i = 0; i < 4; i++) {
    const double samples = pow(4, (double)i);
    s.row[i].contestant.render.pinholes = (size_t)samples;
    s.row[i].number[ABBE_TRANSPORT_SAMPLES_NUMBER] = samples;
    s.row[i].number[ABBE_TRANSPORT_LIMIT_RMSE_NUMBER] = 3 / sqrt(samples);
  }
  s.row[3].contestant.render.footprint = ABBE_FOOTPRINT_OFF;
  assert_near(abbe_transport_study_slope(&s, 0), -0.5, 1e-12);
  assert_near(abbe_transport_study_slope(&s, 2), -0.5, 1e-12);
  assert_true(isnan(abbe_transport_study_slope(&s, 3)));
}

TEST(named_contestants) {
  abbe_transport_contestant list[ABBE_TRANSPORT_STUDY_MOST];
  assert_int_equal(abbe_transport_study_contestants("none", list), 0);
  const size_t volumes = abbe_transport_study_contestants("volume", list);
  assert_true(volumes > 10 && volumes <= ABBE_TRANSPORT_STUDY_MOST);
  assert_int_equal(list[0].render.transport, ABBE_TRANSPORT_AUTO);
  assert_false(abbe_transport_looks_up(&list[0]));
  for (size_t i = 1; i < volumes; i++) assert_true(abbe_transport_looks_up(&list[i]));
  const size_t pinholes = abbe_transport_study_contestants("pinhole", list);
  assert_int_equal(pinholes, 1 + 2 * 3);
}

static bool never(void *user, double done) {
  (void)user;
  (void)done;
  return false;
}

#define ORB                                                                                        \
  CAMERA SUN FLOOR                                                                                 \
      "- {name: orb, shape: sphere, radius: 0.1, levels: 3, material: crown, transform: "          \
      "[{translate: [0, 0, 0.15]}]}\n"

TEST(a_ball) {
  OWNED(abbe_scene, scene) = {0};
  OWNED(abbe_image, picture) = {0};
  abbe_error why = {0};
  static abbe_transport_study s;
  size_t refused;
  char folder[] = "/tmp/abbe-test-transports-XXXXXX", file[64];
  assert_non_null(mkdtemp(folder));
  snprintf(file, sizeof file, "%s/v.exr", folder);
  load_text(ORB, &scene);
  const abbe_render_desc photons = {.width = 32, .height = 32, .photons = 48, .aovs = true};
  abbe_renderer *renderer = make_renderer(&scene, &photons);
  draw_frame(renderer);
  read_picture(renderer, true, &picture);
  abbe_renderer_free(renderer);
  const abbe_region_desc grid = {.kind = ABBE_REGION_GRID, .side = 8};
  const size_t most = 40000; /* of 110592 */
  const abbe_transport_contestant list[] = {
      {.render = {.photons = 48}},
      {.render = {.profile = ABBE_PROFILE_WAND2003}}, /* knows no glass */
      {.render = {.transport = ABBE_TRANSPORT_VOLUME},
       .fill = {.nodes = 12, .region = grid, .passes = 1, .photons = 2000}},
      {.render = {.transport = ABBE_TRANSPORT_VOLUME},
       .fill = {.nodes = 12, .region = grid, .passes = 1, .photons = 2000},
       .joined_bytes = most}};
  abbe_sweep sweep = {.context = context, .scene = &scene, .frames = 1, .picture = &picture};
  REFUSED(
      ABBE_CANCELLED, "",
      abbe_transport_study_measure(&sweep, list, 4, file, never, NULL, &s, &refused, NULL, &error));
  OK(abbe_transport_study_measure(&sweep, list, 4, file, NULL, NULL, &s, &refused, &why, &error));
  if (refused > 1) print_message("%s\n", why.text);
  assert_int_equal(s.count, 3);
  assert_int_equal(refused, 1);
  assert_true(why.text[0] != '\0');
  const double *own = s.row[0].number, *n = s.row[1].number;
  assert_near(own[ABBE_TRANSPORT_CAUSTIC_DE_NUMBER], 0, 1e-3); /* it is the reference */
  assert_true(n[ABBE_TRANSPORT_CAUSTIC_DE_NUMBER] > 0.1);
  assert_true(own[ABBE_TRANSPORT_MOVED_MS_NUMBER] > 0 && n[ABBE_TRANSPORT_MOVED_MS_NUMBER] > 0);
  assert_true(own[ABBE_TRANSPORT_POP_NUMBER] > 0 && own[ABBE_TRANSPORT_POP_NUMBER] < 1);
  assert_true(isnan(own[ABBE_TRANSPORT_BYTES_MEMORY_NUMBER]));
  assert_near(n[ABBE_TRANSPORT_BYTES_MEMORY_NUMBER], 2 * 12 * 512 * 9, 0);
  assert_true(n[ABBE_TRANSPORT_BYTES_DISK_NUMBER] > 1000);
  assert_true(n[ABBE_TRANSPORT_BYTES_GPU_NUMBER] > 512 * 20);
  assert_near(n[ABBE_TRANSPORT_NODES_NUMBER], 12, 0);
  assert_near(n[ABBE_TRANSPORT_PHOTONS_NODE_NUMBER], 2000, 0);
  assert_true(n[ABBE_TRANSPORT_NODE_ERROR_NUMBER] > 0 && n[ABBE_TRANSPORT_MID_ERROR_NUMBER] > 0);
  assert_true(isnan(own[ABBE_TRANSPORT_NODE_ERROR_NUMBER]));
  print_message("%g and %g ms, without caustics %g and %g\n", own[ABBE_TRANSPORT_FRAME_MS_NUMBER],
                n[ABBE_TRANSPORT_FRAME_MS_NUMBER], own[ABBE_TRANSPORT_NONE_MS_NUMBER],
                n[ABBE_TRANSPORT_NONE_MS_NUMBER]);
  assert_true(own[ABBE_TRANSPORT_NONE_MS_NUMBER] > 0 && n[ABBE_TRANSPORT_NONE_MS_NUMBER] > 0);
  const double joint = s.row[2].number[ABBE_TRANSPORT_BYTES_MEMORY_NUMBER];
  print_message("%g bytes joined within %g\n", joint, s.row[2].contestant.fill.tolerance);
  assert_true(s.row[2].contestant.fill.joins && joint <= most && joint > 0.7 * most);
  assert_int_not_equal(access(file, F_OK), 0);
  rmdir(folder);
  sweep.picture = NULL;
  REFUSED(
      ABBE_INVALID_ARGUMENT, "",
      abbe_transport_study_measure(&sweep, list, 4, file, NULL, NULL, &s, &refused, NULL, &error));
}
