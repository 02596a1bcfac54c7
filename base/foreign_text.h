/* foreign_text.h: text of others as clean UTF-8: bytes of a file in whatever encoding, and scraps
 * of HTML.
 *
 * Catalogues come as ASCII, UTF-8, UTF-16 with or without a byte-order mark, or Windows-1252. It
 * finds out which, converts, and makes every line end a single newline. It knows no format.
 */
#ifndef ABBE_BASE_FOREIGN_TEXT_H
#define ABBE_BASE_FOREIGN_TEXT_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

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

/* The plain text of a scrap of HTML, as references in databases are written, in UTF-8: malloc'd, at
 * most max bytes and cut between letters; NULL where there is no memory. Tags go, the common
 * entities become their letters, and runs of blanks become one; scripts, styles and a '<' that
 * begins no tag stay. */
char *abbe_html_text(const char *html, size_t max);
/* Its inverse: '&', '<' and '>' as entities; malloc'd, NULL where there is no memory. */
char *abbe_html_escape(const char *text);

#endif
