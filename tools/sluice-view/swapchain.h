/** Swapchain of a window. Finished pictures are copied to its images and presented. */
#ifndef SLUICE_VIEW_SWAPCHAIN_H
#define SLUICE_VIEW_SWAPCHAIN_H

#include "../common/gpu.h"
#include "../common/target.h"

#define SWAPCHAIN_MAX_IMAGES 16
#define SWAPCHAIN_SLOTS 2 ///< frames in flight

struct swapchain {
    const struct gpu *gpu; ///< borrowed
    VkSurfaceKHR surface;  ///< borrowed
    VkSwapchainKHR swapchain;
    VkImage images[SWAPCHAIN_MAX_IMAGES];
    VkSemaphore
        presented[SWAPCHAIN_MAX_IMAGES]; ///< per image; signaled when the image may be presented
    VkSemaphore
        acquired[SWAPCHAIN_SLOTS]; ///< per frame in flight; signaled when its image is acquired
    uint32_t image_count, width, height;
    VkPresentModeKHR wanted; ///< set before swapchain_create
    VkPresentModeKHR mode;   ///< in use
    bool outdated;           ///< must be created again before the next frame
};

enum swapchain_outcome { SWAPCHAIN_GOOD, SWAPCHAIN_OUTDATED, SWAPCHAIN_FAILED };

/** Chooses a present mode. Replaces IMMEDIATE by MAILBOX, and MAILBOX by FIFO, if the wanted mode
 * is not offered. Every window offers FIFO. */
VkPresentModeKHR swapchain_choose_mode(VkPresentModeKHR wanted, const VkPresentModeKHR *offered,
                                       uint32_t count);
/** Returns the name of a mode: "FIFO", "MAILBOX" or "IMMEDIATE". */
const char *swapchain_mode_name(VkPresentModeKHR mode);
/** Creates the swapchain, or creates it again with another size. No frame may be in flight. Returns
 *  SWAPCHAIN_OUTDATED while the window has no pixels. */
enum swapchain_outcome swapchain_create(const struct gpu *gpu, VkSurfaceKHR surface, uint32_t width,
                                        uint32_t height, struct swapchain *swapchain);
/** Destroys the swapchain. A zeroed struct is allowed. */
void swapchain_destroy(struct swapchain *swapchain);
/** Acquires an image. Call before the frame records commands, so that none must be abandoned. */
enum swapchain_outcome swapchain_acquire(struct swapchain *swapchain, uint32_t slot,
                                         uint32_t *image);
/** Records a copy of a target to the image. Call after the render pass of the target. */
void swapchain_record_copy(const struct swapchain *swapchain, uint32_t image,
                           const struct target *target, VkCommandBuffer commands);
enum swapchain_outcome swapchain_present(struct swapchain *swapchain, uint32_t image);

#endif /* SLUICE_VIEW_SWAPCHAIN_H */
