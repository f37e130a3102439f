/**
 * Scripts of events. A line has a frame number, an event and its arguments.
 *
 *     40 key 3
 *     60 click 312 200
 *     80 set budget 16
 *     90 screenshot out.png
 *     120 quit
 *
 * Events are key CHORD, hold CHORD FRAMES, type TEXT, hover X Y, click X Y [left|right|middle],
 * double-click X Y, drag X Y X Y [FRAMES], wheel N, drop PATH, set NAME VALUE, set b NAME VALUE, do
 * ACTION, record FILE, frame NUMBER (of a recording), screenshot FILE, reset and quit. Empty lines
 * and text after '#' are ignored.
 */
#ifndef SLUICE_VIEW_SCRIPT_H
#define SLUICE_VIEW_SCRIPT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum script_kind {
    SCRIPT_MOVE,   ///< x, y
    SCRIPT_BUTTON, ///< number, down
    SCRIPT_KEY,    ///< number, down
    SCRIPT_WHEEL,  ///< x
    SCRIPT_TYPE,   ///< text
    SCRIPT_DROP,   ///< text
    SCRIPT_SET,    ///< text, value
    SCRIPT_SET_B,  ///< text, value
    SCRIPT_DO,     ///< text: an action of texture_actions.h
    SCRIPT_RECORD, ///< text: path of the recording
    SCRIPT_FRAME,  ///< number: frame of the shown recording
    SCRIPT_RESET,  ///< restores settings, panels and camera
    SCRIPT_SCREENSHOT,
    SCRIPT_QUIT
};

/** A step of input. A click has three steps: a move and two buttons. */
struct script_step {
    uint32_t frame, order; ///< `order`: position in the file, for steps of one frame
    enum script_kind kind;
    int number;
    bool down;
    float x, y;
    char *text, *value; ///< owned
};

struct script {
    struct script_step *steps; ///< sorted by frame
    size_t count, capacity, next;
};

/** Reads a script, which must be zeroed or finished. False, with file, line and cause on stderr, on
 *  failure. */
bool script_read(const char *path, struct script *script);
/** Reads a script from a text. Messages begin with `name`. */
bool script_parse(const char *name, const char *text, struct script *script);
void script_finish(struct script *script);
/** Returns the next step of a frame; NULL: no step is left. */
const struct script_step *script_next(struct script *script, uint32_t frame);
/** Returns the last frame with a step. */
uint32_t script_last_frame(const struct script *script);

#endif /* SLUICE_VIEW_SCRIPT_H */
