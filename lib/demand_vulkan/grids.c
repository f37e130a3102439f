/* Grids: textures that are sampled as one. Their cells are words in the buffer of levels. */
#include "base/checked.h"
#include "base/struct_size.h"
#include "demand_vulkan/loader.h"
#include "demand_vulkan/refused_arguments.h"

#include <sluice/shared/demand.h>

#include <inttypes.h>
#include <string.h>

static uint32_t *grid_words(SluiceDemandLoader *loader, uint32_t element)
{
    return ((struct slc_mirror_element *)slc_table_mirror_change(&loader->grids, element))->words;
}

/* Writes a cell. `first_element`: first element of the grid's cells in the grids' part of the
 * buffer. */
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

static SluiceResult check_member(SluiceDemandLoader *loader, SluiceDemandTextureId id)
{
    uint32_t index;
    if (id == SLUICE_NO_DEMAND_TEXTURE)
        return SLUICE_SUCCESS;
    SluiceResult result = slc_texture_find(loader, id, &index);
    if (result == SLUICE_SUCCESS && loader->textures[index].kind == SLC_TEXTURE_GRID)
        return slc_demand_refuse_grid(loader, "sluiceAddDemandGrid", id);
    return result;
}

static SluiceResult check_cells(SluiceDemandLoader *loader, const SluiceDemandTextureId *ids,
                                uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        SluiceResult result = check_member(loader, ids[i]);
        if (result != SLUICE_SUCCESS)
            return result;
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
                      const SluiceDemandTextureId *ids, uint32_t count)
{
    struct slc_demand_texture *texture = &loader->textures[index];
    texture->kind = SLC_TEXTURE_GRID;
    texture->first_element = first;
    texture->cell_count = count;
    for (uint32_t i = 0; i < count; i++) {
        write_cell(loader, first, i, ids[i] ? (uint32_t)ids[i] : SLUICE_DEMAND_NO_TEXTURE);
        if (ids[i])
            loader->textures[(uint32_t)ids[i]].grid_uses++;
    }
}

static void show_grid(SluiceDemandLoader *loader, uint32_t index,
                      const SluiceDemandGridCreateInfo *info)
{
    struct SluiceDemandTexture *entry = slc_table_mirror_change(&loader->table, index);
    uint32_t first = loader->textures[index].first_element;
    *entry = (struct SluiceDemandTexture){.state = SLUICE_DEMAND_TEXTURE_GRID,
                                          .width = info->columnCount,
                                          .height = info->rowCount,
                                          .levels = SLC_MAX_REGULAR_LEVELS *
                                                    (1 + loader->max_image_count + first),
                                          .tailPage = (uint32_t)info->baseId,
                                          .maxAnisotropy = 1};
    memcpy(entry->baseColor, info->missingColor, sizeof entry->baseColor);
}

static SluiceResult add_grid(SluiceDemandLoader *loader, const SluiceDemandGridCreateInfo *info,
                             SluiceDemandTextureId *id)
{
    uint32_t index, first, count = info->columnCount * info->rowCount;
    SluiceResult result = check_cells(loader, info->pTextureIds, count);
    if (result == SLUICE_SUCCESS)
        result = check_member(loader, info->baseId);
    if (result == SLUICE_SUCCESS)
        result = take_cells(loader, count, &first);
    if (result != SLUICE_SUCCESS)
        return result;
    result = slc_texture_take(loader, &index);
    if (result != SLUICE_SUCCESS) {
        slc_region_arena_give(&loader->grid_arena, first, slc_div_up_u32(count, 16));
        return result;
    }
    fill_grid(loader, index, first, info->pTextureIds, count);
    if (info->baseId != SLUICE_NO_DEMAND_TEXTURE)
        loader->textures[(uint32_t)info->baseId].grid_uses++;
    show_grid(loader, index, info);
    *id = slc_texture_id(loader, index);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceAddDemandGrid(SluiceDemandLoader *loader,
                                 const SluiceDemandGridCreateInfo *pCreateInfo,
                                 SluiceDemandTextureId *pTextureId)
{
    if (!loader || !pCreateInfo || !pTextureId)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceDemandGridCreateInfo info = {.structSize = sizeof info};
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceDemandGridCreateInfo), &info,
                                          pCreateInfo, &loader->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!info.pTextureIds)
        return SLUICE_ERROR_NULL_POINTER;
    if (info.columnCount == 0 || info.rowCount == 0)
        return slc_demand_refuse(loader, __func__,
                                 "a grid of %" PRIu32 " x %" PRIu32 " textures is empty",
                                 info.columnCount, info.rowCount);
    if ((uint64_t)info.columnCount * info.rowCount > loader->grid_arena.size * (uint64_t)16)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    return add_grid(loader, &info, pTextureId);
}

static uint32_t read_base(const SluiceDemandLoader *loader, uint32_t index)
{
    const struct SluiceDemandTexture *entry = slc_table_mirror_get(&loader->table, index);
    return entry->tailPage;
}

/* Removes the texture from a grid's cells, and as its base. */
static void leave_grid(SluiceDemandLoader *loader, uint32_t index, uint32_t at)
{
    const struct slc_demand_texture *grid = &loader->textures[at];
    for (uint32_t c = 0; c < grid->cell_count; c++)
        if (read_cell(loader, grid->first_element, c) == index) {
            write_cell(loader, grid->first_element, c, SLUICE_DEMAND_NO_TEXTURE);
            loader->textures[index].grid_uses--;
        }
    if (read_base(loader, at) != index)
        return;
    struct SluiceDemandTexture *entry = slc_table_mirror_change(&loader->table, at);
    entry->tailPage = 0;
    loader->textures[index].grid_uses--;
}

void slc_grids_leave(SluiceDemandLoader *loader, uint32_t index)
{
    for (uint32_t i = 1; i < loader->texture_high && loader->textures[index].grid_uses; i++)
        if (loader->textures[i].kind == SLC_TEXTURE_GRID)
            leave_grid(loader, index, i);
}

void slc_grid_empty(SluiceDemandLoader *loader, uint32_t index)
{
    const struct slc_demand_texture *grid = &loader->textures[index];
    uint32_t base = read_base(loader, index);
    for (uint32_t c = 0; c < grid->cell_count; c++) {
        uint32_t member = read_cell(loader, grid->first_element, c);
        if (member != SLUICE_DEMAND_NO_TEXTURE)
            loader->textures[member].grid_uses--;
    }
    if (base)
        loader->textures[base].grid_uses--;
}
