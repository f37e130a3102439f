#include "device/cut_source.h"

#include "support/test.h"

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    const struct cut_source *cut = (struct cut_source *)base;
    SluiceResult result = sluiceGetImageInfo(cut->whole, info);
    info->mipLevelCount = cut->level_count;
    return result;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    const struct cut_source *cut = (struct cut_source *)base;
    assert_true(region->mipLevel < cut->level_count);
    return sluiceReadImageRegion(cut->whole, region, texels, row_pitch);
}

static void destroy(SluiceImageSource *base)
{
    struct cut_source *cut = (struct cut_source *)base;
    sluiceDestroyImageSource(cut->whole);
    cut->whole = NULL;
}

void cut_source_init(struct cut_source *cut, SluiceImageSource *whole, uint32_t level_count)
{
    static const SluiceImageSourceInterface interface = {sizeof interface, get_info, read_region,
                                                         destroy};
    *cut = (struct cut_source){{&interface}, whole, level_count};
}
