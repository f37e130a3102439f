/** Time that the tile manager takes by itself. */
#ifndef SLUICE_TRADEOFF_CORE_TIME_H
#define SLUICE_TRADEOFF_CORE_TIME_H

#include <stddef.h>

/**
 * Returns the number of frames of a recording: that of complete-retire calls or that of
 * get-tiles-to-map calls, whichever is larger, because a frame need not make both. Returns 0 if the
 * recording cannot be played to its end.
 */
double core_time_count_frames(const char *data, size_t size);

/**
 * Plays a recording several times. Returns the microseconds per frame of the fastest run, with
 * decoding and hashing. NaN if there is no file or no frame, or the recording cannot be played to
 * its end.
 */
double core_time_per_frame(const char *trace_path);

#endif /* SLUICE_TRADEOFF_CORE_TIME_H */
