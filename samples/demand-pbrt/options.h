/** What the command line says. */
#ifndef DEMAND_PBRT_OPTIONS_H
#define DEMAND_PBRT_OPTIONS_H

#include "../../tools/common/device_list.h"
#include "../../tools/common/option_table.h"
#include "../common/frame_range.h"
#include "../common/read_sharing.h"
#include "../common/split.h"
#include "camera_path.h"

enum path_choice { PATH_AUTO, PATH_PIPELINE, PATH_COMPUTE };

struct pbrt_options {
    const char *scene;
    const char *file;
    const char *bounds;
    const char *cache;
    const char *dump;
    const char *statistics;
    const char *sequence;
    const char *contact_sheet;
    const char *device;
    struct device_list devices;
    int split;                   ///< enum split
    int read_sharing;            ///< enum read_sharing
    struct frame_range pictures; ///< of the animation, from 1 on; not given: all
    uint32_t animation;          ///< pictures; 0: one, which is no animation
    uint32_t dim[2];             ///< 0: as the film
    float background[3];
    uint32_t debug[2]; ///< pixel; UINT32_MAX: none
    uint32_t samples;
    uint32_t bounces;
    uint32_t warmup;   ///< UINT32_MAX: until nothing is missing
    uint32_t launches; ///< most
    uint32_t repeat;
    struct camera_view camera, fly_from;
    uint32_t fly;        ///< frames; 0: none
    double fly_at;       ///< share of the way where the picture is; 1: its end
    double frame_budget; ///< ms; 0: no limit
    uint32_t cluster_size;
    uint32_t anisotropy;
    uint32_t threads;
    double exposure;
    int mode;                 ///< PBRT_MODE_...
    int granularity;          ///< 0: fine
    int path;                 ///< enum path_choice
    uint64_t budget;          ///< bytes of geometry; 0: no limit
    uint64_t material_budget; ///< bytes of ops; 0: no limit
    uint64_t texture_budget;
    bool face_forward, oneshot_geometry, oneshot_material, sort_proxies, verbose_loading;
    bool preload, preload_shapes, uncompacted, json, validation, list_devices;
};

enum option_outcome pbrt_options_parse(int argc, char **argv, struct pbrt_options *options);

#endif /* DEMAND_PBRT_OPTIONS_H */
