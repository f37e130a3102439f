/** The hall: the scene that comes with the viewer. */
#ifndef SLUICE_VIEW_SCENE_HALL_H
#define SLUICE_VIEW_SCENE_HALL_H

#include <stdbool.h>
#include <stddef.h>

/** Finds hall.gltf where it was installed, or in the sources of a build tree. False, with a line on
 *  stderr, if there is none. */
bool scene_hall_find(char *path, size_t size);
/** Finds hall.gltf as scene_hall_find, without a line on stderr. */
bool scene_hall_look(char *path, size_t size);

#endif /* SLUICE_VIEW_SCENE_HALL_H */
