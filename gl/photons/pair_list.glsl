// Refined intervals: photon * PAIR_INTERVALS + which of the coarse intervals. LISTS_PAIRS: who includes
// this lists them.
const uint PAIR_INTERVALS = 8u;

#ifndef LISTS_PAIRS
readonly
#endif
layout(std430, binding = BINDING_PAIRS) buffer PairList {
  uint pair_count, pair_groups[3];
  uint pair_at[];
};
