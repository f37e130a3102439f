/** Measurements per frame, and the figures of a walk. */
#ifndef SAMPLES_STREAMING_MEASURE_H
#define SAMPLES_STREAMING_MEASURE_H

#include "settings.h"
#include "view_needs.h"

#define MEASURE_SHARP_DB 60.0  ///< PSNR that counts as an equal picture
#define MEASURE_EQUAL_DB 999.0 ///< replaces infinity in formats without it

struct frame_record {
    double frame_seconds; ///< time since the previous submission
    double host_seconds;  ///< time of the application's thread
    double gpu_seconds;
    double psnr;       ///< against the fully resident picture; NaN without a comparison
    double ssim, flip; ///< NaN if the frame was not measured
    SluiceVulkanStreamerStatistics statistics;
    uint64_t neural_bytes; ///< latents and weights in GPU memory
    struct GalleryCounts counts;
    struct needs_frame needs; ///< valid if requirements are counted
    double missing_percent;   ///< percentage of the sampled pixels; NaN: not counted
};

struct measure {
    const struct settings *settings;      ///< borrowed
    struct frame_record *frames;          ///< owned
    uint32_t begin_frame;                 ///< first drawn frame
    uint32_t first_frame, frame_count;    ///< first measured frame; end, exclusive
    uint32_t rest_frame;                  ///< first frame with a camera at rest
    SluiceVulkanStreamerStatistics start; ///< statistics after warming up, before the first frame
    bool counting;                        ///< true: counts are valid
    uint64_t tile_count;                  ///< tiles of all textures
    uint32_t picture_count, refused_count;
    uint32_t texture_count;
    struct view_reads reads;
    const struct needs *needs; ///< borrowed; requirements of all frames; NULL: not counted
    double file_bytes;         ///< bytes read from the files of a neural set; NaN: no set
    uint64_t truth_bytes;      ///< memory of the fully resident pictures; 0 without a comparison
};

/** A figure of the walk. */
struct figure {
    const char *name;
    double value; ///< NaN: absent
    const char *unit;
    const char *meaning; ///< explanation in the report
};

#define MEASURE_MAX_FIGURES 64
#define MEASURE_TILE_BYTES 65536.0

bool measure_begin(struct measure *measure, const struct settings *settings);
void measure_finish(struct measure *measure);

uint32_t measure_resident_tiles(const struct frame_record *record);
/** Returns the number of figures. */
uint32_t measure_figures(const struct measure *measure, struct figure figures[MEASURE_MAX_FIGURES]);

/** Writes a line per frame. Reports errors on stderr. */
bool measure_write_csv(const struct measure *measure, const char *path);
void measure_print_json(const struct figure *figures, uint32_t count);
void measure_print_text(const struct figure *figures, uint32_t count);
/** Formats like "12.5"; NaN becomes "-". */
const char *measure_format(double value, char buffer[32]);

#endif /* SAMPLES_STREAMING_MEASURE_H */
