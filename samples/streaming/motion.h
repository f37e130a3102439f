/**
 * Where a camera will be, from where it was in the last frames alone.
 *
 * A motion that goes on evenly, or speeds up or slows down evenly, is followed exactly. One that
 * slows down ends at a halt and does not turn back; what speeding up adds is bounded by what the
 * speed of now does. A jump is no motion: until it has left the last frames nothing is said.
 */
#ifndef SAMPLES_STREAMING_MOTION_H
#define SAMPLES_STREAMING_MOTION_H

#include <stdbool.h>
#include <stdint.h>

#include "camera.h"

#define MOTION_FRAMES 5 ///< that are looked at

/** Zero-initialize. */
struct motion {
    struct camera past[MOTION_FRAMES]; ///< oldest first; the last `count` of them
    double times[MOTION_FRAMES];       ///< seconds
    uint32_t count;
};

/**
 * What the camera is at `seconds`. What is not finite, looks nowhere or is not later than the frame
 * before makes all of the past forgotten; so does a gap of more than MOTION_LONGEST_STEP.
 */
void motion_add(struct motion *motion, const struct camera *camera, double seconds);

#define MOTION_LONGEST_STEP 0.25 ///< seconds between two frames

/**
 * Writes where the camera will be `seconds` (0 and more) after the last frame, `target` as far away
 * as it is now. False if that is where it is, or if nothing can be said: then it is where it is, or
 * zero if there was no frame at all.
 */
bool motion_look_ahead(const struct motion *motion, double seconds, struct camera *ahead);

#endif /* SAMPLES_STREAMING_MOTION_H */
