/**
 * A sweep of settings over the scene that is shown and a camera path: sluice-tradeoff runs as a
 * child process, which runs this program without a window.
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
    const struct view_settings *settings; ///< of the base; what is not the default
    const struct camera_path *path;       ///< NULL or empty: the camera stands at `camera`
    const struct view_camera *camera;
    const struct file_list *paths; ///< of the scene; none: the room
    const char *cache, *device;    ///< NULL: the default
    uint32_t threads;              ///< 0: the default
};

struct trade {
    enum trade_state state;
    struct child child;
    struct text_list arguments;
    char *out, *error;    ///< owned
    unsigned done, total; ///< runs
    double looked;        ///< when they were counted, clock_seconds()
    char advice[TRADE_ADVICE][160];
    char reason[400]; ///< why it failed
};

/** Kills what runs. A zeroed struct is fine. */
void trade_finish(struct trade *trade);
/** Begins a sweep into TRADE_FOLDER of the working folder, and ends one before. `state` says
 *  whether it runs. */
void trade_begin(struct trade *trade, const struct trade_request *request);
void trade_cancel(struct trade *trade);
/** Once per frame: counts runs, and takes the advice when the sweep is done. */
void trade_watch(struct trade *trade);
/** Until it has ended. */
void trade_wait(struct trade *trade);
/** Shows the page in the program that the desktop has for it, which stays when this one ends. */
void trade_open_page(void);
/** Of the results. */
const char *trade_page(void);

#endif /* SLUICE_VIEW_TRADE_H */
