/* sweep_table.h: what a sweep has measured so far: settings, times, errors, and the Pareto front.
 *
 * A table of one scene at one size against one reference on one machine, kept as CSV: comments
 * "# fact: text" say what it belongs to, then a line of column names, then a row a setting. A cell
 * that is empty is not known. It runs nothing, and knows of settings no more than their names.
 */
#ifndef ABBE_VALIDATION_TRADEOFF_SWEEP_TABLE_H
#define ABBE_VALIDATION_TRADEOFF_SWEEP_TABLE_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_SWEEP_MAX_ROWS 4096
#define ABBE_SWEEP_WORD 16
#define ABBE_SWEEP_WORDS 32

/* The contestants that the tracer is, beside the renderer's profiles: its picture as it comes, and
 * filtered. */
#define ABBE_SWEEP_TRACE "trace"
#define ABBE_SWEEP_TRACE_FILTER "trace-filter"
/* And their number: the default profile with soft light through so many pinholes. */
#define ABBE_SWEEP_PINHOLE "pinhole-"

/* One contestant's setting, every field resolved. Of the tracer's only photons and passes count. */
typedef struct abbe_sweep_setting {
  char profile[ABBE_SWEEP_WORD]; /* profile of the renderer, or one of the names above */
  size_t wavelengths, photons, map, samples, upsample;
  char fill[ABBE_SWEEP_WORD];
  char model[ABBE_SWEEP_WORD]; /* as it was requested: "auto" is the plan's choice */
  double share;
  size_t exits;
  size_t passes;  /* passes of the tracer, each of photons x photons photons; 0: the renderer's
                     setting */
  size_t history; /* frames that a picture is made of, where they follow one another; 1: its own */
  char polygons[ABBE_SWEEP_WORDS];  /* for photons in image space, where they are of another kind
                                       than its own: "even+culled"; else "" */
  char direction[ABBE_SWEEP_WORDS]; /* that photons in image space take light from, where it is
                                       another than the profile's: "own"; else "" */
} abbe_sweep_setting;

/* X(code, column, text). Errors are against the reference; beside each stands what the reference's
 * own noise alone would make of it. Caustic: the brightest pixels (texels) that hold 95 % of the
 * reference's caustic light. */
#define ABBE_SWEEP_NUMBERS(X)                                                                      \
  X(FRAME_MS, "frame_ms", "frame, ms")             /* median of the frames */                      \
  X(FASTEST_MS, "fastest_ms", "fastest frame, ms") /* of the frames */                             \
  X(LIGHT_MS, "light_ms", "light's passes, ms")    /* in the median frame */                       \
  X(EYE_MS, "eye_ms", "eye's passes, ms")                                                          \
  X(CAMERA_MS, "camera_ms", "frame after a camera's move, ms")                                     \
  X(BASELINE_MS, "baseline_ms", "surfaces alone, ms")        /* default profile */                 \
  X(WARM_MS, "warm_ms", "whole process, shaders cached, ms") /* median of processes */             \
  X(COLD_MS, "cold_ms", "whole process, no shader cached, ms")                                     \
  X(PHOTONS_HIT, "photons_hit", "photons that meet refractors")    /* photons of all lights */     \
  X(HIT_SHARE, "hit_share", "share of the first light's photons")  /* that do */                   \
  X(LAYERS, "polygon_layers", "polygons over a pixel, mean")       /* where there are */           \
  X(OWN_DE, "own_de", "caustic, mean CIEDE2000 by its own halves") /* traced */                    \
  X(AFTER_1, "after_1_de", "caustic, mean CIEDE2000 of the first frame") /* scene at rest */       \
  X(AFTER_2, "after_2_de", "of the second frame")                        /* the same */            \
  X(AFTER_4, "after_4_de", "of the fourth frame")                                                  \
  X(AFTER_8, "after_8_de", "of the eighth frame")                                                  \
  X(FILL_INVENTED, "fill_invented",                                                                \
    "light that the fill adds, share of the map's")                          /* of the map */      \
  X(FILL_LOST, "fill_lost", "light that the fill drops, share of the map's") /* before it */       \
  X(MAP_SCALE, "map_scale", "factor on the map")          /* 1, or the best one */                 \
  X(MAP_RMSE, "map_rmse", "map's caustic, relative RMSE") /* X, Y, Z together */                   \
  X(MAP_RMSE_NOISE, "map_rmse_noise", "noise of it")                                               \
  X(MAP_UV, "map_uv", "map's caustic, u'v' distance")                                              \
  X(MAP_UV_NOISE, "map_uv_noise", "noise of it")                                                   \
  X(MAP_BANDS, "map_bands", "map's caustic, relative RMSE of the bands")                           \
  X(MAP_BANDS_NOISE, "map_bands_noise", "noise of it")                                             \
  X(MAP_ENERGY, "map_energy", "map's energy ratio") /* ratio of all its Y */                       \
  X(MAP_ENERGY_NOISE, "map_energy_noise", "noise of it")                                           \
  X(SCALE, "scale", "factor on the picture")                                                       \
  X(CAUSTIC_DE, "caustic_de", "caustic, mean CIEDE2000") /* in the picture */                      \
  X(CAUSTIC_DE_NOISE, "caustic_de_noise", "noise of it")                                           \
  X(CAUSTIC_DE95, "caustic_de95", "caustic, 95 % CIEDE2000")                                       \
  X(CAUSTIC_DE95_NOISE, "caustic_de95_noise", "noise of it")                                       \
  X(CAUSTIC_RMSE, "caustic_rmse", "caustic, relative RMSE")                                        \
  X(CAUSTIC_RMSE_NOISE, "caustic_rmse_noise", "noise of it")                                       \
  X(PICTURE_DE, "picture_de", "picture, mean CIEDE2000") /* all pixels */                          \
  X(PICTURE_DE_NOISE, "picture_de_noise", "noise of it")                                           \
  X(PICTURE_DE95, "picture_de95", "picture, 95 % CIEDE2000")                                       \
  X(PICTURE_DE95_NOISE, "picture_de95_noise", "noise of it")                                       \
  X(PICTURE_RMSE, "picture_rmse", "picture, relative RMSE")                                        \
  X(PICTURE_RMSE_NOISE, "picture_rmse_noise", "noise of it")                                       \
  X(MATCHED_DE, "matched_de", "caustic against matched physics, mean CIEDE2000")                   \
  X(MATCHED_DE_NOISE, "matched_de_noise", "noise of it")                                           \
  X(MATCHED_MAP, "matched_map", "map's caustic against matched physics, relative RMSE")            \
  X(MATCHED_MAP_NOISE, "matched_map_noise", "noise of it")

typedef enum abbe_sweep_number {
#define ABBE_SWEEP_ENUM(code, column, text) ABBE_SWEEP_##code,
  ABBE_SWEEP_NUMBERS(ABBE_SWEEP_ENUM)
#undef ABBE_SWEEP_ENUM
      ABBE_SWEEP_NUMBER_COUNT
} abbe_sweep_number;

/* X(code, name): what a table belongs to. */
#define ABBE_SWEEP_FACTS(X)                                                                        \
  X(PROGRAM, "program") /* with its version */                                                     \
  X(SCENE, "scene")     /* path */                                                                 \
  X(SCENE_HASH, "scene hash")                                                                      \
  X(CLASS, "class")         /* class of the scene: its hardest refractor */                        \
  X(SIZE, "size")           /* size of the picture, "512x512" */                                   \
  X(REFERENCE, "reference") /* path of the picture */                                              \
  X(REFERENCE_MAP, "reference map")                                                                \
  X(REFERENCE_HASH, "reference hash")                                                              \
  X(MODEL, "model")     /* errors of matched physics: abbe_sweep_model */                          \
  X(FRAMES, "frames")   /* behind each median */                                                   \
  X(DEVICE, "device")   /* what draws */                                                           \
  X(MACHINE, "machine") /* the processor, and how many of its threads */                           \
  X(DATE, "date")       /* date of the first row */

typedef enum abbe_sweep_fact {
#define ABBE_SWEEP_ENUM(code, name) ABBE_SWEEP_FACT_##code,
  ABBE_SWEEP_FACTS(ABBE_SWEEP_ENUM)
#undef ABBE_SWEEP_ENUM
      ABBE_SWEEP_FACT_COUNT
} abbe_sweep_fact;

typedef struct abbe_sweep_row {
  abbe_sweep_setting setting;
  double number[ABBE_SWEEP_NUMBER_COUNT]; /* NaN: not known */
  bool front;                             /* on the Pareto front */
} abbe_sweep_row;

/* A zeroed table is empty. */
typedef struct abbe_sweep_table {
  char fact[ABBE_SWEEP_FACT_COUNT][256]; /* "": not stated; one line each */
  size_t count, room;
  abbe_sweep_row *row; /* [count] */
} abbe_sweep_table;

const char *abbe_sweep_number_name(abbe_sweep_number number);
const char *abbe_sweep_number_text(abbe_sweep_number number);
/* The number of that column, or ABBE_SWEEP_NUMBER_COUNT. */
abbe_sweep_number abbe_sweep_number_find(const char *column);
/* Whether it is an error against the reference, whose noise is the next number. */
bool abbe_sweep_number_is_error(abbe_sweep_number number);

/* The times that a front can be of: a frame once the scene stands, all passes or those that a
 * camera's move needs; a whole process. The tracer keeps nothing between its pictures. */
#define ABBE_SWEEP_TIMES 4
extern const abbe_sweep_number abbe_sweep_times[ABBE_SWEEP_TIMES];
const char *abbe_sweep_fact_name(abbe_sweep_fact fact);

/* What tables for people show beside a setting, and a number for them: three digits, "-" where it
 * is not known. */
#define ABBE_SWEEP_SHOWN 8
#define ABBE_SWEEP_SHORT 24
extern const abbe_sweep_number abbe_sweep_shown[ABBE_SWEEP_SHOWN];
const char *abbe_sweep_number_short(double value, char out[ABBE_SWEEP_SHORT]);

bool abbe_sweep_setting_is_traced(const abbe_sweep_setting *setting);
/* Whether its picture takes earlier frames. A frame's time is then not what its error takes, so
 * that it is on no front, in no preset, and nothing that the default profile is judged by. */
bool abbe_sweep_setting_has_history(const abbe_sweep_setting *setting);
bool abbe_sweep_setting_same(const abbe_sweep_setting *a, const abbe_sweep_setting *b);
/* For charts: "w7 p256 m1024 s2", with what else is unusual; "trace 4 x p512". */
void abbe_sweep_setting_label(const abbe_sweep_setting *setting, char *out, size_t size);

void abbe_sweep_table_free(abbe_sweep_table *table);
/* Sets a fact; what would break a line becomes a blank, what is too long is cut. */
void abbe_sweep_table_set(abbe_sweep_table *table, abbe_sweep_fact fact, const char *text);
/* The row of that setting, or NULL. */
const abbe_sweep_row *abbe_sweep_table_find(const abbe_sweep_table *table,
                                            const abbe_sweep_setting *setting);
/* Whether the errors of the default profile's settings are more than the reference's own noise: if
 * not, the table shows nothing of settings. */
bool abbe_sweep_table_tells(const abbe_sweep_table *table, abbe_sweep_number number);
/* How much longer the median of a setting's frames takes than its fastest, as a share of that; the
 * median over the rows where they differ, which a quiet machine keeps below ABBE_SWEEP_QUIET. 0
 * where none do. */
#define ABBE_SWEEP_QUIET 0.15
double abbe_sweep_table_unrest(const abbe_sweep_table *table);
/* Adds a row. ABBE_INVALID_ARGUMENT where its setting is there already or the table is full. */
abbe_result abbe_sweep_table_add(abbe_sweep_table *table, const abbe_sweep_row *row,
                                 abbe_error *error);
/* Finds the Pareto front of that time against that error: over all rows, or (with a profile's name)
 * over that profile's rows alone. ABBE_NO_MEMORY. */
abbe_result abbe_sweep_table_mark(abbe_sweep_table *table, abbe_sweep_number time,
                                  abbe_sweep_number number, const char *profile, abbe_error *error);
/* The rows on the front in the order of that time, as malloc'd indices; NULL for want of memory. */
size_t *abbe_sweep_table_front(const abbe_sweep_table *table, abbe_sweep_number time,
                               size_t *out_count);

/* The table as text, and beside its target and renamed. ABBE_IO, ABBE_NO_MEMORY. */
abbe_result abbe_sweep_table_save(const abbe_sweep_table *table, const char *path,
                                  abbe_error *error);
/* ABBE_PARSE names line and cell of what is no such table; facts that are not known are passed
 * over. */
abbe_result abbe_sweep_table_parse(const char *text, size_t size, const char *name,
                                   abbe_sweep_table *out, abbe_error *error);
abbe_result abbe_sweep_table_load(const char *path, abbe_sweep_table *out, abbe_error *error);

/* Errors of matched physics against full, as the fact `model` has them: "caustic_de 1.2 (0.3),
 * map_rmse 0.1 (0.02), map_energy 0.93", noise in brackets. */
typedef struct abbe_sweep_model {
  double de, de_noise; /* caustic, mean CIEDE2000 */
  double map, map_noise, energy;
} abbe_sweep_model;

void abbe_sweep_model_write(const abbe_sweep_model *model, abbe_sweep_table *table);
/* False where the table has no such fact. */
bool abbe_sweep_model_read(const abbe_sweep_table *table, abbe_sweep_model *out);

/* ABBE_INVALID_ARGUMENT names the first fact in which two tables differ, so that rows of the two
 * do not belong together. The date, paths of references and the count of frames may differ. */
abbe_result abbe_sweep_table_agree(const abbe_sweep_table *a, const char *name,
                                   const abbe_sweep_table *b, abbe_error *error);

/* The rows of tables of one sweep (abbe_sweep_table_agree), under the first's facts. names: of the
 * tables, for errors. ABBE_INVALID_ARGUMENT where they differ or two have a setting;
 * ABBE_NO_MEMORY. */
abbe_result abbe_sweep_table_join(const abbe_sweep_table *tables, const char *const *names,
                                  size_t count, abbe_sweep_table *out, abbe_error *error);

#endif
