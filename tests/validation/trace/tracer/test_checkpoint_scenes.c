/* All that the walks read of a scene is part of its checkpoint: of two scenes that differ in one
 * thing neither goes on with the other's. */
#include "tests/validation/trace_scene.h"

#include "validation/trace/tracer/checkpoint.h"

#include <unistd.h>

static const char path[] = "checkpoint-scenes-test";

#define SEEN_BY(more) "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]" more "}\n"
#define LIT SEEN_BY("") POINT_LIGHT
#define STONE(material) LIT FLOOR BEADS(material)
#define SKY(radiance)                                                                              \
  SEEN_BY("")                                                                                      \
  "environment: {uniform: " radiance ", illuminant: E, size: 64}\n" FLOOR BEADS("n-"               \
                                                                                "bk7")
#define PLATE(surface)                                                                             \
  LIT FLOOR "- {name: plate, shape: rectangle, width: 0.1, height: 0.1, " surface                  \
            ", transform: [{translate: [0, 0, 0.3]}]}\n" BEADS("n-bk7")
#define MIST(words) LIT "medium: {" words ", box: [[-1, -1, 0], [1, 1, 1]]}\n" FLOOR BEADS("n-bk7")
#define AXES(x, z) STONE("tanzanite, axes: {x: " x ", z: " z "}")

static const char *const scenes[][2] = {
    {SEEN_BY(", aperture: 8") POINT_LIGHT FLOOR BEADS("n-bk7"),
     SEEN_BY(", aperture: 16") POINT_LIGHT FLOOR BEADS("n-bk7")},
    {SEEN_BY(", polariser: {angle: 30}") POINT_LIGHT FLOOR BEADS("n-bk7"),
     SEEN_BY(", polariser: {angle: 31}") POINT_LIGHT FLOOR BEADS("n-bk7")},
    {SKY("2"), SKY("3")},
    {MIST("scattering: 0.5"), MIST("scattering: 0.6")},
    {MIST("scattering: 0.5"), MIST("scattering: 0.5, absorption: 0.1")},
    {MIST("scattering: 0.5"), MIST("scattering: 0.5, g: 0.1")},
    {STONE("n-bk7, medium: {scattering: 5}"), STONE("n-bk7, medium: {scattering: 6}")},
    {STONE("n-bk7"), STONE("n-bk7, coating: {layers: [[1.38, 99.6]]}")},
    {STONE("n-bk7, roughness: 0.3"), STONE("n-bk7, roughness: 0.4")},
    {STONE("ruby"), STONE("sapphire")},
    {STONE("calcite, axis: [1, 0, 0]"), STONE("calcite, axis: [0, 1, 0]")},
    {STONE("tourmaline-green, axis: [1, 0, 0]"), STONE("tourmaline-blue, axis: [1, 0, 0]")},
    {AXES("[0, 0, 1]", "[1, 1, 0]"), AXES("[1, 1, 0]", "[0, 0, 1]")},
    {PLATE("mirror: 0.8"), PLATE("mirror: 0.7")},
    {PLATE("mirror: 0.8"), PLATE("mirror: 0.8, roughness: 0.2")},
    {PLATE("mirror: 0.8, roughness: 0.3"), PLATE("mirror: 0.8, roughness: 0.2")},
    {PLATE("mirror: gold"), PLATE("mirror: silver")},
    {PLATE("reflectance: 0.5"), PLATE("reflectance: 0.6")},
};

TEST(of_two_scenes_neither_is_the_other) {
  static const abbe_trace_desc desc = {
      .width = 4, .height = 3, .no_map = true, .photons = 500, .threads = 1};
  for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
    for (int saved = 0; saved < 2; saved++) {
      OWNED(abbe_scene, one) = scene_of(scenes[i][saved]);
      OWNED(abbe_scene, two) = scene_of(scenes[i][!saved]);
      HELD(abbe_tracer, tracer) = make_tracer(&one, &desc);
      HELD(abbe_tracer, other) = make_tracer(&two, &desc);
      OK(abbe_checkpoint_save(tracer, path, &error));
      REFUSED(ABBE_INVALID_ARGUMENT, "another scene", abbe_checkpoint_load(other, path, &error));
      OK(abbe_checkpoint_load(tracer, path, &error));
    }
  unlink(path);
}

/* What a picture shows of the background is asked for by the scene. */
TEST(a_background_that_is_transparent_is_told) {
  static const abbe_trace_desc desc = {
      .width = 4, .height = 3, .no_map = true, .photons = 500, .threads = 1};
  OWNED(abbe_scene, scene) = scene_of(STONE("n-bk7"));
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &desc);
  OK(abbe_checkpoint_save(tracer, path, &error));
  scene.transparent = true;
  HELD(abbe_tracer, other) = make_tracer(&scene, &desc);
  REFUSED(ABBE_INVALID_ARGUMENT, "another scene", abbe_checkpoint_load(other, path, &error));
  OK(abbe_checkpoint_save(other, path, &error));
  OK(abbe_checkpoint_load(other, path, &error));
  unlink(path);
}

TEST(a_checkpoint_is_known_by_its_head) {
  static const struct {
    const char *text;
    bool is;
  } files[] = {{"", false},
               {"abbe checkpoint", false},
               {"abbe checkpoint ", true},
               {"abbe checkpoint 1\n", true},
               {"description: a scene of glass\n", false}};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    OK(abbe_file_write(path, files[i].text, strlen(files[i].text), &error));
    assert_int_equal(abbe_checkpoint_is(path), files[i].is);
  }
  unlink(path);
  assert_false(abbe_checkpoint_is(path));
  assert_false(abbe_checkpoint_is(NULL));
}
