/* X, Y and Z lie in the map each where its own light lands, also where the whole spectrum is
 * narrower than a texel or than a photon's footprint. */
#include "tests/gl/frame.h"

#include "colorimetry/weights.h"

enum { COUNTS = 4 };

/* Of the pane, and from the lamp to the floor; m. */
static const double thickness = 0.03, way = 2.2 * 1.4142135623730951;

/* A narrow beam goes slantwise through the middle of a pane. */
#define BEAM_THROUGH_PANE                                                                          \
  "materials: glass.yaml\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"                     \
  "lights:\n- {name: lamp, kind: spot, position: [-2, 0, 2.2], target: [0.2, 0, 0], intensity: "   \
  "1,\n"                                                                                           \
  "   cone: 2, soft: 0.5}\n" FLOOR                                                                 \
  "- {name: pane, shape: box, size: [0.3, 0.3, 0.03], material: crown,\n"                          \
  "   transform: [{translate: [0, 0, 0.2]}]}\n"

/* How far the pane moves the beam aside, in the mean over X, Y and Z: a ray that meets it at the
 * angle a and goes on at b inside comes out beside its way by thickness sin(a - b) / cos(b). */
static void moved_aside(const abbe_scene *scene, double out[3]) {
  const abbe_material *material = scene->object[1].material;
  double sum[3] = {0, 0, 0};
  const double a = acos(-1) / 4;
  for (int c = 0; c < 3; c++) out[c] = 0;
  for (int k = 0; k < 400; k++) {
    double xyz[3], n = 1;
    abbe_weights_band_xyz(&scene->light[0].illuminant, 380, 780, 380 + k, 381 + k, xyz);
    abbe_material_n(material, 380.5 + k, &n, NULL);
    const double b = asin(sin(a) / n);
    for (int c = 0; c < 3; c++) sum[c] += xyz[c];
    for (int c = 0; c < 3; c++) out[c] += xyz[c] * thickness * sin(a - b) / cos(b);
  }
  for (int c = 0; c < 3; c++) out[c] /= sum[c];
}

/* The mean place of X, Y and Z in the map's window, as tangents. What is shared out bilinearly
 * keeps it, however wide the texels. */
static void middles(const abbe_image *map, const abbe_map_layout *layout, double at[3][2]) {
  for (size_t c = 0; c < 3; c++) {
    double sum[2] = {0, 0};
    for (size_t i = 0; i < map->width * map->height; i++) {
      const double value = (double)map->data[i * map->channels + c];
      sum[0] += value * ((double)(i % map->width) + 0.5);
      sum[1] += value * ((double)(i / map->width) + 0.5);
    }
    for (int k = 0; k < 2; k++)
      at[c][k] = sum[k] / image_sum(map, c) * abbe_map_layout_texel_size(layout, k, map->width, 0);
  }
}

static void assert_parted(const abbe_scene *scene, const abbe_render_desc *desc) {
  double aside[3], at[3][2];
  moved_aside(scene, aside);
  FILLED(abbe_image, map, make_map(scene, desc, &map));
  middles(&map, desc->map_layout, at);
  const double texel = abbe_map_layout_texel_size(desc->map_layout, 0, map.width, 0);
  const double widest = fabs(aside[2] - aside[1]) / way;
  assert_true(widest < 0.15 * texel);
  for (size_t c = 0; c < 3; c += 2) {
    const double apart = hypot(at[c][0] - at[1][0], at[c][1] - at[1][1]);
    const double expected = fabs(aside[c] - aside[1]) / way;
    print_message("%zu texels, %zu wavelengths: %c lies %.4f of a texel from Y, and should %.4f\n",
                  desc->map_size, desc->wavelengths, c == 0 ? 'X' : 'Z', apart / texel,
                  expected / texel);
    assert_near(apart, expected, 0.03 * widest);
  }
}

GROUP(make_context, free_context);

/* Violet leaves the pane beside red by a fortieth of a texel to a tenth, and by less than that of a
 * photon's footprint: however many wavelengths tell, bridged or each by itself, it lands there. The
 * beam's cone, of a degree, makes up to 2 % of that. */
TEST(colours_part_within_a_texel) {
  static const size_t counts[COUNTS] = {3, 5, 7, 21};
  abbe_map_layout fitted, even;
  abbe_render_desc desc = small_frame;
  desc.width = desc.height = 16;
  desc.exits = 1;
  OWNED(abbe_scene, scene) = scene_of(BEAM_THROUGH_PANE);
  abbe_renderer *renderer = make_renderer(&scene, &desc);
  abbe_renderer_map_layout(renderer, 0, &fitted);
  abbe_renderer_free(renderer);
  abbe_map_layout_make(&fitted.view, &even);
  desc.map_layout = &even;
  for (desc.map_size = 64; desc.map_size <= 256; desc.map_size *= 2) {
    for (size_t i = 0; i < COUNTS; i++) {
      desc.wavelengths = counts[i];
      assert_parted(&scene, &desc);
    }
    desc.fill = ABBE_FILL_NONE;
    assert_parted(&scene, &desc);
    desc.fill = ABBE_FILL_AUTO;
  }
}
