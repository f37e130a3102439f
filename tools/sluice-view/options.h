/** Options of the command line. */
#ifndef SLUICE_VIEW_OPTIONS_H
#define SLUICE_VIEW_OPTIONS_H

#include "settings.h"

#include "../common/option_table.h"

struct view_options {
    struct view_settings settings;
    struct option_texts b;    ///< settings of B, as sets_read takes them
    struct option_list words; ///< scenes
    bool room, headless, deterministic, fresh, json, validation, list_devices, still;
    uint32_t frames; ///< 0: until the script ends, or the window is closed
    const char *script, *screenshot, *csv, *play, *cache, *device, *record;
    uint32_t cursor;    ///< frame of a recording
    const char *camera; ///< as view_camera_read takes it; NULL: the scene's
};

/** Settings that stand before the options: defaults, or those of a file, which options change. */
enum option_outcome options_read(int argc, char **argv, struct view_options *options);

#endif /* SLUICE_VIEW_OPTIONS_H */
