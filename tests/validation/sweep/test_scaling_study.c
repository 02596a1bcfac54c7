/* How time grows: slopes by hand, what is changed on the way, and that the scene is itself again.
 */
#include "tests/fontconfig.h"
#include "tests/gl/frame.h"

#include "validation/sweep/scaling_study.h"
#include "validation/sweep/sweep_hash.h"

/* The cheapest shaders to compile: what grows is asked of each alike. */
#define SCENE CAMERA POINT_LIGHT FLOOR BRICK("crown")

GROUP(make_context, free_context);

TEST(slopes) {
  abbe_scaling_study g = {.count = 6};
  const abbe_scaling_study_point points[] = {
      {ABBE_SCALING_PHOTONS, 10, 5, 0, 0, 0},     {ABBE_SCALING_PHOTONS, 100, 50, 0, 0, 0},
      {ABBE_SCALING_PHOTONS, 1000, 500, 0, 0, 0}, {ABBE_SCALING_PIXELS, 1, 7, 0, 0, 0},
      {ABBE_SCALING_PIXELS, 16, 28, 0, 0, 0},     {ABBE_SCALING_FACES, 4, 1, 0, 0, 0}};
  memcpy(g.point, points, sizeof points);
  assert_near(abbe_scaling_study_slope(&g, ABBE_SCALING_PHOTONS), 1, 1e-12);
  assert_near(abbe_scaling_study_slope(&g, ABBE_SCALING_PIXELS), 0.5, 1e-12);
  assert_true(isnan(abbe_scaling_study_slope(&g, ABBE_SCALING_FACES)));
  assert_true(isnan(abbe_scaling_study_slope(&g, ABBE_SCALING_SHARE)));
}

static bool never(void *user, double done) {
  (void)user;
  (void)done;
  return false;
}

TEST(all_axes) {
  OWNED(abbe_scene, scene) = {0};
  abbe_scaling_study g;
  load_text(SCENE, &scene);
  unsigned long long before = abbe_sweep_hash_scene(&scene);
  const abbe_sweep sweep = {.context = context, .scene = &scene, .frames = 1};
  REFUSED(ABBE_CANCELLED, "",
          abbe_scaling_study_measure(&sweep, &scene, 32, never, NULL, &g, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_scaling_study_measure(&sweep, &scene, 4, NULL, NULL, &g, &error));
  OK(abbe_scaling_study_measure(&sweep, &scene, 32, NULL, NULL, &g, &error));
  assert_true(abbe_sweep_hash_scene(&scene) == before);
  size_t seen[ABBE_SCALING_COUNT] = {0};
  for (size_t i = 0; i < g.count; i++) {
    const abbe_scaling_study_point *p = &g.point[i];
    seen[p->axis]++;
    assert_true(p->frame_ms > 0 && p->light_ms > 0 && p->eye_ms > 0);
    if (i > 0 && p[-1].axis == p->axis) assert_true(p->x > p[-1].x);
  }
  for (int k = 0; k < ABBE_SCALING_COUNT; k++) assert_true(seen[k] >= 4);
  /* Faces are cut into four. */
  const abbe_scaling_study_point *faces = g.point;
  while (faces->axis != ABBE_SCALING_FACES) faces++;
  assert_near(faces[0].x, g.base_x[ABBE_SCALING_FACES], 0);
  assert_near(faces[1].x, 4 * faces[0].x, 0);
  char folder[] = "/tmp/abbe-test-scaling-XXXXXX", path[64], *text;
  size_t size;
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/g.svg", folder);
  OK(abbe_scaling_study_plot(&g, path, &error));
  OK(abbe_scaling_study_save(&g, path, &error));
  OK(abbe_file_read(path, 1 << 16, &text, &size, &error));
  assert_contains(text, "axis,x,frame_ms,light_ms,eye_ms,baseline_ms\nphotons,16,");
  free(text);
  unlink(path);
  rmdir(folder);
}
