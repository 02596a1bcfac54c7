/* What each field of a scene and of a request is part of: edited alone, it differs in those parts
 * of a renderer, and in no other. */
#include "tests/scenes/scene_text.h"

#include "gl/renderer_state.h"
#include "gl/scene/spectra/camera_bands.h"

enum {
  GEOMETRY = 1 << ABBE_PART_GEOMETRY,
  SURFACES = 1 << ABBE_PART_SURFACES,
  SPECTRA = 1 << ABBE_PART_SPECTRA,
  SHADOWS = 1 << ABBE_PART_SHADOWS,
  LIGHT = 1 << ABBE_PART_LIGHT,
  EYE = 1 << ABBE_PART_EYE,
  POWERS = 1 << ABBE_PART_POWERS,
  WAY = LIGHT | EYE, /* light's, and what stands on it */
  PLACE = SHADOWS | WAY,
  SHAPE = GEOMETRY | PLACE
};

/* A point light, a spot and a sun; a floor with places for a texture, a ball and a brick. */
static const char text[] = CAMERA
    "lights:\n"
    "- {name: lamp, kind: point, position: [0.05, 0.03, 0.6], intensity: 1}\n"
    "- {name: spot, kind: spot, position: [-0.4, 0, 0.7], target: [0, 0, 0.2], intensity: 2, cone: "
    "40, soft: 5}\n"
    "- {name: sun, kind: directional, direction: [0.1, 0.2, -1], irradiance: 1}\n" FLOOR BALL(
        "murk") BRICK("crown");

static float texel[2][3] = {{0.5f, 0.25f, 0.75f}, {1, 0.5f, 0.25f}};

typedef struct edited {
  abbe_scene scene;
  abbe_render_desc desc;
} edited;

static abbe_object *floor_of(edited *e) {
  return &e->scene.object[0];
}

static abbe_object *ball_of(edited *e) {
  return &e->scene.object[1];
}

static abbe_object *brick_of(edited *e) {
  return &e->scene.object[2];
}

static abbe_material *glass_of(edited *e) {
  return (abbe_material *)ball_of(e)->material;
}

static void give_texture(edited *e) {
  abbe_image *t = &floor_of(e)->texture;
  t->width = 2;
  t->height = 1;
  t->channels = 3;
  t->data = &texel[0][0];
}

/* X(what, edit, parts): of e, from then on. */
#define EDITS(X)                                                                                   \
  X("nothing", (void)e, 0)                                                                         \
  X("the eye", e->scene.camera.eye[0] += 0.1, EYE)                                                 \
  X("its target", e->scene.camera.target[1] += 0.01, EYE)                                          \
  X("its up", e->scene.camera.up[0] += 0.1, EYE)                                                   \
  X("its angle", e->scene.camera.fov_y_rad *= 0.9, EYE)                                            \
  X("a size that is not asked for", e->scene.camera.width += 8, 0)                                 \
  X("ambient light", e->scene.ambient += 0.1, POWERS)                                              \
  X("the background", e->scene.background += 0.1, POWERS)                                          \
  X("a light's name", e->scene.light[0].name[0] = 'd', 0)                                          \
  X("a light's power", e->scene.light[1].power *= 2, POWERS)                                       \
  X("a light's illuminant", e->scene.light[2].illuminant.kind = ABBE_ILLUMINANT_A,                 \
    SPECTRA | WAY | SURFACES)                                                                      \
  X("a lamp's place", e->scene.light[0].position[0] += 0.01, PLACE)                                \
  X("a spot's place", e->scene.light[1].position[0] += 0.01, PLACE)                                \
  X("a spot's direction", e->scene.light[1].direction[0] += 0.01, WAY)                             \
  X("a spot's cone", e->scene.light[1].cone_rad *= 0.99, WAY)                                      \
  X("a spot's soft edge", e->scene.light[1].soft_rad *= 0.5, WAY)                                  \
  X("the sun's direction", e->scene.light[2].direction[0] += 0.01, PLACE)                          \
  X("an object's name", floor_of(e)->name[0] = 'd', 0)                                             \
  X("the first coloured receiver", floor_of(e)->reflectance[1] = 0.25, SURFACES | EYE)             \
  X("a reflectance", floor_of(e)->reflectance[1] = 0.2, SURFACES)                                  \
  X("a texture's repeat", floor_of(e)->texture_repeat[0] = 2, SURFACES)                            \
  X("the first texture", give_texture(e), SURFACES | EYE)                                          \
  X("a texture's colour", texel[0][0] = 0.125f, SURFACES)                                          \
  X("a corner's place", ball_of(e)->mesh.position[0][0] += 1e-4, SHAPE)                            \
  X("a corner's normal", ball_of(e)->mesh.normal[0][0] += 1e-4, SHAPE)                             \
  X("a corner's uv", floor_of(e)->mesh.uv[0][0] += 0.1, SHAPE)                                     \
  X("a face", ball_of(e)->mesh.face[0][0] ^= 1, SHAPE)                                             \
  X("a sphere's centre", ball_of(e)->exact.centre[0] += 1e-4, SHAPE)                               \
  X("a sphere's radius", ball_of(e)->exact.radius *= 0.999, SHAPE)                                 \
  X("a solid's plane", brick_of(e)->exact.plane[0][3] *= 0.999, SHAPE)                             \
  X("a rectangle's edge", floor_of(e)->exact.parallelogram[0][3] *= 0.999, SHAPE)                  \
  X("a receiver's bounds", floor_of(e)->max[0] += 1e-4, SHAPE)                                     \
  X("a refractor's bounds", ball_of(e)->max[0] += 1e-4, SHAPE | SPECTRA)                           \
  X("which glass", brick_of(e)->material = ball_of(e)->material, SHAPE | SPECTRA)                  \
  X("a glass's name", glass_of(e)->name[0] = 'd', 0)                                               \
  X("its coefficient", glass_of(e)->dispersion.c[0] += 0.01, SPECTRA | WAY)                        \
  X("the range of its index", glass_of(e)->min_nm += 1, SPECTRA | WAY)                             \
  X("what its source prints", glass_of(e)->published_n_d += 0.1, 0)                                \
  X("the picture's width", e->desc.width = 40, EYE)                                                \
  X("the picture's height", e->desc.height = 40, EYE)                                              \
  X("samples", e->desc.supersample = 3, EYE)                                                       \
  X("adaptive", e->desc.adaptive = 2, EYE)                                                         \
  X("the lens", (e->scene.camera.aperture = 0.01, e->scene.camera.focus = 1), EYE)                 \
  X("their shift", e->desc.sample_shift[1] = 0.25, EYE)                                            \
  X("aovs", e->desc.aovs = true, EYE)                                                              \
  X("the space", e->desc.space = ABBE_RGB_SPACE_REC709, SURFACES | POWERS)                         \
  X("wavelengths", e->desc.wavelengths = 9, SPECTRA | WAY)                                         \
  X("the range from", e->desc.min_nm = 400, SPECTRA | WAY | SURFACES)                              \
  X("the range to", e->desc.max_nm = 700, SPECTRA | WAY | SURFACES)                                \
  X("photons", e->desc.photons = 48, WAY)                                                          \
  X("their shift", e->desc.photon_shift[0] = 0.25, WAY)                                            \
  X("the map", e->desc.map_size = 96, WAY)                                                         \
  X("the fill", e->desc.fill = ABBE_FILL_NONE, SPECTRA | WAY)                                      \
  X("the share", e->desc.energy_share = 0.03, WAY)                                                 \
  X("exits", e->desc.exits = 3, WAY)                                                               \
  X("whose map is given, where none is", e->desc.map_layout_light = 1, 0)                          \
  X("who watches", e->desc.progress_user = e, 0)

static const struct {
  const char *what;
  unsigned parts;
} rows[] = {
#define ROW(what, edit, parts) {what, parts},
    EDITS(ROW)
#undef ROW
};

/* Edits row `i`. */
static void edit(edited *e, size_t i) {
  size_t row = 0;
#define DO(what, edit, parts)                                                                      \
  if (row++ == i) edit;
  EDITS(DO)
#undef DO
}

static void inputs_of(const edited *e, abbe_renderer_inputs *out) {
  MADE(abbe_plan, plan, abbe_plan_make(&e->scene, &e->desc, &plan, &error));
  abbe_renderer_inputs_of(&e->scene, &plan, out);
}

static void print_parts(const char *which, unsigned parts) {
  static const char *const names[] = {"geometry", "surfaces", "spectra", "shadows",
                                      "light",    "eye",      "powers"};
  print_error(" %s", which);
  for (unsigned k = 0; k < ABBE_PART_COUNT; k++)
    if (parts >> k & 1) print_error(" %s", names[k]);
}

/* Edits stay: what comes after one is told from it. */
TEST(each_field_is_of_its_parts) {
  edited e = {.desc = {.width = 32, .height = 32, .photons = 32, .map_size = 64}};
  abbe_renderer_inputs before, after;
  int wrong = 0;
  e.scene = scene_of(text);
  inputs_of(&e, &before);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    edit(&e, i);
    inputs_of(&e, &after);
    const unsigned parts = abbe_renderer_inputs_differ(&before, &after);
    before = after;
    if (parts == rows[i].parts) continue;
    wrong++;
    print_error("%s:", rows[i].what);
    print_parts("differs in", parts);
    print_parts("and should in", rows[i].parts);
    print_error("\n");
  }
  assert_int_equal(wrong, 0);
  memset(&floor_of(&e)->texture, 0, sizeof floor_of(&e)->texture);
  abbe_scene_free(&e.scene);
}

TEST(absorption_along_each_axis_is_of_the_spectra) {
  edited e = {.desc = {.width = 32, .height = 32, .photons = 32, .map_size = 64}};
  abbe_renderer_inputs before, after;
  e.scene = scene_of("camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR BALL(
      "tourmaline-green"));
  inputs_of(&e, &before);
  abbe_material *crystal = glass_of(&e);
  abbe_spectrum *z = crystal->attenuation_yz[1], *other = NULL;
  const size_t count = abbe_spectrum_count(z);
  FREED double *value = calloc(count, sizeof *value);
  for (size_t i = 0; i < count; i++) value[i] = 1.001 * abbe_spectrum_value(z)[i];
  OK(abbe_spectrum_make(abbe_spectrum_lambda_nm(z), value, count, abbe_spectrum_interpolation(z),
                        &other, &error));
  crystal->attenuation_yz[1] = other;
  inputs_of(&e, &after);
  assert_int_equal(abbe_renderer_inputs_differ(&before, &after), SPECTRA | WAY);
  crystal->attenuation_yz[1] = z;
  abbe_spectrum_free(other);
  e.scene.object[1].axis[0] = 0.6;
  e.scene.object[1].axis[2] = 0.8;
  inputs_of(&e, &after);
  assert_int_equal(abbe_renderer_inputs_differ(&before, &after), SPECTRA | WAY);
  abbe_scene_free(&e.scene);
}

/* Where two crystals touch there is a face once their axes differ, however they are turned. */
TEST(a_crystal_turned_against_another_is_of_the_shape) {
  edited e = {.desc = {.width = 32, .height = 32, .photons = 32, .map_size = 64}};
  abbe_renderer_inputs before, after;
  e.scene = scene_of("camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR BALL(
      "calcite") BRICK("calcite"));
  inputs_of(&e, &before);
  const double turned[3] = {0.6, 0, 0.8};
  for (int i = 0; i < 2; i++) {
    memcpy(e.scene.object[1 + i].axis, turned, sizeof turned);
    inputs_of(&e, &after);
    assert_int_equal(abbe_renderer_inputs_differ(&before, &after),
                     i == 0 ? SHAPE | SPECTRA : SPECTRA | WAY);
  }
  abbe_scene_free(&e.scene);
}

/* Two wavelengths by request are even, and by themselves they are sodium's lines. */
TEST(lines_of_lights_are_of_the_spectra) {
  edited e = {.desc = {.width = 32, .height = 32, .photons = 32, .map_size = 64}};
  abbe_renderer_inputs even, lines;
  e.scene = scene_of(CAMERA "lights: [{name: lamp, kind: point, position: [0, 0, 0.6], intensity: "
                            "1, illuminant: sodium}]\n" FLOOR BALL("crown"));
  inputs_of(&e, &lines);
  e.desc.wavelengths = 2;
  inputs_of(&e, &even);
  assert_int_equal(abbe_renderer_inputs_differ(&even, &lines), SPECTRA | WAY);
  abbe_scene_free(&e.scene);
}

/* A light between two stones has a cube of views, and is one light to what glows by a matrix. */
TEST(light_of_several_views_excites_once) {
  enum { ROWS = 2 };
  const double by_nm[ROWS] = {410, 450}, nm[2] = {500, 600}, photons[2] = {0.002, 0.002};
  edited e = {.desc = {.width = 32, .height = 32, .photons = 32, .map_size = 64}};
  double weight[2][ROWS];
  e.scene = scene_of(CAMERA "lights: [{name: lamp, kind: point, position: [0.115, 0, 0.2], "
                            "intensity: 1}]\n" FLOOR BALL("murk") BRICK("crown"));
  for (int i = 0; i < ROWS; i++) {
    abbe_spectrum *row = NULL;
    OK(abbe_spectrum_make(nm, photons, 2, ABBE_INTERPOLATION_LINEAR, &row, &error));
    OK(abbe_fluorescence_add_row(&glass_of(&e)->fluorescence, by_nm[i], row, &error));
  }
  OK(abbe_fluorescence_sum_rows(&glass_of(&e)->fluorescence, &error));
  MADE(abbe_plan, plan, abbe_plan_make(&e.scene, &e.desc, &plan, &error));
  assert_true(plan.light_view_count > e.scene.light_count);
  for (int i = 0; i < 2; i++) {
    abbe_glow_rows_weigh(&e.scene, &plan, ball_of(&e), weight[i]);
    plan.light_view_count = e.scene.light_count;
  }
  for (int i = 0; i < ROWS; i++) assert_near(weight[0][i], weight[1][i], 0);
  assert_true(weight[0][0] > 0 && weight[0][1] > 0);
  abbe_scene_free(&e.scene);
}
