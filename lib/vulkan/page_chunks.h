/**
 * The array images ("chunks") whose layers are the pages of a pool: when one is made, which layers
 * of it are free, and when one has been empty for so long that it can go.
 *
 * Free layers keep their texels. They stand in a ring, and the one that was freed longest ago is
 * taken first. Not thread-safe: the pool locks.
 */
#ifndef SLC_VULKAN_PAGE_CHUNKS_H
#define SLC_VULKAN_PAGE_CHUNKS_H

#include "vulkan/page_timelines.h"
#include "vulkan/plain_image.h"

#define SLC_PAGE_FORMATS 256u
/* In a format: of pages that commands of the application write. They lie in chunks of their own,
 * which shaders can store to. */
#define SLC_PAGE_PRODUCED 128u
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
    uint64_t value;          ///< free: the last frame of `user` that could read it; 0: none could
    uint8_t user;            ///< that holds it, or gave it back
    bool held;
    uint32_t shared; ///< held: 1 + the index of its entry in the directory; 0: it has none
};

struct slc_page_chunk {
    enum slc_page_chunk_state state;
    SluiceFormat format;
    struct slc_plain_image image;
    VkImageView view;
    struct slc_page_layer *layers; ///< owned; layer_count, and the head of the ring of free ones
    uint32_t free_count, layer_count;
    bool leaving;          ///< LIVE: no page of it is taken any more, so that it runs empty
    bool fresh;            ///< not yet in the layout in which it stays
    uint8_t maker;         ///< user that puts it there; SLC_MAX_PAGE_USERS: whoever records next
    uint64_t layout_frame; ///< of the maker, that did; 0: none yet
    uint64_t tick;         ///< LIVE: the last in which it was not empty
    uint64_t retire_values[SLC_MAX_PAGE_USERS]; ///< RETIRING: each user's last frame that sees it
};

struct slc_page_chunks {
    struct slc_page_chunk *at; ///< owned; by the upper 16 bits of a page
    uint32_t count;
    const struct slc_vk *vk; ///< borrowed, as the next two
    const struct slc_caps *caps;
    const SluiceAllocationCallbacks *cb;
    struct slc_image_memory memory;
    uint32_t last[SLC_PAGE_FORMATS];       ///< that a page was taken from
    uint32_t page_count[SLC_PAGE_FORMATS]; ///< of all live chunks of the format
    uint64_t refused_tick; ///< the last in which the device had no memory; 0: it had some then
    bool has_freed;        ///< a chunk has gone since then: one may be made at once
    uint32_t max_layer_count;
    uint64_t max_size;    ///< bytes of device memory, a hard limit; 0: none
    uint32_t image_count; ///< chunks that have an image
    uint64_t shortages;   ///< pages that were not there because all chunks were in use
};

/** The format of the pages of a texture. `produced`: commands of the application write them. */
static inline SluiceFormat slc_page_format(SluiceFormat format, bool produced)
{
    return (SluiceFormat)((uint32_t)format | (produced ? SLC_PAGE_PRODUCED : 0u));
}

/** Pages that so many chunks hold, at most: if all are of one format. */
uint64_t slc_page_chunks_capacity(uint32_t chunk_count, uint32_t max_image_array_layers);

/** After an error it can be finished. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_page_chunks_init(struct slc_page_chunks *chunks, const struct slc_vk *vk,
                                  const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                  uint32_t count);
void slc_page_chunks_finish(struct slc_page_chunks *chunks);

static inline struct slc_page_layer *slc_page_layer(const struct slc_page_chunks *chunks,
                                                    uint32_t page)
{
    return &chunks->at[page >> 16].layers[page & 0xFFFFu];
}

/** Pages of all live chunks, free ones included. */
uint32_t slc_page_chunks_present(const struct slc_page_chunks *chunks);
/** Pages that chunks can still be made for, by max_size and the number of chunks. */
uint32_t slc_page_chunks_room(const struct slc_page_chunks *chunks, uint64_t tick);
/** The device had no memory for a chunk a short while ago. */
bool slc_page_chunks_is_refused(const struct slc_page_chunks *chunks, uint64_t tick);

/** A new chunk belongs to its maker until its layout transition is complete. */
bool slc_page_chunk_is_ready(const struct slc_page_chunk *chunk,
                             const struct slc_page_timelines *timelines, uint32_t user);
/** Free pages of the format that the user may write to now. */
uint32_t slc_page_chunks_free_count(const struct slc_page_chunks *chunks,
                                    const struct slc_page_timelines *timelines, uint32_t user,
                                    SluiceFormat format);
/** One of them; SLUICE_PAGE_NONE if there is none. It stays free until slc_page_chunks_take. */
uint32_t slc_page_chunks_find(struct slc_page_chunks *chunks,
                              const struct slc_page_timelines *timelines, uint32_t user,
                              SluiceFormat format);

/** False if asking the device for another chunk is of no use now. */
bool slc_page_chunks_can_grow(const struct slc_page_chunks *chunks, uint64_t tick);
/** Makes a chunk of the user: as many pages again as the format has, or fewer if the device has no
 *  memory for them. False if it has none at all, or all chunks are in use. */
bool slc_page_chunks_grow(struct slc_page_chunks *chunks, uint64_t tick, uint32_t user,
                          SluiceFormat format);

void slc_page_chunks_take(struct slc_page_chunks *chunks, uint32_t page, uint32_t user);
/** True if the page is still free as `owner` of this user left it. */
bool slc_page_chunks_is_left(const struct slc_page_chunks *chunks, uint32_t page, uint32_t user,
                             uint32_t owner);
/** `value`: the last frame of `user` that may read the page. */
void slc_page_chunks_free(struct slc_page_chunks *chunks, uint32_t page, uint32_t user,
                          uint64_t value, uint32_t owner);

/** Retires the chunk if it has been empty for a while, or just now if `hurry`. No frame that is
 *  recorded from then on may see it. */
void slc_page_chunks_retire(struct slc_page_chunks *chunks, uint32_t index,
                            const struct slc_page_timelines *timelines, bool hurry);
/** Destroys the chunk if it is retiring and no frame that sees it is left. */
void slc_page_chunks_end_retired(struct slc_page_chunks *chunks, uint32_t index,
                                 const struct slc_page_timelines *timelines);

/** Puts a new chunk into its layout, if that is for the user to do. */
void slc_page_chunks_record(struct slc_page_chunks *chunks, uint32_t index,
                            const struct slc_page_timelines *timelines, uint32_t user,
                            VkCommandBuffer commands);
/** The user's frames from `frame` on will never be complete; `last` is the last that will. */
void slc_page_chunks_abandon(struct slc_page_chunks *chunks, uint32_t user, uint64_t frame,
                             uint64_t last);
/** The user goes, and holds no page: no value of its timeline stays. */
void slc_page_chunks_drop_user(struct slc_page_chunks *chunks, uint32_t user);

#endif /* SLC_VULKAN_PAGE_CHUNKS_H */
