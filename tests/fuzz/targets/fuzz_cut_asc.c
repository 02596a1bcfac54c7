/* GemCad's text designs. */
#include "tests/fuzz/cut_keeps.h"

const char *const fuzz_words[] = {"GemCad 5.0\n",
                                  "g 96 0.0\n",
                                  "g -96 48\n",
                                  "y 8 y\n",
                                  "I 1.544\n",
                                  "H ",
                                  "F ",
                                  "a -90 1 ",
                                  "a 0 0.4 96\n",
                                  "\na 45 ",
                                  " n ",
                                  " G ",
                                  "96 48 24 72 ",
                                  "-0",
                                  "1e308",
                                  "nan",
                                  "\r",
                                  "\xe2\x88\x92",
                                  ";",
                                  "g96 0.0\n",
                                  "a -0 0.5 96\n",
                                  NULL};

int fuzz_input(const uint8_t *data, size_t size) {
  return fuzz_cut(abbe_cut_asc_parse, data, size);
}
