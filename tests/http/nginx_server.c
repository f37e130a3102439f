#define _XOPEN_SOURCE 700

#include "http/nginx_server.h"

#include "support/test.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* A port that is free now. */
static unsigned free_port(void)
{
    struct sockaddr_in address = {.sin_family = AF_INET};
    socklen_t size = sizeof address;
    int listener = socket(AF_INET, SOCK_STREAM, 0);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    assert_int_equal(bind(listener, (struct sockaddr *)&address, sizeof address), 0);
    assert_int_equal(getsockname(listener, (struct sockaddr *)&address, &size), 0);
    close(listener);
    return ntohs(address.sin_port);
}

static bool is_listening(unsigned port)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
    int client = socket(AF_INET, SOCK_STREAM, 0);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    bool is_there = connect(client, (struct sockaddr *)&address, sizeof address) == 0;
    close(client);
    return is_there;
}

static void run_in(const char *folder, const char *commands)
{
    char line[1024];
    snprintf(line, sizeof line, "cd '%s' && %s", folder, commands);
    assert_int_equal(system(line), 0);
}

/* Paths are relative to the folder. Five requests per connection, so that connections end between
 * reads. */
static void write_configuration(const struct nginx_server *server)
{
    char path[128];
    snprintf(path, sizeof path, "%s/nginx.conf", server->folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file,
            "user root;\nworker_processes 1;\ndaemon off;\nmaster_process off;\npid pid;\n"
            "error_log error.log warn;\nevents { worker_connections 256; }\n"
            "http {\n"
            "  access_log off; keepalive_requests 5; gzip on; gzip_types *;\n"
            "  client_body_temp_path t1; proxy_temp_path t2; fastcgi_temp_path t3;\n"
            "  uwsgi_temp_path t4; scgi_temp_path t5;\n"
            "  limit_req_zone $uri zone=one:1m rate=20r/s;\n"
            "  server {\n"
            "    listen 127.0.0.1:%u; listen 127.0.0.1:%u ssl; root www;\n"
            "    ssl_certificate certificate.pem; ssl_certificate_key key.pem;\n"
            "    location /moved/ { rewrite ^/moved/(.*)$ /$1 redirect; }\n"
            "    location /limited/ { limit_req zone=one; alias www/; }\n"
            "    location /whole/ { max_ranges 0; alias www/; }\n"
            "  }\n"
            "}\n",
            server->port, server->tls_port);
    fclose(file);
}

bool nginx_is_there(void)
{
    return system("PATH=$PATH:/usr/sbin; { command -v nginx && command -v openssl; } >/dev/null") ==
           0;
}

void nginx_start(struct nginx_server *server)
{
    char file[128], log[128];
    snprintf(file, sizeof file, "%s/nginx.conf", server->folder);
    snprintf(log, sizeof log, "%s/error.log", server->folder);
    server->process = fork();
    if (server->process == 0) {
        int nothing = open("/dev/null", O_RDWR);
        dup2(nothing, 1);
        dup2(nothing, 2);
        setenv("PATH", "/usr/sbin:/usr/local/sbin:/usr/bin:/usr/local/bin:/bin", 1);
        execlp("nginx", "nginx", "-p", server->folder, "-c", file, "-e", log, (char *)NULL);
        _exit(127);
    }
    for (int left = 1000; left > 0 && !is_listening(server->port); left--)
        nanosleep(&(struct timespec){0, 10000000}, NULL);
    assert_true(is_listening(server->port));
}

void nginx_init(struct nginx_server *server)
{
    *server = (struct nginx_server){.folder = "/tmp/sluice-nginx-XXXXXX"};
    assert_non_null(mkdtemp(server->folder));
    server->port = free_port();
    do
        server->tls_port = free_port();
    while (server->tls_port == server->port);
    write_configuration(server);
    run_in(server->folder,
           "mkdir www && openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes "
           "-subj /CN=127.0.0.1 -addext subjectAltName=IP:127.0.0.1 -days 2 -keyout key.pem "
           "-out certificate.pem 2>/dev/null");
    nginx_start(server);
}

void nginx_stop(struct nginx_server *server)
{
    kill(server->process, SIGTERM);
    assert_int_equal(waitpid(server->process, NULL, 0), server->process);
}

void nginx_finish(struct nginx_server *server)
{
    nginx_stop(server);
    run_in(server->folder, "rm -r \"$PWD\"");
}
