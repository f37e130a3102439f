/** Numbers as files have them, on any host. */
#ifndef SLC_BASE_LITTLE_ENDIAN_H
#define SLC_BASE_LITTLE_ENDIAN_H

#include <stdint.h>

static inline void slc_put_u32(unsigned char *bytes, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (unsigned char)(value >> 8 * i);
}

static inline void slc_put_u64(unsigned char *bytes, uint64_t value)
{
    slc_put_u32(bytes, (uint32_t)value);
    slc_put_u32(bytes + 4, (uint32_t)(value >> 32));
}

static inline uint32_t slc_get_u32(const unsigned char *bytes)
{
    uint32_t value = 0;
    for (int i = 0; i < 4; i++)
        value |= (uint32_t)bytes[i] << 8 * i;
    return value;
}

static inline uint64_t slc_get_u64(const unsigned char *bytes)
{
    return slc_get_u32(bytes) | (uint64_t)slc_get_u32(bytes + 4) << 32;
}

#endif /* SLC_BASE_LITTLE_ENDIAN_H */
