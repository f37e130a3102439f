/** Marks of tiles, for shaders: why finer levels are missing, and the age of resident tiles. */
#ifndef SLUICE_VIEW_TILE_MARKS_H
#define SLUICE_VIEW_TILE_MARKS_H

#include "mark_words.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define MARK_THRASH_LOADS 3u
#define MARK_THRASH_MICROSECONDS 10000000u

struct tile_marks {
    SluiceVulkanStreamer *streamer; ///< borrowed
    struct mark_texture *textures;  ///< owned, as all below
    struct mark_order *order;       ///< by id
    struct mark_tile *tiles;
    uint32_t *words; ///< marks in the layout that shaders read
    uint8_t *maps;   ///< scratch for two maps of the largest texture
    size_t map_size, word_count, tile_count;
    uint32_t texture_count, next_texture;
    uint64_t event_cursor;
};

/** Creates marks of textures. False without memory. */
bool tile_marks_create(SluiceVulkanStreamer *streamer, const SluiceTextureId *ids, uint32_t count,
                       struct tile_marks *marks);
/** Frees the marks. A zeroed struct is allowed. */
void tile_marks_destroy(struct tile_marks *marks);
/** Adds new events. With `show`, also updates the words of some textures. Call once per frame.
 * `now`: time stamp of the frame, in microseconds. */
void tile_marks_update(struct tile_marks *marks, uint64_t now, bool show);
/** Size of the words in bytes. */
size_t tile_marks_size(const struct tile_marks *marks);
void tile_marks_copy(const struct tile_marks *marks, void *to);

#endif /* SLUICE_VIEW_TILE_MARKS_H */
