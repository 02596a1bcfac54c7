/* error.h: result codes and the sentence that explains one.
 *
 * Every Abbe function that can fail returns an abbe_result and, when it is not ABBE_OK, fills
 * the abbe_error that its caller passed (which may be NULL). There is no hidden global error and
 * no call of exit() in the library. Functions that compute plain maths return their value.
 */
#ifndef ABBE_BASE_ERROR_H
#define ABBE_BASE_ERROR_H

#include <stdarg.h>

#ifdef __cplusplus
extern "C" {
#endif

/* One list makes the codes and their texts: X(code, text). */
#define ABBE_RESULTS(X)                                                                            \
  X(OK, "done")                                                                                    \
  X(INVALID_ARGUMENT, "a value is outside what the function accepts")                              \
  X(NO_MEMORY, "memory could not be allocated")                                                    \
  X(IO, "a file could not be read or written")                                                     \
  X(PARSE, "a file is not well formed")                                                            \
  X(SCHEMA, "a file is well formed but says something it may not say")                             \
  X(NOT_FOUND, "a name is not known")                                                              \
  X(OUT_OF_RANGE, "a wavelength is outside the range of its data")                                 \
  X(GEOMETRY, "a shape cannot be used as it is")                                                   \
  X(UNSUPPORTED, "the scene asks for something that is not modelled")                              \
  X(GL, "the graphics context failed")                                                             \
  X(COLOUR, "the colour configuration failed")                                                     \
  X(CANCELLED, "the work was cancelled")                                                           \
  X(TOLERANCE, "a comparison was out of tolerance")

typedef enum abbe_result {
#define ABBE_RESULT_ENUM(code, text) ABBE_##code,
  ABBE_RESULTS(ABBE_RESULT_ENUM)
#undef ABBE_RESULT_ENUM
      ABBE_RESULT_COUNT
} abbe_result;

/* The last failure: its code and one sentence that names the file, line, key and value concerned
 * and says what would be right. text is one printable line of UTF-8 (text.h), whatever names
 * and values it quotes; over-long sentences are cut. */
typedef struct abbe_error {
  abbe_result code;
  char text[1024];
} abbe_error;

/* The general text of a code ("unknown result" for a value outside the list). */
const char *abbe_result_text(abbe_result result);

/* Fills error (NULL is allowed) with code and the printf-style sentence; returns code, so that
 * `return abbe_error_set(error, ABBE_IO, "…")` both explains and fails. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
abbe_result
abbe_error_set(abbe_error *error, abbe_result code, const char *format, ...);
/* The same for a function with arguments of its own; prefix ("" for none) comes first. */
abbe_result abbe_error_set_list(abbe_error *error, abbe_result code, const char *prefix,
                                const char *format, va_list arguments);

/* Returns from the calling function with the result of the call unless that is ABBE_OK. */
#define ABBE_TRY(...)                                                                              \
  do {                                                                                             \
    const abbe_result tried = (__VA_ARGS__);                                                       \
    if (tried != ABBE_OK) return tried;                                                            \
  } while (0)

/* ABBE_OWNED(type, name) is a local of which type_free is called where its block ends, however it
 * is left, and so is free() of an ABBE_FREED pointer. It has to be safe to free from its
 * declaration on. ABBE_HELD(type, name) is a pointer to what type_free frees there, of a type that
 * ABBE_HOLDS(type) names. */
#define ABBE_OWNED(type, name) __attribute__((cleanup(type##_free))) type name
#define ABBE_HOLDS(type)                                                                           \
  static inline void type##_drop(type **held) {                                                    \
    type##_free(*held);                                                                            \
  }
#define ABBE_HELD(type, name) __attribute__((cleanup(type##_drop))) type *name
#define ABBE_FREED __attribute__((cleanup(abbe_drop)))
void abbe_drop(void *pointer);

#ifdef __cplusplus
}
#endif
#endif
