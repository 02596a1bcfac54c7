/* gsl_guard.h: keeps GSL from ending the program.
 *
 * GSL's default error handler aborts, even where a call only ran out of memory. Between enter and
 * leave it is off, so that GSL returns its code; the host program's own handler comes back with
 * the last leave. Calls nest and may come from several threads.
 */
#ifndef ABBE_BASE_GSL_GUARD_H
#define ABBE_BASE_GSL_GUARD_H

void abbe_gsl_guard_enter(void);
void abbe_gsl_guard_leave(void);

#endif
