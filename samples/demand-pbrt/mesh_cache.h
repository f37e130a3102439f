/** A cache that reads meshes once for all devices. */
#ifndef DEMAND_PBRT_MESH_CACHE_H
#define DEMAND_PBRT_MESH_CACHE_H

#include "scene.h"

/** A mesh that was read. */
struct mesh_read {
    SluiceResult result;
    SluicePbrtMesh mesh;
    uint32_t shape;
    double seconds; ///< time of the reading thread; 0: another device had read it
    bool is_kept;   ///< true: in the cache
};

/** Opaque. With one device, the cache keeps nothing. */
struct mesh_cache;

/** Default limit of cached meshes in bytes. */
#define MESH_CACHE_BYTES ((uint64_t)1 << 30)

/** `device_count`: at most 64. `most_kept`: limit of cached meshes in bytes, exceeded only by
 * meshes in use. The scene must outlive the cache. Returns NULL on error and reports it on
 * stderr. */
struct mesh_cache *mesh_cache_create(const struct scene *scene, uint32_t device_count,
                                     uint64_t most_kept);
/** Accepts NULL. All meshes must have been given back. */
void mesh_cache_destroy(struct mesh_cache *cache);

/** Reads the mesh of a shape, gets it from the cache, or waits for the thread that reads it.
 * Thread-safe. */
void mesh_cache_read(struct mesh_cache *cache, uint32_t shape, struct mesh_read *read);
/**
 * Gives a mesh back. Call once per mesh_cache_read, also after an error. The mesh is freed when all
 * devices have given it back. Beyond `most_kept` bytes, meshes are freed in the order in which they
 * were given back. Thread-safe.
 */
void mesh_cache_give(struct mesh_cache *cache, uint32_t device, struct mesh_read *read);

/** Returns the reads of files and of meshes in the scene's text, and the reads that the cache
 * answered. */
void mesh_cache_get_counts(struct mesh_cache *cache, uint64_t *read_count, uint64_t *shared_count);

#endif /* DEMAND_PBRT_MESH_CACHE_H */
