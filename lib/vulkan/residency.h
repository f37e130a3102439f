/**
 * What makes texels resident: one interface, one implementation per file (residency_sparse.c:
 * sparse binding; residency_paged.c: a page table for shaders; residency_dense.c: fully backed
 * images). The streamer decides nothing about memory and an implementation nothing about tiles.
 *
 * The protocol of a frame:
 *
 *     update            polls; from here on completed_value and retire_limit are of this frame
 *     unmap, map        collect changes
 *     submit            makes all of them happen; they are over once completed_value reaches *value
 *     record_begin      before everything else
 *     record_uploads    into images whose maps are over
 *     record_publish    behind the uploads, before the MinMip maps that show them
 *
 * After any of these frames:
 *
 *     abandon           it, and those after it, were never submitted, but for what submit did
 */
#ifndef SLC_VULKAN_RESIDENCY_H
#define SLC_VULKAN_RESIDENCY_H

#include "vulkan/buffer.h"
#include "vulkan/caps.h"
#include "vulkan/image_use.h"
#include "vulkan/page_sharing.h"

struct slc_residency;

/** The image of one streamed texture. */
struct slc_residency_image {
    VkImage image;
    SluiceStreamedTextureDesc desc;
    bool uneven;          ///< some level's size is not twice the next one's
    bool storage;         ///< shaders can store to it
    uint32_t first_level; ///< of the texture that `image` has
};

/** Layer of an image that holds one tile. */
struct slc_tile_page {
    VkImage image;
    VkImageView view; ///< all layers, for stores; VK_NULL_HANDLE if shaders cannot store
    uint32_t image_index, layer;
};

/** Bits: copies texels, and shows tiles from the frame that begins on. */
enum slc_upload_part { SLC_UPLOAD_COPY = 1, SLC_UPLOAD_SHOW = 2 };

struct slc_residency_interface {
    /** Uploads go to images that are not sparse and have all their memory. */
    bool ordinary_images;
    /** A map is complete only when no frame under way can read the tile's place. */
    bool maps_unread;

    /** Nothing of it is in use on the GPU. */
    void (*destroy)(struct slc_residency *residency);

    /** `index` is the streamer's; it names the image in the other calls. The layers of an array
     *  have the indices from `index` on. Logs what it refuses;
     *  sparse: if `refusal` is not NULL, says there what UNSUPPORTED means instead. */
    SluiceResult (*create_image)(struct slc_residency *residency, uint32_t index,
                                 const SluiceImageInfo *info, const struct slc_image_use *use,
                                 const char **refusal, struct slc_residency_image *image);
    /** No frame that uses it is incomplete and image_is_idle. Of an array with its first layer. */
    void (*destroy_image)(struct slc_residency *residency, uint32_t index);
    /** True when no change of it is pending or under way. */
    bool (*image_is_idle)(const struct slc_residency *residency, uint32_t index);

    /** True: the texels of a tile that was unmapped are still there, and it is mapped again; shown
     *  by this frame at the earliest. Asked before its texels are read. NULL: they never are. */
    bool (*revive)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);

    /** The texels of an image's layer come from this layer of the source: tiles that are equal, or
     *  that another front end shows, may have one page. NULL, as the next four are then: no tile is
     * shared. */
    void (*set_source)(struct slc_residency *residency, uint32_t index, SluiceImageSource *source,
                       uint32_t layer);
    /** SLC_SHARE_READY: the tile or an equal one is on a page, and it is mapped, as by revive;
     *  asked before that. SLC_SHARE_WAIT: it will be. Of regular tiles. */
    enum slc_share (*share)(struct slc_residency *residency, uint32_t index,
                            const SluiceTile *tile);
    /** A read of the tile begins. */
    void (*announce)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);
    /** It failed, or what it read is not mapped. */
    void (*withdraw)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);
    /** The image is removed: its source need not live longer. */
    void (*leave_source)(struct slc_residency *residency, uint32_t index);

    /** The texels of the source have changed: what is shared of it is shared no longer. */
    void (*drop_source)(struct slc_residency *residency, uint32_t index);

    /** A tile that is not mapped cannot be revived: its texels have changed. NULL: none can. */
    void (*spoil)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);
    /** Other texels are about to be copied to a mapped tile: it gets a page of its own if others
     *  have its page. False: there is none now. NULL: tiles have their own. */
    bool (*renew)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);

    /** False: no more tiles may ever be bound, and this one was not yet. NULL: all may. */
    bool (*reserve)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);

    /** Whether that call would return true. NULL: always. */
    bool (*may_reserve)(const struct slc_residency *residency, uint32_t index, uint32_t tile);

    /** Pages that tiles of this image could have now; UINT32_MAX: nobody knows of an end. NULL:
     *  slots of heaps are all they need. */
    uint32_t (*page_room)(const struct slc_residency *residency, uint32_t index);

    /**
     * Moves tiles together until memory has fallen by `size` bytes: frames do so until the next
     * call. Returns how many pages must be given back first. Returns SLC_NONE if no image can be
     * emptied, or none has to be. NULL if pages are slots of heaps; `compact` is NULL then, too.
     */
    uint32_t (*gather)(struct slc_residency *residency, uint64_t size);
    /** Lets the next frame move at most `most` tiles, if the moves can empty an image in the end.
     *  Equal tiles on one page count once. Returns how many tiles can move; frames under way may
     *  hold some of them back. */
    uint32_t (*compact)(struct slc_residency *residency, uint32_t most);

    /** As SluiceHeapAllocator. */
    SluiceResult (*allocate_heap)(struct slc_residency *residency, uint64_t size,
                                  uint32_t *heap_id);
    void (*release_heap)(struct slc_residency *residency, uint32_t heap_id);
    /** Makes heaps of `size` bytes ahead, at most `max_count`; 0: any number. NULL: heaps have no
     *  memory, as in the next two. */
    void (*prepare_heaps)(struct slc_residency *residency, uint64_t size, uint32_t max_count);
    /** Frees up to `wanted` bytes, in whole heaps, that hold no tiles. Returns how many. */
    uint64_t (*free_spare)(struct slc_residency *residency, uint64_t wanted);
    /** Bytes of heaps that were released and are not freed yet. NULL: heaps have no memory. */
    uint64_t (*going_size)(const struct slc_residency *residency);

    /** `frame` begins. `completed_frame`: the last frame that is over on the GPU. Never waits. */
    SluiceResult (*update)(struct slc_residency *residency, uint64_t frame,
                           uint64_t completed_frame);
    /** NOT_READY, and nothing is collected: there is no room now, or an older use of the tile's
     *  place is not over. Ask again in the next frame. OUT_OF_DEVICE_MEMORY, of regular
     *  tiles alone: not even soon. */
    SluiceResult (*map)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);
    /** The MinMip maps of `frame` are the first that do not show the tile. `filled` false: its
     *  texels may not be there, so it cannot be revived. Only room_to_unmap times. */
    void (*unmap)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile,
                  uint64_t frame, bool filled);
    /** Takes back a map that is complete. The tile was never shown, and no frame reads or writes
     *  it. NULL: nothing to do. */
    void (*discard)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);
    /** How many unmaps may be collected. */
    uint32_t (*room_to_unmap)(const struct slc_residency *residency);
    /** All that was collected goes to the GPU; `*value` names it. */
    SluiceResult (*submit)(struct slc_residency *residency, uint64_t *value);
    /** Until everything submitted is over. For tests and shutdown. */
    SluiceResult (*wait)(struct slc_residency *residency);
    uint64_t (*completed_value)(const struct slc_residency *residency);
    /** The largest frame such that all unmaps of it and of earlier ones are over. */
    uint64_t (*retire_limit)(const struct slc_residency *residency, uint64_t completed_frame);

    /** One image's texels from `buffer`; the streamer puts barriers around. COPY alone may be of
     *  another queue: the tiles are shown later, by SHOW alone. */
    void (*record_uploads)(struct slc_residency *residency, uint32_t index,
                           VkCommandBuffer commands, VkBuffer buffer, uint32_t count,
                           const VkBufferImageCopy *regions, uint32_t parts);

    /* What follows may be NULL: there is nothing to do. */

    /** Finds the page to which commands write a regular tile. The map of the tile is complete.
     *  NULL: tiles have their places in the texture's image. */
    struct slc_tile_page (*find_page)(const struct slc_residency *residency, uint32_t index,
                                      const SluiceTile *tile);
    /** Shows a tile from the frame that begins on. A complete frame wrote its texels. */
    void (*show)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);

    /** Of the frame being begun, behind a barrier over all that earlier ones do. */
    void (*record_begin)(struct slc_residency *residency, uint64_t frame, VkCommandBuffer commands);
    void (*record_publish)(struct slc_residency *residency, VkCommandBuffer commands);
    /** What frames from `frame` on recorded is recorded by the next one; uploads come again by
     *  themselves. */
    void (*abandon)(struct slc_residency *residency, uint64_t frame);
    /** Its handle and address never change. */
    const struct slc_buffer *(*page_table)(const struct slc_residency *residency);
    /** Of SluiceTextureEntry. */
    uint32_t (*page_table_offset)(const struct slc_residency *residency, uint32_t index);
};

/** What is counted for the public statistics. */
struct slc_residency_counters {
    uint64_t bind_calls, bind_runs;
    uint64_t unbinds, unbinds_saved; ///< tiles
    uint32_t page_chunks;
    uint64_t page_chunk_shortages;
};

/** The first member of every implementation's own struct. */
struct slc_residency {
    const struct slc_residency_interface *interface;
    struct slc_residency_counters counters;
};

struct slc_residency_create_info {
    const struct slc_vk *vk; ///< outlives the residency, as what follows
    const struct slc_caps *caps;
    const SluiceAllocationCallbacks *cb;
    VkQueue sparse_queue;
    uint32_t max_binds_per_call; ///< at least 1
    uint32_t max_image_count;
    uint32_t max_changes;       ///< maps and unmaps per frame
    uint32_t max_touched_tiles; ///< 0: no limit
    uint32_t max_region_count;
    uint64_t kept_heap_size;     ///< bytes of heaps that are kept while empty
    bool whole;                  ///< dense: textures have packed levels alone
    bool packed_outside;         ///< paged: packed tiles take no slots
    bool may_lack_memory;        ///< for an image: that is no news
    struct slc_page_pool *pages; ///< borrowed
    uint32_t page_user;          ///< of these
};

SluiceResult slc_create_sparse_residency(const struct slc_residency_create_info *info,
                                         struct slc_residency **residency);
SluiceResult slc_create_paged_residency(const struct slc_residency_create_info *info,
                                        struct slc_residency **residency);
SluiceResult slc_create_dense_residency(const struct slc_residency_create_info *info,
                                        struct slc_residency **residency);

#endif /* SLC_VULKAN_RESIDENCY_H */
