/**
 * Model of an application: its loads in flight, its bound tiles, and the slots that the GPU may
 * still read. Checks every answer of the manager.
 */
#ifndef TESTS_CORE_APP_MODEL_H
#define TESTS_CORE_APP_MODEL_H

#include "core/sound.h"

enum { APP_TEXTURES = 4, APP_TILES = 64, APP_CAPACITY = 8, APP_HEAPS = 16 };

enum app_tile { APP_NOTHING, APP_LOADING, APP_CANCELING, APP_BOUND };

/** A slot. 0: free; else held by a tile or retiring. */
struct app_slot {
    bool held;
    uint64_t retire; ///< > 0: retire value that must complete before the slot is used again
};

struct app_texture {
    SluiceTextureId id;
    uint32_t tile_count;
    enum app_tile tiles[APP_TILES];
    uint32_t heap[APP_TILES], slot[APP_TILES];
};

struct app_model {
    struct fixture f;
    struct app_texture textures[APP_TEXTURES];
    struct app_slot slots[APP_HEAPS][APP_CAPACITY];
    uint64_t random, time, retire, completed;
    uint32_t handed_out, bound, unbound, removed; ///< so far
};

void app_open(struct app_model *a, uint64_t seed);
/** Removes all textures and waits for the GPU. All slots must be free then, and all heaps
 * released. */
void app_close(struct app_model *a);

/** Make one call each, or one per tile, with random textures and tiles. */
void app_feed(struct app_model *a);
void app_read_map_list(struct app_model *a);
void app_read_cancel_list(struct app_model *a);
void app_read_unmap_list(struct app_model *a);
void app_answer(struct app_model *a, uint32_t one_in);
void app_replace_texture(struct app_model *a);
void app_defragment(struct app_model *a);
void app_release_heaps(struct app_model *a);
void app_complete(struct app_model *a);

/** Checks every tile and slot against the manager's states and counts. */
void app_check(const struct app_model *a);

#endif /* TESTS_CORE_APP_MODEL_H */
