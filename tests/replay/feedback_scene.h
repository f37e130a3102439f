/** A small "SLTRACE1" trace, made from the description in docs/replay.md. */
#ifndef TESTS_REPLAY_FEEDBACK_SCENE_H
#define TESTS_REPLAY_FEEDBACK_SCENE_H

#include "random_app.h"

/** Textures 0 (512), 1 (1024, follows 0) and 2 (256); a window that moves and then stands. */
void make_feedback_scene(struct trace_buffer *trace);

#endif /* TESTS_REPLAY_FEEDBACK_SCENE_H */
