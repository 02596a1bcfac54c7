/* A scene for Mitsuba 3 [Mitsuba3], in a spectral variant. Its look-at axes are mirrored twice, so
 * that pictures of right-handed worlds are; spectra of lights are multiplied by what its film
 * divides by, the luminance of a radiance of 1 W/(m2 sr nm). */
#include "scenes/export/export_writing.h"

#include "base/maths.h"
#include "base/number.h"
#include "colorimetry/weights.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const double film_y = 106.7502593994140625;

/* ---- spectra ---- */

typedef struct list {
  FILE *file;
  size_t count;
  bool wavelengths;
} list;

static void put_one(void *user, double lambda_nm, double value) {
  list *l = user;
  abbe_number_write(l->file, "%s%.9g", l->count++ > 0 ? ", " : "",
                    l->wavelengths ? lambda_nm : value);
}

static void write_light_spectrum(const abbe_export_writing *w, const char *name,
                                 const abbe_light *light) {
  abbe_weights_range range;
  abbe_weights_range_make(&light->illuminant, ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM,
                          &range);
  const double factor = light->power * film_y / range.white_y;
  fprintf(w->file, "    <spectrum name=\"%s\" type=\"irregular\">\n", name);
  for (int k = 0; k < 2; k++) {
    list l = {w->file, 0, k == 0};
    fprintf(w->file, "      <string name=\"%s\" value=\"", k == 0 ? "wavelengths" : "values");
    abbe_export_light_spectrum(&light->illuminant, factor, put_one, &l);
    fputs("\"/>\n", w->file);
  }
  fputs("    </spectrum>\n", w->file);
}

static void write_table(const abbe_export_writing *w, const char *name, const abbe_material *m,
                        double (*at)(const abbe_material *m, double lambda_nm)) {
  fprintf(w->file, "      <spectrum name=\"%s\" type=\"irregular\">\n", name);
  for (int k = 0; k < 2; k++) {
    list l = {w->file, 0, k == 0};
    fprintf(w->file, "        <string name=\"%s\" value=\"", k == 0 ? "wavelengths" : "values");
    for (size_t i = 0; i < ABBE_EXPORT_TABLE_COUNT; i++) {
      const double nm = ABBE_EXPORT_TABLE_FIRST_NM + (double)i * ABBE_EXPORT_TABLE_STEP_NM;
      put_one(&l, nm, at(m, nm));
    }
    fputs("\"/>\n", w->file);
  }
  fputs("      </spectrum>\n", w->file);
}

/* ---- meshes ---- */

static void put_float(FILE *file, double value) {
  const float narrow = (float)value;
  uint32_t bits;
  memcpy(&bits, &narrow, sizeof bits);
  for (int i = 0; i < 4; i++) putc((int)(bits >> 8 * i & 255), file);
}

/* Rows of its pictures go downwards with v. */
static void write_ply(FILE *file, const abbe_mesh *mesh, const double repeat[2]) {
  const bool with_uv = mesh->uv != NULL && repeat != NULL;
  fprintf(file,
          "ply\nformat binary_little_endian 1.0\nelement vertex %zu\nproperty float x\n"
          "property float y\nproperty float z\nproperty float nx\nproperty float ny\n"
          "property float nz\n%selement face %zu\nproperty list uchar int vertex_indices\n"
          "end_header\n",
          mesh->vertex_count, with_uv ? "property float u\nproperty float v\n" : "",
          mesh->face_count);
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    for (int k = 0; k < 3; k++) put_float(file, mesh->position[i][k]);
    for (int k = 0; k < 3; k++) put_float(file, mesh->normal[i][k]);
    if (!with_uv) continue;
    put_float(file, repeat[0] * mesh->uv[i][0]);
    put_float(file, 1 - repeat[1] * mesh->uv[i][1]);
  }
  for (size_t f = 0; f < mesh->face_count; f++) {
    putc(3, file);
    for (int k = 0; k < 3; k++)
      for (int i = 0; i < 4; i++) putc((int)(mesh->face[f][k] >> 8 * i & 255), file);
  }
}

static abbe_result add_ply(const abbe_export_writing *w, const char *name, const abbe_object *o,
                           abbe_error *error) {
  char suffix[ABBE_EXPORT_NAME_SIZE + 8], *data = NULL;
  size_t size = 0;
  FILE *memory = open_memstream(&data, &size);
  if (memory != NULL) write_ply(memory, &o->mesh, o->texture_path ? o->texture_repeat : NULL);
  if (memory == NULL || fclose(memory) != 0) {
    free(data);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a mesh");
  }
  snprintf(suffix, sizeof suffix, "-%s.ply", name);
  return abbe_export_files_add(w->files, suffix, data, size, error);
}

/* ---- the scene ---- */

static void write_point(const abbe_export_writing *w, const char *before, const double p[3],
                        const char *after) {
  fputs(before, w->file);
  abbe_export_vector(w->file, p, ", ");
  fputs(after, w->file);
}

static void write_head(const abbe_export_writing *w) {
  char name[ABBE_EXPORT_NAME_SIZE];
  const abbe_camera *c = &w->scene->camera;
  fputs("  <default name=\"spp\" value=\"256\"/>\n"
        "  <default name=\"integrator\" value=\"volpath\"/>\n",
        w->file);
  for (size_t i = 0; i < w->report->glass_count; i++)
    abbe_number_write(w->file, "  <default name=\"n_%s\" value=\"%.9g\"/>\n",
                      abbe_export_name(name, "m", i, w->report->glass[i].material->name),
                      w->report->glass[i].index.value[0]);
  fputs("  <integrator type=\"$integrator\"><integer name=\"max_depth\" value=\"24\"/>"
        "</integrator>\n",
        w->file);
  abbe_number_write(w->file,
                    "  <sensor type=\"perspective\">\n    <string name=\"fov_axis\" value=\"y\"/>\n"
                    "    <float name=\"fov\" value=\"%.9g\"/>\n"
                    "    <float name=\"near_clip\" value=\"0.0001\"/>\n",
                    c->fov_y_rad * ABBE_EXPORT_DEGREES);
  write_point(w, "    <transform name=\"to_world\">\n      <lookat origin=\"", c->eye, "\"");
  write_point(w, " target=\"", c->target, "\"");
  write_point(w, " up=\"", c->up, "\"/>\n    </transform>\n");
  fprintf(w->file,
          "    <film type=\"hdrfilm\">\n      <integer name=\"width\" value=\"%zu\"/>\n"
          "      <integer name=\"height\" value=\"%zu\"/>\n"
          "      <string name=\"pixel_format\" value=\"rgb\"/>\n"
          "      <string name=\"component_format\" value=\"float32\"/>\n"
          "      <rfilter type=\"box\"/>\n    </film>\n"
          "    <sampler type=\"independent\"><integer name=\"sample_count\" value=\"$spp\"/>"
          "</sampler>\n  </sensor>\n",
          c->width, c->height);
}

static void write_matrix(const abbe_export_writing *w, const double a[3], const double b[3],
                         const double c[3], const double at[3]) {
  fputs("    <transform name=\"to_world\"><matrix value=\"", w->file);
  for (int k = 0; k < 3; k++)
    abbe_number_write(w->file, "%.9g %.9g %.9g %.9g  ", a[k], b[k], c[k], at[k]);
  fputs("0 0 0 1\"/></transform>\n", w->file);
}

static void write_area(const abbe_export_writing *w, const abbe_light *light) {
  double a[3], b[3], c[3], normal[3];
  memcpy(c, light->direction, sizeof c);
  if (light->kind == ABBE_LIGHT_DISK) {
    abbe_export_basis(light->direction, a, b);
    for (int k = 0; k < 3; k++) a[k] *= light->radius, b[k] *= light->radius, c[k] *= light->radius;
  } else {
    abbe_vector_cross(light->edge[0], light->edge[1], normal);
    const int turned = abbe_vector_dot(normal, light->direction) < 0;
    memcpy(a, light->edge[turned], sizeof a);
    memcpy(b, light->edge[!turned], sizeof b);
  }
  fprintf(w->file, "  <shape type=\"%s\">\n",
          light->kind == ABBE_LIGHT_DISK ? "disk" : "rectangle");
  write_matrix(w, a, b, c, light->position);
  fputs("    <bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0, 0, 0\"/></bsdf>\n"
        "    <emitter type=\"area\">\n",
        w->file);
  write_light_spectrum(w, "radiance", light);
  fputs("    </emitter>\n  </shape>\n", w->file);
}

static void write_light(const abbe_export_writing *w, const abbe_light *light) {
  if (abbe_light_has_size(light)) {
    write_area(w, light);
    return;
  }
  if (light->kind == ABBE_LIGHT_DIRECTIONAL) {
    write_point(w, "  <emitter type=\"directional\">\n    <vector name=\"direction\" value=\"",
                light->direction, "\"/>\n");
    write_light_spectrum(w, "irradiance", light);
  } else if (light->kind == ABBE_LIGHT_POINT) {
    write_point(w, "  <emitter type=\"point\">\n    <point name=\"position\" value=\"",
                light->position, "\"/>\n");
    write_light_spectrum(w, "intensity", light);
  } else {
    double a[3], b[3];
    abbe_export_basis(light->direction, a, b);
    fputs("  <emitter type=\"spot\">\n", w->file);
    write_matrix(w, a, b, light->direction, light->position);
    abbe_number_write(w->file,
                      "    <float name=\"cutoff_angle\" value=\"%.9g\"/>\n"
                      "    <float name=\"beam_width\" value=\"%.9g\"/>\n",
                      light->cone_rad * ABBE_EXPORT_DEGREES,
                      fmax(light->cone_rad - light->soft_rad, 0) * ABBE_EXPORT_DEGREES);
    write_light_spectrum(w, "intensity", light);
  }
  fputs("  </emitter>\n", w->file);
}

/* Its map has +y at the top row and -z in the first column; the matrix turns y to Abbe's z. */
static void map_direction(double u, double v, double out[3]) {
  abbe_export_direction(0.25 - u, v, out);
}

static abbe_result write_environment(const abbe_export_writing *w, abbe_error *error) {
  static const double x[3] = {1, 0, 0}, y[3] = {0, 0, 1}, z[3] = {0, -1, 0}, at[3] = {0, 0, 0};
  fprintf(w->file,
          "  <emitter type=\"envmap\">\n"
          "    <string name=\"filename\" value=\"%s-environment.exr\"/>\n",
          w->files->name);
  write_matrix(w, x, y, z, at);
  fputs("  </emitter>\n", w->file);
  return abbe_export_panorama(w, map_direction, error);
}

static void write_glass(const abbe_export_writing *w, const abbe_material *m) {
  char name[ABBE_EXPORT_NAME_SIZE];
  abbe_export_name(name, "m", abbe_export_glass_of(w, m), m->name);
  fprintf(w->file,
          "    <bsdf type=\"dielectric\">\n      <float name=\"int_ior\" value=\"$n_%s\"/>\n"
          "      <float name=\"ext_ior\" value=\"1\"/>\n    </bsdf>\n",
          name);
  if (m->attenuation == NULL) return;
  fputs("    <medium name=\"interior\" type=\"homogeneous\">\n"
        "      <float name=\"albedo\" value=\"0\"/>\n",
        w->file);
  write_table(w, "sigma_t", m, abbe_material_attenuation);
  fputs("    </medium>\n", w->file);
}

static void write_reflectance(const abbe_export_writing *w, const abbe_object *o) {
  fputs("      <spectrum name=\"reflectance\" type=\"irregular\">\n", w->file);
  for (int k = 0; k < 2; k++) {
    list l = {w->file, 0, k == 0};
    fprintf(w->file, "        <string name=\"%s\" value=\"", k == 0 ? "wavelengths" : "values");
    abbe_export_reflectance(o, put_one, &l);
    fputs("\"/>\n", w->file);
  }
  fputs("      </spectrum>\n", w->file);
}

static abbe_result write_diffuse(const abbe_export_writing *w, const abbe_object *o,
                                 const char *name, abbe_error *error) {
  fputs("    <bsdf type=\"twosided\"><bsdf type=\"diffuse\">\n", w->file);
  if (o->texture_path != NULL)
    fprintf(w->file,
            "      <texture name=\"reflectance\" type=\"bitmap\">"
            "<string name=\"filename\" value=\"%s-%s.exr\"/></texture>\n",
            w->files->name, name);
  else if (abbe_export_is_grey(o))
    abbe_number_write(w->file, "      <spectrum name=\"reflectance\" value=\"%.9g\"/>\n",
                      o->reflectance[0]);
  else
    write_reflectance(w, o);
  fputs("    </bsdf></bsdf>\n", w->file);
  return o->texture_path != NULL ? abbe_export_texture(w, o, name, error) : ABBE_OK;
}

static void write_mirror(const abbe_export_writing *w, const abbe_object *o) {
  const bool rough = abbe_brushing_is_rough(&o->brushing);
  fprintf(w->file, "    <bsdf type=\"twosided\"><bsdf type=\"%sconductor\">\n",
          rough ? "rough" : "");
  if (rough)
    abbe_number_write(w->file,
                      "      <string name=\"distribution\" value=\"ggx\"/>\n"
                      "      <float name=\"alpha\" value=\"%.9g\"/>\n",
                      abbe_export_roughness(o));
  if (o->conductor != NULL) {
    write_table(w, "eta", o->conductor, abbe_export_conductor_n);
    write_table(w, "k", o->conductor, abbe_export_conductor_k);
  } else {
    abbe_number_write(w->file,
                      "      <string name=\"material\" value=\"none\"/>\n"
                      "      <spectrum name=\"specular_reflectance\" value=\"%.9g\"/>\n",
                      o->mirror_reflectance);
  }
  fputs("    </bsdf></bsdf>\n", w->file);
}

static abbe_result write_object(const abbe_export_writing *w, size_t i, abbe_error *error) {
  const abbe_object *o = &w->scene->object[i];
  if (o->cloud) return ABBE_OK;
  const bool sphere = o->exact.kind == ABBE_EXACT_SPHERE;
  char name[ABBE_EXPORT_NAME_SIZE];
  abbe_result result = ABBE_OK;
  abbe_export_name(name, "o", i, o->name);
  fprintf(w->file, "  <shape type=\"%s\" id=\"%s\">\n", sphere ? "sphere" : "ply", name);
  if (sphere) {
    write_point(w, "    <point name=\"center\" value=\"", o->exact.centre, "\"/>\n");
    abbe_number_write(w->file, "    <float name=\"radius\" value=\"%.9g\"/>\n", o->exact.radius);
  } else {
    fprintf(w->file, "    <string name=\"filename\" value=\"%s-%s.ply\"/>\n", w->files->name, name);
    result = add_ply(w, name, o, error);
  }
  if (result != ABBE_OK) return result;
  if (o->material != NULL)
    write_glass(w, o->material);
  else if (o->mirror)
    write_mirror(w, o);
  else
    result = write_diffuse(w, o, name, error);
  fputs("  </shape>\n", w->file);
  return result;
}

abbe_result abbe_export_mitsuba(const abbe_export_writing *w, abbe_error *error) {
  abbe_result result = ABBE_OK;
  abbe_export_comment(w, "<!-- ", " -->\n");
  fprintf(w->file,
          "<!-- mitsuba -m scalar_spectral %s.xml: the picture is radiance in linear Rec.709, in "
          "W/(m2 sr) of white.\n     -D integrator=ptracer sees caustics of point lights on "
          "receivers, without absorption and without what glass shows;\n     -D n_NAME=1.5 sets "
          "another index, to draw a wavelength at a time. -->\n<scene version=\"3.0.0\">\n",
          w->files->name);
  write_head(w);
  for (size_t i = 0; i < w->scene->light_count; i++) write_light(w, &w->scene->light[i]);
  if (w->scene->environment != NULL) result = write_environment(w, error);
  for (size_t i = 0; i < w->scene->object_count && result == ABBE_OK; i++)
    result = write_object(w, i, error);
  fputs("</scene>\n", w->file);
  return result;
}
