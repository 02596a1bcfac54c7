#include "cli/view/picture/view_show.h"

void abbe_view_screen_free(abbe_view_screen *s) {
  if (s->texture != 0) s->gl->DeleteTextures(1, &s->texture);
  if (s->framebuffer != 0) s->gl->DeleteFramebuffers(1, &s->framebuffer);
  *s = (abbe_view_screen){.gl = s->gl};
}

static void make(abbe_view_screen *s, size_t width, size_t height) {
  s->gl->DeleteTextures(1, &s->texture);
  s->gl->DeleteFramebuffers(1, &s->framebuffer);
  s->gl->GenTextures(1, &s->texture);
  s->gl->BindTexture(GL_TEXTURE_2D, s->texture);
  s->gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, (GLsizei)width, (GLsizei)height);
  s->gl->GenFramebuffers(1, &s->framebuffer);
  s->gl->BindFramebuffer(GL_READ_FRAMEBUFFER, s->framebuffer);
  s->gl->FramebufferTexture(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, s->texture, 0);
  s->width = width;
  s->height = height;
}

void abbe_view_screen_take(abbe_view_screen *s, const unsigned char *pixels, size_t width,
                           size_t height, size_t side, const size_t seen[2]) {
  s->side = side;
  for (int k = 0; k < 2; k++) s->seen[k] = seen[k];
  if (s->width != width || s->height != height) make(s, width, height);
  s->gl->BindTexture(GL_TEXTURE_2D, s->texture);
  s->gl->PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  /* rows upward, as the window's: what is turned over is not copied, but drawn */
  for (size_t y = 0; y < height; y++)
    s->gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, (GLint)(height - 1 - y), (GLsizei)width, 1, GL_RGBA,
                         GL_UNSIGNED_BYTE, pixels + 4 * width * y);
}

void abbe_view_screen_draw(abbe_view_screen *s, size_t width, size_t height) {
  static const unsigned char dark[4] = {22, 24, 28, 255};
  static const size_t pixel[2] = {1, 1};
  if (s->texture == 0) abbe_view_screen_take(s, dark, 1, 1, 2, pixel);
  const GLint w = (GLint)s->width, h = (GLint)s->height, side = (GLint)s->side;
  const GLint below = (GLint)height - (GLint)s->seen[1];
  s->gl->BindFramebuffer(GL_READ_FRAMEBUFFER, s->framebuffer);
  s->gl->Enable(GL_SCISSOR_TEST);
  s->gl->Scissor(0, below, (GLsizei)(s->seen[0] < width ? s->seen[0] : width), (GLsizei)s->seen[1]);
  s->gl->BlitFramebuffer(0, 0, w, h, 0, below, side * w, below + side * h, GL_COLOR_BUFFER_BIT,
                         side > 1 ? GL_LINEAR : GL_NEAREST);
  s->gl->Disable(GL_SCISSOR_TEST);
}
