/** What a policy that knows the future would have loaded, beside what was loaded. */
#ifndef SLUICE_TRADEOFF_FORESIGHT_H
#define SLUICE_TRADEOFF_FORESIGHT_H

#include "runs.h"

/**
 * Adds clairvoyant_tiles and clairvoyant_levels_too_coarse to all complete runs of points whose
 * first run wrote what each frame needs, or whose scene is a trace. Each trace is played once per
 * budget and latency, by this tool's own `play`, and the answers are kept in RESULTS/clairvoyant;
 * with `recall` only what is kept is added. What cannot be played is said on stderr and has no such
 * figures.
 */
void foresight_add(struct runs *runs, const char *own_path, bool recall);

#endif /* SLUICE_TRADEOFF_FORESIGHT_H */
