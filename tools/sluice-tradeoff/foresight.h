/** Compares loads with those of a clairvoyant policy. */
#ifndef SLUICE_TRADEOFF_FORESIGHT_H
#define SLUICE_TRADEOFF_FORESIGHT_H

#include "runs.h"

/**
 * Adds clairvoyant_tiles and clairvoyant_levels_too_coarse to complete runs. A point takes part if
 * its first run wrote the required tiles of each frame, or if its scene is a trace. This tool's own
 * `play` plays each trace once per budget and latency. RESULTS/clairvoyant keeps the answers.
 * `recall`: add kept answers only. Traces that cannot be played are reported on stderr; their runs
 * lack these figures.
 */
void foresight_add(struct runs *runs, const char *own_path, bool recall);

#endif /* SLUICE_TRADEOFF_FORESIGHT_H */
