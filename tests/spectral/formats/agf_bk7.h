/* agf_bk7.h: the record of N-BK7 as an AGF catalogue has it. */
#ifndef ABBE_TESTS_SPECTRAL_FORMATS_AGF_BK7_H
#define ABBE_TESTS_SPECTRAL_FORMATS_AGF_BK7_H

#define BK7_CD                                                                                     \
  "CD 1.03961212E+00 6.00069867E-03 2.31792344E-01 2.00179144E-02 1.01046945E+00 "                 \
  "1.03560653E+02\n"
#define BK7                                                                                        \
  "NM N-BK7 2 517642.251 1.5168 64.17 0 1 1\nGC step 0.5 available\nED 7.1 8.3 2.51 -0.0009 "      \
  "0\n" BK7_CD "TD 1.86E-06 1.31E-08 -1.37E-11 4.34E-07 6.27E-10 0.17 2.0E+01\n"                   \
  "OD 1.0000 - 0.0000 1.0000 2.3000 2.3000\nLD 3.00000E-01 2.50000E+00\n"                          \
  "IT 3.34000E-01 7.80000E-01 2.50000E+01\nIT 4.00000E-01 9.92000E-01 2.50000E+01\n"

#endif
