/* How SQLite's failures are reported. */
#include "spectral/store/material_store_columns.h"

#include <stddef.h>

abbe_result abbe_store_fail(sqlite3 *db, int code, const char *name, abbe_error *error) {
  const char *text = db != NULL ? sqlite3_errmsg(db) : sqlite3_errstr(code);
  switch (code & 0xff) {
  case SQLITE_NOMEM:
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", name);
  case SQLITE_CANTOPEN:
  case SQLITE_IOERR:
  case SQLITE_PERM:
  case SQLITE_AUTH:
    return abbe_error_set(error, ABBE_IO, "%s: cannot be read: %s", name, text);
  default:
    return abbe_error_set(error, ABBE_PARSE, "%s: the store is damaged: %s", name, text);
  }
}

abbe_result abbe_store_prepare(sqlite3 *db, const char *sql, const char *name, sqlite3_stmt **out,
                               abbe_error *error) {
  int code = sqlite3_prepare_v2(db, sql, -1, out, NULL);
  return code == SQLITE_OK ? ABBE_OK : abbe_store_fail(db, code, name, error);
}
