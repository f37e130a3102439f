/** What a sample of a demand scene must give, with the pages that are resident there. */
#ifndef TESTS_DEVICE_DEMAND_EXPECT_H
#define TESTS_DEVICE_DEMAND_EXPECT_H

#include "device/demand_oracle.h"
#include "device/demand_scene.h"

#define DEMAND_EXPECT_PAGES 65536u
#define DEMAND_TAP_PAGES 16u ///< 4x4 texels; 3x3 tiles where a texture repeats
#define DEMAND_ASKED 1u
#define DEMAND_USED 2u
#define DEMAND_MARKED 4u /* as used, if the page has a block: a tail that is not looked up */

struct demand_expectation {
    struct demand_scene *scene;
    const struct SluiceDemandTexture *entry; ///< of the texture, or one with other address modes
    uint32_t index;                          ///< whose tiles and texels they are
    double loader_bias;
    bool preview;
    double color[4], du[4], dv[4];
    bool resident;
    bool sure;  ///< float cannot come to anything else
    bool jumps; ///< derivatives do, so they are not sure

    struct demand_tap tap; ///< private, as the rest
    uint32_t finest;       ///< level
    double sum[3][4];      ///< color and derivatives
    uint32_t worst;        ///< 0: all are there, 1: one is refused, 2: one is missing
    uint32_t here[DEMAND_TAP_PAGES], here_count;
    uint32_t unsure[DEMAND_TAP_PAGES], unsure_count;
    bool ask;
    uint8_t notes[DEMAND_EXPECT_PAGES];
    uint32_t noted[4096], noted_count;
};

/** Fills in the results; and adds to pages[], if sure, DEMAND_ASKED, _USED and _MARKED. */
void demand_expect(struct demand_expectation *e, const struct DemandInput *in, uint8_t *pages);

#endif /* TESTS_DEVICE_DEMAND_EXPECT_H */
