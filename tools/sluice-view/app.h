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
    struct view_settings settings; ///< settings of A, and settings that A and B share
    struct view_settings b;        ///< settings of B; see sets.h
    const struct gpu *gpu;         ///< borrowed
    struct stage *stage;           ///< borrowed; NULL while none is open
    struct stage *other;           ///< stage of B, borrowed; NULL: nothing is compared
    struct view_facts facts, facts_b;
    struct half_times times[2]; ///< times of A and B since their settings last changed
    bool keeps_b; ///< B stays open though nothing is compared, so that X can swap A and B
    struct view_camera camera;
    struct vec3 center;        ///< point that VIEW_ORBIT turns around
    struct view_camera frozen; ///< camera that tiles are loaded for while `is_frozen`
    bool is_frozen;
    enum app_follow follow;
    double follow_seconds;
    uint32_t file_camera;    ///< camera of the file that was chosen last; APP_NO_CAMERA: none
    struct camera_path path; ///< owned
    bool recording;          ///< a camera path is being recorded
    bool tracing;            ///< decisions of the streamer are being recorded, for sluice-replay
    struct view_camera bookmarks[APP_BOOKMARKS];
    bool bookmark_set[APP_BOOKMARKS];
    bool open[PANEL_COUNT];
    struct file_facts file;
    bool edits_b;           ///< controls change B
    struct browser browser; ///< file browser of PANEL_OPEN
    double pinned;          ///< time whose values the titles of the graphs show; 0: now
    struct app_quantiles quantiles;
    struct texture_table table;
    struct memory_map memory;
    struct inspector_maps maps;
    char texture_filter[TEXTURE_TABLE_FILTER]; ///< filter words of the table of textures
    bool touched;                              ///< the user has moved the camera
    bool dragging;                             ///< the mouse turns the camera
    bool dragging_divider;
    float mouse_x, mouse_y; ///< mouse position in the previous frame
    float press_x, press_y;
    bool buttons[3]; ///< mouse buttons held in the previous frame
    bool held[VIEW_KEY_COUNT];
    double click_age; ///< seconds since the last click on the picture
    uint32_t last_view;
    struct stage_pick pick;  ///< surface under the mouse
    struct view_probe probe; ///< values under the mouse, for legend and inspector
    struct view_camera probed_camera;
    float picture_scale;       ///< pixels of the scene per pixel of the window
    struct stage_pick inspect; ///< surface that was inspected last
    uint32_t selected;         ///< index of the selected texture; STAGE_NO_TEXTURE: none
    double truth_part; ///< 0 to 1; resident part of the tiles of the second picture of view 8
    const struct flip_map *flip; ///< borrowed; FLIP between the pictures of a comparison
    uint64_t dragged_budget; ///< bytes; budget not in effect yet, while its slider is held. 0: none
    bool demonstrating;      ///< the budget moves by itself
    double demonstration;    ///< seconds
    uint64_t budget_before;
    char said[256];
    double said_seconds;       ///< seconds for which `said` is still shown
    float width, height;       ///< pixels of the picture
    const char *present_mode;  ///< present mode of the window; NULL: no window
    float line_width;          ///< pixels; width of the line at the bottom. 0: not shown
    float legend_width;        ///< pixels; width of the legend in the previous frame. 0: not shown
    double seconds;            ///< time since the viewer began
    bool deterministic;        ///< figures that differ between runs are not shown
    bool headless;             ///< no window; time follows from the frame number
    const char *program;       ///< words of the command line before the options
    const struct trade *trade; ///< borrowed
    struct thumbs *thumbs;     ///< borrowed
    /* Requests to the main loop. The loop resets them. */
    bool quit, reload, step, step_tile, restart, screenshot, screenshot_plain, screenshot_large,
        trace;
    bool trade_toggle, trade_page, reload_shaders, swap;
};

void app_init(struct view_app *app);
void app_finish(struct view_app *app);
/** Takes over a scene that was opened: the camera begins its tour. False without memory. */
bool app_open(struct view_app *app, struct stage *stage, bool walks);
void app_close(struct view_app *app);
/** Changes a setting of B. B begins as a copy of A unless B has settings of its own already.
 *  False, with a line on stderr, where sets_set fails. */
bool app_set_b(struct view_app *app, const char *name, const char *value);
/** Resets settings, panels, camera and selection to their state at program start. */
void app_reset(struct view_app *app, const struct view_settings *settings, bool walks);
/** Handles the input of a frame. Call after ui_begin_frame. */
void app_input(struct view_app *app, const struct ui_input *input);
/** Advances the camera, the demonstration of the budget and other motion by `seconds`. */
void app_move(struct view_app *app, double seconds);
/** Finds a camera of the file by its name or number. Returns APP_NO_CAMERA if there is none. */
uint32_t app_find_camera(const struct view_app *app, const char *text);
/** Moves the view to a camera of the file. */
void app_choose_camera(struct view_app *app, uint32_t index);
void app_next_camera(struct view_app *app);
/** Returns the path that `follow` stands for. Never NULL while a scene is open. */
const struct camera_path *app_path(const struct view_app *app, enum app_follow follow);
/** Stops a path that plays. Otherwise plays the first that exists: the recorded path, the path of
 *  the chosen camera, or the walk of the scene. */
void app_play(struct view_app *app);
/** Moves the camera along the path that it follows. */
void app_follow(struct view_app *app, double seconds);
/** Shows a line for some seconds. */
void app_say(struct view_app *app, const char *format, ...) UI_PRINTF(2, 3);
void app_set_view(struct view_app *app, uint32_t view);
/** Opens or closes a panel. One that opens takes the place of the others on its side. */
void app_set_panel(struct view_app *app, enum app_panel panel, bool open);
/** Opens a panel that the user asked for, and shows hidden panels. */
void app_show_panel(struct view_app *app, enum app_panel panel);
void app_inspect(struct view_app *app, const struct stage_pick *pick);
/** Moves the camera before a surface that has a tile of a texture. */
void app_look_at_tile(struct view_app *app, uint32_t texture, const SluiceTile *tile);
/** Writes the command line that opens the same scene with the same settings. The camera is part of
 *  the command unless it moves by itself. Settings that were kept do not act on the command. */
void app_write_command(const struct view_app *app, char *text, size_t size);
void app_copy_command(struct view_app *app);
/** Ends the demonstration of the budget, if it runs, and restores the budget from before. */
void app_end_demonstration(struct view_app *app);
/** Returns true if a second picture is drawn. */
bool app_has_second(const struct view_app *app);
/** Returns true if A and B are compared: a second picture is drawn, and view 8 is not shown. */
bool app_compares(const struct view_app *app);
/** Returns true if the picture at x, in pixels, belongs to B. */
bool app_shows_b(const struct view_app *app, float x);
/** Returns true if the picture is a difference of two pictures. */
bool app_shows_difference(const struct view_app *app);
/** Returns true if a divider can be dragged. */
bool app_has_divider(const struct view_app *app);

#endif /* SLUICE_VIEW_APP_H */
