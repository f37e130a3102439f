/** A trace that is being written: header, blocks of records, end mark. docs/replay.md has the form.
 */
#ifndef SLC_REPLAY_RECORDER_H
#define SLC_REPLAY_RECORDER_H

#include "base/part_file.h"
#include "replay/byte_buffer.h"

#include <sluice/replay.h>

#define SLC_TRACE_HEADER_SIZE 40u
/** u32 payload size, u64 checksum. */
#define SLC_TRACE_BLOCK_HEADER_SIZE 12u
/** A block ends with the first record that makes its payload at least so long. */
#define SLC_TRACE_BLOCK_SIZE 4096u
/** Words of the header that belong to the kind of trace. */
#define SLC_TRACE_WORDS 4

struct SluiceRecorder {
    SluiceAllocationCallbacks cb;
    void *source;               ///< Borrowed: who is recorded.
    void (*stop)(void *source); ///< The source tells the recorder no more.
    SluiceRecordWriter writer;
    SluiceResult result;    ///< the first thing that went wrong; nothing is written after it
    struct slc_bytes block; ///< records that are not written yet
    struct slc_bytes head;  ///< of that block
    uint64_t checksum;      ///< over all bytes written so far but checksums
    uint64_t hash;          ///< over all decisions so far
    uint64_t event_count;
    uint32_t last_page;        ///< of demand loading: pages are written as differences
    struct slc_part_file file; ///< Closed if the caller writes.
};

/** NULL without memory. */
SluiceRecorder *slc_recorder_create(const SluiceAllocationCallbacks *cb, void *source,
                                    void (*stop)(void *source));
/**
 * Reads and checks the info of a recording to a file. `refusal`: why the object cannot be recorded,
 * or NULL.
 * Errors, with a message: INVALID_ARGUMENT; those of slc_struct_read.
 */
SluiceResult slc_recorder_read_info(const SluiceFileRecordingInfo *given, const char *refusal,
                                    SluiceFileRecordingInfo *info);
/** The file becomes the writer. After an error the recorder is gone. */
SluiceResult slc_recorder_open_file(SluiceRecorder *recorder, const SluiceFileRecordingInfo *info);
void slc_recorder_write_header(SluiceRecorder *recorder, const char magic[8], uint32_t version,
                               const uint32_t words[SLC_TRACE_WORDS]);
/** Hands the recorder out. If the header could not be written, it is gone, and so is its file. */
SluiceResult slc_recorder_begin(SluiceRecorder *recorder, SluiceRecorder **out);
/** A record was appended to `block`; the block may end with it. */
void slc_recorder_end_record(SluiceRecorder *recorder);
/** The state of the source was appended; writes the mark behind it. */
void slc_recorder_end_snapshot(SluiceRecorder *recorder);
/** What sluiceEndRecording does. */
SluiceResult slc_recorder_end(SluiceRecorder *recorder);

#endif /* SLC_REPLAY_RECORDER_H */
