/* What shaders write into the feedback buffer for each region, see sluice/feedback.glsl. */
#ifndef SLUICE_SHARED_FEEDBACK_H
#define SLUICE_SHARED_FEEDBACK_H

/* A word: the finest level, SLUICE_MIP_UNTOUCHED if there is none. */
#define SLUICE_FEEDBACK_LEVELS 0
/* Half a word, the low half first: a bit per level, the last one for all coarser levels. */
#define SLUICE_FEEDBACK_MASKS 1
#define SLUICE_FEEDBACK_MASK_LEVELS 16

#endif
