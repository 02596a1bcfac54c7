/* material_store_columns.h: what is in a store of materials, and how SQLite's failures are
 * reported.
 * Internal to spectral/. */
#ifndef ABBE_SPECTRAL_STORE_MATERIAL_STORE_COLUMNS_H
#define ABBE_SPECTRAL_STORE_MATERIAL_STORE_COLUMNS_H

#include "base/error.h"

#include <sqlite3.h>

/* "Abbe" in the file's header, and the version of what follows. */
enum { ABBE_STORE_APPLICATION = 0x41626265, ABBE_STORE_VERSION = 5, ABBE_STORE_MAX_TERMS = 3 };

/* X(name, type): the columns after id. Lists of numbers are doubles, the least byte first; points
 * are pairs of them, nm and value, or nm, n and k of a conductor. What is large comes last: SQLite
 * reads a row from its beginning.
 */
#define ABBE_STORE_COLUMNS(X)                                                                      \
  X(name, "TEXT NOT NULL UNIQUE COLLATE NOCASE")                                                   \
  X(description, "TEXT")                                                                           \
  X(model, "TEXT NOT NULL")                                                                        \
  X(coefficients, "BLOB")                                                                          \
  X(interpolation, "TEXT")                                                                         \
  X(extraordinary_model, "TEXT")                                                                   \
  X(extraordinary_coefficients, "BLOB")                                                            \
  X(extraordinary_interpolation, "TEXT")                                                           \
  X(alpha_model, "TEXT")                                                                           \
  X(alpha_coefficients, "BLOB")                                                                    \
  X(alpha_interpolation, "TEXT")                                                                   \
  X(gamma_model, "TEXT")                                                                           \
  X(gamma_coefficients, "BLOB")                                                                    \
  X(gamma_interpolation, "TEXT")                                                                   \
  X(from_nm, "REAL")                                                                               \
  X(to_nm, "REAL")                                                                                 \
  X(extrapolate, "INTEGER")                                                                        \
  X(temperature_c, "REAL")                                                                         \
  X(n_absolute, "INTEGER")                                                                         \
  X(n_d, "REAL")                                                                                   \
  X(v_d, "REAL")                                                                                   \
  X(source, "TEXT")                                                                                \
  X(comment, "TEXT")                                                                               \
  X(warning, "TEXT")                                                                               \
  X(code, "TEXT")                                                                                  \
  X(status, "TEXT")                                                                                \
  X(melt_frequency, "REAL")                                                                        \
  X(density_g_cm3, "REAL")                                                                         \
  X(expansion_per_k, "BLOB") /* the two, or these and from, to, from, to in K */                   \
  X(dpgf, "REAL")                                                                                  \
  X(thermal, "BLOB")                                                                               \
  X(ratings, "BLOB")                                                                               \
  X(cauchy2, "BLOB") /* coefficients, largest error, from, to */                                   \
  X(cauchy3, "BLOB")                                                                               \
  X(attenuation_interpolation, "TEXT")                                                             \
  X(attenuation_per_m, "BLOB")                                                                     \
  X(attenuation_y_interpolation, "TEXT")                                                           \
  X(attenuation_y_per_m, "BLOB")                                                                   \
  X(attenuation_z_interpolation, "TEXT")                                                           \
  X(attenuation_z_per_m, "BLOB") /* the other is along x */                                        \
  X(fluorescence_yield, "REAL")                                                                    \
  X(fluorescence_interpolation, "TEXT") /* of both that follow */                                  \
  X(fluorescence_emission, "BLOB")                                                                 \
  X(fluorescence_excitation_per_m, "BLOB")                                                         \
  X(alpha_points, "BLOB")                                                                          \
  X(gamma_points, "BLOB")                                                                          \
  X(extraordinary_points, "BLOB")                                                                  \
  X(points, "BLOB")

typedef enum abbe_store_column {
#define ABBE_STORE_ENUM(name, type) ABBE_STORE_##name,
  ABBE_STORE_COLUMNS(ABBE_STORE_ENUM)
#undef ABBE_STORE_ENUM
      ABBE_STORE_COLUMN_COUNT
} abbe_store_column;

#define ABBE_STORE_TYPED(name, type) ", " #name " " type
#define ABBE_STORE_ABOUT "CREATE TABLE about(description TEXT)"
#define ABBE_STORE_MATERIALS                                                                       \
  "CREATE TABLE materials(id INTEGER PRIMARY KEY" ABBE_STORE_COLUMNS(ABBE_STORE_TYPED) ")"

/* Turns SQLite's code into ABBE_NO_MEMORY, ABBE_IO, or ABBE_PARSE of the file at path. db may be
 * NULL. */
abbe_result abbe_store_fail(sqlite3 *db, int code, const char *path, abbe_error *error);
/* sqlite3_prepare_v2; *out is freed with sqlite3_finalize, also after a failure. */
abbe_result abbe_store_prepare(sqlite3 *db, const char *sql, const char *path, sqlite3_stmt **out,
                               abbe_error *error);

#endif
