#include "cli/render/render_request.h"

typedef abbe_render_request request;

bool abbe_render_is_checked(const request *q) {
  return q->picture.point != NULL && q->picture.request.max_error > 0;
}

abbe_traced_picture_desc abbe_render_describe_traced(const request *q) {
  const abbe_render_desc *d = &q->render.desc;
  return (abbe_traced_picture_desc){.width = d->width,
                                    .height = d->height,
                                    .min_nm = d->min_nm,
                                    .max_nm = d->max_nm,
                                    .space = d->space,
                                    .observer = d->observer,
                                    .quiet = q->quiet};
}

/* Whether a time is requested and nothing has estimated the error. */
static bool is_open(const request *q) {
  const abbe_picture_choice *c = &q->picture;
  return c->point != NULL && c->request.budget_ms > 0 && !abbe_picture_choice_tells(c);
}

abbe_result abbe_render_check_in_time(request *q, const abbe_scene *scene,
                                      const abbe_image *picture, abbe_error *error) {
  const abbe_traced_picture_desc desc = abbe_render_describe_traced(q);
  if (!is_open(q)) return ABBE_OK;
  return abbe_traced_picture_check_in_time(&q->picture, scene, &desc, picture, error);
}

abbe_result abbe_render_check_frame_in_time(request *q, const abbe_scene *scene,
                                            abbe_renderer *renderer, abbe_error *error) {
  abbe_image layers = {0};
  if (!is_open(q) || !abbe_renderer_plan(renderer)->caustics) return ABBE_OK;
  abbe_result result = abbe_renderer_read(renderer, true, &layers, error);
  if (result == ABBE_OK) result = abbe_render_check_in_time(q, scene, &layers, error);
  abbe_image_free(&layers);
  return result;
}

abbe_result abbe_render_check_frame(request *q, const abbe_scene *scene, abbe_renderer *renderer,
                                    abbe_image *image, abbe_error *error) {
  abbe_image layers = {0}, traced = {0};
  if (!abbe_render_is_checked(q) || !abbe_renderer_plan(renderer)->caustics) return ABBE_OK;
  const abbe_traced_picture_desc desc = abbe_render_describe_traced(q);
  abbe_result result = abbe_renderer_read(renderer, true, &layers, error);
  if (result == ABBE_OK)
    result =
        abbe_traced_picture_check(&q->picture, scene, &desc, q->may_trace, &layers, &traced, error);
  if (result == ABBE_OK && q->picture.traced_instead) {
    abbe_image_free(image);
    *image = traced;
  }
  abbe_image_free(&layers);
  return result;
}
