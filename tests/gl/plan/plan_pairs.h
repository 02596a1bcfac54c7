/* plan_pairs.h: pairs of scenes that differ in one fact, and what that changes of the plan. */
#ifndef ABBE_TESTS_GL_PLAN_PLAN_PAIRS_H
#define ABBE_TESTS_GL_PLAN_PLAN_PAIRS_H

#include "tests/gl/plan/plan_rows.h"

#define EYE_ASIDE "materials: glass.yaml\ncamera: {eye: [0, -1, 0.5], target: [-0.6, 0, 0.05]}\n"
#define SPOT(target)                                                                               \
  "lights:\n- {name: lamp, kind: spot, position: [0.05, 0.03, 0.6], target: " target               \
  ", cone: 10, intensity: 1}\n"
#define LIGHT_ASIDE_OF(illuminant)                                                                 \
  "- {name: second, kind: point, position: [-0.1, 0.03, 0.6], intensity: 1, "                      \
  "illuminant: " illuminant "}\n"
#define LIGHT_ASIDE LIGHT_ASIDE_OF("D65")
#define CARD                                                                                       \
  "- {name: card, shape: rectangle, width: 0.1, height: 0.1, transform: [{translate: [-0.4, 0, "   \
  "0.3]}], reflectance: 0.5}\n"
#define CEILING                                                                                    \
  "- {name: ceiling, shape: rectangle, width: 2, height: 2, transform: [{rotate: {axis: [1, 0, "   \
  "0], angle: 180}}, {translate: [0, 0, 0.7]}], reflectance: 0.5}\n"
#define PEBBLE "- {name: pebble, shape: sphere, radius: 0.05, reflectance: 0.5}\n"
#define ROOM "- {name: room, shape: box, size: [3, 3, 3], reflectance: 0.5}\n"
#define DOME                                                                                       \
  "- {name: dome, shape: sphere, radius: 0.05, transform: [{translate: [0.5, 0, 0.8]}], "          \
  "reflectance: 0.5}\n"
#define WOOD                                                                                       \
  "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5, "            \
  "texture: " ABBE_SOURCE_DIR "/scenes/wood.png}\n"
#define CUBE(material)                                                                             \
  "- {name: ball, shape: box, size: [0.1, 0.1, 0.1], transform: [{translate: [0, 0, 0.2]}], "      \
  "material: " material "}\n"
#define STONE(material)                                                                            \
  "- {name: ball, shape: gem, sides: 6, girdle: 0.08, table: 0.05, crown: 0.024, pavilion: 0.04, " \
  "transform: [{rotate: {axis: [1, 0, 0], angle: 5}}, {translate: [0, 0, 0.2]}], "                 \
  "material: " material "}\n"
#define EGG(material)                                                                              \
  "- {name: ball, shape: sphere, radius: 0.08, levels: 4, transform: [{scale: [1, 1, 1.2]}, "      \
  "{translate: [0, 0, 0.2]}], material: " material "}\n"
#define TORUS(material)                                                                            \
  "- {name: ball, shape: ring, major: 0.08, minor: 0.02, transform: [{translate: [0, 0, 0.2]}], "  \
  "material: " material "}\n"
#define YOLK(material)                                                                             \
  "- {name: yolk, shape: sphere, radius: 0.04, levels: 3, transform: [{translate: [0, 0, 0.2]}], " \
  "material: " material "}\n"
#define SUNK(material)                                                                             \
  "- {name: ball, shape: sphere, radius: 0.08, levels: 4, transform: [{translate: [0, 0, 0.05]}]," \
  " material: " material "}\n"

#define OPTICAL_DEPTHS RUNS(CHOICE_ABSORPTION, "paths keep how much they pass of what tints")

/* What each has in common, and differs from in one fact. */
static const char ball[] = CAMERA POINT_LIGHT FLOOR BALL("crown");
static const char flat[] = CAMERA POINT_LIGHT FLOOR BALL("flat");
static const char cube[] = CAMERA POINT_LIGHT FLOOR CUBE("crown");
static const char stone[] = CAMERA POINT_LIGHT FLOOR STONE("dense");
static const char egg[] = CAMERA POINT_LIGHT FLOOR EGG("crown");

#define BALL_BESIDE                                                                                \
  "- {name: other, shape: sphere, radius: 0.08, levels: 4, transform: [{translate: [0.5, 0, "      \
  "0.2]}], material: crown}\n"
#define LAMP_BETWEEN                                                                               \
  "lights:\n- {name: lamp, kind: point, position: [0.25, 0, 0.2], intensity: 1}\n"
#define MIRROR                                                                                     \
  "- {name: glass, shape: rectangle, width: 0.2, height: 0.2, mirror: 0.9, transform: [{rotate: "  \
  "{axis: [0, 1, 0], angle: 90}}, {translate: [0.5, 0, 0.2]}]}\n"
static const char two_balls[] = CAMERA POINT_LIGHT FLOOR BALL("crown") BALL_BESIDE;

/* The plan of a scene and a request, against another scene's with none. */
typedef struct pair {
  const char *fact, *from, *to;
  abbe_render_desc desc; /* of the second */
  row row[40];
} pair;

/* The plan of one ball on a floor. */
#define BALL_ROWS(tiles, colours)                                                                  \
  COUNTS(7, 8, 9),                                                                                 \
      RUNS_OF(CHOICE_REFRACTOR_MODEL, "ball", "exact sphere: the object is a sphere"),             \
      RESTS(CHOICE_MULTI_REFRACTOR_PATHS, "light that leaves the refractor cannot meet it again"), \
      RUNS(CHOICE_RECEIVER_MODEL, "exact parallelograms: every receiver is a rectangle or a box"), \
      RESTS(CHOICE_RECEIVER_SHADOWS, "the receivers bound a convex room around the lights"),       \
      RUNS(CHOICE_WAVELENGTHS, "7 from 380 to 780 nm: the index varies with wavelength"),          \
      RUNS(CHOICE_INNER_REFLECTIONS,                                                               \
           "followed until less than 0.01 of the light is left, 8 exits at most"),                 \
      RUNS_OF(CHOICE_LIGHT_MAP, "lamp", "the light may meet a refractor"), tiles,                  \
      RESTS(PASS_RECEIVER_DEPTH, "receivers are hit exactly"),                                     \
      RUNS(PASS_LIGHT_FRONT, "photons start where the light sees a refractor"),                    \
      RESTS(PASS_LIGHT_BACK, "every refractor has an exact surface"),                              \
      RUNS(PASS_PHOTON_PLACEMENT, "at most 256 a side, where light meets a refractor"),            \
      RUNS(PASS_PHOTONS, "4 to 7 wavelengths, as each photon's hits ask"),                         \
      RUNS(PASS_SPECTRAL_MAP, "1024 x 1024 texels"),                                               \
      RUNS(PASS_GAP_FILL, "bridge: wavelengths land apart"),                                       \
      RESTS(CHOICE_ABSORPTION, "every material is clear"),                                         \
      RUNS(PASS_EYE_RECEIVERS, "light, shadow and spectral map"),                                  \
      RUNS(PASS_EYE_FRONT, "the pixels that show a refractor"),                                    \
      RESTS(PASS_EYE_BACK, "every refractor has an exact surface"),                                \
      RUNS(PASS_EYE_ADAPTIVE, "4 x 4 rays for a sample of a receiver where its light bends"),      \
      RUNS(PASS_EYE_REFRACTION, "until less than 0.005 of its light is left, 256 exits at most"),  \
      RUNS(PASS_EYE_PICTURE, "2 x 2 samples a pixel"), RESTS(CHOICE_TEXTURES, "none"), colours,    \
      RESTS(CHOICE_LIGHT_SIZE, "none"), RESTS(CHOICE_ENVIRONMENT, "none"),
#define UNLIT                                                                                      \
  RESTS(CHOICE_RECEIVER_MAPS, "no light meets a refractor"),                                       \
      RESTS(PASS_LIGHT_FRONT, "no light meets a refractor"),                                       \
      RESTS(PASS_PHOTON_PLACEMENT, "no light meets a refractor"),                                  \
      RESTS(PASS_PHOTONS, "no light meets a refractor"),                                           \
      RESTS(PASS_SPECTRAL_MAP, "no light meets a refractor"),                                      \
      RESTS(PASS_GAP_FILL, "nothing lands apart")
#define SHADOWED                                                                                   \
  RUNS(CHOICE_RECEIVER_SHADOWS, "a receiver may stand between a light and another"),               \
      RUNS(CHOICE_RECEIVER_MAPS, "a receiver may hide from a light where its light lands")
static const row ball_rows[] = {
    BALL_ROWS(RESTS(CHOICE_RECEIVER_MAPS, "the lights' maps hold all receivers"), GREY) END};
static const pair pairs[] = {
    FIELDS("no refractor", ball, CAMERA POINT_LIGHT FLOOR, {0},
           {COUNTS(1, 8, 9), RESTS(CHOICE_MULTI_REFRACTOR_PATHS, "nothing refracts"),
            RUNS(CHOICE_WAVELENGTHS, "1 from 380 to 780 nm: nothing refracts"),
            RESTS(CHOICE_INNER_REFLECTIONS, "nothing refracts"), UNLIT,
            RESTS(CHOICE_ABSORPTION, "nothing refracts"), RESTS(PASS_EYE_FRONT, "nothing refracts"),
            RESTS(PASS_EYE_REFRACTION, "nothing refracts"), GONE(CHOICE_REFRACTOR_MODEL, "ball"),
            GONE(CHOICE_LIGHT_MAP, "lamp"), END}),
    FIELDS("one sample a pixel", ball, ball, {.supersample = 1},
           {RESTS(PASS_EYE_PICTURE, "one sample a pixel: nothing is averaged"), END}),
    FIELDS("a ray a sample", ball, ball, {.adaptive = 1},
           {RESTS(PASS_EYE_ADAPTIVE, "none, as asked"), END}),
    FIELDS("a lamp between the refractors", two_balls,
           CAMERA LAMP_BETWEEN FLOOR BALL("crown") BALL_BESIDE, {0},
           {RUNS_OF(CHOICE_LIGHT_MAP, "lamp",
                    "a cube: 2 of 6 faces, as 'other' is more than 76 degrees off the middle of "
                    "all refractors"),
            END}),
    FIELDS("a mesh about a lamp between the refractors", two_balls,
           CAMERA LAMP_BETWEEN FLOOR DOME BALL("crown") BALL_BESIDE, {0},
           {RUNS(CHOICE_RECEIVER_MODEL, "triangle hierarchy: 'dome' is a general mesh"),
            RUNS(CHOICE_RECEIVER_SHADOWS, "a receiver may stand between a light and another"),
            RUNS_OF(CHOICE_LIGHT_MAP, "lamp",
                    "a cube: 2 of 6 faces, as 'other' is more than 76 degrees off the middle of "
                    "all refractors"),
            RUNS(CHOICE_RECEIVER_MAPS, "a receiver may hide from a light where its light lands"),
            END}),
    FIELDS("an index that is constant", ball, CAMERA POINT_LIGHT FLOOR BALL("flat"), {0},
           {COUNTS(1, 8, 9),
            RUNS(CHOICE_WAVELENGTHS,
                 "1 from 380 to 780 nm: all indices are constant, one geometry serves all"),
            RUNS(PASS_PHOTONS, "1 wavelengths through the refractors"),
            RESTS(PASS_GAP_FILL, "nothing lands apart"), END}),
    FIELDS("an index that is air's", ball, CAMERA POINT_LIGHT FLOOR BALL("air"), {0},
           {COUNTS(1, 8, 9),
            RESTS_OF(CHOICE_REFRACTOR_MODEL, "ball",
                     "clear, and its index is that of air: light does not notice it"),
            RESTS(CHOICE_MULTI_REFRACTOR_PATHS, "nothing refracts"),
            RUNS(CHOICE_WAVELENGTHS, "1 from 380 to 780 nm: nothing refracts"),
            RESTS(CHOICE_INNER_REFLECTIONS, "nothing refracts"), UNLIT,
            RESTS(CHOICE_ABSORPTION, "nothing refracts"), RESTS(PASS_EYE_FRONT, "nothing refracts"),
            RESTS(PASS_EYE_REFRACTION, "nothing refracts"), GONE(CHOICE_LIGHT_MAP, "lamp"), END}),
    FIELDS("a material that absorbs", ball, CAMERA POINT_LIGHT FLOOR BALL("murk"), {0},
           {OPTICAL_DEPTHS, END}),
    FIELDS(
        "a material that absorbs outside the range alone", ball,
        CAMERA POINT_LIGHT FLOOR BALL("murk"), {.min_nm = 500},
        {RUNS(CHOICE_WAVELENGTHS, "7 from 500 to 780 nm: the index varies with wavelength"), END}),
    FIELDS(
        "a constant index, and an attenuation that varies", flat,
        CAMERA POINT_LIGHT FLOOR BALL("smoke"), {0},
        {COUNTS(7, 8, 9),
         RUNS(CHOICE_WAVELENGTHS, "7 from 380 to 780 nm: the attenuation varies with wavelength"),
         RUNS(PASS_PHOTONS, "7 wavelengths through the refractors"), OPTICAL_DEPTHS, END}),
    FIELDS("a constant index, and an attenuation that is constant", flat,
           CAMERA POINT_LIGHT FLOOR BALL("grey"), {0},
           {RUNS(CHOICE_ABSORPTION, "a material attenuates; path lengths are kept"), END}),
    FIELDS("a cube for the ball", ball, CAMERA POINT_LIGHT FLOOR CUBE("crown"), {0},
           {RUNS_OF(CHOICE_REFRACTOR_MODEL, "ball",
                    "convex planes: the object is a convex faceted solid"),
            RUNS(CHOICE_INNER_REFLECTIONS, "followed until less than 0.01 of the light is left, 8 "
                                           "exits at most; 0.17 % of it is still inside then"),
            IN_ROWS, END}),
    FIELDS("an index above 2, of a cube", cube, CAMERA POINT_LIGHT FLOOR CUBE("dense"), {0},
           {RUNS(CHOICE_INNER_REFLECTIONS, "followed until less than 0.01 of the light is left, 8 "
                                           "exits at most; 0.42 % of it is still inside then"),
            END}),
    FIELDS("facets that slope, of a cube", cube, CAMERA POINT_LIGHT FLOOR STONE("dense"), {0},
           {COUNTS(7, 24, 25),
            RUNS_OF(CHOICE_REFRACTOR_MODEL, "ball",
                    "convex planes: the object is a convex faceted solid: it has 19 planes"),
            RUNS(CHOICE_INNER_REFLECTIONS, "followed until less than 0.01 of the light is left, 24 "
                                           "exits at most; 6.1 % of it is still inside then"),
            END}),
    FIELDS("an index of 1.5, of a dense stone", stone, CAMERA POINT_LIGHT FLOOR STONE("crown"), {0},
           {COUNTS(7, 11, 12),
            RUNS(CHOICE_INNER_REFLECTIONS, "followed until less than 0.01 of the light is left, 11 "
                                           "exits at most; 0.49 % of it is still inside then"),
            END}),
    FIELDS("ten exits, asked for in a dense stone", stone, CAMERA POINT_LIGHT FLOOR STONE("dense"),
           {.exits = 10},
           {COUNTS(7, 10, 11),
            RUNS(CHOICE_INNER_REFLECTIONS, "followed until less than 0.01 of the light is left, 10 "
                                           "exits at most; 20 % of it is still inside then"),
            END}),
    FIELDS("a share, asked for in a dense stone", stone, CAMERA POINT_LIGHT FLOOR STONE("dense"),
           {.energy_share = 0.05},
           {RUNS(CHOICE_INNER_REFLECTIONS, "followed until less than 0.05 of the light is left, 24 "
                                           "exits at most; 7.8 % of it is still inside then"),
            END}),
    FIELDS("an index above 2, of a ball", ball, CAMERA POINT_LIGHT FLOOR BALL("dense"), {0}, {END}),
    FIELDS(
        "a convex mesh for the ball", ball, CAMERA POINT_LIGHT FLOOR EGG("crown"), {0},
        {COUNTS(7, 4, 5),
         RUNS_OF(CHOICE_REFRACTOR_MODEL, "ball",
                 "front and back layers: the object is a convex mesh and stands alone: a view sees "
                 "all of it, front and back"),
         RUNS(CHOICE_INNER_REFLECTIONS,
              "followed until less than 0.01 of the light is left, 4 exits at most"),
         RUNS(PASS_LIGHT_BACK, "a mesh without an exact surface ends at its back layer"),
         RUNS(PASS_EYE_BACK, "a mesh without an exact surface ends at its back layer"),
         RUNS(PASS_EYE_REFRACTION, "until less than 0.005 of its light is left, 4 exits at most"),
         END}),
    FIELDS(
        "a mesh with a hole for the ball", ball, CAMERA POINT_LIGHT FLOOR TORUS("crown"), {0},
        {COUNTS(7, 8, 16),
         RUNS_OF(CHOICE_REFRACTOR_MODEL, "ball",
                 "triangle hierarchy: the object is a general mesh, and light may meet it more "
                 "than twice"),
         RUNS(CHOICE_MULTI_REFRACTOR_PATHS, "the refractor is not convex"),
         RUNS(PASS_EYE_REFRACTION, "until less than 0.01 of its light is left, 256 exits at most"),
         END}),
    FIELDS(
        "a second refractor, apart", ball, CAMERA POINT_LIGHT FLOOR BALL("crown") BRICK("crown"),
        {0},
        {COUNTS(7, 8, 16),
         RUNS_OF(CHOICE_REFRACTOR_MODEL, "brick",
                 "convex planes: the object is a convex faceted solid"),
         RUNS(CHOICE_MULTI_REFRACTOR_PATHS, "there is more than one refractor"), IN_ROWS,
         RUNS(PASS_EYE_REFRACTION, "until less than 0.01 of its light is left, 256 exits at most"),
         END}),
    FIELDS(
        "a second refractor, within", ball, CAMERA POINT_LIGHT FLOOR BALL("crown") YOLK("crown"),
        {0},
        {COUNTS(7, 8, 16),
         RUNS_OF(CHOICE_REFRACTOR_MODEL, "yolk", "exact sphere: the object is a sphere"),
         RUNS(CHOICE_MULTI_REFRACTOR_PATHS, "there is more than one refractor"),
         RUNS(PASS_EYE_REFRACTION, "until less than 0.01 of its light is left, 256 exits at most"),
         END}),
    FIELDS(
        "a refractor that reaches into the floor", ball, CAMERA POINT_LIGHT FLOOR SUNK("crown"),
        {0},
        {COUNTS(7, 8, 16),
         RUNS(CHOICE_MULTI_REFRACTOR_PATHS, "a receiver may reach into the refractor"), SHADOWED,
         RUNS(PASS_EYE_REFRACTION, "until less than 0.01 of its light is left, 256 exits at most"),
         END}),
    FIELDS("a mirror beside it", ball, CAMERA POINT_LIGHT FLOOR BALL("crown") MIRROR, {0},
           {COUNTS(7, 8, 16),
            RUNS_OF(CHOICE_REFRACTOR_MODEL, "glass", "triangle hierarchy: the object is a mirror"),
            RUNS_OF(CHOICE_MIRROR, "", "it reflects 0.9 of the light"),
            RUNS(CHOICE_MULTI_REFRACTOR_PATHS, "what a mirror sends on may meet a surface again"),
            RUNS(CHOICE_RECEIVER_MAPS, "a receiver lies more than 76 degrees off"),
            RUNS(PASS_EYE_REFRACTION, "until less than 0.03 of its light is left, 256 exits"),
            END}),
    FIELDS("a directional light", ball, CAMERA SUN FLOOR BALL("crown"), {0},
           {RUNS_OF(CHOICE_LIGHT_MAP, "sun", "the light may meet a refractor"),
            GONE(CHOICE_LIGHT_MAP, "lamp"), END}),
    FIELDS("a spot that shines on the refractor", ball,
           CAMERA SPOT("[0, 0, 0]") FLOOR BALL("crown"), {0}, {END}),
    FIELDS("a spot that shines past the refractor", ball,
           CAMERA SPOT("[-0.5, 0, 0]") FLOOR BALL("crown"), {0},
           {RESTS_OF(CHOICE_LIGHT_MAP, "lamp", "its cone misses every refractor"), UNLIT, END}),
    FIELDS("a spot that shines past a mesh", egg, CAMERA SPOT("[-0.5, 0, 0]") FLOOR EGG("crown"),
           {0},
           {RESTS_OF(CHOICE_LIGHT_MAP, "lamp", "its cone misses every refractor"),
            RESTS(CHOICE_RECEIVER_MAPS, "no light meets a refractor"),
            RESTS(PASS_LIGHT_FRONT, "no light meets a refractor"),
            RESTS(PASS_LIGHT_BACK, "no light meets a refractor"),
            RESTS(PASS_PHOTON_PLACEMENT, "no light meets a refractor"),
            RESTS(PASS_PHOTONS, "no light meets a refractor"),
            RESTS(PASS_SPECTRAL_MAP, "no light meets a refractor"),
            RESTS(PASS_GAP_FILL, "nothing lands apart"), END}),
    FIELDS("a second light", ball, CAMERA POINT_LIGHT LIGHT_ASIDE FLOOR BALL("crown"), {0},
           {RUNS_OF(CHOICE_LIGHT_MAP, "second", "the light may meet a refractor"), END}),
    FIELDS("a second light of another spectrum", ball,
           CAMERA POINT_LIGHT LIGHT_ASIDE_OF("A") FLOOR BALL("crown"), {0},
           {RUNS_OF(CHOICE_LIGHT_MAP, "second", "the light may meet a refractor"),
            NOTE("through refractors, colours are split by the first light's illuminant"), END}),
    FIELDS("a receiver that may hide another", ball, CAMERA POINT_LIGHT FLOOR CARD BALL("crown"),
           {0}, {SHADOWED, END}),
    FIELDS("a receiver far off the way to the refractor", ball,
           CAMERA POINT_LIGHT FLOOR CEILING BALL("crown"), {0},
           {RUNS(CHOICE_RECEIVER_MAPS,
                 "a receiver lies more than 76 degrees off the view of a light's map"),
            END}),
    FIELDS("a mesh far off the way to the refractor", ball,
           CAMERA POINT_LIGHT FLOOR DOME BALL("crown"), {0},
           {RUNS(CHOICE_RECEIVER_MODEL, "triangle hierarchy: 'dome' is a general mesh"), SHADOWED,
            END}),
    FIELDS("meshes alone", ball, CAMERA POINT_LIGHT "objects:\n" PEBBLE DOME BALL("crown"), {0},
           {RUNS(CHOICE_RECEIVER_MODEL, "triangle hierarchy: 'pebble' is a general mesh"), SHADOWED,
            END}),
    FIELDS("a receiver that is no rectangle", ball, CAMERA POINT_LIGHT FLOOR HILL BALL("crown"),
           {0},
           {RUNS(CHOICE_RECEIVER_MODEL, "triangle hierarchy: 'hill' is a general mesh"), SHADOWED,
            END}),
    FIELDS("a receiver that is no rectangle, and layers as asked", egg,
           CAMERA POINT_LIGHT FLOOR HILL EGG("crown"), {.model = ABBE_MODEL_LAYERS},
           {RUNS_OF(CHOICE_REFRACTOR_MODEL, "ball", "front and back layers: as asked"),
            RESTS(CHOICE_MULTI_REFRACTOR_PATHS,
                  "light goes through two layers and no further, as asked"),
            RUNS(CHOICE_RECEIVER_MODEL, "triangle hierarchy: 'hill' is a general mesh"), SHADOWED,
            END}),
    FIELDS("a room around the refractor", ball, CAMERA POINT_LIGHT FLOOR ROOM BALL("crown"), {0},
           {SHADOWED, END}),
    FIELDS("a texture", ball, CAMERA POINT_LIGHT WOOD BALL("crown"), {0},
           {RUNS(CHOICE_TEXTURES, "a receiver has one"), COLOURED, END}),
    FIELDS("a light with a size", ball, CAMERA DISK_LIGHT FLOOR BALL("crown"), {.light_points = 1},
           {RUNS(CHOICE_LIGHT_SIZE, LAMP_HAS_SIZE), END}),
    FIELDS("an environment", ball,
           CAMERA POINT_LIGHT FLOOR BALL(
               "crown") "environment: {softboxes: [{elevation: 90, radius: 3, radiance: 9}]}\n",
           {.environment_lights = 1},
           {RUNS_OF(CHOICE_LIGHT_MAP, "environment 1", "the light may meet a refractor"),
            RUNS(CHOICE_ENVIRONMENT, "the camera sees it whole; 1 directional lights stand for the "
                                     "100 % that stand out of it, sharp but for shadows of convex "
                                     "solids and balls; the rest lights receivers without shadows "
                                     "or caustics (--transport pinhole: with)"),
            END}),
    FIELDS("an eye that looks past the refractor", ball, EYE_ASIDE POINT_LIGHT FLOOR BALL("crown"),
           {0},
           {RESTS(PASS_EYE_FRONT, "the eye sees no refractor"),
            RESTS(PASS_EYE_REFRACTION, "the eye sees no refractor"), END}),
    FIELDS("an eye that looks past a mesh", egg, EYE_ASIDE POINT_LIGHT FLOOR EGG("crown"), {0},
           {RESTS(PASS_EYE_FRONT, "the eye sees no refractor"),
            RESTS(PASS_EYE_BACK, "the eye sees no refractor"),
            RESTS(PASS_EYE_REFRACTION, "the eye sees no refractor"), END}),
    FIELDS("neither light nor eye for the refractor", ball,
           EYE_ASIDE SPOT("[-0.5, 0, 0]") FLOOR BALL("murk"), {0},
           {COUNTS(1, 8, 9),
            RUNS(CHOICE_WAVELENGTHS,
                 "1 from 380 to 780 nm: neither a light nor the eye meets a refractor"),
            RESTS(CHOICE_INNER_REFLECTIONS, "neither a light nor the eye meets a refractor"),
            RESTS_OF(CHOICE_LIGHT_MAP, "lamp", "its cone misses every refractor"), UNLIT,
            RESTS(CHOICE_ABSORPTION, "neither a light nor the eye meets a refractor"),
            RESTS(PASS_EYE_FRONT, "the eye sees no refractor"),
            RESTS(PASS_EYE_REFRACTION, "the eye sees no refractor"), END}),
    FIELDS("one wavelength, as asked", ball, CAMERA POINT_LIGHT FLOOR BALL("crown"),
           {.wavelengths = 1},
           {COUNTS(1, 8, 9), RUNS(CHOICE_WAVELENGTHS, "1 from 380 to 780 nm: as asked"),
            RUNS(PASS_PHOTONS, "1 wavelengths through the refractors"),
            RESTS(PASS_GAP_FILL, "nothing lands apart"), END}),
    FIELDS("many wavelengths of a constant index, as asked", flat,
           CAMERA POINT_LIGHT FLOOR BALL("flat"), {.wavelengths = 21},
           {COUNTS(21, 8, 9), RUNS(CHOICE_WAVELENGTHS, "21 from 380 to 780 nm: as asked"),
            RUNS(PASS_PHOTONS, "21 wavelengths through the refractors"), END}),
    FIELDS("many wavelengths of a glass that tints", ball, CAMERA POINT_LIGHT FLOOR BALL("murk"),
           {.wavelengths = 21},
           {COUNTS(21, 8, 9), RUNS(CHOICE_WAVELENGTHS, "21 from 380 to 780 nm: as asked"),
            RUNS(PASS_PHOTONS, "4 to 21 wavelengths, as each photon's hits ask"), OPTICAL_DEPTHS,
            END}),
    FIELDS(
        "many wavelengths of a glass that tints, from wall to wall of a mesh", ball,
        CAMERA POINT_LIGHT FLOOR RING("murk"), {.wavelengths = 21},
        {COUNTS(21, 8, 16), RUNS_OF(CHOICE_REFRACTOR_MODEL, "ring", "triangle hierarchy"),
         RUNS(CHOICE_MULTI_REFRACTOR_PATHS, "the refractor is not convex"),
         RUNS(CHOICE_WAVELENGTHS, "21 from 380 to 780 nm: as asked"),
         RUNS(PASS_PHOTONS, "4 to 21 wavelengths, as each photon's hits ask"), OPTICAL_DEPTHS,
         RUNS(PASS_EYE_REFRACTION, "until less than 0.01 of its light is left, 256 exits at most"),
         GONE(CHOICE_REFRACTOR_MODEL, "ball"), END}),
    FIELDS("many wavelengths of a clear glass", ball, CAMERA POINT_LIGHT FLOOR BALL("crown"),
           {.wavelengths = 21},
           {COUNTS(21, 8, 9), RUNS(CHOICE_WAVELENGTHS, "21 from 380 to 780 nm: as asked"),
            RUNS(PASS_PHOTONS, "4 to 21 wavelengths, as each photon's hits ask"), END}),
    FIELDS("no fill, as asked", ball, CAMERA POINT_LIGHT FLOOR BALL("crown"),
           {.fill = ABBE_FILL_NONE},
           {RUNS(PASS_PHOTONS, "7 wavelengths through the refractors"),
            RESTS(PASS_GAP_FILL, "none, as asked"), END}),
    FIELDS("one exit, as asked", ball, CAMERA POINT_LIGHT FLOOR BALL("crown"), {.exits = 1},
           {COUNTS(7, 1, 2), RESTS(CHOICE_INNER_REFLECTIONS, "two interfaces only, as asked"),
            RUNS(PASS_EYE_REFRACTION, "one direction a wavelength"), END}),
    FIELDS("the thesis profile, as asked", ball, CAMERA POINT_LIGHT FLOOR BALL("crown"),
           {.profile = ABBE_PROFILE_THESIS},
           {COUNTS(7, 1, 1),
            RUNS_OF(CHOICE_REFRACTOR_MODEL, "ball",
                    "front and back layers: the thesis profile knows no other model"),
            RESTS(CHOICE_MULTI_REFRACTOR_PATHS,
                  "the published method follows two interfaces at the most"),
            RUNS(CHOICE_RECEIVER_MODEL,
                 "iterated image space: the thesis profile knows no other model"),
            RUNS(CHOICE_RECEIVER_SHADOWS, "a receiver may stand between a light and another"),
            RUNS(CHOICE_WAVELENGTHS, "7 from 380 to 680 nm: the index varies with wavelength"),
            RESTS(CHOICE_INNER_REFLECTIONS, "two interfaces only, as published"),
            RESTS(CHOICE_RECEIVER_MAPS, "the thesis knows none"),
            RUNS(PASS_RECEIVER_DEPTH, "receivers are found by their depth from the light"),
            RUNS(PASS_LIGHT_BACK, "a mesh without an exact surface ends at its back layer"),
            RUNS(PASS_PHOTON_PLACEMENT, "at most 512 a side, where light meets a refractor"),
            RUNS(PASS_PHOTONS, "7 wavelengths through the refractors"),
            RUNS(PASS_GAP_FILL, "smear: wavelengths land apart"),
            RUNS(PASS_EYE_BACK, "a mesh without an exact surface ends at its back layer"),
            RESTS(PASS_EYE_ADAPTIVE, "the thesis knows none"),
            RUNS(PASS_EYE_REFRACTION, "one direction a wavelength"),
            RESTS(PASS_EYE_PICTURE, "one sample a pixel: nothing is averaged"), END}),
};

enum { PAIRS = sizeof pairs / sizeof *pairs };

#endif
