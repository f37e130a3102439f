/**
 * Converts a trace to the uses of every tile that some map needs. Only touched tiles are stored,
 * beside a table of 4 bytes per tile of each set.
 */
#include "clairvoyant.h"

#include <stdlib.h>
#include <string.h>

#define NEVER UINT32_MAX

struct set_state {
    uint32_t texture, members;
    uint32_t last_visit, first_touch;
    uint32_t *nodes;        ///< per regular tile
    uint32_t *region_touch; ///< per region: frame of its first touch
};

struct builder {
    struct feedback_trace *trace;
    struct set_state *sets;
    uint32_t *set_of; ///< per texture
    uint32_t set_count, latency;
    struct node *nodes;
    uint32_t *last_use, *first_frame; ///< per node; `last_use`: index into `uses`
    uint32_t node_count, node_room;
    struct frame_use *order;
    struct use *uses;
    uint32_t use_count, use_room;
    struct {
        uint32_t set, frame;
    } * visits;
    uint32_t visit_count, visit_room;
    uint64_t regions;
    struct reactive_floor reactive;
};

void *clv_alloc(size_t count, size_t size)
{
    void *memory = calloc(count ? count : 1, size);
    if (!memory) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
    return memory;
}

static void *grow(void *memory, uint32_t count, uint32_t *room, size_t size)
{
    if (count < *room)
        return memory;
    *room = *room ? *room * 2 : 4096;
    memory = realloc(memory, *room * size);
    if (!memory) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
    return memory;
}

static uint32_t add_node(struct builder *b, const struct node *node)
{
    uint32_t room = b->node_room;
    b->nodes = grow(b->nodes, b->node_count, &b->node_room, sizeof *b->nodes);
    uint32_t same = room;
    b->last_use = grow(b->last_use, b->node_count, &same, sizeof *b->last_use);
    b->first_frame = grow(b->first_frame, b->node_count, &room, sizeof *b->first_frame);
    b->nodes[b->node_count] = *node;
    b->last_use[b->node_count] = NEVER;
    b->first_frame[b->node_count] = NEVER;
    return b->node_count++;
}

static bool usable(const SluiceStreamedTextureLayout *t)
{
    return t->desc.packedTileCount && t->desc.tileWidth % t->desc.feedbackRegionWidth == 0 &&
           t->desc.tileHeight % t->desc.feedbackRegionHeight == 0 &&
           t->feedbackWidth * t->feedbackHeight <= UINT16_MAX;
}

static const SluiceStreamedTextureLayout *layout_of(const struct builder *b, uint32_t set)
{
    return &b->trace->textures[b->sets[set].texture].layout;
}

static bool find_sets(struct builder *b)
{
    uint32_t count = b->trace->texture_count;
    const struct feedback_texture *textures = b->trace->textures;
    b->sets = clv_alloc(count, sizeof *b->sets);
    b->set_of = clv_alloc(count, sizeof *b->set_of);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t primary = textures[i].primary;
        if (primary == i)
            b->sets[b->set_count++] = (struct set_state){i, 0, NEVER, NEVER, NULL, NULL};
        uint32_t set = b->set_count - 1;
        if (b->set_count == 0 || primary != b->sets[set].texture ||
            !feedback_trace_same_shape(&textures[i].layout.desc, &textures[primary].layout.desc) ||
            !usable(&textures[i].layout)) {
            fprintf(stderr,
                    "texture %u: sets must stand together, be of one shape and have packed tiles, "
                    "at most 65535 regions, and regions that lie in one tile\n",
                    i);
            return false;
        }
        b->set_of[i] = set;
        b->sets[set].members++;
    }
    return true;
}

/** Adds the nodes of packed tiles, which come first. */
static void add_packed_nodes(struct builder *b)
{
    for (uint32_t i = 0; i < b->set_count; i++) {
        const SluiceStreamedTextureLayout *t = layout_of(b, i);
        add_node(b, &(struct node){.set = i,
                                   .parent = NO_NODE,
                                   .packed = true,
                                   .size = (uint16_t)(b->sets[i].members * t->desc.packedTileCount),
                                   .level = (uint8_t)t->desc.regularMipCount,
                                   .tile = t->regularTileCount});
    }
}

static void first_sight(struct builder *b, uint32_t set)
{
    struct set_state *s = &b->sets[set];
    if (s->nodes)
        return;
    const SluiceStreamedTextureLayout *t = layout_of(b, set);
    size_t tiles = t->regularTileCount, regions = (size_t)t->feedbackWidth * t->feedbackHeight;
    s->nodes = clv_alloc(tiles, sizeof *s->nodes);
    s->region_touch = clv_alloc(regions, sizeof *s->region_touch);
    memset(s->nodes, 0xff, tiles * sizeof *s->nodes);
    memset(s->region_touch, 0xff, regions * sizeof *s->region_touch);
}

static void add_use(struct builder *b, uint32_t node, uint32_t frame, uint32_t last_visit,
                    bool exact)
{
    uint32_t last = b->last_use[node];
    if (last == NEVER || b->uses[last].frame != frame) {
        uint32_t room = b->use_room;
        b->uses = grow(b->uses, b->use_count, &room, sizeof *b->uses);
        b->order = grow(b->order, b->use_count, &b->use_room, sizeof *b->order);
        bool follows = last != NEVER && b->uses[last].frame == last_visit;
        b->uses[b->use_count] = (struct use){.frame = frame & 0x7fffffff, .follows = follows};
        b->order[b->use_count] = (struct frame_use){node, b->use_count};
        if (last == NEVER)
            b->first_frame[node] = frame;
        last = b->last_use[node] = b->use_count++;
    }
    b->uses[last].regions++;
    b->uses[last].exact = (uint16_t)(b->uses[last].exact + exact);
}

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/** Returns the node of the tile over (tx, ty) of level 0 at `level`. */
static uint32_t node_at(struct builder *b, uint32_t set, uint32_t level, uint32_t parent,
                        uint32_t tx, uint32_t ty)
{
    struct set_state *s = &b->sets[set];
    const SluiceStreamedTextureLayout *t = layout_of(b, set);
    uint32_t x = least(tx >> level, t->levelWidthInTiles[level] - 1);
    uint32_t y = least(ty >> level, t->levelHeightInTiles[level] - 1);
    uint32_t tile = t->levelFirstTile[level] + y * t->levelWidthInTiles[level] + x;
    uint32_t *node = &s->nodes[tile];
    if (*node == NEVER)
        *node = add_node(b, &(struct node){.set = set,
                                           .parent = parent,
                                           .level = (uint8_t)level,
                                           .size = (uint16_t)s->members,
                                           .tile = tile});
    return *node;
}

static void count_unseen(struct builder *b, uint32_t set, uint32_t touch, uint32_t frame,
                         uint32_t unseen)
{
    uint64_t *cause = frame - b->sets[set].first_touch <= b->latency ? &b->reactive.appears
                      : frame - touch <= b->latency                  ? &b->reactive.enters
                                                                     : &b->reactive.finer;
    *cause += unseen;
    b->reactive.regions += unseen > 0;
}

static void add_region(struct builder *b, uint32_t set, uint32_t x, uint32_t y, uint32_t want,
                       uint32_t frame)
{
    struct set_state *s = &b->sets[set];
    const SluiceStreamedTextureLayout *t = layout_of(b, set);
    uint32_t node = set, *touch = &s->region_touch[y * t->feedbackWidth + x];
    uint32_t tx = x * t->desc.feedbackRegionWidth / t->desc.tileWidth;
    uint32_t ty = y * t->desc.feedbackRegionHeight / t->desc.tileHeight;
    uint32_t regular = t->desc.regularMipCount;
    want = least(want, regular);
    s->first_touch = s->first_touch == NEVER ? frame : s->first_touch;
    *touch = *touch == NEVER ? frame : *touch;
    uint32_t unseen = 0;
    for (uint32_t level = regular;; level--) {
        if (level < regular)
            node = node_at(b, set, level, node, tx, ty);
        add_use(b, node, frame, s->last_visit, level == want);
        /* packed tiles need no request */
        unseen += level < regular && frame - b->first_frame[node] <= b->latency;
        if (level == want)
            break;
    }
    count_unseen(b, set, *touch, frame, unseen);
    b->regions++;
}

static void add_map(struct builder *b, uint32_t texture, const uint8_t *map, uint32_t frame)
{
    uint32_t set = b->set_of[texture];
    const SluiceStreamedTextureLayout *t = layout_of(b, set);
    for (uint32_t y = 0; y < t->feedbackHeight; y++)
        for (uint32_t x = 0; x < t->feedbackWidth; x++) {
            uint32_t want = map[y * t->feedbackWidth + x];
            if (want == SLUICE_MIP_UNTOUCHED)
                continue;
            first_sight(b, set);
            add_region(b, set, x, y, want, frame);
        }
    b->visits = grow(b->visits, b->visit_count, &b->visit_room, sizeof *b->visits);
    b->visits[b->visit_count].set = set;
    b->visits[b->visit_count++].frame = frame;
    b->sets[set].last_visit = frame;
}

static bool read_frames(struct builder *b)
{
    feedback_trace_rewind(b->trace);
    for (uint32_t frame = 0; frame < b->trace->frame_count; frame++) {
        uint64_t time;
        uint32_t maps, texture;
        feedback_trace_next_frame(b->trace, &time, &maps);
        for (uint32_t i = 0; i < maps; i++) {
            const uint8_t *map = feedback_trace_next_map(b->trace, &texture);
            if (b->trace->textures[texture].primary != texture) {
                fprintf(stderr, "texture %u: follows another one, and has a map\n", texture);
                return false;
            }
            add_map(b, texture, map, frame);
        }
    }
    return true;
}

static void index_visits(struct workload *w, const struct builder *b)
{
    w->visit_first = clv_alloc((size_t)w->set_count + 2, sizeof *w->visit_first);
    w->visits = clv_alloc(b->visit_count, sizeof *w->visits);
    for (uint32_t i = 0; i < b->visit_count; i++)
        w->visit_first[b->visits[i].set + 2]++;
    for (uint32_t i = 0; i < w->set_count; i++)
        w->visit_first[i + 2] += w->visit_first[i + 1];
    for (uint32_t i = 0; i < b->visit_count; i++)
        w->visits[w->visit_first[b->visits[i].set + 1]++] = b->visits[i].frame;
}

/** Sorts twice by counting: by node, keeping the order of time, then by frame, keeping the order of
 * nodes. */
void clv_workload_index(struct workload *w, const struct frame_use *draft,
                        const struct use *draft_uses)
{
    w->uses = clv_alloc(w->use_count, sizeof *w->uses);
    w->frame_uses = clv_alloc(w->use_count, sizeof *w->frame_uses);
    w->frame_first = clv_alloc((size_t)w->frame_count + 2, sizeof *w->frame_first);
    uint32_t *next = clv_alloc((size_t)w->node_count + 2, sizeof *next);
    for (uint32_t i = 0; i < w->use_count; i++) {
        next[draft[i].node + 1]++;
        w->frame_first[draft_uses[i].frame + 2]++;
    }
    for (uint32_t i = 0; i < w->node_count; i++) {
        w->nodes[i].first_use = next[i];
        next[i + 1] += next[i];
    }
    w->nodes[w->node_count].first_use = w->use_count;
    for (uint32_t i = 0; i < w->use_count; i++)
        w->uses[next[draft[i].node]++] = draft_uses[i];
    for (uint32_t i = 0; i < w->frame_count; i++)
        w->frame_first[i + 2] += w->frame_first[i + 1];
    for (uint32_t n = 0; n < w->node_count; n++)
        for (uint32_t i = w->nodes[n].first_use; i < w->nodes[n + 1].first_use; i++)
            w->frame_uses[w->frame_first[w->uses[i].frame + 1]++] = (struct frame_use){n, i};
    free(next);
}

static void take_over(struct workload *w, struct builder *b)
{
    *w = (struct workload){.frame_count = b->trace->frame_count,
                           .set_count = b->set_count,
                           .node_count = b->node_count,
                           .use_count = b->use_count,
                           .regions = b->regions,
                           .reactive = b->reactive};
    add_node(b, &(struct node){0}); /* end marker for the uses of the last node */
    w->nodes = b->nodes;
    w->set_texture = clv_alloc(b->set_count, sizeof *w->set_texture);
    for (uint32_t i = 0; i < b->set_count; i++) {
        w->set_texture[i] = b->sets[i].texture;
        w->packed_tiles += w->nodes[i].size;
    }
    clv_workload_index(w, b->order, b->uses);
    index_visits(w, b);
}

bool clv_workload_read(struct workload *w, struct feedback_trace *trace, uint32_t latency)
{
    struct builder b = {.trace = trace, .latency = latency};
    bool good = find_sets(&b);
    if (good) {
        add_packed_nodes(&b);
        good = read_frames(&b);
    }
    if (good)
        take_over(w, &b);
    else
        free(b.nodes);
    for (uint32_t i = 0; i < b.set_count; i++) {
        free(b.sets[i].nodes);
        free(b.sets[i].region_touch);
    }
    free(b.sets);
    free(b.set_of);
    free(b.last_use);
    free(b.first_frame);
    free(b.order);
    free(b.uses);
    free(b.visits);
    return good;
}

void clv_workload_finish(struct workload *w)
{
    free(w->nodes);
    free(w->uses);
    free(w->frame_first);
    free(w->frame_uses);
    free(w->visit_first);
    free(w->visits);
    free(w->set_texture);
}
