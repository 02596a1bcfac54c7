/* How much of a cell an object leaves: of a ball in a grid, by its volume. */
#include "tests/scenes/scene_text.h"

#include "base/maths.h"
#include "validation/lab/lone_object.h"

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
