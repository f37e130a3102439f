/**
 * Copies of tiles that no frame shows yet, on the upload queue. Frames do not wait for them: a tile
 * is shown by a frame that begins when its copy is complete.
 *
 * A copy may begin when no frame under way can read the place of the tile: in images of pages and
 * dense images, when the frame that mapped it is complete. Frames that copy tiles themselves have
 * barriers for that.
 */
#ifndef SLC_VULKAN_EARLY_UPLOADS_H
#define SLC_VULKAN_EARLY_UPLOADS_H

#include "vulkan/streamer.h"

/** True if the upload queue copies the unit, now or as soon as it may. */
bool slc_upload_is_early(const SluiceVulkanStreamer *s, const struct slc_unit *unit);

/** Submits what can be copied now; its units go from `binding` to `copying`. Uses frame_units. */
SluiceResult slc_early_uploads_start(SluiceVulkanStreamer *s);

/** The next unit of `copying` whose copy is complete. SLC_NONE: there is none. */
uint32_t slc_early_uploads_next(const SluiceVulkanStreamer *s);

#endif /* SLC_VULKAN_EARLY_UPLOADS_H */
