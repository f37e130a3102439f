/* Eviction of requested tiles: "Evicting" in docs/manager-specification.md. */
#include "core/naive_manager.h"

#include <stdlib.h>

enum { MAX_LOOKED_AT = 1024 };

/* Number of tiles that a call may still examine, in total and per level. */
struct looks {
    uint32_t all;
    uint32_t of_level[SLUICE_MAX_MIP_LEVELS];
};

/* Returns the first MAPPED regular tile of a level in eviction order. */
static struct naive_ref first_mapped(const struct naive_manager *n, uint32_t level)
{
    uint32_t count;
    struct naive_ref first = {0};
    struct naive_ref *refs = naive_collect(n, NULL, SLUICE_TILE_STATE_MAPPED, &count);
    for (uint32_t i = 0; i < count; i++) {
        const struct naive_tile *tile = refs[i].tile;
        if (!tile->packed && tile->level == level &&
            (!first.tile || tile->mapped_at < first.tile->mapped_at))
            first = refs[i];
    }
    free(refs);
    return first;
}

static struct naive_tile *finest_mapped(const struct naive_manager *n, uint32_t end)
{
    for (uint32_t level = 0; level < end; level++) {
        struct naive_tile *tile = first_mapped(n, level).tile;
        if (tile)
            return tile;
    }
    return NULL;
}

static bool are_neighbors(uint32_t a, uint32_t b)
{
    return a == b || a + 1 == b || b + 1 == a;
}

static bool is_seen(const struct naive_manager *n, const struct naive_ref *ref)
{
    const struct naive_texture *t = ref->texture;
    if (!naive_would_believe(n, t, 18, ref->tile->level))
        return true;
    for (uint32_t i = 0; i < t->layout.regularTileCount; i++) {
        const struct naive_tile *tile = &t->tiles[i];
        if (tile->level == ref->tile->level && are_neighbors(tile->x, ref->tile->x) &&
            are_neighbors(tile->y, ref->tile->y) && t->last_wishes[i] <= tile->level)
            return true;
    }
    return false;
}

static struct naive_tile *find_unseen(struct naive_manager *n, struct looks *looks, uint32_t end)
{
    for (uint32_t level = 0; level < end && level < SLUICE_MAX_MIP_LEVELS; level++)
        while (looks->of_level[level] > 0 && looks->all > 0) {
            struct naive_ref first = first_mapped(n, level);
            looks->of_level[level]--;
            if (!is_seen(n, &first))
                return first.tile;
            looks->all--;
            first.tile->mapped_at = ++n->stamp; /* behind the others */
        }
    return NULL;
}

static struct looks begin_looks(const struct naive_manager *n)
{
    struct looks looks = {.all = MAX_LOOKED_AT};
    uint32_t count;
    struct naive_ref *refs = naive_collect(n, NULL, SLUICE_TILE_STATE_MAPPED, &count);
    for (uint32_t i = 0; i < count; i++)
        looks.of_level[refs[i].tile->level] += !refs[i].tile->packed;
    free(refs);
    return looks;
}

static uint32_t count_mapped(const struct naive_manager *n, uint32_t level)
{
    uint32_t count, found = 0;
    struct naive_ref *refs = naive_collect(n, NULL, SLUICE_TILE_STATE_MAPPED, &count);
    for (uint32_t i = 0; i < count; i++)
        found += !refs[i].tile->packed && refs[i].tile->level == level;
    free(refs);
    return found;
}

static void evict(struct naive_manager *n, struct looks *looks, struct naive_tile *tile)
{
    naive_evict(n, tile);
    const uint32_t left = count_mapped(n, tile->level);
    if (looks->of_level[tile->level] > left)
        looks->of_level[tile->level] = left;
}

/* Returns the tile to evict for a request, or NULL. */
static struct naive_tile *find_for(struct naive_manager *n, struct looks *looks,
                                   const struct naive_tile *request)
{
    if (request->packed)
        return finest_mapped(n, SLUICE_MAX_MIP_LEVELS);
    const bool waited = request->requested_at <= n->round.waited;
    const bool waited_long = request->requested_at <= n->round.waited_long;
    struct naive_tile *unseen = find_unseen(n, looks, request->level + (waited ? 1 : 0));
    n->events[NAIVE_UNSEEN_EVICTED] += unseen != NULL;
    if (unseen)
        return unseen;
    const uint32_t gap = waited_long ? 1 : waited ? 2 : 3;
    struct naive_tile *tile =
        request->level >= gap ? finest_mapped(n, request->level - gap + 1) : NULL;
    n->events[NAIVE_SEEN_EVICTED] += tile != NULL;
    n->events[NAIVE_LONG_WAITED] += tile && tile->level + 1 == request->level;
    return tile;
}

void naive_evict_for(struct naive_manager *n, const struct naive_ref *refs, uint32_t count,
                     uint32_t unserved)
{
    uint32_t listed, unlisted;
    naive_count_standby(n, &listed, &unlisted);
    struct looks looks = begin_looks(n);
    uint64_t coming = (uint64_t)listed + naive_count_all(n, NAIVE_SLOT_RETIRING);
    const uint32_t reserved = naive_kept(n), free_slots = naive_count_all(n, NAIVE_SLOT_FREE);
    for (; free_slots + coming < reserved; coming++) {
        struct naive_tile *tile = finest_mapped(n, SLUICE_MAX_MIP_LEVELS);
        if (!tile)
            return;
        evict(n, &looks, tile);
    }
    coming -= free_slots < reserved ? reserved - free_slots : 0;
    for (uint32_t i = 0; i < count && i < NAIVE_MAX_PASSED_OVER && unserved > 0; i++) {
        if (naive_is_passed_over(n, &refs[i]))
            continue;
        unserved--;
        if (coming > 0) {
            coming--;
            continue;
        }
        struct naive_tile *tile = find_for(n, &looks, refs[i].tile);
        if (!tile)
            return;
        evict(n, &looks, tile);
    }
}
