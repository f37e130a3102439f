/* Tiles that are not FREE, in the order of their lists, and the heaps that hold them. */
#include "core/history.h"
#include "core/layout.h"
#include "core/snapshot_parts.h"
#include "core/texture_tiles.h"
#include "residency/due.h"
#include "residency/node.h"
#include "residency/nodes.h"
#include "residency/request_queues.h"

/* Heaps ------------------------------------------------------------------------------------- */

enum { HEAP_DEAD, HEAP_LIVE, HEAP_PACKED };

static uint32_t kind_of(const struct slc_tile_heap *heap)
{
    return heap->free_count == SLC_HEAP_DEAD ? HEAP_DEAD : heap->packed ? HEAP_PACKED : HEAP_LIVE;
}

void slc_snapshot_heaps(slc_manager *m, struct slc_snapshot_io *io)
{
    struct slc_tile_heaps *h = &m->residency.heaps;
    uint32_t count = h->end;
    slc_snapshot_u32(io, &count, (1u << 30) - 1);
    for (uint32_t i = 0; i < count && slc_snapshot_is_good(io); i++) {
        uint32_t kind = io->reading ? 0 : kind_of(&h->heaps[i]);
        uint32_t id = io->reading ? 0 : h->heaps[i].id;
        SluiceResult result = SLUICE_SUCCESS;
        slc_snapshot_u32(io, &kind, HEAP_PACKED);
        if (kind != HEAP_DEAD)
            slc_snapshot_u32(io, &id, UINT32_MAX);
        if (io->reading && slc_snapshot_is_good(io))
            result = kind == HEAP_DEAD ? slc_tile_heaps_restore_dead(h)
                                       : slc_tile_heaps_restore(h, id, kind == HEAP_PACKED);
        if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY)
            io->result = result;
        else if (result != SLUICE_SUCCESS)
            slc_snapshot_fail(io, "two heaps of the snapshot have one id");
    }
    io->part(io->user);
}

/** Exchanges a list of heaps: each index plus 1, then 0. Buckets follow each other in one list. */
static void exchange_heaps(struct slc_tile_heaps *h, struct slc_snapshot_io *io, bool loose)
{
    uint32_t bucket = 0, next = loose ? h->loose : h->buckets[0], behind = UINT32_MAX;
    while (slc_snapshot_is_good(io)) {
        while (!io->reading && !loose && next == UINT32_MAX && bucket < h->capacity)
            next = h->buckets[++bucket];
        uint64_t at = io->reading || next == UINT32_MAX ? 0 : next + UINT64_C(1);
        at = slc_snapshot_number(io, at, UINT32_MAX);
        if (at == 0)
            return;
        uint32_t index = (uint32_t)at - 1;
        if (!io->reading) {
            next = h->heaps[index].next;
            continue;
        }
        if (!loose && behind != UINT32_MAX && index < h->end &&
            h->heaps[index].free_count != h->heaps[behind].free_count)
            behind = UINT32_MAX;
        if (!slc_tile_heaps_restore_order(h, index, behind, loose))
            slc_snapshot_fail(io, "the snapshot has heaps in an order that cannot be");
        behind = index;
    }
}

void slc_snapshot_heap_order(slc_manager *m, struct slc_snapshot_io *io)
{
    struct slc_tile_heaps *h = &m->residency.heaps;
    exchange_heaps(h, io, true);
    exchange_heaps(h, io, false);
    uint64_t open =
        slc_snapshot_number(io, h->open == UINT32_MAX ? 0 : h->open + UINT64_C(1), h->end);
    if (io->reading)
        h->open = open ? (uint32_t)open - 1 : UINT32_MAX;
    if (h->open != UINT32_MAX && !h->heaps[h->open].loose)
        slc_snapshot_fail(io, "the heap of the snapshot that slots are taken from is in a bucket");
    io->part(io->user);
}

/* Tiles ------------------------------------------------------------------------------------- */

/** Marks of tiles, from 1 on; 0 ends the tiles. */
static const struct {
    uint8_t state, flags;
} marks[] = {
    {SLUICE_TILE_STATE_FREE, 0},
    {SLUICE_TILE_STATE_REQUESTED, 0},
    {SLUICE_TILE_STATE_ALLOCATED, 0},
    {SLUICE_TILE_STATE_MAPPED, 0},
    {SLUICE_TILE_STATE_STANDBY, 0},
    {SLUICE_TILE_STATE_STANDBY, SLC_NODE_LISTED},
    {SLUICE_TILE_STATE_STANDBY, SLC_NODE_LISTED | SLC_NODE_WANTED},
    {SLUICE_TILE_STATE_CANCELED, 0},
    {SLUICE_TILE_STATE_CANCELED, SLC_NODE_LISTED},
    {SLUICE_TILE_STATE_CANCELED, SLC_NODE_LISTED | SLC_NODE_WANTED},
    {SLUICE_TILE_STATE_FAILED, 0},
    {SLUICE_TILE_STATE_GIVEN_UP, 0},
    {SLC_NODE_RETIRING, 0},
};

enum { MARK_COUNT = sizeof marks / sizeof *marks };

static uint32_t mark_of(const struct slc_node *n)
{
    for (uint32_t i = 1; i < MARK_COUNT; i++)
        if (marks[i].state == n->state && marks[i].flags == n->flags)
            return i;
    return 0;
}

static bool has_slot(const struct slc_node *n)
{
    return n->level != SLC_OUTSIDE_CLASS &&
           (n->state == SLUICE_TILE_STATE_ALLOCATED || n->state == SLUICE_TILE_STATE_CANCELED ||
            n->state == SLUICE_TILE_STATE_MAPPED || n->state == SLUICE_TILE_STATE_STANDBY ||
            n->state == SLC_NODE_RETIRING);
}

/** Makes the memory for a tile in its texture. Returns the cell for the node; NULL after an error.
 */
static uint32_t *restore_cell(slc_manager *m, struct slc_snapshot_io *io, struct slc_node *n)
{
    struct slc_managed_texture *t = slc_snapshot_texture(m, io, n->owner);
    if (!t || n->tile >= t->shape->tile_count) {
        slc_snapshot_fail(io, "the snapshot has a tile that its texture lacks");
        return NULL;
    }
    bool regular = n->tile < t->shape->regular_tile_count;
    n->level = (uint8_t)(regular ? slc_tile_place(t, n->tile).level : slc_packed_class(t));
    if (regular)
        io->result = slc_state_make(m, t);
    if (!slc_snapshot_is_good(io))
        return NULL;
    uint32_t *cell = slc_node_cell(t, n->tile);
    if (*cell) {
        slc_snapshot_fail(io, "the snapshot has a tile twice");
        return NULL;
    }
    t->regular_nodes += regular;
    return cell;
}

static void restore_tile(slc_manager *m, struct slc_snapshot_io *io, const struct slc_node *n,
                         uint32_t *cell)
{
    if (!slc_snapshot_is_good(io))
        return;
    if (!slc_reserve_nodes(&m->residency, 1))
        io->result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    else if (!slc_node_restore(&m->residency, n, cell))
        slc_snapshot_fail(io, "the snapshot has a tile whose slot is another's or not there");
}

/** Exchanges one tile. Returns false at the end of the tiles. */
static bool exchange_tile(slc_manager *m, struct slc_snapshot_io *io, const struct slc_node *from)
{
    struct slc_node n = from ? *from : (struct slc_node){.heap = SLC_NONE};
    uint64_t mark = slc_snapshot_number(io, from ? mark_of(from) : 0, MARK_COUNT - 1);
    if (mark == 0)
        return false;
    uint32_t *cell = NULL;
    n.state = marks[mark].state;
    n.flags = marks[mark].flags;
    if (n.state == SLC_NODE_RETIRING) {
        n.owner = SLC_NONE;
    } else {
        slc_snapshot_u32(io, &n.owner, UINT32_MAX);
        slc_snapshot_u32(io, &n.tile, UINT32_MAX);
        slc_snapshot_u32(io, &n.failures, UINT32_MAX);
        slc_snapshot_u8(io, &n.need, SLC_REQUEST_NEEDS - 1);
        if (io->reading && slc_snapshot_is_good(io))
            cell = restore_cell(m, io, &n);
    }
    if (n.state != SLUICE_TILE_STATE_GIVEN_UP)
        slc_snapshot_u64(io, &n.order);
    if (has_slot(&n)) {
        slc_snapshot_u32(io, &n.heap, UINT32_MAX - 1);
        slc_snapshot_u32(io, &n.slot, UINT32_MAX);
    }
    if (io->reading)
        restore_tile(m, io, &n, cell);
    io->part(io->user);
    return slc_snapshot_is_good(io);
}

static void write_list(slc_manager *m, struct slc_snapshot_io *io, const struct slc_list *list)
{
    for (uint32_t node = list->head; node; node = slc_node_at(&m->residency, node)->next)
        exchange_tile(m, io, slc_node_at(&m->residency, node));
}

/** Writes tiles that are in no list: ALLOCATED, packed MAPPED, and CANCELED ones once handed out.
 */
static void write_unlisted(slc_manager *m, struct slc_snapshot_io *io)
{
    for (uint32_t node = 1; node < m->residency.node_end; node++) {
        const struct slc_node *n = slc_node_at(&m->residency, node);
        if (n->state == SLUICE_TILE_STATE_ALLOCATED ||
            (n->state == SLUICE_TILE_STATE_CANCELED && n->flags & SLC_NODE_LISTED) ||
            (n->state == SLUICE_TILE_STATE_MAPPED && slc_is_packed_class(n->level)))
            exchange_tile(m, io, n);
    }
}

static void write_tiles(slc_manager *m, struct slc_snapshot_io *io)
{
    const struct slc_machine *r = &m->residency;
    for (uint32_t node = slc_first_request(r); node; node = slc_next_request(r, node))
        exchange_tile(m, io, slc_node_at(r, node));
    for (uint32_t l = 0; l < SLUICE_MAX_MIP_LEVELS; l++)
        write_list(m, io, &r->mapped[l]);
    write_list(m, io, &r->standby);
    write_list(m, io, &r->standby_outside);
    write_list(m, io, &r->evicted);
    write_list(m, io, &r->canceled);
    write_list(m, io, &r->given_up);
    write_list(m, io, &r->retiring);
    for (uint32_t node = slc_due_first(r); node; node = slc_due_next(r, node))
        exchange_tile(m, io, slc_node_at(r, node));
    write_unlisted(m, io);
    exchange_tile(m, io, NULL);
}

void slc_snapshot_tiles(slc_manager *m, struct slc_snapshot_io *io)
{
    if (!io->reading)
        write_tiles(m, io);
    else
        while (exchange_tile(m, io, NULL))
            ;
}
