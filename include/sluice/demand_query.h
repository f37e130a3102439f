/**
 * Says which tiles of a demand loader (demand.h) are resident and in which slots of memory, waits
 * for them, and lists what launches missed. Link `sluice-vulkan`.
 *
 * Thread safety: external on the loader.
 */
#ifndef SLUICE_DEMAND_QUERY_H
#define SLUICE_DEMAND_QUERY_H

#include <sluice/demand.h>

#ifdef __cplusplus
extern "C" {
#endif

/** State of a page. */
typedef enum SluiceDemandPageState {
    SLUICE_DEMAND_PAGE_ABSENT = 0,
    SLUICE_DEMAND_PAGE_PENDING = 1, ///< It is being loaded, or was refused for now.
    SLUICE_DEMAND_PAGE_RESIDENT = 2 ///< Launches from the next one on find it.
} SluiceDemandPageState;

/** Tile, or mip tail, of a texture. */
typedef struct SluiceDemandTileInfo {
    uint32_t structSize;          ///< sizeof(SluiceDemandTileInfo).
    bool isOpen;                  ///< The texture is open. If not, the fields below are 0.
    bool isTail;                  ///< All coarse levels from `level` on, which share a page.
    uint32_t page;                ///< Virtual page, as shaders request it.
    uint32_t level;               ///< First level of the page.
    uint32_t x, y, width, height; ///< Texels of `level` that the page has.
    SluiceDemandPageState state;
} SluiceDemandTileInfo;

/**
 * Finds the page of a texel of a level, in texels of that level. A variant has the pages of its
 * texture. Levels above the last one mean the last one.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for grids, for a texel outside, or for
 *         a wrong structSize.
 */
SLUICE_API SluiceResult sluiceGetDemandTileInfo(SluiceDemandLoader *loader,
                                                SluiceDemandTextureId textureId, uint32_t level,
                                                uint32_t x, uint32_t y,
                                                SluiceDemandTileInfo *pInfo);

/** Progress of the tiles of a rectangle. */
typedef struct SluiceDemandRegionProgress {
    uint32_t structSize; ///< sizeof(SluiceDemandRegionProgress).
    bool isOpen;         ///< The texture is open. If not, all tile counts are 0.
    bool failed;         ///< The texture cannot be opened for now.
    bool ready;          ///< Launches from the next one on find all tiles.
    uint32_t tileCount; ///< Tiles of the level and of all coarser ones; the mip tail counts as one.
    uint32_t residentTileCount;
    uint32_t pendingTileCount; ///< They are being read or made.
    uint32_t refusedTileCount; ///< They cannot be read, or there is no memory, for now.
} SluiceDemandRegionProgress;

/**
 * Gets how far the tiles are that a rectangle of a level covers, of that level and of all coarser
 * ones. Takes time in proportion to the tiles. The region's array layer is ignored. `pRegion` NULL:
 * all texels of level 0. A variant has the tiles of its texture.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for grids, for a wrong structSize, or
 *         if the texture is open and the rectangle leaves its level.
 */
SLUICE_API SluiceResult sluiceGetDemandRegionProgress(SluiceDemandLoader *loader,
                                                      SluiceDemandTextureId textureId,
                                                      const SluiceImageRegion *pRegion,
                                                      SluiceDemandRegionProgress *pProgress);

/** Why sluiceWaitDemandRegion returned. */
typedef enum SluiceDemandWaitStatus {
    SLUICE_DEMAND_WAIT_READY = 0, ///< Launches from the next one on find all tiles.
    /** The texture cannot be opened, or some tiles are refused and all others are resident. */
    SLUICE_DEMAND_WAIT_FAILED = 1,
    /** The next step is a launch: begin, end, submit and process one, and wait again. */
    SLUICE_DEMAND_WAIT_LAUNCH = 2,
    SLUICE_DEMAND_WAIT_TIMEOUT = 3, ///< Reads are still under way, and a launch has nothing to do.
    /** Some tiles are absent and not loading, and no launch is in progress: call
     *  sluicePreloadDemandRegion, or sample the tiles. */
    SLUICE_DEMAND_WAIT_NOT_REQUESTED = 4
} SluiceDemandWaitStatus;

/**
 * Waits for the tiles of a rectangle, at most `timeoutNs` nanoseconds: for loading screens. 0:
 * returns the status. `pRegion` is defined as in sluiceGetDemandRegionProgress.
 *
 * Launches copy and show tiles that were read, and start reads beyond maxTilesInFlight. So this
 * function returns SLUICE_DEMAND_WAIT_LAUNCH at once when a launch has something to do, and sleeps
 * while only reads are in progress. The function requests no tiles: call sluicePreloadDemandRegion
 * first. Threads of the context read meanwhile. On a thread of the application that runs reads,
 * pass 0.
 *
 * Errors: as sluiceGetDemandRegionProgress; SLUICE_ERROR_CANCELED after sluiceAbortDemandLoader.
 */
SLUICE_API SluiceResult sluiceWaitDemandRegion(SluiceDemandLoader *loader,
                                               SluiceDemandTextureId textureId,
                                               const SluiceImageRegion *pRegion, uint64_t timeoutNs,
                                               SluiceDemandWaitStatus *pStatus);

/** Kinds of missed pages. */
typedef enum SluiceDemandMissKind {
    SLUICE_DEMAND_MISS_OPENING = 0, ///< The texture was not open.
    SLUICE_DEMAND_MISS_TILE = 1,
    SLUICE_DEMAND_MISS_TAIL = 2,
    SLUICE_DEMAND_MISS_RESOURCE = 3, ///< Page of a resource.
    SLUICE_DEMAND_MISS_GONE = 4      ///< Its texture or resource was removed or closed since.
} SluiceDemandMissKind;

/** Page that a launch missed. Never grows. */
typedef struct SluiceDemandMiss {
    SluiceDemandMissKind kind;
    uint32_t page;  ///< Virtual page. Of resources: page of the resource.
    uint64_t id;    ///< Texture or resource. 0 if it is gone.
    uint32_t level; ///< Tiles and tails.
    uint32_t x, y;  ///< Tiles: column and row in tiles of the level.
} SluiceDemandMiss;

/**
 * Lists the pages that the launch processed last missed, in the order in which they are loaded: at
 * most maxRequestsPerLaunch, and none before the first one.
 *
 * Pages are looked up when this is called: a page that was given away since then and taken by
 * another texture is listed as that one's. Call it before textures are removed.
 *
 * Set `*pMissCount` to the capacity of `pMisses`. The call sets it to the number written. Returns
 * SLUICE_INCOMPLETE if there are more. With `pMisses` NULL, writes the number of misses.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceGetDemandMisses(const SluiceDemandLoader *loader,
                                              uint32_t *pMissCount, SluiceDemandMiss *pMisses);

/** Array image whose layers are slots of 64 KiB for tiles. Never grows. */
typedef struct SluiceDemandSlotImage {
    uint32_t image; ///< Upper 16 bits of places in the page table. Below 1024.
    SluiceFormat format;
    uint32_t slotCount;      ///< Layers.
    uint32_t usedSlotCount;  ///< Slots with tiles or mip tails of this loader.
    uint32_t otherSlotCount; ///< Slots of other loaders and streamers of the context.
} SluiceDemandSlotImage;

/**
 * Lists the array images of the context's tile memory, by ascending `image`: for pictures of
 * memory.
 *
 * Set `*pImageCount` to the capacity of `pImages`. The call sets it to the number written. Returns
 * SLUICE_INCOMPLETE if there are more. With `pImages` NULL, writes the number of images.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceGetDemandSlotImages(const SluiceDemandLoader *loader,
                                                  uint32_t *pImageCount,
                                                  SluiceDemandSlotImage *pImages);

/** State of a tile in a slot. */
typedef enum SluiceDemandSlotState {
    SLUICE_DEMAND_SLOT_LOADING = 0,  ///< The slot waits for the texels of the tile.
    SLUICE_DEMAND_SLOT_RESIDENT = 1, ///< Launches from the next one on find the tile.
    SLUICE_DEMAND_SLOT_STANDBY = 2 ///< Evicted; comes back without a read until the slot is taken.
} SluiceDemandSlotState;

/** Tile or mip tail in a slot. Never grows. */
typedef struct SluiceDemandSlot {
    uint32_t image; ///< As in SluiceDemandSlotImage.
    uint32_t layer;
    SluiceDemandSlotState state;
    bool isTail; ///< All coarse levels from `level` on.
    SluiceDemandTextureId textureId;
    uint32_t page;  ///< Virtual page, as in SluiceDemandTileInfo.
    uint32_t level; ///< First level of the page.
    uint32_t x, y;  ///< Tiles: column and row in tiles of the level.
} SluiceDemandSlot;

/**
 * Lists the tiles and mip tails with a slot, in no order. Includes evicted tiles whose slot is not
 * reused yet. Mip tails and equal tiles that share a slot are listed separately. Free slots are not
 * listed. Time: proportional to the number of slots.
 *
 * Set `*pSlotCount` to the capacity of `pSlots`. The call sets it to the number written. Returns
 * SLUICE_INCOMPLETE if there are more. With `pSlots` NULL, writes the number of entries.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceGetDemandSlots(const SluiceDemandLoader *loader, uint32_t *pSlotCount,
                                             SluiceDemandSlot *pSlots);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_DEMAND_QUERY_H */
