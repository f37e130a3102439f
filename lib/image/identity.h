/** Asks sources which regions of theirs have equal texels. */
#ifndef SLC_IMAGE_IDENTITY_H
#define SLC_IMAGE_IDENTITY_H

#include <sluice/image.h>

/** Calls pfnIdentifyRegion. Returns false for sources without it. */
static inline bool slc_identify_region(SluiceImageSource *source, const SluiceImageRegion *region,
                                       uint64_t *identity)
{
    bool (*identify)(SluiceImageSource *, const SluiceImageRegion *, uint64_t *) =
        source->pInterface->pfnIdentifyRegion;
    return identify && identify(source, region, identity);
}

#endif /* SLC_IMAGE_IDENTITY_H */
