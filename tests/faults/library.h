/* library.h: calls of OpenEXR, of Little CMS and for reading that fail when they are told to.
 *
 * A test program that links faults_library has these calls of Abbe's own objects pass through here.
 * What the libraries call within themselves is not touched.
 */
#ifndef ABBE_TESTS_FAULTS_LIBRARY_H
#define ABBE_TESTS_FAULTS_LIBRARY_H

#include <stddef.h>

typedef enum faults_library_kind {
  FAULTS_OF_CALLS,
  FAULTS_OF_READING,
  FAULTS_OF_PACKERS, /* those that libdeflate makes */
} faults_library_kind;

/* From now on the n-th call of the kind fails (n from 1; 0: none does): a library's with the code
 * if it gives one, one that reads with the error number; 0: it reads or writes nothing. */
void faults_library_begin(faults_library_kind kind, size_t n, int code);
/* Calls of the kind since begin; from now on nothing fails. */
size_t faults_library_end(void);
/* What failed; "" without. */
const char *faults_library_what(void);

#endif
