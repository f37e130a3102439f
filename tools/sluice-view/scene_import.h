/** Scenes from files. */
#ifndef SLUICE_VIEW_SCENE_IMPORT_H
#define SLUICE_VIEW_SCENE_IMPORT_H

#include "scene_data.h"

/** Fills a zeroed scene; reads glTF, OBJ and what else Assimp reads. `cache`: folder for baked
 * pictures. `wait`: until all pictures are baked. Says on stderr what is wrong, and which images
 * are left out. */
bool scene_import(const char *path, const char *cache, bool wait, struct scene_data *scene);

#endif /* SLUICE_VIEW_SCENE_IMPORT_H */
