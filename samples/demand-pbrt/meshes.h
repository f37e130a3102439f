/** Meshes in memory: one for each PLY file and for each mesh in the text, however often placed. */
#ifndef DEMAND_PBRT_MESHES_H
#define DEMAND_PBRT_MESHES_H

#include "mesh_reader.h"
#include "mesh_tree.h"
#include "pbrt_shared.h"
#include "scene.h"
#include "structures.h"
#include "table.h"

enum mesh_state { MESH_ABSENT, MESH_BUILT, MESH_FAILED };

struct mesh {
    enum mesh_state state;
    uint32_t shape; ///< one of those that have it
    uint32_t triangle_count;
    uint32_t built_at;    ///< launch
    uint32_t used_at;     ///< last launch that built it or hit it, as far as it was looked up
    bool leaves;          ///< is being evicted
    uint32_t place_count; ///< shapes in the world that use it now
    struct arena_part data;
    struct structure structure;
    struct mesh_tree tree; ///< of the compute path
};

/** Zeroed is empty. */
struct meshes {
    struct mesh *items; ///< owned
    uint32_t count;
    uint32_t *of_shape; ///< owned; mesh of each shape
    struct mesh_reader *reader;
    struct arena data;
    uint64_t size;      ///< bytes of all meshes on the device
    struct table table; ///< struct PbrtMesh by mesh
    bool says_what_it_reads;
    bool uncompacted; ///< structures stay as they were built
    /* Since the beginning. */
    uint64_t built_count, evicted_count, triangle_count, bytes_read, failed_count;
    uint64_t normal_count, uv_count;
    double read_seconds; ///< of all threads together
    double build_seconds;
};

/** Says on stderr why it failed. */
bool meshes_create(const struct gpu *gpu, const struct scene *scene, uint32_t thread_count,
                   struct meshes *meshes);
void meshes_finish(const struct gpu *gpu, struct structures *structures, struct meshes *meshes);

/**
 * Reads and builds meshes that are absent; no two are equal. A mesh that cannot be read, or for
 * which there is no memory, becomes MESH_FAILED, and stderr says why. False if nothing can go on.
 */
bool meshes_build(const struct gpu *gpu, const struct scene *scene, struct structures *structures,
                  struct meshes *meshes, const uint32_t *which, uint32_t count, uint32_t launch);
/** Whether a mesh need not be read from its file any more; if it must, that begins. */
bool meshes_fetch(struct meshes *meshes, uint32_t index);
/** Device memory of a mesh. */
uint64_t meshes_size_of(const struct mesh *mesh);
/** Makes a mesh absent. No launch is under way. */
void meshes_evict(const struct gpu *gpu, struct structures *structures, struct meshes *meshes,
                  uint32_t index);

#endif /* DEMAND_PBRT_MESHES_H */
