/** FNV-1a, 64 bits: checksums of traces and hashes of decisions. */
#ifndef SLC_REPLAY_HASH_H
#define SLC_REPLAY_HASH_H

#include <stddef.h>
#include <stdint.h>

/** Hash of zero bytes. */
#define SLC_HASH_EMPTY UINT64_C(0xCBF29CE484222325)

uint64_t slc_hash_bytes(uint64_t hash, const void *data, size_t size);
/** Extends a hash by the value's bytes, low byte first. */
uint64_t slc_hash_u8(uint64_t hash, uint8_t value);
uint64_t slc_hash_u32(uint64_t hash, uint32_t value);
uint64_t slc_hash_u64(uint64_t hash, uint64_t value);

#endif /* SLC_REPLAY_HASH_H */
