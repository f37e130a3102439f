#include "pbrt/byte_window.h"

#include "base/alloc.h"
#include "base/system.h"
#include "platform/file.h"

#include <string.h>

#if SLC_HAVE_ZLIB
#include <zlib.h>
#endif

#define INPUT_SIZE ((size_t)1 << 16)

struct slc_pbrt_inflater {
    unsigned char input[INPUT_SIZE];
#if SLC_HAVE_ZLIB
    SluiceAllocationCallbacks allocator;
    z_stream stream;
    bool has_ended; ///< a gzip member has ended; another may follow
#endif
};

/* Returns the number of bytes read; 0 at the end and after a failure, which is recorded. */
static size_t read_file(struct slc_pbrt_window *window, unsigned char *bytes, size_t size)
{
    while (window->failure == SLUICE_SUCCESS) {
        int64_t got = slc_file_read_at(window->descriptor, window->file_offset, bytes, size);
        if (got >= 0) {
            window->file_offset += (uint64_t)got;
            return (size_t)got;
        }
        if (errno != EINTR)
            window->failure = SLUICE_ERROR_IO;
    }
    return 0;
}

#if SLC_HAVE_ZLIB
/* Allocates for zlib. Blocks begin with their size, because zlib frees without a size. */
static void *allocate(void *user, uInt count, uInt size)
{
    struct slc_pbrt_inflater *inflater = user;
    size_t bytes = (size_t)count * size + sizeof(max_align_t);
    unsigned char *block = slc_alloc(&inflater->allocator, bytes, 1);
    if (!block)
        return NULL;
    memcpy(block, &bytes, sizeof bytes);
    return block + sizeof(max_align_t);
}

static void release(void *user, void *memory)
{
    struct slc_pbrt_inflater *inflater = user;
    unsigned char *block = (unsigned char *)memory - sizeof(max_align_t);
    size_t bytes;
    memcpy(&bytes, block, sizeof bytes);
    slc_free(&inflater->allocator, block, bytes, 1);
}

static SluiceResult start_inflater(struct slc_pbrt_window *window)
{
    struct slc_pbrt_inflater *inflater = slc_calloc(&window->allocator, 1, sizeof *inflater);
    if (!inflater)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    inflater->allocator = window->allocator;
    inflater->stream.zalloc = allocate;
    inflater->stream.zfree = release;
    inflater->stream.opaque = inflater;
    if (inflateInit2(&inflater->stream, 15 + 16) != Z_OK) {
        slc_free(&window->allocator, inflater, 1, sizeof *inflater);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    window->inflater = inflater;
    return SLUICE_SUCCESS;
}

static void finish_inflater(struct slc_pbrt_window *window)
{
    if (!window->inflater)
        return;
    inflateEnd(&window->inflater->stream);
    slc_free(&window->allocator, window->inflater, 1, sizeof *window->inflater);
}

static size_t read_compressed(struct slc_pbrt_window *window, unsigned char *bytes, size_t size)
{
    struct slc_pbrt_inflater *inflater = window->inflater;
    z_stream *stream = &inflater->stream;
    stream->next_out = bytes;
    stream->avail_out = (uInt)size;
    while (stream->avail_out == size && window->failure == SLUICE_SUCCESS) {
        if (stream->avail_in == 0) {
            stream->next_in = inflater->input;
            stream->avail_in = (uInt)read_file(window, inflater->input, INPUT_SIZE);
        }
        if (stream->avail_in == 0) {
            if (!inflater->has_ended && window->failure == SLUICE_SUCCESS)
                window->failure = SLUICE_ERROR_CORRUPT_DATA;
            break;
        }
        if (inflater->has_ended && inflateReset(stream) != Z_OK)
            break;
        int status = inflate(stream, Z_NO_FLUSH);
        inflater->has_ended = status == Z_STREAM_END;
        if (status == Z_MEM_ERROR)
            window->failure = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        else if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
            window->failure = SLUICE_ERROR_CORRUPT_DATA;
    }
    return size - stream->avail_out;
}
#else
static SluiceResult start_inflater(struct slc_pbrt_window *window)
{
    (void)window;
    return SLUICE_ERROR_UNSUPPORTED;
}

static void finish_inflater(struct slc_pbrt_window *window)
{
    (void)window;
}

static size_t read_compressed(struct slc_pbrt_window *window, unsigned char *bytes, size_t size)
{
    (void)window, (void)bytes, (void)size;
    return 0;
}
#endif

/* Checks the limit during the read, because text may be a thousand times as large as a compressed
 * file. */
static void check_limit(struct slc_pbrt_window *window)
{
    if (window->base + window->end <= window->most || window->failure != SLUICE_SUCCESS)
        return;
    window->failure = SLUICE_ERROR_LIMIT_EXCEEDED;
    window->is_over = true;
}

void slc_pbrt_window_limit(struct slc_pbrt_window *window, uint64_t most)
{
    window->most = most;
    check_limit(window);
}

static bool goes_on(struct slc_pbrt_window *window)
{
    const struct slc_pbrt_watch *watch = window->watch;
    if (!watch || !watch->goes_on || window->failure != SLUICE_SUCCESS ||
        watch->goes_on(watch->user, watch->read_size))
        return true;
    window->failure = SLUICE_ERROR_CANCELED;
    return false;
}

size_t slc_pbrt_window_refill(struct slc_pbrt_window *window, size_t keep)
{
    size_t kept = window->end - keep;
    memmove(window->bytes, window->bytes + keep, kept);
    window->base += keep;
    window->cursor -= keep;
    window->end = kept;
    size_t room = SLC_PBRT_WINDOW_SIZE - kept;
    size_t got = 0;
    if (room > 0 && !window->is_over && goes_on(window))
        got = window->inflater ? read_compressed(window, window->bytes + kept, room)
                               : read_file(window, window->bytes + kept, room);
    window->is_over |= room > 0 && got == 0;
    window->end += got;
    if (window->watch)
        window->watch->read_size += got;
    window->bytes[window->end] = 0;
    check_limit(window);
    return keep;
}

bool slc_pbrt_window_seek(struct slc_pbrt_window *window, uint64_t offset)
{
    if (!window->inflater && offset > window->base + window->end) {
        if (offset > window->stamp.size)
            return false;
        window->base = window->file_offset = offset;
        window->cursor = window->end = 0;
        window->bytes[0] = 0;
    }
    while (offset > window->base + window->end) {
        window->cursor = window->end;
        slc_pbrt_window_refill(window, window->end);
        if (window->end == 0)
            return false;
    }
    window->cursor = (size_t)(offset - window->base);
    return true;
}

bool slc_pbrt_window_take(struct slc_pbrt_window *window, void *bytes, size_t size)
{
    unsigned char *to = bytes;
    while (size > 0) {
        size_t ready = window->end - window->cursor;
        size_t part = ready < size ? ready : size;
        memcpy(to, window->bytes + window->cursor, part);
        window->cursor += part;
        to += part;
        size -= part;
        if (size > 0) {
            slc_pbrt_window_refill(window, window->cursor);
            if (window->end == 0)
                return false;
        }
    }
    return true;
}

static struct slc_pbrt_stamp stamp_of(const struct slc_file_status *status)
{
    return (struct slc_pbrt_stamp){status->device, status->inode, status->size,
                                   status->modified.seconds, status->modified.nanoseconds};
}

bool slc_pbrt_stamp_of(const char *path, struct slc_pbrt_stamp *stamp)
{
    struct slc_file_status status;
    if (!slc_path_get_status(path, &status) || status.kind != SLC_NODE_FILE)
        return false;
    *stamp = stamp_of(&status);
    return true;
}

bool slc_pbrt_stamps_equal(const struct slc_pbrt_stamp *a, const struct slc_pbrt_stamp *b)
{
    return a->device == b->device && a->inode == b->inode && a->size == b->size &&
           a->seconds == b->seconds && a->nanoseconds == b->nanoseconds;
}

SluiceResult slc_pbrt_window_open(struct slc_pbrt_window *window, const char *path,
                                  const SluiceAllocationCallbacks *cb)
{
    return slc_pbrt_window_open_watched(window, path, NULL, cb);
}

SluiceResult slc_pbrt_window_open_watched(struct slc_pbrt_window *window, const char *path,
                                          struct slc_pbrt_watch *watch,
                                          const SluiceAllocationCallbacks *cb)
{
    struct slc_file_status status;
    *window = (struct slc_pbrt_window){
        .allocator = *cb, .descriptor = slc_open_input(path), .most = UINT64_MAX};
    if (window->descriptor < 0)
        return slc_system_result(errno);
    window->is_open = true;
    window->watch = watch;
    SluiceResult result = SLUICE_ERROR_IO;
    if (!slc_file_get_status(window->descriptor, &status) || status.kind != SLC_NODE_FILE)
        goto fail;
    window->stamp = stamp_of(&status);
    result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    window->bytes = slc_alloc(cb, SLC_PBRT_WINDOW_SIZE + 1, 1);
    if (!window->bytes)
        goto fail;
    window->bytes[0] = 0;
    slc_pbrt_window_refill(window, 0);
    result = window->failure;
    if (result == SLUICE_SUCCESS && window->end >= 2 && window->bytes[0] == 0x1F &&
        window->bytes[1] == 0x8B) {
        window->end = 0;
        window->file_offset = 0;
        window->is_over = false;
        result = start_inflater(window);
        if (result == SLUICE_SUCCESS)
            slc_pbrt_window_refill(window, 0);
    }
    if (result == SLUICE_SUCCESS)
        return SLUICE_SUCCESS;
fail:
    slc_pbrt_window_finish(window);
    return result;
}

void slc_pbrt_window_finish(struct slc_pbrt_window *window)
{
    if (!window->is_open)
        return;
    finish_inflater(window);
    slc_free(&window->allocator, window->bytes, SLC_PBRT_WINDOW_SIZE + 1, 1);
    slc_file_close(window->descriptor);
    *window = (struct slc_pbrt_window){0};
}
