/** Meshes, nodes, cameras and animations of a glTF file, read by Assimp from what was checked. */
#ifndef SLUICE_VIEW_GLTF_GEOMETRY_H
#define SLUICE_VIEW_GLTF_GEOMETRY_H

#include "gltf_file.h"

struct aiScene;
struct aiMaterial;

/** `flags`: aiPostProcessSteps. NULL: aiGetErrorString says why. Ends with aiReleaseImport. */
const struct aiScene *gltf_import_geometry(const struct gltf_file *file, unsigned flags);
/** The number that a material has in the file; the count of GLTF_MATERIALS for the one of meshes
 *  that name none. */
uint32_t gltf_material_number(const struct gltf_file *file, const struct aiMaterial *material);

#endif /* SLUICE_VIEW_GLTF_GEOMETRY_H */
