/* A scene for pbrt-v4 [Pbrt4]. Its cameras mirror right-handed worlds, hence the scale before
 * LookAt; light spectra are scaled to a luminance of 1, so that "scale" is Abbe's power; an inline
 * spectrum is 0 outside its own wavelengths, so tables go from 360 to 830 nm. */
#include "scenes/export/export_writing.h"

#include "base/maths.h"
#include "base/number.h"

#include <math.h>

typedef struct line {
  FILE *file;
  size_t count;
} line;

static void put_pair(void *user, double lambda_nm, double value) {
  line *l = user;
  abbe_number_write(l->file, "%s%.9g %.9g", l->count++ % 6 == 0 ? "\n    " : "  ", lambda_nm,
                    value);
}

static void put_table(FILE *file, const char *name, const abbe_material *m,
                      double (*at)(const abbe_material *m, double lambda_nm)) {
  line l = {file, 0};
  fprintf(file, "\n  \"spectrum %s\" [", name);
  for (size_t i = 0; i < ABBE_EXPORT_TABLE_COUNT; i++) {
    const double nm = ABBE_EXPORT_TABLE_FIRST_NM + (double)i * ABBE_EXPORT_TABLE_STEP_NM;
    put_pair(&l, nm, at(m, nm));
  }
  fputs(" ]", file);
}

static void write_camera(const abbe_export_writing *w) {
  const abbe_camera *c = &w->scene->camera;
  const double aspect = (double)c->width / (double)c->height;
  /* the angle is that of the shorter side */
  const double fov = aspect >= 1 ? c->fov_y_rad : 2 * atan(aspect * tan(0.5 * c->fov_y_rad));
  fputs("Scale -1 1 1\nLookAt ", w->file);
  abbe_export_vector(w->file, c->eye, " ");
  fputs("  ", w->file);
  abbe_export_vector(w->file, c->target, " ");
  fputs("  ", w->file);
  abbe_export_vector(w->file, c->up, " ");
  abbe_number_write(w->file, "\nCamera \"perspective\" \"float fov\" %.9g\n",
                    fov * ABBE_EXPORT_DEGREES);
  fprintf(w->file,
          "Film \"rgb\" \"integer xresolution\" %zu \"integer yresolution\" %zu\n"
          "  \"string filename\" \"%s.exr\" \"bool savefp16\" false\n"
          "Sampler \"halton\" \"integer pixelsamples\" 256\n"
          "Integrator \"bdpt\" \"integer maxdepth\" 24\n\nWorldBegin\n",
          c->width, c->height, w->files->name);
}

static void write_spectrum(const abbe_export_writing *w, const char *name,
                           const abbe_light *light) {
  line l = {w->file, 0};
  fprintf(w->file, "\n  \"spectrum %s\" [", name);
  abbe_export_light_spectrum(&light->illuminant, 1, put_pair, &l);
  abbe_number_write(w->file, " ]\n  \"float scale\" %.9g\n", light->power);
}

/* Columns of a matrix, as pbrt reads them. */
static void write_frame(const abbe_export_writing *w, const abbe_light *light) {
  double a[3], b[3];
  abbe_export_basis(light->direction, a, b);
  fputs("  Transform [ ", w->file);
  abbe_export_vector(w->file, a, " ");
  fputs(" 0  ", w->file);
  abbe_export_vector(w->file, b, " ");
  fputs(" 0  ", w->file);
  abbe_export_vector(w->file, light->direction, " ");
  fputs(" 0  ", w->file);
  abbe_export_vector(w->file, light->position, " ");
  fputs(" 1 ]\n", w->file);
}

static void write_mesh(const abbe_export_writing *w, const abbe_mesh *mesh,
                       const double repeat[2]) {
  fputs("  Shape \"trianglemesh\"\n    \"point3 P\" [", w->file);
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    fputs(i % 3 == 0 ? "\n      " : "  ", w->file);
    abbe_export_vector(w->file, mesh->position[i], " ");
  }
  fputs(" ]\n    \"normal N\" [", w->file);
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    fputs(i % 3 == 0 ? "\n      " : "  ", w->file);
    abbe_export_vector(w->file, mesh->normal[i], " ");
  }
  if (mesh->uv != NULL && repeat != NULL) {
    fputs(" ]\n    \"point2 uv\" [", w->file);
    for (size_t i = 0; i < mesh->vertex_count; i++)
      abbe_number_write(w->file, "%s%.9g %.9g", i % 6 == 0 ? "\n      " : "  ",
                        repeat[0] * mesh->uv[i][0], repeat[1] * mesh->uv[i][1]);
  }
  fputs(" ]\n    \"integer indices\" [", w->file);
  for (size_t i = 0; i < mesh->face_count; i++)
    fprintf(w->file, "%s%u %u %u", i % 8 == 0 ? "\n      " : "  ", mesh->face[i][0],
            mesh->face[i][1], mesh->face[i][2]);
  fputs(" ]\n", w->file);
}

static abbe_result write_area(const abbe_export_writing *w, const abbe_light *light,
                              abbe_error *error) {
  abbe_mesh mesh = {0};
  abbe_result result = ABBE_OK;
  fputs("\nAttributeBegin\n  Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
        "  AreaLightSource \"diffuse\"",
        w->file);
  write_spectrum(w, "L", light);
  if (light->kind == ABBE_LIGHT_DISK) {
    write_frame(w, light);
    abbe_number_write(w->file, "  Shape \"disk\" \"float radius\" %.9g\n", light->radius);
  } else {
    result = abbe_export_light_mesh(light, &mesh, error);
    if (result == ABBE_OK) write_mesh(w, &mesh, NULL);
  }
  abbe_mesh_free(&mesh);
  fputs("AttributeEnd\n", w->file);
  return result;
}

static abbe_result write_light(const abbe_export_writing *w, const abbe_light *light,
                               abbe_error *error) {
  const double *at = light->position, *d = light->direction;
  if (abbe_light_has_size(light)) return write_area(w, light, error);
  if (light->kind == ABBE_LIGHT_DIRECTIONAL) {
    abbe_number_write(w->file,
                      "\nLightSource \"distant\" \"point3 from\" [ %.9g %.9g %.9g ] "
                      "\"point3 to\" [ 0 0 0 ]",
                      -d[0], -d[1], -d[2]);
    write_spectrum(w, "L", light);
    return ABBE_OK;
  }
  fprintf(w->file, "\nLightSource \"%s\" \"point3 from\" [ ",
          light->kind == ABBE_LIGHT_SPOT ? "spot" : "point");
  abbe_export_vector(w->file, at, " ");
  if (light->kind == ABBE_LIGHT_SPOT)
    abbe_number_write(w->file,
                      " ] \"point3 to\" [ %.9g %.9g %.9g ]\n"
                      "  \"float coneangle\" %.9g \"float conedeltaangle\" %.9g",
                      at[0] + d[0], at[1] + d[1], at[2] + d[2],
                      light->cone_rad * ABBE_EXPORT_DEGREES, light->soft_rad * ABBE_EXPORT_DEGREES);
  else
    fputs(" ]", w->file);
  write_spectrum(w, "I", light);
  return ABBE_OK;
}

/* Where the middle of pbrt's square of directions of equal area looks to +z [Clarberg2008]. */
static void square_direction(double across, double down, double out[3]) {
  const double u = 2 * across - 1, v = 2 * down - 1;
  const double edge = 1 - (fabs(u) + fabs(v)), r = 1 - fabs(edge);
  const double quarter = 0.25 * ABBE_PI;
  const double phi = r > 0 ? quarter * ((fabs(v) - fabs(u)) / r + 1) : quarter;
  const double away = r * sqrt(fmax(2 - r * r, 0));
  out[0] = copysign(away * cos(phi), u);
  out[1] = copysign(away * sin(phi), v);
  out[2] = copysign(1 - r * r, edge);
}

static abbe_result write_environment(const abbe_export_writing *w, abbe_error *error) {
  const size_t width = w->scene->environment->map.width, side = width < 1024 ? width : 1024;
  fprintf(w->file,
          "\nLightSource \"infinite\" \"string filename\" \"%s-environment.exr\" "
          "\"float scale\" 1\n",
          w->files->name);
  return abbe_export_environment(w, side, side, square_direction, error);
}

static void write_glass(const abbe_export_writing *w, size_t i) {
  const abbe_scene_export_glass *g = &w->report->glass[i];
  char name[ABBE_EXPORT_NAME_SIZE];
  line l = {w->file, 0};
  abbe_export_name(name, "m", i, g->material->name);
  fprintf(w->file,
          "\nMakeNamedMaterial \"%s\" \"string type\" \"dielectric\" \"float roughness\" 0\n"
          "  \"spectrum eta\" [",
          name);
  for (size_t k = 0; k < ABBE_EXPORT_TABLE_COUNT; k++)
    put_pair(&l, ABBE_EXPORT_TABLE_FIRST_NM + (double)k * ABBE_EXPORT_TABLE_STEP_NM,
             g->index.table[k]);
  fputs(" ]\n", w->file);
  if (g->material->attenuation == NULL) return;
  fprintf(w->file,
          "MakeNamedMedium \"%s\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [ 0 0 0 ]", name);
  put_table(w->file, "sigma_a", g->material, abbe_material_attenuation);
  fputc('\n', w->file);
}

/* GGX's alpha is what pbrt takes without remapping. */
static void put_roughness(FILE *file, const abbe_object *o) {
  if (!abbe_brushing_is_rough(&o->brushing))
    fputs(" \"float roughness\" 0", file);
  else
    abbe_number_write(file, " \"float roughness\" %.9g \"bool remaproughness\" false",
                      abbe_export_roughness(o));
}

static abbe_result write_material(const abbe_export_writing *w, size_t i, const abbe_object *o,
                                  abbe_error *error) {
  char name[ABBE_EXPORT_NAME_SIZE];
  if (o->material != NULL) {
    abbe_export_name(name, "m", abbe_export_glass_of(w, o->material), o->material->name);
    fprintf(w->file, "  NamedMaterial \"%s\"\n", name);
    if (o->material->attenuation != NULL) fprintf(w->file, "  MediumInterface \"%s\" \"\"\n", name);
  } else if (o->conductor != NULL) {
    fputs("  Material \"conductor\"", w->file);
    put_roughness(w->file, o);
    put_table(w->file, "eta", o->conductor, abbe_export_conductor_n);
    put_table(w->file, "k", o->conductor, abbe_export_conductor_k);
    fputc('\n', w->file);
  } else if (o->mirror) {
    fputs("  Material \"conductor\"", w->file);
    put_roughness(w->file, o);
    abbe_number_write(w->file, " \"spectrum reflectance\" [ 360 %.9g 830 %.9g ]\n",
                      o->mirror_reflectance, o->mirror_reflectance);
  } else if (o->texture_path != NULL) {
    abbe_export_name(name, "o", i, o->name);
    fprintf(w->file,
            "  Texture \"%s\" \"spectrum\" \"imagemap\" \"string filename\" \"%s-%s.exr\"\n"
            "  Material \"diffuse\" \"texture reflectance\" \"%s\"\n",
            name, w->files->name, name, name);
    return abbe_export_texture(w, o, name, error);
  } else if (abbe_export_is_grey(o)) {
    abbe_number_write(w->file,
                      "  Material \"diffuse\" \"spectrum reflectance\" [ 360 %.9g 830 %.9g ]\n",
                      o->reflectance[0], o->reflectance[0]);
  } else {
    line l = {w->file, 0};
    fputs("  Material \"diffuse\" \"spectrum reflectance\" [", w->file);
    abbe_export_reflectance(o, put_pair, &l);
    fputs(" ]\n", w->file);
  }
  return ABBE_OK;
}

static abbe_result write_object(const abbe_export_writing *w, size_t i, abbe_error *error) {
  const abbe_object *o = &w->scene->object[i];
  if (o->cloud) return ABBE_OK;
  char name[ABBE_EXPORT_NAME_SIZE];
  fprintf(w->file, "\n# %s\nAttributeBegin\n", abbe_export_name(name, "o", i, o->name));
  const abbe_result result = write_material(w, i, o, error);
  if (o->exact.kind == ABBE_EXACT_SPHERE) {
    fputs("  Translate ", w->file);
    abbe_export_vector(w->file, o->exact.centre, " ");
    abbe_number_write(w->file, "\n  Shape \"sphere\" \"float radius\" %.9g\n", o->exact.radius);
  } else {
    write_mesh(w, &o->mesh, o->texture_path != NULL ? o->texture_repeat : NULL);
  }
  fputs("AttributeEnd\n", w->file);
  return result;
}

abbe_result abbe_export_pbrt(const abbe_export_writing *w, abbe_error *error) {
  abbe_export_comment(w, "# ", "\n");
  fprintf(w->file,
          "# pbrt %s.pbrt: the picture is radiance in linear Rec.709, in W/(m2 sr) of white.\n"
          "# bdpt sees caustics but for those seen through glass; sppm sees these, without "
          "absorption.\n\n",
          w->files->name);
  write_camera(w);
  for (size_t i = 0; i < w->report->glass_count; i++) write_glass(w, i);
  for (size_t i = 0; i < w->scene->light_count; i++)
    ABBE_TRY(write_light(w, &w->scene->light[i], error));
  if (w->scene->environment != NULL) ABBE_TRY(write_environment(w, error));
  for (size_t i = 0; i < w->scene->object_count; i++) ABBE_TRY(write_object(w, i, error));
  return ABBE_OK;
}
