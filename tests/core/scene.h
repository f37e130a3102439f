/**
 * A small streaming application: textures with visible windows, and a frame loop with slow loads,
 * late retire values and a budget. Random choices come from a hash only.
 */
#ifndef TESTS_CORE_SCENE_H
#define TESTS_CORE_SCENE_H

#include "core/fixture.h"

#define SCENE_TEXTURES 64
#define SCENE_TICKS 16 ///< time stamps per frame

/** Visible window of a texture, in feedback regions of the size of level 0 tiles. */
struct scene_window {
    uint32_t x, y, width, height; ///< width 0: nothing
    uint8_t level;                ///< requested level in the middle; without rings: everywhere
    uint8_t rings;                ///< regions per coarser level; 0: none
};

struct scene_texture {
    SluiceTextureId id; ///< SLUICE_NO_TEXTURE: none
    SluiceStreamedTextureLayout layout;
    struct scene_window window;
    bool silent;       ///< true: gets no more maps
    uint32_t maps;     ///< maps so far
    uint8_t *uploads;  ///< owned; by tile: uploads since scene_rest
    uint8_t *min_mip;  ///< owned; last published copy
    uint8_t *feedback; ///< owned
};

struct scene_load {
    SluiceTextureId id;
    uint32_t tile;
    uint64_t due; ///< frame
};

struct scene {
    struct fixture f;
    struct scene_texture textures[SCENE_TEXTURES];
    uint32_t texture_count;
    SluiceStreamedTextureManagerConfig config;
    uint64_t frame;
    uint32_t maps_per_frame; ///< textures take turns
    uint32_t load_frames;    ///< frames from the hand-out to the answer
    uint32_t retire_frames;  ///< frames until a retire value completes
    uint32_t loads_per_frame;
    uint32_t timeout_frames;
    uint32_t missing; ///< percent of the regions that a map lacks
    bool releases_heaps;
    uint32_t next;              ///< index of the next texture to take its turn
    uint64_t uploads, unmapped; ///< tiles handed out and unbound so far
    struct scene_load loads[FIXTURE_ROOM];
    uint32_t load_count;
};

/** Opens a scene: 8 maps and 64 loads per frame, 2 frames per load, retirement after 2 frames,
 * timeout of 16 frames. */
void scene_open(struct scene *s, uint32_t heap_capacity, uint32_t heap_count);
/** Opens a scene like scene_open, with alwaysMapPackedTiles. */
void scene_open_packed(struct scene *s, uint32_t heap_capacity, uint32_t heap_count);
void scene_close(struct scene *s);

/** Applies `config`. */
void scene_configure(struct scene *s);

/** Adds a square texture with tiles of 128 x 128 texels, last in the order of turns. */
struct scene_texture *scene_add(struct scene *s, uint32_t size, struct scene_window window);

/** Removes a texture and frees its arrays. Its place in the order of turns stays empty. */
void scene_remove(struct scene *s, struct scene_texture *t);

void scene_run(struct scene *s, uint32_t frames);

/** Clears the counts of uploads by tile. */
void scene_rest(struct scene *s);

/** Returns the most uploads of a single tile since scene_rest. */
uint32_t scene_most_uploads(const struct scene *s);

/** Returns the number of frames until every texture had a map. */
uint32_t scene_round(const struct scene *s);

/** Returns the level that the window requests at a region; 255 outside. */
uint8_t scene_wanted(const struct scene_texture *t, uint32_t x, uint32_t y);

/** Returns the mean of missing levels in the window, in thousandths. A region without any level
 * lacks R + 1. */
uint32_t scene_deficit(const struct scene_texture *t);
uint32_t scene_mean_deficit(const struct scene *s);

/** Returns whether every visible region shows its packed level or better. */
bool scene_shows_something(const struct scene_texture *t);

/** Counts tiles in a state, of one texture or of all (NULL). */
uint32_t scene_tiles_in(const struct scene *s, const struct scene_texture *t,
                        SluiceTileState state);

/** Counts the regular tiles that the visible windows require, and all packed tiles. */
uint32_t scene_working_set(const struct scene *s);

#endif /* TESTS_CORE_SCENE_H */
