#include "tests/check.h"

#include "base/file.h"
#include "base/maths.h"
#include "scenes/import/scene_file.h"
#include "scenes/studio/setting.h"
#include "scenes/studio/studio.h"
#include "spectral/formats/material_import.h"

#include <unistd.h>

#define QUARTZ ABBE_SOURCE_DIR "/scenes/designs/brilliant-quartz.asc"
#define OVAL ABBE_SOURCE_DIR "/scenes/designs/oval.asc"

static void load(const char *path, const abbe_studio *studio, abbe_scene *out) {
  const abbe_scene_options options = {.studio = studio};
  OK(abbe_scene_load(path, &options, out, &error));
}

static const abbe_object *called(const abbe_scene *scene, const char *name) {
  for (size_t i = 0; i < scene->object_count; i++)
    if (strcmp(scene->object[i].name, name) == 0) return &scene->object[i];
  return NULL;
}

static void put(const char *path, const char *text) {
  OK(abbe_file_write(path, text, strlen(text), &error));
}

/* A box of 4 x 6 x 2 of the file's units. */
static void put_box(const char *path, double unit) {
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  for (int i = 0; i < 8; i++)
    fprintf(f, "v %g %g %g\n", (i & 1 ? 4 : 0) * unit, (i & 2 ? 6 : 0) * unit,
            (i & 4 ? 2 : 0) * unit);
  fprintf(f, "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
  fclose(f);
}

TEST(every_look_shows_a_stone) {
  for (int look = 0; look < ABBE_STUDIO_LOOK_COUNT; look++)
    for (int with = 0; with < ABBE_STUDIO_WITH_COUNT; with++) {
      const abbe_studio studio = {.look = (abbe_studio_look)look, .with = (abbe_studio_with)with};
      FILLED(abbe_scene, scene, load(QUARTZ, &studio, &scene));
      const abbe_object *stone = called(&scene, "stone"), *table = called(&scene, "table");
      assert_non_null(stone);
      assert_string_equal(stone->material->name, "quartz");
      assert_near(fmin(stone->max[0] - stone->min[0], stone->max[1] - stone->min[1]), 0.0065,
                  1e-12);
      assert_int_equal(table != NULL, with != ABBE_STUDIO_WITH_NONE);
      if (with == ABBE_STUDIO_WITH_TABLE) assert_near(stone->min[2], 0, 1e-15);
      if (with == ABBE_STUDIO_WITH_RING) assert_true(stone->min[2] > 0.01);
      assert_int_equal(called(&scene, "band") != NULL, with == ABBE_STUDIO_WITH_RING);
    }
}

/* A flat face of metal shows what is behind as high as the camera: light in studios of softboxes,
 * graded; beside a bare stone it is as dark as the room. */
TEST(flat_metal_mirrors_light) {
  static const abbe_studio_look looks[] = {ABBE_STUDIO_LOOK_white, ABBE_STUDIO_LOOK_black,
                                           ABBE_STUDIO_LOOK_velvet, ABBE_STUDIO_LOOK_backdrop};
  for (size_t i = 0; i < sizeof looks / sizeof *looks; i++)
    for (int setting = 0; setting <= 1 + ABBE_SETTING_BEZEL; setting += 1 + ABBE_SETTING_BEZEL) {
      const abbe_studio studio = {.look = looks[i], .setting = setting};
      FILLED(abbe_scene, scene, load(OVAL, &studio, &scene));
      double d[3], dark[3] = {-0.1, 0, -1}, room[3], seen[3], above[3];
      for (int k = 0; k < 3; k++)
        d[k] = (k < 2 ? -1 : 1) * (scene.camera.eye[k] - scene.camera.target[k]);
      abbe_vector_normalise(d);
      abbe_vector_normalise(dark);
      const double high = asin(d[2]) + 0.17;
      abbe_environment_radiance(scene.environment, dark, room);
      abbe_environment_radiance(scene.environment, d, seen);
      const double up[3] = {0, cos(high), sin(high)};
      abbe_environment_radiance(scene.environment, up, above);
      assert_near(seen[1] / room[1], setting == 0 ? 1 : 7, 0.2);
      assert_near(above[1] / room[1], setting == 0 ? 1 : 11, 0.2);
    }
}

/* The metal stands on the table, and in a row touches the next. */
TEST(settings_hold_every_stone) {
  static const char *const names[] = {"prongs", "bezel", "channel", "band", "pave"};
  for (int kind = 0; kind < ABBE_SETTING_COUNT; kind++)
    for (int ring = 0; ring < 2; ring++) {
      const char *const more[] = {OVAL};
      const abbe_studio studio =
          FIELDS(.setting = 1 + kind, .with = ring ? ABBE_STUDIO_WITH_RING : ABBE_STUDIO_WITH_TABLE,
                 .more = more, .more_count = !ring, .metal = "silver");
      FILLED(abbe_scene, scene, load(OVAL, &studio, &scene));
      const abbe_object *metal =
          called(&scene, printed("stone%s's %s", ring ? "" : " 1", names[kind]));
      assert_non_null(metal);
      assert_string_equal(metal->conductor->name, "silver");
      size_t holding = 0;
      for (size_t i = 0; i < scene.object_count; i++) holding += scene.object[i].holds;
      assert_int_equal(holding, !ring || kind == ABBE_SETTING_BAND ? studio.more_count + 1 : 2);
      double lowest = metal->min[2];
      for (size_t i = 0; i < scene.object_count; i++)
        if (strstr(scene.object[i].name, "stone") != NULL)
          lowest = fmin(lowest, scene.object[i].min[2]);
      assert_near(lowest, 0, 1e-12);
      if (kind == ABBE_SETTING_CHANNEL || kind == ABBE_SETTING_PAVE)
        if (!ring) {
          assert_near(called(&scene, printed("stone 2's %s", names[kind]))->min[0], metal->max[0],
                      1e-8);
        }
    }
}

TEST(width_and_stone_are_the_users) {
  const abbe_studio studio = {.width_m = 0.012, .material = "ruby"};
  FILLED(abbe_scene, scene, load(OVAL, &studio, &scene));
  const abbe_object *stone = called(&scene, "stone");
  assert_near(stone->max[0] - stone->min[0], 0.012, 1e-12);
  assert_string_equal(stone->material->name, "ruby");
}

/* Between any two is a gap, and all are in the picture. */
TEST(several_stand_side_by_side) {
  const char *const more[] = {OVAL, QUARTZ, OVAL, QUARTZ};
  for (size_t count = 1; count <= 4; count++) {
    const abbe_studio studio = {.more = more, .more_count = count};
    FILLED(abbe_scene, scene, load(QUARTZ, &studio, &scene));
    const abbe_object *stone[5];
    for (size_t i = 0; i <= count; i++) {
      stone[i] = called(&scene, printed("stone %zu", i + 1));
      assert_non_null(stone[i]);
      assert_near(stone[i]->min[2], 0, 1e-15);
      for (size_t k = 0; k < i; k++)
        assert_true(stone[k]->max[0] < stone[i]->min[0] || stone[i]->max[0] < stone[k]->min[0] ||
                    stone[k]->max[1] < stone[i]->min[1] || stone[i]->max[1] < stone[k]->min[1]);
    }
    assert_true(scene.camera.width > 512);
  }
}

/* How far beside the middle of the picture an object reaches, in halves of its width. */
static double beside(const abbe_camera *c, const abbe_object *object) {
  double view[3], right[3], most = 0;
  abbe_vector_subtract(c->target, c->eye, view);
  abbe_vector_normalise(view);
  abbe_vector_cross(view, c->up, right);
  abbe_vector_normalise(right);
  for (size_t i = 0; i < object->mesh.vertex_count; i++) {
    double p[3];
    abbe_vector_subtract(object->mesh.position[i], c->eye, p);
    most = fmax(most, fabs(abbe_vector_dot(p, right)) / abbe_vector_dot(p, view));
  }
  return most * (double)c->height / ((double)c->width * tan(0.5 * c->fov_y_rad));
}

/* They fill the picture that is asked for, however wide it is. */
TEST(the_camera_knows_the_pictures_size) {
  static const size_t sizes[][2] = {{400, 100}, {128, 128}, {90, 160}};
  const char *const more[] = {OVAL, QUARTZ};
  for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
    const abbe_studio studio = {
        .more = more, .more_count = 2, .columns = sizes[i][0], .rows = sizes[i][1]};
    FILLED(abbe_scene, scene, load(QUARTZ, &studio, &scene));
    assert_int_equal(scene.camera.width, sizes[i][0]);
    assert_int_equal(scene.camera.height, sizes[i][1]);
    double most = 0;
    for (size_t k = 1; k <= 3; k++)
      most = fmax(most, beside(&scene.camera, called(&scene, printed("stone %zu", k))));
    assert_true(most > (i == 0 ? 0.2 : 0.8) && most <= 0.85 + 1e-3);
  }
}

TEST(a_mesh_has_its_files_size) {
  static const struct {
    const char *path;
    double unit, width;
    const char *note;
  } boxes[] = {{"/tmp/abbe-test-studio.obj", 1, 0.004, "wide; look"},
               {"/tmp/abbe-test-studio.obj", 1000, ABBE_STUDIO_WIDTH_M, "--width says which"}};
  for (int i = 0; i < 2; i++) {
    abbe_scene scene;
    put_box(boxes[i].path, boxes[i].unit);
    load(boxes[i].path, &(abbe_studio){.material = "topaz"}, &scene);
    const abbe_object *stone = called(&scene, "stone");
    assert_near(stone->max[0] - stone->min[0], boxes[i].width, 1e-12);
    assert_near(stone->max[1] - stone->min[1], 1.5 * boxes[i].width, 1e-12);
    assert_near(stone->min[2], 0, 1e-15);
    assert_non_null(strstr(scene.description, boxes[i].note));
    abbe_scene_free(&scene);
    unlink(boxes[i].path);
  }
}

/* What is made for another folder is the same scene there. */
TEST(a_saved_scene_is_the_same) {
  static const char path[] = "/tmp/abbe-test-studio.yaml";
  const abbe_studio studio = {.folder = "/tmp/", .look = ABBE_STUDIO_LOOK_velvet};
  const abbe_scene_options options = {.studio = &studio};
  FREED char *text = NULL;
  size_t size;
  OK(abbe_scene_text(OVAL, &options, &text, &size, &error));
  put(path, text);
  FILLED(abbe_scene, made, load(OVAL, &studio, &made));
  FILLED(abbe_scene, saved, load(path, NULL, &saved));
  assert_string_equal(made.description, saved.description);
  assert_memory_equal(&made.camera, &saved.camera, sizeof made.camera);
  assert_int_equal(made.object_count, saved.object_count);
  const abbe_mesh *a = &called(&made, "stone")->mesh, *b = &called(&saved, "stone")->mesh;
  assert_int_equal(a->vertex_count, b->vertex_count);
  assert_memory_equal(a->position, b->position, a->vertex_count * sizeof *a->position);
  unlink(path);
}

/* Lamps that stand about a small stone stand about a large one as well. */
TEST(lamps_grow_with_the_stones) {
  static const abbe_studio_look looks[] = {ABBE_STUDIO_LOOK_white, ABBE_STUDIO_LOOK_dispersion};
  for (int i = 0; i < 2; i++) {
    OWNED(abbe_scene, large);
    FILLED(abbe_scene, small, load(QUARTZ, &(abbe_studio){.look = looks[i]}, &small));
    load(QUARTZ, &(abbe_studio){.look = looks[i], .width_m = 0.2}, &large);
    const abbe_light *a = &small.light[0], *b = &large.light[0];
    const double factor = b->position[2] / a->position[2];
    assert_true(factor > 5);
    for (int k = 0; k < 3; k++) assert_near(b->position[k], factor * a->position[k], 1e-9);
    assert_near(b->radius, factor * a->radius, 1e-9);
    /* the same light on the stone: of a disk by its radiance, of a point by W/sr */
    assert_near(b->power, a->kind == ABBE_LIGHT_POINT ? factor * factor * a->power : a->power,
                1e-9 * b->power);
  }
}

TEST(an_index_finds_a_stone) {
  static const struct {
    double n;
    const char *name;
  } stones[] = {
      {1.54, "quartz"},   {1.577, "emerald"}, /* no clear stone is near, and no glass */
      {1.62, "topaz"},    {1.66, "peridot"},  {1.76, "sapphire"}, {2.15, "cubic-zirconia"},
      {2.417, "diamond"}, {1.1, "quartz"},    {3, "moissanite"}};
  const abbe_material_table none = {0};
  MADE(abbe_material_table, table, abbe_material_table_load(NULL, &table, &error));
  for (size_t i = 0; i < sizeof stones / sizeof *stones; i++)
    assert_string_equal(abbe_studio_nearest(&table, stones[i].n)->name, stones[i].name);
  assert_null(abbe_studio_nearest(&none, 1.54));
}

TEST(what_is_wrong_is_said) {
  static const char *const more[] = {OVAL};
  const struct {
    const char *path;
    abbe_studio studio;
    abbe_result code;
    const char *words;
  } bad[] = {{"/no/such.asc", {0}, ABBE_IO, "/no/such.asc"},
             {QUARTZ,
              {.with = ABBE_STUDIO_WITH_RING, .more = more, .more_count = 1},
              ABBE_INVALID_ARGUMENT,
              "a ring holds one stone, not 2"},
             {QUARTZ, {.material = "rubi"}, ABBE_NOT_FOUND, "did you mean 'ruby'"}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    abbe_scene scene;
    const abbe_scene_options options = {.studio = &bad[i].studio};
    REFUSED(bad[i].code, bad[i].words, abbe_scene_load(bad[i].path, &options, &scene, &error));
  }
}
