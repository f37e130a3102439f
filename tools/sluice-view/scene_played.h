/** Recordings in the place of scenes: the part that needs no device. */
#ifndef SLUICE_VIEW_SCENE_PLAYED_H
#define SLUICE_VIEW_SCENE_PLAYED_H

#include "played.h"
#include "scene_data.h"
#include "stage.h"

/** Plays the recording once. Says on stderr why it failed. */
bool scene_played_open(const char *path, struct scene_data *scene);
/** Fills the textures of a stage. NULL without memory. To be freed. */
struct stage_texture *scene_played_textures(const struct played *played);

#endif /* SLUICE_VIEW_SCENE_PLAYED_H */
