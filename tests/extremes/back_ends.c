/* The same map and picture on EGL's software device and on OSMesa. Ends with 77 where one of them
 * is missing. */
#include "gl/device/context_backend.h"
#include "tests/extremes/laws.h"

#include <stdio.h>
#include <string.h>

enum { SKIPPED = 77 };

static abbe_context_native native;

static bool make_current(void *user) {
  (void)user;
  return native.make_current(&native);
}

static bool draw(bool osmesa, const extreme *e, extreme_frame *out) {
  abbe_context *context = NULL;
  abbe_error error = {0};
  abbe_result result =
      osmesa ? abbe_context_osmesa(&native, &error) : abbe_context_egl(true, 0, &native, &error);
  const abbe_context_host host = {native.lookup, make_current, NULL};
  if (result == ABBE_OK) result = abbe_context_adopt(&host, &context, &error);
  if (result == ABBE_OK) result = extreme_frame_make(context, e, out, &error);
  abbe_context_free(context);
  if (native.destroy != NULL) native.destroy(&native);
  native = (abbe_context_native){0};
  if (result != ABBE_OK) printf("%s\n", error.text);
  return result == ABBE_OK;
}

static size_t differences(const abbe_image *a, const abbe_image *b) {
  size_t count = a->width * a->height * a->channels, different = 0;
  if (count != b->width * b->height * b->channels) return count + 1;
  for (size_t i = 0; i < count; i++)
    different += memcmp(&a->data[i], &b->data[i], sizeof *a->data) != 0;
  return different;
}

static bool same(const char *name, const extreme *e) {
  extreme_frame a, b;
  if (!draw(true, e, &a)) return false;
  bool drawn = draw(false, e, &b);
  if (drawn) {
    size_t map = differences(&a.map, &b.map), picture = differences(&a.picture, &b.picture);
    printf("%s: %zu values of the map differ, %zu of the picture; map %g W\n", name, map, picture,
           extreme_sum(&a.map, 1));
    drawn = map == 0 && picture == 0 && extreme_sum(&a.map, 1) > 0;
    extreme_frame_free(&b);
  }
  extreme_frame_free(&a);
  return drawn;
}

static bool there_is(bool osmesa) {
  abbe_error error = {0};
  const abbe_result result =
      osmesa ? abbe_context_osmesa(&native, &error) : abbe_context_egl(true, 0, &native, &error);
  if (native.destroy != NULL) native.destroy(&native);
  native = (abbe_context_native){0};
  if (result != ABBE_OK) printf("skipped: %s\n", error.text);
  return result == ABBE_OK;
}

int main(void) {
  const extreme ball = {.scene = {.b = 0.01}};
  const extreme ring = {.scene = {.b = 0.6, .objects = EXTREME_FLOOR EXTREME_RING}};
  const extreme wide = {.scene = {.b = 0.01, .objects = EXTREME_FLOOR EXTREME_BRICK},
                        .desc = {.photons = 128, .wavelengths = 65}};
  if (!there_is(true) || !there_is(false)) return SKIPPED;
  bool equal = same("ball", &ball);
  equal = same("ring", &ring) && equal;
  equal = same("brick, 64-bit sums", &wide) && equal;
  return equal ? 0 : 1;
}
