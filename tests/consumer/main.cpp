// The same from C++: the headers compile, the names link.
#include <sluice/sluice.h>

#include <cstdio>
#include <cstring>

int main()
{
    if (std::strcmp(sluiceGetResultName(SLUICE_SUCCESS), "SLUICE_SUCCESS") != 0)
        return 1;
    std::printf("sluice %d.%d.%d\n", SLUICE_VERSION_MAJOR, SLUICE_VERSION_MINOR,
                SLUICE_VERSION_PATCH);
    return 0;
}
