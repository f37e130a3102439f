/**
 * Resident tiles whose texels have changed in the source. They are read again and copied over the
 * old texels, which frames show until then. A tile on a page that other tiles or users share gets a
 * page of its own first.
 *
 * A load that began before the change is read again, or followed by a reload
 * (docs/decisions/0118-reloads-replace-texels-in-place.md).
 */
#ifndef SLC_VULKAN_LOAD_RELOADS_H
#define SLC_VULKAN_LOAD_RELOADS_H

#include "vulkan/streamer.h"

/** Makes room for `tile_count` tiles. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_reloads_reserve(SluiceVulkanStreamer *s, uint32_t tile_count);
/** Queues a regular tile, or the mip tail, to be read again. Needs slc_reloads_reserve. */
void slc_reload_tile(SluiceVulkanStreamer *s, uint32_t texture, uint32_t tile);
void slc_reload_tail(SluiceVulkanStreamer *s, uint32_t texture);
/** True if texels of the tile wait to be read again. */
bool slc_reload_is_due(const SluiceVulkanStreamer *s, uint32_t texture, uint32_t tile);
/** Returns the tiles of the texture that show old texels. A mip tail counts as one. */
uint32_t slc_reload_count(const SluiceVulkanStreamer *s, uint32_t texture);

/** Starts reads, at most a quarter of maxLoadsInFlight at a time. */
SluiceResult slc_reloads_start(SluiceVulkanStreamer *s);
/** Ends a read of a reload with `answer`. */
void slc_reload_back(SluiceVulkanStreamer *s, uint32_t unit, SluiceResult answer);
/** Repeats a read that began before the change. Returns false if the loader refuses. */
bool slc_unit_read_again(SluiceVulkanStreamer *s, uint32_t unit, SluiceResult *answer);
/** Drops reloads of a mip tail that is unmapped. */
void slc_reloads_drop_tail(SluiceVulkanStreamer *s, uint32_t texture);
/** Drops reloads of a texture that is removed. */
void slc_reloads_drop(SluiceVulkanStreamer *s, uint32_t texture);
/** Gives a reloaded tile a page of its own if necessary. False: no page is free. */
bool slc_reload_has_place(SluiceVulkanStreamer *s, const struct slc_unit *unit);

#endif /* SLC_VULKAN_LOAD_RELOADS_H */
