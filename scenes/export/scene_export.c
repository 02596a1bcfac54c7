#include "scenes/export/scene_export.h"

#include "base/file.h"
#include "scenes/export/export_writing.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

/* What a format cannot hold of a scene, before anything is written. */

typedef struct survey {
  const abbe_scene *scene;
  abbe_scene_export_target target;
  bool spectral; /* spectra as such, not red, green and blue */
  bool spheres;
  abbe_scene_export_report *report;
} survey;

#define LOST(s, name, ...)                                                                         \
  abbe_report_add(&(s)->report->notes, ABBE_NOTE_LOST, 0, name, __VA_ARGS__)
#define CHANGED(s, name, ...)                                                                      \
  abbe_report_add(&(s)->report->notes, ABBE_NOTE_CHANGED, 0, name, __VA_ARGS__)

static abbe_result add_glass(const survey *s, const abbe_material *m, abbe_error *error) {
#define ABBE_SURVEY_FORM(code, name, ending, form, program) ABBE_EXPORT_FORM_##form,
  static const abbe_export_form forms[] = {ABBE_SCENE_EXPORTS(ABBE_SURVEY_FORM)};
  abbe_scene_export_report *r = s->report;
  for (size_t i = 0; i < r->glass_count; i++)
    if (r->glass[i].material == m) return ABBE_OK;
  abbe_scene_export_glass *all = realloc(r->glass, (r->glass_count + 1) * sizeof *all);
  if (all == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a report");
  r->glass = all;
  abbe_scene_export_glass *g = &all[r->glass_count];
  ABBE_TRY(abbe_export_index_make(m, forms[s->target], &g->index, error));
  g->material = m;
  r->glass_count++;
  if (g->index.held)
    abbe_report_add(&r->notes, ABBE_NOTE_ASSUMED, 0, m->name,
                    "its record goes from %.4g to %.4g nm; beyond, n is held", m->min_nm,
                    m->max_nm);
  if (abbe_material_is_uniaxial(m))
    LOST(s, m->name, "its double refraction; the ordinary index is written");
  if (abbe_material_is_biaxial(m))
    LOST(s, m->name, "its double refraction; the middle index is written");
  if (abbe_material_is_pleochroic(m))
    LOST(s, m->name, "its pleochroism; the mean of its absorption over its axes is written");
  if (abbe_material_is_fluorescent(m))
    LOST(s, m->name, "its fluorescence%s", m->attenuation == NULL ? ", and what excites it" : "");
  if (m->attenuation != NULL && !s->spectral)
    CHANGED(s, m->name, "absorption is three numbers, of 611.4, 549.1 and 464.2 nm");
  return ABBE_OK;
}

static void survey_mirror(const survey *s, const abbe_object *o) {
  const abbe_microfacets *m = &o->brushing.facets;
  if (abbe_brushing_is_rough(&o->brushing) && (m->x < m->y || m->y < m->x))
    LOST(s, o->name, "the way its grooves run: the root of both roughnesses' product is written");
  if (o->conductor != NULL) {
    if (!s->spectral) LOST(s, o->name, "n and k: its colour at normal incidence is written");
  } else if (s->target == ABBE_SCENE_EXPORT_PBRT) {
    CHANGED(s, o->name,
            "its reflectance is that of a conductor at normal incidence, and rises at grazing");
  } else if (s->target == ABBE_SCENE_EXPORT_GLTF) {
    CHANGED(s, o->name, "its reflectance rises at grazing");
  }
}

static abbe_result survey_object(const survey *s, const abbe_object *o, abbe_error *error) {
  const abbe_object_kind kind = abbe_object_kind_of(o);
  abbe_result result = ABBE_OK;
  if (o->cloud) {
    LOST(s, o->name, "it is left out: what is around it goes on in it");
    return ABBE_OK;
  }
  if (o->exact.kind == ABBE_EXACT_SPHERE && !s->spheres)
    CHANGED(s, o->name, "the sphere is %zu triangles", o->mesh.face_count);
  if (kind == ABBE_OBJECT_REFRACTOR) result = add_glass(s, o->material, error);
  if (kind == ABBE_OBJECT_MIRROR) survey_mirror(s, o);
  if (o->coatings != NULL) LOST(s, o->name, "its coating: its faces are bare");
  if (o->roughness != NULL) LOST(s, o->name, "its roughness: its faces are polished");
  if (o->medium != NULL) LOST(s, o->name, "what scatters in it: its inside is clear");
  if (o->spectrum != NULL && !s->spectral)
    LOST(s, o->name, "its measured reflectance: its colour under D65 is written");
  else if (kind == ABBE_OBJECT_RECEIVER && o->texture_path != NULL && s->spectral)
    CHANGED(s, o->name, "its colour is lifted to a spectrum in the program's own way");
  if (kind == ABBE_OBJECT_RECEIVER && o->texture_path != NULL &&
      s->target == ABBE_SCENE_EXPORT_GLTF)
    CHANGED(s, o->name, "its texture is taken as sRGB, whatever its file says");
  return result;
}

static void survey_light(const survey *s, const abbe_light *light) {
  const bool soft = light->kind == ABBE_LIGHT_SPOT && light->soft_rad > 0;
  const abbe_scene_export_target target = s->target;
  if (!s->spectral && light->illuminant.kind != ABBE_ILLUMINANT_D65)
    CHANGED(s, light->name, "its spectrum is a colour, linear Rec.709");
  if (soft && target == ABBE_SCENE_EXPORT_GLTF)
    CHANGED(s, light->name, "its edge fades as the viewer has it");
  if (light->polariser.kind != ABBE_POLARISER_NONE)
    LOST(s, light->name, "its polariser: twice the light that it passes");
  if (!abbe_light_has_size(light)) return;
  if (light->kind == ABBE_LIGHT_DISK && !s->spheres)
    CHANGED(s, light->name, "the disk has %d straight sides and its own area",
            ABBE_EXPORT_DISK_SIDES);
  if (target == ABBE_SCENE_EXPORT_GLTF)
    LOST(s, light->name, "its light: it is a surface that glows, by which viewers light nothing");
  else
    CHANGED(s, light->name, "its back is black, and light does not pass it");
}

static void survey_surroundings(const survey *s) {
  if (s->scene->environment != NULL) {
    if (s->target == ABBE_SCENE_EXPORT_GLTF)
      LOST(s, "environment", "glTF has no surroundings; give the viewer a picture of its own");
    else
      CHANGED(s, "environment", "resampled to STEM-environment.exr, linear Rec.709");
  }
  if (s->scene->medium != NULL) LOST(s, "medium", "the air is clear");
  if (s->scene->camera.aperture > 0)
    LOST(s, "camera", "its aperture: all is sharp, not only what is %.4g m along its view",
         s->scene->camera.focus);
  if (s->scene->camera.polariser.kind != ABBE_POLARISER_NONE)
    LOST(s, "camera", "its polariser: twice the light that it passes");
  if (s->scene->ambient > 0)
    LOST(s, "ambient", "the format has no light without shadows (%.3g W/m2)", s->scene->ambient);
  if (s->scene->background > 0)
    LOST(s, "background", "the format has no radiance that only the camera sees (%.3g)",
         s->scene->background);
  if (s->target == ABBE_SCENE_EXPORT_GLTF)
    LOST(s, "caustics", "viewers of glTF throw no light through refractors");
}

/* Fills the zeroed report: each material's index in the target's form, and notes. */
static abbe_result export_survey(const abbe_scene *scene, abbe_scene_export_target target,
                                 abbe_scene_export_report *report, abbe_error *error) {
  const bool spectral = target == ABBE_SCENE_EXPORT_PBRT;
  const survey s = {scene, target, spectral, spectral, report};
  for (size_t i = 0; i < scene->object_count; i++)
    ABBE_TRY(survey_object(&s, &scene->object[i], error));
  for (size_t i = 0; i < scene->light_count; i++) survey_light(&s, &scene->light[i]);
  survey_surroundings(&s);
  return ABBE_OK;
}

static const struct {
  const char *name, *ending;
  abbe_result (*write)(const abbe_export_writing *w, abbe_error *error);
} targets[] = {
    [ABBE_SCENE_EXPORT_PBRT] = {"pbrt", ".pbrt", abbe_export_pbrt},
    [ABBE_SCENE_EXPORT_GLTF] = {"gltf", ".glb", abbe_export_gltf},
    [ABBE_SCENE_EXPORT_BLENDER] = {"blender", ".py", abbe_export_blender},
};

static bool known(abbe_scene_export_target target) {
  return (int)target >= 0 && target < ABBE_SCENE_EXPORT_COUNT;
}

const char *abbe_scene_export_name(abbe_scene_export_target target) {
  return known(target) ? targets[target].name : "unknown";
}

const char *abbe_scene_export_ending(abbe_scene_export_target target) {
  return known(target) ? targets[target].ending : "";
}

abbe_scene_export_target abbe_scene_export_of_name(const char *name) {
  int i = 0;
  while (i < ABBE_SCENE_EXPORT_COUNT && strcmp(name, targets[i].name) != 0) i++;
  return (abbe_scene_export_target)i;
}

void abbe_scene_export_report_free(abbe_scene_export_report *report) {
  if (report == NULL) return;
  free(report->glass);
  abbe_report_free(&report->notes);
  memset(report, 0, sizeof *report);
}

/* A scene's own files are not written over by those that stand beside the exported one. */
static abbe_result spare_scene(const abbe_scene *scene, const abbe_export_files *files,
                               abbe_error *error) {
  struct stat own, to;
  for (size_t i = 0; i < files->count; i++)
    for (size_t k = 0; k < abbe_scene_file_count(scene); k++) {
      const char *path = abbe_scene_file(scene, k);
      if (path != NULL && stat(path, &own) == 0 && stat(files->file[i].path, &to) == 0 &&
          own.st_dev == to.st_dev && own.st_ino == to.st_ino)
        return abbe_error_set(
            error, ABBE_INVALID_ARGUMENT,
            "%s would be written over the scene's file %s; export to another name",
            files->file[i].path, path);
    }
  return ABBE_OK;
}

static abbe_result write_all(const char *path, const abbe_export_writing *asked,
                             abbe_error *error) {
  abbe_export_files files = {0};
  abbe_file_writer writer = {0};
  abbe_result result = abbe_export_files_begin(&files, path, error);
  if (result == ABBE_OK) result = abbe_file_writer_open(&writer, path, error);
  if (result == ABBE_OK) {
    abbe_export_writing w = *asked;
    w.file = writer.stream;
    w.files = &files;
    result = targets[w.target].write(&w, error);
    if (result == ABBE_OK) result = spare_scene(w.scene, &files, error);
    if (result == ABBE_OK) result = abbe_export_files_write(&files, error);
    const bool others = result == ABBE_OK;
    result = abbe_file_writer_end(&writer, result, error);
    if (result != ABBE_OK && others) abbe_export_files_undo(&files);
  }
  abbe_export_files_free(&files);
  return result;
}

abbe_result abbe_scene_export_write(const char *path, const abbe_scene *scene,
                                    abbe_scene_export_target target,
                                    abbe_scene_export_report *report, abbe_error *error) {
  const char *ending = strrchr(abbe_file_name(path), '.');
  memset(report, 0, sizeof *report);
  if (!known(target))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no format %d to export to",
                          (int)target);
  if (ending == NULL || strcasecmp(ending, targets[target].ending) != 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: a file for %s ends in %s", path,
                          targets[target].name, targets[target].ending);
  ABBE_TRY(abbe_scene_check(scene, error));
  ABBE_TRY(export_survey(scene, target, report, error));
  const abbe_export_writing w = {.scene = scene, .target = target, .report = report};
  return write_all(path, &w, error);
}
