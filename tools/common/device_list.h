/** Which Vulkan devices a program uses at a time: the value of --devices. */
#ifndef TOOLS_COMMON_DEVICE_LIST_H
#define TOOLS_COMMON_DEVICE_LIST_H

#include <stdbool.h>
#include <stdint.h>

#define DEVICE_LIST_MOST 64u
#define DEVICE_LIST_ALL UINT32_MAX

/** Zeroed: one device, which --device chooses. */
struct device_list {
    uint32_t wanted;                    ///< Devices, or DEVICE_LIST_ALL. 0: those of `indices`.
    uint32_t count;                     ///< Of `indices`.
    uint32_t indices[DEVICE_LIST_MOST]; ///< Of --list-devices. One may stand here several times.
};

/** Reads "all", a count such as "2", or indices such as "0,1". A comma makes it indices: "1," is
 *  device 1 alone. `value` is a struct device_list. False if the text is none of these. */
bool device_list_parse(const char *text, void *value);

#endif /* TOOLS_COMMON_DEVICE_LIST_H */
