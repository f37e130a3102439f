/** Range of the frames that a task renders: "24-47" on the command line. */
#ifndef SAMPLES_COMMON_FRAME_RANGE_H
#define SAMPLES_COMMON_FRAME_RANGE_H

#include <stdbool.h>
#include <stdint.h>

struct frame_range {
    bool given;
    uint32_t first, last; ///< inclusive
};

/** Parser for OPTION_CUSTOM. `value` is a struct frame_range. */
bool frame_range_parse(const char *text, void *value);

#endif /* SAMPLES_COMMON_FRAME_RANGE_H */
