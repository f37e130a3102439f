/** Explains why a texture is coarse: facts about a tile, and the sentence made of them. */
#ifndef SLC_VULKAN_TEXTURE_EXPLAIN_H
#define SLC_VULKAN_TEXTURE_EXPLAIN_H

#include "core/requested_levels.h"
#include "vulkan/texture_rect.h"

#include <sluice/vulkan_explain.h>

/** Facts about a tile of level 0. All levels are levels of `texture`. */
struct slc_coarse_place {
    const struct slc_texture *texture, *primary; ///< equal if the texture follows no other one
    uint32_t x, y;                               ///< in tiles
    uint8_t resident;
    bool fades;
    uint8_t marked; ///< level that shaders and requests mark, before the texture's control
    struct slc_requested_level requested;
    uint8_t limit;          ///< finestLevel of the primary, as a level of the texture
    uint32_t missing;       ///< level of the missing tile; UNTOUCHED: none is missing
    SluiceTileState state;  ///< state of the missing tile
    bool is_limit_of_tiles; ///< the device binds no more tiles
};

/** Writes the explanation as a sentence. */
void slc_explain_in_words(const SluiceVulkanStreamer *s, const struct slc_coarse_place *place,
                          SluiceCoarseReason reason, char *sentence);

#endif /* SLC_VULKAN_TEXTURE_EXPLAIN_H */
