/**
 * A file read front to back through a small buffer, decompressed if it is a gzip file. Files are
 * not mapped: one that another program cuts off would end the process.
 */
#ifndef SLC_PBRT_BYTE_WINDOW_H
#define SLC_PBRT_BYTE_WINDOW_H

#include <sluice/base.h>

#define SLC_PBRT_WINDOW_SIZE ((size_t)1 << 17)

/** Identity of a file's contents: differs when the file has changed. */
struct slc_pbrt_stamp {
    uint64_t device, inode, size;
    int64_t seconds, nanoseconds;
};

/** Asked before files of windows are read. */
struct slc_pbrt_watch {
    void *user;
    bool (*goes_on)(void *user, uint64_t read_size); ///< NULL: nobody is asked
    uint64_t read_size;                              ///< bytes of text that all windows have read
};

/** Zeroed: closed. `bytes[end]` is always 0, so that scans may stop there. */
struct slc_pbrt_window {
    SluiceAllocationCallbacks allocator;
    int descriptor;
    unsigned char *bytes;         ///< owned; SLC_PBRT_WINDOW_SIZE + 1
    size_t cursor, end;           ///< not read yet
    uint64_t base;                ///< offset of bytes[0] in the text, decompressed
    uint64_t file_offset;         ///< of the next byte to read from the file
    bool is_open, is_over;        ///< is_over: nothing follows bytes[end]
    SluiceResult failure;         ///< of reading; the text counts as over then
    uint64_t most;                ///< bytes of text that may be read
    struct slc_pbrt_watch *watch; ///< borrowed; NULL: none
    struct slc_pbrt_stamp stamp;
    struct slc_pbrt_inflater *inflater; ///< owned; NULL: plain
};

/** Opens a regular file. Errors: those of slc_system_result; IO for folders and the like;
 *  UNSUPPORTED for gzip files without zlib. Nothing is logged. */
SluiceResult slc_pbrt_window_open(struct slc_pbrt_window *window, const char *path,
                                  const SluiceAllocationCallbacks *cb);
/** slc_pbrt_window_open with a watch, which may be NULL and outlives the window. If goes_on
 *  returns false the text counts as over, with the failure CANCELED. */
SluiceResult slc_pbrt_window_open_watched(struct slc_pbrt_window *window, const char *path,
                                          struct slc_pbrt_watch *watch,
                                          const SluiceAllocationCallbacks *cb);
void slc_pbrt_window_finish(struct slc_pbrt_window *window);

/**
 * Moves bytes[keep] to the front and reads more behind. Returns the number of bytes by which
 * indices have become lower. `keep` <= cursor. Sets is_over at the end.
 */
size_t slc_pbrt_window_refill(struct slc_pbrt_window *window, size_t keep);

/** Sets the most bytes of text. Text beyond it is a failure: LIMIT_EXCEEDED. */
void slc_pbrt_window_limit(struct slc_pbrt_window *window, uint64_t most);

/** Goes to an offset of the text, at or behind the present one. False: the text ends before. */
bool slc_pbrt_window_seek(struct slc_pbrt_window *window, uint64_t offset);

/** Copies `size` bytes and goes on behind them. False: the text ends before. */
bool slc_pbrt_window_take(struct slc_pbrt_window *window, void *bytes, size_t size);

static inline uint64_t slc_pbrt_window_offset(const struct slc_pbrt_window *window)
{
    return window->base + window->cursor;
}

/** Bytes that can still follow at most: known for plain files, UINT64_MAX for compressed ones. */
static inline uint64_t slc_pbrt_window_left(const struct slc_pbrt_window *window)
{
    uint64_t offset = slc_pbrt_window_offset(window);
    if (window->inflater)
        return UINT64_MAX;
    return offset < window->stamp.size ? window->stamp.size - offset : 0;
}

/** Stamp of a file by name, without opening it. False: it is not there. */
bool slc_pbrt_stamp_of(const char *path, struct slc_pbrt_stamp *stamp);
bool slc_pbrt_stamps_equal(const struct slc_pbrt_stamp *a, const struct slc_pbrt_stamp *b);

#endif /* SLC_PBRT_BYTE_WINDOW_H */
