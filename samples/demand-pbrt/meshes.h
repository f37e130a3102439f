/** Meshes in memory: one for each PLY file and for each mesh in the text, however often placed. */
#ifndef DEMAND_PBRT_MESHES_H
#define DEMAND_PBRT_MESHES_H

#include "build_batch.h"
#include "mesh_reader.h"
#include "mesh_tree.h"
#include "pbrt_shared.h"
#include "scene.h"
#include "structures.h"
#include "table.h"

enum mesh_state { MESH_ABSENT, MESH_BUILDING, MESH_BUILT, MESH_FAILED };

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

/** Meshes and their builds: a mesh that the compute path traces has none. */
struct mesh_list {
    uint32_t *items;                ///< owned
    struct structure_build *builds; ///< owned
    uint32_t count, room, build_count;
};

/** Who reads the meshes of a device. */
struct mesh_reading {
    struct mesh_cache *cache; ///< of all devices
    uint32_t device, thread_count;
};

/** Zeroed is empty. */
struct meshes {
    struct mesh *items; ///< owned
    uint32_t count;
    uint32_t *of_shape; ///< owned; mesh of each shape
    struct mesh_reader *reader;
    struct mesh_list waiting, building; ///< MESH_BUILDING: read, and in the batch
    struct build_batch batch;
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
bool meshes_create(const struct gpu *gpu, const struct scene *scene,
                   const struct mesh_reading *reading, struct meshes *meshes);
void meshes_finish(const struct gpu *gpu, struct structures *structures, struct meshes *meshes);

/**
 * Reads and builds meshes that are absent; no two are equal. A mesh that cannot be read, or for
 * which there is no memory, becomes MESH_FAILED, and stderr says why. False if nothing can go on.
 */
bool meshes_build(const struct gpu *gpu, const struct scene *scene, struct structures *structures,
                  struct meshes *meshes, const uint32_t *which, uint32_t count, uint32_t launch);
/** Reads an absent mesh, which waits then for meshes_begin. */
bool meshes_prepare(const struct gpu *gpu, const struct scene *scene, struct meshes *meshes,
                    uint32_t index);
/** Begins to build what waits, unless a batch is under way; meshes_continue ends that. */
bool meshes_begin(const struct gpu *gpu, struct structures *structures, struct meshes *meshes);
/** Meshes of a batch that has ended are built, for the launch with that number. `waits` until it
 *  has. No launch is under way. Says on stderr why it failed. */
bool meshes_continue(const struct gpu *gpu, struct structures *structures, struct meshes *meshes,
                     uint32_t launch, bool waits);

enum mesh_fetch { MESH_IS_READ_LATER, MESH_IS_READ, MESH_IS_BUILT_LATER, MESH_IS_THERE };
/** How far a mesh is; if it must be read, that begins. */
enum mesh_fetch meshes_fetch(struct meshes *meshes, uint32_t index);
/** Device memory of a mesh. */
uint64_t meshes_size_of(const struct mesh *mesh);
/** Makes a mesh absent. No launch is under way. */
void meshes_evict(const struct gpu *gpu, struct structures *structures, struct meshes *meshes,
                  uint32_t index);

#endif /* DEMAND_PBRT_MESHES_H */
