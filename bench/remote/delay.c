/*
 * Delays packets between two network namespaces, as a long line does, on kernels without netem.
 *
 *     delay MILLISECONDS COMMAND [ARGUMENT]...
 *
 * Makes the network device "near" in the namespace it is started in and "far" in a new one, in
 * which it runs COMMAND. Each packet that enters one device leaves the other half of MILLISECONDS,
 * the round trip, later. Ends with COMMAND, and has its exit status. Needs the rights of root in
 * its namespaces: `unshare --net --map-root-user` is enough.
 *
 * Packets of TCP stay up to 64 KiB long (IFF_VNET_HDR, TUN_F_TSO4), so that the processor is not
 * the limit: with 0 ms 500 MB/s pass on two cores.
 */
#define _GNU_SOURCE

#include <errno.h>
#include <fcntl.h>
#include <linux/if.h>
#include <linux/if_tun.h>
#include <pthread.h>
#include <sched.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { PACKET_SIZE = (64 << 10) + 256, SLOTS = 4096 }; /* 270 MB each way, if all are used */

struct packet {
    int64_t due; ///< nanoseconds
    ssize_t size;
    unsigned char bytes[PACKET_SIZE];
};

/** A direction of the line: a ring that one thread fills and another empties. */
struct direction {
    int from, to;
    int64_t delay; ///< nanoseconds
    struct packet *ring;
    uint64_t filled, emptied;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
};

static void must(bool is_fine, const char *what)
{
    if (is_fine)
        return;
    fprintf(stderr, "delay: %s: %s\n", what, strerror(errno));
    exit(1);
}

static int64_t now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

static int open_device(const char *name)
{
    int device = open("/dev/net/tun", O_RDWR | O_CLOEXEC);
    must(device >= 0, "/dev/net/tun");
    struct ifreq request = {.ifr_flags = IFF_TUN | IFF_NO_PI | IFF_VNET_HDR};
    snprintf(request.ifr_name, sizeof request.ifr_name, "%s", name);
    must(ioctl(device, TUNSETIFF, &request) == 0, name);
    must(ioctl(device, TUNSETOFFLOAD, TUN_F_CSUM | TUN_F_TSO4) == 0, "offloads");
    return device;
}

static void *fill(void *user)
{
    struct direction *d = user;
    for (;;) {
        pthread_mutex_lock(&d->mutex);
        while (d->filled - d->emptied == SLOTS)
            pthread_cond_wait(&d->changed, &d->mutex);
        pthread_mutex_unlock(&d->mutex);
        struct packet *packet = &d->ring[d->filled % SLOTS];
        packet->size = read(d->from, packet->bytes, PACKET_SIZE);
        if (packet->size <= 0)
            continue; /* the device is not up yet */
        packet->due = now() + d->delay;
        pthread_mutex_lock(&d->mutex);
        d->filled++;
        pthread_cond_broadcast(&d->changed);
        pthread_mutex_unlock(&d->mutex);
    }
    return NULL;
}

static void *empty(void *user)
{
    struct direction *d = user;
    for (;;) {
        pthread_mutex_lock(&d->mutex);
        while (d->filled == d->emptied)
            pthread_cond_wait(&d->changed, &d->mutex);
        pthread_mutex_unlock(&d->mutex);
        const struct packet *packet = &d->ring[d->emptied % SLOTS];
        const struct timespec due = {packet->due / 1000000000, packet->due % 1000000000};
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL);
        if (write(d->to, packet->bytes, (size_t)packet->size) < 0 && errno != EIO)
            perror("delay: a packet is lost");
        pthread_mutex_lock(&d->mutex);
        d->emptied++;
        pthread_cond_broadcast(&d->changed);
        pthread_mutex_unlock(&d->mutex);
    }
    return NULL;
}

static void start(struct direction *d)
{
    pthread_t thread;
    d->ring = malloc(SLOTS * sizeof *d->ring);
    must(d->ring, "memory");
    pthread_mutex_init(&d->mutex, NULL);
    pthread_cond_init(&d->changed, NULL);
    must(pthread_create(&thread, NULL, fill, d) == 0, "a thread");
    must(pthread_create(&thread, NULL, empty, d) == 0, "a thread");
}

int main(int argc, char **argv)
{
    static struct direction there, back;
    int status = 0;
    if (argc < 3) {
        fprintf(stderr, "usage: delay MILLISECONDS COMMAND [ARGUMENT]...\n");
        return 2;
    }
    int64_t delay = (int64_t)(atof(argv[1]) * 0.5e6);
    int near = open_device("near");
    must(unshare(CLONE_NEWNET) == 0, "a network namespace");
    int far = open_device("far");
    pid_t child = fork();
    must(child >= 0, "a process");
    if (child == 0) {
        execvp(argv[2], argv + 2);
        must(false, argv[2]);
    }
    there = (struct direction){.from = near, .to = far, .delay = delay};
    back = (struct direction){.from = far, .to = near, .delay = delay};
    start(&there);
    start(&back);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        continue;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}
