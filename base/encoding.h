/* encoding.h: bytes of a text file, in whatever encoding, as clean UTF-8; and text of whatever
 * origin as what a terminal may show.
 *
 * Catalogues come as ASCII, UTF-8, UTF-16 with or without a byte-order mark, or Windows-1252. It
 * finds out which, converts, and makes every line end a single newline. It knows no format.
 */
#ifndef ABBE_BASE_ENCODING_H
#define ABBE_BASE_ENCODING_H

#include "base/error.h"

#include <stdbool.h>
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

/* Whether the bytes are no text in any of these encodings: a spreadsheet, a picture, an archive.
 * Such files hold zeros or many control characters in their first 4096 bytes. */
bool abbe_encoding_is_binary(const char *bytes, size_t size);

/* Text from files and command lines may hold what a terminal obeys. Writes length bytes of text to
 * out[size] as valid UTF-8 without it, zero-terminated, cut between letters where it does not fit:
 * control characters become their pictures (ESC U+241B, DEL U+2421); what is no UTF-8, the controls
 * U+0080 to U+009F, and letters that turn the direction of writing, part lines or paragraphs, or
 * have no width (U+202E, U+2028, U+200B, U+FEFF and their like) become U+FFFD. Newline and tab, and
 * a return before a newline, stay where lines is true and become spaces where not. Returns the
 * bytes written; 3 * length + 1 always do. */
size_t abbe_encoding_printable(const char *text, size_t length, bool lines, char *out, size_t size);

/* Bytes of the valid UTF-8 letter at text, which ends with a zero; 0 where none begins there. */
size_t abbe_encoding_letter(const char *text);
/* Cuts text at its end, where its last letter is incomplete. */
void abbe_encoding_trim(char *text);

#ifdef __cplusplus
}
#endif
#endif
