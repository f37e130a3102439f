/**
 * Progress of each user of a page pool. A user is a streamer in paged mode or a demand loader.
 * Users record independently of each other: each has its own timeline of frames or launches.
 *
 * The pool counts the frames of all users in ticks. A user's safe tick orders its timeline among
 * the others: all of its frames that were recorded up to that tick are complete.
 */
#ifndef SLC_VULKAN_PAGE_TIMELINES_H
#define SLC_VULKAN_PAGE_TIMELINES_H

#include "vulkan/dispatch.h"

#define SLC_MAX_PAGE_USERS 16u
#define SLC_PAGE_FRAMES 16u /* at least as many as a user may have in flight */

struct slc_page_timeline {
    VkSemaphore semaphore;            ///< VK_NULL_HANDLE: no user
    uint64_t recorded;                ///< the last frame that was recorded, and not abandoned
    uint64_t frames[SLC_PAGE_FRAMES]; ///< ring of the last recorded frames
    uint64_t frame_count;             ///< frames put into the ring, without abandoned ones
    uint64_t completed;
    uint64_t safe_tick;  ///< frames that were recorded up to this tick are complete
    uint64_t mark_frame; ///< safe_tick becomes mark_tick when this frame is complete; 0: none
    uint64_t mark_tick;
    /** Last seen progress of each other user, and the number of this user's frames since the
     * progress changed. */
    uint64_t seen[SLC_MAX_PAGE_USERS];
    uint32_t still[SLC_MAX_PAGE_USERS];
};

struct slc_page_timelines {
    struct slc_page_timeline of[SLC_MAX_PAGE_USERS]; ///< by user
    uint32_t user_count;
    uint64_t tick; ///< frames recorded, of all users
};

/** Returns a free index for a user; SLC_MAX_PAGE_USERS if there is none. */
uint32_t slc_page_timelines_free_place(const struct slc_page_timelines *timelines);
/** Adds a user. `semaphore`: timeline that the user's frames signal with their numbers. */
void slc_page_timelines_add(struct slc_page_timelines *timelines, uint32_t user,
                            VkSemaphore semaphore);
void slc_page_timelines_remove(struct slc_page_timelines *timelines, uint32_t user);

/** Begins a tick with a frame of the user: polls the semaphores of all others. */
void slc_page_timelines_advance(struct slc_page_timelines *timelines, const struct slc_vk *vk,
                                uint32_t user, uint64_t completed_frame);
/** Notes that the user's frame is recorded, and may read pages. */
void slc_page_timelines_record(struct slc_page_timelines *timelines, uint32_t user, uint64_t frame);
/** Abandons the user's frames from `frame` on: nothing waits for them any more. */
void slc_page_timelines_abandon(struct slc_page_timelines *timelines, uint32_t user,
                                uint64_t frame);

static inline bool slc_page_timelines_reached(const struct slc_page_timelines *timelines,
                                              uint32_t user, uint64_t frame)
{
    return timelines->of[user].completed >= frame;
}

/** True if all recorded frames of the users in the bit set are complete. `except` is ignored. */
bool slc_page_timelines_are_idle(const struct slc_page_timelines *timelines, uint32_t users,
                                 uint32_t except);
/** True if all frames that the users in the bit set recorded up to the tick are complete. `except`
 *  is ignored. */
bool slc_page_timelines_passed(const struct slc_page_timelines *timelines, uint32_t users,
                               uint32_t except, uint64_t tick);

#endif /* SLC_VULKAN_PAGE_TIMELINES_H */
