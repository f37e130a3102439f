/**
 * Residency: the interface by which texels become resident, with one implementation per file.
 * residency_sparse.c uses sparse binding, residency_paged.c a page table for shaders,
 * residency_dense.c fully backed images. The streamer decides about tiles, implementations about
 * memory.
 *
 * The protocol of a frame:
 *
 *     update            polls; updates completed_value and retire_limit
 *     unmap, map        collect changes
 *     submit            submits the changes; complete once completed_value reaches *value
 *     record_begin      before everything else
 *     record_uploads    copies into images whose maps are complete
 *     record_publish    after the uploads, before the MinMip maps that show them
 *
 * After any of these frames:
 *
 *     abandon           the frame and later ones never run; changes of submit stay
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
    uint32_t first_level; ///< first level of the texture that is in `image`
};

/** Layer of an image that holds one tile. */
struct slc_tile_page {
    VkImage image;
    VkImageView view; ///< all layers, for stores; VK_NULL_HANDLE if shaders cannot store
    uint32_t image_index, layer;
};

/** Bits of record_uploads. COPY: copy texels. SHOW: show tiles from the frame that begins on. */
enum slc_upload_part { SLC_UPLOAD_COPY = 1, SLC_UPLOAD_SHOW = 2 };

struct slc_residency_interface {
    /** Uploads go to images that are not sparse and have all their memory. */
    bool ordinary_images;
    /** A map is complete only when no frame under way can read the tile's place. */
    bool maps_unread;

    /** Destroys the residency. The GPU must not use it any more. */
    void (*destroy)(struct slc_residency *residency);

    /** Creates the image of a texture. `index` is the streamer's, and names the image in all calls.
     *  Layers of an array have the indices from `index` on. Logs errors. Sparse: if `refusal` is
     *  not NULL, writes the reason for UNSUPPORTED there instead. */
    SluiceResult (*create_image)(struct slc_residency *residency, uint32_t index,
                                 const SluiceImageInfo *info, const struct slc_image_use *use,
                                 const char **refusal, struct slc_residency_image *image);
    /** Destroys an image. All frames that use it must be complete, and image_is_idle true. For an
     *  array: call it with the first layer. */
    void (*destroy_image)(struct slc_residency *residency, uint32_t index);
    /** True if no change of the image is pending or in progress. */
    bool (*image_is_idle)(const struct slc_residency *residency, uint32_t index);

    /** Maps an unmapped tile again if its texels are still there, and returns true. This frame may
     *  show the tile. Call it before the texels are read. NULL: texels are never kept. */
    bool (*revive)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);

    /** Sets the source of an image's layer: equal tiles, and tiles that another front end shows,
     * may share a page. NULL, like the next five functions: tiles are never shared. */
    void (*set_source)(struct slc_residency *residency, uint32_t index, SluiceImageSource *source,
                       uint32_t layer);
    /** Maps a regular tile to the page of an equal tile. Call it before revive. SLC_SHARE_READY:
     * the tile is mapped, as by revive. SLC_SHARE_WAIT: the page will be ready later. */
    enum slc_share (*share)(struct slc_residency *residency, uint32_t index,
                            const SluiceTile *tile);
    /** Announces that a read of the tile begins: equal tiles wait for it. */
    void (*announce)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);
    /** Withdraws an announced read that failed, or whose tile is not mapped. */
    void (*withdraw)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);
    /** Ends the use of the image's source, which may be destroyed afterwards. */
    void (*leave_source)(struct slc_residency *residency, uint32_t index);

    /** Ends the sharing of tiles of the source, because its texels have changed. */
    void (*drop_source)(struct slc_residency *residency, uint32_t index);

    /** Keeps an unmapped tile from being revived, because its texels have changed. NULL: no tile
     *  can be revived. */
    void (*spoil)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);
    /** Moves a mapped tile to a page of its own if its page is shared. Call it before other texels
     *  are copied to the tile. False: no page is free now. NULL: pages are never shared. */
    bool (*renew)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);

    /** Counts a tile that is bound for the first time. False: the limit of different tiles is
     *  reached. NULL: no limit. */
    bool (*reserve)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);

    /** True if `reserve` would return true. NULL: always. */
    bool (*may_reserve)(const struct slc_residency *residency, uint32_t index, uint32_t tile);

    /** Returns the pages that tiles of this image can get now; UINT32_MAX: no known limit. NULL:
     *  tiles need only slots of heaps. */
    uint32_t (*page_room)(const struct slc_residency *residency, uint32_t index);

    /**
     * Moves tiles together, frame by frame, until memory has fallen by `size` bytes, or until the
     * next call. Returns how many pages must be given back first. Returns SLC_NONE if no image can
     * be emptied, or none has to be. NULL, like `compact`, if pages are slots of heaps.
     */
    uint32_t (*gather)(struct slc_residency *residency, uint64_t size);
    /** Lets the next frame move at most `most` tiles, if the moves can empty an image in the end.
     *  Equal tiles on one page count once. Returns how many tiles can move; frames under way may
     *  hold some of them back. */
    uint32_t (*compact)(struct slc_residency *residency, uint32_t most);

    /** Functions of SluiceHeapAllocator. */
    SluiceResult (*allocate_heap)(struct slc_residency *residency, uint64_t size,
                                  uint32_t *heap_id);
    void (*release_heap)(struct slc_residency *residency, uint32_t heap_id);
    /** Makes heaps of `size` bytes ahead, at most `max_count`; 0: any number. NULL, like the next
     *  two functions: heaps have no memory. */
    void (*prepare_heaps)(struct slc_residency *residency, uint64_t size, uint32_t max_count);
    /** Frees up to `wanted` bytes of heaps without tiles, in whole heaps. Returns the bytes. */
    uint64_t (*free_spare)(struct slc_residency *residency, uint64_t wanted);
    /** Returns the bytes of heaps that were released and are not freed yet. */
    uint64_t (*going_size)(const struct slc_residency *residency);

    /** Begins `frame`. `completed_frame`: last frame that the GPU has finished. Never waits. */
    SluiceResult (*update)(struct slc_residency *residency, uint64_t frame,
                           uint64_t completed_frame);
    /** Collects the map of a tile. NOT_READY, with nothing collected: there is no room now, or an
     *  older use of the tile's memory is not complete. Call it again in the next frame.
     *  OUT_OF_DEVICE_MEMORY, for regular tiles only: there will be no memory soon. */
    SluiceResult (*map)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);
    /** Collects the unmap of a tile. The MinMip maps of `frame` are the first that do not show the
     *  tile. `filled` false: its texels may be missing, so it cannot be revived. At most
     *  room_to_unmap calls per frame. */
    void (*unmap)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile,
                  uint64_t frame, bool filled);
    /** Undoes a complete map. The tile was never shown, and no frame reads or writes it. NULL:
     *  nothing to do. */
    void (*discard)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);
    /** Returns how many unmaps may be collected. */
    uint32_t (*room_to_unmap)(const struct slc_residency *residency);
    /** Submits the collected changes to the GPU. completed_value reaches `*value` when they end. */
    SluiceResult (*submit)(struct slc_residency *residency, uint64_t *value);
    /** Waits until all submitted changes are complete. For tests and shutdown. */
    SluiceResult (*wait)(struct slc_residency *residency);
    uint64_t (*completed_value)(const struct slc_residency *residency);
    /** Returns the last frame whose unmaps, and those of all earlier frames, are complete. */
    uint64_t (*retire_limit)(const struct slc_residency *residency, uint64_t completed_frame);

    /** Records copies of texels from `buffer` to one image. The streamer records the barriers. COPY
     *  without SHOW may be for another queue: a later call with SHOW shows the tiles. */
    void (*record_uploads)(struct slc_residency *residency, uint32_t index,
                           VkCommandBuffer commands, VkBuffer buffer, uint32_t count,
                           const VkBufferImageCopy *regions, uint32_t parts);

    /* The next functions may be NULL: there is nothing to do. */

    /** Finds the page to which commands write a regular tile. The map of the tile is complete.
     *  NULL: tiles have their places in the texture's image. */
    struct slc_tile_page (*find_page)(const struct slc_residency *residency, uint32_t index,
                                      const SluiceTile *tile);
    /** Shows a tile from the frame that begins on. A complete frame wrote its texels. */
    void (*show)(struct slc_residency *residency, uint32_t index, const SluiceTile *tile);

    /** Records commands of the frame that begins, after a barrier behind all earlier frames. */
    void (*record_begin)(struct slc_residency *residency, uint64_t frame, VkCommandBuffer commands);
    void (*record_publish)(struct slc_residency *residency, VkCommandBuffer commands);
    /** Records again, with the next frame, what frames from `frame` on recorded. The streamer
     *  repeats uploads. */
    void (*abandon)(struct slc_residency *residency, uint64_t frame);
    /** Returns the page table. Its handle and address never change. */
    const struct slc_buffer *(*page_table)(const struct slc_residency *residency);
    /** Returns the page table offset for SluiceTextureEntry. */
    uint32_t (*page_table_offset)(const struct slc_residency *residency, uint32_t index);
};

/** Counters for the public statistics. */
struct slc_residency_counters {
    uint64_t bind_calls, bind_runs;
    uint64_t unbinds, unbinds_saved; ///< tiles
    uint32_t page_chunks;
    uint64_t page_chunk_shortages;
};

/** First member of every implementation's struct. */
struct slc_residency {
    const struct slc_residency_interface *interface;
    struct slc_residency_counters counters;
};

struct slc_residency_create_info {
    const struct slc_vk *vk; ///< outlives the residency, like the next pointers
    const struct slc_caps *caps;
    const SluiceAllocationCallbacks *cb;
    VkQueue sparse_queue;
    uint32_t max_binds_per_call; ///< at least 1
    uint32_t max_image_count;
    uint32_t max_changes;       ///< maps and unmaps per frame
    uint32_t max_touched_tiles; ///< 0: no limit
    uint32_t max_region_count;
    uint64_t kept_heap_size;     ///< bytes of heaps that are kept while empty
    bool whole;                  ///< dense: all levels of textures are packed
    bool packed_outside;         ///< paged: packed tiles take no slots
    bool may_lack_memory;        ///< does not log images for which there is no memory
    struct slc_page_pool *pages; ///< borrowed
    uint32_t page_user;          ///< user of `pages`
};

SluiceResult slc_create_sparse_residency(const struct slc_residency_create_info *info,
                                         struct slc_residency **residency);
SluiceResult slc_create_paged_residency(const struct slc_residency_create_info *info,
                                        struct slc_residency **residency);
SluiceResult slc_create_dense_residency(const struct slc_residency_create_info *info,
                                        struct slc_residency **residency);

#endif /* SLC_VULKAN_RESIDENCY_H */
