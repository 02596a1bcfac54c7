#include "tests/scenes/scene_text.h"

#define PLATE(reflectance)                                                                         \
  CAMERA POINT_LIGHT                                                                               \
      "objects:\n- {name: plate, shape: rectangle, width: 2, height: 2, reflectance: " reflectance \
      "}\n"

static const char *write_table(const char *text) {
  static char path[64];
  snprintf(path, sizeof path, "/tmp/abbe-test-spectrum-%ld.csv", (long)getpid());
  OK(abbe_file_write(path, text, strlen(text), &error));
  return path;
}

static void load_plate(const char *format, const char *path, abbe_scene *scene) {
  char text[1024], plate[256];
  snprintf(plate, sizeof plate, format, path);
  snprintf(text, sizeof text, PLATE("%s"), plate);
  *scene = scene_of(text);
}

TEST(a_file_gives_a_spectrum) {
  const char *path = write_table("nm;leaf;stone\n400;0,1;0,5\n500;0,3;0,5\n700;0,2;0,5\n");
  FILLED(abbe_scene, scene, load_plate("{spectrum: %s, column: leaf}", path, &scene));
  const abbe_object *o = &scene.object[0];
  assert_int_equal(abbe_object_kind_of(o), ABBE_OBJECT_RECEIVER);
  assert_near(abbe_spectrum_at(o->spectrum, 450), 0.2, 1e-12);
  assert_string_equal(o->spectrum_path, path);
  bool listed = false;
  for (size_t i = 0; i < abbe_scene_file_count(&scene); i++)
    listed = listed || (abbe_scene_file(&scene, i) && !strcmp(abbe_scene_file(&scene, i), path));
  assert_true(listed);
  abbe_scene_free(&scene);
  load_plate("{spectrum: %s, column: stone}", path, &scene);
  for (int k = 0; k < 3; k++) assert_near(scene.object[0].reflectance[k], 0.5, 5e-4);
  unlink(path);
}

TEST(a_patch_gives_a_spectrum) {
  OWNED(abbe_scene, scene) = scene_of(PLATE("{patch: red}"));
  const abbe_object *o = &scene.object[0];
  assert_null(o->spectrum_path);
  assert_true(abbe_spectrum_at(o->spectrum, 650) > 10 * abbe_spectrum_at(o->spectrum, 500));
  assert_true(o->reflectance[0] > 4 * o->reflectance[1]);
}

static void refuses(const char *format, const char *table, abbe_result result, const char *says) {
  char path[96], text[1024], plate[256];
  snprintf(path, sizeof path, "%s.yaml", write_table(table));
  snprintf(plate, sizeof plate, format, write_table(table));
  snprintf(text, sizeof text, PLATE("%s"), plate);
  const char *whole = strstr(text, "camera:");
  OK(abbe_file_write(path, whole, strlen(whole), &error));
  abbe_scene scene;
  abbe_error why = {0};
  const abbe_result got = abbe_scene_load(path, NULL, &scene, &why);
  if (got != result || strstr(why.text, says) == NULL) fail_msg("%s: %d %s", format, got, why.text);
  unlink(path);
  unlink(write_table(""));
}

TEST(what_is_no_reflectance_is_refused) {
  const char *good = "nm,a\n400,0.5\n700,0.5\n";
  refuses("{patch: blue sky, column: a}", good, ABBE_SCHEMA, "either {spectrum: FILE}");
  refuses("{}", good, ABBE_SCHEMA, "either {spectrum: FILE}");
  refuses("{patch: reed}", good, ABBE_NOT_FOUND, "did you mean 'red'");
  refuses("{spectrum: %s}", "nm,a\n400,50\n700,60\n", ABBE_SCHEMA, "divide by 100");
  refuses("{spectrum: %s, column: b}", good, ABBE_SCHEMA, "the column 'b'");
  refuses("{spectrum: /no/such.csv}", good, ABBE_IO, "/no/such.csv");
  refuses("{patch: red, colour: blue}", good, ABBE_SCHEMA, "colour");
  refuses("{patch: red}, texture: wood.png", good, ABBE_SCHEMA, "a texture multiplies");
}
