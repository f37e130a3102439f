/** Loop subdivision of triangle meshes. */
#ifndef SLC_PBRT_LOOP_SUBDIVISION_H
#define SLC_PBRT_LOOP_SUBDIVISION_H

#include "base/alloc.h"

#include <sluice/pbrt.h>

/**
 * Replaces a control mesh by itself subdivided `levels` times, with its vertices moved to the limit
 * surface and with the normals there. Normals and uvs of the control mesh are dropped, as in pbrt.
 *
 * Vertices of level l keep their indices in level l + 1. Positions stay within the control mesh's
 * bounds.
 *
 * Returns SLUICE_ERROR_UNSUPPORTED if a face has a corner twice, if more than two faces share an
 * edge or run along it in one direction, or if fans of faces touch in a vertex alone; the mesh is
 * unchanged then. Returns SLUICE_ERROR_LIMIT_EXCEEDED if the result takes more than `max_size`
 * bytes, and SLUICE_ERROR_OUT_OF_HOST_MEMORY, unchanged too. Source: Loop, "Smooth Subdivision
 * Surfaces Based on Triangles", 1987; Hoppe et al., "Piecewise Smooth Surface Reconstruction",
 * 1994; weights as in pbrt-v3, shapes/loopsubdiv.cpp.
 */
SluiceResult slc_pbrt_subdivide(const SluiceAllocationCallbacks *cb, uint32_t levels,
                                uint64_t max_size, SluicePbrtMesh *mesh);

#endif /* SLC_PBRT_LOOP_SUBDIVISION_H */
