/** Parses --devices: the Vulkan devices that a program uses at a time. */
#ifndef TOOLS_COMMON_DEVICE_LIST_H
#define TOOLS_COMMON_DEVICE_LIST_H

#include <stdbool.h>
#include <stdint.h>

#define DEVICE_LIST_MOST 64u
#define DEVICE_LIST_ALL UINT32_MAX

/** Zeroed: the one device that --device chooses. */
struct device_list {
    uint32_t wanted; ///< Number of devices, or DEVICE_LIST_ALL. 0: use `indices`.
    uint32_t count;  ///< Length of `indices`.
    uint32_t indices[DEVICE_LIST_MOST]; ///< As in --list-devices. May contain duplicates.
};

/** Reads "all", a count such as "2", or indices such as "0,1". A text with a comma holds indices:
 * "1," is device 1 alone. `value`: struct device_list. Returns false for any other text. */
bool device_list_parse(const char *text, void *value);

#endif /* TOOLS_COMMON_DEVICE_LIST_H */
