/**
 * Window: reads a file front to back through a small buffer, and decompresses gzip files. Files are
 * not mapped, because truncation by another program would end the process.
 */
#ifndef SLC_PBRT_BYTE_WINDOW_H
#define SLC_PBRT_BYTE_WINDOW_H

#include <sluice/base.h>

#define SLC_PBRT_WINDOW_SIZE ((size_t)1 << 17)

/** Stamp of a file's contents; differs after a change. */
struct slc_pbrt_stamp {
    uint64_t device, inode, size;
    int64_t seconds, nanoseconds;
};

/** Watch: callback before each read of windows. */
struct slc_pbrt_watch {
    void *user;
    bool (*goes_on)(void *user, uint64_t read_size); ///< NULL: always continue
    uint64_t read_size;                              ///< bytes of text read by all windows
};

/** Window. Zeroed: closed. `bytes[end]` is always 0 and stops scans. */
struct slc_pbrt_window {
    SluiceAllocationCallbacks allocator;
    int descriptor;
    unsigned char *bytes;         ///< owned; SLC_PBRT_WINDOW_SIZE + 1
    size_t cursor, end;           ///< range of unread bytes
    uint64_t base;                ///< offset of bytes[0] in the text, decompressed
    uint64_t file_offset;         ///< offset of the next byte to read from the file
    bool is_open, is_over;        ///< is_over: nothing follows bytes[end]
    SluiceResult failure;         ///< error of a read; the text then ends
    uint64_t most;                ///< most bytes of text to read
    struct slc_pbrt_watch *watch; ///< borrowed; NULL: none
    struct slc_pbrt_stamp stamp;
    struct slc_pbrt_inflater *inflater; ///< owned; NULL: not compressed
};

/** Opens a regular file. Errors, not logged: slc_system_result's; IO for other kinds of files;
 *  UNSUPPORTED for gzip files without zlib. */
SluiceResult slc_pbrt_window_open(struct slc_pbrt_window *window, const char *path,
                                  const SluiceAllocationCallbacks *cb);
/** slc_pbrt_window_open with a watch, which may be NULL and must outlive the window. If goes_on
 *  returns false, the text ends with the failure CANCELED. */
SluiceResult slc_pbrt_window_open_watched(struct slc_pbrt_window *window, const char *path,
                                          struct slc_pbrt_watch *watch,
                                          const SluiceAllocationCallbacks *cb);
void slc_pbrt_window_finish(struct slc_pbrt_window *window);

/**
 * Moves bytes[keep] to the front and reads more bytes. Returns the decrease of indices. `keep` <=
 * cursor. Sets is_over at the end.
 */
size_t slc_pbrt_window_refill(struct slc_pbrt_window *window, size_t keep);

/** Sets the most bytes of text. Text beyond it is a failure: LIMIT_EXCEEDED. */
void slc_pbrt_window_limit(struct slc_pbrt_window *window, uint64_t most);

/** Seeks forward to an offset of the text. False: the text ends before. */
bool slc_pbrt_window_seek(struct slc_pbrt_window *window, uint64_t offset);

/** Copies `size` bytes and skips them. False: the text ends before. */
bool slc_pbrt_window_take(struct slc_pbrt_window *window, void *bytes, size_t size);

static inline uint64_t slc_pbrt_window_offset(const struct slc_pbrt_window *window)
{
    return window->base + window->cursor;
}

/** Returns an upper bound of unread bytes; UINT64_MAX for compressed files. */
static inline uint64_t slc_pbrt_window_left(const struct slc_pbrt_window *window)
{
    uint64_t offset = slc_pbrt_window_offset(window);
    if (window->inflater)
        return UINT64_MAX;
    return offset < window->stamp.size ? window->stamp.size - offset : 0;
}

/** Gets the stamp of a file without opening. False: missing. */
bool slc_pbrt_stamp_of(const char *path, struct slc_pbrt_stamp *stamp);
bool slc_pbrt_stamps_equal(const struct slc_pbrt_stamp *a, const struct slc_pbrt_stamp *b);

#endif /* SLC_PBRT_BYTE_WINDOW_H */
