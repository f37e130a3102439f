#include "remote.h"

#include <sluice/http.h>

#include <stdlib.h>

/* Returns NULL if the variable is not set or empty. */
static const char *variable(const char *name)
{
    const char *value = getenv(name);
    return value && value[0] ? value : NULL;
}

static const char *either(const char *a, const char *b)
{
    const char *value = variable(a);
    return value ? value : variable(b);
}

static SluiceResult create_client(const SluiceLogCallback *log, SluiceHttpClient **client)
{
    SluiceS3Access access = {.structSize = sizeof access,
                             .pEndpoint = either("AWS_ENDPOINT_URL_S3", "AWS_ENDPOINT_URL"),
                             .pRegion = either("AWS_REGION", "AWS_DEFAULT_REGION"),
                             .pAccessKey = variable("AWS_ACCESS_KEY_ID"),
                             .pSecretKey = variable("AWS_SECRET_ACCESS_KEY"),
                             .pSessionToken = variable("AWS_SESSION_TOKEN")};
    SluiceHttpClientCreateInfo info = {.structSize = sizeof info,
                                       .pCertificateFile = variable("SSL_CERT_FILE"),
                                       .pS3 = access.pEndpoint ? &access : NULL,
                                       .log = *log};
    return sluiceCreateHttpClient(&info, client);
}

bool remote_begin(struct remote_session *session, const SluiceLogCallback *log)
{
    SluiceHttpClient *client = NULL;
    if (session->client)
        return true;
    SluiceResult result = create_client(log, &client);
    session->client = client;
    return result == SLUICE_SUCCESS;
}

void remote_serve_opener(const struct remote_session *session, SluiceImageOpenerCreateInfo *info)
{
    if (!session->client)
        return;
    info->pathOpener = (SluicePathOpener){session->client, sluiceOpenHttpPath, sluiceCloseHttpPath};
    info->pfnCheckPath = sluiceCheckHttpPath;
}

void remote_end(struct remote_session *session)
{
    sluiceDestroyHttpClient(session->client);
    session->client = NULL;
}

bool remote_open(struct remote_file *remote, struct remote_session *session, const char *url,
                 const SluiceLogCallback *log)
{
    *remote = (struct remote_file){.input = {.structSize = sizeof remote->input}};
    if (!remote_begin(session, log))
        return false;
    remote->session = *session;
    return sluiceOpenHttpPath(session->client, url, &remote->input, &remote->file) ==
           SLUICE_SUCCESS;
}

void remote_close(struct remote_file *remote)
{
    sluiceCloseHttpPath(remote->session.client, remote->file);
    remote->file = NULL;
}
