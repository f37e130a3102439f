#include "base/log.h"

#include <stdarg.h>
#include <stdio.h>

void slc_log(const SluiceLogCallback *log, SluiceLogSeverity severity, const char *format, ...)
{
    if (!log || !log->pfnLog)
        return;
    char message[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    log->pfnLog(log->pUserData, severity, message);
}
