/** Everything that one walk needs, made in order and released in reverse. */
#ifndef SAMPLES_STREAMING_GALLERY_H
#define SAMPLES_STREAMING_GALLERY_H

#include "view.h"

struct gallery {
    struct settings settings;
    struct gpu gpu;
    struct picture_list pictures;
    struct room room;
    struct pattern_image floor_pattern, wall_pattern;
    SluiceImageSource *floor, *wall;
    struct target target;
    struct renderer renderer, truth_renderer; ///< the latter where the truth needs its own
    struct view streamed;
    struct view truth; ///< only with --compare
};

enum gallery_outcome { GALLERY_READY, GALLERY_NO_DEVICE, GALLERY_FAILED };

/** Fills all but the settings. Says on stderr what is wrong; gallery_close is due in any case. */
enum gallery_outcome gallery_open(struct gallery *gallery);
/** False if the recording could not be written. */
bool gallery_close(struct gallery *gallery);

#endif /* SAMPLES_STREAMING_GALLERY_H */
