#include "app.h"

#include "actions.h"
#include "controls.h"
#include "panel_open.h"
#include "panels.h"
#include "played_app.h"
#include "sets.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define LOOK_PER_PIXEL 0.0035f
#define CLICK_PIXELS 4.0f
#define DOUBLE_CLICK_SECONDS 0.35
#define DEMONSTRATION_SECONDS 6.0
#define DIVIDER_PIXELS 8.0f
#define COMMAND_SIZE 16384

void app_init(struct view_app *app)
{
    *app = (struct view_app){.last_view = VIEW_PICTURE, .selected = STAGE_NO_TEXTURE};
    controls_set_defaults(&app->settings);
    controls_set_defaults(&app->b);
    app->mouse_x = app->mouse_y = -1;
    app->click_age = 10;
}

void app_finish(struct view_app *app)
{
    app_close(app);
    camera_path_finish(&app->path);
    file_facts_finish(&app->file);
    browser_finish(&app->browser);
}

static void begin_scene(struct view_app *app, bool walks)
{
    struct vec3 bounds[2];
    app->camera = stage_camera(app->stage);
    app->is_frozen = false; /* requests of the previous scene were frozen at another camera */
    stage_bounds(app->stage, bounds);
    app->center = vec3_mix(bounds[0], bounds[1], 0.5f);
    app->selected = STAGE_NO_TEXTURE;
    app->file_camera = APP_NO_CAMERA;
    app->inspect = app->pick = (struct stage_pick){.texture = STAGE_NO_TEXTURE};
    app->follow = walks ? FOLLOW_TOUR : FOLLOW_NOTHING;
    app->touched = !walks;
    app->follow_seconds = 0;
}

bool app_open(struct view_app *app, struct stage *stage, bool walks)
{
    if (!facts_create(&app->facts, stage))
        return false;
    app->stage = stage;
    app->pinned = 0;
    begin_scene(app, walks);
    return true;
}

bool app_set_b(struct view_app *app, const char *name, const char *value)
{
    struct view_settings b = app->settings.compared == VIEW_WITH_B ? app->b : app->settings;
    if (!sets_set(&b, name, value, "sluice-view: B"))
        return false;
    app->b = b;
    app->settings.compared = VIEW_WITH_B;
    return true;
}

void app_reset(struct view_app *app, const struct view_settings *settings, bool walks)
{
    app->settings = *settings;
    memset(app->open, 0, sizeof app->open);
    app->last_view = VIEW_PICTURE;
    app->demonstrating = app->recording = app->keeps_b = app->swap = app->edits_b = false;
    app->dragged_budget = 0;
    app->said_seconds = 0;
    file_facts_finish(&app->file);
    file_facts_begin(&app->file);
    if (app->stage)
        begin_scene(app, walks);
}

void app_close(struct view_app *app)
{
    if (app->stage)
        facts_destroy(&app->facts);
    texture_table_finish(&app->table);
    memory_map_finish(&app->memory);
    inspector_maps_finish(&app->maps);
    app->stage = NULL;
}

void app_say(struct view_app *app, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(app->said, sizeof app->said, format, arguments);
    va_end(arguments);
    app->said_seconds = 4;
}

void app_set_view(struct view_app *app, uint32_t view)
{
    if (view == app->settings.view)
        return;
    app->last_view = app->settings.view;
    app->settings.view = view;
}

void app_set_panel(struct view_app *app, enum app_panel panel, bool open)
{
    for (int other = 0; open && other < PANEL_COUNT; other++)
        if (panel_is_right((enum app_panel)other) == panel_is_right(panel))
            app->open[other] = false;
    app->open[panel] = open;
}

void app_show_panel(struct view_app *app, enum app_panel panel)
{
    app_set_panel(app, panel, true);
    app->settings.panels = 0;
}

void app_inspect(struct view_app *app, const struct stage_pick *pick)
{
    if (!pick->hit)
        return;
    app->inspect = *pick;
    app->selected = pick->texture;
    app_show_panel(app, PANEL_INSPECTOR);
}

void app_write_command(const struct view_app *app, char *text, size_t size)
{
    char options[4096], camera[160], cursor[32] = "", b[2048] = "";
    const bool played = app->facts.borrows; /* a recording */
    const bool stands = app->stage && !played && app->follow == FOLLOW_NOTHING;
    if (played && app->facts.played_frame > 0)
        snprintf(cursor, sizeof cursor, " --cursor %u", app->facts.played_frame);
    controls_write_command(&app->settings, options, sizeof options);
    if (app->settings.compared == VIEW_WITH_B)
        sets_write(&app->settings, &app->b, b, sizeof b);
    snprintf(text, size, "%s%s%s%s%s%s%s --fresh", app->program, options, b[0] ? " --b " : "", b,
             stands ? " --camera " : "",
             stands ? view_camera_write(&app->camera, camera, sizeof camera) : "", cursor);
}

void app_copy_command(struct view_app *app)
{
    char line[COMMAND_SIZE];
    app_write_command(app, line, sizeof line);
    ui_copy_text(line);
    app_say(app, "Copied: %s", line);
}

bool app_has_second(const struct view_app *app)
{
    return app->settings.view == VIEW_TRUTH || app->settings.compare != VIEW_COMPARE_OFF ||
           app->keeps_b;
}

bool app_compares(const struct view_app *app)
{
    return app->other && app->settings.view != VIEW_TRUTH;
}

/* Flicker changes the picture 4 times per second, and begins with A. */
bool app_shows_b(const struct view_app *app, float x)
{
    const struct view_settings *s = &app->settings;
    if (s->view == VIEW_TRUTH)
        return false;
    if (s->compare == VIEW_FLICKER)
        return (uint64_t)(app->seconds * 4) % 2 == 1;
    return s->compare == VIEW_DIVIDER && x > (float)s->divider * app->width;
}

bool app_shows_difference(const struct view_app *app)
{
    return app->settings.view == VIEW_TRUTH || app->settings.compare == VIEW_DIFFERENCE;
}

bool app_has_divider(const struct view_app *app)
{
    return app_shows_difference(app) ? app->settings.difference == VIEW_BOTH_DIFFERENCES
                                     : app->settings.compare == VIEW_DIVIDER;
}

/* The first input that moves the camera ends its tour. */
static void touch(struct view_app *app)
{
    if (!app->touched)
        app->follow = FOLLOW_NOTHING;
    app->touched = true;
}

/* Modifiers at the present key event. A chord may begin and end between two frames. */
static unsigned modifiers_held(const struct view_app *app)
{
    return (app->held[VIEW_KEY_SHIFT] ? VIEW_SHIFT : 0) |
           (app->held[VIEW_KEY_CONTROL] ? VIEW_CONTROL : 0) |
           (app->held[VIEW_KEY_ALT] ? VIEW_ALT : 0);
}

static void read_keys(struct view_app *app, const struct ui_input *input)
{
    for (uint32_t i = 0; i < input->key_count; i++) {
        const struct ui_key_event *event = &input->keys[i];
        if (event->key == VIEW_KEY_NONE) {
            if (app->open[PANEL_OPEN])
                panel_open_type(app, event->text);
            continue;
        }
        if (app->open[PANEL_OPEN] && event->down &&
            (event->key < VIEW_KEY_SHIFT || event->key > VIEW_KEY_ALT) &&
            panel_open_key(app, event->key, modifiers_held(app)))
            continue;
        if (event->key < 0 || event->key >= VIEW_KEY_COUNT ||
            (event->down && ui_owns_key(event->key)))
            continue;
        app->held[event->key] = event->down;
        if (!event->down || (event->key >= VIEW_KEY_SHIFT && event->key <= VIEW_KEY_ALT))
            continue;
        touch(app);
        if (actions_press(app, event->key, modifiers_held(app)))
            app->held[event->key] = false;
    }
}

static bool over_divider(const struct view_app *app, float x)
{
    return app_has_divider(app) &&
           fabsf(x - (float)app->settings.divider * app->width) < DIVIDER_PIXELS;
}

static void pick(struct view_app *app, const struct ui_input *input)
{
    app->pick = (struct stage_pick){.texture = STAGE_NO_TEXTURE};
    if (app->stage && app->width > 0 && app->height > 0)
        app->pick = stage_pick(app->stage, &app->camera, app->width / app->height,
                               input->mouse_x / app->width, input->mouse_y / app->height);
}

static void click_picture(struct view_app *app)
{
    if (app->click_age < DOUBLE_CLICK_SECONDS && app->pick.hit) {
        app->settings.motion = VIEW_ORBIT;
        app->center = app->pick.position;
        app->camera = view_camera_at(app->camera.position, app->center, app->camera.fov);
        app_say(app, "Orbit round this point; O walks again");
        app->click_age = DOUBLE_CLICK_SECONDS;
        return;
    }
    if (app->pick.hit)
        app->selected = app->pick.texture;
    app->click_age = 0;
}

static void read_buttons(struct view_app *app, const struct ui_input *input)
{
    const bool pressed = input->buttons[0] && !app->buttons[0];
    const bool released = !input->buttons[0] && app->buttons[0];
    if (pressed && !ui_owns_mouse()) {
        app->dragging_divider = over_divider(app, input->mouse_x);
        app->dragging = !app->dragging_divider;
        app->press_x = input->mouse_x;
        app->press_y = input->mouse_y;
        pick(app, input);
    }
    if (released) {
        const bool still = fabsf(input->mouse_x - app->press_x) < CLICK_PIXELS &&
                           fabsf(input->mouse_y - app->press_y) < CLICK_PIXELS;
        if (app->dragging && still)
            click_picture(app);
        app->dragging = app->dragging_divider = false;
    }
    if (input->buttons[1] && !app->buttons[1] && !ui_owns_mouse()) {
        touch(app);
        pick(app, input);
        app_inspect(app, &app->pick);
    }
}

static void read_motion(struct view_app *app, const struct ui_input *input,
                        struct camera_wish *wish)
{
    const float dx = input->mouse_x - app->mouse_x, dy = input->mouse_y - app->mouse_y;
    if (app->dragging && (dx != 0 || dy != 0)) {
        if (fabsf(input->mouse_x - app->press_x) + fabsf(input->mouse_y - app->press_y) >=
            CLICK_PIXELS)
            touch(app);
        wish->look_right = dx * LOOK_PER_PIXEL;
        wish->look_up = -dy * LOOK_PER_PIXEL;
    }
    if (app->dragging_divider && app->width > 0)
        app->settings.divider = fmax(0.0, fmin(1.0, (double)(input->mouse_x / app->width)));
    if (input->buttons[2] && app->buttons[2] && !ui_owns_mouse() && app->height > 0) {
        touch(app);
        wish->pan_right = dx / app->height;
        wish->pan_up = dy / app->height;
    }
    if (input->wheel != 0 && !ui_owns_mouse()) {
        touch(app);
        wish->dolly = input->wheel;
        if (app->camera.span > 0) { /* orthographic: distance does not matter */
            app_say(app, "Height of the view: %.3g m", 2 * (double)app->camera.span);
        } else if (app->settings.motion != VIEW_ORBIT) {
            app->settings.speed =
                fmax(0.01, fmin(1000.0, app->settings.speed * pow(1.15, (double)input->wheel)));
            app_say(app, "Speed: %.2f m/s", app->settings.speed);
        }
    }
}

static float axis(const struct view_app *app, int plus, int plus_too, int minus, int minus_too)
{
    return (float)((app->held[plus] || app->held[plus_too]) -
                   (app->held[minus] || app->held[minus_too]));
}

void app_input(struct view_app *app, const struct ui_input *input)
{
    app->width = input->width;
    app->height = input->height;
    read_keys(app, input);
    read_buttons(app, input);
    struct camera_wish wish = {.seconds = input->seconds,
                               .factor = input->shift     ? 4.0f
                                         : input->control ? 0.25f
                                                          : 1.0f};
    read_motion(app, input, &wish);
    wish.forward = axis(app, 'W', VIEW_KEY_UP, 'S', VIEW_KEY_DOWN);
    wish.right = axis(app, 'D', VIEW_KEY_RIGHT, 'A', VIEW_KEY_LEFT);
    wish.up = axis(app, 'E', 'E', 'Q', 'Q');
    if (app->follow == FOLLOW_NOTHING)
        view_camera_move(&app->camera, &wish, app->settings.motion, app->settings.speed,
                         &app->center);
    app->mouse_x = input->mouse_x;
    app->mouse_y = input->mouse_y;
    memcpy(app->buttons, input->buttons, sizeof app->buttons);
}

void app_end_demonstration(struct view_app *app)
{
    if (app->demonstrating)
        app->settings.budget = app->budget_before;
    app->demonstrating = false;
}

/* Lowers the budget to 16 MiB in the first second, and raises it in the last one. */
static void demonstrate(struct view_app *app, double seconds)
{
    const double least = 16.0 * 1048576.0;
    double most = app->budget_before ? (double)app->budget_before : 512.0 * 1048576.0;
    app->demonstration += seconds;
    const double at = app->demonstration;
    const double part =
        fmin(1.0, fmin(at, DEMONSTRATION_SECONDS - at)); /* 0: budget from before, 1: 16 MiB */
    app->settings.budget = (uint64_t)(exp2(log2(most) + (log2(least) - log2(most)) * part));
    if (at < DEMONSTRATION_SECONDS)
        return;
    app_end_demonstration(app);
}

/* Keeps the camera of a freeze. A key, a control, a script or a file may set the setting. */
static void note_freeze(struct view_app *app)
{
    const bool frozen = app->settings.freeze_wants != 0;
    if (frozen && !app->is_frozen)
        app->frozen = app->camera;
    app->is_frozen = frozen;
}

void app_move(struct view_app *app, double seconds)
{
    note_freeze(app);
    app->seconds += seconds;
    app->click_age += seconds;
    app->said_seconds -= seconds;
    if (app->stage && app->follow != FOLLOW_NOTHING)
        app_follow(app, seconds);
    if (app->demonstrating)
        demonstrate(app, seconds);
    played_app_move(app);
    if (app->recording) {
        camera_path_add(&app->path, (float)app->follow_seconds, &app->camera);
        app->follow_seconds += seconds;
    }
}
