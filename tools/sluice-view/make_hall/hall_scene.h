/** The hall as a glTF scene. */
#ifndef SLUICE_VIEW_HALL_SCENE_H
#define SLUICE_VIEW_HALL_SCENE_H

#include <stdbool.h>

/** Writes FOLDER/hall.gltf and hall.bin. Reports failures on stderr. */
bool hall_scene_write(const char *folder);

#endif /* SLUICE_VIEW_HALL_SCENE_H */
