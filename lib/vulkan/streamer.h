/** What the files of the streamer share: its parts and who calls whom. */
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
    SLC_TEXTURE_REMOVED, ///< waits for frames, reads and bindings that still name it
};

/** See texture_forgetting.h. */
enum slc_presence { SLC_PRESENT = 0, SLC_LEAVING, SLC_FORGOTTEN };

/** The packed levels are read, bound, copied and published as one. */
enum slc_packed_state {
    SLC_PACKED_COLLECTING = 0, ///< until every packed tile that is not mapped was handed out
    SLC_PACKED_READY,          ///< waits for staging slots
    SLC_PACKED_READING,
    SLC_PACKED_MAPPING,
    SLC_PACKED_UPLOADING,
};

/** Texels of a MinMip map that are not what they are to become, and some that are. */
struct slc_fade_rect {
    uint32_t x0, y0, x1, y1; ///< y1 is 0: none
};

struct slc_texture {
    enum slc_texture_state state;
    SluiceTextureId id;
    SluiceTextureId primary_id;
    SluiceImageSource *source; ///< borrowed; NULL: it has a producer
    struct slc_tile_producer producer;
    VkImageView *level_views; ///< owned by layer 0; levels of `image`, for stores; NULL: none
    SluiceImageInfo info;
    struct slc_residency *residency; ///< of the streamer: `residency`, `paged` or `plain`
    struct slc_residency_image image;
    uint32_t first, layer, layer_count; ///< of an array: the index of layer 0; else itself, 0, 1
    struct slc_texture_views views;
    SluiceStreamedTextureLayout layout;
    struct slc_sampler_kind sampler_kind;
    SluiceTextureFilter filter;
    uint32_t sampler; ///< index in samplers, if there is a texture array
    uint32_t region_first, region_count;
    struct slc_fade_rect fade;
    uint16_t whole_shown; ///< the largest texel of its MinMip map, as the texture table has it
    struct slc_feedback_map feedback; ///< of primaries; its levels are part of feedback_levels
    bool feedback_whole;              ///< the next resolve must bring the whole map
    uint32_t primary_place;           ///< in primaries; SLC_NONE: it has no turns
    uint32_t first_request;           ///< place + 1 of a request; 0: none
    bool map_due;                     ///< in due_maps
    bool drop_due;                    ///< what earlier maps requested does not count any longer
    uint8_t finest_level; ///< SluiceVulkanTextureControl of primaries, as the next three
    int8_t mip_bias;
    bool hidden;
    int8_t priority;
    uint64_t added_frame;    ///< the last one begun before; its feedback and table entry come later
    uint64_t recorded_frame; ///< that recorded its layout and table entry; 0: in new_textures
    uint64_t cleared_frame;  ///< that cleared its feedback; 0: none did
    uint64_t shown_frame;    ///< the last that recorded any of its MinMip map
    bool whole_stale;        ///< the device may have another whole_shown
    uint64_t removed_frame;  ///< also of one that is LEAVING: it is not shown from here on
    enum slc_presence presence;
    bool forgettable;
    bool in_order; ///< of use: PRESENT and forgettable
    uint64_t used_frame;
    uint32_t used_before, used_after; ///< in that order; SLC_NONE
    uint32_t unit_count;              ///< staging slots that name it
    uint32_t reload_next;             ///< first unit of its mip tail that is not read again yet

    struct slc_packed_units packed;
    SluiceTile *packed_tiles;  ///< owned; desc.packedTileCount, of which packed_collected
    uint32_t packed_collected; ///< handed out and not answered
    uint32_t packed_mapped;    ///< answered as mapped, and not unmapped
    enum slc_packed_state packed_state;
    uint32_t packed_done;            ///< units arrived, tiles bound, units uploaded
    SluiceResult packed_result;      ///< of the last unit that failed; SUCCESS: none did
    struct slc_read_trouble trouble; ///< of the first layer
    uint32_t packed_first_unit;      ///< chain over slc_unit.next of those that arrived
};

enum slc_unit_state {
    SLC_UNIT_FREE = 0,
    SLC_UNIT_READING,  ///< the loader has it
    SLC_UNIT_ARRIVED,  ///< texels are in its slot, not bound yet
    SLC_UNIT_BINDING,  ///< copied once its bind is over
    SLC_UNIT_UPLOADED, ///< its slot is read by a frame
};

/** One staging slot and what is on its way through it: a tile, or a share of packed levels. */
struct slc_unit {
    enum slc_unit_state state;
    uint32_t texture;
    SluiceTile tile;
    uint32_t packed_unit; ///< SLC_NONE for a tile
    bool canceled;
    bool published; ///< the manager counts it as mapped: copied by a frame that was abandoned
    bool dropped;   ///< its tile was unmapped, and is not in tile_units; what it copied is no use
    bool reload;    ///< its tile is resident already; see load_reloads.h
    bool stale;     ///< READING, ARRIVED: the texels have changed since; it is read again
    const SluiceImageSource *source; ///< READING: that the loader reads
    bool produced; ///< the application's commands fill it: it has no memory in its staging slot
    uint64_t asked_frame; ///< frame that first asked its producer; 0: none
    bool copied;          ///< its texels are in their place, or on their way on the upload queue
    uint64_t bound_frame; ///< in which its bind was submitted
    uint64_t ticket;
    uint64_t value;       ///< BINDING: of the bind, in `copying` of the upload; UPLOADED: the frame
    uint64_t stage_frame; ///< in which it entered its stage (load_stages.h)
    uint64_t requested_frame; ///< in which its tile was requested; UINT64_MAX: not
    uint32_t next;            ///< in its list
};

struct slc_unit_list {
    uint32_t first, last;
};

/** See shrink.h. */
struct slc_shrink {
    uint32_t own_target;    ///< targetHeapCount that the application has set; 0: none
    uint32_t target;        ///< targetHeapCount that the streamer chose
    uint64_t config_count;  ///< slc_manager_config_count behind the streamer's last sluiceSetConfig
    bool compacting;        ///< heaps that become empty are released without any pressure
    uint64_t size_before;   ///< tile memory when a heap had to go for pages; 0: none has to
    uint64_t pages_until;   ///< before this frame memory is for pages: no heap comes
    uint64_t lacking_until; ///< before this frame tiles count as waiting for pages
};

/** See unmet_budget.h. */
struct slc_unmet_budget {
    uint64_t size;   ///< bytes in use for tiles, as of the last frame
    uint32_t frames; ///< in which it was the same, beyond the budget
    bool told;       ///< logged since the budget was last kept
};

/** See texture_forgetting.h. */
struct slc_forgetting {
    uint32_t first, last, count; ///< textures in the order of use, the one used last at the end
    uint32_t *leaving;           ///< owned; maxTextureCount; textures that are LEAVING
    uint32_t leaving_count;
    uint32_t absent_count;  ///< textures that are not PRESENT
    uint64_t refused_frame; ///< the last one in which an image had no memory
    uint32_t hunger;        ///< frames in a row in which an image had no memory
    bool heap_refused;      ///< since the last step
    bool told;              ///< logged that none can be forgotten
};

/** See texture_requests.h. */
struct slc_texture_requests {
    struct slc_texture_request *list; ///< owned; `room`, of which `count` were used
    uint32_t count, room;
    uint32_t first_free; ///< place + 1; 0: none
    uint32_t live_count;
};

#define SLC_STAGE_FRAMES 1024u

/** See load_stages.h. */
struct slc_load_stages {
    uint64_t first_frame;                ///< the oldest one in `requests`
    uint64_t requests[SLC_STAGE_FRAMES]; ///< number of the next request when a frame began
    SluiceVulkanLoadStages counts;
};

/** See strict_mode.h. */
struct slc_strict {
    SluiceVulkanStrictMode mode; ///< pfnReport NULL: off
    uint64_t marked_frame;       ///< the last one in which some map had marks, as far as was looked
    uint64_t refused_frame;      ///< that begins waited for
    uint32_t refused_count;
    bool budget_reached;              ///< the frame's requests stopped for lack of slots
    uint64_t heaps_told, chunks_told; ///< frames; 0: never
    uint64_t shortages;               ///< of page images, as of the last frame
};

struct SluiceVulkanStreamer {
    SluiceAllocationCallbacks cb;
    SluiceVulkanStreamerCreateInfo info; ///< defaults filled in
    SluiceVulkanStreamerDebugInfo debug;
    SluiceVulkanContext *context;
    struct slc_vk vk;                           ///< the context's, but for memory_client
    struct slc_memory_client memory;            ///< of vk
    struct slc_memory_pressure memory_pressure; ///< as of the last begin
    struct slc_unmet_budget unmet_budget;
    struct slc_shrink shrink;
    struct slc_forgetting forgetting;
    struct slc_caps caps;        ///< the context's
    struct slc_page_pool *pages; ///< of the context; NULL: not yet
    uint32_t page_user;          ///< user of `pages`; SLC_MAX_PAGE_USERS: not yet
    struct slc_residency *residency;
    struct slc_residency *paged; ///< of textures that sparse mode refuses; NULL: there are none
    struct slc_residency *plain; ///< of textures that are images with all levels; packed tiles only
    bool chooses_modes;          ///< small textures are in `plain`
    SluiceStreamedTextureManager *manager;
    bool manager_locked; ///< for the application, but inside of the streamer's own calls
    SluiceTileLoader *loader;

    VkSemaphore semaphore; ///< of frames
    uint64_t frame;        ///< the last one begun; numbers of abandoned ones are not used again
    uint64_t ended_frame;  ///< the last one that was ended or abandoned
    uint64_t completed_frame;
    uint64_t retired;    ///< the last value that the manager was told
    uint64_t time_stamp; ///< of the last frame begun
    struct slc_time_check time_check;
    uint64_t manager_time;            ///< the last time stamp that the manager got
    uint32_t most_textures_per_frame; ///< that the buffers have room for
    uint32_t next_textures_per_frame; ///< from the next frame on
    uint32_t next_frames_per_round;   ///< as well
    bool hold_loads;
    uint32_t load_steps; ///< loads that start although they are held
    uint32_t share;      ///< maps of the frame that began; the buffers have room for them
    uint32_t all_left;   ///< turns until all textures that are asked for had one
    bool share_of_all;   ///< some of them because all textures are asked for
    uint64_t in_flight[SLC_MAX_FRAMES]; ///< by slot; framesInFlight of them; 0: none
    bool submittable[SLC_MAX_FRAMES];   ///< by slot; its frame was ended without an error
    uint64_t slot_turn;                 ///< frames begun and not abandoned
    uint32_t slot;                      ///< of the last frame begun
    bool buffers_cleared;
    uint64_t cleared_frame; ///< that did
    bool has_put_back;      ///< what abandoned frames recorded is to be recorded again

    struct slc_texture *textures; ///< owned; maxTextureCount
    uint32_t *by_manager_index;   ///< owned; low half of a texture id -> index in textures
    uint32_t texture_low;         ///< no texture before is free
    uint32_t texture_high;        ///< textures from here on were never used
    uint32_t *primaries;          ///< owned; textures whose feedback is read back
    uint32_t primary_count, primary_cursor;
    uint32_t *due_maps; ///< owned; textures of which the manager gets a map in the next frame
    uint32_t due_map_count;
    struct slc_texture_requests requests;
    uint8_t *control_map; ///< owned; scratch for maps that are not the feedback alone
    uint32_t control_room;
    uint64_t list_version;  ///< counts whatever makes lists of what to resolve out of date
    uint32_t *new_textures; ///< owned; added since the last frame
    uint32_t new_texture_count;
    uint32_t *packed_queue; ///< owned; textures whose packed levels are READY or MAPPING
    uint32_t packed_queue_count;
    uint32_t removed_count;
    bool told_of_heaps; ///< logged that no heap can be allocated
    bool told_of_modes; ///< that a texture's address modes are not its source's
    struct slc_region_arena regions;

    struct slc_unit *units;          ///< owned; maxLoadsInFlight
    struct slc_unit_list free_units; ///< used last, first
    struct slc_unit_list arrived, binding, uploaded;
    struct slc_unit_list copying;    ///< BINDING, on the upload queue; oldest first
    struct slc_unit_list unproduced; ///< bound, not recorded
    struct slc_unit_list produced;   ///< recorded, not complete
    uint32_t free_unit_count;
    struct slc_map tile_units;       ///< (texture, tile) -> unit, until the unit is free
    struct slc_reload_lists reloads; ///< see load_reloads.h
    uint32_t reload_unit_count;
    struct slc_deferred_tiles deferred;
    struct slc_deferred_tiles awaited; ///< that another front end is about to have
    uint32_t lacking_pages; ///< deferred tiles that could not have a page when the frame began
    uint32_t
        pages_left[SLC_PAGE_FORMATS]; ///< for loads that start in this frame; SLC_NONE: unknown
    struct slc_staging staging;       ///< a slot per unit
    struct slc_upload_queue uploads;  ///< zeroed: frames make all copies
    uint32_t *frame_units;            ///< owned; tilesPerFrame
    VkBufferImageCopy *copies;        ///< owned
    uint32_t copy_capacity;
    SluiceTile *tiles;      ///< owned; tilesPerFrame
    uint32_t *tile_indices; ///< owned; tilesPerFrame

    struct slc_samplers samplers;
    struct slc_texture_array texture_array;
    struct slc_descriptors descriptors; ///< a set per frame in flight
    struct slc_buffer texture_table, feedback, min_mip;
    struct slc_buffer *min_mip_staging; ///< owned; per frame in flight, as large as one needed it
    uint64_t min_mip_refused; ///< frame in which there was no memory for a larger one; 0: none
    uint16_t *min_mip_texels; ///< owned; what min_mip shows after the frames begun
    uint16_t *around_row;     ///< owned; scratch
    uint32_t *around_words;   ///< owned; scratch for a row
    uint8_t *min_mip_levels;  ///< owned; the manager's maps, which texels move to
    struct slc_fade_clock fade_clock;
    uint32_t *fades; ///< owned; textures whose texels move
    uint32_t fade_count;
    uint8_t *zero_map;                ///< owned; for mapEverything, maxRegionCount
    struct slc_buffer feedback_turns; ///< a bit per texture: takes part in this frame
    uint32_t *turns;                  ///< owned; the same on the host
    uint8_t *feedback_levels;         ///< owned; a byte per region, as resolved last
    struct slc_readback_ring readback;
    struct slc_resolve resolve;

    struct slc_strict strict;
    struct slc_load_stages stages;
    SluiceVulkanStreamerStatistics counts; ///< but what others count
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

/** The residency that has a page table; NULL: none. */
static inline struct slc_residency *slc_residency_of_pages(const SluiceVulkanStreamer *s)
{
    return s->residency->interface->page_table ? s->residency : s->paged;
}

/** Bytes of the bits that say which textures write feedback. */
static inline uint64_t slc_turns_size(const SluiceVulkanStreamer *s)
{
    return ((uint64_t)s->info.maxTextureCount + 31) / 32 * 4;
}

static inline SluiceFormat slc_texture_page_format(const struct slc_texture *texture)
{
    return slc_page_format(texture->info.format, texture->producer.pfn);
}

/** Logs what the manager refuses although it should not; returns `result`. */
SluiceResult slc_streamer_check(const SluiceVulkanStreamer *s, SluiceResult result,
                                const char *what);

/* streamer_settings.c */
/** A frame begins. */
void slc_settings_apply(SluiceVulkanStreamer *s);

/* frame.c */
/** The last frame that may be under way on the GPU: ended, and not abandoned. 0: none. */
uint64_t slc_streamer_last_submittable(const SluiceVulkanStreamer *s);

/* streamer_buffers.c */
/** Gives buffers that are created later an address, if the application asks for it. Errors:
 *  UNSUPPORTED, with a log message. */
SluiceResult slc_streamer_use_addresses(SluiceVulkanStreamer *s);
/** Fills in all fields. */
void slc_streamer_fill_buffers(const SluiceVulkanStreamer *s, SluiceVulkanBuffers *buffers);

/* residencies.c */
/** Chooses the streamer's mode, and creates what its textures need. Errors: UNSUPPORTED and
 *  NULL_POINTER, with a log message; OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN. */
SluiceResult slc_residencies_create(SluiceVulkanStreamer *s);
/** Nothing of them is in use on the GPU. */
void slc_residencies_destroy(SluiceVulkanStreamer *s);

/* load_units.c */
SluiceResult slc_loads_init(SluiceVulkanStreamer *s);
void slc_loads_finish(SluiceVulkanStreamer *s);

/* minmip_upload.c: publishes what the manager changed */
SluiceResult slc_min_mip_record(SluiceVulkanStreamer *s, VkCommandBuffer commands);
/** What frames from `frame` on published is published again. */
void slc_min_mip_abandon(SluiceVulkanStreamer *s, uint64_t frame);

/* feedback.c: which textures' feedback is resolved, and what the manager gets of it */
/** A frame begins: how many textures have their turn. */
void slc_feedback_choose_share(SluiceVulkanStreamer *s);
/** The texture has turns from now on, or none any longer. */
void slc_feedback_join(SluiceVulkanStreamer *s, uint32_t index);
void slc_feedback_leave(SluiceVulkanStreamer *s, uint32_t index);
void slc_feedback_add(SluiceVulkanStreamer *s, struct slc_texture *texture);
void slc_feedback_record_new(SluiceVulkanStreamer *s, const struct slc_texture *texture,
                             VkCommandBuffer commands);
void slc_feedback_record_turns(SluiceVulkanStreamer *s, VkCommandBuffer commands);
uint64_t slc_feedback_size(const SluiceVulkanStreamer *s, uint32_t region_count); ///< bytes
uint32_t slc_feedback_clear_value(const SluiceVulkanStreamer *s);                 ///< of each word
SluiceResult slc_feedback_read(SluiceVulkanStreamer *s);
void slc_feedback_record(SluiceVulkanStreamer *s, VkCommandBuffer commands);
/** Nothing comes back of frames from `frame` on; their share of the textures has the next turn. */
void slc_feedback_abandon(SluiceVulkanStreamer *s, uint64_t frame);

/* texture.c */
void slc_textures_record_new(SluiceVulkanStreamer *s, VkCommandBuffer commands);
/** Textures that were first recorded in frames from `frame` on are new again. */
void slc_textures_abandon(SluiceVulkanStreamer *s, uint64_t frame);
/** Destroys what is over; returns the largest retire value that no texture holds back. */
uint64_t slc_textures_retire(SluiceVulkanStreamer *s, uint64_t limit);
void slc_texture_destroy(SluiceVulkanStreamer *s, uint32_t index);
/** Regions at the edge are narrower, or levels do not halve evenly. */
bool slc_texture_is_ragged(const struct slc_texture *texture);

/* texture_control.c */
void slc_control_finish(SluiceVulkanStreamer *s);

/* texture_forgetting.c */
/** Checks forgetTextures and forgetAfterFrames, and sets what they imply. */
SluiceResult slc_forgetting_fill_in(SluiceVulkanStreamerCreateInfo *info,
                                    const SluiceLogCallback *log);
/** Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_forgetting_init(SluiceVulkanStreamer *s);
void slc_forgetting_finish(SluiceVulkanStreamer *s);

#endif /* SLC_VULKAN_STREAMER_H */
