/* pair_case.h: a stone in company, its light carried by a transport, drawn as a stage of the viewer
 * draws it; and the means of two parts of the picture, which a trace has too.
 */
#ifndef ABBE_TESTS_PAIRS_PAIR_CASE_H
#define ABBE_TESTS_PAIRS_PAIR_CASE_H

#include "tests/pairs/cover.h"

#include "base/error.h"
#include "gl/device/context.h"
#include "gl/plan/plan.h"
#include "scenes/scene.h"

/* Factors of a row, and their levels. */
enum { PAIR_STONE, PAIR_COMPANY, PAIR_TRANSPORT, PAIR_STAGE };
enum { PAIR_STONES = 3, PAIR_COMPANIES = 6, PAIR_TRANSPORTS = 4, PAIR_STAGES = 3 };
extern const size_t pair_levels[COVER_FACTORS];
const char *pair_level_name(size_t factor, size_t level);

/* What is looked at: the stone, and where its caustic falls. */
enum { PAIR_SIDE = 64, PAIR_REGIONS = 2 };
extern const char *const pair_region_name[PAIR_REGIONS];

typedef struct pair_light {
  double xyz[PAIR_REGIONS][3]; /* mean radiance */
  /* standard errors: of Y over Y, of X / Y and of Z / Y */
  double error[PAIR_REGIONS], ratio_error[PAIR_REGIONS][2];
} pair_light;

/* A company that a transport refuses, and a part of the sentence that says so. */
typedef struct pair_refusal {
  size_t company, transport;
  const char *words;
} pair_refusal;
extern const pair_refusal pair_refusals[];
extern const size_t pair_refusal_count;
bool pair_can(const cover_row *row);

abbe_result pair_scene(size_t stone, size_t company, abbe_scene *out, abbe_error *error);
/* Plans it, without graphics; a volume is one of few rays. The caller frees the plan. */
abbe_result pair_plan(const cover_row *row, abbe_plan *out, abbe_error *error);
/* Draws it. Errors are those of as many random samples as there are pixels. */
abbe_result pair_draw(abbe_context *context, const cover_row *row, pair_light *out,
                      abbe_error *error);
/* Traces it several times with other seeds, whose spread tells the errors. */
abbe_result pair_trace(size_t stone, size_t company, pair_light *out, abbe_error *error);

#endif
