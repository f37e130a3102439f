/** What can be swept: programs, their settings, what they measure, the built-in plans. */
#ifndef SLUICE_TRADEOFF_SCENES_H
#define SLUICE_TRADEOFF_SCENES_H

#include "program.h"
#include "sweep.h"

struct scene_setting {
    struct sweep_setting setting;
    const char *base;  ///< NULL: what --help says; "on" or "off" of flags
    const char *quick; ///< values of the quick plan beside the base: "1/4,1/64"; NULL: none
    const char *full;  ///< of the full plan
};

struct scene_metric {
    struct sweep_metric metric;
    bool is_time; ///< disturbed by what the first run writes
};

/** Metrics for one purpose, the best first; NULL at the end. The first that was measured counts. */
struct scene_roles {
    const char *const *quality, *const *memory, *const *time;
};

/** Where a run writes what. */
struct scene_run {
    const char *folder;    ///< of this run
    const char *reference; ///< folder that the runs of a sweep share
    const char *base;      ///< folder of the base's first run, which is made first; NULL for itself
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
    bool keeps_reference;                         ///< runs share a folder for --reference
    struct scene_roles roles;
    /** What a run needs beside its settings and decides nothing of the scene. */
    void (*add_run_arguments)(const struct program *program, const struct scene_run *run,
                              struct text_list *arguments);
    /** What decides of it: the seed of a repeat, what it is compared to. */
    void (*add_repeat_arguments)(const struct program *program, uint32_t repeat,
                                 struct text_list *arguments);
};

/** Adds "--seed REPEAT" where the program has that option. Repeats count from 1 there. */
void scene_add_seed(const struct program *program, uint32_t repeat, struct text_list *arguments);

/** NULL: there is none of that name. */
const struct scene *scene_find(const char *name);

extern const struct scene scene_gallery, scene_demand_tracer, scene_neural, scene_view, scene_trace;

#endif /* SLUICE_TRADEOFF_SCENES_H */
