/* lib/core/overlap.h against a comparison of every cell with every other. */
#include "core/overlap.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

static uint64_t next_random(uint64_t *seed)
{
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return *seed >> 33;
}

static uint32_t cells(uint32_t size, uint32_t cell)
{
    return (uint32_t)(((uint64_t)size + cell - 1) / cell);
}

/** [i * c, (i + 1) * c) of `size` against [j * d, (j + 1) * d) of `other`, cut off at the ends. */
static bool overlap(uint64_t i, uint64_t c, uint64_t size, uint64_t j, uint64_t d, uint64_t other)
{
    uint64_t end = (i + 1) * c < size ? (i + 1) * c : size;
    uint64_t other_end = (j + 1) * d < other ? (j + 1) * d : other;
    return i * c * other < other_end * size && j * d * size < end * other;
}

static uint8_t least_by_looking_at_all(const struct slc_grid *from, const uint8_t *values,
                                       const struct slc_grid *to, uint32_t column, uint32_t row)
{
    uint8_t least = 255;
    for (uint32_t y = 0; y < from->rows; y++)
        for (uint32_t x = 0; x < from->columns; x++)
            if (overlap(column, to->cell_width, to->width, x, from->cell_width, from->width) &&
                overlap(row, to->cell_height, to->height, y, from->cell_height, from->height) &&
                values[(size_t)y * from->columns + x] < least)
                least = values[(size_t)y * from->columns + x];
    return least;
}

static void check_pair(const struct slc_grid *from, const struct slc_grid *to, uint64_t *seed)
{
    size_t in = (size_t)from->columns * from->rows, out = (size_t)to->columns * to->rows;
    uint8_t *values = malloc(in), *least = malloc(out);
    assert_non_null(values);
    assert_non_null(least);
    for (size_t i = 0; i < in; i++)
        values[i] = (uint8_t)next_random(seed);
    slc_least_overlapped(from, values, to, least);
    for (size_t i = 0; i < out; i++)
        assert_int_equal(least[i],
                         least_by_looking_at_all(from, values, to, (uint32_t)(i % to->columns),
                                                 (uint32_t)(i / to->columns)));
    free(values);
    free(least);
}

static struct slc_grid random_grid(uint64_t *seed)
{
    struct slc_grid g = {.width = 1 + (uint32_t)(next_random(seed) % 300),
                         .height = 1 + (uint32_t)(next_random(seed) % 300),
                         .cell_width = 1 + (uint32_t)(next_random(seed) % 400),
                         .cell_height = 1 + (uint32_t)(next_random(seed) % 400)};
    while (cells(g.width, g.cell_width) > 24)
        g.cell_width *= 2;
    while (cells(g.height, g.cell_height) > 24)
        g.cell_height *= 2;
    g.columns = cells(g.width, g.cell_width);
    g.rows = cells(g.height, g.cell_height);
    return g;
}

static void random_grids_match_a_look_at_all_cells(void **state)
{
    (void)state;
    uint64_t seed = 7;
    for (int i = 0; i < 400; i++) {
        struct slc_grid from = random_grid(&seed), to = random_grid(&seed);
        check_pair(&from, &to, &seed);
        check_pair(&from, &from, &seed);
    }
}

static void the_largest_sizes_do_not_overflow(void **state)
{
    (void)state;
    const uint32_t most = 1u << 20;
    const uint32_t sizes[] = {1, 2, 3, most - 1, most};
    const uint32_t cell_sizes[] = {1u << 17, (1u << 17) + 1, most, UINT32_MAX};
    uint64_t seed = 9;
    for (size_t a = 0; a < 5; a++)
        for (size_t b = 0; b < 5; b++)
            for (size_t c = 0; c < 16; c++) {
                struct slc_grid from = {sizes[a],          sizes[b], cell_sizes[c % 4],
                                        cell_sizes[c / 4], 0,        0};
                struct slc_grid to = {sizes[b],          sizes[a], cell_sizes[c / 4],
                                      cell_sizes[c % 4], 0,        0};
                from.columns = cells(from.width, from.cell_width);
                from.rows = cells(from.height, from.cell_height);
                to.columns = cells(to.width, to.cell_width);
                to.rows = cells(to.height, to.cell_height);
                check_pair(&from, &to, &seed);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_grids_match_a_look_at_all_cells),
        cmocka_unit_test(the_largest_sizes_do_not_overflow),
    };
    return RUN_TESTS(tests);
}
