/* memory.h: allocations that fail when they are told to.
 *
 * A test program that links tests/faults/memory.c with the options of abbe_faults_memory has every
 * allocation of Abbe's own objects pass through here: malloc and its kin, the functions of libc,
 * libyaml, SQLite and GSL that allocate for their caller, and what expat, libpng and OpenEXR
 * allocate within themselves. What other libraries allocate within themselves is not touched.
 */
#ifndef ABBE_TESTS_FAULTS_MEMORY_H
#define ABBE_TESTS_FAULTS_MEMORY_H

#include <stdbool.h>
#include <stddef.h>

/* From now on the n-th allocation fails (n from 1; 0: none does), with `all` every later one too.
 */
void faults_memory_begin(size_t n, bool all);
/* Allocations since begin, failed ones included; from now on nothing fails. */
size_t faults_memory_end(void);
/* How many failed since begin. */
size_t faults_memory_failed(void);
/* What failed first, for messages. */
const char *faults_memory_what(void);

#endif
