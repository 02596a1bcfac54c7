// Sums whose result does not depend on the order. WIDE: 64 bits from two 32-bit atomics; the carry
// goes up once, whoever causes it. Otherwise 32 bits, in units that all light together cannot
// overflow. Value = (hi * 2^32 +) lo, in fixed units.
#define WIDE_ADD(words, lo_index, hi_index, value)                          \
  {                                                                         \
    uint wide_value = (value);                                              \
    uint wide_old = atomicAdd(words[lo_index], wide_value);                 \
    if (wide_old + wide_value < wide_old) atomicAdd(words[hi_index], 1u);   \
  }
// What is subtracted may stand before what it is from: the sum is right modulo 2^64.
#define WIDE_SUBTRACT(words, lo_index, hi_index, value)                     \
  {                                                                         \
    uint wide_value = (value);                                              \
    uint wide_old = atomicAdd(words[lo_index], 0u - wide_value);            \
    if (wide_old < wide_value) atomicAdd(words[hi_index], 0xffffffffu);     \
  }
