/*
 * Queue of GIVEN_UP tiles that the application has not listed yet, oldest first. The reports of one
 * texture are linked, so that removing a texture does not search the queue. Its reports stay in the
 * queue without a texture until half of the queue has none. A link is the number of a report: its
 * index in the array plus `base`.
 */
#include "core/reports.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "core/layout.h"
#include "core/observer.h"

#include <string.h>

static uint64_t key_of(const struct slc_report *report)
{
    return slc_pair_key((uint32_t)report->texture_id, report->tile);
}

uint32_t slc_reports_count(const slc_manager *m)
{
    return m->reports.end - m->reports.first - m->reports.dropped;
}

static void append(struct slc_reports *r, struct slc_managed_texture *t, uint32_t tile)
{
    uint32_t number = r->base + r->end;
    if (t->report_count++)
        r->list[t->last_report - r->base].next = number;
    else
        t->first_report = number;
    t->last_report = number;
    r->list[r->end++] = (struct slc_report){slc_texture_id(t), tile, 0};
}

/** Moves the reports with a texture to the beginning of `list`, under new numbers. */
static void pack(slc_manager *m, struct slc_report *list)
{
    struct slc_reports *r = &m->reports, old = *r;
    r->list = list;
    r->base = old.base + old.end;
    r->first = r->end = r->dropped = 0;
    for (uint32_t i = old.first; i < old.end; i++) {
        struct slc_report report = old.list[i];
        if (report.texture_id == SLUICE_NO_TEXTURE)
            continue;
        struct slc_managed_texture *t = slc_texture_at(m, (uint32_t)report.texture_id);
        if (t->first_report == old.base + i)
            t->report_count = 0;
        append(r, t, report.tile);
    }
}

bool slc_reports_reserve(slc_manager *m, uint32_t count)
{
    struct slc_reports *r = &m->reports;
    uint32_t waiting = slc_reports_count(m);
    if ((uint64_t)r->end + count <= r->room)
        return true;
    uint64_t room = (uint64_t)waiting + count + waiting / 2 + 16;
    if (room >= 1u << 30 || slc_map_reserve(&r->tiles, &m->cb, (uint32_t)room))
        return false;
    struct slc_report *list = slc_alloc(&m->cb, (size_t)room, sizeof *list), *old = r->list;
    if (!list)
        return false;
    pack(m, list);
    slc_free(&m->cb, old, r->room, sizeof *old);
    r->room = (uint32_t)room;
    return true;
}

void slc_reports_add(slc_manager *m, struct slc_managed_texture *t, uint32_t tile)
{
    uint64_t key = slc_pair_key(t->index, tile);
    if (slc_map_get(&m->reports.tiles, key) != SLC_MAP_NONE)
        return; /* reported already, and not listed since */
    slc_map_add(&m->reports.tiles, key, 0);
    append(&m->reports, t, tile);
}

/** Takes the first report of a queue that is not empty. False: its texture was removed. */
static bool take(slc_manager *m, SluiceTile *tile)
{
    struct slc_reports *r = &m->reports;
    struct slc_report report = r->list[r->first++];
    if (report.texture_id == SLUICE_NO_TEXTURE) {
        r->dropped--;
        return false;
    }
    struct slc_managed_texture *t = slc_texture_at(m, (uint32_t)report.texture_id);
    struct slc_place p = slc_tile_place(t, report.tile);
    *tile = (SluiceTile){report.texture_id, report.tile, p.level, p.x, p.y, 0, 0};
    slc_map_remove(&r->tiles, key_of(&report));
    t->first_report = report.next;
    t->report_count--;
    return true;
}

uint32_t slc_reports_take(slc_manager *m, uint32_t room, SluiceTile *tiles)
{
    struct slc_reports *r = &m->reports;
    uint32_t written = 0;
    while (written < room && slc_reports_count(m) > 0)
        written += take(m, &tiles[written]);
    if (slc_reports_count(m) == 0) {
        r->base += r->end;
        r->first = r->end = r->dropped = 0;
    }
    return written;
}

void slc_reports_drop(slc_manager *m, struct slc_managed_texture *t)
{
    struct slc_reports *r = &m->reports;
    for (; t->report_count > 0; t->report_count--) {
        struct slc_report *report = &r->list[t->first_report - r->base];
        slc_map_remove(&r->tiles, key_of(report));
        t->first_report = report->next;
        report->texture_id = SLUICE_NO_TEXTURE;
        r->dropped++;
        m->residency.steps++;
    }
    if (r->dropped > slc_reports_count(m)) {
        m->residency.steps += r->end - r->first;
        pack(m, r->list);
    }
}

const char *slc_reports_check(const slc_manager *m)
{
    const struct slc_reports *r = &m->reports;
    uint32_t dropped = 0;
    for (uint32_t i = r->first; i < r->end; i++) {
        const struct slc_report *report = &r->list[i];
        dropped += report->texture_id == SLUICE_NO_TEXTURE;
        if (report->texture_id == SLUICE_NO_TEXTURE)
            continue;
        const struct slc_managed_texture *t = slc_texture_at(m, (uint32_t)report->texture_id);
        if (!t->live || t->report_count == 0 || slc_texture_id(t) != report->texture_id)
            return "a report is of no texture";
        if (slc_map_get(&r->tiles, key_of(report)) == SLC_MAP_NONE)
            return "a report is not in the map";
    }
    return dropped == r->dropped && r->tiles.count == slc_reports_count(m) ? NULL
                                                                           : "reports are lost";
}

static SluiceResult get_given_up_tiles(slc_manager *m, uint32_t *count, SluiceTile *tiles)
{
    uint32_t waiting = slc_reports_count(m);
    if (!tiles) {
        *count = waiting;
        return SLUICE_SUCCESS;
    }
    *count = slc_reports_take(m, *count, tiles);
    return *count < waiting ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

SluiceResult sluiceGetGivenUpTiles(SluiceStreamedTextureManager *manager, uint32_t *pTileCount,
                                   SluiceTile *pTiles)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_call call = {.kind = SLC_CALL_GET_GIVEN_UP, .query = !pTiles, .tiles = pTiles};
    if (!pTileCount) {
        call.result = SLUICE_ERROR_NULL_POINTER;
    } else {
        call.room = *pTileCount;
        call.result = get_given_up_tiles(manager, pTileCount, pTiles);
        call.count = *pTileCount;
    }
    slc_notify(manager, &call);
    return call.result;
}
