/** Bakes pictures that cannot be read tile by tile into tile stores, and keeps the stores. */
#ifndef SAMPLES_STREAMING_BAKED_H
#define SAMPLES_STREAMING_BAKED_H

#include "picture_file.h"

/** A picture, and the file that is streamed for it. */
struct picture_path {
    const char *path;       ///< borrowed
    char *copy;             ///< owned; `path` of a picture on a server; NULL: not on a server
    char *store;            ///< owned; store that is streamed; NULL: stream the file itself
    enum picture_kind kind; ///< kind of the file itself
    bool refused;           ///< true: nothing is streamed; the reason was printed
};

/**
 * Bakes in parallel with one progress bar, and prints how many pictures were baked and how many
 * stores were up to date. A store is up to date if it was baked from a file of equal size and time
 * with equal settings. Pictures that cannot be baked are refused; the others continue. Without
 * sluice-bake in the build, OpenEXR files are streamed as they are, and picture_file_open reports
 * the others. Returns false only if nothing can be baked at all.
 *
 * The store of a picture is in "cache/baked", under the picture's whole path with .store added.
 */
bool baked_prepare(struct picture_path *paths, size_t count, const char *cache,
                   enum pixel_format pixels);

#endif /* SAMPLES_STREAMING_BAKED_H */
