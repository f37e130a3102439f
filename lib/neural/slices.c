#include "neural/slices.h"

#include "base/checked.h"

/* One direction, x or y, of a request in one grid. */
struct axis {
    uint32_t grid;         ///< texels of the grid
    uint32_t origin, size; ///< range of the request, in texels of its first mip
    uint32_t first_size;   ///< texels of the first mip
    uint32_t last_size;    ///< texels of the coarsest mip of the request that uses the grid
    uint32_t last_step;    ///< levels from the first mip to the coarsest
};

/* Range of grid texels first..last; may extend beyond the grid. */
struct range {
    int32_t first, last;
};

static int64_t floor_div(int64_t a, int64_t b)
{
    return a / b - (a % b < 0);
}

static struct range unite(struct range a, struct range b)
{
    return (struct range){a.first < b.first ? a.first : b.first, a.last > b.last ? a.last : b.last};
}

/*
 * Returns the grid texels for the coarsest mip's texels from edge to edge, which cover all finer
 * fused mips. Schema 1 computes in float and truncates, like compressors of version 0.7.
 */
static struct range edge_range(const struct axis *a, bool is_clamped)
{
    uint32_t first = a->origin >> a->last_step;
    uint32_t end =
        (uint32_t)(((uint64_t)a->origin + a->size + (1u << a->last_step) - 1) >> a->last_step);
    int64_t grid = a->grid, size = a->last_size;
    if (is_clamped) {
        float scale = (float)a->grid;
        return (struct range){(int32_t)((float)first / (float)a->last_size * scale - 0.5f),
                              (int32_t)((float)end / (float)a->last_size * scale - 0.5f) + 1};
    }
    return (struct range){(int32_t)floor_div(2 * (int64_t)first * grid - size, 2 * size),
                          (int32_t)floor_div(2 * (int64_t)end * grid - size, 2 * size) + 1};
}

/*
 * Finds the grid texels for a mip `step` levels coarser than the first. With sizes other than
 * powers of two, texel x of the first mip may not lie over texel x >> step.
 */
static struct range texel_range(const struct axis *a, uint32_t mip_size, uint32_t step)
{
    uint64_t end = (uint64_t)a->origin + a->size;
    uint32_t over_first = (uint32_t)((uint64_t)a->origin * mip_size / a->first_size);
    uint32_t over_last = (uint32_t)((end * mip_size + a->first_size - 1) / a->first_size) - 1;
    uint32_t first = slc_min_u32(a->origin >> step, over_first);
    uint32_t last = slc_max_u32((uint32_t)((end - 1) >> step), over_last);
    last = slc_min_u32(last, mip_size - 1);
    first = slc_min_u32(first, last);
    return (struct range){slc_neural_corner(slc_neural_place(first, a->grid, mip_size)),
                          slc_neural_corner(slc_neural_place(last, a->grid, mip_size)) + 1};
}

struct span {
    uint32_t first, count;
};

static struct span clamp_range(struct range range, uint32_t grid)
{
    int32_t first = range.first < 0 ? 0 : range.first;
    int32_t last = range.last >= (int32_t)grid ? (int32_t)grid - 1 : range.last;
    first = first > last ? last : first;
    return (struct span){(uint32_t)first, (uint32_t)(last - first + 1)};
}

static struct span wrap_range(struct range range, uint32_t grid)
{
    int64_t count = (int64_t)range.last - range.first + 1;
    if (count >= grid)
        return (struct span){0, grid};
    return (struct span){(uint32_t)(((int64_t)range.first + 2 * (int64_t)grid) % grid),
                         (uint32_t)count};
}

/* Extends a span to pairs if elements have an odd number of nibbles, so rows begin at bytes. */
static struct span pair_up(struct span span, uint32_t grid, uint32_t bits)
{
    if (!(bits & 4))
        return span;
    uint32_t end = slc_min_u32((span.first + span.count + 1) & ~1u, grid);
    span.first &= ~1u;
    return (struct span){span.first, end - span.first};
}

/* Unit: the mips of a request that use one pair of grids. */
struct unit {
    uint32_t first_grid;
    uint32_t first, last; ///< mips
};

/* Returns the unit that begins at a mip. */
static struct unit unit_at(const SluiceNeuralSet *set, const struct slc_neural_request *request,
                           uint32_t mip)
{
    struct unit unit = {set->mips[mip].first_grid, mip, mip};
    uint32_t end = request->first_mip + request->mip_count;
    while (unit.last + 1 < end && set->mips[unit.last + 1].first_grid == unit.first_grid)
        unit.last++;
    return unit;
}

static uint32_t mip_size(const SluiceNeuralSet *set, uint32_t mip, int direction)
{
    return direction ? set->mips[mip].height : set->mips[mip].width;
}

static struct axis axis_of(const SluiceNeuralSet *set, const struct slc_neural_request *request,
                           const struct unit *unit, uint32_t grid, int direction)
{
    const struct slc_neural_grid *g = &set->grids[grid];
    return (struct axis){
        .grid = direction ? g->height : g->width,
        .origin = request->origin[direction],
        .size = request->size[direction],
        .first_size = mip_size(set, request->first_mip, direction),
        .last_size = mip_size(set, unit->last, direction),
        .last_step = unit->last - request->first_mip,
    };
}

static struct span span_of(const SluiceNeuralSet *set, const struct slc_neural_request *request,
                           const struct unit *unit, uint32_t grid, int direction)
{
    struct axis a = axis_of(set, request, unit, grid, direction);
    bool is_clamped = set->info.schema == 1;
    struct range range = edge_range(&a, is_clamped);
    for (uint32_t mip = unit->first; mip <= unit->last; mip++)
        range =
            unite(range, texel_range(&a, mip_size(set, mip, direction), mip - request->first_mip));
    return is_clamped ? clamp_range(range, a.grid) : wrap_range(range, a.grid);
}

uint64_t slc_neural_slice_bytes(uint32_t width, uint32_t height, uint32_t bits_per_texel)
{
    return ((uint64_t)width * height * bits_per_texel + 31) / 32 * 4;
}

static uint64_t make_slice(const SluiceNeuralSet *set, const struct slc_neural_request *request,
                           const struct unit *unit, uint32_t grid, uint64_t offset,
                           SluiceNeuralSlice *slice)
{
    const struct slc_neural_grid *g = &set->grids[grid];
    uint32_t bits = g->features * g->bits;
    struct span x = span_of(set, request, unit, grid, 0);
    struct span y = span_of(set, request, unit, grid, 1);
    if (set->info.schema == 1) {
        x = pair_up(x, g->width, bits);
        y = pair_up(y, g->height, x.count * bits);
    }
    *slice = (SluiceNeuralSlice){
        .dataOffset = (uint32_t)offset,
        .gridSize = g->width | g->height << 16,
        .origin = x.first | y.first << 16,
        .sliceSize = x.count | y.count << 16,
    };
    return slc_neural_slice_bytes(x.count, y.count, bits);
}

uint64_t slc_neural_make_slices(const SluiceNeuralSet *set,
                                const struct slc_neural_request *request,
                                SluiceNeuralSlice slices[SLC_NEURAL_MAX_GRIDS])
{
    uint64_t size = 0;
    uint32_t end = request->first_mip + request->mip_count;
    for (uint32_t mip = request->first_mip; mip < end;) {
        struct unit unit = unit_at(set, request, mip);
        for (uint32_t i = unit.first_grid; i < unit.first_grid + 2; i++)
            size += make_slice(set, request, &unit, i, size, &slices[i]);
        mip = unit.last + 1;
    }
    return size;
}

uint64_t slc_neural_whole_slices(const SluiceNeuralSet *set,
                                 SluiceNeuralSlice slices[SLC_NEURAL_MAX_GRIDS])
{
    uint64_t size = 0;
    for (uint32_t i = 0; i < set->grid_count; i++) {
        const struct slc_neural_grid *g = &set->grids[i];
        uint32_t texels = g->width | g->height << 16;
        slices[i] = (SluiceNeuralSlice){(uint32_t)size, texels, 0, texels};
        size += slc_neural_slice_bytes(g->width, g->height, g->features * g->bits);
    }
    return size;
}

static uint64_t div_up(uint64_t a, uint64_t b)
{
    return a / b + (a % b != 0);
}

/* Returns a bound if each mip is half of the finer mip, by the rule of version 0.7. */
static uint64_t bound_even(const struct axis *a, uint32_t alignment)
{
    uint64_t step = (uint64_t)1 << a->last_step, aligned = div_up(alignment, step);
    uint64_t offset = step > aligned ? step - aligned : 0;
    uint64_t texels = div_up(offset + a->size, step);
    bool is_aligned = aligned * a->grid % a->last_size == 0;
    return div_up((texels + !is_aligned) * a->grid, a->last_size) + 2;
}

/* Returns a bound for other sizes: the rectangle and three texels of the coarsest mip. */
static uint64_t bound_odd(const struct axis *a)
{
    return div_up((uint64_t)a->size * a->grid, a->first_size) +
           div_up(3 * (uint64_t)a->grid, a->last_size) + 4;
}

static uint32_t bound_span(const struct axis *a, uint32_t alignment, uint32_t bits)
{
    bool is_even = (uint64_t)a->last_size << a->last_step == a->first_size;
    uint64_t count = is_even ? bound_even(a, alignment) : bound_odd(a);
    if (bits & 4)
        count = (count + 2) & ~(uint64_t)1;
    return (uint32_t)slc_min_u64(count, a->grid);
}

uint64_t slc_neural_bound_slices(const SluiceNeuralSet *set,
                                 const struct slc_neural_request *request, uint32_t alignment)
{
    uint64_t size = 0;
    uint32_t end = request->first_mip + request->mip_count;
    for (uint32_t mip = request->first_mip; mip < end;) {
        struct unit unit = unit_at(set, request, mip);
        for (uint32_t i = unit.first_grid; i < unit.first_grid + 2; i++) {
            const struct slc_neural_grid *g = &set->grids[i];
            uint32_t bits = g->features * g->bits, pair = set->info.schema == 1 ? bits : 0;
            struct axis x = axis_of(set, request, &unit, i, 0);
            struct axis y = axis_of(set, request, &unit, i, 1);
            uint32_t width = bound_span(&x, alignment, pair);
            /* a slice that ends with an odd grid has pairs of rows */
            bool has_pairs = (pair & 4) && g->width % 2;
            size +=
                slc_neural_slice_bytes(width, bound_span(&y, alignment, has_pairs ? 4 : 0), bits);
        }
        mip = unit.last + 1;
    }
    return size;
}

void slc_neural_fill_constants(const SluiceNeuralSet *set, const struct slc_neural_request *request,
                               SluiceNeuralConstants *constants)
{
    const SluiceNeuralSetInfo *info = &set->info;
    *constants = (SluiceNeuralConstants){
        .schema = info->schema,
        .width = info->width,
        .height = info->height,
        .mipCount = info->mipCount,
        .channelCount = info->channelCount,
        .validChannels = info->validChannels,
        .inputCount = info->inputCount,
        .networkFeatures = info->schema == 1 ? (info->inputCount - 32) / 4 : 16,
        .highFeatures = info->highFeatures,
        .highBits = info->highBits,
        .lowFeatures = info->lowFeatures,
        .lowBits = info->lowBits,
        .firstMip = request->first_mip,
        .residentMipCount = request->mip_count,
    };
    for (uint32_t i = 0; i < info->mipCount; i++) {
        const struct slc_neural_mip *mip = &set->mips[i];
        constants->mips[i] = (SluiceNeuralMipConstants){
            mip->first_grid, slc_neural_wave_code(info->schema, mip->position_lod),
            mip->position_lod, mip->position_scale};
    }
}
