/** What playing a trace can be told. */
#ifndef SLUICE_TRADEOFF_PLAY_OPTIONS_H
#define SLUICE_TRADEOFF_PLAY_OPTIONS_H

#include "../common/option_table.h"

struct play_options {
    const char *trace;  ///< path
    const char *output; ///< folder for frames.csv; NULL: none
    /* memory */
    uint32_t heap_tiles, max_heaps; ///< max_heaps 0: any number
    uint64_t budget;                ///< bytes for all heaps, 0: as max_heaps says
    uint32_t standby, prefetch_levels;
    /* loads */
    uint32_t tiles_per_frame, latency;
    uint32_t loads_in_flight; ///< 0: tiles_per_frame * (latency + 1)
    /* feedback */
    double timeout; ///< s
    uint32_t misses_to_forget, textures_per_frame;
    uint32_t writers;   ///< of a region
    double probability; ///< that one of them writes
    double drop;        ///< that none does: that a region is left out of a frame's map
    int32_t mip_bias;   ///< levels
    uint32_t seed;      ///< of what is left out
    bool in_turns;      ///< a map shows the frame that it is read in alone
    /* what is printed beside */
    bool json, clairvoyant;
    uint32_t rounds; ///< of the search for its bound
};

/** Says on stderr what is wrong. */
enum option_outcome play_options_parse(struct play_options *options, int argc, char **argv);

#endif /* SLUICE_TRADEOFF_PLAY_OPTIONS_H */
