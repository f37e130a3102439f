/* Flags of ProbeParams for the shader of stochastic samples. The low two bits are the kernel.
 * Inputs: lodBias is the LOD, maxAnisotropy is sigma. Outputs: footprint is the texel and whether
 * it is the border. */
#ifndef STOCHASTIC_STREAM_SHARED_H
#define STOCHASTIC_STREAM_SHARED_H

#include "probe_shared.h"

#define STOCHASTIC_KERNEL 3u
#define STOCHASTIC_MARK 4u
#define STOCHASTIC_WANTED 8u /* the texel that is wanted, whether it is resident or not */
#define STOCHASTIC_SEED_SHIFT 8

#endif
