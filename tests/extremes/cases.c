#include "tests/extremes/extreme.h"

/* A cube of 0.1 with a fan of slivers on its top: a corner of the fan is 1e-7 off the edge. */
#define CORNERS                                                                                    \
  "v -0.05 -0.05 -0.05\nv 0.05 -0.05 -0.05\nv 0.05 0.05 -0.05\nv -0.05 0.05 -0.05\n"               \
  "v -0.05 -0.05 0.05\nv 0.05 -0.05 0.05\nv 0.05 0.05 0.05\nv -0.05 0.05 0.05\n"
#define SIDES                                                                                      \
  "f 1 3 2\nf 1 4 3\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n"
#define SLIVERS CORNERS "v 0 -0.0499999 0.05\n" SIDES "f 5 6 9\nf 6 7 9\nf 7 8 9\nf 8 5 9\n"
#define TWICE CORNERS SIDES "f 5 6 7\nf 5 7 8\nf 5 6 7\n"
/* The third seals the gap between an edge that has a point on it and one that has none. */
#define NO_AREA CORNERS "v 0 -0.05 0.05\n" SIDES "f 5 9 7\nf 9 6 7\nf 5 6 9\nf 5 7 8\n"
#define LOOSE CORNERS "v 0 -0.05 0.05\n" SIDES "f 5 6 7\nf 5 7 8\nf 5 9 6\n"
#define NEEDLE "v -0.1 0 0\nv 0.1 0 0\nv 0 1e-5 0\nv 0 0 1e-5\nf 1 2 4\nf 1 3 2\nf 2 3 4\nf 1 4 3\n"
#define WIDE                                                                                       \
  "- {name: plain, shape: rectangle, width: 100000, height: 100000, reflectance: 0.5, transform: " \
  "[PLACE]}\n"
#define CARD                                                                                       \
  "- {name: card, shape: rectangle, width: 0.3, height: 0.3, reflectance: 0.9, transform: "        \
  "[{translate: [0, 0, 1e-3]}, PLACE]}\n"
#define MIRROR_BALL                                                                                \
  "- {name: ball, shape: sphere, radius: 0.08, levels: 4, mirror: 0.9, transform: "                \
  "[{translate: [0, 0, 0.2]}, PLACE]}\n"
#define PLATE(thickness)                                                                           \
  "- {name: plate, shape: box, size: [0.2, 0.2, " thickness "], material: glass, transform: "      \
  "[{translate: [0, 0, 0.2]}, PLACE]}\n"
#define BEAD(x, radius)                                                                            \
  "- {name: bead" x ", shape: sphere, radius: " radius ", levels: 2, material: glass, transform: " \
  "[{translate: [" x ", 0, 0.2]}, PLACE]}\n"
#define FLOOR_OF(reflectance)                                                                      \
  "- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: " reflectance               \
  ", transform: [PLACE]}\n"
#define LIGHT(...)                                                                                 \
  { __VA_ARGS__ }
#define LAMP(x, y, z) LIGHT({.kind = "point", .at = {x, y, z}})
#define SUN(x, y, z) LIGHT({.kind = "directional", .way = {x, y, z}})
#define AROUND(shape) EXTREME_FLOOR shape

#define CASE(of, called, ...)                                                                      \
  { .group = of, .name = called, __VA_ARGS__ }

const extreme extremes[] = {
    CASE("indices", "B = 0", .each = true, .scene = {.n = 1.5, .b = 0}, .desc = {.wavelengths = 7}),
    CASE("indices", "B = 1e-6", .each = true, .scene = {.n = 1.5, .b = 1e-6},
         .desc = {.wavelengths = 7}),
    CASE("indices", "B = 0.6", .each = true, .scene = {.n = 1.5, .b = 0.6},
         .desc = {.wavelengths = 7}),
    CASE("indices", "B = 10", .each = true, .scene = {.n = 1.5, .b = 10},
         .desc = {.wavelengths = 7}),
    CASE("indices", "n = 1 - 1e-6", .each = true, .dark = true, .scene = {.n = 1 - 1e-6, .b = 0},
         .desc = {.wavelengths = 7}),
    CASE("indices", "n = 1", .each = true, .dark = true, .scene = {.n = 1, .b = 0},
         .desc = {.wavelengths = 7}),
    CASE("indices", "n = 1 + 1e-7", .each = true, .dark = true, .scene = {.n = 1 + 1e-7, .b = 0},
         .desc = {.wavelengths = 7}),
    CASE("indices", "n = 1 + 1e-6", .each = true, .dark = true, .scene = {.n = 1 + 1e-6, .b = 0},
         .desc = {.wavelengths = 7}),
    CASE("indices", "n = 1 + 1e-5", .each = true, .scene = {.n = 1 + 1e-5, .b = 0},
         .desc = {.wavelengths = 7}),
    CASE("indices", "n = 1.001", .each = true, .scene = {.n = 1.001, .b = 0},
         .desc = {.wavelengths = 7}),
    CASE("indices", "n = 4", .each = true, .scene = {.n = 4, .b = 0}, .desc = {.wavelengths = 7}),
    CASE("indices", "n below 0", .scene = {.n = -1.5}, .refused = ABBE_SCHEMA,
         .reason = "no real index"),
    CASE("indices", "n falls below 0 at 360 nm", .scene = {.n = 1.5, .b = -0.25},
         .refused = ABBE_SCHEMA, .reason = "no real index"),

    CASE("wavelengths", "360 to 830 nm", .scene = {.b = 0.01},
         .desc = {.wavelengths = 16, .min_nm = 360, .max_nm = 830}),
    CASE("wavelengths", "360 to 361 nm", .scene = {.b = 0.01},
         .desc = {.wavelengths = 3, .min_nm = 360, .max_nm = 361}),
    CASE("wavelengths", "555 to 556 nm", .scene = {.b = 0.01},
         .desc = {.wavelengths = 3, .min_nm = 555, .max_nm = 556}),
    CASE("wavelengths", "829 to 830 nm", .scene = {.b = 0.01},
         .desc = {.wavelengths = 3, .min_nm = 829, .max_nm = 830}),
    CASE("wavelengths", "1 wavelength", .scene = {.b = 0.01}, .desc = {.wavelengths = 1}),
    CASE("wavelengths", "2 wavelengths", .scene = {.b = 0.01}, .desc = {.wavelengths = 2}),
    CASE("wavelengths", "65 wavelengths, brick",
         .scene = {.b = 0.01, .objects = AROUND(EXTREME_BRICK)}, .desc = {.wavelengths = 65}),
    CASE("wavelengths", "1000 wavelengths", .scene = {.b = 0.01},
         .desc = {.wavelengths = 1000, .photons = 16}),
    CASE("wavelengths", "1000 wavelengths, brick", .heavy = true,
         .scene = {.b = 0.01, .objects = AROUND(EXTREME_BRICK)},
         .desc = {.wavelengths = 1000, .photons = 256, .map_size = 1024}),
    CASE("wavelengths", "1001 wavelengths", .desc = {.wavelengths = 1001},
         .refused = ABBE_INVALID_ARGUMENT, .reason = "1 to 1000"),
    CASE("wavelengths", "an empty range", .desc = {.min_nm = 500, .max_nm = 500},
         .refused = ABBE_INVALID_ARGUMENT, .reason = "empty"),
    CASE("wavelengths", "359 to 831 nm, beyond the observer",
         .desc = {.wavelengths = 7, .min_nm = 359, .max_nm = 831}),
    CASE("wavelengths", "no light that is seen, 900 to 901 nm",
         .desc = {.wavelengths = 3, .min_nm = 900, .max_nm = 901}, .refused = ABBE_INVALID_ARGUMENT,
         .reason = "the eye sees 360 to 830 nm"),

    CASE("photons", "1 photon", .scene = {.b = 0.01}, .desc = {.photons = 1}),
    CASE("photons", "2 x 2 photons, a map of 1", .scene = {.b = 0.01},
         .desc = {.photons = 2, .map_size = 1}),
    CASE("photons", "3 x 3 photons, a map of 2",
         .scene = {.b = 0.01, .objects = AROUND(EXTREME_RING)},
         .desc = {.photons = 3, .map_size = 2}),
    CASE("photons", "257 x 257 photons, a map of 97", .scene = {.b = 0.01},
         .desc = {.photons = 257, .map_size = 97}),
    CASE("photons", "1024 x 1024 photons, 64-bit sums", .heavy = true, .scene = {.b = 0.01},
         .desc = {.photons = 1024, .map_size = 1024}),
    CASE("photons", "4096 x 4096 photons, 1 wavelength, 1 exit", .heavy = true,
         .desc = {.photons = 4096, .map_size = 1024, .wavelengths = 1, .exits = 1}),
    CASE("photons", "4096 x 4096 photons, 7 wavelengths, 8 exits", .heavy = true,
         .scene = {.b = 0.01}, .desc = {.photons = 4096, .map_size = 4096, .wavelengths = 7},
         .refused = ABBE_UNSUPPORTED, .reason = "a grid below 4096 or fewer exits",
         .by_device = true),
    CASE("photons", "4097 x 4097 photons", .desc = {.photons = 4097},
         .refused = ABBE_INVALID_ARGUMENT, .reason = "1 to 4096"),
    CASE("photons", "16 exits of every share",
         .scene = {.b = 0.01, .objects = AROUND(EXTREME_BRICK)},
         .desc = {.exits = 16, .energy_share = 1e-30}),
    CASE("photons", "1 exit", .scene = {.b = 0.01}, .desc = {.exits = 1}),
    CASE("photons", "paths that end at once", .scene = {.b = 0.01}, .desc = {.energy_share = 1}),

    CASE("scale", "1e-4 m a unit", .each = true, .scene = {.b = 0.01, .size = 1e-4}),
    CASE("scale", "1e5 m a unit", .each = true,
         .scene = {.b = 0.01,
                   .size = 1e5,
                   .light = {{.kind = "point", .at = {0.05, 0.03, 0.6}, .power = 0.01}}}),
    CASE("scale", "1e5 m from the origin", .each = true,
         .scene = {.b = 0.01, .at = {1e5, -1e5, 1e5}}),
    CASE("scale", "1e7 m from the origin", .scene = {.at = {0, 1e7, 0}}, .refused = ABBE_SCHEMA,
         .reason = "-1e+06 to 1e+06"),
    CASE("scale", "ball of 1e-4 m units 1e3 m from the origin",
         .scene = {.b = 0.01, .size = 1e-4, .at = {1e3, 0, 0}}),
    CASE("scale", "two beads 1e-4 of a unit wide, 1.8 units apart",
         .scene = {.objects = EXTREME_FLOOR BEAD("-0.9", "5e-5") BEAD("0.9", "5e-5")},
         .refused = ABBE_UNSUPPORTED, .reason = "a matter of chance"),
    CASE("scale", "a bead of one texel beside a ball",
         .scene = {.objects = EXTREME_FLOOR EXTREME_BALL BEAD("0.5", "5e-3")}),
    CASE("scale", "a ball over a floor 1e5 units wide",
         .scene = {.b = 0.01, .objects = WIDE EXTREME_BALL}),
    CASE("scale", "a ball over a floor 1e5 units wide, under a sun",
         .scene = {.light = SUN(0.1, 0.2, -1), .objects = WIDE EXTREME_BALL}),
    CASE("scale", "a ball over a card 1e-3 above a floor 1e5 units wide",
         .scene = {.light = SUN(0.1, 0.2, -1), .objects = WIDE CARD EXTREME_BALL}),
    CASE("scale", "a mirror ball over a floor 1e5 units wide, close to the camera",
         .scene = {.objects = WIDE MIRROR_BALL, .eye = {0, -0.2, 0.25}, .target = {0, 0, 0.2}}),
    CASE("scale", "two balls 1e5 units apart, under a sun",
         .scene = {.light = SUN(0.1, 0.2, -1), .objects = WIDE EXTREME_BALL BEAD("1e5", "0.08")},
         .desc = {.photons = 3}, .refused = ABBE_UNSUPPORTED,
         .reason = "move them nearer together"),
    CASE("scale", "a ball that fills the view",
         .scene = {.b = 0.01, .eye = {0, -0.081, 0.2}, .target = {0, 0, 0.2}}),
    CASE("scale", "a plate 1e-9 thick", .scene = {.b = 0.01, .objects = AROUND(PLATE("1e-9"))},
         .refused = ABBE_UNSUPPORTED, .reason = "thin"),
    CASE("scale", "a plate 1e-4 thick", .scene = {.b = 0.01, .objects = AROUND(PLATE("1e-4"))}),

    CASE("lights", "a lamp that touches the ball", .scene = {.light = LAMP(0, 0, 0.28)},
         .refused = ABBE_UNSUPPORTED, .reason = "on the surface"),
    CASE("lights", "a lamp inside the ball", .scene = {.light = LAMP(0, 0, 0.2)},
         .refused = ABBE_UNSUPPORTED, .reason = "inside"),
    CASE("lights", "a lamp 1e-9 above the ball", .scene = {.light = LAMP(0, 0, 0.28 + 1e-9)},
         .refused = ABBE_UNSUPPORTED, .reason = "on the surface"),
    CASE("lights", "a lamp 1e-4 above the ball", .scene = {.light = LAMP(0, 0, 0.28 + 1e-4)}),
    CASE("lights", "a lamp just far enough from the ball", .scene = {.light = LAMP(0, 0, 0.285)}),
    CASE("lights", "a lamp between two balls",
         .scene = {.light = LAMP(0, 0, 0.2),
                   .objects = EXTREME_FLOOR BEAD("-0.3", "0.08") BEAD("0.3", "0.08")}),
    CASE("lights", "a lamp below the floor", .dark = true, .scene = {.light = LAMP(0, 0, -0.5)}),
    CASE("lights", "a lamp between ball and floor", .scene = {.light = LAMP(0, 0, 0.02)}),
    CASE("lights", "a lamp on the floor", .scene = {.light = LAMP(0.4, 0, 0)}),
    CASE("lights", "a lamp 1e-9 above the floor", .scene = {.light = LAMP(0.4, 0, 1e-9)}),
    CASE("lights", "a lamp 1000 units away",
         .scene = {.light = {{.kind = "point", .at = {0, 0, 1e3}, .power = 1e6}}}),
    CASE("lights", "a lamp 5e5 units away",
         .scene = {.light = {{.kind = "point", .at = {0, 0, 5e5}, .power = 1e9}}},
         .refused = ABBE_UNSUPPORTED, .reason = "directional"),
    CASE("lights", "a sun", .scene = {.b = 0.01, .light = SUN(0.1, 0.2, -1)}),
    CASE("lights", "a sun along the floor", .scene = {.light = SUN(1, 0, 0)}),
    CASE("lights", "a sun that grazes the floor by 1e-6", .scene = {.light = SUN(1, 0, -1e-6)}),
    CASE("lights", "a sun that grazes the floor by 1e-3",
         .scene = {.light = SUN(1, 0, -1e-3), .objects = AROUND(EXTREME_BRICK)}),
    CASE("lights", "a sun from below", .dark = true, .scene = {.light = SUN(0, 0, 1)}),
    CASE("lights", "a sun along a box's sides",
         .scene = {.light = SUN(0, 0, -1), .objects = AROUND(PLATE("0.05"))}),
    CASE("lights", "a spot beside everything", .dark = true,
         .scene = {.light = {{.kind = "spot", .at = {0, 0, 0.6}, .way = {0, 0, 1}}}}),
    CASE("lights", "a disk", .desc = {.light_points = 1},
         .scene = {.light = {{.kind = "disk", .at = {0, 0, 0.6}, .way = {0, 0, -1}}}}),
    CASE("lights", "1e-20 W/sr",
         .scene = {.b = 0.01, .light = {{.kind = "point", .at = {0, 0, 0.6}, .power = 1e-20}}}),
    CASE("lights", "1e20 W/sr",
         .scene = {.b = 0.01, .light = {{.kind = "point", .at = {0, 0, 0.6}, .power = 1e20}}},
         .refused = ABBE_SCHEMA, .reason = "1e+09"),
    CASE("lights", "1e9 W/sr",
         .scene = {.b = 0.01, .light = {{.kind = "point", .at = {0, 0, 0.6}, .power = 1e9}}}),
    CASE("lights", "two lamps, one behind the floor",
         .scene = {.light = {{.kind = "point", .at = {0, 0, 0.6}},
                             {.kind = "point", .at = {0, 0, -0.5}}}}),

    CASE("meshes", "slivers",
         .scene = {.b = 0.01, .mesh = SLIVERS, .objects = AROUND(EXTREME_SOLID)}),
    CASE("meshes", "a face that is there twice",
         .scene = {.b = 0.01, .mesh = TWICE, .objects = AROUND(EXTREME_SOLID)}),
    CASE("meshes", "a face without area that belongs to nothing",
         .scene = {.mesh = LOOSE, .objects = AROUND(EXTREME_SOLID)}, .refused = ABBE_GEOMETRY,
         .reason = "open edges"),
    CASE("meshes", "a face without area",
         .scene = {.b = 0.01, .mesh = NO_AREA, .objects = AROUND(EXTREME_SOLID)}),
    CASE("meshes", "a needle 1e-4 as thick as long",
         .scene = {.b = 0.01, .mesh = NEEDLE, .objects = AROUND(EXTREME_SOLID)}),
    CASE("meshes", "two floors in one plane",
         .scene = {.b = 0.01, .objects = EXTREME_FLOOR EXTREME_FLOOR EXTREME_BALL}),
    CASE("meshes", "two balls in one place",
         .scene = {.b = 0.01, .objects = EXTREME_FLOOR EXTREME_BALL EXTREME_BALL}),
    CASE("meshes", "a gem of 3 sides", .scene = {.b = 0.01, .objects = AROUND(EXTREME_GEM("3"))}),
    CASE("meshes", "a gem of 1000 facets",
         .scene = {.b = 0.01, .objects = AROUND(EXTREME_GEM("250"))}),
    CASE("meshes", "a gem of 1000 sides",
         .scene = {.b = 0.01, .objects = AROUND(EXTREME_GEM("1000"))}),
    CASE("meshes", "absorption 0", .scene = {.b = 0.01}),
    CASE("meshes", "absorption 1e6 per metre", .each = true, .scene = {.attenuation_per_m = 1e6}),
    CASE("meshes", "absorption 1e15 per metre", .scene = {.attenuation_per_m = 1e15},
         .refused = ABBE_UNSUPPORTED, .reason = "absorbs light within a wavelength"),
    CASE("meshes", "absorption 1e16 per metre", .scene = {.attenuation_per_m = 1e16},
         .refused = ABBE_SCHEMA, .reason = "1e+15"),
    CASE("meshes", "a black floor", .scene = {.b = 0.01, .objects = FLOOR_OF("0") EXTREME_BALL}),
    CASE("meshes", "a white floor", .scene = {.b = 0.01, .objects = FLOOR_OF("1") EXTREME_BALL}),
    CASE("meshes", "a floor of glass touches a white one",
         .scene = {.b = 0.01,
                   .objects =
                       FLOOR_OF("1") "- {name: pane, shape: box, size: [0.4, 0.4, 0.1], material: "
                                     "glass, transform: [{translate: [0, 0, 0.05]}, PLACE]}\n"}),

    CASE("images", "1 x 1 pixel", .scene = {.b = 0.01}, .desc = {.width = 1, .height = 1}),
    CASE("images", "16 x 16 pixels", .scene = {.b = 0.01}, .desc = {.width = 16, .height = 16}),
    CASE("images", "1 x 512 pixels", .scene = {.b = 0.01}, .desc = {.width = 1, .height = 512}),
    CASE("images", "8192 x 2 pixels", .scene = {.b = 0.01},
         .desc = {.width = 8192, .height = 2, .supersample = 1}),
    CASE("images", "8192 x 8192 pixels", .heavy = true, .scene = {.b = 0.01},
         .desc = {.width = 8192, .height = 8192, .supersample = 1}),
    CASE("images", "8192 x 8192 pixels of 4 x 4 samples", .scene = {.b = 0.01},
         .desc = {.width = 8192, .height = 8192, .supersample = 4}, .refused = ABBE_UNSUPPORTED,
         .reason = "use fewer samples", .by_device = true),
    CASE("images", "8193 pixels", .desc = {.width = 8193}, .refused = ABBE_INVALID_ARGUMENT,
         .reason = "1 to 8192"),
};
const size_t extreme_count = sizeof extremes / sizeof *extremes;
