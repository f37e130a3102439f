/* Memory of nodes. */
#include "residency/nodes.h"

#include "base/alloc.h"

static bool add_node_chunk(struct slc_machine *r)
{
    if (r->node_chunk_count == SLC_MAX_NODES / SLC_NODES_PER_CHUNK)
        return false;
    if (r->node_chunk_count == r->node_chunk_room) {
        uint32_t room = r->node_chunk_room ? r->node_chunk_room * 2 : 16;
        struct slc_node **chunks =
            slc_regrow(r->cb, r->node_chunks, r->node_chunk_room, room, sizeof *chunks);
        if (!chunks)
            return false;
        r->node_chunks = chunks;
        r->node_chunk_room = room;
    }
    struct slc_node *chunk = slc_alloc(r->cb, SLC_NODES_PER_CHUNK, sizeof *chunk);
    if (!chunk)
        return false;
    r->node_chunks[r->node_chunk_count++] = chunk;
    return true;
}

bool slc_reserve_nodes(struct slc_machine *r, uint64_t count)
{
    uint32_t before = r->node_chunk_count;
    while (count > (uint64_t)r->free_node_count +
                       (r->node_chunk_count * SLC_NODES_PER_CHUNK - r->node_end)) {
        if (add_node_chunk(r))
            continue;
        /* keeps no chunks of a reservation that failed */
        while (r->node_chunk_count > before)
            slc_free(r->cb, r->node_chunks[--r->node_chunk_count], SLC_NODES_PER_CHUNK,
                     sizeof(struct slc_node));
        return false;
    }
    return true;
}

uint32_t slc_nodes_take(struct slc_machine *r)
{
    uint32_t node = r->free_node;
    if (node) {
        r->free_node = slc_node_at(r, node)->next;
        r->free_node_count--;
        return node;
    }
    assert(r->node_end / SLC_NODES_PER_CHUNK < r->node_chunk_count); /* reserved before */
    return r->node_end++;
}

void slc_nodes_give(struct slc_machine *r, uint32_t node)
{
    slc_node_at(r, node)->next = r->free_node;
    slc_node_at(r, node)->owner = SLC_NONE;
    slc_node_at(r, node)->state = SLUICE_TILE_STATE_FREE;
    r->free_node = node;
    r->free_node_count++;
}

void slc_nodes_finish(struct slc_machine *r)
{
    for (uint32_t i = 0; i < r->node_chunk_count; i++)
        slc_free(r->cb, r->node_chunks[i], SLC_NODES_PER_CHUNK, sizeof(struct slc_node));
    slc_free(r->cb, r->node_chunks, r->node_chunk_room, sizeof *r->node_chunks);
}
