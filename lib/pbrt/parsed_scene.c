#include "pbrt/parsed_scene.h"

#include "base/log.h"

#include <stdarg.h>
#include <stdio.h>

static void say(const SluicePbrtScene *scene, const SluiceLogCallback *log,
                SluiceLogSeverity severity, const struct slc_pbrt_place *place, const char *text)
{
    const char *path = place->file < scene->file_count
                           ? slc_pbrt_name(&scene->names, scene->files[place->file].path)
                           : "scene";
    slc_log(log, severity, "%s:%u:%u: %s", path, place->line, place->column, text);
}

void slc_pbrt_say(SluicePbrtScene *scene, SluiceLogSeverity severity,
                  const struct slc_pbrt_place *place, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (severity == SLUICE_LOG_ERROR)
        scene->info.errorCount += scene->info.errorCount < UINT32_MAX;
    else
        scene->info.warningCount += scene->info.warningCount < UINT32_MAX;
    if (scene->message_count > SLC_PBRT_MAX_MESSAGES)
        return;
    if (scene->message_count++ == SLC_PBRT_MAX_MESSAGES - 1)
        snprintf(text, sizeof text, "more messages are left out");
    if (scene->message_count <= SLC_PBRT_MAX_MESSAGES)
        say(scene, &scene->limits.log, severity, place, text);
}

void slc_pbrt_warn(const SluicePbrtScene *scene, const struct slc_pbrt_place *place,
                   const char *text)
{
    say(scene, &scene->limits.log, SLUICE_LOG_WARNING, place, text);
}

SluiceResult slc_pbrt_fail(const SluicePbrtScene *scene, SluiceResult result,
                           const struct slc_pbrt_place *place, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    say(scene, &scene->limits.log, SLUICE_LOG_ERROR, place, text);
    return result;
}

const char *slc_pbrt_failure_text(SluiceResult result)
{
    switch (result) {
    case SLUICE_ERROR_FILE_NOT_FOUND: return "no such file";
    case SLUICE_ERROR_OUT_OF_HOST_MEMORY: return "not enough memory";
    case SLUICE_ERROR_UNSUPPORTED: return "compressed, and Sluice was built without zlib";
    case SLUICE_ERROR_CORRUPT_DATA: return "damaged compressed data";
    case SLUICE_ERROR_LIMIT_EXCEEDED: return "more text than maxTextSize allows";
    case SLUICE_NOT_READY: return "too few file descriptors";
    default: return "cannot be read";
    }
}
