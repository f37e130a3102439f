#include "replay/runs.h"

#include <string.h>

/* Shortest run. A shorter run between literals saves nothing. */
#define MIN_RUN 3

static size_t run_length(const uint8_t *map, size_t size)
{
    size_t n = 1;
    while (n < size && map[n] == map[0])
        n++;
    return n;
}

void slc_put_runs(struct slc_bytes *bytes, const uint8_t *map, size_t size)
{
    size_t literal = 0; /* start of unwritten bytes */
    for (size_t i = 0; i < size;) {
        size_t run = run_length(map + i, size - i);
        bool last = i + run == size;
        if (run >= MIN_RUN || (last && i == literal)) {
            if (i > literal) {
                slc_put_varint(bytes, (uint64_t)(i - literal - 1) << 1 | 1);
                slc_put_bytes(bytes, map + literal, i - literal);
            }
            slc_put_varint(bytes, (uint64_t)(run - 1) << 1);
            slc_put_u8(bytes, map[i]);
            literal = i + run;
        }
        i += run;
    }
    if (literal < size) {
        slc_put_varint(bytes, (uint64_t)(size - literal - 1) << 1 | 1);
        slc_put_bytes(bytes, map + literal, size - literal);
    }
}

/* Encodes the runs in a separate buffer first, because their size precedes them. */
void slc_put_map(struct slc_bytes *out, const uint8_t *map, size_t size)
{
    struct slc_bytes runs;
    slc_bytes_init(&runs, &out->cb);
    slc_put_runs(&runs, map, size);
    slc_put_varint(out, runs.size);
    slc_put_bytes(out, runs.data, runs.size);
    out->failed |= runs.failed;
    slc_bytes_finish(&runs);
}

void slc_get_runs(struct slc_cursor *cursor, uint8_t *map, size_t size)
{
    size_t done = 0;
    while (!cursor->why && cursor->pos < cursor->end) {
        size_t start = cursor->pos;
        uint64_t code = slc_get_varint(cursor);
        uint64_t count = code >> 1; /* count - 1, which fits */
        if (!cursor->why && count >= size - done) {
            slc_cursor_fail(cursor, start, "a map's runs exceed its size");
            return;
        }
        const uint8_t *data = slc_get_bytes(cursor, code & 1 ? count + 1 : 1);
        if (!data)
            return;
        if (map && code & 1)
            memcpy(map + done, data, (size_t)count + 1);
        else if (map)
            memset(map + done, *data, (size_t)count + 1);
        done += (size_t)count + 1;
    }
    if (done != size)
        slc_cursor_fail(cursor, cursor->pos, "a map's runs fall short of its size");
}

void slc_get_run_pairs(struct slc_cursor *cursor, uint8_t *map, size_t size)
{
    size_t done = 0;
    while (!cursor->why && cursor->pos < cursor->end) {
        size_t start = cursor->pos;
        uint32_t count = slc_get_varint32(cursor);
        uint8_t value = slc_get_u8(cursor);
        if (cursor->why)
            return;
        if (count > size - done) {
            slc_cursor_fail(cursor, start, "a map's runs exceed its size");
            return;
        }
        if (map)
            memset(map + done, value, count);
        done += count;
    }
    if (done != size)
        slc_cursor_fail(cursor, cursor->pos, "a map's runs fall short of its size");
}
