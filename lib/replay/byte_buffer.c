#include "replay/byte_buffer.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <string.h>

void slc_bytes_init(struct slc_bytes *bytes, const SluiceAllocationCallbacks *cb)
{
    *bytes = (struct slc_bytes){.cb = *cb};
}

void slc_bytes_finish(struct slc_bytes *bytes)
{
    slc_free(&bytes->cb, bytes->data, bytes->capacity, 1);
    *bytes = (struct slc_bytes){.cb = bytes->cb};
}

static bool reserve(struct slc_bytes *bytes, size_t more)
{
    size_t need, twice;
    if (bytes->failed)
        return false;
    if (!slc_add_size(bytes->size, more, &need)) {
        bytes->failed = true;
        return false;
    }
    if (need <= bytes->capacity)
        return true;
    if (!slc_mul_size(bytes->capacity, 2, &twice) || twice < need)
        twice = need;
    if (twice < 256)
        twice = 256;
    uint8_t *data = slc_regrow(&bytes->cb, bytes->data, bytes->capacity, twice, 1);
    if (!data) {
        bytes->failed = true;
        return false;
    }
    bytes->data = data;
    bytes->capacity = twice;
    return true;
}

void slc_put_bytes(struct slc_bytes *bytes, const void *data, size_t size)
{
    if (size == 0 || !reserve(bytes, size))
        return;
    memcpy(bytes->data + bytes->size, data, size);
    bytes->size += size;
}

static void put_fixed(struct slc_bytes *bytes, uint64_t value, uint32_t size)
{
    uint8_t out[8];
    for (uint32_t i = 0; i < size; i++)
        out[i] = (uint8_t)(value >> (8 * i));
    slc_put_bytes(bytes, out, size);
}

void slc_put_u8(struct slc_bytes *bytes, uint8_t value)
{
    put_fixed(bytes, value, 1);
}

void slc_put_u32(struct slc_bytes *bytes, uint32_t value)
{
    put_fixed(bytes, value, 4);
}

void slc_put_u64(struct slc_bytes *bytes, uint64_t value)
{
    put_fixed(bytes, value, 8);
}

void slc_put_varint(struct slc_bytes *bytes, uint64_t value)
{
    uint8_t out[10];
    size_t size = 0;
    for (; value > 127; value >>= 7)
        out[size++] = (uint8_t)(value | 128);
    out[size++] = (uint8_t)value;
    slc_put_bytes(bytes, out, size);
}

void slc_put_signed(struct slc_bytes *bytes, int64_t value)
{
    uint64_t shifted = (uint64_t)value << 1;
    slc_put_varint(bytes, value < 0 ? ~shifted : shifted);
}

void slc_cursor_fail(struct slc_cursor *cursor, size_t pos, const char *why)
{
    if (cursor->why)
        return;
    cursor->pos = pos;
    cursor->why = why;
}

const uint8_t *slc_get_bytes(struct slc_cursor *cursor, uint64_t size)
{
    if (cursor->why)
        return NULL;
    if (size > cursor->end - cursor->pos) {
        slc_cursor_fail(cursor, cursor->pos, "ends too early");
        return NULL;
    }
    const uint8_t *data = cursor->data + cursor->pos;
    cursor->pos += (size_t)size;
    return data;
}

static uint64_t get_fixed(struct slc_cursor *cursor, uint32_t size)
{
    const uint8_t *data = slc_get_bytes(cursor, size);
    uint64_t value = 0;
    for (uint32_t i = 0; data && i < size; i++)
        value |= (uint64_t)data[i] << (8 * i);
    return value;
}

uint8_t slc_get_u8(struct slc_cursor *cursor)
{
    return (uint8_t)get_fixed(cursor, 1);
}

uint16_t slc_get_u16(struct slc_cursor *cursor)
{
    return (uint16_t)get_fixed(cursor, 2);
}

uint32_t slc_get_u32(struct slc_cursor *cursor)
{
    return (uint32_t)get_fixed(cursor, 4);
}

uint64_t slc_get_u64(struct slc_cursor *cursor)
{
    return get_fixed(cursor, 8);
}

uint64_t slc_get_varint(struct slc_cursor *cursor)
{
    size_t start = cursor->pos;
    uint64_t value = 0;
    for (uint32_t shift = 0; !cursor->why; shift += 7) {
        uint8_t byte = slc_get_u8(cursor);
        /* The tenth byte holds only bit 63. */
        if (shift == 63 && byte > 1) {
            slc_cursor_fail(cursor, start, "a number does not fit 64 bits");
            return 0;
        }
        value |= (uint64_t)(byte & 127) << shift;
        if (byte < 128)
            break;
    }
    return cursor->why ? 0 : value;
}

uint32_t slc_get_varint32(struct slc_cursor *cursor)
{
    size_t start = cursor->pos;
    uint64_t value = slc_get_varint(cursor);
    if (value > UINT32_MAX) {
        slc_cursor_fail(cursor, start, "a number does not fit 32 bits");
        return 0;
    }
    return (uint32_t)value;
}

int64_t slc_get_signed(struct slc_cursor *cursor)
{
    uint64_t value = slc_get_varint(cursor);
    return value & 1 ? -(int64_t)(value >> 1) - 1 : (int64_t)(value >> 1);
}

int32_t slc_get_signed32(struct slc_cursor *cursor)
{
    size_t start = cursor->pos;
    int64_t value = slc_get_signed(cursor);
    if (value < INT32_MIN || value > INT32_MAX) {
        slc_cursor_fail(cursor, start, "a number does not fit 32 bits");
        return 0;
    }
    return (int32_t)value;
}
