#include "cli/options/spectral_options.h"

#include "cli/base/command.h"

enum { MOST_THREADS = 256 };

error_t abbe_work_options_take(abbe_work_options *o, int key, const char *text,
                               const char *program) {
  switch (key) {
  case ABBE_WORK_RANGE:
    abbe_command_range(program, "--range", text, &o->min_nm, &o->max_nm);
    return 0;
  case ABBE_WORK_SEED:
    o->seed = (uint32_t)abbe_command_count(program, "--seed", text, 0, UINT32_MAX);
    return 0;
  case ABBE_WORK_THREADS:
    o->threads = abbe_command_count(program, "--threads", text, 1, MOST_THREADS);
    return 0;
  case ABBE_WORK_RESUME:
    o->resume = true;
    return 0;
  case ABBE_WORK_EVERY:
    o->every_s = abbe_command_number(program, "--checkpoint-every", text, 0, 1e9);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}
