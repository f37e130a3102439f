/** How long the tile manager takes by itself. */
#ifndef SLUICE_TRADEOFF_CORE_TIME_H
#define SLUICE_TRADEOFF_CORE_TIME_H

/**
 * Plays a recording several times and returns the microseconds per frame of the fastest, decoding
 * and hashing included. Frames are as many as there are calls that say which are over, or
 * that ask which tiles to map: a frame whose loads are all under way asks nothing. NaN if there is
 * no file, no frame in it, or it cannot be played to its end.
 */
double core_time_per_frame(const char *trace_path);

#endif /* SLUICE_TRADEOFF_CORE_TIME_H */
