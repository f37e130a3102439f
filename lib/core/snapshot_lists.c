/* Textures in the order in which they are visited, retried, and shown; tiles to be reported. */
#include "core/given_up_retry.h"
#include "core/layout.h"
#include "core/minmip.h"
#include "core/reports.h"
#include "core/snapshot_parts.h"
#include "core/visits.h"

struct slc_managed_texture *slc_snapshot_texture(slc_manager *m, struct slc_snapshot_io *io,
                                                 uint32_t index)
{
    if (slc_snapshot_is_good(io) && index < m->texture_end && slc_texture_at(m, index)->live)
        return slc_texture_at(m, index);
    slc_snapshot_fail(io, "the snapshot names a texture that it does not have");
    return NULL;
}

/** Exchanges the index of a texture plus 1; 0 ends a list. Returns NULL at the end or after an
 * error. */
static struct slc_managed_texture *exchange_index(slc_manager *m, struct slc_snapshot_io *io,
                                                  uint32_t index)
{
    uint64_t at = index == SLC_NONE ? 0 : index + UINT64_C(1);
    at = slc_snapshot_number(io, io->reading ? 0 : at, UINT32_MAX);
    return at ? slc_snapshot_texture(m, io, (uint32_t)at - 1) : NULL;
}

static void exchange_visits(slc_manager *m, struct slc_snapshot_io *io)
{
    struct slc_managed_texture *t;
    for (uint32_t next = m->visit_first; (t = exchange_index(m, io, next)); next = t->visit_next) {
        if (io->reading && t->visited)
            slc_snapshot_fail(io, "the snapshot has a texture in one list twice");
        else if (io->reading)
            slc_visit(m, t, true);
        slc_snapshot_u32(io, &t->bias_epoch, UINT32_MAX);
    }
    io->part(io->user);
}

static void exchange_troubles(slc_manager *m, struct slc_snapshot_io *io, enum slc_trouble state)
{
    struct slc_managed_texture *t;
    uint32_t next = m->troubles[state].count ? m->troubles[state].first : SLC_NONE;
    for (; (t = exchange_index(m, io, next)); next = t->trouble_next) {
        if (io->reading && t->trouble != SLC_TROUBLE_NONE)
            slc_snapshot_fail(io, "the snapshot has a texture in one list twice");
        else if (io->reading)
            slc_trouble_move(m, t, state);
        slc_snapshot_u64(io, &t->trouble_time);
    }
    io->part(io->user);
}

static void exchange_dirty_area(struct slc_snapshot_io *io, struct slc_managed_texture *t)
{
    const struct slc_shape *s = t->shape;
    slc_snapshot_u32(io, &t->dirty_x0, UINT32_MAX);
    slc_snapshot_u32(io, &t->dirty_y0, UINT32_MAX);
    slc_snapshot_u32(io, &t->dirty_x1, s->min_mip_width);
    slc_snapshot_u32(io, &t->dirty_y1, s->min_mip_height);
    if (t->dirty_x0 >= t->dirty_x1 || t->dirty_y0 >= t->dirty_y1)
        slc_snapshot_fail(io, "the snapshot has an update of a MinMip map that is empty");
}

static void exchange_dirty(slc_manager *m, struct slc_snapshot_io *io)
{
    struct slc_managed_texture *t;
    /* Restoring tiles has made updates of its own. */
    while (io->reading && m->dirty_first != SLC_NONE)
        slc_min_mip_drop_update(m, slc_texture_at(m, m->dirty_first));
    for (uint32_t next = m->dirty_first; (t = exchange_index(m, io, next)); next = t->dirty_next) {
        if (io->reading && t->dirty)
            slc_snapshot_fail(io, "the snapshot has a texture in one list twice");
        else if (io->reading)
            slc_min_mip_dirty_all(m, t);
        exchange_dirty_area(io, t);
    }
    io->part(io->user);
}

/** Returns the report from `at` on that has a texture; the end of the list if none has. */
static uint32_t next_report(const slc_manager *m, uint32_t at)
{
    while (at < m->reports.end && m->reports.list[at].texture_id == SLUICE_NO_TEXTURE)
        at++;
    return at;
}

static void restore_report(slc_manager *m, struct slc_snapshot_io *io,
                           struct slc_managed_texture *t, uint32_t tile)
{
    if (!slc_snapshot_is_good(io))
        return;
    if (tile >= t->shape->tile_count)
        slc_snapshot_fail(io, "the snapshot has a tile that its texture lacks");
    else if (slc_reports_reserve(m, 1))
        slc_reports_add(m, t, tile);
    else
        io->result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

static void exchange_reports(slc_manager *m, struct slc_snapshot_io *io)
{
    struct slc_managed_texture *t;
    for (uint32_t at = next_report(m, m->reports.first);; at = next_report(m, at + 1)) {
        bool there = !io->reading && at < m->reports.end;
        uint32_t tile = there ? m->reports.list[at].tile : 0;
        t = exchange_index(m, io, there ? (uint32_t)m->reports.list[at].texture_id : SLC_NONE);
        if (!t)
            break;
        slc_snapshot_u32(io, &tile, UINT32_MAX);
        if (io->reading)
            restore_report(m, io, t, tile);
    }
    io->part(io->user);
}

void slc_snapshot_lists(slc_manager *m, struct slc_snapshot_io *io)
{
    exchange_visits(m, io);
    for (int state = SLC_TROUBLE_RESTING; state < SLC_TROUBLE_COUNT; state++)
        exchange_troubles(m, io, (enum slc_trouble)state);
    exchange_dirty(m, io);
    exchange_reports(m, io);
}
