/* Copies from staging memory to the pages of tiles and the slots of byte pages. */
#include "base/checked.h"
#include "demand_vulkan/tiles.h"
#include "vulkan/compute.h"
#include "vulkan/sparse_layout.h"

#define COPY_BATCH 128u
#define MOST_TARGETS 16u

/* Copies to one image. `block_targets`: images of compressed blocks that commands since the last
 * barrier write. */
struct copies {
    SluiceDemandLoader *loader;
    VkCommandBuffer commands;
    VkImage target, block_targets[MOST_TARGETS];
    uint32_t block_target_count;
    bool blocks; ///< `target` has compressed blocks
    VkBuffer source;
    uint32_t count;
    VkBufferImageCopy list[COPY_BATCH];
};

struct byte_copies {
    SluiceDemandLoader *loader;
    VkCommandBuffer commands;
    VkBuffer source, target;
    uint32_t count;
    VkBufferCopy list[COPY_BATCH];
};

/* Removes the job from the count of its owner. */
static void release(SluiceDemandLoader *loader, const struct slc_demand_job *job)
{
    if (job->image)
        slc_image_release(loader, job->image);
    else
        slc_resource_release(loader, job->owner);
}

/*
 * Returns how many tiles a launch copies. While reads are in progress, it copies only a share of
 * the staging memory: other parts wait for launches to end, or are being read into. Without reads
 * in progress, it copies all tiles.
 */
static uint32_t most_tiles(const SluiceDemandLoader *loader)
{
    if (loader->reading_count == 0)
        return UINT32_MAX;
    return slc_max_u32(1, loader->info.maxTilesInFlight / (loader->info.launchesInFlight + 1));
}

void slc_uploads_admit(SluiceDemandLoader *loader)
{
    uint32_t left = most_tiles(loader);
    for (struct slc_demand_job *job;
         left > 0 && (job = slc_job_list_pop(loader, &loader->arrived));) {
        if (job->stale) {
            slc_residency_failed(loader->residency, job->page, false);
            release(loader, job);
            slc_job_free(loader, job);
            continue;
        }
        slc_residency_loaded(loader->residency, job->page, job->place);
        slc_job_list_append(loader, &loader->admitted, job);
        left--;
    }
}

/* Copies are disjoint and need no barrier. But synchronization validation (1.3.239) takes
 * block-compressed texels as rows of texels, and reports disjoint copies of two commands to an
 * image as overlapping. */
static void separate(struct copies *c)
{
    uint32_t i = 0;
    while (i < c->block_target_count && c->block_targets[i] != c->target)
        i++;
    if (i < c->block_target_count || i == MOST_TARGETS) {
        slc_compute_barrier(&c->loader->vk, c->commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                            VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                            VK_ACCESS_TRANSFER_WRITE_BIT);
        c->block_target_count = 0;
    }
    c->block_targets[c->block_target_count++] = c->target;
}

static void flush(struct copies *c)
{
    if (c->count && c->blocks)
        separate(c);
    if (c->count)
        c->loader->vk.CmdCopyBufferToImage(c->commands, c->source, c->target,
                                           VK_IMAGE_LAYOUT_GENERAL, c->count, c->list);
    c->count = 0;
}

static uint32_t round_up(uint32_t size, uint32_t to)
{
    return slc_div_up_u32(size, to) * to;
}

static void add(struct copies *c, const struct slc_demand_job *job,
                const struct slc_tile_part *part)
{
    uint32_t place = job->place & SLUICE_DEMAND_PLACE_MASK;
    VkImage target = slc_page_image(c->loader->pages, place);
    uint32_t block = job->image->blocks ? 4 : 1;
    uint64_t offset;
    VkBuffer source = slc_job_buffer(c->loader, job, &offset);
    if (c->count == COPY_BATCH || target != c->target || source != c->source)
        flush(c);
    c->target = target;
    c->blocks = block > 1;
    c->source = source;
    /* A level may end inside the page, and must end with a whole block there. */
    c->list[c->count++] =
        (VkBufferImageCopy){.bufferOffset = offset + part->offset,
                            .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, place & 0xFFFFu, 1},
                            .imageOffset = {(int32_t)part->x, (int32_t)part->y, 0},
                            .imageExtent = {round_up(part->region.width, block),
                                            round_up(part->region.height, block), 1}};
    if (!job->counted)
        c->loader->counts.bytesUploaded += sluiceGetFormatRegionSize(
            job->image->info.format, part->region.width, part->region.height);
}

static void flush_bytes(struct byte_copies *c)
{
    if (c->count)
        c->loader->vk.CmdCopyBuffer(c->commands, c->source, c->target, c->count, c->list);
    c->count = 0;
}

static void record_bytes(struct byte_copies *c, const struct slc_demand_job *job)
{
    SluiceDemandLoader *loader = c->loader;
    const struct slc_demand_resource *resource = loader->resources[job->owner];
    uint32_t chunk;
    VkBufferCopy copy = {.size = resource->info.pageSize};
    VkBuffer source = slc_job_buffer(loader, job, &copy.srcOffset);
    slc_byte_place(job->place, resource->stride, &chunk, &copy.dstOffset);
    VkBuffer target = loader->bytes.chunks[chunk].buffer;
    if (c->count == COPY_BATCH || target != c->target || source != c->source)
        flush_bytes(c);
    c->source = source;
    c->target = target;
    c->list[c->count++] = copy;
    if (!job->counted)
        loader->counts.bytesUploaded += copy.size;
}

/* True if an admitted job is still wanted. It was forgotten if the page table had no room, or its
 * launch was abandoned or could not begin. Then even its place may belong to another page. */
static bool is_wanted(const SluiceDemandLoader *loader, const struct slc_demand_job *job)
{
    if (job->image)
        return !job->stale && slc_page_directory_shows(&loader->directory, job->page, job->place);
    return !job->stale &&
           slc_page_directory_shows_wide(&loader->directory, job->page,
                                         slc_byte_pages_value(loader, job->page, job->place));
}

static void record_tile(struct copies *copies, struct slc_demand_job *job)
{
    SluiceDemandLoader *loader = copies->loader;
    struct slc_tile_part parts[SLC_TILE_MAX_PARTS];
    slc_image_touch(loader, job->image, loader->launch);
    if (!slc_is_tail_word(job->place))
        slc_page_share_written(loader->pages, loader->page_user, job->place, loader->launch);
    uint32_t part_count = slc_tile_parts(job->image, job->page, job->place, parts);
    for (uint32_t i = 0; i < part_count; i++)
        add(copies, job, &parts[i]);
}

uint32_t slc_uploads_record(SluiceDemandLoader *loader, VkCommandBuffer commands)
{
    struct copies copies = {.loader = loader, .commands = commands};
    struct byte_copies bytes = {.loader = loader, .commands = commands};
    uint32_t count = 0;
    for (struct slc_demand_job *job; (job = slc_job_list_pop(loader, &loader->admitted));) {
        bool wanted = is_wanted(loader, job);
        if (wanted && job->image)
            record_tile(&copies, job);
        else if (wanted)
            record_bytes(&bytes, job);
        count += wanted;
        job->launch = loader->launch;
        job->counted = true;
        release(loader, job);
        slc_job_list_append(loader, &loader->copied, job);
    }
    flush(&copies);
    flush_bytes(&bytes);
    return count;
}

void slc_uploads_end_retired(SluiceDemandLoader *loader)
{
    while (loader->copied.first != SLC_NONE &&
           loader->jobs[loader->copied.first].launch <= loader->processed)
        slc_job_free(loader, slc_job_list_pop(loader, &loader->copied));
}

void slc_uploads_abandon(SluiceDemandLoader *loader, uint64_t launch)
{
    struct slc_job_list kept = {SLC_NONE, SLC_NONE};
    for (struct slc_demand_job *job; (job = slc_job_list_pop(loader, &loader->copied));) {
        if (job->launch < launch) {
            slc_job_list_append(loader, &kept, job);
        } else if (job->stale) { /* its image slot may belong to another image by now */
            slc_job_free(loader, job);
        } else {
            *(job->image ? &job->image->job_count : &loader->resources[job->owner]->job_count) += 1;
            slc_job_list_append(loader, &loader->admitted, job);
        }
    }
    loader->copied = kept;
}
