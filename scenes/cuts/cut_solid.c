#include "scenes/cuts/cut_file.h"

#include "base/file.h"
#include "base/number.h"
#include "colorimetry/illuminant.h"
#include "colorimetry/observer.h"
#include "colorimetry/rgb_space.h"
#include "spectral/materials/absorption.h"
#include "spectral/materials/material_query.h"
#include "spectral/wavelengths.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define ABBE_SOLID_ENDING(code, ending) ending,
static const char *const endings[] = {ABBE_CUT_SOLIDS(ABBE_SOLID_ENDING)};

static const double millimetres = 1e3;

abbe_cut_solid_format abbe_cut_solid_format_of(const char *path) {
  const char *ending = strrchr(abbe_file_name(path), '.');
  int i = 0;
  while (i < ABBE_CUT_SOLID_COUNT && !(ending != NULL && strcasecmp(ending, endings[i]) == 0)) i++;
  return (abbe_cut_solid_format)i;
}

typedef struct solid {
  const abbe_cut *cut;
  const abbe_cut_polyhedron *p;
  double scale;
  FILE *to;
} solid;

static const double *corner(const solid *s, const abbe_cut_face *face, size_t i) {
  return s->p->vertex[s->p->corner[face->first + i]];
}

static const double *normal(const solid *s, const abbe_cut_face *face) {
  return s->cut->facet[face->facet].n;
}

static size_t count_triangles(const solid *s) {
  return s->p->corner_count - 2 * s->p->face_count;
}

static void put_u32(FILE *to, uint32_t value) {
  for (int i = 0; i < 4; i++) putc((int)(value >> 8 * i & 255), to);
}

static void put_float(FILE *to, double value) {
  const float narrow = (float)value;
  uint32_t bits;
  memcpy(&bits, &narrow, sizeof bits);
  put_u32(to, bits);
}

/* ---- STL ---- */

static void write_stl(const solid *s) {
  char head[80] = "a cut stone, in millimetres";
  fwrite(head, 1, sizeof head, s->to);
  put_u32(s->to, (uint32_t)count_triangles(s));
  for (size_t f = 0; f < s->p->face_count; f++) {
    const abbe_cut_face *face = &s->p->face[f];
    for (size_t i = 1; i + 1 < face->count; i++) {
      const double *const at[] = {corner(s, face, 0), corner(s, face, i), corner(s, face, i + 1)};
      for (int k = 0; k < 3; k++) put_float(s->to, normal(s, face)[k]);
      for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++) put_float(s->to, millimetres * s->scale * at[c][k]);
      putc(0, s->to);
      putc(0, s->to);
    }
  }
}

/* ---- OBJ ---- */

/* A name's letters and digits. */
static void put_word(FILE *to, const char *name) {
  for (; *name != '\0'; name++) {
    const char c = *name;
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    putc(plain ? c : '_', to);
  }
}

static void write_obj(const solid *s) {
  fputs("# a cut stone, in millimetres, z up\no stone\n", s->to);
  for (size_t v = 0; v < s->p->vertex_count; v++) {
    fputs("v", s->to);
    for (int k = 0; k < 3; k++)
      abbe_number_write(s->to, " %.9g", millimetres * s->scale * s->p->vertex[v][k]);
    putc('\n', s->to);
  }
  for (size_t f = 0; f < s->p->face_count; f++)
    abbe_number_write(s->to, "vn %.9g %.9g %.9g\n", normal(s, &s->p->face[f])[0],
                      normal(s, &s->p->face[f])[1], normal(s, &s->p->face[f])[2]);
  for (size_t f = 0; f < s->p->face_count; f++) {
    const abbe_cut_face *face = &s->p->face[f];
    fputs("g facet_", s->to);
    put_word(s->to, abbe_cut_facet_name(s->cut, face->facet));
    fprintf(s->to, "_%zu\nf", face->facet + 1);
    for (size_t i = 0; i < face->count; i++)
      fprintf(s->to, " %u//%zu", s->p->corner[face->first + i] + 1, f + 1);
    putc('\n', s->to);
  }
}

/* ---- glTF ---- */

/* What is left of white through so many metres, linear Rec.709 within 0 to 1. */
static void colour_through(const abbe_material *m, double metres, double rgb[3]) {
  const abbe_illuminant d65 = {0};
  double xyz[3] = {0}, white = 0, matrix[9];
  for (double l = ABBE_WAVELENGTH_MIN_NM; l <= ABBE_WAVELENGTH_MAX_NM; l += 1) {
    double bar[3];
    const double power = abbe_illuminant_power(&d65, l);
    const double left = abbe_absorption_transmittance(abbe_material_attenuation(m, l), metres);
    abbe_observer_xyz(l, bar);
    for (int i = 0; i < 3; i++) xyz[i] += left * power * bar[i];
    white += power * bar[1];
  }
  for (int i = 0; i < 3; i++) xyz[i] /= white;
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, matrix);
  abbe_rgb_space_apply(matrix, xyz, rgb);
  for (int i = 0; i < 3; i++) rgb[i] = fmin(fmax(rgb[i], 0), 1);
}

static abbe_result put_material(const abbe_material *m, double width, FILE *to, abbe_error *error) {
  abbe_material_numbers n = {.n_d = 1.5, .v_d = INFINITY};
  if (m != NULL) {
    abbe_material_numbers_make(m, &n);
    if (!isfinite(n.n_d) || isnan(n.v_d))
      return abbe_error_set(error, ABBE_OUT_OF_RANGE,
                            "'%s' has no index at the lines d, F and C, which glTF asks for",
                            m->name);
  }
  fputs("\"materials\":[{\"name\":\"stone\",\"pbrMetallicRoughness\":{\"metallicFactor\":0,"
        "\"roughnessFactor\":0},\"extensions\":{\"KHR_materials_transmission\":"
        "{\"transmissionFactor\":1},",
        to);
  abbe_number_write(to, "\"KHR_materials_ior\":{\"ior\":%.9g},", n.n_d);
  abbe_number_write(to, "\"KHR_materials_dispersion\":{\"dispersion\":%.9g},", 20 / n.v_d);
  abbe_number_write(to, "\"KHR_materials_volume\":{\"thicknessFactor\":%.9g", width);
  if (m != NULL && m->attenuation != NULL) {
    double rgb[3];
    colour_through(m, width, rgb);
    abbe_number_write(to, ",\"attenuationDistance\":%.9g,\"attenuationColor\":[%.6g,%.6g,%.6g]",
                      width, rgb[0], rgb[1], rgb[2]);
  }
  fputs("}}}],", to);
  return ABBE_OK;
}

/* Places, normals and triangles: y is up, so (x, y, z) is (x, z, -y). */
static void put_bytes(const solid *s, FILE *to) {
  for (int what = 0; what < 2; what++)
    for (size_t f = 0; f < s->p->face_count; f++) {
      const abbe_cut_face *face = &s->p->face[f];
      for (size_t i = 0; i < face->count; i++) {
        const double *at = what == 0 ? corner(s, face, i) : normal(s, face);
        const double scale = what == 0 ? s->scale : 1;
        put_float(to, scale * at[0]);
        put_float(to, scale * at[2]);
        put_float(to, -scale * at[1]);
      }
    }
  uint32_t first = 0;
  for (size_t f = 0; f < s->p->face_count; f++) {
    const uint32_t count = (uint32_t)s->p->face[f].count;
    for (uint32_t i = 1; i + 1 < count; i++) {
      put_u32(to, first);
      put_u32(to, first + i);
      put_u32(to, first + i + 1);
    }
    first += count;
  }
}

static abbe_result put_json(const solid *s, const abbe_material *material, FILE *to,
                            abbe_error *error) {
  const size_t corners = s->p->corner_count, triangles = count_triangles(s);
  const double *min = s->p->min, *max = s->p->max, k = s->scale;
  fputs(
      "{\"asset\":{\"version\":\"2.0\",\"generator\":\"abbe\"},\"scene\":0,\"scenes\":[{\"nodes\":"
      "[0]}],\"nodes\":[{\"name\":\"stone\",\"mesh\":0}],\"extensionsUsed\":["
      "\"KHR_materials_ior\",\"KHR_materials_transmission\",\"KHR_materials_volume\","
      "\"KHR_materials_dispersion\"],",
      to);
  const double width = k * fmin(max[0] - min[0], max[1] - min[1]);
  ABBE_TRY(put_material(material, width, to, error));
  fputs("\"meshes\":[{\"name\":\"stone\",\"primitives\":[{\"attributes\":{\"POSITION\":0,"
        "\"NORMAL\":1},\"indices\":2,\"material\":0}]}],",
        to);
  fprintf(to,
          "\"buffers\":[{\"byteLength\":%zu}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu,"
          "\"target\":34962},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"target\":34962},"
          "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"target\":34963}],",
          24 * corners + 12 * triangles, 12 * corners, 12 * corners, 12 * corners, 24 * corners,
          12 * triangles);
  fprintf(to,
          "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":%zu,\"type\":"
          "\"VEC3\",",
          corners);
  /* as the floats are */
  const float low[] = {(float)(k * min[0]), (float)(k * min[2]), (float)(-k * max[1])};
  const float high[] = {(float)(k * max[0]), (float)(k * max[2]), (float)(-k * min[1])};
  abbe_number_write(to, "\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]},", (double)low[0],
                    (double)low[1], (double)low[2], (double)high[0], (double)high[1],
                    (double)high[2]);
  fprintf(to,
          "{\"bufferView\":1,\"componentType\":5126,\"count\":%zu,\"type\":\"VEC3\"},"
          "{\"bufferView\":2,\"componentType\":5125,\"count\":%zu,\"type\":\"SCALAR\"}]}",
          corners, 3 * triangles);
  return ABBE_OK;
}

static abbe_result write_glb(const solid *s, const abbe_material *material, abbe_error *error) {
  enum { JSON = 0x4e4f534a, BIN = 0x004e4942, MAGIC = 0x46546c67 };
  char *text = NULL;
  size_t length = 0;
  FILE *json = open_memstream(&text, &length);
  if (json == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a solid");
  abbe_result result = put_json(s, material, json, error);
  const bool whole = fclose(json) == 0;
  if (result == ABBE_OK && !whole)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a solid");
  if (result == ABBE_OK) {
    const size_t pad = (4 - length % 4) % 4;
    const size_t bytes = 24 * s->p->corner_count + 12 * count_triangles(s);
    put_u32(s->to, MAGIC);
    put_u32(s->to, 2);
    put_u32(s->to, (uint32_t)(12 + 8 + length + pad + 8 + bytes));
    put_u32(s->to, (uint32_t)(length + pad));
    put_u32(s->to, JSON);
    fwrite(text, 1, length, s->to);
    for (size_t i = 0; i < pad; i++) putc(' ', s->to);
    put_u32(s->to, (uint32_t)bytes);
    put_u32(s->to, BIN);
    put_bytes(s, s->to);
  }
  free(text);
  return result;
}

abbe_result abbe_cut_solid_write(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                 double scale, const abbe_material *material,
                                 abbe_cut_solid_format format, FILE *to, abbe_error *error) {
  assert(scale > 0);
  const solid s = {.cut = cut, .p = polyhedron, .scale = scale, .to = to};
  abbe_result result = ABBE_OK;
  switch (format) {
  case ABBE_CUT_SOLID_STL:
    write_stl(&s);
    break;
  case ABBE_CUT_SOLID_OBJ:
    write_obj(&s);
    break;
  case ABBE_CUT_SOLID_GLB:
    result = write_glb(&s, material, error);
    break;
  default:
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "no such kind of solid");
  }
  if (result == ABBE_OK && ferror(to))
    result = abbe_error_set(error, ABBE_IO, "the solid could not be written");
  return result;
}
