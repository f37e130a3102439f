/** Formatted messages to a caller's log callback. */
#ifndef SLC_BASE_LOG_H
#define SLC_BASE_LOG_H

#include <sluice/base.h>

/** Cut off at 1023 bytes. Does nothing if `log` is NULL or has no function. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void slc_log(const SluiceLogCallback *log, SluiceLogSeverity severity, const char *format, ...);

/** Logs an error that names the argument, its value and its limit. Returns INVALID_ARGUMENT. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
SluiceResult
slc_log_refusal(const SluiceLogCallback *log, const char *format, ...);

#endif /* SLC_BASE_LOG_H */
