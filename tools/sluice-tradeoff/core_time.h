/** How long the tile manager takes by itself. */
#ifndef SLUICE_TRADEOFF_CORE_TIME_H
#define SLUICE_TRADEOFF_CORE_TIME_H

#include <stddef.h>

/**
 * Frames of a recording: as many as there are calls that say which are over, or that ask which
 * tiles to map, if those are more; a frame whose loads are all under way asks nothing. 0 if it
 * cannot be played to its end.
 */
double core_time_count_frames(const char *data, size_t size);

/**
 * Plays a recording several times and returns the microseconds per frame of the fastest, decoding
 * and hashing included. NaN if there is no file, no frame in it, or it cannot be played to its end.
 */
double core_time_per_frame(const char *trace_path);

#endif /* SLUICE_TRADEOFF_CORE_TIME_H */
