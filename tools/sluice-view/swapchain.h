/** The images of a window: the finished picture is copied to them and presented. */
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
    VkSemaphore presented[SWAPCHAIN_MAX_IMAGES]; ///< of an image: signaled when it may be presented
    VkSemaphore acquired[SWAPCHAIN_SLOTS];       ///< of a frame in flight
    uint32_t image_count, width, height;
    VkPresentModeKHR wanted; ///< set before swapchain_create
    VkPresentModeKHR mode;   ///< in use
    bool outdated;           ///< create it again before the next frame
};

enum swapchain_outcome { SWAPCHAIN_GOOD, SWAPCHAIN_OUTDATED, SWAPCHAIN_FAILED };

/** IMMEDIATE is replaced by MAILBOX, and MAILBOX by FIFO, which every window has. */
VkPresentModeKHR swapchain_choose_mode(VkPresentModeKHR wanted, const VkPresentModeKHR *offered,
                                       uint32_t count);
/** "FIFO", "MAILBOX", "IMMEDIATE". */
const char *swapchain_mode_name(VkPresentModeKHR mode);
/** Creates it, or creates it again with another size; no frame may be in flight. SWAPCHAIN_OUTDATED
 *  while the window has no pixels. */
enum swapchain_outcome swapchain_create(const struct gpu *gpu, VkSurfaceKHR surface, uint32_t width,
                                        uint32_t height, struct swapchain *swapchain);
/** A zeroed struct is fine. */
void swapchain_destroy(struct swapchain *swapchain);
/** Call before anything of the frame is recorded, so that nothing has to be abandoned. */
enum swapchain_outcome swapchain_acquire(struct swapchain *swapchain, uint32_t slot,
                                         uint32_t *image);
/** Records the copy of a target after its render pass. */
void swapchain_record_copy(const struct swapchain *swapchain, uint32_t image,
                           const struct target *target, VkCommandBuffer commands);
enum swapchain_outcome swapchain_present(struct swapchain *swapchain, uint32_t image);

#endif /* SLUICE_VIEW_SWAPCHAIN_H */
