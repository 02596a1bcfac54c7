/* work_options.h: what commands that follow many rays are asked alike: which wavelengths, random
 * numbers and threads, and that they go on from a checkpoint. Internal to cli/.
 */
#ifndef ABBE_CLI_OPTIONS_WORK_OPTIONS_H
#define ABBE_CLI_OPTIONS_WORK_OPTIONS_H

#include <argp.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Zeroed but for every_s. */
typedef struct abbe_work_options {
  double min_nm, max_nm; /* 0: not given */
  uint32_t seed;
  size_t threads; /* 0: all cores */
  bool resume;
  double every_s; /* between two checkpoints */
} abbe_work_options;

/* Rows of a command's options, and in *options what they say. */
enum {
  ABBE_WORK_RANGE = 0x7e00,
  ABBE_WORK_SEED,
  ABBE_WORK_THREADS,
  ABBE_WORK_RESUME,
  ABBE_WORK_EVERY
};
#define ABBE_WORK_OPTIONS(group, keeping)                                                          \
  {"range", ABBE_WORK_RANGE, "FROM:TO", 0, "wavelengths in nm (380:780)", group},                  \
      {"seed", ABBE_WORK_SEED, "N", 0, "of the random numbers (0)", group},                        \
      {"threads", ABBE_WORK_THREADS, "N", 0, "all cores without; the result is the same", group},  \
      {"resume", ABBE_WORK_RESUME, NULL, 0, "go on from the checkpoint, where there is one",       \
       keeping},                                                                                   \
  {                                                                                                \
    "checkpoint-every", ABBE_WORK_EVERY, "SECONDS", 0, "how often it is written (30)", keeping     \
  }
/* ARGP_ERR_UNKNOWN where key is none of them; ends the program where the text is no such number. */
error_t abbe_work_options_take(abbe_work_options *options, int key, const char *text,
                               const char *program);

#endif
