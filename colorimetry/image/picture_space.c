#include "colorimetry/image/picture_space.h"

#include "colorimetry/image/rgb_encoding.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

static bool is_stated(const double xy[8]) {
  for (int i = 0; i < 8; i++)
    if (xy[i] != 0) return true;
  return false;
}

static abbe_result find_observer(const abbe_image *image, const char *name, abbe_observer *out,
                                 abbe_error *error) {
  const char *word = abbe_image_attribute_text(image, "abbe:observer");
  *out = word != NULL ? abbe_observer_find(word) : ABBE_OBSERVER_CIE_1931;
  if (*out != ABBE_OBSERVER_COUNT) return ABBE_OK;
  return abbe_error_set(error, ABBE_COLOUR,
                        "%s: its attribute abbe:observer is '%.60s', no observer that is known: "
                        "'%s' is one, and 1964 another",
                        name, word, abbe_observer_text(ABBE_OBSERVER_CIE_1931));
}

/* Scene-linear spaces of the Color Interop Forum's recommendation 03: xy of primaries and white. */
static const struct {
  const char *id;
  double xy[8];
} interop[] = {
    {"lin_ap1_scene", {0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767}},
    {"lin_ap0_scene", {0.7347, 0.2653, 0, 1, 0.0001, -0.077, 0.32168, 0.33767}},
    {"lin_rec709_scene", {0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329}},
    {"lin_p3d65_scene", {0.68, 0.32, 0.265, 0.69, 0.15, 0.06, 0.3127, 0.329}},
    {"lin_rec2020_scene", {0.708, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.329}},
    {"lin_adobergb_scene", {0.64, 0.33, 0.21, 0.71, 0.15, 0.06, 0.3127, 0.329}},
    {"lin_ciexyzd65_scene",
     {1, 0, 0, 1, 0, 0, 1.0 / 3, 1.0 / 3}}, /* as ABBE_RGB_SPACE_XYZ has it */
};
enum { INTEROP = sizeof interop / sizeof *interop };

/* Takes an ID, or what is left of it without namespaces; NULL where it is not known. */
static const double *interop_xy(const char *id) {
  for (; id != NULL; id = strchr(id, ':') != NULL ? strchr(id, ':') + 1 : NULL)
    for (size_t i = 0; i < INTEROP; i++)
      if (strcmp(id, interop[i].id) == 0) return interop[i].xy;
  return NULL;
}

static bool are_near(const double a[8], const double b[8]) {
  for (int i = 0; i < 8; i++)
    if (!(fabs(a[i] - b[i]) <= 1e-3)) return false;
  return true;
}

const char *abbe_picture_space_id(const abbe_image *image) {
  static const char *const rgb[3] = {"R", "G", "B"};
  abbe_observer observer;
  if (find_observer(image, "", &observer, NULL) != ABBE_OK || observer != ABBE_OBSERVER_CIE_1931)
    return NULL;
  for (int k = 0; k < 3; k++)
    if (abbe_image_find_channel(image, rgb[k]) == (size_t)-1) return NULL;
  for (size_t i = 0; i < INTEROP; i++)
    if (are_near(image->xy, interop[i].xy)) return interop[i].id;
  return NULL;
}

/* The file's colorInteropID as chromaticities; *out is NULL where it has none, or "unknown". */
static abbe_result find_interop(const abbe_image *image, const char *name, const double **out,
                                abbe_error *error) {
  const char *id = abbe_image_attribute_text(image, "colorInteropID");
  *out = NULL;
  if (id == NULL || strcmp(id, "unknown") == 0) return ABBE_OK;
  if (strcmp(id, "data") == 0)
    return abbe_error_set(error, ABBE_COLOUR,
                          "%s: its colorInteropID says that its channels are data and no colours",
                          name);
  *out = interop_xy(id);
  if (*out == NULL)
    return abbe_error_set(error, ABBE_COLOUR,
                          "%s: its colorInteropID '%.60s' is no linear space that is known, such "
                          "as lin_ap1_scene or lin_rec709_scene",
                          name, id);
  if (!is_stated(image->xy) || are_near(image->xy, *out)) return ABBE_OK;
  return abbe_error_set(error, ABBE_COLOUR,
                        "%s: its colorInteropID '%.60s' and its chromaticities contradict each "
                        "other",
                        name, id);
}

abbe_result abbe_picture_space_find(const abbe_image *image, bool is_xyz, const char *name,
                                    abbe_picture_space *out, abbe_error *error) {
  *out = (abbe_picture_space){.space = is_xyz ? ABBE_RGB_SPACE_XYZ : ABBE_RGB_SPACE_COUNT};
  const double *xy = NULL;
  ABBE_TRY(find_observer(image, name, &out->observer, error));
  if (!is_xyz) ABBE_TRY(find_interop(image, name, &xy, error));
  const char *word = abbe_image_attribute_text(image, "abbe:space");
  if (xy != NULL) word = NULL; /* the ID is what other programs write last */
  for (int s = 0; out->space == ABBE_RGB_SPACE_COUNT && word && s < ABBE_RGB_SPACE_COUNT; s++)
    if (strcasecmp(word, abbe_rgb_space_name((abbe_rgb_space)s)) == 0)
      out->space = (abbe_rgb_space)s;
  if (word != NULL && out->space == ABBE_RGB_SPACE_COUNT)
    return abbe_error_set(error, ABBE_COLOUR,
                          "%s: its attribute abbe:space is '%.60s', not acescg, rec709 or xyz",
                          name, word);
  const char *stated = xy != NULL ? "colorInteropID" : "chromaticities";
  if (xy == NULL && is_stated(image->xy)) xy = image->xy;
  if (out->space == ABBE_RGB_SPACE_COUNT && xy != NULL) {
    abbe_error why = {0};
    out->space = abbe_rgb_space_of_chromaticities(xy);
    snprintf(out->text, sizeof out->text, "RGB of the file's %s", stated);
    if (abbe_rgb_space_chromaticities_to_xyz(xy, out->to_xyz, &why) != ABBE_OK)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: %.400s", name, why.text);
    if (out->space == ABBE_RGB_SPACE_COUNT) return ABBE_OK;
  }
  out->assumed = out->space == ABBE_RGB_SPACE_COUNT;
  if (out->assumed) out->space = ABBE_RGB_SPACE_REC709;
  snprintf(out->text, sizeof out->text, "%s", abbe_rgb_space_name(out->space));
  abbe_rgb_space_to_xyz(out->space, out->to_xyz);
  return ABBE_OK;
}

static double held(double value) {
  return value < 0 ? 0 : value > 1 ? 1 : value;
}

/* One and a half turns through the hues about the grey diagonal [Green2011]. */
static void cubehelix(double t, double rgb[3]) {
  const double start = 0.5, turns = -1.5, tau = 6.283185307179586;
  double angle = tau * (start / 3 + turns * t), amplitude = t * (1 - t) / 2;
  double c = amplitude * cos(angle), s = amplitude * sin(angle);
  rgb[0] = t - 0.14861 * c + 1.78277 * s;
  rgb[1] = t - 0.29227 * c - 0.90649 * s;
  rgb[2] = t + 1.97294 * c;
}

/* Inverts CIELAB's f where it is above 6/29, as all of this map is. */
static double from_lab(double f) {
  return f * f * f;
}

static double srgb_encoded(double linear) {
  return abbe_srgb_encoded(linear);
}

/* Straight in magnitude, saturation and hue of CIELAB, the hue of the ends turned on to where the
 * greys meet without a kink [Moreland2009]. */
static void cool_to_warm(double t, double rgb[3]) {
  const double middle[2] = {88, 1.061}, end[2] = {80, 1.08}, hue[2] = {-1.1, 0.5};
  int warm = t > 0.5;
  double share = fabs(2 * t - 1); /* 0 in the middle, 1 at the ends */
  double m = middle[0] + (end[0] - middle[0]) * share, s = end[1] * share;
  double h0 = warm ? middle[1] : hue[0] - (middle[1] - hue[1]);
  double h = h0 + (hue[warm] - h0) * share;
  double l = m * cos(s), a = m * sin(s) * cos(h), b = m * sin(s) * sin(h), fy = (l + 16) / 116;
  double xyz[3] = {0.95047 * from_lab(fy + a / 500), from_lab(fy),
                   1.08883 * from_lab(fy - b / 200)};
  double matrix[9];
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, matrix);
  abbe_rgb_space_apply(matrix, xyz, rgb);
  for (int i = 0; i < 3; i++) rgb[i] = srgb_encoded(rgb[i]);
}

void abbe_colour_map_at(abbe_colour_map map, double t, double rgb[3]) {
  if (isnan(t)) {
    rgb[0] = rgb[2] = 0;
    rgb[1] = 0.8;
    return;
  }
  if (map == ABBE_COLOUR_MAP_DIFFERENCE)
    cool_to_warm(held(t), rgb);
  else
    cubehelix(held(t), rgb);
  for (int i = 0; i < 3; i++) rgb[i] = held(rgb[i]);
}
