/* Textures of a snapshot: descriptions, settings, primaries and followers. */
#include "base/alloc.h"
#include "core/managed_textures.h"
#include "core/sets.h"
#include "core/snapshot_parts.h"
#include "core/uv_transform.h"

static void exchange_desc(struct slc_snapshot_io *io, SluiceStreamedTextureDesc *d)
{
    slc_snapshot_u32(io, &d->width, UINT32_MAX);
    slc_snapshot_u32(io, &d->height, UINT32_MAX);
    slc_snapshot_u32(io, &d->mipLevelCount, UINT32_MAX);
    slc_snapshot_u32(io, &d->regularMipCount, UINT32_MAX);
    slc_snapshot_u32(io, &d->packedTileCount, UINT32_MAX);
    slc_snapshot_u32(io, &d->tileWidth, UINT32_MAX);
    slc_snapshot_u32(io, &d->tileHeight, UINT32_MAX);
    slc_snapshot_u32(io, &d->feedbackRegionWidth, UINT32_MAX);
    slc_snapshot_u32(io, &d->feedbackRegionHeight, UINT32_MAX);
    slc_snapshot_flag(io, &d->packedTilesOutside);
}

static void exchange_axis(struct slc_snapshot_io *io, struct slc_uv_axis *axis)
{
    int64_t scale = slc_snapshot_signed(io, axis->scale);
    int64_t offset = slc_snapshot_signed(io, axis->offset);
    uint64_t wrap = slc_snapshot_number(io, (uint64_t)axis->wrap, SLUICE_UV_WRAP_MIRROR_CLAMP);
    if (!io->reading)
        return;
    *axis = (struct slc_uv_axis){scale, offset, (SluiceUvWrap)wrap};
    if (!slc_uv_axis_is_valid(axis))
        slc_snapshot_fail(io, "the snapshot has a transform out of range");
}

static void exchange_uv(slc_manager *m, struct slc_snapshot_io *io, struct slc_managed_texture *t)
{
    bool has_uv = t->uv;
    slc_snapshot_flag(io, &has_uv);
    if (!has_uv)
        return;
    if (io->reading)
        t->uv = slc_calloc(&m->cb, 1, sizeof *t->uv);
    if (!t->uv) {
        io->result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        return;
    }
    exchange_axis(io, &t->uv->u);
    exchange_axis(io, &t->uv->v);
}

static void exchange_fields(slc_manager *m, struct slc_snapshot_io *io,
                            struct slc_managed_texture *t)
{
    int64_t priority = slc_snapshot_signed(io, t->priority);
    if (priority < -SLUICE_MAX_PRIORITY || priority > SLUICE_MAX_PRIORITY)
        slc_snapshot_fail(io, "the snapshot has a priority out of range");
    else if (io->reading)
        t->priority = (int8_t)priority;
    slc_snapshot_flag(io, &t->has_map);
    slc_snapshot_flag(io, &t->seen);
    slc_snapshot_flag(io, &t->retried_all);
    slc_snapshot_u64(io, &t->map_time);
    slc_snapshot_u64(io, &t->interval);
    slc_snapshot_u64(io, &t->timeout);
    slc_snapshot_u64(io, &t->seen_time);
    slc_snapshot_u32(io, &t->hits, UINT32_MAX - 1);
    slc_snapshot_u32(io, &t->returns, UINT32_MAX - 1);
    slc_snapshot_u32(io, &t->failed_total, UINT32_MAX);
    slc_snapshot_u32(io, &t->mapped_total, UINT32_MAX);
    slc_snapshot_u32(io, &t->unmapped_total, UINT32_MAX);
    exchange_uv(m, io, t);
}

static void exchange_texture(slc_manager *m, struct slc_snapshot_io *io, uint32_t index)
{
    uint32_t generation = io->reading ? 0 : slc_texture_at(m, index)->generation;
    bool live = !io->reading && slc_texture_at(m, index)->live;
    SluiceStreamedTextureDesc desc = {0};
    slc_snapshot_u32(io, &generation, UINT32_MAX);
    slc_snapshot_flag(io, &live);
    if (live) {
        if (!io->reading)
            desc = slc_texture_at(m, index)->shape->desc;
        exchange_desc(io, &desc);
    }
    if (!slc_snapshot_is_good(io))
        return;
    SluiceResult result =
        io->reading ? slc_texture_restore(m, generation, live ? &desc : NULL) : SLUICE_SUCCESS;
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY)
        io->result = result;
    else if (result != SLUICE_SUCCESS)
        slc_snapshot_fail(io, "no texture is as the snapshot says");
    if (live && slc_snapshot_is_good(io))
        exchange_fields(m, io, slc_texture_at(m, index));
    io->part(io->user);
}

static void exchange_followers(slc_manager *m, struct slc_snapshot_io *io, uint32_t index)
{
    struct slc_managed_texture *p = slc_texture_at(m, index);
    uint32_t next = p->live ? p->first_follower : SLC_NONE;
    while (slc_snapshot_is_good(io)) {
        uint64_t at = slc_snapshot_number(io, next == SLC_NONE ? 0 : next + UINT64_C(1), SLC_NONE);
        if (at == 0)
            return;
        struct slc_managed_texture *t = slc_snapshot_texture(m, io, (uint32_t)at - 1);
        if (io->reading && t && p->live && t != p && p->primary == SLC_NONE &&
            t->primary == SLC_NONE && t->first_follower == SLC_NONE)
            slc_follow(m, t, p);
        else if (io->reading)
            slc_snapshot_fail(io, "the snapshot has a follower that cannot be one");
        else
            next = t->next_follower;
    }
}

void slc_snapshot_textures(slc_manager *m, struct slc_snapshot_io *io)
{
    uint32_t count = m->texture_end;
    slc_snapshot_u32(io, &count, UINT32_MAX);
    for (uint32_t i = 0; i < count && slc_snapshot_is_good(io); i++)
        exchange_texture(m, io, i);
    if (io->reading && slc_snapshot_is_good(io))
        slc_textures_restored(m);
    for (uint32_t i = 0; i < count && slc_snapshot_is_good(io); i++)
        exchange_followers(m, io, i);
}
