/* Directional lights in place of an environment, and the soft light that is left. */
#include "tests/scenes/environment/irradiance.h"
#include "tests/scenes/scene_text.h"

#include "base/maths.h"
#include "scenes/lights/environment_lights.h"

#define PLAIN CAMERA FLOOR

static void add(const char *environment, size_t count, abbe_scene *scene, abbe_scene *out) {
  *scene = scene_of(printed(PLAIN "environment: %s\n", environment));
  const abbe_environment_lights_desc desc = {.count = count, .min_nm = 380, .max_nm = 780};
  OK(abbe_environment_lights_add(scene, &desc, NULL, out, &error));
}

static void drop(abbe_scene *scene, abbe_scene *lit) {
  abbe_environment_lights_drop(lit);
  abbe_scene_free(scene);
}

TEST(one_softbox_is_one_light) {
  abbe_scene scene, lit;
  add("{softboxes: [{elevation: 60, azimuth: 30, radius: 10, radiance: 3}]}", 1, &scene, &lit);
  assert_int_equal(lit.light_count, 1);
  assert_int_equal(lit.environment_lights, 1);
  const double r = 10 * ABBE_PI / 180, e = 60 * ABBE_PI / 180, a = 30 * ABBE_PI / 180;
  const double way[3] = {-cos(e) * cos(a), -cos(e) * sin(a), -sin(e)};
  /* across its middle a disk of constant radiance gives pi L sin^2 r */
  assert_near(lit.light[0].power / (ABBE_PI * 3 * pow(sin(r), 2)), 1, 1e-3);
  for (int k = 0; k < 3; k++) assert_near(lit.light[0].direction[k], way[k], 1e-3);
  assert_int_equal(lit.light[0].kind, ABBE_LIGHT_DIRECTIONAL);
  assert_near(lit.light[0].radius, tan(r), 2e-3);
  drop(&scene, &lit);
}

#define STUDIO                                                                                     \
  "{dome: cos, rotate: 40, uniform: 0.1, softboxes: [{elevation: 30, width: 40, height: 20, "      \
  "radiance: 5}, {elevation: 70, azimuth: 130, radius: 5, radiance: [90, 70, 50]}, {elevation: "   \
  "-20, azimuth: 200, radius: 2, radiance: 400}]}"

/* However many there are, lights and soft light shine on any open plane as the environment does. */
TEST(every_open_plane_has_its_irradiance) {
  for (size_t count = 1; count <= 16; count *= 4) {
    abbe_scene scene, lit;
    add(STUDIO, count, &scene, &lit);
    assert_true(lit.light_count <= count);
    double most[3], n[3] = {0, 0, 1};
    irradiance_of(scene.environment, n, most);
    for (int i = 0; i < 12; i++) {
      double soft[3], rgb[3], all = 0;
      for (int k = 0; k < 3; k++) n[k] = sin(7.1 * i + 3 * k + 1);
      abbe_vector_normalise(n);
      irradiance_of(scene.environment, n, rgb);
      abbe_irradiance_map_at(lit.soft_light, n, soft);
      for (size_t k = 0; k < lit.light_count; k++)
        all += fmax(-abbe_vector_dot(lit.light[k].direction, n), 0) * lit.light[k].power;
      double left = 0, right = 0;
      static const double luminance[3] = {0.2126390058715104, 0.7151686787677559,
                                          0.0721923153607337};
      for (int k = 0; k < 3; k++) left += luminance[k] * soft[k];
      for (int k = 0; k < 3; k++) right += luminance[k] * rgb[k];
      assert_near((all + left) / most[1], right / most[1], 1e-2);
    }
    for (size_t i = 1; i < lit.light_count; i++)
      assert_true(lit.light[i].power <= lit.light[i - 1].power);
    drop(&scene, &lit);
  }
}

/* As radiance, what the lights leave and the lights are all: by luminance, with their directions,
 * and by colour where a lamp has one. No texel gains. */
TEST(what_is_left_and_the_lights_are_all) {
  static const double luminance[3] = {0.2126390058715104, 0.7151686787677559, 0.0721923153607337};
  for (size_t count = 0; count <= 2; count++) {
    abbe_scene scene, lit;
    add(STUDIO, count, &scene, &lit);
    assert_int_equal(lit.environment_lights, count);
    const abbe_environment *e = scene.environment;
    MADE(abbe_radiance_map, left,
         abbe_environment_lights_leave(e, lit.environment_lights, &left, &error));
    double flux[3] = {0, 0, 0};
    for (size_t i = 0; i < left.width * left.height; i++) {
      double d[3], y = 0;
      abbe_radiance_map_direction(&left, (double)(i % left.width) + 0.5,
                                  (double)(i / left.width) + 0.5, d);
      for (size_t k = 0; k < 3; k++) {
        const double taken = (double)(e->map.rgb[3 * i + k] - left.rgb[3 * i + k]);
        assert_true(taken >= 0);
        y += luminance[k] * taken * abbe_radiance_map_solid_angle(&left, i / left.width);
      }
      for (int k = 0; k < 3; k++)
        for (int r = 0; r < 3; r++) flux[k] += y * e->to_map[3 * r + k] * d[r];
    }
    for (size_t i = 0; i < lit.environment_lights; i++)
      for (int k = 0; k < 3; k++) flux[k] += lit.light[i].power * lit.light[i].direction[k];
    for (int k = 0; k < 3; k++) assert_near(flux[k], 0, 1e-4);
    drop(&scene, &lit);
  }
}

/* Small lamps are lights, and each its own; what is wide is left. */
TEST(only_lamps_become_lights) {
  abbe_scene scene, lit;
  add(STUDIO, 8, &scene, &lit);
  assert_int_equal(lit.light_count, 2);
  assert_near(lit.light[0].direction[2], -sin(70 * ABBE_PI / 180), 2e-3);
  assert_near(lit.light[1].direction[2], sin(20 * ABBE_PI / 180), 2e-3);
  drop(&scene, &lit);
}

/* Nothing stands out. */
TEST(smooth_surroundings_need_no_light) {
  static const char *const smooth[] = {"{uniform: 1}", "{dome: cos}", "{dome: iso}"};
  for (int i = 0; i < 3; i++) {
    abbe_scene scene, lit;
    double up[3], rgb[3];
    add(smooth[i], 16, &scene, &lit);
    assert_int_equal(lit.light_count, 0);
    irradiance_of(scene.environment, (const double[3]){0, 0, 1}, up);
    abbe_irradiance_map_at(lit.soft_light, (const double[3]){0, 0, 1}, rgb);
    for (int k = 0; k < 3; k++) assert_near(rgb[k] / up[k], 1, 2e-3);
    drop(&scene, &lit);
  }
}

/* A sun in a sky is one light with the sun's own irradiance. */
TEST(the_sun_stands_out_of_its_sky) {
  abbe_scene scene, lit;
  add("{uniform: 0.5, softboxes: [{elevation: 45, azimuth: 30, radius: 0.5, radiance: 4000}]}", 4,
      &scene, &lit);
  assert_int_equal(lit.light_count, 1);
  assert_near(lit.light[0].power / (ABBE_PI * 4000 * pow(sin(0.5 * ABBE_PI / 180), 2)), 1, 2e-3);
  drop(&scene, &lit);
}

TEST(colours_are_the_lights_own) {
  abbe_scene scene, lit;
  add("{softboxes: [{elevation: 60, radius: 10, radiance: [1, 0.1, 0.1]}, {elevation: 60, azimuth: "
      "180, radius: 10, radiance: 0.4}]}",
      2, &scene, &lit);
  assert_int_equal(lit.light_count, 2);
  /* the grey one shines as the illuminant does, the red one less in blue */
  for (size_t i = 0; i < 2; i++) {
    const abbe_illuminant *own = &lit.light[i].illuminant;
    const double blue = abbe_illuminant_power(own, 450) / abbe_illuminant_power(own, 640);
    const abbe_illuminant *all = &scene.environment->illuminant;
    const double white = abbe_illuminant_power(all, 450) / abbe_illuminant_power(all, 640);
    if (lit.light[i].direction[0] > 0)
      assert_near(blue / white, 1, 1e-9);
    else
      assert_true(blue < 0.3 * white);
  }
  drop(&scene, &lit);
}

/* Also at the zenith, where texels are thin. */
TEST(a_lamp_at_the_zenith_is_no_brighter) {
  abbe_scene scene, lit;
  add("{softboxes: [{elevation: 90, radius: 3, radiance: 9}]}", 1, &scene, &lit);
  const double r = 3 * ABBE_PI / 180;
  assert_near(lit.light[0].power / (ABBE_PI * 9 * pow(sin(r), 2)), 1, 2e-3);
  assert_near(lit.light[0].direction[2], -1, 1e-6);
  drop(&scene, &lit);
}

TEST(own_lights_stay_and_leave_room) {
  abbe_scene lit;
  char text[4096] = CAMERA POINT_LIGHT FLOOR "environment: {softboxes: [";
  for (int i = 0; i < 20; i++)
    snprintf(text + strlen(text), sizeof text - strlen(text),
             "{elevation: 20, azimuth: %d, radius: 2, radiance: 9},", 18 * i);
  strcat(text, "]}\n");
  abbe_environment_lights_desc desc = {.count = 99, .min_nm = 380, .max_nm = 780};
  abbe_scene scene = scene_of(text);
  OK(abbe_environment_lights_add(&scene, &desc, NULL, &lit, &error));
  assert_int_equal(lit.light_count, ABBE_SCENE_MAX_LIGHTS);
  assert_int_equal(lit.environment_lights, ABBE_SCENE_MAX_LIGHTS - 1);
  assert_string_equal(lit.light[0].name, "lamp");
  assert_string_equal(lit.light[1].name, "environment 1");
  drop(&scene, &lit);
  scene = scene_of(CAMERA POINT_LIGHT FLOOR);
  desc.count = 4;
  OK(abbe_environment_lights_add(&scene, &desc, NULL, &lit, &error));
  assert_int_equal(lit.light_count, 1);
  assert_int_equal(lit.environment_lights, 0);
  drop(&scene, &lit);
}

/* What an earlier copy has is what would be found, and only of the same surroundings. */
TEST(an_earlier_copy_is_taken_over) {
  abbe_scene scene, first, again, turned;
  add(STUDIO, 2, &scene, &first);
  const abbe_environment_lights_desc desc = {.count = 2, .min_nm = 380, .max_nm = 780};
  first.light[0].power *= 3; /* to see who was there */
  OK(abbe_environment_lights_add(&scene, &desc, &first, &again, &error));
  assert_int_equal(again.light_count, first.light_count);
  assert_int_equal(again.environment_lights, first.environment_lights);
  assert_memory_equal(again.soft_light, first.soft_light, sizeof *first.soft_light);
  for (size_t i = 0; i < again.light_count; i++) {
    const abbe_light *a = &again.light[i], *b = &first.light[i];
    assert_string_equal(a->name, b->name);
    assert_true(a->name != b->name && a->power == b->power && a->kind == b->kind);
    assert_memory_equal(a->direction, b->direction, sizeof a->direction);
    for (double nm = 400; nm < 700; nm += 50)
      assert_true(abbe_illuminant_power(&a->illuminant, nm) ==
                  abbe_illuminant_power(&b->illuminant, nm));
  }
  abbe_environment_turn(1, NULL, 0, scene.environment->to_map);
  OK(abbe_environment_lights_add(&scene, &desc, &first, &turned, &error));
  assert_near(turned.light[0].power / (first.light[0].power / 3), 1, 1e-12);
  assert_true(turned.light[0].direction[0] != first.light[0].direction[0]);
  abbe_environment_lights_drop(&again);
  abbe_environment_lights_drop(&turned);
  drop(&scene, &first);
}
