/* Light and camera through coated panes: shares of the stack in closed form, and every watt in the
 * ledger. */
#include "tests/validation/trace/walks/light_walks.h"

#include "base/file.h"
#include "tests/validation/trace_scene.h"
#include "validation/trace/tracer/tracer.h"

#define SCENE "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR

/* Of light of 550 nm at that cosine of the angle in air: what a pane of n-bk7's index with such
 * films on both sides, or above alone, passes with all inner reflections, of s and p. */
static double passes(const fixture *f, const abbe_film_layer *layer, size_t count, bool both,
                     double cos_air) {
  const double n = (double)f->media.n[4], air[2] = {1, 0}, glass[2] = {n, 0};
  const double sine = sqrt(1 - cos_air * cos_air) / n, cos_glass = sqrt(1 - sine * sine);
  const size_t below = both ? count : 0;
  abbe_film_light in, top, out;
  double sum = 0;
  abbe_film_light_at(layer, count, false, 1, glass, cos_air, 550, &in);
  abbe_film_light_at(layer, count, true, n, air, cos_glass, 550, &top);
  abbe_film_light_at(layer, below, true, n, air, cos_glass, 550, &out);
  /* the walks carry unpolarised light from face to face */
  double t_in, t_out, r_top, r_out, ignored;
  abbe_film_unpolarised(&in, &ignored, &t_in);
  abbe_film_unpolarised(&top, &r_top, &ignored);
  abbe_film_unpolarised(&out, &r_out, &t_out);
  sum = t_in * t_out / (1 - r_top * r_out);
  return sum;
}

static void check_pane(const char *coating, const abbe_film_layer *layer, size_t count, bool both,
                       unsigned splits) {
  enum { BATCHES = 64 };
  FREED fixture *f = malloc(sizeof *f);
  make(printed(SCENE SLAB("n-bk7, coating: %s"), coating), NULL, f);
  abbe_light_walk_split(f->walk, splits);
  const double from[3] = {-0.05, 0.01, 0.5}, d[3] = {0.6, 0, -0.8};
  double landed = 0, sent = 0;
  for (uint32_t b = 0; b < BATCHES; b++) {
    for (uint32_t i = 0; i < BATCH; i++) {
      f->photon[i] = photon_of(f, from, d, i);
      f->photon[i].step = STEPS / 2; /* 550 nm */
      f->photon[i].within = 0;
      sent++;
    }
    const size_t hits =
        abbe_light_walk_run(f->walk, &f->scene.light[0], b, f->photon, BATCH, f->hit, &f->ledger);
    for (size_t i = 0; i < hits; i++) landed += (double)f->hit[i].flux;
  }
  assert_near(landed / sent, passes(f, layer, count, both, 0.8), 4 * 0.45 / sqrt(BATCHES * BATCH));
  const abbe_light_ledger *l = &f->ledger;
  assert_near(l->reached, sent, 1e-6 * sent);
  assert_near(l->deposited + l->absorbed + l->missed, l->reached, 1e-5 * l->reached);
  if (layer[0].k > 0)
    assert_true(l->absorbed > 0.05 * sent);
  else
    assert_near(l->absorbed, 0, 1e-5 * sent);
  assert_near(l->lost + l->trapped, 0, 0);
  fixture_free(f);
}

TEST(a_coated_pane_passes_what_its_films_do) {
  const abbe_film_layer clear[2] = {{1.38, 0, 99.6, NULL}, {2.35, 0, 60, NULL}},
                        grey = {0.42, 2.4, 10, NULL};
  check_pane("{layers: [[1.38, 99.6], [2.35, 60]]}", clear, 2, true, 0);
  check_pane("{layers: [[[0.42, 2.4], 10]]}", &grey, 1, true, 0);
  check_pane("{layers: [[[0.42, 2.4], 10]]}", &grey, 1, true, 3);
  check_pane("{layers: [[[0.42, 2.4], 10]], faces: table}", &grey, 1, false, 0);
  check_pane("[{layers: [[1.38, 99.6]]}, {layers: [[[0.42, 2.4], 10]], faces: [table]}, {layers: "
             "[[1.5, 0]], faces: pavilion}]",
             &grey, 1, false, 1);
}

/* A table that equals a film gives what the film gives; of one that absorbs, no watt is missed. */
TEST(a_pane_under_a_table_passes_what_the_film_does) {
  static const char *const path = "/tmp/abbe-test-coated-walk.coated";
  const abbe_film_layer films[2] = {{1.38, 0, 99.6, NULL}, {0.42, 2.4, 10, NULL}};
  for (int i = 0; i < 2; i++) {
    char text[8192], *end = text;
    end += sprintf(end, "OPTIS - Coated surface file v1.0\n\n91 1\n550\n");
    for (int a = 0; a < 91; a++) {
      abbe_film_light l;
      abbe_film_light_at(&films[i], 1, false, 1, (const double[2]){1.51852, 0},
                         cos(a * ABBE_DEGREE), 550, &l);
      end += sprintf(end, "%d %.6f %.6f\n%.6f %.6f\n", a, 100 * l.reflected[1],
                     100 * l.transmitted[1], 100 * l.reflected[0], 100 * l.transmitted[0]);
    }
    OK(abbe_file_write(path, text, (size_t)(end - text), &error));
    check_pane(printed("{file: %s, faces: table}", path), &films[i], 1, false, i ? 3 : 0);
  }
  OWNED(abbe_scene, scene) = scene_of(printed(SCENE SLAB("n-bk7, coating: {file: %s}"), path));
  abbe_tracer *tracer = NULL;
  REFUSED(ABBE_UNSUPPORTED, "has no phases for polarised light: take --polarisation off",
          abbe_tracer_make(&scene, &(abbe_trace_desc){.polarisation = ABBE_TRACE_POLARISATION_ON},
                           &tracer, &error));
  unlink(path);
}

/* In even surroundings a stone with clear films is as bright as they are; absorbing ones make it
 * darker. */
static double furnace(const char *material, const char *coating) {
  char text[2048];
  snprintf(text, sizeof text,
           "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.3], fov: 6}\nbackground: 1\nlights: "
           "[{name: far, kind: point, position: [3, 3, 3], intensity: 1}]\nobjects:\n" SLAB(
               "%s, coating: %s") "- {name: floor, shape: rectangle, width: 2, height: 2, "
                                  "reflectance: 0}\n",
           material, coating);
  OWNED(abbe_scene, scene) = scene_of(text);
  scene.object_count = 1; /* no floor */
  abbe_tracer *tracer = make_tracer(&scene, &(abbe_trace_desc){.width = 8,
                                                               .height = 8,
                                                               .no_map = true,
                                                               .threads = 1,
                                                               .photons = 16,
                                                               .space = ABBE_RGB_SPACE_XYZ});
  run_passes(tracer, 64);
  MADE(abbe_image, image, abbe_tracer_picture(tracer, &image, &error));
  const double mean = channel_sum(&image, "Y") / 64;
  abbe_tracer_free(tracer);
  scene.object_count = 2;
  return mean;
}

TEST(a_furnace_of_coated_stones_is_even) {
  static const char *const stones[] = {"n-bk7", "calcite", "topaz"};
  for (int i = 0; i < 3; i++) {
    assert_near(furnace(stones[i], "{layers: [[1.38, 99.6], [2.35, 60]]}"), 1, 0.004);
    assert_true(furnace(stones[i], "{layers: [[[0.42, 2.4], 10]]}") < 0.8);
  }
}

TEST(photons_through_coated_crystals_are_all_accounted_for) {
  static const char *const stones[] = {"calcite", "topaz"};
  for (int i = 0; i < 2; i++) {
    FREED fixture *f = malloc(sizeof *f);
    make(printed(SCENE SLAB("%s, coating: {layers: [[[0.42, 2.4], 10], [2.4, 60]]}"), stones[i]),
         NULL, f);
    const double from[3] = {-0.05, 0.01, 0.5}, d[3] = {0.6, 0, -0.8};
    shoot(f, from, d, 16);
    const abbe_light_ledger *l = &f->ledger;
    assert_near(l->reached, (double)f->photons, 1e-6 * (double)f->photons);
    assert_near(l->deposited + l->absorbed + l->missed, l->reached, 1e-5 * l->reached);
    assert_true(l->absorbed > 0.05 * l->reached && l->lost == 0);
    fixture_free(f);
  }
}
