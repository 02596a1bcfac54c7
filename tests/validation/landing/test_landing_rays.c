/* Rays that leave refractors and mirrors, and what a light sees: known places, and lookups that
 * agree. */
#include "tests/check.h"
#include "tests/scenes/scene_text.h"

#include "base/maths.h"
#include "validation/landing/landing_rays.h"

#define PANE                                                                                       \
  "- {name: pane, shape: box, size: [0.3, 0.3, 0.06], transform: [{translate: [0, 0, 0.3]}], "     \
  "material: flat}\n"
#define STEEP                                                                                      \
  "- {name: mirror, shape: rectangle, width: 0.1, height: 0.1, mirror: 1, transform: [{rotate: "   \
  "{axis: [0, 1, 0], angle: 60}}, {translate: [0.1, 0, 0.15]}]}\n"

static void make(const char *text, size_t side, size_t grid, abbe_scene *scene,
                 abbe_landing_rays *rays) {
  abbe_error error = {0};
  load_text(text, scene);
  const abbe_result result = abbe_landing_rays_make(scene, 0, 550, side, grid, rays, &error);
  if (result != ABBE_OK) print_error("%s\n", error.text);
  assert_int_equal(result, ABBE_OK);
}

/* A pane shifts a ray sideways by h sin(a) (1 - cos a / (n cos b)), and does not turn it. */
TEST(a_pane_shifts) {
  OWNED(abbe_scene, scene) = {0};
  abbe_landing_rays r;
  make(CAMERA POINT_LIGHT FLOOR PANE, 64, 64, &scene, &r);
  assert_true(r.count > 20);
  for (size_t i = 0; i < r.count; i++) {
    const abbe_landing_ray *ray = &r.ray[i];
    const double *lamp = scene.light[0].position, c = -ray->direction[2], s = sqrt(1 - c * c);
    const double cos_b = sqrt(1 - s * s / 2.25), shift = 0.06 * s * (1 - c / (1.5 * cos_b));
    double from[3], along, off;
    abbe_vector_subtract(ray->origin, lamp, from);
    along = abbe_vector_dot(from, ray->direction);
    off = sqrt(fmax(abbe_vector_dot(from, from) - along * along, 0));
    assert_near(off, shift, 1e-9);
    assert_near(ray->at[2], 0, 1e-12);
    assert_near(fabs(ray->normal[2]), 1, 1e-12);
    assert_false(ray->reflected);
  }
  abbe_landing_rays_free(&r);
}

/* Off a flat mirror light comes as from the lamp's image. */
TEST(a_mirror_has_the_lamps_image) {
  OWNED(abbe_scene, scene) = {0};
  abbe_landing_rays r;
  make(CAMERA POINT_LIGHT FLOOR STEEP, 64, 256, &scene, &r);
  assert_true(r.count > 20);
  const double n[3] = {sin(acos(-1) / 3), 0, cos(acos(-1) / 3)}, middle[3] = {0.1, 0, 0.15};
  double image[3], from[3];
  abbe_vector_subtract(scene.light[0].position, middle, from);
  for (int k = 0; k < 3; k++)
    image[k] = scene.light[0].position[k] - 2 * abbe_vector_dot(from, n) * n[k];
  for (size_t i = 0; i < r.count; i++) {
    double way[3], across[3];
    assert_true(r.ray[i].reflected);
    abbe_vector_subtract(r.ray[i].at, image, way);
    abbe_vector_cross(way, r.ray[i].direction, across);
    assert_near(abbe_vector_length(across), 0, 1e-9);
  }
  abbe_landing_rays_free(&r);
}

/* The texture holds what exact lookups see at its texels' middles, and at their sides nearly. */
TEST(lookups_agree) {
  OWNED(abbe_scene, scene) = {0};
  abbe_landing_rays r;
  make(CAMERA SUN FLOOR HILL BALL("crown"), 128, 32, &scene, &r);
  size_t seen = 0;
  for (size_t i = 0; i < 128 * 128; i += 7) {
    double uv[2] = {((double)(i % 128) + 0.5) / 128, ((double)(i / 128) + 0.5) / 128}, o[3], d[3],
           at[3], a[3], b[3];
    abbe_view_ray(&r.view, uv, o, d);
    for (int k = 0; k < 3; k++) at[k] = o[k] + 0.1 * d[k];
    const bool one = abbe_landing_rays_look(&r, at, a),
               two = abbe_landing_rays_look_exactly(&r, at, b);
    assert_int_equal(one, two);
    for (int k = 0; k < 3 && one; k++) assert_near(a[k], b[k], 1e-9);
    if (one) assert_near(abbe_landing_rays_texels(&r, a, b), 0, 1e-6);
    seen += one;
  }
  assert_true(seen > 1000);
  const double aside[3] = {1e3, 0, 0};
  double found[3];
  assert_false(abbe_landing_rays_look(&r, aside, found));
  assert_false(abbe_landing_rays_look_exactly(&r, aside, found));
  abbe_landing_rays_free(&r);
}

TEST(what_is_refused) {
  OWNED(abbe_scene, scene) = {0};
  abbe_landing_rays r;
  load_text(CAMERA POINT_LIGHT FLOOR, &scene);
  REFUSED(ABBE_UNSUPPORTED, "refractors and mirrors",
          abbe_landing_rays_make(&scene, 0, 550, 64, 64, &r, &error));
  abbe_scene_free(&scene);
  load_text(CAMERA POINT_LIGHT FLOOR BALL("crown"), &scene);
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_landing_rays_make(&scene, 1, 550, 64, 64, &r, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_landing_rays_make(&scene, 0, 550, 0, 64, &r, &error));
  abbe_landing_rays_free(&r);
}
