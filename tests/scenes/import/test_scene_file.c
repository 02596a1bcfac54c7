#include "tests/check.h"

#include "base/file.h"
#include "base/maths.h"
#include "scenes/import/scene_file.h"
#include "spectral/optics.h"
#include "tests/patience.h"

static abbe_scene load(const char *name) {
  abbe_scene scene;
  OK(abbe_scene_load(printed("%s/scenes/%s.yaml", ABBE_SOURCE_DIR, name), NULL, &scene, &error));
  return scene;
}

static const abbe_object *find(const abbe_scene *scene, const char *name) {
  for (size_t i = 0; i < scene->object_count; i++)
    if (strcmp(scene->object[i].name, name) == 0) return &scene->object[i];
  fail_msg("no object '%s'", name);
  return NULL;
}

static const abbe_object *refractor(const abbe_scene *scene) {
  for (size_t i = 0; i < scene->object_count; i++)
    if (scene->object[i].material) return &scene->object[i];
  fail_msg("no refractor");
  return NULL;
}

TEST(every_shipped_scene_loads) {
  static const struct {
    const char *name;
    size_t faces;
    abbe_exact_kind exact;
    size_t count;
  } scenes[] = {
      {"sphere", 5120, ABBE_EXACT_SPHERE, 0},
      {"ring", 65536, ABBE_EXACT_NONE, 0},
      {"gem", 24, ABBE_EXACT_CONVEX, 19},
      {"bunny", 235136, ABBE_EXACT_NONE, 0},
      {"glass", 12160, ABBE_EXACT_NONE, 0},
      {"prism", 8, ABBE_EXACT_CONVEX, 5},
      {"rainbow", 20480, ABBE_EXACT_SPHERE, 0},
      {"diamond", 110, ABBE_EXACT_CONVEX, 73},
      {"diamond-studio", 110, ABBE_EXACT_CONVEX, 73},
      {"looks/white", 110, ABBE_EXACT_CONVEX, 73},
      {"looks/black", 110, ABBE_EXACT_CONVEX, 73},
      {"looks/velvet", 110, ABBE_EXACT_CONVEX, 73},
      {"looks/daylight", 110, ABBE_EXACT_CONVEX, 73},
      {"looks/darkfield", 110, ABBE_EXACT_CONVEX, 73},
      {"looks/lightbox", 110, ABBE_EXACT_CONVEX, 73},
      {"looks/dispersion", 110, ABBE_EXACT_CONVEX, 73},
      {"looks/fire", 110, ABBE_EXACT_CONVEX, 73},
      {"looks/backdrop", 110, ABBE_EXACT_CONVEX, 73},
  };
  for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
    abbe_scene scene = load(scenes[i].name);
    const abbe_object *glass = refractor(&scene);
    assert_int_equal(glass->mesh.face_count, scenes[i].faces);
    assert_int_equal(glass->exact.kind, scenes[i].exact);
    assert_int_equal(glass->exact.count, scenes[i].count);
    assert_null(glass->fixes);
    assert_int_equal(scene.camera.width, 512);
    assert_int_equal(scene.camera.height, 512);
    assert_non_null(scene.description);
    abbe_scene_free(&scene);
    assert_null(scene.object);
  }
}

TEST(cornell_boxes_face_inwards_and_are_red_on_the_left) {
  static const char *const names[] = {"sphere", "ring", "gem", "bunny"};
  static const char *const walls[] = {"floor", "back wall", "left wall", "right wall", "ceiling"};
  const double inside[3] = {0, 0, 0.15};
  for (size_t i = 0; i < 4; i++) {
    OWNED(abbe_scene, scene) = load(names[i]);
    for (size_t w = 0; w < 5; w++) {
      const abbe_object *wall = find(&scene, walls[w]);
      assert_int_equal(wall->exact.kind, ABBE_EXACT_PARALLELOGRAMS);
      assert_int_equal(wall->exact.count, 1);
      const double *p = wall->exact.parallelogram[0];
      double normal[3], to[3];
      abbe_vector_cross(p + 3, p + 6, normal);
      abbe_vector_subtract(inside, p, to);
      assert_true(abbe_vector_dot(normal, to) > 0);
      assert_true(abbe_vector_dot(normal, wall->mesh.normal[0]) > 0);
    }
    const abbe_object *left = find(&scene, "left wall");
    assert_true(left->max[0] < -0.14 && left->reflectance[0] > 5 * left->reflectance[1]);
  }
}

/* A prism's ray in the plane of its base: [BornWolf1999]. */
TEST(the_spectrum_of_the_prism_falls_on_the_wall) {
  OWNED(abbe_scene, scene) = load("prism");
  const abbe_object *prism = refractor(&scene), *wall = find(&scene, "wall");
  const double wavelengths[3] = {400, 588, 700};
  double at[3] = {0};
  for (int i = 0; i < 3; i++) {
    double p[3] = {-0.7, 0, 0.03}, d[3] = {1, 0, 0}, n;
    OK(abbe_material_n(prism->material, wavelengths[i], &n, &error));
    for (int face = 0; face < 2; face++) {
      /* into the solid: the last plane entered; out of it: the first one left */
      double best = face ? INFINITY : -INFINITY, normal[3] = {0};
      for (size_t k = 0; k < prism->exact.count; k++) {
        const double *plane = prism->exact.plane[k], cosine = abbe_vector_dot(plane, d);
        const double t = (plane[3] - abbe_vector_dot(plane, p)) / cosine;
        if (fabs(cosine) < 1e-9 || (face ? cosine < 0 || t > best : cosine > 0 || t < best))
          continue;
        best = t;
        for (int a = 0; a < 3; a++) normal[a] = face ? -plane[a] : plane[a];
      }
      for (int a = 0; a < 3; a++) p[a] += best * d[a];
      const double wi[3] = {-d[0], -d[1], -d[2]};
      assert_true(abbe_optics_refract(wi, normal, face ? n : 1 / n, d));
    }
    if (i == 1) assert_true(fabs(acos(d[0]) * 180 / ABBE_PI - 59.6) < 0.2);
    const double t = (wall->min[1] - p[1]) / d[1];
    at[i] = p[0] + t * d[0];
    assert_true(at[i] > wall->min[0] && at[i] < wall->max[0]);
  }
  /* violet is bent more: it lands nearer to the slit; the spectrum is centimetres wide */
  assert_true(at[0] < at[1] && at[1] < at[2] && at[2] - at[0] > 0.03);
}

/* The outermost ray of order one: b from 0 to 1, exit angle 4 asin(b/n) - 2 asin(b). */
TEST(the_rainbow_falls_on_the_screen) {
  OWNED(abbe_scene, scene) = load("rainbow");
  const abbe_object *drop = refractor(&scene), *above = find(&scene, "screen, above the hole");
  const double distance = above->min[0] - drop->exact.centre[0], r = drop->exact.radius;
  double angle[2] = {0};
  for (int i = 0; i < 2; i++) {
    double n;
    OK(abbe_material_n(drop->material, i ? 700 : 400, &n, &error));
    for (double b = 0; b < 1; b += 1e-4) angle[i] = fmax(angle[i], 4 * asin(b / n) - 2 * asin(b));
    const double rise = distance * tan(angle[i]) + r;
    assert_true(drop->exact.centre[2] + rise < above->max[2]);
    assert_true(drop->exact.centre[2] + distance * tan(angle[i]) > above->min[2]);
  }
  assert_true(angle[1] > 42.1 * ABBE_PI / 180 && angle[1] < 42.7 * ABBE_PI / 180);
  assert_true(angle[0] > 40.2 * ABBE_PI / 180 && angle[0] < 40.9 * ABBE_PI / 180);
  /* the beam passes the hole and covers the drop */
  const double to_drop = scene.light[0].position[0] - drop->exact.centre[0];
  assert_true(to_drop * sin(scene.light[0].cone_rad) > r);
  assert_true((to_drop - distance) * tan(scene.light[0].cone_rad) < above->min[2] - 0.4);
}

TEST(the_glass_stands_on_textured_wood) {
  OWNED(abbe_scene, scene) = load("glass");
  const abbe_object *table = find(&scene, "table");
  assert_int_equal(table->texture.width, 256);
  assert_true(table->texture_repeat[0] == 3);
  for (size_t i = 0; i < 256 * 256 * 3; i++)
    assert_true(table->texture.data[i] >= 0 && table->texture.data[i] < 0.7f);
  assert_true(refractor(&scene)->min[2] > 0);
}

TEST(options_choose_another_table) {
  const abbe_scene_options options = {.materials = "thesis"};
  abbe_scene scene;
  OK(abbe_scene_load(ABBE_SOURCE_DIR "/scenes/sphere.yaml", &options, &scene, &error));
  assert_string_equal(scene.table.path, "thesis");
  abbe_scene_free(&scene);
  REFUSED(ABBE_NOT_FOUND, "gem.yaml:",
          abbe_scene_load(ABBE_SOURCE_DIR "/scenes/gem.yaml", &options, &scene, &error));
}

static abbe_result load_set(const char *stone, const char *set, abbe_scene *out,
                            abbe_error *error) {
  const abbe_scene_options options = {.stone = stone, .set = &set, .set_count = set != NULL};
  *error = (abbe_error){0};
  return abbe_scene_load(ABBE_SOURCE_DIR "/scenes/gem.yaml", &options, out, error);
}

TEST(values_are_set_by_their_path) {
  abbe_scene scene;
  abbe_error why;
  OK(load_set(NULL, "lights.lamp.intensity=2", &scene, &error));
  assert_true(scene.light[0].power == 2);
  abbe_scene_free(&scene);
  OK(load_set(NULL, "objects.5.height=0.2", &scene, &error));
  assert_true(fabs(scene.object[5].max[1] - 0.1) < 1e-12);
  abbe_scene_free(&scene);
  OK(load_set(NULL, "objects.back wall.reflectance=[0.1, 0.2, 0.3]", &scene, &error));
  abbe_scene_free(&scene);
  OK(load_set(NULL, "background=0.25", &scene, &error)); /* a new key */
  assert_true(scene.background == 0.25);
  abbe_scene_free(&scene);
  OK(load_set(NULL, "camera.fov=", &scene, &error)); /* the default's */
  assert_true(fabs(scene.camera.fov_y_rad - ABBE_PI / 4) < 1e-12);
  abbe_scene_free(&scene);
  static const struct {
    const char *set, *says;
  } bad[] = {{"lights.lamp.intensity=-1", "'intensity: -1'"},
             {"lights.lamp.intensity=bright", "'intensity"},
             {"lights.lamp.intensty=2", "did you mean 'intensity'"},
             {"lights.lamb.intensity=2", "there is no 'lamb'; did you mean 'lamp'?"},
             {"object.gem.table=0.02", "there is no 'object'; did you mean 'objects'?"},
             {"objects.77.table=0.02", "there is no '77'"},
             {"camera.fov.x=1", "in what is one value"},
             {"camera.fow=", "did you mean 'fov'"},
             {"camera.eye=", "'eye'"},
             {"camera", "write KEY=VALUE"},
             {"=3", "write KEY=VALUE"}};
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
    assert_int_not_equal(load_set(NULL, bad[i].set, &scene, &why), ABBE_OK);
    if (strstr(why.text, bad[i].says) == NULL) fail_msg("%s: %s", bad[i].set, why.text);
  }
}

TEST(a_stone_takes_anothers_place) {
  static const char *const good[] = {"ruby", "n-sf11=ruby", "gem=ruby"};
  abbe_scene scene;
  abbe_error why;
  for (size_t i = 0; i < 3; i++) {
    OK(load_set(good[i], NULL, &scene, &error));
    assert_string_equal(refractor(&scene)->material->name, "ruby");
    abbe_scene_free(&scene);
  }
  static const char *const bad[][2] = {{"rubi", "did you mean 'ruby'"},
                                       {"n-sf1=ruby", "did you mean 'n-sf11'?"},
                                       {"floor=ruby", "nothing in it is made of 'floor'"}};
  for (size_t i = 0; i < 3; i++) {
    assert_int_not_equal(load_set(bad[i][0], NULL, &scene, &why), ABBE_OK);
    if (strstr(why.text, bad[i][1]) == NULL) fail_msg("%s: %s", bad[i][0], why.text);
  }
}

TEST(bad_scenes_are_explained) {
  static const struct {
    const char *name;
    abbe_result result;
    const char *says;
  } bad[] = {
      {"malformed", ABBE_PARSE, "scene_malformed.yaml:"},
      {"not_a_mapping", ABBE_SCHEMA, "mapping"},
      {"unknown_key", ABBE_SCHEMA, ":5: a scene has no key 'lihgts'; did you mean 'lights'"},
      {"unknown_camera_key", ABBE_SCHEMA, "did you mean 'target'"},
      {"unknown_object_key", ABBE_SCHEMA,
       ":17: an object has no key 'radus'; did you mean 'radius'"},
      {"foreign_shape_key", ABBE_SCHEMA, "no key 'levels'"},
      {"unknown_shape", ABBE_SCHEMA, "did you mean 'sphere'"},
      {"unknown_material", ABBE_NOT_FOUND, "n-bk7"},
      {"unknown_light_kind", ABBE_SCHEMA, "did you mean 'spot'"},
      {"unknown_illuminant", ABBE_IO, ":7: the illuminant 'D6' is neither"},
      {"unknown_table", ABBE_IO, "no_such_table.yaml"},
      {"missing_camera", ABBE_SCHEMA, "'camera'"},
      {"missing_eye", ABBE_SCHEMA, "'eye'"},
      {"missing_radius", ABBE_SCHEMA, "'radius'"},
      {"missing_kind", ABBE_SCHEMA, "'kind'"},
      {"missing_intensity", ABBE_SCHEMA, "'intensity'"},
      {"nan_radius", ABBE_SCHEMA, ".nan"},
      {"nan_position", ABBE_SCHEMA, "nan"},
      {"infinite_width", ABBE_SCHEMA, "width"},
      {"zero_radius", ABBE_INVALID_ARGUMENT, "radius 0"},
      {"negative_height", ABBE_INVALID_ARGUMENT, "height -1"},
      {"zero_scale", ABBE_SCHEMA, "'scale'"},
      {"zero_axis", ABBE_SCHEMA, "'axis'"},
      {"two_steps_in_one", ABBE_SCHEMA, "one of translate, rotate, scale, look"},
      {"wrong_kind_of_value", ABBE_SCHEMA, "'width: wide'"},
      {"list_for_number", ABBE_SCHEMA, "'radius'"},
      {"short_vector", ABBE_SCHEMA, "3 numbers"},
      {"zero_size", ABBE_SCHEMA, "'size"},
      {"fractional_size", ABBE_SCHEMA, "whole numbers"},
      {"huge_size", ABBE_SCHEMA, "'size"},
      {"eye_is_target", ABBE_SCHEMA, "same point"},
      {"up_along_view", ABBE_SCHEMA, "'up'"},
      {"material_and_reflectance", ABBE_SCHEMA, "this one has more than one"},
      {"no_substance", ABBE_SCHEMA, "this one has none"},
      {"shape_and_mesh", ABBE_SCHEMA, "has both"},
      {"reflectance_above_one", ABBE_SCHEMA, "'reflectance"},
      {"irradiance_of_a_point", ABBE_SCHEMA, "'intensity' (W/sr)"},
      {"cone_of_a_point", ABBE_SCHEMA, "a spot light has"},
      {"spot_without_cone", ABBE_SCHEMA, "'cone'"},
      {"spot_without_direction", ABBE_SCHEMA, "'direction'"},
      {"zero_direction", ABBE_SCHEMA, "direction is zero"},
      {"soft_beyond_cone", ABBE_SCHEMA, "'soft"},
      {"dark_light", ABBE_SCHEMA, "must shine"},
      {"cut_without_file", ABBE_SCHEMA, "'file'"},
      {"cut_without_width", ABBE_SCHEMA, "'width'"},
      {"cut_of_a_mesh", ABBE_UNSUPPORTED, "is no design that is known by its name"},
      {"disk_without_radius", ABBE_SCHEMA, "'radius'"},
      {"disk_of_no_size", ABBE_SCHEMA, "'radius' is zero"},
      {"rectangle_without_height", ABBE_SCHEMA, "'height'"},
      {"rectangle_of_no_size", ABBE_SCHEMA, "'width' is zero"},
      {"width_of_a_disk", ABBE_SCHEMA, "a rectangle light has"},
      {"radius_of_a_rectangle", ABBE_SCHEMA, "a disk light has"},
      {"disk_without_direction", ABBE_SCHEMA, "'direction'"},
      {"intensity_of_a_disk", ABBE_SCHEMA, "'radiance' (W/(m2 sr))"},
      {"cone_of_a_disk", ABBE_SCHEMA, "a disk light has no 'cone'"},
      {"radiance_of_a_spot", ABBE_SCHEMA, "'intensity' (W/sr)"},
      {"radius_of_a_point", ABBE_SCHEMA, "a disk light has"},
      {"missing_mesh", ABBE_IO, "no_such_mesh.obj"},
      {"mesh_of_unknown_kind", ABBE_UNSUPPORTED, ".obj"},
      {"open_mesh", ABBE_GEOMETRY, "5 open edges make 1 hole, the widest of 5 edges, "},
      {"flat_refractor", ABBE_GEOMETRY, "no volume"},
      {"subdivided_facets", ABBE_SCHEMA, "smooth"},
      {"missing_texture", ABBE_IO, "no_such_wood.png"},
      {"texture_without_uv", ABBE_SCHEMA, "texture coordinates"},
      {"repeat_without_texture", ABBE_SCHEMA, "'repeat'"},
      {"open_profile", ABBE_SCHEMA,
       ":16: the 'profile' of a refractor begins and ends on the axis"},
      {"profile_of_triples", ABBE_SCHEMA, "[r, z]"},
      {"no_light", ABBE_SCHEMA, "has no light"},
      {"no_receiver", ABBE_SCHEMA, "has no receiver"},
      {"light_inside", ABBE_UNSUPPORTED, "inside the refractor 'ball'"},
      {"light_inside_a_prism", ABBE_UNSUPPORTED, "inside the refractor"},
      {"light_inside_a_mesh", ABBE_UNSUPPORTED, "inside the refractor"},
      {"light_inside_a_file_of_millimetres", ABBE_UNSUPPORTED,
       "so move it outside; 'stone' is 200 m wide, all other objects together 1 m: if its file is "
       "in another unit, 'fit: METRES' gives it its size"},
      {"flattened_blob", ABBE_SCHEMA, "leave out 'smooth: true'"},
      {"flattened_floor", ABBE_SCHEMA, "'flatten' is for the mesh of a file that refracts"},
      {"flattened_too_far", ABBE_SCHEMA, "'flatten: 0.5'"},
      {"flattened_dent", ABBE_GEOMETRY, "the mesh is no convex solid yet: ("},
      {"fit_to_nothing", ABBE_SCHEMA, "'fit' is the longest side"},
      {"centre_of_two", ABBE_SCHEMA, "'centre'"},
      {"disk_in_part", ABBE_UNSUPPORTED, "partly inside the refractor 'ball'"},
      {"faint_light", ABBE_SCHEMA, "'intensity: 1e-40' is too faint"},
      {"metal", ABBE_UNSUPPORTED, "the material 'foil' absorbs light within a wavelength"},
      {"mirror_of_glass", ABBE_UNSUPPORTED,
       ":19: the material 'n-bk7' is no conductor, so 'mirror' cannot be of it; take a metal such "
       "as silver, or a reflectance from 0 to 1; a glass stands under 'material'"},
      {"mirror_of_foil", ABBE_UNSUPPORTED, "record is of the model conductor, with points"},
      {"mirror_above_one", ABBE_SCHEMA, ":19: 'mirror: 1.2' is not in the range from 0 to 1"},
      {"mirror_below_zero", ABBE_SCHEMA, "'mirror: -0.1' is not in the range"},
      {"mirror_nan", ABBE_SCHEMA, "'mirror: .nan' is not a finite number"},
      {"mirror_of_a_list", ABBE_SCHEMA, "'mirror'"},
      {"mirror_unknown", ABBE_NOT_FOUND, "did you mean 'silver'"},
      {"mirror_and_material", ABBE_SCHEMA, "this one has more than one"},
      {"mirror_and_reflectance", ABBE_SCHEMA, "this one has more than one"},
      {"roughness_of_glass", ABBE_SCHEMA, ":20: 'roughness: 5e-4' is not in the range from 0.001"},
      {"roughness_of_a_floor", ABBE_SCHEMA, "what receives light scatters it evenly"},
      {"roughness_too_small", ABBE_SCHEMA, "'roughness' is 0, of a smooth mirror, or from 0.001"},
      {"roughness_above_one", ABBE_SCHEMA, "'roughness"},
      {"roughness_of_three", ABBE_SCHEMA, "'roughness'"},
      {"roughness_without_a_way", ABBE_SCHEMA, "wants 'brushed: {along: [x, y, z]}'"},
      {"brushed_both_ways", ABBE_SCHEMA, "'brushed' wants {along: [x, y, z]} or {around"},
      {"brushed_to_nothing", ABBE_SCHEMA, "'brushed' is zero"},
      {"brushed_smooth", ABBE_SCHEMA, "a 'roughness: [along, across]' says how deep"},
      {"mirror_alone", ABBE_SCHEMA, "has no receiver"},
      {"conductor_refracts", ABBE_UNSUPPORTED,
       ":19: the material 'silver' is a conductor: no light comes through it; say 'mirror: silver' "
       "in place of 'material: silver'"},
      {"light_on_a_mirror", ABBE_UNSUPPORTED, "on the surface of the mirror 'ball' (line 14)"},
      {"light_on_a_ball", ABBE_UNSUPPORTED, "on the surface of the refractor 'ball'"},
      {"light_on_a_box", ABBE_UNSUPPORTED, "on the surface of the refractor 'ball'"},
      {"camera_on_a_ball", ABBE_UNSUPPORTED, "eye is on the surface of the refractor 'ball'"},
      {"camera_inside", ABBE_UNSUPPORTED, "camera's eye is inside"},
      {"camera_in_a_glow", ABBE_UNSUPPORTED, "'diamond-fluorescent', which absorbs light"},
      {"nothing_in_view", ABBE_UNSUPPORTED, "in the camera's view"},
  };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    abbe_scene scene;
    abbe_error error = {0};
    const char *path = printed("%s/tests/bad/scene_%s.yaml", ABBE_SOURCE_DIR, bad[i].name);
    const abbe_result result = abbe_scene_load(path, NULL, &scene, &error);
    if (result != bad[i].result || error.code != result || !strstr(error.text, bad[i].says) ||
        (!strstr(error.text, "scene_") && !strstr(error.text, "no_such")))
      fail_msg("%s: code %d (not %d), '%s' (wants '%s')", bad[i].name, result, bad[i].result,
               error.text, bad[i].says);
    assert_null(scene.object);
    assert_int_equal(abbe_scene_load(path, NULL, &scene, NULL), result);
  }
}

/* The example of docs/scene-files.md, between its first pair of fences. */
TEST(the_documented_scene_loads) {
  FREED char *text = NULL;
  size_t size;
  OK(abbe_file_read(ABBE_SOURCE_DIR "/docs/scene-files.md", 1 << 20, &text, &size, &error));
  char *begin = strstr(text, "```yaml\n");
  assert_non_null(begin);
  begin += strlen("```yaml\n");
  char *end = strstr(begin, "```");
  assert_non_null(end);
  OK(abbe_file_write("t_documented.yaml", begin, (size_t)(end - begin), &error));
  abbe_scene scene;
  OK(abbe_scene_load("t_documented.yaml", NULL, &scene, &error));
  assert_string_equal(scene.object[0].material->name, "sapphire");
  abbe_scene_free(&scene);
  remove("t_documented.yaml");
}

TEST(a_missing_file_is_named) {
  abbe_scene scene;
  REFUSED(ABBE_IO, "no_such_scene.yaml",
          abbe_scene_load("no_such_scene.yaml", NULL, &scene, &error));
}

/* Text says what its file says; without a file the name stands in the messages. */
TEST(text_is_read_like_a_file) {
  FREED char *text = NULL;
  size_t size = 0;
  abbe_scene parsed, loaded = load("prism");
  const char *path = ABBE_SOURCE_DIR "/scenes/prism.yaml";
  OK(abbe_file_read(path, 1 << 20, &text, &size, &error));
  OK(abbe_scene_parse(text, size, path, NULL, &parsed, &error));
  assert_int_equal(parsed.object_count, loaded.object_count);
  assert_string_equal(parsed.path, loaded.path);
  assert_memory_equal(parsed.object[0].max, loaded.object[0].max, sizeof loaded.object[0].max);
  abbe_scene_free(&parsed);
  abbe_scene_free(&loaded);
  REFUSED(ABBE_SCHEMA,
          "words:1:", abbe_scene_parse("camera: 7\n", 10, "words", NULL, &parsed, &error));
  assert_null(parsed.object);
}

/* Only what was set differs; without changes nothing does. */
TEST(texts_differ_where_something_was_set) {
  static const char path[] = ABBE_SOURCE_DIR "/scenes/gem.yaml";
  const char *set = "lights.lamp.cone=40";
  const abbe_scene_options options = {.set = &set, .set_count = 1, .stone = "diamond"};
  FREED char *plain = NULL;
  char *changed;
  size_t plain_size, changed_size;
  OK(abbe_scene_text(path, NULL, &plain, &plain_size, &error));
  OK(abbe_scene_text(path, &options, &changed, &changed_size, &error));
  char *cone = strstr(plain, "cone: 45"), *stone = strstr(plain, "material: n-sf11");
  assert_true(cone != NULL && stone != NULL && strlen(plain) == plain_size);
  const size_t to_cone = (size_t)(cone - plain), after = to_cone + strlen("cone: 45");
  assert_memory_equal(plain, changed, to_cone);
  assert_memory_equal(changed + to_cone, "cone: 40", 8);
  assert_memory_equal(plain + after, changed + after, (size_t)(stone - plain) - after);
  assert_non_null(strstr(changed, "material: diamond\n"));
  assert_int_equal(changed_size, plain_size + strlen("diamond") - strlen("n-sf11"));
  free(changed);
  set = "lights.lamb.cone=40";
  assert_int_equal(abbe_scene_text(path, &options, &changed, &changed_size, NULL),
                   ABBE_INVALID_ARGUMENT);
  assert_null(changed);
}

/* Scenes that nobody wants any more while they are read. */

/* Whoever stops it is not asked again, whenever that is, and there is no scene. */
TEST(reading_ends_when_it_is_told_to) {
  static const struct {
    const char *name;
    size_t least; /* questions: of a large mesh, of surroundings and a cut stone */
  } scenes[] = {{"bunny", 60}, {"stone", 60}};
  for (size_t i = 0; i < 2; i++) {
    OWNED(abbe_scene, scene) = {0};
    abbe_result result = ABBE_CANCELLED;
    patience p = {0};
    const char *path = printed("%s/scenes/%s.yaml", ABBE_SOURCE_DIR, scenes[i].name);
    for (size_t most = 0; result == ABBE_CANCELLED; most = 4 * most + 3) {
      abbe_watch watch = {patience_lasts, &p, false};
      p = (patience){.most = most};
      abbe_watch_set(&watch);
      result = abbe_scene_load(path, NULL, &scene, NULL);
      abbe_watch_set(NULL);
      if (result != ABBE_CANCELLED) break;
      assert_int_equal(p.asked, most + 1);
      assert_true(scene.object == NULL && scene.environment == NULL);
    }
    assert_int_equal(result, ABBE_OK);
    if (p.asked < scenes[i].least) fail_msg("%s: asked %zu times", scenes[i].name, p.asked);
  }
}
