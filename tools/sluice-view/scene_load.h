/** Opens a scene on a thread, while frames are drawn. */
#ifndef SLUICE_VIEW_SCENE_LOAD_H
#define SLUICE_VIEW_SCENE_LOAD_H

#include "scene_open.h"

#include "../common/files.h"

struct scene_load;

/** Moves the paths out of the list. NULL, with a line on stderr, without memory or a thread. */
/** `how` has all but paths and progress. */
struct scene_load *scene_load_begin(struct file_list *paths, const struct scene_request *how);
/** Whether scene_load_end does not wait. */
bool scene_load_done(const struct scene_load *load);
/** Writes "Opening hall.gltf: 3 of 45 images". */
void scene_load_describe(const struct scene_load *load, char *text, size_t size);
/** Waits for the thread, and frees the load. Moves its paths out, and its scene if one was opened.
 */
bool scene_load_end(struct scene_load *load, struct scene_data *scene, struct file_list *paths);
/** Cancels a load without a wait, and moves it into a list, which begins as NULL. Its thread ends
 *  without a scene. A file of geometry that is being read is read to its end; the text of a scene
 *  of pbrt for 128 KiB at most, and vertices of one PLY file. */
void scene_load_keep_canceled(struct scene_load *load, struct scene_load **canceled);
/** Frees the loads of the list whose threads have ended. `wait`: all loads. */
void scene_load_drop_canceled(struct scene_load **canceled, bool wait);

#endif /* SLUICE_VIEW_SCENE_LOAD_H */
