/* Volumes filled by photons against what is known: a plate's beams, a ball under the tracer, a beam
 * through nothing, flux that every shell has. */
#include "tests/check.h"

#include "base/maths.h"
#include "scenes/view/view.h"
#include "scenes/volume/half.h"
#include "tests/scenes/scene_text.h"
#include "tests/validation/lab/filled_volume.h"
#include "validation/lab/exit_fill.h"

#define PLATE(material)                                                                            \
  CAMERA SUN FLOOR "- {name: plate, shape: box, size: [0.2, 0.2, 0.02], material: " material       \
                   ", transform: [{translate: [0.1, 0, 0.5]}]}\n"
#define ORB(material)                                                                              \
  CAMERA SUN FLOOR "- {name: orb, shape: sphere, radius: 0.05, levels: 4, material: " material     \
                   ", transform: [{translate: [0, 0, 0.2]}]}\n"

static double value_at(const abbe_caustic_volume *v, size_t node, size_t cell, size_t channel) {
  return abbe_half_value(v->value[(node * v->region.cells + cell) * 9 + channel]);
}

/* Light straight down on a plate of n = 1.5: 2 n / (n^2 + 1) of it goes on through all reflections
 * inside, and the rest goes back; in the plate's own cells nothing is asked. */
TEST(a_plate_has_two_beams) {
  abbe_volume_fill_statistics done;
  OWNED(abbe_scene, scene) = scene_of(PLATE("flat"));
  const abbe_volume_fill_desc desc =
      FIELDS(.object = 1, .nodes = 1, .region = {.kind = ABBE_REGION_GRID, .side = 16},
             .photons = 1 << 16, .passes = 4, .threads = 2);
  FILLED(abbe_caustic_volume, v, fill_volume(&scene, &desc, &v, &done));
  const double through = 2 * 1.5 / (1.5 * 1.5 + 1);
  size_t seen = 0;
  for (size_t cell = 0; cell < v.region.cells; cell++) {
    double p[3];
    const double half = v.region.desc.outer / 16;
    abbe_volume_region_middle(&v.region, cell, p);
    const bool in_beam = fabs(p[0]) + half < 0.1 && fabs(p[1]) + half < 0.1;
    const bool beside = fabs(p[0]) - half > 0.1 || fabs(p[1]) - half > 0.1;
    const double beam = p[2] + half < -0.01 ? through : p[2] - half > 0.01 ? through - 1 : NAN;
    if (isnan(beam)) continue;
    for (size_t c = 0; c < 9; c++) {
      const double white = c / 3 == 1 ? 1 : v.white[c / 3];
      if (in_beam) assert_near(value_at(&v, 0, cell, c), c % 3 == 2 ? -beam * white : 0, 0.02);
      if (beside) assert_near(value_at(&v, 0, cell, c), 0, 1e-6);
    }
    seen += in_beam;
  }
  assert_true(seen > 50);
  /* all that met it came out again */
  assert_near(done.ledger.missed / done.ledger.reached, 1, 1e-5);
}

/* Through an index of 1 the beam goes on as it was, in the object's shadow alone. */
TEST(index_one_is_a_beam) {
  abbe_volume_fill_statistics done;
  OWNED(abbe_scene, scene) = scene_of(ORB("air"));
  const abbe_volume_fill_desc desc =
      FIELDS(.object = 1, .nodes = 12, .region = {.kind = ABBE_REGION_GRID, .side = 12},
             .photons = SANITIZED ? 1 << 13 : 1 << 15, .threads = 2);
  FILLED(abbe_caustic_volume, v, fill_volume(&scene, &desc, &v, &done));
  size_t seen = 0;
  for (size_t node = 0; node < 12; node += 3)
    for (size_t cell = 0; cell < v.region.cells; cell++) {
      double p[3], across[3];
      const double *l = v.nodes.direction[node];
      const double half = v.region.desc.outer / 12 * sqrt(3);
      abbe_volume_region_middle(&v.region, cell, p);
      abbe_vector_cross(p, l, across);
      const double off = abbe_vector_length(across), along = abbe_vector_dot(p, l);
      const bool inside = off + half < 0.05 && along + half < -0.05;
      const bool outside = off - half > 0.05 || along - half > 0.05;
      for (size_t k = 0; k < 3; k++) {
        if (inside) assert_near(value_at(&v, node, cell, 3 + k), -l[k], 0.03);
        if (outside) assert_near(value_at(&v, node, cell, 3 + k), 0, 1e-6);
      }
      seen += inside;
    }
  assert_true(seen > 20);
}

enum { BALL_PHOTONS = SANITIZED ? 1 << 15 : 1 << 17 };

/* A map of floors that cut the layer of cells, as the tracer has it: mean flux by area. */
static void trace_layer(abbe_scene *scene, double middle, double height, size_t side, double half,
                        double *sum, double *square) {
  enum { FLOORS = 5 };
  static const double down[3] = {0, 0, -1}, north[3] = {0, 1, 0};
  abbe_view view;
  abbe_map_layout layout;
  const double from[3] = {0, 0, 0.6}, window[4] = {-half, half, -half, half};
  abbe_view_look(from, down, north, true, &view);
  memcpy(view.window, window, sizeof window);
  view.near = 0.1;
  view.far = 2;
  abbe_map_layout_make(&view, &layout);
  for (int f = 0; f < FLOORS; f++) {
    const abbe_trace_desc desc =
        FIELDS(.no_picture = true, .map_width = side, .map_height = side, .layout = &layout,
               .photons = BALL_PHOTONS, .seed = (uint32_t)f + 1, .threads = 2);
    abbe_object *floor = &scene->object[0];
    const double at = middle + ((f + 0.5) / FLOORS - 0.5) * height;
    for (size_t i = 0; i < floor->mesh.vertex_count; i++) floor->mesh.position[i][2] = at;
    floor->exact.parallelogram[0][2] = at;
    floor->min[2] = floor->max[2] = at;
    OWNED(abbe_image, map) = traced_map(scene, &desc, 4);
    const size_t y = abbe_image_find_channel(&map, "Y"),
                 e = abbe_image_find_channel(&map, "stderr.Y");
    for (size_t i = 0; i < side * side; i++) {
      const double area = abbe_map_layout_texel_size(&layout, 0, side, 0) *
                          abbe_map_layout_texel_size(&layout, 1, side, side - 1);
      sum[i] += (double)map.data[i * map.channels + y] / area / FLOORS;
      square[i] += pow((double)map.data[i * map.channels + e] / area / FLOORS, 2);
    }
  }
}

/* Under a ball, at the node that the light is at: a cell holds what the tracer brings to floors in
 * it, within four standard errors of both. */
TEST(a_ball_is_as_the_tracer_has_it) {
  enum { SIDE = 12, LAYERS_END = SANITIZED ? 3 : 4 };
  abbe_volume_fill_statistics done;
  OWNED(abbe_scene, scene) = scene_of(ORB("crown"));
  const double down[3] = {0, 0, -1};
  memcpy(scene.light[0].direction, down, sizeof down);
  const abbe_volume_fill_desc desc =
      FIELDS(.object = 1, .nodes = 1, .region = {.kind = ABBE_REGION_GRID, .side = SIDE},
             .photons = BALL_PHOTONS, .passes = 8, .threads = 2);
  FILLED(abbe_caustic_volume, v, fill_volume(&scene, &desc, &v, &done));
  const double half = v.region.desc.outer, cell = 2 * half / SIDE;
  for (size_t layer = 2; layer < LAYERS_END; layer++) { /* below the ball, past the focus */
    double sum[SIDE * SIDE] = {0}, square[SIDE * SIDE] = {0}, all = 0, both = 0;
    trace_layer(&scene, 0.2 + ((double)layer + 0.5) * cell - half, cell, SIDE, half, sum, square);
    for (size_t i = 0; i < SIDE * SIDE; i++) {
      const size_t x = i % SIDE, y = SIDE - 1 - i / SIDE; /* rows from the top */
      const double own = -value_at(&v, 0, (layer * SIDE + y) * SIDE + x, 5);
      /* the volume has as many photons as the floors: its error is like theirs; half precision; and
       * five floors stand for all between */
      const double sigma = sqrt(2 * square[i]) + 0x1p-11 * sum[i];
      assert_near(own, sum[i], 4 * sigma + 0.02 * sum[i] + 1e-4);
      all += own;
      both += sum[i];
    }
    assert_near(all / both, 1, 0.01);
  }
}

/* Without receivers in the way every shell beyond the object has all the flux that left it. */
TEST(shells_have_the_flux_of_the_ledger) {
  abbe_volume_fill_statistics done;
  OWNED(abbe_scene, scene) = scene_of(ORB("murk"));
  const abbe_volume_fill_desc desc =
      FIELDS(.object = 1, .nodes = 12,
             .region = {.kind = ABBE_REGION_GEODESIC, .levels = 4, .shells = 8}, .photons = 1 << 14,
             .passes = 2, .threads = 2);
  FILLED(abbe_caustic_volume, v, fill_volume(&scene, &desc, &v, &done));
  assert_near(done.outflow[0], 1, 0.01); /* radial parts in the cells' middles */
  assert_near(done.outflow[1], 1, 0.01);
  assert_true(done.ledger.absorbed > 0.01 * done.ledger.reached);
  assert_near((done.ledger.missed + done.ledger.absorbed) / done.ledger.reached, 1, 1e-4);
  assert_int_equal(done.photons, 12 * 2 << 14);
}

TEST(threads_change_nothing) {
  abbe_caustic_volume v[3];
  abbe_volume_fill_statistics done;
  OWNED(abbe_scene, scene) = scene_of(ORB("crown"));
  abbe_volume_fill_desc desc =
      FIELDS(.object = 1, .nodes = 1, .kind = ABBE_VOLUME_PRINTED,
             .region = {.kind = ABBE_REGION_OCTAHEDRAL, .side = 16, .shells = 8}, .photons = 50000,
             .passes = 1);
  for (size_t i = 0; i < 3; i++) {
    desc.threads = i == 0 ? 1 : 2;
    desc.seed = i == 2;
    fill_volume(&scene, &desc, &v[i], &done);
  }
  const size_t bytes = v[0].region.cells * 3 * sizeof *v[0].value;
  assert_memory_equal(v[0].value, v[1].value, bytes);
  assert_memory_not_equal(v[0].value, v[2].value, bytes);
  assert_near(v[0].byte, v[1].byte, 0);
  for (size_t i = 0; i < 3; i++) abbe_caustic_volume_free(&v[i]);
}

TEST(requests) {
  OWNED(abbe_caustic_volume, v);
  abbe_volume_fill_statistics done;
  int calls = 0;
  OWNED(abbe_scene, scene) = scene_of(ORB("crown"));
  abbe_volume_fill_desc desc = {.object = 0, .photons = 1000, .passes = 1};
  REFUSED(ABBE_INVALID_ARGUMENT, "receiver", abbe_volume_fill(&scene, &desc, &v, &done, &error));
  abbe_scene dark = scene;
  dark.light_count = 0;
  REFUSED(ABBE_INVALID_ARGUMENT, "no light", abbe_volume_fill(&dark, &desc, &v, &done, &error));
  desc.object = 7;
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_volume_fill(&scene, &desc, &v, &done, &error));
  desc.object = 1;
  desc.progress = stop_at_once;
  desc.user = &calls;
  REFUSED(ABBE_CANCELLED, "", abbe_volume_fill(&scene, &desc, &v, &done, &error));
  assert_int_equal(calls, 1);
  assert_null(v.value);
  desc.progress = NULL;
  desc.region = (abbe_region_desc){.kind = ABBE_REGION_GRID, .side = 8};
  desc.until_error = 0.05;
  fill_volume(&scene, &desc, &v, &done);
  assert_true(done.error <= 0.05 && done.passes > 2);
  assert_int_equal(v.nodes.count, 1); /* a ball's */
  assert_near(v.region.desc.outer, 0.15, 1e-12);
  assert_near(v.error, done.error, 0);
}

/* Each is right but for one thing. */
TEST(requests_beyond_the_limits_are_refused) {
  static const struct {
    abbe_volume_fill_desc desc;
    const char *says;
  } cases[] = {
      {FIELDS(.object = 1, .photons = ABBE_VOLUME_FILL_MOST_PHOTONS + 1), "at most 67108864 and"},
      {FIELDS(.object = 1, .passes = ABBE_VOLUME_FILL_MOST_PASSES + 1), "100001 passes"},
      {FIELDS(.object = 1, .exits = 100, .kind = ABBE_VOLUME_PRINTED), "they are not printed"},
      {FIELDS(.object = 1, .light = 1), ""},
      {FIELDS(.object = 1, .nodes = 1u << 30), ""},
      {FIELDS(.object = 1, .photons = 1, .region = {.kind = ABBE_REGION_GRID, .side = 1u << 20}),
       ""},
      {FIELDS(.object = 1, .photons = 1, .region = {.inner = 2, .outer = 1}), ""},
      {FIELDS(.object = 1, .photons = 1, .min_nm = 100, .max_nm = 110,
              .region = {.kind = ABBE_REGION_GRID, .side = 4}),
       ""}};
  OWNED(abbe_scene, scene) = scene_of(ORB("crown"));
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    abbe_caustic_volume v;
    abbe_volume_fill_statistics done;
    REFUSED(ABBE_INVALID_ARGUMENT, cases[i].says,
            abbe_volume_fill(&scene, &cases[i].desc, &v, &done, &error));
    assert_null(v.value);
  }
}

/* What is not said of the region: triangles around values, texels around exits. */
TEST(sizes_that_are_not_said) {
  OWNED(abbe_scene, scene) = scene_of(ORB("crown"));
  for (int exits = 0; exits < 2; exits++) {
    abbe_volume_fill_statistics done;
    const abbe_volume_fill_desc desc = {
        .object = 1, .nodes = exits ? 12 : 0, .exits = exits ? 50 : 0, .photons = 100, .passes = 1};
    FILLED(abbe_caustic_volume, v, fill_volume(&scene, &desc, &v, &done));
    assert_int_equal(v.region.desc.kind, exits ? ABBE_REGION_OCTAHEDRAL : ABBE_REGION_GEODESIC);
    assert_int_equal(v.region.row, exits ? 48 * 48 : 5120);
    assert_int_equal(v.region.rows, 24);
    assert_int_equal(v.nodes.count, exits ? 12 : 1);
    assert_true(isnan(v.error) || !(v.error > 0)); /* one pass has none */
  }
}

/* Stopped from outside, before a pass and while a checkpoint is read. */
TEST(a_flag_stops) {
  static const char path[] = "volume-fill-stop-test";
  static const volatile int stop = 1;
  abbe_volume_fill_statistics done;
  OWNED(abbe_scene, scene) = scene_of(ORB("crown"));
  abbe_volume_fill_desc desc = {.object = 1,
                                .nodes = 1,
                                .region = {.kind = ABBE_REGION_GRID, .side = 4},
                                .photons = 1000,
                                .stop = &stop,
                                .checkpoint = path,
                                .resume = true};
  for (int times = 0; times < 2; times++) {
    abbe_caustic_volume v;
    REFUSED(ABBE_CANCELLED, "stopped", abbe_volume_fill(&scene, &desc, &v, &done, &error));
    assert_int_equal(access(path, F_OK), 0);
  }
  desc.stop = NULL;
  FILLED(abbe_caustic_volume, v, fill_volume(&scene, &desc, &v, &done));
  assert_int_equal(done.photons, 4000);
  unlink(path);
}

/* An error that one photon a pass never comes below ends with the most passes; where one goes past
 * all cells, what is printed is dark. */
TEST(one_photon_a_pass) {
  abbe_volume_fill_statistics done;
  OWNED(abbe_scene, scene) = scene_of(ORB("crown"));
  abbe_volume_fill_desc desc = {.object = 1,
                                .nodes = 1,
                                .region = {.kind = ABBE_REGION_GRID, .side = 2},
                                .photons = 1,
                                .passes = 1,
                                .until_error = 1e-9,
                                .threads = 1};
  FILLED(abbe_caustic_volume, v, fill_volume(&scene, &desc, &v, &done));
  assert_int_equal(done.passes, ABBE_VOLUME_FILL_MOST_PASSES);
  assert_true(done.error > 1e-9);
  desc.until_error = 0;
  desc.kind = ABBE_VOLUME_PRINTED;
  desc.region.outer = 1e-4;
  FILLED(abbe_caustic_volume, dark, fill_volume(&scene, &desc, &dark, &done));
  assert_near(dark.byte, 1.0 / 255, 0);
  for (size_t i = 0; i < 8 * 3; i++) assert_int_equal(dark.value[i], 0);
}

/* How much of a cell an object leaves: of a ball in a grid, by its volume. */

TEST(a_ball_takes_its_volume) {
  const double radius = 0.05, centre[3] = {0, 0, 0.1};
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA POINT_LIGHT FLOOR "- {name: ball, shape: sphere, radius: 0.05, levels: 3, "
                                        "material: flat, transform: [{translate: [0, 0, 0.1]}]}\n");
  abbe_scene alone = scene;
  alone.object = &scene.object[1];
  alone.object_count = 1;
  const abbe_region_desc desc = {.kind = ABBE_REGION_GRID, .side = 20, .outer = 2 * radius};
  MADE(abbe_geometry, g, abbe_geometry_make(&alone, &g, &error));
  MADE(abbe_volume_region, r, abbe_volume_region_make(&desc, &r, &error));
  FREED float *share = calloc(r.cells, sizeof *share);
  OK(abbe_volume_space_measure(&g, &r, centre, radius, 400000, share, &error));
  double taken = 0;
  for (size_t cell = 0; cell < r.cells; cell++) {
    double p[3], near = 0, far = 0;
    abbe_volume_region_middle(&r, cell, p);
    for (int k = 0; k < 3; k++) {
      near += pow(fmax(fabs(p[k]) - 0.05 * 2 * radius, 0), 2);
      far += pow(fabs(p[k]) + 0.05 * 2 * radius, 2);
    }
    if (sqrt(far) < radius) assert_near((double)share[cell], 0, 1e-3);
    if (sqrt(near) > radius) assert_near((double)share[cell], 1, 1e-3);
    taken += (1 - (double)share[cell]) * abbe_volume_region_volume(&r, cell);
  }
  assert_near(taken / (4 * ABBE_PI / 3 * pow(radius, 3)), 1, 0.01);
}
