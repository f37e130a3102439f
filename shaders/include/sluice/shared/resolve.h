/* Push constants of resolve/feedback.comp: a dispatch packs and clears one texture's feedback. */
#ifndef SLUICE_SHARED_RESOLVE_H
#define SLUICE_SHARED_RESOLVE_H

#include "types.h"

#define SLUICE_RESOLVE_GROUP_SIZE 64

struct SluiceResolveParams {
    uint feedbackOffset; /* first word in the feedback buffer */
    uint regionCount;
    uint resolvedOffset; /* first word in the readback buffer; four regions per word */
};
SLUICE_SHARED_SIZE(struct SluiceResolveParams, 12)

#endif
