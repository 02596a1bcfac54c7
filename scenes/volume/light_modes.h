/* light_modes.h: values at light nodes as sums of a few modes of the light's direction: the
 * singular value decomposition of the values, cut off. Of all sums of so many terms these leave the
 * least mean square [EckartYoung1936].
 */
#ifndef ABBE_SCENES_VOLUME_LIGHT_MODES_H
#define ABBE_SCENES_VOLUME_LIGHT_MODES_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

/* Of halves value[nodes][each]: singular values that fall, singular[nodes], and modes in their
 * order, mode[nodes][nodes], a mode a row. Modes are orthogonal, of mean square 1 over the nodes;
 * the values times a mode, over the number of nodes, are its term. What is left out by the terms
 * from k on has as its sum of squares that of singular[k] and all behind it. ABBE_INVALID_ARGUMENT
 * for no nodes, ABBE_NO_MEMORY. */
abbe_result abbe_light_modes_find(size_t nodes, size_t each, const uint16_t *value,
                                  double *singular, double *mode, abbe_error *error);

#endif
