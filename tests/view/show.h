/** A scene that is drawn frame by frame, as the headless viewer draws it, for tests. */
#ifndef TESTS_VIEW_SHOW_H
#define TESTS_VIEW_SHOW_H

#include "support/test.h"

#include "app.h"

#define SHOW_WIDTH 160u
#define SHOW_HEIGHT 120u
#define SHOW_FRAME_MICROSECONDS 20000u

struct show {
    struct gpu gpu;
    struct frames frames;
    struct view_app app;
    struct stage *stage; ///< NULL: there is no device
    uint64_t clock;
};

/** A setup function of cmocka. Draws the room in paged mode, without panels, at the settings of
 *  tests: every quad writes, all maps are read, nothing fades. */
int show_begin(void **state);
int show_end(void **state);
/** The present one. Skips the test without a device. */
struct show *show_get(void);
SluiceStreamedTextureManager *show_manager(void);
/** Draws a frame, and waits for all that it loads. Returns its pixels: RGBA. */
const uint8_t *show_draw(void);

#endif /* TESTS_VIEW_SHOW_H */
