/* disk.h: calls for files that fail when they are told to.
 *
 * A test program that links faults_disk has the calls of Abbe's own objects pass through here:
 * open, linkat, fdopen, fchmod, fsync, fclose, rename and pwrite. Writes through streams are
 * libc's: a limit on a file's size fails those.
 */
#ifndef ABBE_TESTS_FAULTS_DISK_H
#define ABBE_TESTS_FAULTS_DISK_H

#include <stdbool.h>
#include <stddef.h>

/* From now on the n-th of these calls fails with the error number (n from 1; 0: none does). */
void faults_disk_begin(size_t n, int number);
/* Calls since begin; from now on nothing fails. */
size_t faults_disk_end(void);
/* What failed; "" without. */
const char *faults_disk_what(void);

/* Whether there are files without names (they are refused as by a file system that has none). */
void faults_disk_unnamed(bool allowed);

#endif
