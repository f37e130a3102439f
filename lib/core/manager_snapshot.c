#include "core/manager_snapshot.h"

#include "core/check.h"
#include "core/mip_bias.h"
#include "core/observer.h"
#include "core/priority.h"
#include "core/reports.h"
#include "core/snapshot_parts.h"

/* First, because lists have limits. */
static void exchange_config(slc_manager *m, struct slc_snapshot_io *io)
{
    SluiceStreamedTextureManagerConfig config = m->config;
    config.structSize = sizeof config;
    slc_snapshot_u32(io, &config.numExtraStandbyTiles, UINT32_MAX);
    slc_snapshot_u32(io, &config.maxHeapCount, UINT32_MAX);
    slc_snapshot_u32(io, &config.maxLoadAttempts, UINT32_MAX);
    slc_snapshot_u64(io, &config.retryDelayTicks);
    slc_snapshot_u32(io, &config.missesToExpire, UINT32_MAX);
    slc_snapshot_u32(io, &config.prefetchLevels, UINT32_MAX);
    slc_snapshot_u64(io, &config.givenUpRetryDelayTicks);
    slc_snapshot_u32(io, &config.targetHeapCount, UINT32_MAX);
    slc_snapshot_flag(io, &config.noEviction);
    slc_snapshot_flag(io, &config.noMipBias);
    slc_snapshot_flag(io, &config.separatePackedTiles);
    if (io->reading && slc_snapshot_is_good(io))
        slc_manager_take_config(m, &config);
}

static void exchange_bias(struct slc_global_bias *b, struct slc_snapshot_io *io)
{
    slc_snapshot_u32(io, &b->value, SLC_MAX_MIP_BIAS);
    slc_snapshot_u32(io, &b->maps, UINT32_MAX);
    slc_snapshot_u32(io, &b->epoch, UINT32_MAX);
    slc_snapshot_u32(io, &b->rounds, UINT32_MAX);
    slc_snapshot_flag(io, &b->raised);
    slc_snapshot_u32(io, &b->floor, SLC_MAX_MIP_BIAS + 1);
    slc_snapshot_u64(io, &b->failed_limit);
    slc_snapshot_u64(io, &b->demand);
    slc_snapshot_flag(io, &b->changed);
    slc_snapshot_u32(io, &b->trials, SLC_MAX_BIAS_TRIALS);
    slc_snapshot_u32(io, &b->waited, UINT32_MAX);
}

static void exchange_round(struct slc_round *r, struct slc_snapshot_io *io)
{
    slc_snapshot_u32(io, &r->maps, UINT32_MAX);
    slc_snapshot_u64(io, &r->began);
    slc_snapshot_u64(io, &r->waited);
    slc_snapshot_u32(io, &r->count, UINT32_MAX);
    slc_snapshot_u64(io, &r->began_long);
    slc_snapshot_u64(io, &r->waited_long);
}

/* Last, because restoring tiles and lists counts like the calls that made them. */
static void exchange_totals(slc_manager *m, struct slc_snapshot_io *io)
{
    bool weighted = slc_has_priorities(m);
    slc_snapshot_u64(io, &m->map_interval);
    slc_snapshot_flag(io, &m->starved);
    slc_snapshot_flag(io, &m->refused);
    slc_snapshot_u32(io, &m->prefetch_level, UINT32_MAX);
    slc_snapshot_u32(io, &m->prefetch_texture, UINT32_MAX);
    slc_snapshot_flag(io, &m->has_time);
    slc_snapshot_u64(io, &m->time);
    slc_snapshot_u64(io, &m->last_retire);
    slc_snapshot_u64(io, &m->handed_out_total);
    slc_snapshot_u64(io, &m->mapped_total);
    slc_snapshot_u64(io, &m->unmapped_total);
    slc_snapshot_u64(io, &m->canceled_total);
    slc_snapshot_u64(io, &m->failed_total);
    slc_snapshot_u64(io, &m->moved_total);
    slc_snapshot_u64(io, &m->given_up_retried_total);
    slc_snapshot_u64(io, &m->residency.requests.next_sequence);
    slc_snapshot_u64(io, &m->residency.completed_retire);
    slc_snapshot_u64(io, &m->residency.restored_total);
    slc_snapshot_flag(io, &weighted);
    if (io->reading && weighted)
        slc_use_priorities(m);
}

static void exchange(slc_manager *m, struct slc_snapshot_io *io)
{
    exchange_config(m, io);
    slc_snapshot_textures(m, io);
    slc_snapshot_heaps(m, io);
    slc_snapshot_tiles(m, io);
    slc_snapshot_heap_order(m, io);
    slc_snapshot_histories(m, io);
    slc_snapshot_lists(m, io);
    exchange_bias(&m->bias, io);
    exchange_round(&m->round, io);
    exchange_totals(m, io);
    io->part(io->user);
}

void slc_snapshot_write(const SluiceStreamedTextureManager *manager, struct slc_snapshot_io *io)
{
    assert(!io->reading);
    exchange((slc_manager *)manager, io); /* does not change the manager while writing */
}

static uint32_t textures_behind(const slc_manager *m)
{
    uint32_t count = 0;
    for (uint32_t i = m->visit_first; i != SLC_NONE; i = slc_texture_at(m, i)->visit_next)
        count += slc_texture_at(m, i)->bias_epoch != m->bias.epoch;
    return count;
}

void slc_snapshot_read(SluiceStreamedTextureManager *manager, struct slc_snapshot_io *io)
{
    assert(io->reading && !manager->used);
    exchange(manager, io);
    if (!slc_snapshot_is_good(io))
        return;
    manager->used = true;
    manager->bias.behind = textures_behind(manager);
    if (slc_reports_count(manager) > manager->failed_total)
        slc_snapshot_fail(io, "the snapshot has more reports than failures");
    if (slc_manager_check_restored(manager))
        slc_snapshot_fail(io, slc_manager_check_restored(manager));
}
