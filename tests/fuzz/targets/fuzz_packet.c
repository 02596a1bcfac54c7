/* Packets of tev's protocol, as other programs send them to the viewer: on a window that shows a
 * picture of 2 x 1 pixels. Input: a packet but for its length. */
#include "tests/fuzz/fuzz.h"

#include "cli/view/inspect/inspect.h"

#include <string.h>

const char *const fuzz_words[] = {"\1\1a\0", "\2a\0", "\3\1a\0R\0\0\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0",
                                  "\4\1b\0\2\0\0\0\2\0\0\0\1\0\0\0R\0", NULL};

enum { MOST = 4096, SMALL = 64 };

static uint32_t word_at(const uint8_t *data) {
  return (uint32_t)data[0] | (uint32_t)data[1] << 8 | (uint32_t)data[2] << 16 |
         (uint32_t)data[3] << 24;
}

/* A picture of many pixels is made and takes its time: it is left to other tests. */
static bool is_large(const uint8_t *packet, size_t size) {
  const uint8_t *name = packet + 6, *end = memchr(name, '\0', size > 6 ? size - 6 : 0);
  return packet[4] == 4 && end != NULL && end + 9 <= packet + size &&
         (word_at(end + 1) > SMALL || word_at(end + 5) > SMALL);
}

static bool prepare(abbe_inspect *s) {
  static const char *const channel[] = {"R"};
  return abbe_inspect_await(s, NULL) == ABBE_OK &&
         abbe_inspect_create(s, "a", (const size_t[3]){2, 1, 1}, channel, NULL) == ABBE_OK;
}

int fuzz_input(const uint8_t *data, size_t size) {
  uint8_t packet[MOST + 4] = {0};
  abbe_error error = {0}, why = {0};
  if (size > MOST) return 0;
  for (int i = 0; i < 4; i++) packet[i] = (uint8_t)((size + 4) >> (8 * i));
  if (size > 0) memcpy(packet + 4, data, size);
  if (is_large(packet, size + 4)) return 0;
  const abbe_result checked =
      FUZZED(abbe_inspect_take_packet(NULL, packet, size + 4, NULL, &error), &error);
  FUZZ_PROMISE(checked == ABBE_OK || error.text[0] != '\0');
  abbe_inspect s = {0};
  size_t focus = (size_t)-1;
  if (!prepare(&s)) return 0;
  const abbe_result taken =
      FUZZED(abbe_inspect_take_packet(&s, packet, size + 4, &focus, &why), &why);
  FUZZ_PROMISE(taken == ABBE_OK || why.text[0] != '\0');
  FUZZ_PROMISE(checked == ABBE_OK || taken != ABBE_OK);
  FUZZ_PROMISE(s.count <= 3 && (focus == (size_t)-1 || focus < s.count));
  abbe_inspect_free(&s);
  return 0;
}
