#include "validation/passes/time_left.h"

#include <math.h>
#include <stddef.h>

double abbe_time_left_seconds(const abbe_time_left *left) {
  return left->seconds != NULL ? left->seconds(left->user) : INFINITY;
}

bool abbe_time_left_holds(const abbe_time_left *left, double seconds) {
  return left->seconds == NULL || ABBE_TIME_LEFT_ROOM * seconds <= abbe_time_left_seconds(left);
}
