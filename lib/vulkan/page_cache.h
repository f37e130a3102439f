/**
 * The physical pages of paged residency: layers of array images, each as large as a tile. Images
 * ("chunks") are made when pages of a format run out and go when they have been empty for a while.
 *
 * A page that was given back keeps its texels until it is taken again, and those that were given
 * back longest ago are taken first: until then its last owner can have it back as it was.
 */
#ifndef SLC_VULKAN_PAGE_CACHE_H
#define SLC_VULKAN_PAGE_CACHE_H

#include "vulkan/page_views.h"

#define SLC_PAGE_FORMATS 64u
#define SLC_PAGE_CHUNK_LAYERS 2048u /* 128 MiB, at most, and what the device allows */
#define SLC_MAX_PAGE_CHUNKS (1u << 10)
#define SLC_NO_OWNER UINT32_MAX

enum slc_page_chunk_state {
    SLC_CHUNK_FREE = 0,
    SLC_CHUNK_LIVE,
    SLC_CHUNK_RETIRING, ///< no shader of new frames sees it; waits for the others
};

struct slc_page_layer {
    uint16_t previous, next; ///< free: in the ring
    uint32_t owner;          ///< free: whose texels it has, SLC_NO_OWNER for nobody's
};

struct slc_page_chunk {
    enum slc_page_chunk_state state;
    SluiceFormat format;
    struct slc_plain_image image;
    VkImageView view;
    struct slc_page_layer *layers; ///< owned; layer_count, and the head of the ring of free ones
    uint32_t free_count, layer_count;
    bool fresh;            ///< not yet in the layout in which it stays
    uint64_t layout_frame; ///< that put it there
    uint64_t frame; ///< LIVE: the last in which it was not empty; RETIRING: the first without it
};

struct slc_page_cache {
    const struct slc_vk *vk;
    const struct slc_caps *caps;
    const SluiceAllocationCallbacks *cb;
    struct slc_page_views *views;  ///< borrowed; one per chunk
    struct slc_page_chunk *chunks; ///< owned; views->count
    struct slc_image_memory memory;
    uint32_t last_chunk[SLC_PAGE_FORMATS]; ///< that a page was taken from
    uint32_t page_count[SLC_PAGE_FORMATS]; ///< of all live chunks of the format
    uint64_t frame;                        ///< the last one recorded
    uint64_t refused_frame; ///< the last in which the device had no memory; 0: it had some then
    bool has_freed;         ///< a chunk has gone since then: one may be made at once
    uint32_t max_layer_count;
    uint64_t max_size;    ///< bytes of device memory, a hard cap; 0: none
    uint32_t chunk_count; ///< that have an image
    uint64_t shortages;   ///< pages that were not there because all chunks were in use
    bool hurry;           ///< chunks that are empty go with the next record
};

SluiceResult slc_page_cache_init(struct slc_page_cache *cache, const struct slc_vk *vk,
                                 const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                 struct slc_page_views *views);
/** Nothing of it is in use on the GPU. */
void slc_page_cache_finish(struct slc_page_cache *cache);

/** Pages that so many chunks hold, at most: if all are of one format. */
uint64_t slc_page_chunks_capacity(uint32_t chunk_count, uint32_t max_image_array_layers);

/** Pages of all chunks that are in use, free ones included. */
uint32_t slc_page_cache_layer_count(const struct slc_page_cache *cache);
/** Pages that chunks could still be made for, by max_size and the number of views. */
uint32_t slc_page_cache_room(const struct slc_page_cache *cache);

/** The device had no memory for a chunk a short while ago. */
bool slc_page_cache_is_refused(const struct slc_page_cache *cache);

/** Pages of the format that can be taken now. After a refusal one more than are free, so that the
 *  device is asked again, and UINT32_MAX while it has not refused any. */
uint32_t slc_page_cache_free_count(const struct slc_page_cache *cache, SluiceFormat format);

/** SLUICE_PAGE_NONE if there is neither a free page nor room for another chunk. */
uint32_t slc_page_cache_take(struct slc_page_cache *cache, SluiceFormat format);
/** `owner` may ask for it again; or SLC_NO_OWNER. */
void slc_page_cache_give(struct slc_page_cache *cache, uint32_t page, uint32_t owner);
/** True: nobody has taken the page since `owner` gave it, and now it is taken by him again. */
bool slc_page_cache_retake(struct slc_page_cache *cache, uint32_t page, uint32_t owner);

static inline VkImage slc_page_image(const struct slc_page_cache *cache, uint32_t page)
{
    return cache->chunks[page >> 16].image.image;
}

/** New chunks into their layout; drops chunks. Before anything that `frame` copies or draws. */
void slc_page_cache_record(struct slc_page_cache *cache, uint64_t frame, uint64_t completed_frame,
                           VkCommandBuffer commands);
/** Nothing that frames from `frame` on recorded has happened. */
void slc_page_cache_abandon(struct slc_page_cache *cache, uint64_t frame);

#endif /* SLC_VULKAN_PAGE_CACHE_H */
