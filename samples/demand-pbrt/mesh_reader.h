/** Threads that read meshes from files, so that the host does something else meanwhile. */
#ifndef DEMAND_PBRT_MESH_READER_H
#define DEMAND_PBRT_MESH_READER_H

#include "mesh_cache.h"

struct mesh_reader;

/** Meshes that may be asked for and not taken yet: they are in memory. */
#define MESH_READER_ROOM 64u

/** For a device. `thread_count` 0: all processors but one, 1 to 8. The cache outlives it. Says on
 *  stderr why it failed; NULL then. */
struct mesh_reader *mesh_reader_create(struct mesh_cache *cache, uint32_t device,
                                       uint32_t thread_count);
/** NULL is fine. What was asked for and not taken is freed. */
void mesh_reader_destroy(struct mesh_reader *reader);

/** Begins to read the mesh of a shape, unless that was begun before. If there is no room, the
 * oldest that was read and not taken is freed. False: all are being read. */
bool mesh_reader_ask(struct mesh_reader *reader, uint32_t shape);
/** Whether mesh_reader_take would not wait. */
bool mesh_reader_is_ready(struct mesh_reader *reader, uint32_t shape);
/** Waits for a mesh that was asked for, or reads it. The caller gives it back, also after an error.
 */
void mesh_reader_take(struct mesh_reader *reader, uint32_t shape, struct mesh_read *read);
void mesh_reader_give(struct mesh_reader *reader, struct mesh_read *read);

#endif /* DEMAND_PBRT_MESH_READER_H */
