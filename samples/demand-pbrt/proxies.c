#include "proxies.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/log.h"
#include "../../tools/common/text.h"
#include "../common/ray_table.h"
#include "pbrt_shared.h"

/* Rounding errors of boxes, relative to the largest coordinate, because transforms mix the axes.
 * The host transforms boxes; the device transforms triangles. */
#define ROUNDING 1.0e-5f
#define RANK 0u /* served before tiles */
#define RANGE_COUNT 512u
#define MOST_BOXES (PBRT_PAGE_CAPACITY / 2)

/* Limit of boxes that a frame of a flight lists, nearest first. Sorting 40 000 takes longer than a
 * frame. */
#define MOST_LISTED 2048u

static bool check(SluiceResult result, const char *what)
{
    if (result < 0)
        text_say("%s: %s", what, sluiceGetResultName(result));
    return result >= 0;
}

static bool create_set(SluiceDemandLoader *loader, SluiceProxyKind kind, uint64_t most,
                       SluiceProxySet **set, SluiceDemandResourceId *resource, uint32_t *page)
{
    const SluiceProxySetCreateInfo info = {.structSize = sizeof info,
                                           .kind = kind,
                                           .maxProxyCount =
                                               most < INT32_MAX ? (uint32_t)most : INT32_MAX,
                                           .log = {.pfnLog = log_say}};
    return check(sluiceCreateProxySet(&info, set), "proxies") &&
           check(sluiceAddDemandProxies(loader, *set, RANK, resource, page), "proxies");
}

bool proxies_create(SluiceDemandLoader *loader, const struct scene *scene, struct proxies *p)
{
    const uint64_t boxes =
        scene->place_count + scene->node_count + scene->clusters.tree.node_count + 1;
    const uint64_t most_boxes = boxes < MOST_BOXES ? boxes : MOST_BOXES;
    const uint32_t surface_count = scene->info.materialCount + scene->info.textureCount;
    *p = (struct proxies){.loader = loader, .changed = true};
    if (!create_set(loader, SLUICE_PROXY_KIND_GEOMETRY, most_boxes, &p->boxes, &p->box_resource,
                    &p->box_page) ||
        !create_set(loader, SLUICE_PROXY_KIND_MATERIAL, surface_count + 1ull, &p->surfaces,
                    &p->surface_resource, &p->surface_page))
        return false;
    for (uint32_t i = 0; i < surface_count; i++) {
        SluiceProxyId id; /* the id's index is i */
        if (!check(sluiceAddMaterialProxy(p->surfaces, &id), "a material"))
            return false;
    }
    return true;
}

void proxies_finish(const struct gpu *gpu, struct structures *structures, struct proxies *p)
{
    structures_give(gpu, structures, &p->structure);
    gpu_destroy_buffer(gpu, &p->buffer);
    free(p->moved);
    sluiceDestroyProxySet(p->boxes);
    sluiceDestroyProxySet(p->surfaces);
    free(p->nodes);
    free(p->ids);
    *p = (struct proxies){0};
}

static SluiceProxySetInfo get_info(const SluiceProxySet *set)
{
    SluiceProxySetInfo info = {.structSize = sizeof info};
    (void)sluiceGetProxySetInfo(set, &info); /* cannot fail otherwise */
    return info;
}

uint32_t proxies_box_count(const struct proxies *p)
{
    return get_info(p->boxes).proxyCount;
}

static bool reserve(void **items, uint32_t *room, uint32_t count, size_t size)
{
    if (count <= *room)
        return true;
    uint32_t more = *room ? *room : 64;
    while (more < count)
        more += more / 4;
    void *grown = realloc(*items, more * size);
    if (!grown) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    *items = grown;
    *room = more;
    return true;
}

static bool note_move(struct proxies *p, uint32_t index, const SluiceProxyBox *box)
{
    if (!p->notes_moves)
        return true;
    if (!reserve((void **)&p->moved, &p->moved_room, p->moved_count + 1, sizeof *p->moved))
        return false;
    p->moved[p->moved_count] = (struct moved_box){.index = index, .is_there = box};
    if (box)
        p->moved[p->moved_count].box = *box;
    p->moved_count++;
    return true;
}

bool proxies_add(struct proxies *p, struct scene_node node, const SluicePbrtBounds *box)
{
    SluiceProxyBox wide;
    SluiceProxyId id;
    float more = 0x1p-90f; /* points and tiny shapes become boxes, too */
    for (int i = 0; i < 3; i++)
        more = fmaxf(more, ROUNDING * fmaxf(fabsf(box->least[i]), fabsf(box->most[i])));
    for (int i = 0; i < 3; i++) {
        wide.min[i] = box->least[i] - more;
        wide.max[i] = box->most[i] + more;
    }
    if (!check(sluiceAddGeometryProxy(p->boxes, &wide, &id), "a box"))
        return false;
    const uint32_t index = (uint32_t)id;
    if (!reserve((void **)&p->nodes, &p->node_room, index + 1, sizeof *p->nodes))
        return false;
    p->nodes[index] = node;
    p->added_count++;
    p->changed = true;
    return note_move(p, index, &wide);
}

/** Lists at most `most` requested proxies of a set. */
static bool list(struct proxies *p, SluiceProxySet *set, SluiceDemandResourceId resource,
                 const SluiceProxyListInfo *info, uint32_t most, uint32_t *count)
{
    if (!check(sluiceProcessDemandProxies(p->loader, resource, set), "requests"))
        return false;
    *count = get_info(set).requestedCount;
    *count = *count < most ? *count : most;
    if (*count == 0)
        return true;
    return reserve((void **)&p->ids, &p->id_room, *count, sizeof *p->ids) &&
           check(sluiceGetRequestedProxies(set, info, count, p->ids), "requests");
}

static bool take_nodes(struct proxies *p, const struct proxy_order *order, struct proxy_requests *r)
{
    const SluiceProxyListInfo info = {.structSize = sizeof info,
                                      .order = order->largest_first ? SLUICE_PROXY_ORDER_VOLUME
                                                                    : SLUICE_PROXY_ORDER_INDEX};
    uint32_t count;
    if (!list(p, p->boxes, p->box_resource, &info, UINT32_MAX, &count))
        return false;
    count = order->one_node && count > 1 ? 1 : count;
    if (!reserve((void **)&r->nodes, &r->node_room, count, sizeof *r->nodes))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        r->nodes[i] = p->nodes[(uint32_t)p->ids[i]];
        if (!check(sluiceRemoveProxy(p->boxes, p->ids[i]), "a box") ||
            !note_move(p, (uint32_t)p->ids[i], NULL))
            return false;
    }
    r->node_count = count;
    p->changed = p->changed || count > 0;
    return check(sluiceClearProxyRequests(p->boxes, SLUICE_ALL_PROXIES), "requests");
}

static bool take_surfaces(struct proxies *p, const struct proxy_order *order,
                          struct proxy_requests *r)
{
    uint32_t count;
    if (!list(p, p->surfaces, p->surface_resource, NULL, UINT32_MAX, &count))
        return false;
    count = order->one_surface && count > 1 ? 1 : count;
    if (!reserve((void **)&r->surfaces, &r->surface_room, count, sizeof *r->surfaces))
        return false;
    for (uint32_t i = 0; i < count; i++)
        r->surfaces[i] = (uint32_t)p->ids[i];
    r->surface_count = count;
    return check(sluiceClearProxyRequests(p->surfaces, SLUICE_ALL_PROXIES), "requests");
}

bool proxies_take(struct proxies *p, const struct proxy_order *order, struct proxy_requests *r)
{
    return take_nodes(p, order, r) && take_surfaces(p, order, r);
}

bool proxies_list(struct proxies *p, const float eye[3], struct proxy_requests *r)
{
    SluiceProxyListInfo info = {.structSize = sizeof info, .order = SLUICE_PROXY_ORDER_DISTANCE};
    memcpy(info.point, eye, sizeof info.point);
    if (!list(p, p->boxes, p->box_resource, &info, MOST_LISTED, &r->node_count) ||
        !reserve((void **)&r->ids, &r->id_room, r->node_count, sizeof *r->ids) ||
        !reserve((void **)&r->nodes, &r->node_room, r->node_count, sizeof *r->nodes))
        return false;
    for (uint32_t i = 0; i < r->node_count; i++) {
        r->ids[i] = p->ids[i];
        r->nodes[i] = p->nodes[(uint32_t)r->ids[i]];
    }
    const struct proxy_order all = {0};
    return check(sluiceClearProxyRequests(p->boxes, SLUICE_ALL_PROXIES), "requests") &&
           take_surfaces(p, &all, r);
}

bool proxies_take_node(struct proxies *p, const struct proxy_requests *r, uint32_t number)
{
    p->changed = true;
    return check(sluiceRemoveProxy(p->boxes, r->ids[number]), "a box") &&
           note_move(p, (uint32_t)r->ids[number], NULL);
}

void proxies_forget_moves(struct proxies *p)
{
    free(p->moved);
    p->moved = NULL;
    p->moved_count = p->moved_room = 0;
}

void proxy_requests_finish(struct proxy_requests *r)
{
    free(r->ids);
    free(r->nodes);
    free(r->surfaces);
    *r = (struct proxy_requests){0};
}

/** Replaces the buffer if it is too small. Then all boxes are written again. */
static bool reserve_boxes(const struct gpu *gpu, struct proxies *p)
{
    const VkDeviceSize size = (VkDeviceSize)p->box_count * sizeof(SluiceProxyBox);
    if (p->buffer.size >= size && p->buffer.buffer)
        return true;
    gpu_destroy_buffer(gpu, &p->buffer);
    p->version = 0;
    return gpu_create_buffer(gpu, size + size / 4 + 1024, structures_input_usage(gpu), &p->buffer);
}

/** Updates the buffer, whose size follows the largest index. */
static bool write_boxes(const struct gpu *gpu, struct proxies *p)
{
    p->box_count = get_info(p->boxes).indexCount;
    if (!reserve_boxes(gpu, p))
        return false;
    SluiceProxyRange ranges[RANGE_COUNT];
    uint32_t range_count;
    const SluiceProxyBoxWrite write = {.structSize = sizeof write,
                                       .capacity =
                                           (uint32_t)(p->buffer.size / sizeof(SluiceProxyBox)),
                                       .pBoxes = p->buffer.mapped,
                                       .rangeCapacity = RANGE_COUNT,
                                       .pRanges = ranges};
    return check(sluiceWriteProxyBoxes(p->boxes, &write, &p->version, &range_count), "boxes");
}

double proxies_memory(const struct proxies *p)
{
    return (double)get_info(p->boxes).hostMemorySize + (double)p->buffer.size +
           (double)p->moved_room * sizeof *p->moved + (double)p->node_room * sizeof *p->nodes +
           (double)p->structure.storage.size;
}

static void count_memory(struct proxies *p)
{
    const SluiceProxySetInfo info = get_info(p->boxes);
    if (info.proxyCount <= p->most_count)
        return;
    p->most_count = info.proxyCount;
    p->bytes_per_box = (proxies_memory(p) - (double)p->structure.storage.size) / info.proxyCount;
}

bool proxies_build(const struct gpu *gpu, struct structures *structures, struct proxies *p)
{
    if (!p->changed)
        return true;
    SluiceProxyGeometry geometry = {.structSize = sizeof geometry};
    structures_give(gpu, structures, &p->structure);
    if (!write_boxes(gpu, p) ||
        !check(
            sluiceGetProxyGeometry(p->boxes, ray_buffer_address(gpu, p->buffer.buffer), &geometry),
            "boxes"))
        return false;
    p->changed = false;
    count_memory(p);
    struct structure_build build = {.type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR,
                                    .primitive_count = geometry.range.primitiveCount,
                                    .geometry = geometry.geometry,
                                    .target = &p->structure};
    return build.primitive_count == 0 || structures_build(gpu, structures, &build, 1);
}
