/**
 * Data of a sweep: settings, tried points, and measurements at each. The CSV file, the page and the
 * recommendations are made from it alone.
 */
#ifndef SLUICE_TRADEOFF_SWEEP_H
#define SLUICE_TRADEOFF_SWEEP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** A setting: an option of the program that draws the scene. */
struct sweep_setting {
    const char *name;    ///< as on the command line, without dashes
    const char *meaning; ///< one line
    const char *unit;    ///< "" if none
    bool condition;      ///< true: an external condition, not a choice; only the base's value is
                         ///< recommended
};

enum sweep_better { SWEEP_LESS_IS_BETTER, SWEEP_MORE_IS_BETTER, SWEEP_NEITHER };

/** A metric: a figure that the program prints, or one computed from several. */
struct sweep_metric {
    const char *name; ///< the figure's name
    const char *unit;
    const char *meaning; ///< one line
    enum sweep_better better;
};

/** A mean over repeats. */
struct sweep_estimate {
    double mean;        ///< NaN: unknown
    double half_width;  ///< 95 % confidence interval (Student's t); NaN with fewer than two repeats
    double least, most; ///< range over the repeats
    uint32_t count;     ///< number of repeats with the figure
};

enum sweep_state { SWEEP_PENDING, SWEEP_DONE, SWEEP_FAILED };

/** A combination of settings. Owns its strings. */
struct sweep_point {
    char **values;      ///< by setting, as on the command line: "1/16"
    char *label;        ///< differences from the base settings: "probability 1/64, budget 16"
    char *command_line; ///< repeats this point's first run
    char *folder; ///< folder of the first run: frames.csv, frame-*.png, truth-*.png, flip-*.png
    enum sweep_state state;
    char *reason;                     ///< reason of a failure; else NULL
    struct sweep_estimate *estimates; ///< by metric
    struct sweep_estimate *deltas;    ///< by metric: difference from the base, repeat by repeat
    double *measured;                 ///< [metric][repeat]; NaN: not measured, or does not count
};

struct sweep {
    char *title;        ///< title of the page: "The gallery"
    char *scene;        ///< drawn scene, one line
    char *machine;      ///< device and driver, one line
    char *command_line; ///< command line of the whole sweep
    const struct sweep_setting *settings;
    const struct sweep_metric *metrics;
    uint32_t setting_count, metric_count, point_count;
    uint32_t base; ///< the point with the scene's defaults
    uint32_t repeats;
    struct sweep_point *points;
};

/** The best point by a rule. */
struct sweep_recommendation {
    const char *name; ///< "quality", "balanced", "small memory"
    const char *rule; ///< goal and bounds, one line
    int64_t point;    ///< -1: no point keeps to the rule
};

/** Returns a metric's index, or -1 if there is none of that name. */
int sweep_find_metric(const struct sweep *sweep, const char *name);

#endif /* SLUICE_TRADEOFF_SWEEP_H */
