/* text.h: the letters of UTF-8, and text of whatever origin as what a terminal may show.
 *
 * It allocates nothing and cannot fail. Other encodings are foreign_text.h's.
 */
#ifndef ABBE_BASE_TEXT_H
#define ABBE_BASE_TEXT_H

#include <expat.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What stands for that which cannot be decoded or shown. */
#define ABBE_UTF8_REPLACEMENT 0xfffd

/* Bytes of the letter at c, of which left (at least 1) are there, and its code point; 0 where it is
 * malformed, overlong, cut, a surrogate or beyond Unicode. */
size_t abbe_utf8_read(const unsigned char *c, size_t left, uint32_t *code);
/* Writes the letter, at most 4 bytes; returns how many. */
size_t abbe_utf8_write(char *to, uint32_t code);

/* Text from files and command lines may hold what a terminal obeys. Writes length bytes of text to
 * out[size] as valid UTF-8 without it, zero-terminated, cut between letters where it does not fit:
 * control characters become their pictures (ESC U+241B, DEL U+2421); what is no UTF-8, the controls
 * U+0080 to U+009F, and letters that turn the direction of writing, part lines or paragraphs, or
 * have no width (U+202E, U+2028, U+200B, U+FEFF and their like) become U+FFFD. Newline and tab, and
 * a return before a newline, stay where lines is true and become spaces where not. Returns the
 * bytes written; 3 * length + 1 always do. */
size_t abbe_utf8_printable(const char *text, size_t length, bool lines, char *out, size_t size);

/* Bytes of the valid UTF-8 letter at text, which ends with a zero; 0 where none begins there. */
size_t abbe_utf8_letter(const char *text);
/* Cuts text at its end, where its last letter is incomplete. */
void abbe_utf8_trim(char *text);

/* The known word that a mistyped one most likely meant (edit distance). */

/* The candidate nearest to word by case-insensitive edit distance (with transpositions), or NULL
 * where none is near enough to be meant: up to a third of the longer word may differ; of a short
 * one up to two letters, if more than half of it is left, or one. */
const char *abbe_nearest_word(const char *word, const char *const *candidates, size_t count);

/* A cJSON tree as text whose every number reads back to the same double.
 *
 * cJSON itself prints 15 digits where a number that reads back to nearly the same will do. It knows
 * nothing of what is printed; strings keep their bytes. */

struct cJSON;

/* json as text, in lines or on one (cJSON_free frees it): each number is the shortest decimal of
 * its double, null where it is not finite. NULL where json is NULL and for want of memory. */
char *abbe_json_text(const struct cJSON *json, bool lines);

/* Where expat reads. */

/* The line of the element that is reported, from 1; expat 2.9 has a function of its own for it. */
static inline size_t abbe_xml_line(XML_Parser parser) {
#if XML_MAJOR_VERSION > 2 || XML_MINOR_VERSION >= 9
  return (size_t)XML_GetCurrentLineNumber64(parser);
#else
  return (size_t)XML_GetCurrentLineNumber(parser);
#endif
}

#endif
