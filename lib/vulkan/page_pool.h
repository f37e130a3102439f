/**
 * The physical pages of a context: layers of array images, each as large as a tile. Images
 * ("chunks") are made when pages of a format run out. They are destroyed when they have been empty
 * for a while.
 *
 * Users (streamers in paged mode, demand loaders) record independently of each other: each has its
 * own timeline of frames or launches. A page that a user gives back can be taken by the same user
 * at once, because its own barriers order the copy behind earlier reads. Another user can take it
 * when the last frame that could read it is complete.
 *
 * A page that was given back keeps its texels until it is taken again, and those that were given
 * back longest ago are taken first: until then its last owner can have it back as it was.
 */
#ifndef SLC_VULKAN_PAGE_POOL_H
#define SLC_VULKAN_PAGE_POOL_H

#include "vulkan/memory_budget.h"
#include "vulkan/page_chunks.h"
#include "vulkan/page_timelines.h"
#include "vulkan/page_views.h"
#include "vulkan/shared_tiles.h"
#include "platform/thread.h"

#include <sluice/vulkan.h>

struct slc_page_user {
    struct slc_memory_client *client; ///< for whom the pool allocates; NULL: nobody counts
    /** Views for the user's shaders; owns only the array. A new image enters the array of its maker
     *  with the frame that records its layout transition, and other arrays when that frame is
     *  complete. A retired image leaves with the user's next frame. */
    struct slc_page_views shown;
    uint32_t held_count;  ///< pages, each once
    uint32_t equal_count; ///< tiles on these pages beside the first one
    uint64_t max_size;    ///< bytes; 0: no limit of its own
    uint64_t empty_frame; ///< that put the image of empty places into its layout; 0: none did
};

struct slc_page_pool {
    struct slc_vk vk; ///< the context's, but for memory_client
    struct slc_memory_client client;
    const SluiceAllocationCallbacks *cb;
    struct slc_mutex mutex; ///< around everything below; users may be on different threads
    bool has_mutex;
    struct slc_page_views views; ///< sampler and empty image for the users' arrays
    struct slc_page_chunks chunks;
    struct slc_page_timelines timelines;
    struct slc_page_user users[SLC_MAX_PAGE_USERS];
    struct slc_shared_tiles shared; ///< see page_sharing.h
    struct slc_map generations;     ///< source -> of its texels, if they ever changed
    uint32_t generation;            ///< the newest of all sources
    uint32_t least_generation;      ///< of sources that are not in `generations`
    bool generation_is_named;       ///< a tile was named since the newest one began
    uint32_t held_count;            ///< pages, each once
    bool empty_is_ready;            ///< the image of empty places is in its layout
    bool hurry;                     ///< chunks that are empty are retired with the next record
    uint32_t leaving;               ///< chunk that is to run empty; SLC_NONE: none is
    uint32_t leaving_user;          ///< user that empties it
};

/** After an error it can be finished. Errors: OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN. */
SluiceResult slc_page_pool_init(struct slc_page_pool *pool, const struct slc_vk *vk,
                                const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                uint32_t chunk_count);
/** It has no users. */
void slc_page_pool_finish(struct slc_page_pool *pool);

/** `semaphore`: timeline that the user's frames signal with their numbers. `max_size`: bytes that
 *  the pool may allocate for the user; 0: no limit. `client`: where memory that the user was
 * refused counts, may be NULL. Errors: LIMIT_EXCEEDED, OUT_OF_HOST_MEMORY. */
SluiceResult slc_page_pool_add_user(struct slc_page_pool *pool, VkSemaphore semaphore,
                                    uint64_t max_size, struct slc_memory_client *client,
                                    uint32_t *user);
/** Changes the `max_size` of slc_page_pool_add_user. Frees no chunk. */
void slc_page_pool_set_max_size(struct slc_page_pool *pool, uint32_t user, uint64_t max_size);
/** The user's frames are complete. Pages that it still holds are given back. */
void slc_page_pool_remove_user(struct slc_page_pool *pool, uint32_t user);

/** The array of views for shaders of the user's frames, as of the last frame that was recorded.
 *  Calls of other users do not change it. */
static inline const struct slc_page_views *slc_page_pool_views(const struct slc_page_pool *pool,
                                                               uint32_t user)
{
    return &pool->users[user].shown;
}

/** slc_page_pool_views for applications, without images that others have retired since. Errors:
 *  INVALID_ARGUMENT for a wrong structSize. */
SluiceResult slc_page_pool_write_views(struct slc_page_pool *pool, uint32_t user,
                                       SluiceVulkanPages *out);

/** Pages that the user could hold: those of all chunks, and those that chunks could still be made
 *  for, without pages that others hold. */
uint64_t slc_page_pool_capacity(struct slc_page_pool *pool, uint32_t user);
/** Tiles for which there are pages: one for each page of all chunks, free ones included, without
 *  pages that others hold; and the user's tiles that are on a page with an equal one. */
uint32_t slc_page_pool_present(struct slc_page_pool *pool, uint32_t user);

/** The device had no memory for a chunk a short while ago. */
bool slc_page_pool_is_refused(struct slc_page_pool *pool);

/** The device had no memory for the last chunk that was asked for. */
bool slc_page_pool_was_refused(struct slc_page_pool *pool);

/** Pages of the format that the user can take now, with those that chunks can still be made for if
 *  the pool has a limit. Without one: UINT32_MAX until the device refuses a chunk, and one more
 * than are free later, so that the device is asked again. */
uint32_t slc_page_pool_free_count(struct slc_page_pool *pool, uint32_t user, SluiceFormat format);

/** SLUICE_PAGE_NONE if there is neither a free page nor room for another chunk. Take pages before
 *  the slc_page_pool_record of the frame that shows them: its array of views has their images. */
uint32_t slc_page_pool_take(struct slc_page_pool *pool, uint32_t user, SluiceFormat format);
/** Keeps images of pages of `size` bytes, in all, while they are empty. Default: 0. Call it before
 *  there are users. */
static inline void slc_page_pool_keep(struct slc_page_pool *pool, uint64_t size)
{
    pool->chunks.kept_size = size;
}

/** Makes images of pages of the format until the pool has what it keeps, or there is no memory. */
void slc_page_pool_prepare(struct slc_page_pool *pool, uint32_t user, SluiceFormat format);
/** Removes one tile from the page. `owner` may ask for it again; or SLC_NO_OWNER. A page with other
 *  tiles, of this user or of others, stays theirs. */
void slc_page_pool_give(struct slc_page_pool *pool, uint32_t user, uint32_t page, uint32_t owner);
/** True: nobody has taken the page since `owner` of this user gave it, and now the user has it
 *  again. */
bool slc_page_pool_retake(struct slc_page_pool *pool, uint32_t user, uint32_t page, uint32_t owner);
/** Lets the next shortage ask the device again: it or the budget may have memory now. */
void slc_page_pool_ask_again(struct slc_page_pool *pool);
/** Parts of the calls above for files that lock the pool themselves: the caller has its mutex. */
void slc_page_pool_hold_locked(struct slc_page_pool *pool, uint32_t user, uint32_t page);
void slc_page_pool_give_locked(struct slc_page_pool *pool, uint32_t user, uint32_t page,
                               uint32_t owner);
/** Stops emptying the chunk that runs empty, if any. */
void slc_page_pool_stay_locked(struct slc_page_pool *pool);

/** Chunks that are empty may go to another format. */
void slc_page_pool_hurry(struct slc_page_pool *pool);

/** First frame of a user: shaders may read the image of empty places from now on. */
void slc_page_pool_record_empty(struct slc_page_pool *pool, uint32_t user, uint64_t frame,
                                VkCommandBuffer commands);

/** The image of a page that is held. */
static inline VkImage slc_page_image(const struct slc_page_pool *pool, uint32_t page)
{
    return pool->chunks.at[page >> 16].image.image;
}

/** View of all layers of the image of a page. VK_NULL_HANDLE if shaders cannot store. */
static inline VkImageView slc_page_storage_view(const struct slc_page_pool *pool, uint32_t page)
{
    const struct slc_page_chunk *chunk = &pool->chunks.at[page >> 16];
    return chunk->image.storage ? chunk->view : VK_NULL_HANDLE;
}

/** Begins a frame of the user: new chunks into their layout, empty ones are retired. Before
 *  anything that `frame` copies or draws. */
void slc_page_pool_record(struct slc_page_pool *pool, uint32_t user, uint64_t frame,
                          uint64_t completed_frame, VkCommandBuffer commands);
/** Nothing that the user's frames from `frame` on recorded has happened. */
void slc_page_pool_abandon(struct slc_page_pool *pool, uint32_t user, uint64_t frame);

struct slc_page_pool_counts {
    uint64_t tile_memory_size, device_memory_size; ///< bytes; of pages, and with all else
    uint32_t chunk_count;
    uint64_t shortages;
};
struct slc_page_pool_counts slc_page_pool_get_counts(struct slc_page_pool *pool);

#endif /* SLC_VULKAN_PAGE_POOL_H */
