/**
 * Host copy of a feedback map, updated by the results of the resolve passes. The cost is
 * proportional to the changes. No Vulkan.
 */
#ifndef SLC_VULKAN_FEEDBACK_MAP_H
#define SLC_VULKAN_FEEDBACK_MAP_H

#include <sluice/shared/resolve.h>

#include <stdbool.h>
#include <stdint.h>

struct slc_feedback_map {
    uint8_t *levels; ///< borrowed; levels resolved last, SLUICE_MIP_UNTOUCHED at first
    uint32_t region_count;
    uint32_t checksum; ///< checksum of `levels`; 0 at first
};

/** Makes a map in which all regions are SLUICE_MIP_UNTOUCHED. */
void slc_feedback_map_init(struct slc_feedback_map *map, uint8_t *levels, uint32_t region_count);

/**
 * Applies a result other than SLUICE_RESOLVED_NOTHING; `data` are its `count` words. False if the
 * result does not fit the map, or the checksum differs afterwards: the map is then invalid until a
 * result brings the whole map.
 */
bool slc_feedback_map_update(struct slc_feedback_map *map, const struct SluiceResolveResult *result,
                             const uint32_t *data);

/** Returns the factor of a region in the checksum. Twin of sluiceResolveWeight. */
uint32_t slc_resolve_weight(uint32_t region);

#endif /* SLC_VULKAN_FEEDBACK_MAP_H */
