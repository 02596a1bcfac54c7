#include "scenes/volume/caustic_volume.h"

#include "base/maths.h"
#include "base/number.h"
#include "colorimetry/image/exr.h"
#include "scenes/volume/half.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT = 1024, EXITS_WIDTH = 1024 };

static const char *const vector_names[9] = {"X.x", "X.y", "X.z", "Y.x", "Y.y",
                                            "Y.z", "Z.x", "Z.y", "Z.z"};
static const char *const printed_names[3] = {"R", "G", "B"};
static const char *const exit_names[ABBE_EXIT_HALVES] = {
    "P.x",  "P.y",  "P.z",  "D.x",  "D.y",  "D.z",  "Pu.x", "Pu.y", "Pu.z",
    "Pv.x", "Pv.y", "Pv.z", "Du.x", "Du.y", "Du.z", "Dv.x", "Dv.y", "Dv.z",
    "T",    "S",    "Pn.x", "Pn.y", "Pn.z", "Dn.x", "Dn.y", "Dn.z"};
static const char vector_units[] =
    "vector irradiance F of X, Y, Z for light of 1 W/m2 across its beam and a white of Y = 1; what "
    "faces n gets -n . F; coordinates from the object's centre in m";
static const char printed_units[] =
    "bytes of light on what faces the object's centre, a share of the beam's";
static const char exit_units[] =
    "points of the surface (P place, D normal, Pu.x bin of wavelengths), node by node the exits of "
    "points that face its light (P place, D direction, u and v their change with the light, T "
    "share "
    "of light, S facets met, n the change with the index), cells' free space 26 a pixel; places "
    "from "
    "the object's centre in its radii";

static const struct {
  const char *name, *units;
  const char *const *channel;
} kinds[] = {[ABBE_VOLUME_VECTOR] = {"vector", vector_units, vector_names},
             [ABBE_VOLUME_PRINTED] = {"printed", printed_units, printed_names},
             [ABBE_VOLUME_EXITS] = {"exits", exit_units, exit_names}};

static const char *const *names_of(const abbe_caustic_volume *v) {
  return kinds[v->kind].channel;
}

static size_t channels_of(const abbe_caustic_volume *v) {
  return v->kind == ABBE_VOLUME_EXITS ? ABBE_EXIT_HALVES : abbe_caustic_volume_channels(v);
}

static size_t total_of(const abbe_caustic_volume *v) {
  if (v->kind == ABBE_VOLUME_EXITS)
    return v->exits.points + v->exits.count +
           (v->region.cells + ABBE_EXIT_HALVES - 1) / ABBE_EXIT_HALVES;
  return v->nodes.count * v->region.cells;
}

/* The half in a channel of a pixel; NULL where nothing is kept. */
static uint16_t *half_at(const abbe_caustic_volume *v, size_t pixel, size_t channel) {
  const abbe_light_exits *e = &v->exits;
  if (v->kind != ABBE_VOLUME_EXITS) return &v->value[pixel * channels_of(v) + channel];
  if (pixel < e->points) return &e->point[pixel][channel];
  pixel -= e->points;
  if (pixel < e->count) return &e->exit[pixel][channel];
  const size_t cell = (pixel - e->count) * ABBE_EXIT_HALVES + channel;
  return cell < e->cells ? &e->space[cell] : NULL;
}

/* ---- attributes ---- */

/* What an attribute says: words and numbers in turn, a number for each '#' of the pattern. */
static void join(const char *pattern, const double *number, char text[TEXT]) {
  size_t used = 0;
  for (; *pattern != '\0' && used + ABBE_NUMBER_TEXT_SIZE < TEXT; pattern++) {
    if (*pattern != '#') {
      text[used++] = *pattern;
      continue;
    }
    abbe_number_text(*number++, text + used);
    used += strlen(text + used);
  }
  text[used] = '\0';
}

/* The numbers of such a text; false where it is another, or a number is not finite. */
static bool part(const char *pattern, const char *text, double *number) {
  for (; *pattern != '\0'; pattern++) {
    if (*pattern == '#') {
      const char *end;
      if (!abbe_number_read(text, &end, number) || !isfinite(*number)) return false;
      text = end;
      number++;
    } else if (*pattern != *text++) {
      return false;
    }
  }
  return *text == '\0';
}

static const char grid_pattern[] = "grid of # cells a side, # m wide";
static const char geodesic_pattern[] = "# shells of # triangles, # to # m";
static const char octahedral_pattern[] = "# shells of # x # octahedral texels, # to # m";
static const char one_pattern[] = "1 along # # #";
static const char nodes_pattern[] = "# of a geodesic sphere";
static const char ball_pattern[] = "ball, radius # m, # vertices, # faces";
static const char body_pattern[] =
    "radius # m, # vertices, # faces; of them # at # # #, # at # # #, # at # # #";
static const char light_pattern[] = "XYZ # # #, # to # nm";
static const char number_pattern[] = "#";
static const char exits_pattern[] = "# points of # m2, # exits";

static void describe_region(const abbe_region_desc *d, char text[TEXT]) {
  const double side = (double)d->side, shells = (double)d->shells,
               faces = 20 * pow(4, (double)d->levels);
  if (d->kind == ABBE_REGION_GRID)
    join(grid_pattern, (double[]){side, 2 * d->outer}, text);
  else if (d->kind == ABBE_REGION_GEODESIC)
    join(geodesic_pattern, (double[]){shells, faces, d->inner, d->outer}, text);
  else
    join(octahedral_pattern, (double[]){shells, side, side, d->inner, d->outer}, text);
}

static void describe_body(const abbe_volume_body *b, char text[TEXT]) {
  double n[15] = {b->radius, (double)b->vertices, (double)b->faces};
  for (int a = 0; a < 3; a++) {
    n[3 + 4 * a] = (double)b->anchor[a];
    memcpy(&n[4 + 4 * a], b->anchor_at[a], sizeof b->anchor_at[a]);
  }
  join(b->ball ? ball_pattern : body_pattern, n, text);
}

static abbe_result write_attributes(const abbe_caustic_volume *v, abbe_image *image,
                                    abbe_error *error) {
  const bool printed = v->kind == ABBE_VOLUME_PRINTED, exits = v->kind == ABBE_VOLUME_EXITS;
  char region[TEXT], nodes[TEXT], body[TEXT], light[TEXT], byte[TEXT], spread[TEXT], points[TEXT];
  const double *axis = v->nodes.direction[0];
  describe_region(&v->region.desc, region);
  describe_body(&v->body, body);
  if (v->nodes.count == 1)
    join(one_pattern, axis, nodes);
  else
    join(nodes_pattern, (double[]){(double)v->nodes.count}, nodes);
  join(light_pattern, (double[]){v->white[0], v->white[1], v->white[2], v->min_nm, v->max_nm},
       light);
  join(number_pattern, &v->byte, byte);
  join(exits_pattern, (double[]){(double)v->exits.points, v->exits.area, (double)v->exits.count},
       points);
  join(number_pattern, &v->error, spread);
  const char *const all[][2] = {
      {"abbe:volume", kinds[v->kind].name},
      {"abbe:volume_region", region},
      {"abbe:volume_nodes", nodes},
      {"abbe:volume_object", v->body.name},
      {"abbe:volume_material", v->body.material},
      {"abbe:volume_body", body},
      {"abbe:volume_light", light},
      {"abbe:volume_error", spread},
      {"abbe:volume_units", kinds[v->kind].units},
      {exits ? "abbe:volume_exits" : "abbe:volume_byte", exits ? points : byte}};
  const size_t count = sizeof all / sizeof *all - (printed || exits ? 0 : 1);
  for (size_t i = 0; i < count; i++)
    ABBE_TRY(abbe_image_set_attribute(image, all[i][0], all[i][1], error));
  return ABBE_OK;
}

/* Nine numbers a map. */
static abbe_result write_maps(const abbe_body_symmetry *s, abbe_image *image, abbe_error *error) {
  ABBE_FREED char *text = malloc(s->count * 9 * (ABBE_NUMBER_TEXT_SIZE + 1) + 1);
  size_t used = 0;
  if (text == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu maps", s->count);
  for (size_t i = 0; i < 9 * s->count; i++) {
    if (i > 0) text[used++] = ' ';
    abbe_number_text(s->map[i / 9][i % 9], text + used);
    used += strlen(text + used);
  }
  return abbe_image_set_attribute(image, "abbe:volume_symmetry", text, error);
}

/* ---- writing ---- */

abbe_result abbe_volume_file_write(const char *path, const abbe_caustic_volume *v,
                                   abbe_error *error) {
  if (v->value == NULL && v->exits.points == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: the volume has no values", path);
  const size_t total = total_of(v), channels = channels_of(v);
  /* whole rows of cells, as far as they fit */
  size_t width = v->kind == ABBE_VOLUME_EXITS ? EXITS_WIDTH : v->region.row;
  while (width > ABBE_IMAGE_MAX_SIDE) width = (width + 3) / 4;
  width *= total / width / ABBE_IMAGE_MAX_SIDE + 1;
  if (width > ABBE_IMAGE_MAX_SIDE) width = ABBE_IMAGE_MAX_SIDE;
  const size_t height = (total + width - 1) / width;
  if (height > ABBE_IMAGE_MAX_SIDE)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: %zu nodes of %zu cells are more than a picture has pixels", path,
                          v->nodes.count, v->region.cells);
  ABBE_OWNED(abbe_image, image) = {0};
  ABBE_TRY(abbe_image_make(width, height, channels, names_of(v), &image, error));
  for (size_t i = 0; i < total * channels; i++) {
    const uint16_t *half = half_at(v, i / channels, i % channels);
    image.data[i] = half != NULL ? (float)abbe_half_value(*half) : 0;
  }
  ABBE_TRY(write_attributes(v, &image, error));
  if (v->kind == ABBE_VOLUME_EXITS) ABBE_TRY(write_maps(&v->exits.symmetry, &image, error));
  return abbe_exr_write_half(path, &image, error);
}

/* ---- reading ---- */

static bool is_count(double x, double most) {
  return x >= 0 && x <= most && x == floor(x);
}

static bool read_region(const char *text, abbe_region_desc *out) {
  double n[5];
  *out = (abbe_region_desc){0};
  if (part(grid_pattern, text, n)) {
    *out = (abbe_region_desc){.kind = ABBE_REGION_GRID, .outer = n[1] / 2};
    out->side = is_count(n[0], ABBE_REGION_MOST_SIDE) ? (size_t)n[0] : 0;
    return out->side > 0;
  }
  if (part(octahedral_pattern, text, n)) {
    if (!is_count(n[0], ABBE_REGION_MOST_SHELLS) || !is_count(n[1], ABBE_REGION_MOST_SIDE) ||
        n[1] != n[2])
      return false;
    *out = (abbe_region_desc){.kind = ABBE_REGION_OCTAHEDRAL,
                              .side = (size_t)n[1],
                              .shells = (size_t)n[0],
                              .inner = n[3],
                              .outer = n[4]};
    return true;
  }
  if (!part(geodesic_pattern, text, n) || !is_count(n[0], ABBE_REGION_MOST_SHELLS)) return false;
  *out = (abbe_region_desc){
      .kind = ABBE_REGION_GEODESIC, .shells = (size_t)n[0], .inner = n[2], .outer = n[3]};
  double faces = 20;
  for (; faces < n[1] && out->levels < ABBE_SPHERE_MESH_MOST_LEVELS; faces *= 4) out->levels++;
  return faces == n[1];
}

static bool read_body(const char *text, abbe_volume_body *b) {
  double n[15] = {0};
  b->ball = part(ball_pattern, text, n);
  if (!b->ball && !part(body_pattern, text, n)) return false;
  const double most = 1e9;
  if (!(n[0] > 0) || !is_count(n[1], most) || !is_count(n[2], most)) return false;
  b->radius = n[0];
  b->vertices = (size_t)n[1];
  b->faces = (size_t)n[2];
  for (int a = 0; a < 3 && !b->ball; a++) {
    if (!is_count(n[3 + 4 * a], n[1] - 1)) return false;
    b->anchor[a] = (size_t)n[3 + 4 * a];
    memcpy(b->anchor_at[a], &n[4 + 4 * a], sizeof b->anchor_at[a]);
  }
  double across[3];
  abbe_vector_cross(b->anchor_at[0], b->anchor_at[1], across);
  return b->ball || abbe_vector_length(across) > 1e-9 * b->radius * b->radius;
}

/* nodes: how many, and of one its direction. */
static bool read_nodes(const char *text, double nodes[4]) {
  nodes[0] = 1;
  return part(one_pattern, text, nodes + 1) ||
         (part(nodes_pattern, text, nodes) && is_count(nodes[0], ABBE_LIGHT_NODES_MOST));
}

static bool read_light(const char *text, abbe_caustic_volume *v) {
  double n[5];
  if (!part(light_pattern, text, n) || !(n[3] > 0) || !(n[3] < n[4])) return false;
  memcpy(v->white, n, sizeof v->white);
  v->min_nm = n[3];
  v->max_nm = n[4];
  return true;
}

static abbe_result broken(const char *path, const char *name, const char *text, abbe_error *error) {
  return abbe_error_set(error, ABBE_PARSE,
                        "%s: the attribute %s, '%.80s', is none that 'abbe volume' writes", path,
                        name, text != NULL ? text : "missing");
}

static abbe_result read_attributes(const char *path, const abbe_image *image,
                                   abbe_caustic_volume *v, abbe_region_desc *region,
                                   double nodes[4], abbe_error *error) {
  static const char *const names[] = {
      "abbe:volume",       "abbe:volume_region", "abbe:volume_nodes",    "abbe:volume_body",
      "abbe:volume_light", "abbe:volume_object", "abbe:volume_material", "abbe:volume_error",
      "abbe:volume_byte",  "abbe:volume_exits"};
  const char *text[10];
  for (size_t i = 0; i < 10; i++) {
    text[i] = abbe_image_attribute_text(image, names[i]);
    if (text[i] == NULL && i == 0)
      return abbe_error_set(error, ABBE_NOT_FOUND,
                            "%s: there is no attribute abbe:volume, so it is no caustic volume; "
                            "'abbe volume' makes one",
                            path);
    if (text[i] == NULL && i < 8) return broken(path, names[i], NULL, error);
  }
  const bool printed = strcmp(text[0], "printed") == 0;
  const bool exits = strcmp(text[0], "exits") == 0;
  v->kind = printed ? ABBE_VOLUME_PRINTED : exits ? ABBE_VOLUME_EXITS : ABBE_VOLUME_VECTOR;
  if (!printed && !exits && strcmp(text[0], "vector") != 0)
    return broken(path, names[0], text[0], error);
  if (!read_region(text[1], region)) return broken(path, names[1], text[1], error);
  if (!read_nodes(text[2], nodes)) return broken(path, names[2], text[2], error);
  if (!read_body(text[3], &v->body)) return broken(path, names[3], text[3], error);
  if (!read_light(text[4], v)) return broken(path, names[4], text[4], error);
  snprintf(v->body.name, sizeof v->body.name, "%s", text[5]);
  snprintf(v->body.material, sizeof v->body.material, "%s", text[6]);
  if (!part(number_pattern, text[7], &v->error)) return broken(path, names[7], text[7], error);
  if (printed && (text[8] == NULL || !part(number_pattern, text[8], &v->byte) || !(v->byte > 0)))
    return broken(path, names[8], text[8], error);
  double n[3] = {0};
  if (exits && (text[9] == NULL || !part(exits_pattern, text[9], n) ||
                !is_count(n[0], ABBE_LIGHT_EXITS_MOST) || n[0] < 1 || !(n[1] > 0) ||
                !is_count(n[2], ABBE_LIGHT_EXITS_MOST_EXITS)))
    return broken(path, names[9], text[9], error);
  v->exits.points = (size_t)n[0];
  v->exits.area = n[1];
  v->exits.count = (size_t)n[2];
  return ABBE_OK;
}

/* Where channels of those names lie in the picture's pixels. */
static abbe_result find_channels(const char *path, const abbe_image *image,
                                 const abbe_caustic_volume *v, size_t *from, abbe_error *error) {
  const size_t channels = channels_of(v);
  if (image->channels != channels)
    return abbe_error_set(error, ABBE_PARSE, "%s: %zu channels; its attributes ask for %zu", path,
                          image->channels, channels);
  for (size_t c = 0; c < channels; c++) {
    from[c] = abbe_image_find_channel(image, names_of(v)[c]);
    if (from[c] == (size_t)-1)
      return abbe_error_set(error, ABBE_PARSE, "%s: there is no channel %s", path, names_of(v)[c]);
  }
  return ABBE_OK;
}

static abbe_result read_maps(const char *path, const abbe_image *image, abbe_body_symmetry *out,
                             abbe_error *error) {
  static const char name[] = "abbe:volume_symmetry";
  const char *text = abbe_image_attribute_text(image, name), *at = text;
  double(*map)[9] = malloc(ABBE_BODY_SYMMETRY_MOST * sizeof *map);
  if (map == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for maps");
  size_t count = 0;
  bool good = text != NULL;
  for (; good && *at != '\0' && count < 9 * ABBE_BODY_SYMMETRY_MOST; count++) {
    const char *end;
    good = abbe_number_read(at, &end, &map[count / 9][count % 9]);
    at = good && *end == ' ' ? end + 1 : end;
  }
  good = good && *at == '\0' && count % 9 == 0 &&
         abbe_body_symmetry_make(count / 9, (const double(*)[9])map, out, NULL) == ABBE_OK;
  free(map);
  return good ? ABBE_OK : broken(path, name, text, error);
}

/* A table for the points that the picture begins with. */
static abbe_result read_points(const char *path, const abbe_image *image, const size_t *from,
                               abbe_caustic_volume *v, abbe_error *error) {
  const size_t points = v->exits.points, count = v->exits.count, channels = image->channels;
  const double area = v->exits.area;
  v->exits = (abbe_light_exits){0};
  if (image->width * image->height < points)
    return abbe_error_set(error, ABBE_PARSE, "%s: %zu pixels for %zu points", path,
                          image->width * image->height, points);
  abbe_exit_halves *half = calloc(points, sizeof *half);
  if (half == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu points", points);
  for (size_t i = 0; i < points; i++)
    for (size_t c = 0; c < ABBE_EXIT_HALVES; c++)
      half[i][c] = abbe_half_of((double)image->data[i * channels + from[c]]);
  abbe_error why = {0};
  abbe_body_symmetry symmetry = {0};
  abbe_result result = read_maps(path, image, &symmetry, error);
  if (result != ABBE_OK) {
    free(half);
    return result;
  }
  result = abbe_light_exits_make(&v->nodes, points, (const abbe_exit_halves *)half, &symmetry,
                                 v->body.radius, area, v->region.cells, &v->exits, &why);
  abbe_body_symmetry_free(&symmetry);
  free(half);
  if (result == ABBE_OK && v->exits.count != count)
    return abbe_error_set(
        error, ABBE_PARSE,
        "%s: %zu exits are those of %zu points and %zu nodes; its attributes say %zu", path,
        v->exits.count, points, v->nodes.count, count);
  if (result == ABBE_OK) return ABBE_OK;
  return abbe_error_set(error, result == ABBE_INVALID_ARGUMENT ? ABBE_PARSE : result, "%s: %s",
                        path, why.text);
}

/* Channels lie in a file by name. */
static abbe_result take_values(const char *path, const abbe_image *image, abbe_caustic_volume *v,
                               abbe_error *error) {
  const size_t channels = channels_of(v), pixels = image->width * image->height;
  size_t from[ABBE_EXIT_HALVES];
  ABBE_TRY(find_channels(path, image, v, from, error));
  if (v->kind == ABBE_VOLUME_EXITS) /* these give the number of exits */
    ABBE_TRY(read_points(path, image, from, v, error));
  const size_t total = total_of(v);
  if (pixels < total || pixels - total >= image->width)
    return abbe_error_set(error, ABBE_PARSE, "%s: %zu pixels; its attributes ask for %zu", path,
                          pixels, total);
  if (v->kind != ABBE_VOLUME_EXITS) ABBE_TRY(abbe_caustic_volume_allocate(v, error));
  for (size_t i = 0; i < total * channels; i++) {
    const size_t c = i % channels;
    const double x = (double)image->data[i - c + from[c]];
    const bool byte = x >= 0 && x <= 255 && x == floor(x);
    if (!isfinite(x) || fabs(x) > 65504 || (v->kind == ABBE_VOLUME_PRINTED && !byte))
      return abbe_error_set(error, ABBE_PARSE, "%s: channel %s has a value of %g", path,
                            names_of(v)[c], x);
    uint16_t *half = half_at(v, i / channels, c);
    if (half != NULL) *half = abbe_half_of(x);
  }
  return ABBE_OK;
}

abbe_result abbe_volume_file_read(const char *path, abbe_caustic_volume *out, abbe_error *error) {
  *out = (abbe_caustic_volume){0};
  abbe_image image = {0};
  abbe_region_desc region;
  double nodes[4];
  abbe_error why = {0};
  ABBE_TRY(abbe_exr_read(path, &image, error));
  abbe_result result = read_attributes(path, &image, out, &region, nodes, error);
  if (result == ABBE_OK) {
    result = abbe_volume_region_make(&region, &out->region, &why);
    if (result == ABBE_OK)
      result = abbe_light_nodes_make((size_t)nodes[0], nodes + 1, &out->nodes, &why);
    if (result != ABBE_OK)
      result = abbe_error_set(error, result == ABBE_INVALID_ARGUMENT ? ABBE_PARSE : result,
                              "%s: %s", path, why.text);
  }
  if (result == ABBE_OK) result = take_values(path, &image, out, error);
  abbe_image_free(&image);
  if (result != ABBE_OK) abbe_caustic_volume_free(out);
  return result;
}
