/** How long the tile manager takes by itself. */
#ifndef SLUICE_TRADEOFF_CORE_TIME_H
#define SLUICE_TRADEOFF_CORE_TIME_H

/**
 * Plays a recording several times and returns the microseconds per frame of the fastest, decoding
 * and hashing included. NaN if there is no file, or it cannot be played to its end.
 */
double core_time_per_frame(const char *trace_path, double frame_count);

#endif /* SLUICE_TRADEOFF_CORE_TIME_H */
