/* A program outside the house: it knows the installed headers and library only. */
#include "colorimetry/image/display_ocio.h"
#include "gl/renderer.h"
#include "scenes/import/scene_file.h"
#include <stdio.h>

int main(int argc, char **argv) {
  abbe_error error = {0};
  abbe_scene scene = {0};
  abbe_context *context = NULL;
  abbe_renderer *renderer = NULL;
  abbe_display *display = NULL;
  const abbe_display_desc plain = {0};
  const abbe_render_desc desc = {.width = 32, .height = 32, .photons = 32, .map_size = 64};
  abbe_result result = abbe_scene_load(argc > 1 ? argv[1] : "", NULL, &scene, &error);
  if (result == ABBE_OK) result = abbe_context_make(ABBE_CONTEXT_CPU, &context, &error);
  if (result == ABBE_OK) result = abbe_renderer_make(context, &scene, &desc, &renderer, &error);
  if (result == ABBE_OK) result = abbe_renderer_frame(renderer, NULL, NULL, NULL, &error);
  if (result == ABBE_OK) result = abbe_display_make(&plain, &display, &error);
  printf("outside: %s %s\n", abbe_result_text(result), error.text);
  abbe_display_free(display);
  abbe_renderer_free(renderer);
  abbe_context_free(context);
  abbe_scene_free(&scene);
  return result != ABBE_OK;
}
