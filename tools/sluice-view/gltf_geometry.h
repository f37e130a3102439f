/** Geometry of a glTF file, read by Assimp from the checked data. */
#ifndef SLUICE_VIEW_GLTF_GEOMETRY_H
#define SLUICE_VIEW_GLTF_GEOMETRY_H

#include "gltf_file.h"

struct aiScene;
struct aiMaterial;

/** Imports the geometry; release it by aiReleaseImport. `flags`: aiPostProcessSteps. NULL on
 * failure: aiGetErrorString has the cause. */
const struct aiScene *gltf_import_geometry(const struct gltf_file *file, unsigned flags);
/** Returns the index of a material in the file. Returns the count of GLTF_MATERIALS for the default
 *  material. */
uint32_t gltf_material_number(const struct gltf_file *file, const struct aiMaterial *material);

#endif /* SLUICE_VIEW_GLTF_GEOMETRY_H */
