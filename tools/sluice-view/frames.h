/** Frames in flight: commands, and the picture with the user interface, which is presented or
 *  written. */
#ifndef SLUICE_VIEW_FRAMES_H
#define SLUICE_VIEW_FRAMES_H

#include "swapchain.h"
#include "ui_draw.h"

#define FRAMES_SLOTS UI_DRAW_SLOTS
#define FRAMES_MAX_SIGNALS 4
#define FRAMES_TIMES 6 ///< time stamps per slot: begin and end of the frame and of two halves

struct frames {
    const struct gpu *gpu; ///< borrowed
    struct target target;  ///< picture and user interface
    struct ui_drawing drawing;
    struct frames_slot {
        VkCommandBuffer commands;
        VkFence fence;
        bool submitted;
        unsigned halves; ///< bits: halves that were recorded
        bool swapped;    ///< half 0 was recorded as half 1
    } slots[FRAMES_SLOTS];
    struct gpu_buffer pixels; ///< for screenshots
    VkQueryPool times;        ///< FRAMES_TIMES per slot
    uint64_t number;          ///< number of the next frame
    double gpu_seconds;       ///< GPU time of the last frame that was read back
    double half_seconds[2];   ///< GPU times of the halves that were read back last
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
    uint32_t image;              ///< image of the swapchain, acquired for the slot
    bool read;                   ///< keeps the pixels for frames_write
};

/** Creates frames. Call ui_create first, for the fonts. False, with a line on stderr, on failure.
 */
bool frames_create(const struct gpu *gpu, uint32_t width, uint32_t height, struct frames *frames);
/** Waits for all frames, and destroys them. A zeroed struct is allowed. */
void frames_destroy(struct frames *frames);
/** Waits for all frames, and sets the size of the next ones. */
bool frames_resize(struct frames *frames, uint32_t width, uint32_t height);
uint32_t frames_slot(const struct frames *frames);
/** Waits until the slot is free, and begins its commands. VK_NULL_HANDLE if that failed. */
VkCommandBuffer frames_begin(struct frames *frames);
/** Begins the commands of half 0 or 1. Halves do not overlap on the GPU, so that each is measured
 *  alone. */
void frames_begin_half(struct frames *frames, uint32_t half);
void frames_end_half(struct frames *frames, uint32_t half);
/** Exchanges the halves of all frames in flight. Call before the halves of this frame. */
void frames_swap_halves(struct frames *frames);
/** Halves of the frames in flight are not read. Before halves of this frame. */
void frames_forget_halves(struct frames *frames);
bool frames_end(struct frames *frames, const struct frames_end *end);
/** Writes the pixels of the last frame, whose `read` was set, as a PNG file. */
bool frames_write(struct frames *frames, const char *path);
/** Waits for the last frame, whose `read` was set, and returns its pixels. NULL on failure. */
const uint8_t *frames_pixels(struct frames *frames);
bool frames_wait(struct frames *frames);

#endif /* SLUICE_VIEW_FRAMES_H */
