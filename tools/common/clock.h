/** Wall time for progress and statistics; no decision depends on it. */
#ifndef TOOLS_COMMON_CLOCK_H
#define TOOLS_COMMON_CLOCK_H

/** Returns seconds since a fixed point in the past. */
double clock_seconds(void);
/** Sleeps until clock_seconds() reaches `time`. */
void clock_sleep_until(double time);

#endif /* TOOLS_COMMON_CLOCK_H */
