/**
 * Decides which tiles of which textures should be resident.
 *
 * The manager holds no image data, calls no graphics API and reads no clock. It turns feedback into
 * lists of tiles to map and to unmap, assigns each mapped tile a slot in a heap of the application,
 * and keeps a MinMip map per texture that tells shaders what they may sample. docs/manager.md
 * explains the frame loop, docs/manager-specification.md the exact rules.
 *
 * Usual order of calls in a frame:
 *
 *     sluiceCompleteRetireValue            work that the GPU has finished
 *     sluiceUpdateWithSamplerFeedback      for each map that was read back
 *     sluiceGetTilesToCancel               loads to stop     -> sluiceReportCanceledTiles
 *     sluiceGetTilesToUnmap                bindings to drop
 *     sluiceGetTilesToMap                  loads to start    -> sluiceUpdateTilesMapping, or
 *                                                               sluiceReportFailedTiles
 *     sluiceGetMinMipUpdates               rectangles to publish (sluiceWriteMinMipRect)
 *
 * States of a tile (sluiceGetTileState):
 *
 *     FREE -> REQUESTED -> ALLOCATED -> MAPPED -> STANDBY -> (unmapped, slot retiring) -> FREE
 *
 * - A tile is wanted while its texture's feedback requests it.
 * - A REQUESTED tile that is no longer wanted becomes FREE.
 * - An ALLOCATED tile that is no longer wanted becomes CANCELED. sluiceGetTilesToCancel lists it
 *   once. Its slot is released when the application answers.
 * - A prefetched tile is CANCELED from the start, and not listed.
 * - A STANDBY tile that is wanted again becomes MAPPED at once.
 * - A tile whose load failed is FAILED until its next try. After too many failures it is GIVEN_UP,
 *   and tried again much later.
 *
 * Thread safety of all functions here: external on the manager. Calls that take a const manager may
 * run at the same time. Different managers are independent: one manager per thread requires no
 * lock.
 */
#ifndef SLUICE_MANAGER_H
#define SLUICE_MANAGER_H

#include <sluice/base.h>
#include <sluice/heap.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SluiceStreamedTextureManager SluiceStreamedTextureManager;

/**
 * Id of a texture. Never 0 and never reused.
 *
 * The low 32 bits are an index, which is reused: a new texture gets the lowest free index, from 0.
 * The high 32 bits are a generation, which is not reused.
 */
typedef uint64_t SluiceTextureId;

/** No texture. Value of an id in a zeroed struct. */
#define SLUICE_NO_TEXTURE ((SluiceTextureId)0)
/** All textures of a manager, in calls that say so. Never the id of a texture. */
#define SLUICE_ALL_TEXTURES ((SluiceTextureId)UINT64_MAX)

/** In a feedback map: nothing was sampled. In a MinMip map: not even packed levels are resident. */
#define SLUICE_MIP_UNTOUCHED 255

/** Levels of the longest mip chain (2^20 texels). */
#define SLUICE_MAX_MIP_LEVELS 21
#define SLUICE_MAX_TEXTURE_SIZE (1u << 20)
/** Most tiles of one texture, regular and packed, and most regions of one feedback map. */
#define SLUICE_MAX_TILES_PER_TEXTURE (1u << 30)

/** Settings that are fixed at creation. */
typedef struct SluiceStreamedTextureManagerCreateInfo {
    uint32_t structSize;               ///< sizeof(SluiceStreamedTextureManagerCreateInfo).
    SluiceHeapAllocator heapAllocator; ///< Both functions are required.
    /** Must outlive the manager. Default: malloc and free. */
    const SluiceAllocationCallbacks *pAllocator;
    uint32_t heapTileCapacity; ///< Slots per heap, 1 to 2^20. Recommended: 256.
    uint32_t tileSize;         ///< Bytes per slot, above 0. 65536 for GPU tiles.
    bool alwaysMapPackedTiles; ///< Packed tiles stay wanted as long as the texture exists.
    /**
     * Locks the manager while `*pLocked` is true, so that its owner can hand it to other code.
     * Default: NULL, never locked. The bool must outlive the manager.
     *
     * Locked calls return SLUICE_ERROR_INVALID_ARGUMENT and change nothing: adding, removing and
     * linking textures, feedback, lists of tiles and MinMip rectangles, answers, retire values,
     * defragmentation and evacuation. sluiceDestroyStreamedTextureManager does nothing. Queries,
     * configuration, trimming, heaps, retries and recording still work.
     */
    const bool *pLocked;
    SluiceLogCallback log; ///< Why an argument is refused with SLUICE_ERROR_INVALID_ARGUMENT.
} SluiceStreamedTextureManagerCreateInfo;

/** Recommended values for the create-info. */
#define SLUICE_DEFAULT_HEAP_TILE_CAPACITY 256u
#define SLUICE_DEFAULT_TILE_SIZE 65536u

/** Settings that can change at any time. All are 0 after creation. */
typedef struct SluiceStreamedTextureManagerConfig {
    uint32_t structSize; ///< sizeof(SluiceStreamedTextureManagerConfig).
    /** Most tiles that stay STANDBY. Further ones are listed for unmapping, oldest first. Tiles
     *  without slots (packedTilesOutside) are counted separately, up to the same number.
     *  Default: 0, none. */
    uint32_t numExtraStandbyTiles;
    uint32_t maxHeapCount;    ///< Most heaps. Default: as many as the allocator grants.
    uint32_t maxLoadAttempts; ///< Failed loads until a tile is GIVEN_UP. Default: 5.
    uint64_t retryDelayTicks; ///< Time from the first failure to the next try; doubles. Default: 0.
    /**
     * Consecutive maps that must miss a region, in addition to the timeout, before the region is no
     * longer wanted. Each coarser level takes a quarter as many, because more regions see it.
     *
     * Default (0): learned per texture from how often maps miss what earlier and later maps show.
     * Tiles that are still visible are then not evicted because stochastic feedback missed them. 1:
     * only the timeout counts.
     */
    uint32_t missesToExpire;
    /**
     * Number of coarsest regular levels to prefetch, of all textures. They are loaded while nothing
     * is requested, a slot is free and fewer than numExtraStandbyTiles tiles are STANDBY. New views
     * then sharpen sooner, at the cost of more uploads. Default: 0, none.
     */
    uint32_t prefetchLevels;
    /**
     * Time until GIVEN_UP tiles of a texture are tried again: four tiles first, and all when one of
     * them loads. Default: 120 * retryDelayTicks; never if retryDelayTicks is 0. UINT64_MAX: never.
     */
    uint64_t givenUpRetryDelayTicks;
    /**
     * Number of heaps to shrink to. While more heaps exist, tiles are evicted until the rest fits
     * into targetHeapCount heaps: STANDBY tiles, oldest first, then wanted tiles, finest first. No
     * heap is allocated meanwhile. Packed tiles stay. Make the heaps empty with
     * sluiceEvacuateHeaps, and release them with sluiceGetEmptyHeaps and sluiceReleaseHeap.
     * Default: 0, never shrink.
     */
    uint32_t targetHeapCount;
    /** Requests never evict resident tiles: they wait for free slots. targetHeapCount still evicts.
     */
    bool noEviction;
    bool noMipBias; ///< The global mip bias becomes 0 and stays 0.
    /**
     * Packed tiles get heaps of their own, if the allocator and the limits grant one. Packed tiles
     * stay while their texture does, so heaps of regular tiles can run empty. Costs at most one
     * heap that is not full. Other tiles take slots of these heaps before requests are refused.
     */
    bool separatePackedTiles;
} SluiceStreamedTextureManagerConfig;

/**
 * Shape of a texture. Level l has max(1, width >> l) x max(1, height >> l) texels.
 *
 * Levels [0, regularMipCount) are regular: cut into tiles of tileWidth x tileHeight texels, smaller
 * at the right and bottom edge. Levels [regularMipCount, mipLevelCount) are packed: they form the
 * mip tail, and share packedTileCount tiles.
 *
 * Tiles are numbered level by level from level 0, row by row. Packed tiles come last. Never grows.
 */
typedef struct SluiceStreamedTextureDesc {
    uint32_t width, height;         ///< Texels of level 0, 1 to SLUICE_MAX_TEXTURE_SIZE.
    uint32_t mipLevelCount;         ///< 1 to floor(log2(max(width, height))) + 1.
    uint32_t regularMipCount;       ///< 0 to mipLevelCount.
    uint32_t packedTileCount;       ///< Above 0 if regularMipCount < mipLevelCount, else 0.
    uint32_t tileWidth, tileHeight; ///< Texels, above 0.
    /** Texels of level 0 per feedback texel. Default: the tile size. */
    uint32_t feedbackRegionWidth, feedbackRegionHeight;
    /**
     * Packed tiles take no slots, because their memory is outside the heaps. They are handed out
     * and answered like other tiles, with heapId and slot 0, even if no slot is free. The global
     * mip bias does not count them. Default: false.
     */
    bool packedTilesOutside;
} SluiceStreamedTextureDesc;

/** Layout computed from a SluiceStreamedTextureDesc. */
typedef struct SluiceStreamedTextureLayout {
    uint32_t structSize;            ///< sizeof(SluiceStreamedTextureLayout).
    SluiceStreamedTextureDesc desc; ///< With region sizes filled in.
    uint32_t regularTileCount; ///< Tiles of all regular levels. Index of the first packed tile.
    uint32_t tileCount;        ///< regularTileCount + packedTileCount.
    uint32_t feedbackWidth, feedbackHeight; ///< Regions: ceil(width / feedbackRegionWidth), ...
    /** One MinMip texel per tile of level 0. 1x1 without regular levels. */
    uint32_t minMipWidth, minMipHeight;
    uint32_t levelWidthInTiles[SLUICE_MAX_MIP_LEVELS];  ///< Regular levels only.
    uint32_t levelHeightInTiles[SLUICE_MAX_MIP_LEVELS]; ///< Regular levels only.
    uint32_t levelFirstTile[SLUICE_MAX_MIP_LEVELS];     ///< Regular levels only.
} SluiceStreamedTextureLayout;

/** Resolved feedback map. */
typedef struct SluiceFeedbackDesc {
    uint32_t structSize; ///< sizeof(SluiceFeedbackDesc).
    /**
     * [height][width] bytes, row 0 first, tightly packed. A texel is the finest mip level that its
     * region requests, or SLUICE_MIP_UNTOUCHED if nothing was sampled there. Values above the last
     * level mean the last level.
     */
    const uint8_t *pMinMip;
    uint32_t width, height; ///< Must be the texture's feedbackWidth and feedbackHeight.
    int32_t mipBias;        ///< Levels, added to each requested level before clamping to the chain.
    /** Number of coarsest regular levels that may be requested. Default: all. */
    uint32_t streamedMipLevels;
} SluiceFeedbackDesc;

/** State of a tile. The transitions are listed at the top of this header. */
typedef enum SluiceTileState {
    SLUICE_TILE_STATE_FREE = 0,      ///< No memory, not wanted.
    SLUICE_TILE_STATE_REQUESTED = 1, ///< Wanted. Waits for sluiceGetTilesToMap.
    SLUICE_TILE_STATE_ALLOCATED = 2, ///< Has a slot and is being loaded.
    SLUICE_TILE_STATE_MAPPED = 3,    ///< Resident and wanted.
    SLUICE_TILE_STATE_STANDBY = 4,   ///< Resident; not wanted, or evicted to make room.
    SLUICE_TILE_STATE_CANCELED = 5,  ///< Being loaded, but not wanted. Waits for an answer.
    SLUICE_TILE_STATE_FAILED = 6,    ///< Wanted. Its load failed and will be retried.
    SLUICE_TILE_STATE_GIVEN_UP = 7   ///< Its load failed too often. See givenUpRetryDelayTicks.
} SluiceTileState;

/** Tile, and its slot if it has one. Never grows. */
typedef struct SluiceTile {
    SluiceTextureId textureId;
    uint32_t tileIndex;
    uint32_t mipLevel; ///< regularMipCount for packed tiles.
    uint32_t x, y;     ///< In tiles of its level. Packed tiles: x counts from 0, y is 0.
    uint32_t heapId;
    uint32_t slot; ///< Index in the heap, 0 to heapTileCapacity - 1.
} SluiceTile;

/** Why a tile changed its state. */
typedef enum SluiceTileEventReason {
    SLUICE_TILE_EVENT_FEEDBACK = 0,   ///< A map requests the tile, or no map does any longer.
    SLUICE_TILE_EVENT_ADDED = 1,      ///< Its texture was added: packed tiles with
                                      ///< alwaysMapPackedTiles.
    SLUICE_TILE_EVENT_LISTED = 2,     ///< sluiceGetTilesToMap returned it.
    SLUICE_TILE_EVENT_PREFETCHED = 3, ///< As before, and nothing requests it (prefetchLevels).
    SLUICE_TILE_EVENT_ANSWERED = 4,   ///< Its load arrived, failed, or was canceled.
    SLUICE_TILE_EVENT_RETRIED = 5,    ///< Its load had failed; it is due again.
    SLUICE_TILE_EVENT_EVICTED = 6,    ///< Others need its slot.
    SLUICE_TILE_EVENT_UNMAPPED = 7,   ///< sluiceGetTilesToUnmap returned it.
    SLUICE_TILE_EVENT_CALLED = 8,     ///< sluiceEvictStreamedTexture.
    SLUICE_TILE_EVENT_REMOVED = 9     ///< Its texture was removed or forgotten.
} SluiceTileEventReason;

/** Change of a tile's state. Never grows. */
typedef struct SluiceTileEvent {
    SluiceTextureId textureId;
    uint64_t timeStamp; ///< The last one that the manager was given. 0 before the first.
    uint64_t mark;      ///< sluiceMarkTileEvents.
    uint32_t tileIndex;
    SluiceTileState from, to;
    SluiceTileEventReason reason;
} SluiceTileEvent;

/** Most events that a manager keeps. */
#define SLUICE_MAX_TILE_EVENTS (1u << 24)

/**
 * Move of a tile: copy the contents of `from` to (heapId, slot) and bind the tile there. Never
 * grows.
 */
typedef struct SluiceTileMove {
    SluiceTile from; ///< Tile and its old slot.
    uint32_t heapId;
    uint32_t slot;
} SluiceTileMove;

/** Rectangle of a MinMip map, in its texels. Never grows. */
typedef struct SluiceMinMipRect {
    SluiceTextureId textureId;
    uint32_t x, y, width, height;
} SluiceMinMipRect;

/** Statistics. `...Total` counts since creation and wraps at 2^64; other counts are current. */
typedef struct SluiceStreamedTextureStatistics {
    uint32_t structSize; ///< sizeof(SluiceStreamedTextureStatistics).
    uint32_t textureCount;
    uint64_t tileCount; ///< All tiles of all textures, resident or not.
    uint32_t requestedTileCount, allocatedTileCount, mappedTileCount, standbyTileCount;
    uint32_t canceledTileCount, failedTileCount, givenUpTileCount;
    uint32_t retiringSlotCount; ///< Slots of unmapped tiles that the GPU may still read.
    uint32_t heapCount, freeSlotCount;
    uint32_t reservedSlotCount; ///< Slots kept free for packed tiles.
    uint32_t globalMipBias;     ///< LOD bias added to every request, in sixteenths of a level.
    uint64_t handedOutTotal, mappedTotal, unmappedTotal, canceledTotal, failedTotal;
    uint64_t restoredTotal; ///< STANDBY -> MAPPED, without a load.
    uint64_t movedTotal;
    uint64_t hostMemorySize;      ///< Bytes currently allocated from pAllocator.
    uint64_t givenUpRetriedTotal; ///< GIVEN_UP -> REQUESTED, except by sluiceRetryFailedTiles.
} SluiceStreamedTextureStatistics;

/** Statistics of a texture. `...Total` counts since it was added, and wraps at 2^32. */
typedef struct SluiceTextureStatistics {
    uint32_t structSize;         ///< sizeof(SluiceTextureStatistics).
    uint32_t residentTileCount;  ///< MAPPED or STANDBY, packed tiles included.
    uint32_t requestedTileCount; ///< REQUESTED.
    uint32_t mappedTotal;        ///< Loads that arrived.
    uint32_t unmappedTotal;      ///< Tiles listed by sluiceGetTilesToUnmap.
    uint32_t failedTotal;        ///< Loads that failed.
    bool wanted;                 ///< Some region requests a level now.
    bool seen;                   ///< Some map requested something.
    uint64_t seenTime;           ///< Time stamp of the last map that did. 0 if none did.
    uint32_t wantedTileCount; ///< Tiles that maps request, resident or not, packed ones included.
    /** Bytes of the slots of resident tiles, and of all wanted tiles if they were resident. Packed
     * tiles without slots take none. */
    uint64_t residentSize, wantedSize;
} SluiceTextureStatistics;

/** Statistics of a level of a texture. Sizes are bytes of slots. */
typedef struct SluiceTextureLevelStatistics {
    uint32_t structSize; ///< sizeof(SluiceTextureLevelStatistics).
    uint32_t tileCount;  ///< Of the level. All packed levels are one.
    uint32_t residentTileCount;
    uint32_t wantedTileCount; ///< That maps request, resident or not.
    uint64_t residentSize, wantedSize;
} SluiceTextureLevelStatistics;

/** Greatest priority of a texture; the least is the negative of it. */
#define SLUICE_MAX_PRIORITY 16

/**
 * Creates a manager without textures and heaps.
 *
 * `*pCreateInfo` is copied; objects that it points to must outlive the manager. The caller owns
 * `*pManager` and destroys it with sluiceDestroyStreamedTextureManager. `*pManager` is NULL after
 * an error.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER if an argument or a heap callback is NULL;
 *         SLUICE_ERROR_ZERO_HEAP_CAPACITY if the heap capacity or tile size is 0;
 *         SLUICE_ERROR_INVALID_ARGUMENT if the capacity is above 2^20 or only one of pAllocator's
 *         functions is set; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult
sluiceCreateStreamedTextureManager(const SluiceStreamedTextureManagerCreateInfo *pCreateInfo,
                                   SluiceStreamedTextureManager **pManager);

/** Releases every heap through the heap allocator, then destroys the manager. NULL is allowed. */
SLUICE_API void sluiceDestroyStreamedTextureManager(SluiceStreamedTextureManager *manager);

/**
 * Changes the configuration. It takes effect at once: a smaller numExtraStandbyTiles lists tiles
 * for unmapping. A maxHeapCount below the number of existing heaps releases none of them.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceSetConfig(SluiceStreamedTextureManager *manager,
                                        const SluiceStreamedTextureManagerConfig *pConfig);

/**
 * Computes the layout of a texture without a manager. `*pLayout` is unchanged after an error.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_ZERO_TILES if a size is 0 or there is no level;
 *         SLUICE_ERROR_INVALID_PACKED_MIPS if regularMipCount > mipLevelCount or packedTileCount
 *         contradicts it; SLUICE_ERROR_INVALID_ARGUMENT if a size or level count is out of range;
 *         SLUICE_ERROR_LIMIT_EXCEEDED for more than SLUICE_MAX_TILES_PER_TEXTURE tiles or regions.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetStreamedTextureLayout(const SluiceStreamedTextureDesc *pDesc,
                                                       SluiceStreamedTextureLayout *pLayout);

/**
 * Adds a texture. Its tiles are FREE; with alwaysMapPackedTiles its packed tiles are REQUESTED.
 *
 * Errors: as sluiceGetStreamedTextureLayout; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceAddStreamedTexture(SluiceStreamedTextureManager *manager,
                                                 const SluiceStreamedTextureDesc *pDesc,
                                                 SluiceTextureId *pTextureId);

/**
 * Removes a texture, whatever the states of its tiles.
 *
 * Its slots, including those of loads in progress, are released once `retireValue` has completed.
 * Its tiles are no longer listed, and late answers return SLUICE_ERROR_STALE_TEXTURE. Textures that
 * follow it have no primary from now on.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_TIME_BACKWARDS if `retireValue` is below an earlier one.
 */
SLUICE_API SluiceResult sluiceRemoveStreamedTexture(SluiceStreamedTextureManager *manager,
                                                    SluiceTextureId textureId,
                                                    uint64_t retireValue);

/**
 * Forgets a texture that nothing wants: makes all of its tiles FREE, and drops the requests of its
 * maps. The texture stays. Its next map requests tiles as the first map did.
 *
 * The tiles are not listed by sluiceGetTilesToUnmap. Shaders must not sample them from now on.
 * Their slots are released once `retireValue` has completed. Packed tiles are forgotten only if
 * alwaysMapPackedTiles is off.
 *
 * Returns SLUICE_NOT_READY, with nothing changed, while a map of the texture still counts, or while
 * a tile is in another state than FREE or STANDBY.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_TIME_BACKWARDS if `retireValue` is below an earlier one.
 */
SLUICE_API SluiceResult sluiceForgetStreamedTexture(SluiceStreamedTextureManager *manager,
                                                    SluiceTextureId textureId,
                                                    uint64_t retireValue);

/**
 * Evicts a texture that is out of sight: drops the requests of all its maps, and lists its STANDBY
 * tiles for unmapping until at most `keepTileCount` are left, finer levels first. UINT32_MAX keeps
 * all tiles STANDBY.
 *
 * Followers of the texture are evicted, too, and keep at most `keepTileCount` tiles each. Tiles
 * that are being loaded are CANCELED. Packed tiles stay wanted if alwaysMapPackedTiles is on. The
 * next map requests tiles as usual, and restores requested tiles that are still STANDBY.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, SLUICE_ERROR_UNKNOWN_TEXTURE, SLUICE_ERROR_STALE_TEXTURE.
 */
SLUICE_API SluiceResult sluiceEvictStreamedTexture(SluiceStreamedTextureManager *manager,
                                                   SluiceTextureId textureId,
                                                   uint32_t keepTileCount);

/**
 * Gets the layout of a texture.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, SLUICE_ERROR_UNKNOWN_TEXTURE, SLUICE_ERROR_STALE_TEXTURE.
 */
SLUICE_API SluiceResult sluiceGetTextureLayout(const SluiceStreamedTextureManager *manager,
                                               SluiceTextureId textureId,
                                               SluiceStreamedTextureLayout *pLayout);

/**
 * Merges a feedback map into the requests of a texture and of the textures that follow it.
 *
 * Requested level: a region requests the finest level of this map and earlier ones, made coarser by
 * the global mip bias while more is wanted than slots can hold.
 *
 * Expiry: a request counts for at least `timeout`, even while slots are short, and until as many
 * maps have missed it as missesToExpire says. Maps that are close in time expire together, at most
 * a quarter of the timeout and one map late. A request that has expired stays expired, even if a
 * later call passes a longer timeout. A texture without new maps keeps its requests, unless
 * sluiceGetTilesToMap needs its slots.
 *
 * Tiles: a region that requests a level wants every tile of that level that it touches, the parents
 * of those tiles up to the coarsest regular level, and the packed tiles. The parent of tile (x, y)
 * is (x >> 1, y >> 1), clamped to the grid of the coarser level. A tile that becomes wanted is
 * REQUESTED, or MAPPED if it was STANDBY. A tile that is no longer wanted becomes FREE, CANCELED
 * or STANDBY.
 *
 * The map is read during the call and not kept. `timeStamp` and `timeout` share any unit you like.
 * Time stamps must not decrease, over all textures; they may wrap at 2^64. After an error the
 * manager is unchanged.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, SLUICE_ERROR_UNKNOWN_TEXTURE, SLUICE_ERROR_STALE_TEXTURE,
 *         SLUICE_ERROR_SIZE_MISMATCH, SLUICE_ERROR_TIME_BACKWARDS, SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Source: RTXTS Integration Guide, "Render Flow"; encoding as in the Direct3D Sampler Feedback
 * specification, "MinMip feedback map", "Decoded representation".
 */
SLUICE_API SluiceResult sluiceUpdateWithSamplerFeedback(SluiceStreamedTextureManager *manager,
                                                        SluiceTextureId textureId,
                                                        const SluiceFeedbackDesc *pFeedback,
                                                        uint64_t timeStamp, uint64_t timeout);

/**
 * Merges the last feedback map of a primary texture into a follower once, matched in UV.
 *
 * Sizes, tile shapes and level counts may differ, and sluiceSetUvTransform moves the follower
 * against the primary. Level m of the primary becomes level m +
 * floor(log2(min(width ratio, height ratio))) of the follower, at least 0. The result is merged
 * like a map of the follower's own; a follower that is matched with several primaries within
 * `timeout` holds the union. Does nothing if the primary never had a map, or if the follower has no
 * regular level and no packed tile to request.
 *
 * Errors: as sluiceUpdateWithSamplerFeedback; SLUICE_ERROR_INVALID_ARGUMENT if both are the same
 *         texture.
 */
SLUICE_API SluiceResult sluiceMatchPrimaryTexture(SluiceStreamedTextureManager *manager,
                                                  SluiceTextureId primaryId,
                                                  SluiceTextureId followerId, uint64_t timeStamp,
                                                  uint64_t timeout);

/**
 * Makes a texture follow a primary: each later feedback map of the primary is matched to it.
 *
 * SLUICE_NO_TEXTURE as primary ends following. Current requests of the follower expire only with
 * later maps.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT if the primary is the texture itself or follows another, or
 *         if the texture has followers; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceSetPrimaryTexture(SluiceStreamedTextureManager *manager,
                                                SluiceTextureId followerId,
                                                SluiceTextureId primaryId);

/**
 * Sets the priority of a texture: -SLUICE_MAX_PRIORITY to SLUICE_MAX_PRIORITY. Default: 0. A
 * texture that follows a primary has the primary's priority.
 *
 * Priorities order tiles of one level. Coarser levels still come first. A priority that is higher
 * by 1 counts as if twice as much of level 0 requested each tile of the texture. While slots are
 * short, a request may evict wanted tiles of less priority, of the same level or a finer one. The
 * finest wanted tiles are evicted first, and among them the tiles of the least priority. Priorities
 * do not change the number of slots or the global mip bias. If not even coarse levels fit, use
 * finestLevel or mipBias.
 *
 * Waiting requests of the texture are reordered at once. They come behind waiting requests of equal
 * order.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a priority out of range.
 */
SLUICE_API SluiceResult sluiceSetTexturePriority(SluiceStreamedTextureManager *manager,
                                                 SluiceTextureId textureId, int32_t priority);

/** Wrap mode of a texture outside of UV 0 to 1. Values equal VkSamplerAddressMode, except borders.
 */
typedef enum SluiceUvWrap {
    SLUICE_UV_WRAP_REPEAT = 0,
    SLUICE_UV_WRAP_MIRROR = 1,
    SLUICE_UV_WRAP_CLAMP = 2,
    SLUICE_UV_WRAP_MIRROR_CLAMP = 3 ///< Mirrored once, at 0; then clamped.
} SluiceUvWrap;

/** UV of a follower: UV * scale + offset, where UV is the primary's. Never grows. */
typedef struct SluiceUvTransform {
    float scaleU, scaleV;      ///< 1/4096 to 4096, or the negative of that.
    float offsetU, offsetV;    ///< -4096 to 4096.
    SluiceUvWrap wrapU, wrapV; ///< Of the follower.
} SluiceUvTransform;

/**
 * Sets where a texture is sampled when it follows a primary: a detail map that repeats 8 times has
 * scales of 8. NULL: where the primary is. Counts from the next map that is matched, until it is
 * set again.
 *
 * Regions: a region of the follower requests the finest level of the primary's regions that sample
 * it. Levels: level m of the primary becomes level m + floor(log2(min(width ratio * |scaleU|,
 * height ratio * |scaleV|))), at least 0. Scales and offsets are rounded to multiples of 2^-24.
 *
 * The primary's map knows UVs within 0 to 1 only. So if the primary repeats, scales must be whole
 * numbers. A texture with other UVs, or rotated ones, needs feedback of its own: no primary.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a value out of range;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY. Nothing has changed after an error.
 */
SLUICE_API SluiceResult sluiceSetUvTransform(SluiceStreamedTextureManager *manager,
                                             SluiceTextureId textureId,
                                             const SluiceUvTransform *pTransform);

/**
 * Returns tiles to load. Reserves a slot for each and makes it ALLOCATED.
 *
 * With `pTiles` NULL, writes the number of REQUESTED tiles and changes nothing. Otherwise
 * `*pTileCount` is the capacity of `pTiles` on entry and the number written on return.
 *
 * Order: packed tiles first, then coarser levels before finer ones. Within a level, tiles that
 * more of level 0 requests come first (compared in powers of two), then earlier requests. While
 * slots are short, regular tiles that their texture's last map does not request are skipped.
 *
 * Scope: `textureId` restricts the list to one texture. Such a call leaves free slots to coarser
 * requests of other textures, so call it for each texture in turn. SLUICE_ALL_TEXTURES covers all;
 * idle textures cost nothing. If no request is left, such a call may also return tiles to prefetch
 * (prefetchLevels). These are CANCELED at once and not listed by sluiceGetTilesToCancel.
 *
 * Slots: if no slot is free (for regular tiles: no more than reservedSlotCount) the heap allocator
 * is called, and may refuse once per call. If it refuses, the requests wait, and one slot is
 * reclaimed per waiting request, whatever the capacity of `pTiles`:
 * - STANDBY tiles are listed for unmapping, oldest first.
 * - If they are too few, textures that had no map for four times their usual interval and timeout
 *   no longer want anything.
 * - If no texture is that idle, wanted tiles are evicted, finest first. They are listed for
 *   unmapping and STANDBY until then, and REQUESTED after that.
 *
 * Wanted tiles that a request may evict:
 * - A tile that its texture's last map does not show: for a request of a coarser level, or of the
 *   same level if the request has waited for a whole round of maps.
 * - A tile that the last map shows: for a request at least three levels coarser; two if the request
 *   has waited for a round; one if it has waited for 4 to 7 rounds.
 * - Any regular tile: for a packed tile.
 *
 * docs/manager-specification.md has the exact rules.
 *
 * Answer every returned tile with sluiceUpdateTilesMapping, sluiceReportFailedTiles or
 * sluiceReportCanceledTiles, or remove its texture.
 *
 * Returns SLUICE_INCOMPLETE if requests are left because `pTiles` is full or because they were all
 * skipped. Returns SLUICE_BUDGET_REACHED if requests are left for lack of slots.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT for SLUICE_NO_TEXTURE; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceGetTilesToMap(SluiceStreamedTextureManager *manager,
                                            SluiceTextureId textureId, uint32_t *pTileCount,
                                            SluiceTile *pTiles);

/**
 * Reports that the data of ALLOCATED tiles is in place and may be sampled: they become MAPPED.
 *
 * CANCELED tiles, including prefetched ones, may be reported as well. They become MAPPED if they
 * are wanted by now, else STANDBY.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_UNKNOWN_TILE; SLUICE_ERROR_INVALID_TILE_STATE if a tile was not handed out,
 *         was answered already or appears twice in the list.
 */
SLUICE_API SluiceResult sluiceUpdateTilesMapping(SluiceStreamedTextureManager *manager,
                                                 SluiceTextureId textureId, uint32_t tileCount,
                                                 const uint32_t *pTileIndices);

/**
 * Reports that loading ALLOCATED or CANCELED tiles failed and that nothing of them was written.
 * Their slots are free at once.
 *
 * Wanted tiles become FAILED. They become REQUESTED again with the first call whose time stamp is
 * at least `timeStamp + retryDelayTicks * 2^(failures - 1)`. After maxLoadAttempts failures they
 * are GIVEN_UP: the MinMip map stays at the coarser level, and the next try follows after
 * givenUpRetryDelayTicks. A tile that is no longer wanted resets its count of failures.
 *
 * Retrying GIVEN_UP tiles: after givenUpRetryDelayTicks the four tiles of a texture that were given
 * up first become REQUESTED as a probe. At most 16 textures are probed at a time. Packed tiles that
 * follow the four are included. One more failure makes a probe GIVEN_UP again. When a tile that had
 * failed is MAPPED, all GIVEN_UP tiles of its texture become REQUESTED, once per probe. When
 * another tile of the texture is MAPPED, and an eighth of the delay has passed, the texture is
 * probed at once.
 *
 * Errors: as sluiceUpdateTilesMapping; SLUICE_ERROR_TIME_BACKWARDS;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceReportFailedTiles(SluiceStreamedTextureManager *manager,
                                                SluiceTextureId textureId, uint32_t tileCount,
                                                const uint32_t *pTileIndices, uint64_t timeStamp);

/**
 * Makes all GIVEN_UP and FAILED tiles of a texture REQUESTED at once; with SLUICE_ALL_TEXTURES,
 * those of all textures. Tiles that were GIVEN_UP reset their count of failures. Call it when you
 * learn that a source can be read again.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT for SLUICE_NO_TEXTURE.
 */
SLUICE_API SluiceResult sluiceRetryFailedTiles(SluiceStreamedTextureManager *manager,
                                               SluiceTextureId textureId);

/**
 * Lists tiles that became GIVEN_UP and were not listed yet. A tile is listed once, however often it
 * is given up. heapId and slot have no meaning here. Uses `pTileCount` and `pTiles` as
 * sluiceGetTilesToMap.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceGetGivenUpTiles(SluiceStreamedTextureManager *manager,
                                              uint32_t *pTileCount, SluiceTile *pTiles);

/**
 * Returns CANCELED tiles whose loads can be stopped, each once.
 *
 * A tile that is wanted again before it is returned becomes ALLOCATED again and is not listed. A
 * tile that is wanted again later becomes REQUESTED when it is answered. Uses `textureId`,
 * `pTileCount` and `pTiles` as sluiceGetTilesToMap.
 *
 * Errors: as sluiceGetTilesToMap.
 */
SLUICE_API SluiceResult sluiceGetTilesToCancel(SluiceStreamedTextureManager *manager,
                                               SluiceTextureId textureId, uint32_t *pTileCount,
                                               SluiceTile *pTiles);

/**
 * Reports that CANCELED tiles were not loaded and never mapped. ALLOCATED tiles may be given back
 * in the same way; wanted ones become REQUESTED again.
 *
 * The slots are released once `retireValue` has completed. Pass 0 to release them at once. If a
 * bind or copy was already recorded, pass the value of its frame.
 *
 * Errors: as sluiceUpdateTilesMapping; SLUICE_ERROR_TIME_BACKWARDS;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceReportCanceledTiles(SluiceStreamedTextureManager *manager,
                                                  SluiceTextureId textureId, uint32_t tileCount,
                                                  const uint32_t *pTileIndices,
                                                  uint64_t retireValue);

/**
 * Returns tiles whose bindings are to be dropped: STANDBY tiles beyond numExtraStandbyTiles and
 * tiles whose slots are required, oldest first.
 *
 * The tiles become FREE, or REQUESTED if they were evicted while wanted. The MinMip maps no longer
 * show them. Their slots are released once `retireValue` has completed. It must complete after
 * every use of the old MinMip maps. A tile that is wanted again before it is returned becomes
 * MAPPED and is not listed. Uses `textureId`, `pTileCount` and `pTiles` as sluiceGetTilesToMap.
 *
 * Errors: as sluiceGetTilesToMap; SLUICE_ERROR_TIME_BACKWARDS; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceGetTilesToUnmap(SluiceStreamedTextureManager *manager,
                                              SluiceTextureId textureId, uint64_t retireValue,
                                              uint32_t *pTileCount, SluiceTile *pTiles);

/**
 * Reports that the GPU has finished everything up to `retireValue`. Slots that wait for such values
 * are released.
 *
 * A retire value is a frame number or timeline semaphore value. Values passed to calls that release
 * slots must not decrease, nor must values passed here. 0 is always complete.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, SLUICE_ERROR_TIME_BACKWARDS.
 */
SLUICE_API SluiceResult sluiceCompleteRetireValue(SluiceStreamedTextureManager *manager,
                                                  uint64_t retireValue);

/**
 * Lists STANDBY tiles for unmapping, oldest first, until at most `keepTileCount` are left. Tiles
 * without slots (packedTilesOutside) are not counted and stay.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceTrimStandbyTiles(SluiceStreamedTextureManager *manager,
                                               uint32_t keepTileCount);

/**
 * Returns moves that empty the least used heaps into fuller ones, at most `*pMoveCount`.
 *
 * Make the copies in the order of the list: a tile may move more than once. MAPPED and STANDBY
 * tiles belong to their new slots when the call returns. The old slots are released once
 * `retireValue` has completed. Every listed move helps to empty a heap, so repeated calls end.
 * `*pMoveCount` is the number written on return. `pMoves` must not be NULL.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, SLUICE_ERROR_TIME_BACKWARDS, SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceDefragmentTiles(SluiceStreamedTextureManager *manager,
                                              uint64_t retireValue, uint32_t *pMoveCount,
                                              SluiceTileMove *pMoves);

/**
 * Evicts tiles of the least used heap that can be emptied, at most `maxTileCount`. They are listed
 * for unmapping. Wanted tiles are REQUESTED afterwards, and get slots of fuller heaps.
 *
 * For applications that cannot make the copies of sluiceDefragmentTiles while shaders read the
 * tiles. Does nothing if fuller heaps have no room, or if every heap holds packed tiles or tiles
 * that are being loaded. Call it once per frame until sluiceGetEmptyHeaps lists enough heaps.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceEvacuateHeaps(SluiceStreamedTextureManager *manager,
                                            uint32_t maxTileCount);

/**
 * Lists empty heaps. Keeps half a heap's worth of free slots in reserve, except of heaps beyond
 * targetHeapCount; all heaps are listed only if no slot is in use. Two-call idiom as in Vulkan.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceGetEmptyHeaps(const SluiceStreamedTextureManager *manager,
                                            uint32_t *pHeapCount, uint32_t *pHeapIds);

/**
 * Releases an empty heap through the heap allocator.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, SLUICE_ERROR_UNKNOWN_HEAP, SLUICE_ERROR_HEAP_IN_USE.
 */
SLUICE_API SluiceResult sluiceReleaseHeap(SluiceStreamedTextureManager *manager, uint32_t heapId);

/**
 * Writes a whole MinMip map: minMipHeight rows of minMipWidth bytes, `rowPitch` bytes apart.
 *
 * A texel is the finest level m for which the covering tiles of level m and of all coarser regular
 * levels, and all packed tiles, are MAPPED or STANDBY. It is regularMipCount if only the packed
 * tiles are. It is SLUICE_MIP_UNTOUCHED if not even the packed tiles are; without packed levels, if
 * the coarsest level is not.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_SIZE_MISMATCH if `rowPitch` < minMipWidth or `size`, in bytes, is
 *         below (minMipHeight - 1) * rowPitch + minMipWidth.
 */
SLUICE_API SluiceResult sluiceWriteMinMipData(const SluiceStreamedTextureManager *manager,
                                              SluiceTextureId textureId, size_t rowPitch,
                                              size_t size, uint8_t *pMinMip);

/**
 * Writes the requested levels of a texture: minMipHeight rows of minMipWidth bytes, `rowPitch`
 * bytes apart. sluiceWriteMinMipData writes the resident levels in the same layout.
 *
 * A texel stands for a tile of level 0. It is the finest level that unexpired maps request there,
 * made coarser by the global mip bias at the time of the last map. SLUICE_MIP_UNTOUCHED: no map
 * requests anything there. If a texel is below the texel of the MinMip map, finer tiles are
 * missing.
 *
 * Errors: as sluiceWriteMinMipData.
 */
SLUICE_API SluiceResult sluiceWriteRequestedLevels(const SluiceStreamedTextureManager *manager,
                                                   SluiceTextureId textureId, size_t rowPitch,
                                                   size_t size, uint8_t *pLevels);

/**
 * Writes a rectangle of a MinMip map. Its first texel goes to pMinMip[0].
 *
 * Errors: as sluiceWriteMinMipData; SLUICE_ERROR_INVALID_ARGUMENT if the rectangle is empty or
 *         leaves the map.
 */
SLUICE_API SluiceResult sluiceWriteMinMipRect(const SluiceStreamedTextureManager *manager,
                                              const SluiceMinMipRect *pRect, size_t rowPitch,
                                              size_t size, uint8_t *pMinMip);

/**
 * Returns rectangles that cover all MinMip texels that changed since they were last returned, at
 * most one per texture. For a new texture the rectangle is the whole map. Uses `pRectCount` and
 * `pRects` as sluiceGetTilesToMap uses `pTileCount` and `pTiles`.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceGetMinMipUpdates(SluiceStreamedTextureManager *manager,
                                               uint32_t *pRectCount, SluiceMinMipRect *pRects);

/**
 * Gets state, position and slot of a tile. `pState` and `pTile` may each be NULL.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, SLUICE_ERROR_UNKNOWN_TEXTURE, SLUICE_ERROR_STALE_TEXTURE,
 *         SLUICE_ERROR_UNKNOWN_TILE.
 */
SLUICE_API SluiceResult sluiceGetTileState(const SluiceStreamedTextureManager *manager,
                                           SluiceTextureId textureId, uint32_t tileIndex,
                                           SluiceTileState *pState, SluiceTile *pTile);

/**
 * Gets the tile that is in a slot, in constant time: for pictures of heaps. textureId is
 * SLUICE_NO_TEXTURE if the slot is free, or retires.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_HEAP; SLUICE_ERROR_INVALID_ARGUMENT, with
 *         a log message, for a slot that heaps do not have.
 */
SLUICE_API SluiceResult sluiceGetSlotTile(const SluiceStreamedTextureManager *manager,
                                          uint32_t heapId, uint32_t slot, SluiceTile *pTile);

/**
 * Gets the current statistics.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceGetStatistics(const SluiceStreamedTextureManager *manager,
                                            SluiceStreamedTextureStatistics *pStatistics);

/**
 * Gets statistics of a texture, in constant time. Requests of an application that are merged into
 * maps (vulkan_control.h) count as seen.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, SLUICE_ERROR_UNKNOWN_TEXTURE, SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a wrong structSize.
 */
SLUICE_API SluiceResult sluiceGetTextureStatistics(const SluiceStreamedTextureManager *manager,
                                                   SluiceTextureId textureId,
                                                   SluiceTextureStatistics *pStatistics);

/**
 * Gets statistics of one level of a texture, in constant time. regularMipCount stands for all
 * packed levels. Packed tiles without slots have sizes of 0.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, SLUICE_ERROR_UNKNOWN_TEXTURE, SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a level that the texture does not
 *         have, or a wrong structSize.
 */
SLUICE_API SluiceResult sluiceGetTextureLevelStatistics(const SluiceStreamedTextureManager *manager,
                                                        SluiceTextureId textureId, uint32_t level,
                                                        SluiceTextureLevelStatistics *pStatistics);

/**
 * Keeps the last `capacity` state changes of tiles. 0 keeps none, and frees the memory: 40 bytes
 * per event. Events kept so far are lost. Decisions are the same with and without events.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, above
 *         SLUICE_MAX_TILE_EVENTS; SLUICE_ERROR_OUT_OF_HOST_MEMORY. Nothing has changed after an
 *         error.
 */
SLUICE_API SluiceResult sluiceSetTileEventCapacity(SluiceStreamedTextureManager *manager,
                                                   uint32_t capacity);

/**
 * Sets the mark that events have from now on, for example the number of a frame or a time. A
 * streamer marks events with the index of its frame (vulkan.h).
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceMarkTileEvents(SluiceStreamedTextureManager *manager, uint64_t mark);

/**
 * Reads events, the oldest first, from `*pCursor` on. The cursor is the number of an event, from 0;
 * it becomes that of the next event to read. Each reader has its own cursor.
 *
 * `*pEventCount` is the capacity of `pEvents` on entry, which may be 0, and the number written on
 * return. `*pLostCount` becomes the number of events since the cursor that are no longer kept; it
 * may be NULL. Returns SLUICE_INCOMPLETE if events are left.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, if the
 *         cursor is above the number of events so far.
 */
SLUICE_API SluiceResult sluiceReadTileEvents(const SluiceStreamedTextureManager *manager,
                                             uint64_t *pCursor, uint32_t *pEventCount,
                                             SluiceTileEvent *pEvents, uint64_t *pLostCount);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_MANAGER_H */
