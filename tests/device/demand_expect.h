/** Expected result of a sample in a demand scene, for the pages that are resident. */
#ifndef TESTS_DEVICE_DEMAND_EXPECT_H
#define TESTS_DEVICE_DEMAND_EXPECT_H

#include "device/demand_oracle.h"
#include "device/demand_scene.h"

#define DEMAND_EXPECT_PAGES 65536u
#define DEMAND_TAP_PAGES 16u ///< 4x4 texels; 3x3 tiles where a texture repeats
#define DEMAND_ASKED 1u
#define DEMAND_USED 2u
#define DEMAND_MARKED 4u /* used if the page has a block: a tail that is not looked up */

struct demand_expectation {
    struct demand_scene *scene;
    const struct SluiceDemandTexture
        *entry;     ///< entry of the texture, or one with other address modes
    uint32_t index; ///< texture of the tiles and texels
    double loader_bias;
    bool preview;
    double color[4], du[4], dv[4];
    bool resident;
    bool sure;  ///< true: float rounding cannot change the result
    bool jumps; ///< true: derivatives jump, so they are not certain

    struct demand_tap tap; ///< this and later fields are private
    uint32_t finest;       ///< finest level
    double sum[3][4];      ///< color and derivatives
    uint32_t worst;        ///< 0: all pages are resident, 1: one is refused, 2: one is missing
    uint32_t here[DEMAND_TAP_PAGES], here_count;
    uint32_t unsure[DEMAND_TAP_PAGES], unsure_count;
    bool ask;
    uint8_t notes[DEMAND_EXPECT_PAGES];
    uint32_t noted[4096], noted_count;
};

/** Fills in the results. If certain, adds DEMAND_ASKED, _USED and _MARKED to pages[]. */
void demand_expect(struct demand_expectation *e, const struct DemandInput *in, uint8_t *pages);

#endif /* TESTS_DEVICE_DEMAND_EXPECT_H */
