/**
 * Scripts of events: a line has the number of a frame, an event and what the event needs.
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
 * and what follows '#' are passed over.
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
    SCRIPT_DO,     ///< text: texture_actions.h
    SCRIPT_RECORD, ///< text: a file
    SCRIPT_FRAME,  ///< number: of a recording that is shown
    SCRIPT_RESET,  ///< settings, panels and camera as at first
    SCRIPT_SCREENSHOT,
    SCRIPT_QUIT
};

/** Input of one frame: a click is a move and two buttons. */
struct script_step {
    uint32_t frame, order; ///< steps of a frame have the order of the file
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

/** False, with file, line and cause on stderr. Zero or finish the script before. */
bool script_read(const char *path, struct script *script);
/** Reads a script from a text. `name` stands in messages. */
bool script_parse(const char *name, const char *text, struct script *script);
void script_finish(struct script *script);
/** The next step of this frame; NULL when there is none left. */
const struct script_step *script_next(struct script *script, uint32_t frame);
/** The last frame that a step is in. */
uint32_t script_last_frame(const struct script *script);

#endif /* SLUICE_VIEW_SCRIPT_H */
