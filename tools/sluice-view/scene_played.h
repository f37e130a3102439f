/** Recordings shown instead of scenes: the part that needs no device. */
#ifndef SLUICE_VIEW_SCENE_PLAYED_H
#define SLUICE_VIEW_SCENE_PLAYED_H

#include "played.h"
#include "scene_data.h"
#include "stage.h"

/** Opens a recording, and plays it once. False, with a line on stderr, on failure. */
bool scene_played_open(const char *path, struct scene_data *scene);
/** Returns the textures of a stage; release them by free. NULL without memory. */
struct stage_texture *scene_played_textures(const struct played *played);

#endif /* SLUICE_VIEW_SCENE_PLAYED_H */
