/* GDeflate against an encoder that writes the same bits the long way round, alone and in sets. */
#include "base/little_endian.h"
#include "neural/gdeflate.h"
#include "neural/made_file.h"
#include "neural/neural_files.h"
#include "neural/neural_set.h"
#include "support/failing_allocator.h"
#include "support/roll.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* Bits of 32 lanes. Words lie in the order in which a decoder asks for them, so the encoder keeps
 * what each lane has and counts as a decoder does. */
struct encoder {
    uint8_t bits[32][1 << 20 >> 3];
    uint32_t written[32]; /* bits put into a lane */
    uint32_t lane;
    uint8_t asked[1 << 17]; /* lanes, in the order in which words are asked for */
    uint32_t asked_count;
    uint32_t loaded[32]; /* bits that the decoder has loaded */
};

static void ask(struct encoder *e)
{
    if (e->loaded[e->lane] - e->written[e->lane] >= 32)
        return;
    e->asked[e->asked_count++] = (uint8_t)e->lane;
    e->loaded[e->lane] += 32;
}

static void step(struct encoder *e)
{
    ask(e);
    e->lane = (e->lane + 1) % 32;
}

static void put(struct encoder *e, uint32_t value, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t bit = e->written[e->lane]++;
        e->bits[e->lane][bit / 8] |= (uint8_t)((value >> i & 1) << bit % 8);
    }
}

/* Huffman codes begin with their highest bit. */
static void put_code(struct encoder *e, uint32_t code, uint32_t count)
{
    for (uint32_t i = count; i-- > 0;)
        put(e, code >> i & 1, 1);
}

static void begin_block(struct encoder *e, bool is_last, uint32_t type)
{
    e->lane = 0;
    put(e, is_last, 1);
    put(e, type, 2);
    ask(e);
}

static struct encoder *new_encoder(void)
{
    struct encoder *e = calloc(1, sizeof *e);
    assert_non_null(e);
    for (uint32_t i = 0; i < 32; i++)
        step(e);
    return e;
}

static size_t finish(struct encoder *e, uint8_t *out)
{
    uint32_t taken[32] = {0};
    for (uint32_t i = 0; i < e->asked_count; i++) {
        uint32_t lane = e->asked[i];
        memcpy(out + 4 * i, e->bits[lane] + taken[lane], 4);
        taken[lane] += 4;
    }
    size_t size = 4 * (size_t)e->asked_count;
    free(e);
    return size;
}

/* A literal, or a copy. */
struct token {
    uint32_t literal, length, distance; /* length 0: a literal */
};

static void put_fixed(struct encoder *e, uint32_t symbol)
{
    if (symbol < 144)
        put_code(e, 0x30 + symbol, 8);
    else if (symbol < 256)
        put_code(e, 0x190 + symbol - 144, 9);
    else if (symbol < 280)
        put_code(e, symbol - 256, 7);
    else
        put_code(e, 0xC0 + symbol - 280, 8);
}

/* The dynamic block's codes: 9 bits for every literal and length, 5 for every distance. */
static void put_symbol(struct encoder *e, uint32_t symbol, bool is_dynamic)
{
    if (is_dynamic)
        put_code(e, symbol, 9);
    else
        put_fixed(e, symbol);
}

static void put_length(struct encoder *e, uint32_t length, bool is_dynamic)
{
    if (length > 257) { /* symbol 285 of DEFLATE64 */
        put_symbol(e, 285, is_dynamic);
        put(e, length - 3, 16);
        return;
    }
    uint32_t base = 3, extra = 0, symbol = 257;
    for (; symbol < 284 && length >= base + (1u << extra); symbol++) {
        base += 1u << extra;
        extra = symbol + 1 < 265 ? 0 : (symbol + 1 - 261) / 4;
    }
    put_symbol(e, symbol, is_dynamic);
    put(e, length - base, extra);
}

static void put_distance(struct encoder *e, uint32_t distance)
{
    uint32_t base = 1, extra = 0, symbol = 0;
    for (; symbol < 31 && distance >= base + (1u << extra); symbol++) {
        base += 1u << extra;
        extra = symbol + 1 < 4 ? 0 : (symbol + 1) / 2 - 1;
    }
    put_code(e, symbol, 5);
    put(e, distance - base, extra);
}

/* All codes of 9 bits but 2 (incomplete is no matter), all distances of 5 bits. */
static void put_dynamic_header(struct encoder *e)
{
    static const uint8_t ORDER[19] = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                      11, 4,  12, 3, 13, 2, 14, 1, 15};
    put(e, 286 - 257, 5);
    put(e, 31, 5);
    put(e, 15, 4);
    ask(e);
    for (int i = 0; i < 19; i++, step(e)) /* symbols 5, 9 and 16 have codes of 2 bits */
        put(e, ORDER[i] == 5 || ORDER[i] == 9 || ORDER[i] == 16 ? 2 : 0, 3);
    e->lane = 0;
    for (uint32_t i = 0; i < 286 + 32;) {
        bool repeats = i > 0 && i != 286 && (i < 286 ? 286 : 318) - i >= 6;
        if (repeats) {
            put_code(e, 2, 2);
            put(e, 3, 2);
        } else {
            put_code(e, i < 286 ? 1 : 0, 2);
        }
        i += repeats ? 6 : 1;
        step(e);
    }
    e->lane = 0;
}

/* A copy's distance follows when its lane comes around again. */
static void put_tokens(struct encoder *e, const struct token *tokens, size_t count, bool is_dynamic)
{
    uint32_t waiting[32] = {0};
    for (size_t i = 0; i < count; step(e)) {
        if (waiting[e->lane]) {
            put_distance(e, waiting[e->lane]);
            waiting[e->lane] = 0;
            continue;
        }
        const struct token *t = &tokens[i++];
        if (t->length)
            put_length(e, t->length, is_dynamic);
        else
            put_symbol(e, t->literal, is_dynamic);
        waiting[e->lane] = t->length ? t->distance : 0;
    }
    while (waiting[e->lane]) { /* the end of the block is a symbol, too */
        put_distance(e, waiting[e->lane]);
        waiting[e->lane] = 0;
        step(e);
    }
    put_symbol(e, 256, is_dynamic);
    for (int i = 0; i < 32; i++, step(e))
        if (waiting[e->lane])
            put_distance(e, waiting[e->lane]);
}

static void put_stored(struct encoder *e, const uint8_t *bytes, uint32_t size)
{
    put(e, size, 16);
    for (uint32_t i = 0; i < size; i++, step(e))
        put(e, bytes[i], 8);
    for (int i = 0; i < 32; i++)
        step(e);
}

/* Rolls tokens that make `size` bytes, and the bytes. */
static size_t roll_tokens(struct token *tokens, uint8_t *bytes, size_t from, size_t size)
{
    size_t count = 0, at = from;
    while (at < from + size) {
        size_t left = from + size - at;
        struct token t = {.literal = (uint32_t)roll() % 256};
        if (at > 0 && left >= 3 && roll() % 3 == 0) {
            t.length = 3 + (uint32_t)roll() % (roll() % 50 ? 40 : 4000);
            t.length = t.length > left ? (uint32_t)left : t.length;
            t.distance = 1 + (uint32_t)roll() % (uint32_t)at;
            for (uint32_t i = 0; i < t.length; i++)
                bytes[at + i] = bytes[at + i - t.distance];
        } else {
            bytes[at] = (uint8_t)t.literal;
        }
        at += t.length ? t.length : 1;
        tokens[count++] = t;
    }
    return count;
}

/* `size` bytes in three blocks of all kinds. */
static size_t encode(uint8_t *bytes, size_t size, uint8_t *out)
{
    struct encoder *e = new_encoder();
    struct token *tokens = calloc(size + 1, sizeof *tokens);
    assert_non_null(tokens);
    size_t part = size / 3, stored = part < 60000 ? part : 60000;
    size_t count = roll_tokens(tokens, bytes, 0, part);
    begin_block(e, false, 1);
    e->lane = 0;
    put_tokens(e, tokens, count, false);
    for (size_t i = 0; i < stored; i++)
        bytes[part + i] = (uint8_t)roll();
    begin_block(e, false, 0);
    put_stored(e, bytes + part, (uint32_t)stored);
    count = roll_tokens(tokens, bytes, part + stored, size - part - stored);
    begin_block(e, true, 2);
    put_dynamic_header(e);
    put_tokens(e, tokens, count, true);
    free(tokens);
    return finish(e, out);
}

static void tiles_of_all_kinds_of_blocks_inflate(void **state)
{
    static const size_t SIZES[] = {0, 1, 2, 3, 31, 32, 33, 100, 1000, 4097, 65536};
    uint8_t *bytes = malloc(65536), *again = malloc(65536), *stream = malloc(1 << 19);
    (void)state;
    roll_seed(3);
    for (size_t i = 0; i < sizeof SIZES / sizeof *SIZES; i++)
        for (int n = 0; n < 5; n++) {
            size_t size = encode(bytes, SIZES[i], stream);
            memset(again, 0xA5, 65536);
            assert_true(slc_gdeflate_inflate(stream, size, again, SIZES[i]));
            assert_memory_equal(bytes, again, SIZES[i]);
            if (SIZES[i])
                assert_false(slc_gdeflate_inflate(stream, size, again, SIZES[i] - 1));
            assert_false(slc_gdeflate_inflate(stream, 16, again, SIZES[i] + 1));
        }
    free(bytes);
    free(again);
    free(stream);
}

static void damaged_streams_end(void **state)
{
    uint8_t bytes[1000], again[1000], *stream = malloc(1 << 16);
    (void)state;
    roll_seed(4);
    for (int n = 0; n < 2000; n++) {
        size_t size = encode(bytes, sizeof bytes, stream);
        for (int i = 1 + roll() % 3; i > 0; i--)
            stream[(size_t)roll() % size] ^= (uint8_t)(1 << roll() % 8);
        (void)slc_gdeflate_inflate(stream, (size_t)roll() % (size + 1), again, sizeof again);
    }
    memset(stream, 0, 1 << 16); /* empty stored blocks for ever */
    assert_false(slc_gdeflate_inflate(stream, 1 << 16, again, sizeof again));
    free(stream);
}

/* Appends a part of a grid as a stream of stored blocks, and lets the set read that. */
static void compress_part(struct slc_neural_view *view, struct made_file *file)
{
    const uint64_t size = view->stored_size;
    const uint32_t count = (uint32_t)((size + SLC_GDEFLATE_TILE - 1) / SLC_GDEFLATE_TILE);
    file->bytes = realloc(file->bytes, file->size + 2 * (size_t)size + 4096);
    assert_non_null(file->bytes);
    uint8_t *begin = file->bytes + file->size, *table = begin + 8, *tiles = table + 4 * count,
            *to = tiles;
    memcpy(begin, (uint8_t[4]){4, 0xFB, (uint8_t)count, (uint8_t)(count >> 8)}, 4);
    slc_put_u32(begin + 4, 1 | (uint32_t)(size % SLC_GDEFLATE_TILE) << 2);
    for (uint32_t t = 0; t < count; t++) {
        const uint64_t left = size - (uint64_t)t * SLC_GDEFLATE_TILE;
        const uint32_t part = (uint32_t)(left < SLC_GDEFLATE_TILE ? left : SLC_GDEFLATE_TILE);
        const uint8_t *from = file->bytes + view->offset + (size_t)t * SLC_GDEFLATE_TILE;
        struct encoder *e = new_encoder();
        begin_block(e, false, 0);
        put_stored(e, from, part / 2);
        begin_block(e, true, 0);
        put_stored(e, from + part / 2, part - part / 2);
        slc_put_u32(table + 4 * t, (uint32_t)(to - tiles));
        to += finish(e, to);
    }
    *view = (struct slc_neural_view){.offset = file->size,
                                     .stored_size = (uint64_t)(to - begin),
                                     .size = size,
                                     .is_compressed = true,
                                     .crc = view->crc};
    file->size += view->stored_size;
}

/* The largest allocation since it was zeroed. */
static void *allocate_noting(void *user, size_t size, size_t alignment)
{
    size_t *largest = user;
    *largest = size > *largest ? size : *largest;
    (void)alignment;
    return malloc(size);
}

static void free_noting(void *user, void *memory, size_t size)
{
    (void)user, (void)size;
    free(memory);
}

/* A set whose latents take a tile per 512 rows of texels and part; part 1 of each grid is
 * compressed. */
struct compressed {
    struct made_file file;
    SluiceNeuralSet *set, *plain;
    size_t largest;
};

static void open_compressed(struct compressed *c, uint32_t height)
{
    const struct made_shape shape = {3, 1024, height, 4, 8, 0, 0, 0, SLUICE_NEURAL_NETWORK_SCHEMA3};
    struct made_parts parts;
    const SluiceAllocationCallbacks noting = {&c->largest, allocate_noting, free_noting};
    *c = (struct compressed){0};
    make_parts(&parts, &shape, 5);
    CHECK_OK(write_made_file(&parts, &c->file));
    free_made_parts(&parts);
    CHECK_OK(open_neural_bytes(c->file.bytes, c->file.size, &noting, &c->set));
    for (uint32_t g = 0; g < c->set->grid_count; g++)
        compress_part(&c->set->grids[g].parts[1], &c->file);
    c->set->file.input.pBytes = c->file.bytes;
    c->set->file.size = c->set->file.input.size = c->file.size;
    CHECK_OK(open_neural_bytes(c->file.bytes, c->file.size, NULL, &c->plain));
}

static void close_compressed(struct compressed *c)
{
    sluiceDestroyNeuralSet(c->set);
    sluiceDestroyNeuralSet(c->plain);
    free(c->file.bytes);
}

static void slices_of_compressed_latents_are_those_of_plain_ones(void **state)
{
    /* all, a column, a rectangle that ends at the edge */
    static const SluiceNeuralRequest requests[] = {
        {0, 0, 0, 0, 0, 0},
        {.x = 500, .width = 8, .height = 1024},
        {.x = 900, .y = 700, .width = 124, .height = 324}};
    struct compressed c;
    (void)state;
    open_compressed(&c, 1024);
    assert_true(c.set->grids[0].parts[1].size > SLC_GDEFLATE_TILE);
    for (size_t i = 0; i < sizeof requests / sizeof *requests; i++) {
        SluiceNeuralConstants constants;
        uint64_t size = 0;
        CHECK_OK(sluiceReadNeuralLatents(c.plain, &requests[i], &constants, &size, NULL));
        uint8_t *plain = malloc(size), *got = malloc(size);
        assert_true(plain && got);
        CHECK_OK(sluiceReadNeuralLatents(c.plain, &requests[i], &constants, &size, plain));
        CHECK_OK(sluiceReadNeuralLatents(c.set, &requests[i], &constants, &size, got));
        assert_memory_equal(plain, got, size);
        free(plain);
        free(got);
    }
    close_compressed(&c);
}

static void columns_of_compressed_latents_take_memory_of_a_tile(void **state)
{
    const SluiceNeuralRequest column = {.x = 500, .width = 8, .height = 4096};
    struct compressed c;
    SluiceNeuralConstants constants;
    uint64_t size = 1 << 20;
    uint8_t *bytes = malloc(size);
    (void)state;
    assert_non_null(bytes);
    open_compressed(&c, 4096);
    c.largest = 0;
    assert_true(c.set->grids[0].parts[1].size > 6 * SLC_GDEFLATE_TILE);
    CHECK_OK(sluiceReadNeuralLatents(c.set, &column, &constants, &size, bytes));
    assert_in_range(c.largest, SLC_GDEFLATE_TILE, 3 * SLC_GDEFLATE_TILE);
    free(bytes);
    close_compressed(&c);
}

static void checksums_are_compared_where_any_part_is_compressed(void **state)
{
    const SluiceNeuralRequest request = {.x = 16, .y = 16, .width = 8, .height = 8};
    struct compressed c;
    SluiceNeuralConstants constants;
    uint64_t size = 1 << 20;
    uint8_t *bytes = malloc(size);
    (void)state;
    assert_non_null(bytes);
    open_compressed(&c, 1024);
    c.set->grids[0].parts[1].crc ^= 1;
    CHECK_RESULT(sluiceReadNeuralLatents(c.set, &request, &constants, &size, bytes),
                 SLUICE_ERROR_CORRUPT_DATA);
    free(bytes);
    close_compressed(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_of_all_kinds_of_blocks_inflate),
        cmocka_unit_test(damaged_streams_end),
        cmocka_unit_test(slices_of_compressed_latents_are_those_of_plain_ones),
        cmocka_unit_test(columns_of_compressed_latents_take_memory_of_a_tile),
        cmocka_unit_test(checksums_are_compared_where_any_part_is_compressed),
    };
    return RUN_TESTS(tests);
}
