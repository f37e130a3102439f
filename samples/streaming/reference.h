/**
 * Frames of the walk with everything resident, kept in a folder: drawn once, compared with by any
 * number of walks.
 */
#ifndef SAMPLES_STREAMING_REFERENCE_H
#define SAMPLES_STREAMING_REFERENCE_H

#include "frame_file.h"

struct gallery;

struct reference {
    struct frame_file frames; ///< as large as those of the walk, and as many
    uint64_t device_memory;   ///< bytes that everything resident took
};

/**
 * Opens the frames in settings.reference, after having drawn them if they are missing, damaged or
 * differ in what matters, and says so on stderr; nothing of the drawing is left on the device.
 * reference.txt is there only if reference.frames is complete. Needs all of the gallery but its
 * views. One process at a time may draw into a folder. Says on stderr why it failed.
 */
bool reference_open(const struct gallery *gallery, struct reference *reference);
/** A zeroed struct is fine. */
void reference_close(struct reference *reference);

#endif /* SAMPLES_STREAMING_REFERENCE_H */
