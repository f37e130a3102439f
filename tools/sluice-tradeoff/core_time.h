/** How long the tile manager takes by itself. */
#ifndef SLUICE_TRADEOFF_CORE_TIME_H
#define SLUICE_TRADEOFF_CORE_TIME_H

/**
 * Plays a recording several times and returns the microseconds per frame of the fastest, decoding
 * and hashing included. A frame is what asks once which tiles to map. NaN if there is no file, no
 * frame in it, or it cannot be played to its end.
 */
double core_time_per_frame(const char *trace_path);

#endif /* SLUICE_TRADEOFF_CORE_TIME_H */
