#include "gl/photons/photon_ledger.h"

#include "gl/device/bindings.h"

#include <math.h>

enum { WORDS = 2 * ABBE_LEDGER_ENTRIES };

abbe_result abbe_photon_ledger_make(const abbe_photon_lights *views, abbe_photon_ledger *out,
                                    abbe_error *error) {
  out->views = views;
  ABBE_TRY(abbe_gpu_make_buffer(views->scene->gpu, WORDS * 4, NULL, &out->sums, error));
  return abbe_gpu_make_buffer(views->scene->gpu, WORDS * 4, NULL, &out->saved, error);
}

void abbe_photon_ledger_free(abbe_photon_ledger *ledger) {
  if (ledger->views == NULL) return;
  abbe_gpu_drop_buffers(ledger->views->scene->gpu, 1, &ledger->sums);
  abbe_gpu_drop_buffers(ledger->views->scene->gpu, 1, &ledger->saved);
}

void abbe_photon_ledger_clear(abbe_photon_ledger *ledger) {
  abbe_gpu_clear_buffer(ledger->views->scene->gpu, ledger->sums);
}

void abbe_photon_ledger_bind(const abbe_photon_ledger *ledger) {
  abbe_gpu_bind_storage(ledger->views->scene->gpu, BINDING_LEDGER, ledger->sums);
}

/* A group of 256 photons sums in 32 bits. */
double abbe_photon_ledger_unit(const abbe_photon_ledger *ledger, size_t light) {
  return ldexp(ledger->views->light[light].cell_flux, -22);
}

void abbe_photon_ledger_set(const abbe_photon_ledger *ledger, GLuint program, size_t light) {
  abbe_gpu_set_float(ledger->views->scene->gpu, program, "ledger_unit",
                     abbe_photon_ledger_unit(ledger, light));
}

void abbe_photon_ledger_save(const abbe_photon_ledger *ledger) {
  abbe_gpu_copy(ledger->views->scene->gpu, ledger->sums, 0, ledger->saved, 0, WORDS * 4);
}

void abbe_photon_ledger_restore(const abbe_photon_ledger *ledger) {
  abbe_gpu_copy(ledger->views->scene->gpu, ledger->saved, 0, ledger->sums, 0, WORDS * 4);
}

/* What is taken back may come to a little more than what was entered, by what is known only between
 * two wavelengths. */
double abbe_photon_ledger_wide(const GLuint *lo_hi) {
  return ldexp((double)(GLint)lo_hi[1], 32) + lo_hi[0];
}

void abbe_photon_ledger_enter(const abbe_photon_ledger *ledger,
                              const int64_t entry[ABBE_LEDGER_ENTRIES]) {
  const abbe_gl *gl = ledger->views->scene->gpu->gl;
  uint32_t word[WORDS];
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, ledger->sums);
  gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof word, word);
  for (size_t k = 0; k < ABBE_LEDGER_ENTRIES; k++) {
    uint32_t *at = word + 2 * k;
    const uint64_t sum = (at[0] | (uint64_t)at[1] << 32) + (uint64_t)entry[k];
    at[0] = (uint32_t)sum;
    at[1] = (uint32_t)(sum >> 32);
  }
  gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof word, word);
}

void abbe_photon_ledger_read(const abbe_photon_ledger *ledger, size_t light, abbe_ledger *out) {
  const abbe_gl *gl = ledger->views->scene->gpu->gl;
  GLuint word[WORDS];
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, ledger->sums);
  gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof word, word);
  double *const entry[WORDS / 2] = {&out->reached, &out->reflected, &out->absorbed,
                                    &out->trapped, &out->missed,    &out->interpolated};
  for (size_t i = 0; i < WORDS / 2; i++)
    *entry[i] += abbe_photon_ledger_wide(word + 2 * i) * abbe_photon_ledger_unit(ledger, light);
}
