/* Scenes that are nearly right: each row is refused for one thing, where it stands. */
#include "tests/check.h"

#include "base/file.h"
#include "scenes/import/scene_file.h"

#include <unistd.h>

#define NAME ABBE_SOURCE_DIR "/tests/fuzz/parts/scene.yaml" /* beside what scenes name */

#define TOP "materials: table.yaml\n"
#define CAMERA(keys) "camera: {target: [0, 0, 0.05], " keys "}\n"
#define LAMP "lights: [{name: lamp, kind: point, position: [0, 0, 2], intensity: 1}]\n"
#define LIGHT(keys) "lights:\n- {position: [0, 0, 2], " keys "}\n"
#define FLOOR "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5}\n"
#define EYE CAMERA("eye: [0, -1, 0.5]")
#define HEAD TOP EYE LAMP FLOOR
#define OBJECT(keys) HEAD "- {" keys "}\n"
#define BOX(keys) OBJECT("name: box, shape: box, size: [0.1, 0.1, 0.1], " keys)
#define CUT(keys)                                                                                  \
  OBJECT("name: cut, shape: cut, file: ../../../scenes/designs/step-square.asc, width: 0.01, "     \
         "material: flat, " keys)
#define BOXES "mesh: ../../meshes/crossing.obj, material: flat, "
#define SKY(keys) TOP EYE FLOOR "environment: {size: 64, " keys "}\n"
#define POOL(keys) OBJECT("shape: water, size: [1, 1, 0.1], material: flat, " keys)

static abbe_result parse(const char *text, const abbe_scene_options *options, abbe_scene *out,
                         abbe_error *error) {
  return abbe_scene_parse(text, strlen(text), NAME, options, out, error);
}

typedef struct row {
  const char *text, *words;
} row;

static void refuse_all(const row *rows, size_t count) {
  for (size_t i = 0; i < count; i++) {
    abbe_scene scene;
    abbe_error why = {0};
    if (parse(rows[i].text, NULL, &scene, &why) == ABBE_OK ||
        strstr(why.text, rows[i].words) == NULL || strstr(why.text, "scene.yaml:") == NULL)
      fail_msg("%s: %s",
               strrchr(rows[i].text, '\n') - 100 > rows[i].text ? strrchr(rows[i].text, '\n') - 100
                                                                : rows[i].text,
               why.text);
    assert_null(scene.object);
  }
}

#define REFUSE(rows) refuse_all(rows, sizeof(rows) / sizeof *(rows))

TEST(places_and_sizes) {
  static const row rows[] = {
      {BOX("material: flat, transform: [{rotate: {axis: [1, 0, 0]}}]"), "'angle'"},
      {BOX("material: flat, transform: [{look: {from: [0, 0, 1], to: [0, 0, 1]}}]"), "apart"},
      {BOX("material: flat, transform: [{look: {from: [0, 0, 1], to: [1, 0, 1], up: [0, 0, 0]}}]"),
       "'up' not 0"},
      {BOX("material: flat, transform: [{look: {from: [0, 0, 0], to: [1e-200, 0, 0]}}]"), "'look'"},
      {BOX("material: flat, stand: [0, 0, 0], centre: [0, 0, 0]"), "one of the two"},
      {OBJECT("mesh: tetra.obj, material: flat, width: 0.1, fit: 0.1"), "one of the two"},
      {BOX("material: flat, flatten: 0.01"), "'flatten' is for the mesh of a file"},
      {BOX("material: flat, fit: 0"), "in metres, above 0"},
      {HEAD "- 7\n", "an object must be a mapping"},
      {OBJECT("shpae: sphere, radius: 1, material: flat"), "did you mean 'shape'"},
      {OBJECT("mehs: tetra.obj, material: flat"), "did you mean 'mesh'"},
      {BOX("materail: flat"), "did you mean 'material'"},
      {OBJECT("shape: cut, file: a.asc, width: 0, material: flat"), "'width' is the stone's"},
      {OBJECT("shape: lathe, material: flat"), "'profile'"},
      {OBJECT("shape: lathe, material: flat, profile: [[0, 0]]"), "a list of 2 to 4096"},
      {OBJECT("shape: lathe, material: flat, profile: [[0.1, 0], [0, 0.1]]"), "this one is open"},
      {OBJECT("mesh: ../../../scenes/bunny.ply, material: flat, subdivide: 8"), "faces"},
  };
  REFUSE(rows);
}

TEST(what_objects_are_made_of) {
  static const row rows[] = {
      {BOX("mirror: ''"), "is empty"},
      {BOX("mirror: 1x"), "'1x'"},
      {BOX("mirror: 0.9, roughness: 0.2, brushed: [0, 0, 1]"), "'brushed' wants"},
      {BOX("material: flat, brushed: {along: [1, 0, 0]}"), "what refracts has no grooves"},
      {BOX("reflectance: 1, brushed: {along: [1, 0, 0]}"), "'brushed' is of a mirror; what receiv"},
      {BOX("reflectance: 1, roughness: 0.5"), "'roughness' is of a mirror; what receives light"},
      {BOX("mirror: 0.9, roughness: [0.4, 0.1]"), "which way the grooves run"},
      {BOX("reflectance: 1, axis: [0, 0, 1]"), "'axis' is the optic axis of a crystal"},
      {BOX("material: flat, axis: [0, 0, 1]"), "the optic axis of a uniaxial crystal; the mat"},
      {OBJECT(BOXES "coating: {layers: [[1.38, 100]]}"), "films or rough facets"},
      {OBJECT(BOXES "roughness: 0.2"), "films or rough facets"},
      {BOX("material: flat, coating: {layers: [[[1.38, 0.1, 2], 100]]}"), "a layer is of a mat"},
      {BOX("material: flat, coating: {layers: [[1.38, 100]], faces: ['']}"), "names of facets"},
      {BOX("material: flat, coating: {layers: [[1.38, 100]], faces: []}"), "'faces' is empty"},
      {BOX("material: flat, roughness: []"), "'roughness' has 1 to 16 entries, not 0"},
      {BOX("material: flat, coating: [{layers: [[1.38, 1]]}, {layers: [[1.38, 1]]}]"),
       "a second entry for all"},
      {BOX("material: flat, coating: {layers: [[1.38, 100]], faces: culet}"),
       "'box' has no facet 'culet'; facets are named table, crown, girdle, pavilion"},
      {CUT("coating: {layers: [[1.38, 100]], faces: culet}"),
       "facets are named table, crown, girdle, pavilion, G, 1, 2, A, B, T"},
      {BOX("material: flat, clouds: [7]"), "a cloud has a 'radius' or a 'size'"},
      {BOX("material: flat, clouds: [{size: [0, 1, 1]}]"), "'size' of a cloud is above 0"},
      {BOX("material: flat, clouds: [{size: [0.01, 0, 1]}]"), "'size' of a cloud is above 0"},
      {BOX("material: flat, clouds: [{size: [0.01, 0.01, 0]}]"), "'size' of a cloud is above 0"},
      {BOX("material: flat, clouds: [{radius: 0}]"), "'radius' of a cloud is above 0"},
      {BOX("material: flat, clouds: 3"), "wants a list of 1 to 32"},
      {BOX("material: flat, clouds: [{radius: 1}]"), "reaches out of 'box'"},
      {OBJECT(BOXES "clouds: [{radius: 0.001}]"), "is several, which cross"},
      {BOX("reflectance: 1, clouds: [{radius: 0.01}]"), "has no 'material'"},
  };
  REFUSE(rows);
}

TEST(water_and_sky) {
  static const row rows[] = {
      {POOL("waves: [7]"), "an entry of 'waves' must be a mapping"},
      {POOL("drops: [{at: [0, 0], time: soon, depth: 0.01, radius: 0.1}]"), "'time: soon'"},
      {POOL("rain: 3"), "'rain' must be a mapping"},
      {SKY("uniform: 1, illuminant: mercury"), "surroundings have no light of lines"},
      {SKY("uniform: 1, tilt: {axis: [0, 0, 1]}"), "'angle'"},
      {SKY("sun: {towards: [0, 0, 1], azimuth: 3, irradiance: 1}"), "either 'towards' or"},
      {SKY("sky: {type: overcast, zenith: 1, azimuth: 3}"), "'elevation'"},
      {SKY("sky: {type: clear, zenith: 1, towards: [0, 0, -1]}"), "below the horizon"},
      {SKY("sky: {type: -3, zenith: 1}"), "'type' is clear, overcast, or the number"},
      {SKY("softboxes: [{elevation: 3, radiance: 1, height: 3}]"), "'width'"},
      {SKY("softboxes: [{elevation: 3, radiance: 1, radius: 3, roll: 3}]"), "has both"},
  };
  REFUSE(rows);
}

TEST(cameras_and_lights) {
  static const row rows[] = {
      {TOP CAMERA("eye: [0, -1, 0.5], size: [64, 48.5]") LAMP FLOOR, "two whole numbers"},
      {TOP CAMERA("frame: floor, elevation: 0, azimuth: 0, up: [1, 0, 0]") LAMP FLOOR, "'up'"},
      {TOP CAMERA("eye: [0, -1, 0.5], aperture: 8, focus: 0") LAMP FLOOR, "'focus: 0'"},
      {TOP CAMERA("eye: [0, -1, 0.5], aperture: 8, focus: [floor]") LAMP FLOOR,
       "'focus' wants names of objects"},
      {TOP EYE LIGHT("kind: point, intensity: {keyframes: [[0, []]]}") FLOOR, "1 to 16 numbers"},
      {TOP EYE LIGHT("kind: point, intensity: {keyframes: [[0, 1], [1, x]]}") FLOOR, "keyframes"},
      {TOP EYE LIGHT("kind: spot, direction: [0, 0, -1], target: [0, 0, 0]") FLOOR, "has both"},
      {TOP EYE LIGHT("kind: spot, target: [0, 0, 2]") FLOOR, "direction is zero"},
      {TOP EYE LIGHT("kind: point, target: [0, 0, 1]") FLOOR, "a point light has no 'target'"},
      {TOP EYE LIGHT("kind: point, direction: [0, 0, 1]") FLOOR, "no 'direction'; it shines"},
      {TOP EYE LAMP "objects: []\n", "has no receiver"},
      {TOP "temperature: 40\n" EYE LAMP FLOOR "- {mesh: coloured.gltf, material: from-file}\n",
       "'temperature': "},
      {OBJECT("mesh: tetra.obj, reflectance: 1, transform: [{scale: [0, 1, 1]}]"), "'scale' must"},
  };
  REFUSE(rows);
}

/* Lists of as many items as there may be, and one more. */
TEST(lists_have_an_end) {
  static const struct {
    const char *before, *item, *after, *words;
    int most;
  } lists[] = {
      {POOL("waves: ["), "{}", "]", "'waves' wants a list of up to 64", 64},
      {OBJECT("shape: lathe, material: flat, profile: ["), "[0, 0]", "]", "a list of 2 to 4096",
       4096},
      {BOX("material: flat, coating: ["), "{layers: [[1.38, 1]], faces: table}", "]",
       "'coating' has 1 to 16 entries, not 17", 16},
      {BOX("material: flat, clouds: ["), "{radius: 1mm}", "]", "a list of 1 to 32 balls", 32},
      {BOX("material: flat, setting: ["), "{kind: band, metal: metal}", "]",
       "5 settings: a stone has up to 4", 4},
      {SKY("dome: ["), "[0, 1]", "]", "'dome' wants", 1024},
      {SKY("softboxes: ["), "{elevation: 90, radius: 3, radiance: 1}", "]",
       "'softboxes' wants a list of at most 256", 256},
      {TOP EYE "lights: [{kind: point, position: [0, 0, 2], intensity: {keyframes: [", "[%d, 1]",
       "]}}]\n" FLOOR, "a list of 1 to 10000 pairs", 10000},
      {TOP EYE "lights: [{kind: point, position: {keyframes: [[0, [", "1", "]]]}}]\n" FLOOR,
       "1 to 16 numbers", 16},
  };
  static char text[400000];
  for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
    for (int more = 0; more < 2; more++) {
      OWNED(abbe_scene, scene) = {0};
      abbe_error why = {0};
      char *at = text + sprintf(text, "%s", lists[i].before);
      const size_t tail = strlen(lists[i].before);
      char rest[8] = "";
      if (strcmp(at - 2, "}\n") == 0) strcpy(rest, "}\n"), at -= 2; /* the braces close behind */
      for (int k = 0; k < lists[i].most + more; k++) {
        if (k > 0) at += sprintf(at, ", ");
        at += sprintf(at, lists[i].item, k);
      }
      sprintf(at, "%s%s", lists[i].after, rest);
      assert_true(tail < sizeof text);
      const abbe_result result = parse(text, NULL, &scene, &why);
      if ((strstr(why.text, lists[i].words) != NULL) != (more == 1) ||
          (more == 1 && result == ABBE_OK))
        fail_msg("%s, %d more: %s", lists[i].words, more, why.text);
    }
}

/* What is read, though it looks as the rows above. */
TEST(scenes_that_are_right) {
  static const struct {
    const char *text, *fixes;
    abbe_exact_kind exact;
    size_t objects;
  } rows[] = {
      {OBJECT("shape: sphere, radius: 0.1, material: flat, transform: [{rotate: {axis: [0, 0, 1], "
              "angle: 45}}, {scale: [2, 1, 1]}]"),
       NULL, ABBE_EXACT_NONE, 2},
      {OBJECT("shape: sphere, radius: 0.1, material: flat, fit: 0.3, transform: [{scale: [1, 2, "
              "1]}]"),
       NULL, ABBE_EXACT_NONE, 2},
      {OBJECT("mesh: ../../bad/inverted.obj, material: flat, flatten: 0.001"),
       "; made a convex solid of planes", ABBE_EXACT_CONVEX, 2},
      {CUT("roughness: {alpha: 0.3, faces: [t, a]}"), NULL, ABBE_EXACT_CONVEX, 2},
      {CUT("setting: {kind: pave, metal: metal}"), NULL, ABBE_EXACT_CONVEX, 3},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    MADE(abbe_scene, scene, parse(rows[i].text, NULL, &scene, &error));
    const abbe_object *o = &scene.object[1];
    assert_int_equal(scene.object_count, rows[i].objects);
    assert_int_equal(o->exact.kind, rows[i].exact);
    assert_true((o->fixes != NULL) == (rows[i].fixes != NULL));
    if (o->fixes != NULL) assert_contains(o->fixes, rows[i].fixes);
    if (i == 1) assert_near(o->max[1] - o->min[1], 0.3, 1e-12); /* as its vertices lie */
    if (i != 3) continue;
    size_t rough = 0;
    for (size_t f = 0; f < o->roughness->face_count; f++) rough += o->roughness->face[f] != 0;
    assert_int_equal(rough, 2 + 4 * 2); /* a table of four corners, and four sides of four */
  }
  /* the light of a lamp that has a name is no file */
  MADE(abbe_scene, scene,
       parse(TOP EYE LIGHT("kind: point, intensity: 1, illuminant: F11") FLOOR, NULL, &scene,
             &error));
  assert_null(scene.light[0].illuminant_path);
}

/* Places beyond numbers. */
TEST(sizes_that_are_no_number) {
  static const struct {
    const char *step, *keys, *words;
  } rows[] = {
      {"{scale: 1e6}", "shape: rectangle, width: 1, height: 1, fit: 1", "no size cannot be fitted"},
      {"{scale: 1e6}", "shape: rectangle, width: 1, height: 1", "flattens the mesh"},
      {"{scale: [1, 1, 1e6]}", "shape: lathe, around: 3, profile: [[1, 0], [1, 1e6]]",
       "has no finite size"},
      {"{scale: [1, 1, 1e6]}", "shape: lathe, around: 3, profile: [[1, 0], [1, -1e6]]",
       "has no finite size"},
      {"{scale: [1, 1, 1e6]}", "shape: lathe, around: 3, profile: [[1, 0], [1, 1e6]], fit: 1",
       "no size cannot be fitted"},
      {"{scale: 1e6}", "shape: box, size: [1, 1, 1], fit: 1, setting: {kind: band, metal: metal}",
       "no size cannot be fitted"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    abbe_scene scene;
    char text[4096];
    const bool stone = strstr(rows[i].keys, "setting") != NULL;
    snprintf(text, sizeof text, HEAD "- {%s, %s, transform: [", rows[i].keys,
             stone ? "material: flat" : "reflectance: 1");
    for (int k = 0; k < (strchr(rows[i].step, '[') ? 51 : 60); k++)
      snprintf(text + strlen(text), sizeof text - strlen(text), "%s, ", rows[i].step);
    strcat(text, "{scale: 1}]}\n");
    abbe_error why = {0};
    if (parse(text, NULL, &scene, &why) == ABBE_OK || strstr(why.text, rows[i].words) == NULL)
      fail_msg("%s: %s", rows[i].keys, why.text);
  }
}
