/* Encoding of a region in the feedback buffer. See sluice/feedback.glsl. */
#ifndef SLUICE_SHARED_FEEDBACK_H
#define SLUICE_SHARED_FEEDBACK_H

/* A word: the finest level, or SLUICE_MIP_UNTOUCHED. */
#define SLUICE_FEEDBACK_LEVELS 0
/* Half a word, low half first: a bit per level. The last bit stands for all coarser levels. */
#define SLUICE_FEEDBACK_MASKS 1
#define SLUICE_FEEDBACK_MASK_LEVELS 16

#endif
