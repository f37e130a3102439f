/* Samples per second with everything resident, compared with textureGrad of ordinary images. */
#include "rig.h"

#define LAUNCHES 40u
#define TURNS 8u /* turns of each, alternating, because clocks drift */

static bool add_times(struct rig *rig, uint32_t kind, struct samples *samples)
{
    for (uint32_t i = 0; i < repetitions(LAUNCHES); i++) {
        struct rig_outcome outcome;
        if (!rig_launch(rig, kind, &outcome))
            return false;
        if (i > 0) /* the first one is cold */
            samples_add(samples, outcome.gpu_seconds * 1e9);
    }
    return true;
}

static bool measure(const struct bench *bench, bool tracking, uint32_t kind, double *plain,
                    double *sampled)
{
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .noEviction = !tracking};
    struct rig rig;
    struct samples times[2];
    samples_init(&times[0], LAUNCHES * TURNS);
    samples_init(&times[1], LAUNCHES * TURNS);
    bool done = rig_create(&rig, bench, &info, true) && rig_load(&rig, 1000) > 0;
    rig.timed = true;
    for (uint32_t i = 0; done && i < repetitions(TURNS); i++)
        done = add_times(&rig, DEMAND_BENCH_PLAIN, &times[0]) && add_times(&rig, kind, &times[1]);
    double share = bench->wall ? 0.0 : 0.5; /* disturbances only lengthen wall times */
    if (done) {
        *plain = samples_quantile(&times[0], share);
        *sampled = samples_quantile(&times[1], share);
    }
    samples_finish(&times[0]);
    samples_finish(&times[1]);
    rig_destroy(&rig);
    return done;
}

/* No sample is magnified, so smart filters are trilinear. */
static bool measure_filters(const struct bench *bench)
{
    static const struct {
        const char *name;
        SluiceDemandFilter filter;
        uint32_t kind;
    } variants[] = {
        {"sampling.linear_of_cubic", SLUICE_DEMAND_FILTER_LINEAR, DEMAND_BENCH_CUBIC},
        {"sampling.smart", SLUICE_DEMAND_FILTER_SMART_CUBIC, DEMAND_BENCH_CUBIC},
        {"sampling.cubic", SLUICE_DEMAND_FILTER_CUBIC, DEMAND_BENCH_CUBIC},
        {"sampling.linear_slopes", SLUICE_DEMAND_FILTER_LINEAR, DEMAND_BENCH_SLOPES},
        {"sampling.cubic_slopes", SLUICE_DEMAND_FILTER_CUBIC, DEMAND_BENCH_SLOPES},
    };
    for (uint32_t i = 0; i < sizeof variants / sizeof *variants; i++) {
        struct bench filtered = *bench;
        double plain, sampled;
        filtered.filter = variants[i].filter;
        if (!measure(&filtered, false, variants[i].kind, &plain, &sampled))
            return false;
        figure(variants[i].name, "of_plain", plain / sampled, "of textureGrad");
    }
    return true;
}

bool measure_sampling(const struct bench *bench)
{
    double count = (double)bench->edge * bench->edge; /* per ns: G/s */
    static const char *const names[2] = {"sampling.untracked", "sampling.tracked"};
    for (int tracking = 0; tracking < 2; tracking++) {
        double plain, sampled;
        if (!measure(bench, tracking, DEMAND_BENCH_SAMPLED, &plain, &sampled))
            return false;
        figure(names[tracking], "rate", count / sampled, "Gsamples/s");
        figure(names[tracking], "of_plain", plain / sampled, "of textureGrad");
        if (!tracking)
            figure("sampling.plain", "rate", count / plain, "Gsamples/s");
    }
    return measure_filters(bench);
}
