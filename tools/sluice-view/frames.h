/** Frames in flight: commands, the picture with the user interface on it, and where it goes. */
#ifndef SLUICE_VIEW_FRAMES_H
#define SLUICE_VIEW_FRAMES_H

#include "swapchain.h"
#include "ui_draw.h"

#define FRAMES_SLOTS UI_DRAW_SLOTS
#define FRAMES_MAX_SIGNALS 4
#define FRAMES_TIMES 6 ///< time stamps per slot: of the frame, and of two halves

struct frames {
    const struct gpu *gpu; ///< borrowed
    struct target target;  ///< picture and user interface
    struct ui_drawing drawing;
    struct frames_slot {
        VkCommandBuffer commands;
        VkFence fence;
        bool submitted;
        unsigned halves; ///< bits: those that were recorded
        bool swapped;    ///< half 0 was recorded as half 1
    } slots[FRAMES_SLOTS];
    struct gpu_buffer pixels; ///< for screenshots
    VkQueryPool times;        ///< FRAMES_TIMES per slot
    uint64_t number;          ///< of the next frame
    double gpu_seconds;       ///< of the last frame that is known
    double half_seconds[2];   ///< of the last frames that are known
    unsigned halves_known;    ///< bits: half_seconds that frames_begin has just read
};

/** A timeline semaphore that the frame signals. */
struct frames_signal {
    VkSemaphore semaphore;
    uint64_t value;
};

/** Parts of a frame besides its commands. */
struct frames_end {
    const struct ui_geometry *geometry;
    VkImageView views[UI_TEXTURE_COUNT]; ///< in SHADER_READ_ONLY_OPTIMAL
    struct frames_signal signals[FRAMES_MAX_SIGNALS];
    uint32_t signal_count;
    struct swapchain *swapchain; ///< NULL: none
    uint32_t image;              ///< of the swapchain, acquired for the slot
    bool read;                   ///< keep the pixels; see frames_write
};

/** Fonts must exist (ui_create). Says on stderr what failed. */
bool frames_create(const struct gpu *gpu, uint32_t width, uint32_t height, struct frames *frames);
/** Waits for all frames. A zeroed struct is fine. */
void frames_destroy(struct frames *frames);
/** Waits for all frames; the next one has another size. */
bool frames_resize(struct frames *frames, uint32_t width, uint32_t height);
uint32_t frames_slot(const struct frames *frames);
/** Waits until the slot is free, and begins its commands. VK_NULL_HANDLE if that failed. */
VkCommandBuffer frames_begin(struct frames *frames);
/** Around the commands of half 0 or 1. Halves do not overlap on the GPU, so that each is measured
 *  by itself. */
void frames_begin_half(struct frames *frames, uint32_t half);
void frames_end_half(struct frames *frames, uint32_t half);
/** Half 0 of the frames in flight is half 1 from now on. Before halves of this frame. */
void frames_swap_halves(struct frames *frames);
bool frames_end(struct frames *frames, const struct frames_end *end);
/** Writes the pixels of the last frame, whose `read` was set, as a PNG file. */
bool frames_write(struct frames *frames, const char *path);
/** Pixels of the last frame, whose `read` was set: waits for it. NULL if that failed. */
const uint8_t *frames_pixels(struct frames *frames);
bool frames_wait(struct frames *frames);

#endif /* SLUICE_VIEW_FRAMES_H */
