/** Compiles programs ahead that drivers compile at their first use. */
#ifndef SLUICE_VIEW_TRACED_REHEARSAL_H
#define SLUICE_VIEW_TRACED_REHEARSAL_H

#include "scene_data.h"
#include "stage.h"

/**
 * Makes lavapipe compile the programs of a scene of pbrt ahead; other devices have compiled them.
 *
 * lavapipe compiles a program when it runs first, on the thread of its one queue, which frames of
 * the window wait for. This function lets a second device run each program once. Its code is in the
 * driver's cache on disk then, where the device of the window finds it. Any thread. A failure says
 * nothing: the window waits then.
 */
void traced_rehearse(const struct gpu *gpu, const struct scene_data *scene);

#endif /* SLUICE_VIEW_TRACED_REHEARSAL_H */
