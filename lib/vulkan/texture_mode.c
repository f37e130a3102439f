#include "vulkan/texture_mode.h"

#include "base/log.h"

SluiceResult slc_texture_check_mode(const SluiceVulkanStreamer *s, SluiceResidencyMode mode)
{
    if (mode == SLUICE_RESIDENCY_MODE_AUTO || mode == SLUICE_RESIDENCY_MODE_DENSE ||
        mode == s->info.residencyMode || (mode == SLUICE_RESIDENCY_MODE_PAGED && s->paged))
        return SLUICE_SUCCESS;
    bool paged = mode == SLUICE_RESIDENCY_MODE_PAGED &&
                 s->info.residencyMode == SLUICE_RESIDENCY_MODE_SPARSE;
    slc_log(&s->vk.log, SLUICE_LOG_ERROR,
            "residencyMode of a texture is %d; the streamer's is %d: it has textures of its own "
            "mode and dense ones%s",
            (int)mode, (int)s->info.residencyMode,
            paged ? "; set pagedTextures of the streamer" : "");
    return SLUICE_ERROR_UNSUPPORTED;
}

/* True if a texture is an image with all levels: it is requested to be dense, or fits into a tile,
 * so that there is nothing to stream. */
static bool is_plain(const SluiceVulkanStreamer *s, SluiceResidencyMode mode,
                     const SluiceImageInfo *image)
{
    if (mode == SLUICE_RESIDENCY_MODE_AUTO)
        return s->chooses_modes && slc_fits_into_tile(image);
    return mode == SLUICE_RESIDENCY_MODE_DENSE && s->info.residencyMode != mode;
}

static SluiceResult create(struct slc_residency *in, uint32_t first, const SluiceImageInfo *image,
                           const struct slc_image_use *use, const char **refusal,
                           struct slc_residency **residency, struct slc_residency_image *out)
{
    *residency = in;
    return in->interface->create_image(in, first, image, use, refusal, out);
}

/* Creates a sparse image, or a paged one if sparse mode refuses the texture and paging is allowed.
 */
static SluiceResult create_sparse_or_paged(SluiceVulkanStreamer *s, uint32_t first,
                                           SluiceResidencyMode mode, const SluiceImageInfo *image,
                                           const struct slc_image_use *use,
                                           struct slc_residency **residency,
                                           struct slc_residency_image *out)
{
    bool may_be_paged = mode == SLUICE_RESIDENCY_MODE_AUTO;
    const char *refusal = "is not available as a sparse image";
    SluiceResult result = SLUICE_ERROR_UNSUPPORTED;
    if (s->debug.notSparse == SLUICE_FORMAT_UNDEFINED || s->debug.notSparse != image->format)
        result = create(s->residency, first, image, use, &refusal, residency, out);
    if (result != SLUICE_ERROR_UNSUPPORTED)
        return result;
    if (may_be_paged)
        result = create(s->paged, first, image, use, NULL, residency, out);
    if (result == SLUICE_ERROR_UNSUPPORTED)
        slc_log(&s->vk.log, SLUICE_LOG_ERROR, "%s: %ux%u %s %s%s",
                image->pName ? image->pName : "image", image->width, image->height,
                sluiceGetFormatName(image->format), refusal,
                may_be_paged ? ", so it would have to be paged" : "");
    return result;
}

SluiceResult slc_texture_try_image(SluiceVulkanStreamer *s, uint32_t index,
                                   SluiceResidencyMode mode, const SluiceImageInfo *image,
                                   struct slc_residency **residency,
                                   struct slc_residency_image *out)
{
    const struct slc_image_use sampled = {0};
    return is_plain(s, mode, image)
               ? create(s->plain, index, image, &sampled, NULL, residency, out)
               : slc_texture_create_image(s, index, mode, image, &sampled, residency, out);
}

SluiceResult slc_texture_create_image(SluiceVulkanStreamer *s, uint32_t first,
                                      SluiceResidencyMode mode, const SluiceImageInfo *image,
                                      const struct slc_image_use *use,
                                      struct slc_residency **residency,
                                      struct slc_residency_image *out)
{
    if (is_plain(s, mode, image)) {
        SluiceResult result = create(s->plain, first, image, use, NULL, residency, out);
        if (result != SLUICE_ERROR_OUT_OF_DEVICE_MEMORY || mode != SLUICE_RESIDENCY_MODE_AUTO)
            return result; /* otherwise tiles may fit: heaps may hold the whole budget */
    }
    if (!s->paged)
        return create(s->residency, first, image, use, NULL, residency, out);
    if (mode == SLUICE_RESIDENCY_MODE_PAGED)
        return create(s->paged, first, image, use, NULL, residency, out);
    return create_sparse_or_paged(s, first, mode, image, use, residency, out);
}

SluiceResidencyMode slc_texture_mode(const SluiceVulkanStreamer *s,
                                     const struct slc_texture *texture)
{
    if (texture->image.desc.packedTilesOutside && texture->image.desc.regularMipCount == 0)
        return SLUICE_RESIDENCY_MODE_DENSE;
    return texture->residency == s->paged ? SLUICE_RESIDENCY_MODE_PAGED : s->info.residencyMode;
}
