/* Maps on receivers: how they are chosen and laid out, and that light which a light's own map
 * cannot hold lies on them as it would in the map, by a closed form, and all of it. */
#include "tests/gl/frame.h"

#include "gl/renderer_state.h"
#include "gl/scene/receiver_tiles.h"

enum { SIDE = 256, ALIGN = 32 };

static const double square[9] = {0, 0, 0, 2, 0, 0, 0, 1, 0};
static const double slanted[9] = {1, 2, 3, 1, 1, 0, 0, 1, 2};

/* Of one side each of so many charts, the other one dark. */
static abbe_tile_light **make_light(size_t count) {
  abbe_tile_light **light = calloc(2 * count, sizeof *light);
  assert_non_null(light);
  for (size_t i = 0; i < count; i++) {
    light[2 * i] = calloc(1, sizeof **light);
    assert_non_null(light[2 * i]);
  }
  return light;
}

static void free_light(abbe_tile_light **light, size_t count) {
  for (size_t i = 0; i < count; i++) free(light[2 * i]);
  free(light);
}

/* Evenly over a part of the parallelogram. */
static void shine(abbe_tile_light *light, double low, double high, double flux) {
  for (int i = 0; i < 10000; i++) {
    const double u = low + (high - low) * (i + 0.5) / 10000;
    abbe_tile_light_add(light, u, 1 - u, flux / 10000);
  }
}

GROUP(make_context, free_context);

TEST(windows_hold_the_light) {
  abbe_tile_light **light = make_light(1);
  abbe_receiver_tiles tiles;
  shine(light[0], 0.25, 0.5, 1);
  abbe_tile_light_add(light[0], 0.9, 0.1, 1e-5); /* a stray photon */
  abbe_receiver_tiles_lay_out(light, &square, 2, 4, SIDE, ALIGN, &tiles);
  assert_int_equal(tiles.count, 1);
  const double *window = tiles.tile[0].window;
  assert_true(window[0] < 0.25 && window[0] > 0.24 && window[1] > 0.4999 && window[1] < 0.51);
  assert_true(window[2] < 0.5001 && window[2] > 0.49 && window[3] > 0.75 && window[3] < 0.76);
  free_light(light, 1);
}

/* Brightest first, until a thousandth is left. */
TEST(tiles_of_what_is_worth_one) {
  enum { COUNT = ABBE_RECEIVER_TILES + 4 };
  abbe_tile_light **light = make_light(COUNT);
  double parallelogram[COUNT][9];
  const double(*all)[9] = (const double(*)[9])parallelogram;
  abbe_receiver_tiles tiles;
  double total = 0;
  for (size_t i = 0; i < COUNT; i++) {
    const double flux = i == 5 ? 1e-4 : (double)(1 + (7 * i) % COUNT);
    memcpy(parallelogram[i], i % 2 ? square : slanted, sizeof square);
    shine(light[2 * i], 0.1, 0.9, flux);
    total += flux;
  }
  abbe_receiver_tiles_lay_out(light, all, 2 * COUNT, 1001 * total, 1024, ALIGN, &tiles);
  assert_int_equal(tiles.count, 0);
  abbe_receiver_tiles_lay_out(light, all, 2 * COUNT, total, 1024, ALIGN, &tiles);
  assert_int_equal(tiles.count, ABBE_RECEIVER_TILES);
  for (size_t i = 0; i + 1 < tiles.count; i++)
    assert_true(light[tiles.tile[i].chart_side]->flux >= light[tiles.tile[i + 1].chart_side]->flux);
  for (size_t i = 0; i < COUNT; i++) light[2 * i]->flux = i == 3 ? 1 : i == 4 ? 9e-4 : 0;
  abbe_receiver_tiles_lay_out(light, all, 2 * COUNT, 1, SIDE, ALIGN, &tiles);
  assert_int_equal(tiles.count, 1);
  assert_int_equal(tiles.tile[0].chart_side, 6);
  light[8]->flux = 1.1e-3;
  abbe_receiver_tiles_lay_out(light, all, 2 * COUNT, 1, SIDE, ALIGN, &tiles);
  assert_int_equal(tiles.count, 2);
  free_light(light, COUNT);
}

/* Whatever the receivers' shapes: aligned, within the layer, none over another. */
TEST(rectangles_are_apart) {
  enum { COUNT = ABBE_RECEIVER_TILES };
  abbe_tile_light **light = make_light(COUNT);
  double parallelogram[COUNT][9] = {{0}};
  static const size_t sides[] = {32, 64, 128, 1024};
  for (size_t i = 0; i < COUNT; i++) {
    shine(light[2 * i], 0, 1, (double)(i + 1));
    parallelogram[i][3] = pow(10, (double)(i % 3) - 1);
    parallelogram[i][7] = pow(10, 1 - (double)(i % 4));
  }
  for (size_t s = 0; s < sizeof sides / sizeof *sides; s++) {
    abbe_receiver_tiles tiles;
    abbe_receiver_tiles_lay_out(light, (const double(*)[9])parallelogram, 2 * COUNT, 36, sides[s],
                                ALIGN, &tiles);
    const size_t blocks = (sides[s] / ALIGN) * (sides[s] / ALIGN);
    assert_int_equal(tiles.count, blocks < COUNT ? blocks : COUNT);
    for (size_t i = 0; i < tiles.count; i++) {
      const size_t *a = tiles.tile[i].rect;
      for (int k = 0; k < 4; k++) assert_true(a[k] % ALIGN == 0);
      assert_true(a[0] < a[1] && a[1] <= sides[s] && a[2] < a[3] && a[3] <= tiles.rows);
      for (size_t j = 0; j < i; j++) {
        const size_t *b = tiles.tile[j].rect;
        assert_true(a[1] <= b[0] || b[1] <= a[0] || a[3] <= b[2] || b[3] <= a[2]);
      }
    }
    assert_true(tiles.rows <= sides[s]);
  }
  free_light(light, COUNT);
}

/* The shaders' affine map undoes the place of a texel, and texels fill the window's area. */
TEST(places_and_texels) {
  const abbe_receiver_tile tile = {.window = {0.25, 0.5, 0.1, 0.6}, .rect = {32, 96, 64, 128}};
  float packed[ABBE_TILE_FLOATS];
  double place[3];
  abbe_receiver_tile_pack(&tile, slanted, packed);
  assert_true(packed[8] == 32 && packed[9] == 64 && packed[10] == 96 && packed[11] == 128);
  for (double x = 32; x <= 96; x += 16)
    for (double y = 64; y <= 128; y += 16) {
      abbe_receiver_tile_place(&tile, slanted, x, y, place);
      double on[3] = {packed[3], packed[7], 0};
      for (int k = 0; k < 3; k++) {
        on[0] += (double)packed[k] * place[k];
        on[1] += (double)packed[4 + k] * place[k];
        on[2] += (double)packed[12 + k] * (place[k] - slanted[k]);
      }
      assert_true(fabs(on[0] - x) < 1e-3 && fabs(on[1] - y) < 1e-3 && fabs(on[2]) < 1e-6);
    }
  const double area = sqrt(4 + 4 + 1) * 0.25 * 0.5; /* |(1,1,0) x (0,1,2)| = |(2,-2,1)| */
  assert_true(fabs(abbe_receiver_tile_texel(&tile, slanted) * 64 * 64 - area) < 1e-12);
}

#define FACING_DOWN(height)                                                                        \
  "transform: [{rotate: {axis: [1, 0, 0], angle: 180}}, {translate: [0, 0, " height "]}]"
#define LAMP                                                                                       \
  "lights:\n- {name: lamp, kind: spot, position: [0, 0, 1], target: [0, 0, 0], cone: 9, "          \
  "intensity: 1}\n"
#define GREAT_BALL                                                                                 \
  "- {name: ball, shape: sphere, radius: 0.1, levels: 5, transform: [{translate: [0, 0, 0.5]}], "  \
  "material: flat}\n"
#define LOW_EYE "materials: glass.yaml\ncamera: {eye: [0, -0.8, 0.3], target: [0, 0, 0], fov: 45}\n"
/* Between the lamp and where the ball sends a side of its light, and beside the ball's light. */
#define SCREEN                                                                                     \
  "- {name: screen, shape: rectangle, width: 0.3, height: 0.5, reflectance: 0, transform: "        \
  "[{translate: [0.215, 0, 0.42]}]}\n"

#define SHELF                                                                                      \
  "- {name: shelf, shape: rectangle, width: 0.3, height: 0.5, reflectance: 0, transform: "         \
  "[{translate: [0.8, 0, 0.1]}]}\n"
#define PEBBLE "- {name: pebble, shape: sphere, radius: 0.05, reflectance: 0.5}\n"

/* One exit: a ring of light on the floor, a side of which the lamp does not see. */
static const abbe_render_desc one_exit =
    FIELDS(.width = 96, .height = 96, .photons = 128, .map_size = 512, .exits = 1, .aovs = true,
           .space = ABBE_RGB_SPACE_XYZ);

static size_t channel_of(const abbe_image *image, const char *name) {
  const size_t channel = abbe_image_find_channel(image, name);
  assert_true(channel < image->channels);
  return channel;
}

static abbe_statistics draw(const char *text, const abbe_render_desc *desc, abbe_image *picture,
                            size_t *tiles) {
  OWNED(abbe_scene, scene) = scene_of(text);
  HELD(abbe_renderer, renderer) = make_renderer(&scene, desc);
  abbe_statistics statistics = draw_frame(renderer);
  if (picture != NULL) *picture = aovs_of(renderer);
  *tiles = renderer->atlas.used ? renderer->atlas.tiles[0].count : 0;
  return statistics;
}

/* What a screen hides from the lamp looks as it does without the screen. */
TEST(what_the_lamp_does_not_see) {
  OWNED(abbe_image, open) = {0};
  OWNED(abbe_image, hidden) = {0};
  size_t tiles = 9;
  const abbe_statistics all = draw(LOW_EYE LAMP FLOOR GREAT_BALL, &one_exit, &open, &tiles);
  assert_int_equal(tiles, 0);
  const abbe_statistics some =
      draw(LOW_EYE LAMP FLOOR GREAT_BALL SCREEN, &one_exit, &hidden, &tiles);
  assert_int_equal(tiles, 1);
  assert_true(abbe_ledger_imbalance(&some.energy) < 1e-4);
  const double reached = all.energy.reached;
  assert_true(fabs(some.energy.deposited - all.energy.deposited) < 1e-3 * reached);
  const size_t y = channel_of(&open, "caustic.Y");
  double sum = 0, difference = 0, total[2] = {0, 0};
  for (size_t i = 0; i < open.width * open.height; i++) {
    const double a = (double)open.data[i * open.channels + y];
    const double b = (double)hidden.data[i * hidden.channels + y];
    total[0] += a;
    total[1] += b;
    sum += a * a;
    difference += (a - b) * (a - b);
  }
  print_message("light %.4f of what it is without, RMS %.4f\n", total[1] / total[0],
                sqrt(difference / sum));
  assert_true(fabs(total[1] - total[0]) < 0.01 * total[0]);
  assert_true(sqrt(difference / sum) < 0.06);
}

/* A rectangle of 2 x 2, and the upper face of a mesh: a prism upside down. */
#define TILTED_RECTANGLE(angle)                                                                    \
  "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5, "            \
  "transform: [{rotate: {axis: [1, 0.3, 0], angle: " angle "}}]}\n"
#define TILTED_PRISM(angle)                                                                        \
  "objects:\n- {name: floor, shape: prism, side: 2, length: 2, reflectance: 0.5, transform: "      \
  "[{rotate: {axis: [1, 0, 0], angle: 180}}, {translate: [0, 0, -0.5773502691896258]}, "           \
  "{rotate: {axis: [1, 0.3, 0], angle: " angle "}}]}\n"

/* Where a screen hides the lamp, a mesh shows the light that a rectangle in its place does, however
 * it leans against the axes that its chart is seen along. */
TEST(meshes_show_what_rectangles_do) {
  static const char *const texts[][2] = {
      {LOW_EYE LAMP TILTED_RECTANGLE("0") GREAT_BALL SCREEN,
       LOW_EYE LAMP TILTED_PRISM("0") GREAT_BALL SCREEN},
      {LOW_EYE LAMP TILTED_RECTANGLE("25") GREAT_BALL SCREEN,
       LOW_EYE LAMP TILTED_PRISM("25") GREAT_BALL SCREEN},
  };
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    abbe_image picture[2] = {{0}, {0}};
    abbe_statistics s[2];
    for (int k = 0; k < 2; k++) {
      size_t tiles = 0;
      s[k] = draw(texts[i][k], &one_exit, &picture[k], &tiles);
      assert_int_equal(tiles, 1);
    }
    assert_true(s[1].energy.on_tiles > 0.05 * s[1].energy.reached);
    assert_true(fabs(s[1].energy.on_tiles - s[0].energy.on_tiles) < 1e-3 * s[0].energy.reached);
    const size_t y = channel_of(&picture[0], "caustic.Y");
    double sum = 0, difference = 0;
    for (size_t k = 0; k < picture[0].width * picture[0].height; k++) {
      const double a = (double)picture[0].data[k * picture[0].channels + y];
      const double b = (double)picture[1].data[k * picture[1].channels + y];
      sum += a * a;
      difference += (a - b) * (a - b);
    }
    print_message("leaning %zu: %.4f and %.4f on tiles, RMS %.4f\n", i,
                  s[0].energy.on_tiles / s[0].energy.reached,
                  s[1].energy.on_tiles / s[1].energy.reached, sqrt(difference / sum));
    assert_true(sum > 0);
    assert_true(sqrt(difference / sum) < 0.03); /* their texels differ */
    abbe_image_free(&picture[0]);
    abbe_image_free(&picture[1]);
  }
}

#define ROOM                                                                                       \
  "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5}\n"           \
  "- {name: ceiling, shape: rectangle, width: 2, height: 2, reflectance: 0.5, " FACING_DOWN(       \
      "1.2") "}\n"
#define WALLS                                                                                      \
  "- {name: east, shape: rectangle, width: 1.2, height: 2, reflectance: 0.5, transform: "          \
  "[{rotate: {axis: [0, 1, 0], angle: -90}}, {translate: [1, 0, 0.6]}]}\n"                         \
  "- {name: west, shape: rectangle, width: 1.2, height: 2, reflectance: 0.5, transform: "          \
  "[{rotate: {axis: [0, 1, 0], angle: 90}}, {translate: [-1, 0, 0.6]}]}\n"                         \
  "- {name: north, shape: rectangle, width: 2, height: 1.2, reflectance: 0.5, transform: "         \
  "[{rotate: {axis: [1, 0, 0], angle: 90}}, {translate: [0, 1, 0.6]}]}\n"                          \
  "- {name: south, shape: rectangle, width: 2, height: 1.2, reflectance: 0.5, transform: "         \
  "[{rotate: {axis: [1, 0, 0], angle: -90}}, {translate: [0, -1, 0.6]}]}\n"
#define BUBBLE                                                                                     \
  "objects:\n- {name: bubble, shape: sphere, radius: 1.5, levels: 5, reflectance: 0.5}\n"
#define CEILING_EYE                                                                                \
  "materials: glass.yaml\ncamera: {eye: [0.5, -0.3, 0.2], target: [0, 0, 1.2], fov: 2}\n"
#define BULB "lights:\n- {name: lamp, kind: point, position: [0, 0, 0.9], intensity: 1}\n"

/* The ball mirrors the lamp onto the ceiling behind it. A ray at the angle t meets the ball at d t
 * from the axis, where its normal leans by d t / R, and goes back at t + 2 d t / R; so, near the
 * axis, L further up its light has spread to x = t (d + L (1 + 2 d / R)), and
 * E = I ((n - 1) / (n + 1))^2 / (x / t)^2. */
TEST(behind_the_lamp) {
  abbe_render_desc desc = one_exit;
  size_t tiles = 0;
  desc.width = desc.height = 16;
  desc.photons = 512;
  desc.energy_share = 1e-3; /* little light asks for tiles then */
  FILLED(abbe_image, picture, draw(CEILING_EYE BULB ROOM GREAT_BALL, &desc, &picture, &tiles));
  assert_true(tiles >= 1);
  const double n = 1.5, d = 0.3, l = 0.6, radius = 0.1;
  const double spread = d + l * (1 + 2 * d / radius);
  const double e = pow((n - 1) / (n + 1) / spread, 2), radiance = 0.5 * e / 3.14159265358979;
  const size_t y = channel_of(&picture, "caustic.Y");
  const double mean = image_sum(&picture, y) / (double)(picture.width * picture.height);
  print_message("radiance %.6g, %.6g by the closed form\n", mean, radiance);
  assert_true(fabs(mean - radiance) < 0.02 * radiance);
}

static double sum_of_layer(const abbe_renderer *r, size_t layer, const abbe_receiver_tiles *tiles,
                           double *outside) {
  const size_t side = r->plan.desc.map_size;
  FREED float *texel = calloc(r->map.layers * side * side * 4, sizeof *texel);
  double sum = 0;
  assert_non_null(texel);
  r->gpu.gl->BindTexture(GL_TEXTURE_2D_ARRAY, r->map.texture);
  r->gpu.gl->GetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA, GL_FLOAT, texel);
  *outside = 0;
  for (size_t y = 0; y < tiles->rows; y++)
    for (size_t x = 0; x < side; x++) {
      const double value = (double)texel[((layer * side + y) * side + x) * 4 + 1];
      double area = 0;
      for (size_t k = 0; k < tiles->count; k++) {
        const abbe_receiver_tile *tile = &tiles->tile[k];
        if (x >= tile->rect[0] && x < tile->rect[1] && y >= tile->rect[2] && y < tile->rect[3])
          area =
              abbe_receiver_tile_texel(tile, r->scene.charts.parallelogram[tile->chart_side / 2]);
      }
      sum += value * area;
      *outside += area == 0 ? fabs(value) : 0;
    }
  return sum;
}

/* In a closed room everything lands; map and tiles hold it, each once, and nothing beside them. */
TEST(a_closed_room) {
  static const struct {
    const char *what, *text;
    size_t wavelengths;
  } rooms[] = {
      {"one ball", CEILING_EYE BULB ROOM WALLS BALL("crown"), 0},
      {"more wavelengths than all photons take", CEILING_EYE BULB ROOM WALLS BALL("crown"), 13},
      {"a round room", CEILING_EYE BULB BUBBLE BALL("crown"), 0},
      {"two refractors", CEILING_EYE BULB ROOM WALLS BALL("crown") BRICK("crown"), 0},
  };
  for (size_t i = 0; i < sizeof rooms / sizeof *rooms; i++) {
    abbe_render_desc desc = small_frame;
    desc.wavelengths = rooms[i].wavelengths;
    desc.energy_share = 1e-3; /* little light asks for tiles then */
    OWNED(abbe_scene, scene) = scene_of(rooms[i].text);
    HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
    const abbe_statistics s = draw_frame(renderer);
    const abbe_ledger *e = &s.energy;
    const abbe_receiver_tiles *tiles = &renderer->atlas.tiles[0];
    double outside = 0;
    assert_true(renderer->atlas.used);
    OWNED(abbe_image, map) = map_of(renderer, 0);
    const double beside = sum_of_layer(renderer, renderer->atlas.layer[0], tiles, &outside);
    const double both = image_sum(&map, 1) + beside;
    print_message("%s: %zu tiles, %.3f of all, missed %.2g, imbalance %.2g, open by %.2g\n",
                  rooms[i].what, tiles->count, beside / e->reached,
                  (e->missed + e->reflected) / e->reached, abbe_ledger_imbalance(e),
                  both / e->deposited - 1);
    assert_true(abbe_ledger_imbalance(e) < 1e-4);
    assert_true(e->missed + e->reflected < 2e-3 * e->reached);
    assert_true(beside > 0.01 * e->reached);
    assert_true(fabs(both - e->deposited) < 1e-4 * e->deposited);
    assert_true(fabs(beside - e->on_tiles) < 1e-4 * beside);
    assert_true(outside == 0);
  }
}

/* No tile where none is worth it, whatever the plan expects. */
TEST(no_tiles) {
  size_t tiles = 9;
  abbe_render_desc desc = one_exit;
  desc.width = desc.height = 16;
  draw(LOW_EYE LAMP FLOOR GREAT_BALL SHELF, &desc, NULL, &tiles);
  assert_int_equal(tiles, 0);
  draw(LOW_EYE LAMP "objects:\n" GREAT_BALL PEBBLE HILL, &desc, NULL, &tiles);
  assert_int_equal(tiles, 0);
  draw(LOW_EYE LAMP FLOOR GREAT_BALL SCREEN HILL, &desc, NULL, &tiles);
  assert_int_equal(tiles, 1);
}

/* More parts take light than there is room for maps: said, not left dark. */
TEST(too_many_parts) {
  abbe_renderer *renderer = NULL;
  abbe_render_desc desc = small_frame;
  desc.map_size = 64; /* four rectangles */
  desc.energy_share = 1e-3;
  OWNED(abbe_scene, scene) = scene_of(CEILING_EYE BULB BUBBLE BALL("crown"));
  REFUSED(ABBE_UNSUPPORTED, "", abbe_renderer_make(context, &scene, &desc, &renderer, &error));
  print_message("%s\n", last_error.text);
  assert_non_null(strstr(last_error.text, "'bubble'"));
  assert_non_null(strstr(last_error.text, "--map"));
}
