/* Pages: rectangles of mips with the same latent images. */
#include "neural/neural_set.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/checked.h"

#include <sluice/neural_pages.h>

#include <assert.h>
#include <string.h>

#define LEAST_EDGE 8u
#define MAX_GROUP_PAGES (1u << 20)
#define ALIGNMENT 16u /* alignment of byte pages */

static SluiceResult page_size(const SluiceNeuralSet *set, const SluiceNeuralPageGroup *group,
                              uint64_t *size)
{
    const SluiceNeuralRequest request = {.firstMip = group->firstMip,
                                         .mipCount = group->mipCount,
                                         .width = group->pageWidth,
                                         .height = group->pageHeight};
    SluiceResult result = sluiceBoundNeuralLatents(
        set, &request, group->pageWidth < group->pageHeight ? group->pageWidth : group->pageHeight,
        size);
    *size += sizeof(SluiceNeuralConstants);
    return result;
}

/* Finds the page size of a group: the largest power of two that fits, or a whole side. */
static SluiceResult lay_out_group(const SluiceNeuralSet *set, uint32_t width, uint32_t height,
                                  uint32_t max_size, SluiceNeuralPageGroup *group, uint64_t *size)
{
    const uint32_t least = slc_max_u32(LEAST_EDGE, 1u << (group->mipCount - 1));
    uint32_t larger = slc_max_u32(width, height), edge = 1;
    while (edge < larger)
        edge *= 2;
    for (;; edge /= 2) {
        group->pageWidth = slc_min_u32(edge, width);
        group->pageHeight = slc_min_u32(edge, height);
        SluiceResult result = page_size(set, group, size);
        if (result != SLUICE_SUCCESS)
            return result;
        if (*size <= max_size)
            break;
        if (edge / 2 < least)
            return SLUICE_ERROR_LIMIT_EXCEEDED;
    }
    group->columns = slc_div_up_u32(width, group->pageWidth);
    group->rows = slc_div_up_u32(height, group->pageHeight);
    if ((uint64_t)group->columns * group->rows > MAX_GROUP_PAGES)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceLayOutNeuralPages(const SluiceNeuralSet *set, uint32_t maxPageSize,
                                     SluiceNeuralPages *pPages)
{
    if (!set || !pPages)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceNeuralSetInfo info = {.structSize = sizeof info};
    SluiceResult result = sluiceGetNeuralSetInfo(set, &info);
    SluiceNeuralPages pages = {.width = info.width,
                               .height = info.height,
                               .mipCount = info.mipCount,
                               .channelCount = info.channelCount};
    for (uint32_t mip = 0; mip < info.mipCount && result == SLUICE_SUCCESS;) {
        SluiceNeuralMip description = {.structSize = sizeof description};
        SluiceNeuralPageGroup *group = &pages.groups[pages.groupCount++];
        uint64_t size = 0;
        result = sluiceGetNeuralMip(set, mip, &description);
        if (result != SLUICE_SUCCESS)
            break;
        assert(description.firstFusedMip == mip);
        *group = (SluiceNeuralPageGroup){
            .firstMip = mip, .mipCount = description.fusedMipCount, .firstPage = pages.pageCount};
        result = lay_out_group(set, description.width, description.height,
                               maxPageSize / ALIGNMENT * ALIGNMENT, group, &size);
        pages.pageCount += group->columns * group->rows;
        pages.pageSize = slc_max_u32(pages.pageSize, (uint32_t)size);
        mip += description.fusedMipCount;
    }
    if (result != SLUICE_SUCCESS)
        return result;
    pages.pageSize = slc_div_up_u32(pages.pageSize, ALIGNMENT) * ALIGNMENT;
    *pPages = pages;
    return SLUICE_SUCCESS;
}

static const SluiceNeuralPageGroup *find_group(const SluiceNeuralPages *pages, uint32_t page)
{
    for (uint32_t i = 0; i < pages->groupCount && i < SLUICE_NEURAL_MAX_LATENT_IMAGES; i++) {
        const SluiceNeuralPageGroup *group = &pages->groups[i];
        if (page - group->firstPage < group->columns * group->rows)
            return group;
    }
    return NULL;
}

static SluiceNeuralRequest rectangle(const SluiceNeuralPages *pages,
                                     const SluiceNeuralPageGroup *group, uint32_t page)
{
    uint32_t index = page - group->firstPage;
    SluiceNeuralRequest r = {.firstMip = group->firstMip,
                             .mipCount = group->mipCount,
                             .x = index % group->columns * group->pageWidth,
                             .y = index / group->columns * group->pageHeight};
    r.width = slc_min_u32(group->pageWidth, slc_mip_size(pages->width, group->firstMip) - r.x);
    r.height = slc_min_u32(group->pageHeight, slc_mip_size(pages->height, group->firstMip) - r.y);
    return r;
}

SluiceResult sluiceReadNeuralPage(const SluiceNeuralSet *set, const SluiceNeuralPages *pPages,
                                  uint32_t page, void *pBytes)
{
    if (!set || !pPages || !pBytes)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceNeuralPages made;
    const SluiceNeuralPageGroup *group = find_group(pPages, page);
    if (page >= pPages->pageCount || !group ||
        sluiceLayOutNeuralPages(set, pPages->pageSize, &made) != SLUICE_SUCCESS ||
        memcmp(&made, pPages, sizeof made))
        return slc_log_refusal(&set->file.log,
                               "%s: page is %u of %u, or the pages are those of "
                               "another set",
                               set->file.path, page, pPages->pageCount);
    const SluiceNeuralRequest request = rectangle(pPages, group, page);
    const SluiceAllocationCallbacks *cb = &set->allocator;
    /* Latents are not read in the order of their bytes, and the memory may be slow to read. */
    unsigned char *bytes = slc_alloc(cb, pPages->pageSize, 1);
    if (!bytes)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceNeuralConstants constants;
    uint64_t size = pPages->pageSize - sizeof constants;
    SluiceResult result =
        sluiceReadNeuralLatents(set, &request, &constants, &size, bytes + sizeof constants);
    if (result == SLUICE_SUCCESS) {
        memcpy(bytes, &constants, sizeof constants);
        memset(bytes + sizeof constants + size, 0, pPages->pageSize - sizeof constants - size);
        memcpy(pBytes, bytes, pPages->pageSize);
    }
    slc_free(cb, bytes, pPages->pageSize, 1);
    return result;
}
