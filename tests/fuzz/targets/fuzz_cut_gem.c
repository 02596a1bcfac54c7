/* GemCad's binary designs. */
#include "tests/fuzz/cut_keeps.h"

const char *const fuzz_words[] = {"\x01",     "\xff\xff\xff\xff", "preform",  "\tG", "\x7f\xff",
                                  "\x7f\xf8", "\xc0\xf8",         "\x3f\xf0", NULL};

int fuzz_input(const uint8_t *data, size_t size) {
  return fuzz_cut(abbe_cut_gem_parse, data, size);
}
