/** Little-endian bytes on every host: a growing buffer for writing, a bounded cursor for reading.
 */
#ifndef SLC_REPLAY_BYTE_BUFFER_H
#define SLC_REPLAY_BYTE_BUFFER_H

#include <sluice/base.h>

/** Growing buffer. Out of memory: `failed` is set and further puts do nothing. */
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
/** Appends LEB128: seven bits per byte, low bits first. The top bit is set in all but the last. */
void slc_put_varint(struct slc_bytes *bytes, uint64_t value);
/** Appends a signed number: zigzag (0, -1, 1, -2, ...), then LEB128. */
void slc_put_signed(struct slc_bytes *bytes, int64_t value);

/**
 * Cursor: reads `data` from `pos` up to `end`. After the first error, `why` is the reason, `pos` is
 * the start of the failed item, and every read yields 0.
 */
struct slc_cursor {
    const uint8_t *data; ///< borrowed
    size_t pos, end;
    const char *why; ///< reason of the first error; NULL: no error
};

/** Records an error, unless there was an earlier error. */
void slc_cursor_fail(struct slc_cursor *cursor, size_t pos, const char *why);

/** Returns `size` bytes in place; NULL if fewer are left. */
const uint8_t *slc_get_bytes(struct slc_cursor *cursor, uint64_t size);
uint8_t slc_get_u8(struct slc_cursor *cursor);
uint16_t slc_get_u16(struct slc_cursor *cursor);
uint32_t slc_get_u32(struct slc_cursor *cursor);
uint64_t slc_get_u64(struct slc_cursor *cursor);
uint64_t slc_get_varint(struct slc_cursor *cursor);
/** Reads a varint that must fit 32 bits. */
uint32_t slc_get_varint32(struct slc_cursor *cursor);
int64_t slc_get_signed(struct slc_cursor *cursor);
/** Reads a signed varint that must fit 32 bits. */
int32_t slc_get_signed32(struct slc_cursor *cursor);

#endif /* SLC_REPLAY_BYTE_BUFFER_H */
