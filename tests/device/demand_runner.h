/** Launches that sample a list of positions through a demand loader, and images to sample. */
#ifndef TESTS_DEVICE_DEMAND_RUNNER_H
#define TESTS_DEVICE_DEMAND_RUNNER_H

#include "device/harness.h"
#include "support/fault_source.h"

#include <sluice/demand.h>
#include <sluice/shared/bindings.h>

#include "demand_runner_shared.h"

#define RUNNER_SAMPLES 65536u
#define RUNNER_LAUNCHES HARNESS_FRAMES

struct runner {
    struct harness *h;
    SluiceDemandLoader *loader;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet sets[RUNNER_LAUNCHES];
    uint64_t generations[RUNNER_LAUNCHES];      ///< generation of the pages in each set
    uint64_t byte_generations[RUNNER_LAUNCHES]; ///< generation of the chunks of byte pages
    bool reads_bytes;                           ///< true: the shader reads byte pages
    struct harness_buffer inputs, outputs;
    uint32_t count; ///< samples
    SluiceDemandLaunch launch;
    SluiceDemandRequests requests;
    SluiceDemandTicket ticket;
};

/** Fills in `info` with the harness's objects. `info` may be NULL. */
void runner_init(struct runner *r, struct harness *h, const SluiceDemandLoaderCreateInfo *info);
/** Initializes with an existing loader. runner_finish destroys the loader. */
void runner_init_with(struct runner *r, struct harness *h, SluiceDemandLoader *loader);
/** Allows RUNNER_LAYER_GRAD and later kinds from now on. Byte pages are not allowed then. */
void runner_sample_grids(struct runner *r);
/** Allows RUNNER_CUBE_GRAD from now on. Single grids and byte pages are not allowed then. */
void runner_sample_cubes(struct runner *r);
/** Like runner_sample_cubes or runner_sample_grids, with a shader in HLSL that supports nothing
 * else. */
void runner_sample_in_hlsl(struct runner *r, bool cubes);
void runner_finish(struct runner *r);
void runner_fill(struct harness *h, SluiceDemandLoaderCreateInfo *info);

/** Empties the list of samples. */
void runner_clear(struct runner *r);
void runner_add(struct runner *r, struct RunnerInput input);
/** Samples the middle of a level's texel. A nearest sampler reads that texel only. */
void runner_add_texel(struct runner *r, SluiceDemandTextureId id, uint32_t width, uint32_t height,
                      uint32_t level, uint32_t x, uint32_t y);
/** Adds texel (7, 9) of each tile of 128 x 128 texels in `row_count` rows of tiles of level 0,
 * beginning with row `first`. */
void runner_add_tiles(struct runner *r, SluiceDemandTextureId id, uint32_t size, uint32_t first,
                      uint32_t row_count);
void runner_add_page(struct runner *r, uint32_t page);

/** Records and submits a launch. At most two may be in flight. Returns the result of
 * sluiceBeginDemandLaunch if it is not SUCCESS. */
SluiceResult runner_submit(struct runner *r);
/** Submits and processes a launch. Sets `requests` and `ticket`. */
void runner_launch(struct runner *r);
/** Launches and waits for the reads until nothing is missing. Returns the number of launches, or
 * `limit`. */
uint32_t runner_load(struct runner *r, uint32_t limit);

struct RunnerOutput runner_output(const struct runner *r, uint32_t sample);
bool runner_all_resident(const struct runner *r);
SluiceDemandStatistics runner_statistics(const struct runner *r);

/** An image whose texels are hashes of their positions. Counts openings and reads. */
struct runner_image {
    SluiceImageInfo info;
    uint32_t seed;
    SluiceImageSource *inner;
    struct fault_source source;
    atomic_uint opened, closed;
    SluiceResult open_result; ///< result of pfnOpen
    uint64_t open_failures;   ///< number of NOT_READY results before
    char name[32];
};

void runner_image_init(struct runner_image *image, SluiceFormat format, uint32_t width,
                       uint32_t height, uint32_t seed);
/** Initializes with all of `info`, address modes included. */
void runner_image_init_as(struct runner_image *image, const SluiceImageInfo *info, uint32_t seed);
void runner_image_finish(struct runner_image *image);
/** Describes the image, opened by callback. */
SluiceDemandImage runner_image_desc(struct runner_image *image);
/** Adds a texture of the image with nearest filters and REPEAT. */
SluiceDemandTextureId runner_add_texture(struct runner *r, struct runner_image *image);
extern const SluiceDemandSampler runner_nearest;

/** Returns the image's texel on the host: RGBA8 and RGBA16F. */
void runner_image_texel(struct runner_image *image, uint32_t level, uint32_t x, uint32_t y,
                        float rgba[4]);
/** Checks that the samples of runner_add_texel are resident and have the image's color. */
void runner_check_texel(const struct runner *r, uint32_t sample, struct runner_image *image,
                        uint32_t level, uint32_t x, uint32_t y);

#endif /* TESTS_DEVICE_DEMAND_RUNNER_H */
