/* text_cursor.h: from counts of characters to bytes in UTF-8 text.
 *
 * libyaml's marks count characters; edits need bytes. The cursor walks from where it last was, so
 * marks that come nearly in order cost little however long the text is. It does not check the
 * encoding: a wrong text gives a wrong byte, never one outside the text.
 */
#ifndef ABBE_BASE_TEXT_CURSOR_H
#define ABBE_BASE_TEXT_CURSOR_H

#include <stddef.h>

typedef struct abbe_text_cursor {
  const char *text; /* the caller's */
  size_t size;      /* bytes */
  size_t byte;      /* where the cursor is */
  size_t index;     /* characters before it; a byte order mark at the start is none */
} abbe_text_cursor;

/* A cursor at the text's first character. */
abbe_text_cursor abbe_text_cursor_make(const char *text, size_t size);
/* Moves to the character of that index; its first byte, or size where the text is shorter. */
size_t abbe_text_cursor_byte(abbe_text_cursor *cursor, size_t index);

#endif
