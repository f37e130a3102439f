#include "played_app.h"

#include "panel_played.h"

#include <string.h>

#define LEAP 100u

static struct played *played_of(const struct view_app *app)
{
    return app->stage ? stage_played(app->stage) : NULL;
}

void played_app_go(struct view_app *app, uint32_t frame)
{
    struct played *p = played_of(app);
    if (!p || played_go(p, frame))
        return;
    p->playing = false;
    app_say(app, "Frame %u cannot be shown: out of memory", frame);
}

static void search(struct view_app *app, enum played_figure figure, int direction,
                   const char *words)
{
    struct played *p = played_of(app);
    const uint32_t found = played_find(p, p->frame, figure, direction);
    p->playing = false;
    if (found == UINT32_MAX) {
        app_say(app, "No %s %s this frame", words, direction > 0 ? "behind" : "before");
        return;
    }
    played_app_go(app, found);
    app_say(app, "Frame %u: %u %s%s", found, p->frames[found].figures[figure], words,
            p->frames[found].figures[figure] == 1 ? "" : "s");
}

static void show_longest(struct view_app *app)
{
    struct played *p = played_of(app);
    const uint32_t longest = played_longest(p);
    p->playing = false;
    played_app_go(app, longest);
    app_say(app, "Frame %u is the longest: %.1f ms", longest,
            p->frames[longest].figures[PLAYED_MICROSECONDS] / 1e3);
}

static void play(struct view_app *app)
{
    struct played *p = played_of(app);
    p->playing = !p->playing;
    if (p->playing && p->frame + 1 == p->frame_count)
        played_app_go(app, 0);
    app_say(app, "%s", p->playing ? "Plays; space stops" : "Stopped; N and Shift+N step");
}

static void step(struct view_app *app, int64_t frames)
{
    struct played *p = played_of(app);
    const int64_t to = (int64_t)p->frame + frames;
    p->playing = false;
    played_app_go(app, to > 0 ? (uint32_t)to : 0);
}

void played_app_act(struct view_app *app, int action)
{
    const struct played *p = played_of(app);
    if (!p) {
        app_say(app, "This is for recordings: drop a file of Ctrl+R onto the window");
        return;
    }
    switch ((enum played_action)action) {
    case PLAYED_NEXT: step(app, 1); break;
    case PLAYED_BACK: step(app, -1); break;
    case PLAYED_FORWARD: step(app, LEAP); break;
    case PLAYED_REWIND: step(app, -(int64_t)LEAP); break;
    case PLAYED_FIRST: step(app, -(int64_t)p->frame); break;
    case PLAYED_LAST: step(app, (int64_t)p->frame_count); break;
    case PLAYED_PLAY: play(app); break;
    case PLAYED_NEXT_FAILURE: search(app, PLAYED_FAILED, 1, "failed read"); break;
    case PLAYED_LAST_FAILURE: search(app, PLAYED_FAILED, -1, "failed read"); break;
    case PLAYED_NEXT_LOSS: search(app, PLAYED_LOST, 1, "evicted wanted tile"); break;
    case PLAYED_LAST_LOSS: search(app, PLAYED_LOST, -1, "evicted wanted tile"); break;
    case PLAYED_SHOW_LONGEST: show_longest(app); break;
    }
}

static const struct {
    const char *chord;
    enum played_action action;
} keys[] = {
    {"N", PLAYED_NEXT},         {"right", PLAYED_NEXT},
    {"Shift+N", PLAYED_BACK},   {"left", PLAYED_BACK},
    {"Home", PLAYED_FIRST},     {"End", PLAYED_LAST},
    {"space", PLAYED_PLAY},     {"P", PLAYED_PLAY},
    {"F", PLAYED_NEXT_FAILURE}, {"Shift+F", PLAYED_LAST_FAILURE},
    {"E", PLAYED_NEXT_LOSS},    {"Shift+E", PLAYED_LAST_LOSS},
    {"L", PLAYED_SHOW_LONGEST}, {"pagedown", PLAYED_FORWARD},
    {"pageup", PLAYED_REWIND},
};

bool played_app_press(struct view_app *app, int key, unsigned modifiers)
{
    struct view_chord chord;
    for (size_t i = 0; played_of(app) && i < sizeof keys / sizeof *keys; i++)
        if (view_chord_read(keys[i].chord, &chord) && chord.key == key &&
            chord.modifiers == modifiers) {
            played_app_act(app, (int)keys[i].action);
            return true;
        }
    return false;
}

const char *played_app_refuses(const struct action *action)
{
    if (strcmp(action->group, "Camera") == 0 || strcmp(action->group, "Views") == 0)
        return "A recording has no picture: it holds decisions, not the scene";
    if (strcmp(action->group, "Streaming") == 0)
        return "A recording is played as it was: nothing streams";
    static const char *const chords[] = {"Ctrl+T", "Shift+T", "Ctrl+F5"};
    for (int i = 0; action->chord && i < 3; i++)
        if (strcmp(action->chord, chords[i]) == 0)
            return "This is for scenes: a recording has no settings to sweep and no shaders";
    return NULL;
}

bool played_app_takes(const char *control)
{
    static const char *const names[] = {"graph-span", "memory-colors", "event-reason", "events-of",
                                        "size",       "full-screen",   "frame-cap",    "ui-scale",
                                        "panels",     "theme",         "vsync"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(names[i], control) == 0)
            return true;
    return false;
}

void played_app_move(struct view_app *app)
{
    struct played *p = played_of(app);
    if (!p || !p->playing)
        return;
    if (p->frame + 1 < p->frame_count)
        played_app_go(app, p->frame + 1);
    else
        p->playing = false;
}
