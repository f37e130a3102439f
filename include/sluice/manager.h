/**
 * Decides which tiles of which textures should be resident.
 *
 * The manager holds no image data, calls no graphics API and never reads a clock: it turns feedback
 * into lists of tiles to map and to unmap, gives each mapped tile a slot in a heap of the
 * application's, and keeps a MinMip map per texture that says what may be sampled. See
 * docs/manager.md for the frame loop and the exact rules.
 *
 * A frame, in the usual order:
 *
 *     sluiceCompleteRetireValue            what the GPU has finished
 *     sluiceUpdateWithSamplerFeedback      for each map that was read back
 *     sluiceGetTilesToCancel               loads to stop     -> sluiceReportCancelledTiles
 *     sluiceGetTilesToUnmap                bindings to drop
 *     sluiceGetTilesToMap                  loads to start    -> sluiceUpdateTilesMapping, or
 *                                                               sluiceReportFailedTiles
 *     sluiceGetMinMipUpdates               rectangles to publish (sluiceWriteMinMipRect)
 *
 * The state of a tile (sluiceGetTileState):
 *
 *     FREE -> REQUESTED -> ALLOCATED -> MAPPED -> STANDBY -> (unmapped, slot retiring) -> FREE
 *
 * A tile that is REQUESTED and no longer wanted goes straight back to FREE. One that is ALLOCATED
 * and no longer wanted is CANCELLED: it is listed once by sluiceGetTilesToCancel and its slot comes
 * back when the application answers; one that was prefetched is so from the start, and not listed.
 * One that is STANDBY and wanted again is MAPPED at once. One whose load failed is FAILED until it
 * is tried again, or GIVEN_UP.
 *
 * Thread safety of everything here: external on the manager, except that calls which take a const
 * manager may run beside each other. One manager per thread needs no lock at all.
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
 * Names one texture for its whole life and no other after it: the low 32 bits are an index that is
 * used again, the high 32 bits a generation that is not. Indices are handed out densely from 0, the
 * lowest free one first. Never 0.
 */
typedef uint64_t SluiceTextureId;

/** No texture; in the list calls: all textures. */
#define SLUICE_ALL_TEXTURES ((SluiceTextureId)0)
#define SLUICE_NO_TEXTURE ((SluiceTextureId)0)

/** In a feedback map: nothing was sampled. In a MinMip map: not even the packed mips are there. */
#define SLUICE_MIP_UNTOUCHED 255

/** The longest mip chain (2^20 texels) has 21 levels. */
#define SLUICE_MAX_MIP_LEVELS 21
#define SLUICE_MAX_TEXTURE_SIZE (1u << 20)
/** Regular and packed tiles of one texture together, and regions of one map. */
#define SLUICE_MAX_TILES_PER_TEXTURE (1u << 30)

typedef struct SluiceStreamedTextureManagerCreateInfo {
    SluiceHeapAllocator heapAllocator;           ///< both functions required
    const SluiceAllocationCallbacks *pAllocator; ///< NULL: malloc and free; outlives the manager
    uint32_t heapTileCapacity; ///< slots per heap, 1 to 2^20; users start with 256
    uint32_t tileSize;         ///< bytes per slot, > 0; 65536 for GPU tiles
    bool alwaysMapPackedTiles; ///< true: packed tiles are wanted from add to remove
} SluiceStreamedTextureManagerCreateInfo;

/** The defaults that the create-info's comments name; the heap allocator is left to fill in. */
#define SLUICE_DEFAULT_HEAP_TILE_CAPACITY 256u
#define SLUICE_DEFAULT_TILE_SIZE 65536u

/** Zeroed is the state after creation, but for the fields whose comment says otherwise. */
typedef struct SluiceStreamedTextureManagerConfig {
    /** Tiles that may stay STANDBY; those beyond it are listed for unmapping, oldest first. */
    uint32_t numExtraStandbyTiles;
    uint32_t maxHeapCount;    ///< heaps that may exist at a time; 0: as many as the allocator gives
    uint32_t maxLoadAttempts; ///< failed loads until a tile is GIVEN_UP; 0: 5
    uint64_t retryDelay;      ///< time from the first failure to the second try, doubled each time
    /**
     * Maps in a row that have to miss what a region wanted, beside the timeout, before it is no
     * longer wanted; coarser levels, which more regions see, need a quarter as many per level. 0:
     * learned per texture from how often maps miss what earlier and later ones show, so that
     * stochastic feedback drops nothing that is still there. 1: the timeout alone counts.
     */
    uint32_t missesToForget;
    /**
     * So many of the coarsest regular levels of all textures are loaded whenever nothing is
     * requested, a slot is free and fewer than numExtraStandbyTiles are STANDBY: what comes into
     * view is there sooner, for more uploads. 0: none.
     */
    uint32_t prefetchLevels;
} SluiceStreamedTextureManagerConfig;

/**
 * The shape of one texture. Level l has max(1, width >> l) x max(1, height >> l) texels. Levels
 * [0, regularMipCount) are cut into tiles of tileWidth x tileHeight texels, those at the right and
 * bottom edge are smaller; levels [regularMipCount, mipLevelCount) are packed: they live together
 * in packedTileCount tiles.
 *
 * Tiles are numbered level by level from level 0, each row by row; the packed ones come last.
 */
typedef struct SluiceStreamedTextureDesc {
    uint32_t width, height;         ///< texels of level 0, 1 to SLUICE_MAX_TEXTURE_SIZE
    uint32_t mipLevelCount;         ///< 1 to floor(log2(max(width, height))) + 1
    uint32_t regularMipCount;       ///< 0 to mipLevelCount
    uint32_t packedTileCount;       ///< > 0 exactly if regularMipCount < mipLevelCount
    uint32_t tileWidth, tileHeight; ///< texels, > 0
    /** Texels of level 0 that one feedback texel stands for; 0: the tile's size. */
    uint32_t feedbackRegionWidth, feedbackRegionHeight;
} SluiceStreamedTextureDesc;

/** What follows from a SluiceStreamedTextureDesc. */
typedef struct SluiceStreamedTextureLayout {
    SluiceStreamedTextureDesc desc; ///< region sizes filled in
    uint32_t regularTileCount;      ///< tiles of all regular levels; the first packed tile's index
    uint32_t tileCount;             ///< regularTileCount + packedTileCount
    uint32_t feedbackWidth, feedbackHeight; ///< regions: ceil(width / feedbackRegionWidth), ...
    /** One MinMip texel per tile of level 0; 1x1 without regular levels. */
    uint32_t minMipWidth, minMipHeight;
    uint32_t levelWidthInTiles[SLUICE_MAX_MIP_LEVELS];  ///< of the regular levels
    uint32_t levelHeightInTiles[SLUICE_MAX_MIP_LEVELS]; ///< of the regular levels
    uint32_t levelFirstTile[SLUICE_MAX_MIP_LEVELS];     ///< of the regular levels
} SluiceStreamedTextureLayout;

/** One resolved feedback map. */
typedef struct SluiceFeedbackDesc {
    /**
     * [height][width] of uint8_t, row 0 first, tightly packed. Each texel is the finest mip level
     * wanted in its region; SLUICE_MIP_UNTOUCHED where nothing was sampled. Values beyond the last
     * level mean the last level.
     */
    const uint8_t *pMinMip;
    uint32_t width, height; ///< must be the texture's feedbackWidth and feedbackHeight
    int32_t mipBias; ///< levels, added to each wanted level before it is clamped to the chain
    /** Only the coarsest so many regular levels are wanted; 0: all of them. */
    uint32_t streamedMipLevels;
} SluiceFeedbackDesc;

typedef enum SluiceTileState {
    SLUICE_TILE_STATE_FREE = 0,      ///< no memory, not wanted
    SLUICE_TILE_STATE_REQUESTED = 1, ///< wanted; waits to be handed out by sluiceGetTilesToMap
    SLUICE_TILE_STATE_ALLOCATED = 2, ///< handed out: has a slot, its data is on its way
    SLUICE_TILE_STATE_MAPPED = 3,    ///< the data is there, and wanted
    SLUICE_TILE_STATE_STANDBY = 4,   ///< the data is there, not wanted (any more) or to make room
    SLUICE_TILE_STATE_CANCELLED = 5, ///< handed out, not wanted (any more); waits for an answer
    SLUICE_TILE_STATE_FAILED = 6,    ///< wanted; its load failed and will be tried again
    SLUICE_TILE_STATE_GIVEN_UP = 7   ///< its load failed too often; see sluiceRetryFailedTiles
} SluiceTileState;

/** A tile and, where it has memory, the slot. */
typedef struct SluiceTile {
    SluiceTextureId textureId;
    uint32_t tileIndex;
    uint32_t mipLevel; ///< regularMipCount for packed tiles
    uint32_t x, y;     ///< in tiles of its level; packed tiles: x counts from 0, y is 0
    uint32_t heapId;
    uint32_t slot; ///< index in the heap, 0 to heapTileCapacity - 1
} SluiceTile;

/** Copy the contents of `from` to the slot (heapId, slot) and bind the tile there. */
typedef struct SluiceTileMove {
    SluiceTile from; ///< the tile and the slot it leaves
    uint32_t heapId;
    uint32_t slot;
} SluiceTileMove;

/** In MinMip texels. */
typedef struct SluiceMinMipRect {
    SluiceTextureId textureId;
    uint32_t x, y, width, height;
} SluiceMinMipRect;

/** Counts are of now, `...Total` count from creation on and wrap after 2^64. */
typedef struct SluiceStreamedTextureStatistics {
    uint32_t textureCount;
    uint64_t tileCount; ///< of all textures: what fully resident textures would need
    uint32_t requestedTileCount, allocatedTileCount, mappedTileCount, standbyTileCount;
    uint32_t cancelledTileCount, failedTileCount, givenUpTileCount;
    uint32_t retiringSlotCount; ///< unmapped, the GPU may still read them
    uint32_t heapCount, freeSlotCount;
    uint32_t reservedSlotCount; ///< of all slots so many are kept for packed tiles
    uint32_t globalMipBias;     ///< added to what every region asks for; sixteenths of a level
    uint64_t handedOutTotal, mappedTotal, unmappedTotal, cancelledTotal, failedTotal;
    uint64_t restoredTotal; ///< STANDBY -> MAPPED, no load needed
    uint64_t movedTotal;
    uint64_t hostMemorySize; ///< bytes taken from pAllocator now
} SluiceStreamedTextureStatistics;

/**
 * Creates a manager with no textures and no heaps.
 *
 * `*pManager` belongs to the caller, who releases it with sluiceDestroyStreamedTextureManager; it
 * is NULL on failure. `*pCreateInfo` is copied; what it points to must outlive the manager.
 *
 * Errors: NULL_POINTER if an argument or a heap callback is NULL; ZERO_HEAP_CAPACITY if the heap
 *         capacity or tile size is 0; INVALID_ARGUMENT if the capacity is above 2^20 or only one of
 *         pAllocator's functions is set; OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult
sluiceCreateStreamedTextureManager(const SluiceStreamedTextureManagerCreateInfo *pCreateInfo,
                                   SluiceStreamedTextureManager **pManager);

/** Releases every heap through the allocator, then the manager. NULL is allowed. */
SLUICE_API void sluiceDestroyStreamedTextureManager(SluiceStreamedTextureManager *manager);

/**
 * Takes effect at once: a smaller numExtraStandbyTiles lists tiles for unmapping. A maxHeapCount
 * below the number of living heaps releases none.
 */
SLUICE_API SluiceResult sluiceSetConfig(SluiceStreamedTextureManager *manager,
                                        const SluiceStreamedTextureManagerConfig *pConfig);

/**
 * Computes the layout of a description without a manager.
 *
 * Errors: NULL_POINTER; ZERO_TILES if a size is 0 or there is no level; INVALID_PACKED_MIPS if
 *         regularMipCount > mipLevelCount or the packed tile count contradicts it;
 *         INVALID_ARGUMENT if a size or level count is out of range; LIMIT_EXCEEDED beyond
 *         SLUICE_MAX_TILES_PER_TEXTURE tiles or regions. `*pLayout` is untouched after an error.
 */
SLUICE_API SluiceResult sluiceGetStreamedTextureLayout(const SluiceStreamedTextureDesc *pDesc,
                                                       SluiceStreamedTextureLayout *pLayout);

/**
 * Adds a texture: with alwaysMapPackedTiles its packed tiles are REQUESTED, everything else FREE.
 *
 * Errors: as sluiceGetStreamedTextureLayout, and OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceAddStreamedTexture(SluiceStreamedTextureManager *manager,
                                                 const SluiceStreamedTextureDesc *pDesc,
                                                 SluiceTextureId *pTextureId);

/**
 * Removes a texture in whatever state its tiles are. Slots it holds, also those of loads under way,
 * come back once `retireValue` has completed. Nothing of it is listed any more, late answers are
 * refused with STALE_TEXTURE, its followers stand alone from now on.
 *
 * Errors: UNKNOWN_TEXTURE, STALE_TEXTURE, TIME_BACKWARDS (retireValue is below an earlier one).
 */
SLUICE_API SluiceResult sluiceRemoveStreamedTexture(SluiceStreamedTextureManager *manager,
                                                    SluiceTextureId textureId,
                                                    uint64_t retireValue);

SLUICE_API SluiceResult sluiceGetTextureLayout(const SluiceStreamedTextureManager *manager,
                                               SluiceTextureId textureId,
                                               SluiceStreamedTextureLayout *pLayout);

/**
 * Merges one feedback map into the state of one texture, and of the textures that follow it.
 *
 * A region wants the finest level that this map or an earlier one asked for in it, coarsened by the
 * global mip bias while more is wanted than there can be slots for. What earlier maps asked for
 * counts for at least `timeout`, while slots are short eleven sixteenths of it; it lapses once, as
 * well, as many maps as missesToForget says have missed it. Maps that lie close together lapse as
 * one, a quarter of the timeout and a map late at most. What one call has let lapse stays lapsed,
 * also if a later call brings a longer timeout. A level wanted in a region makes wanted: every tile
 * of that level that the region touches, each one's parent (x >> 1, y >> 1, clamped to the coarser
 * level's grid) up to the coarsest regular level, and the packed tiles. Tiles that become wanted
 * are REQUESTED or, from STANDBY, MAPPED; tiles that no longer are go the other way. A texture that
 * gets no maps keeps what it wants, unless sluiceGetTilesToMap needs the slots.
 *
 * The map is read before the call returns and not kept. `timeStamp` and `timeout` share any unit
 * the caller likes; time stamps never decrease, over all textures, and may wrap past 2^64.
 *
 * Errors: NULL_POINTER, UNKNOWN_TEXTURE, STALE_TEXTURE, SIZE_MISMATCH, TIME_BACKWARDS,
 *         OUT_OF_HOST_MEMORY. The manager is unchanged after any of them.
 * Source: RTXTS Integration Guide, "Render Flow"; encoding as in the Direct3D Sampler Feedback
 *         specification, "MinMip feedback map", "Decoded representation".
 */
SLUICE_API SluiceResult sluiceUpdateWithSamplerFeedback(SluiceStreamedTextureManager *manager,
                                                        SluiceTextureId textureId,
                                                        const SluiceFeedbackDesc *pFeedback,
                                                        uint64_t timeStamp, uint64_t timeout);

/**
 * Gives a texture what another one's last feedback map asked for, matched in UV, whatever the two
 * sizes, tile shapes and level counts: level m of the primary stands for level
 * m + floor(log2(min(width ratio, height ratio))) of the follower, at least 0. The result is merged
 * like a map of the follower's own, so one that is matched with several primaries within `timeout`
 * holds the union. Does nothing if the primary never had a map or the follower has no regular level
 * and no packed tile to request.
 *
 * Errors: as sluiceUpdateWithSamplerFeedback; INVALID_ARGUMENT if both are the same texture.
 */
SLUICE_API SluiceResult sluiceMatchPrimaryTexture(SluiceStreamedTextureManager *manager,
                                                  SluiceTextureId primaryId,
                                                  SluiceTextureId followerId, uint64_t timeStamp,
                                                  uint64_t timeout);

/**
 * Makes a texture a follower for good: each feedback map of the primary is matched to it without a
 * call. SLUICE_NO_TEXTURE as primary ends that. What it wants now lapses with later maps only.
 *
 * Errors: UNKNOWN_TEXTURE, STALE_TEXTURE; INVALID_ARGUMENT if the primary is the texture itself or
 *         follows another, or if the texture has followers; OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceSetPrimaryTexture(SluiceStreamedTextureManager *manager,
                                                SluiceTextureId followerId,
                                                SluiceTextureId primaryId);

/**
 * Hands out tiles to load: reserves a slot for each and makes it ALLOCATED.
 *
 * Packed tiles come first, then coarser levels before finer ones, within a level the tile that the
 * most of level 0 under it wants (by powers of two), then the one that was requested earliest.
 * While slots are short, regular tiles that their texture's last map does not ask for are passed
 * over. `textureId` restricts the list to one texture, which then leaves free slots to the coarser
 * requests of others: go round all of them. With SLUICE_ALL_TEXTURES it covers all, and idle ones
 * cost nothing. With prefetchLevels it may go on with tiles that nothing wants, when no
 * request is left; these are CANCELLED at once and not listed by sluiceGetTilesToCancel.
 *
 * With `pTiles` NULL, writes how many are REQUESTED and changes nothing. Otherwise `*pTileCount` is
 * the room in `pTiles` on entry and the number written on return. Where no slot is free (for
 * regular tiles: more than reservedSlotCount) the heap allocator is asked, at most once in vain per
 * call; where it refuses, as many STANDBY tiles as are needed, oldest first, are listed for
 * unmapping, and the requests wait. If there are not enough of them, textures that got no map for
 * four times their usual interval and timeout no longer want anything; and the finest tiles that
 * are wanted make room for packed tiles and for requests two levels coarser, or one if these have
 * waited for a whole round of maps: they are listed for unmapping, STANDBY until then, and
 * REQUESTED after that.
 *
 * Every tile handed out must be answered with one of sluiceUpdateTilesMapping,
 * sluiceReportFailedTiles and sluiceReportCancelledTiles, or its texture removed.
 *
 * Returns SLUICE_INCOMPLETE if more are left for lack of room or because all that are left were
 * passed over, SLUICE_BUDGET_REACHED for lack of slots. Errors: NULL_POINTER, UNKNOWN_TEXTURE,
 * STALE_TEXTURE, OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceGetTilesToMap(SluiceStreamedTextureManager *manager,
                                            SluiceTextureId textureId, uint32_t *pTileCount,
                                            SluiceTile *pTiles);

/**
 * The data of these ALLOCATED tiles is in place and may be sampled: they become MAPPED. A CANCELLED
 * tile may be answered too, it becomes STANDBY, or MAPPED if it is wanted (again). So are tiles
 * that were prefetched.
 *
 * Errors: NULL_POINTER, UNKNOWN_TEXTURE, STALE_TEXTURE, UNKNOWN_TILE; INVALID_TILE_STATE if a tile
 *         was not handed out, was answered already or stands in the list twice.
 */
SLUICE_API SluiceResult sluiceUpdateTilesMapping(SluiceStreamedTextureManager *manager,
                                                 SluiceTextureId textureId, uint32_t tileCount,
                                                 const uint32_t *pTileIndices);

/**
 * Loading these ALLOCATED or CANCELLED tiles failed and nothing of theirs was written: the slots
 * are free at once. Wanted ones are FAILED and become REQUESTED again with the first call that
 * brings a time stamp of `timeStamp + retryDelay * 2^(failures - 1)` or later; after
 * maxLoadAttempts failures they are GIVEN_UP, and the MinMip map stays at the coarser level. A tile
 * that is no longer wanted forgets its failures.
 *
 * Errors: as sluiceUpdateTilesMapping, TIME_BACKWARDS, OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceReportFailedTiles(SluiceStreamedTextureManager *manager,
                                                SluiceTextureId textureId, uint32_t tileCount,
                                                const uint32_t *pTileIndices, uint64_t timeStamp);

/** Makes every GIVEN_UP and FAILED tile of the texture (or of all) that is wanted REQUESTED. */
SLUICE_API SluiceResult sluiceRetryFailedTiles(SluiceStreamedTextureManager *manager,
                                               SluiceTextureId textureId);

/**
 * Lists the tiles that became GIVEN_UP and were not listed yet, each once, however often it did.
 * Calling convention as sluiceGetTilesToMap; heapId and slot mean nothing here.
 */
SLUICE_API SluiceResult sluiceGetGivenUpTiles(SluiceStreamedTextureManager *manager,
                                              uint32_t *pTileCount, SluiceTile *pTiles);

/**
 * Hands out CANCELLED tiles, each once: their loads can be stopped. One that is wanted again before
 * it was handed out is ALLOCATED again and not listed; one that is wanted again after that becomes
 * REQUESTED when it is answered. Calling convention as sluiceGetTilesToMap.
 */
SLUICE_API SluiceResult sluiceGetTilesToCancel(SluiceStreamedTextureManager *manager,
                                               SluiceTextureId textureId, uint32_t *pTileCount,
                                               SluiceTile *pTiles);

/**
 * These CANCELLED tiles were not loaded and never mapped: their slots come back once `retireValue`
 * has completed (0: at once; a bind or copy that was already recorded names its frame's value).
 * ALLOCATED tiles may be given back in the same way; wanted ones are REQUESTED again.
 * Errors: as sluiceUpdateTilesMapping, TIME_BACKWARDS, OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceReportCancelledTiles(SluiceStreamedTextureManager *manager,
                                                   SluiceTextureId textureId, uint32_t tileCount,
                                                   const uint32_t *pTileIndices,
                                                   uint64_t retireValue);

/**
 * Hands out the tiles whose bindings are to be dropped: STANDBY tiles beyond numExtraStandbyTiles
 * and those whose slots are needed, oldest first. They are FREE afterwards, or REQUESTED if they
 * only made room, and the MinMip maps no longer show them; their slots come back once `retireValue`
 * has completed, which must be a value that completes after every use of the old MinMip maps. A
 * tile that is wanted again before it was handed out is MAPPED again and not listed. Calling
 * convention as sluiceGetTilesToMap. Errors: also TIME_BACKWARDS, OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceGetTilesToUnmap(SluiceStreamedTextureManager *manager,
                                              SluiceTextureId textureId, uint64_t retireValue,
                                              uint32_t *pTileCount, SluiceTile *pTiles);

/**
 * Everything up to `retireValue` is over on the GPU; slots that wait for such a value are free.
 * A retire value, here and in the other calls, is a frame number or timeline semaphore value: those
 * given to calls that free slots never decrease, nor do those given here. 0 is always complete.
 * Errors: TIME_BACKWARDS.
 */
SLUICE_API SluiceResult sluiceCompleteRetireValue(SluiceStreamedTextureManager *manager,
                                                  uint64_t retireValue);

/** Lists STANDBY tiles, oldest first, for unmapping until at most `keepTileCount` are left. */
SLUICE_API SluiceResult sluiceTrimStandbyTiles(SluiceStreamedTextureManager *manager,
                                               uint32_t keepTileCount);

/**
 * Hands out up to `*pMoveCount` copies that empty the least used heaps into fuller ones. Tiles that
 * are MAPPED or STANDBY belong to their new slots when the call returns; the old ones come back
 * once `retireValue` has completed. No move is listed that helps to empty no heap, so repeated
 * calls end. A tile may move more than once in a call: make the copies in the order of the list. On
 * return `*pMoveCount` is the number written. `pMoves` must not be NULL.
 *
 * Errors: NULL_POINTER, TIME_BACKWARDS, OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceDefragmentTiles(SluiceStreamedTextureManager *manager,
                                              uint64_t retireValue, uint32_t *pMoveCount,
                                              SluiceTileMove *pMoves);

/**
 * Lists heaps with all slots free, calling convention as Vulkan's enumerations, as long as half a
 * heap of free slots stays in others: all of them only when no slot at all is taken.
 */
SLUICE_API SluiceResult sluiceGetEmptyHeaps(const SluiceStreamedTextureManager *manager,
                                            uint32_t *pHeapCount, uint32_t *pHeapIds);

/** Gives an empty heap back through the allocator. Errors: UNKNOWN_HEAP, HEAP_IN_USE. */
SLUICE_API SluiceResult sluiceReleaseHeap(SluiceStreamedTextureManager *manager, uint32_t heapId);

/**
 * Writes the whole MinMip map: [minMipHeight] rows of minMipWidth bytes, `rowPitch` bytes apart.
 * A texel is the finest level m such that the tiles over it of level m and of all coarser regular
 * levels are MAPPED or STANDBY and so are all packed tiles; regularMipCount if only the packed ones
 * are; SLUICE_MIP_UNTOUCHED if not even those (or, without packed levels, the coarsest one).
 *
 * Errors: NULL_POINTER, UNKNOWN_TEXTURE, STALE_TEXTURE; SIZE_MISMATCH if rowPitch < minMipWidth or
 *         `size` is less than (minMipHeight - 1) * rowPitch + minMipWidth.
 */
SLUICE_API SluiceResult sluiceWriteMinMipData(const SluiceStreamedTextureManager *manager,
                                              SluiceTextureId textureId, size_t rowPitch,
                                              size_t size, uint8_t *pMinMip);

/**
 * The same for a rectangle of the map, whose first texel goes to pMinMip[0]. Errors: also
 * INVALID_ARGUMENT if it is empty or leaves the map.
 */
SLUICE_API SluiceResult sluiceWriteMinMipRect(const SluiceStreamedTextureManager *manager,
                                              const SluiceMinMipRect *pRect, size_t rowPitch,
                                              size_t size, uint8_t *pMinMip);

/**
 * Hands out rectangles that cover every MinMip texel that changed since they were last handed out,
 * at most one per texture. A new texture is listed whole. Calling convention as
 * sluiceGetTilesToMap.
 */
SLUICE_API SluiceResult sluiceGetMinMipUpdates(SluiceStreamedTextureManager *manager,
                                               uint32_t *pRectCount, SluiceMinMipRect *pRects);

/** State, place and slot of one tile. `pState` and `pTile` may each be NULL. */
SLUICE_API SluiceResult sluiceGetTileState(const SluiceStreamedTextureManager *manager,
                                           SluiceTextureId textureId, uint32_t tileIndex,
                                           SluiceTileState *pState, SluiceTile *pTile);

SLUICE_API SluiceResult sluiceGetStatistics(const SluiceStreamedTextureManager *manager,
                                            SluiceStreamedTextureStatistics *pStatistics);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_MANAGER_H */
