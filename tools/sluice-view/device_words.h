/** Sentences about a device: quirks in force, and why a residency mode was chosen. */
#ifndef SLUICE_VIEW_DEVICE_WORDS_H
#define SLUICE_VIEW_DEVICE_WORDS_H

#include <sluice/vulkan_device.h>

#define DEVICE_QUIRKS 10u
#define DEVICE_WORDS 200u

/** Writes a sentence for each quirk that applies in a mode. Returns their number. */
uint32_t device_quirks(const SluiceVulkanDeviceCapabilities *capabilities, SluiceResidencyMode mode,
                       char quirks[DEVICE_QUIRKS][DEVICE_WORDS]);
/** Writes why a streamer of `texture_count` textures has a mode. `asked`: mode requested at
 * creation, may be AUTO. Returns `words`. */
const char *device_mode_reason(const SluiceVulkanDeviceCapabilities *capabilities,
                               SluiceResidencyMode asked, SluiceResidencyMode mode,
                               uint32_t texture_count, char words[DEVICE_WORDS]);

#endif /* SLUICE_VIEW_DEVICE_WORDS_H */
