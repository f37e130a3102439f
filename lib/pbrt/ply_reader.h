/** Bounds and triangles of PLY files. */
#ifndef SLC_PBRT_PLY_READER_H
#define SLC_PBRT_PLY_READER_H

#include <sluice/pbrt.h>

#include "pbrt/byte_window.h"

/** Message about a file. After an error: its cause. After success: an approximation, or NULL. */
struct slc_pbrt_ply_trouble {
    const char *text;
};

/** Reads header and vertices. Errors: slc_pbrt_window_open's; CORRUPT_DATA. */
SluiceResult slc_pbrt_ply_read_bounds(const char *path, const SluiceAllocationCallbacks *cb,
                                      SluicePbrtBounds *bounds, struct slc_pbrt_stamp *stamp,
                                      struct slc_pbrt_ply_trouble *trouble);

/** Reads the whole file. Arrays have exactly the sizes of the counts. Errors:
 * slc_pbrt_window_open's; CORRUPT_DATA; LIMIT_EXCEEDED. After an error, *mesh is zero except
 * structSize. */
SluiceResult slc_pbrt_ply_read_mesh(const char *path, const SluiceAllocationCallbacks *cb,
                                    uint64_t max_size, SluicePbrtMesh *mesh,
                                    struct slc_pbrt_ply_trouble *trouble);

void slc_pbrt_free_mesh(const SluiceAllocationCallbacks *cb, SluicePbrtMesh *mesh);

#endif /* SLC_PBRT_PLY_READER_H */
