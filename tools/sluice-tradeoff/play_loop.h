/** The frame loop of "SLTRACE1 traces" in docs/replay.md, on the public interface of the
 * manager. */
#ifndef SLUICE_TRADEOFF_PLAY_LOOP_H
#define SLUICE_TRADEOFF_PLAY_LOOP_H

#include "play_feedback.h"
#include "play_view.h"

/** Counts of a frame: a row of frames.csv. */
struct play_frame {
    uint64_t time; ///< us, as in the trace
    uint32_t map_count;
    struct view_counts view; ///< state before the frame's maps were processed
    uint32_t loaded_tiles, stale_tiles, unmapped_tiles, canceled_tiles;
    /* at the end of the frame */
    uint32_t requested_tiles, tiles_in_flight, resident_tiles, heaps;
    double core_us; ///< time in calls of the manager, except in those that only query it
};

struct play_load {
    SluiceTextureId id;
    uint32_t tile;
    uint32_t frame; ///< frame in which the load was handed out
};

/** Zeroed is finished. */
struct play_loop {
    const struct play_options *options;
    struct feedback_trace *trace;
    SluiceStreamedTextureManager *manager;
    SluiceTextureId *ids; ///< owned; by the trace's index
    struct view view;
    struct play_feedback feedback;
    struct play_load *loads; ///< owned; in the order in which they were handed out
    uint32_t load_count, load_room;
    SluiceTile *tiles; ///< owned; [load_room]
    uint32_t *batch;   ///< owned; [load_room]; indices of loads answered together
    uint32_t next_heap;
    struct play_frame *frames; ///< owned; [trace->frame_count]
    struct play_frame now;
    uint64_t began_ns;                          ///< start of the current call
    uint64_t core_ns;                           ///< manager time of the frame
    SluiceStreamedTextureStatistics statistics; ///< after the latest frame
};

/** Creates the manager with the trace's textures. Returns false if the trace exceeds the limits or
 * the memory, with a message on stderr. `options` and `trace` must outlive the loop. */
bool play_loop_init(struct play_loop *loop, const struct play_options *options,
                    struct feedback_trace *trace);
/** Plays all frames. Reports errors on stderr. */
bool play_loop_run(struct play_loop *loop);
void play_loop_finish(struct play_loop *loop);

#endif /* SLUICE_TRADEOFF_PLAY_LOOP_H */
