#include "budget.h"

#include <stdio.h>
#include <stdlib.h>

struct candidate {
    uint32_t used_at, mesh;
};

static int compare(const void *a, const void *b)
{
    const struct candidate *x = a, *y = b;
    if (x->used_at != y->used_at)
        return x->used_at < y->used_at ? -1 : 1;
    return x->mesh < y->mesh ? -1 : x->mesh > y->mesh;
}

/* Shaders note the last launch that hit a place. */
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
        struct mesh *mesh = &w->meshes.items[list[i].mesh];
        mesh->leaves = true;
        kept -= meshes_size_of(mesh);
    }
    free(list);
    *fits = kept <= w->budget;
    return true;
}
