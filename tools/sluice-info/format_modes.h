/** Streaming modes of a device by format. Uses only the public functions and structs. */
#ifndef TOOLS_SLUICE_INFO_FORMAT_MODES_H
#define TOOLS_SLUICE_INFO_FORMAT_MODES_H

#include <sluice/vulkan.h>

/** The residency modes of a streamer, and demand loading. */
enum format_mode {
    FORMAT_MODE_SPARSE,
    FORMAT_MODE_PAGED,
    FORMAT_MODE_DENSE,
    FORMAT_MODE_DEMAND,
    FORMAT_MODES
};

extern const char *const format_mode_names[FORMAT_MODES];

/** Returns the mode whose features a device must have. Demand loading needs those of paged mode. */
SluiceResidencyMode format_mode_residency(enum format_mode mode);

/**
 * Returns "yes", "nearest only" (streamed, without linear filters), or why the format is refused.
 *
 * `has_mode`: whether sluiceRequireVulkanFeatures succeeds for format_mode_residency(mode).
 */
const char *format_mode_answer(enum format_mode mode, bool has_mode, SluiceFormat format,
                               const SluiceVulkanFormatCapabilities *caps);

/** Returns true for "yes" and "nearest only". */
bool format_mode_is_streamed(const char *answer);

#endif /* TOOLS_SLUICE_INFO_FORMAT_MODES_H */
