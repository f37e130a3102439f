/**
 * Compares how often a region is missed with the prediction of feedback_rate.h. Counts with the
 * shaders' selection functions, frame by frame and map by map. Counts may be 5 standard deviations
 * off, by the exact binomial tail. Seeds are fixed.
 */
#include <math.h>

#include <sluice/feedback_rate.h>

#include "support/test.h"
#include "vulkan/shader_twins.h"

#define FIVE_SIGMA 2.87e-7 /* on each side */

struct rectangle {
    uint32_t x, y, width, height;
};

/** A region on screen in pixels, and the distance of a footprint's corners from its middle. */
struct extent {
    double x0, y0, x1, y1, reach;
};

/** A still picture of one region: the pixels that touch it. */
struct picture {
    SluiceFeedbackRate rate;
    struct rectangle pixels;
    struct extent extent; ///< shared quads
    float probability;
};

/** Returns whether the corner that sluiceWriteQuadFeedback gives a pixel is in the region. */
static bool marks_by_corner(const struct extent *e, uint32_t x, uint32_t y, uint32_t seed)
{
    double corner_x = x + 0.5 + ((x ^ seed) & 1 ? e->reach : -e->reach);
    double corner_y = y + 0.5 + ((y ^ seed >> 1) & 1 ? e->reach : -e->reach);
    return corner_x >= e->x0 && corner_x < e->x1 && corner_y >= e->y0 && corner_y < e->y1;
}

static bool touches(const struct picture *p, uint32_t x, uint32_t y, uint32_t frame)
{
    return p->rate.selection != SLUICE_FEEDBACK_SELECTION_SHARED_QUADS ||
           marks_by_corner(&p->extent, x, y, frame);
}

static bool selects(const struct picture *p, uint32_t x, uint32_t y, uint32_t frame)
{
    switch (p->rate.selection) {
    case SLUICE_FEEDBACK_SELECTION_RANDOM_PIXELS:
        return slc_twin_select_random(x, y, frame, p->probability);
    case SLUICE_FEEDBACK_SELECTION_LATTICE: return slc_twin_select_lattice(x, y, frame);
    default: return slc_twin_select_random_quad(x, y, frame, p->probability);
    }
}

static bool frame_marks(const struct picture *p, uint32_t frame)
{
    const struct rectangle *r = &p->pixels;
    for (uint32_t y = r->y; y < r->y + r->height; y++)
        for (uint32_t x = r->x; x < r->x + r->width; x++)
            if (selects(p, x, y, frame) && touches(p, x, y, frame))
                return true;
    return false;
}

/** Returns whether all maps less than a timeout old are empty when the last one is read, at frame
 * `last`. */
static bool timeout_misses(const struct picture *p, uint32_t last, uint32_t frames)
{
    uint32_t turn = p->rate.textureCount / p->rate.texturesPerFrame;
    for (uint32_t since = 0; since < frames; since += turn) {
        uint32_t read = last - since;
        for (uint32_t age = 0; age < (p->rate.inTurns ? 1 : turn); age++)
            if (frame_marks(p, read - age))
                return false;
    }
    return true;
}

/** Counts misses over disjoint timeouts, whose beginnings meet every frame of the lattice. */
static uint32_t count_misses(const struct picture *p, uint32_t trials)
{
    uint32_t frames = (uint32_t)(p->rate.frameRate * p->rate.timeoutSeconds), misses = 0;
    uint32_t turn = p->rate.textureCount / p->rate.texturesPerFrame;
    uint32_t distance = (frames > turn ? frames : turn) | 1;
    for (uint32_t trial = 1; trial <= trials; trial++)
        misses += timeout_misses(p, trial * distance, frames);
    return misses;
}

static double chance_of_count(uint32_t n, uint32_t k, double p)
{
    if (p <= 0 || p >= 1)
        return k == (p <= 0 ? 0 : n);
    return exp(lgamma(n + 1.0) - lgamma(k + 1.0) - lgamma(n - k + 1.0) + k * log(p) +
               (n - k) * log1p(-p));
}

/** Chance of k or more (side 1) or of k or fewer (side -1) in `n` draws. */
static double tail(uint32_t n, uint32_t k, double p, int side)
{
    double sum = 0;
    for (uint32_t i = side > 0 ? k : 0; i <= (side > 0 ? n : k); i++)
        sum += chance_of_count(n, i, p);
    return sum;
}

static double predicted(const struct picture *p)
{
    double miss = -1;
    CHECK_OK(sluicePredictFeedbackMiss(&p->rate, (double)p->probability, &miss));
    return miss;
}

/** Expects the predicted number of misses, or at most that number unless `exactly`. */
static void expect_misses(const struct picture *p, uint32_t trials, bool exactly)
{
    double chance = predicted(p);
    uint32_t misses = count_misses(p, trials);
    if (tail(trials, misses, chance, 1) < FIVE_SIGMA ||
        (exactly && tail(trials, misses, chance, -1) < FIVE_SIGMA))
        fail_msg("selection %d, %ux%u at %u,%u, in turns %d of %u: %u of %u, not %g",
                 (int)p->rate.selection, (unsigned)p->pixels.width, (unsigned)p->pixels.height,
                 (unsigned)p->pixels.x, (unsigned)p->pixels.y, p->rate.inTurns,
                 (unsigned)(p->rate.textureCount / p->rate.texturesPerFrame), (unsigned)misses,
                 (unsigned)trials, chance);
}

/* 60 frames per second, a timeout of one second. */
static struct picture picture_of(SluiceFeedbackSelection selection, struct rectangle pixels,
                                 uint32_t turn, bool in_turns)
{
    return (struct picture){.rate = {.structSize = sizeof(SluiceFeedbackRate),
                                     .selection = selection,
                                     .regionWidth = pixels.width,
                                     .regionHeight = pixels.height,
                                     .textureCount = turn,
                                     .texturesPerFrame = 1,
                                     .inTurns = in_turns,
                                     .frameRate = 60,
                                     .timeoutSeconds = 1},
                            .pixels = pixels};
}

/** Sets the probability chosen for an allowed chance of misses. Returns false if none suffices. */
static bool choose(struct picture *p, double allowed)
{
    SluiceResult result = sluiceChooseFeedbackProbability(&p->rate, allowed, &p->probability);
    if (result != SLUICE_ERROR_LIMIT_EXCEEDED)
        CHECK_OK(result);
    return result == SLUICE_SUCCESS;
}

static const uint32_t sides[] = {1, 2, 3, 8, 15, 64};
enum { SIDES = sizeof sides / sizeof *sides };
static const uint32_t turns[] = {1, 10};

/* Pixels and quads that begin at the region's border: the prediction is exact. */
static void check_random(SluiceFeedbackSelection selection, double allowed)
{
    for (uint32_t side = 0; side < SIDES; side++)
        for (uint32_t i = 0; i < 4; i++) {
            struct rectangle pixels = {640, 358, sides[side], sides[side]};
            struct picture p = picture_of(selection, pixels, turns[i / 2], i % 2);
            assert_true(choose(&p, allowed));
            expect_misses(&p, sides[side] > 16 ? 400 : 3000, true);
        }
}

static void random_pixels_miss_as_often_as_predicted(void **state)
{
    (void)state;
    check_random(SLUICE_FEEDBACK_SELECTION_RANDOM_PIXELS, 0.3);
    check_random(SLUICE_FEEDBACK_SELECTION_RANDOM_PIXELS, 0.01);
}

static void random_quads_miss_as_often_as_predicted(void **state)
{
    (void)state;
    check_random(SLUICE_FEEDBACK_SELECTION_RANDOM_QUADS, 0.3);
    check_random(SLUICE_FEEDBACK_SELECTION_RANDOM_QUADS, 0.01);
}

static void quads_that_lie_across_a_region_miss_it_no_more_often(void **state)
{
    (void)state;
    for (uint32_t side = 0; side + 1 < SIDES; side++)
        for (uint32_t place = 1; place < 4; place++) {
            struct rectangle pixels = {640 + place % 2, 358 + place / 2, sides[side], sides[side]};
            struct picture p =
                picture_of(SLUICE_FEEDBACK_SELECTION_RANDOM_QUADS, pixels, 10, false);
            assert_true(choose(&p, 0.1));
            expect_misses(&p, 2000, false);
        }
}

/** A region reached only by the lower right corner of one pixel of a quad. */
static struct picture picture_of_corner(uint32_t place, uint32_t turn, bool in_turns)
{
    struct rectangle pixel = {640 + place % 2, 358 + place / 2, 1, 1};
    struct picture p = picture_of(SLUICE_FEEDBACK_SELECTION_SHARED_QUADS, pixel, turn, in_turns);
    p.extent = (struct extent){pixel.x + 0.75, pixel.y + 0.75, 9999, 9999, 0.5};
    return p;
}

static void one_corner_of_one_pixel_is_missed_as_often_as_predicted(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 4; i++)
        for (uint32_t place = 0; place < 4; place++) {
            struct picture p = picture_of_corner(place, i / 2 ? 3 : 1, i % 2);
            assert_true(choose(&p, 0.3));
            expect_misses(&p, 3000, true);
        }
}

static void corners_are_never_marked_where_turns_are_an_even_number_apart(void **state)
{
    (void)state;
    uint32_t never = 0;
    for (uint32_t place = 0; place < 4; place++) {
        struct picture p = picture_of_corner(place, 4, true);
        uint32_t hits = 0;
        p.probability = 1;
        for (uint32_t frame = 0; frame < 4000; frame += 4)
            hits += frame_marks(&p, frame);
        never += hits == 0;
    }
    assert_int_equal(never, 3);
}

static double draw_between(double least, double greatest)
{
    static uint32_t drawn;
    drawn++;
    return least + (greatest - least) * (slc_twin_hash(drawn, 7, 11) >> 8) / 16777216.0;
}

/** Places a region of that size so that it touches `count` pixels from `first` on. Some are
 * hidden. */
static void draw_axis(double size, double reach, uint32_t *first, uint32_t *count, double *x0)
{
    *x0 = draw_between(64, 66);
    double least = ceil(*x0 - reach - 0.5), greatest = ceil(*x0 + size + reach - 0.5) - 1;
    least = fmin(least + floor(draw_between(0, 2.5)), greatest);
    greatest = fmax(greatest - floor(draw_between(0, 2.5)), least);
    *first = (uint32_t)least;
    *count = (uint32_t)(greatest - least) + 1;
}

/** A region at least as large as the footprints, marked by their corners. */
static struct picture draw_picture(double greatest)
{
    struct extent e = {.reach = draw_between(0.5, 1.2)};
    double width = draw_between(2 * e.reach, greatest),
           height = draw_between(2 * e.reach, greatest);
    struct rectangle pixels;
    draw_axis(width, e.reach, &pixels.x, &pixels.width, &e.x0);
    draw_axis(height, e.reach, &pixels.y, &pixels.height, &e.y0);
    e.x1 = e.x0 + width;
    e.y1 = e.y0 + height;
    struct picture p = picture_of(SLUICE_FEEDBACK_SELECTION_SHARED_QUADS, pixels, 1, false);
    p.extent = e;
    return p;
}

/** Counts quads that mark the region if they are selected in that frame. */
static uint32_t count_quads(const struct picture *p, uint32_t frame)
{
    const struct rectangle *r = &p->pixels;
    uint32_t quads = 0;
    for (uint32_t y = r->y / 2; y <= (r->y + r->height - 1) / 2; y++)
        for (uint32_t x = r->x / 2; x <= (r->x + r->width - 1) / 2; x++) {
            bool marks = false;
            for (uint32_t i = 0; i < 4; i++) {
                uint32_t px = 2 * x + i % 2, py = 2 * y + i / 2;
                marks |= px - r->x < r->width && py - r->y < r->height && /* unsigned */
                         marks_by_corner(&p->extent, px, py, frame);
            }
            quads += marks;
        }
    return quads;
}

/** Number of quads promised over four frames, from the prediction: at p = 1/2 each quad halves the
 * chance. */
static uint32_t promised_quads(struct picture *p)
{
    p->rate.timeoutSeconds = 4 / p->rate.frameRate;
    p->probability = 0.5f;
    return (uint32_t)lround(-log2(predicted(p)));
}

/* In the worst case there are no more quads than promised, so the promise is tight. */
static void promised_quads_mark_wherever_corners_lie(void **state)
{
    (void)state;
    uint32_t small = 0, large = 0;
    for (uint32_t i = 0; i < 100000; i++) {
        struct picture p = draw_picture(6);
        uint32_t promised = promised_quads(&p), sum = 0, least = UINT32_MAX;
        for (uint32_t frame = 0; frame < 4; frame++) {
            uint32_t quads = count_quads(&p, frame);
            sum += quads;
            least = quads < least ? quads : least;
        }
        bool always = p.pixels.width > 2 && p.pixels.height > 2;
        assert_true(always ? 4 * least >= promised : sum >= promised);
        large += always && 4 * least == promised;
        small += !always && sum == promised;
    }
    print_message("# as few as promised: %u small, %u large\n", (unsigned)small, (unsigned)large);
    assert_true(small > 100 && large > 100);
}

static void shared_corners_miss_no_more_often_than_predicted(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 200; i++) {
        struct picture p = draw_picture(i % 8 ? 12 : 64);
        p.rate.textureCount = i % 3 ? 11 : 1; /* odd */
        p.rate.inTurns = i % 3 == 2;
        if (choose(&p, 0.1))
            expect_misses(&p, 500, false);
    }
}

/* Deterministic: tries all first frames, and takes the worst of 64 positions. */
static double worst_lattice_miss(struct picture *p)
{
    uint32_t worst = 0;
    for (uint32_t place = 0; place < 64; place++) {
        p->pixels.x = 640 + place % 8;
        p->pixels.y = 360 + place / 8;
        uint32_t misses = 0;
        for (uint32_t first = 0; first < 64; first++)
            misses += timeout_misses(p, 6400 + first, 60);
        worst = misses > worst ? misses : worst;
    }
    return worst / 64.0;
}

/* If turns do not divide the timeout, some timeouts have one more turn than predicted. */
static void lattice_misses_exactly_as_often_as_predicted(void **state)
{
    (void)state;
    const uint32_t distances[] = {1, 2, 7, 10, 16, 60};
    for (uint32_t width = 1; width <= 9; width += width < 4 ? 1 : 2)
        for (uint32_t height = 1; height <= 9; height += height < 4 ? 1 : 3)
            for (uint32_t i = 0; i < 12; i++) {
                struct rectangle pixels = {0, 0, width, height};
                struct picture p =
                    picture_of(SLUICE_FEEDBACK_SELECTION_LATTICE, pixels, distances[i / 2], i % 2);
                double miss = worst_lattice_miss(&p);
                assert_true(60 % distances[i / 2] ? miss <= predicted(&p) : miss == predicted(&p));
            }
}

/* Half of the regions are marked within the median, and fewer one frame earlier. Likewise for 99 of
 * 100. */
static void check_quantile(struct picture *p, double frames, double share)
{
    uint32_t trials = 4000, within = 0, before = 0, n = (uint32_t)frames;
    for (uint32_t trial = 1; trial <= trials; trial++) {
        uint32_t age = 1;
        while (age <= n && !frame_marks(p, trial * (n + 1) + age))
            age++;
        within += age <= n;
        before += age < n;
    }
    assert_true(tail(trials, within, share, -1) > FIVE_SIGMA);
    assert_true(tail(trials, before, share, 1) > FIVE_SIGMA);
}

static void delays_are_exceeded_as_often_as_predicted(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 6; i++) {
        uint32_t side = sides[i % 3 + 1];
        struct rectangle pixels = {640, 358, side, side};
        struct picture p = picture_of((SluiceFeedbackSelection)(i / 3), pixels, 1, false);
        SluiceFeedbackDelay delay = {.structSize = sizeof delay};
        p.probability = 0.01f;
        CHECK_OK(sluicePredictFeedbackDelay(&p.rate, 0.01f, &delay));
        check_quantile(&p, delay.median, 0.5);
        check_quantile(&p, delay.percentile99, 0.99);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_pixels_miss_as_often_as_predicted),
        cmocka_unit_test(random_quads_miss_as_often_as_predicted),
        cmocka_unit_test(quads_that_lie_across_a_region_miss_it_no_more_often),
        cmocka_unit_test(one_corner_of_one_pixel_is_missed_as_often_as_predicted),
        cmocka_unit_test(shared_corners_miss_no_more_often_than_predicted),
        cmocka_unit_test(promised_quads_mark_wherever_corners_lie),
        cmocka_unit_test(corners_are_never_marked_where_turns_are_an_even_number_apart),
        cmocka_unit_test(lattice_misses_exactly_as_often_as_predicted),
        cmocka_unit_test(delays_are_exceeded_as_often_as_predicted),
    };
    return RUN_TESTS(tests);
}
