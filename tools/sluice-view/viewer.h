/** The viewer as a whole: device, scene, frames and, if there is one, the window. */
#ifndef SLUICE_VIEW_VIEWER_H
#define SLUICE_VIEW_VIEWER_H

#include "app.h"
#include "flip_map.h"
#include "frames.h"
#include "large_picture.h"
#include "options.h"
#include "scene_load.h"
#include "script.h"
#include "shader_files.h"
#include "summary.h"
#include "thumbs.h"
#include "trade.h"
#include "window.h"

#include "../common/files.h"

#include <sluice/camera_motion.h>
#include <sluice/replay.h>

struct viewer {
    const struct view_options *options;
    struct gpu gpu;
    struct view_app app;
    struct frames frames;
    struct stage *stage;
    struct stage *other;                   ///< of B; NULL: nothing is compared
    struct traced_parts_load *other_parts; ///< for `other` of a traced scene; NULL: none are made
    struct shader_code code[SCENE_SHADER_COUNT]; ///< compiled last; empty: those of the build
    struct window *window;                       ///< NULL: headless
    struct swapchain swapchain;
    uint32_t
        sized[2]; ///< settings.size that the window or the headless picture has, or was asked for
    struct flip_map flip;
    SluiceCameraMotion motion; ///< of the last frames
    struct script script;
    struct ui_input input;
    struct view_settings applied;   ///< what the streamer has
    struct view_settings applied_b; ///< what that of B has
    struct view_settings reopened;  ///< with which the scene was to be opened again
    bool asked;                     ///< `reopened` is known: if that failed, it is not tried again
    struct file_list paths;         ///< owned; of the scene; none: the room
    struct scene_load *load;        ///< of the next scene; NULL: none
    struct scene_load *canceled;    ///< canceled loads whose threads have not ended
    char command[4200];             ///< of "copy command line", without options
    char settings_path[4096];       ///< "": none are kept
    char recent_path[4096];         ///< of the list of recent files; "": it is not kept
    char screenshot[4096];          ///< to write after this frame; "": none
    struct large_picture large;     ///< that this frame draws
    struct summary summary;
    struct trade trade;
    struct thumbs thumbs;     ///< of `stage`, once the table of textures was open
    SluiceRecorder *recorder; ///< of the manager of `stage`; NULL: none
    char recording[4096];     ///< its file
    bool recording_failed;
    struct output_file *csv;
    uint32_t frame;
    double last_time, host_seconds;
    uint64_t clock; ///< microseconds; stands while streaming is paused
    unsigned screenshot_number;
    double begin, first_picture, first_processor; ///< seconds
    uint32_t first_frame;                         ///< with a picture of the scene
};

/** Opens the scene of the paths; with a window, on a thread. False, with lines on stderr, if that
 *  failed. */
bool viewer_open_scene(struct viewer *viewer);
/** Waits for the frames. */
void viewer_close_scene(struct viewer *viewer);
/** Opens other paths, and may take them; NULL: the same scene with other settings. With a window,
 *  other paths are opened on a thread. The old scene stays until the new one can be shown. */
void viewer_reopen(struct viewer *viewer, struct file_list *paths);
/** Asks for the scene to be opened again if settings changed that are fixed while it is open. */
void viewer_reopen_if_needed(struct viewer *viewer);
/** Shows a scene that a thread has opened, and says before how far it is. False if there is nothing
 *  to show. */
bool viewer_watch_load(struct viewer *viewer);
/** Opens what the browser or the menu chose. */
void viewer_open_chosen(struct viewer *viewer);
/** Does not wait. The scene that is shown stays; without one, the room is opened. */
void viewer_cancel_load(struct viewer *viewer);
/** Cancels what is being opened, and waits for all threads that open scenes. */
void viewer_end_load(struct viewer *viewer);
bool viewer_open_now(const struct viewer *viewer, const struct file_list *paths,
                     struct scene_data *scene);
struct stage *viewer_create_stage(struct viewer *viewer, const struct view_settings *settings,
                                  struct scene_data *scene);
/** Creates or destroys the second streamer, as the settings of the comparison want it. False if the
 *  device failed. */
bool viewer_fit_other(struct viewer *viewer);
/** No frame may be in flight. */
void viewer_close_other(struct viewer *viewer);
/** All that the second picture is drawn with. */
struct view_settings viewer_second_settings(const struct viewer *viewer);
/** Gives the streamers settings that have changed. */
void viewer_apply(struct viewer *viewer);
/** Exchanges A and B, if that was asked for and both are open. */
void viewer_swap(struct viewer *viewer);
/** Records what the streamer decides into a file for sluice-replay, between two frames. Ends the
 *  recording before. `path` NULL: a new name in the working folder. */
void viewer_begin_recording(struct viewer *viewer, const char *path);
/** Does nothing if nothing is recorded. */
void viewer_end_recording(struct viewer *viewer);
/** Compiles the shaders of the scene again, and says what came of it. */
void viewer_reload_shaders(struct viewer *viewer);
/** Gives the window the size of the settings, and the settings the size that somebody gave the
 *  window. False if the device failed. */
bool viewer_follow_size(struct viewer *viewer);
/** Presents as the settings say from the next swapchain on. */
void viewer_follow_vsync(struct viewer *viewer);
/** Says what the window got instead. */
void viewer_say_vsync(struct viewer *viewer);
/** Begins and ends sweeps of settings, as the panel asks for them, and watches them. */
void viewer_follow_trade(struct viewer *viewer);
/** Returns the exit status: 0, 1, or 77 without a device. */
int viewer_run(const struct view_options *options);

#endif /* SLUICE_VIEW_VIEWER_H */
