#include "actions.h"

#include "panel_open.h"
#include "memory_map.h"
#include "panel_traced.h"
#include "played_app.h"
#include "texture_actions.h"

#include <math.h>
#include <string.h>

static void show_view(struct view_app *app, int view)
{
    app_set_view(app, (uint32_t)view);
}

static void show_last_view(struct view_app *app, int argument)
{
    (void)argument;
    app_set_view(app, app->last_view);
}

static void toggle_panel(struct view_app *app, int panel)
{
    if (app->open[panel] && app->settings.panels == 0)
        app_set_panel(app, (enum app_panel)panel, false);
    else
        app_show_panel(app, (enum app_panel)panel);
}

static void play(struct view_app *app, int argument)
{
    (void)argument;
    app_play(app);
}

static void next_camera(struct view_app *app, int argument)
{
    (void)argument;
    app_next_camera(app);
}

static void record(struct view_app *app, int argument)
{
    (void)argument;
    app->recording = !app->recording;
    if (app->recording) {
        app->path.count = 0;
        app->follow = FOLLOW_NOTHING;
        app->follow_seconds = 0;
    }
    if (app->recording)
        app_say(app, "Recording the camera's path; R ends it");
    else
        app_say(app, "Recorded %.1f s; space plays them", (double)camera_path_length(&app->path));
}

static void trace(struct view_app *app, int argument)
{
    (void)argument;
    app->trace = true;
}

static void pause(struct view_app *app, int argument)
{
    (void)argument;
    app->settings.pause = !app->settings.pause;
    app_say(app, "%s",
            app->settings.pause
                ? "Streaming stands still; N steps one frame, Shift+N loads one tile"
                : "Streaming goes on");
}

static void step(struct view_app *app, int argument)
{
    (void)argument;
    app->settings.pause = 1;
    app->step = true;
}

static void step_tile(struct view_app *app, int argument)
{
    (void)argument;
    if (app->settings.pause && app->facts.now.requestedTileCount == 0)
        app_say(app, "No tile waits; N looks at what is seen");
    app->settings.pause = 1;
    app->step_tile = true;
}

static void restart(struct view_app *app, int argument)
{
    (void)argument;
    app->restart = true;
    app_say(app, "Everything was evicted");
}

static void evict_selected(struct view_app *app, int argument)
{
    (void)argument;
    if (app->selected >= app->facts.texture_count)
        app_say(app, "Click a surface first: its texture is evicted");
    else if (texture_actions_do(app, "evict"))
        app_say(app, "Evicted %s", stage_texture(app->stage, app->selected)->name);
}

static void trim(struct view_app *app, int argument)
{
    (void)argument;
    memory_trim(app);
}

static void compact(struct view_app *app, int argument)
{
    (void)argument;
    memory_compact(app);
}

static void freeze(struct view_app *app, int argument)
{
    (void)argument;
    app->settings.freeze_wants = !app->settings.freeze_wants;
    const bool traced = app->stage && stage_traced(app->stage);
    app_say(app, "%s",
            !app->settings.freeze_wants ? "Tiles are loaded for this camera"
            : traced                    ? "Rays request nothing: what is in memory stays"
                                        : "Tiles are loaded for the camera as it was here");
}

static void demonstrate(struct view_app *app, int argument)
{
    (void)argument;
    if (!app->demonstrating)
        app->budget_before = app->settings.budget;
    app->settings.budget = app->budget_before;
    app->demonstrating = !app->demonstrating;
    app->demonstration = 0;
    if (app->demonstrating)
        app_say(app, "16 MB for 6 seconds: the picture blurs, and sharpens again");
}

static void scale_budget(struct view_app *app, int doubled)
{
    const uint64_t least = 8u << 20;
    uint64_t budget = app->settings.budget;
    if (budget == 0)
        budget = app->facts.memory_size > least ? app->facts.memory_size : 256u << 20;
    budget = doubled ? 2 * budget : budget / 2;
    app->settings.budget = budget < least ? least : budget;
    app_say(app, "Budget: %.0f MiB", (double)app->settings.budget / 1048576.0);
}

static void shift_bias(struct view_app *app, int quarters)
{
    app->settings.lod_bias = fmax(-8.0, fmin(8.0, app->settings.lod_bias + quarters / 4.0));
    app_say(app, "Mip bias: %+.2f levels", app->settings.lod_bias);
}

static void compare(struct view_app *app, int argument)
{
    (void)argument;
    app->settings.compare = (app->settings.compare + 1) % 4;
    app->keeps_b = false;
}

/* Swaps A and B. Without a comparison B stays open, so that the next X returns at once. V closes B.
 */
static void swap(struct view_app *app, int argument)
{
    (void)argument;
    if (app->settings.view == VIEW_TRUTH) {
        app_say(app, "View 8 compares with the truth; 1, then X swaps A and B");
        return;
    }
    app->swap = true;
    app->keeps_b |= app->settings.compare == VIEW_COMPARE_OFF;
}

static void copy_command(struct view_app *app, int argument)
{
    (void)argument;
    app_copy_command(app);
}

static void frame_selection(struct view_app *app, int argument)
{
    (void)argument;
    if (!app->inspect.hit) {
        app_say(app, "Right click a surface first");
        return;
    }
    const struct vec3 back = vec3_scale(view_camera_forward(&app->camera), -1.5f);
    app->camera.position = vec3_add(app->inspect.position, back);
    app->center = app->inspect.position;
    app->follow = FOLLOW_NOTHING;
}

static void show_whole(struct view_app *app, int argument)
{
    (void)argument;
    if (app->stage)
        app->camera = stage_camera(app->stage);
    app->follow = FOLLOW_NOTHING;
}

static void keep_bookmark(struct view_app *app, int number)
{
    app->bookmarks[number - 1] = app->camera;
    app->bookmark_set[number - 1] = true;
    app_say(app, "Bookmark %d: Alt+%d comes back here", number, number);
}

static void go_to_bookmark(struct view_app *app, int number)
{
    if (!app->bookmark_set[number - 1]) {
        app_say(app, "No bookmark %d yet: Ctrl+%d keeps one", number, number);
        return;
    }
    app->camera = app->bookmarks[number - 1];
    app->follow = FOLLOW_NOTHING;
}

static void reload(struct view_app *app, int argument)
{
    (void)argument;
    app->reload = true;
}

static void sweep(struct view_app *app, int argument)
{
    (void)argument;
    app->trade_toggle = true;
    app_show_panel(app, PANEL_TRADE);
}

static void reload_shaders(struct view_app *app, int argument)
{
    (void)argument;
    app->reload_shaders = true;
}

static void full_screen(struct view_app *app, int argument)
{
    (void)argument;
    app->settings.full_screen = !app->settings.full_screen;
}

static void take_screenshot(struct view_app *app, int with_panels)
{
    app->screenshot = true;
    app->screenshot_plain = !with_panels;
}

static void take_large(struct view_app *app, int argument)
{
    (void)argument;
    if (app->stage && stage_streamer(app->stage))
        app->screenshot_large = true;
    else
        app_say(app, "Pictures at twice the resolution are of streamed scenes alone");
}

static void hide_panels(struct view_app *app, int argument)
{
    (void)argument;
    app->settings.panels = !app->settings.panels;
}

static void open_file(struct view_app *app, int argument)
{
    (void)argument;
    panel_open_toggle(app);
}

static void quit(struct view_app *app, int argument)
{
    (void)argument;
    app->quit = true;
}

static void next_motion(struct view_app *app, int argument)
{
    static const char *const words[] = {"Walk: keeps its height", "Fly: goes where it looks",
                                        "Orbit: turns round the point in the middle"};
    (void)argument;
    app->settings.motion = (app->settings.motion + 1) % 3;
    app_say(app, "%s", words[app->settings.motion]);
}

static const struct action table[] = {
    {"Camera", NULL, "drag", "look (orbit: turn)", NULL, 0},
    {"Camera", NULL, "WASD, arrows", "walk", NULL, 0},
    {"Camera", NULL, "Q E", "down, up", NULL, 0},
    {"Camera", NULL, "Shift, Ctrl", "fast, slow, while held", NULL, 0},
    {"Camera", NULL, "wheel", "speed (orbit: distance)", NULL, 0},
    {"Camera", NULL, "middle drag", "pan", NULL, 0},
    {"Camera", NULL, "double click", "orbit round this point", NULL, 0},
    {"Camera", "O", NULL, "walk, fly or orbit", next_motion, 0},
    {"Camera", "F", NULL, "go to what was inspected", frame_selection, 0},
    {"Camera", "Home", NULL, "whole scene", show_whole, 0},
    {"Camera", "space", NULL, "play the path, or stop", play, 0},
    {"Camera", "Shift+C", NULL, "next camera of the file", next_camera, 0},
    {"Camera", "R", NULL, "record a path, or end it", record, 0},
    {"Camera", "Ctrl+1", "Ctrl+1 to 9", "keep a bookmark", keep_bookmark, 1},
    {"Camera", "Alt+1", "Alt+1 to 9", "go to a bookmark", go_to_bookmark, 1},

    {"Views", "1", NULL, "picture", show_view, VIEW_PICTURE},
    {"Views", "2", NULL, "resident level", show_view, VIEW_RESIDENT},
    {"Views", "3", NULL, "missing: why is it blurry?", show_view, VIEW_MISSING},
    {"Views", "4", NULL, "wanted level", show_view, VIEW_WANTED},
    {"Views", "5", NULL, "age of tiles in memory", show_view, VIEW_AGE},
    {"Views", "6", NULL, "textures", show_view, VIEW_IDENTITY},
    {"Views", "7", NULL, "feedback written", show_view, VIEW_WRITTEN},
    {"Views", "8", NULL, "difference to the truth", show_view, VIEW_TRUTH},
    {"Views", "9", NULL, "checks: texels per pixel", show_view, VIEW_CHECKS},
    {"Views", "tab", "Tab or `", "last view, and back", show_last_view, 0},
    {"Views", "V", NULL, "compare A with B", compare, 0},
    {"Views", "X", NULL, "swap A and B", swap, 0},

    {"Streaming", "P", NULL, "pause", pause, 0},
    {"Streaming", "N", NULL, "step one frame", step, 0},
    {"Streaming", "Shift+N", NULL, "load one tile, while paused", step_tile, 0},
    {"Streaming", "Shift+R", NULL, "evict everything, watch it fill", restart, 0},
    {"Streaming", "delete", "Delete", "evict the selected texture", evict_selected, 0},
    {"Streaming", "Ctrl+M", NULL, "evict standby tiles", trim, 0},
    {"Streaming", "Shift+M", NULL, "move tiles together", compact, 0},
    {"Streaming", "L", NULL, "freeze what is wanted", freeze, 0},
    {"Streaming", "Ctrl+R", NULL, "record for sluice-replay", trace, 0},
    {"Streaming", "B", NULL, "budget demonstration", demonstrate, 0},
    {"Streaming", "[", NULL, "half the budget", scale_budget, 0},
    {"Streaming", "]", NULL, "twice the budget", scale_budget, 1},
    {"Streaming", ",", NULL, "finer by 1/4 level", shift_bias, -1},
    {"Streaming", ".", NULL, "coarser by 1/4 level", shift_bias, 1},

    {"Recordings", NULL, "N, right", "next frame", played_app_act, PLAYED_NEXT},
    {"Recordings", NULL, "Shift+N, left", "frame before", played_app_act, PLAYED_BACK},
    {"Recordings", NULL, "Home", "first frame", played_app_act, PLAYED_FIRST},
    {"Recordings", NULL, "End", "last frame", played_app_act, PLAYED_LAST},
    {"Recordings", NULL, "space, P", "play, or stop", played_app_act, PLAYED_PLAY},
    {"Recordings", NULL, "F, Shift+F", "next failed read, last", played_app_act,
     PLAYED_NEXT_FAILURE},
    {"Recordings", NULL, "E, Shift+E", "next eviction, last", played_app_act, PLAYED_NEXT_LOSS},
    {"Recordings", NULL, "L", "longest frame", played_app_act, PLAYED_SHOW_LONGEST},

    {"Panels", NULL, "right click", "inspect: why is this blurry?", NULL, 0},
    {"Panels", "U", NULL, "all controls", toggle_panel, PANEL_CONTROLS},
    {"Panels", "T", NULL, "textures", toggle_panel, PANEL_TEXTURES},
    {"Panels", "M", NULL, "memory", toggle_panel, PANEL_MEMORY},
    {"Panels", "G", NULL, "graphs over time", toggle_panel, PANEL_GRAPHS},
    {"Panels", "Y", NULL, "latency of loads", toggle_panel, PANEL_LATENCY},
    {"Panels", "I", NULL, "inspector", toggle_panel, PANEL_INSPECTOR},
    {"Panels", "K", NULL, "events", toggle_panel, PANEL_EVENTS},
    {"Panels", "J", NULL, "device", toggle_panel, PANEL_DEVICE},
    {"Panels", "Shift+I", NULL, "file and messages", toggle_panel, PANEL_FILE},
    {"Panels", "Shift+T", NULL, "what settings cost here", toggle_panel, PANEL_TRADE},
    {"Panels", "Ctrl+T", NULL, "sweep settings, or cancel", sweep, 0},
    {"Panels", NULL, "Ctrl+Tab", "arrows, Enter, Delete in a panel", NULL, 0},
    {"Panels", "H", "H or Esc", "hide panels, and back", hide_panels, 0},

    {"Program", "F1", NULL, "all keys", toggle_panel, PANEL_KEYS},
    {"Program", "F10", NULL, "menu", toggle_panel, PANEL_MENU},
    {"Program", "Ctrl+O", NULL, "open a file", open_file, 0},
    {"Program", "C", NULL, "copy command line", copy_command, 0},
    {"Program", "F5", NULL, "open the scene again", reload, 0},
    {"Program", "Ctrl+F5", NULL, "compile the shaders again", reload_shaders, 0},
    {"Program", "F11", NULL, "full screen", full_screen, 0},
    {"Program", "F12", NULL, "screenshot of the picture", take_screenshot, 0},
    {"Program", "Shift+F12", NULL, "screenshot with panels", take_screenshot, 1},
    {"Program", "Ctrl+F12", NULL, "picture at twice the resolution", take_large, 0},
    {"Program", NULL, "drop a file", "open it", NULL, 0},
    {"Program", "Ctrl+Q", NULL, "quit", quit, 0},
};

#define COUNT (sizeof table / sizeof *table)

const struct action *actions_get(uint32_t *count)
{
    *count = (uint32_t)COUNT;
    return table;
}

bool actions_lists(const struct view_app *app, const struct action *action)
{
    const bool of_recordings = strcmp(action->group, "Recordings") == 0;
    if (app->stage && stage_played(app->stage))
        return of_recordings || !played_app_refuses(action);
    return !of_recordings;
}

void actions_run(struct view_app *app, const struct action *action)
{
    const char *why = NULL;
    if (app->stage && stage_traced(app->stage) && action->chord)
        why = panel_traced_refuses(action->chord);
    if (app->stage && stage_played(app->stage))
        why = played_app_refuses(action);
    if (why)
        app_say(app, "%s", why);
    else
        action->act(app, action->argument);
}

/* Esc closes the page of keys or the menu before it hides the panels. */
static bool close_page(struct view_app *app)
{
    const bool shown =
        app->settings.panels == 0 && (app->open[PANEL_KEYS] || app->open[PANEL_MENU]);
    if (shown)
        app->open[PANEL_KEYS] = app->open[PANEL_MENU] = false;
    return shown;
}

bool actions_press(struct view_app *app, int key, unsigned modifiers)
{
    if (played_app_press(app, key, modifiers))
        return true;
    if (key >= '1' && key <= '9' && (modifiers == VIEW_CONTROL || modifiers == VIEW_ALT)) {
        (modifiers == VIEW_CONTROL ? keep_bookmark : go_to_bookmark)(app, key - '0');
        return true;
    }
    if (key == VIEW_KEY_ESCAPE && modifiers == 0 && close_page(app))
        return true;
    if (key == VIEW_KEY_ESCAPE || key == VIEW_KEY_BACKQUOTE)
        key = key == VIEW_KEY_ESCAPE ? 'H' : VIEW_KEY_TAB;
    for (size_t i = 0; i < COUNT; i++) {
        struct view_chord chord;
        if (table[i].chord && view_chord_read(table[i].chord, &chord) && chord.key == key &&
            chord.modifiers == modifiers) {
            actions_run(app, &table[i]);
            return true;
        }
    }
    return false;
}
