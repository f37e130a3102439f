/** Meshes that are read once for all devices. */
#ifndef DEMAND_PBRT_MESH_CACHE_H
#define DEMAND_PBRT_MESH_CACHE_H

#include "scene.h"

/** Counts of reads. */
struct mesh_read {
    SluiceResult result;
    SluicePbrtMesh mesh;
    uint32_t shape;
    double seconds; ///< of the thread; 0: another device had read it
    bool is_kept;   ///< in the cache
};

/** Opaque. With one device nothing is kept. */
struct mesh_cache;

/** Bytes of meshes in memory that programs allow. */
#define MESH_CACHE_BYTES ((uint64_t)1 << 30)

/** `device_count`: at most 64. `most_kept`: bytes of meshes in memory, unless more are in use. The
 *  scene outlives the cache. Says on stderr why it failed; NULL then. */
struct mesh_cache *mesh_cache_create(const struct scene *scene, uint32_t device_count,
                                     uint64_t most_kept);
/** NULL is fine. All meshes were given back. */
void mesh_cache_destroy(struct mesh_cache *cache);

/** Reads the mesh of a shape, or gets it from memory, or waits for the thread that reads it. Any
 *  thread. */
void mesh_cache_read(struct mesh_cache *cache, uint32_t shape, struct mesh_read *read);
/**
 * Gives a mesh back, once for each call of mesh_cache_read, also after an error. It is freed when
 * all devices have given it back. Beyond `most_kept` bytes the mesh that was given back first is
 * freed first. Any thread.
 */
void mesh_cache_give(struct mesh_cache *cache, uint32_t device, struct mesh_read *read);

/** Files and meshes of the text read so far, and reads that needed none. */
void mesh_cache_get_counts(struct mesh_cache *cache, uint64_t *read_count, uint64_t *shared_count);

#endif /* DEMAND_PBRT_MESH_CACHE_H */
