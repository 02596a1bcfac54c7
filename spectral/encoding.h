/* encoding.h: bytes of a text file, in whatever encoding, as clean UTF-8.
 *
 * Catalogues come as ASCII, UTF-8, UTF-16 with or without a byte-order mark, or Windows-1252. It
 * finds out which, converts, and makes every line end a single newline. It knows no format.
 */
#ifndef ABBE_SPECTRAL_ENCODING_H
#define ABBE_SPECTRAL_ENCODING_H

#include "spectral/error.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The text of size bytes as UTF-8 in *text (malloc'd, zero at its end, *length without it): no
 * byte-order mark, lines end with '\n', control characters other than newline and tab become
 * spaces, what cannot be decoded becomes U+FFFD. A byte-order mark decides; without one, text whose
 * every other byte is mostly zero is UTF-16, valid UTF-8 is that, and the rest is Windows-1252.
 * At most three times size bytes are allocated. ABBE_NO_MEMORY. */
abbe_result abbe_encoding_decode(const char *bytes, size_t size, char **text, size_t *length,
                                 abbe_error *error);

/* Bytes of the valid UTF-8 letter at text, which ends with a zero; 0 where none begins there. */
size_t abbe_encoding_letter(const char *text);
/* Cuts text at its end, where its last letter is incomplete. */
void abbe_encoding_trim(char *text);

#ifdef __cplusplus
}
#endif
#endif
