/* time_left.h: how much of a budget is left, and whether a piece of work still fits.
 *
 * It has no clock of its own: who asks brings one.
 */
#ifndef ABBE_VALIDATION_PASSES_TIME_LEFT_H
#define ABBE_VALIDATION_PASSES_TIME_LEFT_H

#include <stdbool.h>

/* Work takes up to so many times as long as was expected of it, and has room for that. */
#define ABBE_TIME_LEFT_ROOM 1.3

/* Zeroed: the time has no end. */
typedef struct abbe_time_left {
  double (*seconds)(void *user); /* until it ends, below 0 after that; or NULL */
  void *user;
} abbe_time_left;

/* s; infinite without an end. */
double abbe_time_left_seconds(const abbe_time_left *left);

/* Whether work that is expected to take so many seconds ends in time, with ABBE_TIME_LEFT_ROOM.
 * NaN is work of which nothing is known: it fits where there is no end. */
bool abbe_time_left_holds(const abbe_time_left *left, double seconds);

#endif
