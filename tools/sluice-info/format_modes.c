#include "format_modes.h"

#include <string.h>

#define YES "yes"
#define NEAREST "nearest only"

const char *const format_mode_names[FORMAT_MODES] = {"sparse", "paged", "dense", "demand"};

SluiceResidencyMode format_mode_residency(enum format_mode mode)
{
    static const SluiceResidencyMode modes[FORMAT_MODES] = {
        [FORMAT_MODE_SPARSE] = SLUICE_RESIDENCY_MODE_SPARSE,
        [FORMAT_MODE_PAGED] = SLUICE_RESIDENCY_MODE_PAGED,
        [FORMAT_MODE_DENSE] = SLUICE_RESIDENCY_MODE_DENSE,
        [FORMAT_MODE_DEMAND] = SLUICE_RESIDENCY_MODE_PAGED};
    return modes[mode];
}

/* Returns NULL, or the reason why sparse mode refuses the format. */
static const char *refuse_sparse(const SluiceVulkanFormatCapabilities *caps)
{
    if (!caps->tileWidth)
        return "no sparse image";
    return caps->sparse ? NULL : "tile not 64 KiB";
}

/* Returns NULL, or the reason why demand loading refuses the format. It places the levels of a mip
 * tail at multiples of 4 texels. */
static const char *refuse_demand(SluiceFormat format)
{
    SluiceFormatInfo info = {.structSize = sizeof info};
    if (sluiceGetFormatInfo(format, &info) != SLUICE_SUCCESS)
        return "unknown format";
    return info.blockWidth > 4 || info.blockHeight > 4 ? "blocks above 4x4" : NULL;
}

const char *format_mode_answer(enum format_mode mode, bool has_mode, SluiceFormat format,
                               const SluiceVulkanFormatCapabilities *caps)
{
    const bool needs_filter = mode == FORMAT_MODE_PAGED || mode == FORMAT_MODE_DEMAND;
    const char *refusal = NULL;
    if (!has_mode)
        return "no such mode";
    if (!caps->sampled)
        return "no sampled image";
    if (needs_filter && !caps->linearFilter)
        return "no linear filter";
    if (mode == FORMAT_MODE_SPARSE)
        refusal = refuse_sparse(caps);
    if (mode == FORMAT_MODE_DEMAND)
        refusal = refuse_demand(format);
    if (refusal)
        return refusal;
    return caps->linearFilter ? YES : NEAREST;
}

bool format_mode_is_streamed(const char *answer)
{
    return strcmp(answer, YES) == 0 || strcmp(answer, NEAREST) == 0;
}
