/** The runs of a sweep: a folder for each, complete or absent. */
#ifndef SLUICE_TRADEOFF_RUNS_H
#define SLUICE_TRADEOFF_RUNS_H

#include "child.h"
#include "figures.h"
#include "options.h"

struct run {
    uint32_t point, repeat;
    char *key;    ///< of its settings, program and build: "budget-16-r1-0123456789abcdef"; owned
    char *folder; ///< RESULTS/runs/KEY, there once it is complete; owned
    enum sweep_state state;
    bool was_there; ///< complete before this sweep began
    char *reason;   ///< why it failed, else NULL; owned
    struct figures figures;
};

/** What the runs of a sweep share; borrowed, but `runs`. */
struct runs {
    const struct options *options;
    const struct program *program;
    struct sweep *sweep;
    const char *results;
    struct run *items; ///< repeat by repeat, the points in turn: [repeat][point]
    uint32_t count;
};

/**
 * Names all runs and finds out which are complete, and why others failed. With `recall` names are
 * those that the results folder remembers, where it does.
 */
void runs_init(struct runs *runs, bool recall);
void runs_finish(struct runs *runs);

/** Finds out anew whether a run is complete, or why it failed. */
void runs_look(struct run *run);

/** The whole command line of a run that writes into `folder`. */
void runs_add_arguments(const struct runs *runs, const struct run *run, const char *folder,
                        struct text_list *arguments);

enum runs_outcome { RUNS_DONE, RUNS_INTERRUPTED, RUNS_NO_DEVICE, RUNS_UNWRITABLE };

/**
 * Makes those that are not complete, up to options->jobs at a time. After the failure of a point's
 * run its others are not tried. What cannot be written ends it, said on stderr.
 */
enum runs_outcome runs_make(struct runs *runs);

#endif /* SLUICE_TRADEOFF_RUNS_H */
