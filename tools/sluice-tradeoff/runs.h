/** The runs of a sweep: a folder for each, complete or absent. */
#ifndef SLUICE_TRADEOFF_RUNS_H
#define SLUICE_TRADEOFF_RUNS_H

#include "child.h"
#include "figures.h"
#include "options.h"

struct run {
    uint32_t point, repeat;
    char *key;    ///< from settings, program and build: "budget-16-r1-0123456789abcdef"; owned
    char *folder; ///< RESULTS/runs/KEY; exists when the run is complete; owned
    enum sweep_state state;
    bool was_there; ///< true: complete before this sweep began
    char *reason;   ///< reason of a failure; else NULL; owned
    struct figures figures;
};

/** Runs of a sweep and their shared inputs. All borrowed except `items`. */
struct runs {
    const struct options *options;
    const struct program *program;
    struct sweep *sweep;
    const char *results;
    struct run *items; ///< owned; [repeat][point]
    uint32_t count;
};

/**
 * Names all runs, and finds out which are complete and why others failed. `recall`: prefer the
 * names in the results folder.
 */
void runs_init(struct runs *runs, bool recall);
void runs_finish(struct runs *runs);

/** Checks again whether a run is complete, or why it failed. */
void runs_look(struct run *run);

/** Adds the whole command line of a run that writes into `folder`. */
void runs_add_arguments(const struct runs *runs, const struct run *run, const char *folder,
                        struct text_list *arguments);

enum runs_outcome { RUNS_DONE, RUNS_INTERRUPTED, RUNS_NO_DEVICE, RUNS_UNWRITABLE };

/**
 * Makes runs that are not complete, up to options->jobs at a time. After a failure, skips the
 * point's other runs. Stops if a file cannot be written, and reports it on stderr.
 */
enum runs_outcome runs_make(struct runs *runs);

#endif /* SLUICE_TRADEOFF_RUNS_H */
