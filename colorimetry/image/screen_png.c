#include "colorimetry/image/screen_png.h"

#include "colorimetry/image/avif_file.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/rgb_space.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* The names that pictures go by, in order of preference; a lone Y is a grey. */
static const char *const triples[][3] = {{"R", "G", "B"}, {"X", "Y", "Z"}, {"Y", "Y", "Y"}};
enum { TRIPLE_RGB, TRIPLE_XYZ, TRIPLE_GREY, TRIPLE_COUNT };

static bool find_triple(const abbe_image *image, const char *layer, int triple, size_t at[3]) {
  for (int k = 0; k < 3; k++) {
    char name[300];
    snprintf(name, sizeof name, "%s%s%s", layer ? layer : "", layer ? "." : "", triples[triple][k]);
    at[k] = abbe_image_find_channel(image, name);
    if (at[k] == (size_t)-1) return false;
  }
  return true;
}

static const char *name_of(const abbe_screen_png_desc *d) {
  return d->name != NULL ? d->name : "the picture";
}

static abbe_result no_triple(const abbe_screen_png_desc *d, const abbe_image *image,
                             abbe_error *error) {
  char known[700] = "";
  for (size_t i = 0; i < image->channels; i++) {
    size_t used = strlen(known);
    snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "", image->channel[i]);
  }
  return abbe_error_set(error, ABBE_NOT_FOUND,
                        "%s: it has no channels R, G, B (nor X, Y, Z, nor Y)%s%s%s; it has: %s",
                        name_of(d), d->layer ? " in the layer '" : "", d->layer ? d->layer : "",
                        d->layer ? "'" : "", known);
}

/* The three channels to show, as an image of their own. */
static abbe_result pick_channels(const abbe_screen_png_desc *d, const abbe_image *image,
                                 abbe_image *picked, int *triple, abbe_error *error) {
  size_t at[3];
  for (*triple = 0; *triple < TRIPLE_COUNT; ++*triple)
    if (find_triple(image, d->layer, *triple, at)) break;
  if (*triple == TRIPLE_COUNT) return no_triple(d, image, error);
  abbe_result result =
      abbe_image_make(image->width, image->height, 3, triples[TRIPLE_RGB], picked, error);
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < image->width * image->height; i++)
    for (int k = 0; k < 3; k++)
      picked->data[3 * i + (size_t)k] = image->data[i * image->channels + at[k]];
  return ABBE_OK;
}

static const struct {
  double xy[8];
  const char *ocio_name;
} other_spaces[] = {
    {{0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.0770, 0.32168, 0.33767}, "ACES2065-1"},
};

static bool same_xy(const double a[8], const double b[8]) {
  for (int i = 0; i < 8; i++)
    if (!(fabs(a[i] - b[i]) < 1e-3)) return false;
  return true;
}

static bool is_stated(const double xy[8]) {
  for (int i = 0; i < 8; i++)
    if (xy[i] != 0) return true;
  return false;
}

static const char *space_of_chromaticities(const double xy[8]) {
  for (int s = 0; s < ABBE_RGB_SPACE_COUNT; s++) {
    double known[8];
    abbe_rgb_space_chromaticities((abbe_rgb_space)s, known);
    if (same_xy(xy, known)) return abbe_rgb_space_ocio_name((abbe_rgb_space)s);
  }
  return same_xy(xy, other_spaces[0].xy) ? other_spaces[0].ocio_name : NULL;
}

/* What the command line says, else the file's own word, else its channels' names, else its
 * chromaticities; NULL (the configuration's scene_linear) where it is silent. */
static abbe_result find_source(const abbe_screen_png_desc *d, const abbe_image *image, int triple,
                               const char **space, abbe_error *error) {
  *space = d->display.source_space;
  if (*space != NULL) return ABBE_OK;
  const char *word = abbe_image_attribute_text(image, "abbe:space");
  for (int s = 0; word != NULL && s < ABBE_RGB_SPACE_COUNT; s++)
    if (strcasecmp(word, abbe_rgb_space_name((abbe_rgb_space)s)) == 0) {
      *space = abbe_rgb_space_ocio_name((abbe_rgb_space)s);
      return ABBE_OK;
    }
  if (word != NULL)
    return abbe_error_set(error, ABBE_COLOUR,
                          "%s: its attribute abbe:space is '%.60s', not acescg, rec709 or xyz; "
                          "--source names the space",
                          name_of(d), word);
  if (triple == TRIPLE_XYZ) *space = abbe_rgb_space_ocio_name(ABBE_RGB_SPACE_XYZ);
  if (*space != NULL || !is_stated(image->xy)) return ABBE_OK;
  *space = space_of_chromaticities(image->xy);
  if (*space != NULL) return ABBE_OK;
  return abbe_error_set(error, ABBE_COLOUR,
                        "%s: its chromaticities, red (%g, %g) to white (%g, %g), are of no known "
                        "space; --source names the space",
                        name_of(d), image->xy[0], image->xy[1], image->xy[6], image->xy[7]);
}

abbe_result abbe_screen_png_write(const char *path, const abbe_image *image,
                                  const abbe_screen_png_desc *d, abbe_error *error) {
  ABBE_REQUIRE(path && image && d, error);
  abbe_image picked = {0};
  abbe_display *transform = NULL;
  abbe_display_desc desc = d->display;
  int triple = 0;
  abbe_result result = pick_channels(d, image, &picked, &triple, error);
  if (result == ABBE_OK) result = find_source(d, image, triple, &desc.source_space, error);
  if (result == ABBE_OK) result = abbe_display_make(&desc, &transform, error);
  if (result == ABBE_OK) result = abbe_display_apply(transform, &picked, error);
  if (result == ABBE_OK && abbe_avif_is_meant(path))
    result = abbe_avif_write(path, &picked, d->bits != 0 ? d->bits : 10, error);
  else if (result == ABBE_OK)
    result = abbe_png_write(
        path, &picked, d->bits != 0 ? d->bits : picked.transfer != 0 ? 16 : 8, error);
  abbe_display_free(transform);
  abbe_image_free(&picked);
  return result;
}
