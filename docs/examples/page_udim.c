/* Lines that demand.md shows about UDIM sets. Compiled, not run. */
#include <sluice/demand.h>
#include <sluice/open.h>
#include <sluice/udim.h>

enum { ROWS = 10, PATH_SIZE = 256 };

struct cell {
    SluiceImageOpener *opener;
    char path[PATH_SIZE];
};

/* On a worker thread, when the cell is first sampled. */
static SluiceResult open_cell(void *user, SluiceImageSource **source)
{
    struct cell *cell = user;
    return sluiceOpenImageSource(cell->opener, cell->path, source);
}

/* `cells`: one for each of 10 columns and ROWS rows; lives as long as the textures. */
SluiceResult add_udim_set(SluiceDemandLoader *loader, SluiceImageOpener *opener,
                          const char *pattern, struct cell *cells, SluiceDemandTextureId baseId,
                          SluiceDemandTextureId *pGridId);
SluiceResult add_udim_set(SluiceDemandLoader *loader, SluiceImageOpener *opener,
                          const char *pattern, struct cell *cells, SluiceDemandTextureId baseId,
                          SluiceDemandTextureId *pGridId)
{
    uint32_t numbers[SLUICE_UDIM_COLUMNS * ROWS], count = SLUICE_UDIM_COLUMNS * ROWS;
    SluiceDemandTextureId ids[SLUICE_UDIM_COLUMNS * ROWS] = {SLUICE_NO_DEMAND_TEXTURE};
    SluiceResult result = sluiceFindUdimFiles(pattern, NULL, &count, numbers);
    for (uint32_t i = 0; i < count && result == SLUICE_SUCCESS; i++) {
        uint32_t at = numbers[i] - SLUICE_UDIM_FIRST; /* column + 10 * row */
        SluiceDemandTextureCreateInfo texture = {
            .structSize = sizeof texture,
            .image = {.pUserData = &cells[at], .pfnOpen = open_cell, .pName = cells[at].path},
            .failureColor = {1, 0, 1, 1}};
        if (at >= SLUICE_UDIM_COLUMNS * ROWS)
            break; /* more rows than the grid has */
        cells[at].opener = opener;
        result = sluiceWriteUdimPath(pattern, numbers[i], NULL, PATH_SIZE, cells[at].path);
        if (result == SLUICE_SUCCESS)
            result = sluiceAddDemandTexture(loader, &texture, &ids[at]);
    }
    SluiceDemandGridCreateInfo grid = {.structSize = sizeof grid,
                                       .columnCount = SLUICE_UDIM_COLUMNS,
                                       .rowCount = ROWS,
                                       .pTextureIds = ids,
                                       .baseId = baseId};
    if (result == SLUICE_SUCCESS)
        result = sluiceAddDemandGrid(loader, &grid, pGridId);
    return result;
}
