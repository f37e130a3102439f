/**
 * The host's copy of a feedback map, kept up to date by the results of the resolve passes. Costs
 * what has changed. No Vulkan.
 */
#ifndef SLC_VULKAN_FEEDBACK_MAP_H
#define SLC_VULKAN_FEEDBACK_MAP_H

#include <sluice/shared/resolve.h>

#include <stdbool.h>
#include <stdint.h>

struct slc_feedback_map {
    uint8_t *levels; ///< borrowed; as resolved last, SLUICE_MIP_UNTOUCHED at first
    uint32_t region_count;
    uint32_t checksum; ///< of `levels`: 0 at first
};

/** Begins with nothing touched. */
void slc_feedback_map_init(struct slc_feedback_map *map, uint8_t *levels, uint32_t region_count);

/**
 * Takes in a result that is not SLUICE_RESOLVED_NOTHING; `data` are its `count` words. False if it
 * does not fit the map or the map does not have its checksum afterwards: then the map is not what
 * the device has, until a result brings all of it.
 */
bool slc_feedback_map_update(struct slc_feedback_map *map, const struct SluiceResolveResult *result,
                             const uint32_t *data);

/** The factor of a region in the checksum; twin of sluiceResolveWeight. */
uint32_t slc_resolve_weight(uint32_t region);

#endif /* SLC_VULKAN_FEEDBACK_MAP_H */
