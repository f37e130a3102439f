/** Command-line options. */
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
    struct frame_range pictures; ///< range of animation frames, from 1; not given: all
    uint32_t animation;          ///< number of pictures; 0: a single picture
    uint32_t dim[2];             ///< picture size in pixels; 0: as in the scene's film
    float background[3];
    uint32_t debug[2]; ///< pixel for --debug; UINT32_MAX: none
    uint32_t samples;
    uint32_t bounces;
    uint32_t warmup;   ///< warm-up launches; UINT32_MAX: until nothing is missing
    uint32_t launches; ///< limit of launches
    uint32_t repeat;
    struct camera_view camera, fly_from;
    uint32_t fly;        ///< frames; 0: none
    double fly_at;       ///< position on the camera path, 0 to 1
    double frame_budget; ///< limit of host time per frame in ms; 0: none
    uint32_t cluster_size;
    uint32_t anisotropy;
    uint32_t threads;
    double exposure;
    int mode;                 ///< PBRT_MODE_...
    int granularity;          ///< 0: fine
    int path;                 ///< enum path_choice
    uint64_t budget;          ///< bytes of ops; 0: no limit
    uint64_t material_budget; ///< bytes of ops; 0: no limit
    uint64_t texture_budget;
    bool face_forward, oneshot_geometry, oneshot_material, sort_proxies, verbose_loading;
    bool preload, preload_shapes, uncompacted, json, validation, list_devices;
};

enum option_outcome pbrt_options_parse(int argc, char **argv, struct pbrt_options *options);

#endif /* DEMAND_PBRT_OPTIONS_H */
