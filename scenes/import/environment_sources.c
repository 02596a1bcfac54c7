#include "base/maths.h"

#include "colorimetry/image/exr.h"
#include "colorimetry/upsampling.h"
#include "scenes/environment/environment_source.h"
#include "scenes/import/scene_reading.h"
#include "scenes/import/scene_value.h"

#include <stdlib.h>
#include <string.h>

enum { LEAST_SIZE = 64, MOST_SIZE = 4096, DEFAULT_SIZE = 1024 };

/* What no colour can be lifted under is refused where it is named. */
static abbe_result read_illuminant(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                                   abbe_environment *out, abbe_error *error) {
  abbe_upsampling ignored;
  double line[ABBE_ILLUMINANT_MOST_LINES];
  ABBE_TRY(abbe_scene_value_illuminant(yaml, node, folder, &out->illuminant, &out->illuminant_path,
                                       error));
  if (abbe_illuminant_lines(&out->illuminant, line) > 0)
    return abbe_yaml_fail(yaml, abbe_yaml_get(yaml, node, "illuminant"), error,
                          "'illuminant': surroundings have no light of lines; lights may have it");
  abbe_result result = abbe_upsampling_make(&out->illuminant, ABBE_WAVELENGTH_MIN_NM,
                                            ABBE_WAVELENGTH_MAX_NM, &ignored, error);
  const abbe_yaml_node at = abbe_yaml_get(yaml, node, "illuminant");
  return result == ABBE_OK ? result : abbe_scene_value_locate(yaml, at, result, error);
}

static abbe_result read_turn(abbe_yaml *yaml, abbe_yaml_node node, double to_map[9],
                             abbe_error *error) {
  const abbe_yaml_node tilt = abbe_yaml_get(yaml, node, "tilt");
  double rotate = 0, axis[3] = {0}, angle = 0;
  abbe_yaml_node ignored;
  ABBE_TRY(abbe_yaml_get_number(yaml, node, "rotate", -3600, 3600, &rotate, error));
  if (tilt.id) {
    if (!abbe_yaml_is_mapping(yaml, tilt))
      return abbe_yaml_fail(yaml, tilt, error, "'tilt' wants {axis: [x, y, z], angle: degrees}");
    ABBE_TRY(abbe_scene_value_point(yaml, tilt, "axis", axis, error));
    ABBE_TRY(abbe_yaml_require(yaml, tilt, "angle", &ignored, error));
    ABBE_TRY(abbe_yaml_get_number(yaml, tilt, "angle", -3600, 3600, &angle, error));
    ABBE_TRY(abbe_yaml_check_keys(yaml, tilt, "'tilt'", error));
    if (!abbe_vector_normalise(axis))
      return abbe_yaml_fail(yaml, tilt, error, "'axis' is zero; it must point somewhere");
  }
  abbe_environment_turn(rotate * ABBE_DEGREE, tilt.id ? axis : NULL, angle * ABBE_DEGREE, to_map);
  return ABBE_OK;
}

static abbe_result read_picture(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                                abbe_environment *out, abbe_error *error) {
  static const char *const layouts[] = {"latlong", "cube", NULL};
  const abbe_yaml_node file = abbe_yaml_get(yaml, node, "file");
  const abbe_yaml_node size = abbe_yaml_get(yaml, node, "size");
  const bool stated = abbe_yaml_get(yaml, node, "layout").id != 0;
  char *name = NULL;
  int layout = 0;
  if (size.id)
    return abbe_yaml_fail(yaml, size, error,
                          "'size' is for surroundings that are computed; a picture has its own");
  abbe_result result = abbe_yaml_get_string(yaml, node, "file", &name, error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_choice(yaml, node, "layout", layouts, &layout, error);
  if (result == ABBE_OK) {
    out->path = abbe_scene_value_path(folder, name);
    result = out->path ? abbe_environment_picture_read(out->path,
                                                       !stated       ? ABBE_LAYOUT_BY_ASPECT
                                                       : layout == 0 ? ABBE_LAYOUT_LATLONG
                                                                     : ABBE_LAYOUT_CUBE,
                                                       &out->map, error)
                       : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
    if (result != ABBE_OK) abbe_scene_value_locate(yaml, file, result, error);
    if (out->path != NULL) out->path[abbe_exr_file_length(out->path)] = '\0';
  }
  free(name);
  return result;
}

/* The map of what is computed, black at first. */
static abbe_result read_size(abbe_yaml *yaml, abbe_yaml_node node, abbe_environment *out,
                             abbe_error *error) {
  const abbe_yaml_node layout = abbe_yaml_get(yaml, node, "layout");
  size_t size = DEFAULT_SIZE;
  if (layout.id)
    return abbe_yaml_fail(yaml, layout, error, "'layout' says nothing without a 'file'");
  ABBE_TRY(abbe_yaml_get_count(yaml, node, "size", LEAST_SIZE, MOST_SIZE, &size, error));
  if (size % 2 != 0)
    return abbe_yaml_fail(yaml, abbe_yaml_get(yaml, node, "size"), error,
                          "'size' is the map's width in texels, an even number");
  return abbe_radiance_map_make(size, &out->map, error);
}

static abbe_result read_scale(abbe_yaml *yaml, abbe_yaml_node node, abbe_radiance_map *map,
                              abbe_error *error) {
  double scale = 1;
  ABBE_TRY(abbe_yaml_get_number(yaml, node, "scale", 1e-12, ABBE_SCENE_BRIGHTEST, &scale, error));
  for (size_t i = 0; scale != 1 && i < 3 * map->width * map->height; i++)
    map->rgb[i] = (float)((double)map->rgb[i] * scale);
  return ABBE_OK;
}

enum { MAX_KNOTS = 1024, COSINE_KNOTS = 181 };

typedef struct reading {
  abbe_yaml *yaml;
  abbe_radiance_map *map;
  size_t count; /* number of sources */
  bool has_sun;
  abbe_environment_source sun; /* where it stands, for the sky */
} reading;

static abbe_result add(reading *r, abbe_yaml_node node, const abbe_environment_source *source,
                       abbe_error *error) {
  const abbe_result result = abbe_environment_source_add(source, r->map, error);
  if (result != ABBE_OK) return abbe_scene_value_locate(r->yaml, node, result, error);
  r->count++;
  return ABBE_OK;
}

/* --- values --- */

/* A number, or one for each of red, green and blue. */
static abbe_result read_colour(const abbe_yaml *yaml, abbe_yaml_node node, const char *what,
                               double out[3], abbe_error *error) {
  const bool list = abbe_yaml_is_sequence(yaml, node);
  if (list && abbe_yaml_count(yaml, node) != 3)
    return abbe_yaml_fail(yaml, node, error, "'%s' wants a number or [red, green, blue]", what);
  for (size_t k = 0; k < (list ? 3 : 1); k++)
    ABBE_TRY(abbe_yaml_number(yaml, list ? abbe_yaml_item(yaml, node, k) : node, what, 0,
                              ABBE_SCENE_BRIGHTEST, &out[k], error));
  if (!list) out[1] = out[2] = out[0];
  return ABBE_OK;
}

static abbe_result require_colour(const reading *r, abbe_yaml_node node, const char *key,
                                  double out[3], abbe_error *error) {
  abbe_yaml_node value;
  ABBE_TRY(abbe_yaml_require(r->yaml, node, key, &value, error));
  return read_colour(r->yaml, value, key, out, error);
}

/* Degrees, as radians; an absent key leaves *out. */
static abbe_result read_angle(const reading *r, abbe_yaml_node node, const char *key, double least,
                              double most, double *out, abbe_error *error) {
  double degrees = *out / ABBE_DEGREE;
  ABBE_TRY(abbe_yaml_get_number(r->yaml, node, key, least, most, &degrees, error));
  *out = degrees * ABBE_DEGREE;
  return ABBE_OK;
}

static abbe_result require_angle(const reading *r, abbe_yaml_node node, const char *key,
                                 double least, double most, double *out, abbe_error *error) {
  abbe_yaml_node ignored;
  ABBE_TRY(abbe_yaml_require(r->yaml, node, key, &ignored, error));
  return read_angle(r, node, key, least, most, out, error);
}

/* Where a source stands: 'elevation' and 'azimuth', or 'towards'. Up is the direction in which
 * elevation grows. *found (NULL: it must be there): whether either is given. */
static abbe_result read_place(const reading *r, abbe_yaml_node node, abbe_environment_source *out,
                              bool *found, abbe_error *error) {
  const abbe_yaml_node towards = abbe_yaml_get(r->yaml, node, "towards");
  const abbe_yaml_node elevation = abbe_yaml_get(r->yaml, node, "elevation");
  const abbe_yaml_node around = abbe_yaml_get(r->yaml, node, "azimuth");
  double up = 0, azimuth = 0;
  if (towards.id && (elevation.id || around.id))
    return abbe_yaml_fail(r->yaml, towards, error,
                          "either 'towards' or 'elevation' and 'azimuth' say where a source is");
  if (found) *found = towards.id || elevation.id;
  if (found && !*found && !around.id) return ABBE_OK;
  if (towards.id) {
    ABBE_TRY(abbe_scene_value_point(r->yaml, node, "towards", out->centre, error));
    if (!abbe_vector_normalise(out->centre))
      return abbe_yaml_fail(r->yaml, towards, error, "'towards' is zero; it must point somewhere");
    up = atan2(out->centre[2], hypot(out->centre[0], out->centre[1]));
    azimuth = atan2(out->centre[1], out->centre[0]);
  } else {
    abbe_result result = require_angle(r, node, "elevation", -90, 90, &up, error);
    if (result == ABBE_OK) result = read_angle(r, node, "azimuth", -3600, 3600, &azimuth, error);
    if (result != ABBE_OK) return result;
  }
  const double centre[3] = {cos(up) * cos(azimuth), cos(up) * sin(azimuth), sin(up)};
  const double above[3] = {-sin(up) * cos(azimuth), -sin(up) * sin(azimuth), cos(up)};
  memcpy(out->centre, centre, sizeof centre);
  memcpy(out->up, above, sizeof above);
  return ABBE_OK;
}

/* --- the sky --- */

static abbe_result read_sun(reading *r, abbe_yaml_node node, abbe_error *error) {
  abbe_environment_source *sun = &r->sun;
  double irradiance[3], diameter = 0.533 * ABBE_DEGREE;
  *sun = (abbe_environment_source){.kind = ABBE_SOURCE_DISK};
  ABBE_TRY(read_place(r, node, sun, NULL, error));
  ABBE_TRY(require_colour(r, node, "irradiance", irradiance, error));
  ABBE_TRY(read_angle(r, node, "diameter", 0.1, 90, &diameter, error));
  ABBE_TRY(abbe_yaml_check_keys(r->yaml, node, "the sun", error));
  sun->radius_rad = diameter / 2;
  for (int k = 0; k < 3; k++)
    sun->radiance[k] = abbe_environment_source_disk_radiance(irradiance[k], sun->radius_rad);
  r->has_sun = true;
  return add(r, node, sun, error);
}

static abbe_result read_sky_type(const reading *r, abbe_yaml_node node, int *out,
                                 abbe_error *error) {
  abbe_yaml_node value;
  double number = 0;
  ABBE_TRY(abbe_yaml_require(r->yaml, node, "type", &value, error));
  const char *text = abbe_yaml_text(r->yaml, value);
  *out = text && strcmp(text, "clear") == 0      ? ABBE_SKY_CLEAR
         : text && strcmp(text, "overcast") == 0 ? ABBE_SKY_OVERCAST
                                                 : 0;
  if (*out) return ABBE_OK;
  if (!text || text[0] < '0' || text[0] > '9')
    return abbe_yaml_fail(r->yaml, value, error,
                          "'type' is clear, overcast, or the number of one of the CIE's standard "
                          "skies, 1 to %d",
                          ABBE_SKY_TYPES);
  ABBE_TRY(abbe_yaml_number(r->yaml, value, "type", 1, ABBE_SKY_TYPES, &number, error));
  *out = (int)number;
  if (number != *out) return abbe_yaml_fail(r->yaml, value, error, "'type' wants a whole number");
  return ABBE_OK;
}

static abbe_result read_sky(reading *r, abbe_yaml_node node, abbe_error *error) {
  abbe_environment_source sky = {.kind = ABBE_SOURCE_SKY}, place = r->sun;
  const abbe_yaml_node zenith = abbe_yaml_get(r->yaml, node, "zenith");
  const abbe_yaml_node irradiance = abbe_yaml_get(r->yaml, node, "irradiance");
  bool found = false;
  ABBE_TRY(read_sky_type(r, node, &sky.sky.type, error));
  ABBE_TRY(read_place(r, node, &place, &found, error));
  if ((zenith.id != 0) == (irradiance.id != 0))
    return abbe_yaml_fail(r->yaml, node, error,
                          "a sky has either a 'zenith' (its radiance there) or an 'irradiance' "
                          "(on the ground); this one has %s",
                          zenith.id ? "both" : "neither");
  ABBE_TRY(require_colour(r, node, zenith.id ? "zenith" : "irradiance", sky.radiance, error));
  ABBE_TRY(abbe_yaml_check_keys(r->yaml, node, "a sky", error));
  if (abbe_sky_needs_sun(sky.sky.type) && !found && !r->has_sun)
    return abbe_yaml_fail(r->yaml, node, error,
                          "this sky is brighter about the sun: say by 'elevation' and 'azimuth' "
                          "where that is, or give the surroundings a 'sun'");
  if (abbe_sky_needs_sun(sky.sky.type) && place.centre[2] < 0)
    return abbe_yaml_fail(r->yaml, node, error, "the sun of a sky is not below the horizon");
  memcpy(sky.sky.sun, place.centre, sizeof place.centre);
  if (irradiance.id) {
    const double per_zenith = abbe_sky_horizontal(&sky.sky);
    for (int k = 0; k < 3; k++) sky.radiance[k] /= per_zenith;
  }
  return add(r, node, &sky, error);
}

/* --- small sources --- */

/* Turned about the line of sight, anticlockwise as it is seen. */
static void roll(abbe_environment_source *s, double angle) {
  double right[3], up[3];
  abbe_vector_cross(s->centre, s->up, right);
  for (int k = 0; k < 3; k++) up[k] = cos(angle) * s->up[k] - sin(angle) * right[k];
  memcpy(s->up, up, sizeof up);
}

static abbe_result read_softbox(reading *r, abbe_yaml_node node, abbe_error *error) {
  abbe_environment_source box = {.kind = ABBE_SOURCE_RECTANGLE};
  const bool disk = abbe_yaml_get(r->yaml, node, "radius").id != 0;
  const bool flat = abbe_yaml_get(r->yaml, node, "width").id ||
                    abbe_yaml_get(r->yaml, node, "height").id ||
                    abbe_yaml_get(r->yaml, node, "roll").id;
  double width = 0, height = 0, angle = 0;
  ABBE_TRY(read_place(r, node, &box, NULL, error));
  ABBE_TRY(require_colour(r, node, "radiance", box.radiance, error));
  if (disk == flat)
    return abbe_yaml_fail(r->yaml, node, error,
                          "a softbox has either a 'width' and a 'height' or a 'radius', in "
                          "degrees; this one has %s",
                          disk ? "both" : "neither");
  if (disk) {
    box.kind = ABBE_SOURCE_DISK;
    ABBE_TRY(require_angle(r, node, "radius", 0.05, 180, &box.radius_rad, error));
  } else {
    ABBE_TRY(require_angle(r, node, "width", 0.1, 170, &width, error));
    ABBE_TRY(require_angle(r, node, "height", 0.1, 170, &height, error));
    ABBE_TRY(read_angle(r, node, "roll", -360, 360, &angle, error));
    box.half_width_rad = width / 2;
    box.half_height_rad = height / 2;
    roll(&box, angle);
  }
  ABBE_TRY(abbe_yaml_check_keys(r->yaml, node, "a softbox", error));
  return add(r, node, &box, error);
}

static abbe_result read_spot(reading *r, abbe_yaml_node node, abbe_error *error) {
  abbe_environment_source spot = {.kind = ABBE_SOURCE_SPOT};
  const abbe_yaml_node solid = abbe_yaml_get(r->yaml, node, "solid_angle");
  const abbe_yaml_node sigma = abbe_yaml_get(r->yaml, node, "sigma");
  double solid_angle = 0;
  ABBE_TRY(read_place(r, node, &spot, NULL, error));
  ABBE_TRY(require_colour(r, node, "radiance", spot.radiance, error));
  if ((solid.id != 0) == (sigma.id != 0))
    return abbe_yaml_fail(r->yaml, node, error,
                          "a spot has either a 'sigma' (degrees) or a 'solid_angle' (sr); this "
                          "one has %s",
                          solid.id ? "both" : "neither");
  ABBE_TRY(read_angle(r, node, "sigma", 0.05, 60, &spot.radius_rad, error));
  ABBE_TRY(abbe_yaml_get_number(r->yaml, node, "solid_angle", 1e-5, 1, &solid_angle, error));
  ABBE_TRY(abbe_yaml_check_keys(r->yaml, node, "a spot", error));
  if (solid.id) spot.radius_rad = abbe_environment_source_spot_sigma(solid_angle);
  return add(r, node, &spot, error);
}

/* --- domes --- */

/* Green to 45 degrees, red to 75, blue above: what the faces of a stone show of the sky. */
static const abbe_dome_knot aset[] = {{0, {0, 1, 0}},
                                      {45 * ABBE_DEGREE, {0, 1, 0}},
                                      {45 * ABBE_DEGREE, {1, 0, 0}},
                                      {75 * ABBE_DEGREE, {1, 0, 0}},
                                      {75 * ABBE_DEGREE, {0, 0, 1}},
                                      {90 * ABBE_DEGREE, {0, 0, 1}}};
static const abbe_dome_knot iso[] = {{0, {1, 1, 1}}, {90 * ABBE_DEGREE, {1, 1, 1}}};

static abbe_result add_dome(reading *r, abbe_yaml_node node, const abbe_dome_knot *knot,
                            size_t count, abbe_error *error) {
  const abbe_environment_source dome = {
      .kind = ABBE_SOURCE_DOME, .radiance = {1, 1, 1}, .knot_count = count, .knot = knot};
  return add(r, node, &dome, error);
}

static abbe_result read_knots(reading *r, abbe_yaml_node node, abbe_error *error) {
  static const char wants[] = "'dome' wants iso, cos, aset, or a list of at least two [elevation, "
                              "radiance] in rising order";
  const size_t count = abbe_yaml_count(r->yaml, node);
  if (!abbe_yaml_is_sequence(r->yaml, node) || count < 2 || count > MAX_KNOTS)
    return abbe_yaml_fail(r->yaml, node, error, "%s", wants);
  abbe_dome_knot *knot = calloc(count, sizeof *knot);
  if (!knot) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a dome");
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    const abbe_yaml_node item = abbe_yaml_item(r->yaml, node, i);
    double degrees = 0;
    if (!abbe_yaml_is_sequence(r->yaml, item) || abbe_yaml_count(r->yaml, item) != 2)
      result = abbe_yaml_fail(r->yaml, item, error, "%s", wants);
    if (result == ABBE_OK)
      result = abbe_yaml_number(r->yaml, abbe_yaml_item(r->yaml, item, 0), "elevation", -90, 90,
                                &degrees, error);
    if (result == ABBE_OK)
      result = read_colour(r->yaml, abbe_yaml_item(r->yaml, item, 1), "dome", knot[i].rgb, error);
    knot[i].elevation_rad = degrees * ABBE_DEGREE;
    if (result == ABBE_OK && i > 0 && knot[i].elevation_rad < knot[i - 1].elevation_rad)
      result = abbe_yaml_fail(r->yaml, item, error, "%s", wants);
  }
  if (result == ABBE_OK) result = add_dome(r, node, knot, count, error);
  free(knot);
  return result;
}

static abbe_result read_dome(reading *r, abbe_yaml_node node, abbe_error *error) {
  const char *text = abbe_yaml_text(r->yaml, node);
  if (text && strcmp(text, "iso") == 0)
    return add_dome(r, node, iso, sizeof iso / sizeof *iso, error);
  if (text && strcmp(text, "aset") == 0)
    return add_dome(r, node, aset, sizeof aset / sizeof *aset, error);
  if (!text || strcmp(text, "cos") != 0) return read_knots(r, node, error);
  abbe_dome_knot knot[COSINE_KNOTS];
  for (int i = 0; i < COSINE_KNOTS; i++) {
    const double elevation = 90 * ABBE_DEGREE * i / (COSINE_KNOTS - 1), value = sin(elevation);
    knot[i] = (abbe_dome_knot){elevation, {value, value, value}};
  }
  return add_dome(r, node, knot, COSINE_KNOTS, error);
}

/* --- all --- */

static abbe_result read_list(reading *r, abbe_yaml_node node, const char *key,
                             abbe_result (*read)(reading *, abbe_yaml_node, abbe_error *),
                             abbe_error *error) {
  const abbe_yaml_node list = abbe_yaml_get(r->yaml, node, key);
  const size_t count = abbe_yaml_count(r->yaml, list);
  if (!list.id) return ABBE_OK;
  if (!abbe_yaml_is_sequence(r->yaml, list) || count > ABBE_ENVIRONMENT_MAX_SOURCES)
    return abbe_yaml_fail(r->yaml, list, error, "'%s' wants a list of at most %d", key,
                          ABBE_ENVIRONMENT_MAX_SOURCES);
  for (size_t i = 0; i < count; i++) {
    const abbe_yaml_node item = abbe_yaml_item(r->yaml, list, i);
    ABBE_TRY(abbe_yaml_is_mapping(r->yaml, item)
                 ? read(r, item, error)
                 : abbe_yaml_fail(r->yaml, item, error,
                                  "an entry of '%s' must be a mapping (key: value)", key));
  }
  return ABBE_OK;
}

static abbe_result read_one(reading *r, abbe_yaml_node node, const char *key,
                            abbe_result (*read)(reading *, abbe_yaml_node, abbe_error *),
                            abbe_error *error) {
  const abbe_yaml_node value = abbe_yaml_get(r->yaml, node, key);
  if (!value.id) return ABBE_OK;
  if (!abbe_yaml_is_mapping(r->yaml, value))
    return abbe_yaml_fail(r->yaml, value, error, "'%s' must be a mapping (key: value)", key);
  return read(r, value, error);
}

/* Adds the sources that the node's keys name (uniform, sky, sun, softboxes, spots, dome) to the
 * map; *count says how many there were. */
static abbe_result environment_read_sources(abbe_yaml *yaml, abbe_yaml_node node,
                                            abbe_radiance_map *map, size_t *count,
                                            abbe_error *error) {
  reading r = {.yaml = yaml, .map = map};
  const abbe_yaml_node uniform = abbe_yaml_get(yaml, node, "uniform");
  const abbe_yaml_node dome = abbe_yaml_get(yaml, node, "dome");
  abbe_environment_source even = {.kind = ABBE_SOURCE_UNIFORM};
  abbe_result result = ABBE_OK;
  if (uniform.id) {
    result = read_colour(yaml, uniform, "uniform", even.radiance, error);
    if (result == ABBE_OK) result = add(&r, uniform, &even, error);
  }
  if (result == ABBE_OK && dome.id) result = read_dome(&r, dome, error);
  if (result == ABBE_OK) result = read_one(&r, node, "sun", read_sun, error);
  if (result == ABBE_OK) result = read_one(&r, node, "sky", read_sky, error);
  if (result == ABBE_OK) result = read_list(&r, node, "softboxes", read_softbox, error);
  if (result == ABBE_OK) result = read_list(&r, node, "spots", read_spot, error);
  *count = r.count;
  return result;
}

abbe_result abbe_environment_read(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                                  abbe_environment *out, abbe_error *error) {
  size_t sources = 0;
  if (!abbe_yaml_is_mapping(yaml, node))
    return abbe_yaml_fail(yaml, node, error, "'environment' must be a mapping (key: value)");
  const bool file = abbe_yaml_get(yaml, node, "file").id != 0;
  abbe_result result = read_turn(yaml, node, out->to_map, error);
  if (result == ABBE_OK) result = read_illuminant(yaml, node, folder, out, error);
  if (result == ABBE_OK)
    result =
        file ? read_picture(yaml, node, folder, out, error) : read_size(yaml, node, out, error);
  if (result == ABBE_OK) result = environment_read_sources(yaml, node, &out->map, &sources, error);
  if (result == ABBE_OK) result = read_scale(yaml, node, &out->map, error);
  if (result == ABBE_OK) result = abbe_yaml_check_keys(yaml, node, "'environment'", error);
  if (result == ABBE_OK && !file && sources == 0)
    result = abbe_yaml_fail(yaml, node, error,
                            "'environment' has no light: give it a 'file', or one or more of "
                            "uniform, sky, sun, softboxes, spots, dome");
  if (result != ABBE_OK) return result;
  result = abbe_environment_prepare(out, error);
  return result == ABBE_OK ? result : abbe_scene_value_locate(yaml, node, result, error);
}
