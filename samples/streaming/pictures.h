/** The pictures that hang in the gallery: files of many kinds that could be opened. */
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
    struct remote_file remote; ///< of a URL; closed after `color`
    SluiceImageSource *color;  ///< owned; NULL where `neural` says so
    SluiceImageInfo info;
    float exposure;            ///< factor that brings the picture to a middle brightness
    bool gray;                 ///< one channel, to be shown as gray
    SluiceImageSource *relief; ///< owned; height of canvas and paint, half the picture's size
    struct pattern_image relief_pattern;
    struct neural_picture *neural; ///< owned; NULL: no texture of a neural set
};

struct picture_list {
    struct picture *pictures; ///< owned
    uint32_t count;
    uint32_t refused;              ///< files that could not be opened; the reasons were printed
    SluiceStoreReadPool *pool;     ///< owned; that all stores share
    SluiceExrMemoryBudget *memory; ///< owned; that all OpenEXR files without levels share
    struct neural_files *neural;   ///< owned; NULL: no neural set hangs
    struct remote_session session; ///< connections of the URLs
};

/** What the device can hold of one image. */
struct picture_limits {
    uint32_t max_size;  ///< texels in a direction
    uint64_t max_bytes; ///< with all levels
    bool takes_blocks;  ///< BC formats
};

/**
 * Generates first if the settings name no images, and bakes what cannot be streamed as it is. Files
 * that cannot be shown are left out and named on stderr; false if none is left.
 */
bool pictures_open(const struct settings *settings, const struct picture_limits *limits,
                   struct picture_list *list);
void pictures_close(struct picture_list *list);

#endif /* SAMPLES_STREAMING_PICTURES_H */
