/** Texels in files, which are little endian, and in memory, where words have the host's order. */
#ifndef SLC_IMAGE_BYTE_ORDER_H
#define SLC_IMAGE_BYTE_ORDER_H

#include "image/format_size.h"

#include <stddef.h>

/* Compilers without these macros build for little-endian hosts alone. */
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
#define SLC_HOST_IS_BIG_ENDIAN 1
#else
#define SLC_HOST_IS_BIG_ENDIAN 0
#endif

/** Reverses every word of `word_size` bytes. `size` is a multiple of it. Any alignment. */
void slc_reverse_words(void *bytes, size_t size, uint32_t word_size);

/** True if texels of the format differ between files and the memory of this host. */
static inline bool slc_file_order_differs(SluiceFormat format)
{
    return SLC_HOST_IS_BIG_ENDIAN && slc_format_word_size(format) > 1;
}

/** Converts texels from a file's order to the host's, or back. */
static inline void slc_exchange_file_order(SluiceFormat format, void *texels, size_t size)
{
    if (slc_file_order_differs(format))
        slc_reverse_words(texels, size, slc_format_word_size(format));
}

#endif /* SLC_IMAGE_BYTE_ORDER_H */
