/* A scene for LuxCore [LuxCore]: .scn, and .cfg beside it. Its lights are red, green and blue;
 * glass has Cauchy's A as interiorior and B, in um2, as cauchyb, as its source has it (a comment
 * there keeps the form by n_d, of forks); the camera's angle is that of the longer side. */
#include "scenes/export/export_writing.h"

#include "base/maths.h"
#include "base/number.h"

#include <math.h>
#include <stdlib.h>

static void put(const abbe_export_writing *w, const char *room, const char *name, const char *key,
                const double v[3]) {
  fprintf(w->file, "scene.%s.%s.%s = ", room, name, key);
  abbe_export_vector(w->file, v, " ");
  fputc('\n', w->file);
}

static void put_number(const abbe_export_writing *w, const char *room, const char *name,
                       const char *key, double value) {
  abbe_number_write(w->file, "scene.%s.%s.%s = %.9g\n", room, name, key, value);
}

static void put_word(const abbe_export_writing *w, const char *room, const char *name,
                     const char *key, const char *word) {
  fprintf(w->file, "scene.%s.%s.%s = %s\n", room, name, key, word);
}

static void write_camera(const abbe_export_writing *w) {
  const abbe_camera *c = &w->scene->camera;
  const double aspect = (double)c->width / (double)c->height;
  const double fov = aspect > 1 ? 2 * atan(aspect * tan(0.5 * c->fov_y_rad)) : c->fov_y_rad;
  fputs("scene.camera.type = perspective\nscene.camera.lookat.orig = ", w->file);
  abbe_export_vector(w->file, c->eye, " ");
  fputs("\nscene.camera.lookat.target = ", w->file);
  abbe_export_vector(w->file, c->target, " ");
  fputs("\nscene.camera.up = ", w->file);
  abbe_export_vector(w->file, c->up, " ");
  abbe_number_write(w->file, "\nscene.camera.fieldofview = %.9g\nscene.camera.cliphither = 1e-5\n",
                    fov * ABBE_EXPORT_DEGREES);
}

static void write_mesh(const abbe_export_writing *w, const char *name, const abbe_mesh *mesh,
                       const double repeat[2]) {
  put_word(w, "shapes", name, "type", "inlinedmesh");
  fprintf(w->file, "scene.shapes.%s.vertices =", name);
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    fputc(' ', w->file);
    abbe_export_vector(w->file, mesh->position[i], " ");
  }
  fprintf(w->file, "\nscene.shapes.%s.normals =", name);
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    fputc(' ', w->file);
    abbe_export_vector(w->file, mesh->normal[i], " ");
  }
  if (mesh->uv != NULL && repeat != NULL) { /* rows of pictures go downwards with v */
    fprintf(w->file, "\nscene.shapes.%s.uvs =", name);
    for (size_t i = 0; i < mesh->vertex_count; i++)
      abbe_number_write(w->file, " %.9g %.9g", repeat[0] * mesh->uv[i][0],
                        1 - repeat[1] * mesh->uv[i][1]);
  }
  fprintf(w->file, "\nscene.shapes.%s.faces =", name);
  for (size_t f = 0; f < mesh->face_count; f++)
    fprintf(w->file, " %u %u %u", mesh->face[f][0], mesh->face[f][1], mesh->face[f][2]);
  fprintf(w->file, "\nscene.objects.%s.shape = %s\n", name, name);
}

static abbe_result write_area(const abbe_export_writing *w, const char *name,
                              const abbe_light *light, const double rgb[3], abbe_error *error) {
  static const double black[3] = {0};
  abbe_mesh mesh = {0};
  const abbe_result result = abbe_export_light_mesh(light, &mesh, error);
  if (result == ABBE_OK) {
    put_word(w, "materials", name, "type", "matte");
    put(w, "materials", name, "kd", black);
    put(w, "materials", name, "emission", rgb);
    write_mesh(w, name, &mesh, NULL);
    put_word(w, "objects", name, "material", name);
  }
  abbe_mesh_free(&mesh);
  return result;
}

static abbe_result write_light(const abbe_export_writing *w, size_t i, abbe_error *error) {
  const abbe_light *light = &w->scene->light[i];
  char name[ABBE_EXPORT_NAME_SIZE];
  double rgb[3];
  const double sphere = light->kind == ABBE_LIGHT_POINT ? 4 * ABBE_PI : 1;
  abbe_export_name(name, "l", i, light->name);
  abbe_export_light_rgb(&light->illuminant, rgb);
  for (int c = 0; c < 3; c++) rgb[c] *= sphere * light->power;
  fputc('\n', w->file);
  if (abbe_light_has_size(light)) return write_area(w, name, light, rgb, error);
  put_word(w, "lights", name, "type",
           light->kind == ABBE_LIGHT_POINT  ? "point"
           : light->kind == ABBE_LIGHT_SPOT ? "spot"
                                            : "sharpdistant");
  put(w, "lights", name, "color", rgb);
  if (light->kind == ABBE_LIGHT_DIRECTIONAL) {
    put(w, "lights", name, "direction", light->direction);
    return ABBE_OK;
  }
  put(w, "lights", name, "position", light->position);
  if (light->kind == ABBE_LIGHT_POINT) return ABBE_OK;
  double target[3];
  for (int k = 0; k < 3; k++) target[k] = light->position[k] + light->direction[k];
  put(w, "lights", name, "target", target);
  put_number(w, "lights", name, "coneangle", light->cone_rad * ABBE_EXPORT_DEGREES);
  put_number(w, "lights", name, "conedeltaangle", light->soft_rad * ABBE_EXPORT_DEGREES);
  return ABBE_OK;
}

/* From the zenith down, and round from +x towards +y. */
static void map_direction(double u, double v, double out[3]) {
  abbe_export_direction(u, v, out);
}

static abbe_result write_environment(const abbe_export_writing *w, abbe_error *error) {
  fprintf(w->file,
          "\nscene.lights.environment.type = infinite\n"
          "scene.lights.environment.file = \"%s-environment.exr\"\n"
          "scene.lights.environment.colorspace = nop\n",
          w->files->name);
  return abbe_export_panorama(w, map_direction, error);
}

static void write_glass(const abbe_export_writing *w, size_t i) {
  const abbe_scene_export_glass *g = &w->report->glass[i];
  const double *v = g->index.value;
  char name[ABBE_EXPORT_NAME_SIZE];
  abbe_export_name(name, "m", i, g->material->name);
  fputc('\n', w->file);
  put_word(w, "materials", name, "type", "glass");
  put_number(w, "materials", name, "interiorior", v[0]);
  put_number(w, "materials", name, "exteriorior", 1);
  if (v[1] > 0) put_number(w, "materials", name, "cauchyb", v[1]);
  if (g->material->attenuation == NULL) return;
  double per_m[3];
  char volume[ABBE_EXPORT_NAME_SIZE]; /* volumes and materials share their names */
  abbe_export_name(volume, "v", i, g->material->name);
  abbe_export_attenuation_rgb(g->material, per_m);
  put_word(w, "volumes", volume, "type", "clear");
  put(w, "volumes", volume, "absorption", per_m);
  put_word(w, "materials", name, "volume.interior", volume);
}

static void write_mirror(const abbe_export_writing *w, const char *name, const abbe_object *o) {
  static const double nm[3] = {611.4, 549.1, 464.2};
  double n[3], k[3];
  if (o->conductor == NULL) {
    for (int c = 0; c < 3; c++) n[c] = o->mirror_reflectance;
    put_word(w, "materials", name, "type", "mirror");
    put(w, "materials", name, "kr", n);
    return;
  }
  for (int c = 0; c < 3; c++) abbe_export_nk(o->conductor, nm[c], &n[c], &k[c]);
  put_word(w, "textures", name, "type", "fresnelconst");
  put(w, "textures", name, "n", n);
  put(w, "textures", name, "k", k);
  put_word(w, "materials", name, "type", "metal2");
  put_word(w, "materials", name, "fresnel", name);
  const double roughness = abbe_export_roughness(o);
  put_number(w, "materials", name, "uroughness", roughness);
  put_number(w, "materials", name, "vroughness", roughness);
}

static abbe_result write_object(const abbe_export_writing *w, size_t i, abbe_error *error) {
  const abbe_object *o = &w->scene->object[i];
  if (o->cloud) return ABBE_OK;
  char name[ABBE_EXPORT_NAME_SIZE], material[ABBE_EXPORT_NAME_SIZE];
  abbe_result result = ABBE_OK;
  abbe_export_name(name, "o", i, o->name);
  fputc('\n', w->file);
  if (o->mirror) {
    write_mirror(w, name, o);
  } else if (o->texture_path != NULL) {
    put_word(w, "textures", name, "type", "imagemap");
    fprintf(w->file, "scene.textures.%s.file = \"%s-%s.exr\"\n", name, w->files->name, name);
    put_word(w, "textures", name, "colorspace", "nop");
    put_word(w, "materials", name, "type", "matte");
    put_word(w, "materials", name, "kd", name);
    result = abbe_export_texture(w, o, name, error);
  } else if (o->material == NULL) {
    put_word(w, "materials", name, "type", "matte");
    put(w, "materials", name, "kd", o->reflectance);
  }
  write_mesh(w, name, &o->mesh, o->texture_path != NULL ? o->texture_repeat : NULL);
  if (o->material != NULL)
    abbe_export_name(material, "m", abbe_export_glass_of(w, o->material), o->material->name);
  put_word(w, "objects", name, "material", o->material != NULL ? material : name);
  return result;
}

static abbe_result add_settings(const abbe_export_writing *w, abbe_error *error) {
  const abbe_camera *c = &w->scene->camera;
  char *text = NULL;
  size_t size = 0;
  FILE *memory = open_memstream(&text, &size);
  if (memory == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a file");
  fprintf(memory,
          "scene.file = %s.scn\nrenderengine.type = PATHCPU\nsampler.type = SOBOL\n"
          "path.pathdepth.total = 24\npath.pathdepth.specular = 24\npath.pathdepth.diffuse = 4\n"
          "path.hybridbackforward.enable = 1\npath.hybridbackforward.partition = 0.5\n"
          "film.width = %zu\nfilm.height = %zu\nfilm.imagepipelines.0.0.type = NOP\n"
          "film.outputs.0.type = RGB\nfilm.outputs.0.filename = %s.exr\nbatch.haltspp = 256\n",
          w->files->name, c->width, c->height, w->files->name);
  if (fclose(memory) != 0) {
    free(text);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a file");
  }
  return abbe_export_files_add(w->files, ".cfg", text, size, error);
}

abbe_result abbe_export_luxcore(const abbe_export_writing *w, abbe_error *error) {
  abbe_export_comment(w, "# ", "\n");
  fprintf(w->file,
          "# luxcoreconsole %s.cfg: the picture is radiance in linear Rec.709, in W/(m2 sr) of "
          "white.\n\n",
          w->files->name);
  write_camera(w);
  for (size_t i = 0; i < w->report->glass_count; i++) write_glass(w, i);
  ABBE_TRY(add_settings(w, error));
  for (size_t i = 0; i < w->scene->light_count; i++) ABBE_TRY(write_light(w, i, error));
  if (w->scene->environment != NULL) ABBE_TRY(write_environment(w, error));
  for (size_t i = 0; i < w->scene->object_count; i++) ABBE_TRY(write_object(w, i, error));
  return ABBE_OK;
}
