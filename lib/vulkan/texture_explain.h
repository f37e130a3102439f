/** Why a texture is as coarse as it is: the place that is looked at, and the sentence about it. */
#ifndef SLC_VULKAN_TEXTURE_EXPLAIN_H
#define SLC_VULKAN_TEXTURE_EXPLAIN_H

#include "core/requested_levels.h"
#include "vulkan/texture_rect.h"

#include <sluice/vulkan_explain.h>

/** A tile of level 0, and what is known of it. Levels are those of the texture. */
struct slc_coarse_place {
    const struct slc_texture *texture, *primary; ///< the same without a primary
    uint32_t x, y;                               ///< in tiles
    uint8_t resident;
    bool fades;
    uint8_t marked; ///< by shaders and requests, before what the application decides about it
    struct slc_requested_level requested;
    uint8_t limit;          ///< finestLevel of the primary, as a level of the texture
    uint32_t missing;       ///< level of the tile that is missing; UNTOUCHED: none
    SluiceTileState state;  ///< of that tile
    bool is_limit_of_tiles; ///< the device binds no more tiles
};

/** Writes the answer in words. */
void slc_explain_in_words(const SluiceVulkanStreamer *s, const struct slc_coarse_place *place,
                          SluiceCoarseReason reason, char *sentence);

#endif /* SLC_VULKAN_TEXTURE_EXPLAIN_H */
