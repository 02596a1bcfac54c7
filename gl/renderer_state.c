#include "gl/renderer_state.h"

#include "gl/device/api.h"

abbe_result abbe_renderer_enter(abbe_context *context, abbe_error *error) {
  ABBE_TRY(abbe_context_make_current(context, error));
  abbe_gl_state_begin(abbe_context_gl(context));
  return ABBE_OK;
}

abbe_result abbe_renderer_leave(abbe_context *context, abbe_result result) {
  abbe_gl_state_end(abbe_context_gl(context));
  return result;
}

bool abbe_renderer_watch(void *user, double done) {
  abbe_renderer_watched *w = user;
  const bool goes_on = w->progress(w->user, done);
  w->result = abbe_context_make_current(w->context, w->error);
  return goes_on && w->result == ABBE_OK;
}

abbe_result abbe_renderer_end_watch(abbe_renderer *r, abbe_result result, abbe_error *error) {
  const bool stopped = r->gpu.stopped;
  abbe_gpu_watch(&r->gpu, NULL, NULL);
  r->gpu.compiling = NULL;
  if (!stopped) return result;
  return abbe_error_set(error, ABBE_CANCELLED, "the render was cancelled");
}

bool abbe_renderer_has_method(const abbe_renderer *r) {
  return abbe_method_of(r->plan.desc.profile)->own_passes;
}

abbe_result abbe_renderer_check(const abbe_renderer *r, abbe_error *error) {
  if (r->lacking == 0) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "the renderer's last change or frame failed, so there is nothing to draw; "
                        "abbe_renderer_change comes first");
}

bool abbe_renderer_is_lit(const abbe_renderer *r) {
  return r->lit;
}

const abbe_plan *abbe_renderer_plan(const abbe_renderer *r) {
  return &r->plan;
}
