/** Meshes in device memory: one per PLY file and per mesh in the text, shared by all its shapes. */
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
    uint32_t shape; ///< one of the shapes that use the mesh
    uint32_t triangle_count;
    uint32_t built_at;    ///< launch that built the mesh
    uint32_t used_at;     ///< last launch known to have built or hit the mesh
    bool leaves;          ///< true: being evicted
    uint32_t place_count; ///< shapes in the world that use the mesh
    struct arena_part data;
    struct structure structure;
    struct mesh_tree tree; ///< tree of the compute path
};

/** Meshes and their builds. Meshes of the compute path have no build. */
struct mesh_list {
    uint32_t *items;                ///< owned
    struct structure_build *builds; ///< owned
    uint32_t count, room, build_count;
};

/** Settings with which a device reads its meshes. */
struct mesh_reading {
    struct mesh_cache *cache; ///< shared by all devices
    uint32_t device, thread_count;
};

/** Zeroed is empty. */
struct meshes {
    struct mesh *items; ///< owned
    uint32_t count;
    uint32_t *of_shape; ///< owned; mesh index by shape
    struct mesh_reader *reader;
    struct mesh_list waiting, building; ///< `building`: read, and in the batch (MESH_BUILDING)
    struct build_batch batch;
    struct arena data;
    uint64_t size;      ///< bytes of all meshes on the device
    struct table table; ///< struct PbrtMesh by mesh
    bool says_what_it_reads;
    bool uncompacted; ///< true: structures are not compacted
    /* Totals since the start. */
    uint64_t built_count, evicted_count, triangle_count, bytes_read, failed_count;
    uint64_t normal_count, uv_count;
    double read_seconds; ///< total over all threads
    double build_seconds;
};

/** Reports errors on stderr. */
bool meshes_create(const struct gpu *gpu, const struct scene *scene,
                   const struct mesh_reading *reading, struct meshes *meshes);
void meshes_finish(const struct gpu *gpu, struct structures *structures, struct meshes *meshes);

/**
 * Reads and builds absent meshes. `which` must not repeat a mesh. A mesh that cannot be read or
 * allocated becomes MESH_FAILED, with a message on stderr. Returns false if rendering cannot
 * continue.
 */
bool meshes_build(const struct gpu *gpu, const struct scene *scene, struct structures *structures,
                  struct meshes *meshes, const uint32_t *which, uint32_t count, uint32_t launch);
/** Reads an absent mesh. meshes_begin builds it. */
bool meshes_prepare(const struct gpu *gpu, const struct scene *scene, struct meshes *meshes,
                    uint32_t index);
/** Begins to build the waiting meshes, unless a batch is running. meshes_continue ends the
 * batch. */
bool meshes_begin(const struct gpu *gpu, struct structures *structures, struct meshes *meshes);
/** Marks the meshes of an ended batch as built, for the launch of that number. `waits`: wait for
 * the end. Call only while no launch is running. Reports errors on stderr. */
bool meshes_continue(const struct gpu *gpu, struct structures *structures, struct meshes *meshes,
                     uint32_t launch, bool waits);

enum mesh_fetch { MESH_IS_READ_LATER, MESH_IS_READ, MESH_IS_BUILT_LATER, MESH_IS_THERE };
/** Returns how far a mesh is. Begins to read an absent mesh. */
enum mesh_fetch meshes_fetch(struct meshes *meshes, uint32_t index);
/** Device memory of a mesh in bytes. */
uint64_t meshes_size_of(const struct mesh *mesh);
/** Makes a mesh absent. Call only while no launch is running. */
void meshes_evict(const struct gpu *gpu, struct structures *structures, struct meshes *meshes,
                  uint32_t index);

#endif /* DEMAND_PBRT_MESHES_H */
