#include "gl/device/statistics.h"

#include <math.h>

double abbe_ledger_imbalance(const abbe_ledger *l) {
  if (!(l->reached > 0)) return 0;
  double parts = l->reflected + l->absorbed + l->trapped + l->missed + l->deposited;
  return fabs(l->reached + l->interpolated - parts) / l->reached;
}

void abbe_ledger_scale(abbe_ledger *l, double by) {
  double *const entry[] = {&l->reached, &l->reflected, &l->absorbed, &l->trapped,
                           &l->missed,  &l->deposited, &l->on_tiles, &l->interpolated};
  for (size_t i = 0; i < sizeof entry / sizeof *entry; i++) *entry[i] *= by;
}

void abbe_statistics_add_ms(abbe_statistics *s, abbe_pass pass, double ms) {
  size_t i = 0;
  if ((int)pass < 0 || pass >= ABBE_PASS_COUNT) return;
  while (i < s->pass_count && s->pass[i].pass != pass) i++;
  if (i == s->pass_count) s->pass[s->pass_count++] = (abbe_pass_time){pass, 0};
  s->pass[i].ms += ms;
}

double abbe_statistics_stage_ms(const abbe_statistics *s, abbe_pass_stage stage) {
  double sum = 0;
  for (size_t i = 0; i < s->pass_count; i++)
    if (abbe_pass_stage_of(s->pass[i].pass) == stage) sum += s->pass[i].ms;
  return sum;
}

bool abbe_statistics_ran(const abbe_statistics *s, abbe_pass pass) {
  for (size_t i = 0; i < s->pass_count; i++)
    if (s->pass[i].pass == pass) return true;
  return false;
}
