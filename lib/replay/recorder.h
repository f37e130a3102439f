/** Recorder: writes a trace of header, blocks of records, and end mark (docs/replay.md). */
#ifndef SLC_REPLAY_RECORDER_H
#define SLC_REPLAY_RECORDER_H

#include "base/part_file.h"
#include "replay/byte_buffer.h"

#include <sluice/replay.h>

#define SLC_TRACE_HEADER_SIZE 40u
/** Bytes of a block header: u32 payload size, u64 checksum. */
#define SLC_TRACE_BLOCK_HEADER_SIZE 12u
/** Least payload of a block. The block ends with the record that reaches this size. */
#define SLC_TRACE_BLOCK_SIZE 4096u
/** Number of header words that depend on the kind of trace. */
#define SLC_TRACE_WORDS 4

struct SluiceRecorder {
    SluiceAllocationCallbacks cb;
    void *source;               ///< borrowed; the recorded object
    void (*stop)(void *source); ///< detaches the recorder from the source
    SluiceRecordWriter writer;
    SluiceResult result;    ///< first error; nothing is written after an error
    struct slc_bytes block; ///< records still to be written
    struct slc_bytes head;  ///< header of the block
    uint64_t checksum;      ///< over all written bytes except checksums
    uint64_t hash;          ///< over all recorded decisions
    uint64_t event_count;
    uint32_t last_page;        ///< demand loading: pages are written as differences
    struct slc_part_file file; ///< closed if the caller writes
};

/** Creates a recorder. NULL: out of memory. */
SluiceRecorder *slc_recorder_create(const SluiceAllocationCallbacks *cb, void *source,
                                    void (*stop)(void *source));
/**
 * Reads and checks the info of a recording to a file. `refusal`: reason why the object cannot be
 * recorded, or NULL.
 * Errors, with a message: INVALID_ARGUMENT; those of slc_struct_read.
 */
SluiceResult slc_recorder_read_info(const SluiceFileRecordingInfo *given, const char *refusal,
                                    SluiceFileRecordingInfo *info);
/** Opens a file as the writer. Destroys the recorder on an error. */
SluiceResult slc_recorder_open_file(SluiceRecorder *recorder, const SluiceFileRecordingInfo *info);
void slc_recorder_write_header(SluiceRecorder *recorder, const char magic[8], uint32_t version,
                               const uint32_t words[SLC_TRACE_WORDS]);
/** Writes the header and returns the recorder. Destroys recorder and file on an error. */
SluiceResult slc_recorder_begin(SluiceRecorder *recorder, SluiceRecorder **out);
/** Ends a record in `block`, and the block if large enough. */
void slc_recorder_end_record(SluiceRecorder *recorder);
/** Ends the snapshot of the source: writes the mark behind it. */
void slc_recorder_end_snapshot(SluiceRecorder *recorder);
/** Implements sluiceEndRecording. */
SluiceResult slc_recorder_end(SluiceRecorder *recorder);

#endif /* SLC_REPLAY_RECORDER_H */
