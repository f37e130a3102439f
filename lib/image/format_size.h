/** Sizes of rows and rectangles in any format, including compressed ones. */
#ifndef SLC_IMAGE_FORMAT_SIZE_H
#define SLC_IMAGE_FORMAT_SIZE_H

#include <sluice/image.h>

#include "base/checked.h"

/** Returns the bytes of a row of `width` texels, or of their blocks. */
static inline uint64_t slc_format_row_size(const SluiceFormatInfo *format, uint32_t width)
{
    return (uint64_t)slc_div_up_u32(width, format->blockWidth) * format->blockSize;
}

/** Returns the rows of `height` rows of texels, or of their blocks. */
static inline uint32_t slc_format_row_count(const SluiceFormatInfo *format, uint32_t height)
{
    return slc_div_up_u32(height, format->blockHeight);
}

static inline bool slc_format_is_compressed(const SluiceFormatInfo *format)
{
    return format->blockWidth > 1 || format->blockHeight > 1;
}

/** True if channels are not whole bytes, or share bits. */
static inline bool slc_format_is_packed(SluiceFormat format)
{
    return format == SLUICE_FORMAT_A2B10G10R10_UNORM_PACK32 ||
           format == SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32 ||
           format == SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32;
}

/** True if channels are 16-bit UNORM. */
static inline bool slc_format_is_unorm16(SluiceFormat format)
{
    return format == SLUICE_FORMAT_R16_UNORM || format == SLUICE_FORMAT_R16G16_UNORM ||
           format == SLUICE_FORMAT_R16G16B16A16_UNORM;
}

/** True if channels are SNORM, of 8 or 16 bits. False for blocks. */
static inline bool slc_format_is_snorm(SluiceFormat format)
{
    return format >= SLUICE_FORMAT_R8_SNORM && format <= SLUICE_FORMAT_R16G16B16A16_SNORM;
}

/** True if channels are integers, UINT or SINT. */
static inline bool slc_format_is_integer(SluiceFormat format)
{
    return format >= SLUICE_FORMAT_R8_UINT && format <= SLUICE_FORMAT_R32G32B32A32_SINT;
}

static inline bool slc_format_is_sint(SluiceFormat format)
{
    return format >= SLUICE_FORMAT_R8_SINT && format <= SLUICE_FORMAT_R32G32B32A32_SINT;
}

/** True if channels are halves. */
static inline bool slc_format_is_half(SluiceFormat format)
{
    return format == SLUICE_FORMAT_R16_SFLOAT || format == SLUICE_FORMAT_R16G16_SFLOAT ||
           format == SLUICE_FORMAT_R16G16B16A16_SFLOAT;
}

/**
 * Returns the bytes of the words of a texel: 1, 2 or 4. Words have the host's byte order in memory.
 * 1 for compressed blocks, which are strings of bytes on every host.
 */
uint32_t slc_format_word_size(SluiceFormat format);

/** Returns the sRGB or the linear format with the same bytes; `format` itself if there is none. */
SluiceFormat slc_format_twin(SluiceFormat format, bool srgb);
bool slc_format_has_srgb_twin(SluiceFormat format);
bool slc_format_is_srgb(SluiceFormat format);

#endif /* SLC_IMAGE_FORMAT_SIZE_H */
