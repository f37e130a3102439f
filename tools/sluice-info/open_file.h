/** Opens any texture file that this build reads. */
#ifndef TOOLS_SLUICE_INFO_OPEN_FILE_H
#define TOOLS_SLUICE_INFO_OPEN_FILE_H

#include <sluice/image.h>

#include "../common/remote.h"

struct texture_file {
    struct remote_session session; ///< connection of a URL
    struct remote_file remote;
    SluiceImageSource *source;
    SluiceImageInfo image;
    const char *kind; ///< "tile store" and so on
    bool is_store;
    bool has_spoken; ///< true: the library has reported the error
};

/** Options of opening a file. */
struct texture_opening {
    /** Byte limit for reading; UINT64_MAX if no texels are read. */
    uint64_t memory;
    /** Reads only level 0. Files without levels then have one level and are not read as a whole. */
    bool level_zero_alone;
};

/** Opens a file. Reports errors on stderr. The struct must not move until it is closed. */
bool open_texture_file(struct texture_file *file, const char *path,
                       const struct texture_opening *opening);
void close_texture_file(struct texture_file *file);

#endif /* TOOLS_SLUICE_INFO_OPEN_FILE_H */
