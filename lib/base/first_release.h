/**
 * Size of each growing struct in the first release that has it, by its last field then. A field
 * added later changes nothing here.
 *
 * The lines are macros: a layer uses those of its own structs. tests/struct_size stops the build if
 * a struct with structSize has no line.
 */
#ifndef SLC_BASE_FIRST_RELEASE_H
#define SLC_BASE_FIRST_RELEASE_H

#include <stddef.h>

#define SLC_UP_TO(type, last) (offsetof(type, last) + sizeof(((type *)0)->last))

#define SLC_FIRST_SluiceLookAheadInfo SLC_UP_TO(SluiceLookAheadInfo, shrink)
#define SLC_FIRST_SluiceLookAhead SLC_UP_TO(SluiceLookAhead, lodBias)
#define SLC_FIRST_SluiceFormatInfo SLC_UP_TO(SluiceFormatInfo, integer)
#define SLC_FIRST_SluiceImageInfo SLC_UP_TO(SluiceImageInfo, cube)
#define SLC_FIRST_SluiceImageSourceInterface                                                       \
    SLC_UP_TO(SluiceImageSourceInterface, pfnIdentifyRegion)
#define SLC_FIRST_SluiceCompleteChainSourceCreateInfo                                              \
    SLC_UP_TO(SluiceCompleteChainSourceCreateInfo, log)
#define SLC_FIRST_SluiceTileReadFailure SLC_UP_TO(SluiceTileReadFailure, offset)
#define SLC_FIRST_SluiceTileLoaderCreateInfo SLC_UP_TO(SluiceTileLoaderCreateInfo, end)
#define SLC_FIRST_SluiceReadPoolCreateInfo SLC_UP_TO(SluiceReadPoolCreateInfo, cacheSize)
#define SLC_FIRST_SluiceReadPoolStatistics SLC_UP_TO(SluiceReadPoolStatistics, keptCount)
#define SLC_FIRST_SluiceTileLoaderStatistics                                                       \
    SLC_UP_TO(SluiceTileLoaderStatistics, lastFailureOffset)
#define SLC_FIRST_SluiceStreamedTextureManagerCreateInfo                                           \
    SLC_UP_TO(SluiceStreamedTextureManagerCreateInfo, log)
#define SLC_FIRST_SluiceStreamedTextureManagerConfig                                               \
    SLC_UP_TO(SluiceStreamedTextureManagerConfig, separatePackedTiles)
#define SLC_FIRST_SluiceStreamedTextureLayout SLC_UP_TO(SluiceStreamedTextureLayout, levelFirstTile)
#define SLC_FIRST_SluiceFeedbackDesc SLC_UP_TO(SluiceFeedbackDesc, streamedMipLevels)
#define SLC_FIRST_SluiceStreamedTextureStatistics                                                  \
    SLC_UP_TO(SluiceStreamedTextureStatistics, givenUpRetriedTotal)
#define SLC_FIRST_SluiceTextureLevelStatistics SLC_UP_TO(SluiceTextureLevelStatistics, wantedSize)
#define SLC_FIRST_SluiceTextureStatistics SLC_UP_TO(SluiceTextureStatistics, seenTime)
#define SLC_FIRST_SluiceFileRecordingInfo SLC_UP_TO(SluiceFileRecordingInfo, log)
#define SLC_FIRST_SluiceReplayInfo SLC_UP_TO(SluiceReplayInfo, pStatistics)
#define SLC_FIRST_SluiceReplayResult SLC_UP_TO(SluiceReplayResult, demand)
#define SLC_FIRST_SluiceTracePlayerCreateInfo                                                      \
    SLC_UP_TO(SluiceTracePlayerCreateInfo, tileEventCapacity)
#define SLC_FIRST_SluiceTraceCall SLC_UP_TO(SluiceTraceCall, offset)
#define SLC_FIRST_SluiceTracePlayerState SLC_UP_TO(SluiceTracePlayerState, numExtraStandbyTiles)
#define SLC_FIRST_SluiceProxySetCreateInfo SLC_UP_TO(SluiceProxySetCreateInfo, log)
#define SLC_FIRST_SluiceProxySetInfo SLC_UP_TO(SluiceProxySetInfo, hostMemorySize)
#define SLC_FIRST_SluiceProxyRequests SLC_UP_TO(SluiceProxyRequests, pIndices)
#define SLC_FIRST_SluiceProxyListInfo SLC_UP_TO(SluiceProxyListInfo, point)
#define SLC_FIRST_SluiceProxyBoxWrite SLC_UP_TO(SluiceProxyBoxWrite, pRanges)
#define SLC_FIRST_SluiceNeuralSetCreateInfo SLC_UP_TO(SluiceNeuralSetCreateInfo, filePool)
#define SLC_FIRST_SluiceNeuralSetInfo SLC_UP_TO(SluiceNeuralSetInfo, latentSize)
#define SLC_FIRST_SluiceNeuralDecodeInfo SLC_UP_TO(SluiceNeuralDecodeInfo, log)
#define SLC_FIRST_SluiceNeuralMaskInfo SLC_UP_TO(SluiceNeuralMaskInfo, log)
#define SLC_FIRST_SluiceNeuralMaskReport SLC_UP_TO(SluiceNeuralMaskReport, wrongAfter)
#define SLC_FIRST_SluiceNeuralWriteInfo SLC_UP_TO(SluiceNeuralWriteInfo, log)
#define SLC_FIRST_SluiceNeuralTexture SLC_UP_TO(SluiceNeuralTexture, bcFormat)
#define SLC_FIRST_SluiceNeuralMip SLC_UP_TO(SluiceNeuralMip, fusedMipCount)
#define SLC_FIRST_SluiceNeuralLatentImage SLC_UP_TO(SluiceNeuralLatentImage, mipCount)
#define SLC_FIRST_SluiceFeedbackRate SLC_UP_TO(SluiceFeedbackRate, timeoutSeconds)
#define SLC_FIRST_SluiceFeedbackDelay SLC_UP_TO(SluiceFeedbackDelay, percentile99)
#define SLC_FIRST_SluicePicturePair SLC_UP_TO(SluicePicturePair, peak)
#define SLC_FIRST_SluiceExrImageSourceCreateInfo SLC_UP_TO(SluiceExrImageSourceCreateInfo, filePool)
#define SLC_FIRST_SluiceExrInfo SLC_UP_TO(SluiceExrInfo, chromaticities)
#define SLC_FIRST_SluiceExrWriteInfo SLC_UP_TO(SluiceExrWriteInfo, pfnProgress)
#define SLC_FIRST_SluiceDdsImageSourceCreateInfo SLC_UP_TO(SluiceDdsImageSourceCreateInfo, filePool)
#define SLC_FIRST_SluiceKtx2ImageSourceCreateInfo                                                  \
    SLC_UP_TO(SluiceKtx2ImageSourceCreateInfo, filePool)
#define SLC_FIRST_SluiceS3Access SLC_UP_TO(SluiceS3Access, pSessionToken)
#define SLC_FIRST_SluiceHttpClientCreateInfo SLC_UP_TO(SluiceHttpClientCreateInfo, maxCacheSize)
#define SLC_FIRST_SluiceHttpStatistics SLC_UP_TO(SluiceHttpStatistics, cacheSize)
#define SLC_FIRST_SluiceInput SLC_UP_TO(SluiceInput, pfnRead)
#define SLC_FIRST_SluiceStoreCreateInfo SLC_UP_TO(SluiceStoreCreateInfo, cube)
#define SLC_FIRST_SluiceStoreImageSourceCreateInfo                                                 \
    SLC_UP_TO(SluiceStoreImageSourceCreateInfo, filePool)
#define SLC_FIRST_SluiceStoreInfo SLC_UP_TO(SluiceStoreInfo, cube)
#define SLC_FIRST_SluiceStoreDefect SLC_UP_TO(SluiceStoreDefect, result)
#define SLC_FIRST_SluiceStoreVerifyInfo SLC_UP_TO(SluiceStoreVerifyInfo, pInput)
#define SLC_FIRST_SluiceStoreReport SLC_UP_TO(SluiceStoreReport, rawTileCount)
#define SLC_FIRST_SluiceBakeSettings SLC_UP_TO(SluiceBakeSettings, keepPrimaries)
#define SLC_FIRST_SluiceBakerCreateInfo SLC_UP_TO(SluiceBakerCreateInfo, log)
#define SLC_FIRST_SluiceBakeInfo SLC_UP_TO(SluiceBakeInfo, cube)
#define SLC_FIRST_SluiceBakeReport SLC_UP_TO(SluiceBakeReport, clampedTexelCount)
#define SLC_FIRST_SluiceDemandLoaderCreateInfo                                                     \
    SLC_UP_TO(SluiceDemandLoaderCreateInfo, forgetAfterLaunches)
#define SLC_FIRST_SluiceDemandLoaderSettings                                                       \
    SLC_UP_TO(SluiceDemandLoaderSettings, forgetAfterLaunches)
#define SLC_FIRST_SluiceDemandSampler SLC_UP_TO(SluiceDemandSampler, explicitAddressModes)
#define SLC_FIRST_SluiceDemandTextureCreateInfo                                                    \
    SLC_UP_TO(SluiceDemandTextureCreateInfo, failureColor)
#define SLC_FIRST_SluiceDemandGridCreateInfo SLC_UP_TO(SluiceDemandGridCreateInfo, baseId)
#define SLC_FIRST_SluiceDemandResourceCreateInfo SLC_UP_TO(SluiceDemandResourceCreateInfo, pfnRead)
#define SLC_FIRST_SluiceDemandBuffers SLC_UP_TO(SluiceDemandBuffers, sections)
#define SLC_FIRST_SluiceDemandByteBuffers SLC_UP_TO(SluiceDemandByteBuffers, generation)
#define SLC_FIRST_SluiceDemandLaunch SLC_UP_TO(SluiceDemandLaunch, descriptorSet)
#define SLC_FIRST_SluiceDemandRequests SLC_UP_TO(SluiceDemandRequests, lodBias)
#define SLC_FIRST_SluiceDemandTicketStatus SLC_UP_TO(SluiceDemandTicketStatus, failedCount)
#define SLC_FIRST_SluiceDemandStatistics SLC_UP_TO(SluiceDemandStatistics, texturesForgotten)
#define SLC_FIRST_SluiceFilePoolCreateInfo SLC_UP_TO(SluiceFilePoolCreateInfo, pAllocator)
#define SLC_FIRST_SluiceFilePoolStatistics SLC_UP_TO(SluiceFilePoolStatistics, replacedTotal)
#define SLC_FIRST_SluiceImageOpenerCreateInfo SLC_UP_TO(SluiceImageOpenerCreateInfo, log)
#define SLC_FIRST_SluiceOpenedImageInfo SLC_UP_TO(SluiceOpenedImageInfo, totalTexels)
#define SLC_FIRST_SluicePbrtSceneCreateInfo SLC_UP_TO(SluicePbrtSceneCreateInfo, pfnProgress)
#define SLC_FIRST_SluicePbrtSceneInfo SLC_UP_TO(SluicePbrtSceneInfo, focalDistance)
#define SLC_FIRST_SluicePbrtTexture SLC_UP_TO(SluicePbrtTexture, worldToTexture)
#define SLC_FIRST_SluicePbrtMaterial SLC_UP_TO(SluicePbrtMaterial, amount)
#define SLC_FIRST_SluicePbrtLight SLC_UP_TO(SluicePbrtLight, isTwoSided)
#define SLC_FIRST_SluicePbrtShape SLC_UP_TO(SluicePbrtShape, levels)
#define SLC_FIRST_SluicePbrtMesh SLC_UP_TO(SluicePbrtMesh, bytesRead)
#define SLC_FIRST_SluiceVulkanStreamerDebugInfo SLC_UP_TO(SluiceVulkanStreamerDebugInfo, notSparse)
#define SLC_FIRST_SluiceVulkanStreamerCreateInfo                                                   \
    SLC_UP_TO(SluiceVulkanStreamerCreateInfo, pagedTextures)
#define SLC_FIRST_SluiceVulkanStreamerSettings SLC_UP_TO(SluiceVulkanStreamerSettings, noMipBias)
#define SLC_FIRST_SluiceVulkanTextureState SLC_UP_TO(SluiceVulkanTextureState, shownLevel)
#define SLC_FIRST_SluiceVulkanTextureRequest SLC_UP_TO(SluiceVulkanTextureRequest, until)
#define SLC_FIRST_SluiceVulkanRequestProgress                                                      \
    SLC_UP_TO(SluiceVulkanRequestProgress, givenUpTileCount)
#define SLC_FIRST_SluiceVulkanStrictMode SLC_UP_TO(SluiceVulkanStrictMode, pfnReport)
#define SLC_FIRST_SluiceVulkanLoadStages SLC_UP_TO(SluiceVulkanLoadStages, whole)
#define SLC_FIRST_SluiceDemandStrictMode SLC_UP_TO(SluiceDemandStrictMode, pfnReport)
#define SLC_FIRST_SluiceDemandRegionProgress SLC_UP_TO(SluiceDemandRegionProgress, refusedTileCount)
#define SLC_FIRST_SluiceDemandTileInfo SLC_UP_TO(SluiceDemandTileInfo, state)
#define SLC_FIRST_SluiceVulkanExplanation SLC_UP_TO(SluiceVulkanExplanation, sentence)
#define SLC_FIRST_SluiceVulkanTextureControl SLC_UP_TO(SluiceVulkanTextureControl, hidden)
#define SLC_FIRST_SluiceTileBatch SLC_UP_TO(SluiceTileBatch, pTiles)
#define SLC_FIRST_SluiceTileProducer SLC_UP_TO(SluiceTileProducer, timeoutFrames)
#define SLC_FIRST_SluiceVulkanTextureCreateInfo                                                    \
    SLC_UP_TO(SluiceVulkanTextureCreateInfo, residencyMode)
#define SLC_FIRST_SluiceVulkanBuffers SLC_UP_TO(SluiceVulkanBuffers, pageTable)
#define SLC_FIRST_SluiceVulkanPages SLC_UP_TO(SluiceVulkanPages, generation)
#define SLC_FIRST_SluiceStreamingFrame SLC_UP_TO(SluiceStreamingFrame, descriptorSet)
#define SLC_FIRST_SluiceVulkanStreamerStatistics                                                   \
    SLC_UP_TO(SluiceVulkanStreamerStatistics, tilesProduced)
#define SLC_FIRST_SluiceDeviceMemoryRequest SLC_UP_TO(SluiceDeviceMemoryRequest, deviceAddress)
#define SLC_FIRST_SluiceProxyGeometry SLC_UP_TO(SluiceProxyGeometry, range)
#define SLC_FIRST_SluiceVulkanContextCreateInfo                                                    \
    SLC_UP_TO(SluiceVulkanContextCreateInfo, minTileMemorySize)
#define SLC_FIRST_SluiceVulkanContextStatistics                                                    \
    SLC_UP_TO(SluiceVulkanContextStatistics, deviceMemoryBudget)
#define SLC_FIRST_SluiceNeuralImageSourceCreateInfo                                                \
    SLC_UP_TO(SluiceNeuralImageSourceCreateInfo, log)
#define SLC_FIRST_SluiceNeuralCompressorCreateInfo                                                 \
    SLC_UP_TO(SluiceNeuralCompressorCreateInfo, checkpointSize)
#define SLC_FIRST_SluiceNeuralTrainedSet SLC_UP_TO(SluiceNeuralTrainedSet, fp8Size)
#define SLC_FIRST_SluiceNeuralProgress SLC_UP_TO(SluiceNeuralProgress, channelErrors)
#define SLC_FIRST_SluiceNeuralPaths SLC_UP_TO(SluiceNeuralPaths, matrixK)
#define SLC_FIRST_SluiceNeuralConvertInfo SLC_UP_TO(SluiceNeuralConvertInfo, log)
#define SLC_FIRST_SluiceVulkanNeuralDecoderCreateInfo                                              \
    SLC_UP_TO(SluiceVulkanNeuralDecoderCreateInfo, pAllocator)
#define SLC_FIRST_SluiceVulkanNeuralOutput SLC_UP_TO(SluiceVulkanNeuralOutput, to)
#define SLC_FIRST_SluiceVulkanDeviceCapabilities                                                   \
    SLC_UP_TO(SluiceVulkanDeviceCapabilities, sparseCubes)
#define SLC_FIRST_SluiceVulkanFormatCapabilities                                                   \
    SLC_UP_TO(SluiceVulkanFormatCapabilities, maxImageSize)
#define SLC_FIRST_SluiceVulkanSparseImageLayout                                                    \
    SLC_UP_TO(SluiceVulkanSparseImageLayout, memoryTypeBits)

#endif /* SLC_BASE_FIRST_RELEASE_H */
