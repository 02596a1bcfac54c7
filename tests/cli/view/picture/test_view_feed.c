/* Which facets feed a place, with hits that are made here. */
#include "tests/check.h"

#include "cli/view/picture/view_feed.h"
#include "cli/view/picture/view_show.h"

#include <time.h>

enum { GRID = 16 };

/* A cube of 2 m around the origin, a quad a side in two triangles. */
static void make_cube(abbe_object *object) {
  static const double corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                      {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
  static const uint32_t side[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  static const abbe_material glass = {.name = "glass"};
  *object = (abbe_object){.material = &glass, .min = {-1, -1, -1}, .max = {1, 1, 1}};
  OK(abbe_mesh_make(8, 12, false, &object->mesh, &error));
  memcpy(object->mesh.position, corner, sizeof corner);
  for (int i = 0; i < 6; i++)
    for (int k = 0; k < 3; k++) {
      object->mesh.face[2 * i][k] = side[i][k];
      object->mesh.face[2 * i + 1][k] = side[i][k == 0 ? 0 : k + 1];
    }
}

/* Photons of a beam downward from above, one a cell, which all land at their own cell's place on
 * the level z = -3, each by a path of its own. */
static void shine(float *at, unsigned *cell, abbe_view_hits *out, double tilt) {
  static unsigned path[GRID * GRID];
  const double origin[3] = {3 * tilt, 0, 3}, down[3] = {-tilt, 0, -1}, up[3] = {0, 1, 0};
  *out = (abbe_view_hits){0};
  abbe_view_look(origin, down, up, true, &out->view);
  const double window[4] = {-0.8, 0.8, -0.8, 0.8};
  memcpy(out->view.window, window, sizeof window);
  out->at = at;
  out->cell = cell;
  out->count = (size_t)GRID * GRID;
  out->slots = out->samples = 1;
  out->grid[0] = out->grid[1] = GRID;
  out->path = path;
  out->last = true;
  for (unsigned y = 0; y < GRID; y++)
    for (unsigned x = 0; x < GRID; x++) {
      const unsigned i = y * GRID + x;
      cell[i] = x | y << 16;
      path[i] = i + 1;
      const float hit[4] = {(float)x, (float)y, -3, 0.5F};
      memcpy(at + 4 * (size_t)i, hit, sizeof hit);
    }
}

static void from_above(bool mirror) {
  static float at[4 * GRID * GRID];
  static unsigned cell[GRID * GRID];
  static abbe_view_feed feed;
  abbe_object object[2] = {{0}};
  make_cube(&object[1]);
  object[1].mirror = mirror;
  if (mirror) object[1].material = NULL;
  const abbe_scene scene = {.object_count = 2, .object = object};
  abbe_view_hits hits;
  shine(at, cell, &hits, 0);
  abbe_view_feed_begin((const double[3]){4, 7, -3}, 1.1, &feed); /* that cell and four around */
  OK(abbe_view_feed_add(&feed, &hits, &error));
  abbe_view_feed_end(&feed, &scene, NULL);
  assert_int_equal(feed.photons, 5);
  assert_int_equal(feed.ray_count, 5);
  double whole = 0;
  for (size_t i = 0; i < 5; i++) {
    whole += feed.ray[i].share;
    assert_near(feed.ray[i].entry[2], 1, 1e-12); /* the top, straight below where it began */
    for (int k = 0; k < 2; k++) assert_near(feed.ray[i].entry[k], feed.ray[i].light[k], 1e-12);
    assert_int_equal(feed.ray[i].facet, 0);
  }
  assert_near(whole, 1, 1e-12);
  assert_int_equal(feed.facet_count, 1);
  assert_int_equal(feed.facet[0].object, 1);
  assert_near(feed.facet[0].normal[2], 1, 1e-12);
  assert_near(feed.facet[0].offset, 1, 1e-12);
  assert_near(feed.facet[0].share, 1, 1e-12);
  assert_int_equal(feed.edge_count, 4); /* of two triangles, but for the one that they share */
  for (size_t i = 0; i < 4; i++)
    for (int k = 0; k < 2; k++) assert_near(feed.edge[i][k][2], 1, 0);
  abbe_mesh_free(&object[1].mesh);
}

TEST(light_from_above_comes_through_the_top) {
  from_above(false);
}

TEST(light_comes_off_a_mirror_alike) {
  from_above(true);
}

/* Aslant, of the beam's height one part meets the top and one the side, as the sines say. */
TEST(two_facets_share_as_they_are_seen) {
  static float at[4 * GRID * GRID];
  static unsigned cell[GRID * GRID];
  static abbe_view_feed feed;
  abbe_object object = {0};
  make_cube(&object);
  const abbe_scene scene = {.object_count = 1, .object = &object};
  abbe_view_hits hits;
  shine(at, cell, &hits, 1);
  abbe_view_feed_begin((const double[3]){7.5, 7.5, -3}, 7.6, &feed); /* 178 cells, all alike */
  OK(abbe_view_feed_add(&feed, &hits, &error));
  abbe_view_feed_end(&feed, &scene, NULL);
  assert_true(feed.photons > 150 && feed.photons < ABBE_VIEW_FEED_RAYS);
  assert_int_equal(feed.ray_count, feed.photons);
  assert_int_equal(feed.facet_count, 2); /* at 45 degrees they are seen alike */
  assert_near(feed.facet[0].share, 0.5, 1e-12);
  assert_near(feed.facet[0].share + feed.facet[1].share, 1, 1e-12);
  for (size_t i = 0; i < feed.ray_count; i++) {
    const abbe_view_facet *f = &feed.facet[feed.ray[i].facet];
    double along = 0;
    for (int k = 0; k < 3; k++) along += f->normal[k] * feed.ray[i].entry[k];
    assert_near(along, f->offset, 1e-9);
  }
  assert_int_equal(feed.edge_count, 8);
  abbe_mesh_free(&object.mesh);
}

TEST(nothing_lands_or_nothing_is_met) {
  static float at[4 * GRID * GRID];
  static unsigned cell[GRID * GRID];
  static abbe_view_feed feed;
  const abbe_scene scene = {0};
  abbe_view_hits hits;
  shine(at, cell, &hits, 0);
  abbe_view_feed_begin((const double[3]){4, 7, 5}, 1.1, &feed);
  OK(abbe_view_feed_add(&feed, &hits, &error));
  abbe_view_feed_end(&feed, &scene, NULL);
  assert_int_equal(feed.photons + feed.ray_count + feed.facet_count + feed.edge_count, 0);
  const volatile int stop = 1;
  hits.stop = &stop;
  abbe_view_feed_begin((const double[3]){4, 7, -3}, 1.1, &feed);
  OK(abbe_view_feed_add(&feed, &hits, &error));
  assert_int_equal(feed.photons, 0);
  hits.stop = NULL;
  OK(abbe_view_feed_add(&feed, &hits, &error));
  abbe_view_feed_end(&feed, &scene, NULL);
  assert_int_equal(feed.photons, 5);
  assert_int_equal(feed.ray_count + feed.facet_count, 0);
}

/* Rays are followed until it is told to stop. */
TEST(a_look_is_given_up) {
  static float at[4 * GRID * GRID];
  static unsigned cell[GRID * GRID];
  static abbe_view_feed feed;
  abbe_object object = {0};
  make_cube(&object);
  const abbe_scene scene = {.object_count = 1, .object = &object};
  abbe_view_hits hits;
  shine(at, cell, &hits, 0);
  for (int stop = 0; stop < 2; stop++) {
    const volatile int told = stop;
    abbe_view_feed_begin((const double[3]){4, 7, -3}, 1.1, &feed);
    OK(abbe_view_feed_add(&feed, &hits, &error));
    abbe_view_feed_end(&feed, &scene, &told);
    assert_int_equal(feed.ray_count, stop ? 0 : 5);
    assert_int_equal(feed.facet_count, stop ? 0 : 1);
  }
  abbe_mesh_free(&object.mesh);
}

static size_t count_lights(const abbe_view_hits *hits, const double point[3], double radius) {
  static const abbe_scene nothing = {0};
  static abbe_view_feed feed;
  abbe_view_feed_begin(point, radius, &feed);
  OK(abbe_view_feed_add(&feed, hits, &error));
  abbe_view_feed_end(&feed, &nothing, NULL);
  return feed.photons;
}

/* Hits a metre apart, asked for at places far from all: between neighbours of one path there is
 * light, between others there is none, and beside the outermost none either. */
TEST(light_lies_between_neighbours) {
  enum { LEFT = 7 }; /* columns below it are of one path, the others of another */
  static float at[4 * GRID * GRID];
  static unsigned cell[GRID * GRID], path[GRID * GRID];
  abbe_view_hits hits;
  const double between[3] = {3.45, 7.3, -3}, apart[3] = {LEFT - 0.2, 7.3, -3};
  const double torn[3] = {LEFT - 0.49, 7.3, -3}, beside[3] = {-0.7, 7.3, -3};
  shine(at, cell, &hits, 0);
  assert_int_equal(count_lights(&hits, between, 0.1), 0);
  for (int i = 0; i < GRID * GRID; i++) path[i] = i % GRID < LEFT ? 1 : 2;
  hits.path = path;
  assert_int_equal(count_lights(&hits, between, 0.1), 2); /* x 3, and 4 from 3.5 on */
  assert_int_equal(count_lights(&hits, apart, 0.1), 1);   /* the right one's half alone */
  assert_int_equal(count_lights(&hits, torn, 0.1), 2);    /* where both end */
  assert_int_equal(count_lights(&hits, beside, 0.1), 0);
  assert_int_equal(count_lights(&hits, between, 0.03),
                   0); /* a metre is a tear to so small a place */
}

/* Three wavelengths that one photon spreads over 20 m, and two batches of two of them. */
TEST(light_lies_between_wavelengths) {
  const float at[12] = {-3, 0, 0, 1, 7, 0, 0, 1, 17, 0, 0, 1};
  const unsigned path[3] = {5, 5, 5}, torn[3] = {5, 5, 6}, cell[1] = {0};
  abbe_view_hits hits;
  static float grid_at[4 * GRID * GRID];
  static unsigned grid_cell[GRID * GRID];
  shine(grid_at, grid_cell, &hits, 0);
  hits.at = at;
  hits.path = path;
  hits.cell = cell;
  hits.count = hits.grid[0] = hits.grid[1] = 1;
  hits.samples = 3;
  for (int x = -3; x < 18; x++)
    assert_int_equal(count_lights(&hits, (const double[3]){x, 0.4, 0}, 0.5), 1);
  assert_int_equal(count_lights(&hits, (const double[3]){-3.6, 0, 0}, 0.5), 0);
  assert_int_equal(count_lights(&hits, (const double[3]){12, 0.6, 0}, 0.5), 0);
  hits.path = torn;
  assert_int_equal(count_lights(&hits, (const double[3]){2, 0, 0}, 0.5), 1);
  assert_int_equal(count_lights(&hits, (const double[3]){12, 0, 0}, 0.5), 0);
  assert_int_equal(count_lights(&hits, (const double[3]){17, 0, 0}, 0.5), 1);
  /* in batches that share the middle one: one photon, and each wavelength's flux once */
  static abbe_view_feed feed;
  abbe_view_feed_begin((const double[3]){7, 0, 0}, 11, &feed);
  hits.path = path;
  hits.samples = 2;
  hits.last = false;
  OK(abbe_view_feed_add(&feed, &hits, &error));
  hits.at = at + 4;
  hits.last = true;
  OK(abbe_view_feed_add(&feed, &hits, &error));
  assert_int_equal(feed.photons, 1);
  assert_near(feed.flux, 3, 1e-12);
  abbe_view_feed_end(&feed, &(const abbe_scene){0}, NULL);
}

/* A grid that is coarser one way than the other: rays go through the middles of its own cells. */
TEST(cells_of_an_oblong_grid) {
  static float at[4 * GRID * GRID];
  static unsigned cell[GRID * GRID];
  static abbe_view_feed feed;
  abbe_object object = {0};
  make_cube(&object);
  const abbe_scene scene = {.object_count = 1, .object = &object};
  abbe_view_hits hits;
  shine(at, cell, &hits, 0);
  hits.grid[1] = 2 * GRID;
  abbe_view_feed_begin((const double[3]){8, 15, -3}, 0.5, &feed);
  OK(abbe_view_feed_add(&feed, &hits, &error));
  abbe_view_feed_end(&feed, &scene, NULL);
  assert_int_equal(feed.ray_count, 1);
  const double right = fabs(feed.ray[0].entry[0]), above = fabs(feed.ray[0].entry[1]);
  assert_near(right, 1.6 * (8.5 / GRID - 0.5), 1e-9);
  assert_near(above, 1.6 * (0.5 - 15.5 / (2 * GRID)), 1e-9);
  abbe_mesh_free(&object.mesh);
}

/* On the cube, seen from outside; not before it, nor beside it on the ground. What is seen through
 * it is asked for then, where that is a receiver. */
TEST(what_is_seen_may_be_the_refractor) {
  static abbe_view_feed feed;
  static abbe_material glass = {.name = "glass", .min_nm = 380, .max_nm = 780};
  abbe_object object[2] = {{0}};
  make_cube(&object[0]);
  make_cube(&object[1]); /* far below: a floor */
  for (size_t i = 0; i < 8; i++) object[1].mesh.position[i][2] -= 4;
  object[0].material = &glass;
  object[1].material = NULL;
  glass.dispersion.model = ABBE_DISPERSION_CONSTANT;
  glass.dispersion.count = 1;
  glass.dispersion.c[0] = 1.5;
  const abbe_scene scene = {.object_count = 2, .object = object, .camera.eye = {0.2, 0.1, 5}};
  const struct {
    double point[3], height;
    bool on;
  } cases[] = {{{0.2, 0.1, 1}, -3, true}, {{3, 0, -1}, -1, false}, {{0.2, 0.1, 3}, 3, false}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    abbe_view_feed_begin(cases[i].point, 0.01, &feed);
    assert_true(abbe_view_feed_look(&feed, &scene, 550));
    assert_true(feed.on_refractor == cases[i].on);
    assert_near(feed.point[2], cases[i].height, 1e-9);
    assert_near(feed.radius, cases[i].on ? 0.01 * 8 / 4 : 0.01, 1e-9);
  }
  const abbe_scene alone = {.object_count = 1, .object = object, .camera.eye = {0.2, 0.1, 5}};
  abbe_view_feed_begin(cases[0].point, 0.01, &feed);
  assert_false(abbe_view_feed_look(&feed, &alone, 550)); /* nothing lies behind */
  for (int k = 0; k < 2; k++) abbe_mesh_free(&object[k].mesh);
}

/* A table that a thread makes: none at first, then the one that abbe_display_table_make makes. */

enum { SIDE = 64 };

static void make_image(abbe_image *out) {
  static const char *const names[] = {"R", "G", "B"};
  OK(abbe_image_make(SIDE, SIDE, 3, names, out, &error));
  for (size_t i = 0; i < 3 * SIDE * SIDE; i++)
    out->data[i] = (float)exp2(0.01 * (double)(i * 7919 % 1200) - 9);
}

TEST(it_is_the_one_that_is_made_at_once) {
  const abbe_display_desc desc = {.display = "sRGB", .view = "Looking"};
  const struct timespec time = {.tv_nsec = 1000000};
  abbe_display *display = NULL;
  abbe_display_table *other = NULL;
  OK(abbe_display_make(&desc, &display, &error));
  abbe_view_table *table = abbe_view_table_begin(display);
  assert_non_null(table);
  OK(abbe_display_table_make(display, &other, &error));
  while (abbe_view_table_get(table) == NULL) nanosleep(&time, NULL);
  FILLED(abbe_image, a, make_image(&a));
  FILLED(abbe_image, b, make_image(&b));
  OK(abbe_display_table_apply(abbe_view_table_get(table), &a, &error));
  OK(abbe_display_table_apply(other, &b, &error));
  assert_memory_equal(a.data, b.data, 3 * sizeof *a.data * SIDE * SIDE);
  abbe_display_table_free(other);
  abbe_view_table_free(table);
  abbe_display_free(display);
}

TEST(it_may_be_left_before_it_is_made) {
  abbe_display *display = NULL;
  OK(abbe_display_make(&(abbe_display_desc){.view = NULL}, &display, &error));
  abbe_view_table_free(abbe_view_table_begin(display));
  assert_null(abbe_view_table_get(NULL));
  abbe_view_table_free(NULL);
  abbe_display_free(display);
}

/* Where a look into refractors ends: a slab, a cube that light cannot leave by its side, a ball. */

static abbe_material glass = {.name = "glass", .min_nm = 380, .max_nm = 780};

/* A box, outward all around. */
static void make_box(const double low[3], const double high[3], const abbe_material *material,
                     abbe_object *object) {
  static const uint32_t side[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  *object = (abbe_object){.material = material};
  OK(abbe_mesh_make(8, 12, false, &object->mesh, &error));
  for (int i = 0; i < 8; i++)
    for (int k = 0; k < 3; k++) object->mesh.position[i][k] = (i >> k & 1) != 0 ? high[k] : low[k];
  for (int i = 0; i < 6; i++)
    for (int k = 0; k < 3; k++) {
      object->mesh.face[2 * i][k] = side[i][k];
      object->mesh.face[2 * i + 1][k] = side[i][k == 0 ? 0 : k + 1];
    }
}

/* A box of glass over a floor far below, and a look down at an angle to the vertical. */
static void look(const double low[3], const double high[3], double x, double angle,
                 abbe_view_sight *out) {
  static const double ground[2][3] = {{-100, -100, -11}, {100, 100, -10}};
  abbe_object object[2];
  const abbe_scene scene = {.object_count = 2, .object = object};
  glass.dispersion.model = ABBE_DISPERSION_CONSTANT;
  glass.dispersion.count = 1;
  glass.dispersion.c[0] = 1.5;
  make_box(low, high, &glass, &object[0]);
  make_box(ground[0], ground[1], NULL, &object[1]);
  /* off the diagonals of the sides */
  const double along[3] = {sin(angle), 0, -cos(angle)};
  const double eye[3] = {x - 5 * along[0], 0.13, high[2] - 5 * along[2]};
  abbe_view_sight_follow(&scene, eye, along, 550, out);
  for (int k = 0; k < 2; k++) abbe_mesh_free(&object[k].mesh);
}

/* Its ray goes on as it came, beside its line by t sin(a) (1 - cos(a) / (n cos(b))). */
TEST(a_slab_shifts) {
  static const double low[3] = {-50, -50, -1}, high[3] = {50, 50, 0};
  for (int degrees = 0; degrees < 80; degrees += 20) {
    const double a = degrees * acos(-1) / 180, b = asin(sin(a) / 1.5);
    abbe_view_sight sight;
    look(low, high, 0.2, a, &sight);
    assert_true(sight.lands);
    assert_int_equal(sight.count, 3);
    const double straight = 0.2 + 10 * tan(a), shift = sin(a) * (1 - cos(a) / (1.5 * cos(b)));
    assert_near(sight.place[2][0], straight - shift / cos(a), 1e-9);
    assert_near(sight.place[2][2], -10, 1e-9);
    assert_near(sight.length, 5 + 1 / cos(b) + 9 / cos(a), 1e-9);
  }
}

/* From n = 1.5 no light that came in by the top leaves by a side: asin(1 / 1.5) is 41.8 degrees,
 * and it meets sides at 48.2 or more. It leaves by the bottom as it came in, its x turned back. */
TEST(a_cube_turns_it_back) {
  static const double low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};
  const double a = 0.9, b = asin(sin(a) / 1.5);
  abbe_view_sight sight;
  look(low, high, 0.7, a, &sight);
  assert_true(sight.lands);
  assert_int_equal(sight.count, 4); /* top, side, bottom, ground */
  assert_near(sight.place[1][0], 1, 1e-12);
  assert_near(sight.place[2][2], -1, 1e-12);
  const double out = 2 - (0.7 + 2 * tan(b));
  assert_near(sight.place[2][0], out, 1e-9);
  assert_near(sight.place[3][0], out - 9 * tan(a), 1e-9);
}

TEST(what_does_not_land) {
  static const double low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};
  abbe_view_sight sight;
  look(low, high, 0, acos(-1), &sight); /* upward, from below the floor's top */
  assert_int_equal(sight.count, 2);
  assert_false(sight.lands);
  abbe_object object;
  make_box(low, high, &glass, &object);
  const abbe_scene alone = {.object_count = 1, .object = &object};
  abbe_view_sight_follow(&alone, (const double[3]){0.2, 0.1, 5}, (const double[3]){0, 0, -1}, 550,
                         &sight);
  assert_int_equal(sight.count, 2);
  assert_false(sight.lands);
  abbe_view_sight_follow(&alone, (const double[3]){0.2, 0.1, 5}, (const double[3]){0, 0, -1}, 900,
                         &sight); /* no index is known there */
  assert_int_equal(sight.count, 1);
  abbe_view_sight_follow(&alone, (const double[3]){0.2, 0.1, 5}, (const double[3]){0, 0, 1}, 550,
                         &sight);
  assert_int_equal(sight.count, 0);
  abbe_mesh_free(&object.mesh);
}
