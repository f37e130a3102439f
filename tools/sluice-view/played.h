/**
 * A recording of a manager that is looked at frame by frame. It is played once from end to end,
 * which counts what each frame did; afterwards any frame can be gone to. The decisions are those of
 * the library's trace player.
 */
#ifndef SLUICE_VIEW_PLAYED_H
#define SLUICE_VIEW_PLAYED_H

#include "tile_log.h"

#include <sluice/replay.h>

#define PLAYED_EVENTS 2048u
#define PLAYED_BLOCK 64u ///< frames
#define PLAYED_NO_TEXTURE UINT32_MAX
#define PLAYED_TICKS_PER_SECOND 1000000u ///< traces do not tell the unit of time stamps

/** Figures of a frame. The first ones are as of its end, the others count what it did. */
enum played_figure {
    PLAYED_REQUESTED, ///< tiles
    PLAYED_LOADING,
    PLAYED_RESIDENT, ///< and wanted
    PLAYED_STANDBY,  ///< resident, not wanted
    PLAYED_CANCELING,
    PLAYED_FAILING, ///< their load failed and will be retried
    PLAYED_GIVEN_UP,
    PLAYED_HEAPS,
    PLAYED_FREE_SLOTS,
    PLAYED_BUDGET, ///< heaps that the configuration allows; 0: no limit
    PLAYED_BIAS,   ///< sixteenths of a level
    PLAYED_LISTED, ///< tiles that were handed out
    PLAYED_LOADED,
    PLAYED_EVICTED, ///< tiles whose slots were given back
    PLAYED_CANCELED,
    PLAYED_FAILED,       ///< reads
    PLAYED_RESTORED,     ///< from standby
    PLAYED_LOST,         ///< wanted tiles that were evicted
    PLAYED_STALE,        ///< tiles that were loaded, and nothing requested them any more
    PLAYED_MAPS,         ///< of feedback
    PLAYED_TEXELS,       ///< of these maps
    PLAYED_REFUSED,      ///< heaps that the device refused
    PLAYED_MICROSECONDS, ///< until the next frame, if ticks are microseconds; at most 2^32 - 1
    PLAYED_FIGURES
};

struct played_frame {
    uint64_t first_call; ///< number of calls before it
    uint64_t time;       ///< time stamp; that of the frame before if it has none
    uint32_t figures[PLAYED_FIGURES];
};

struct played_texture {
    SluiceTextureId id;
    SluiceStreamedTextureDesc desc;
    uint32_t tile_count, map_size; ///< map: texels of its MinMip map
    uint32_t primary;              ///< index; PLAYED_NO_TEXTURE: it follows none
    char name[32];                 ///< as sluice-replay --dump has it
};

/** State at the begin of a frame. */
struct played_point {
    uint32_t frame;
    void *bytes; ///< owned; of sluiceWriteTraceCheckpoint
    size_t size, capacity;
    struct tile_log_kept log;
    SluiceTileEvent *events; ///< owned
    uint32_t event_count;
    uint64_t lost_events, timeout;
};

struct played {
    char *data; ///< owned; the trace
    size_t size;
    uint64_t memory_left; ///< of what traces may allocate
    SluiceAllocationCallbacks callbacks;
    SluiceTracePlayer *player;
    SluiceStreamedTextureManager *manager; ///< borrowed; another one after each jump
    SluiceTracePlayerState begin, end;     ///< before the first call, and behind the last one
    char name[256];                        ///< of the file, for messages
    char message[256];                     ///< of the library, about the trace
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

    /* At the cursor: behind the last call of this frame. */
    uint32_t frame;
    struct tile_log log;
    SluiceTileEvent *events; ///< owned; the last PLAYED_EVENTS, a ring. Marks: frames.
    uint32_t event_count, event_next;
    uint64_t event_cursor, lost_events;
    uint64_t timeout; ///< of the last map
    bool playing;     ///< goes on by itself
};

/** Told now and then while a recording is opened: part of it that was read, 0 to 1. False: cancel.
 */
typedef bool played_progress(void *user, double part);

/** Whether a file is a trace: it begins as one, or is called one. */
bool played_takes(const char *path);
/** Opens a recording and goes to its first frame. NULL, with a line on stderr, if there is no frame
 *  to show. A recording that is damaged later is opened up to there, with a line on stderr.
 *  `progress` NULL: nobody asks. */
struct played *played_open(const char *path, played_progress *progress, void *user);
/** Takes the bytes, which were malloc'd. `most_point_size`: bytes of checkpoints; 0: the default.
 */
struct played *played_open_bytes(const char *name, char *data, size_t size, size_t most_point_size,
                                 played_progress *progress, void *user);
/** NULL is allowed. */
void played_close(struct played *played);
/** Goes to a frame; the last one if it is beyond. False, and the cursor is where that happened, if
 *  the recording cannot be played again: out of memory. */
bool played_go(struct played *played, uint32_t frame);
/** Returns the next frame behind or before a frame that has any of a figure; UINT32_MAX: none. */
uint32_t played_find(const struct played *played, uint32_t from, enum played_figure figure,
                     int direction);
/** Returns the longest frame: the one with the most time until the next. */
uint32_t played_longest(const struct played *played);
/** Returns the largest value of frames `first` to `end` - 1. */
uint32_t played_peak(const struct played *played, enum played_figure figure, uint32_t first,
                     uint32_t end);
/** Name for programs: "tiles_requested". */
const char *played_figure_name(enum played_figure figure);
/** Tiles that are wanted, resident or not. */
uint32_t played_wanted(const struct played_frame *frame);
/** Finds a texture by its id. False: it is none of the recording. */
bool played_find_texture(const struct played *played, SluiceTextureId id, uint32_t *index);

#endif /* SLUICE_VIEW_PLAYED_H */
