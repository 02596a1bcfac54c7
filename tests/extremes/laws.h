/* laws.h: what must hold of every picture and map, whatever was asked for. */
#ifndef ABBE_TESTS_EXTREMES_LAWS_H
#define ABBE_TESTS_EXTREMES_LAWS_H

#include "gl/renderer.h"
#include "tests/extremes/extreme.h"
#include "tests/extremes/report.h"

typedef struct extreme_frame {
  abbe_scene scene;
  abbe_statistics statistics;
  abbe_map_layout layout;
  abbe_image picture, map; /* the map of the first light; zeroed where no light is refracted */
} extreme_frame;

/* Loads, renders one frame and reads it. */
abbe_result extreme_frame_make(abbe_context *context, const extreme *e, extreme_frame *out,
                               abbe_error *error);
void extreme_frame_free(extreme_frame *frame);

/* Renders the case and holds it to the laws, or to its refusal. */
void extreme_check(abbe_context *context, const extreme *e, extreme_row *row);

double extreme_sum(const abbe_image *image, size_t channel);
double extreme_max(const abbe_image *image, size_t channel);

#endif
