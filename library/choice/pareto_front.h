/* pareto_front.h: of many costs and errors, those that no other beats in both; and what to pick of
 * them.
 *
 * The Pareto front of settings that cost time and make errors. It knows no settings: arrays in,
 * flags and indices out. A cost or an error that is not finite, and a cost that is not positive,
 * is not on the front.
 */
#ifndef ABBE_LIBRARY_CHOICE_PARETO_FRONT_H
#define ABBE_LIBRARY_CHOICE_PARETO_FRONT_H

#include <stddef.h>

/* Of count points those that no other beats, as indices in the order of cost (and so of falling
 * error): none has at most their cost and at most their error, and less of one. Of equal points it
 * is the first. Returns how many; order[count] has room. */
size_t abbe_pareto_front_order(const double *cost, const double *error, size_t count,
                               size_t *order);

/* Where a front in that order, given by its costs and errors, bends most: the point furthest below
 * the straight line between its ends in logarithms (an error of 0 counts as 1e-12). Without a bend,
 * or with fewer than three points, the middle one: count
 * 2. */
size_t abbe_pareto_front_knee(const double *cost, const double *error, size_t count);

/* The cheapest point of such a front whose error is at most 1 + slack times the least there is. */
size_t abbe_pareto_front_accurate(const double *error, size_t count, double slack);

#endif
