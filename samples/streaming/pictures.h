/** The pictures that hang in the gallery: OpenEXR files that could be opened. */
#ifndef SAMPLES_STREAMING_PICTURES_H
#define SAMPLES_STREAMING_PICTURES_H

#include <sluice/image.h>

#include "generate.h"
#include "settings.h"

struct picture {
    char *path;               ///< owned
    SluiceImageSource *color; ///< owned
    SluiceImageInfo info;
    float exposure;            ///< factor that brings the picture to a middle brightness
    bool grey;                 ///< one channel, to be shown as grey
    SluiceImageSource *relief; ///< owned; height of canvas and paint, half the picture's size
    struct pattern_image relief_pattern;
};

struct picture_list {
    struct picture *pictures; ///< owned
    uint32_t count;
    uint32_t refused; ///< files that could not be opened; the reasons were printed
};

/** What the device can hold of one image. */
struct picture_limits {
    uint32_t max_size;  ///< texels in a direction
    uint64_t max_bytes; ///< with all levels
};

/** Generates first if the settings name no images. Says on stderr what is wrong. */
bool pictures_open(const struct settings *settings, const struct picture_limits *limits,
                   struct picture_list *list);
void pictures_close(struct picture_list *list);

#endif /* SAMPLES_STREAMING_PICTURES_H */
