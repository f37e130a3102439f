/* Data of crowd.comp. */
#ifndef CROWD_SHARED_H
#define CROWD_SHARED_H

#include "sluice/shared/types.h"

#define CROWD_GROUP 64

struct CrowdOutput {
    float color[4];
    uint missing; /* SLUICE_MIP_UNTOUCHED: nothing is resident */
    uint padding[3];
};
SLUICE_SHARED_SIZE(struct CrowdOutput, 32)

struct CrowdParams {
    uint first; /* in the texture table */
    uint count;
    uint place; /* outputs of these begin here */
    uint padding;
};
SLUICE_SHARED_SIZE(struct CrowdParams, 16)

#endif
