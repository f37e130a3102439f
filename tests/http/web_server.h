/** Runs faulty_server.py for a group of tests. */
#ifndef TESTS_HTTP_WEB_SERVER_H
#define TESTS_HTTP_WEB_SERVER_H

struct web_server {
    unsigned ports[3];     ///< web, the same of another origin, TLS or 0
    char certificate[256]; ///< a path; "-": none
};
extern struct web_server web_server;

/** Set-up and tear-down of a group of cmocka tests. */
int web_server_start(void **state);
int web_server_stop(void **state);

#endif /* TESTS_HTTP_WEB_SERVER_H */
