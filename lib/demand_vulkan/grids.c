/* UDIM grids: textures that are sampled as one. Their cells are words in the buffer of levels. */
#include "base/checked.h"
#include "demand_vulkan/loader.h"
#include "demand_vulkan/refused_arguments.h"

#include <sluice/shared/demand.h>

#include <inttypes.h>
#include <string.h>

static uint32_t *grid_words(SluiceDemandLoader *loader, uint32_t element)
{
    return ((struct slc_mirror_element *)slc_table_mirror_change(&loader->grids, element))->words;
}

/* The cells of a grid begin at an element of the part of the buffer that grids have. */
static void write_cell(SluiceDemandLoader *loader, uint32_t first_element, uint32_t cell,
                       uint32_t value)
{
    grid_words(loader, first_element + cell / 16)[cell % 16] = value;
}

static uint32_t read_cell(const SluiceDemandLoader *loader, uint32_t first_element, uint32_t cell)
{
    const struct slc_mirror_element *element =
        slc_table_mirror_get(&loader->grids, first_element + cell / 16);
    return element->words[cell % 16];
}

static SluiceResult check_cells(SluiceDemandLoader *loader, const SluiceDemandTextureId *ids,
                                uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t index;
        if (ids[i] == SLUICE_NO_DEMAND_TEXTURE)
            continue;
        SluiceResult result = slc_texture_find(loader, ids[i], &index);
        if (result != SLUICE_SUCCESS)
            return result;
        if (loader->textures[index].kind == SLC_TEXTURE_GRID)
            return slc_demand_refuse_grid(loader, "sluiceAddDemandUdim", ids[i]);
    }
    return SLUICE_SUCCESS;
}

static SluiceResult take_cells(SluiceDemandLoader *loader, uint32_t count, uint32_t *first)
{
    uint32_t elements = slc_div_up_u32(count, 16);
    if (!slc_region_arena_take(&loader->grid_arena, elements, first))
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    SluiceResult result = slc_table_mirror_reserve(&loader->grids, *first + elements);
    if (result != SLUICE_SUCCESS)
        slc_region_arena_give(&loader->grid_arena, *first, elements);
    return result;
}

static void fill_grid(SluiceDemandLoader *loader, uint32_t index, uint32_t first,
                      const SluiceDemandTextureId *ids, uint32_t columns, uint32_t rows)
{
    struct slc_demand_texture *texture = &loader->textures[index];
    texture->kind = SLC_TEXTURE_GRID;
    texture->first_element = first;
    texture->cell_count = columns * rows;
    for (uint32_t i = 0; i < columns * rows; i++) {
        write_cell(loader, first, i, ids[i] ? (uint32_t)ids[i] : SLUICE_DEMAND_NO_TEXTURE);
        if (ids[i])
            loader->textures[(uint32_t)ids[i]].grid_uses++;
    }
}

SluiceResult sluiceAddDemandUdim(SluiceDemandLoader *loader,
                                 const SluiceDemandTextureId *pTextureIds, uint32_t columns,
                                 uint32_t rows, const float missingColor[4],
                                 SluiceDemandTextureId *pTextureId)
{
    uint32_t index, first;
    if (!loader || !pTextureIds || !missingColor || !pTextureId)
        return SLUICE_ERROR_NULL_POINTER;
    if (columns == 0 || rows == 0)
        return slc_demand_refuse(loader, __func__,
                                 "a grid of %" PRIu32 " x %" PRIu32 " textures is empty", columns,
                                 rows);
    if ((uint64_t)columns * rows > loader->grid_arena.size * (uint64_t)16)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    SluiceResult result = check_cells(loader, pTextureIds, columns * rows);
    if (result == SLUICE_SUCCESS)
        result = take_cells(loader, columns * rows, &first);
    if (result != SLUICE_SUCCESS)
        return result;
    result = slc_texture_take(loader, &index);
    if (result != SLUICE_SUCCESS) {
        slc_region_arena_give(&loader->grid_arena, first, slc_div_up_u32(columns * rows, 16));
        return result;
    }
    fill_grid(loader, index, first, pTextureIds, columns, rows);
    struct SluiceDemandTexture *entry = slc_table_mirror_change(&loader->table, index);
    *entry = (struct SluiceDemandTexture){.state = SLUICE_DEMAND_TEXTURE_UDIM,
                                          .width = columns,
                                          .height = rows,
                                          .levels = SLC_MAX_REGULAR_LEVELS *
                                                    (1 + loader->max_image_count + first),
                                          .maxAnisotropy = 1};
    memcpy(entry->baseColor, missingColor, sizeof entry->baseColor);
    *pTextureId = slc_texture_id(loader, index);
    return SLUICE_SUCCESS;
}

void slc_grids_leave(SluiceDemandLoader *loader, uint32_t index)
{
    for (uint32_t i = 1; i < loader->texture_high && loader->textures[index].grid_uses; i++) {
        const struct slc_demand_texture *grid = &loader->textures[i];
        for (uint32_t c = 0; grid->kind == SLC_TEXTURE_GRID && c < grid->cell_count; c++)
            if (read_cell(loader, grid->first_element, c) == index) {
                write_cell(loader, grid->first_element, c, SLUICE_DEMAND_NO_TEXTURE);
                loader->textures[index].grid_uses--;
            }
    }
}

void slc_grid_empty(SluiceDemandLoader *loader, const struct slc_demand_texture *grid)
{
    for (uint32_t c = 0; c < grid->cell_count; c++) {
        uint32_t index = read_cell(loader, grid->first_element, c);
        if (index != SLUICE_DEMAND_NO_TEXTURE)
            loader->textures[index].grid_uses--;
    }
}
