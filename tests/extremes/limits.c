#include "tests/extremes/limits.h"

#include "tests/extremes/laws.h"
#include "validation/trace/tracer/tracer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const shapes[] = {EXTREME_FLOOR EXTREME_BALL, EXTREME_FLOOR EXTREME_BRICK,
                                     EXTREME_FLOOR EXTREME_RING};
enum { SHAPES = sizeof shapes / sizeof *shapes };

static bool draw(abbe_context *context, const extreme *e, extreme_frame *out, extreme_row *row) {
  abbe_error error = {0};
  if (extreme_frame_make(context, e, out, &error) == ABBE_OK) return true;
  extreme_row_break(row, "%s", error.text);
  return false;
}

static bool same(const abbe_image *a, const abbe_image *b) {
  size_t count = a->width * a->height * a->channels;
  return count == b->width * b->height * b->channels &&
         (count == 0 || memcmp(a->data, b->data, count * sizeof *a->data) == 0);
}

/* Root mean square of the differences in Y over the mean of b. */
static double rms(const abbe_image *a, const abbe_image *b) {
  double squares = 0, sum = 0;
  for (size_t i = 0; i < a->width * a->height; i++) {
    double y = (double)b->data[i * b->channels + 1];
    squares += pow((double)a->data[i * a->channels + 1] - y, 2);
    sum += y;
  }
  double count = (double)(a->width * a->height);
  return sum > 0 ? sqrt(squares / count) / (sum / count) : INFINITY;
}

/* Draws both and compares their pictures. */
static double compare(abbe_context *context, const extreme *a, const extreme *b, bool maps,
                      bool *equal, extreme_row *row) {
  extreme_frame x, y;
  double difference = INFINITY;
  *equal = false;
  if (!draw(context, a, &x, row)) return difference;
  if (draw(context, b, &y, row)) {
    difference = maps ? rms(&x.map, &y.map) : rms(&x.picture, &y.picture);
    *equal = same(&x.map, &y.map) && same(&x.picture, &y.picture);
    extreme_frame_free(&y);
  }
  extreme_frame_free(&x);
  return difference;
}

static void want_below(const char *what, double value, double bound, extreme_row *row) {
  extreme_row_add(row, "%s%s %.1e", row->figures[0] != '\0' ? ", " : "", what, value);
  if (!(value <= bound)) extreme_row_break(row, "%s: %.3g is above %g", what, value, bound);
}

static void want_same(const char *what, bool equal, extreme_row *row) {
  extreme_row_add(row, "%s%s %s", row->figures[0] != '\0' ? ", " : "", what,
                  equal ? "to the bit" : "differs");
  if (!equal) extreme_row_break(row, "%s: not the same to the last bit", what);
}

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Draws both and compares their pictures but for the hundredth of the pixels that differ most. */
static double compare_calm(abbe_context *context, const extreme *a, const extreme *b,
                           extreme_row *row) {
  extreme_frame x, y;
  double difference = INFINITY;
  if (!draw(context, a, &x, row)) return difference;
  if (draw(context, b, &y, row)) {
    size_t count = x.picture.width * x.picture.height, kept = count - count / 100;
    double *square = calloc(count, sizeof *square), squares = 0, sum = 0;
    for (size_t i = 0; square != NULL && i < count; i++) {
      double value = (double)y.picture.data[i * y.picture.channels + 1];
      square[i] = pow((double)x.picture.data[i * x.picture.channels + 1] - value, 2);
      sum += value;
    }
    if (square != NULL) qsort(square, count, sizeof *square, by_size);
    for (size_t i = 0; square != NULL && i < kept; i++) squares += square[i];
    if (sum > 0) difference = sqrt(squares / (double)kept) / (sum / (double)count);
    free(square);
    extreme_frame_free(&y);
  }
  extreme_frame_free(&x);
  return difference;
}

/* Where n as a float is one number for all wavelengths, dispersion is gone to the last bit. At
 * B = 1e-6 n still moves by 40 of its last bits: the picture moves with the landings. Light that a
 * curved wall sends to the next one twenty times and more has no limit there: a ring doubles what
 * two rays differ by from wall to wall, so that they show different things after forty even where n
 * differs by 1e-12. Some ten pixels of the ring show such light. */
static void no_dispersion(abbe_context *context, extreme_row *row) {
  bool equal, all = true;
  double worst = 0, calm = 0;
  for (int i = 0; i < SHAPES; i++) {
    extreme none = {.scene = {.objects = shapes[i]}, .desc = {.wavelengths = 7}}, tiny = none;
    tiny.scene.b = 1e-9;
    compare(context, &tiny, &none, true, &equal, row);
    all = all && equal;
    tiny.scene.b = 1e-6;
    calm = fmax(calm, compare_calm(context, &tiny, &none, row));
    none.desc.exits = tiny.desc.exits = 7;
    worst = fmax(worst, compare(context, &tiny, &none, false, &equal, row));
  }
  want_same("B = 1e-9", all, row);
  want_below("B = 1e-6", calm, 1e-4, row);
  want_below("with few exits", worst, 1e-3, row);
}

/* Seven wavelengths of one index, and one: what differs is the rounding of their weights. */
static void one_wavelength_for_all(abbe_context *context, extreme_row *row) {
  bool equal;
  double worst = 0;
  for (int i = 0; i < SHAPES; i++) {
    extreme one = {.scene = {.objects = shapes[i]}, .desc = {.wavelengths = 1}}, many = one;
    many.desc.wavelengths = 7;
    worst = fmax(worst, compare(context, &many, &one, false, &equal, row));
  }
  want_below("7 wavelengths", worst, 1e-4, row);
}

/* Glass of air's index is not there: neither caustic nor edge of a shadow. Beyond 2e-6 it is drawn,
 * and its shadow is filled by the map to the width of a photon's cell along its rim: of the 2304
 * pixels some 20 lie along it, each off by half its light at the most, which is 0.05 of the mean.
 */
static void no_refraction(abbe_context *context, extreme_row *row) {
  static const double index[] = {1 - 1e-6, 1, 1 + 1e-7, 1 + 1e-6};
  const extreme empty = {.scene = {.objects = EXTREME_FLOOR}};
  bool equal, all = true;
  double worst = 0;
  for (int i = 0; i < SHAPES; i++) {
    extreme glass = {.scene = {.objects = shapes[i]}};
    for (int k = 0; k < 4; k++) {
      glass.scene.n = index[k];
      extreme_frame a, b;
      if (!draw(context, &glass, &a, row)) return;
      if (!draw(context, &empty, &b, row)) return;
      all = all && same(&a.picture, &b.picture) && a.statistics.photons == 0;
      extreme_frame_free(&a);
      extreme_frame_free(&b);
    }
    glass.scene.n = 1 + 1e-5;
    glass.desc = (abbe_render_desc){.photons = 256, .map_size = 512};
    worst = fmax(worst, compare(context, &glass, &empty, false, &equal, row));
  }
  want_same("n = 1 within 1e-6", all, row);
  want_below("n = 1 + 1e-5", worst, 0.05, row);
}

/* Lamps ever farther away, of the same irradiance, are a sun. */
static void a_far_lamp_is_a_sun(abbe_context *context, extreme_row *row) {
  static const double distance[] = {10, 100, 1000, 4000};
  extreme sun = {.scene = {.light = {{.kind = "directional", .way = {0, 0, -1}}}}};
  double last = INFINITY;
  sun.desc = (abbe_render_desc){.photons = 128, .map_size = 128};
  for (int i = 0; i < 4; i++) {
    extreme lamp = sun;
    bool equal;
    double d = distance[i];
    lamp.scene.light[0] = (extreme_light){.kind = "point", .at = {0, 0, 0.2 + d}, .power = d * d};
    double difference = compare(context, &lamp, &sun, false, &equal, row);
    if (i < 3 && !(difference < last))
      extreme_row_break(row, "at %g m the difference grows to %g", d, difference);
    last = difference;
    if (i == 2) want_below("1000 m", difference, 0.02, row);
    if (i == 3) want_below("4000 m", difference, 0.02, row);
  }
}

/* Intensity grows with the square of the size, so that radiance stays. The picture of one metre a
 * unit again: what differs is the rounding of coordinates. */
static void size_does_not_matter(abbe_context *context, extreme_row *row) {
  static const double size[] = {1e-4, 1e5};
  for (int k = 0; k < 2; k++) {
    double worst = 0;
    for (int i = 0; i < SHAPES; i++) {
      extreme one = {.scene = {.b = 0.01, .objects = shapes[i]}}, other;
      bool equal;
      one.scene.light[0] = (extreme_light){.kind = "point", .at = {0.05, 0.03, 0.6}, .power = 0.01};
      other = one;
      other.scene.size = size[k];
      worst = fmax(worst, compare(context, &other, &one, false, &equal, row));
    }
    want_below(k == 0 ? "1e-4" : "1e5", worst, 0.01, row);
  }
}

static void place_does_not_matter(abbe_context *context, extreme_row *row) {
  static const double at[][3] = {{1e3, 0, 0}, {1e5, -1e5, 1e5}, {9e5, 9e5, -9e5}};
  static const char *const name[] = {"1e3 m", "1e5 m", "9e5 m"};
  for (int k = 0; k < 3; k++) {
    double worst = 0;
    for (int i = 0; i < SHAPES; i++) {
      extreme here = {.scene = {.b = 0.01, .objects = shapes[i]}}, there = here;
      bool equal;
      memcpy(there.scene.at, at[k], sizeof at[k]);
      worst = fmax(worst, compare(context, &there, &here, false, &equal, row));
    }
    want_below(name[k], worst, 0.01, row);
  }
}

/* Without length nothing is absorbed, of a colour so dark nothing comes through: what is in the map
 * then was reflected on the outside. */
static void absorption(abbe_context *context, extreme_row *row) {
  bool equal;
  double through = 0, faint = 0;
  for (int i = 0; i < SHAPES; i++) {
    extreme clear = {.scene = {.objects = shapes[i]}}, other = clear;
    extreme_frame black;
    other.scene.attenuation_per_m = 1e-12;
    faint = fmax(faint, compare(context, &other, &clear, true, &equal, row));
    other.scene.attenuation_per_m = 1e6;
    if (!draw(context, &other, &black, row)) return;
    const abbe_ledger *l = &black.statistics.energy;
    through = fmax(through, (l->reached - l->absorbed - l->reflected - l->deposited) / l->reached);
    through = fmax(through, l->trapped / l->reached);
    extreme_frame_free(&black);
  }
  want_below("1e-12 /m", faint, 1e-5, row);
  want_below("1e6 /m", through, 0.06, row);
}

/* A black floor is black, and a white one twice as bright as a grey one. */
static void receivers(abbe_context *context, extreme_row *row) {
  static const char *const floors[] = {
      "- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0, transform: "
      "[PLACE]}\n" EXTREME_BALL,
      "- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 1, transform: "
      "[PLACE]}\n" EXTREME_BALL,
      EXTREME_FLOOR EXTREME_BALL};
  extreme_frame frame[3];
  for (int i = 0; i < 3; i++) {
    /* where more rays are taken depends on how bright the floor is */
    extreme e = {.scene = {.b = 0.01, .objects = floors[i]}, .desc = {.adaptive = 1}};
    if (!draw(context, &e, &frame[i], row)) return;
  }
  double worst = 0;
  for (size_t i = 0; i < frame[2].picture.width * frame[2].picture.height; i++) {
    double grey = (double)frame[2].picture.data[3 * i + 1];
    double white = (double)frame[1].picture.data[3 * i + 1];
    if (grey > 0) worst = fmax(worst, fabs(white / grey - 2));
  }
  want_below("black", extreme_max(&frame[0].picture, 1), 0, row);
  want_below("white over grey", worst, 1e-4, row);
  for (int i = 0; i < 3; i++) extreme_frame_free(&frame[i]);
}

/* ---- counts ---- */

/* Sums of blocks, so that what is compared is where light is and not which texel it fell into. */
enum { BLOCKS = 12 };
static void sum_blocks(const abbe_image *map, double out[BLOCKS * BLOCKS][3]) {
  static const char *const name[] = {"X", "Y", "Z"};
  memset(out, 0, BLOCKS * BLOCKS * sizeof *out);
  for (size_t y = 0; y < map->height; y++)
    for (size_t x = 0; x < map->width; x++)
      for (size_t c = 0; c < 3; c++)
        out[y * BLOCKS / map->height * BLOCKS + x * BLOCKS / map->width][c] +=
            (double)map->data[(y * map->width + x) * map->channels +
                              abbe_image_find_channel(map, name[c])];
}

/* Half the sum of the differences over the sum: the share of light that lies elsewhere or has
 * another colour. */
static double misplaced(const abbe_image *a, const abbe_image *b) {
  double x[BLOCKS * BLOCKS][3], y[BLOCKS * BLOCKS][3], difference = 0, sum = 0;
  sum_blocks(a, x);
  sum_blocks(b, y);
  for (size_t i = 0; i < BLOCKS * BLOCKS; i++)
    for (size_t c = 0; c < 3; c++) {
      difference += fabs(x[i][c] - y[i][c]);
      sum += y[i][c];
    }
  return 0.5 * difference / sum;
}

/* The reference's map of the case, laid out like the frame's, after 16 passes. */
static bool trace_map(const extreme *e, const abbe_map_layout *layout, abbe_image *out,
                      extreme_row *row) {
  abbe_scene scene;
  abbe_tracer *tracer = NULL;
  abbe_error error = {0};
  abbe_result result = extreme_load(&e->scene, &scene, &error);
  if (result != ABBE_OK) {
    extreme_row_break(row, "%s", error.text);
    return false;
  }
  abbe_trace_desc desc = {.physics = {.matched = false},
                          .no_picture = true,
                          .map_width = 96,
                          .layout = layout,
                          .photons = 1 << 16};
  result = abbe_tracer_make(&scene, &desc, &tracer, &error);
  for (int i = 0; i < 16 && result == ABBE_OK; i++) result = abbe_tracer_pass(tracer, NULL, &error);
  if (result == ABBE_OK) result = abbe_tracer_map(tracer, out, &error);
  if (result != ABBE_OK) extreme_row_break(row, "%s", error.text);
  abbe_tracer_free(tracer);
  abbe_scene_free(&scene);
  return result == ABBE_OK;
}

/* The series' error against the reference falls, and ends below the bound. The layout is the last
 * one's, so that all maps have the same texels. */
static void converge(abbe_context *context, extreme *e, size_t *count, const size_t *series,
                     size_t steps, double bound, extreme_row *row) {
  extreme_frame best;
  abbe_image truth = {0};
  double first = 0, last = 0;
  *count = series[steps - 1];
  if (!draw(context, e, &best, row)) return;
  if (trace_map(e, &best.layout, &truth, row)) {
    e->desc.map_layout = &best.layout;
    for (size_t i = 0; i < steps; i++) {
      extreme_frame frame;
      *count = series[i];
      if (!draw(context, e, &frame, row)) break;
      last = misplaced(&frame.map, &truth);
      if (i == 0) first = last;
      extreme_row_add(row, "%s%zu: %.2g", i > 0 ? ", " : "", series[i], last);
      extreme_frame_free(&frame);
    }
    if (!(last < bound)) extreme_row_break(row, "%g of the light is elsewhere at the end", last);
    if (!(last < 0.5 * first)) extreme_row_break(row, "%g is no half of the first error", last);
  }
  abbe_image_free(&truth);
  extreme_frame_free(&best);
}

/* A prism spreads parallel light over half the floor. */
static void many_wavelengths(abbe_context *context, extreme_row *row) {
  static const size_t series[] = {1, 2, 4, 16, 64};
  extreme e = {.scene = {.b = 0.02,
                         .light = {{.kind = "directional", .way = {0.948, 0, 0.319}}},
                         .objects = EXTREME_FLOOR
                         "- {name: prism, shape: prism, apex: 60, side: 0.06, length: 0.06, "
                         "material: glass, transform: [{translate: [-0.8, 0, 0.5]}, PLACE]}\n"},
               .desc = {.photons = 64, .fill = ABBE_FILL_NONE}};
  converge(context, &e, &e.desc.wavelengths, series, 5, 0.05, row);
}

static void many_photons(abbe_context *context, extreme_row *row) {
  static const size_t series[] = {8, 16, 32, 64, 256};
  extreme e = {.scene = {.b = 0.02, .objects = shapes[0]}, .desc = {.wavelengths = 16}};
  converge(context, &e, &e.desc.photons, series, 5, 0.03, row);
}

const extreme_limit extreme_limits[] = {
    {"B to 0: the map without dispersion", no_dispersion},
    {"one index: 7 wavelengths are 1", one_wavelength_for_all},
    {"n to 1: the picture without glass", no_refraction},
    {"a lamp to infinity: a sun", a_far_lamp_is_a_sun},
    {"sizes: the picture of one metre", size_does_not_matter},
    {"places: the picture at the origin", place_does_not_matter},
    {"absorption to 0 and to infinity", absorption},
    {"reflectance to 0 and to 1", receivers},
    {"wavelengths: to the reference", many_wavelengths},
    {"photons: to the reference", many_photons},
};
const size_t extreme_limit_count = sizeof extreme_limits / sizeof *extreme_limits;
