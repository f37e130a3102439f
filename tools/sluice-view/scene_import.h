/** Reads scenes from files. */
#ifndef SLUICE_VIEW_SCENE_IMPORT_H
#define SLUICE_VIEW_SCENE_IMPORT_H

#include "scene_data.h"

/** Fills a zeroed scene from glTF, OBJ or another format that Assimp reads. `cache`: folder for
 * baked pictures. `wait`: waits until all pictures are baked. Reports faults, and images that are
 * left out, on stderr. */
bool scene_import(const char *path, const char *cache, bool wait, struct scene_data *scene);

#endif /* SLUICE_VIEW_SCENE_IMPORT_H */
