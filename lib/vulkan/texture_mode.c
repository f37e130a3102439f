#include "vulkan/texture_mode.h"

#include "base/log.h"

SluiceResult slc_texture_check_mode(const SluiceVulkanStreamer *s, SluiceResidencyMode mode)
{
    if (mode == SLUICE_RESIDENCY_MODE_AUTO || mode == SLUICE_RESIDENCY_MODE_DENSE ||
        mode == s->info.residencyMode)
        return SLUICE_SUCCESS;
    slc_log(&s->vk.log, SLUICE_LOG_ERROR,
            "residencyMode of a texture is %d; the streamer's is %d: it has textures of its own "
            "mode and dense ones",
            (int)mode, (int)s->info.residencyMode);
    return SLUICE_ERROR_UNSUPPORTED;
}

/* Textures that fit into a tile have nothing to stream. A texture that is to be dense whatever its
 * size is read as a whole. */
static bool is_plain(const SluiceVulkanStreamer *s, SluiceResidencyMode mode,
                     const SluiceImageInfo *image)
{
    if (mode == SLUICE_RESIDENCY_MODE_AUTO)
        return s->chooses_modes && slc_fits_into_tile(image);
    return mode == SLUICE_RESIDENCY_MODE_DENSE && s->info.residencyMode != mode;
}

SluiceResult slc_texture_create_image(SluiceVulkanStreamer *s, uint32_t first,
                                      SluiceResidencyMode mode, const SluiceImageInfo *image,
                                      bool produced, struct slc_residency **residency,
                                      struct slc_residency_image *out)
{
    *residency = is_plain(s, mode, image) ? s->plain : s->residency;
    SluiceResult result =
        (*residency)->interface->create_image(*residency, first, image, produced, out);
    if (result != SLUICE_ERROR_OUT_OF_DEVICE_MEMORY || *residency == s->residency ||
        mode != SLUICE_RESIDENCY_MODE_AUTO)
        return result;
    *residency = s->residency; /* heaps may have taken the whole budget, and have a slot for it */
    return s->residency->interface->create_image(s->residency, first, image, produced, out);
}

SluiceResidencyMode slc_texture_mode(const SluiceVulkanStreamer *s,
                                     const struct slc_texture *texture)
{
    return texture->layout.desc.packedTilesOutside ? SLUICE_RESIDENCY_MODE_DENSE
                                                   : s->info.residencyMode;
}
