/** The first mip levels of another source. */
#ifndef TESTS_DEVICE_CUT_SOURCE_H
#define TESTS_DEVICE_CUT_SOURCE_H

#include <sluice/image.h>

struct cut_source {
    SluiceImageSource base;
    SluiceImageSource *whole;
    uint32_t level_count;
};

/** Takes `whole` over: sluiceDestroyImageSource(&cut->base) destroys it. */
void cut_source_init(struct cut_source *cut, SluiceImageSource *whole, uint32_t level_count);

#endif /* TESTS_DEVICE_CUT_SOURCE_H */
