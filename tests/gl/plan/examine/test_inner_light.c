/* What convex solids keep inside: known answers, and what the renderer's ledger says. */
#include "tests/gl/frame.h"

#include "base/maths.h"
#include "gl/plan/examine/examine.h"
#include "gl/plan/plan.h"

static const double share_of_nothing = 1e-12;

/* A solid of planes that lies within 1 m of the origin, and parallel rays onto it along d. */
static abbe_exact solid_of(double (*plane)[4], size_t count) {
  return (abbe_exact){.kind = ABBE_EXACT_CONVEX, .count = count, .plane = plane};
}

static abbe_view rays_along(const double d[3], double half_width) {
  static const double origin[3] = {0, 0, 0}, up[3] = {0, 1, 0};
  abbe_view view;
  double from[3];
  for (int k = 0; k < 3; k++) from[k] = origin[k] - 10 * d[k];
  abbe_view_look(from, d, up, true, &view);
  for (int k = 0; k < 4; k++) view.window[k] = k % 2 == 0 ? -half_width : half_width;
  return view;
}

#define THICKNESS 0.1
static double slab[6][4] = {{0, 0, 1, THICKNESS}, {0, 0, -1, 0}, {1, 0, 0, 1},
                            {-1, 0, 0, 1},        {0, 1, 0, 1},  {0, -1, 0, 1}};
static const double down[3] = {0, 0, -1};

static double reflected_straight(double n) {
  return pow((n - 1) / (n + 1), 2);
}

GROUP(make_context, free_context);

TEST(a_slab_keeps_a_geometric_series) {
  const double n = 1.5, r = reflected_straight(n), per_m = 3;
  const abbe_exact solid = solid_of(slab, 6);
  const abbe_view view = rays_along(down, 0.5);
  for (int tinted = 0; tinted < 2; tinted++) {
    abbe_inner_light inside;
    assert_true(abbe_inner_light_follow(&solid, &view, NULL, n, tinted * per_m, 1e-300, &inside));
    for (size_t k = 0; k <= ABBE_RENDER_MAX_EXITS; k++) {
      const double left = exp(-tinted * per_m * THICKNESS * (double)k);
      const double known = (1 - r) * pow(r, (double)k) * left;
      assert_near(inside.kept[k] / known, 1, 1e-9);
      assert_true(inside.faint[k] == 0);
    }
  }
}

TEST(faint_paths_end) {
  const double n = 1.5, r = reflected_straight(n);
  const abbe_exact solid = solid_of(slab, 6);
  const abbe_view view = rays_along(down, 0.5);
  abbe_inner_light inside;
  assert_true(abbe_inner_light_follow(&solid, &view, NULL, n, 0, 0.01, &inside));
  assert_near(inside.kept[1], (1 - r) * r, 1e-12); /* 0.038 */
  for (size_t k = 2; k <= ABBE_RENDER_MAX_EXITS; k++) {
    assert_true(inside.kept[k] == 0);
    assert_near(inside.faint[k], (1 - r) * r * r, 1e-12); /* 0.0015 */
  }
}

TEST(air_keeps_nothing) {
  const abbe_exact solid = solid_of(slab, 6);
  const double slant[3] = {0.28, 0, -0.96};
  const abbe_view view = rays_along(slant, 0.5);
  abbe_inner_light inside;
  assert_true(abbe_inner_light_follow(&solid, &view, NULL, 1, 0, share_of_nothing, &inside));
  assert_near(inside.kept[0], 1, 1e-12);
  for (size_t k = 1; k <= ABBE_RENDER_MAX_EXITS; k++)
    assert_true(inside.kept[k] == 0 && inside.faint[k] == 0);
}

/* Straight in through a leg, mirrored by the long side as a whole, and straight out of the other
 * leg; what that reflects goes back the same way. */
TEST(a_right_angled_prism_turns_light) {
  const double n = 1.6, r = reflected_straight(n), root = sqrt(0.5);
  double prism[5][4] = {
      {0, 0, 1, 0.5}, {1, 0, 0, 0.5}, {-root, 0, -root, 0}, {0, 1, 0, 1}, {0, -1, 0, 1}};
  const abbe_exact solid = solid_of(prism, 5);
  const abbe_view view = rays_along(down, 0.3);
  abbe_inner_light inside;
  assert_true(abbe_inner_light_follow(&solid, &view, NULL, n, 0, share_of_nothing, &inside));
  const double known[6] = {1, 1, r, r, r * r, r * r};
  for (size_t k = 0; k < 6; k++) assert_near(inside.kept[k], (1 - r) * known[k], 1e-9);
}

TEST(what_no_light_meets_keeps_none) {
  const abbe_exact solid = solid_of(slab, 6);
  const double up[3] = {0, 1, 0}, from[3] = {0, 0, 5};
  abbe_light spot = {
      .kind = ABBE_LIGHT_SPOT, .position = {0, 0, 5}, .direction = {0, 0, 1}, .cone_rad = 0.5};
  abbe_inner_light inside;
  abbe_view view;
  abbe_view_look(from, down, up, false, &view);
  const double corner[4][3] = {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}};
  abbe_view_fit(&view, corner, 4);
  assert_false(abbe_inner_light_follow(&solid, &view, &spot, 1.5, 0, 0.01, &inside));
  for (size_t k = 0; k <= ABBE_RENDER_MAX_EXITS; k++)
    assert_true(inside.kept[k] == 0 && inside.faint[k] == 0);
  spot.direction[2] = -1;
  assert_true(abbe_inner_light_follow(&solid, &view, &spot, 1.5, 0, 0.01, &inside));
  assert_true(inside.kept[1] > 0.03 && inside.kept[1] < 0.05);
}

TEST(diamond_keeps_more_than_crown) {
  abbe_inner_light diamond, crown;
  OWNED(abbe_scene, scene) = shipped_scene("diamond");
  const abbe_object *stone = NULL;
  for (size_t i = 0; i < scene.object_count; i++)
    if (scene.object[i].material != NULL) stone = &scene.object[i];
  assert_non_null(stone);
  abbe_view view = rays_along(down, 0.005);
  assert_true(
      abbe_inner_light_follow(&stone->exact, &view, NULL, 2.42, 0, share_of_nothing, &diamond));
  assert_true(
      abbe_inner_light_follow(&stone->exact, &view, NULL, 1.52, 0, share_of_nothing, &crown));
  for (size_t k = 3; k <= ABBE_RENDER_MAX_EXITS; k++)
    assert_true(diamond.kept[k] > 1.5 * crown.kept[k]);
}

TEST(exits_are_as_few_as_do) {
  abbe_inner_light inside = {{0}, {0}};
  for (size_t k = 0; k <= ABBE_RENDER_MAX_EXITS; k++) inside.kept[k] = pow(0.5, (double)k);
  assert_int_equal(abbe_inner_light_exits(&inside, 2, 24), 8); /* 1 / 256 is below 1 / 200 */
  assert_int_equal(abbe_inner_light_exits(&inside, 10, 24), 10);
  assert_int_equal(abbe_inner_light_exits(&inside, 2, 6), 6);
  for (size_t k = 0; k <= ABBE_RENDER_MAX_EXITS; k++) inside.faint[k] = 0.002;
  assert_int_equal(abbe_inner_light_exits(&inside, 2, 24), 9); /* 1 / 512 and 0.002 */
  /* More than a part of what faint paths keep is no reason for exits, which do not follow them. */
  for (size_t k = 0; k <= ABBE_RENDER_MAX_EXITS; k++) inside.faint[k] = 0.1;
  assert_int_equal(abbe_inner_light_exits(&inside, 2, 24), 9);
}

static double planned(const abbe_scene *scene, const abbe_render_desc *asked, abbe_plan *plan) {
  OK(abbe_plan_make(scene, asked, plan, &error));
  return abbe_inner_light_plan(scene, asked, plan);
}

/* Its plan follows the gem's light until little is inside; what is asked for stays. */
TEST(a_gem_takes_as_many_exits_as_carry_light) {
  OWNED(abbe_plan, plan) = {0}, fewer = {0}, asked = {0};
  OWNED(abbe_scene, scene) = shipped_scene("gem");
  const double left = planned(&scene, NULL, &plan);
  assert_true(plan.desc.exits > ABBE_PLAN_EXITS && plan.desc.exits < ABBE_PLAN_MOST_EXITS);
  assert_true(plan.desc.energy_share < ABBE_PLAN_SHARE);
  assert_true(left > 0 && left <= ABBE_INNER_LIGHT_MOST);
  const abbe_render_desc one_less = {.exits = plan.desc.exits - 1,
                                     .energy_share = plan.desc.energy_share};
  assert_true(planned(&scene, &one_less, &fewer) > ABBE_INNER_LIGHT_MOST);
  const abbe_render_desc own = {.exits = 3, .energy_share = 0.2};
  assert_true(planned(&scene, &own, &asked) > 0.1);
  assert_int_equal(asked.desc.exits, 3);
  assert_near(asked.desc.energy_share, 0.2, 0);
  /* Triangle by triangle it takes as many: the light is the same. */
  const abbe_render_desc by_triangles = {.model = ABBE_MODEL_BVH};
  MADE(abbe_plan, triangles, abbe_plan_make(&scene, &by_triangles, &triangles, &error));
  assert_int_equal(triangles.desc.exits, plan.desc.exits);
  assert_near(triangles.desc.energy_share, plan.desc.energy_share, 0);
}

/* An earlier plan's light is that of the same stone and lamps, and of no others. */
TEST(an_earlier_plan_is_taken_over) {
  OWNED(abbe_scene, scene) = shipped_scene("gem");
  MADE(abbe_plan, first, abbe_plan_make(&scene, NULL, &first, &error));
  first.inside.exits++; /* to see who was there */
  scene.camera.eye[0] += 0.01;
  MADE(abbe_plan, again, abbe_plan_make_after(&first, &scene, NULL, &again, &error));
  assert_int_equal(again.desc.exits, first.desc.exits + 1);
  assert_near(again.desc.energy_share, first.desc.energy_share, 0);
  scene.light[0].position[0] += 1e-9;
  MADE(abbe_plan, moved, abbe_plan_make_after(&first, &scene, NULL, &moved, &error));
  assert_int_equal(moved.desc.exits, first.desc.exits);
}

/* But while light moves it is that of where lamps stood, and of the same stone. */
TEST(an_earlier_plan_serves_light_that_moves) {
  const abbe_render_desc coarse = {.coarse = ABBE_COARSE_ALL};
  OWNED(abbe_scene, scene) = shipped_scene("gem");
  MADE(abbe_plan, first, abbe_plan_make(&scene, &coarse, &first, &error));
  first.inside.exits++;
  scene.light[0].position[0] += 1e-9;
  MADE(abbe_plan, moved, abbe_plan_make_after(&first, &scene, &coarse, &moved, &error));
  assert_int_equal(moved.desc.exits, first.desc.exits + 1);
  MADE(abbe_plan, rests, abbe_plan_make_after(&first, &scene, NULL, &rests, &error));
  assert_int_equal(rests.desc.exits, first.desc.exits);
  for (size_t i = 0; i < scene.object_count; i++)
    if (scene.object[i].exact.kind == ABBE_EXACT_CONVEX)
      scene.object[i].exact.plane[0][3] *= 1 - 1e-9;
  MADE(abbe_plan, other, abbe_plan_make_after(&first, &scene, &coarse, &other, &error));
  assert_int_equal(other.desc.exits, first.desc.exits);
}

#define STONE                                                                                      \
  "- {name: stone, shape: gem, sides: 6, girdle: 0.1, table: 0.06, crown: 0.03, pavilion: 0.05, "  \
  "transform: [{rotate: {axis: [1, 0, 0], angle: 5}}, {translate: [0, 0, 0.2]}], material: "       \
  "flat}\n"

/* 64 x 64 rays here, 384 x 384 photons there, of one index: from a half to a hundredth of the
 * light.
 */
TEST(the_ledger_says_the_same) {
  static const char *const lights[] = {SUN, POINT_LIGHT};
  for (int i = 0; i < 2; i++)
    for (size_t exits = 1; exits <= 5; exits += 2) {
      OWNED(abbe_plan, plan) = {0};
      OWNED(abbe_scene, scene) = scene_of(printed(CAMERA "%s" FLOOR STONE, lights[i]));
      abbe_render_desc desc = small_frame;
      desc.photons = 384;
      desc.map_size = 512;
      desc.exits = exits;
      desc.energy_share = 1e-6;
      const double left = planned(&scene, &desc, &plan);
      HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
      const abbe_ledger e = draw_frame(renderer).energy;
      assert_near(left / (e.trapped / e.reached), 1, 0.08);
    }
}
