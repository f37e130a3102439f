// main.c's part in C++: the headers compile, the names link. C++17: owners of handles, too.
#include <sluice/sluice.h>
#if __cplusplus >= 201703L
#include <sluice/sluice.hpp>
#endif

#include <cstdio>
#include <cstring>
#include <utility>

#if __cplusplus >= 201703L
static int own_a_source()
{
    const unsigned char texels[4] = {1, 2, 3, 4};
    auto info = sluice::sized<SluiceImageInfo>();
    info.width = info.height = info.mipLevelCount = info.arrayLayerCount = 1;
    info.format = SLUICE_FORMAT_R8G8B8A8_UNORM;
    auto [result, source] = sluice::create(sluiceCreateMemoryImageSource, texels, &info, nullptr);
    sluice::ImageSource kept = std::move(source);
    auto read = sluice::sized<SluiceImageInfo>();
    if (result != SLUICE_SUCCESS || sluiceGetImageInfo(kept.get(), &read) != SLUICE_SUCCESS)
        return 2;
    return read.width == 1 && !source ? 0 : 3;
}
#endif

int main()
{
    if (std::strcmp(sluiceGetResultName(SLUICE_SUCCESS), "SLUICE_SUCCESS") != 0)
        return 1;
    std::printf("sluice %d.%d.%d\n", SLUICE_VERSION_MAJOR, SLUICE_VERSION_MINOR,
                SLUICE_VERSION_PATCH);
#if __cplusplus >= 201703L
    return own_a_source();
#else
    return 0;
#endif
}
