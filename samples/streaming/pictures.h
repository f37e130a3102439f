/** The pictures of the gallery: opened files of many kinds. */
#ifndef SAMPLES_STREAMING_PICTURES_H
#define SAMPLES_STREAMING_PICTURES_H

#include <sluice/exr.h>
#include <sluice/store.h>

#include "../../tools/common/remote.h"
#include "generate.h"
#include "settings.h"

struct neural_files;
struct neural_picture;

struct picture {
    char *path;                ///< owned
    struct remote_file remote; ///< connection of a URL; closed after `color`
    SluiceImageSource *color;  ///< owned; may be NULL if `neural` is set
    SluiceImageInfo info;
    float exposure;            ///< factor for a medium brightness
    bool gray;                 ///< true: one channel, shown as gray
    SluiceImageSource *relief; ///< owned; height of canvas and paint, half the picture's size
    struct pattern_image relief_pattern;
    struct neural_picture *neural; ///< owned; NULL: not from a neural set
};

struct picture_list {
    struct picture *pictures; ///< owned
    uint32_t count;
    uint32_t refused;              ///< files that could not be opened; the reasons were printed
    SluiceStoreReadPool *pool;     ///< owned; shared by all stores
    SluiceExrMemoryBudget *memory; ///< owned; shared by all OpenEXR files without levels
    struct neural_files *neural;   ///< owned; NULL: no neural set
    struct remote_session session; ///< connections of the URLs
};

/** Limits of the device for one image. */
struct picture_limits {
    uint32_t max_size;  ///< texels per axis
    uint64_t max_bytes; ///< including all levels
    bool takes_blocks;  ///< true: BC formats are supported
};

/**
 * Generates pictures if the settings name none, and bakes pictures that cannot be streamed
 * directly. Skips files that cannot be shown, and names them on stderr. Returns false if none is
 * left.
 */
bool pictures_open(const struct settings *settings, const struct picture_limits *limits,
                   struct picture_list *list);
void pictures_close(struct picture_list *list);

#endif /* SAMPLES_STREAMING_PICTURES_H */
