#include "vulkan/texture_requests.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "vulkan/due_maps.h"
#include "vulkan/texture_state.h"

#include <assert.h>
#include <inttypes.h>

#define FIRST_ROOM 16u

void slc_texture_requests_finish(struct slc_texture_requests *requests,
                                 const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, requests->list, requests->room, sizeof *requests->list);
    *requests = (struct slc_texture_requests){0};
}

/* Places ------------------------------------------------------------------------------------- */

/* Makes room for one more request. */
static SluiceResult reserve(SluiceVulkanStreamer *s)
{
    struct slc_texture_requests *r = &s->requests;
    if (r->first_free || r->count < r->room)
        return SLUICE_SUCCESS;
    if (r->room == SLC_MAX_TEXTURE_REQUESTS) {
        slc_log(&s->vk.log, SLUICE_LOG_ERROR, "there are %u requests for tiles; end some of them",
                SLC_MAX_TEXTURE_REQUESTS);
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    }
    uint32_t room = r->room ? 2 * r->room : FIRST_ROOM;
    struct slc_texture_request *list = slc_regrow(&s->cb, r->list, r->room, room, sizeof *r->list);
    if (!list)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    r->list = list;
    r->room = room;
    return SLUICE_SUCCESS;
}

static struct slc_texture_request *take(struct slc_texture_requests *r)
{
    struct slc_texture_request *request;
    if (r->first_free) {
        request = &r->list[r->first_free - 1];
        r->first_free = request->next;
    } else {
        request = &r->list[r->count++];
        request->generation = 0;
    }
    request->generation++;
    r->live_count++;
    return request;
}

/* Frees a request. An element whose generations are used up stays unused: ids are never reused. */
static void give_back(struct slc_texture_requests *r, struct slc_texture_request *request)
{
    request->live = false;
    r->live_count--;
    if (request->generation == UINT32_MAX)
        return;
    request->next = r->first_free;
    r->first_free = (uint32_t)(request - r->list) + 1;
}

static SluiceTextureRequestId id_of(const struct slc_texture_requests *r,
                                    const struct slc_texture_request *request)
{
    return (uint64_t)request->generation << 32 | (uint32_t)(request - r->list);
}

/* Finds a live request. NULL: the request has ended. */
static SluiceResult find(const SluiceVulkanStreamer *s, SluiceTextureRequestId id,
                         struct slc_texture_request **request)
{
    uint32_t place = (uint32_t)id, generation = (uint32_t)(id >> 32);
    *request = NULL;
    if (place >= s->requests.count || generation == 0 ||
        generation > s->requests.list[place].generation)
        return slc_log_refusal(&s->vk.log, "requestId is %#" PRIx64 ", which no request had", id);
    struct slc_texture_request *found = &s->requests.list[place];
    if (found->live && found->generation == generation)
        *request = found;
    return SLUICE_SUCCESS;
}

/* Beginning and ending ----------------------------------------------------------------------- */

static void end_request(SluiceVulkanStreamer *s, struct slc_texture_request *request)
{
    struct slc_texture *texture = &s->textures[request->texture];
    uint32_t place = (uint32_t)(request - s->requests.list) + 1;
    uint32_t *link = &texture->first_request;
    while (*link != place)
        link = &s->requests.list[*link - 1].next;
    *link = request->next;
    give_back(&s->requests, request);
    texture->drop_due |= texture->hidden; /* no later map would let the request expire */
    slc_due_map_add(s, texture);
}

static bool is_over(const struct slc_texture_request *request, uint64_t now)
{
    return request->until != UINT64_MAX && now - request->until <= UINT64_MAX / 2;
}

void slc_texture_requests_expire(SluiceVulkanStreamer *s)
{
    for (uint32_t i = 0; i < s->requests.count && s->requests.live_count; i++)
        if (s->requests.list[i].live && is_over(&s->requests.list[i], s->time_stamp))
            end_request(s, &s->requests.list[i]);
}

void slc_texture_requests_drop(SluiceVulkanStreamer *s, struct slc_texture *texture)
{
    while (texture->first_request) {
        struct slc_texture_request *request = &s->requests.list[texture->first_request - 1];
        texture->first_request = request->next;
        give_back(&s->requests, request);
    }
}

void slc_texture_requests_merge(const SluiceVulkanStreamer *s, const struct slc_texture *texture,
                                uint8_t *map)
{
    for (uint32_t i = texture->first_request; i; i = s->requests.list[i - 1].next) {
        const struct slc_texture_request *request = &s->requests.list[i - 1];
        const struct slc_tile_rect *r = &request->regions;
        for (uint32_t y = r->y0; y < r->y1; y++) {
            uint8_t *row = map + (size_t)y * texture->layout.feedbackWidth;
            for (uint32_t x = r->x0; x < r->x1; x++)
                row[x] = request->level < row[x] ? request->level : row[x];
        }
    }
}

static SluiceResult describe(const SluiceVulkanStreamer *s, const struct slc_texture *texture,
                             const SluiceVulkanTextureRequest *given,
                             struct slc_texture_request *out)
{
    const SluiceStreamedTextureLayout *layout = &texture->layout;
    const struct slc_cells regions = {layout->desc.feedbackRegionWidth,
                                      layout->desc.feedbackRegionHeight, layout->feedbackWidth,
                                      layout->feedbackHeight};
    const struct slc_cells tiles = slc_min_mip_cells(layout);
    out->level = (uint8_t)slc_min_u32(given->level, layout->desc.mipLevelCount - 1);
    out->until = given->until;
    SluiceResult result = slc_texture_rect_cells(s, texture, &given->rect, &regions, &out->regions);
    if (result == SLUICE_SUCCESS)
        result = slc_texture_rect_cells(s, texture, &given->rect, &tiles, &out->tiles);
    return result;
}

SluiceResult sluiceRequestVulkanTexture(SluiceVulkanStreamer *streamer, SluiceTextureId textureId,
                                        const SluiceVulkanTextureRequest *pRequest,
                                        SluiceTextureRequestId *pRequestId)
{
    SluiceVulkanStreamer *s = streamer;
    if (!s || !pRequest)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceVulkanTextureRequest given = {.structSize = sizeof given};
    struct slc_texture *texture = NULL;
    struct slc_texture_request made = {.live = true};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceVulkanTextureRequest), &given, pRequest, &s->vk.log);
    if (result == SLUICE_SUCCESS)
        result = slc_streamer_find_primary(s, textureId, &texture);
    if (result == SLUICE_SUCCESS)
        result = describe(s, texture, &given, &made);
    if (result == SLUICE_SUCCESS)
        result = reserve(s);
    if (result == SLUICE_SUCCESS)
        result = slc_due_map_reserve(s, texture);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_texture_request *request = take(&s->requests);
    made.generation = request->generation;
    made.texture = (uint32_t)(texture - s->textures);
    made.next = texture->first_request;
    *request = made;
    texture->first_request = (uint32_t)(request - s->requests.list) + 1;
    slc_due_map_add(s, texture);
    if (pRequestId)
        *pRequestId = id_of(&s->requests, request);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceWithdrawVulkanRequest(SluiceVulkanStreamer *streamer,
                                         SluiceTextureRequestId requestId)
{
    if (!streamer)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_texture_request *request;
    SluiceResult result = find(streamer, requestId, &request);
    if (request)
        end_request(streamer, request);
    return result;
}

/* Progress ----------------------------------------------------------------------------------- */

static void count_tile(const SluiceVulkanStreamer *s, const struct slc_texture *texture,
                       uint32_t tile, SluiceVulkanRequestProgress *progress)
{
    SluiceTileState state;
    SluiceResult result = sluiceGetTileState(s->manager, texture->id, tile, &state, NULL);
    assert(result == SLUICE_SUCCESS);
    (void)result;
    progress->tileCount++;
    progress->residentTileCount +=
        state == SLUICE_TILE_STATE_MAPPED || state == SLUICE_TILE_STATE_STANDBY;
    progress->givenUpTileCount += state == SLUICE_TILE_STATE_GIVEN_UP;
}

/* Counts the tiles of a level. The parent of tile (x, y) is (x >> 1, y >> 1), clamped to its grid.
 */
static void count_level(const SluiceVulkanStreamer *s, const struct slc_texture_request *request,
                        uint32_t level, SluiceVulkanRequestProgress *progress)
{
    const struct slc_texture *texture = &s->textures[request->texture];
    const SluiceStreamedTextureLayout *layout = &texture->layout;
    uint32_t width = layout->levelWidthInTiles[level], height = layout->levelHeightInTiles[level];
    uint32_t x1 = slc_min_u32((request->tiles.x1 - 1) >> level, width - 1);
    uint32_t y1 = slc_min_u32((request->tiles.y1 - 1) >> level, height - 1);
    for (uint32_t y = slc_min_u32(request->tiles.y0 >> level, height - 1); y <= y1; y++)
        for (uint32_t x = slc_min_u32(request->tiles.x0 >> level, width - 1); x <= x1; x++)
            count_tile(s, texture, layout->levelFirstTile[level] + y * width + x, progress);
}

static SluiceVulkanRequestProgress progress_of(const SluiceVulkanStreamer *s,
                                               const struct slc_texture_request *request)
{
    SluiceVulkanRequestProgress progress = {.structSize = sizeof progress, .over = !request};
    if (!request)
        return progress;
    const struct slc_texture *texture = &s->textures[request->texture];
    const SluiceStreamedTextureLayout *layout = &texture->layout;
    for (uint32_t level = request->level; level < layout->desc.regularMipCount; level++)
        count_level(s, request, level, &progress);
    for (uint32_t tile = layout->regularTileCount; tile < layout->tileCount; tile++)
        count_tile(s, texture, tile, &progress);
    progress.ready = slc_texture_state(s, texture, &request->tiles).residentLevel <= request->level;
    return progress;
}

SluiceResult sluiceGetVulkanRequestProgress(const SluiceVulkanStreamer *streamer,
                                            SluiceTextureRequestId requestId,
                                            SluiceVulkanRequestProgress *pProgress)
{
    if (!streamer || !pProgress)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_struct *type = SLC_STRUCT(SluiceVulkanRequestProgress);
    struct slc_texture_request *request;
    SluiceResult result = slc_struct_check(type, pProgress, &streamer->vk.log);
    if (result == SLUICE_SUCCESS)
        result = find(streamer, requestId, &request);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceVulkanRequestProgress progress = progress_of(streamer, request);
    slc_struct_write(type, pProgress, &progress);
    return SLUICE_SUCCESS;
}
