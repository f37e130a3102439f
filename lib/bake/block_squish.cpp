#include "bake/block_squish.h"

#include <squish.h>

extern "C" void slc_squish_block(enum slc_block_kind kind, const uint8_t rgba[64], uint32_t mask,
                                 void *block)
{
    static const int flags[] = {squish::kDxt1, squish::kDxt5, squish::kBc4, squish::kBc5};
    squish::CompressMasked(rgba, static_cast<int>(mask), block,
                           flags[kind] | squish::kColourClusterFit);
}
