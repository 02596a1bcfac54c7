// 64-bit sums from two 32-bit atomics: the carry goes up once, whoever causes it, so the total
// does not depend on the order. Value = hi * 2^32 + lo, in fixed units.
#define WIDE_ADD(words, lo_index, hi_index, value)                          \
  {                                                                         \
    uint wide_value = (value);                                              \
    uint wide_old = atomicAdd(words[lo_index], wide_value);                 \
    if (wide_old + wide_value < wide_old) atomicAdd(words[hi_index], 1u);   \
  }
