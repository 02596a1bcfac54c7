/* The materials that an object may be made of, in the order of a jeweller, and their colours. */
#include "cli/view/state/view_outline.h"

#include "colorimetry/image/rgb_encoding.h"
#include "spectral/materials/absorption.h"
#include "spectral/optics.h"

#include <math.h>
#include <string.h>

/* By the words of its record; makers' catalogues have glasses alone. */
static bool is_glass(const abbe_material *m) {
  static const char *const words[] = {" glass", " crown",  " flint", "Flint",
                                      " water", "Acrylic", "Air"};
  bool is = m->catalogue.code != NULL;
  for (size_t i = 0; i < sizeof words / sizeof *words && m->description != NULL; i++)
    is = is || strstr(m->description, words[i]) != NULL;
  return is;
}

/* By the wavelengths of the primaries of Rec.709, as abbe_absorption_colour has them. */
static unsigned colour_of(const abbe_material *m) {
  static const double nm[3] = {611.4, 549.1, 464.2}, path_m = 0.005;
  double colour[3] = {1, 1, 1}, n, k;
  unsigned out = 0;
  if (m->attenuation != NULL) abbe_absorption_colour(m->attenuation, path_m, colour);
  for (int i = 0; i < 3; i++) {
    if (abbe_material_is_conductor(m) && abbe_material_nk(m, nm[i], &n, &k, NULL) == ABBE_OK)
      colour[i] = abbe_optics_fresnel_conductor(1, n, k);
    out = out << 8 | (unsigned)(255 * abbe_srgb_encoded(fmin(1, colour[i])) + 0.5);
  }
  return out;
}

static bool add_material(const abbe_material *m, size_t *count, char **names, unsigned *colours) {
  if (*count == ABBE_VIEW_MOST_STONES) return true;
  colours[*count] = colour_of(m);
  return (names[*count] = strdup(m->name)) != NULL && ++*count > 0;
}

bool abbe_view_outline_list_materials(const abbe_material_table *table, abbe_view_outline *out) {
  bool read = true;
  for (int glass = 0; glass < 2; glass++) {
    for (size_t i = 0; read && i < table->count; i++) {
      const abbe_material *m = &table->material[i];
      if (abbe_material_is_conductor(m))
        read = glass || add_material(m, &out->metal_count, out->metal, out->metal_colour);
      else if (is_glass(m) == (glass == 1))
        read = add_material(m, &out->stone_count, out->stone, out->stone_colour);
    }
    if (glass == 0) out->glasses_from = out->stone_count;
  }
  return read;
}
