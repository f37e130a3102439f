#include "controls.h"

#include "../common/option_value.h"
#include "../common/text.h"

#include <stdlib.h>
#include <string.h>

#define FIELD(name) offsetof(struct view_settings, name)
#define MIB 1048576.0
#define LEAST_BUDGET (4u << 20)

/* Options that other programs have keep their names, defaults and meanings (tests/programs). */
static const struct control table[] = {
    {"Memory",
     "Budget",
     {OPTION_BYTES, "budget", "SIZE", "0", NULL,
      "most memory for tiles, 4M or more; 0: as much as the device has", 0, 1099511627776.0},
     FIELD(budget),
     "%.0f MiB",
     CONTROL_LOGARITHMIC},
    {"Memory",
     "Standby tiles",
     {OPTION_UINT, "standby", "N", "1024", NULL,
      "tiles that are kept in memory after nothing requests them", 0, UINT32_MAX},
     FIELD(standby),
     NULL,
     CONTROL_LOGARITHMIC},
    {"Memory",
     "Timeout",
     {OPTION_SECONDS, "timeout", "SECONDS", "1", NULL,
      "time that a tile stays requested after it was last seen", 1e-6, 1e9},
     FIELD(timeout),
     "%.2f s",
     CONTROL_LOGARITHMIC},
    {"Memory",
     "Misses to forget",
     {OPTION_UINT, "misses-to-forget", "N", "0", NULL,
      "maps that must miss a tile before it is no longer requested; 0: learned per texture", 0,
      4096},
     FIELD(misses),
     NULL,
     CONTROL_LOGARITHMIC},
    {"Memory",
     "Prefetch levels",
     {OPTION_UINT, "prefetch-levels", "N", "0", NULL,
      "coarsest levels of all textures that are loaded while nothing is requested", 0, 15},
     FIELD(prefetch_levels),
     NULL,
     0},
    {"Memory",
     "Residency",
     {OPTION_CHOICE, "residency", "auto|sparse|paged|dense", "auto", NULL,
      "sparse images, a page table, or memory for everything; auto: sparse if the device has it, "
      "otherwise paged"},
     FIELD(residency),
     NULL,
     CONTROL_REOPENS},
    {"Memory",
     "Load",
     {OPTION_CHOICE, "load", "wanted|everything", "wanted", NULL,
      "tiles to load: tiles that feedback requests, or all tiles"},
     FIELD(load),
     NULL,
     CONTROL_REOPENS},

    {"Feedback",
     "Feedback",
     {OPTION_CHOICE, "feedback", "on|off", "on", NULL,
      "on: shaders report the tiles they sample; off: no new tile is loaded"},
     FIELD(feedback),
     NULL,
     0},
    {"Feedback",
     "Written by",
     {OPTION_CHOICE, "feedback-by", "quads|lattice|every-pixel|turns", "quads", NULL,
      "pixels that write feedback: quads, each with --probability; one pixel in 8x8, each once in "
      "64 frames; every pixel; or every pixel of textures whose maps are read in this frame"},
     FIELD(feedback_by),
     NULL,
     0},
    {"Feedback",
     "Probability",
     {OPTION_REAL, "probability", "P", "1/16", NULL,
      "probability that a pixel quad writes feedback", 0, 1},
     FIELD(probability),
     "%.4f",
     CONTROL_LOGARITHMIC},
    {"Feedback",
     "Look ahead",
     {OPTION_SECONDS, "predict", "SECONDS", "0", NULL,
      "time ahead: feedback is also written from where the camera will be then; 0: off", 0, 10},
     FIELD(predict),
     "%.2f s",
     CONTROL_LOGARITHMIC},
    {"Feedback",
     "Textures per frame",
     {OPTION_UINT, "textures-per-frame", "N", "10", NULL,
      "feedback maps read back per frame; 0: all", 0, 65536},
     FIELD(textures_per_frame),
     NULL,
     CONTROL_LOGARITHMIC},
    {"Feedback",
     "Texture sets",
     {OPTION_CHOICE, "texture-sets", "on|off", "on", NULL,
      "on: textures of a material follow the feedback of its color; off: each writes its own"},
     FIELD(texture_sets),
     NULL,
     0},

    {"Loading",
     "Tiles per frame",
     {OPTION_UINT, "tiles-per-frame", "N", "256", NULL, "most tiles that are loaded per frame", 1,
      8192},
     FIELD(tiles_per_frame),
     NULL,
     CONTROL_LOGARITHMIC},
    {"Loading",
     "Loads in flight",
     {OPTION_UINT, "loads-in-flight", "N", "0", NULL,
      "most tiles that are being read or wait for upload; 0: 4 times --tiles-per-frame", 0, 65536},
     FIELD(loads_in_flight),
     NULL,
     CONTROL_LOGARITHMIC | CONTROL_REOPENS},
    {"Loading",
     "Loader threads",
     {OPTION_UINT, "threads", "N", "0", NULL, "worker threads; 0: by the number of processors", 0,
      256},
     FIELD(threads),
     NULL,
     CONTROL_LOGARITHMIC | CONTROL_REOPENS},
    {"Loading",
     "Fade",
     {OPTION_SECONDS, "fade", "SECONDS", "0.1", NULL,
      "time that a texel takes to become one level sharper; 0: at once", 0, 3600},
     FIELD(fade),
     "%.2f s",
     CONTROL_LOGARITHMIC},
    {"Loading",
     "Source latency",
     {OPTION_MILLISECONDS, "source-latency", "MS", "0", NULL,
      "delay of each read, independent of other reads", 0, 60000},
     FIELD(source_latency),
     "%.0f ms",
     CONTROL_LOGARITHMIC | CONTROL_REOPENS},
    {"Loading",
     "Source bandwidth",
     {OPTION_REAL, "source-bandwidth", "MB/S", "0", NULL,
      "10^6 bytes of texels per second that all reads share; 0: no limit", 0, 1e9},
     FIELD(source_bandwidth),
     "%.0f MB/s",
     CONTROL_LOGARITHMIC | CONTROL_REOPENS},
    {"Loading",
     "Reads fail",
     {OPTION_UINT, "source-fails", "N", "0", NULL,
      "reads of 1 region in N fail, as from a broken file; 0: none", 0, 65536},
     FIELD(source_fails),
     NULL,
     CONTROL_LOGARITHMIC | CONTROL_PASSING},
    {"Loading",
     "Pause streaming",
     {OPTION_CHOICE, "pause", "off|on", "off", NULL, "streaming stops; the camera still moves"},
     FIELD(pause),
     NULL,
     CONTROL_PASSING | CONTROL_OF_BOTH},
    {"Loading",
     "Freeze wants",
     {OPTION_CHOICE, "freeze-wants", "off|on", "off", NULL,
      "tiles stay requested for the present camera, while you fly on"},
     FIELD(freeze_wants),
     NULL,
     CONTROL_PASSING | CONTROL_OF_BOTH},

    {"Sampling",
     "Mip bias",
     {OPTION_REAL, "lod-bias", "B", "0", NULL, "levels; positive is blurrier", -8, 8},
     FIELD(lod_bias),
     "%+.2f",
     0},
    {"Sampling",
     "Anisotropy",
     {OPTION_UINT, "anisotropy", "N", "8", NULL, "most anisotropy of the filter; 1: trilinear", 1,
      16},
     FIELD(anisotropy),
     NULL,
     CONTROL_REOPENS},
    {"Sampling",
     "Filter",
     {OPTION_CHOICE, "texel-filter", "linear|nearest", "linear", NULL,
      "nearest: one texel of one level, without anisotropy"},
     FIELD(filter),
     NULL,
     0},
    {"Sampling",
     "Finest level",
     {OPTION_UINT, "finest-level", "N", "0", NULL, "finest level that is sampled or requested", 0,
      15},
     FIELD(finest_level),
     NULL,
     0},
    {"Sampling",
     "Alpha test",
     {OPTION_CHOICE, "alpha-test", "on|off", "on", NULL,
      "off: materials with a mask are opaque, and write feedback everywhere"},
     FIELD(alpha_test),
     NULL,
     0},

    {"Rays",
     "Render mode",
     {OPTION_CHOICE, "render-mode", "primary|near|distant|path", "primary", NULL,
      "pbrt scenes: primary: lights without shadows; near, distant: ambient occlusion within 128 "
      "and 10^6 units; path: paths with shadows"},
     FIELD(render_mode),
     NULL,
     0},
    {"Rays",
     "Most samples",
     {OPTION_UINT, "most-samples", "N", "256", NULL,
      "pbrt scenes: samples per pixel that accumulate while the camera stands still", 1, 65536},
     FIELD(most_samples),
     NULL,
     CONTROL_LOGARITHMIC},
    {"Rays",
     "Depth",
     {OPTION_UINT, "depth", "N", "3", NULL, "pbrt scenes: bounces of paths", 0, 16},
     FIELD(depth),
     NULL,
     0},
    {"Rays",
     "Exposure",
     {OPTION_REAL, "exposure", "STOPS", "0", NULL, "pbrt scenes: brightness", -16, 16},
     FIELD(exposure),
     "%+.2f",
     0},

    {"Picture",
     "View",
     {OPTION_UINT, "view", "N", "1", NULL,
      "1 picture, 2 resident level, 3 missing levels, 4 wanted level, 5 age, 6 textures, "
      "7 feedback written, 8 difference to the truth, 9 checks",
      1, 9},
     FIELD(view),
     NULL,
     CONTROL_PASSING},
    {"Picture",
     "Tint",
     {OPTION_REAL, "tint", "T", "0.7", NULL,
      "opacity of the colors of views 2 to 6 over the picture", 0, 1},
     FIELD(tint),
     "%.2f",
     0},
    {"Picture",
     "Tile borders",
     {OPTION_CHOICE, "borders", "off|on|numbers", "off", NULL,
      "draw the borders of tiles; numbers: with column and row of each tile"},
     FIELD(borders),
     NULL,
     0},
    {"Picture",
     "Wireframe",
     {OPTION_CHOICE, "wireframe", "off|on", "off", NULL, "draw the edges of triangles"},
     FIELD(wireframe),
     NULL,
     0},
    {"Picture",
     "Camera path",
     {OPTION_CHOICE, "camera-path", "off|on", "off", NULL,
      "draw the path that the camera follows, and bookmarks"},
     FIELD(show_path),
     NULL,
     0},
    {"Picture",
     "Render scale",
     {OPTION_REAL, "render-scale", "S", "0", NULL,
      "pixels of the picture per pixel of the window, in each direction; 0: 1, on CPUs 1/2, for "
      "pbrt scenes 1/4",
      0, 2},
     FIELD(render_scale),
     "%.2f",
     0},

    {"Compare",
     "Compare",
     {OPTION_CHOICE, "compare-as", "off|divider|difference|flicker", "off", NULL,
      "show a second picture from the same camera: side by side, subtracted, or in turns"},
     FIELD(compare),
     NULL,
     CONTROL_PASSING},
    {"Compare",
     "Compare to",
     {OPTION_CHOICE, "compare-to", "everything|budget|b", "everything", NULL,
      "the second picture: everything resident, 16 MiB for tiles, or B, which has settings of its "
      "own"},
     FIELD(compared),
     NULL,
     0},
    {"Compare",
     "Divider",
     {OPTION_REAL, "divider", "X", "0.5", NULL,
      "position of the divider between the pictures, from the left; can be dragged", 0, 1},
     FIELD(divider),
     "%.2f",
     0},
    {"Compare",
     "Difference as",
     {OPTION_CHOICE, "difference-as", "both|pixels|flip", "both", NULL,
      "differences of pixels, perceived differences (the FLIP metric), or both side by side"},
     FIELD(difference),
     NULL,
     0},
    {"Compare",
     "Gain",
     {OPTION_REAL, "gain", "K", "4", NULL, "factor of the difference", 1, 16},
     FIELD(gain),
     "x%.0f",
     0},

    {"Camera",
     "Motion",
     {OPTION_CHOICE, "motion", "walk|fly|orbit", "walk", NULL,
      "walk: the camera keeps its height; fly: moves where it looks; orbit: turns around a point"},
     FIELD(motion),
     NULL,
     0},
    {"Camera",
     "Speed",
     {OPTION_REAL, "speed", "M/S", "2.5", NULL, "meters per second", 0.01, 1000},
     FIELD(speed),
     "%.2f m/s",
     CONTROL_LOGARITHMIC},
    {"Camera",
     "Path speed",
     {OPTION_REAL, "path-speed", "K", "1", NULL, "speed along the camera path, as a factor", 0.05,
      20},
     FIELD(path_speed),
     "x%.2f",
     CONTROL_LOGARITHMIC},
    {"Camera",
     "Path loop",
     {OPTION_CHOICE, "path-loop", "on|off", "on", NULL,
      "on: the path starts again at its end; off: the camera stops there"},
     FIELD(path_loop),
     NULL,
     0},

    {"Window",
     "Size",
     {OPTION_EXTENT, "size", "WxH", "1280x720", NULL,
      "pixels of the window, or of the pictures of --headless", 160, 8192},
     FIELD(size),
     NULL,
     0},
    {"Window",
     "Full screen",
     {OPTION_CHOICE, "full-screen", "off|on", "off", NULL, "the window takes the whole monitor"},
     FIELD(full_screen),
     NULL,
     0},
    {"Window",
     "Frame cap",
     {OPTION_UINT, "frame-cap", "N", "60", NULL,
      "most frames per second; 0: no limit. The time step of --headless", 0, 1000},
     FIELD(frame_cap),
     NULL,
     0},
    {"Window",
     "UI scale",
     {OPTION_REAL, "ui-scale", "S", "0", NULL, "size of letters; 0: scale of the monitor", 0, 4},
     FIELD(ui_scale),
     "%.2f",
     CONTROL_STARTS},
    {"Window",
     "Theme",
     {OPTION_CHOICE, "theme", "dark|light|contrast", "dark", NULL,
      "colors of panels; contrast: black and white, with borders"},
     FIELD(theme),
     NULL,
     0},
    {"Window",
     "Vsync",
     {OPTION_CHOICE, "vsync", "on|mailbox|off", "on", NULL,
      "on: each picture waits for the monitor (FIFO); mailbox: the newest picture waits (MAILBOX); "
      "off: none waits, and pictures may tear (IMMEDIATE). A mode that the window lacks is "
      "replaced "
      "by the previous one"},
     FIELD(vsync),
     NULL,
     0},
    {"Window",
     "Panels",
     {OPTION_CHOICE, "panels", "on|off", "on", NULL, "off: the picture alone"},
     FIELD(panels),
     NULL,
     CONTROL_PASSING},
    {"Panels",
     "Graphs",
     {OPTION_CHOICE, "graph-span", "10s|1min|all", "10s", NULL, "time that graphs show"},
     FIELD(graph_span),
     NULL,
     0},
    {"Panels",
     "Memory colors",
     {OPTION_CHOICE, "memory-colors", "state|texture|level|age", "state", NULL,
      "colors of the slots of memory"},
     FIELD(memory_colors),
     NULL,
     0},
    {"Panels",
     "Events",
     {OPTION_CHOICE, "event-reason",
      "all|feedback|added|taken-up|prefetched|answered|retried|evicted|unmapped|called|removed",
      "all", NULL, "reason of the events that are listed."},
     FIELD(event_reason),
     NULL,
     0},
    {"Panels",
     "Events of",
     {OPTION_CHOICE, "events-of", "selected|all", "selected", NULL,
      "textures whose events are listed; selected: all textures until one is selected"},
     FIELD(events_of),
     NULL,
     0},
};

#define COUNT (sizeof table / sizeof *table)
_Static_assert(COUNT <= CONTROLS_MAX, "callers have room for CONTROLS_MAX");

const struct control *controls_get(uint32_t *count)
{
    *count = (uint32_t)COUNT;
    return table;
}

struct option control_option(const struct control *control, struct view_settings *settings)
{
    struct option option = control->option;
    option.value = (char *)settings + control->offset;
    return option;
}

size_t controls_write_options(struct view_settings *settings, bool given[CONTROLS_MAX],
                              struct option *options)
{
    size_t count = 0;
    const char *group = "";
    for (size_t i = 0; i < COUNT; i++) {
        if (strcmp(group, table[i].group) != 0)
            options[count++] = (struct option){OPTION_SECTION, .help = table[i].group};
        group = table[i].group;
        options[count] = control_option(&table[i], settings);
        options[count++].given = &given[i];
    }
    return count;
}

void control_reset(const struct control *control, struct view_settings *settings)
{
    const struct option option = control_option(control, settings);
    option_value_read(&option, option.initial);
}

void controls_set_defaults(struct view_settings *settings)
{
    *settings = (struct view_settings){0};
    for (size_t i = 0; i < COUNT; i++)
        control_reset(&table[i], settings);
}

const struct control *controls_find(const char *name)
{
    for (size_t i = 0; i < COUNT; i++)
        if (strcmp(table[i].option.name, name) == 0)
            return &table[i];
    return NULL;
}

bool control_is_of_sets(const struct control *control)
{
    static const char *const groups[] = {"Memory", "Feedback", "Loading", "Sampling"};
    for (size_t i = 0; i < sizeof groups / sizeof *groups; i++)
        if (strcmp(control->group, groups[i]) == 0)
            return !(control->flags & CONTROL_OF_BOTH);
    return false;
}

bool controls_budget_fits(const struct view_settings *settings)
{
    return settings->budget == 0 || settings->budget >= LEAST_BUDGET;
}

bool controls_set(struct view_settings *settings, const char *name, const char *value,
                  const char *speaker)
{
    char wanted[512];
    const struct control *control = controls_find(name);
    if (!control) {
        text_say("%s: there is no setting %s", speaker, name);
        return false;
    }
    struct view_settings changed = *settings;
    const struct option option = control_option(control, &changed);
    if (!option_value_read(&option, value)) {
        text_say("%s: %s %s: wants %s", speaker, name, value,
                 option_value_wanted(&option, value, wanted, sizeof wanted));
        return false;
    }
    if (!controls_budget_fits(&changed)) {
        text_say("%s: %s %s: " CONTROLS_BUDGET_WANTED, speaker, name, value);
        return false;
    }
    *settings = changed;
    return true;
}

static void write_choice(const char *words, int choice, char *text, size_t size)
{
    for (; choice > 0 && strchr(words, '|'); choice--)
        words = strchr(words, '|') + 1;
    snprintf(text, size, "%.*s", (int)strcspn(words, "|"), words);
}

const char *control_write(const struct control *control, const struct view_settings *settings,
                          char *text, size_t size)
{
    const void *value = (const char *)settings + control->offset;
    const uint64_t *bytes = value;
    const uint32_t *extent = value;
    switch (control->option.kind) {
    case OPTION_UINT: snprintf(text, size, "%u", (unsigned)*extent); break;
    case OPTION_BYTES:
        if (*bytes % 1048576 == 0)
            snprintf(text, size, "%.0f", (double)*bytes / MIB);
        else
            snprintf(text, size, "%.0fK", (double)*bytes / 1024.0);
        break;
    case OPTION_CHOICE:
        write_choice(control->option.operand, *(const int *)value, text, size);
        break;
    case OPTION_EXTENT: snprintf(text, size, "%ux%u", extent[0], extent[1]); break;
    default: snprintf(text, size, "%.9g", *(const double *)value); break;
    }
    return text;
}

bool control_is_default(const struct control *control, const struct view_settings *settings)
{
    char now[64], initial[64];
    struct view_settings defaults = *settings;
    control_reset(control, &defaults);
    return strcmp(control_write(control, settings, now, sizeof now),
                  control_write(control, &defaults, initial, sizeof initial)) == 0;
}

void controls_write_command(const struct view_settings *settings, char *text, size_t size)
{
    char value[64];
    size_t length = 0;
    text[0] = '\0';
    for (size_t i = 0; i < COUNT && length < size; i++)
        if (!control_is_default(&table[i], settings))
            length +=
                (size_t)snprintf(text + length, size - length, " --%s %s", table[i].option.name,
                                 control_write(&table[i], settings, value, sizeof value));
}

void controls_take_given(const struct view_settings *from, const bool given[CONTROLS_MAX],
                         struct view_settings *to)
{
    char text[64];
    for (size_t i = 0; i < COUNT; i++)
        if (given[i]) {
            const struct option option = control_option(&table[i], to);
            option_value_read(&option, control_write(&table[i], from, text, sizeof text));
        }
}
