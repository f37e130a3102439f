/** Triangles of shapes other than PLY files. */
#ifndef SLC_PBRT_SHAPE_READER_H
#define SLC_PBRT_SHAPE_READER_H

#include "pbrt/parsed_scene.h"

/** Reads the numbers of a mesh from the text again. Errors, logged: sluiceReadPbrtShape's. After an
 *  error, *mesh is zero except structSize. */
SluiceResult slc_pbrt_read_inline_mesh(const SluicePbrtScene *scene,
                                       const struct slc_pbrt_shape_entry *shape,
                                       SluicePbrtMesh *mesh);

/** Makes triangles of a sphere, disk or cylinder. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_pbrt_build_quadric(const SluicePbrtScene *scene,
                                    const struct slc_pbrt_shape_entry *shape, SluicePbrtMesh *mesh);
/** Returns the box of a quadric before the transform. */
SluicePbrtBounds slc_pbrt_quadric_bounds(const struct slc_pbrt_shape_entry *shape);

#endif /* SLC_PBRT_SHAPE_READER_H */
