/** Command-line options of the gallery. */
#ifndef SAMPLES_STREAMING_SETTINGS_H
#define SAMPLES_STREAMING_SETTINGS_H

#include <sluice/vulkan.h>

#include "../../tools/common/option_table.h"
#include "../common/frame_range.h"

enum write_frames { WRITE_FRAMES_SOME, WRITE_FRAMES_ALL, WRITE_FRAMES_NONE };
enum pixel_format { PIXEL_FORMAT_AUTO, PIXEL_FORMAT_RGBA16F, PIXEL_FORMAT_RGBA8 };
enum three_way { THREE_WAY_AUTO, THREE_WAY_ON, THREE_WAY_OFF };
enum residency { RESIDENCY_AUTO, RESIDENCY_SPARSE, RESIDENCY_PAGED, RESIDENCY_DENSE };
enum on_off { SETTING_ON, SETTING_OFF };

/** Ways to stream a texture of a neural set. */
enum neural_mode {
    NEURAL_RAW,      ///< BC7 blocks, from a tile store
    NEURAL_BC7,      ///< blocks, from a tile store
    NEURAL_LOAD,     ///< decoded by the loader's threads
    NEURAL_FEEDBACK, ///< decoded by the GPU, tile by tile
    NEURAL_SAMPLE,   ///< decoded by the sampling shader
    NEURAL_MODE_COUNT
};

/** Ways to run the network in the shader of NEURAL_SAMPLE. */
enum neural_path {
    NEURAL_PATH_AUTO,
    NEURAL_PATH_PLAIN,
    NEURAL_PATH_DOT,       ///< integer dot products
    NEURAL_PATH_VECTOR,    ///< cooperative vectors with INT8 weights
    NEURAL_PATH_VECTOR_FP8 ///< cooperative vectors with FP8 weights
};

struct settings {
    /* pictures */
    struct option_list images;
    const char *cache;
    uint32_t generate_scale;
    bool generate_only;
    const char *neural; ///< .ntc file; NULL: show pictures
    struct option_list neural_as;
    enum neural_mode neural_modes[NEURAL_MODE_COUNT]; ///< from `neural_as`, set by parsing
    uint32_t neural_mode_count, neural_picks;
    int neural_path;      ///< enum neural_path
    const char *material; ///< output folder of a material; NULL: none
    int format;           ///< enum pixel_format
    /* frames */
    uint32_t size[2];
    uint32_t frames, rest_frames;
    struct frame_range range; ///< all frames if not given, set by parsing
    uint32_t play_in;         ///< frames before the range, rounded up; parsing limits it to `first`
    uint32_t frames_per_second;
    uint32_t samples;
    const char *output;
    int write_frames; ///< enum write_frames
    bool deterministic;
    uint32_t seed;
    /* streaming */
    int residency; ///< enum residency
    double probability;
    bool lattice;
    uint32_t textures_per_frame, tiles_per_frame;
    double timeout; ///< seconds
    uint32_t standby, heap_tiles, max_heaps, threads, touched_tiles;
    uint64_t budget;  ///< bytes for tiles; 0: no limit; parsing fits heap_tiles and max_heaps to it
    int texture_sets; ///< enum on_off
    uint32_t loads_in_flight;
    double fade;             ///< seconds
    double source_latency;   ///< milliseconds, in the time of the frames
    double source_bandwidth; ///< MB/s, 0: no limit
    const char *record;
    double predict;   ///< seconds
    uint32_t warm_up; ///< frames
    /* sampling */
    double lod_bias;
    uint32_t anisotropy;
    bool highlight;
    /* checks */
    bool compare, validation, json;
    int compare_with;    ///< enum residency
    int check_residency; ///< enum three_way
    int needs;           ///< enum three_way
    const char *needs_trace;
    const char *reference;                            ///< folder of the truth; NULL: do not keep
    uint32_t reference_anisotropy, reference_samples; ///< not 0 after parsing
    uint32_t reference_supersample;                   ///< 1, 2 or 4
    double reference_lod_bias;                        ///< not NaN after parsing
    uint32_t metrics_every;                           ///< 0 without a truth
    /* device */
    const char *device;
    bool list_devices;
};

enum option_outcome settings_parse(int argc, char **argv, struct settings *settings);

/** Makes the path "OUTPUT/frames.csv", or "OUTPUT/frames-24-47.csv" of a range. */
void settings_report_path(const struct settings *settings, const char *name, const char *ending,
                          char *path, size_t size);

SluiceResidencyMode settings_residency_mode(int residency);
/** Returns whether to count the required tiles of frames. */
bool settings_find_needs(const struct settings *settings);

#endif /* SAMPLES_STREAMING_SETTINGS_H */
