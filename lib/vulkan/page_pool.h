/**
 * Pool of the physical pages of a context: layers of array images, each as large as a tile. Images
 * ("chunks") are made when pages of a format run out. They are destroyed when they have been empty
 * for a while.
 *
 * Users (streamers in paged mode, demand loaders) record independently of each other: each has its
 * own timeline of frames or launches. A page that a user gives back can be taken by the same user
 * at once, because its own barriers order the copy behind earlier reads. Another user can take it
 * when the last frame that could read it is complete.
 *
 * A page that was given back keeps its texels until it is taken again. Until then its last owner
 * can take it back with its texels. Pages that were given back longest ago are taken first.
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
    struct slc_memory_client *client; ///< client that refusals are charged to; NULL: none
    /** Views for the user's shaders; owns only the array. A new image enters the array of its maker
     *  with the frame that records its layout transition, and other arrays when that frame is
     *  complete. A retired image leaves with the user's next frame. */
    struct slc_page_views shown;
    uint32_t held_count;  ///< held pages, each counted once
    uint32_t equal_count; ///< tiles on held pages beyond the first one of each page
    uint64_t max_size;    ///< bytes; 0: no limit for this user
    uint64_t empty_frame; ///< frame with the layout transition of the empty image; 0: none
};

struct slc_page_pool {
    struct slc_vk vk; ///< copy of the context's, with `client` as client
    struct slc_memory_client client;
    const SluiceAllocationCallbacks *cb;
    struct slc_mutex mutex; ///< guards the fields below; users may be on different threads
    bool has_mutex;
    struct slc_page_views views; ///< sampler and empty image for the users' arrays
    struct slc_page_chunks chunks;
    struct slc_page_timelines timelines;
    struct slc_page_user users[SLC_MAX_PAGE_USERS];
    struct slc_shared_tiles shared; ///< see page_sharing.h
    struct slc_map generations;     ///< source -> generation of its texels, if they ever changed
    uint32_t generation;            ///< newest generation of all sources
    uint32_t least_generation;      ///< generation of sources that are not in `generations`
    bool generation_is_named;       ///< a key with the newest generation was made
    uint32_t held_count;            ///< held pages, each counted once
    bool empty_is_ready;            ///< the empty image is in its layout
    bool hurry;                     ///< empty chunks are retired with the next record
    uint32_t leaving;               ///< chunk that is being emptied; SLC_NONE: none
    uint32_t leaving_user;          ///< user that empties it
};

/** After an error it can be finished. Errors: OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN. */
SluiceResult slc_page_pool_init(struct slc_page_pool *pool, const struct slc_vk *vk,
                                const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                uint32_t chunk_count);
/** Finishes a pool without users. */
void slc_page_pool_finish(struct slc_page_pool *pool);

/** Adds a user. `semaphore`: timeline that the user's frames signal with their numbers. `max_size`:
 *  bytes that the pool may allocate for the user; 0: no limit. `client`: client that refusals are
 *  charged to, may be NULL. Errors: LIMIT_EXCEEDED, OUT_OF_HOST_MEMORY. */
SluiceResult slc_page_pool_add_user(struct slc_page_pool *pool, VkSemaphore semaphore,
                                    uint64_t max_size, struct slc_memory_client *client,
                                    uint32_t *user);
/** Changes the `max_size` of slc_page_pool_add_user. Frees no chunk. */
void slc_page_pool_set_max_size(struct slc_page_pool *pool, uint32_t user, uint64_t max_size);
/** Removes a user whose frames are complete. Gives its pages back. */
void slc_page_pool_remove_user(struct slc_page_pool *pool, uint32_t user);

/** Returns the array of views for shaders of the user's frames, as of the last recorded frame.
 *  Calls of other users do not change the array. */
static inline const struct slc_page_views *slc_page_pool_views(const struct slc_page_pool *pool,
                                                               uint32_t user)
{
    return &pool->users[user].shown;
}

/** Writes slc_page_pool_views for applications, without images that other users have retired since.
 *  Errors: INVALID_ARGUMENT for a wrong structSize. */
SluiceResult slc_page_pool_write_views(struct slc_page_pool *pool, uint32_t user,
                                       SluiceVulkanPages *out);

/** Returns the pages that the user could hold: pages of all chunks and of chunks that can still be
 *  made, without pages that others hold. */
uint64_t slc_page_pool_capacity(struct slc_page_pool *pool, uint32_t user);
/** Returns the tiles for which there are pages: one for each page of all chunks, including free
 *  ones, without pages that others hold; plus the user's tiles that share a page with an equal one.
 */
uint32_t slc_page_pool_present(struct slc_page_pool *pool, uint32_t user);

/** True if the device refused memory for a chunk a short while ago. */
bool slc_page_pool_is_refused(struct slc_page_pool *pool);

/** True if the device refused memory for the last chunk. */
bool slc_page_pool_was_refused(struct slc_page_pool *pool);

/** Returns the pages of the format that the user can take now. With a limit, pages of chunks that
 *  can still be made count. Without a limit: UINT32_MAX until the device refuses a chunk; then the
 *  free pages plus one, so that the device is asked again. */
uint32_t slc_page_pool_free_count(struct slc_page_pool *pool, uint32_t user, SluiceFormat format);

/** Takes a page. SLUICE_PAGE_NONE if there is neither a free page nor room for another chunk. Take
 *  pages before the slc_page_pool_record of the frame that shows them, so that its array of views
 *  has their images. */
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
/** Takes a page back, with its texels, and returns true if nobody took it since this user gave it
 *  for `owner`. */
bool slc_page_pool_retake(struct slc_page_pool *pool, uint32_t user, uint32_t page, uint32_t owner);
/** Lets the next shortage ask the device again. Call it when device or budget may have memory. */
void slc_page_pool_ask_again(struct slc_page_pool *pool);
/** Parts of the calls above for files that lock the pool themselves: the caller has its mutex. */
void slc_page_pool_hold_locked(struct slc_page_pool *pool, uint32_t user, uint32_t page);
void slc_page_pool_give_locked(struct slc_page_pool *pool, uint32_t user, uint32_t page,
                               uint32_t owner);
/** Stops emptying a chunk, if one is being emptied. */
void slc_page_pool_stay_locked(struct slc_page_pool *pool);

/** Retires empty chunks with the next record, so that other formats can have their memory. */
void slc_page_pool_hurry(struct slc_page_pool *pool);

/** Records the layout transition of the empty image in a user's first frame, before shaders read.
 */
void slc_page_pool_record_empty(struct slc_page_pool *pool, uint32_t user, uint64_t frame,
                                VkCommandBuffer commands);

/** Returns the image of a held page. */
static inline VkImage slc_page_image(const struct slc_page_pool *pool, uint32_t page)
{
    return pool->chunks.at[page >> 16].image.image;
}

/** Returns a view of all layers of a page's image. VK_NULL_HANDLE if shaders cannot store to it. */
static inline VkImageView slc_page_storage_view(const struct slc_page_pool *pool, uint32_t page)
{
    const struct slc_page_chunk *chunk = &pool->chunks.at[page >> 16];
    return chunk->image.storage ? chunk->view : VK_NULL_HANDLE;
}

/** Begins a frame of the user: records layout transitions of new chunks, and retires empty ones.
 *  Call it before `frame` records copies or draws. */
void slc_page_pool_record(struct slc_page_pool *pool, uint32_t user, uint64_t frame,
                          uint64_t completed_frame, VkCommandBuffer commands);
/** Abandons the user's frames from `frame` on: none of their commands runs. */
void slc_page_pool_abandon(struct slc_page_pool *pool, uint32_t user, uint64_t frame);

struct slc_page_pool_counts {
    uint64_t tile_memory_size, device_memory_size; ///< bytes of pages; bytes of all allocations
    uint32_t chunk_count;
    uint64_t shortages;
};
struct slc_page_pool_counts slc_page_pool_get_counts(struct slc_page_pool *pool);

#endif /* SLC_VULKAN_PAGE_POOL_H */
