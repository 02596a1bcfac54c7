/* Light through refractors that lie in one another, and from their outsides alone, and what the eye
 * sees in a stone that keeps light inside: the renderer against the reference tracer, which shares
 * no code with it. */
#include "tests/gl/frame.h"
#include "tests/validation/trace_scene.h"

enum { SIDE = 64, BLOCK = 8, BLOCKS = SIDE / BLOCK, MAX_PASSES = 12 };

/* Y of blocks of texels: finer than that the tracer's few photons are noise. */
static void sum_blocks(const abbe_image *map, double block[BLOCKS * BLOCKS]) {
  const size_t y = abbe_image_find_channel(map, "Y");
  memset(block, 0, BLOCKS * BLOCKS * sizeof *block);
  for (size_t i = 0; i < SIDE * SIDE; i++)
    block[i / SIDE / BLOCK * BLOCKS + i % SIDE / BLOCK] += (double)map->data[i * map->channels + y];
}

typedef struct agreement {
  double energy;  /* the renderer's light over the tracer's */
  double trapped; /* what its ledger gives up within refractors, over the same */
  double apart;   /* sum of the blocks' absolute differences, over the light */
  double light;   /* W */
} agreement;

static agreement compare(const char *text, int passes, bool polarised) {
  abbe_render_desc desc = small_frame;
  desc.photons = polarised ? 256 : 128;
  desc.map_size = SIDE;
  OWNED(abbe_scene, scene) = scene_of(text);
  desc.exits = 16;
  abbe_renderer *renderer = make_renderer(&scene, &desc);
  const abbe_statistics statistics = draw_frame(renderer);
  OWNED(abbe_image, drawn) = map_of(renderer, 0);
  abbe_renderer_free(renderer);
  abbe_map_layout layout;
  OK(abbe_map_layout_read(&drawn, "drawn", &layout, &error));
  HELD(abbe_tracer, tracer) = make_tracer(
      &scene, &(abbe_trace_desc){.no_picture = true,
                                 .map_width = SIDE,
                                 .map_height = SIDE,
                                 .layout = &layout,
                                 .photons = 1 << 17,
                                 .space = ABBE_RGB_SPACE_XYZ,
                                 .polarisation = polarised ? ABBE_TRACE_POLARISATION_ON
                                                           : ABBE_TRACE_POLARISATION_AUTO});
  run_passes(tracer, passes);
  MADE(abbe_image, traced, abbe_tracer_map(tracer, &traced, &error));
  double a[BLOCKS * BLOCKS], b[BLOCKS * BLOCKS];
  sum_blocks(&drawn, a);
  sum_blocks(&traced, b);
  agreement found = {0};
  double light = 0;
  for (size_t i = 0; i < BLOCKS * BLOCKS; i++) {
    found.apart += fabs(a[i] - b[i]);
    light += a[i];
    found.light += b[i];
  }
  assert_true(found.light > 0);
  assert_true(abbe_ledger_imbalance(&statistics.energy) < 1e-4);
  found.energy = light / found.light;
  found.apart /= found.light;
  found.trapped = statistics.energy.trapped / found.light;
  print_message("%.4f of the tracer's light, %.4f given up, %.4f of it elsewhere\n", found.energy,
                found.trapped, found.apart);
  return found;
}

#define INNER(material)                                                                            \
  "- {name: core, shape: sphere, radius: 0.06, levels: 4, transform: [{translate: [0.005, 0, "     \
  "0.2]}], material: " material "}\n"

/* What the map lacks is what the ledger says that was given up; of that some would not have landed.
 */
static void hold(agreement found, double least_light) {
  assert_true(found.light > least_light);
  assert_true(found.energy < 1.01);
  assert_true(found.energy + found.trapped > 0.995);
  assert_true(found.apart < found.trapped + 0.03);
}

static void check(const char *text, int passes, double least_light) {
  hold(compare(text, passes, false), least_light);
}

GROUP(make_context, free_context);

TEST(a_hollow_ball) {
  check(CAMERA POINT_LIGHT FLOOR BALL("crown") INNER("air"), 4, 1e-3);
}

TEST(a_ball_in_another) {
  check(CAMERA POINT_LIGHT FLOOR BALL("crown") INNER("dense"), 4, 1e-3);
}

/* A cup of glass with water up to its inner wall: the water is listed last and reaches into the
 * glass. */
TEST(a_cup_of_water) {
  check(CAMERA POINT_LIGHT FLOOR
        "- {name: cup, shape: lathe, around: 48, profile: [[0, 0], [0.06, 0], [0.06, 0.12], [0.05, "
        "0.12], [0.05, 0.01], [0, 0.01]], transform: [{translate: [0, 0, 0.1]}], material: crown}\n"
        "- {name: water, shape: lathe, around: 48, profile: [[0, 0], [0.055, 0], [0.055, 0.08], "
        "[0, 0.08]], transform: [{translate: [0, 0, 0.105]}], material: flat}\n",
        MAX_PASSES, 1e-3);
}

#define BESIDE                                                                                     \
  "- {name: ball, shape: sphere, radius: 0.03, centre: [0.3, 0, 0.2], material: n-bk7}\n"

#define CRYSTAL(stone)                                                                             \
  "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR                          \
  "- {name: stone, shape: box, size: [0.12, 0.12, 0.08], transform: [{rotate: {axis: [0, 1, 0], "  \
  "angle: 10}}, {translate: [0, 0, 0.2]}], material: " stone "}\n"

/* Two caustics; and what absorbs by the light's direction: alone, and beside glass. */
TEST(both_waves_of_a_crystal) {
  check(CRYSTAL("calcite, axis: [1, 0.3, 0.7]") BESIDE, 8, 1e-3);
  check(CRYSTAL("topaz, axes: {x: [1, 0.2, 0], z: [0, 0, 1]}"), 8, 1e-3);
  check(CRYSTAL("tourmaline-green, axis: [1, 0.2, 0]"), 8, 1e-3);
}

/* A film meets each wave's own index, alone and beside glass; by the ordinary one for both it would
 * pass 4 % more of this light. */
TEST(a_coated_crystal) {
  static const char stone[] = "calcite, axis: [1, 0, 0], coating: {layers: [[2.4, 57]]}";
  check(printed(CRYSTAL("%s"), stone), 8, 1e-3);
  check(printed(CRYSTAL("%s") BESIDE, stone), 8, 1e-3);
}

/* Light that has left a crystal enters the next by its field: one that absorbs the ordinary wave
 * and stands at 45 degrees passes half of what the first passed. By choice of 128 x 128 photons. */
TEST(two_crystals_in_line) {
  const agreement found =
      compare(CRYSTAL("tourmaline-green, axis: [1, 0, 0]") "- {name: second, shape: box, size: "
                                                           "[0.12, 0.12, 0.08], transform: "
                                                           "[{translate: [0, 0, 0.09]}], material: "
                                                           "tourmaline-green, axis: [1, 1, 0]}\n",
              8, true);
  assert_true(found.light > 1e-4);
  assert_near(found.energy, 1, 0.02); /* what is given up would mostly be absorbed */
}

#define BALL_ON                                                                                    \
  "- {name: ball, shape: sphere, radius: 0.03, centre: [0, 0, 0.3], material: n-bk7}\n"

/* Light goes through the glass, too, and is absorbed there. */
TEST(glass_above_a_pleochroic_crystal) {
  check(CRYSTAL("tourmaline-green, axis: [1, 0.2, 0]") BALL_ON, 8, 1e-3);
}

/* Light comes to the wall from the pane's mirror alone. */
TEST(the_outside_alone) {
  check("materials: glass.yaml\ncamera: {eye: [-1, -1, 0.5], target: [0, 0, 0.05]}\n"
        "lights:\n- {name: lamp, kind: spot, position: [-0.5, 0, 0.6], target: [0, 0, 0.1], cone: "
        "12, intensity: 1}\n"
        "objects:\n- {name: brick, shape: box, size: [0.3, 0.3, 0.1], transform: [{translate: [0, "
        "0, 0.05]}], material: smoke}\n"
        "- {name: wall, shape: rectangle, width: 2, height: 2, reflectance: 0.5, transform: "
        "[{rotate: {axis: [0, 1, 0], angle: -90}}, {translate: [0.6, 0, 1.12]}]}\n",
        4, 1e-4);
}

#define PARTS(file)                                                                                \
  "- {name: parts, mesh: " ABBE_SOURCE_DIR "/tests/meshes/" file                                   \
  ", transform: [{rotate: {axis: [0, 1, 0], angle: 25}}, {translate: [0, 0, 0.2]}], "              \
  "material: crown}\n"

#define ONE_BY_ONE(name, size, at)                                                                 \
  "- {name: " name ", shape: box, size: [" size "], transform: [{translate: [" at                  \
  "]}, {rotate: {axis: [0, 1, 0], angle: 25}}, {translate: [0, 0, 0.2]}], material: crown}\n"

/* A mesh of boxes shows what the same boxes show that are listed one by one. Their edges part so
 * much light that the tracer's noise alone is more than check() allows. */
static void check_parts(const char *parts, const char *listed) {
  const agreement mesh = compare(parts, MAX_PASSES, false),
                  boxes = compare(listed, MAX_PASSES, false);
  assert_near(mesh.light / boxes.light, 1, 0.003);
  assert_near(mesh.energy, boxes.energy, 0.003);
  assert_true(mesh.energy < 1.01 && mesh.energy + mesh.trapped > 0.995);
  assert_near(mesh.apart, boxes.apart, 0.01);
}

TEST(parts_of_a_mesh_that_cross) {
  check_parts(CAMERA POINT_LIGHT FLOOR PARTS("crossing.obj"),
              CAMERA POINT_LIGHT FLOOR ONE_BY_ONE("a", "0.12, 0.12, 0.1", "0, 0, 0")
                  ONE_BY_ONE("b", "0.13, 0.07, 0.07", "0.045, 0.005, 0.005"));
}

/* Faces lie on one another, back to back and side by side; of the boxes listed one by one those
 * that come later reach into the first, by a tenth of a millimetre. */
TEST(parts_of_a_mesh_that_touch) {
  check_parts(CAMERA POINT_LIGHT FLOOR PARTS("flush.obj"),
              CAMERA POINT_LIGHT FLOOR ONE_BY_ONE("a", "0.12, 0.12, 0.08", "0, 0, -0.01")
                  ONE_BY_ONE("b", "0.09, 0.07, 0.0601", "0.065, 0.005, -0.02005")
                      ONE_BY_ONE("c", "0.06, 0.07, 0.0301", "-0.01, -0.005, 0.04495"));
}

/* The tracer's picture of it all is that of one block: the wall within is none. */
TEST(parts_of_one_stuff_have_no_wall) {
#define HALF(name, x)                                                                              \
  "- {name: " name ", shape: box, size: [0.081, 0.08, 0.06], transform: [{translate: [" x          \
  ", 0, 0.2]}], material: dense}\n"
  const agreement two =
      compare(CAMERA POINT_LIGHT FLOOR HALF("a", "-0.04") HALF("b", "0.04"), MAX_PASSES, false);
  const agreement one =
      compare(CAMERA POINT_LIGHT FLOOR "- {name: one, shape: box, size: [0.161, 0.08, 0.06], "
                                       "transform: [{translate: [0, 0, 0.2]}], material: dense}\n",
              MAX_PASSES, false);
  assert_near(two.light / one.light, 1, 0.005);
  assert_near(two.energy, one.energy, 0.01);
}

/* The whole frame shows a brilliant of diamond's index on paper that ambient light alone lights, so
 * that each ray's ways out are all that counts. With eight exits it is a tenth too dark. */
#define STONE_OF(name, at, more)                                                                   \
  "- {name: " name ", shape: brilliant, diameter: 0.1, transform: [{rotate: {axis: [0, 0, 1], "    \
  "angle: 7}}, {translate: [" at ", 0, 0.046]}], material: dense" more "}\n"
#define STONE(name, at) STONE_OF(name, at, "")
static void check_stones(const char *stones, const char *eye, const char *target, const char *fov,
                         int looks, double share) {
  char text[2048];
  snprintf(
      text, sizeof text,
      "materials: glass.yaml\nambient: 3\n"
      "camera: {eye: %s, target: %s, up: [0, 1, 0.3], fov: %s}\n"
      "lights:\n- {name: aside, kind: spot, position: [3, 3, 1], target: [4, 4, 0], cone: 5, "
      "intensity: 1}\n"
      "objects:\n%s- {name: paper, shape: rectangle, width: 2, height: 2, reflectance: 0.85}\n",
      eye, target, fov, stones);
  OWNED(abbe_scene, scene) = scene_of(text);
  abbe_render_desc desc = small_frame;
  desc.energy_share = share; /* 0: the plan's */
  abbe_renderer *renderer = drawn_renderer(&scene, &desc);
  OWNED(abbe_image, drawn) = picture_of(renderer);
  abbe_renderer_free(renderer);
  HELD(abbe_tracer, tracer) = make_tracer(
      &scene, &(abbe_trace_desc){.no_map = true, .width = 64, .height = 64, .photons = 1});
  run_passes(tracer, looks);
  MADE(abbe_image, traced, abbe_tracer_picture(tracer, &traced, &error));
  const double noise = abbe_tracer_error(tracer) / 64; /* of the mean of 64 x 64 pixels */
  for (size_t k = 0; k < 3; k++) {
    static const char *const names[] = {"R", "G", "B"};
    const double ratio = image_sum(&drawn, abbe_image_find_channel(&drawn, names[k])) /
                         channel_sum(&traced, names[k]);
    print_message("%s: %.4f of the tracer's, which is known to %.4f\n", names[k], ratio, noise);
    assert_true(noise < 0.004);
    assert_near(ratio, 1, 0.02);
  }
}

TEST(a_stone_face_up) {
  check_stones(STONE("stone", "0"), "[0, -0.04, 0.8]", "[0, 0, 0.05]", "4", 48, 0);
}

TEST(a_stone_from_the_side) {
  check_stones(STONE("stone", "0"), "[0.1, -0.75, 0.2]", "[0, 0, 0.04]", "2.5", 8, 0);
}

/* Films on all of it, or on some facets; one that absorbs; and in turn with another stone. */
TEST(coated_stones) {
#define TITANIA ", coating: {layers: [[2.4, 120]]}"
#define GREY ", coating: {layers: [[[0.42, 2.4], 10]], faces: [pavilion]}"
  check_stones(STONE_OF("stone", "0", TITANIA), "[0, -0.04, 0.8]", "[0, 0, 0.05]", "4", 48, 5e-4);
  check_stones(STONE_OF("stone", "0", GREY), "[0, -0.04, 0.8]", "[0, 0, 0.05]", "4", 48, 5e-4);
  check_stones(STONE_OF("left", "-0.052", TITANIA) STONE("right", "0.052"), "[0.05, -0.75, 0.2]",
               "[-0.052, 0, 0.04]", "2.5", 8, 0);
}

/* Photons too. */
TEST(light_through_films) {
#define PANE(coating)                                                                              \
  CAMERA POINT_LIGHT FLOOR "- {name: pane, shape: box, size: [0.1, 0.1, 0.03], transform: "        \
                           "[{translate: [0, 0, 0.2]}], material: dense" coating "}\n"
  check(PANE(TITANIA), 4, 1e-4);
  check(PANE(GREY), 4, 1e-4);
  check(CAMERA POINT_LIGHT FLOOR BALL("crown" TITANIA) INNER("air"), 4, 1e-3);
}

/* Through one the eye sees the other, from refractor to refractor. */
TEST(two_stones_from_the_side) {
  check_stones(STONE("left", "-0.052") STONE("right", "0.052"), "[0.05, -0.75, 0.2]",
               "[-0.052, 0, 0.04]", "2.5", 8, 0);
}

/* ---- colours of what disperses, which may be neither the first refractor nor one by itself ----
 */

#define ASIDE                                                                                      \
  "- {name: aside, kind: spot, position: [3, 3, 1], target: [4, 4, 0], cone: 5, intensity: 1}\n"

/* Black strips on white, far below. */
static void add_strips(const char *refractors, char *text, size_t size) {
  int used = snprintf(
      text, size,
      "materials: glass.yaml\nambient: 3\n"
      "camera: {eye: [0, -0.6, 0.5], target: [0, 0, 0.1], up: [0, 0, 1], fov: 16, inside: true}\n"
      "lights:\n" ASIDE
      "objects:\n%s- {name: white, shape: rectangle, width: 9, height: 9, reflectance: 0.9,\n"
      "   transform: [{translate: [0, 1, -1]}]}\n",
      refractors);
  for (int i = 0; i < 12; i++)
    used += snprintf(text + used, size - (size_t)used,
                     "- {name: strip %d, shape: rectangle, width: 0.2, height: 9, reflectance: 0, "
                     "transform: [{translate: [%g, 1, -0.99]}]}\n",
                     i, 0.4 * i - 2.3);
}

/* Sum over all pixels of the products of R - G, and of B - G, in one and another picture. */
static double tints(const abbe_image *a, const abbe_image *b) {
  const size_t r = abbe_image_find_channel(a, "R"), g = abbe_image_find_channel(a, "G"),
               blue = abbe_image_find_channel(a, "B"), rb = abbe_image_find_channel(b, "R"),
               gb = abbe_image_find_channel(b, "G"), bb = abbe_image_find_channel(b, "B");
  double sum = 0;
  for (size_t i = 0; i < a->width * a->height; i++) {
    const float *p = a->data + i * a->channels, *q = b->data + i * b->channels;
    sum += (double)((p[r] - p[g]) * (q[rb] - q[gb]) + (p[blue] - p[g]) * (q[bb] - q[gb]));
  }
  return sum;
}

static abbe_image traced_by(const abbe_scene *scene, uint32_t seed) {
  const abbe_trace_desc desc = {
      .no_map = true, .width = SIDE, .height = SIDE, .photons = 1, .seed = seed};
  return traced_picture(scene, &desc, 24);
}

/* Noise of two traces knows nothing of each other, nor of what is drawn. */
static void check_tints(const char *text) {
  abbe_render_desc desc = small_frame;
  OWNED(abbe_scene, scene) = scene_of(text);
  desc.width = desc.height = SIDE;
  abbe_renderer *renderer = drawn_renderer(&scene, &desc);
  OWNED(abbe_image, drawn) = picture_of(renderer);
  abbe_renderer_free(renderer);
  OWNED(abbe_image, one) = traced_by(&scene, 1), other = traced_by(&scene, 2);
  const double traced = tints(&one, &other), own = tints(&drawn, &drawn);
  const double shared = 0.5 * (tints(&drawn, &one) + tints(&drawn, &other));
  print_message("of the tracer's tints %.3f are drawn, of what is drawn %.3f is traced\n",
                shared / traced, shared / own);
  assert_true(shared > 0 && shared > 0.45 * traced);
  assert_true(shared > 0.45 * own);
}

/* Air has no dispersion, but beside glass. A card's edge is seen through it. */
TEST(a_bubble_seen_from_inside_glass) {
  check_tints("materials: glass.yaml\nambient: 3\n"
              "camera: {eye: [0, -0.25, 0], target: [0.006, 0, 0], fov: 5, inside: true}\n"
              "lights:\n" ASIDE "objects:\n"
              "- {name: block, shape: box, size: [0.6, 0.6, 0.6], material: crown}\n"
              "- {name: bubble, shape: sphere, radius: 0.02, material: air}\n"
              "- {name: card, shape: box, size: [0.1, 0.002, 0.1], transform: [{translate: [0.05, "
              "0.1, 0]}], reflectance: 0.9}\n");
}

TEST(glass_behind_what_does_not_disperse) {
  char text[4096];
  add_strips("- {name: near, shape: sphere, radius: 0.07, material: flat, transform: [{translate: "
             "[0, -0.2, 0.23]}]}\n"
             "- {name: far, shape: sphere, radius: 0.07, material: crown, transform: [{translate: "
             "[0, 0, 0.1]}]}\n",
             text, sizeof text);
  check_tints(text);
}

TEST(a_ball_from_its_inside) {
  char text[4096];
  add_strips("- {name: ball, shape: sphere, radius: 0.3, material: crown, transform: [{translate: "
             "[0.1, -0.6, 0.4]}]}\n",
             text, sizeof text);
  check_tints(text);
}
