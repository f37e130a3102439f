/* Flags of ProbeParams for the jitter shader. The low two bits are the kernel. */
#ifndef JITTER_SHARED_H
#define JITTER_SHARED_H

#include "probe_shared.h"

#define JITTER_KERNEL 3u
#define JITTER_OFFSETS 4u  /* uv are random numbers; red and green become the offset */
#define JITTER_FEEDBACK 8u /* feedback of all offsets at once */
#define JITTER_SAMPLE 16u  /* mean of JITTER_GRID^2 samples */
#define JITTER_GRID 32     /* random numbers are the middles of its cells */

#endif
