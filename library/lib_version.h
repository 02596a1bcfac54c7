/* lib_version.h: which release of the shared library a program runs with, and its promise.
 *
 * libabbe.so exports the functions of library/lib_*.h and abbe_result_text of base/error.h, and
 * nothing else. What they take are handles, numbers, texts and arrays; only abbe_error has a layout
 * that callers know. Requests are texts KEY=VALUE, so that a key may be added. Before 1.0 the
 * second number of a release says whether programs must be built anew: the file's soname and the
 * version of its symbols hold it.
 *
 * A handle is used by one thread at a time; different handles by different threads.
 */
#ifndef ABBE_LIBRARY_LIB_VERSION_H
#define ABBE_LIBRARY_LIB_VERSION_H

#ifdef __cplusplus
extern "C" {
#endif

/* "0.1.0". */
const char *abbe_lib_version(void);

#ifdef __cplusplus
}
#endif
#endif
