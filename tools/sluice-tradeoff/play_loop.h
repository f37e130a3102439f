/** The frame loop of docs/replay.md, "SLTRACE1 traces", through the public interface of the
 * manager. */
#ifndef SLUICE_TRADEOFF_PLAY_LOOP_H
#define SLUICE_TRADEOFF_PLAY_LOOP_H

#include "play_feedback.h"
#include "play_view.h"

/** What is known of a frame; a row of frames.csv. */
struct play_frame {
    uint64_t time; ///< us, as in the trace
    uint32_t map_count;
    struct view_counts view; ///< before the frame's maps were processed
    uint32_t loaded_tiles, stale_tiles, unmapped_tiles, canceled_tiles;
    /* at the end of the frame */
    uint32_t requested_tiles, tiles_in_flight, resident_tiles, heaps;
    double core_us; ///< in calls of the manager, those left out that only look at it
};

struct play_load {
    SluiceTextureId id;
    uint32_t tile;
    uint32_t frame; ///< that it was handed out in
};

/** Zeroed is finished. */
struct play_loop {
    const struct play_options *options;
    struct feedback_trace *trace;
    SluiceStreamedTextureManager *manager;
    SluiceTextureId *ids; ///< owned; by the trace's index
    struct view view;
    struct play_feedback feedback;
    struct play_load *loads; ///< owned; first handed out first
    uint32_t load_count, load_room;
    SluiceTile *tiles; ///< owned; [load_room]
    uint32_t *batch;   ///< owned; [load_room], indices of one answer
    uint32_t next_heap;
    struct play_frame *frames; ///< owned; [trace->frame_count]
    struct play_frame now;
    uint64_t began_ns;                          ///< of a call that is under way
    uint64_t core_ns;                           ///< of the frame
    SluiceStreamedTextureStatistics statistics; ///< after the latest frame
};

/** Creates the manager with the trace's textures. False, with a message on stderr, if the trace
 * asks for more than can be had. `options` and `trace` must stay. */
bool play_loop_init(struct play_loop *loop, const struct play_options *options,
                    struct feedback_trace *trace);
/** Plays all frames. Says on stderr why it failed. */
bool play_loop_run(struct play_loop *loop);
void play_loop_finish(struct play_loop *loop);

#endif /* SLUICE_TRADEOFF_PLAY_LOOP_H */
