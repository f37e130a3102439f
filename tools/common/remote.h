/** Files on servers, for programs that take names of files: URLs. */
#ifndef TOOLS_COMMON_REMOTE_H
#define TOOLS_COMMON_REMOTE_H

#include <sluice/open.h>

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/** Connections that files share. Zeroed: none. */
struct remote_session {
    void *client;
};

struct remote_file {
    struct remote_session session; ///< borrowed
    void *file;
    SluiceInput input; ///< for the source that reads the file
};

/** Returns whether a name is a URL of http, https or s3. */
static inline bool remote_is_url(const char *name)
{
    return strncmp(name, "http://", 7) == 0 || strncmp(name, "https://", 8) == 0 ||
           strncmp(name, "s3://", 5) == 0;
}

/** Copies the last part of a URL's path, without the query, which may hold keys. */
static inline void remote_name(const char *url, char *name, size_t size)
{
    size_t length = strcspn(url, "?#"), first = length;
    while (first > 0 && url[first - 1] != '/')
        first--;
    snprintf(name, size, "%.*s", (int)(length - first), url + first);
}

/** Returns the input to read from. NULL: the file is not remote, and its path is read. */
static inline const SluiceInput *remote_input(const struct remote_file *remote)
{
    return remote->file ? &remote->input : NULL;
}

/**
 * Creates a client, if the session has none. Keys for s3:// come from AWS_ACCESS_KEY_ID,
 * AWS_SECRET_ACCESS_KEY, AWS_SESSION_TOKEN, AWS_REGION or AWS_DEFAULT_REGION, AWS_ENDPOINT_URL_S3
 * or AWS_ENDPOINT_URL; trusted certificates from SSL_CERT_FILE. False: said on `log`, which files
 * use, too.
 */
bool remote_begin(struct remote_session *session, const SluiceLogCallback *log);
/** Lets an opener open URLs. The session must outlive it. Sets nothing without a client. */
void remote_serve_opener(const struct remote_session *session, SluiceImageOpenerCreateInfo *info);
/** Close all files first. A zeroed struct is allowed. */
void remote_end(struct remote_session *session);

/** Opens a URL. Begins the session if it has not. The session stays until the file is closed.
 *  False: said on `log`. */
bool remote_open(struct remote_file *remote, struct remote_session *session, const char *url,
                 const SluiceLogCallback *log);
/** A zeroed struct is allowed. Destroy the sources that read it first. */
void remote_close(struct remote_file *remote);

#endif /* TOOLS_COMMON_REMOTE_H */
