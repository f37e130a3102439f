/**
 * Expected result of playing a trace if slots suffice, nothing expires and every map is read. A
 * tile is loaded once, and is resident from the frame after its latency on. Computed tile by tile,
 * without a manager.
 */
#ifndef TESTS_PLAY_NAIVE_PLAY_H
#define TESTS_PLAY_NAIVE_PLAY_H

#include <sluice/manager.h>

enum { NAIVE_TEXTURES = 4, NAIVE_FRAMES = 24, NAIVE_REGIONS = 256 };

/** A trace before it is written. Maps are [frame][texture]. */
struct naive_trace {
    uint32_t texture_count, frame_count;
    SluiceStreamedTextureDesc textures[NAIVE_TEXTURES];
    uint32_t primaries[NAIVE_TEXTURES];
    bool has_map[NAIVE_FRAMES][NAIVE_TEXTURES];
    uint8_t maps[NAIVE_FRAMES][NAIVE_TEXTURES][NAIVE_REGIONS];
};

struct naive_answer {
    uint64_t needed_tiles, loaded_tiles, stale_tiles;
    uint64_t touched_regions, missing_regions, missing_levels;
};

struct naive_answer naive_play(const struct naive_trace *trace, uint32_t latency);

#endif /* TESTS_PLAY_NAIVE_PLAY_H */
