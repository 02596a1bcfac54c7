/* A program outside the house, in C: it knows library/lib_*.h and libabbe.so only. It renders,
 * changes the camera, traces and compares. */
#include "library/lib_comparison.h"
#include "library/lib_scene.h"
#include "library/lib_version.h"

#include <stdio.h>
#include <string.h>

static const char *const small[] = {"width=32", "height=32", "photons=32", "map_size=64"};
static const char *const quick[] = {"width=32", "height=32", "photons=10000", "passes=2"};

int main(int argc, char **argv) {
  abbe_error error = {0};
  abbe_lib_scene *scene = NULL;
  abbe_lib_picture *first = NULL, *moved = NULL, *truth = NULL;
  abbe_lib_comparison *comparison = NULL;
  double eye[3], target[3], up[3], fov, ratio = 0, noise, limit;
  abbe_result result =
      abbe_lib_scene_open(argc > 1 ? argv[1] : "", NULL, NULL, NULL, 0, &scene, &error);
  if (result == ABBE_OK) result = abbe_lib_scene_render(scene, small, 4, &first, &error);
  if (result == ABBE_OK) result = abbe_lib_scene_camera(scene, eye, target, up, &fov, &error);
  if (result == ABBE_OK) result = abbe_lib_scene_look(scene, NULL, NULL, NULL, 0.7 * fov, &error);
  if (result == ABBE_OK) result = abbe_lib_scene_render(scene, small, 4, &moved, &error);
  if (result == ABBE_OK) result = abbe_lib_scene_trace(scene, quick, 4, NULL, &truth, NULL, &error);
  if (result == ABBE_OK)
    result = abbe_lib_comparison_make(truth, moved, NULL, NULL, 0, &comparison, &error);
  if (result == ABBE_OK)
    result = abbe_lib_comparison_value(comparison, "energy_ratio", false, &ratio, &noise, &limit,
                                       &error);
  const int differs =
      result == ABBE_OK && memcmp(abbe_lib_picture_pixels(first), abbe_lib_picture_pixels(moved),
                                  32 * 32 * 3 * sizeof(float)) != 0;
  printf("outside in C, Abbe %s: %s; camera %s, energy ratio %.1f\n", abbe_lib_version(),
         result == ABBE_OK ? "done" : error.text, differs ? "moved" : "stuck", ratio);
  abbe_lib_comparison_free(comparison);
  abbe_lib_picture_free(truth);
  abbe_lib_picture_free(moved);
  abbe_lib_picture_free(first);
  abbe_lib_scene_free(scene);
  return result != ABBE_OK;
}
