/* statistics.h: what a frame took and where its light went. */
#ifndef ABBE_GL_DEVICE_STATISTICS_H
#define ABBE_GL_DEVICE_STATISTICS_H

#include "gl/plan/facts/plan_facts.h"

#include <stdbool.h>
#include <stddef.h>

/* Light that reached refractors, and what became of it, in W of the lights' power. Each wavelength
 * counts by its share of the light's Y. What is deposited is summed from the finished map and
 * tiles, all else while photons are traced and laid: so the balance is a check and no identity. */
typedef struct abbe_ledger {
  double reached;
  double reflected; /* on the outside, at the first interface, and hit no receiver */
  double absorbed;  /* along inner paths */
  double trapped;   /* still inside when the path ended: below the energy share, or out of exits */
  double missed;    /* met no receiver, or one where neither map nor tile holds it */
  double deposited; /* in the spectral map and on receivers' tiles */
  double on_tiles;  /* the part of deposited that is on tiles */
  /* Light between two traced wavelengths is laid by the index there, and is not quite the mean of
   * what these two carry. This is how much more it is: the error of a sum over the traced
   * wavelengths alone. May be below 0. */
  double interpolated;
} abbe_ledger;

/* |reached + interpolated - (reflected + absorbed + trapped + missed + deposited)| / reached; 0
 * where nothing was reached. */
double abbe_ledger_imbalance(const abbe_ledger *ledger);
/* All of it, in another unit. */
void abbe_ledger_scale(abbe_ledger *ledger, double by);

typedef struct abbe_pass_time {
  abbe_pass pass;
  double ms;
} abbe_pass_time;

typedef struct abbe_statistics {
  double
      frame_ms; /* time of all passes, until the device had done them; without reading the ledger */
  double baseline_ms; /* time of drawing the surfaces alone, where it was measured; else 0 */
  size_t pass_count;  /* passes that ran, in the order in which each ended first */
  abbe_pass_time pass[ABBE_PASS_COUNT];
  /* Passes of the plan that did not run, for what they drew in an earlier frame still holds. */
  bool kept[ABBE_PASS_COUNT];
  size_t photons;         /* lit cells that show a refractor, of all lights */
  size_t wavelengths;     /* the plan's */
  double refractor_share; /* share of the cells of the first light's grid that have a photon */
  double polygon_layers;  /* in wyman2006: polygons over a pixel of its image, mean; else 0 */
  size_t device_bytes;    /* bytes of buffers and textures */
  abbe_ledger energy;
} abbe_statistics;

void abbe_statistics_add_ms(abbe_statistics *s, abbe_pass pass, double ms);
bool abbe_statistics_ran(const abbe_statistics *s, abbe_pass pass);
/* Sum over the passes of a stage: the lights' or the camera's. */
double abbe_statistics_stage_ms(const abbe_statistics *s, abbe_pass_stage stage);

#endif
