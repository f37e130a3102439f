/** Options of playing a trace. */
#ifndef SLUICE_TRADEOFF_PLAY_OPTIONS_H
#define SLUICE_TRADEOFF_PLAY_OPTIONS_H

#include "../common/option_table.h"

struct play_options {
    const char *trace;  ///< path
    const char *output; ///< folder for frames.csv; NULL: none
    /* memory */
    uint32_t heap_tiles, max_heaps; ///< max_heaps 0: any number
    uint64_t budget;                ///< bytes for all heaps; 0: max_heaps decides
    uint32_t standby, prefetch_levels;
    /* loads */
    uint32_t tiles_per_frame, latency;
    uint32_t loads_in_flight; ///< 0: tiles_per_frame * (latency + 1)
    /* feedback */
    double timeout; ///< s
    uint32_t misses_to_forget, textures_per_frame;
    uint32_t writers;   ///< pixels that see a region
    double probability; ///< probability that a pixel writes feedback
    double drop; ///< probability that no pixel of a region writes: the map then lacks the region
    int32_t mip_bias; ///< levels
    uint32_t seed;    ///< seed of the regions that are left out
    bool in_turns;    ///< true: a map shows only the frame in which it is read
    /* Extra output. */
    bool json, clairvoyant;
    uint32_t rounds; ///< rounds of the search for the clairvoyant bound
};

/** Reports errors on stderr. */
enum option_outcome play_options_parse(struct play_options *options, int argc, char **argv);

#endif /* SLUICE_TRADEOFF_PLAY_OPTIONS_H */
