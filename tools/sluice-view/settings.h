/** Settings: one plain struct that options, panels, scripts and files of settings share. */
#ifndef SLUICE_VIEW_SETTINGS_H
#define SLUICE_VIEW_SETTINGS_H

#include <stdbool.h>
#include <stdint.h>

enum view_residency { VIEW_AUTO, VIEW_SPARSE, VIEW_PAGED, VIEW_DENSE };
enum view_load { VIEW_LOAD_WANTED, VIEW_LOAD_EVERYTHING };
enum view_feedback { VIEW_FEEDBACK_ON, VIEW_FEEDBACK_OFF };
/** Pixels that write feedback. shaders/scene_push.glsl has the same numbers. */
enum view_feedback_by { VIEW_BY_QUADS, VIEW_BY_LATTICE, VIEW_BY_EVERY_PIXEL, VIEW_BY_TURNS };
enum view_switch { VIEW_ON, VIEW_OFF }; ///< values of the choice "on|off"
enum view_vsync { VIEW_VSYNC_ON, VIEW_VSYNC_MAILBOX, VIEW_VSYNC_OFF };
enum view_filter { VIEW_LINEAR, VIEW_NEAREST };
enum view_path_loop { VIEW_LOOP, VIEW_ONCE };
enum view_motion { VIEW_WALK, VIEW_FLY, VIEW_ORBIT };
enum view_compare { VIEW_COMPARE_OFF, VIEW_DIVIDER, VIEW_DIFFERENCE, VIEW_FLICKER };
enum view_render_mode { VIEW_PRIMARY, VIEW_NEAR, VIEW_DISTANT, VIEW_PATHS }; ///< PBRT_MODE_...
enum view_compared { VIEW_WITH_EVERYTHING, VIEW_WITH_BUDGET, VIEW_WITH_B };
enum view_borders { VIEW_NO_BORDERS, VIEW_BORDERS, VIEW_NUMBERED_BORDERS };
enum view_events_of { VIEW_EVENTS_OF_SELECTED, VIEW_EVENTS_OF_ALL };
enum view_difference { VIEW_BOTH_DIFFERENCES, VIEW_PIXELS, VIEW_FLIP };

/** Views of the picture, by the number of their key. */
enum view_number {
    VIEW_PICTURE = 1,
    VIEW_RESIDENT,
    VIEW_MISSING,
    VIEW_WANTED,
    VIEW_AGE,
    VIEW_IDENTITY,
    VIEW_WRITTEN,
    VIEW_TRUTH,
    VIEW_CHECKS
};

/** Values of all controls (controls.c). Choices have type int, also choices "off|on". */
struct view_settings {
    uint64_t budget; ///< bytes; 0: no limit
    double lod_bias;
    int feedback;    ///< enum view_feedback
    int feedback_by; ///< enum view_feedback_by
    double probability;
    double predict;              ///< seconds
    uint32_t textures_per_frame; ///< 0: all
    uint32_t tiles_per_frame, loads_in_flight;
    double timeout; ///< seconds
    uint32_t standby;
    uint32_t misses, prefetch_levels; ///< SluiceVulkanStreamerSettings
    double fade;                      ///< seconds
    int residency;                    ///< enum view_residency
    int load;                         ///< enum view_load
    uint32_t anisotropy;
    int texture_sets;      ///< enum view_switch
    int filter;            ///< enum view_filter
    uint32_t finest_level; ///< finest level that may be sampled or requested
    int alpha_test;        ///< enum view_switch
    uint32_t threads;      ///< threads of the loader; 0: chosen by the number of processors
    double source_latency, source_bandwidth; ///< milliseconds, MB/s
    uint32_t source_fails; ///< reads fail in 1 of `source_fails` regions; 0: in none
    int pause, freeze_wants;

    /* Settings of pbrt scenes. */
    int render_mode; ///< enum view_render_mode
    uint32_t most_samples, depth;
    double exposure; ///< stops

    uint32_t view; ///< enum view_number
    double render_scale;
    double tint;
    int borders; ///< enum view_borders
    int wireframe;
    int show_path;         ///< draws the camera path and the bookmarks
    int compare, compared; ///< enum view_compare, enum view_compared
    int difference;        ///< enum view_difference
    double divider;        ///< 0 to 1
    double gain;           ///< factor of the difference

    int motion; ///< enum view_motion
    double speed;
    int path_loop; ///< enum view_path_loop
    double path_speed;

    uint32_t size[2];
    int full_screen;
    uint32_t frame_cap;
    double ui_scale;   ///< 0: scale of the monitor
    int theme;         ///< enum ui_theme
    int vsync;         ///< enum view_vsync
    int panels;        ///< 0: panels are shown
    int graph_span;    ///< enum history_span
    int memory_colors; ///< enum memory_colors
    int event_reason;  ///< EVENT_ANY_REASON, or 1 + SluiceTileEventReason
    int events_of;     ///< enum view_events_of
};

#endif /* SLUICE_VIEW_SETTINGS_H */
