/** The command line of a sweep. */
#ifndef SLUICE_TRADEOFF_OPTIONS_H
#define SLUICE_TRADEOFF_OPTIONS_H

#include "../common/option_table.h"
#include "memory.h"
#include "scenes.h"

/** Texts are borrowed from the command line, except those of lists. */
struct options {
    const struct scene *scene;
    const char *trace;              ///< path for scene `trace`; else NULL
    const char *results;            ///< folder
    const char *program;            ///< NULL: look beside the tool
    struct text_list sweeps, bases; ///< "name=value,value", "name=value"
    struct text_list scene_arguments;
    bool grid, full, fresh, json;
    uint32_t repeats, jobs;
    double run_limit; ///< seconds
};

/** Parses the command line. Prints the help text for --help; reports errors on stderr. Skips
 * `argv[0]`. */
enum option_outcome options_parse_sweep(int argc, char **argv, struct options *options);
/** Adds the scene's arguments from the plan, unless the command line overrides them. */
void options_add_scene(const struct options *options, struct text_list *arguments);
void options_finish(struct options *options);

#endif /* SLUICE_TRADEOFF_OPTIONS_H */
