/** Threads that read meshes from files while the host does other work. */
#ifndef DEMAND_PBRT_MESH_READER_H
#define DEMAND_PBRT_MESH_READER_H

#include "mesh_cache.h"

struct mesh_reader;

/** Maximum number of meshes that are requested and not taken. They occupy memory. */
#define MESH_READER_ROOM 64u

/** Creates a reader for a device. `thread_count` 0: one thread per processor but one, 1 to 8. The
 * cache must outlive it. Reports errors on stderr and returns NULL. */
struct mesh_reader *mesh_reader_create(struct mesh_cache *cache, uint32_t device,
                                       uint32_t thread_count);
/** Frees all meshes that were not taken. NULL is allowed. */
void mesh_reader_destroy(struct mesh_reader *reader);

/** Requests the mesh of a shape, unless it is requested already. Without room, frees the oldest
 * mesh that was read and not taken. Returns false if all others are still being read. */
bool mesh_reader_ask(struct mesh_reader *reader, uint32_t shape);
/** Returns whether mesh_reader_take would return at once. */
bool mesh_reader_is_ready(struct mesh_reader *reader, uint32_t shape);
/** Waits for a requested mesh, or reads it now. Give it back with mesh_reader_give, also after an
 * error. */
void mesh_reader_take(struct mesh_reader *reader, uint32_t shape, struct mesh_read *read);
void mesh_reader_give(struct mesh_reader *reader, struct mesh_read *read);

#endif /* DEMAND_PBRT_MESH_READER_H */
