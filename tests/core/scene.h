/**
 * A small application that streams: some textures, a window of each in view, a frame loop with slow
 * loads, late retire values and a budget. Nothing in it is random but by a hash.
 */
#ifndef TESTS_CORE_SCENE_H
#define TESTS_CORE_SCENE_H

#include "core/fixture.h"

#define SCENE_TEXTURES 64
#define SCENE_TICKS 16 ///< time stamps per frame

/** What of a texture is in view, in feedback regions; these are as large as tiles of level 0. */
struct scene_window {
    uint32_t x, y, width, height; ///< width 0: nothing
    uint8_t level;                ///< wanted in the middle, or everywhere without rings
    uint8_t rings;                ///< regions until the next coarser level; 0: none
};

struct scene_texture {
    SluiceTextureId id; ///< SLUICE_NO_TEXTURE: none
    SluiceStreamedTextureLayout layout;
    struct scene_window window;
    bool silent;       ///< gets no maps any more
    uint32_t maps;     ///< so far
    uint8_t *uploads;  ///< per tile, since scene_rest; owned
    uint8_t *min_mip;  ///< as last published; owned
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
    uint32_t maps_per_frame; ///< round robin
    uint32_t load_frames;    ///< from being handed out to the answer
    uint32_t retire_frames;  ///< until a retire value completes
    uint32_t loads_per_frame;
    uint32_t timeout_frames;
    uint32_t missing; ///< percent of the regions that a map does not show
    bool releases_heaps;
    uint32_t next;              ///< of the round robin
    uint64_t uploads, unmapped; ///< handed out and unbound so far
    struct scene_load loads[FIXTURE_ROOM];
    uint32_t load_count;
};

/** 8 maps and 64 loads a frame, 2 frames per load, retired after 2, 16 frames of timeout. */
void scene_open(struct scene *s, uint32_t heap_capacity, uint32_t heap_count);
/** The same with alwaysMapPackedTiles. */
void scene_open_packed(struct scene *s, uint32_t heap_capacity, uint32_t heap_count);
void scene_close(struct scene *s);

/** Applies `config`. */
void scene_configure(struct scene *s);

/** A square texture in tiles of 128 x 128 texels, last in the round robin. */
struct scene_texture *scene_add(struct scene *s, uint32_t size, struct scene_window window);

/** Frees what the scene keeps of it too; its place in the round robin stays empty. */
void scene_remove(struct scene *s, struct scene_texture *t);

void scene_run(struct scene *s, uint32_t frames);

/** Forgets which tiles were loaded. */
void scene_rest(struct scene *s);

/** The most uploads of any one tile since scene_rest. */
uint32_t scene_most_uploads(const struct scene *s);

/** Frames until every texture had a map. */
uint32_t scene_round(const struct scene *s);

/** What the window wants at a region; 255 outside of it. */
uint8_t scene_wanted(const struct scene_texture *t, uint32_t x, uint32_t y);

/** Mean levels that are missing in the window, in thousandths; nothing at all counts as R + 1. */
uint32_t scene_deficit(const struct scene_texture *t);
uint32_t scene_mean_deficit(const struct scene *s);

/** Whether every region in view shows its packed level or better. */
bool scene_shows_something(const struct scene_texture *t);

/** Tiles of all textures that are in a state. */
uint32_t scene_tiles_in(const struct scene *s, const struct scene_texture *t,
                        SluiceTileState state);

/** Regular tiles that what is in view needs, and packed ones. */
uint32_t scene_working_set(const struct scene *s);

#endif /* TESTS_CORE_SCENE_H */
