/* clock.h: how long something takes. It does not know the date. */
#ifndef ABBE_BASE_CLOCK_H
#define ABBE_BASE_CLOCK_H

/* Seconds since some moment before the program began: they only ever grow, whoever sets the
 * machine's time. */
double abbe_clock_seconds(void);

/* Seconds that a processor has worked for the calling thread. */
double abbe_clock_thread_seconds(void);

/* Seconds since this process was started, to a hundredth, loading of its libraries included; where
 * the system does not know, since some moment after. */
double abbe_clock_process_seconds(void);

#endif
