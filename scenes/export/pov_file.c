#include "scenes/export/pov_file.h"

#include "base/file.h"
#include "base/maths.h"
#include "base/number.h"
#include "colorimetry/rgb_space.h"
#include "colorimetry/weights.h"
#include "spectral/wavelengths.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#define DEGREES (180.0 / ABBE_PI)

/* --- the index --- */

enum { STEPS = 350 }; /* a nanometre each */

static double light_at(const abbe_illuminant *illuminant, double lambda_nm) {
  double xyz[3];
  abbe_weights_band_xyz(illuminant, ABBE_POVRAY_VIOLET_NM, ABBE_POVRAY_RED_NM, lambda_nm - 0.5,
                        lambda_nm + 0.5, xyz);
  return xyz[0] + xyz[1] + xyz[2];
}

abbe_result abbe_pov_file_glass(const abbe_material *material, const abbe_illuminant *illuminant,
                                abbe_pov_glass *out, abbe_error *error) {
  double lambda_nm[STEPS + 1], n[STEPS + 1], light[STEPS + 1], sum = 0, all = 0;
  memset(out, 0, sizeof *out);
  for (int i = 0; i <= STEPS; i++) {
    lambda_nm[i] = ABBE_POVRAY_VIOLET_NM + i;
    ABBE_TRY(abbe_material_n(material, lambda_nm[i], &n[i], error));
    light[i] = light_at(illuminant, lambda_nm[i]);
  }
  out->index = abbe_povray_index_fit(lambda_nm, n, light, STEPS + 1);
  for (int i = 0; i <= STEPS; i++) {
    const double off = fabs(abbe_povray_index_at(&out->index, lambda_nm[i]) - n[i]);
    sum += light[i] * off * off;
    all += light[i];
    if (off <= out->worst && i > 0) continue;
    out->worst = off;
    out->worst_nm = lambda_nm[i];
  }
  out->rms = sqrt(sum / all);
  return ABBE_OK;
}

/* --- the file --- */

typedef struct writing {
  FILE *file;
  const abbe_scene *scene;
  const abbe_pov_options *options;
  double scale; /* units per metre */
  bool photons; /* there are refractors */
} writing;

double abbe_pov_file_scale(const abbe_scene *scene) {
  double min[3], max[3], size = 0;
  if (!abbe_scene_bounds(scene, true, true, min, max)) return 1;
  for (int k = 0; k < 3; k++) size = fmax(size, max[k] - min[k]);
  return size > 0 && isfinite(size) ? pow(10, round(log10(30 / size))) : 1;
}

/* A comment of one line, whatever the name holds. */
static void comment(const writing *w, const char *what, const char *name) {
  fprintf(w->file, "\n// %s '", what);
  for (; *name != '\0'; name++) fputc(iscntrl((unsigned char)*name) ? '?' : *name, w->file);
  fprintf(w->file, "'\n");
}

static void point(const writing *w, const char *before, const double p[3], const char *after) {
  abbe_number_write(w->file, "%s<%.12g, %.12g, %.12g>%s", before, w->scale * p[0], w->scale * p[1],
                    w->scale * p[2], after);
}

static void vector(const writing *w, const char *before, const double v[3], double length,
                   const char *after) {
  abbe_number_write(w->file, "%s<%.12g, %.12g, %.12g>%s", before, length * v[0], length * v[1],
                    length * v[2], after);
}

static void write_head(const writing *w) {
  const abbe_scene *s = w->scene;
  comment(w, "Abbe's scene", s->path != NULL ? s->path : "scene");
  abbe_number_write(
      w->file,
      "// %g units are a metre. The linear picture is radiance, W/(m2 sr), in Rec.709:\n"
      "//   povray +Iscene.pov +Oscene.exr +FE +W%zu +H%zu -D\n"
      "// Declare=Caustics=0 leaves the light out that refractors throw, not their shadows.\n"
      "#version 3.7;\n"
      "#ifndef (Caustics) #declare Caustics = 1; #end\n"
      "#ifndef (Photons) #declare Photons = %zu; #end\n"
      "#ifndef (Samples) #declare Samples = %zu; #end\n"
      "#ifndef (Gather) #declare Gather = 100; #end\n"
      "global_settings {\n"
      "  assumed_gamma 1\n  ambient_light rgb 1\n  max_trace_level 24\n  adc_bailout 1e-3\n",
      w->scale, s->camera.width, s->camera.height, w->options->photons, w->options->samples);
  if (w->photons)
    fprintf(w->file, "  #if (Caustics)\n  photons {\n    count Photons autostop 0 "
                     "gather Gather, 5 * Gather\n    max_trace_level 16 adc_bailout 1e-3\n  }\n"
                     "  #end\n");
  abbe_number_write(w->file, "}\nbackground { rgb %.12g }\n", s->background);
}

/* The camera by its own axes: no handedness is left to choose. */
static void write_camera(const writing *w) {
  const abbe_camera *c = &w->scene->camera;
  double forward[3], right[3], up[3];
  abbe_vector_subtract(c->target, c->eye, forward);
  abbe_vector_normalise(forward);
  abbe_vector_cross(forward, c->up, right);
  abbe_vector_normalise(right);
  abbe_vector_cross(right, forward, up);
  const double height = 2 * tan(0.5 * c->fov_y_rad);
  point(w, "camera {\n  perspective\n  location ", c->eye, "\n");
  vector(w, "  direction ", forward, 1, "\n");
  vector(w, "  right ", right, height * (double)c->width / (double)c->height, "\n");
  vector(w, "  up ", up, height, "\n}\n");
}

static void light_colour(const abbe_light *light, double rgb[3]) {
  double white[3], matrix[9];
  abbe_weights_band_xyz(&light->illuminant, ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM,
                        ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM, white);
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, matrix);
  abbe_rgb_space_apply(matrix, white, rgb);
}

/* A distance far below any from the light to what it lights, m. */
static double fade_length(const abbe_scene *scene, const abbe_light *light) {
  double min[3], max[3], away[3];
  abbe_scene_bounds(scene, true, true, min, max);
  for (int k = 0; k < 3; k++)
    away[k] = fmax(fabs(light->position[k] - min[k]), fabs(light->position[k] - max[k]));
  return 1e-4 * abbe_vector_length(away);
}

static void write_light(const writing *w, const abbe_light *light) {
  double rgb[3], at[3], aim[3], power = light->power / ABBE_PI;
  const bool parallel = light->kind == ABBE_LIGHT_DIRECTIONAL;
  comment(w, "light", light->name);
  light_colour(light, rgb);
  if (abbe_light_has_size(light)) power *= abbe_light_area(light);
  memcpy(at, light->position, sizeof at);
  if (parallel) {
    double min[3], max[3], size = 0;
    abbe_scene_bounds(w->scene, true, true, min, max);
    for (int k = 0; k < 3; k++) size += max[k] - min[k];
    for (int k = 0; k < 3; k++) at[k] = 0.5 * (min[k] + max[k]) - 2 * size * light->direction[k];
  } else {
    /* A light fades by 2 / (1 + (r / d)^2); with d far below r that is 2 d^2 / r^2. */
    power /= 2 * pow(fade_length(w->scene, light), 2);
  }
  for (int k = 0; k < 3; k++) aim[k] = at[k] + light->direction[k];
  point(w, "light_source {\n  ", at, "\n");
  vector(w, "  color rgb ", rgb, power, "\n");
  if (light->kind == ABBE_LIGHT_SPOT)
    abbe_number_write(w->file, "  spotlight tightness 0 radius %.12g falloff %.12g\n",
                      fmax(light->cone_rad - light->soft_rad, 0) * DEGREES,
                      light->cone_rad * DEGREES);
  if (light->kind == ABBE_LIGHT_RECTANGLE) {
    fprintf(w->file, "  // 9 x 9 points stand for the rectangle\n"
                     "  spotlight tightness 1 radius 90 falloff 90\n");
    vector(w, "  area_light ", light->edge[0], 2 * w->scale, ", ");
    vector(w, "", light->edge[1], 2 * w->scale, ", 9, 9\n");
  }
  if (light->kind == ABBE_LIGHT_DISK) {
    double u[3], v[3];
    const int axis = fabs(light->direction[0]) < 0.6 ? 0 : 1;
    const double hint[3] = {axis == 0, axis == 1, 0};
    abbe_vector_cross(light->direction, hint, u);
    abbe_vector_normalise(u);
    abbe_vector_cross(light->direction, u, v);
    const double side = 2 * light->radius * w->scale;
    fprintf(w->file, "  // 9 x 9 points stand for the disk\n"
                     "  spotlight tightness 1 radius 90 falloff 90\n");
    vector(w, "  area_light ", u, side, ", ");
    vector(w, "", v, side, ", 9, 9 circular\n");
  }
  if (parallel) fprintf(w->file, "  parallel\n");
  if (light->kind != ABBE_LIGHT_POINT) point(w, "  point_at ", aim, "\n");
  if (!parallel)
    abbe_number_write(w->file, "  fade_power 2 fade_distance %.12g\n",
                      w->scale * fade_length(w->scene, light));
  if (w->photons)
    fprintf(w->file, "  photons { refraction on reflection on%s }\n",
            abbe_light_has_size(light) ? " area_light" : "");
  fprintf(w->file, "}\n");
}

static void list(const writing *w, const char *name, const double (*v)[3], size_t count,
                 double scale) {
  fprintf(w->file, "  %s { %zu", name, count);
  for (size_t i = 0; i < count; i++) vector(w, i % 4 == 0 ? ",\n    " : ", ", v[i], scale, "");
  fprintf(w->file, " }\n");
}

static void write_mesh(const writing *w, const abbe_mesh *mesh, bool solid) {
  fprintf(w->file, "mesh2 {\n");
  list(w, "vertex_vectors", (const double(*)[3])mesh->position, mesh->vertex_count, w->scale);
  list(w, "normal_vectors", (const double(*)[3])mesh->normal, mesh->vertex_count, 1);
  if (mesh->uv != NULL) {
    fprintf(w->file, "  uv_vectors { %zu", mesh->vertex_count);
    for (size_t i = 0; i < mesh->vertex_count; i++)
      abbe_number_write(w->file, ", <%.12g, %.12g>", mesh->uv[i][0], mesh->uv[i][1]);
    fprintf(w->file, " }\n");
  }
  fprintf(w->file, "  face_indices { %zu", mesh->face_count);
  for (size_t i = 0; i < mesh->face_count; i++)
    fprintf(w->file, "%s<%u, %u, %u>", i % 8 == 0 ? ",\n    " : ", ", mesh->face[i][0],
            mesh->face[i][1], mesh->face[i][2]);
  fprintf(w->file, " }\n%s", solid ? "  inside_vector <0.3090, 0.2279, 0.9233>\n" : "");
}

static void write_surface(const writing *w, const abbe_object *object) {
  if (object->exact.kind != ABBE_EXACT_SPHERE) {
    write_mesh(w, &object->mesh, abbe_object_kind_of(object) == ABBE_OBJECT_REFRACTOR);
    return;
  }
  point(w, "sphere {\n  ", object->exact.centre, "");
  abbe_number_write(w->file, ", %.12g\n", w->scale * object->exact.radius);
}

/* exp(-(1 - fade_color) depth / fade_distance): three attenuations, each of its colour's third of
 * the light. */
static void write_absorption(const writing *w, const abbe_material *material) {
  static const double range[3][2] = {
      {580, ABBE_POVRAY_RED_NM}, {490, 580}, {ABBE_POVRAY_VIOLET_NM, 490}};
  double mean[3] = {0}, most = 0;
  for (int c = 0; c < 3; c++) {
    int count = 0;
    for (double nm = range[c][0]; nm < range[c][1]; nm += 1, count++)
      mean[c] += abbe_material_attenuation(material, nm);
    mean[c] /= count;
    most = fmax(most, mean[c]);
  }
  if (!(most > 0)) return;
  abbe_number_write(
      w->file, "    fade_power 1001 fade_distance %.12g fade_color rgb <%.12g, %.12g, %.12g>\n",
      w->scale / most, 1 - mean[0] / most, 1 - mean[1] / most, 1 - mean[2] / most);
}

static abbe_result write_refractor(const writing *w, const abbe_object *object, abbe_error *error) {
  abbe_pov_glass glass;
  ABBE_TRY(abbe_pov_file_glass(object->material, abbe_scene_illuminant(w->scene), &glass, error));
  comment(w, "refractor", object->name);
  abbe_number_write(w->file, "// %s: off by %.2g at the most (%g nm), by %.2g in the mean\n",
                    object->material->name, glass.worst, glass.worst_nm, glass.rms);
  fprintf(w->file, "#declare Surface = ");
  write_surface(w, object);
  abbe_number_write(
      w->file,
      "}\n"
      "object {\n  Surface\n  pigment { rgbt 1 }\n"
      "  finish { ambient 0 diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }\n"
      "  interior {\n    ior %.12g\n",
      glass.index.ior);
  if (glass.index.dispersion != 1)
    abbe_number_write(w->file, "    dispersion %.12g dispersion_samples Samples\n",
                      glass.index.dispersion);
  write_absorption(w, object->material);
  fprintf(w->file, "  }\n  photons { target reflection on refraction on collect off }\n"
                   "  #if (!Caustics) no_shadow #end\n}\n"
                   "#if (!Caustics)\n" /* nothing but its shadow */
                   "object { Surface pigment { rgb 0 } finish { ambient 0 diffuse 0 } no_image "
                   "no_reflection }\n"
                   "#end\n");
  return ABBE_OK;
}

static abbe_result write_receiver(const writing *w, const abbe_object *object, abbe_error *error) {
  const double *r = object->reflectance;
  if (object->texture_path != NULL && strpbrk(object->texture_path, "\"\\\n") != NULL)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the texture '%.200s' of '%.60s' has a quote, a backslash or a line's "
                          "end in its path, which POV-Ray cannot read; give it a plainer name",
                          object->texture_path, object->name);
  comment(w, "receiver", object->name);
  write_surface(w, object);
  const double ambient = w->scene->ambient / ABBE_PI, grey = (r[0] + r[1] + r[2]) / 3;
  const bool textured = object->texture_path != NULL;
  if (textured) {
    if (r[0] != r[1] || r[1] != r[2])
      fprintf(w->file, "  // the mean of its reflectance over red, green and blue\n");
    abbe_number_write(w->file,
                      "  pigment { uv_mapping image_map { png \"%s\" gamma srgb interpolate 2 } "
                      "scale <%.12g, %.12g, 1> }\n",
                      object->texture_path, 1 / object->texture_repeat[0],
                      1 / object->texture_repeat[1]);
  } else {
    vector(w, "  pigment { rgb ", r, 1, " }\n");
  }
  abbe_number_write(w->file, "  finish { ambient %.12g diffuse %.12g }\n}\n",
                    textured ? ambient * grey : ambient, textured ? grey : 1);
  return ABBE_OK;
}

static abbe_result write_scene(const writing *w, abbe_error *error) {
  write_head(w);
  write_camera(w);
  for (size_t i = 0; i < w->scene->light_count; i++) write_light(w, &w->scene->light[i]);
  for (size_t i = 0; i < w->scene->object_count; i++) {
    const abbe_object *object = &w->scene->object[i];
    if (object->cloud) continue;
    ABBE_TRY(abbe_object_kind_of(object) == ABBE_OBJECT_REFRACTOR
                 ? write_refractor(w, object, error)
                 : write_receiver(w, object, error));
  }
  return ABBE_OK;
}

static abbe_result check_options(const abbe_pov_options *o, abbe_error *error) {
  if (o->photons > ABBE_POV_MAX_PHOTONS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu photons are more than POV-Ray can hold; at most %d", o->photons,
                          ABBE_POV_MAX_PHOTONS);
  if (o->samples < 2 || o->samples > ABBE_POV_MAX_SAMPLES)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "POV-Ray takes 2 to %d samples of the spectrum, not %zu",
                          ABBE_POV_MAX_SAMPLES, o->samples);
  return ABBE_OK;
}

abbe_result abbe_pov_file_write(const char *path, const abbe_scene *scene,
                                const abbe_pov_options *options, abbe_error *error) {
  abbe_pov_options o = options != NULL ? *options : (abbe_pov_options){0};
  if (o.photons == 0) o.photons = 100000;
  if (o.samples == 0) o.samples = 31;
  abbe_result result = check_options(&o, error);
  abbe_file_writer writer = {0};
  if (result == ABBE_OK) result = abbe_scene_check(scene, error);
  if (result == ABBE_OK && scene->environment != NULL)
    result = abbe_error_set(error, ABBE_UNSUPPORTED,
                            "the scene has an 'environment', which is not exported; leave it out, "
                            "and give the scene 'lights'");
  const char *hazy = scene->medium != NULL ? "a 'medium'" : NULL;
  for (size_t i = 0; i < scene->object_count && hazy == NULL; i++)
    if (scene->object[i].medium != NULL)
      hazy = scene->object[i].cloud ? "a cloud under 'clouds'" : "a 'medium'";
  if (result == ABBE_OK && hazy != NULL)
    result = abbe_error_set(error, ABBE_UNSUPPORTED,
                            "the scene has %s that scatters light, which is not written for "
                            "POV-Ray; leave it out",
                            hazy);
  const abbe_object *mirror = abbe_scene_mirror(scene);
  if (result == ABBE_OK && mirror != NULL)
    result = abbe_error_set(error, ABBE_UNSUPPORTED,
                            "the object '%s' (line %zu) is a mirror, which is not written for "
                            "POV-Ray; leave it out",
                            mirror->name, mirror->line);
  if (result == ABBE_OK) result = abbe_file_writer_open(&writer, path, error);
  if (result != ABBE_OK) return result;
  double min[3], max[3];
  const writing w = {writer.stream, scene, &o, abbe_pov_file_scale(scene),
                     abbe_scene_bounds(scene, true, false, min, max)};
  result = write_scene(&w, error);
  return abbe_file_writer_end(&writer, result, error);
}
