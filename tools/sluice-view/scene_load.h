/** Opens a scene on a thread, while frames are drawn. */
#ifndef SLUICE_VIEW_SCENE_LOAD_H
#define SLUICE_VIEW_SCENE_LOAD_H

#include "scene_open.h"

#include "../common/files.h"

struct scene_load;

/** Begins a load. Moves the paths out of the list. `how` has all fields but paths and progress.
 *  NULL, with a line on stderr, without memory or a thread. */
struct scene_load *scene_load_begin(struct file_list *paths, const struct scene_request *how);
/** Returns true if scene_load_end would return without a wait. */
bool scene_load_done(const struct scene_load *load);
/** Writes the progress: "Opening hall.gltf: 3 of 45 images". */
void scene_load_describe(const struct scene_load *load, char *text, size_t size);
/** Waits for the thread, and frees the load. Moves out the paths, and the scene if it was opened.
 *  False if it was not. */
bool scene_load_end(struct scene_load *load, struct scene_data *scene, struct file_list *paths);
/** Cancels a load without a wait, and moves it into a list. An empty list is NULL. The thread ends
 *  without a scene. Before that it reads the present geometry file to its end. Of a pbrt scene it
 *  reads at most 128 KiB of text, and the vertices of one PLY file. */
void scene_load_keep_canceled(struct scene_load *load, struct scene_load **canceled);
/** Frees the loads whose threads have ended. `wait`: waits for all threads, and frees all loads. */
void scene_load_drop_canceled(struct scene_load **canceled, bool wait);

#endif /* SLUICE_VIEW_SCENE_LOAD_H */
