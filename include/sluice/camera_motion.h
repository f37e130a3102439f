/**
 * Predicts where a camera will be, so that tiles are requested before they are in view.
 *
 * Each frame, add the view matrix of the camera. Then ask for the camera some time ahead, and draw
 * feedback, and nothing else, from there: small, with a depth test of its own, in the same
 * streaming frame as the picture. Its marks go into the feedback buffer of the picture.
 * docs/control.md shows the calls, docs/trade-offs.md how much they save.
 *
 * Pure functions without allocations. Thread safety: external on the motion.
 */
#ifndef SLUICE_CAMERA_MOTION_H
#define SLUICE_CAMERA_MOTION_H

#include <sluice/base.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SLUICE_CAMERA_FRAMES 5 ///< Frames that a prediction looks at.

/** Motion of a camera: its last frames. Zero-initialize; fields are private. Never grows. */
typedef struct SluiceCameraMotion {
    uint32_t count;
    float viewMatrix[16];
    double times[SLUICE_CAMERA_FRAMES];
    double eyes[SLUICE_CAMERA_FRAMES][3], axes[SLUICE_CAMERA_FRAMES][3];
} SluiceCameraMotion;

/**
 * Adds the camera of a frame. `pViewMatrix` is from world to camera: 16 floats in columns, a
 * rotation and a translation. The viewing direction may be +z or -z. World units are meters: less
 * than 4 mm of motion ahead counts as no motion.
 *
 * If `seconds` is not later than the frame before, or more than 0.25 s later, all earlier frames
 * are forgotten.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if the matrix scales or has a
 *         value that is not finite, or if `seconds` is not finite. All frames are then forgotten.
 */
SLUICE_API SluiceResult sluiceAddCameraFrame(SluiceCameraMotion *pMotion, const float *pViewMatrix,
                                             double seconds);

/** Settings of a prediction. */
typedef struct SluiceLookAheadInfo {
    uint32_t structSize; ///< sizeof(SluiceLookAheadInfo).
    /** Time to look ahead: about the time from a mark to the tile's display. Values that are not
     * above 0 predict no motion. */
    double seconds;
    uint64_t frameIndex; ///< Frames look ahead all the way and half of it, in turns.
    uint32_t pictureWidth, pictureHeight; ///< Pixels of the picture, above 0.
    uint32_t shrink; ///< Pixels of the picture per pixel of the feedback, per axis. Default: 4.
} SluiceLookAheadInfo;

/** The predicted camera, for a draw that marks tiles alone. */
typedef struct SluiceLookAhead {
    uint32_t structSize; ///< sizeof(SluiceLookAhead).
    /** The camera is going to move. If false, the feedback of the picture suffices. */
    bool draw;
    double seconds;         ///< How far ahead this frame looks.
    float viewMatrix[16];   ///< The camera there. Use the projection of the picture.
    uint32_t width, height; ///< Pixels to draw: picture size / `shrink`, rounded up.
    /** Add it to the level of detail of feedback, which has larger pixels than the picture:
     * -log2(shrink). */
    float lodBias;
} SluiceLookAhead;

/**
 * Predicts the camera from its last 5 frames.
 *
 * A motion of constant speed or constant acceleration is followed exactly. Turns of the viewing
 * direction are followed nearly; rolls about it are not predicted. A motion that slows down ends at
 * a halt and does not turn back. Acceleration at most doubles the distance that the present speed
 * gives. A jump is no motion: until it has left the last 5 frames, `draw` is false.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a picture without pixels, or
 *         for a wrong structSize.
 */
SLUICE_API SluiceResult sluicePredictCamera(const SluiceCameraMotion *pMotion,
                                            const SluiceLookAheadInfo *pInfo,
                                            SluiceLookAhead *pLookAhead);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_CAMERA_MOTION_H */
