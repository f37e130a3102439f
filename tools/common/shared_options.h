/**
 * Options shared by several programs, with equal name, default and meaning. tests/programs compares
 * the --help texts.
 */
#ifndef TOOLS_COMMON_SHARED_OPTIONS_H
#define TOOLS_COMMON_SHARED_OPTIONS_H

#include "device_list.h"
#include "option_table.h"

/* Memory. Sizes are in bytes. */
struct option option_budget(uint64_t *bytes, const char *help);
struct option option_heap_tiles(uint32_t *tiles);
struct option option_max_heaps(uint32_t *heaps);
struct option option_standby(uint32_t *tiles);
/** Host memory. `help` says what for. */
struct option option_memory(uint64_t *bytes, const char *help);

/* Loading. */
struct option option_tiles_per_frame(uint32_t *tiles, uint32_t most);
struct option option_latency(uint32_t *frames);
struct option option_timeout(double *seconds);
struct option option_threads(uint32_t *count);

/* The device. */
struct option option_device(const char **device);
/** For programs that use several devices at a time. */
struct option option_devices(struct device_list *devices);
struct option option_list_devices(bool *list);
struct option option_validation(bool *validation);

/* Behavior of the program. */
struct option option_seed(uint32_t *seed);
struct option option_json(bool *json);
/** `known`: all names, separated by commas. See chosen_names.h. */
struct option option_only(const char **only, const char *known);

#endif /* TOOLS_COMMON_SHARED_OPTIONS_H */
