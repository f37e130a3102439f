/** Opens whatever file of a texture this build reads. */
#ifndef TOOLS_SLUICE_INFO_OPEN_FILE_H
#define TOOLS_SLUICE_INFO_OPEN_FILE_H

#include <sluice/image.h>

struct texture_file {
    SluiceImageSource *source;
    SluiceImageInfo image;
    const char *kind; ///< "tile store" and so on
    bool is_store;
};

/** Says on standard error what is wrong. */
bool open_texture_file(struct texture_file *file, const char *path);
void close_texture_file(struct texture_file *file);

#endif /* TOOLS_SLUICE_INFO_OPEN_FILE_H */
