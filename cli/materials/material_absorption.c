/* What a material absorbs, by direction where it is pleochroic, as text and as JSON. */
#include "cli/materials/materials.h"

#include "colorimetry/pleochroism.h"
#include "spectral/materials/absorption.h"

#include <math.h>
#include <stdio.h>

/* For a field along that axis. */
static void show_attenuation(const abbe_material *m, int axis) {
  const abbe_spectrum *own = axis > 0 ? m->attenuation_yz[axis - 1] : m->attenuation;
  const double *l = abbe_spectrum_lambda_nm(own), *a = abbe_spectrum_value(own);
  size_t count = abbe_spectrum_count(own);
  for (size_t i = 0; i < count && i < 8; i++)
    printf(" %.4g at %g%s", a[i], l[i], i + 1 < count ? "," : "");
  printf(count > 8 ? " … (%zu points)\n" : "\n", count);
  printf("                through 10 mm:");
  for (int nm = 400; nm <= 700; nm += 100)
    printf(" %.4g at %d%s",
           abbe_absorption_transmittance(abbe_material_attenuation_along(m, axis, nm), 0.01), nm,
           nm < 700 ? "," : " nm\n");
}

static const double face_m[2] = {0.005, 0.01};

/* L*, C*ab and the hue angle in degrees. */
static void chroma_of(const double lab[3], double out[3]) {
  const double hue = atan2(lab[2], lab[1]) * 180 / acos(-1);
  out[0] = lab[0];
  out[1] = hypot(lab[1], lab[2]);
  out[2] = hue < 0 ? hue + 360 : hue;
}

/* Shows a face that is cut across each direction; one that holds the axis shows both waves. */
static void show_faces(const abbe_material *m) {
  static const struct {
    const char *name;
    int axis;  /* whose field or, */
    bool face; /* unpolarised, whose face it is */
  } rows[] = {{"ordinary ray", 0, false},
              {"extraordinary ray", 2, false},
              {"face across the axis", 2, true},
              {"face along the axis", 0, true}};
  abbe_pleochroism p[2];
  for (int i = 0; i < 2; i++) abbe_pleochroism_make(m, face_m[i], &p[i]);
  printf("  pleochroic    colours of D65: L*, chroma and hue through 5 mm, and through 10 mm\n");
  for (size_t r = 0; r < sizeof rows / sizeof rows[0]; r++) {
    printf("                %-21s", rows[r].name);
    for (int i = 0; i < 2; i++) {
      double lch[3];
      chroma_of(rows[r].face ? p[i].face_lab[rows[r].axis] : p[i].field_lab[rows[r].axis], lch);
      printf(" %5.1f %5.1f %5.1f%s", lch[0], lch[1], lch[2], i == 0 ? "   " : "\n");
    }
  }
  printf("                largest difference    %5.1f%s%5.1f (CIELAB)\n", p[0].largest,
         "               ", p[1].largest);
}

void abbe_materials_show_absorption(const abbe_material *m) {
  if (m->attenuation == NULL) {
    printf("  absorption    none recorded\n");
    return;
  }
  if (!abbe_material_is_pleochroic(m)) {
    printf("  absorption    1/m, at nm:");
    show_attenuation(m, 0);
    return;
  }
  printf("  ordinary      1/m, at nm:");
  show_attenuation(m, 0);
  printf("  extraordinary 1/m, at nm:");
  show_attenuation(m, 2);
  show_faces(m);
}

/* ---- JSON ---- */

static void add_points(cJSON *to, const char *key, const abbe_spectrum *spectrum) {
  cJSON *list = cJSON_AddArrayToObject(to, key);
  for (size_t i = 0; list != NULL && i < abbe_spectrum_count(spectrum); i++) {
    const double row[2] = {abbe_spectrum_lambda_nm(spectrum)[i], abbe_spectrum_value(spectrum)[i]};
    cJSON_AddItemToArray(list, cJSON_CreateDoubleArray(row, 2));
  }
}

/* `attenuation_per_m` is the ordinary wave's; the colours are CIELAB of D65. */
static void add_pleochroism(cJSON *to, const abbe_material *m) {
  cJSON *item = cJSON_AddObjectToObject(to, "pleochroism");
  add_points(item, "extraordinary_per_m", m->attenuation_yz[1]);
  cJSON *list = cJSON_AddArrayToObject(item, "colours");
  for (int i = 0; i < 2; i++) {
    abbe_pleochroism p;
    abbe_pleochroism_make(m, face_m[i], &p);
    cJSON *colours = cJSON_CreateObject();
    if (colours == NULL || !cJSON_AddItemToArray(list, colours)) return;
    cJSON_AddNumberToObject(colours, "thickness_m", face_m[i]);
    const struct {
      const char *key;
      const double *lab;
    } rows[] = {{"ordinary_lab", p.field_lab[0]},
                {"extraordinary_lab", p.field_lab[2]},
                {"across_the_axis_lab", p.face_lab[2]},
                {"along_the_axis_lab", p.face_lab[0]}};
    for (int k = 0; k < 4; k++)
      cJSON_AddItemToObject(colours, rows[k].key, cJSON_CreateDoubleArray(rows[k].lab, 3));
    cJSON_AddNumberToObject(colours, "largest_difference", p.largest);
  }
}

void abbe_materials_add_absorption(cJSON *to, const abbe_material *m) {
  if (m->attenuation != NULL)
    add_points(to, "attenuation_per_m", m->attenuation);
  else
    cJSON_AddNullToObject(to, "attenuation_per_m");
  if (abbe_material_is_pleochroic(m)) add_pleochroism(to, m);
}
