/** Names and numbers of keys, for input events, scripts and the page of keys. */
#ifndef SLUICE_VIEW_KEYS_H
#define SLUICE_VIEW_KEYS_H

#include <stddef.h>

/** Keys. Printable keys have the number of their ASCII capital, other keys the number of GLFW. */
enum view_key {
    VIEW_KEY_NONE = 0,
    VIEW_KEY_SPACE = 32,
    VIEW_KEY_BACKQUOTE = 96,
    VIEW_KEY_ESCAPE = 256,
    VIEW_KEY_ENTER,
    VIEW_KEY_TAB,
    VIEW_KEY_BACKSPACE,
    VIEW_KEY_INSERT,
    VIEW_KEY_DELETE,
    VIEW_KEY_RIGHT,
    VIEW_KEY_LEFT,
    VIEW_KEY_DOWN,
    VIEW_KEY_UP,
    VIEW_KEY_PAGE_UP,
    VIEW_KEY_PAGE_DOWN,
    VIEW_KEY_HOME,
    VIEW_KEY_END,
    VIEW_KEY_F1 = 290,
    VIEW_KEY_F5 = 294,
    VIEW_KEY_F11 = 300,
    VIEW_KEY_F12,
    VIEW_KEY_SHIFT = 340,
    VIEW_KEY_CONTROL,
    VIEW_KEY_ALT,
    VIEW_KEY_COUNT = 349
};

enum view_modifier { VIEW_SHIFT = 1, VIEW_CONTROL = 2, VIEW_ALT = 4 };

/** A key with held modifiers: "Shift+R", "Ctrl-Q", "F1", "space". */
struct view_chord {
    int key;
    unsigned modifiers; ///< enum view_modifier
};

/** Reads a chord. False if `text` names no key. */
int view_chord_read(const char *text, struct view_chord *chord);

#endif /* SLUICE_VIEW_KEYS_H */
