/** The command line of a sweep. */
#ifndef SLUICE_TRADEOFF_OPTIONS_H
#define SLUICE_TRADEOFF_OPTIONS_H

#include "../common/option_table.h"
#include "memory.h"
#include "scenes.h"

/** Texts are borrowed from the command line, but those of lists. */
struct options {
    const struct scene *scene;
    const char *trace;              ///< of scene trace, else NULL
    const char *results;            ///< folder
    const char *program;            ///< NULL: found beside the tool
    struct text_list sweeps, bases; ///< "name=value,value", "name=value"
    struct text_list scene_arguments;
    bool grid, full, fresh, json;
    uint32_t repeats, jobs;
    double run_limit; ///< seconds
};

/** Says on stderr what is wrong; prints the help text for --help. `argv[0]` is passed over. */
enum option_outcome options_parse_sweep(int argc, char **argv, struct options *options);
/** What the plan says of the scene, but for what the command line says otherwise. */
void options_add_scene(const struct options *options, struct text_list *arguments);
void options_finish(struct options *options);

#endif /* SLUICE_TRADEOFF_OPTIONS_H */
