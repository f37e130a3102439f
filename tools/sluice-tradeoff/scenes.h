/** Scenes that can be swept: programs, settings, metrics, and built-in plans. */
#ifndef SLUICE_TRADEOFF_SCENES_H
#define SLUICE_TRADEOFF_SCENES_H

#include "program.h"
#include "sweep.h"

struct scene_setting {
    struct sweep_setting setting;
    const char *base;  ///< NULL: default from --help; flags: "on" or "off"
    const char *quick; ///< quick plan: values beside the base, "1/4,1/64"; NULL: none
    const char *full;  ///< full plan: values beside the base; NULL: none
};

struct scene_metric {
    struct sweep_metric metric;
    bool is_time; ///< true: the first run's extra output disturbs it
};

/** Metrics for each purpose, best first, ending with NULL. The first one that was measured is
 * used. */
struct scene_roles {
    const char *const *quality, *const *memory, *const *time;
};

/** Output folders of a run. */
struct scene_run {
    const char *folder;    ///< folder of this run
    const char *reference; ///< folder shared by the runs of a sweep
    const char *base;      ///< folder of the base's first run, made first; NULL for that run itself
    uint32_t repeat;       ///< from 0
};

struct scene {
    const char *name, *title;
    const char *program, *installed; ///< see program_find; NULL: this tool's own `play`
    const struct scene_setting *settings;
    const struct scene_metric *metrics;
    uint32_t setting_count, metric_count;
    const char *quick_arguments, *full_arguments; ///< separated by spaces
    const char *full_grid;                        ///< "name=a,b name=c,d", or NULL
    bool keeps_reference;                         ///< true: runs share a folder for --reference
    struct scene_roles roles;
    /** Adds arguments that a run requires beside its settings. They do not affect the scene. */
    void (*add_run_arguments)(const struct program *program, const struct scene_run *run,
                              struct text_list *arguments);
    /** Adds arguments that affect the scene: the seed of a repeat, and the truth to compare
     * with. */
    void (*add_repeat_arguments)(const struct program *program, uint32_t repeat,
                                 struct text_list *arguments);
};

/** Adds "--seed REPEAT" if the program has that option. REPEAT counts from 1. */
void scene_add_seed(const struct program *program, uint32_t repeat, struct text_list *arguments);

/** Returns NULL if there is no scene of that name. */
const struct scene *scene_find(const char *name);

extern const struct scene scene_gallery, scene_demand_tracer, scene_neural, scene_view, scene_trace;

#endif /* SLUICE_TRADEOFF_SCENES_H */
