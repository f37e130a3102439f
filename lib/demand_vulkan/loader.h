/**
 * Internals of the demand loader: its parts, and the functions that its files call of one another.
 * Each part has a file. All functions run on the thread that uses the loader, unless they say
 * otherwise.
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
#define SLC_LARGE_SLOTS 16u        /* staging slots for a byte page above 64 KiB */
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
    float last_color[4]; ///< color of the last level
};

/* Texture, by index; 0 is not used. The element of equal index of `table` is the part for shaders.
 */
struct slc_demand_texture {
    enum slc_texture_kind kind;
    uint32_t generation; ///< generation of the index, from 1 on
    uint32_t image;      ///< IMAGE: slot of the image while opening or open; else SLC_NONE
    bool failed;         ///< IMAGE: the image cannot be opened
    bool retry_queued;   ///< the index is in the list of openings to be tried again
    bool told;           ///< a failure was logged; false again after a success
    bool told_tail;      ///< a failure of the tail was logged; opening alone is no success
    uint32_t grid_uses;  ///< cells of grids that name the texture
    uint32_t first_element, cell_count; ///< GRID: cells, 16 per element of `grids`
    uint32_t base;                      ///< VARIANT
    uint32_t next;               ///< IMAGE, VARIANT: next variant; FREE, RETIRED: next of the list
    uint64_t launch;             ///< RETIRED: last launch that may name the texture
    SluiceDemandImage source;    ///< IMAGE
    struct slc_made_image *made; ///< IMAGE, owned: in place of `source`; else NULL
    VkSamplerAddressMode modes[2]; ///< IMAGE, VARIANT: address modes of the sampler
    bool explicit_modes;
    float failure_color[4];
};

enum slc_image_state {
    SLC_IMAGE_FREE = 0,
    SLC_IMAGE_OPENING,
    SLC_IMAGE_OPEN,
    SLC_IMAGE_DETACHED, ///< no texture has the image any more; reads are in progress
    SLC_IMAGE_RETIRED   ///< closed; launches may still name its pages
};

/* Image that is open. The job that opens it has a pointer to it, so it is never moved. */
struct slc_demand_image {
    enum slc_image_state state;
    uint32_t slot, texture;
    uint32_t next; ///< next of the list: FREE, RETIRED, or images whose base color is read again
    bool refresh;  ///< in the list of images whose base color is read again
    uint32_t job_count;
    uint64_t launch;                   ///< RETIRED: last launch that may name its pages
    uint64_t last_use;                 ///< last launch that used, missed or copied a page of it
    uint32_t older, newer;             ///< OPEN: neighbors in the order of use
    bool has_tail;                     ///< OPEN: index of its order; true may be out of date
    SluiceDemandImage origin;          ///< the texture's source when it was opened
    const struct slc_made_image *made; ///< the texture's, or NULL; not read once DETACHED
    SluiceDemandTicket ticket;

    /* Fields of the worker that opens the image, until its job is collected. */
    struct SluiceDemandLoader *loader;
    SluiceImageSource *source;
    SluiceImageInfo info;
    const char *trouble; ///< why the image cannot be used; NULL: usable, or see the job's result
    bool is_refused;     ///< opening returned UNSUPPORTED
    uint8_t *last_level; ///< owned; texels of the last level that the source reads; or NULL
    uint64_t started_as; ///< with last_level: ticket of the read
    struct slc_demand_image *next_started; ///< guarded by the mutex of `tickets`
    float read_color[4];

    uint32_t tile_width, tile_height; ///< texels
    bool blocks;                      ///< compressed
    uint32_t regular_count, tail_page;
    uint32_t first_pages[SLC_MAX_REGULAR_LEVELS];
    float base_color[4];
    uint32_t generation;  ///< generation of the texels, for keys of tiles
    uint32_t retry_group; ///< group of tiles that could not be read; 0: none
    bool told;            ///< failed tiles were logged; false again when one of them is read
    bool told_remake;     ///< a failed remake was logged; false again when one succeeds
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
    uint32_t stride;         ///< bytes from one byte page to the next; 0: pages are values
    uint32_t byte_kind;      ///< kind of byte pages; see byte_memory.h
    bool addresses;          ///< values of byte pages are addresses
    bool produced;           ///< commands write its byte pages
    uint32_t eviction_count; ///< evicted values that wait for launches before pfnEvict is called
    uint8_t class_index;
    struct slc_missed_pages missed; ///< loading pages that the application answers
    uint32_t retry_group;           ///< group of pages without a value; 0: none
    bool told;                      ///< the first page without a value was logged
    bool told_remake;               ///< a failed remake was logged
};

/* Evicted value, which no new launch sees. */
struct slc_eviction {
    uint32_t resource, page; ///< page of the resource
    uint64_t value, launch;
};

/* Job: a read, or a page that commands write. Jobs below maxTilesInFlight have the slot of
 * `staging` at their index. Jobs from first_large on have SLC_LARGE_SLOTS slots of `large`. Jobs
 * from first_produce on have no memory, and are for commands. */
struct slc_demand_job {
    enum slc_job_kind kind;
    uint32_t page, owner;           ///< image slot, or index of the resource
    uint32_t place;                 ///< place of a tile: chunk << 16 | layer; or of a byte page
    uint32_t next;                  ///< free, arrived or copied: next of the list
    bool stale;                     ///< the result is not wanted any more
    bool counted;                   ///< counted in bytesUploaded
    bool remakes;                   ///< the page is resident, and commands write it again
    uint64_t launch;                ///< copied or produced: launch with the commands
    uint64_t asked;                 ///< launch that first asked the producer; 0: none
    SluiceResult answer;            ///< answer of the producer
    uint64_t start;                 ///< ns
    uint64_t value;                 ///< value of a resource's page
    uint64_t id;                    ///< id of the texture or resource
    struct slc_demand_image *image; ///< NULL: a job of a resource

    /* Guarded by the lock of the tickets. */
    bool running;
    SluiceDemandTicket ticket;
    uint64_t read; ///< the tile loader's ticket; 0: not known yet
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
    SluiceTileRead reads[SLC_BATCH_JOBS]; ///< point to `regions` and `texels`
    SluiceImageRegion regions[SLC_BATCH_JOBS];
    void *texels[SLC_BATCH_JOBS];
};

/* Preload: levels of a texture to load without requests of shaders. */
struct slc_preload {
    SluiceDemandTextureId texture;
    SluiceDemandTicket ticket;
    SluiceImageRegion region;    ///< region of the finest level; width 0: the whole level
    struct slc_remake_area area; ///< valid if `planned`
    uint32_t level, next_page;   ///< next level, and next tile of the area in it, from 0
    bool opening, planned;
    bool detached;          ///< no texture has the planned image any more
    uint32_t planned_count; ///< tasks of the ticket that have not begun
};

/* Page that is refused because its read failed, or texture that could not be opened. */
struct slc_failed_page {
    uint32_t page, next; ///< next in the list; 0: none
    uint64_t since;      ///< ns
};

struct slc_failed_list {
    uint32_t first, last; ///< 0: empty
};

#define SLC_PAGES_PER_PROBE 4u

/* Failed pages of an image or of a resource. */
struct slc_retry_group {
    uint32_t *owner;         ///< field of the image or resource with the group's index
    uint32_t previous, next; ///< list of resting groups, longest rest first; free groups by next
    uint64_t since;          ///< ns; start of the rest
    struct slc_failed_list pages;
    uint32_t probes[SLC_PAGES_PER_PROBE], probe_count; ///< pages that were tried last
};

/* Retries of all images and resources. Index 0 of both arrays is unused. */
struct slc_retries {
    struct slc_failed_page *pages; ///< owned
    uint32_t page_capacity, free_page;
    struct slc_retry_group *groups; ///< owned
    uint32_t group_capacity, free_group, first_group, last_group;
    struct slc_failed_list openings; ///< texture indices
    bool has_opened;                 ///< a texture was opened whose opening had failed
    uint64_t opened, now;            ///< ns; time of that opening; time of the last step
};

struct slc_page_run {
    uint32_t first;
    uint64_t count;
    uint64_t launch; ///< launch that clears the requests; 0: none yet
};

/** Sections whose ranks a launch wrote. */
struct slc_rank_run {
    uint32_t first, count;
};

/** State of strict mode. Launches are processed ones. */
struct slc_demand_strict {
    SluiceDemandStrictMode mode; ///< pfnReport NULL: off
    uint64_t awaited;            ///< launch that calls wait for; 0: none
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
    struct slc_vk vk;                           ///< copy of the context's, with `memory` as client
    struct slc_memory_client memory;            ///< memory client of `vk`
    struct slc_memory_pressure memory_pressure; ///< pressure when the last launch began
    uint64_t memory_limit;                      ///< budget in bytes when the last launch began
    struct slc_caps caps;                       ///< copy of the context's
    bool usable[SLUICE_FORMAT_COUNT];           ///< formats that the device samples and filters
    VkSemaphore semaphore;

    struct slc_page_pool *pages; ///< page pool of the context; NULL: not used yet
    uint32_t page_user;          ///< user of `pages`; SLC_MAX_PAGE_USERS: none yet
    struct slc_tile_memory tiles;
    struct slc_byte_memory bytes;
    struct slc_page_memory byte_interface;
    struct slc_buffer_array byte_buffers; ///< chunks as new launches see them
    uint64_t byte_reserve;                ///< bytes of memoryBudget that tiles do not get
    uint32_t byte_resource_count;         ///< live resources of byte pages
    struct slc_descriptors descriptors;   ///< one set per launch in flight
    struct slc_buffer table_buffer, levels_buffer;
    bool told_of_modes;         ///< logged that a texture's address modes differ from its image's
    struct slc_staging staging; ///< one slot per tile job
    struct slc_staging large;   ///< SLC_LARGE_SLOTS per large job; zeroed until one is needed
    struct slc_table_mirror table;  ///< struct SluiceDemandTexture by index
    struct slc_table_mirror levels; ///< parameters, then 16 words per image slot
    struct slc_table_mirror grids;  ///< words of grids, behind `levels`
    struct slc_region_arena grid_arena;
    uint32_t max_image_count;
    struct slc_demand_scan scan;
    struct slc_page_directory directory;
    struct slc_page_space *space;
    struct slc_demand_residency *residency;
    struct slc_page_memory tile_interface;
    uint64_t tile_limit; ///< limit of the class of tiles
    uint32_t
        *owners; ///< owned; owner of each block of SLUICE_DEMAND_BLOCK_PAGES pages, see pages.h
    uint32_t owner_capacity;
    bool has_shared;    ///< pages of other front ends are shown from the next launch on
    bool space_changed; ///< ids were allocated since the last launch
    struct slc_rank_run ranks[SLC_MAX_LAUNCHES]; ///< by launch
    /** Owned; pages whose requests are cleared: by launches in progress, then by the next launch.
     */
    struct slc_page_run *forgotten;
    uint32_t forgotten_count, forgotten_capacity;

    struct slc_demand_texture *textures; ///< owned
    uint32_t texture_high, texture_capacity, texture_count, texture_page_count;
    uint32_t free_texture, first_retired_texture, last_retired_texture;

    struct slc_demand_image **images; ///< owned, by slot
    uint32_t image_high, image_capacity, free_image, first_retired_image, last_retired_image;
    uint32_t first_refresh;
    struct slc_image_order orders[2]; ///< open images; [1]: tails with places
    uint64_t known_since;             ///< processed launches after this one reported their uses
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
    struct slc_eviction *evictions;        ///< owned ring, sorted by launch
    uint32_t eviction_first, eviction_count, eviction_capacity;
    uint32_t unasked_count; ///< requests of the last launch that did not reach the residency
    uint32_t held_count; ///< resident values of resources; each needs an entry of `evictions` later

    SluiceTileLoader *reader;
    struct slc_demand_job *jobs; ///< owned
    uint32_t job_count, first_large, first_produce;
    struct slc_job_list free_tiles, free_others, free_large, free_produce;
    struct slc_job_list arrived, admitted, copied; ///< read; resident; being copied
    struct slc_job_list unproduced,
        produced;                       ///< not asked for yet; written by a launch in progress
    struct slc_production *productions; ///< owned, [maxTilesInFlight]
    struct slc_remakes remakes;         ///< pages that are resident
    uint32_t free_tile_count, free_other_count, free_large_count, free_produce_count;
    uint32_t reading_count; ///< tiles and byte pages that are submitted and not yet back
    struct slc_job_batch batch;
    struct slc_tickets tickets;

    struct slc_preload *preloads; ///< owned, in the order of the calls
    uint32_t preload_count, preload_capacity;

    uint64_t launch, ended, processed; ///< launches begun last, ended last and processed last
    uint32_t *misses; ///< owned, [maxRequestsPerLaunch]; missed pages of the last processed launch
    uint32_t miss_count;
    uint64_t listed_launch;         ///< last processed launch that left no request to the next scan
    bool cleared;                   ///< the device's buffers are cleared
    uint64_t cleared_launch;        ///< launch that cleared them
    bool page_table_was_full;       ///< a full page table was logged
    bool tracked[SLC_MAX_LAUNCHES]; ///< by launch: shaders reported the pages that they used
    bool probed[SLC_MAX_LAUNCHES];  ///< by launch: they reported only for strict mode
    struct slc_demand_strict strict;
    uint32_t limited_count; ///< resources with a limit
    struct slc_retries retries;
    SluiceDemandLoaderSettings settings; ///< settings from the next launch on
    uint32_t requests_per_launch;        ///< maxRequestsPerLaunch of the present launch
    SluiceDemandStatistics counts;
};

/** True if a read with this result may succeed when shaders request the page again. */
static inline bool slc_result_may_pass(SluiceResult result)
{
    return result == SLUICE_NOT_READY || result == SLUICE_ERROR_CANCELED ||
           result == SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

/** Returns the image's name for messages: the application's name, else the source's. */
static inline const char *slc_image_name(const struct slc_demand_image *image)
{
    if (image->origin.pName)
        return image->origin.pName;
    return (image->source || image->made) && image->info.pName ? image->info.pName : "image";
}

/* loader_settings.c */
/** Applies changed settings when a launch begins. */
void slc_loader_settings_apply(SluiceDemandLoader *loader);

/* textures.c */
SluiceResult slc_texture_find(SluiceDemandLoader *loader, SluiceDemandTextureId id,
                              uint32_t *index);
SluiceDemandTextureId slc_texture_id(const SluiceDemandLoader *loader, uint32_t index);
/** Takes a free index with an entry in the table, and sets its generation. Errors: LIMIT_EXCEEDED,
 *  OUT_OF_HOST_MEMORY. */
SluiceResult slc_texture_take(SluiceDemandLoader *loader, uint32_t *index);
/** Show a state of a texture and all its variants to shaders, from the next launch on. */
void slc_texture_show_unknown(SluiceDemandLoader *loader, uint32_t index);
void slc_texture_show_failed(SluiceDemandLoader *loader, uint32_t index);
void slc_texture_show_image(SluiceDemandLoader *loader, const struct slc_demand_image *image);
/** Frees indices of textures that no launch after `processed` names. */
void slc_textures_end_retired(SluiceDemandLoader *loader);
void slc_demand_textures_finish(SluiceDemandLoader *loader);
/** Lets shaders request a texture again whose opening failed. False: it did not fail. */
bool slc_texture_retry(SluiceDemandLoader *loader, uint32_t index);

/* retries.c: retries of failed pages and openings */
/** Adds a failed page. `owner`: retry_group of the image or resource. False without memory. */
bool slc_retries_add(SluiceDemandLoader *loader, uint32_t *owner, uint32_t page);
/** Notes that a page of the owner was read. */
void slc_retries_success(SluiceDemandLoader *loader, uint32_t *owner, uint32_t page);
/** Lets all pages of the owner be requested again at once. Call it when the owner is removed, too.
 */
void slc_retries_all(SluiceDemandLoader *loader, uint32_t *owner);
/** Adds a texture whose opening failed. False without memory. */
bool slc_retries_add_opening(SluiceDemandLoader *loader, uint32_t texture);
/** Notes that a texture was opened whose opening had failed. */
void slc_retries_note_opened(SluiceDemandLoader *loader);
/** Lets pages and textures be requested again after their rest. Call it before changes are applied.
 */
void slc_retries_advance(SluiceDemandLoader *loader);
void slc_retries_everything(SluiceDemandLoader *loader);
/** Writes "retrying in 30 s", for messages, to `words` of `size` bytes. Returns `words`. */
const char *slc_retries_words(const SluiceDemandLoader *loader, char *words, size_t size);
void slc_retries_finish(SluiceDemandLoader *loader);

/* grids.c */
/** Removes a texture from all cells, which show the color of their grid. */
void slc_grids_leave(SluiceDemandLoader *loader, uint32_t index);
/** Empties a grid. Launches in progress still see its cells. */
void slc_grid_empty(SluiceDemandLoader *loader, uint32_t index);

/* images.c */
/** Begins to open the image of a texture, unless it is opening or open. */
enum slc_request_answer slc_image_request(SluiceDemandLoader *loader, uint32_t texture,
                                          SluiceDemandTicket ticket, SluiceResult *result);
/** Ends a job that opened the image or read its base color. */
void slc_image_job_back(SluiceDemandLoader *loader, struct slc_demand_image *image,
                        const struct slc_demand_job *job, SluiceResult result);
/** Ends a job of the image, of any kind. Retires a detached image after its last job. */
void slc_image_release(SluiceDemandLoader *loader, struct slc_demand_image *image);
/** Fails an image that cannot be sampled: its texture shows failureColor from now on. */
void slc_image_fail(SluiceDemandLoader *loader, struct slc_demand_image *image);
/** Detaches an image from its texture: forgets its pages, and closes it when its reads end. */
void slc_image_detach(SluiceDemandLoader *loader, struct slc_demand_image *image);
/** True if the image is open, has no reads, and was not used by the last processed launch. Launches
 *  in flight may use it. */
bool slc_image_is_idle(const SluiceDemandLoader *loader, const struct slc_demand_image *image);
/** Closes an idle image. Its texture becomes unopened, as if it had never been requested. */
void slc_image_forget_texture(SluiceDemandLoader *loader, struct slc_demand_image *image);
/** Drops the tiles of an image whose texels have changed. */
void slc_image_invalidate(SluiceDemandLoader *loader, struct slc_demand_image *image);
void slc_images_refresh(SluiceDemandLoader *loader);
void slc_images_end_retired(SluiceDemandLoader *loader);
void slc_images_finish(SluiceDemandLoader *loader);
/** Makes the source whose texels are images to open: see slc_demand_image.read_color. */
void slc_image_opener_init(SluiceImageSource *opener);
/** Ends an opening. If the source has read the last level itself, successfully, computes the base
 *  color from it. */
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
/** Finds a live resource. Errors: UNKNOWN_TEXTURE, STALE_TEXTURE. */
SluiceResult slc_resource_find(SluiceDemandLoader *loader, SluiceDemandResourceId id,
                               struct slc_demand_resource **resource);
/** Makes room in `evictions` for all resident values and one more. False without memory. */
bool slc_resource_reserve_eviction(SluiceDemandLoader *loader);
/** Returns the request for a page of the resource. */
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
/** Reports a job without a result to the residency, and logs it if it `failed`. */
void slc_resource_fail(SluiceDemandLoader *loader, struct slc_demand_resource *resource,
                       const struct slc_demand_job *job, SluiceResult result, bool failed);
SluiceDemandResourceId slc_resource_id(const struct slc_demand_resource *resource);
/** Drops the texels that jobs are about to write to these pages. */
void slc_resource_drop_jobs(SluiceDemandLoader *loader, const struct slc_demand_resource *resource,
                            uint32_t first, uint32_t count);
/** Ends a job of the resource, of any kind. Frees a removed resource after its last job. */
void slc_resource_release(SluiceDemandLoader *loader, uint32_t index);
/** Queues the value of an evicted page for pfnEvict. */
void slc_resource_evicted(SluiceDemandLoader *loader, uint32_t index, uint32_t page,
                          uint64_t value);
/** Calls pfnEvict for values that no launch after `processed` reads. */
void slc_resources_end_retired(SluiceDemandLoader *loader);
void slc_resources_finish(SluiceDemandLoader *loader);

/* byte_pages.c */
/** Checks the settings of byte pages. Allocates nothing. Errors, logged: UNSUPPORTED,
 *  INVALID_ARGUMENT. */
SluiceResult slc_byte_pages_init(SluiceDemandLoader *loader);
/** Returns the elements of the array of chunks in descriptor sets. 0 if the device allows too few
 *  storage buffers. */
uint32_t slc_byte_pages_binding_count(const SluiceDemandLoader *loader);
/** Checks the page size of a new resource, and makes staging memory for large pages. Errors:
 * INVALID_ARGUMENT, LIMIT_EXCEEDED, logged; OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN. */
SluiceResult slc_byte_pages_prepare(SluiceDemandLoader *loader, uint32_t page_size);
/** Derives from the resource's info how its pages are read and shown. */
void slc_byte_pages_describe(SluiceDemandLoader *loader, struct slc_demand_resource *resource);
void slc_byte_job_back(SluiceDemandLoader *loader, struct slc_demand_job *job, SluiceResult result);
/** Returns the value of a page for shaders. `value`: value or place in the residency. */
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
/** True if a job of the kind can be taken. Makes staging memory for it. */
bool slc_job_is_ready(SluiceDemandLoader *loader, enum slc_job_kind kind);
/** Takes a free job. NULL if there is none. For kinds with staging memory slc_job_is_ready must be
 *  true. */
struct slc_demand_job *slc_job_take(SluiceDemandLoader *loader, enum slc_job_kind kind);
void slc_job_free(SluiceDemandLoader *loader, struct slc_demand_job *job);
/** Returns the staging memory of the job. */
uint8_t *slc_job_memory(SluiceDemandLoader *loader, const struct slc_demand_job *job);
VkBuffer slc_job_buffer(SluiceDemandLoader *loader, const struct slc_demand_job *job,
                        uint64_t *offset);
/** Submits a read and begins a task of the ticket. Sets userValue of `read`. Errors, with no task
 *  begun: those of the tile loader. */
SluiceResult slc_job_submit(SluiceDemandLoader *loader, struct slc_demand_job *job,
                            SluiceTileRead *read, SluiceDemandTicket ticket);
/** Begin and end a batch. Reads of single regions in between are submitted together, so that
 * reading threads do not delay further submissions. */
void slc_jobs_begin_batch(SluiceDemandLoader *loader);
void slc_jobs_end_batch(SluiceDemandLoader *loader);
/** Collects reads that have ended: opens images, shows values, and adds tiles to `arrived`. */
void slc_jobs_collect(SluiceDemandLoader *loader);
/** Discards the results of jobs of this kind and owner for `count` pages from `first` on. */
void slc_jobs_drop(SluiceDemandLoader *loader, enum slc_job_kind kind, uint32_t owner,
                   uint32_t first, uint64_t count);
/** Waits until no job of this kind and owner is running. */
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
/** Adds an opened image to the order of use. */
void slc_image_enter_order(SluiceDemandLoader *loader, struct slc_demand_image *image);
/** Removes an image that is closed from the order of use. */
void slc_image_leave_order(SluiceDemandLoader *loader, struct slc_demand_image *image);
/** Notes that the tail has a place, and is being read. */
void slc_image_gets_tail(SluiceDemandLoader *loader, struct slc_demand_image *image);
/** Notes that `launch` uses the image. */
void slc_image_touch(SluiceDemandLoader *loader, struct slc_demand_image *image, uint64_t launch);
/** Notes that `launch`, which is being processed, uses or misses a page. */
void slc_image_touch_page(SluiceDemandLoader *loader, uint32_t page, uint64_t launch);
/** Forgets images for a requested page, if no place is free: images that were last used before any
 *  tile that could be evicted. */
void slc_images_make_room(SluiceDemandLoader *loader, uint32_t page);
/** Forgets images unused for forgetAfterLaunches. Call it when a launch was processed. */
void slc_images_forget_old(SluiceDemandLoader *loader);

/* tiles.c */
/** Returns the kind of jobs that load tiles of the image. */
static inline enum slc_job_kind slc_tile_job_kind(const struct slc_demand_image *image)
{
    return image->made ? SLC_JOB_PRODUCE : SLC_JOB_TILE;
}
/** Sets the limit of the class of tiles to slc_tile_memory_limit_now. */
void slc_tiles_limit(SluiceDemandLoader *loader);
/** Requests a page of the image. */
enum slc_request_answer slc_tile_request(SluiceDemandLoader *loader, struct slc_demand_image *image,
                                         uint32_t page, SluiceDemandTicket ticket,
                                         SluiceResult *result);
void slc_tile_job_back(SluiceDemandLoader *loader, struct slc_demand_job *job, SluiceResult result,
                       uint64_t size);

/* uploads.c */
/** Makes tiles that have arrived resident. Call it before the page table is recorded. */
void slc_uploads_admit(SluiceDemandLoader *loader);
/** Records the copies of admitted tiles. Returns how many. */
uint32_t slc_uploads_record(SluiceDemandLoader *loader, VkCommandBuffer commands);
/** Admits tiles again that launches from this one on copied. */
void slc_uploads_abandon(SluiceDemandLoader *loader, uint64_t launch);
/** Frees staging memory that launches up to `processed` have read. */
void slc_uploads_end_retired(SluiceDemandLoader *loader);

/* requests.c */
/** Processes the requests of a launch, and counts them into `requests`. */
void slc_requests_process(SluiceDemandLoader *loader, uint64_t launch, SluiceDemandTicket ticket,
                          SluiceDemandRequests *requests);
/** Requests a page of a texture or resource. */
enum slc_request_answer slc_page_request_any(SluiceDemandLoader *loader, uint32_t page,
                                             SluiceDemandTicket ticket, SluiceResult *result);
/** Applies changes of the residency to the page table, from the next record on. */
void slc_changes_apply(SluiceDemandLoader *loader);
/** Passes evicted values to their resources. */
void slc_evicted_take(SluiceDemandLoader *loader);

/* preload.c */
void slc_preloads_continue(SluiceDemandLoader *loader);
/** Detaches preloads from the texture's image, which is going away. */
void slc_preloads_detach(SluiceDemandLoader *loader, uint32_t texture);
void slc_preloads_finish(SluiceDemandLoader *loader);

/* productions.c; see productions.h, too */
/** Begins a tile or mip tail of `image` that has got a place. A job must be ready. */
void slc_tile_production_begin(SluiceDemandLoader *loader, struct slc_demand_image *image,
                               uint32_t page);
/** Begins a byte page that has got a place. A job must be ready. */
void slc_byte_production_begin(SluiceDemandLoader *loader, struct slc_demand_resource *resource,
                               uint32_t page);

/* remaking.c */
/** Drops remakes of pages that are gone or will be made as new pages. */
void slc_remakes_forget(SluiceDemandLoader *loader, uint32_t first, uint64_t count);

/* relief.c */
/** Empties images of pages whose memory the budget or other front ends need. Call it before a
 *  launch is recorded. */
void slc_relieve_memory(SluiceDemandLoader *loader);

#endif /* SLC_DEMAND_VULKAN_LOADER_H */
