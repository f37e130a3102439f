/** Picture files of a scene. Each file is opened once for all devices. */
#ifndef DEMAND_PBRT_PICTURE_FILES_H
#define DEMAND_PBRT_PICTURE_FILES_H

#include <sluice/open.h>
#include <sluice/pbrt.h>

#include <stdbool.h>

#include "../common/shared_source.h"

/** A picture. Loaders keep its address, so it must not move. */
struct picture_file {
    const char *path; ///< owned by the scene
    const char *file; ///< scene file that names the picture first
    uint32_t line;
    bool has_failed; ///< the error was reported on stderr
    bool says_what_it_reads;
    SluiceImageOpener *opener;
    struct shared_source shared;
};

/** Zeroed is empty. */
struct picture_files {
    SluiceImageOpener *opener;
    bool says_what_it_reads;
    pthread_mutex_t mutex;       ///< guards all fields below
    struct picture_file **items; ///< owned, with its elements
    uint32_t count, room;
};

/** `cache`: folder for baked pictures. Reports errors on stderr. */
bool picture_files_create(const char *cache, uint32_t thread_count, struct picture_files *files);
/** Call after all loaders are destroyed. */
void picture_files_finish(struct picture_files *files);

/** Finds or adds the file of an image texture. The file lives until picture_files_finish.
 * Thread-safe. Returns NULL on error and reports it on stderr. */
struct picture_file *picture_files_find(struct picture_files *files,
                                        const SluicePbrtTexture *texture);

#endif /* DEMAND_PBRT_PICTURE_FILES_H */
