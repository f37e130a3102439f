/* Restores the wants of maps. Textures that share a history are restored to one again. */
#include "base/bytes.h"
#include "core/follower.h"
#include "core/history.h"
#include "core/mip_bias.h"
#include "core/snapshot_parts.h"
#include "core/wants.h"

#include <string.h>

/** Exchanges levels of regions: levels of the texture, or SLUICE_MIP_UNTOUCHED. */
static void exchange_map(struct slc_snapshot_io *io, const struct slc_managed_texture *t,
                         uint8_t *map)
{
    size_t count = slc_region_count(t);
    if (!slc_snapshot_is_good(io))
        return;
    io->bytes(io->user, map, count);
    for (size_t i = 0; io->reading && slc_snapshot_is_good(io) && i < count; i++)
        if (map[i] != SLUICE_MIP_UNTOUCHED && map[i] >= t->shape->desc.mipLevelCount)
            slc_snapshot_fail(io, "the snapshot has a map with a level that its texture lacks");
    io->part(io->user);
}

static void exchange_span(slc_manager *m, struct slc_snapshot_io *io, struct slc_managed_texture *t,
                          uint32_t index)
{
    if (io->reading) {
        io->result = slc_history_make(m, t, 1);
        if (!slc_snapshot_is_good(io))
            return;
        memset(t->history->spans[index].map, SLUICE_MIP_UNTOUCHED, slc_padded(slc_region_count(t)));
        t->history->span_count = index + 1;
    }
    struct slc_span *span = &t->history->spans[index];
    slc_snapshot_u64(io, &span->begin);
    slc_snapshot_u64(io, &span->end);
    slc_snapshot_u32(io, &span->weight, UINT32_MAX);
    slc_snapshot_u8(io, &span->below, UINT8_MAX);
    slc_snapshot_flag(io, &span->empty);
    exchange_map(io, t, span->map);
}

/** Restores values that follow from the maps of a history, and the wanted tiles. */
static void restore_derived(slc_manager *m, struct slc_snapshot_io *io,
                            struct slc_managed_texture *t)
{
    struct slc_history *h = t->history;
    io->result = slc_wants_reserve_scratch(m, 0, t->shape->work_size);
    for (size_t i = 0; i < slc_region_count(t); i++) {
        for (uint32_t k = 0; k < h->span_count; k++)
            if (h->spans[k].map[i] < h->least[i])
                h->least[i] = h->spans[k].map[i];
        h->asked_least = h->asked[i] < h->asked_least ? h->asked[i] : h->asked_least;
        t->held_regions += h->least[i] != SLUICE_MIP_UNTOUCHED;
    }
    if (slc_snapshot_is_good(io))
        slc_wants_restore(m, t);
}

static void exchange_history(slc_manager *m, struct slc_snapshot_io *io,
                             struct slc_managed_texture *t)
{
    if (io->reading)
        io->result = slc_history_make(m, t, 1);
    if (!slc_snapshot_is_good(io))
        return;
    struct slc_history *h = t->history;
    uint32_t span_count = h->span_count;
    slc_snapshot_u32(io, &h->bias, SLC_MAX_MIP_BIAS);
    slc_snapshot_u32(io, &h->absence, UINT32_MAX);
    slc_snapshot_u32(io, &span_count, SLC_MAX_SPANS);
    for (uint32_t i = 0; i < span_count && slc_snapshot_is_good(io); i++)
        exchange_span(m, io, t, i);
    exchange_map(io, t, h->asked);
    exchange_map(io, t, h->known);
    if (io->reading && slc_snapshot_is_good(io))
        restore_derived(m, io, t);
}

static void restore_shared(slc_manager *m, struct slc_snapshot_io *io,
                           struct slc_managed_texture *t, uint32_t leader_index)
{
    const struct slc_managed_texture *leader = slc_snapshot_texture(m, io, leader_index);
    if (!leader)
        return;
    if (!leader->history || leader->history->bias || t == leader ||
        !slc_have_same_shape(t, leader)) {
        slc_snapshot_fail(io, "the snapshot has textures that cannot share their maps");
        return;
    }
    io->result = slc_state_make(m, t);
    if (!slc_snapshot_is_good(io))
        return;
    slc_history_share(t, leader->history);
    t->held_regions = leader->held_regions;
    t->hits = leader->hits;
    t->returns = leader->returns;
    t->wanted_tiles = leader->wanted_tiles;
    for (uint32_t l = 0; l < t->shape->desc.regularMipCount; l++)
        *slc_wanted_in_level(t, l) = *slc_wanted_in_level(leader, l);
}

/** Maps each shared history to the first texture that has it. */
static void map_leaders(const slc_manager *m, struct slc_snapshot_io *io, struct slc_map *leaders)
{
    for (uint32_t i = 0; i < m->texture_end && slc_snapshot_is_good(io); i++) {
        const struct slc_managed_texture *t = slc_texture_at(m, i);
        uint64_t key = (uintptr_t)t->history;
        if (!t->live || !t->history || t->history->users == 1 ||
            (leaders->count && slc_map_get(leaders, key) != SLC_MAP_NONE))
            continue;
        uint32_t room = leaders->count < 8 ? 16 : 2 * leaders->count;
        io->result = leaders->count < leaders->capacity ? SLUICE_SUCCESS
                     : room >= 1u << 30                 ? SLUICE_ERROR_OUT_OF_HOST_MEMORY
                                                        : slc_map_reserve(leaders, io->cb, room);
        if (slc_snapshot_is_good(io))
            slc_map_add(leaders, key, i);
    }
}

/** 0: no history. 1: its own history, or the first user of a shared one. Else 2 + index of the
 * first. */
static uint64_t history_mark(const struct slc_managed_texture *t, const struct slc_map *leaders)
{
    if (!t->history)
        return 0;
    uint32_t leader =
        t->history->users > 1 ? slc_map_get(leaders, (uintptr_t)t->history) : t->index;
    return leader == t->index ? 1 : leader + UINT64_C(2);
}

void slc_snapshot_histories(slc_manager *m, struct slc_snapshot_io *io)
{
    struct slc_map leaders = {0};
    if (!io->reading)
        map_leaders(m, io, &leaders);
    for (uint32_t i = 0; i < m->texture_end && slc_snapshot_is_good(io); i++) {
        struct slc_managed_texture *t = slc_texture_at(m, i);
        if (!t->live)
            continue;
        uint64_t mark =
            slc_snapshot_number(io, io->reading ? 0 : history_mark(t, &leaders), UINT32_MAX);
        if (mark == 1)
            exchange_history(m, io, t);
        else if (mark > 1 && io->reading)
            restore_shared(m, io, t, (uint32_t)mark - 2);
    }
    slc_map_finish(&leaders, io->cb);
}
