/** What is measured per frame, and the figures that follow from it. */
#ifndef SAMPLES_STREAMING_MEASURE_H
#define SAMPLES_STREAMING_MEASURE_H

#include "settings.h"
#include "view_needs.h"

#define MEASURE_SHARP_DB 60.0  ///< "the same picture"
#define MEASURE_EQUAL_DB 999.0 ///< stands for infinity where only numbers may be written

struct frame_record {
    double frame_seconds; ///< since the frame before was submitted
    double host_seconds;  ///< of the application's thread
    double gpu_seconds;
    double psnr;       ///< to the fully resident picture; NaN without a comparison
    double ssim, flip; ///< NaN in frames that were not looked at
    SluiceVulkanStreamerStatistics statistics;
    uint64_t neural_bytes; ///< of latents and weights in GPU memory
    struct GalleryCounts counts;
    struct needs_frame needs; ///< where they are found out
    double missing_percent;   ///< of the sampled pixels; NaN where nothing counts them
};

struct measure {
    const struct settings *settings;      ///< borrowed
    struct frame_record *frames;          ///< owned
    uint32_t begin_frame;                 ///< the first that was drawn
    uint32_t first_frame, frame_count;    ///< the first that is measured; behind the last one
    uint32_t rest_frame;                  ///< the first in which the camera stands still
    SluiceVulkanStreamerStatistics start; ///< before the first frame: of warming up
    bool counting;                        ///< counts are valid
    uint64_t tile_count;                  ///< of all textures
    uint32_t picture_count, refused_count;
    uint32_t texture_count;
    struct view_reads reads;
    const struct needs *needs; ///< borrowed; of all frames; NULL: not found out
    double file_bytes;         ///< read from the files of a neural set; NaN: none hangs
    uint64_t truth_bytes;      ///< that the fully resident pictures take; 0 without a comparison
};

/** One named figure. */
struct figure {
    const char *name;
    double value; ///< NaN: there is none
    const char *unit;
    const char *meaning; ///< for the report
};

#define MEASURE_MAX_FIGURES 64
#define MEASURE_TILE_BYTES 65536.0

bool measure_begin(struct measure *measure, const struct settings *settings);
void measure_finish(struct measure *measure);

uint32_t measure_resident_tiles(const struct frame_record *record);
/** Returns how many there are. */
uint32_t measure_figures(const struct measure *measure, struct figure figures[MEASURE_MAX_FIGURES]);

/** One line per frame. Says on stderr why it failed. */
bool measure_write_csv(const struct measure *measure, const char *path);
void measure_print_json(const struct figure *figures, uint32_t count);
void measure_print_text(const struct figure *figures, uint32_t count);
/** "12.5", "-" for NaN. */
const char *measure_format(double value, char buffer[32]);

#endif /* SAMPLES_STREAMING_MEASURE_H */
