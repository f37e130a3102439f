/*
 * Snapshots. A snapshot is a sequence of blocks with numbers (varints) and maps (coded like
 * feedback maps). Blocks do not split numbers or maps.
 */
#include "replay/snapshot.h"

#include "replay/runs.h"
#include "replay/trace_reader.h"

/* Writing ----------------------------------------------------------------------------------- */

static uint64_t write_number(void *user, uint64_t value)
{
    SluiceRecorder *recorder = user;
    slc_put_varint(&recorder->block, value);
    return value;
}

static void write_bytes(void *user, uint8_t *bytes, size_t size)
{
    SluiceRecorder *recorder = user;
    slc_put_map(&recorder->block, bytes, size);
}

static void end_part(void *user)
{
    slc_recorder_end_record(user);
}

void slc_write_snapshot(SluiceRecorder *recorder,
                        void (*write)(const void *source, struct slc_snapshot_io *io),
                        const void *source)
{
    struct slc_snapshot_io io = {.user = recorder,
                                 .cb = &recorder->cb,
                                 .number = write_number,
                                 .bytes = write_bytes,
                                 .part = end_part};
    write(source, &io);
    if (recorder->result == SLUICE_SUCCESS)
        recorder->result = io.result;
    slc_recorder_end_snapshot(recorder);
}

/* Reading ----------------------------------------------------------------------------------- */

struct reader {
    struct slc_replay *replay;
    uint64_t *checksum;
    struct slc_cursor block;
    size_t start; ///< start of the last read item
    bool ended;   ///< the snapshot's end mark was read
    bool reported;
    struct slc_snapshot_io io;
};

static void next_block(struct reader *reader)
{
    struct slc_cursor *in = &reader->replay->in;
    size_t end = 0;
    in->pos = reader->block.end;
    reader->io.result = slc_read_block(reader->replay, reader->checksum, &end);
    reader->reported = reader->io.result != SLUICE_SUCCESS;
    reader->ended = !reader->reported && end == in->pos;
    if (!reader->reported)
        reader->block = (struct slc_cursor){in->data, in->pos, end, NULL};
}

/** Begins the next block if the current block is exhausted. False: error. */
static bool begin_field(struct reader *reader)
{
    if (reader->io.result == SLUICE_SUCCESS && reader->block.pos == reader->block.end &&
        !reader->ended)
        next_block(reader);
    reader->start = reader->block.pos;
    if (reader->io.result == SLUICE_SUCCESS && reader->ended) {
        reader->io.result = SLUICE_ERROR_CORRUPT_DATA;
        reader->io.why = "the snapshot ends before all of it was there";
    }
    return reader->io.result == SLUICE_SUCCESS;
}

static void end_field(struct reader *reader)
{
    if (!reader->block.why)
        return;
    reader->io.result = SLUICE_ERROR_CORRUPT_DATA;
    reader->io.why = reader->block.why;
    reader->start = reader->block.pos;
}

static uint64_t read_number(void *user, uint64_t value)
{
    struct reader *reader = user;
    if (!begin_field(reader))
        return 0;
    value = slc_get_varint(&reader->block);
    end_field(reader);
    return value;
}

static void read_bytes(void *user, uint8_t *bytes, size_t size)
{
    struct reader *reader = user;
    if (!begin_field(reader))
        return;
    uint64_t coded = slc_get_varint(&reader->block);
    size_t start = reader->block.pos;
    if (slc_get_bytes(&reader->block, coded)) {
        struct slc_cursor runs = {reader->block.data, start, reader->block.pos, NULL};
        slc_get_runs(&runs, bytes, size);
        if (runs.why)
            slc_cursor_fail(&reader->block, runs.pos, runs.why);
    }
    end_field(reader);
}

static void part_was_read(void *user)
{
    (void)user;
}

/** Checks that the block is exhausted, and reads the end mark. */
static void read_end(struct reader *reader)
{
    if (reader->io.result == SLUICE_SUCCESS && reader->block.pos == reader->block.end)
        next_block(reader);
    reader->start = reader->block.pos;
    if (reader->io.result != SLUICE_SUCCESS || reader->ended)
        return;
    reader->io.result = SLUICE_ERROR_CORRUPT_DATA;
    reader->io.why = "there is more behind the snapshot";
}

SluiceResult slc_read_snapshot(struct slc_replay *replay, uint64_t *checksum,
                               void (*read)(void *target, struct slc_snapshot_io *io), void *target)
{
    struct reader reader = {.replay = replay,
                            .checksum = checksum,
                            .block = replay->in,
                            .io = {.cb = &replay->cb,
                                   .reading = true,
                                   .number = read_number,
                                   .bytes = read_bytes,
                                   .part = part_was_read}};
    reader.io.user = &reader;
    reader.block.end = reader.block.pos;
    read(target, &reader.io);
    read_end(&reader);
    if (reader.io.result == SLUICE_ERROR_CORRUPT_DATA && !reader.reported)
        return slc_replay_corrupt(replay, reader.start, reader.io.why);
    return reader.io.result;
}
