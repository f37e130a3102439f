#include "remote.h"

bool remote_open(struct remote_file *remote, const char *url, const SluiceLogCallback *log)
{
    (void)url;
    *remote = (struct remote_file){0};
    if (log->pfnLog)
        log->pfnLog(log->pUserData, SLUICE_LOG_ERROR,
                    "URLs cannot be read: this build of Sluice was made without sluice-http, which "
                    "needs libcurl");
    return false;
}

void remote_close(struct remote_file *remote)
{
    (void)remote;
}
