/* What the program says to what it cannot use: the exit code, a sentence that names the thing, and
 * nothing left behind. */
#include "tests/cli/run_program.h"

#define BAD "\"$abbe\" render \"$house\"/tests/bad/"
#define TO " -o picture.exr --png picture.png"
#define SMALL " --size 32x32 --photons 32 --map 64"
#define GEM "\"$abbe\" render \"$house\"/scenes/gem.yaml" SMALL

typedef struct refusal {
  const char *line, *part;
} refusal;

static void refuse_all(const refusal *rows, size_t count, int code) {
  size_t wrong = 0;
  for (size_t i = 0; i < count; i++) wrong += !run_refuses(rows[i].line, code, rows[i].part);
  assert_int_equal(wrong, 0);
}

GROUP(run_setup, run_teardown);

TEST(scenes_that_cannot_be_used) {
  static const refusal rows[] = {
      {"\"$abbe\" render missing.yaml" TO, "missing.yaml: cannot be opened: No such file"},
      {"\"$abbe\" render \"$house\"/scenes" TO, "is a directory"},
      {"printf '\\000\\377' >scene.yaml; \"$abbe\" render scene.yaml" TO
       "; code=$?;rm scene.yaml; exit $code",
       "scene.yaml"},
      {BAD "scene_malformed.yaml" TO, "scene_malformed.yaml:21: is not well-formed YAML"},
      {BAD "scene_unknown_key.yaml" TO, ":5: a scene has no key 'lihgts'; did you mean 'lights'?"},
      {BAD "scene_unknown_material.yaml" TO, "no material 'nbk7'; did you mean 'n-bk7'?"},
      {BAD "scene_unknown_shape.yaml" TO, "scene_unknown_shape.yaml:"},
      {BAD "scene_axis_of_glass.yaml" TO,
       ":20: 'axis' is the optic axis of a uniaxial crystal; the material 'n-bk7' has one index"},
      {BAD "scene_axis_of_nothing.yaml" TO, ":20: 'axis' is zero; it must point somewhere"},
      {BAD "scene_axis_of_a_floor.yaml" TO, ":14: 'axis' is the optic axis of a crystal that"},
      {BAD "scene_nan_radius.yaml" TO, ":16: 'radius: .nan' is not a finite number"},
      {BAD "scene_nan_position.yaml" TO, "is not a finite number"},
      {BAD "scene_infinite_width.yaml" TO, "'width: 1e999' is not a finite number"},
      {BAD "scene_zero_radius.yaml" TO, "radius 0 is not possible"},
      {BAD "scene_zero_size.yaml" TO, "'size: 0' is not in the range"},
      {BAD "scene_huge_size.yaml" TO, "'size: 1e6' is not in the range"},
      {BAD "scene_open_mesh.yaml" TO, "5 open edges"},
      {BAD "scene_missing_mesh.yaml" TO, "scene_missing_mesh.yaml:"},
      {BAD "scene_light_inside.yaml" TO, "is inside the refractor 'ball'"},
      {BAD "scene_light_on_a_box.yaml" TO, "is on the surface of the refractor 'ball'"},
      {BAD "scene_camera_inside.yaml" TO, "the camera's eye is inside the refractor 'ball'"},
      {BAD "scene_no_receiver.yaml" TO, "the scene has no receiver"},
      {BAD "scene_nothing_in_view.yaml" TO, "no receiver is in the camera's view"},
      {BAD "scene_no_light.yaml" TO, "the scene has no light"},
      {"\"$abbe\" plan missing.yaml", "missing.yaml: cannot be opened"},
      {"\"$abbe\" plan \"$house\"/tests/bad/scene_zero_scale.yaml", "'scale' must not be zero"},
  };
  refuse_all(rows, sizeof rows / sizeof *rows, 1);
}

/* A reader that opens it as any other file waits until somebody writes there: for ever. */
#define FIFO "mkfifo fifo; "
#define AFTER "; code=$?; rm -f fifo fifo.obj scene.yaml box.obj box.gltf; exit $code"
#define SCENE(lamp, floor, thing)                                                                  \
  FIFO "echo 'camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"                                 \
       "lights: [{kind: point, position: [0, 0, 1], intensity: 1" lamp "}]\n"                      \
       "objects: [{shape: rectangle, width: 2, height: 2, " floor "}" thing "]' >scene.yaml;"      \
       "\"$abbe\" plan scene.yaml" AFTER

TEST(pipes_are_not_waited_for) {
  static const refusal rows[] = {
      {FIFO "\"$abbe\" render fifo -o picture.exr" AFTER, "fifo: is a named pipe"},
      {FIFO "\"$abbe\" info fifo" AFTER, "fifo: is a named pipe"},
      {FIFO "\"$abbe\" display fifo -o picture.png" AFTER, "fifo: is a named pipe"},
      {FIFO "\"$abbe\" weights --illuminant ./fifo" AFTER, "fifo: is a named pipe"},
      {FIFO "\"$abbe\" materials import fifo -o table.yaml" AFTER, "fifo: is a named pipe"},
      {FIFO "\"$abbe\" materials list --table fifo" AFTER, "fifo: is a named pipe"},
      {FIFO "\"$abbe\" materials add --record fifo --table new.yaml --create" AFTER,
       "fifo: is a named pipe"},
      {FIFO GEM " --ocio fifo" TO AFTER, "fifo: is a named pipe"},
      {FIFO GEM " --materials fifo" TO AFTER, "fifo: is a named pipe"},
      {SCENE(", illuminant: ./fifo", "reflectance: 1", ""), "fifo: is a named pipe"},
      {SCENE("", "texture: fifo", ""), "fifo: is a named pipe"},
      {"mkfifo fifo.obj;" SCENE("", "reflectance: 1", ", {mesh: fifo.obj, material: f2}"),
       "fifo.obj: is a named pipe"},
      {"echo "
       "'{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{"
       "\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
       "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
       "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":"
       "\"fifo\"}]}' >box.gltf;" SCENE("", "reflectance: 1", ", {mesh: box.gltf, material: f2}"),
       "fifo: is a named pipe"},
  };
  refuse_all(rows, sizeof rows / sizeof *rows, 1);
  static const refusal comparison[] = {
      {FIFO "\"$abbe\" compare fifo fifo" AFTER, "fifo: is a named pipe"}};
  refuse_all(comparison, 1, 1);
  /* what an OBJ says of its colours is not needed */
  run_clears(
      "printf 'mtllib fifo\nv 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf "
      "2 3 4\n' >box.obj;" SCENE("", "reflectance: 1", ", {mesh: box.obj, material: f2}"));
}

#define AROUND(picture)                                                                            \
  "printf '" picture "' >around.hdr; echo 'camera: {eye: [0, -1, 0.5], target: [0, 0, 0]}\n"       \
  "environment: {file: around.hdr}\n"                                                              \
  "objects: [{shape: rectangle, width: 2, height: 2, reflectance: 1}]' >scene.yaml; \"$abbe\" "    \
  "render scene.yaml" TO "; code=$?; rm -f around.hdr scene.yaml; exit $code"
#define RADIANCE "#?RADIANCE\\nFORMAT=32-bit_rle_rgbe\\n\\n"
#define BLACK "\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0"

TEST(pictures_that_are_no_surroundings) {
  static const refusal rows[] = {
      {AROUND(""), "around.hdr"},
      {AROUND(RADIANCE), "scene.yaml:2: around.hdr: it cannot be read as a Radiance picture"},
      {AROUND(RADIANCE "-Y 2 +X 4\\nabcd"), "cut off (line 1 of 2)"},
      {AROUND(RADIANCE "-Y 2 +X 2\\n" BLACK), "2 x 2 pixels"},
      {AROUND(RADIANCE "-Y 2 +X 4\\n" BLACK BLACK), "black"},
      {AROUND(RADIANCE "-Y 99999 +X 3\\n"), "around.hdr"},
      {AROUND("\\211PNG"), "around.hdr"},
  };
  refuse_all(rows, sizeof rows / sizeof *rows, 1);
}

TEST(requests_that_cannot_be_met) {
  static const refusal rows[] = {
      {GEM " --materials missing.yaml" TO, "missing.yaml: cannot be opened"},
      {GEM " --ocio missing.ocio" TO, "missing.ocio"},
      {GEM " --view Nope" TO, "no view 'Nope'"},
      {GEM " --display Nope" TO, "'Nope'"},
      {"printf 'ocio_profile_version: 2\\nnonsense' >bad.ocio;" GEM " --ocio bad.ocio" TO
       "; code=$?; rm bad.ocio; exit $code",
       "bad.ocio"},
      {GEM " --range 100:200" TO, "has no index at 100 nm"},
      {"\"$abbe\" render \"$house\"/scenes/metals.yaml --range 100:780" TO,
       "gold has no n and k at 100 nm"},
  };
  refuse_all(rows, sizeof rows / sizeof *rows, 1);
}

TEST(targets_that_cannot_be_written) {
  static const refusal rows[] = {
      {GEM " -o missing/picture.exr", "missing/picture.exr: cannot be written"},
      {GEM " --png missing/picture.png", "missing/picture.png: cannot be written"},
      {GEM " --stats missing/stats.json", "missing/stats.json: cannot be written"},
      {GEM " --save-map missing/map.exr", "missing/map.exr: cannot be written"},
      {GEM " -o picture.exr --png missing/picture.png", "missing/picture.png: cannot be written"},
      {GEM " -o .", "is a directory"},
      {GEM " -o /dev/full", "is not a regular file"},
      {GEM " --json >/dev/full", "could not be written to the output"},
      {"\"$abbe\" plan \"$house\"/scenes/gem.yaml >/dev/full",
       "could not be written to the output"},
  };
  refuse_all(rows, sizeof rows / sizeof *rows, 1);
}

/* A limit on a file's size stands for a disk that is full; the signal that comes with it must not
 * end the program. Each picture is larger than the limit of some kilobytes. */
TEST(a_full_disk) {
  static const refusal rows[] = {
      {"ulimit -f 4; " GEM " --size 64x64 -o picture.exr", "picture.exr"},
      {"ulimit -f 4; " GEM " --size 96x96 --png picture.png", "picture.png"},
      {"ulimit -f 4; " GEM " --map 64 --save-map map.exr", "map.exr"},
  };
  refuse_all(rows, sizeof rows / sizeof *rows, 1);
  /* What stood there before is as it was. */
  run_must("printf before >picture.exr; (ulimit -f 4; " GEM
           " --size 64x64 -o picture.exr); echo $?; cat picture.exr;rm picture.exr");
  assert_string_equal(run_output, "1\nbefore");
  assert_int_equal(run_left(), 0);
}

TEST(wrong_use) {
  static const refusal rows[] = {
      {GEM " -o gem.tiff", "-o writes a .exr file, and 'gem.tiff' ends like another kind; name it "
                           "'gem.exr', or take --png"},
      {GEM " --png gem.TIF", "name it 'gem.png'"},
      {GEM " --save-map map.png", "name it 'map.exr'"},
      {GEM " --stats gem.csv", "name it 'gem.json'"},
      {"\"$abbe\" trace gem.yaml -o gem.tiff", "name it 'gem.exr'"},
      {GEM " --fill smear" TO, "'smear' does not go with the profile 'default'"},
      {GEM " --profile thesis --wavelengths 65" TO, "wavelengths is 65"},
      {"\"$abbe\"", "usage: abbe COMMAND"},
      {"\"$abbe\" rendr", "no command 'rendr'; did you mean 'render'?"},
      {"\"$abbe\" help rendr", "no command 'rendr'"},
      {"\"$abbe\" render", "which scene?"},
      {"\"$abbe\" plan", "which scene?"},
      {GEM, "where to?"},
      {GEM " other.yaml" TO, "one scene at a time"},
      {GEM " --nonsense" TO, "'--nonsense'"},
      {GEM " -o", "requires an argument"},
      {GEM " --wavelengths 0" TO, "--wavelengths '0' is not a whole number from 1 to 1000"},
      {GEM " --wavelengths -1" TO, "--wavelengths '-1'"},
      {GEM " --wavelengths seven" TO, "--wavelengths 'seven'"},
      {GEM " --photons 5000" TO, "--photons '5000' is not a whole number from 1 to 4096"},
      {GEM " --photons 1e3" TO, "--photons '1e3'"},
      {GEM " --map 99999999999999999999" TO, "--map"},
      {GEM " --samples 5" TO, "--samples '5'"},
      {GEM " --exits 33" TO, "--exits '33'"},
      {GEM " --frames 0" TO, "--frames '0'"},
      {GEM " --size 0x0" TO, "--size '0x0'"},
      {GEM " --size 512" TO, "--size '512'"},
      {GEM " --size 9000x10" TO, "--size '9000x10'"},
      {GEM " --range 700:400" TO, "--range '700:400'"},
      {GEM " --range 400" TO, "--range '400'"},
      {GEM " --range nan:700" TO, "--range 'nan:700'"},
      {GEM " --share 0" TO, "--share '0'"},
      {GEM " --exposure nan" TO, "--exposure 'nan'"},
      {GEM " --bits 11" TO, "--bits '11' is not known"},
      {GEM " --bits 12" TO, "a file of kind PNG has 8 or 16 bits, not 12"},
      {GEM " -o picture.exr --ocio studio.ocio",
       "--ocio is for the picture for a display: give --png FILE.png too"},
      {GEM " -o picture.exr --display sRGB", "--display is for the picture"},
      {GEM " -o picture.exr --view Plain", "--view is for the picture"},
      {GEM " -o picture.exr --exposure 1", "--exposure is for the picture"},
      {GEM " -o picture.exr --bits 16", "--bits is for the picture"},
      {"\"$abbe\" trace \"$house\"/scenes/gem.yaml -o picture.exr --view Plain",
       "--view is for the picture"},
      {"\"$abbe\" trace \"$house\"/scenes/gem.yaml -o picture.exr --exposure 1",
       "--exposure is for the picture"},
      {GEM " --profile tesis" TO, "did you mean 'thesis'?"},
      {GEM " --fill smea" TO, "did you mean 'smear'?"},
      {GEM " --space srgb" TO, "acescg, rec709, xyz"},
      {GEM " --backend vulkan" TO, "auto, cpu, gpu"},
  };
  refuse_all(rows, sizeof rows / sizeof *rows, 2);
}

/* Mended, not refused; but it is said. */
TEST(an_inside_out_mesh_is_turned_and_told) {
  static const char line[] =
      "cat >scene.yaml <<END\n"
      "camera: {eye: [0, -1, 0.5], target: [0, 0, 0]}\n"
      "lights: [{kind: point, position: [0.3, 0, 1], intensity: 3}]\n"
      "objects:\n"
      "- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5}\n"
      "- {name: wedge, mesh: $house/tests/bad/inverted.obj, smooth: false, material: n-bk7,\n"
      "   transform: [{translate: [0, 0, 0.2]}]}\n"
      "END\n"
      "\"$abbe\" render scene.yaml" SMALL TO " && \"$abbe\" plan scene.yaml >plan.txt\n";
  run_must(line);
  const char *first = strstr(run_errors, "note: object 'wedge': ");
  assert_non_null(first);
  assert_non_null(strstr(first + 1, "note: object 'wedge': ")); /* both commands */
}
