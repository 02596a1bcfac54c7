#include "scenes/export/scene_export.h"

#include "base/file.h"
#include "scenes/export/export_survey.h"
#include "scenes/export/export_writing.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

static const struct {
  const char *name, *ending;
  abbe_result (*write)(const abbe_export_writing *w, abbe_error *error);
} targets[] = {
    [ABBE_SCENE_EXPORT_PBRT] = {"pbrt", ".pbrt", abbe_export_pbrt},
    [ABBE_SCENE_EXPORT_MITSUBA] = {"mitsuba", ".xml", abbe_export_mitsuba},
    [ABBE_SCENE_EXPORT_LUXCORE] = {"luxcore", ".scn", abbe_export_luxcore},
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
                                    const abbe_scene_export_options *options,
                                    abbe_scene_export_report *report, abbe_error *error) {
  const char *ending = strrchr(abbe_file_name(path), '.');
  const double lambda_nm =
      options != NULL && options->lambda_nm != 0 ? options->lambda_nm : ABBE_EXPORT_LINE_D_NM;
  memset(report, 0, sizeof *report);
  if (!known(target))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no format %d to export to",
                          (int)target);
  if (ending == NULL || strcasecmp(ending, targets[target].ending) != 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: a file for %s ends in %s", path,
                          targets[target].name, targets[target].ending);
  if (!(lambda_nm >= 380 && lambda_nm <= 780))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the wavelength of the one index is from 380 to 780 nm, not %g",
                          lambda_nm);
  abbe_result result = abbe_scene_check(scene, error);
  if (result == ABBE_OK) result = abbe_export_survey(scene, target, lambda_nm, report, error);
  const abbe_export_writing w = {.scene = scene, .target = target, .report = report};
  if (result == ABBE_OK) result = write_all(path, &w, error);
  return result;
}
