/* number.h: numbers as text and back, the same in every locale.
 *
 * Files write 1.5 with a point whatever the host program's locale says. Written numbers are the
 * shortest that read back as the same double. It knows no units.
 */
#ifndef ABBE_SPECTRAL_NUMBER_H
#define ABBE_SPECTRAL_NUMBER_H

#include <stdbool.h>

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

#ifdef __cplusplus
}
#endif
#endif
