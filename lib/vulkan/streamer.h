/** Internals of the streamer: its parts, and the functions that its files call of one another. */
#ifndef SLC_VULKAN_STREAMER_H
#define SLC_VULKAN_STREAMER_H

#include <sluice/loader.h>

#include "base/map.h"
#include "base/none.h"
#include "vulkan/buffer.h"
#include "vulkan/context.h"
#include "vulkan/descriptors.h"
#include "vulkan/fade.h"
#include "vulkan/feedback_map.h"
#include "vulkan/packed_units.h"
#include "vulkan/page_pool.h"
#include "vulkan/deferred_tiles.h"
#include "vulkan/read_health.h"
#include "vulkan/readback_ring.h"
#include "vulkan/region_arena.h"
#include "vulkan/reload_lists.h"
#include "vulkan/residency.h"
#include "vulkan/resolve.h"
#include "vulkan/sparse_layout.h"
#include "vulkan/staging.h"
#include "vulkan/texture_views.h"
#include "vulkan/tile_producer.h"
#include "vulkan/time_defaults.h"
#include "vulkan/upload_queue.h"

#include <sluice/shared/texture_table.h>
#include <sluice/vulkan_explain.h>
#include <sluice/vulkan_strict.h>

#define SLC_MAX_FRAMES 16u
#define SLC_MAX_TILES_PER_FRAME (1u << 14)

enum slc_texture_state {
    SLC_TEXTURE_FREE = 0,
    SLC_TEXTURE_LIVE,
    SLC_TEXTURE_REMOVED, ///< waits for frames, reads and bindings that still use the texture
};

/** Presence of a texture's image. See texture_forgetting.h. */
enum slc_presence { SLC_PRESENT = 0, SLC_LEAVING, SLC_FORGOTTEN };

/** State of the packed levels, which are read, bound, copied and published as a whole. */
enum slc_packed_state {
    SLC_PACKED_COLLECTING = 0, ///< waits until every packed tile that is not mapped is handed out
    SLC_PACKED_READY,          ///< waits for staging slots
    SLC_PACKED_READING,
    SLC_PACKED_MAPPING,
    SLC_PACKED_UPLOADING,
};

/** Bounding rectangle of the texels of a MinMip map that still fade. */
struct slc_fade_rect {
    uint32_t x0, y0, x1, y1; ///< y1 0: empty
};

struct slc_texture {
    enum slc_texture_state state;
    SluiceTextureId id;
    SluiceTextureId primary_id;
    SluiceImageSource *source; ///< borrowed; NULL: the texture has a producer
    struct slc_tile_producer producer;
    VkImageView *level_views; ///< owned by layer 0; views of levels, for stores; NULL: none
    SluiceImageInfo info;
    struct slc_residency *residency; ///< the streamer's `residency`, `paged` or `plain`
    struct slc_residency_image image;
    uint32_t first, layer, layer_count; ///< first: texture of layer 0. No array: itself, 0, 1
    struct slc_texture_views views;
    SluiceStreamedTextureLayout layout;
    struct slc_sampler_kind sampler_kind;
    SluiceTextureFilter filter;
    uint32_t sampler; ///< index in samplers, if there is a texture array
    uint32_t region_first, region_count;
    struct slc_fade_rect fade;
    uint16_t whole_shown;             ///< largest texel of the MinMip map, as in the texture table
    struct slc_feedback_map feedback; ///< primaries; the levels are part of feedback_levels
    bool feedback_whole;              ///< the next resolve must bring the whole map
    uint32_t primary_place;           ///< index in primaries; SLC_NONE: the texture has no turns
    uint32_t first_request;           ///< 1 + index of a request; 0: none
    bool map_due;                     ///< in due_maps
    bool drop_due;                    ///< the requests of earlier maps are to be dropped
    uint8_t finest_level; ///< SluiceVulkanTextureControl of primaries, like the next three fields
    int8_t mip_bias;
    bool hidden;
    int8_t priority;
    uint64_t added_frame;    ///< last frame begun before the texture was added
    uint64_t recorded_frame; ///< frame that recorded layout and table entry; 0: in new_textures
    uint64_t cleared_frame;  ///< frame that cleared the feedback; 0: none
    uint64_t shown_frame;    ///< last frame that recorded texels of the MinMip map
    bool whole_stale;        ///< the device may have another whole_shown
    uint64_t removed_frame;  ///< REMOVED, LEAVING: first frame that does not show the texture
    enum slc_presence presence;
    bool forgettable;
    bool in_order; ///< in the order of use: PRESENT and forgettable
    uint64_t used_frame;
    uint32_t used_before, used_after; ///< neighbors in the order of use, or SLC_NONE
    uint32_t unit_count;              ///< staging slots of the texture
    uint32_t reload_next;             ///< first unit of the mip tail that is not read again yet

    struct slc_packed_units packed;
    SluiceTile *packed_tiles;  ///< owned, [desc.packedTileCount]; packed_collected are in use
    uint32_t packed_collected; ///< packed tiles handed out and not answered
    uint32_t packed_mapped;    ///< packed tiles answered as mapped, and not unmapped
    enum slc_packed_state packed_state;
    uint32_t packed_done;            ///< units arrived, tiles bound, or units uploaded, by state
    SluiceResult packed_result;      ///< error of the last unit that failed; SUCCESS: none failed
    struct slc_read_trouble trouble; ///< used in layer 0, for all layers
    uint32_t packed_first_unit;      ///< first of the units that arrived; linked by slc_unit.next
};

enum slc_unit_state {
    SLC_UNIT_FREE = 0,
    SLC_UNIT_READING,  ///< the loader reads
    SLC_UNIT_ARRIVED,  ///< the texels are in the staging slot; not bound yet
    SLC_UNIT_BINDING,  ///< waits for the bind, then is copied
    SLC_UNIT_UPLOADED, ///< a frame reads the staging slot
};

/** One staging slot, and the tile or part of the packed levels that is loaded through it. */
struct slc_unit {
    enum slc_unit_state state;
    uint32_t texture;
    SluiceTile tile;
    uint32_t packed_unit; ///< SLC_NONE for a tile
    bool canceled;
    bool published; ///< copied by a frame that was abandoned; MAPPED for the manager already
    bool dropped;   ///< the tile was unmapped and is not in tile_units; its texels are discarded
    bool reload;    ///< the tile is resident already; see load_reloads.h
    bool stale;     ///< READING, ARRIVED: the texels have changed since and are read again
    const SluiceImageSource *source; ///< READING: source that the loader reads
    bool produced;        ///< written by the application's commands; the staging slot has no memory
    uint64_t asked_frame; ///< frame that first asked the producer; 0: none
    bool copied;          ///< the texels are copied, or being copied on the upload queue
    uint64_t bound_frame; ///< frame in which the bind was submitted
    uint64_t ticket;
    uint64_t value;           ///< BINDING: value of the bind or the upload; UPLOADED: the frame
    uint64_t stage_frame;     ///< frame in which the unit entered its stage (load_stages.h)
    uint64_t requested_frame; ///< frame in which the tile was requested; UINT64_MAX: not requested
    uint32_t next;            ///< next unit of the list
};

struct slc_unit_list {
    uint32_t first, last;
};

/** State of shrinking tile memory. See shrink.h. */
struct slc_shrink {
    uint32_t own_target;    ///< targetHeapCount that the application has set; 0: none
    uint32_t target;        ///< targetHeapCount that the streamer chose
    uint64_t config_count;  ///< slc_manager_config_count behind the streamer's last sluiceSetConfig
    bool compacting;        ///< heaps that become empty are released without any pressure
    uint64_t size_before;   ///< tile memory when a heap had to be released for pages; 0: none
    uint64_t pages_until;   ///< before this frame no heap is allocated: memory is for pages
    uint64_t lacking_until; ///< before this frame tiles count as waiting for pages
};

/** Detection of a budget that cannot be met. See unmet_budget.h. */
struct slc_unmet_budget {
    uint64_t size;   ///< bytes in use for tiles in the last frame
    uint32_t frames; ///< frames since `size` last changed, while beyond the budget
    bool told;       ///< logged since the budget was last kept
};

/** State of forgetting textures. See texture_forgetting.h. */
struct slc_forgetting {
    uint32_t first, last, count; ///< list of textures by last use, the most recent at the end
    uint32_t *leaving;           ///< owned, [maxTextureCount]; textures that are LEAVING
    uint32_t leaving_count;
    uint32_t absent_count;  ///< textures that are not PRESENT
    uint64_t refused_frame; ///< last frame in which there was no memory for an image
    uint32_t hunger;        ///< consecutive frames without memory for an image
    bool heap_refused;      ///< a heap was refused since the last step
    bool told;              ///< logged that no texture can be forgotten
};

/** Requests of the application. See texture_requests.h. */
struct slc_texture_requests {
    struct slc_texture_request *list; ///< owned, [room]; [0, count) were used so far
    uint32_t count, room;
    uint32_t first_free; ///< 1 + index; 0: none
    uint32_t live_count;
};

#define SLC_STAGE_FRAMES 1024u

/** Times of loads by stage. See load_stages.h. */
struct slc_load_stages {
    uint64_t first_frame;                ///< oldest frame in `requests`
    uint64_t requests[SLC_STAGE_FRAMES]; ///< by frame: next sequence number when the frame began
    SluiceVulkanLoadStages counts;
};

/** State of strict mode. See strict_mode.h. */
struct slc_strict {
    SluiceVulkanStrictMode mode; ///< pfnReport NULL: off
    uint64_t marked_frame;       ///< last frame in which an examined map had marks
    uint64_t refused_frame;      ///< unfinished frame that begins of new frames waited for
    uint32_t refused_count;
    bool budget_reached;              ///< the frame's requests stopped for lack of slots
    uint64_t heaps_told, chunks_told; ///< frames of the last reports; 0: never
    uint64_t shortages;               ///< shortages of page images up to the last frame
};

struct SluiceVulkanStreamer {
    SluiceAllocationCallbacks cb;
    SluiceVulkanStreamerCreateInfo info; ///< defaults filled in
    SluiceVulkanStreamerDebugInfo debug;
    SluiceVulkanContext *context;
    struct slc_vk vk;                           ///< copy of the context's, with `memory` as client
    struct slc_memory_client memory;            ///< memory client of `vk`
    struct slc_memory_pressure memory_pressure; ///< pressure when the last frame began
    struct slc_unmet_budget unmet_budget;
    struct slc_shrink shrink;
    struct slc_forgetting forgetting;
    struct slc_caps caps;        ///< copy of the context's
    struct slc_page_pool *pages; ///< page pool of the context; NULL: not used yet
    uint32_t page_user;          ///< user of `pages`; SLC_MAX_PAGE_USERS: none yet
    struct slc_residency *residency;
    struct slc_residency *paged; ///< textures that sparse mode refuses; NULL: there are none
    struct slc_residency *plain; ///< textures that are images with all levels; packed tiles only
    bool chooses_modes;          ///< small textures are in `plain`
    SluiceStreamedTextureManager *manager;
    bool manager_locked; ///< locked for the application; unlocked in the streamer's own calls
    SluiceTileLoader *loader;

    VkSemaphore semaphore; ///< timeline of frames
    uint64_t frame;        ///< last frame begun; numbers of abandoned frames are not reused
    uint64_t ended_frame;  ///< last frame that was ended or abandoned
    uint64_t completed_frame;
    uint64_t retired;    ///< last retire value that the manager got
    uint64_t time_stamp; ///< time stamp of the last frame begun
    struct slc_time_check time_check;
    uint64_t manager_time;            ///< last time stamp that the manager got
    uint32_t most_textures_per_frame; ///< most textures per frame that the buffers have room for
    uint32_t next_textures_per_frame; ///< texturesPerFrame from the next frame on
    uint32_t next_frames_per_round;   ///< framesPerRound from the next frame on
    bool hold_loads;
    uint32_t load_steps; ///< loads that may start although loads are held
    uint32_t share;      ///< maps to read back in the frame that began; at most what buffers hold
    uint32_t all_left;   ///< turns left of sluiceResolveAllVulkanTextures
    bool share_of_all;   ///< `share` includes turns of all_left
    uint64_t in_flight[SLC_MAX_FRAMES]; ///< by slot, [framesInFlight]: frame; 0: none
    bool submittable[SLC_MAX_FRAMES];   ///< by slot: the frame was ended without an error
    uint64_t slot_turn;                 ///< frames begun and not abandoned
    uint32_t slot;                      ///< slot of the last frame begun
    bool buffers_cleared;
    uint64_t cleared_frame; ///< frame that cleared the buffers
    bool has_put_back;      ///< some recordings of abandoned frames must be recorded again

    struct slc_texture *textures; ///< owned, [maxTextureCount]
    uint32_t *by_manager_index;   ///< owned; low half of a texture id -> index in textures
    uint32_t texture_low;         ///< all textures before this index are in use
    uint32_t texture_high;        ///< textures from this index on were never used
    uint32_t *primaries;          ///< owned; textures whose feedback is read back
    uint32_t primary_count, primary_cursor;
    uint32_t *due_maps; ///< owned; textures whose maps the manager gets in the next frame
    uint32_t due_map_count;
    struct slc_texture_requests requests;
    uint8_t *control_map; ///< owned; scratch for maps that combine feedback and control
    uint32_t control_room;
    uint64_t list_version;  ///< grows with each change that makes lists of resolves out of date
    uint32_t *new_textures; ///< owned; textures added since the last frame
    uint32_t new_texture_count;
    uint32_t *packed_queue; ///< owned; textures whose packed levels are READY or MAPPING
    uint32_t packed_queue_count;
    uint32_t removed_count;
    bool told_of_heaps; ///< logged that no heap can be allocated
    bool told_of_modes; ///< logged that a texture's address modes differ from its source's
    struct slc_region_arena regions;

    struct slc_unit *units;          ///< owned, [maxLoadsInFlight]
    struct slc_unit_list free_units; ///< most recently used first
    struct slc_unit_list arrived, binding, uploaded;
    struct slc_unit_list copying;    ///< BINDING, on the upload queue; oldest first
    struct slc_unit_list unproduced; ///< bound, not recorded
    struct slc_unit_list produced;   ///< recorded, not complete
    uint32_t free_unit_count;
    struct slc_map tile_units;       ///< (texture, tile) -> unit, until the unit is free
    struct slc_reload_lists reloads; ///< see load_reloads.h
    uint32_t reload_unit_count;
    struct slc_deferred_tiles deferred;
    struct slc_deferred_tiles awaited; ///< tiles that another front end is loading
    uint32_t lacking_pages; ///< deferred tiles for which no page was free when the frame began
    uint32_t pages_left[SLC_PAGE_FORMATS]; ///< pages for loads of this frame; SLC_NONE: unknown
    struct slc_staging staging;            ///< one slot per unit
    struct slc_upload_queue uploads;       ///< zeroed: frames make all copies
    uint32_t *frame_units;                 ///< owned, [tilesPerFrame]
    VkBufferImageCopy *copies;             ///< owned
    uint32_t copy_capacity;
    SluiceTile *tiles;      ///< owned, [tilesPerFrame]
    uint32_t *tile_indices; ///< owned, [tilesPerFrame]

    struct slc_samplers samplers;
    struct slc_texture_array texture_array;
    struct slc_descriptors descriptors; ///< one set per frame in flight
    struct slc_buffer texture_table, feedback, min_mip;
    struct slc_buffer *min_mip_staging; ///< owned; per frame in flight, grows as required
    uint64_t min_mip_refused; ///< frame without memory for a larger staging buffer; 0: none
    uint16_t *min_mip_texels; ///< owned; contents of min_mip after the frames begun
    uint16_t *around_row;     ///< owned; scratch
    uint32_t *around_words;   ///< owned; scratch for a row
    uint8_t *min_mip_levels;  ///< owned; the manager's maps, toward which texels fade
    struct slc_fade_clock fade_clock;
    uint32_t *fades; ///< owned; textures whose texels fade
    uint32_t fade_count;
    uint8_t *zero_map;                ///< owned, [maxRegionCount]; for mapEverything
    struct slc_buffer feedback_turns; ///< one bit per texture: writes feedback in this frame
    uint32_t *turns;                  ///< owned; copy of feedback_turns on the host
    uint8_t *feedback_levels;         ///< owned; one byte per region: level resolved last
    struct slc_readback_ring readback;
    struct slc_resolve resolve;

    struct slc_strict strict;
    struct slc_load_stages stages;
    SluiceVulkanStreamerStatistics counts; ///< without counts that other parts keep
};

static inline struct slc_texture *slc_streamer_texture(SluiceVulkanStreamer *s, SluiceTextureId id)
{
    return &s->textures[s->by_manager_index[(uint32_t)id]];
}

static inline struct slc_residency *slc_residency_of(const SluiceVulkanStreamer *s,
                                                     uint32_t texture)
{
    return s->textures[texture].residency;
}

/** Returns the residency that has a page table; NULL: none. */
static inline struct slc_residency *slc_residency_of_pages(const SluiceVulkanStreamer *s)
{
    return s->residency->interface->page_table ? s->residency : s->paged;
}

/** Returns the bytes of feedback_turns: one bit per texture. */
static inline uint64_t slc_turns_size(const SluiceVulkanStreamer *s)
{
    return ((uint64_t)s->info.maxTextureCount + 31) / 32 * 4;
}

static inline SluiceFormat slc_texture_page_format(const struct slc_texture *texture)
{
    return slc_page_format(texture->info.format, texture->producer.pfn);
}

/** Logs an unexpected error of the manager; returns `result`. */
SluiceResult slc_streamer_check(const SluiceVulkanStreamer *s, SluiceResult result,
                                const char *what);

/* streamer_settings.c */
/** Applies changed settings when a frame begins. */
void slc_settings_apply(SluiceVulkanStreamer *s);

/* frame.c */
/** Returns the last frame that may be running on the GPU: ended, and not abandoned. 0: none. */
uint64_t slc_streamer_last_submittable(const SluiceVulkanStreamer *s);

/* streamer_buffers.c */
/** Gives buffers that are created later an address, if the application asks for it. Errors:
 *  UNSUPPORTED, with a log message. */
SluiceResult slc_streamer_use_addresses(SluiceVulkanStreamer *s);
/** Fills in all fields of `buffers`. */
void slc_streamer_fill_buffers(const SluiceVulkanStreamer *s, SluiceVulkanBuffers *buffers);

/* residencies.c */
/** Chooses the streamer's mode, and creates its residencies. Errors: UNSUPPORTED and NULL_POINTER,
 *  with a log message; OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN. */
SluiceResult slc_residencies_create(SluiceVulkanStreamer *s);
/** Destroys the residencies. The GPU must not use them any more. */
void slc_residencies_destroy(SluiceVulkanStreamer *s);

/* load_units.c */
SluiceResult slc_loads_init(SluiceVulkanStreamer *s);
void slc_loads_finish(SluiceVulkanStreamer *s);

/* minmip_upload.c: uploads changed MinMip texels */
SluiceResult slc_min_mip_record(SluiceVulkanStreamer *s, VkCommandBuffer commands);
/** Publishes again in the next frame what frames from `frame` on had published. */
void slc_min_mip_abandon(SluiceVulkanStreamer *s, uint64_t frame);

/* feedback.c: chooses textures to resolve, reads their feedback, and passes it to the manager */
/** Chooses how many textures have their turn in the frame that begins. */
void slc_feedback_choose_share(SluiceVulkanStreamer *s);
/** Gives a texture turns from now on, or ends its turns. */
void slc_feedback_join(SluiceVulkanStreamer *s, uint32_t index);
void slc_feedback_leave(SluiceVulkanStreamer *s, uint32_t index);
void slc_feedback_add(SluiceVulkanStreamer *s, struct slc_texture *texture);
void slc_feedback_record_new(SluiceVulkanStreamer *s, const struct slc_texture *texture,
                             VkCommandBuffer commands);
void slc_feedback_record_turns(SluiceVulkanStreamer *s, VkCommandBuffer commands);
uint64_t slc_feedback_size(const SluiceVulkanStreamer *s, uint32_t region_count); ///< bytes
uint32_t slc_feedback_clear_value(const SluiceVulkanStreamer *s); ///< value of each word
SluiceResult slc_feedback_read(SluiceVulkanStreamer *s);
void slc_feedback_record(SluiceVulkanStreamer *s, VkCommandBuffer commands);
/** Abandons the readback of frames from `frame` on. Their textures have the next turn. */
void slc_feedback_abandon(SluiceVulkanStreamer *s, uint64_t frame);

/* texture.c */
void slc_textures_record_new(SluiceVulkanStreamer *s, VkCommandBuffer commands);
/** Makes textures that were first recorded in frames from `frame` on new again. */
void slc_textures_abandon(SluiceVulkanStreamer *s, uint64_t frame);
/** Destroys textures no longer in use; returns the largest retire value that no texture holds back.
 */
uint64_t slc_textures_retire(SluiceVulkanStreamer *s, uint64_t limit);
void slc_texture_destroy(SluiceVulkanStreamer *s, uint32_t index);
/** True if regions at the edge are narrower, or levels do not halve evenly. */
bool slc_texture_is_ragged(const struct slc_texture *texture);

/* texture_control.c */
void slc_control_finish(SluiceVulkanStreamer *s);

/* texture_forgetting.c */
/** Checks forgetTextures and forgetAfterFrames, and sets the fields that they imply. */
SluiceResult slc_forgetting_fill_in(SluiceVulkanStreamerCreateInfo *info,
                                    const SluiceLogCallback *log);
/** Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_forgetting_init(SluiceVulkanStreamer *s);
void slc_forgetting_finish(SluiceVulkanStreamer *s);

#endif /* SLC_VULKAN_STREAMER_H */
