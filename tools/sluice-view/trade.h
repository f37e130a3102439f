/**
 * A sweep of settings over the shown scene and a camera path. sluice-tradeoff runs as a child
 * process, which runs this program without a window.
 */
#ifndef SLUICE_VIEW_TRADE_H
#define SLUICE_VIEW_TRADE_H

#include "camera.h"
#include "settings.h"

#include "../common/files.h"
#include "../sluice-tradeoff/child.h"
#include "../sluice-tradeoff/memory.h"

#define TRADE_ADVICE 3

enum trade_state { TRADE_NONE, TRADE_RUNS, TRADE_DONE, TRADE_FAILED, TRADE_CANCELED };

struct trade_request {
    const struct view_settings
        *settings;                  ///< base of the sweep: settings that are not at their default
    const struct camera_path *path; ///< NULL or empty: the camera stands at `camera`
    const struct view_camera *camera;
    const struct file_list *paths; ///< paths of the scene; none: the room
    const char *cache, *device;    ///< NULL: the default
    uint32_t threads;              ///< 0: the default
};

struct trade {
    enum trade_state state;
    struct child child;
    struct text_list arguments;
    char *out, *error;    ///< owned
    unsigned done, total; ///< runs
    double looked;        ///< time of the last count, clock_seconds()
    char advice[TRADE_ADVICE][160];
    char reason[400]; ///< cause of TRADE_FAILED
};

/** Kills a sweep that runs. A zeroed struct is allowed. */
void trade_finish(struct trade *trade);
/** Begins a sweep into TRADE_FOLDER of the working folder. Ends a sweep that runs. `state` is
 *  TRADE_RUNS on success. */
void trade_begin(struct trade *trade, const struct trade_request *request);
void trade_cancel(struct trade *trade);
/** Counts runs, and reads the advice once the sweep is done. Call once per frame. */
void trade_watch(struct trade *trade);
/** Waits until the sweep has ended. */
void trade_wait(struct trade *trade);
/** Opens the page of results with the desktop's program. The program may outlive the viewer. */
void trade_open_page(void);
/** Returns the path of the page of results. */
const char *trade_page(void);

#endif /* SLUICE_VIEW_TRADE_H */
