/* The same map and picture by OSMesa and by EGL without a surface. Ends with 77 where there is no
 * EGL, or where it drives a device whose arithmetic is not OSMesa's. */
#include "tests/extremes/laws.h"

#include <stdio.h>
#include <string.h>

enum { SKIPPED = 77 };

static const char *driver(const abbe_context *context) {
  const char *text = strchr(abbe_context_description(context), ':');
  return text != NULL ? text : "";
}

static bool draw(abbe_context_backend backend, const extreme *e, extreme_frame *out) {
  abbe_context *context = NULL;
  abbe_error error = {0};
  abbe_result result = abbe_context_make(backend, &context, &error);
  if (result == ABBE_OK) result = extreme_frame_make(context, e, out, &error);
  abbe_context_free(context);
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
  if (!draw(ABBE_CONTEXT_OSMESA, e, &a)) return false;
  bool drawn = draw(ABBE_CONTEXT_EGL, e, &b);
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

/* False where the two cannot be compared. */
static bool comparable(void) {
  abbe_context *osmesa = NULL, *egl = NULL;
  abbe_error error = {0};
  char name[256];
  if (abbe_context_make(ABBE_CONTEXT_EGL, &egl, &error) != ABBE_OK) {
    printf("skipped: %s\n", error.text);
    return false;
  }
  snprintf(name, sizeof name, "%s", driver(egl));
  abbe_context_free(egl);
  if (abbe_context_make(ABBE_CONTEXT_OSMESA, &osmesa, &error) != ABBE_OK) {
    printf("skipped: %s\n", error.text);
    return false;
  }
  bool equal = strncmp(name, driver(osmesa), strcspn(name, "(")) == 0;
  if (!equal) printf("skipped: EGL drives%s, OSMesa%s\n", name, driver(osmesa));
  abbe_context_free(osmesa);
  return equal;
}

int main(void) {
  const extreme ball = {.scene = {.b = 0.01}};
  const extreme ring = {.scene = {.b = 0.6, .objects = EXTREME_FLOOR EXTREME_RING}};
  const extreme wide = {.scene = {.b = 0.01, .objects = EXTREME_FLOOR EXTREME_BRICK},
                        .desc = {.photons = 128, .wavelengths = 65}};
  if (!comparable()) return SKIPPED;
  bool equal = same("ball", &ball);
  equal = same("ring", &ring) && equal;
  equal = same("brick, 64-bit sums", &wide) && equal;
  return equal ? 0 : 1;
}
