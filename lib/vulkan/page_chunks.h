/**
 * Chunks: array images whose layers are the pages of a pool. Makes chunks, tracks their free
 * layers, and retires chunks that have been empty for a while.
 *
 * Free layers keep their texels. They form a ring, and the layer that was freed longest ago is
 * taken first. Not thread-safe: the pool locks.
 */
#ifndef SLC_VULKAN_PAGE_CHUNKS_H
#define SLC_VULKAN_PAGE_CHUNKS_H

#include "vulkan/page_timelines.h"
#include "vulkan/plain_image.h"

#define SLC_PAGE_FORMATS 256u
/* Bit of a format: commands of the application write these pages. They lie in chunks of their own,
 * which shaders can store to. */
#define SLC_PAGE_PRODUCED 128u
#define SLC_PAGE_CHUNK_LAYERS 2048u /* most layers, 128 MiB; fewer if the device has fewer */
#define SLC_MAX_PAGE_CHUNKS (1u << 10)
#define SLC_NO_OWNER UINT32_MAX

enum slc_page_chunk_state {
    SLC_CHUNK_FREE = 0,
    SLC_CHUNK_LIVE,
    SLC_CHUNK_RETIRING, ///< new frames do not see it; waits for earlier frames
};

struct slc_page_layer {
    uint16_t previous, next; ///< free: neighbors in the ring
    uint32_t owner;          ///< free: owner of its texels; SLC_NO_OWNER: none
    uint64_t value; ///< free: the last frame of `user` that could read the layer; held: the
                    ///< last frame with a copy of the texels; 0: none
    uint8_t user;   ///< user that holds it, or gave it back
    bool held;
    bool moved;      ///< the texels were written by a move, and the layer was not taken since
    uint32_t shared; ///< held: 1 + index of the entry in the directory; 0: no entry
};

struct slc_page_chunk {
    enum slc_page_chunk_state state;
    SluiceFormat format;
    struct slc_plain_image image;
    VkImageView view;
    struct slc_page_layer *layers; ///< owned; layer_count, and the head of the ring of free ones
    uint32_t free_count, layer_count;
    bool leaving; ///< LIVE: runs empty; no page of it may be taken
    bool fresh;   ///< its layout transition is not recorded yet
    uint8_t
        maker; ///< user that records the transition; SLC_MAX_PAGE_USERS: the next user to record
    uint64_t layout_frame; ///< the maker's frame with the transition; 0: none yet
    uint64_t tick;         ///< LIVE: last tick in which the chunk was not empty
    uint64_t retire_values[SLC_MAX_PAGE_USERS]; ///< RETIRING: by user, last frame that sees it
};

struct slc_page_chunks {
    struct slc_page_chunk *at; ///< owned; by the upper 16 bits of a page
    uint32_t count;
    const struct slc_vk *vk; ///< borrowed, like the next two fields
    const struct slc_caps *caps;
    const SluiceAllocationCallbacks *cb;
    struct slc_image_memory memory;
    uint32_t last[SLC_PAGE_FORMATS];       ///< by format: chunk of the page taken last
    uint32_t page_count[SLC_PAGE_FORMATS]; ///< by format: pages of all live chunks
    uint64_t next_prepare_tick;            ///< next tick in which chunks are made ahead
    uint64_t refused_tick; ///< 1 + the tick in which the device refused a chunk; 0: not refused
    bool has_freed;        ///< a chunk was freed since the refusal: the device may be asked at once
    uint32_t max_layer_count;
    uint64_t max_size;    ///< bytes of device memory, a hard limit; 0: none
    uint64_t kept_size;   ///< bytes of empty chunks that stay, unless retired in a hurry
    uint32_t image_count; ///< chunks that have an image
    uint64_t shortages;   ///< pages that were missing because all chunks were in use
};

/** Returns the page format of a texture. `produced`: commands of the application write its pages.
 */
static inline SluiceFormat slc_page_format(SluiceFormat format, bool produced)
{
    return (SluiceFormat)((uint32_t)format | (produced ? SLC_PAGE_PRODUCED : 0u));
}

/** Returns the texel format of a page format. */
static inline SluiceFormat slc_page_texel_format(SluiceFormat format)
{
    return (SluiceFormat)(format & ~SLC_PAGE_PRODUCED);
}

/** Returns the most pages that `chunk_count` chunks can hold, which is if all have one format. */
uint64_t slc_page_chunks_capacity(uint32_t chunk_count, uint32_t max_image_array_layers);

/** Finish it after an error, too. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_page_chunks_init(struct slc_page_chunks *chunks, const struct slc_vk *vk,
                                  const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                  uint32_t count);
void slc_page_chunks_finish(struct slc_page_chunks *chunks);

static inline struct slc_page_layer *slc_page_layer(const struct slc_page_chunks *chunks,
                                                    uint32_t page)
{
    return &chunks->at[page >> 16].layers[page & 0xFFFFu];
}

/** Returns the pages of all live chunks, including free ones. */
uint32_t slc_page_chunks_present(const struct slc_page_chunks *chunks);
/** Returns the pages that further chunks can hold, by max_size and the number of chunks. */
uint32_t slc_page_chunks_room(const struct slc_page_chunks *chunks, uint64_t tick);
/** True if the device refused memory for a chunk a short while ago. */
bool slc_page_chunks_is_refused(const struct slc_page_chunks *chunks, uint64_t tick);

/** True if the user may use a chunk: only its maker may before the layout transition is complete.
 */
bool slc_page_chunk_is_ready(const struct slc_page_chunk *chunk,
                             const struct slc_page_timelines *timelines, uint32_t user);
/** Returns the free pages of a chunk that the user may write to now. */
uint32_t slc_page_chunk_free_count(const struct slc_page_chunk *chunk,
                                   const struct slc_page_timelines *timelines, uint32_t user);
/** Returns the free pages of a format that the user may write to now. */
uint32_t slc_page_chunks_free_count(const struct slc_page_chunks *chunks,
                                    const struct slc_page_timelines *timelines, uint32_t user,
                                    SluiceFormat format);
/** Finds a free page that the user may write to now; SLUICE_PAGE_NONE if there is none. The page
 *  stays free until slc_page_chunks_take. */
uint32_t slc_page_chunks_find(struct slc_page_chunks *chunks,
                              const struct slc_page_timelines *timelines, uint32_t user,
                              SluiceFormat format);

/** True if the limits allow another chunk, and the device did not refuse one a short while ago. */
bool slc_page_chunks_can_grow(const struct slc_page_chunks *chunks, uint64_t tick);
/** Makes a chunk for the user. It doubles the pages of the format, or has fewer pages if the device
 *  lacks memory. Returns false if the device has no memory, or all chunks are in use. */
bool slc_page_chunks_grow(struct slc_page_chunks *chunks, uint64_t tick, uint32_t user,
                          SluiceFormat format);

/** Makes chunks for the user, as large as they can be, until there are kept_size bytes or the
 * device has no more. */
void slc_page_chunks_prepare(struct slc_page_chunks *chunks, uint64_t tick, uint32_t user,
                             SluiceFormat format);

void slc_page_chunks_take(struct slc_page_chunks *chunks, uint32_t page, uint32_t user);
/** True if the page is free and still has the texels of this user's `owner`. */
bool slc_page_chunks_is_left(const struct slc_page_chunks *chunks, uint32_t page, uint32_t user,
                             uint32_t owner);
/** Frees a page. `value`: last frame of `user` that may read the page. `owner`: owner of its
 * texels. */
void slc_page_chunks_free(struct slc_page_chunks *chunks, uint32_t page, uint32_t user,
                          uint64_t value, uint32_t owner);

/** Retires a chunk if it has been empty for a while and other chunks have kept_size bytes. `hurry`:
 * retires any empty chunk at once. Frames recorded later may not see the chunk. */
void slc_page_chunks_retire(struct slc_page_chunks *chunks, uint32_t index,
                            const struct slc_page_timelines *timelines, bool hurry);
/** Destroys a retiring chunk if all frames that see it are complete. */
void slc_page_chunks_end_retired(struct slc_page_chunks *chunks, uint32_t index,
                                 const struct slc_page_timelines *timelines);

/** Records the layout transition of a new chunk, if the user is its maker. */
void slc_page_chunks_record(struct slc_page_chunks *chunks, uint32_t index,
                            const struct slc_page_timelines *timelines, uint32_t user,
                            VkCommandBuffer commands);
/** Abandons the user's frames from `frame` on. `last`: last frame of the user that will complete.
 */
void slc_page_chunks_abandon(struct slc_page_chunks *chunks, uint32_t user, uint64_t frame,
                             uint64_t last);
/** Removes all values of the timeline of a user, which holds no page and is removed. */
void slc_page_chunks_drop_user(struct slc_page_chunks *chunks, uint32_t user);

#endif /* SLC_VULKAN_PAGE_CHUNKS_H */
