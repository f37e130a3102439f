/** Runs nginx on a port of 127.0.0.1, with a folder of files. */
#ifndef TESTS_HTTP_NGINX_SERVER_H
#define TESTS_HTTP_NGINX_SERVER_H

#include <stdbool.h>
#include <sys/types.h>

struct nginx_server {
    char folder[64]; ///< "www" in it is served
    unsigned port, tls_port;
    pid_t process;
};

/** Returns whether nginx is installed. */
bool nginx_is_there(void);
/** Makes the folder, writes the configuration and a certificate, and starts nginx. */
void nginx_init(struct nginx_server *server);
/** Starts nginx again after nginx_stop. */
void nginx_start(struct nginx_server *server);
void nginx_stop(struct nginx_server *server);
/** Stops nginx and removes the folder. */
void nginx_finish(struct nginx_server *server);

#endif /* TESTS_HTTP_NGINX_SERVER_H */
