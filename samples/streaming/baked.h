/** Pictures that cannot be read tile by tile, baked once into tile stores that are kept. */
#ifndef SAMPLES_STREAMING_BAKED_H
#define SAMPLES_STREAMING_BAKED_H

#include "picture_file.h"

/** A picture that was named or found, and what is streamed for it. */
struct picture_path {
    const char *path;       ///< borrowed
    char *copy;             ///< owned; `path` of a picture on a server; NULL: none
    char *store;            ///< owned; streamed instead; NULL: the file itself
    enum picture_kind kind; ///< of the file itself
    bool refused;           ///< nothing is; the reason was printed
};

/**
 * Bakes what needs it, side by side, with one progress bar, and says how many were baked and how
 * many stores were up to date: made of a file of this size and time with these settings. Pictures
 * that cannot be baked are refused, the others go on. In a build without sluice-bake OpenEXR files
 * are streamed as they are and the others left to picture_file_open, which says so. False only when
 * nothing can be baked at all.
 *
 * A store lies in "cache/baked" under its picture's whole path, with .store added.
 */
bool baked_prepare(struct picture_path *paths, size_t count, const char *cache,
                   enum pixel_format pixels);

#endif /* SAMPLES_STREAMING_BAKED_H */
