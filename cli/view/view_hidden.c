#include "cli/view/view_app.h"

#include "base/clock.h"

#include <math.h>
#include <semaphore.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static sem_t called; /* by workers, which know no window */

static void wake(void) {
  sem_post(&called);
}

void abbe_view_hidden_sleep(abbe_view_hidden *h, double most_s) {
  const double least_s = 0.0005, wait_s = abbe_view_app_wait(&h->session, abbe_clock_seconds());
  struct timespec until;
  clock_gettime(CLOCK_REALTIME, &until);
  const double nanoseconds = (double)until.tv_nsec + 1e9 * fmax(least_s, fmin(most_s, wait_s));
  until.tv_sec += (time_t)(nanoseconds / 1e9);
  until.tv_nsec = (long)fmod(nanoseconds, 1e9);
  sem_timedwait(&called, &until);
  while (sem_trywait(&called) == 0) continue;
}

void abbe_view_hidden_resize(abbe_view_hidden *h, size_t width, size_t height) {
  const abbe_gl *gl = h->gl;
  if (h->colour != 0) gl->DeleteTextures(1, &h->colour);
  if (h->framebuffer == 0) gl->GenFramebuffers(1, &h->framebuffer);
  gl->GenTextures(1, &h->colour);
  gl->BindTexture(GL_TEXTURE_2D, h->colour);
  gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, (GLsizei)width, (GLsizei)height);
  gl->BindFramebuffer(GL_FRAMEBUFFER, h->framebuffer);
  gl->FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, h->colour, 0);
  h->width = width;
  h->height = height;
}

void abbe_view_hidden_frame(abbe_view_hidden *h) {
  const double now = abbe_clock_seconds();
  h->input.width = (double)h->width;
  h->input.height = (double)h->height;
  h->input.seconds = now - h->last_s;
  h->last_s = now;
  h->gl->BindFramebuffer(GL_FRAMEBUFFER, h->framebuffer);
  h->gl->Viewport(0, 0, (GLsizei)h->width, (GLsizei)h->height);
  abbe_view_app_frame(&h->session, &h->input, now);
  h->gl->Finish(); /* as a window's swap: else frames pile up, and workers' pictures behind them */
  h->input.wheel = 0;
  h->input.text[0] = '\0';
}

unsigned char *abbe_view_hidden_read(abbe_view_hidden *h) {
  const size_t row = 3 * h->width;
  unsigned char *upward = malloc(row * h->height), *pixels = malloc(row * h->height);
  if (upward != NULL && pixels != NULL) {
    h->gl->BindTexture(GL_TEXTURE_2D, h->colour);
    h->gl->PixelStorei(GL_PACK_ALIGNMENT, 1);
    h->gl->GetTexImage(GL_TEXTURE_2D, 0, GL_RGB, GL_UNSIGNED_BYTE, upward);
    for (size_t y = 0; y < h->height; y++)
      memcpy(pixels + y * row, upward + (h->height - 1 - y) * row, row);
    free(upward);
    return pixels;
  }
  free(upward);
  free(pixels);
  return NULL;
}

abbe_result abbe_view_hidden_begin(abbe_view_hidden *h, const abbe_view_app_desc *desc,
                                   size_t width, size_t height, abbe_error *error) {
  abbe_view_app_desc own = *desc;
  h->input = (abbe_ui_input){.mouse = {-1, -1}};
  if (own.wake == NULL) own.wake = wake;
  ABBE_TRY(abbe_context_make(ABBE_CONTEXT_AUTO, &h->context, error));
  h->gl = abbe_context_gl(h->context);
  h->last_s = abbe_clock_seconds();
  h->framebuffer = h->colour = 0;
  abbe_view_hidden_resize(h, width, height);
  sem_init(&called, 0, 0);
  abbe_result result = abbe_view_app_begin(&h->session, &own, h->context, error);
  if (result == ABBE_OK) return ABBE_OK;
  sem_destroy(&called);
  h->gl->DeleteFramebuffers(1, &h->framebuffer);
  h->gl->DeleteTextures(1, &h->colour);
  abbe_context_free(h->context);
  return result;
}

void abbe_view_hidden_end(abbe_view_hidden *h) {
  abbe_view_app_end(&h->session);
  sem_destroy(&called);
  h->gl->DeleteFramebuffers(1, &h->framebuffer);
  h->gl->DeleteTextures(1, &h->colour);
  abbe_context_free(h->context);
}
