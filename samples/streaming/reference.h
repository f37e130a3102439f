/**
 * Frames of the walk with everything resident, kept in a folder. Drawn once, reused by any number
 * of walks.
 */
#ifndef SAMPLES_STREAMING_REFERENCE_H
#define SAMPLES_STREAMING_REFERENCE_H

#include "frame_file.h"

struct gallery;

struct reference {
    struct frame_file frames; ///< size and count equal the walk's
    uint64_t device_memory;   ///< bytes of all resident pictures
};

/**
 * Opens the frames in settings.reference. Draws them first if they are missing, damaged or made
 * with other settings, and says so on stderr. Drawing leaves nothing on the device. reference.txt
 * exists only if reference.frames is complete. Requires all of the gallery but its views. Only one
 * process at a time may draw into a folder. Reports errors on stderr.
 */
bool reference_open(const struct gallery *gallery, struct reference *reference);
/** Accepts a zeroed struct. */
void reference_close(struct reference *reference);

#endif /* SAMPLES_STREAMING_REFERENCE_H */
