/* designs.h: four designs for the tests of cuts, with what is known of them: two round brilliants,
 * a square step cut, and one that has all of the grammar and looks different in a mirror. */
#ifndef ABBE_TESTS_SCENES_CUTS_DESIGNS_H
#define ABBE_TESTS_SCENES_CUTS_DESIGNS_H

#include "tests/check.h"

#include "scenes/cuts/cut_file.h"

#define ROUND_INDICES "87 81 75 69 63 57 51 45 39 33 27 21 15 9 3"
static const char design_a[] =
    "GemCad 5.0\n"
    "g 96 0.0\n"
    "y 8 y\n"
    "I 1.544\n"
    "H Round brilliant\n"
    "a -90.000000 1.00000000 93 n G " ROUND_INDICES "\n"
    "a -44.500000 0.72230678 93 n 1 " ROUND_INDICES " G Level girdle\n"
    "a -43.000000 0.71730011 96 n 2 84 72 60 48 36 24 12 G Meet 1-1-G\n"
    "a 47.000000 0.75181365 3 n A 9 15 21 27 33 39 45 51 57 63 69 75 81 87 93\n"
    "a 42.000000 0.70453399 96 n B 84 72 60 48 36 24 12 G Meet A-A-G\n"
    "a 27.000000 0.64315200 6 n C 18 30 42 54 66 78 90 G Meet A-A-B-B\n"
    "a 0.000000 0.47398214 96 n T G Meet B-C-C\n";

#define DIAMOND_BUT_TABLE                                                                          \
  "GemCad 5.0\n"                                                                                   \
  "g 96 0.0\n"                                                                                     \
  "y 8 y\n"                                                                                        \
  "I 2.417\n"                                                                                      \
  "H Diamond\n"                                                                                    \
  "a -90.000000 1.00000000 93 n G " ROUND_INDICES "\n"                                             \
  "a -42.000000 0.68770923 93 n 1 " ROUND_INDICES "\n"                                             \
  "a -40.750000 0.68448720 96 n 2 84 72 60 48 36 24 12\n"                                          \
  "a 40.200000 0.66455259 3 n A 9 15 21 27 33 39 45 51 57 63 69 75 81 87 93\n"                     \
  "a 34.500000 0.59810595 96 n B 84 72 60 48 36 24 12\n"                                           \
  "a 22.000000 0.51349761 6 n C 18 30 42 54 66 78 90\n"
static const char design_b[] = DIAMOND_BUT_TABLE "a 0.000000 0.34945832 96 n T\n";
static const char design_b_without_table[] = DIAMOND_BUT_TABLE;

#define STEP_BELOW                                                                                 \
  "GemCad 5.0\n"                                                                                   \
  "g 96 0.0\n"                                                                                     \
  "a -90 1.0 96 24 48 72\n"                                                                        \
  "a -58 .86924487 96 24 48 72\n"                                                                  \
  "a -43 .80281066 96 24 48 72\n"
static const char design_c[] = STEP_BELOW "a 45 .73539105 96 24 48 72\n"
                                          "a 30 .59320508 96 24 48 72\n"
                                          "a 0 0.34 96\n";
static const char design_c_open[] = STEP_BELOW;

static const char design_d[] = "GemCad 5.0\n"
                               "g -96 48.0\n"
                               "y 3 n\n"
                               "I 1.66\n"
                               "a -90.000000 1.00000000 96 n 87 32\n"
                               "64 n G\n"
                               "a -90.000000 1.30000000 10.5 n G2 42.5 74.5\n"
                               "a -42.000000 0.72000000 96 n 1 32 64\n"
                               "a -40.000000 0.78000000 10.5 n 2 42.5\n"
                               " 74.5 G Meet nothing, 3 n or 96\n"
                               "a -0.000000 0.55000000 96 n K\n"
                               "a 38.000000 0.68000000 3 n A 35 67\n"
                               "a 30.000000 0.70000000 16 n B\n"
                               "a 0.000000 0.35000000 96 n T\n";

static inline abbe_cut design_parse(const char *text) {
  abbe_cut cut;
  OK(abbe_cut_asc_parse(text, strlen(text), "design.asc", &cut, NULL, &error));
  return cut;
}

#endif
