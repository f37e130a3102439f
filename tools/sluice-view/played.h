/**
 * A recording of a manager, shown frame by frame. Opening plays the recording once and counts the
 * events of each frame. Then the cursor can go to any frame. The library's trace player makes the
 * decisions again.
 */
#ifndef SLUICE_VIEW_PLAYED_H
#define SLUICE_VIEW_PLAYED_H

#include "tile_log.h"

#include <sluice/replay.h>

#define PLAYED_EVENTS 2048u
#define PLAYED_BLOCK 64u ///< frames
#define PLAYED_NO_TEXTURE UINT32_MAX
#define PLAYED_TICKS_PER_SECOND 1000000u ///< traces do not tell the unit of time stamps

/** Figures of a frame. Figures up to PLAYED_BIAS are the state at its end, later figures count. */
enum played_figure {
    PLAYED_REQUESTED, ///< tiles
    PLAYED_LOADING,
    PLAYED_RESIDENT, ///< resident and wanted
    PLAYED_STANDBY,  ///< resident, not wanted
    PLAYED_CANCELING,
    PLAYED_FAILING, ///< the load failed and will be retried
    PLAYED_GIVEN_UP,
    PLAYED_HEAPS,
    PLAYED_FREE_SLOTS,
    PLAYED_BUDGET, ///< heaps that the configuration allows; 0: no limit
    PLAYED_BIAS,   ///< sixteenths of a level
    PLAYED_LISTED, ///< tiles that were handed out
    PLAYED_LOADED,
    PLAYED_EVICTED, ///< tiles whose slots were freed
    PLAYED_CANCELED,
    PLAYED_FAILED,       ///< reads that failed
    PLAYED_RESTORED,     ///< tiles restored from standby
    PLAYED_LOST,         ///< wanted tiles that were evicted
    PLAYED_STALE,        ///< tiles that nothing requested after their load
    PLAYED_MAPS,         ///< feedback maps
    PLAYED_TEXELS,       ///< texels of these maps
    PLAYED_REFUSED,      ///< heaps that the device refused
    PLAYED_MICROSECONDS, ///< until the next frame, if ticks are microseconds; at most 2^32 - 1
    PLAYED_FIGURES
};

struct played_frame {
    uint64_t first_call; ///< number of calls before the frame
    uint64_t time;       ///< time stamp; copied from the previous frame if it has none
    uint32_t figures[PLAYED_FIGURES];
};

struct played_texture {
    SluiceTextureId id;
    SluiceStreamedTextureDesc desc;
    uint32_t tile_count, map_size; ///< `map_size`: texels of its MinMip map
    uint32_t primary;              ///< index of its primary; PLAYED_NO_TEXTURE: none
    char name[32];                 ///< name, as in sluice-replay --dump
};

/** A checkpoint: the state at the begin of a frame. */
struct played_point {
    uint32_t frame;
    void *bytes; ///< owned; written by sluiceWriteTraceCheckpoint
    size_t size, capacity;
    struct tile_log_kept log;
    SluiceTileEvent *events; ///< owned
    uint32_t event_count;
    uint64_t lost_events, timeout;
};

struct played {
    char *data; ///< owned; the trace
    size_t size;
    uint64_t memory_left; ///< bytes that the trace player may still allocate
    SluiceAllocationCallbacks callbacks;
    SluiceTracePlayer *player;
    SluiceStreamedTextureManager *manager; ///< borrowed; another one after each jump
    SluiceTracePlayerState begin, end;     ///< before the first and after the last call
    char name[256];                        ///< name of the file, for messages
    char message[256];                     ///< message of the library about the trace
    bool damaged;                          ///< frames before the damage are shown

    struct played_frame *frames; ///< owned
    uint32_t frame_count, frame_capacity;
    uint32_t *peaks; ///< owned; [frames / PLAYED_BLOCK][PLAYED_FIGURES], largest of a block
    struct played_texture *textures; ///< owned
    uint32_t texture_count, texture_capacity;
    struct played_point *points; ///< owned; ascend
    uint32_t point_count;
    uint32_t stride; ///< frames between points
    size_t point_size, most_point_size;

    /* State at the cursor: after the last call of `frame`. */
    uint32_t frame;
    bool is_partial; ///< some calls of the frame are not played: memory was short
    struct tile_log log;
    SluiceTileEvent *events; ///< owned; the last PLAYED_EVENTS, a ring. Marks: frames.
    uint32_t event_count, event_next;
    uint64_t event_cursor, lost_events;
    uint64_t timeout; ///< timeout of the last feedback map
    bool playing;     ///< the cursor advances by itself
};

/** Receives the part of a recording that was read, 0 to 1. Return false to cancel. */
typedef bool played_progress(void *user, double part);

/** Returns true if a file is a trace, by its first bytes or by its name. */
bool played_takes(const char *path);
/** Opens a recording and goes to its first frame. Opens a damaged recording up to the damage, with
 * a line on stderr. NULL, with a line on stderr, if there is no frame to show. `progress` NULL:
 * none. */
struct played *played_open(const char *path, played_progress *progress, void *user);
/** Opens a recording in memory. Takes `data`, which malloc must have allocated. `most_point_size`:
 *  bytes of all checkpoints; 0: the default. */
struct played *played_open_bytes(const char *name, char *data, size_t size, size_t most_point_size,
                                 played_progress *progress, void *user);
/** Closes the recording. NULL is allowed. */
void played_close(struct played *played);
/** Goes to a frame, at most to the last one. False if memory ran out while playing: the cursor is
 *  where playing ended. */
bool played_go(struct played *played, uint32_t frame);
/** Returns the nearest frame after (`direction` 1) or before (-1) `from` whose figure is not 0.
 *  UINT32_MAX: none. */
uint32_t played_find(const struct played *played, uint32_t from, enum played_figure figure,
                     int direction);
/** Returns the longest frame, by the time until the next frame. */
uint32_t played_longest(const struct played *played);
/** Returns the largest value of frames `first` to `end` - 1. */
uint32_t played_peak(const struct played *played, enum played_figure figure, uint32_t first,
                     uint32_t end);
/** Returns the name of a figure in JSON: "tiles_requested". */
const char *played_figure_name(enum played_figure figure);
/** Returns the number of wanted tiles, resident or not. */
uint32_t played_wanted(const struct played_frame *frame);
/** Finds a texture by its id. False if the recording has no such texture. */
bool played_find_texture(const struct played *played, SluiceTextureId id, uint32_t *index);

#endif /* SLUICE_VIEW_PLAYED_H */
