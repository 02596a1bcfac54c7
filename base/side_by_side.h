/* side_by_side.h: functions that the compiler makes for several processors' vector units.
 *
 * The one that fits is chosen when the program starts. Sanitizers do not bear it, and Clang knows
 * it in another form: there it says nothing. */
#ifndef ABBE_BASE_SIDE_BY_SIDE_H
#define ABBE_BASE_SIDE_BY_SIDE_H

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(NDEBUG)
#define SIDE_BY_SIDE __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define SIDE_BY_SIDE
#endif

#endif
