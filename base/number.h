/* number.h: numbers as text and back, the same in every locale.
 *
 * Files and messages write 1.5 with a point whatever the host program's locale says: whatever
 * prints or reads numbers with a decimal point goes through here (tests/base/test_locale holds the
 * library to it). Written numbers are the shortest that read back as the same double. Of units
 * it knows those of length.
 */
#ifndef ABBE_BASE_NUMBER_H
#define ABBE_BASE_NUMBER_H

#include <locale.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ABBE_NUMBER_TEXT_SIZE 32

/* value as text in the buffer, which is returned: the shortest decimal that reads back the same,
 * "nan", "inf" or "-inf" where it is not finite. */
const char *abbe_number_text(double value, char text[ABBE_NUMBER_TEXT_SIZE]);

/* value rounded to 15 digits: what a decimal was before a change of unit bent its last bit
 * (0.5876 um is 587.6 nm, not 587.5999999999999). */
double abbe_number_tidy(double value);

/* The number that text begins with (blanks before it are skipped), in decimal or with an exponent,
 * into *value; *end points past it. False, and *end == text, where none begins there. Hexadecimal
 * numbers, infinities and NaN are not numbers here; one too large for a double is infinite. */
bool abbe_number_read(const char *text, const char **end, double *value);

/* Likewise a length, in metres: a number and, blanks between them or not, one of the units
 * ABBE_LENGTH_UNITS behind it. */
bool abbe_number_read_length(const char *text, const char **end, double *metres);
#define ABBE_LENGTH_UNITS "um, mm, cm, m, in, ft"

/* snprintf, vsnprintf and fprintf with a decimal point. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
int abbe_number_format(char *out, size_t size, const char *format, ...);
int abbe_number_format_list(char *out, size_t size, const char *format, va_list arguments);
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
int abbe_number_write(FILE *file, const char *format, ...);

/* Between the two this thread reads and writes numbers as in the C locale: for libraries that go by
 * the thread's own. leave takes what enter returned; pairs nest. */
locale_t abbe_number_enter(void);
void abbe_number_leave(locale_t host);

#ifdef __cplusplus
}
#endif
#endif
