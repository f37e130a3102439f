/** Catalogues, as sluice-bake --merge writes them. A scene shows all stores of a catalogue. */
#ifndef SLUICE_VIEW_SCENE_CATALOGUE_H
#define SLUICE_VIEW_SCENE_CATALOGUE_H

#include "../common/files.h"
#include "../common/remote.h"

#define CATALOGUE ".tsv" /* "list.tsv#name": one of its stores */

/** Returns true if a path or URL has the name of a catalogue. */
bool scene_catalogue_takes(const char *path);
/** Adds "path#store" for each store. False, with a line on stderr, if it cannot be read. */
bool scene_catalogue_collect(const char *path, struct remote_session *session,
                             struct file_list *files);

#endif /* SLUICE_VIEW_SCENE_CATALOGUE_H */
