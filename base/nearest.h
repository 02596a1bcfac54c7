/* nearest.h: the known word that a mistyped one most likely meant (edit distance). */
#ifndef ABBE_BASE_NEAREST_H
#define ABBE_BASE_NEAREST_H

#include <stddef.h>

/* The candidate nearest to word by case-insensitive edit distance (with transpositions), or NULL
 * where none is near enough to be meant: up to a third of the longer word may differ; of a short
 * one up to two letters, if more than half of it is left, or one. */
const char *abbe_nearest_word(const char *word, const char *const *candidates, size_t count);

#endif
