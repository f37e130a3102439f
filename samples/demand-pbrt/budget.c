#include "budget.h"

#include <stdio.h>
#include <stdlib.h>

struct candidate {
    uint32_t used_at, index;
};

static int compare(const void *a, const void *b)
{
    const struct candidate *x = a, *y = b;
    if (x->used_at != y->used_at)
        return x->used_at < y->used_at ? -1 : 1;
    return x->index < y->index ? -1 : x->index > y->index;
}

/* Updates the last use of meshes. Shaders note the last launch that hit a place. */
static void find_last_uses(struct world *w)
{
    for (uint32_t i = 0; i < w->place_count; i++) {
        const uint32_t used = *(const uint32_t *)table_at(&w->used, i);
        struct mesh *mesh = &w->meshes.items[w->places[i].mesh];
        if (w->places[i].live && used > mesh->used_at)
            mesh->used_at = used;
    }
}

static uint32_t list_candidates(const struct world *w, uint32_t launch, struct candidate *list,
                                uint64_t *kept)
{
    uint32_t count = 0;
    *kept = 0;
    for (uint32_t i = 0; i < w->meshes.count; i++) {
        const struct mesh *mesh = &w->meshes.items[i];
        if (mesh->state != MESH_BUILT || mesh->leaves)
            continue;
        *kept += meshes_size_of(mesh);
        if (mesh->built_at != launch)
            list[count++] = (struct candidate){mesh->used_at, i};
    }
    return count;
}

bool budget_make_room(struct world *w, uint32_t launch, bool *fits)
{
    uint64_t kept;
    struct candidate *list = malloc((w->meshes.count + 1u) * sizeof *list);
    if (!list) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    find_last_uses(w);
    const uint32_t count = list_candidates(w, launch, list, &kept);
    qsort(list, count, sizeof *list, compare);
    for (uint32_t i = 0; i < count && kept > w->budget; i++) {
        struct mesh *mesh = &w->meshes.items[list[i].index];
        mesh->leaves = true;
        kept -= meshes_size_of(mesh);
    }
    free(list);
    *fits = kept <= w->budget;
    return true;
}

static void note_use(const struct surfaces *s, uint32_t *used_at, uint32_t surface, uint32_t launch)
{
    if (surface < s->table.count && used_at[surface] < launch)
        used_at[surface] = launch;
}

/* Updates the last use of materials and alphas from the places that were hit. */
static void find_last_surfaces(const struct world *w, struct surfaces *s, uint32_t *used_at)
{
    for (uint32_t i = 0; i < w->place_count; i++) {
        const struct PbrtPlace *place = table_at(&w->place_table, i);
        const uint32_t launch = *(const uint32_t *)table_at(&w->used, i);
        note_use(s, used_at, place->surface, launch);
        note_use(s, used_at, place->alpha, launch);
    }
    for (uint32_t i = 0; i < s->made_count; i++)
        if (s->made[i].used_at < used_at[s->made[i].index])
            s->made[i].used_at = used_at[s->made[i].index];
}

/** Marks the least recently used surfaces until the rest fits. Returns the size of the rest. */
static uint64_t mark_surfaces(struct surfaces *s, uint32_t launch, struct candidate *list)
{
    const uint64_t goal =
        s->budget - s->budget / 8; /* free an eighth, so that not every new surface evicts others */
    uint64_t kept = surfaces_size(s);
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->made_count; i++)
        if (s->made[i].made_at != launch)
            list[count++] = (struct candidate){s->made[i].used_at, i};
    qsort(list, count, sizeof *list, compare);
    for (uint32_t i = 0; i < count && kept > goal; i++) {
        struct made_surface *made = &s->made[list[i].index];
        made->leaves = true;
        kept -= (uint64_t)made->op_count * s->ops.element;
    }
    return kept;
}

bool budget_make_surface_room(const struct world *w, struct surfaces *s, uint32_t launch,
                              bool *fits)
{
    *fits = true;
    if (s->budget == 0 || surfaces_size(s) <= s->budget)
        return true;
    uint32_t *used_at = calloc(s->table.count + 1u, sizeof *used_at);
    struct candidate *list = malloc((s->made_count + 1u) * sizeof *list);
    if (used_at && list) {
        find_last_surfaces(w, s, used_at);
        *fits = mark_surfaces(s, launch, list) <= s->budget;
        surfaces_evict(s);
    } else {
        fprintf(stderr, "out of memory\n");
    }
    const bool done = used_at && list;
    free(used_at);
    free(list);
    return done;
}
