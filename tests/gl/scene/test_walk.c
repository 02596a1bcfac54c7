/* Light from refractor to refractor: stacked and nested glass against closed forms, and the same
 * surfaces by another model. */
#include "tests/gl/frame.h"

#define DOWNWARDS                                                                                  \
  "lights:\n- {name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1}\n"
#define SLAB(name, size, z, material)                                                              \
  "- {name: " name ", shape: box, size: [" size ", " size                                          \
  ", 0.1], transform: [{translate: [0, 0, " z "]}], material: " material "}\n"

/* Paths are followed far: 2e-4 of the light is left at the most. */
static const abbe_render_desc far =
    FIELDS(.width = 16, .height = 16, .photons = 32, .map_size = 64, .wavelengths = 1,
           .energy_share = 1e-5, .exits = ABBE_RENDER_MAX_EXITS);

static abbe_ledger energy_of(const char *text, const abbe_render_desc *desc) {
  OWNED(abbe_scene, scene) = scene_of(text);
  HELD(abbe_renderer, renderer) = make_renderer(&scene, desc);
  abbe_statistics s = draw_frame(renderer);
  assert_true(abbe_ledger_imbalance(&s.energy) < 1e-4);
  assert_true(s.energy.reached > 0);
  return s.energy;
}

GROUP(make_context, free_context);

/* At normal incidence light goes to and fro between the faces; in all 1/T = 1 + sum r / (1 - r). */
TEST(stacked_slabs_pass_what_they_should) {
  const double r = 0.04, t = 1 / (1 + 4 * r / (1 - r));
  abbe_ledger e = energy_of(CAMERA DOWNWARDS FLOOR SLAB("upper", "0.2", "0.4", "flat")
                                SLAB("lower", "0.3", "0.2", "flat"),
                            &far);
  /* The upper slab's light alone: what only the lower one gets passes two faces. */
  const double upper = 0.2 * 0.2, lower = 0.3 * 0.3 - upper, alone = 1 / (1 + 2 * r / (1 - r));
  assert_near(e.deposited / e.reached, (upper * t + lower * alone) / (upper + lower), 5e-3);
  assert_near(e.reflected / e.reached, r, 1e-4);
  /* of the branches between four faces the strongest four wait, and sixteen land */
  if (!(e.trapped < 5e-3 * e.reached)) print_error("trapped %g\n", e.trapped / e.reached);
  assert_true(e.trapped < 5e-3 * e.reached);
}

/* The one listed last is there: glass in glass is one solid, and nothing is reflected between. */
TEST(glass_in_the_same_glass_is_not_seen) {
  const double r = 0.04, alone = 1 / (1 + 2 * r / (1 - r));
  abbe_ledger e = energy_of(
      CAMERA DOWNWARDS FLOOR SLAB("outer", "0.3", "0.3",
                                  "flat") "- {name: inner, shape: sphere, radius: 0.04, transform: "
                                          "[{translate: [0, 0, 0.3]}], material: flat}\n",
      &far);
  assert_near(e.deposited / e.reached, alone, 1e-3);
  assert_true(e.trapped < 1e-3 * e.reached);
}

/* The same scene's refractors by their planes, and by their triangles: energies, and how far the
 * maps are apart in X, Y and Z, as a share of each. */
static void draw_both(const abbe_scene *scene, abbe_ledger energy[2], double apart[3]) {
  abbe_image map[2] = {{0}, {0}};
  abbe_render_desc desc = small_frame;
  abbe_map_layout layout;
  for (int i = 0; i < 2; i++) {
    desc.model = i == 0 ? ABBE_MODEL_CONVEX : ABBE_MODEL_BVH;
    HELD(abbe_renderer, renderer) = make_renderer(scene, &desc);
    energy[i] = draw_frame(renderer).energy;
    map[i] = map_of(renderer, 0);
    if (i == 0) abbe_renderer_map_layout(renderer, 0, &layout);
    desc.map_layout = &layout;
  }
  for (size_t c = 0; c < 3; c++) {
    double sum = 0;
    apart[c] = 0;
    for (size_t i = c; i < map[0].width * map[0].height * map[0].channels; i += map[0].channels) {
      apart[c] += fabs((double)map[0].data[i] - (double)map[1].data[i]);
      sum += (double)map[0].data[i];
    }
    apart[c] /= sum;
  }
  abbe_image_free(&map[0]);
  abbe_image_free(&map[1]);
}

/* A brick by its planes, and the same by its triangles: the same light at the same places. */
TEST(triangles_do_as_planes_do) {
  abbe_ledger e[2];
  double apart[3];
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BRICK("smoke"));
  draw_both(&scene, e, apart);
  /* cells at the outline start by the equation of the planes, or by the light's view of them, whose
   * texels are a 256th of it: a tenth of them, for its perimeter, may be wrong there by a half */
  assert_near(e[1].reached / e[0].reached, 1, 2e-3);
  assert_near(e[1].reflected / e[0].reflected, 1, 5e-3);
  /* pending branches and slots are as many as the exits here; what is cut is cut by the same rule,
   * but for the share of the first interface, which the chain does not count */
  assert_near(e[1].deposited / e[0].deposited, 1, 5e-3);
  assert_near(e[1].absorbed / e[0].absorbed, 1, 5e-3);
  assert_true(apart[1] < 0.02);
}

/* A spectrum so wide that the violet's wavelengths land an eighth of the map apart: bridged alike.
 */
TEST(triangles_spread_a_spectrum_as_planes_do) {
  abbe_ledger e[2];
  double apart[3];
  OWNED(abbe_scene, scene) = shipped_scene("prism");
  draw_both(&scene, e, apart);
  for (int c = 0; c < 3; c++) assert_true(apart[c] < 0.02);
}
