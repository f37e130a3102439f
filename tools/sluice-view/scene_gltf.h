/** Materials of a scene from the JSON of a glTF file, which says more than Assimp does. */
#ifndef SLUICE_VIEW_SCENE_GLTF_H
#define SLUICE_VIEW_SCENE_GLTF_H

#include "gltf_file.h"
#include "scene_data.h"

/** Makes scene->materials, as many as the file has and a default one behind them, and opens their
 *  images. False with a line on stderr. */
bool scene_gltf_materials(struct gltf_file *file, const char *cache, struct scene_data *scene);

/** Adds the cameras of the file, and the path of the first that moves as the tour. False, with a
 *  line on stderr, without memory. */
bool scene_gltf_cameras(struct gltf_file *file, struct scene_data *scene);

#endif /* SLUICE_VIEW_SCENE_GLTF_H */
