#include "replay/hash.h"

#define FNV_PRIME UINT64_C(0x100000001B3)

uint64_t slc_hash_bytes(uint64_t hash, const void *data, size_t size)
{
    const uint8_t *bytes = data;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * FNV_PRIME;
    return hash;
}

static uint64_t hash_fixed(uint64_t hash, uint64_t value, uint32_t size)
{
    for (uint32_t i = 0; i < size; i++)
        hash = (hash ^ (uint8_t)(value >> (8 * i))) * FNV_PRIME;
    return hash;
}

uint64_t slc_hash_u8(uint64_t hash, uint8_t value)
{
    return hash_fixed(hash, value, 1);
}

uint64_t slc_hash_u32(uint64_t hash, uint32_t value)
{
    return hash_fixed(hash, value, 4);
}

uint64_t slc_hash_u64(uint64_t hash, uint64_t value)
{
    return hash_fixed(hash, value, 8);
}
