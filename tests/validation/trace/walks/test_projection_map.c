#include "tests/scenes/scene_text.h"

#include "base/maths.h"
#include "tests/patience.h"
#include "tests/random.h"
#include "validation/trace/walks/projection_map.h"

#define LIGHT(text) "lights:\n- {name: lamp, " text "}\n"
#define FAR_POINT LIGHT("kind: point, position: [0.05, 0.03, 0.6], intensity: 2")
#define SPOT(target, cone, soft)                                                                   \
  LIGHT("kind: spot, position: [0.05, 0.03, 0.6], target: " target ", intensity: 2, cone: " cone   \
        ", soft: " soft)
/* A ring of few faces: many take long under the sanitizers. */
#define COARSE_RING                                                                                \
  "- {name: ring, shape: ring, major: 0.08, minor: 0.02, around: 48, across: 24, transform: "      \
  "[{translate: [0, 0, 0.2]}], material: flat}\n"
/* Glass all around the light's horizon: walls on four sides. */
#define WALL(name, size, place)                                                                    \
  "- {name: " name ", shape: box, size: " size ", transform: [{translate: " place                  \
  "}], material: flat}\n"
#define ALL_ROUND                                                                                  \
  WALL("east", "[0.02, 1, 0.2]", "[0.5, 0, 0.6]")                                                  \
  WALL("west", "[0.02, 1, 0.2]", "[-0.5, 0, 0.6]")                                                 \
  WALL("north", "[0.98, 0.02, 0.2]", "[0, 0.5, 0.6]")                                              \
  WALL("south", "[0.98, 0.02, 0.2]", "[0, -0.5, 0.6]")

typedef struct fixture {
  abbe_scene scene;
  abbe_geometry geometry;
  abbe_projection_map aim;
} fixture;

static void make(const char *text, fixture *f) {
  f->scene = scene_of(text);
  OK(abbe_geometry_make(&f->scene, &f->geometry, &error));
  OK(abbe_projection_map_make(&f->geometry, 0, &f->aim, &error));
}

static void fixture_free(fixture *f) {
  abbe_projection_map_free(&f->aim);
  abbe_geometry_free(&f->geometry);
  abbe_scene_free(&f->scene);
}

static double dot(const float a[3], const float b[3]) {
  double sum = 0;
  for (int k = 0; k < 3; k++) sum += (double)a[k] * (double)b[k];
  return sum;
}

/* A direction evenly over the sphere. */
static void any_direction(uint64_t *random, float d[3]) {
  double z = random_between(random, -1, 1), angle = random_between(random, 0, 2 * ABBE_PI);
  double across = sqrt(1 - z * z);
  d[0] = (float)(across * cos(angle));
  d[1] = (float)(across * sin(angle));
  d[2] = (float)z;
}

/* Lambert's equal-area map, by its definition: twice the sine of half the angle to the way. */
static void on_plane(const abbe_projection_map *a, const float d[3], double at[2]) {
  double x = dot(d, a->right), y = dot(d, a->up), across = hypot(x, y);
  double r = 2 * sin(0.5 * atan2(across, dot(d, a->way)));
  at[0] = across > 0 ? r * x / across : 0;
  at[1] = across > 0 ? r * y / across : 0;
}

/* Cells by their place. */
typedef const abbe_projection_map_cell
    *cell_table[ABBE_PROJECTION_MAP_SIDE][ABBE_PROJECTION_MAP_SIDE];

static void fill_table(const abbe_projection_map *a, cell_table table) {
  memset(table, 0, sizeof(cell_table));
  for (size_t i = 0; i < a->count; i++) table[a->cell[i].y][a->cell[i].x] = &a->cell[i];
}

/* The cell of a place in the plane, or NULL where none was kept. */
static const abbe_projection_map_cell *cell_at(const abbe_projection_map *a, cell_table table,
                                               const double at[2]) {
  double x = floor((at[0] - (double)a->low) / (double)a->step);
  double y = floor((at[1] - (double)a->low) / (double)a->step);
  if (!(x >= 0 && y >= 0 && x < ABBE_PROJECTION_MAP_SIDE && y < ABBE_PROJECTION_MAP_SIDE))
    return NULL;
  return table[(int)y][(int)x];
}

/* A ray from anywhere on the light in any direction or, every other one, to somewhere in the box
 * around the refractors; frame. False where the light sends nothing that way. */
static bool any_ray(const fixture *f, size_t i, uint64_t *random, float o[3], float d[3]) {
  const abbe_light *light = &f->scene.light[0];
  double from[3], to[3], way[3], min[3], max[3];
  memcpy(from, light->position, sizeof from);
  abbe_scene_bounds(&f->scene, true, false, min, max);
  for (int k = 0; k < 3; k++) to[k] = random_between(random, min[k], max[k]);
  if (light->kind == ABBE_LIGHT_DIRECTIONAL)
    for (int k = 0; k < 3; k++) from[k] = to[k] - 10 * light->direction[k];
  if (light->kind == ABBE_LIGHT_DISK) {
    double across[3], hint[3], r = light->radius * sqrt(random_between(random, 0, 1));
    for (int k = 0; k < 3; k++) hint[k] = random_between(random, -1, 1);
    abbe_vector_cross(light->direction, hint, across);
    abbe_vector_normalise(across);
    for (int k = 0; k < 3; k++) from[k] += r * across[k];
  }
  abbe_vector_subtract(to, from, way);
  abbe_vector_normalise(way);
  for (int k = 0; k < 3; k++) d[k] = (float)way[k];
  if (i % 2 && light->kind != ABBE_LIGHT_DIRECTIONAL) any_direction(random, d);
  for (int k = 0; k < 3; k++) way[k] = (double)d[k];
  abbe_geometry_to_frame(&f->geometry, from, o);
  return light->kind == ABBE_LIGHT_DIRECTIONAL || abbe_light_profile(light, way) > 0;
}

static void check_ray(const fixture *f, cell_table table, const float o[3], const float d[3]) {
  const abbe_projection_map *a = &f->aim;
  double at[2];
  on_plane(a, d, at);
  if (a->light->kind == ABBE_LIGHT_DIRECTIONAL) {
    float across[3];
    for (int k = 0; k < 3; k++) across[k] = o[k] - a->origin[k];
    at[0] = dot(across, a->right);
    at[1] = dot(across, a->up);
  }
  const abbe_projection_map_cell *cell = cell_at(a, table, at);
  if (cell == NULL)
    fail_msg("%g %g %g meets a refractor; its place %g %g is in no cell", (double)d[0],
             (double)d[1], (double)d[2], at[0], at[1]);
  assert_true(cell->share > 0);
  const int corner[2] = {cell->x, cell->y};
  float uv[2], out[3], way[3], disk[2] = {0.3f, 0.6f};
  for (int k = 0; k < 2; k++)
    uv[k] = (float)((at[k] - (double)a->low) / (double)a->step - corner[k]);
  float flux = abbe_projection_map_ray(a, cell, uv, disk, out, way);
  if (flux <= 0)
    fail_msg("%g %g %g carries nothing: way %g, plane %g %g", (double)d[0], (double)d[1],
             (double)d[2], dot(d, a->way), at[0], at[1]);
  /* towards the far pole of the map single precision is coarse */
  assert_near(dot(way, d), 1, dot(d, a->way) > -0.9 ? 1e-6 : 1e-4);
}

/* Whichever ray meets a refractor belongs to a cell, and the cell gives this very direction.
 * Returns how many met one. */
static size_t check_covered(const char *text, size_t rays) {
  FILLED(fixture, f, make(text, &f));
  static cell_table table;
  fill_table(&f.aim, table);
  uint64_t random = 17;
  size_t met = 0;
  for (size_t i = 0; i < rays; i++) {
    float o[3], d[3];
    abbe_hit hit;
    if (!any_ray(&f, i, &random, o, d) ||
        !abbe_geometry_hit(&f.geometry, ABBE_GEOMETRY_REFRACTORS, o, d, INFINITY, &hit))
      continue;
    met++;
    check_ray(&f, table, o, d);
  }
  return met;
}

TEST(whatever_meets_a_refractor_is_in_a_cell) {
  static const char *const scenes[] = {
      CAMERA FAR_POINT FLOOR BALL("flat") COARSE_RING,
      /* close to the ball; between it and a brick; in the hole of a ring; among walls */
      CAMERA LIGHT("kind: point, position: [0, 0, 0.2801], intensity: 1") FLOOR BALL("flat"),
      CAMERA LIGHT("kind: point, position: [0.1, 0, 0.2], intensity: 1") FLOOR BALL("flat")
          BRICK("flat"),
      CAMERA LIGHT("kind: point, position: [0, 0, 0.2], intensity: 1") FLOOR COARSE_RING,
      CAMERA LIGHT("kind: point, position: [0.3, 0.2, 0.55], intensity: 1") FLOOR ALL_ROUND,
      CAMERA LIGHT(
          "kind: disk, position: [0, 0, 0.32], target: [0, 0, 0.2], radius: 0.03, radiance: 1")
          FLOOR BALL("flat"),
      CAMERA LIGHT(
          "kind: disk, position: [0, 0, 0.4], target: [0, 0, 0.2], radius: 0.05, radiance: 1")
          FLOOR COARSE_RING BRICK("flat"),
      CAMERA SUN FLOOR COARSE_RING BRICK("flat"),
      CAMERA SPOT("[0, 0, 0.2]", "5", "2") FLOOR BALL("flat"),
      /* the spot looks away from one of the two */
      CAMERA LIGHT(
          "kind: spot, position: [0.11, 0, 0.2], target: [0.3, 0, 0.2], intensity: 1, cone: 60")
          FLOOR BALL("flat") BRICK("flat"),
  };
  for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
    assert_true(check_covered(scenes[i], 4000) > 200);
}

TEST(shares_add_up_to_one) {
  static const char *const scenes[] = {CAMERA SUN FLOOR COARSE_RING,
                                       CAMERA SPOT("[0, 0, 0.2]", "5", "2") FLOOR BALL("flat")};
  for (int i = 0; i < 2; i++) {
    FILLED(fixture, f, make(scenes[i], &f));
    double sum = 0;
    for (size_t c = 0; c < f.aim.count; c++) {
      assert_true(f.aim.cell[c].share > 0);
      assert_true(f.aim.cell[c].x < ABBE_PROJECTION_MAP_SIDE &&
                  f.aim.cell[c].y < ABBE_PROJECTION_MAP_SIDE);
      sum += (double)f.aim.cell[c].share;
    }
    assert_near(sum, 1, 1e-4);
  }
}

/* Watts that reach the refractors by adding up over cells and places within them. */
static double flux_that_meets(const fixture *f, uint64_t random, size_t each) {
  double sum = 0;
  for (size_t c = 0; c < f->aim.count; c++)
    for (size_t i = 0; i < each; i++) {
      float uv[2], disk[2], o[3], d[3];
      for (int k = 0; k < 2; k++) {
        uv[k] = (float)random_between(&random, 0, 0.9999999);
        disk[k] = (float)random_between(&random, 0, 0.9999999);
      }
      float flux = abbe_projection_map_ray(&f->aim, &f->aim.cell[c], uv, disk, o, d);
      abbe_hit hit;
      if (flux > 0 &&
          abbe_geometry_hit(&f->geometry, ABBE_GEOMETRY_REFRACTORS, o, d, INFINITY, &hit))
        sum += (double)flux / (double)each;
    }
  return sum;
}

/* A ball of half angle a is seen in 2 pi (1 - cos a) sr, and a parallel beam meets pi r^2 of it.
 * The cells that are kept lie within about two cells around it. */
TEST(a_ball_gets_its_solid_angle) {
  FILLED(fixture, f, make(CAMERA FAR_POINT FLOOR BALL("flat"), &f));
  double away = sqrt(0.05 * 0.05 + 0.03 * 0.03 + 0.4 * 0.4);
  double exact = 2 * 2 * ABBE_PI * (1 - cos(asin(0.08 / away)));
  assert_near(flux_that_meets(&f, 1, 4) / exact, 1, 2e-3);
  assert_true(f.aim.reach >= exact && f.aim.reach < exact * pow(1 + 4.0 / 128, 2));
  fixture_free(&f);
  make(CAMERA SUN FLOOR BALL("flat"), &f);
  exact = ABBE_PI * 0.08 * 0.08;
  assert_near(flux_that_meets(&f, 2, 4) / exact, 1, 2e-3);
  assert_true(f.aim.reach >= exact && f.aim.reach < exact * pow(1 + 4.0 / 128, 2));
}

/* From within a ring of walls that fill z = 0.5 to 0.7 around a light in the middle: every wall is
 * a rectangle of tangents 1 by 0.1 / 0.49, seen in 4 atan(a b / sqrt(1 + a^2 + b^2)). */
TEST(walls_all_round_get_their_solid_angle) {
  OWNED(fixture, f) = {0};
  make(CAMERA LIGHT("kind: point, position: [0, 0, 0.6], intensity: 1") FLOOR ALL_ROUND, &f);
  double a = 1, b = 0.1 / 0.49;
  double exact = 4 * 4 * atan(a * b / sqrt(1 + a * a + b * b));
  assert_near(flux_that_meets(&f, 3, 8) / exact, 1, 4e-3);
}

/* A disk over a ball, both on one axis: the view factor from disk to sphere by an integral in
 * double precision of the ball's cone, cos-weighted, over the disk: for a ball wholly before the
 * disk's plane a point of it at distance D and angle t to the normal receives pi (r/D)^2 cos t. */
TEST(a_disk_lights_flux) {
  OWNED(fixture, f) = {0};
  make(CAMERA LIGHT(
           "kind: disk, position: [0, 0, 0.6], target: [0, 0, 0.2], radius: 0.1, radiance: 3")
           FLOOR BALL("flat"),
       &f);
  double exact = 0;
  enum { RINGS = 1000 };
  for (int i = 0; i < RINGS; i++) {
    double rho = 0.1 * (i + 0.5) / RINGS, square = rho * rho + 0.16;
    exact +=
        3 * 2 * ABBE_PI * rho * 0.1 / RINGS * ABBE_PI * 0.08 * 0.08 / square * 0.4 / sqrt(square);
  }
  assert_near(flux_that_meets(&f, 4, 8) / exact, 1, 4e-3);
}

/* A spot that fits into the ball: its own flux reaches it, however narrow it is. A soft edge is a
 * smoothstep in the cosine: half of the passage counts. */
TEST(a_spots_cone_is_reached_whole) {
  static const double cones[] = {10, 0.05, 0.001};
  for (size_t i = 0; i < sizeof cones / sizeof *cones; i++) {
    FILLED(fixture, f,
           make(printed(CAMERA LIGHT(
                            "kind: spot, position: [0.05, 0.03, 0.6], target: [0.001, 0, 0.2], "
                            "intensity: 2, cone: %g") FLOOR BALL("flat"),
                        cones[i]),
                &f));
    double exact = 2 * 4 * ABBE_PI * pow(sin(0.5 * cones[i] * ABBE_PI / 180), 2);
    assert_near(flux_that_meets(&f, 5 + i, 4) / exact, 1, 5e-3);
    assert_near(f.aim.reach / exact, 1, 5e-3);
  }
  FILLED(fixture, f, make(CAMERA SPOT("[0, 0, 0.2]", "9", "4") FLOOR BALL("flat"), &f));
  double inner = cos(5 * ABBE_PI / 180), outer = cos(9 * ABBE_PI / 180);
  double exact = 2 * 2 * ABBE_PI * ((1 - inner) + 0.5 * (inner - outer));
  assert_near(flux_that_meets(&f, 11, 4) / exact, 1, 3e-3);
}

/* What is behind a wall gets few photons, but some: a wall hides nothing from photons
 * that the trials missed. What is in sight gets most. */
TEST(hidden_cells_keep_a_share) {
  OWNED(fixture, f) = {0};
  make(CAMERA FAR_POINT FLOOR BALL(
           "flat") "- {name: lid, shape: rectangle, width: 0.4, height: 0.4, transform: "
                   "[{translate: [0.237, 0, 0.5]}], reflectance: 0.5}\n",
       &f);
  double share[2] = {0}, count[2] = {0};
  for (size_t c = 0; c < f.aim.count; c++) {
    float o[3], d[3], middle[2] = {0.5f, 0.5f};
    abbe_projection_map_ray(&f.aim, &f.aim.cell[c], middle, middle, o, d);
    abbe_hit hit;
    unsigned all = ABBE_GEOMETRY_REFRACTORS | ABBE_GEOMETRY_RECEIVERS;
    if (!abbe_geometry_hit(&f.geometry, all, o, d, INFINITY, &hit)) continue;
    int seen = hit.surface->kind == ABBE_GEOMETRY_REFRACTORS;
    share[seen] += (double)f.aim.cell[c].share;
    count[seen]++;
  }
  assert_true(count[0] > 100 && count[1] > 100);
  assert_true(share[0] > 0);
  assert_true(share[0] / count[0] < 0.1 * share[1] / count[1]);
}

TEST(lights_that_miss) {
  fixture f;
  make(CAMERA FAR_POINT FLOOR, &f); /* no refractor */
  assert_int_equal(f.aim.count, 0);
  assert_true(f.aim.reach == 0);
  fixture_free(&f);
  make(CAMERA SPOT("[0.05, 0.03, 2]", "20", "0") FLOOR BALL("flat"), &f); /* looks up */
  assert_int_equal(f.aim.count, 0);
  assert_true(f.aim.reach == 0);
  fixture_free(&f);
  /* a disk with its back to the ball */
  make(CAMERA LIGHT(
           "kind: disk, position: [0, 0, 0.6], direction: [0, 0, 1], radius: 0.1, radiance: 3")
           FLOOR BALL("flat"),
       &f);
  assert_true(f.aim.reach == 0);
  fixture_free(&f);
  abbe_projection_map_free(NULL);
}

/* Neighbours in the list are neighbours in the plane: most steps are of one cell. */
TEST(neighbours_stay_together) {
  FILLED(fixture, f, make(CAMERA FAR_POINT FLOOR BALL("flat"), &f));
  double steps = 0;
  for (size_t c = 1; c < f.aim.count; c++)
    steps += hypot(f.aim.cell[c].x - f.aim.cell[c - 1].x, f.aim.cell[c].y - f.aim.cell[c - 1].y);
  assert_true(steps / (double)f.aim.count < 2);
}

TEST(it_ends_when_it_is_told_to) {
  OWNED(abbe_projection_map, map) = {0};
  abbe_result result = ABBE_CANCELLED;
  patience p;
  FILLED(fixture, f, make(CAMERA FAR_POINT FLOOR COARSE_RING, &f));
  for (size_t most = 0; result == ABBE_CANCELLED; most = 2 * most + 1) {
    abbe_watch watch = {patience_lasts, &p, false};
    p = (patience){.most = most};
    abbe_watch_set(&watch);
    result = abbe_projection_map_make(&f.geometry, 0, &map, NULL);
    abbe_watch_set(NULL);
    if (result != ABBE_CANCELLED) break;
    assert_int_equal(p.asked, most + 1);
    assert_null(map.cell);
  }
  assert_int_equal(result, ABBE_OK);
  assert_true(p.asked > 20);
  assert_int_equal(map.count, f.aim.count);
  assert_memory_equal(map.cell, f.aim.cell, map.count * sizeof *map.cell);
}
