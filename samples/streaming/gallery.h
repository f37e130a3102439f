/** Objects of one walk. gallery_close destroys them in reverse order. */
#ifndef SAMPLES_STREAMING_GALLERY_H
#define SAMPLES_STREAMING_GALLERY_H

#include "reference.h"
#include "view.h"

struct gallery {
    struct settings settings;
    struct gpu gpu;
    struct picture_list pictures;
    struct room room;
    struct pattern_image floor_pattern, wall_pattern;
    SluiceImageSource *floor, *wall;
    struct target target;
    struct view streamed;
    struct view truth;          ///< only with --compare
    struct reference reference; ///< only with --reference
};

enum gallery_outcome { GALLERY_READY, GALLERY_NO_DEVICE, GALLERY_FAILED };

/** Fills all fields but `settings`. Reports errors on stderr. Call gallery_close in any case. */
enum gallery_outcome gallery_open(struct gallery *gallery);
/** Returns false if the recording could not be written. */
bool gallery_close(struct gallery *gallery);

/** Camera of a frame of the walk. At rest in the last frames. */
struct camera gallery_camera(const struct settings *settings, const struct room *room,
                             uint32_t frame);

/** Draws a view with `everything`, from the entrance, until all its tiles are resident. */
bool gallery_fill(struct view *view, const struct room *room);

#endif /* SAMPLES_STREAMING_GALLERY_H */
