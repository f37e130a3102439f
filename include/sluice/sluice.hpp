/**
 * C++17: owners of Sluice's handles. Header-only and optional.
 *
 *     auto [result, writer] = sluice::create(sluiceCreateStoreWriter, &info);
 *     if (result < 0)
 *         return result;
 *     result = sluiceFinishStore(writer.get());
 *
 * An owner is a std::unique_ptr that destroys its handle: it moves and does not copy, has the size
 * of a pointer, and allocates nothing. The functions of C are called with owner.get(). Results stay
 * SluiceResult: nothing here throws, so that the header works with exceptions turned off.
 *
 * Declare an owner behind the owners that its object uses, because C++ destroys members and
 * variables in reverse order.
 *
 * Needs no other header of Sluice. Include the ones whose functions you call. An owner calls the
 * library that made its handle, so a program links only the libraries whose owners it uses.
 */
#ifndef SLUICE_HPP
#define SLUICE_HPP

#include <sluice/base.h>

#include <memory>
#include <tuple>
#include <type_traits>

#if __cplusplus < 201703L && (!defined(_MSVC_LANG) || _MSVC_LANG < 201703L)
#error "sluice.hpp is C++17"
#endif

/* X(owner, handle) of each handle with a function sluiceDestroy. */
#define SLUICE_HPP_HANDLES(X)                                                                      \
    X(Baker, SluiceBaker)                                                                          \
    X(DemandLoader, SluiceDemandLoader)                                                            \
    X(ExrMemoryBudget, SluiceExrMemoryBudget)                                                      \
    X(FilePool, SluiceFilePool)                                                                    \
    X(HttpClient, SluiceHttpClient)                                                                \
    X(HttpFile, SluiceHttpFile)                                                                    \
    X(ImageOpener, SluiceImageOpener)                                                              \
    X(ImageSource, SluiceImageSource)                                                              \
    X(NeuralCompressor, SluiceNeuralCompressor)                                                    \
    X(NeuralSet, SluiceNeuralSet)                                                                  \
    X(PbrtScene, SluicePbrtScene)                                                                  \
    X(ProxySet, SluiceProxySet)                                                                    \
    X(ReadPool, SluiceReadPool)                                                                    \
    X(StoreReadPool, SluiceStoreReadPool)                                                          \
    X(StoreWriter, SluiceStoreWriter)                                                              \
    X(StreamedTextureManager, SluiceStreamedTextureManager)                                        \
    X(TileLoader, SluiceTileLoader)                                                                \
    X(TracePlayer, SluiceTracePlayer)                                                              \
    X(VulkanContext, SluiceVulkanContext)                                                          \
    X(VulkanNeuralDecoder, SluiceVulkanNeuralDecoder)                                              \
    X(VulkanStreamer, SluiceVulkanStreamer)

extern "C" {
#define SLUICE_HPP_DECLARE(owner, handle)                                                          \
    typedef struct handle handle;                                                                  \
    SLUICE_API void sluiceDestroy##owner(handle *);
SLUICE_HPP_HANDLES(SLUICE_HPP_DECLARE)
#undef SLUICE_HPP_DECLARE
typedef struct SluiceRecorder SluiceRecorder;
SLUICE_API SluiceResult sluiceEndRecording(SluiceRecorder *recorder);
}

namespace sluice
{

/** Destroys a handle. A recorder is ended, and its result is lost: see Recorder. */
struct Destroy {
#define SLUICE_HPP_DESTROY(owner, handle)                                                          \
    void operator()(handle *object) const noexcept                                                 \
    {                                                                                              \
        sluiceDestroy##owner(object);                                                              \
    }
    SLUICE_HPP_HANDLES(SLUICE_HPP_DESTROY)
#undef SLUICE_HPP_DESTROY
    void operator()(SluiceRecorder *object) const noexcept
    {
        (void)sluiceEndRecording(object);
    }
};

/** Owns a handle, or nothing. */
template <typename Handle> using Owner = std::unique_ptr<Handle, Destroy>;

#define SLUICE_HPP_OWNER(owner, handle) using owner = Owner<handle>;
SLUICE_HPP_HANDLES(SLUICE_HPP_OWNER)
#undef SLUICE_HPP_OWNER
#undef SLUICE_HPP_HANDLES

/** Call sluiceEndRecording(recorder.release()) to learn whether everything was written. */
using Recorder = Owner<SluiceRecorder>;

/** Answer of create(). `owner` is empty unless a handle was made. */
template <typename Handle> struct [[nodiscard]] Created {
    SluiceResult result;
    Owner<Handle> owner;
};

/**
 * Calls a function that writes a handle to its last parameter, with all arguments but that one.
 *
 * For all functions sluiceCreate, sluiceOpen and sluiceBegin that make a handle.
 */
template <typename... Parameters, typename... Arguments>
auto create(SluiceResult (*function)(Parameters...), Arguments... arguments) noexcept
{
    static_assert(sizeof...(Parameters) == sizeof...(Arguments) + 1,
                  "give all arguments but the last one");
    using Last = std::tuple_element_t<sizeof...(Parameters) - 1, std::tuple<Parameters...>>;
    using Handle = std::remove_pointer_t<std::remove_pointer_t<Last>>;
    Handle *handle = nullptr;
    SluiceResult result = function(arguments..., &handle);
    return Created<Handle>{result, Owner<Handle>(handle)};
}

/** Returns a zeroed struct with its structSize. */
template <typename Struct> constexpr Struct sized() noexcept
{
    static_assert(std::is_trivial_v<Struct>, "for structs of C");
    Struct value{};
    value.structSize = sizeof value;
    return value;
}

/**
 * Returns a function for Sluice to call. Compiles only if the function is noexcept: an exception
 * must not pass through a library in C. A lambda without captures is given with a + before it:
 *
 *     info.log.pfnLog = sluice::callback(+[](void *, SluiceLogSeverity, const char *text) noexcept
 * { std::fputs(text, stderr);
 *     });
 */
template <typename Result, typename... Parameters>
constexpr auto callback(Result (*function)(Parameters...) noexcept) noexcept
    -> Result (*)(Parameters...)
{
    return function;
}

} // namespace sluice

#endif /* SLUICE_HPP */
