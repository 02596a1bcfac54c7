/* photon_ledger.h: where a light's flux goes, summed on the device while photons are traced and
 * deposited. Internal to gl/.
 */
#ifndef ABBE_GL_PHOTONS_PHOTON_LEDGER_H
#define ABBE_GL_PHOTONS_PHOTON_LEDGER_H

#include "gl/device/statistics.h"
#include "gl/light/photon_lights.h"

#include <stdint.h>

typedef struct abbe_photon_ledger {
  const abbe_photon_lights *views;
  GLuint sums, saved;
} abbe_photon_ledger;

abbe_result abbe_photon_ledger_make(const abbe_photon_lights *views, abbe_photon_ledger *out,
                                    abbe_error *error);
void abbe_photon_ledger_free(abbe_photon_ledger *ledger);

void abbe_photon_ledger_clear(abbe_photon_ledger *ledger);
void abbe_photon_ledger_bind(const abbe_photon_ledger *ledger);
/* The unit of the light that is traced now, W; set into the program that is in use. */
double abbe_photon_ledger_unit(const abbe_photon_ledger *ledger, size_t light);
void abbe_photon_ledger_set(const abbe_photon_ledger *ledger, GLuint program, size_t light);

enum {
  ABBE_LEDGER_REACHED,
  ABBE_LEDGER_REFLECTED,
  ABBE_LEDGER_ABSORBED,
  ABBE_LEDGER_TRAPPED,
  ABBE_LEDGER_MISSED,
  ABBE_LEDGER_INTERPOLATED,
  ABBE_LEDGER_ENTRIES
};
/* Adds so many units. Waits for the device. */
void abbe_photon_ledger_enter(const abbe_photon_ledger *ledger,
                              const int64_t entry[ABBE_LEDGER_ENTRIES]);

/* The entries as they are, and back to those. */
void abbe_photon_ledger_save(const abbe_photon_ledger *ledger);
void abbe_photon_ledger_restore(const abbe_photon_ledger *ledger);

/* Waits for the device. Adds the light's entries but for what is deposited, of unit power. */
void abbe_photon_ledger_read(const abbe_photon_ledger *ledger, size_t light, abbe_ledger *out);

/* A sum of two words, which may be below zero. */
double abbe_photon_ledger_wide(const GLuint *lo_hi);

#endif
