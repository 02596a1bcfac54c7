/* null_arguments.h: the API's functions that return a result, each to be called with pointers
 * that point to zeros or nowhere; the calls are made from the headers by
 * tests/null_arguments/generate.
 */
#ifndef ABBE_TESTS_NULL_ARGUMENTS_H
#define ABBE_TESTS_NULL_ARGUMENTS_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { NULL_PARAMETERS = 16 };

/* Zeros; or a handle, which only the library can make: it is never anything but NULL here. */
typedef enum null_kind { NULL_DATA, NULL_HANDLE } null_kind;

typedef struct null_call {
  const char *name;
  abbe_result (*run)(void);
  int count;
  const char *parameter[NULL_PARAMETERS]; /* "" where it is no pointer, or the error */
} null_call;

extern const null_call null_calls[];
extern const size_t null_call_count;

/* What the parameter of that number is given in this call. */
void *null_pointer(int at, null_kind kind);

#endif
