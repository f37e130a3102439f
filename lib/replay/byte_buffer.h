/** Little-endian bytes, the same on every host: a growing buffer to write, a bounded cursor to
 * read. */
#ifndef SLC_REPLAY_BYTE_BUFFER_H
#define SLC_REPLAY_BYTE_BUFFER_H

#include <sluice/base.h>

/** Once memory ran out, `failed` stays set and further puts do nothing. */
struct slc_bytes {
    SluiceAllocationCallbacks cb;
    uint8_t *data; ///< owned
    size_t size, capacity;
    bool failed;
};

void slc_bytes_init(struct slc_bytes *bytes, const SluiceAllocationCallbacks *cb);
void slc_bytes_finish(struct slc_bytes *bytes);

void slc_put_bytes(struct slc_bytes *bytes, const void *data, size_t size);
void slc_put_u8(struct slc_bytes *bytes, uint8_t value);
void slc_put_u32(struct slc_bytes *bytes, uint32_t value);
void slc_put_u64(struct slc_bytes *bytes, uint64_t value);
/** LEB128: seven bits per byte, low ones first, the top bit says that more follow. */
void slc_put_varint(struct slc_bytes *bytes, uint64_t value);
/** Zigzag (0, -1, 1, -2, ...) and then LEB128. */
void slc_put_signed(struct slc_bytes *bytes, int64_t value);

/**
 * Reads `data` from `pos` up to `end`. At the first thing that is wrong `why` says what and `pos`
 * stays at where it began; every read after that yields 0.
 */
struct slc_cursor {
    const uint8_t *data; ///< borrowed
    size_t pos, end;
    const char *why; ///< NULL while all is well
};

/** Notes what is wrong, unless something was before. */
void slc_cursor_fail(struct slc_cursor *cursor, size_t pos, const char *why);

/** `size` bytes in place, NULL if there are fewer. */
const uint8_t *slc_get_bytes(struct slc_cursor *cursor, uint64_t size);
uint8_t slc_get_u8(struct slc_cursor *cursor);
uint16_t slc_get_u16(struct slc_cursor *cursor);
uint32_t slc_get_u32(struct slc_cursor *cursor);
uint64_t slc_get_u64(struct slc_cursor *cursor);
uint64_t slc_get_varint(struct slc_cursor *cursor);
/** A varint that must fit 32 bits. */
uint32_t slc_get_varint32(struct slc_cursor *cursor);
int64_t slc_get_signed(struct slc_cursor *cursor);
/** A signed one that must fit 32 bits. */
int32_t slc_get_signed32(struct slc_cursor *cursor);

#endif /* SLC_REPLAY_BYTE_BUFFER_H */
