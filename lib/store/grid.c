#include "store/grid.h"

#include "base/checked.h"
#include "image/format_size.h"

static uint64_t align(uint64_t size)
{
    return (size + SLC_STORE_ALIGNMENT - 1) / SLC_STORE_ALIGNMENT * SLC_STORE_ALIGNMENT;
}

static bool is_in_tail(const SluiceStoreLayout *layout, uint32_t level)
{
    uint32_t width = slc_mip_size(layout->width, level);
    uint32_t height = slc_mip_size(layout->height, level);
    return width <= layout->tileWidth && height <= layout->tileHeight &&
           (width < layout->tileWidth || height < layout->tileHeight);
}

static uint64_t level_size(const SluiceStoreLayout *layout, uint32_t level)
{
    return sluiceGetFormatRegionSize(layout->format, slc_mip_size(layout->width, level),
                                     slc_mip_size(layout->height, level));
}

static void lay_out_levels(SluiceStoreLayout *layout)
{
    layout->mipLevelCount = slc_mip_count(slc_max_u32(layout->width, layout->height));
    layout->tailFirstLevel = layout->mipLevelCount;
    layout->tileCount = 1;
    for (uint32_t level = 0; level < layout->mipLevelCount; level++) {
        uint32_t width = slc_div_up_u32(slc_mip_size(layout->width, level), layout->tileWidth);
        uint32_t height = slc_div_up_u32(slc_mip_size(layout->height, level), layout->tileHeight);
        layout->levelWidthInTiles[level] = width;
        layout->levelHeightInTiles[level] = height;
        if (!is_in_tail(layout, level)) {
            layout->tileCount += (uint64_t)width * height;
            continue;
        }
        layout->tailFirstLevel = slc_min_u32(layout->tailFirstLevel, level);
        layout->tailSize += (uint32_t)level_size(layout, level);
    }
}

SluiceResult sluiceGetStoreLayout(uint32_t width, uint32_t height, SluiceFormat format,
                                  SluiceStoreLayout *pLayout)
{
    if (!pLayout)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceStoreLayout layout = {.width = width, .height = height, .format = format};
    SluiceResult result = sluiceGetStandardTileShape(format, &layout.tileWidth, &layout.tileHeight);
    if (result != SLUICE_SUCCESS)
        return result;
    if (width == 0 || height == 0 || width > SLUICE_STORE_MAX_SIZE ||
        height > SLUICE_STORE_MAX_SIZE)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    lay_out_levels(&layout);
    *pLayout = layout;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetStoreTileRegion(const SluiceStoreLayout *pLayout, uint32_t mipLevel,
                                      uint32_t tileX, uint32_t tileY, SluiceImageRegion *pRegion)
{
    if (!pLayout || !pRegion)
        return SLUICE_ERROR_NULL_POINTER;
    if (mipLevel >= pLayout->mipLevelCount || tileX >= pLayout->levelWidthInTiles[mipLevel] ||
        tileY >= pLayout->levelHeightInTiles[mipLevel])
        return SLUICE_ERROR_INVALID_ARGUMENT;
    SluiceImageRegion region = {
        .mipLevel = mipLevel, .x = tileX * pLayout->tileWidth, .y = tileY * pLayout->tileHeight};
    region.width =
        slc_min_u32(pLayout->tileWidth, slc_mip_size(pLayout->width, mipLevel) - region.x);
    region.height =
        slc_min_u32(pLayout->tileHeight, slc_mip_size(pLayout->height, mipLevel) - region.y);
    *pRegion = region;
    return SLUICE_SUCCESS;
}

SluiceResult slc_store_grid_init(struct slc_store_grid *grid, uint32_t width, uint32_t height,
                                 SluiceFormat format, uint32_t layer_count)
{
    *grid = (struct slc_store_grid){.layer_count = layer_count};
    SluiceResult result = sluiceGetStoreLayout(width, height, format, &grid->layout);
    if (result != SLUICE_SUCCESS)
        return result;
    if (layer_count == 0 || layer_count > SLUICE_STORE_MAX_ARRAY_LAYERS)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    grid->format.structSize = sizeof grid->format;
    result = sluiceGetFormatInfo(format, &grid->format);
    if (result != SLUICE_SUCCESS)
        return result;
    /* At most 2^14 x 2^14 tiles of 2^16 bytes in level 0, so all sums fit into 63 bits. */
    grid->chunk_count = grid->layout.tileCount * layer_count;
    for (uint32_t level = 0; level < grid->layout.tailFirstLevel; level++) {
        struct slc_store_place end = {0, level, 0, grid->layout.levelHeightInTiles[level]};
        grid->first_chunk[level + 1] = slc_store_chunk_number(grid, &end);
        grid->first_byte[level + 1] = slc_store_chunk_offset(grid, &end);
    }
    grid->layer_size = grid->first_byte[grid->layout.tailFirstLevel] + align(grid->layout.tailSize);
    return SLUICE_SUCCESS;
}

bool slc_store_grid_find(const struct slc_store_grid *grid, uint32_t layer, uint32_t level,
                         uint32_t x, uint32_t y, struct slc_store_place *place)
{
    const SluiceStoreLayout *layout = &grid->layout;
    if (layer >= grid->layer_count || level >= layout->mipLevelCount ||
        x >= layout->levelWidthInTiles[level] || y >= layout->levelHeightInTiles[level])
        return false;
    *place = (struct slc_store_place){layer, slc_min_u32(level, layout->tailFirstLevel), x, y};
    return true;
}

uint64_t slc_store_chunk_number(const struct slc_store_grid *grid,
                                const struct slc_store_place *place)
{
    return place->layer * grid->layout.tileCount + grid->first_chunk[place->level] +
           (uint64_t)place->y * grid->layout.levelWidthInTiles[place->level] + place->x;
}

struct slc_store_place slc_store_chunk_place(const struct slc_store_grid *grid, uint64_t number)
{
    uint64_t rest = number % grid->layout.tileCount;
    struct slc_store_place place = {(uint32_t)(number / grid->layout.tileCount),
                                    grid->layout.tailFirstLevel, 0, 0};
    while (rest < grid->first_chunk[place.level])
        place.level--;
    rest -= grid->first_chunk[place.level];
    place.x = (uint32_t)(rest % grid->layout.levelWidthInTiles[place.level]);
    place.y = (uint32_t)(rest / grid->layout.levelWidthInTiles[place.level]);
    return place;
}

SluiceImageRegion slc_store_chunk_region(const struct slc_store_grid *grid,
                                         const struct slc_store_place *place)
{
    SluiceImageRegion region = {0};
    sluiceGetStoreTileRegion(&grid->layout, place->level, place->x, place->y, &region);
    region.arrayLayer = place->layer;
    return region;
}

uint32_t slc_store_chunk_size(const struct slc_store_grid *grid,
                              const struct slc_store_place *place)
{
    if (slc_store_is_tail(grid, place))
        return grid->layout.tailSize;
    SluiceImageRegion region = slc_store_chunk_region(grid, place);
    return (uint32_t)sluiceGetFormatRegionSize(grid->layout.format, region.width, region.height);
}

uint64_t slc_store_chunk_offset(const struct slc_store_grid *grid,
                                const struct slc_store_place *place)
{
    uint64_t layer = place->layer * grid->layer_size + grid->first_byte[place->level];
    if (slc_store_is_tail(grid, place))
        return layer;
    /* The last column and the last row may be narrower and lower than what is before them. */
    const SluiceStoreLayout *layout = &grid->layout;
    uint32_t columns = layout->levelWidthInTiles[place->level];
    uint32_t rows = layout->levelHeightInTiles[place->level];
    struct slc_store_place first = {0, place->level, 0, 0},
                           right = {0, place->level, columns - 1, 0};
    uint64_t row_size = (columns - 1) * align(slc_store_chunk_size(grid, &first)) +
                        align(slc_store_chunk_size(grid, &right));
    if (place->y < rows) {
        first.y = place->y;
        return layer + place->y * row_size + place->x * align(slc_store_chunk_size(grid, &first));
    }
    first.y = right.y = rows - 1; /* behind the last row: where the next level begins */
    return layer + (rows - 1) * row_size +
           (columns - 1) * align(slc_store_chunk_size(grid, &first)) +
           align(slc_store_chunk_size(grid, &right));
}

uint32_t slc_store_tail_offset(const struct slc_store_grid *grid, uint32_t level)
{
    uint64_t offset = 0;
    for (uint32_t l = grid->layout.tailFirstLevel; l < level; l++)
        offset += level_size(&grid->layout, l);
    return (uint32_t)offset;
}
