#include "base/log.h"

#include <stdarg.h>
#include <stdio.h>

/* For clang, which checks formats that are passed on. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 0)))
#endif
static void
log_list(const SluiceLogCallback *log, SluiceLogSeverity severity, const char *format,
         va_list arguments)
{
    char message[1024];
    if (!log || !log->pfnLog)
        return;
    vsnprintf(message, sizeof message, format, arguments);
    log->pfnLog(log->pUserData, severity, message);
}

void slc_log(const SluiceLogCallback *log, SluiceLogSeverity severity, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    log_list(log, severity, format, arguments);
    va_end(arguments);
}

SluiceResult slc_log_refusal(const SluiceLogCallback *log, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    log_list(log, SLUICE_LOG_ERROR, format, arguments);
    va_end(arguments);
    return SLUICE_ERROR_INVALID_ARGUMENT;
}
