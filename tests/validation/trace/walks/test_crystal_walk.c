/* Light and eye through blocks of calcite: two images at the known distance, and halves of light.
 */
#include "tests/validation/trace/walks/light_walks.h"

#include "spectral/uniaxial.h"
#include "validation/trace/tracer/tracer.h"

/* 0.1 m thick, its axis at 45 degrees to the face; calcite at 550 nm, whose indices vary little
 * over the fixture's range. */
#define CALCITE(axis)                                                                              \
  "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR                          \
  "- {name: slab, shape: box, size: [0.4, 0.4, 0.1], transform: [{translate: [0, 0, 0.3]}], "      \
  "material: spar, axis: " axis "}\n"

#define TABLE_OF(absorption)                                                                       \
  "materials:\n- {name: spar, model: constant, coefficients: [1.66], source: made up,\n"           \
  "   extraordinary: {model: constant, coefficients: [1.48]}," absorption "}\n"
#define TABLE TABLE_OF("")

static const double n_o = 1.66, n_e = 1.48;

/* As make, with a crystal's table. */
static void make_table(const char *table, const char *text, const abbe_physics *physics,
                       fixture *f) {
  char folder[] = "/tmp/abbe-test-crystal-XXXXXX";
  assert_non_null(mkdtemp(folder));
  const char *path = printed("%s/table.yaml", folder);
  OK(abbe_file_write(path, table, strlen(table), &error));
  make(printed("materials: %s\n%s", path, text), physics, f);
  unlink(path);
  rmdir(folder);
}

static void make_crystal(const char *text, const abbe_physics *physics, fixture *f) {
  make_table(TABLE, text, physics, f);
}

/* Of the light that enters as one wave a slab lets through, with all inner reflections, (1 - r) /
 * (1 + r): each wave by its own index, and neither makes any of the other head on. */
TEST(a_beam_becomes_two) {
  FREED fixture *f = malloc(sizeof *f);
  make_crystal(CALCITE("[1, 0, 1]"), NULL, f);
  const double from[3] = {0.02, 0.01, 0.5}, down[3] = {0, 0, -1}, cos_axis = sqrt(0.5);
  const double n[2] = {n_o, abbe_uniaxial_index(n_o, n_e, cos_axis)};
  const double shift = 0.1 * tan(abbe_uniaxial_walk_off(n_o, n_e, cos_axis));
  size_t count[2] = {0}, photons = 0;
  for (uint32_t b = 0; b < 64; b++) {
    for (uint32_t i = 0; i < BATCH; i++) f->photon[i] = photon_of(f, from, down, i);
    size_t hits =
        abbe_light_walk_run(f->walk, &f->scene.light[0], b, f->photon, BATCH, f->hit, &f->ledger);
    photons += BATCH;
    for (size_t i = 0; i < hits; i++) {
      double p[3];
      abbe_geometry_to_world(&f->geometry, f->hit[i].p, p);
      if (p[2] > 0.1) continue;
      /* away from the axis for a negative crystal, once or, after two reflections, three times */
      const double steps = (p[0] - from[0]) / shift;
      const bool odd = fabs(steps - round(steps)) < 1e-3 && (int)round(steps) % 2 != 0;
      assert_true(odd || fabs(steps) < 1e-3);
      assert_near(p[1], from[1], 1e-5);
      count[odd]++;
    }
  }
  for (int wave = 0; wave < 2; wave++) {
    const double r = pow((n[wave] - 1) / (n[wave] + 1), 2);
    check_share((double)count[wave], (double)photons, 0.5 * (1 - r) / (1 + r));
  }
  assert_near(f->ledger.reached, (double)photons, 1e-6 * (double)photons);
  assert_near(f->ledger.lost, 0, 0);
  fixture_free(f);
}

#define PLEOCHROIC                                                                                 \
  TABLE_OF("\n   absorption: {ordinary: {attenuation_per_m: [[500, 30]]},\n"                       \
           "     extraordinary: {attenuation_per_m: [[500, 4]]}}")
#define MIST_BESIDE "medium: {scattering: 1, box: [[5, 5, 5], [6, 6, 6]]}\n"

/* What a slab of 0.1 m passes of light that enters it head on in two halves, with all inner
 * reflections. */
static double two_exponentials(const double n[2], const double per_m[2]) {
  double passed = 0;
  for (int wave = 0; wave < 2; wave++) {
    const double r = pow((n[wave] - 1) / (n[wave] + 1), 2), tau = exp(-per_m[wave] * 0.1);
    passed += 0.5 * (1 - r) * (1 - r) * tau / (1 - r * r * tau * tau);
  }
  return passed;
}

/* Straight on, and nowhere else. */
static void check_two_exponentials(const char *table, const char *scene, const double n[2],
                                   const double per_m[2]) {
  enum { BATCHES = 64 };
  FREED fixture *f = malloc(sizeof *f);
  make_table(table, scene, NULL, f);
  const double from[3] = {0.02, 0.01, 0.5}, down[3] = {0, 0, -1};
  double landed = 0, sent = 0;
  for (uint32_t b = 0; b < BATCHES; b++) {
    for (uint32_t i = 0; i < BATCH; i++) f->photon[i] = photon_of(f, from, down, i);
    for (uint32_t i = 0; i < BATCH; i++) sent += (double)f->photon[i].flux;
    const size_t hits =
        abbe_light_walk_run(f->walk, &f->scene.light[0], b, f->photon, BATCH, f->hit, &f->ledger);
    for (size_t i = 0; i < hits; i++) {
      double p[3];
      abbe_geometry_to_world(&f->geometry, f->hit[i].p, p);
      if (p[2] > 0.1) continue;
      landed += (double)f->hit[i].flux;
      assert_near(p[0], from[0], 1e-5);
      assert_near(p[1], from[1], 1e-5);
    }
  }
  assert_near(landed / sent, two_exponentials(n, per_m), 4 * 0.35 / sqrt(BATCHES * BATCH));
  assert_near(f->ledger.reached,
              f->ledger.deposited + f->ledger.absorbed + f->ledger.missed + f->ledger.trapped,
              1e-5 * f->ledger.reached);
  fixture_free(f);
}

static const double calcite_n[2] = {1.66, 1.48}, pleochroic_per_m[2] = {30, 4};

/* Through a slab whose axis lies in its face head on, each wave with its own loss: two
 * exponentials, and not one of the mean. Mist that no light meets changes nothing. */
TEST(a_pleochroic_slab_passes_two_exponentials) {
  check_two_exponentials(PLEOCHROIC, CALCITE("[1, 1, 0]"), calcite_n, pleochroic_per_m);
  check_two_exponentials(PLEOCHROIC, MIST_BESIDE CALCITE("[1, 1, 0]"), calcite_n, pleochroic_per_m);
}

/* Along the axis both waves are ordinary: one exponential. */
TEST(a_pleochroic_slab_passes_one_along_its_axis) {
  check_two_exponentials(PLEOCHROIC, CALCITE("[0, 0, 1]"), (const double[2]){n_o, n_o},
                         (const double[2]){30, 30});
}

#define THREE                                                                                      \
  "materials:\n- {name: spar, model: constant, coefficients: [1.68], source: made up,\n"           \
  "   biaxial: {alpha: {model: constant, coefficients: [1.53]},\n"                                 \
  "     gamma: {model: constant, coefficients: [1.75]}},\n"                                        \
  "   absorption: {x: {attenuation_per_m: [[500, 10]]}, y: {attenuation_per_m: [[500, 3]]},\n"     \
  "     z: {attenuation_per_m: [[500, 1]]}}}\n"
#define BIAXIAL(x, z)                                                                              \
  "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR                          \
  "- {name: slab, shape: box, size: [0.4, 0.4, 0.1], transform: [{translate: [0, 0, 0.3]}], "      \
  "material: spar, axes: {x: " x ", z: " z "}}\n"

/* Head on into a slab of three indices, x along the normal: the waves have the other two indices
 * and absorptions, and neither makes any of the other. */
TEST(a_biaxial_slab_passes_both_waves) {
  check_two_exponentials(THREE, BIAXIAL("[0, 0, 1]", "[1, 1, 0]"), (const double[2]){1.68, 1.75},
                         (const double[2]){3, 1});
}

TEST(the_ledger_of_three_indices_closes) {
  FREED fixture *f = malloc(sizeof *f);
  make_table(THREE, BIAXIAL("[1, 0.3, 0.2]", "[0.1, 0.3, 1]"), NULL, f);
  flood(f, 40);
  const abbe_light_ledger *l = &f->ledger;
  const double parts = l->deposited + l->absorbed + l->missed + l->trapped + l->lost;
  assert_near(parts / l->reached, 1, 1e-5);
  assert_true(l->lost < 1e-3 * l->reached);
  fixture_free(f);
}

/* All that reaches the block is somewhere, whatever faces it meets and how often it is split. */
TEST(the_ledger_closes) {
  for (unsigned splits = 0; splits < 4; splits++) {
    FREED fixture *f = malloc(sizeof *f);
    make_crystal(CALCITE("[1, 0.3, 0.7]"), NULL, f);
    abbe_light_walk_split(f->walk, splits);
    flood(f, 40);
    const abbe_light_ledger *l = &f->ledger;
    const double parts = l->deposited + l->absorbed + l->missed + l->trapped + l->lost;
    assert_near(parts / l->reached, 1, 1e-5);
    assert_true(l->lost < 1e-3 * l->reached);
    fixture_free(f);
  }
}

/* Split paths carry what chosen ones carry. */
TEST(splitting_biases_nothing) {
  double landed[2];
  for (int i = 0; i < 2; i++) {
    FREED fixture *f = malloc(sizeof *f);
    make_crystal(CALCITE("[1, 0.3, 0.7]"), NULL, f);
    abbe_light_walk_split(f->walk, i == 0 ? 0 : 3);
    flood(f, 100);
    landed[i] = f->ledger.deposited / f->ledger.reached;
    fixture_free(f);
  }
  assert_near(landed[1], landed[0], 5e-3);
}

/* ---- the eye ---- */

/* A bright floor under a slab of the table, seen from straight above through a narrow angle. */
static abbe_image slab_seen(const char *table, const char *around, const char *objects, int wide,
                            int rows, int passes) {
  char folder[] = "/tmp/abbe-test-crystal-XXXXXX";
  assert_non_null(mkdtemp(folder));
  const char *path = printed("%s/table.yaml", folder);
  OK(abbe_file_write(path, table, strlen(table), &error));
  const char *text = printed(
      "materials: %s\n%scamera: {eye: [0, 0, 40], target: [0, 0, 0], up: [0, 1, 0], fov: 0.1, "
      "size: [%d, %d]}\nambient: 3.14159265\n"
      "lights: [{name: lamp, kind: point, position: [0, 0, 200], intensity: 1.0e-12}]\n"
      "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 1}\n%s",
      path, around, wide, rows, objects);
  MADE(abbe_scene, scene, abbe_scene_parse(text, strlen(text), "scene", NULL, &scene, &error));
  const abbe_trace_desc desc =
      FIELDS(.no_map = true, .space = ABBE_RGB_SPACE_XYZ, .width = (size_t)wide,
             .height = (size_t)rows, .photons = 1024, .threads = 1);
  abbe_tracer *tracer = NULL;
  abbe_image picture = {0};
  OK(abbe_tracer_make(&scene, &desc, &tracer, &error));
  for (int p = 0; p < passes; p++) OK(abbe_tracer_pass(tracer, NULL, &error));
  OK(abbe_tracer_picture(tracer, &picture, &error));
  abbe_tracer_free(tracer);
  unlink(path);
  rmdir(folder);
  return picture;
}

/* A dark line on a bright floor under the block, seen straight from above, is two lines of half the
 * depth, as far apart as the closed form says. */
TEST(a_line_is_seen_double) {
  enum { WIDE = 48, ROWS = 8 };
  OWNED(abbe_image, picture) =
      slab_seen(TABLE, "background: 1\n",
                "- {name: line, shape: rectangle, width: 0.02, height: 2, reflectance: 0,\n"
                "   transform: [{translate: [0, 0, 0.001]}]}\n"
                "- {name: slab, shape: box, size: [2, 2, 1], material: spar, axis: [1, 0, 1],\n"
                "   transform: [{translate: [0, 0, 0.6]}]}\n",
                WIDE, ROWS, 24);
  const size_t y = abbe_image_find_channel(&picture, "Y");
  const double pixel = 2 * 40 * tan(0.05 / 180 * 3.14159265358979) / ROWS; /* m on the floor */
  const double shift = tan(abbe_uniaxial_walk_off(n_o, n_e, sqrt(0.5))), around = 0.04;
  double dark[2] = {0}, centre[2] = {0};
  for (size_t i = 0; i < picture.width * picture.height; i++) {
    const double x = ((double)(i % WIDE) + 0.5 - WIDE / 2.0) * pixel;
    const double missing = (1 - (double)picture.data[i * picture.channels + y]) * pixel / ROWS;
    const int line = fabs(x) < around ? 0 : fabs(x + shift) < around ? 1 : -1;
    if (line < 0) continue;
    dark[line] += missing;
    centre[line] += x * missing;
  }
  assert_near(centre[0] / dark[0], 0, 0.3 * pixel);
  assert_near(centre[1] / dark[1], -shift, 0.3 * pixel);
  /* halves, less what is reflected at the upper face and comes from elsewhere */
  const double n[2] = {n_o, abbe_uniaxial_index(n_o, n_e, sqrt(0.5))};
  for (int line = 0; line < 2; line++) {
    const double r = pow((n[line] - 1) / (n[line] + 1), 2);
    assert_near(dark[line] / 0.02, 0.5 * pow(1 - r, 2), 0.03);
  }
}

/* Mean Y of a bright floor through a pleochroic slab, seen from straight above. */
static double floor_through_slab(const char *medium) {
  enum { SIDE = 16 };
  OWNED(abbe_image, picture) =
      slab_seen(PLEOCHROIC, medium,
                "- {name: slab, shape: box, size: [2, 2, 0.1], material: spar, axis: [1, 1, 0],\n"
                "   transform: [{translate: [0, 0, 0.1]}]}\n",
                SIDE, SIDE, 8);
  const size_t y = abbe_image_find_channel(&picture, "Y");
  double sum = 0;
  for (size_t i = 0; i < SIDE * SIDE; i++) sum += (double)picture.data[i * picture.channels + y];
  return sum / (SIDE * SIDE);
}

/* What the camera sees through it is two exponentials too, whether or not there is mist somewhere.
 * What the floor and the slab send to and fro between them is below 2 % of it. */
TEST(a_pleochroic_slab_shows_two_exponentials) {
  const double wanted = two_exponentials(calcite_n, pleochroic_per_m);
  assert_near(floor_through_slab(""), wanted, 0.03 * wanted);
  assert_near(floor_through_slab(MIST_BESIDE), wanted, 0.03 * wanted);
}
