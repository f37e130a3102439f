#include "options.h"

#include "camera.h"
#include "controls.h"
#include "scene_open.h"
#include "sets.h"

#include "../common/shared_options.h"

#include <string.h>

static const char usage[] =
    "usage: sluice-view [OPTION ...] [SCENE | PICTURE ... | FOLDER ... | URL ... | RECORDING]\n\n"
    "Shows a scene whose textures are streamed, and why they look as they do. SCENE is a glTF,\n"
    "OBJ or pbrt file; without one, a hall that comes with this program. Pictures, those of\n"
    "folders, of URLs (http, https, s3: give 32 --threads then) and of catalogues (sluice-bake\n"
    "--merge) hang in a room. RECORDING is a file of --record: its decisions are shown frame by\n"
    "frame, without the scene. Drop files onto the window to open them, or press Ctrl+O.\n";

static const char notes[] =
    "Without a display, use --headless: it draws the same frames, with the panels, into pictures.\n"
    "Exit status: 0; 1 if something failed; 2 for wrong usage; 77 without a Vulkan device that "
    "can\n"
    "stream.\n";

/* Reads settings of B into a copy, to check them: files of settings are read later. */
static bool read_b(const struct view_options *o)
{
    struct view_settings b = o->settings;
    for (size_t i = 0; i < o->b.count; i++)
        if (!sets_read(&b, o->b.items[i], "sluice-view: --b"))
            return false;
    return true;
}

/* Returns true if a text can be a camera's name or number: several numbers are a position. */
static bool names_camera(const char *text)
{
    return text[0] && (!strchr(text, ',') || text[strspn(text, "0123456789+-.eE, ")]);
}

enum option_outcome options_read(int argc, char **argv, struct view_options *o)
{
    const struct option own[] = {
        {OPTION_WORDS, .value = &o->words, .help = "a scene, or pictures", .minimum = 0},
        {OPTION_SECTION, .help = "Compare with B"},
        {OPTION_REPEATED, "b", "NAME=VALUE,...", "(as A)", &o->b,
         "settings of B that differ from those of A: budget=16,probability=1/512. All of Memory, "
         "Feedback, Loading and Sampling, but pause and freeze-wants. V shows both pictures. Makes "
         "--compare-to b; may be given more than once"},
        {OPTION_SECTION, .help = "Scene"},
        {OPTION_FLAG, "room", .value = &o->room,
         .help = "open a room of computed pictures, which needs no file"},
        {OPTION_SECTION, .help = "Without a window"},
        {OPTION_FLAG, "headless", .value = &o->headless,
         .help = "open no window: draw into pictures; time follows the frame number"},
        {OPTION_TEXT, "script", "FILE", "(none)", &o->script,
         "events: \"40 key 3\", \"60 click 312 200\", \"80 set budget 16\", \"90 screenshot "
         "out.png\", \"120 quit\"; also hold, type, hover, double-click, drag, wheel, drop, do, "
         "record, frame and reset"},
        {OPTION_UINT, "frames", "N", "0", &o->frames,
         "number of frames; 0: until the script or the user ends the program, otherwise 120", 0,
         10000000},
        {OPTION_TEXT, "screenshot", "FILE", "(none)", &o->screenshot,
         "write the last picture as PNG"},
        {OPTION_TEXT, "record", "FILE", "(none)", &o->record,
         "record the decisions of the streamer, for sluice-replay"},
        {OPTION_TEXT, "csv", "FILE", "(none)", &o->csv, "write a line of figures per frame"},
        {OPTION_FLAG, "deterministic", .value = &o->deterministic,
         .help = "wait for loads in each frame, so that all runs draw the same pictures"},
        option_json(&o->json),
        {OPTION_TEXT, "play", "FILE", "(none)", &o->play,
         "camera path to follow: lines of seconds, x, y, z, yaw, pitch, fov"},
        {OPTION_TEXT, "camera", "NUMBERS|N|NAME", "(the scene's)", &o->camera,
         "first camera: x,y,z,yaw,pitch,fov in meters and radians, as C copies it, or a camera of "
         "the file by its number or name"},
        {OPTION_UINT, "cursor", "N", "0", &o->cursor,
         "first frame shown of a recording, as C copies it", 0, 4294967295.0},
        {OPTION_FLAG, "still", .value = &o->still,
         .help = "the camera stands still until the user moves it"},
        {OPTION_FLAG, "fresh", .value = &o->fresh,
         .help = "ignore the settings kept from earlier runs, and keep none"},
        {OPTION_TEXT, "cache", "DIR", "($XDG_CACHE_HOME/sluice, ~/.cache/sluice)", &o->cache,
         "folder for generated pictures and tile stores"},
        option_validation(&o->validation),
        {OPTION_SECTION, .help = "Device"},
        option_device(&o->device),
        option_list_devices(&o->list_devices),
    };
    struct option all[sizeof own / sizeof *own + 2 * CONTROLS_MAX];
    *o = (struct view_options){0};
    size_t count = controls_write_options(&o->settings, o->given, all);
    memcpy(all + count, own, sizeof own);
    count += sizeof own / sizeof *own;
    const struct option_table table = {"sluice-view", usage, notes, all, count};
    const enum option_outcome outcome = options_parse(&table, argc, argv);
    struct view_camera camera;
    if (outcome == OPTIONS_RUN && o->camera && !view_camera_read(o->camera, &camera) &&
        !names_camera(o->camera)) {
        options_refuse(&table,
                       "--camera %s: wants six numbers: x,y,z,yaw,pitch,fov, or these and "
                       "roll,span,aspect, or a camera of the file",
                       o->camera);
        return OPTIONS_ERROR;
    }
    if (outcome == OPTIONS_RUN && !controls_budget_fits(&o->settings)) {
        options_refuse(&table, "--budget: " CONTROLS_BUDGET_WANTED);
        return OPTIONS_ERROR;
    }
    if (outcome == OPTIONS_RUN && !read_b(o))
        return OPTIONS_ERROR;
    if (outcome == OPTIONS_RUN &&
        !scene_open_takes((const char *const *)o->words.items, (uint32_t)o->words.count))
        return OPTIONS_ERROR;
    return outcome;
}
