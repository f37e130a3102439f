/** Opens whatever file of a texture this build reads. */
#ifndef TOOLS_SLUICE_INFO_OPEN_FILE_H
#define TOOLS_SLUICE_INFO_OPEN_FILE_H

#include <sluice/image.h>

#include "../common/remote.h"

struct texture_file {
    struct remote_session session; ///< of a URL
    struct remote_file remote;
    SluiceImageSource *source;
    SluiceImageInfo image;
    const char *kind; ///< "tile store" and so on
    bool is_store;
    bool has_spoken; ///< the library has said what is wrong
};

/** What a file is opened for. */
struct texture_opening {
    /** Bytes that reading may take; UINT64_MAX where no texels are read. */
    uint64_t memory;
    /** Nothing but level 0 is read. Files without levels are not read as a whole then, and have one
     *  level. */
    bool level_zero_alone;
};

/** Says on standard error what is wrong. The struct stays where it is until it is closed. */
bool open_texture_file(struct texture_file *file, const char *path,
                       const struct texture_opening *opening);
void close_texture_file(struct texture_file *file);

#endif /* TOOLS_SLUICE_INFO_OPEN_FILE_H */
