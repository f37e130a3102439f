/** Launches that sample a list of places through a demand loader, and images to sample. */
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
    uint64_t generations[RUNNER_LAUNCHES];      ///< of the pages in each set
    uint64_t byte_generations[RUNNER_LAUNCHES]; ///< of the chunks of byte pages
    bool reads_bytes;                           ///< the shader reads byte pages
    struct harness_buffer inputs, outputs;
    uint32_t count; ///< samples
    SluiceDemandLaunch launch;
    SluiceDemandRequests requests;
    SluiceDemandTicket ticket;
};

/** `info` is filled in with what the harness has, and may be NULL. */
void runner_init(struct runner *r, struct harness *h, const SluiceDemandLoaderCreateInfo *info);
/** The same for a loader that is there, which it does not own... but destroys. */
void runner_init_with(struct runner *r, struct harness *h, SluiceDemandLoader *loader);
/** From now on RUNNER_LAYER_GRAD and those behind it are allowed; byte pages are not. */
void runner_sample_grids(struct runner *r);
/** From now on RUNNER_CUBE_GRAD is allowed; grids by themselves and byte pages are not. */
void runner_sample_cubes(struct runner *r);
/** Like runner_sample_cubes or runner_sample_grids, with a shader in HLSL that knows nothing else.
 */
void runner_sample_in_hlsl(struct runner *r, bool cubes);
void runner_finish(struct runner *r);
void runner_fill(struct harness *h, SluiceDemandLoaderCreateInfo *info);

/** The list of samples, empty; another one. */
void runner_clear(struct runner *r);
void runner_add(struct runner *r, struct RunnerInput input);
/** The middle of a texel of a level: with a sampler that takes the nearest, that texel alone. */
void runner_add_texel(struct runner *r, SluiceDemandTextureId id, uint32_t width, uint32_t height,
                      uint32_t level, uint32_t x, uint32_t y);
/** Adds texel (7, 9) of each tile of 128 x 128 texels in `row_count` rows of tiles of level 0. Row
 *  `first` comes first. */
void runner_add_tiles(struct runner *r, SluiceDemandTextureId id, uint32_t size, uint32_t first,
                      uint32_t row_count);
void runner_add_page(struct runner *r, uint32_t page);

/** Records and submits a launch, of which at most two may be under way; the answer of
 * sluiceBeginDemandLaunch if that is not SUCCESS. */
SluiceResult runner_submit(struct runner *r);
/** And processes it: `requests` and `ticket`. */
void runner_launch(struct runner *r);
/** Launches and waits for the reads until nothing is missing; how many launches, or `limit`. */
uint32_t runner_load(struct runner *r, uint32_t limit);

struct RunnerOutput runner_output(const struct runner *r, uint32_t sample);
bool runner_all_resident(const struct runner *r);
SluiceDemandStatistics runner_statistics(const struct runner *r);

/** An image whose texels are hashes of where they are; opened and read as often as it counts. */
struct runner_image {
    SluiceImageInfo info;
    uint32_t seed;
    SluiceImageSource *inner;
    struct fault_source source;
    atomic_uint opened, closed;
    SluiceResult open_result; ///< of pfnOpen
    uint64_t open_failures;   ///< so many times NOT_READY, before that
    char name[32];
};

void runner_image_init(struct runner_image *image, SluiceFormat format, uint32_t width,
                       uint32_t height, uint32_t seed);
/** With the address modes of `info`, too. */
void runner_image_init_as(struct runner_image *image, const SluiceImageInfo *info, uint32_t seed);
void runner_image_finish(struct runner_image *image);
/** Opened by callback. */
SluiceDemandImage runner_image_desc(struct runner_image *image);
/** A texture of it that takes the nearest texel of the nearest level, and repeats. */
SluiceDemandTextureId runner_add_texture(struct runner *r, struct runner_image *image);
extern const SluiceDemandSampler runner_nearest;

/** What reading the image on the host gives: RGBA8 and RGBA16F. */
void runner_image_texel(struct runner_image *image, uint32_t level, uint32_t x, uint32_t y,
                        float rgba[4]);
/** All samples, which runner_add_texel added, are resident, and what the image has there. */
void runner_check_texel(const struct runner *r, uint32_t sample, struct runner_image *image,
                        uint32_t level, uint32_t x, uint32_t y);

#endif /* TESTS_DEVICE_DEMAND_RUNNER_H */
