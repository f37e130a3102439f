/** dlfcn.h for Windows, which lacks it: opens DLLs. */
#ifndef TOOLS_COMMON_WINDOWS_DLFCN_H
#define TOOLS_COMMON_WINDOWS_DLFCN_H

#include <string.h>

#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#define RTLD_NOW 0
#define RTLD_LOCAL 0

static inline void *dlopen(const char *name, int flags)
{
    (void)flags;
    return LoadLibraryA(name);
}

static inline void *dlsym(void *library, const char *symbol)
{
    FARPROC function = GetProcAddress(library, symbol);
    void *pointer;
    memcpy(&pointer, &function, sizeof pointer);
    return pointer;
}

static inline const char *dlerror(void)
{
    return "LoadLibrary fails";
}

static inline int dlclose(void *library)
{
    return FreeLibrary(library) ? 0 : -1;
}

#endif /* TOOLS_COMMON_WINDOWS_DLFCN_H */
