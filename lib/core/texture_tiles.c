#include "core/texture_tiles.h"

#include "core/given_up.h"
#include "core/minmip.h"
#include "residency/node.h"

static void tile_requested(void *user, uint32_t owner, bool now)
{
    slc_texture_at(user, owner)->requested_count += now ? 1 : UINT32_MAX;
}

static void tile_resident(void *user, const struct slc_node *n, bool now)
{
    slc_min_mip_changed(user, slc_texture_at(user, n->owner), n, now);
}

static void tile_given_up(void *user, uint32_t node, bool now)
{
    if (now)
        slc_given_up_enter(user, node);
    else
        slc_given_up_leave(user, node);
}

static void tile_released(void *user, const struct slc_node *n)
{
    struct slc_managed_texture *t = slc_texture_at(user, n->owner);
    *slc_node_cell(t, n->tile) = 0;
    t->regular_nodes -= !slc_is_packed_class(n->level);
}

struct slc_machine_user slc_tiles_user(slc_manager *m)
{
    return (struct slc_machine_user){
        m, tile_requested, tile_resident, tile_given_up, tile_released, NULL, NULL};
}

void slc_tile_requested(slc_manager *m, struct slc_managed_texture *t, uint32_t *cell,
                        uint32_t tile, uint32_t level, uint32_t need)
{
    *cell = slc_node_request(&m->residency, t->index, tile, level, need);
    t->regular_nodes += !slc_is_packed_class(level);
}

void slc_tile_wanted(slc_manager *m, struct slc_managed_texture *t, uint32_t *cell, uint32_t tile,
                     uint32_t level)
{
    uint32_t node = *cell & ~SLC_RESIDENT;
    if (node)
        slc_node_wanted(&m->residency, node);
    else
        slc_tile_requested(m, t, cell, tile, level, 0);
}

void slc_packed_tiles_wanted(slc_manager *m, struct slc_managed_texture *t)
{
    uint32_t count = t->shape->desc.packedTileCount, first = t->shape->regular_tile_count;
    for (uint32_t i = 0; i < count; i++)
        slc_tile_wanted(m, t, &t->packed_nodes[i], first + i, slc_packed_class(t));
}

void slc_packed_tiles_unwanted(slc_manager *m, struct slc_managed_texture *t)
{
    uint32_t count = t->shape->desc.packedTileCount;
    for (uint32_t i = 0; i < count; i++)
        slc_node_unwanted(&m->residency, t->packed_nodes[i]);
}

uint32_t slc_tile_prefetch(slc_manager *m, struct slc_managed_texture *t, uint32_t tile,
                           uint32_t level)
{
    t->regular_nodes++;
    return t->nodes[tile] = slc_node_prefetch(&m->residency, t->index, tile, level);
}

SluiceTile slc_node_tile(const slc_manager *m, uint32_t node)
{
    const struct slc_node *n = slc_node_at(&m->residency, node);
    const struct slc_managed_texture *t = slc_texture_at(m, n->owner);
    struct slc_place place = slc_node_place(t, n);
    bool placed = n->heap != SLC_NONE;
    return (SluiceTile){
        .textureId = slc_texture_id(t),
        .tileIndex = n->tile,
        .mipLevel = place.level,
        .x = place.x,
        .y = place.y,
        .heapId = placed ? m->residency.heaps.heaps[n->heap].id : 0,
        .slot = placed ? n->slot : 0,
    };
}
