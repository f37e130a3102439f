#include "remote.h"

bool remote_begin(struct remote_session *session, const SluiceLogCallback *log)
{
    (void)session;
    if (log->pfnLog)
        log->pfnLog(log->pUserData, SLUICE_LOG_ERROR,
                    "URLs cannot be read: this build of Sluice was made without sluice-http, which "
                    "needs libcurl");
    return false;
}

void remote_serve_opener(const struct remote_session *session, SluiceImageOpenerCreateInfo *info)
{
    (void)session, (void)info;
}

void remote_end(struct remote_session *session)
{
    (void)session;
}

bool remote_open(struct remote_file *remote, struct remote_session *session, const char *url,
                 const SluiceLogCallback *log)
{
    (void)url;
    *remote = (struct remote_file){0};
    return remote_begin(session, log);
}

void remote_close(struct remote_file *remote)
{
    (void)remote;
}
