/* method_facts.h: the methods of caustics that Abbe draws by, each with what it does otherwise than
 * Abbe's own and what it takes where a request leaves it open. What a method knows is found here
 * nobody outside gl/methods tests which one it is. It makes nothing.
 *
 * A published method goes by its own constants, and its profile in units (-cie) by the default
 * profile's wavelengths, CIE weights, indices, Fresnel's law and units. wyman2003 looks caustics up
 * in a printed volume; all else is the default profile's, as is its counterpart: the transport
 * 'volume'.
 */
#ifndef ABBE_GL_METHODS_FACTS_METHOD_FACTS_H
#define ABBE_GL_METHODS_FACTS_METHOD_FACTS_H

#include "scenes/view/estimator.h"
#include "scenes/volume/caustic_volume.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_PROFILES(X)                                                                           \
  X(DEFAULT, "default")                                                                            \
  X(THESIS, "thesis")                                                                              \
  X(THESIS_CIE, "thesis-cie")                                                                      \
  X(SHAH2007, "shah2007")                                                                          \
  X(SHAH2007_CIE, "shah2007-cie")                                                                  \
  X(WYMAN2006, "wyman2006")                                                                        \
  X(WYMAN2006_CIE, "wyman2006-cie") X(WYMAN2003, "wyman2003") X(WAND2003, "wand2003")
typedef enum abbe_profile {
#define ABBE_PROFILE_ENUM(code, name) ABBE_PROFILE_##code,
  ABBE_PROFILES(ABBE_PROFILE_ENUM)
#undef ABBE_PROFILE_ENUM
      ABBE_PROFILE_COUNT
} abbe_profile;

/* bridge: light is laid between neighbouring wavelengths' hits; none: each wavelength lands
 * on its own; smear: the thesis's 20-step fill; of wyman2006, in the camera's image points, quads
 * or triangles of neighbouring photons or a gather, or a gather in the light's. AUTO is bridge,
 * smear in the thesis profile, gather-light in wyman2006, whose none is points. */
#define ABBE_FILLS(X)                                                                              \
  X(AUTO, "auto")                                                                                  \
  X(NONE, "none")                                                                                  \
  X(BRIDGE, "bridge")                                                                              \
  X(SMEAR, "smear")                                                                                \
  X(POINTS, "points")                                                                              \
  X(QUADS, "quads")                                                                                \
  X(TRIANGLES, "triangles") X(GATHER_EYE, "gather-eye") X(GATHER_LIGHT, "gather-light")
typedef enum abbe_fill {
#define ABBE_FILL_ENUM(code, name) ABBE_FILL_##code,
  ABBE_FILLS(ABBE_FILL_ENUM)
#undef ABBE_FILL_ENUM
      ABBE_FILL_COUNT
} abbe_fill;

/* The direction by which wyman2006 shades caustics: photons' own, their mean in a pixel, the direct
 * light's. AUTO is mean; in units direct, which there is exact. */
#define ABBE_DIRECTIONS(X) X(AUTO, "auto") X(OWN, "own") X(MEAN, "mean") X(DIRECT, "direct")
typedef enum abbe_direction {
#define ABBE_DIRECTION_ENUM(code, name) ABBE_DIRECTION_##code,
  ABBE_DIRECTIONS(ABBE_DIRECTION_ENUM)
#undef ABBE_DIRECTION_ENUM
      ABBE_DIRECTION_COUNT
} abbe_direction;

/* What wyman2006 does otherwise with quads and triangles, bits of a request. even: as printed,
 * beams have the light of one photon of the field each, not that of their solid angle; corners:
 * light by corner, of all polygons around it, not by polygon; culled: polygons between surfaces are
 * left out; in-light: they are drawn into the light's image, which the light then projects. */
#define ABBE_POLYGONS(X)                                                                           \
  X(EVEN, "even", 1) X(CORNERS, "corners", 2) X(CULLED, "culled", 4) X(IN_LIGHT, "in-light", 8)
enum {
#define ABBE_POLYGONS_ENUM(code, name, bit) ABBE_POLYGONS_##code = (bit),
  ABBE_POLYGONS(ABBE_POLYGONS_ENUM)
#undef ABBE_POLYGONS_ENUM
      ABBE_POLYGONS_ALL = 15
};

/* How caustics come to receivers: by photons; looked up in a volume that was computed beforehand
 * (scenes/volume/caustic_volume.h); or those of what stands out of surroundings by photons, and
 * those of the rest through samples of mirrors and refractors as pinholes. AUTO: in a volume where
 * one is given, by pinholes in wand2003 and where the plan finds soft light to shade. */
#define ABBE_TRANSPORTS(X)                                                                         \
  X(AUTO, "auto") X(PHOTONS, "photons") X(VOLUME, "volume") X(PINHOLE, "pinhole")
typedef enum abbe_transport {
#define ABBE_TRANSPORT_ENUM(code, name) ABBE_TRANSPORT_##code,
  ABBE_TRANSPORTS(ABBE_TRANSPORT_ENUM)
#undef ABBE_TRANSPORT_ENUM
      ABBE_TRANSPORT_COUNT
} abbe_transport;

/* Whether a pinhole shows the surroundings as wide as its sample reflects them, by curvature. AUTO
 * is on. */
#define ABBE_FOOTPRINTS(X) X(AUTO, "auto") X(OFF, "off") X(ON, "on")
typedef enum abbe_footprint {
#define ABBE_FOOTPRINT_ENUM(code, name) ABBE_FOOTPRINT_##code,
  ABBE_FOOTPRINTS(ABBE_FOOTPRINT_ENUM)
#undef ABBE_FOOTPRINT_ENUM
      ABBE_FOOTPRINT_COUNT
} abbe_footprint;

/* What a profile's method does. A count, range or choice of 0 leaves it to the default profile. */
typedef struct abbe_method_facts {
  const char *says;       /* for a list: what it is */
  const char *called;     /* its name in a sentence */
  bool own_passes;        /* it is published, with passes of its own: all in images, of one light */
  bool printed;           /* by its own constants: display brightness, no units */
  bool reflects_spectra;  /* receivers reflect spectra, not colours of the working space */
  bool presets;           /* presets and choices by error or time may use it */
  bool lamp, directional; /* own passes look from one light; that may be a parallel one */
  bool surroundings;      /* its light is an environment's alone, all of it through pinholes */
  bool mirrors, materials; /* it knows mirrors; several materials */
  bool estimates;          /* an estimator brings rays to receivers; photons are pixels of a view */
  bool low_pass;           /* its map may be smoothed */
  bool draws_photons;      /* into images: as points, polygons or gathers, shaded by a direction */
  bool history;            /* a picture may hold frames that follow one another */
  bool printed_volume;     /* caustics are looked up in one */
  const char *pixel;       /* what each pixel of its photons' grid is; or NULL */
  unsigned fills;          /* 1 << abbe_fill, each that it knows */
  abbe_fill fill;
  size_t wavelengths, photons, map_size;
  double min_nm, max_nm;
  abbe_direction direction;
  abbe_estimator estimator;
} abbe_method_facts;

/* The facts of a method; those of the default for what is no profile. */
const abbe_method_facts *abbe_method_of(abbe_profile profile);

/* "unknown" for what is not one. */
const char *abbe_profile_name(abbe_profile profile);
const char *abbe_fill_name(abbe_fill fill);
const char *abbe_transport_name(abbe_transport transport);

#endif
