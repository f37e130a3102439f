#include "mesh_cache.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

#include "../../tools/common/clock.h"

/** A mesh in memory, or being read. */
struct kept {
    struct mesh_read read;
    bool is_there;              ///< false: a thread is reading it
    uint32_t user_count;        ///< readers that have not given it back
    uint64_t had;               ///< bit mask of devices that have given it back
    struct kept *older, *newer; ///< links in the list of meshes without users
};

struct mesh_cache {
    const struct scene *scene;
    uint64_t all;          ///< bit mask of all devices
    uint64_t most_kept;    ///< bytes
    pthread_mutex_t mutex; ///< guards all fields below
    pthread_cond_t done;
    struct kept **kept; ///< owned, with its elements; by shape
    struct kept *oldest,
        *newest;   ///< meshes without users, ordered by when their last user gave them back
    uint64_t size; ///< bytes of meshes in memory
    uint64_t read_count, shared_count;
};

struct mesh_cache *mesh_cache_create(const struct scene *scene, uint32_t device_count,
                                     uint64_t most_kept)
{
    struct mesh_cache *c = calloc(1, sizeof *c);
    if (c)
        c->kept = calloc(scene->info.shapeCount + 1u, sizeof(struct kept *));
    if (!c || !c->kept) {
        fprintf(stderr, "out of memory\n");
        free(c);
        return NULL;
    }
    c->scene = scene;
    c->most_kept = most_kept;
    c->all = device_count < 64 ? ((uint64_t)1 << device_count) - 1 : UINT64_MAX;
    pthread_mutex_init(&c->mutex, NULL);
    pthread_cond_init(&c->done, NULL);
    return c;
}

static uint64_t size_of(const SluicePbrtMesh *mesh)
{
    const uint64_t words = 3u + (mesh->pNormals ? 3u : 0) + (mesh->pUvs ? 2u : 0);
    return 4 * (words * mesh->vertexCount + 3 * (uint64_t)mesh->triangleCount);
}

static void drop(struct mesh_cache *c, uint32_t shape)
{
    struct kept *kept = c->kept[shape];
    c->size -= size_of(&kept->read.mesh);
    (void)sluiceFreePbrtMesh(c->scene->pbrt, &kept->read.mesh);
    free(kept);
    c->kept[shape] = NULL;
}

static void add_unused(struct mesh_cache *c, struct kept *kept)
{
    kept->older = c->newest;
    kept->newer = NULL;
    *(c->newest ? &c->newest->newer : &c->oldest) = kept;
    c->newest = kept;
}

static void remove_unused(struct mesh_cache *c, struct kept *kept)
{
    *(kept->older ? &kept->older->newer : &c->oldest) = kept->newer;
    *(kept->newer ? &kept->newer->older : &c->newest) = kept->older;
}

/* Some devices never read a mesh that others have read. Such a mesh stays until newer meshes need
 * room. */
static void drop_oldest(struct mesh_cache *c)
{
    while (c->size > c->most_kept && c->oldest) {
        struct kept *kept = c->oldest;
        remove_unused(c, kept);
        drop(c, kept->read.shape);
    }
}

void mesh_cache_destroy(struct mesh_cache *c)
{
    if (!c)
        return;
    for (uint32_t i = 0; i < c->scene->info.shapeCount; i++)
        if (c->kept[i])
            drop(c, i);
    pthread_cond_destroy(&c->done);
    pthread_mutex_destroy(&c->mutex);
    free(c->kept);
    free(c);
}

static void read_shape(const struct scene *scene, uint32_t shape, struct mesh_read *read)
{
    const double start = clock_seconds();
    *read = (struct mesh_read){.mesh.structSize = sizeof read->mesh, .shape = shape};
    read->result = sluiceReadPbrtShape(scene->pbrt, shape, &read->mesh);
    read->seconds = clock_seconds() - start;
}

/** Releases the mutex while reading. The caller holds it. */
static void read_unlocked(struct mesh_cache *c, uint32_t shape, struct mesh_read *read)
{
    pthread_mutex_unlock(&c->mutex);
    read_shape(c->scene, shape, read);
    pthread_mutex_lock(&c->mutex);
    c->read_count++;
}

/** Reads for the first caller. The mutex is held. */
static void read_and_keep(struct mesh_cache *c, uint32_t shape, struct mesh_read *read)
{
    struct kept *kept = calloc(1, sizeof *kept);
    if (!kept) { /* not cached; this caller frees it */
        read_unlocked(c, shape, read);
        return;
    }
    c->kept[shape] = kept;
    kept->user_count = 1;
    read_unlocked(c, shape, &kept->read);
    kept->is_there = true;
    kept->read.is_kept = true;
    c->size += size_of(&kept->read.mesh);
    *read = kept->read;
    pthread_cond_broadcast(&c->done);
}

void mesh_cache_read(struct mesh_cache *c, uint32_t shape, struct mesh_read *read)
{
    pthread_mutex_lock(&c->mutex);
    struct kept *kept = c->kept[shape];
    if (c->all == 1) {
        read_unlocked(c, shape, read);
    } else if (!kept) {
        read_and_keep(c, shape, read);
    } else {
        if (kept->user_count++ == 0)
            remove_unused(c, kept);
        while (!kept->is_there)
            pthread_cond_wait(&c->done, &c->mutex);
        *read = kept->read;
        read->seconds = 0.0;
        c->shared_count++;
    }
    pthread_mutex_unlock(&c->mutex);
}

void mesh_cache_give(struct mesh_cache *c, uint32_t device, struct mesh_read *read)
{
    pthread_mutex_lock(&c->mutex);
    struct kept *kept = c->kept[read->shape];
    if (read->is_kept) {
        kept->had |= (uint64_t)1 << device;
        if (--kept->user_count == 0 && kept->had == c->all)
            drop(c, read->shape);
        else if (kept->user_count == 0)
            add_unused(c, kept);
        drop_oldest(c);
    } else {
        (void)sluiceFreePbrtMesh(c->scene->pbrt, &read->mesh);
    }
    pthread_mutex_unlock(&c->mutex);
}

void mesh_cache_get_counts(struct mesh_cache *c, uint64_t *read_count, uint64_t *shared_count)
{
    pthread_mutex_lock(&c->mutex);
    *read_count = c->read_count;
    *shared_count = c->shared_count;
    pthread_mutex_unlock(&c->mutex);
}
