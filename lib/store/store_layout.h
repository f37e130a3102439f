/** Header, index and checksums: the bytes of a file but for the texels. See docs/store.md. */
#ifndef SLC_STORE_STORE_LAYOUT_H
#define SLC_STORE_STORE_LAYOUT_H

#include "store/grid.h"

#define SLC_STORE_HEADER_SIZE 4096u
#define SLC_STORE_BLOCK_SIZE 4096u
#define SLC_STORE_ENTRY_SIZE 20u
#define SLC_STORE_BLOCK_ENTRIES 204u
#define SLC_STORE_NAME_OFFSET 128u

/** What a header says. */
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
    uint64_t block_count; ///< of the index
    uint64_t data_offset; ///< where chunks begin
    uint64_t file_size;   ///< 0: unfinished
    uint64_t identity;    ///< goes into all other checksums of the file
};

/** Where the bytes of a chunk are; all 0: not written. */
struct slc_store_entry {
    uint64_t offset, checksum;
    uint32_t size;
};

/** Fills in block_count, data_offset and identity, which follow from the rest, and the bytes. */
void slc_store_header_write(struct slc_store_header *header,
                            unsigned char bytes[SLC_STORE_HEADER_SIZE]);

/** Whether both describe the same file, but for its size. */
bool slc_store_header_matches(const unsigned char a[SLC_STORE_HEADER_SIZE],
                              const unsigned char b[SLC_STORE_HEADER_SIZE]);

/**
 * Checks and understands a header; `name` points into `bytes`. Errors: CORRUPT_DATA, UNSUPPORTED;
 * then `offset` is where it is wrong and `message` says what, in a string of the program.
 */
SluiceResult slc_store_header_read(struct slc_store_header *header,
                                   const unsigned char bytes[SLC_STORE_HEADER_SIZE],
                                   uint32_t *offset, const char **message);

/** Whether a number of 4 bytes is at `offset` of the header; then `value` is the number. */
bool slc_store_header_number(const unsigned char bytes[SLC_STORE_HEADER_SIZE], uint32_t offset,
                             uint32_t *value);

/** Where the block is that holds a chunk's entry. */
static inline uint64_t slc_store_block_offset(uint64_t block)
{
    return SLC_STORE_HEADER_SIZE + block * SLC_STORE_BLOCK_SIZE;
}

/** Where the entry of a chunk is in its block. */
static inline uint32_t slc_store_entry_offset(uint64_t number)
{
    return (uint32_t)(number % SLC_STORE_BLOCK_ENTRIES) * SLC_STORE_ENTRY_SIZE;
}

void slc_store_entry_write(const struct slc_store_entry *entry,
                           unsigned char bytes[SLC_STORE_ENTRY_SIZE]);
struct slc_store_entry slc_store_entry_read(const unsigned char bytes[SLC_STORE_ENTRY_SIZE]);

/** Writes the checksum of a block whose entries are there, and clears what lies between. */
void slc_store_block_seal(const struct slc_store_header *header, uint64_t block,
                          unsigned char bytes[SLC_STORE_BLOCK_SIZE]);
bool slc_store_block_is_sound(const struct slc_store_header *header, uint64_t block,
                              const unsigned char bytes[SLC_STORE_BLOCK_SIZE]);

/** Of the bytes of a chunk as they are in the file. */
uint64_t slc_store_chunk_checksum(const struct slc_store_header *header, uint64_t number,
                                  const void *bytes, size_t size);

/**
 * NULL, or what is wrong with an entry: chunks lie between index and `end`, those of an
 * uncompressed file where slc_store_chunk_offset says, and are not larger than their texels.
 */
const char *slc_store_entry_defect(const struct slc_store_header *header, uint64_t end,
                                   const struct slc_store_place *place,
                                   const struct slc_store_entry *entry);

#endif /* SLC_STORE_STORE_LAYOUT_H */
