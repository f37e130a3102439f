/**
 * How many pixels should write feedback: the probability, the textures that are read back per
 * frame, the frame rate and the timeout are one parameter set. Pure functions, any thread; the
 * derivation and a table are in docs/trade-offs.md.
 *
 * The answers are on the safe side: they hold for a region wherever it lies among the quads of the
 * screen, whatever frame its texture's turn comes in, and for a manager that goes by the timeout
 * alone (missesToForget 1). One that learns how reliable maps are holds regions longer.
 */
#ifndef SLUICE_FEEDBACK_RATE_H
#define SLUICE_FEEDBACK_RATE_H

#include <sluice/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How the pixels that write are selected: the functions of shaders/include/sluice/stochastic.glsl.
 */
typedef enum SluiceFeedbackSelection {
    /** Each pixel draws for itself: sluiceSelectRandom with the pixel as the place. */
    SLUICE_FEEDBACK_SELECTION_RANDOM_PIXELS = 0,
    /** sluiceSelectRandomQuad or sluiceSelectRandomFragmentQuad, then sluiceWriteFeedback: a quad
     * that touches the region with any of its pixels marks it. */
    SLUICE_FEEDBACK_SELECTION_RANDOM_QUADS = 1,
    /**
     * The same, then sluiceWriteQuadFeedback with a seed that grows by 1 from frame to frame: quads
     * at the rim of a region, reached by one corner of a footprint, mark it in one frame of four
     * only. In turns that rim is sure to be marked only if the turns lie an odd number of frames
     * apart.
     */
    SLUICE_FEEDBACK_SELECTION_SHARED_QUADS = 2,
    /** sluiceSelectLattice or sluiceSelectFragmentLattice, then sluiceWriteFeedback. */
    SLUICE_FEEDBACK_SELECTION_LATTICE = 3
} SluiceFeedbackSelection;

/** What the chance depends on, but for the probability. */
typedef struct SluiceFeedbackRate {
    SluiceFeedbackSelection selection;
    /** Pixels of the smallest region that matters, at least 1: those whose samples touch it, a
     *  rectangle on screen. Any visible part of a tile of level 0 is a region. */
    uint32_t regionWidth, regionHeight;
    uint32_t textureCount;     ///< whose maps are read back in turn; at least 1
    uint32_t texturesPerFrame; ///< 0: 10; beyond textureCount: that
    bool inTurns;     ///< feedbackInTurns: marks are made only in frames that read them back
    double frameRate; ///< Hz, above 0, finite
    double timeout;   ///< s, 0 (only the newest map counts) to infinity
} SluiceFeedbackRate;

/**
 * Writes to *pMiss the chance, 0 to 1, that no map of one timeout shows the region although it is
 * in view all the time, so that it is evicted wrongly. Of the lattice, which draws nothing: the
 * share of the first frames of a timeout from which that happens, where the region lies worst.
 *
 * `probability` is 0 to 1, as handed to the shader, which knows steps of 2^-23 and takes the next
 * greater one; the lattice does not look at it. The relative error is at most
 * 5e-16 * (1 - ln(*pMiss)), as far as *pMiss is a normal number.
 *
 * Errors: NULL_POINTER; INVALID_ARGUMENT for values outside the ranges above. *pMiss is unchanged
 * then.
 */
SLUICE_API SluiceResult sluicePredictFeedbackMiss(const SluiceFeedbackRate *pRate,
                                                  double probability, double *pMiss);

/**
 * Writes to *pProbability the least multiple of 2^-23 with which sluicePredictFeedbackMiss is at
 * most `allowedMiss`, 0 (the chance 0 itself, not a number too small) to below 1. Of the lattice
 * 1/64, the share of pixels that write, if that is enough.
 *
 * Errors: NULL_POINTER; INVALID_ARGUMENT; LIMIT_EXCEEDED if no probability is enough: maps of the
 * timeout miss the region whatever is drawn. *pProbability is unchanged then.
 */
SLUICE_API SluiceResult sluiceChooseFeedbackProbability(const SluiceFeedbackRate *pRate,
                                                        double allowedMiss, float *pProbability);

/** Frames from the first one that shows a region to the one whose map tells of it, counting both;
 *  infinity if that may never come. */
typedef struct SluiceFeedbackDelay {
    double median;       ///< not exceeded by half of the regions
    double percentile99; ///< nor by 99 of 100
} SluiceFeedbackDelay;

/**
 * How long it takes to notice a region that comes into view; the timeout has no part in that. The
 * frames until the GPU is done and the map is on the host are not counted. Arguments, errors as
 * sluicePredictFeedbackMiss.
 */
SLUICE_API SluiceResult sluicePredictFeedbackDelay(const SluiceFeedbackRate *pRate,
                                                   double probability, SluiceFeedbackDelay *pDelay);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_FEEDBACK_RATE_H */
