#include "validation/trace/tracer/tracer_state.h"

#include "validation/trace/tracer/light_pass.h"

#include <string.h>

/* The most that a pass adds to any sum: a sample, or a digit of a product, which may be a few times
 * that. */
static const int bits_a_pass = ABBE_WHOLE_SUM_BITS + 2;

void abbe_pass_sums_spans(abbe_tracer *t, abbe_sum_span out[ABBE_PASS_SUMS_PARTS]) {
  const abbe_sum_span spans[ABBE_PASS_SUMS_PARTS] = {
      {t->ledger, ABBE_TRACER_LEDGER},
      {t->picture.sum, t->picture.values},
      {t->picture.square, 2 * t->picture.values},
      {t->guides.sum, t->guides.pixels * ABBE_GUIDE_VALUES},
      {t->map.sum, t->map.values},
      {t->map.square, 2 * t->map.values}};
  memcpy(out, spans, sizeof spans);
}

void abbe_pass_counts_get(const abbe_tracer *t, abbe_pass_counts *out) {
  abbe_trace_statistics s;
  abbe_tracer_statistics(t, &s);
  *out = (abbe_pass_counts){.first = t->first,
                            .end = t->pass,
                            .step = t->step,
                            .whole = t->whole,
                            .photons = s.photons,
                            .light_rays = s.light_rays,
                            .eye_rays = s.eye_rays,
                            .cuts = s.cuts};
}

void abbe_pass_counts_set(abbe_tracer *t, const abbe_pass_counts *c) {
  abbe_trace_statistics *s = &t->statistics;
  t->first = (size_t)c->first;
  t->pass = (size_t)c->end;
  t->step = (size_t)c->step;
  t->whole = (size_t)c->whole;
  t->picture.passes = t->map.passes = abbe_tracer_passes(t);
  s->photons = c->photons;
  s->light_rays = c->light_rays;
  s->eye_rays = c->eye_rays;
  t->other_rays = abbe_tracer_walk_rays(t);
  s->cuts = c->cuts;
  if (!t->desc.no_picture) s->cuts -= abbe_accumulator_cuts(&t->picture);
  if (!t->desc.no_map) s->cuts -= abbe_accumulator_cuts(&t->map);
}

bool abbe_pass_counts_hold(const abbe_pass_counts *c) {
  const uint64_t most = ABBE_WHOLE_SUM_MOST_PASSES;
  if (!(c->whole <= most && c->step >= 1 && c->step <= most && c->first <= c->end &&
        c->first <= most && c->end < most + c->step && (c->end - c->first) % c->step == 0))
    return false;
  const uint64_t counted = abbe_pass_counts_passes(c) * ABBE_PASS_COUNTS_MOST;
  return c->photons <= counted && c->light_rays <= counted && c->eye_rays <= counted &&
         c->cuts <= counted;
}

size_t abbe_pass_counts_passes(const abbe_pass_counts *c) {
  return (size_t)((c->end - c->first) / c->step);
}

bool abbe_pass_sums_hold(abbe_whole_sum sum, size_t passes) {
  const abbe_whole_sum most = (abbe_whole_sum)passes << bits_a_pass;
  return -most <= sum && sum <= most;
}

void abbe_pass_sums_clear(abbe_tracer *t) {
  abbe_sum_span span[ABBE_PASS_SUMS_PARTS];
  abbe_pass_sums_spans(t, span);
  for (int i = 0; i < ABBE_PASS_SUMS_PARTS; i++)
    if (span[i].count > 0) memset(span[i].sum, 0, span[i].count * sizeof *span[i].sum);
  abbe_pass_counts_set(t, &(abbe_pass_counts){.step = 1});
}

/* ---- passes ---- */

abbe_result abbe_tracer_begin_at(abbe_tracer *t, size_t pass, size_t step, abbe_error *error) {
  const size_t most = ABBE_WHOLE_SUM_MOST_PASSES;
  if (t->pass > t->first || pass >= most || step == 0 || step > most)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a trace cannot begin at pass %zu, in steps of %zu%s", pass, step,
                          t->pass > t->first ? ", once it has begun" : "");
  t->first = t->pass = pass;
  t->step = step;
  return ABBE_OK;
}

size_t abbe_tracer_first_pass(const abbe_tracer *tracer) {
  return tracer->first;
}

size_t abbe_tracer_step(const abbe_tracer *tracer) {
  return tracer->step;
}
