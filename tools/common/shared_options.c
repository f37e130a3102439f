#include "shared_options.h"

struct option option_budget(uint64_t *bytes, const char *help)
{
    return (struct option){OPTION_BYTES, "budget", "SIZE", "0", bytes, help, 0, 1099511627776.0};
}

struct option option_heap_tiles(uint32_t *tiles)
{
    return (struct option){OPTION_UINT, "heap-tiles", "N", "256", tiles, "tiles of 64 KiB per heap",
                           1,           1 << 20};
}

struct option option_max_heaps(uint32_t *heaps)
{
    return (struct option){OPTION_UINT, "max-heaps", "N", "0", heaps, "most heaps; 0: no limit",
                           0,           UINT32_MAX};
}

struct option option_standby(uint32_t *tiles)
{
    return (struct option){OPTION_UINT, "standby",
                           "N",         "1024",
                           tiles,       "tiles that are kept in memory after nothing requests them",
                           0,           UINT32_MAX};
}

struct option option_memory(uint64_t *bytes, const char *help)
{
    return (struct option){OPTION_BYTES, "memory", "SIZE", "1G",
                           bytes,        help,     1024,   1099511627776.0};
}

struct option option_tiles_per_frame(uint32_t *tiles, uint32_t most)
{
    return (struct option){OPTION_UINT, "tiles-per-frame",
                           "N",         "256",
                           tiles,       "most tiles that are loaded per frame",
                           1,           most};
}

struct option option_latency(uint32_t *frames)
{
    return (struct option){OPTION_UINT, "latency",
                           "FRAMES",    "2",
                           frames,      "time from the request for a tile to its arrival",
                           0,           999};
}

struct option option_timeout(double *seconds)
{
    return (struct option){
        OPTION_SECONDS, "timeout",
        "SECONDS",      "1",
        seconds,        "time that a tile stays requested after it was last seen",
        1e-6,           1e9};
}

struct option option_threads(uint32_t *count)
{
    return (struct option){OPTION_UINT, "threads", "N",
                           "0",         count,     "worker threads; 0: by the number of processors",
                           0,           256};
}

struct option option_device(const char **device)
{
    return (struct option){
        OPTION_TEXT,  "device",
        "INDEX|NAME", "(the best one)",
        device,       "Vulkan device: an index of --list-devices, or part of its name or type"};
}

struct option option_devices(struct device_list *devices)
{
    return (struct option){
        OPTION_CUSTOM,
        "devices",
        "all|COUNT|I,...",
        "(one)",
        devices,
        "Vulkan devices that work side by side: all of the best one's type, so many of them, or "
        "indices of --list-devices with commas (\"1,\" is the device of index 1); one may stand "
        "there several times",
        .parse = device_list_parse,
        .wanted = "all, a COUNT from 1 to 64, or at most 64 indices with commas"};
    _Static_assert(DEVICE_LIST_MOST == 64, "the text says so");
}

struct option option_list_devices(bool *list)
{
    return (struct option){OPTION_FLAG, "list-devices", .value = list,
                           .help = "list the Vulkan devices and end"};
}

struct option option_validation(bool *validation)
{
    return (struct option){OPTION_FLAG, "validation", .value = validation,
                           .help = "use Vulkan's validation layers; any message is an error"};
}

struct option option_seed(uint32_t *seed)
{
    return (struct option){OPTION_UINT, "seed",    "N", "1", seed, "start of all random numbers",
                           0,           UINT32_MAX};
}

struct option option_json(bool *json)
{
    return (struct option){OPTION_FLAG, "json", .value = json,
                           .help = "print JSON objects, one per line"};
}

struct option option_only(const char **only, const char *known)
{
    return (struct option){OPTION_TEXT, "only", "NAMES", "(all)", only, known};
}
