/** Options of the command line. */
#ifndef SLUICE_VIEW_OPTIONS_H
#define SLUICE_VIEW_OPTIONS_H

#include "controls.h"
#include "settings.h"

#include "../common/option_table.h"

struct view_options {
    struct view_settings settings;
    bool given[CONTROLS_MAX]; ///< controls that the command line has
    struct option_texts b;    ///< settings of B, in the syntax of sets_read
    struct option_list words; ///< scenes
    bool room, headless, deterministic, fresh, json, validation, list_devices, still;
    uint32_t frames; ///< 0: until the script ends, or the window is closed
    const char *script, *screenshot, *csv, *play, *cache, *device, *record;
    uint32_t cursor;    ///< frame of a recording
    const char *camera; ///< in the syntax of view_camera_read; NULL: camera of the scene
};

/** Reads the command line. `options->settings` holds defaults, or settings of a file, which options
 *  change. */
enum option_outcome options_read(int argc, char **argv, struct view_options *options);

#endif /* SLUICE_VIEW_OPTIONS_H */
