/** State of the viewer between frames, and what input does to it. */
#ifndef SLUICE_VIEW_APP_H
#define SLUICE_VIEW_APP_H

#include "browser.h"
#include "camera.h"
#include "facts.h"
#include "file_facts.h"
#include "flip_map.h"
#include "half_times.h"
#include "inspector_maps.h"
#include "keys.h"
#include "memory_map.h"
#include "probe.h"
#include "settings.h"
#include "stage.h"
#include "texture_table.h"
#include "ui.h"

struct thumbs;
struct trade;

#define APP_BOOKMARKS 9

enum app_panel {
    PANEL_CONTROLS,
    PANEL_GRAPHS,
    PANEL_LATENCY,
    PANEL_MEMORY,
    PANEL_TEXTURES,
    PANEL_INSPECTOR,
    PANEL_EVENTS,
    PANEL_DEVICE,
    PANEL_TRADE,
    PANEL_FILE,
    PANEL_KEYS,
    PANEL_MENU,
    PANEL_OPEN,
    PANEL_COUNT
};

enum app_follow { FOLLOW_NOTHING, FOLLOW_TOUR, FOLLOW_PATH, FOLLOW_CAMERA };

#define APP_NO_CAMERA UINT32_MAX

/** Quantiles of frame times, kept between frames. */
struct app_quantiles {
    enum history_span span;
    double next; ///< seconds of the viewer's life when they are found again
    double seconds[2];
};

struct view_app {
    struct view_settings settings; ///< of A, and what A and B share
    struct view_settings b;        ///< sets.h
    const struct gpu *gpu;         ///< borrowed
    struct stage *stage;           ///< borrowed; NULL while none is open
    struct stage *other;           ///< of B, borrowed; NULL: nothing is compared
    struct view_facts facts, facts_b;
    struct half_times times[2]; ///< of A and B, since their settings changed last
    bool keeps_b;               ///< B is drawn though nothing is compared: X swaps the pictures
    struct view_camera camera;
    struct vec3 center;        ///< of VIEW_ORBIT
    struct view_camera frozen; ///< for which tiles are loaded while wants are frozen
    bool is_frozen;
    enum app_follow follow;
    double follow_seconds;
    uint32_t file_camera;    ///< of the file, chosen last; APP_NO_CAMERA: none
    struct camera_path path; ///< owned
    bool recording;          ///< the path
    bool tracing;            ///< what the streamer decides, for sluice-replay
    struct view_camera bookmarks[APP_BOOKMARKS];
    bool bookmark_set[APP_BOOKMARKS];
    bool open[PANEL_COUNT];
    struct file_facts file;
    bool edits_b;           ///< controls change B
    struct browser browser; ///< of PANEL_OPEN
    double pinned;          ///< time of the graphs that they show values of; 0: now
    struct app_quantiles quantiles;
    struct texture_table table;
    struct memory_map memory;
    struct inspector_maps maps;
    char texture_filter[TEXTURE_TABLE_FILTER]; ///< words of the table of textures
    bool touched;                              ///< the visitor has the camera
    bool dragging;                             ///< the mouse turns the camera
    bool dragging_divider;
    float mouse_x, mouse_y; ///< of the frame before
    float press_x, press_y;
    bool buttons[3]; ///< of the frame before
    bool held[VIEW_KEY_COUNT];
    double click_age; ///< seconds since the last click on the picture
    uint32_t last_view;
    struct stage_pick pick;  ///< under the mouse
    struct view_probe probe; ///< under the mouse, for legend and inspector
    struct view_camera probed_camera;
    float picture_scale;         ///< pixels of the scene per pixel of the window
    struct stage_pick inspect;   ///< what was inspected
    uint32_t selected;           ///< texture; STAGE_NO_TEXTURE: none
    double truth_part;           ///< of the tiles of view 8's second picture that are loaded
    const struct flip_map *flip; ///< borrowed; between the pictures of a comparison
    uint64_t dragged_budget;     ///< bytes; while its slider is held: not in effect yet. 0: none
    bool demonstrating;          ///< the budget moves by itself
    double demonstration;        ///< seconds
    uint64_t budget_before;
    char said[256];
    double said_seconds;       ///< how long it is still shown
    float width, height;       ///< of the picture
    const char *present_mode;  ///< of the window; NULL: there is none
    float line_width;          ///< of the line at the bottom; 0: it is not shown
    float legend_width;        ///< in the frame before; 0: it was not shown
    double seconds;            ///< of the viewer's life
    bool deterministic;        ///< figures that differ between runs are not shown
    bool headless;             ///< time is that of the frame's number
    const char *program;       ///< words of the command line before the options
    const struct trade *trade; ///< borrowed
    struct thumbs *thumbs;     ///< borrowed
    /* Requests to the loop, which resets them. */
    bool quit, reload, step, step_tile, restart, screenshot, screenshot_plain, screenshot_large,
        trace;
    bool trade_toggle, trade_page, reload_shaders, swap;
};

void app_init(struct view_app *app);
void app_finish(struct view_app *app);
/** A scene was opened: the camera begins its tour. False without memory. */
bool app_open(struct view_app *app, struct stage *stage, bool walks);
void app_close(struct view_app *app);
/** Changes a setting of B, which begins as a copy of A unless it is compared with already. False,
 *  with a line on stderr, as sets_set. */
bool app_set_b(struct view_app *app, const char *name, const char *value);
/** Settings, panels, camera and selection as they were when the program began. */
void app_reset(struct view_app *app, const struct view_settings *settings, bool walks);
/** Input of a frame, behind ui_begin_frame. */
void app_input(struct view_app *app, const struct ui_input *input);
/** Moves what moves by itself. */
void app_move(struct view_app *app, double seconds);
/** A camera of the file by its name or number; APP_NO_CAMERA if there is none. */
uint32_t app_find_camera(const struct view_app *app, const char *text);
/** Stands at a camera of the file. */
void app_choose_camera(struct view_app *app, uint32_t index);
void app_next_camera(struct view_app *app);
/** The path that is followed: never NULL while a scene is open. */
const struct camera_path *app_path(const struct view_app *app, enum app_follow follow);
/** Plays the recorded path, that of the camera that was chosen, or the walk of the scene; or stops.
 */
void app_play(struct view_app *app);
/** Moves the camera along the path that it follows. */
void app_follow(struct view_app *app, double seconds);
/** A line that is shown for some seconds. */
void app_say(struct view_app *app, const char *format, ...) UI_PRINTF(2, 3);
void app_set_view(struct view_app *app, uint32_t view);
/** Opens or closes a panel. One that opens takes the place of the others on its side. */
void app_set_panel(struct view_app *app, enum app_panel panel, bool open);
void app_inspect(struct view_app *app, const struct stage_pick *pick);
/** Moves the camera before a surface that has a tile of a texture. */
void app_look_at_tile(struct view_app *app, uint32_t texture, const SluiceTile *tile);
/** The command that shows this: scene, settings, and the camera unless it moves by itself. */
void app_write_command(const struct view_app *app, char *text, size_t size);
void app_copy_command(struct view_app *app);
/** Ends the demonstration of the budget, if it runs, with the budget before. */
void app_end_demonstration(struct view_app *app);
/** Whether a second picture is drawn. */
bool app_has_second(const struct view_app *app);
/** Whether A and B are compared: there is a second picture, and not that of view 8. */
bool app_compares(const struct view_app *app);
/** Whether the picture at x, in pixels, is that of B. */
bool app_shows_b(const struct view_app *app, float x);
/** Whether the picture is a difference of two. */
bool app_shows_difference(const struct view_app *app);
/** Whether a divider can be dragged. */
bool app_has_divider(const struct view_app *app);

#endif /* SLUICE_VIEW_APP_H */
