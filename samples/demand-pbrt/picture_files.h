/** Pictures of a scene as files: each is opened once for all devices. */
#ifndef DEMAND_PBRT_PICTURE_FILES_H
#define DEMAND_PBRT_PICTURE_FILES_H

#include <sluice/open.h>
#include <sluice/pbrt.h>

#include <stdbool.h>

#include "../common/shared_source.h"

/** A picture. Its address is known to the loaders. */
struct picture_file {
    const char *path; ///< of the scene
    const char *file; ///< text that names it first
    uint32_t line;
    bool has_failed; ///< which stderr has said
    bool says_what_it_reads;
    SluiceImageOpener *opener;
    struct shared_source shared;
};

/** Zeroed is empty. */
struct picture_files {
    SluiceImageOpener *opener;
    bool says_what_it_reads;
    pthread_mutex_t mutex;       ///< of all below
    struct picture_file **items; ///< owned, and each of them
    uint32_t count, room;
};

/** `cache`: folder for baked pictures. Says on stderr why it failed. */
bool picture_files_create(const char *cache, uint32_t thread_count, struct picture_files *files);
/** After all loaders. */
void picture_files_finish(struct picture_files *files);

/** Finds or adds the file of an image texture. It stays until picture_files_finish. Any thread.
 *  NULL: says on stderr why it failed. */
struct picture_file *picture_files_find(struct picture_files *files,
                                        const SluicePbrtTexture *texture);

#endif /* DEMAND_PBRT_PICTURE_FILES_H */
