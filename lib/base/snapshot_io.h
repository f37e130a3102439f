/**
 * Snapshot of an object's state as numbers and bytes. docs/replay.md lists every field.
 *
 * One function writes and reads each part of the state, so that fields are read in the order in
 * which they were written. Fields that follow from others are left out.
 */
#ifndef SLC_BASE_SNAPSHOT_IO_H
#define SLC_BASE_SNAPSHOT_IO_H

#include <sluice/base.h>

#include <stdbool.h>

/** Stream of a snapshot. After an error in `result`, numbers and bytes are meaningless. */
struct slc_snapshot_io {
    void *user;
    const SluiceAllocationCallbacks *cb;
    bool reading;
    /** Writes the value and returns it, or returns the value that was read. */
    uint64_t (*number)(void *user, uint64_t value);
    /** Writes the bytes or fills them. */
    void (*bytes)(void *user, uint8_t *bytes, size_t size);
    /** Ends a part of the state. Memory of written parts may be freed. */
    void (*part)(void *user);
    SluiceResult result; ///< OUT_OF_HOST_MEMORY; CORRUPT_DATA: `why`
    const char *why;
};

/** Refuses the snapshot that is being read. */
static inline void slc_snapshot_fail(struct slc_snapshot_io *io, const char *why)
{
    if (io->result != SLUICE_SUCCESS)
        return;
    io->result = SLUICE_ERROR_CORRUPT_DATA;
    io->why = why;
}

static inline bool slc_snapshot_is_good(const struct slc_snapshot_io *io)
{
    return io->result == SLUICE_SUCCESS;
}

/** Returns a number, at most `most` and 0 after an error. */
static inline uint64_t slc_snapshot_number(struct slc_snapshot_io *io, uint64_t value,
                                           uint64_t most)
{
    if (!slc_snapshot_is_good(io))
        return 0;
    uint64_t got = io->number(io->user, value);
    if (slc_snapshot_is_good(io) && got > most)
        slc_snapshot_fail(io, "a value of the snapshot is above its limit");
    return slc_snapshot_is_good(io) ? got : 0;
}

static inline void slc_snapshot_u64(struct slc_snapshot_io *io, uint64_t *value)
{
    uint64_t got = slc_snapshot_number(io, *value, UINT64_MAX);
    if (io->reading)
        *value = got;
}

static inline void slc_snapshot_u32(struct slc_snapshot_io *io, uint32_t *value, uint32_t most)
{
    uint64_t got = slc_snapshot_number(io, *value, most);
    if (io->reading)
        *value = (uint32_t)got;
}

static inline void slc_snapshot_u8(struct slc_snapshot_io *io, uint8_t *value, uint8_t most)
{
    uint64_t got = slc_snapshot_number(io, *value, most);
    if (io->reading)
        *value = (uint8_t)got;
}

static inline void slc_snapshot_flag(struct slc_snapshot_io *io, bool *value)
{
    uint64_t got = slc_snapshot_number(io, *value, 1);
    if (io->reading)
        *value = got;
}

/** 0 is 0, 1 is -1, 2 is 1, 3 is -2, and so on. */
static inline int64_t slc_snapshot_signed(struct slc_snapshot_io *io, int64_t value)
{
    uint64_t coded = (uint64_t)value << 1 ^ (value < 0 ? UINT64_MAX : 0);
    coded = slc_snapshot_number(io, coded, UINT64_MAX);
    return (int64_t)(coded >> 1 ^ (coded & 1 ? UINT64_MAX : 0));
}

#endif /* SLC_BASE_SNAPSHOT_IO_H */
