/* The key 'coating': what is read of layers, files and facets, and what is refused. */
#include "tests/scenes/scene_text.h"

#define HEAD                                                                                       \
  "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"                                            \
  "lights: [{name: l, kind: point, position: [0, 0, 2], intensity: 1}]\nobjects:\n"                \
  "- {name: floor, shape: rectangle, width: 1, height: 1, reflectance: 1}\n"

#define COATINGS                                                                                   \
  "! made up\nMATE MGF2\n0.4 1.39 0\n0.7 1.37 0 ! red\nMATE CHROME\n.55 3.2 -4.4\nMATE GAIN\n"     \
  "0.5 2 1\nTAPR RIM\nPT 0 1\nCOAT AR\nMGF2 0.25\nCOAT THICK\nMGF2 0.0996 1 0\nCHROME .01 1\n"     \
  "f2 0.1 1\nCOAT LOOP\nMGF2 .1 1 2\nCOAT TAPERED\nMGF2 .1 1 0 RIM\nCOAT LOST\nUNOBTANIUM .1 1\n"  \
  "COAT AMPLIFIES\nGAIN .1 1\nCOAT DEEP\nMGF2 5.1 1\nCOAT BROKEN\nMGF2 thin 1\nTABLE T\nANGL 0\n"  \
  "WAVE 0.5 0.1 0.1 0.9 0.9\nIDEAL I 0.9 0.1\nMATE HUGE\n0.5 1e300 0\nCOAT VAST\nHUGE .1 1\nCOAT " \
  "NAUGHT\nTABLE S\nANGL 0\nWAVE 0.5 0.1 0.2 0.9 0.7 180 180 0 0\nWAVE 0.6 0 0 1 1\nANGL "         \
  "60\nWAVE 0.5 "                                                                                  \
  "0.3 0.1 0.7 0.8\nWAVE 0.6 0.2 0.2 0.8 0.8\nTABLE SHORT\nANGL 0\nWAVE 0.5 0 0 1 1\nANGL "        \
  "9\nTABLE "                                                                                      \
  "OTHER\nANGL 0\nWAVE 0.5 0 0 1 1\nANGL 9\nWAVE 0.6 0 0 1 1\nTABLE FALLS\nANGL 9\nWAVE 0.5 0 0 "  \
  "1 1\n"                                                                                          \
  "ANGL 8\nWAVE 0.5 0 0 1 1\nTABLE LASES\nANGL 0\nWAVE 0.5 0.5 0 0.6 1\nTABLE SPARSE\nANGL "       \
  "0\nWAVE "                                                                                       \
  "0.5 0.5\nTABLE VOID\n"
/* Its maker's example. [SpeosCoated] */
#define COATED                                                                                     \
  "OPTIS - Coated surface file v1.0\nCoating File Example\n4 3\n\t480\t580\t780\n"                 \
  "0\t31.9\t68.1\t1.5\t98.5\t25.7\t74.3\n\t31.9\t68.1\t1.5\t98.5\t25.7\t74.3\n"                    \
  "50\t11.3\t88.7\t11.4\t88.6\t23.3\t76.7\n\t11.3\t88.7\t11.4\t88.6\t23.3\t76.7\n"                 \
  "70\t15\t85\t15.2\t84.8\t26.3\t73.7\n\t16\t84\t15.2\t84.8\t26.3\t73.7\n"                         \
  "90\t100\t0\t100\t0\t100\t0\n\t100\t0\t100\t0\t100\t0\n"

typedef struct folder {
  char path[64], file[96], zec[96], coated[96];
} folder;

static void make_folder(folder *f) {
  snprintf(f->path, sizeof f->path, "/tmp/abbe-test-coating-XXXXXX");
  assert_non_null(mkdtemp(f->path));
  snprintf(f->file, sizeof f->file, "%s/COATING.DAT", f->path);
  snprintf(f->zec, sizeof f->zec, "%s/AR.ZEC", f->path);
  OK(abbe_file_write(f->file, COATINGS, strlen(COATINGS), &error));
  snprintf(f->coated, sizeof f->coated, "%s/AR.coated", f->path);
  OK(abbe_file_write(f->zec, "x", 1, &error));
  OK(abbe_file_write(f->coated, COATED, strlen(COATED), &error));
}

static void folder_free(folder *f) {
  unlink(f->file);
  unlink(f->zec);
  unlink(f->coated);
  rmdir(f->path);
}

/* An object with its middle at 0.2 m, turned by a quarter. */
static abbe_result parse(const folder *f, const char *rest, abbe_scene *scene, abbe_error *out) {
  const char *text = printed(HEAD "- {name: a, transform: [{rotate: {axis: [1, 0, 0], angle: 90}}, "
                                  "{translate: [0, 0, 0.2]}], %s}\n",
                             rest);
  const char *name = printed("%s/scene.yaml", f->path);
  OK(abbe_file_write(name, text, strlen(text), &error));
  const abbe_result result = abbe_scene_load(name, NULL, scene, out);
  unlink(name);
  return result;
}

#define BOX "shape: box, size: [0.1, 0.1, 0.1], material: n-bk7, coating: "
#define FROM(name) BOX "{file: COATING.DAT, name: " name "}"

static void check_layers(const folder *f, const char *rest, double nm, size_t count,
                         const double wanted[][3]) {
  abbe_film_layer layer[ABBE_FILM_MOST_LAYERS];
  MADE(abbe_scene, scene, parse(f, rest, &scene, &error));
  const abbe_coatings *c = scene.object[1].coatings;
  assert_int_equal(c->coating[0].count, count);
  OK(abbe_coating_at(&c->coating[0], nm, layer, &error));
  for (size_t i = 0; i < count; i++) {
    assert_near(layer[i].n, wanted[i][0], 1e-6);
    assert_near(layer[i].k, wanted[i][1], 1e-6);
    assert_near(layer[i].nm, wanted[i][2], 1e-3);
  }
}

TEST(layers_are_read_in_every_form) {
  FILLED(folder, f, make_folder(&f));
  check_layers(&f, BOX "{layers: [[1.38, 99.6], [[0.42, 2.4], 10], [f2, 20]]}", 587.5618, 3,
               (const double[][3]){{1.38, 0, 99.6}, {0.42, 2.4, 10}, {1.620040, 0, 20}});
  check_layers(&f, BOX "{layers: [[1.38, 1], [2.15, 2]], quarter: 550}", 500, 2,
               (const double[][3]){{1.38, 0, 99.63768}, {2.15, 0, 127.90698}});
  check_layers(&f, BOX "{file: COATING.DAT, name: ar, primary: 550}", 550, 1,
               (const double[][3]){{1.38, 0, 99.63768}});
  check_layers(&f, FROM("THICK"), 587.5618, 3,
               (const double[][3]){{1.377496, 0, 99.6}, {3.2, 4.4, 10}, {1.620040, 0, 100}});
  check_layers(&f, BOX "{file: COATING.DAT, name: AR, primary: 550}", 300, 1,
               (const double[][3]){{1.39, 0, 99.63768}});
}

/* Which faces have which coating, by the object's own axes. */
TEST(facets_are_coated_by_name) {
  FILLED(folder, f, make_folder(&f));
  MADE(abbe_scene, scene,
       parse(&f,
             BOX "[{layers: [[1.38, 99.6]]}, {layers: [[2.4, 60]], faces: [table]}, {layers: "
                 "[[2.4, 90]], faces: GIRDLE}]",
             &scene, &error));
  const abbe_object *o = &scene.object[1];
  size_t count[4] = {0};
  for (size_t i = 0; i < o->mesh.face_count; i++) {
    const abbe_coating *on = abbe_coatings_on(o->coatings, i);
    count[on == NULL ? 3 : on - o->coatings->coating]++;
    /* its table, of +z, looks to -y */
    if (on == &o->coatings->coating[1])
      assert_near(o->mesh.normal[o->mesh.face[i][0]][1], -1, 1e-9);
  }
  assert_int_equal(count[0], 2);
  assert_int_equal(count[1], 2);
  assert_int_equal(count[2], 8);
  abbe_scene_free(&scene);
  OK(parse(&f,
           printed("shape: cut, file: %s/scenes/designs/brilliant-diamond.asc, width: 0.1, "
                   "material: n-bk7, coating: {layers: [[1.38, 99.6]], faces: [pavilion]}",
                   ABBE_SOURCE_DIR),
           &scene, &error));
  double coated = 0, faces = (double)scene.object[1].mesh.face_count;
  for (size_t i = 0; i < scene.object[1].mesh.face_count; i++)
    coated += abbe_coatings_on(scene.object[1].coatings, i) != NULL;
  assert_true(coated > 0.2 * faces && coated < 0.6 * faces);
  assert_int_equal(abbe_scene_file_count(&scene), 4 + 1 + 6 + 1);
}

/* How rough facets are, by the same names. */
TEST(facets_are_rough_by_name) {
  static const char box[] = "shape: box, size: [0.1, 0.1, 0.1], material: n-bk7, roughness: ";
  static const struct {
    const char *rest, *part;
  } rows[] = {
      {"0", "'roughness: 0'"},
      {"1.5", "'roughness: 1.5'"},
      {"{alpha: 0.0005}", "'roughness: 0.0005'"},
      {"{faces: table}", "alpha"},
      {"{alpha: 0.3, faces: [culet]}", "has no facet 'culet'; facets are named table"},
      {"[]", "1 to 16 entries, not 0"},
      {"[0.3, 0.4]", "'roughness' has a second entry for all of the object"},
      {"0.3, brushed: {along: [1, 0, 0]}", "what refracts has no grooves here"},
  };
  FILLED(folder, f, make_folder(&f));
  MADE(abbe_scene, scene,
       parse(&f, printed("%s[0.2, {alpha: 0.3, faces: girdle}]", box), &scene, &error));
  const abbe_object *o = &scene.object[1];
  double rough = 0;
  for (size_t i = 0; i < o->mesh.face_count; i++) rough += abbe_coatings_on(o->roughness, i)->alpha;
  assert_near(rough, 4 * 0.2 + 8 * 0.3, 1e-12);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    abbe_scene none;
    REFUSED(ABBE_SCHEMA, rows[i].part,
            parse(&f, printed("%s%s", box, rows[i].rest), &none, &error));
  }
}

TEST(coatings_that_cannot_be_are_refused) {
  static const struct {
    abbe_result code;
    const char *rest, *part;
  } rows[] = {
      {ABBE_SCHEMA, BOX "{layers: [[1.38, -1]]}", "thickness"},
      {ABBE_SCHEMA, BOX "{layers: [[1.38, 5001]]}", "5000"},
      {ABBE_SCHEMA, BOX "{layers: [[1.38, 99]], quarter: 550}", "is thicker than 5000 nm"},
      {ABBE_OUT_OF_RANGE, BOX "{layers: [[silver, 1]], quarter: 100}",
       "scene.yaml:5: silver has no n and k at 100 nm"},
      {ABBE_SCHEMA, BOX "{layers: [[[1.38, -0.1], 20]]}", "k of a layer"},
      {ABBE_SCHEMA, BOX "{layers: [[0, 20]]}", "is above 0"},
      {ABBE_SCHEMA, BOX "{layers: [[1.38]]}", "a layer is [what, nm]"},
      {ABBE_SCHEMA, BOX "{layers: []}", "'layers' is empty"},
      {ABBE_SCHEMA,
       BOX
       "{layers: [[1.4, 1], [1.4, 1], [1.4, 1], [1.4, 1], [1.4, 1], [1.4, 1], [1.4, 1], [1.4, 1], "
       "[1.4, 1], [1.4, 1], [1.4, 1], [1.4, 1], [1.4, 1], [1.4, 1], [1.4, 1], [1.4, 1], [1.4, 1]]}",
       "16"},
      {ABBE_NOT_FOUND, BOX "{layers: [[MgF3, 20]]}", "MgF3"},
      {ABBE_UNSUPPORTED, BOX "{layers: [[sapphire, 20]]}", "'sapphire' is a crystal"},
      {ABBE_SCHEMA, BOX "1", "a 'coating' is {layers"},
      {ABBE_SCHEMA, BOX "{layers: [[1.38, 99.6]], side: up}", "has no key 'side'"},
      {ABBE_SCHEMA, BOX "{layers: [[1.38, 99.6]], faces: [table, rim]}",
       "has no facet 'rim'; facets are named table, crown, girdle, pavilion"},
      {ABBE_SCHEMA,
       "shape: sphere, radius: 0.1, material: n-bk7, coating: {layers: [[1.38, 99]], faces: table}",
       "a sphere has no facets"},
      {ABBE_SCHEMA,
       "shape: box, size: [0.1, 0.1, 0.1], reflectance: 1, coating: {layers: [[1, 1]]}",
       "this object has no 'material'"},
      {ABBE_SCHEMA,
       "shape: box, size: [0.1, 0.1, 0.1], mirror: silver, coating: {layers: [[1, 1]]}",
       "this object has no 'material'"},
      {ABBE_SCHEMA, FROM("AR"), "such as 'primary: 550'"},
      {ABBE_NOT_FOUND, FROM("ARR"), "has no coating 'ARR'; it has AR, THICK, LOOP"},
      {ABBE_UNSUPPORTED, FROM("LOOP"), "COATING.DAT:18: the layer of 'MGF2' begins or ends a loop"},
      {ABBE_UNSUPPORTED, FROM("TAPERED"), "taper 'RIM'"},
      {ABBE_NOT_FOUND, FROM("LOST"), "the material 'UNOBTANIUM'"},
      {ABBE_SCHEMA, FROM("AMPLIFIES"), "would make light"},
      {ABBE_SCHEMA, FROM("VAST"), "n = 1e+300"},
      {ABBE_SCHEMA, FROM("DEEP"), "is 5100 nm thick"},
      {ABBE_PARSE, FROM("BROKEN"), "a layer is a material"},
      {ABBE_PARSE, FROM("SHORT"), "last angle has 0 lines of WAVE, and its first 1"},
      {ABBE_SCHEMA, FROM("OTHER"), "all angles of a table have the same wavelengths"},
      {ABBE_SCHEMA, FROM("FALLS"), "the angle 8 does not do"},
      {ABBE_SCHEMA, FROM("LASES"), "at 500 nm 50 % is reflected and 60 % transmitted"},
      {ABBE_PARSE, FROM("SPARSE"), "WAVE has five numbers"},
      {ABBE_SCHEMA, FROM("VOID"), "not 0 of 0"},
      {ABBE_UNSUPPORTED,
       "shape: box, size: [1, 1, 1], material: sapphire, coating: {file: AR.coated}",
       "'sapphire' is a crystal: give its film as layers"},
      {ABBE_UNSUPPORTED, FROM("I"), "of the kind IDEAL"},
      {ABBE_SCHEMA, FROM("NAUGHT"), "has no layers"},
      {ABBE_UNSUPPORTED, BOX "{file: AR.ZEC, name: AR}", "is an encrypted coating"},
      {ABBE_IO, BOX "{file: none.dat, name: AR}", "none.dat"},
      {ABBE_SCHEMA, BOX "{file: COATING.DAT}", "Say its name beside the file"},
  };
  FILLED(folder, f, make_folder(&f));
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    abbe_scene scene;
    REFUSED(rows[i].code, rows[i].part, parse(&f, rows[i].rest, &scene, &error));
  }
}

/* Shares of s and p at the wavelength, from that side of that angle. */
static abbe_film_light light_of(const abbe_scene *scene, double from, double to, double degrees,
                                double nm) {
  abbe_film_layer layer[ABBE_FILM_MOST_LAYERS];
  abbe_film_light out;
  const double behind[2] = {to, 0};
  const abbe_coating *c = &scene->object[1].coatings->coating[0];
  OK(abbe_coating_at(c, nm, layer, &error));
  abbe_film_light_at(layer, c->count, from > to, from, behind, cos(degrees * ABBE_DEGREE), nm,
                     &out);
  return out;
}

static void check_light(abbe_film_light l, double s, double p, double passed_s, double passed_p) {
  assert_near(l.reflected[ABBE_FILM_S], s, 1e-12);
  assert_near(l.reflected[ABBE_FILM_P], p, 1e-12);
  assert_near(l.transmitted[ABBE_FILM_S], passed_s, 1e-12);
  assert_near(l.transmitted[ABBE_FILM_P], passed_p, 1e-12);
}

/* Linear in wavelength and in the angle's cosine, held beyond both, by the angle outside. */
TEST(tables_of_reflectance_are_read) {
  FILLED(folder, f, make_folder(&f));
  MADE(abbe_scene, scene, parse(&f, FROM("S"), &scene, &error));
  check_light(light_of(&scene, 1, 1.5, 0, 500), 0.1, 0.2, 0.9, 0.7);
  check_light(light_of(&scene, 1, 1.5, 80, 300), 0.3, 0.1, 0.7, 0.8);
  check_light(light_of(&scene, 1, 1.5, 0, 525), 0.075, 0.15, 0.925, 0.775);
  check_light(light_of(&scene, 1, 1.5, acos(0.75) / ABBE_DEGREE, 500), 0.2, 0.15, 0.8, 0.75);
  check_light(light_of(&scene, 1.5, 1, asin(sin(ABBE_PI / 3) / 1.5) / ABBE_DEGREE, 500), 0.3, 0.1,
              0.7, 0.8);
  check_light(light_of(&scene, 1.5, 1, 42, 500), 1, 1, 0, 0);
  abbe_scene_free(&scene);
  OK(parse(&f, BOX "{file: AR.coated}", &scene, &error));
  assert_contains(scene.object[1].coatings->coating[0].path, "/AR.coated");
  check_light(light_of(&scene, 1, 1.5, 0, 480), 0.319, 0.319, 0.681, 0.681);
  check_light(light_of(&scene, 1, 1.5, 50, 580), 0.114, 0.114, 0.886, 0.886);
  check_light(light_of(&scene, 1, 1.5, 70, 400), 0.16, 0.15, 0.84, 0.85);
  check_light(light_of(&scene, 1, 1.5, 0, 680), 0.136, 0.136, 0.864, 0.864);
  check_light(light_of(&scene, 1, 1.5, 90, 780), 1, 1, 0, 0);
}

TEST(damaged_tables_of_reflectance_are_refused) {
  static const char title[] = "OPTIS - Coated surface file v1.0\n\n";
  static const struct {
    abbe_result code;
    const char *text, *part;
  } rows[] = {
      {ABBE_PARSE, "x", "AR.coated:1: it begins 'x'"},
      {ABBE_PARSE, "", "it begins ''"},
      {ABBE_PARSE, "%s", "AR.coated:3: '' is no number"},
      {ABBE_PARSE, "%s1 1\n500\n0 4 96\n4,1 95,9\n", "AR.coated:6: '4,1' is no number"},
      {ABBE_PARSE, "%s1 1\n500\n0 4 96\n", "'' is no number"},
      {ABBE_PARSE, "%s1 1\n500\n0 4 96\n4 96 7\n", "goes on behind its 1 angles of 1 wave"},
      {ABBE_SCHEMA, "%s1 1\n500\n0 4 97\n4 96\n", ":5: at 500 nm 4 % is reflected and 97 %"},
      {ABBE_SCHEMA, "%s1 1\n500\n0 -4 97\n4 96\n", "both are 0 or more"},
      {ABBE_SCHEMA, "%s1 2\n500 400\n", "400 nm does not do"},
      {ABBE_SCHEMA, "%s2 1\n500\n0 4 96\n4 96\n0 4 96\n4 96", "the angle 0 does not do"},
      {ABBE_SCHEMA, "%s1 1\n500\n91 4 96\n4 96\n", "the angle 91 does not do"},
      {ABBE_SCHEMA, "%s1025 1\n", "1 to 1024 angles"},
      {ABBE_SCHEMA, "%s1 0\n", "1 to 4096 wavelengths"},
  };
  FILLED(folder, f, make_folder(&f));
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    abbe_scene scene;
    const char *text = printed(rows[i].text, title);
    OK(abbe_file_write(f.coated, text, strlen(text), &error));
    REFUSED(rows[i].code, rows[i].part, parse(&f, BOX "{file: AR.coated}", &scene, &error));
  }
}
