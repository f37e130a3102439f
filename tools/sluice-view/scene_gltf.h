/** Materials and cameras of a scene, from the JSON of a glTF file. The JSON has more than Assimp.
 */
#ifndef SLUICE_VIEW_SCENE_GLTF_H
#define SLUICE_VIEW_SCENE_GLTF_H

#include "gltf_file.h"
#include "scene_data.h"

/** Makes scene->materials: the materials of the file, then a default one. Opens their images.
 * False, with a line on stderr, on failure. */
bool scene_gltf_materials(struct gltf_file *file, const char *cache, struct scene_data *scene);

/** Adds the cameras of the file. The path of the first moving camera becomes the tour. False, with
 * a line on stderr, without memory. */
bool scene_gltf_cameras(struct gltf_file *file, struct scene_data *scene);

#endif /* SLUICE_VIEW_SCENE_GLTF_H */
