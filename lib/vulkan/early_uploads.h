/**
 * Copies of tiles that no frame shows yet, on the upload queue. Frames do not wait for them: a tile
 * is shown by a frame that begins when its copy is complete.
 *
 * A copy may begin when no frame in progress can read the tile's memory: in images of pages and
 * dense images, when the frame that mapped the tile is complete. Frames that copy tiles themselves
 * use barriers instead.
 */
#ifndef SLC_VULKAN_EARLY_UPLOADS_H
#define SLC_VULKAN_EARLY_UPLOADS_H

#include "vulkan/streamer.h"

/** True if the upload queue copies the unit, now or later. */
bool slc_upload_is_early(const SluiceVulkanStreamer *s, const struct slc_unit *unit);

/** Submits the copies that can begin; moves their units from `binding` to `copying`. Uses
 * frame_units. */
SluiceResult slc_early_uploads_start(SluiceVulkanStreamer *s);

/** Returns the next unit of `copying` whose copy is complete. SLC_NONE: there is none. */
uint32_t slc_early_uploads_next(const SluiceVulkanStreamer *s);

#endif /* SLC_VULKAN_EARLY_UPLOADS_H */
