#include "validation/trace/bounded_trace.h"

#include "validation/trace/denoise.h"
#include "validation/trace/tracer/trace_run.h"

#include <math.h>

/* More than noise requires, because the bound itself is uncertain. */
static const double ahead = 1.1;

/* Pictures after a part of the passes and after all, and what the filter makes of them. */
typedef struct pictures {
  abbe_image part, whole, filtered_part, filtered;
} pictures;

static void free_pictures(pictures *p) {
  abbe_image_free(&p->part);
  abbe_image_free(&p->whole);
  abbe_image_free(&p->filtered_part);
  abbe_image_free(&p->filtered);
}

/* On to so many passes in all. */
static abbe_result go_on(const abbe_bounded_trace_desc *d, abbe_tracer *tracer, size_t passes,
                         abbe_image *picture, abbe_image *filtered, abbe_error *error) {
  const abbe_trace_run_desc run = {
      .passes = passes, .progress = d->progress, .user = d->user, .stop = d->stop};
  const abbe_denoise_desc denoise = {.threads = d->trace.threads};
  abbe_result result = abbe_trace_run(tracer, &run, error);
  if (result == ABBE_OK) result = abbe_tracer_picture(tracer, picture, error);
  return result == ABBE_OK && d->filtered ? abbe_denoise_picture(picture, &denoise, filtered, error)
                                          : result;
}

static abbe_result trace(const abbe_bounded_trace_desc *d, abbe_tracer *tracer, size_t passes,
                         pictures *p, abbe_pass_error *own, abbe_error *error) {
  const size_t part = passes / 2;
  const bool tells = d->filtered ? d->max_error > 0 : part > 0;
  *own = (abbe_pass_error){NAN, NAN};
  if (tells) ABBE_TRY(go_on(d, tracer, part, &p->part, &p->filtered_part, error));
  ABBE_TRY(go_on(d, tracer, passes, &p->whole, &p->filtered, error));
  if (!tells) return ABBE_OK;
  const abbe_pass_pictures all = {.part = &p->part,
                                  .whole = &p->whole,
                                  .part_passes = part,
                                  .passes = passes,
                                  .filtered_part = d->filtered ? &p->filtered_part : NULL,
                                  .filtered = d->filtered ? &p->filtered : NULL};
  return abbe_pass_error_make(&all, own, error);
}

/* How many passes may keep the bound, at least twice as many; 0: too many. By noise, which falls as
 * one over the root of the passes: blur falls slower and is asked about again. */
static size_t find_more(const abbe_bounded_trace_desc *d, const abbe_bounded_trace *t,
                        size_t most) {
  const double least = (double)t->passes * pow(t->own.bound / d->max_error, 2);
  if (least > (double)most || 2 * t->passes > most) return 0;
  return 2 * (size_t)ceil(fmin(fmax(ahead * least / 2, (double)t->passes), (double)most / 2));
}

abbe_result abbe_bounded_trace_make(const abbe_scene *scene, const abbe_bounded_trace_desc *desc,
                                    abbe_image *picture, abbe_bounded_trace *out,
                                    abbe_error *error) {
  abbe_tracer *tracer = NULL;
  abbe_trace_desc own = desc->trace;
  const size_t least = desc->filtered ? 2 : 1, bounded = desc->max_error > 0 ? 2 * least : least;
  *picture = (abbe_image){0};
  if (desc->passes < least)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%zu passes are too few, at least %zu",
                          desc->passes, least);
  own.guides = desc->filtered;
  *out = (abbe_bounded_trace){.passes = desc->passes > bounded ? desc->passes : bounded};
  const size_t most = out->passes * ABBE_BOUNDED_TRACE_MOST_TIMES;
  pictures p = {0};
  abbe_result result = abbe_tracer_make(scene, &own, &tracer, error);
  if (result == ABBE_OK) result = trace(desc, tracer, out->passes, &p, &out->own, error);
  while (result == ABBE_OK && desc->max_error > 0 && out->own.bound > desc->max_error) {
    const size_t more = find_more(desc, out, most);
    if (more == 0) break;
    free_pictures(&p);
    out->passes = more;
    result = trace(desc, tracer, more, &p, &out->own, error);
  }
  if (result == ABBE_OK) {
    abbe_image *made = desc->filtered ? &p.filtered : &p.whole;
    *picture = *made;
    *made = (abbe_image){0};
  }
  free_pictures(&p);
  abbe_tracer_free(tracer);
  return result;
}
