/**
 * What a sweep is made of: settings, the points that were tried, what was measured at each. The CSV
 * file, the page and the recommendations are made from this alone.
 */
#ifndef SLUICE_TRADEOFF_SWEEP_H
#define SLUICE_TRADEOFF_SWEEP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Something that can be set: an option of the program that draws the scene. */
struct sweep_setting {
    const char *name;    ///< as on its command line, without the dashes
    const char *meaning; ///< one line
    const char *unit;    ///< "" if none
    bool condition;      ///< of the world, not a choice: other values than the base's are no advice
};

enum sweep_better { SWEEP_LESS_IS_BETTER, SWEEP_MORE_IS_BETTER, SWEEP_NEITHER };

/** Something that is measured: a figure that the program prints, or one made of several. */
struct sweep_metric {
    const char *name; ///< the figure's name
    const char *unit;
    const char *meaning; ///< one line
    enum sweep_better better;
};

/** A mean over repeats. */
struct sweep_estimate {
    double mean;        ///< NaN: nothing is known
    double half_width;  ///< of the 95 % confidence interval (Student's t); NaN below two repeats
    double least, most; ///< of the repeats
    uint32_t count;     ///< repeats that had the figure
};

enum sweep_state { SWEEP_PENDING, SWEEP_DONE, SWEEP_FAILED };

/** One combination of settings. Strings are owned. */
struct sweep_point {
    char **values;      ///< per setting, as on the command line: "1/16"
    char *label;        ///< what differs from the base settings: "probability 1/64, budget 16"
    char *command_line; ///< that repeats this point's first run
    char *folder;       ///< of the first run: frames.csv, frame-*.png, truth-*.png, flip-*.png
    enum sweep_state state;
    char *reason;                     ///< why it failed, else NULL
    struct sweep_estimate *estimates; ///< per metric
    struct sweep_estimate *deltas;    ///< per metric: to the base, repeat by repeat
    double *measured;                 ///< [metric][repeat]; NaN: not, or does not count
};

struct sweep {
    char *title;        ///< of the page: "The gallery"
    char *scene;        ///< what was drawn, one line
    char *machine;      ///< device and driver, one line
    char *command_line; ///< of the whole sweep
    const struct sweep_setting *settings;
    const struct sweep_metric *metrics;
    uint32_t setting_count, metric_count, point_count;
    uint32_t base; ///< the point with the scene's defaults
    uint32_t repeats;
    struct sweep_point *points;
};

/** A point that is the best by some rule. */
struct sweep_recommendation {
    const char *name; ///< "quality", "balanced", "small memory"
    const char *rule; ///< what it is best at, and within which bounds: one line
    int64_t point;    ///< -1: no point keeps to the rule
};

/** Index of a metric, -1 if there is none of that name. */
int sweep_find_metric(const struct sweep *sweep, const char *name);

#endif /* SLUICE_TRADEOFF_SWEEP_H */
