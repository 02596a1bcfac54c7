#define _GNU_SOURCE /* fopencookie */

#include "cli/base/progress.h"

#include "base/text.h"

#include <string.h>
#include <unistd.h>

enum { BLOCK = 1024, LETTER = 4 };

/* What a text that may go on keeps back: an unfinished letter, or a return that a newline may
 * follow. */
typedef struct side {
  FILE *raw, *shown;
  char held[LETTER];
  size_t count; /* entries held */
} side;

static side sides[2];

/* Bytes at the end of text of which it is not known yet what they are. */
static size_t unfinished(const char *text, size_t size) {
  if (size > 0 && text[size - 1] == '\r') return 1;
  for (size_t back = 1; back < LETTER && back <= size; back++) {
    const unsigned char c = (unsigned char)text[size - back];
    if ((c & 0xc0) == 0x80) continue;
    const size_t letter = c >= 0xf0 ? 4 : c >= 0xe0 ? 3 : c >= 0xc0 ? 2 : 1;
    return letter > back ? back : 0;
  }
  return 0;
}

/* Takes all, or nothing where it cannot be written. */
static ssize_t write_shown(void *cookie, const char *bytes, size_t size) {
  side *s = cookie;
  char in[BLOCK + LETTER], out[3 * sizeof in + 1];
  for (size_t done = 0; done < size;) {
    const size_t part = size - done < BLOCK ? size - done : BLOCK;
    memcpy(in, s->held, s->count);
    memcpy(in + s->count, bytes + done, part);
    const size_t all = s->count + part, rest = unfinished(in, all);
    const size_t length = abbe_utf8_printable(in, all - rest, true, out, sizeof out);
    memcpy(s->held, in + all - rest, rest);
    s->count = rest;
    if (fwrite(out, 1, length, s->raw) != length) return 0;
    done += part;
  }
  return fflush(s->raw) == 0 ? (ssize_t)size : 0;
}

static void begin(side *s, FILE **stream, int buffering) {
  s->raw = *stream;
  s->shown = fopencookie(s, "w", (cookie_io_functions_t){.write = write_shown});
  if (s->shown == NULL) return;
  setvbuf(s->shown, NULL, buffering, BUFSIZ);
  *stream = s->shown;
}

void abbe_output_begin(void) {
  begin(&sides[0], &stdout, isatty(STDOUT_FILENO) ? _IOLBF : _IOFBF);
  begin(&sides[1], &stderr, _IONBF);
}

FILE *abbe_output_raw(FILE *stream) {
  for (int i = 0; i < 2; i++)
    if (stream == sides[i].shown && stream != NULL) return sides[i].raw;
  return stream;
}
