/**
 * Everything that the files of this folder share: the loader and its parts. Each part has a file of
 * its own with the name that its functions begin with; all run on the thread that uses the loader,
 * unless they say otherwise.
 */
#ifndef SLC_DEMAND_VULKAN_LOADER_H
#define SLC_DEMAND_VULKAN_LOADER_H

#include <sluice/demand_strict.h>

#include "demand/page_space.h"
#include "base/none.h"
#include "demand/page_residency.h"
#include "demand_vulkan/byte_memory.h"
#include "demand_vulkan/missed_pages.h"
#include "demand_vulkan/page_directory.h"
#include "demand_vulkan/scan.h"
#include "demand_vulkan/table_mirror.h"
#include "demand_vulkan/tickets.h"
#include "demand_vulkan/tile_memory.h"
#include "vulkan/context.h"
#include "vulkan/descriptors.h"
#include "vulkan/remakes.h"
#include "vulkan/staging.h"
#include "vulkan/tile_producer.h"

#define SLC_MAX_LAUNCHES 16u
#define SLC_MAX_REGULAR_LEVELS 16u /* words of an element of the buffer of levels */
#define SLC_DEMAND_CLASSES 256u    /* tiles, resources without a limit, each resource with one */
#define SLC_LARGE_SLOTS 16u        /* of staging memory: for a byte page above 64 KiB */
#define SLC_CLASS_TILES 0u
#define SLC_CLASS_UNBOUND 1u
#define SLC_CLASS_BYTES 2u /* byte pages of resources without a limit */

enum slc_texture_kind {
    SLC_TEXTURE_FREE = 0,
    SLC_TEXTURE_IMAGE,
    SLC_TEXTURE_VARIANT,
    SLC_TEXTURE_GRID,
    SLC_TEXTURE_RETIRED ///< destroyed; launches may still name the index
};

/** Image whose tiles the application's commands write. */
struct slc_made_image {
    struct slc_tile_producer producer;
    SluiceImageInfo info;
    float last_color[4]; ///< of the last level
};

/* By index; 0 is not used. What shaders see of it is the element of the same index of `table`. */
struct slc_demand_texture {
    enum slc_texture_kind kind;
    uint32_t generation; ///< of the index, from 1 on
    uint32_t image;      ///< IMAGE: slot of the image while it is opened or open; else SLC_NONE
    bool failed;         ///< IMAGE: it cannot be opened
    bool retry_queued;   ///< the index is in the list of openings to be tried again
    bool told;           ///< that it failed; until it is well again
    bool told_tail;      ///< ... at its tail: opening it does not show that it is well
    uint32_t grid_uses;  ///< cells of grids that name it
    uint32_t first_element, cell_count; ///< GRID: where its cells are, 16 in an element of `grids`
    uint32_t base;                      ///< VARIANT
    uint32_t next;                 ///< IMAGE, VARIANT: next variant; FREE, RETIRED: in the list
    uint64_t launch;               ///< RETIRED: the last that may name it
    SluiceDemandImage source;      ///< IMAGE
    struct slc_made_image *made;   ///< IMAGE, owned: in place of `source`; else NULL
    VkSamplerAddressMode modes[2]; ///< IMAGE, VARIANT: the sampler's
    bool explicit_modes;
    float failure_color[4];
};

enum slc_image_state {
    SLC_IMAGE_FREE = 0,
    SLC_IMAGE_OPENING,
    SLC_IMAGE_OPEN,
    SLC_IMAGE_DETACHED, ///< no texture's any more; reads are under way
    SLC_IMAGE_RETIRED   ///< closed; launches may still name its pages
};

/* An image that is open. Workers see it through the job that opens it; it is never moved. */
struct slc_demand_image {
    enum slc_image_state state;
    uint32_t slot, texture;
    uint32_t next; ///< FREE, RETIRED, or waiting for a job that reads the base color again
    bool refresh;  ///< it is in that list
    uint32_t job_count;
    uint64_t launch;                   ///< RETIRED: the last that may name its pages
    uint64_t last_use;                 ///< launch that used it, missed a page of it or copied one
    uint32_t older, newer;             ///< OPEN: in the order of use
    bool has_tail;                     ///< OPEN: which of the orders; may be out of date if true
    SluiceDemandImage origin;          ///< as the texture had it when it was opened
    const struct slc_made_image *made; ///< the texture's, or NULL; not read once it is detached
    SluiceDemandTicket ticket;

    /* Of the worker that opens it, until that job is collected. */
    struct SluiceDemandLoader *loader;
    SluiceImageSource *source;
    SluiceImageInfo info;
    const char *trouble; ///< why it cannot be used; NULL: it can, or result says why
    bool is_refused;     ///< opening it said UNSUPPORTED
    uint8_t *last_level; ///< owned; texels that the source was asked to start; or NULL
    uint64_t started_as; ///< with last_level: ticket of its read
    struct slc_demand_image *next_started; ///< guarded by the mutex of `tickets`
    float read_color[4];

    uint32_t tile_width, tile_height; ///< texels
    bool blocks;                      ///< compressed
    uint32_t regular_count, tail_page;
    uint32_t first_pages[SLC_MAX_REGULAR_LEVELS];
    float base_color[4];
    uint32_t generation;  ///< of the texels that its tiles are named for
    uint32_t retry_group; ///< tiles that could not be read; 0: none
    bool told;            ///< that tiles cannot be read; until one comes that could not
    bool told_remake;     ///< that a tile could not be made again; until one is
};

/** Images by last use. */
struct slc_image_order {
    uint32_t oldest, newest;
};

enum slc_resource_state { SLC_RESOURCE_FREE = 0, SLC_RESOURCE_LIVE, SLC_RESOURCE_DESTROYED };

enum slc_job_kind {
    SLC_JOB_FREE = 0,
    SLC_JOB_OPEN,
    SLC_JOB_TILE,
    SLC_JOB_RESOURCE,     ///< a value
    SLC_JOB_BYTES,        ///< a byte page of at most 64 KiB
    SLC_JOB_LARGE,        ///< a larger one
    SLC_JOB_PRODUCE,      ///< a tile or mip tail that commands write
    SLC_JOB_PRODUCE_BYTES ///< a byte page that commands write
};

/* Image source of one row, whose texels are the pages: the tile loader reads it. */
struct slc_demand_resource {
    SluiceImageSource base; ///< must be first
    enum slc_resource_state state;
    uint32_t index, generation, next_free;
    SluiceDemandResourceCreateInfo info;
    uint32_t first_page, job_count;
    enum slc_job_kind job_kind;
    uint32_t stride;    ///< bytes from one byte page to the next; 0: pages are values
    uint32_t byte_kind; ///< kind of byte pages; see byte_memory.h
    bool addresses;     ///< values of byte pages are addresses
    bool produced;      ///< commands write its byte pages
    uint32_t
        eviction_count; ///< values that pfnEvict is still to be told of, when launches are over
    uint8_t class_index;
    struct slc_missed_pages missed; ///< loading pages that the application answers
    uint32_t retry_group;           ///< pages that have no value; 0: none
    bool told;                      ///< logged the first of them
    bool told_remake;               ///< as of images
};

/* A value that no new launch sees. */
struct slc_eviction {
    uint32_t resource, page; ///< page of the resource
    uint64_t value, launch;
};

/* A read, or a page that commands write. A job below maxTilesInFlight has the slot of `staging` at
 * its index. A job from first_large on has SLC_LARGE_SLOTS slots of `large`. Those from
 * first_produce on have no memory, and are for commands. */
struct slc_demand_job {
    enum slc_job_kind kind;
    uint32_t page, owner;           ///< image slot, or index of the resource
    uint32_t place;                 ///< of a tile: chunk << 16 | layer; of a byte page
    uint32_t next;                  ///< free, arrived or copied: in the list
    bool stale;                     ///< what is read is not wanted any more
    bool counted;                   ///< in bytesUploaded
    bool remakes;                   ///< its page is resident: commands write it again
    uint64_t launch;                ///< copied or produced: the one that does
    uint64_t asked;                 ///< launch that first asked its producer; 0: none
    SluiceResult answer;            ///< of its producer
    uint64_t start;                 ///< ns
    uint64_t value;                 ///< of a resource
    uint64_t id;                    ///< of the texture or resource
    struct slc_demand_image *image; ///< NULL: of a resource

    /* With the lock of the tickets. */
    bool running;
    SluiceDemandTicket ticket;
    uint64_t read; ///< the tile loader's ticket; 0: not yet known
};

struct slc_job_list {
    uint32_t first, last;
};

/** A job that waits for its producer. Jobs with equal keys make a batch. */
struct slc_production {
    uint64_t key;
    uint32_t page, job;
};

#define SLC_BATCH_JOBS 512u

/** Reads of one region each that are submitted together. */
struct slc_job_batch {
    bool open;
    uint32_t count;
    struct slc_demand_job *jobs[SLC_BATCH_JOBS];
    SluiceDemandTicket tickets[SLC_BATCH_JOBS];
    SluiceTileRead reads[SLC_BATCH_JOBS]; ///< that point to the next two
    SluiceImageRegion regions[SLC_BATCH_JOBS];
    void *texels[SLC_BATCH_JOBS];
};

/* Levels of a texture that are still to be loaded without a shader asking. */
struct slc_preload {
    SluiceDemandTextureId texture;
    SluiceDemandTicket ticket;
    SluiceImageRegion region;    ///< of the finest level; width 0: all of it
    struct slc_remake_area area; ///< once it is planned
    uint32_t level, next_page;   ///< tiles of the area in the level, from 0
    bool opening, planned;
    bool detached;          ///< the image that it was planned for is no texture's any more
    uint32_t planned_count; ///< tasks of the ticket that have not begun
};

/* A page that is refused because it could not be read, or a texture that could not be opened. */
struct slc_failed_page {
    uint32_t page, next; ///< next in the list; 0: none
    uint64_t since;      ///< ns
};

struct slc_failed_list {
    uint32_t first, last; ///< 0: empty
};

#define SLC_PAGES_PER_PROBE 4u

/* Of an image, or of a resource. */
struct slc_retry_group {
    uint32_t *owner;         ///< where the image or resource keeps the group's index
    uint32_t previous, next; ///< of those that rest, the longest first; free ones by next
    uint64_t since;          ///< ns; when it began to rest
    struct slc_failed_list pages;
    uint32_t probes[SLC_PAGES_PER_PROBE], probe_count; ///< pages that were tried last
};

/* Index 0 of both arrays is none. */
struct slc_retries {
    struct slc_failed_page *pages; ///< owned
    uint32_t page_capacity, free_page;
    struct slc_retry_group *groups; ///< owned
    uint32_t group_capacity, free_group, first_group, last_group;
    struct slc_failed_list openings; ///< texture indices
    bool has_opened;                 ///< a texture whose opening had failed
    uint64_t opened, now;            ///< ns; when it did; as it was looked at last
};

struct slc_page_run {
    uint32_t first;
    uint64_t count;
    uint64_t launch; ///< that clears its requests; 0: none yet
};

/** Sections whose ranks a launch wrote. */
struct slc_rank_run {
    uint32_t first, count;
};

/** Strict mode. Launches are those processed. */
struct slc_demand_strict {
    SluiceDemandStrictMode mode; ///< pfnReport NULL: off
    uint64_t awaited;            ///< launch that calls wait for; 0: none yet
    uint64_t awaited_since;      ///< ns
    bool awaited_told;
    uint64_t marked; ///< last launch whose shaders requested or used something
    uint64_t tiles_told, pages_told, chunks_told, ids_told; ///< launch of the last report; 0: none
    uint64_t shortages;
};

struct SluiceDemandLoader {
    SluiceAllocationCallbacks cb;
    SluiceDemandLoaderCreateInfo info; ///< with the defaults filled in
    SluiceVulkanContext *context;
    struct slc_vk vk;                           ///< the context's, but for memory_client
    struct slc_memory_client memory;            ///< of vk
    struct slc_memory_pressure memory_pressure; ///< as of the last launch
    uint64_t memory_limit;                      ///< bytes of all front ends, as of the last launch
    struct slc_caps caps;                       ///< the context's
    bool usable[SLUICE_FORMAT_COUNT];           ///< formats that the device samples and filters
    VkSemaphore semaphore;

    struct slc_page_pool *pages; ///< of the context; NULL: not yet
    uint32_t page_user;          ///< of these; SLC_MAX_PAGE_USERS: not yet
    struct slc_tile_memory tiles;
    struct slc_byte_memory bytes;
    struct slc_page_memory byte_interface;
    struct slc_buffer_array byte_buffers; ///< chunks as new launches see them
    uint64_t byte_reserve;                ///< bytes of memoryBudget that tiles do not get
    uint32_t byte_resource_count;         ///< live
    struct slc_descriptors descriptors;   ///< a set per launch in flight
    struct slc_buffer table_buffer, levels_buffer;
    bool told_of_modes;             ///< that a texture's address modes are not its image's
    struct slc_staging staging;     ///< a slot per tile job
    struct slc_staging large;       ///< SLC_LARGE_SLOTS per large job; zeroed until one is needed
    struct slc_table_mirror table;  ///< struct SluiceDemandTexture by index
    struct slc_table_mirror levels; ///< parameters; then 16 words for each image slot
    struct slc_table_mirror grids;  ///< the words of grids, behind them
    struct slc_region_arena grid_arena;
    uint32_t max_image_count;
    struct slc_demand_scan scan;
    struct slc_page_directory directory;
    struct slc_page_space *space;
    struct slc_demand_residency *residency;
    struct slc_page_memory tile_interface;
    uint64_t tile_limit; ///< of the class of tiles
    uint32_t *owners; ///< owned; whose pages a block of SLUICE_DEMAND_BLOCK_PAGES has, see pages.h
    uint32_t owner_capacity;
    bool has_shared;    ///< pages of other front ends are shown from the next launch on
    bool space_changed; ///< ids were given since the last launch
    struct slc_rank_run ranks[SLC_MAX_LAUNCHES]; ///< by launch
    /** Owned; pages whose requests the next launch clears, after those of launches under way. */
    struct slc_page_run *forgotten;
    uint32_t forgotten_count, forgotten_capacity;

    struct slc_demand_texture *textures; ///< owned
    uint32_t texture_high, texture_capacity, texture_count, texture_page_count;
    uint32_t free_texture, first_retired_texture, last_retired_texture;

    struct slc_demand_image **images; ///< owned, by slot
    uint32_t image_high, image_capacity, free_image, first_retired_image, last_retired_image;
    uint32_t first_refresh;
    struct slc_image_order orders[2]; ///< open ones; second: their tails have places
    uint64_t known_since;             ///< processed launches after this one told what they used
    bool knows_use;                   ///< the launch that is being processed did
    uint32_t *tail_blocks; ///< owned; by slot / SLUICE_DEMAND_BLOCK_PAGES: the first tail page
    uint32_t tail_block_count, tail_block_capacity;
    SluiceImageSource opener;               ///< an image whose texels are base colors
    struct slc_demand_image *first_started; ///< reads of `opener` that sources were asked to start;
                                            ///< guarded by the mutex of `tickets`

    struct slc_demand_resource **resources; ///< owned, by index
    uint32_t resource_high, resource_capacity, free_resource;
    bool classes[SLC_DEMAND_CLASSES];      ///< in use
    bool byte_classes[SLC_DEMAND_CLASSES]; ///< in use or last used for byte pages
    struct slc_eviction *evictions;        ///< owned; a ring in the order of their launches
    uint32_t eviction_first, eviction_count, eviction_capacity;
    uint32_t unasked_count; ///< requests of the last launch that did not reach the residency
    uint32_t held_count; ///< resident values of resources: each will need an entry of `evictions`

    SluiceTileLoader *reader;
    struct slc_demand_job *jobs; ///< owned
    uint32_t job_count, first_large, first_produce;
    struct slc_job_list free_tiles, free_others, free_large, free_produce;
    struct slc_job_list arrived, admitted, copied; ///< read; resident; on its way to its place
    struct slc_job_list unproduced, produced; ///< to be asked for; written by a launch under way
    struct slc_production *productions;       ///< owned; maxTilesInFlight
    struct slc_remakes remakes;               ///< pages that are resident
    uint32_t free_tile_count, free_other_count, free_large_count, free_produce_count;
    uint32_t reading_count; ///< tiles and byte pages that are submitted and not yet back
    struct slc_job_batch batch;
    struct slc_tickets tickets;

    struct slc_preload *preloads; ///< owned, in the order in which they were asked for
    uint32_t preload_count, preload_capacity;

    uint64_t launch, ended, processed; ///< the last of each
    uint32_t *misses; ///< owned; maxRequestsPerLaunch; pages of the last one processed
    uint32_t miss_count;
    uint64_t listed_launch;   ///< the last that is processed and left no request to the next scan
    bool cleared;             ///< the device's buffers
    uint64_t cleared_launch;  ///< that did
    bool page_table_was_full; ///< it was told
    bool tracked[SLC_MAX_LAUNCHES]; ///< by launch: shaders said what they used
    bool probed[SLC_MAX_LAUNCHES];  ///< by launch: they said so for strict mode alone
    struct slc_demand_strict strict;
    uint32_t limited_count; ///< resources with a limit
    struct slc_retries retries;
    SluiceDemandLoaderSettings settings; ///< from the next launch on
    uint32_t requests_per_launch;        ///< of the present one
    SluiceDemandStatistics counts;
};

/** A read that ended so may well succeed when shaders ask again. */
static inline bool slc_result_may_pass(SluiceResult result)
{
    return result == SLUICE_NOT_READY || result == SLUICE_ERROR_CANCELED ||
           result == SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

/** For messages: as the application calls it, else as its source does. */
static inline const char *slc_image_name(const struct slc_demand_image *image)
{
    if (image->origin.pName)
        return image->origin.pName;
    return (image->source || image->made) && image->info.pName ? image->info.pName : "image";
}

/* loader_settings.c */
/** A launch begins. */
void slc_loader_settings_apply(SluiceDemandLoader *loader);

/* textures.c */
SluiceResult slc_texture_find(SluiceDemandLoader *loader, SluiceDemandTextureId id,
                              uint32_t *index);
SluiceDemandTextureId slc_texture_id(const SluiceDemandLoader *loader, uint32_t index);
/** An index of its own generation, with an entry in the table. Errors: LIMIT_EXCEEDED,
 *  OUT_OF_HOST_MEMORY. */
SluiceResult slc_texture_take(SluiceDemandLoader *loader, uint32_t *index);
/** The texture of an image and all its variants look like this from the next launch on. */
void slc_texture_show_unknown(SluiceDemandLoader *loader, uint32_t index);
void slc_texture_show_failed(SluiceDemandLoader *loader, uint32_t index);
void slc_texture_show_image(SluiceDemandLoader *loader, const struct slc_demand_image *image);
/** Indices of textures that no launch after `processed` names. */
void slc_textures_end_retired(SluiceDemandLoader *loader);
void slc_demand_textures_finish(SluiceDemandLoader *loader);
/** True: it could not be opened, and may be asked for again. */
bool slc_texture_retry(SluiceDemandLoader *loader, uint32_t index);

/* retries.c: what failed is tried again */
/** `owner`: the retry_group of whose page it is. False: there is no memory to keep it in mind. */
bool slc_retries_add(SluiceDemandLoader *loader, uint32_t *owner, uint32_t page);
/** A page of the owner was read. */
void slc_retries_success(SluiceDemandLoader *loader, uint32_t *owner, uint32_t page);
/** All pages of the owner may be asked for again, now; or the owner goes. */
void slc_retries_all(SluiceDemandLoader *loader, uint32_t *owner);
/** False: there is no memory to keep it in mind. */
bool slc_retries_add_opening(SluiceDemandLoader *loader, uint32_t texture);
/** A texture was opened that could not be before. */
void slc_retries_note_opened(SluiceDemandLoader *loader);
/** What has rested may be asked for again; before changes are applied. */
void slc_retries_advance(SluiceDemandLoader *loader);
void slc_retries_everything(SluiceDemandLoader *loader);
/** "retrying in 30 s", for a message; `size` bytes. Returns `words`. */
const char *slc_retries_words(const SluiceDemandLoader *loader, char *words, size_t size);
void slc_retries_finish(SluiceDemandLoader *loader);

/* grids.c */
/** Cells that name the texture show their grid's own color. */
void slc_grids_leave(SluiceDemandLoader *loader, uint32_t index);
/** The grid names nothing any more; its cells stay what they are for launches under way. */
void slc_grid_empty(SluiceDemandLoader *loader, uint32_t index);

/* images.c */
/** Begins to open the image of a texture, unless that is done. */
enum slc_request_answer slc_image_request(SluiceDemandLoader *loader, uint32_t texture,
                                          SluiceDemandTicket ticket, SluiceResult *result);
/** Ends a job that opened the image or read its base color. */
void slc_image_job_back(SluiceDemandLoader *loader, struct slc_demand_image *image,
                        const struct slc_demand_job *job, SluiceResult result);
/** Ends a job of the image, of any kind. Retires a detached image after its last job. */
void slc_image_release(SluiceDemandLoader *loader, struct slc_demand_image *image);
/** It cannot be sampled after all: the texture shows its failureColor from now on. */
void slc_image_fail(SluiceDemandLoader *loader, struct slc_demand_image *image);
/** No texture's any more: its pages are forgotten, it is closed when its reads are over. */
void slc_image_detach(SluiceDemandLoader *loader, struct slc_demand_image *image);
/** True if the image is open, has no reads, and the last processed launch did not use it. Launches
 *  in flight may use it. */
bool slc_image_is_idle(const SluiceDemandLoader *loader, const struct slc_demand_image *image);
/** Closes an idle image. Its texture is as if nobody had asked for it. */
void slc_image_forget_texture(SluiceDemandLoader *loader, struct slc_demand_image *image);
/** Its texels have changed. */
void slc_image_invalidate(SluiceDemandLoader *loader, struct slc_demand_image *image);
void slc_images_refresh(SluiceDemandLoader *loader);
void slc_images_end_retired(SluiceDemandLoader *loader);
void slc_images_finish(SluiceDemandLoader *loader);
/** A source whose every texel is an image to be opened: see slc_demand_image.read_color. */
void slc_image_opener_init(SluiceImageSource *opener);
/** An opening is over: makes the color of texels that the source read on its own, if there are any,
 *  and they are good. */
void slc_image_end_opening(struct slc_demand_image *image, bool is_read);
/** Returns the interface of sources that fill and read the pages of resources. */
const SluiceImageSourceInterface *slc_resource_interface(void);

/* page_answers.c */
/** Requests a page of a resource without a callback: the application answers it. */
enum slc_request_answer slc_answer_request(SluiceDemandLoader *loader,
                                           struct slc_demand_resource *resource, uint32_t page,
                                           SluiceResult *result);
/** Ends the wait for answers to these pages, which the residency has forgotten. */
void slc_answers_forget(SluiceDemandLoader *loader, struct slc_demand_resource *resource,
                        uint32_t first, uint32_t count);

/* resources.c */
/** Errors: UNKNOWN_TEXTURE, STALE_TEXTURE. */
SluiceResult slc_resource_find(SluiceDemandLoader *loader, SluiceDemandResourceId id,
                               struct slc_demand_resource **resource);
/** Makes room in `evictions` for all resident values and one more. False without memory. */
bool slc_resource_reserve_eviction(SluiceDemandLoader *loader);
/** Request for a page of the resource. */
struct slc_page_request slc_resource_page_request(const struct slc_demand_resource *resource,
                                                  uint32_t page, bool pinned);
enum slc_request_answer slc_resource_request(SluiceDemandLoader *loader, uint32_t index,
                                             uint32_t page, SluiceDemandTicket ticket,
                                             SluiceResult *result);
void slc_resource_job_back(SluiceDemandLoader *loader, struct slc_demand_job *job,
                           SluiceResult result);
/** Resets the retries of the resource after a page could be read. */
void slc_resource_note_success(SluiceDemandLoader *loader, struct slc_demand_resource *resource,
                               uint32_t page);
/** Tells the residency of a job without a result, and logs it if it `failed`. */
void slc_resource_fail(SluiceDemandLoader *loader, struct slc_demand_resource *resource,
                       const struct slc_demand_job *job, SluiceResult result, bool failed);
SluiceDemandResourceId slc_resource_id(const struct slc_demand_resource *resource);
/** Drops the texels that jobs are about to write to these pages. */
void slc_resource_drop_jobs(SluiceDemandLoader *loader, const struct slc_demand_resource *resource,
                            uint32_t first, uint32_t count);
/** Ends a job of the resource, of any kind. Frees a removed resource after its last job. */
void slc_resource_release(SluiceDemandLoader *loader, uint32_t index);
/** The value of a page is not resident any more. */
void slc_resource_evicted(SluiceDemandLoader *loader, uint32_t index, uint32_t page,
                          uint64_t value);
/** pfnEvict for what no launch after `processed` reads. */
void slc_resources_end_retired(SluiceDemandLoader *loader);
void slc_resources_finish(SluiceDemandLoader *loader);

/* byte_pages.c */
/** Checks the settings of byte pages. Allocates nothing. Errors, logged: UNSUPPORTED,
 *  INVALID_ARGUMENT. */
SluiceResult slc_byte_pages_init(SluiceDemandLoader *loader);
/** Elements of the array of chunks in descriptor sets. 0 if the device allows too few storage
 *  buffers. */
uint32_t slc_byte_pages_binding_count(const SluiceDemandLoader *loader);
/** Checks the page size of a new resource, and makes staging memory for large pages. Errors:
 * INVALID_ARGUMENT, LIMIT_EXCEEDED, logged; OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN. */
SluiceResult slc_byte_pages_prepare(SluiceDemandLoader *loader, uint32_t page_size);
/** Sets from its info how pages of the resource are read and shown. */
void slc_byte_pages_describe(SluiceDemandLoader *loader, struct slc_demand_resource *resource);
void slc_byte_job_back(SluiceDemandLoader *loader, struct slc_demand_job *job, SluiceResult result);
/** Value of a page for shaders. `value`: the value or place that the residency has. */
uint64_t slc_byte_pages_value(const SluiceDemandLoader *loader, uint32_t page, uint64_t value);
/** Count the resources of byte pages, which share memoryBudget with tiles. */
void slc_byte_pages_add_resource(SluiceDemandLoader *loader);
void slc_byte_pages_remove_resource(SluiceDemandLoader *loader);
/** Frees empty chunks and divides memoryBudget when a launch begins. */
void slc_byte_pages_begin(SluiceDemandLoader *loader, uint64_t launch);
/** Writes all chunks to the descriptor set of a launch. */
void slc_byte_pages_bind(SluiceDemandLoader *loader, uint32_t slot);
void slc_byte_pages_count(const SluiceDemandLoader *loader, SluiceDemandStatistics *statistics);

/* jobs.c */
SluiceResult slc_jobs_init(SluiceDemandLoader *loader);
void slc_jobs_finish(SluiceDemandLoader *loader);
/** Whether a job of the kind can be taken. Makes staging memory for it. */
bool slc_job_is_ready(SluiceDemandLoader *loader, enum slc_job_kind kind);
/** Takes a free job. NULL if there is none. For kinds with staging memory slc_job_is_ready must be
 *  true. */
struct slc_demand_job *slc_job_take(SluiceDemandLoader *loader, enum slc_job_kind kind);
void slc_job_free(SluiceDemandLoader *loader, struct slc_demand_job *job);
/** Staging memory of the job. */
uint8_t *slc_job_memory(SluiceDemandLoader *loader, const struct slc_demand_job *job);
VkBuffer slc_job_buffer(SluiceDemandLoader *loader, const struct slc_demand_job *job,
                        uint64_t *offset);
/** A task of the ticket begins: `read` without its userValue. Errors, with no task begun: what the
 *  tile loader says. */
SluiceResult slc_job_submit(SluiceDemandLoader *loader, struct slc_demand_job *job,
                            SluiceTileRead *read, SluiceDemandTicket ticket);
/** Between these calls the reads of single regions may wait for each other, so that threads do not
 *  get in the way of the next. */
void slc_jobs_begin_batch(SluiceDemandLoader *loader);
void slc_jobs_end_batch(SluiceDemandLoader *loader);
/** Reads that are over: images are open, values are there, tiles are in `arrived`. */
void slc_jobs_collect(SluiceDemandLoader *loader);
/** What jobs of this kind and owner read of pages from `first` on is not wanted. */
void slc_jobs_drop(SluiceDemandLoader *loader, enum slc_job_kind kind, uint32_t owner,
                   uint32_t first, uint64_t count);
/** Until no job of this kind and owner is running. */
void slc_jobs_wait(SluiceDemandLoader *loader, enum slc_job_kind kind, uint32_t owner);
void slc_job_list_append(SluiceDemandLoader *loader, struct slc_job_list *list,
                         struct slc_demand_job *job);
struct slc_demand_job *slc_job_list_pop(SluiceDemandLoader *loader, struct slc_job_list *list);
static inline uint32_t slc_job_index(const SluiceDemandLoader *loader,
                                     const struct slc_demand_job *job)
{
    return (uint32_t)(job - loader->jobs);
}

/* forgetting.c */
/** The image was opened. */
void slc_image_enter_order(SluiceDemandLoader *loader, struct slc_demand_image *image);
/** The image is open no more. */
void slc_image_leave_order(SluiceDemandLoader *loader, struct slc_demand_image *image);
/** A place was taken for the tail, which is being read. */
void slc_image_gets_tail(SluiceDemandLoader *loader, struct slc_demand_image *image);
/** `launch` uses the image. */
void slc_image_touch(SluiceDemandLoader *loader, struct slc_demand_image *image, uint64_t launch);
/** `launch`, which is being processed, uses a page, or misses it. */
void slc_image_touch_page(SluiceDemandLoader *loader, uint32_t page, uint64_t launch);
/** Forgets images for a page that is requested, if no place is free: those that were used before
 *  any tile that could be evicted. */
void slc_images_make_room(SluiceDemandLoader *loader, uint32_t page);
/** A launch was processed: forgets images that were not used for forgetAfterLaunches. */
void slc_images_forget_old(SluiceDemandLoader *loader);

/* tiles.c */
/** Kind of the jobs that bring tiles of the image. */
static inline enum slc_job_kind slc_tile_job_kind(const struct slc_demand_image *image)
{
    return image->made ? SLC_JOB_PRODUCE : SLC_JOB_TILE;
}
/** The class of tiles gets the limit of slc_tile_memory_limit_now. */
void slc_tiles_limit(SluiceDemandLoader *loader);
/** `page` is one of the image's. */
enum slc_request_answer slc_tile_request(SluiceDemandLoader *loader, struct slc_demand_image *image,
                                         uint32_t page, SluiceDemandTicket ticket,
                                         SluiceResult *result);
void slc_tile_job_back(SluiceDemandLoader *loader, struct slc_demand_job *job, SluiceResult result,
                       uint64_t size);

/* uploads.c */
/** Tiles that arrived are resident; before the page table is recorded. */
void slc_uploads_admit(SluiceDemandLoader *loader);
/** Copies what was admitted; how many tiles. */
uint32_t slc_uploads_record(SluiceDemandLoader *loader, VkCommandBuffer commands);
/** What launches from this one on copied is admitted again. */
void slc_uploads_abandon(SluiceDemandLoader *loader, uint64_t launch);
/** Staging memory that launches up to `processed` have read. */
void slc_uploads_end_retired(SluiceDemandLoader *loader);

/* requests.c */
/** What the launch asked for, counted into `requests`. */
void slc_requests_process(SluiceDemandLoader *loader, uint64_t launch, SluiceDemandTicket ticket,
                          SluiceDemandRequests *requests);
/** One page, whatever it is of. */
enum slc_request_answer slc_page_request_any(SluiceDemandLoader *loader, uint32_t page,
                                             SluiceDemandTicket ticket, SluiceResult *result);
/** The page table shows what the residency says from the next record on. */
void slc_changes_apply(SluiceDemandLoader *loader);
/** Resources hear of the values that went. */
void slc_evicted_take(SluiceDemandLoader *loader);

/* preload.c */
void slc_preloads_continue(SluiceDemandLoader *loader);
/** The image at the texture's index goes: pages that preloads know are not those of the next. */
void slc_preloads_detach(SluiceDemandLoader *loader, uint32_t texture);
void slc_preloads_finish(SluiceDemandLoader *loader);

/* productions.c; see productions.h, too */
/** Begins a tile or mip tail of `image` that got a place. A job must be ready. */
void slc_tile_production_begin(SluiceDemandLoader *loader, struct slc_demand_image *image,
                               uint32_t page);
/** Begins a byte page that got a place. A job must be ready. */
void slc_byte_production_begin(SluiceDemandLoader *loader, struct slc_demand_resource *resource,
                               uint32_t page);

/* remaking.c */
/** These pages are not to be made again: they are gone, or will be made anew. */
void slc_remakes_forget(SluiceDemandLoader *loader, uint32_t first, uint64_t count);

/* relief.c */
/** Empties images of pages whose memory the budget or other front ends need. Call it before a
 *  launch is recorded. */
void slc_relieve_memory(SluiceDemandLoader *loader);

#endif /* SLC_DEMAND_VULKAN_LOADER_H */
