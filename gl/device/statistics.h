/* statistics.h: what a frame took and where its light went. */
#ifndef ABBE_GL_DEVICE_STATISTICS_H
#define ABBE_GL_DEVICE_STATISTICS_H

#include "gl/plan/facts/passes.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Light that reached refractors, and its parts, each sample weighted by its ybar (W of the lights'
 * power); deposited is summed from the map itself, so that the balance is a check and no identity.
 */
typedef struct abbe_ledger {
  double reached;
  double reflected; /* on the outside, at the first interface, and landed nowhere */
  double absorbed;  /* along inner paths */
  double trapped;   /* still inside when the path ended: total or repeated internal reflection */
  double missed;    /* met no receiver, or one where neither map nor tile holds it */
  double deposited; /* in the spectral map and on receivers' tiles */
  double on_tiles;  /* of what is deposited */
  /* What leaves refractors between the wavelengths that are traced, by the index there, less what
   * those have for it by themselves: the quadrature error over wavelengths that this takes away.
   * May be below 0. */
  double interpolated;
} abbe_ledger;

/* |reached + interpolated - the parts| / reached; 0 where nothing was reached. */
double abbe_ledger_imbalance(const abbe_ledger *ledger);

typedef struct abbe_pass_time {
  abbe_pass pass;
  double ms;
} abbe_pass_time;

typedef struct abbe_statistics {
  double frame_ms;   /* all passes, finished */
  double baseline_ms; /* of drawing the surfaces alone, where it was measured; else 0 */
  size_t pass_count; /* of those that ran, as they first ended */
  abbe_pass_time pass[ABBE_PASS_COUNT];
  bool kept[ABBE_PASS_COUNT]; /* of those that the plan runs: what they drew before still holds */
  size_t photons; /* cells that hold a refractor, all lights */
  size_t wavelengths;
  double refractor_share; /* of the first light's photon grid */
  size_t device_bytes;    /* buffers and textures */
  abbe_ledger energy;
} abbe_statistics;

void abbe_statistics_add_ms(abbe_statistics *s, abbe_pass pass, double ms);
bool abbe_statistics_ran(const abbe_statistics *s, abbe_pass pass);
/* Of all passes of the light's side of the frame, or of the eye's. */
double abbe_statistics_stage_ms(const abbe_statistics *s, abbe_pass_stage stage);

#ifdef __cplusplus
}
#endif
#endif
