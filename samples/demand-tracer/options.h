/** Command-line options of the tracer; --help prints them. */
#ifndef TRACER_OPTIONS_H
#define TRACER_OPTIONS_H

#include "../../tools/common/device_list.h"
#include "../../tools/common/option_table.h"
#include "../common/read_sharing.h"
#include "../common/split.h"
#include "scene.h"

enum needs_choice { NEEDS_AUTO, NEEDS_ON, NEEDS_OFF };
enum path_choice { PATH_AUTO, PATH_PIPELINE, PATH_COMPUTE };

struct tracer_options {
    struct option_list textures;
    uint32_t texture_count, texture_size;
    uint32_t size[2];
    uint32_t samples, bounces, max_launches, seed;
    struct scene_camera view;
    int path; ///< enum path_choice
    bool preview, preload;
    bool needs;              ///< outcome of `count_needs`
    int count_needs;         ///< enum needs_choice
    double exposure;         ///< stops
    uint64_t budget, memory; ///< bytes
    uint32_t threads, requests;
    double anisotropy;
    const char *output, *launch_pictures, *contact_sheet, *reference;
    bool json, list_devices, validation;
    const char *device;
    struct device_list devices;
    int split;          ///< enum split
    int read_sharing;   ///< enum read_sharing
    uint32_t animation; ///< number of pictures; 0: a single picture
};

/** Reports errors on stderr. */
enum option_outcome tracer_options_parse(int argc, char **argv, struct tracer_options *options);

#endif /* TRACER_OPTIONS_H */
