/** Header, index and checksums of a store file: all bytes except texels. See docs/store.md. */
#ifndef SLC_STORE_STORE_LAYOUT_H
#define SLC_STORE_STORE_LAYOUT_H

#include "store/grid.h"

#define SLC_STORE_HEADER_SIZE 4096u
#define SLC_STORE_BLOCK_SIZE 4096u
#define SLC_STORE_ENTRY_SIZE 20u
#define SLC_STORE_BLOCK_ENTRIES 204u
#define SLC_STORE_NAME_OFFSET 128u

/** Fields of a header. */
struct slc_store_header {
    uint32_t major, minor;
    struct slc_store_grid grid;
    SluiceStoreColorSpace color_space;
    SluiceStoreMeaning meaning;
    SluiceStoreAddressMode address_mode_u, address_mode_v;
    uint64_t source_size;
    int64_t source_time;
    uint64_t settings_hash;
    bool cube;
    uint32_t compression_level;
    uint32_t name_size;
    const char *name;     ///< name_size bytes without a zero; borrowed
    uint64_t block_count; ///< blocks of the index
    uint64_t data_offset; ///< offset of the first chunk
    uint64_t file_size;   ///< 0: unfinished
    uint64_t identity;    ///< part of all other checksums of the file
};

/** Index entry of a chunk: its bytes. All 0: not written. */
struct slc_store_entry {
    uint64_t offset, checksum;
    uint32_t size;
};

/** Writes a header's bytes. Fills in block_count, data_offset and identity, which follow from the
 * rest. */
void slc_store_header_write(struct slc_store_header *header,
                            unsigned char bytes[SLC_STORE_HEADER_SIZE]);

/** True if two headers describe the same file, apart from its size. */
bool slc_store_header_matches(const unsigned char a[SLC_STORE_HEADER_SIZE],
                              const unsigned char b[SLC_STORE_HEADER_SIZE]);

/**
 * Checks and reads a header; `name` points into `bytes`. Errors: CORRUPT_DATA, UNSUPPORTED, with
 * the offset of the fault in `offset` and the reason in `message`, a constant string.
 */
SluiceResult slc_store_header_read(struct slc_store_header *header,
                                   const unsigned char bytes[SLC_STORE_HEADER_SIZE],
                                   uint32_t *offset, const char **message);

/** Gets the field at `offset` of a header. False if no number of 4 bytes is there. */
bool slc_store_header_number(const unsigned char bytes[SLC_STORE_HEADER_SIZE], uint32_t offset,
                             uint32_t *value);

/** Returns the offset of a block of the index. */
static inline uint64_t slc_store_block_offset(uint64_t block)
{
    return SLC_STORE_HEADER_SIZE + block * SLC_STORE_BLOCK_SIZE;
}

/** Returns the offset of a chunk's entry in its block. */
static inline uint32_t slc_store_entry_offset(uint64_t number)
{
    return (uint32_t)(number % SLC_STORE_BLOCK_ENTRIES) * SLC_STORE_ENTRY_SIZE;
}

void slc_store_entry_write(const struct slc_store_entry *entry,
                           unsigned char bytes[SLC_STORE_ENTRY_SIZE]);
struct slc_store_entry slc_store_entry_read(const unsigned char bytes[SLC_STORE_ENTRY_SIZE]);

/** Writes the checksum of a block with all entries, and clears the bytes between. */
void slc_store_block_seal(const struct slc_store_header *header, uint64_t block,
                          unsigned char bytes[SLC_STORE_BLOCK_SIZE]);
bool slc_store_block_is_sound(const struct slc_store_header *header, uint64_t block,
                              const unsigned char bytes[SLC_STORE_BLOCK_SIZE]);

/** Returns the checksum of a chunk's stored bytes. */
uint64_t slc_store_chunk_checksum(const struct slc_store_header *header, uint64_t number,
                                  const void *bytes, size_t size);

/**
 * Returns NULL, or the defect of an entry. Chunks must be between index and `end`, must not be
 * larger than their texels, and in uncompressed files must be at slc_store_chunk_offset.
 */
const char *slc_store_entry_defect(const struct slc_store_header *header, uint64_t end,
                                   const struct slc_store_place *place,
                                   const struct slc_store_entry *entry);

#endif /* SLC_STORE_STORE_LAYOUT_H */
