/** The viewer as a whole: device, scene, frames and an optional window. */
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
    struct stage *other;                   ///< stage of B; NULL: nothing is compared
    struct traced_parts_load *other_parts; ///< parts for a traced `other`, being made; NULL: none
    struct shader_code
        code[SCENE_SHADER_COUNT]; ///< shaders compiled last; empty: shaders of the build
    struct window *window;        ///< NULL: headless
    struct swapchain swapchain;
    uint32_t sized[2]; ///< settings.size that was applied last, or that the user gave the window
    struct flip_map flip;
    SluiceCameraMotion motion; ///< motion over the last frames, for predictions
    struct script script;
    struct ui_input input;
    struct view_settings applied;   ///< settings that the streamer of `stage` has
    struct view_settings applied_b; ///< settings that the streamer of `other` has
    struct view_settings reopened;  ///< settings that the scene was last opened again for
    bool asked;                    ///< `reopened` is valid. An attempt that failed is not repeated.
    struct file_list paths;        ///< owned; paths of the scene; none: the room
    struct scene_load *load;       ///< load of the next scene; NULL: none
    bool loads_again;              ///< `load` reads the scene that is shown
    bool loads_chosen;             ///< `load` reads a scene that was chosen in the window
    struct scene_load *other_load; ///< load of the scene of B; NULL: none
    struct scene_load *canceled;   ///< canceled loads whose threads have not ended
    char command[4200];            ///< program and paths for "copy command line", without options
    char settings_path[4096];      ///< file of the settings; "": settings are not kept
    char recent_path[4096];        ///< file of the list of recent files; "": the list is not kept
    char screenshot[4096];         ///< file to write after this frame; "": none
    struct large_picture large;    ///< large screenshot that this frame draws
    struct summary summary;
    struct trade trade;
    struct thumbs
        thumbs; ///< small pictures of `stage`, from the first use of the table of textures on
    SluiceRecorder *recorder; ///< recorder of the manager of `stage`; NULL: none
    char recording[4096];     ///< file of `recorder`
    bool recording_failed;
    struct output_file *csv;
    uint32_t frame;
    double last_time, host_seconds;
    uint64_t clock; ///< microseconds; stands while streaming is paused
    unsigned screenshot_number;
    double begin, first_picture, first_processor; ///< seconds
    uint32_t first_frame;                         ///< first frame with a picture of the scene
};

/** Opens the scene of the paths. Opens on a thread if there is a window. False, with lines on
 * stderr, on failure. */
bool viewer_open_scene(struct viewer *viewer);
/** Waits for the frames in flight, and destroys both stages. */
void viewer_close_scene(struct viewer *viewer);
/** Opens other paths, and may move them out of `paths`. NULL: opens the present scene again with
 * its new settings. With a window, files are read on a thread. The old scene stays until
 * the new one can be shown. */
void viewer_reopen(struct viewer *viewer, struct file_list *paths);
/** Requests that the scene is opened again, if a setting changed that is fixed while it is open. */
void viewer_reopen_if_needed(struct viewer *viewer);
/** Reports the progress of a load, and shows the scene once the thread has opened it. False if
 *  there is nothing to show. */
bool viewer_watch_load(struct viewer *viewer);
/** Opens the path that was chosen in the browser or the menu. */
void viewer_open_chosen(struct viewer *viewer);
/** Cancels the load without a wait. The scene that is shown stays. Without a scene, opens the room.
 */
void viewer_cancel_load(struct viewer *viewer);
/** Cancels the load, and waits for all threads that open scenes. */
void viewer_end_load(struct viewer *viewer);
/** Begins to read a scene on a thread, and moves its paths out of the list. NULL, with a line on
 *  stderr, without memory or a thread. */
struct scene_load *viewer_begin_load(const struct viewer *viewer, struct file_list *paths,
                                     uint32_t threads);
/** Begins to read the scene that is shown. NULL as viewer_begin_load. */
struct scene_load *viewer_begin_load_again(const struct viewer *viewer, uint32_t threads);
/** Reads a scene at once. */
bool viewer_open_now(const struct viewer *viewer, const struct file_list *paths,
                     struct scene_data *scene);
struct stage *viewer_create_stage(struct viewer *viewer, const struct view_settings *settings,
                                  struct scene_data *scene);
/** Creates or destroys the second stage, as the settings of the comparison require. False if the
 *  device failed. */
bool viewer_fit_other(struct viewer *viewer);
/** Cancels the load of the scene of B without a wait. */
void viewer_park_other(struct viewer *viewer);
/** Destroys the second stage. No frame may be in flight. */
void viewer_close_other(struct viewer *viewer);
/** Returns all settings of the second picture. */
struct view_settings viewer_second_settings(const struct viewer *viewer);
/** Applies settings that have changed to the streamers. */
void viewer_apply(struct viewer *viewer);
/** Exchanges A and B, if app.swap requests it and both are open. */
void viewer_swap(struct viewer *viewer);
/** Begins a recording of the streamer's decisions, for sluice-replay. Call between two frames. Ends
 *  a recording that runs. `path` NULL: a new name in the working folder. */
void viewer_begin_recording(struct viewer *viewer, const char *path);
/** Ends the recording, if one runs. */
void viewer_end_recording(struct viewer *viewer);
/** Compiles the shaders of the scene again, and shows the outcome. */
void viewer_reload_shaders(struct viewer *viewer);
/** Gives the window the size of the settings. Writes a size that the user gave the window into the
 *  settings. False if the device failed. */
bool viewer_follow_size(struct viewer *viewer);
/** Chooses the present mode of the settings for the next swapchain. */
void viewer_follow_vsync(struct viewer *viewer);
/** Shows a message if the window has another present mode than the settings request. */
void viewer_say_vsync(struct viewer *viewer);
/** Begins, watches and cancels sweeps of settings, as the panel requests. */
void viewer_follow_trade(struct viewer *viewer);
/** Runs the viewer. Returns the exit status: 0, 1, or 77 without a device. */
int viewer_run(const struct view_options *options);

#endif /* SLUICE_VIEW_VIEWER_H */
