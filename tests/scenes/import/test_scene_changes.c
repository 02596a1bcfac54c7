/* Values, materials and lights that are put in the place of others, and numbers by their path. */
#include "tests/check.h"

#include "base/file.h"
#include "scenes/import/scene_file.h"

#include <unistd.h>

#define PARTS ABBE_SOURCE_DIR "/tests/fuzz/parts/"
#define STONE ABBE_SOURCE_DIR "/scenes/designs/step-square.asc"
#define HEAD                                                                                       \
  "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05], fov: 30}\n"                                   \
  "lights: [{name: lamp, kind: point, position: [0, 0, 2], intensity: 1}]\n"                       \
  "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5}\n"
#define BALL(name, material)                                                                       \
  "- {" name "shape: sphere, levels: 1, radius: 5cm, stand: [0, 0, 0.1], material: " material "}"  \
  "\n"

static char folder[] = "/tmp/abbe-test-changes-XXXXXX";

static void make_folder(void) {
  assert_non_null(mkdtemp(folder));
}

static void drop_folder(void) {
  rmdir(folder);
}

GROUP(make_folder, drop_folder);

static abbe_result parse(const char *text, const char *stone, const char *set, abbe_scene *out,
                         abbe_error *error) {
  const abbe_scene_options options = {.stone = stone, .set = &set, .set_count = set != NULL};
  return abbe_scene_parse(text, strlen(text), PARTS "x.yaml", &options, out, error);
}

#define TABLE "materials: table.yaml\n"
#define TWO TABLE HEAD BALL("name: a, ", "flat") BALL("", "crown")

TEST(what_cannot_be_set_is_said) {
  static const struct {
    const char *text, *set, *words;
  } rows[] = {
      {TWO, "lights.lamps.intensity=1", "there is no 'lamps'; did you mean 'lamp'?"},
      {TWO, "objects.1234567.width=1", "there is no '1234567'"},
      {TWO, "objects.0x.width=1", "there is no '0x'"},
      {TWO, "objects.3.width=1", "there is no '3' there"},
      {TWO, "objects.b.radius=1", "there is no 'b'"},
      {TWO, "camera.=1", "there is no ''"},
      {TABLE "objects:\n- &a {width: 1}\n- *a\n", "objects.1.width=2", "'1' is shared with other"},
      {TABLE "objects:\n- &a {width: 1}\n- *a\n", "objects.1=2", "alias"},
      {"camera: {", "camera.fov=2", "x.yaml:"},
  };
  abbe_scene scene;
  abbe_error why = {0};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    if (parse(rows[i].text, NULL, rows[i].set, &scene, &why) == ABBE_OK ||
        strstr(why.text, rows[i].words) == NULL)
      fail_msg("%s: %s", rows[i].set, why.text);
  char longest[300] = "";
  memset(longest, 'a', 255);
  REFUSED(ABBE_SCHEMA, "a scene has no key 'aaaa",
          parse(TWO, NULL, printed("%s=1", longest), &scene, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "sets nothing; write KEY=VALUE",
          parse(TWO, NULL, printed("%sa=1", longest), &scene, &error));
}

TEST(stones_that_cannot_be_replaced) {
  static const struct {
    const char *text, *stone, *words;
  } rows[] = {
      {TWO, "smoke", "'smoke' in the place of what? It has flat and crown; write flat=smoke"},
      {TABLE HEAD, "smoke", "none of its objects has a 'material' to be replaced by 'smoke'"},
      {TABLE "objects: 3\n", "smoke", "none of its objects"},
      {TABLE "objects: [[1], 2]\n", "smoke", "none of its objects"},
      {TWO, "crow=smoke",
       "made of 'crow', or is an object of that name that has a material; did "
       "you mean 'crown'?"},
      {TABLE HEAD BALL("", "&m flat") BALL("", "*m") BALL("", "flat"), "smoke", "alias"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    abbe_scene scene;
    abbe_error why = {0};
    if (parse(rows[i].text, rows[i].stone, NULL, &scene, &why) == ABBE_OK ||
        strstr(why.text, rows[i].words) == NULL)
      fail_msg("%s: %s", rows[i].stone, why.text);
  }
  /* two of one material, one of them without a name */
  MADE(abbe_scene, scene,
       parse(TABLE HEAD BALL("name: a, ", "flat") BALL("", "flat"), "smoke", NULL, &scene, &error));
  for (size_t i = 1; i < 3; i++) assert_string_equal(scene.object[i].material->name, "smoke");
  abbe_scene_free(&scene);
  OK(parse(TWO, "crown=smoke", NULL, &scene, &error));
  assert_string_equal(scene.object[1].material->name, "flat");
  assert_string_equal(scene.object[2].material->name, "smoke");
}

static const char *write_scene(const char *text) {
  const char *path = printed("%s/s.yaml", folder);
  OK(abbe_file_write(path, text, strlen(text), &error));
  return path;
}

/* More names than are looked through for one that is near. */
TEST(many_names) {
  enum { MANY = 600 };
  static char text[120000];
  abbe_scene scene;
  char *at = text + sprintf(text, "%s", TABLE HEAD);
  for (int i = 0; i < MANY; i++)
    at +=
        sprintf(at, "- {name: n%d, shape: rectangle, width: 1, height: 1, material: m%d}\n", i, i);
  REFUSED(ABBE_INVALID_ARGUMENT, "there is no 'n600'; did you mean 'n60'?",
          parse(text, NULL, "objects.n600.width=1", &scene, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "nothing in it is made of 'zzz'",
          parse(text, "zzz=smoke", NULL, &scene, &error));
  double value;
  const char *path = write_scene(text);
  REFUSED(ABBE_INVALID_ARGUMENT, "'objects.n9' is no number; one near it is 'objects.n",
          abbe_scene_number(path, NULL, "objects.n9", &value, &error));
  unlink(path);
}

/* So many settings that the names of their metals are not all kept. */
TEST(many_settings) {
  enum { MANY = 5000 };
  static char text[40 * MANY];
  abbe_scene scene;
  char *at = text + sprintf(text, "%s",
                            TABLE HEAD "- {shape: sphere, radius: 1, material: flat, "
                                       "setting: [3");
  for (int i = 0; i < MANY; i++) at += sprintf(at, ", {metal: m%d}", i);
  strcpy(at, "]}\n");
  REFUSED(ABBE_SCHEMA, "5001 settings: a stone has up to 4",
          parse(text, NULL, NULL, &scene, &error));
}

TEST(numbers_by_their_path) {
  static const struct {
    const char *key, *words; /* NULL: the number */
    double value;
  } rows[] = {
      {"camera.fov", NULL, 30},
      {"camera.eye.1", NULL, -1},
      {"objects.1.radius", NULL, 0.05},
      {"lights.lamp.intensity", NULL, 1},
      {"lights.lamp.kind", "is no number; one near it is 'lights.lamp.", 0},
      {"camera", "is no number; one near it is 'lights'", 0},
      {"objects.floor.shape", "is no number; one near it is 'objects.floor.", 0},
      {"objects.floor.shapes", "there is no 'shapes'; did you mean 'shape'?", 0},
      {"words.0", "'words.0' is no number", 0},
      {"word.only", "'word.only' is no number", 0},
      {"far.farr", "is no number; one near it is 'far.far'", 0},
  };
  const char *path = write_scene(
      HEAD BALL("", "water") "words: [a, b]\nword: {only: a}\nfar: {far: 3, farr: b}\n");
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    double value = 0;
    abbe_error why = {0};
    const abbe_result result = abbe_scene_number(path, NULL, rows[i].key, &value, &why);
    if ((result == ABBE_OK) != (rows[i].words == NULL) || value != rows[i].value ||
        strstr(why.text, rows[i].words ? rows[i].words : "") == NULL)
      fail_msg("%s: %g: %s", rows[i].key, value, why.text);
  }
  double value;
  REFUSED(ABBE_IO, "/no/such.yaml", abbe_scene_number("/no/such.yaml", NULL, "a", &value, &error));
  const char *const set[] = {"camera.fov=31"};
  const abbe_scene_options options = {.set = set, .set_count = 1};
  FREED char *text = NULL;
  size_t size = 0;
  OK(abbe_scene_text(path, &options, &text, &size, &error));
  assert_int_equal(size, strlen(text));
  assert_contains(text, "fov: 31");
  char *none;
  REFUSED(ABBE_IO, "/no/such.yaml", abbe_scene_text("/no/such.yaml", NULL, &none, &size, &error));
  assert_null(none);
  unlink(path);
}

/* A stone's file is the scene that is made for it, of the material and table that are given. */
TEST(stones_are_scenes) {
  const abbe_studio studio = {.material = "diamond", .folder = "/nowhere/"};
  static const struct {
    const char *stone, *table, *material;
    bool studio;
  } rows[] = {{NULL, NULL, NULL, false},
              {"ruby", NULL, "ruby", false},
              {NULL, "thesis", "bk7", false},
              {NULL, NULL, "diamond", true},
              {"diamond=ruby", NULL, "ruby", true}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    abbe_studio made = studio;
    if (rows[i].table != NULL) made.material = "bk7";
    if (!rows[i].studio) made.folder = NULL;
    const abbe_scene_options options = {.stone = rows[i].stone,
                                        .materials = rows[i].table,
                                        .studio = rows[i].studio || rows[i].table ? &made : NULL};
    MADE(abbe_scene, scene, abbe_scene_load(STONE, i > 0 ? &options : NULL, &scene, &error));
    size_t stones = 0;
    for (size_t k = 0; k < scene.object_count; k++) {
      if (scene.object[k].material == NULL) continue;
      stones++;
      if (rows[i].material != NULL)
        assert_string_equal(scene.object[k].material->name, rows[i].material);
    }
    assert_int_equal(stones, 1);
  }
  /* its paths start where they are told to, and lines are those of the scene that is made */
  const char *const set[] = {"camera.fow=3"};
  const abbe_scene_options options = {.studio = &studio, .set = set, .set_count = 1};
  FREED char *text = NULL;
  size_t size;
  abbe_scene scene;
  OK(abbe_scene_text(STONE, &options, &text, &size, &error));
  assert_contains(text, STONE);
  REFUSED(ABBE_SCHEMA,
          "step-square.asc's scene:", abbe_scene_load(STONE, &options, &scene, &error));
}

/* Parts of one mesh have its line. */
TEST(lines_of_parts) {
  static const char boxes[] =
      HEAD "- {mesh: " ABBE_SOURCE_DIR
           "/tests/meshes/crossing.obj, material: water}\n" BALL("", "water");
  const char *path = write_scene(boxes);
  MADE(abbe_scene, scene, abbe_scene_load(path, NULL, &scene, &error));
  write_scene(printed("ambient: 0.5\n%s", boxes));
  OK(abbe_scene_load_lights(path, NULL, &scene, &error));
  static const size_t lines[] = {5, 6, 6, 7};
  assert_int_equal(scene.object_count, 4);
  for (size_t i = 0; i < 4; i++) assert_int_equal(scene.object[i].line, lines[i]);
  unlink(path);
}

/* Lights anew, the rest of the scene kept, with the lines of the file as it is now. */
TEST(lights_alone) {
  const char *path = write_scene(HEAD BALL("name: a, ", "water"));
  MADE(abbe_scene, scene, abbe_scene_load(path, NULL, &scene, &error));
  static const struct {
    const char *text, *words;
  } rows[] = {{"ambient: 0.25\n" HEAD BALL("name: a, ", "water"), NULL},
              {"camera: {", "s.yaml:"},
              {"ambient: -1\n" HEAD, "'ambient: -1'"},
              {"lights: 3\n", "'lights' wants a list"},
              {"ambient: 0\n", "has no light"},
              {HEAD, NULL}}; /* objects that are gone keep their lines */
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    abbe_error why = {0};
    write_scene(rows[i].text);
    const abbe_result result = abbe_scene_load_lights(path, NULL, &scene, &why);
    if ((result == ABBE_OK) != (rows[i].words == NULL) ||
        strstr(why.text, rows[i].words ? rows[i].words : "") == NULL)
      fail_msg("%zu: %s", i, why.text);
    assert_int_equal(scene.light_count, 1);
    assert_int_equal(scene.object_count, 2);
    assert_near(scene.ambient, i < 5 ? 0.25 : 0, 0);
    assert_int_equal(scene.object[0].line, i < 5 ? 5 : 4);
    assert_int_equal(scene.object[1].line, 6);
  }
  unlink(path);
}
