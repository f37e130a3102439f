/** Bounds and triangles of PLY files. */
#ifndef SLC_PBRT_PLY_READER_H
#define SLC_PBRT_PLY_READER_H

#include <sluice/pbrt.h>

#include "pbrt/byte_window.h"

/** Message about a file: after an error its cause, after a success an approximation or NULL. */
struct slc_pbrt_ply_trouble {
    const char *text;
};

/** Reads the header and the vertices. Errors: those of opening; CORRUPT_DATA. */
SluiceResult slc_pbrt_ply_read_bounds(const char *path, const SluiceAllocationCallbacks *cb,
                                      SluicePbrtBounds *bounds, struct slc_pbrt_stamp *stamp,
                                      struct slc_pbrt_ply_trouble *trouble);

/** Reads all of it. The arrays have exactly the sizes that the counts say. Errors: those of
 *  opening; CORRUPT_DATA; LIMIT_EXCEEDED; *mesh is zeroed then, but for structSize. */
SluiceResult slc_pbrt_ply_read_mesh(const char *path, const SluiceAllocationCallbacks *cb,
                                    uint64_t max_size, SluicePbrtMesh *mesh,
                                    struct slc_pbrt_ply_trouble *trouble);

void slc_pbrt_free_mesh(const SluiceAllocationCallbacks *cb, SluicePbrtMesh *mesh);

#endif /* SLC_PBRT_PLY_READER_H */
