/* Kinds of polygons of photons in image space: beams that are alike, light by corners, what lies
 * between surfaces, and the light's image; and what gathers in two images have in common. */
#include "tests/gl/methods/image_space/image_pictures.h"

GROUP(make_context, free_context);

/* As printed, by beams that are all alike: under the lamp, in the middle of a field of 90 degrees,
 * a cell has 4 / N^2 sr, and the mean one 2 pi / 3 / N^2. */
TEST(even_beams) {
  double spread;
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR PANE("flat"));
  abbe_render_desc desc = small;
  desc.width = desc.height = 192;
  desc.profile = ABBE_PROFILE_WYMAN2006;
  desc.space = ABBE_RGB_SPACE_REC709;
  desc.fill = ABBE_FILL_QUADS;
  desc.polygons = ABBE_POLYGONS_EVEN;
  FILLED(abbe_image, picture, make_picture(&scene, &desc, &picture));
  const double mean = middle(&picture, &spread), share = 3.14159265358979 / 6 / pow(0.99, 3);
  print_message("even beams: %.4f\n", mean);
  assert_near(mean, 0.5 * (0.99 * share + 0.1), 0.015);
}

/* Other kinds of polygons: what arrives is what was sent, by quads and triangles alike, and behind
 * the pane it is the direct light, also where the light projects it. */
TEST(polygons_of_other_kinds) {
  static const unsigned kinds[] = {ABBE_POLYGONS_CORNERS, ABBE_POLYGONS_CULLED,
                                   ABBE_POLYGONS_IN_LIGHT,
                                   ABBE_POLYGONS_CORNERS | ABBE_POLYGONS_IN_LIGHT};
  abbe_image picture = {0};
  double spread, own_spread;
  OWNED(abbe_scene, pane) = scene_of(CAMERA POINT_LIGHT FLOOR PANE("flat"));
  OWNED(abbe_scene, mirror) = scene_of(CAMERA POINT_LIGHT FLOOR MIRROR("0.8"));
  abbe_render_desc desc = small;
  desc.width = desc.height = 192;
  for (int f = 0; f < 2; f++) {
    desc.fill = f == 0 ? ABBE_FILL_QUADS : ABBE_FILL_TRIANGLES;
    desc.polygons = 0;
    make_picture(&pane, &desc, &picture);
    const double own = middle(&picture, &own_spread), sent = map_energy(&mirror, &desc);
    abbe_image_free(&picture);
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
      desc.polygons = kinds[k];
      make_picture(&pane, &desc, &picture);
      const double mean = middle(&picture, &spread), arrives = map_energy(&mirror, &desc);
      print_message("%s, %u: %.4f and %.4f, spread %.3f\n", abbe_fill_name(desc.fill), kinds[k],
                    mean / own, arrives / sent, spread);
      assert_near(mean / own, 1, 0.01);
      assert_near(arrives / sent, 1, 0.02);
      assert_true(spread < own_spread + 0.01);
      abbe_image_free(&picture);
    }
  }
}

/* A step under the pane: one column of cells lies between it and the floor. It is under the lamp,
 * where a column has a little more light than its share. */
TEST(polygons_between_surfaces) {
  OWNED(abbe_scene, scene) = scene_of(
      CAMERA POINT_LIGHT FLOOR "- {name: step, shape: rectangle, width: 1, height: 2, reflectance: "
                               "0.5, transform: [{translate: [0.561, 0, 0.1]}]}\n" PANE("flat"));
  for (int f = 0; f < 2; f++) {
    abbe_render_desc desc = small;
    desc.fill = f == 0 ? ABBE_FILL_QUADS : ABBE_FILL_TRIANGLES;
    desc.photons = 128;
    desc.map_size = 1024;
    abbe_renderer *renderer = make_renderer(&scene, &desc);
    const double columns = 128 * sqrt(draw_frame(renderer).refractor_share) - 1;
    abbe_renderer_free(renderer);
    const double kept = map_energy(&scene, &desc);
    desc.polygons = ABBE_POLYGONS_CULLED;
    const double lost = columns * (1 - map_energy(&scene, &desc) / kept);
    print_message("%s: of %.1f columns %.3f are between\n", abbe_fill_name(desc.fill), columns,
                  lost);
    assert_near(lost, 1.15, 0.25);
  }
}

/* A mirror's light on the floor, seen from nearby. */
static void load_mirror(const char *share, abbe_scene *out) {
  *out = scene_of(
      printed("materials: glass.yaml\ncamera: {eye: [0.9, 0, 0.6], target: [0.34, 0, 0], fov: "
              "22}\n" POINT_LIGHT FLOOR MIRROR("%s"),
              share));
}

/* G4. What the camera's image and the light's gather draws near as pixels and texels shrink: the
 * mean difference by the mean light of the mirror. */
TEST(gathers_agree) {
  double apart[2];
  FILLED(abbe_scene, dark, load_mirror("0.0001", &dark));
  FILLED(abbe_scene, bright, load_mirror("0.8", &bright));
  for (int k = 0; k < 2; k++) {
    abbe_image picture[3];
    abbe_render_desc desc = small;
    double off = 0, all = 0;
    desc.width = desc.height = k == 0 ? 64 : 192;
    desc.map_size = k == 0 ? 128 : 384;
    desc.photons = 1024;
    for (int i = 0; i < 3; i++) {
      desc.fill = i == 1 ? ABBE_FILL_GATHER_EYE : ABBE_FILL_GATHER_LIGHT;
      make_picture(i == 0 ? &dark : &bright, &desc, &picture[i]);
    }
    for (size_t p = 0; p < desc.width * desc.height; p++) {
      const size_t at = p * picture[0].channels + 1;
      off += fabs((double)picture[1].data[at] - (double)picture[2].data[at]);
      all += (double)picture[2].data[at] - (double)picture[0].data[at];
    }
    apart[k] = off / all;
    for (int i = 0; i < 3; i++) abbe_image_free(&picture[i]);
  }
  print_message("gathers are %.4f apart, then %.4f\n", apart[0], apart[1]);
  assert_true(apart[0] > 0 && apart[1] < 0.6 * apart[0]);
}
