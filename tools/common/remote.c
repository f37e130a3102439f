#include "remote.h"

#include <sluice/http.h>

#include <stdlib.h>

/* NULL if it is not set, or empty. */
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

bool remote_open(struct remote_file *remote, const char *url, const SluiceLogCallback *log)
{
    SluiceHttpClient *client = NULL;
    *remote = (struct remote_file){.input = {.structSize = sizeof remote->input}};
    SluiceResult result = create_client(log, &client);
    remote->client = client;
    if (result == SLUICE_SUCCESS)
        result = sluiceOpenHttpPath(client, url, &remote->input, &remote->file);
    if (result != SLUICE_SUCCESS)
        remote_close(remote);
    return result == SLUICE_SUCCESS;
}

void remote_close(struct remote_file *remote)
{
    if (remote->client)
        sluiceCloseHttpPath(remote->client, remote->file);
    sluiceDestroyHttpClient(remote->client);
    remote->client = NULL;
    remote->file = NULL;
}
