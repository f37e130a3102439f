/**
 * Predicts how many pixels must write feedback.
 *
 * The probability, the number of textures read back per frame, the frame rate and the timeout are
 * one parameter set. All functions are pure. The derivation and a table are in docs/trade-offs.md.
 *
 * The results are conservative. They hold for any position of a region among the quads of the
 * screen, for any frame of its texture's turn, and for a manager that evicts only by timeout
 * (missesToExpire 1). A manager that learns the reliability of maps keeps regions longer.
 *
 * Thread safety: any thread.
 */
#ifndef SLUICE_FEEDBACK_RATE_H
#define SLUICE_FEEDBACK_RATE_H

#include <sluice/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * How shaders select the pixels that write feedback. See shaders/include/sluice/stochastic.glsl.
 */
typedef enum SluiceFeedbackSelection {
    /** Each pixel decides on its own: sluiceSelectRandom with the pixel as `place`. */
    SLUICE_FEEDBACK_SELECTION_RANDOM_PIXELS = 0,
    /**
     * sluiceSelectRandomQuad or sluiceSelectRandomFragmentQuad, then sluiceWriteFeedback. A quad
     * marks the region if any of its pixels touches it.
     */
    SLUICE_FEEDBACK_SELECTION_RANDOM_QUADS = 1,
    /**
     * Like RANDOM_QUADS, but with sluiceWriteQuadFeedback and a seed that grows by 1 per frame.
     * Quads at the edge of a region, which only one corner of a footprint reaches, mark it in one
     * frame of four. With feedbackInTurns such quads are certain to mark it only if the turns are
     * an odd number of frames apart.
     */
    SLUICE_FEEDBACK_SELECTION_SHARED_QUADS = 2,
    /** sluiceSelectLattice or sluiceSelectFragmentLattice, then sluiceWriteFeedback. */
    SLUICE_FEEDBACK_SELECTION_LATTICE = 3
} SluiceFeedbackSelection;

/** Parameters of the prediction, except the probability. */
typedef struct SluiceFeedbackRate {
    uint32_t structSize; ///< sizeof(SluiceFeedbackRate).
    SluiceFeedbackSelection selection;
    /**
     * Size in pixels, at least 1, of the smallest region that matters: the rectangle of pixels
     * whose samples touch it. Any visible part of a tile of level 0 is a region.
     */
    uint32_t regionWidth, regionHeight;
    uint32_t textureCount;     ///< Textures whose maps are read back in turn. At least 1.
    uint32_t texturesPerFrame; ///< Clamped to textureCount. Default: 10.
    bool inTurns;          ///< feedbackInTurns: shaders mark only textures read back in that frame.
    double frameRate;      ///< Hz. Above 0 and finite.
    double timeoutSeconds; ///< 0 (only the newest map counts) to infinity.
} SluiceFeedbackRate;

/**
 * Predicts the probability that a region which stays in view is evicted by mistake, because no map
 * within one timeout shows it. Writes it to `*pMiss`, 0 to 1.
 *
 * The lattice is not random: for it the result is the share of frames, as first frame of a timeout,
 * from which that happens, for the worst position of the region.
 *
 * `probability` is the shader's, 0 to 1, rounded up to a multiple of 2^-23. The lattice ignores it.
 * The relative error is at most 5e-16 * (1 - ln(*pMiss)) while *pMiss is a normal number.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for values out of range.
 *         `*pMiss` is unchanged then.
 */
SLUICE_API SluiceResult sluicePredictFeedbackMiss(const SluiceFeedbackRate *pRate,
                                                  double probability, double *pMiss);

/**
 * Finds the smallest probability, a multiple of 2^-23, for which sluicePredictFeedbackMiss gives at
 * most `allowedMiss`. Writes it to `*pProbability`.
 *
 * `allowedMiss` is at least 0 and below 1; 0 means exactly 0. For the lattice the result is 1/64,
 * its share of pixels, if that suffices.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT; SLUICE_ERROR_LIMIT_EXCEEDED if
 *         no probability suffices: the maps of one timeout can miss the region even if every pixel
 *         writes. `*pProbability` is unchanged then.
 */
SLUICE_API SluiceResult sluiceChooseFeedbackProbability(const SluiceFeedbackRate *pRate,
                                                        double allowedMiss, float *pProbability);

/**
 * Delay in frames from the first frame that shows a region to the frame whose map reports it,
 * counting both. Infinity if that may never happen.
 */
typedef struct SluiceFeedbackDelay {
    uint32_t structSize; ///< sizeof(SluiceFeedbackDelay).
    double median;       ///< Half of the regions take no longer.
    double percentile99; ///< 99 of 100 regions take no longer.
} SluiceFeedbackDelay;

/**
 * Predicts how long it takes to notice a region that comes into view. Writes it to `*pDelay`.
 *
 * The timeout does not matter. Frames until the GPU has finished and the map is on the host are not
 * counted.
 *
 * Arguments, errors: as sluicePredictFeedbackMiss.
 */
SLUICE_API SluiceResult sluicePredictFeedbackDelay(const SluiceFeedbackRate *pRate,
                                                   double probability, SluiceFeedbackDelay *pDelay);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_FEEDBACK_RATE_H */
