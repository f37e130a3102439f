/**
 * From a trace of the harness to the uses of every tile that some map needs. Only touched tiles
 * are stored, beside a table of 4 bytes per tile of each set that was ever seen.
 */
#include "clairvoyant.h"

#include "sltrace.h"

#include <stdlib.h>
#include <string.h>

enum { NEVER = 0xffffffff };

struct set_state {
    uint32_t texture, members;
    uint32_t last_visit, first_touch;
    uint32_t *nodes;        ///< per regular tile
    uint32_t *region_touch; ///< per region: the frame of its first touch
};

struct builder {
    slt_trace trace;
    struct set_state *sets;
    uint32_t *set_of; ///< per texture
    uint32_t set_count, latency;
    struct node *nodes;
    uint32_t *last_use, *first_frame; ///< per node; the former into `uses`
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

static bool same_shape(const slt_texture *a, const slt_texture *b)
{
    return a->width == b->width && a->height == b->height && a->tileW == b->tileW &&
           a->tileH == b->tileH && a->mipCount == b->mipCount && a->regularMips == b->regularMips &&
           a->packedTiles == b->packedTiles;
}

static bool usable(const slt_texture *t)
{
    return t->packedTiles && t->tileW && t->tileH && t->fbRegionW && t->fbRegionH &&
           (uint32_t)t->fbW * t->fbH <= UINT16_MAX;
}

static bool find_sets(struct builder *b)
{
    uint32_t count = b->trace.p.textureCount;
    const slt_texture *textures = b->trace.tex;
    b->sets = clv_alloc(count, sizeof *b->sets);
    b->set_of = clv_alloc(count, sizeof *b->set_of);
    for (uint32_t i = 0; i < count; i++) {
        if (textures[i].primary == i)
            b->sets[b->set_count++] = (struct set_state){i, 0, NEVER, NEVER, NULL, NULL};
        uint32_t set = b->set_count - 1;
        if (b->set_count == 0 || textures[i].primary != b->sets[set].texture ||
            !same_shape(&textures[i], &textures[b->sets[set].texture]) || !usable(&textures[i])) {
            fprintf(stderr,
                    "texture %u: sets must stand together, be of one shape and have packed "
                    "tiles and at most 65535 regions\n",
                    i);
            return false;
        }
        b->set_of[i] = set;
        b->sets[set].members++;
    }
    for (uint32_t i = 0; i < b->set_count; i++) {
        const slt_texture *t = &textures[b->sets[i].texture];
        add_node(b, &(struct node){.set = i,
                                   .parent = NO_NODE,
                                   .packed = true,
                                   .size = (uint16_t)(b->sets[i].members * t->packedTiles),
                                   .level = t->regularMips,
                                   .tile = t->regularTiles});
    }
    return true;
}

static void first_sight(struct builder *b, struct set_state *s)
{
    if (s->nodes)
        return;
    const slt_texture *t = &b->trace.tex[s->texture];
    size_t tiles = t->regularTiles, regions = (size_t)t->fbW * t->fbH;
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

/** The node of the tile at (tx, ty) of level 0, at `level`. */
static uint32_t node_at(struct builder *b, uint32_t set, uint32_t level, uint32_t parent,
                        uint32_t tx, uint32_t ty)
{
    struct set_state *s = &b->sets[set];
    const slt_texture *t = &b->trace.tex[s->texture];
    uint32_t width, height, first = 0;
    for (uint32_t m = 0; m < level; m++) {
        slt_mip_tiles(t, m, &width, &height);
        first += width * height;
    }
    slt_mip_tiles(t, level, &width, &height);
    uint32_t x = tx >> level, y = ty >> level;
    x = x < width ? x : width - 1;
    y = y < height ? y : height - 1;
    uint32_t *node = &s->nodes[first + y * width + x];
    if (*node == NEVER)
        *node = add_node(b, &(struct node){.set = set,
                                           .parent = parent,
                                           .level = (uint8_t)level,
                                           .size = (uint16_t)s->members,
                                           .tile = first + y * width + x});
    return *node;
}

static void add_region(struct builder *b, uint32_t set, uint32_t x, uint32_t y, uint32_t want,
                       uint32_t frame)
{
    struct set_state *s = &b->sets[set];
    const slt_texture *t = &b->trace.tex[s->texture];
    uint32_t width, height, node = set, *touch = &s->region_touch[y * t->fbW + x];
    slt_mip_tiles(t, 0, &width, &height);
    uint32_t tx = x * t->fbRegionW / t->tileW, ty = y * t->fbRegionH / t->tileH;
    tx = tx < width ? tx : width - 1;
    ty = ty < height ? ty : height - 1;
    want = want < t->regularMips ? want : t->regularMips;
    s->first_touch = s->first_touch == NEVER ? frame : s->first_touch;
    *touch = *touch == NEVER ? frame : *touch;
    uint32_t unseen = 0;
    for (uint32_t level = t->regularMips;; level--) {
        if (level < t->regularMips)
            node = node_at(b, set, level, node, tx, ty);
        add_use(b, node, frame, s->last_visit, level == want);
        /* packed tiles need not be asked for */
        unseen += level < t->regularMips && frame - b->first_frame[node] <= b->latency;
        if (level == want)
            break;
    }
    uint64_t *cause = frame - s->first_touch <= b->latency ? &b->reactive.appears
                      : frame - *touch <= b->latency       ? &b->reactive.enters
                                                           : &b->reactive.finer;
    *cause += unseen;
    b->reactive.regions += unseen > 0;
    b->regions++;
}

static void add_map(struct builder *b, uint32_t texture, const uint8_t *map, uint32_t frame)
{
    uint32_t set = b->set_of[texture];
    const slt_texture *t = &b->trace.tex[texture];
    for (uint32_t y = 0; y < t->fbH; y++)
        for (uint32_t x = 0; x < t->fbW; x++)
            if (map[y * t->fbW + x] != 0xff) {
                first_sight(b, &b->sets[set]);
                add_region(b, set, x, y, map[y * t->fbW + x], frame);
            }
    b->visits = grow(b->visits, b->visit_count, &b->visit_room, sizeof *b->visits);
    b->visits[b->visit_count].set = set;
    b->visits[b->visit_count++].frame = frame;
    b->sets[set].last_visit = frame;
}

static bool read_frames(struct builder *b)
{
    uint8_t *map = clv_alloc(UINT16_MAX, 1);
    bool good = true;
    for (uint32_t frame = 0; good && frame < b->trace.p.frameCount; frame++) {
        uint64_t time;
        uint32_t maps, texture;
        if (!slt_next_frame(&b->trace, &time, &maps))
            break;
        for (uint32_t i = 0; good && i < maps; i++) {
            good =
                slt_next_map(&b->trace, &texture, map) && b->trace.tex[texture].primary == texture;
            if (good)
                add_map(b, texture, map, frame);
        }
    }
    free(map);
    return good;
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

/** Two counting sorts: by node, keeping the order of time, then by frame, keeping that of nodes. */
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
    *w = (struct workload){.frame_count = b->trace.p.frameCount,
                           .set_count = b->set_count,
                           .node_count = b->node_count,
                           .use_count = b->use_count,
                           .regions = b->regions,
                           .reactive = b->reactive};
    add_node(b, &(struct node){0}); /* only to end the uses of the one before it */
    w->nodes = b->nodes;
    w->set_texture = clv_alloc(b->set_count, sizeof *w->set_texture);
    for (uint32_t i = 0; i < b->set_count; i++) {
        w->set_texture[i] = b->sets[i].texture;
        w->packed_tiles += w->nodes[i].size;
    }
    clv_workload_index(w, b->order, b->uses);
    index_visits(w, b);
}

bool clv_workload_read(struct workload *w, const char *path, uint32_t latency)
{
    struct builder b = {.latency = latency};
    bool good = slt_open(&b.trace, path);
    if (good && (good = find_sets(&b)))
        good = read_frames(&b);
    if (good)
        take_over(w, &b);
    else
        fprintf(stderr, "%s: not a usable trace\n", path);
    for (uint32_t i = 0; i < b.set_count; i++) {
        free(b.sets[i].nodes);
        free(b.sets[i].region_touch);
    }
    if (!good)
        free(b.nodes);
    free(b.sets);
    free(b.set_of);
    free(b.last_use);
    free(b.first_frame);
    free(b.order);
    free(b.uses);
    free(b.visits);
    free(b.trace.tex);
    free(b.trace.data);
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
